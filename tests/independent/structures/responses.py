"""Responses over time by Fourier inversion along a line right of the imaginary axis."""

import numpy as np

DAMPING = 24  # of exp over the period: what a period echoes into the next is below 1e-10 of it


def inverse(transform, period, points):
    """Values of the original at `points` times over the first half of a period."""
    sigma = DAMPING / period
    omega = 2 * np.pi / period * np.arange(points // 2 + 1)
    values = transform(sigma + 1j * omega)
    # The transform's step at the end of the line rings at each jump and corner; a smooth taper does not.
    taper = np.cos(np.pi / 2 * (np.arange(points // 2 + 1) / (points // 2))) ** 2
    half = points // 2
    t = period / points * np.arange(half)
    return t, np.exp(sigma * t) * np.fft.irfft(values * taper, points)[:half] * points / period


def absolute_integral(transform, start, shortest):
    """Integral of |original| for an original that comes to rest at 0, within about 1e-4, with many points in the
    shortest time that matters.

    The period grows until little is left at its end; its half is used, because echoes grow toward the end."""
    period = 2 * start
    for _ in range(14):
        points = 1 << int(np.clip(np.ceil(np.log2(60 * period / shortest)), 15, 22))
        t, y = inverse(transform, period, points)
        h = t[1] - t[0]
        # |y| of lines between the points, exact where they cross 0.
        a, b = y[:-1], y[1:]
        crossing = a * b < 0
        plain = np.abs(a + b) / 2
        plain[crossing] = ((a ** 2 + b ** 2) / (2 * np.maximum(np.abs(a) + np.abs(b), 1e-300)))[crossing]
        total = h * plain.sum()
        last = h * plain[-len(plain) // 8:].sum()
        if last < 3e-6 * total:
            return total
        period *= 2
    return float("nan")
