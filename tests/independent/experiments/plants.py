"""Sixty plants for tests that controllers run by themselves, and their exact simulation with a held input."""

import numpy as np
from scipy.linalg import expm

SUBSTEPS = 20  # of a sample time: dead times are rounded to them


class Plant:
    """K times a product of lags, leads, integrators and a dead time, sampled with u held in between."""

    def __init__(self, K, poles, zeros=(), L=0.0, kind=""):
        self.K, self.poles, self.zeros, self.L, self.kind = K, list(poles), list(zeros), L, kind
        # Time constants: each pole T gives 1/(T s + 1), inf an integrator 1/s, negative T an unstable pole 1/(|T| s - 1).
        self.num, self.den = np.array([K], float), np.array([1.0])
        for T in self.poles:
            self.den = np.convolve(self.den, [1, 0] if np.isinf(T) else [T, 1] if T > 0 else [-T, -1])
        for T in self.zeros:
            self.num = np.convolve(self.num, [T, 1])

    def __call__(self, s):
        return np.polyval(self.num, s) / np.polyval(self.den, s) * np.exp(-self.L * s)

    @property
    def integrators(self):
        return sum(np.isinf(T) for T in self.poles)

    @property
    def unstable(self):
        return sum(T < 0 for T in self.poles)

    @property
    def times(self):
        return [abs(T) for T in [*self.poles, *self.zeros] if np.isfinite(T) and T != 0] + ([self.L] if self.L else [])

    def ultimate(self):
        """Frequency at which the angle first reaches -pi, and the gain there."""
        omega = np.exp(np.linspace(np.log(1e-4 / max(self.times)), np.log(1e3 / min(self.times)), 40001))
        angle = np.unwrap(np.angle(self(1j * omega) * np.sign(self.K)))
        angle -= 2 * np.pi * round((angle[0] - self.low_angle()) / (2 * np.pi))
        if self.unstable:  # the band in which the angle is above -pi
            inside = np.flatnonzero(angle > -np.pi)
            at = inside[-1] + 1
        else:
            at = np.flatnonzero(angle <= -np.pi)[0]
        return omega[at], abs(self(1j * omega[at]))

    def low_angle(self):
        return -np.pi / 2 * self.integrators - np.pi * self.unstable


class Simulation:
    """y - y0 at the samples for u - u0 held from sample to sample, with loads at the input."""

    def __init__(self, plant, Ts):
        h = Ts / SUBSTEPS
        num, den = plant.num / plant.den[0], plant.den / plant.den[0]
        n = len(den) - 1
        A = np.zeros((n, n))
        A[0, :] = -den[1:]
        A[1:, :-1] = np.eye(n - 1)
        B = np.zeros((n, 1))
        B[0, 0] = 1
        padded = np.concatenate([np.zeros(n + 1 - len(num)), num])
        self.C, self.D = padded[1:] - padded[0] * den[1:], padded[0]
        whole = expm(np.block([[A, B], [np.zeros((1, n + 1))]]) * h)
        self.Phi, self.Gamma = whole[:n, :n], whole[:n, n]
        self.x = np.zeros(n)
        self.steps = int(round(plant.L / h))
        self.late = [0.0] * (self.steps + 1)

    def sample(self):
        return float(self.C @ self.x + self.D * self.late[0])

    def advance(self, u):
        for _ in range(SUBSTEPS):
            self.late.append(u)
            self.late.pop(0)
            self.x = self.Phi @ self.x + self.Gamma * self.late[0]


def sixty(chance):
    """The plants with their conditions: noise and resolution by the amplitude, drift, samples a period, the sign told."""
    inf = float("inf")
    out = []

    def add(kind, count, make, **conditions):
        for _ in range(count):
            case = dict(kind=kind, plant=make(), noise=0.0, quantum=0.0, drift=0.0, samples=60, told=False)
            case.update({k: v() if callable(v) else v for k, v in conditions.items()})
            case["plant"].kind = kind
            out.append(case)

    u = chance.uniform
    sign = lambda: chance.choice([1, -1])
    lag = lambda: Plant(sign() * u(0.5, 3), [u(5, 60)], L=u(1, 40))
    lags = lambda: Plant(sign() * u(0.5, 3), [u(2, 40) for _ in range(chance.randint(2, 4))], L=u(0, 10))
    integrating = lambda: Plant(sign() * u(0.01, 0.1), [inf] + [u(1, 10)] * chance.randint(0, 1), L=u(2, 10))
    unstable = lambda: (lambda T: Plant(sign() * u(0.5, 2), [-T], L=T * u(0.08, 0.3)))(u(10, 60))
    inverse = lambda: (lambda T: Plant(sign() * u(0.5, 2), [T, T * u(0.3, 1)], zeros=[-T * u(0.1, 0.6)], L=u(0, 8)))(u(8, 30))
    any_stable = lambda: chance.choice([lag, lags])()
    add("lag", 8, lag)
    add("lags", 8, lags)
    add("integrating", 7, integrating)
    add("unstable", 6, unstable, told=True)
    add("inverse", 6, inverse, told=True)
    add("noisy", 9, any_stable, noise=lambda: u(0.01, 0.05))
    add("noisy integrating", 2, integrating, noise=lambda: u(0.01, 0.05), told=True)
    add("noisy unstable", 2, unstable, noise=lambda: u(0.01, 0.03), told=True)
    add("quantised", 4, any_stable, quantum=lambda: u(0.02, 0.15))
    add("drifting", 4, any_stable, drift=lambda: sign() * u(0.05, 0.3), noise=0.01)
    add("slow samples", 4, any_stable, samples=lambda: chance.randint(12, 20))
    return out
