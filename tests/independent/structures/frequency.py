"""Peaks over frequency and counts of unstable poles, from functions of s alone."""

import numpy as np

PER_DECADE = 2000
BELOW, ABOVE = 1e-3, 1e3  # of the lowest and the highest corner


def grid(times, per_decade=PER_DECADE, below=BELOW, above=ABOVE):
    """Angular frequencies around the corners 1/time."""
    low, high = below / max(times), above / min(times)
    return np.exp(np.linspace(np.log(low), np.log(high), int(per_decade * np.log10(high / low)) + 2))


def peak(function, omega, spread=200, rounds=3):
    """The largest |function(j omega)| and where: every maximum near the largest is searched on finer and finer grids."""
    values = np.abs(function(1j * omega))
    tops = np.flatnonzero((values[1:-1] >= values[:-2]) & (values[1:-1] >= values[2:])) + 1
    best, at = max((values[0], omega[0]), (values[-1], omega[-1]))
    for k in tops[values[tops] > 0.98 * values.max()]:
        low, high = omega[k - 1], omega[k + 1]
        for _ in range(rounds):
            fine = np.linspace(low, high, spread)
            there = np.abs(function(1j * fine))
            j = int(np.argmax(there))
            if there[j] > best:
                best, at = there[j], fine[j]
            low, high = fine[max(j - 1, 0)], fine[min(j + 1, spread - 1)]
    return best, at


def unstable_zeros(function, integrators, times, unstable_poles=0, below=1e-6, above=1e5):
    """Zeros in the right half-plane of a function that tends to 1 for large s and has that many poles at 0.

    Cauchy's argument principle on (s/(s + a))^integrators times the function: on the axis from 0 to infinity the
    argument falls by pi for each zero on the right and rises by pi for each pole. Steps of more than half a radian are
    halved. None: the function comes too near to 0 on the axis to tell."""
    a = 1 / max(times)

    def regular(omega):
        s = 1j * omega
        return function(s) * (s / (s + a)) ** integrators

    omega = grid(times, 400, below, above)
    value = regular(omega)
    for _ in range(40):
        step = np.angle(value[1:] / value[:-1])
        wide = np.flatnonzero(np.abs(step) > 0.5)
        if not len(wide):
            break
        middle = np.sqrt(omega[wide] * omega[wide + 1])
        omega, value = np.insert(omega, wide + 1, middle), np.insert(value, wide + 1, regular(middle))
    else:
        return None
    # The first value is real but for a small angle, the last one near 1.
    turned = step.sum() + np.angle(value[0] / np.sign(value[0].real)) - np.angle(value[-1])
    zeros = unstable_poles - turned / np.pi
    return round(zeros) if abs(zeros - round(zeros)) < 0.05 else None
