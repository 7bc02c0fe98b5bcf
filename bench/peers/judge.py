"""Judges designs of any origin by their loops alone: stability and the peaks Ms and Mt on a dense grid, with numpy and
nothing of the engine."""

import re

import numpy as np

TF_OVER_TD = 0.1
LIMIT = 1.4
TOLERANCE = 1e-3  # of a limit, relative
POINTS = 20000


class Plant:
    """num(s)/den(s) e^(-Ls), from a line of `peers_engine plants`."""

    def __init__(self, line):
        self.line = line
        self.name, num, den, L = line.rstrip("\n").split("\t")
        self.num, self.den = (np.array(field.split(), float) for field in (num, den))
        self.L = float(L)
        self.integrators = len(self.den) - 1 - np.flatnonzero(self.den)[-1]
        self.omega = self.grid(POINTS)

    def __call__(self, w):
        return np.polyval(self.num, 1j * w) / np.polyval(self.den, 1j * w) * np.exp(-1j * w * self.L)

    def grid(self, points):
        """Three decades to either side of the frequency where the phase passes -180 degrees."""
        poles = np.roots(self.den)
        slowest = 1 / (self.L + np.sum(1 / np.abs(poles[np.abs(poles) > 0])))
        w = np.geomspace(1e-3 * slowest, 1e6 * slowest, points)
        phase = np.unwrap(np.angle(self(w)))
        crossover = w[np.argmax(phase < -np.pi)]
        return np.geomspace(1e-3 * crossover, 1e3 * crossover, points)


def controller(w, Kp, Ti, Td, Tf=None):
    """`Tf` of the filter where it is not the problem's own."""
    s = 1j * w
    f = s * (TF_OVER_TD * Td if Tf is None else Tf)
    return Kp * (1 + 1 / (s * Ti) + s * Td) / (1 + f + f * f / 2)


def stable(loop, right=0, origin=1):
    """By Nyquist, `loop` on a grid from where its integrators let it come to where it ends: 1 + L turns by half a turn
    for each of `right` unstable poles of the loop and by a quarter for each of `origin` integrators, the controller's
    among them."""
    angle = np.unwrap(np.angle(1 + loop))
    return abs(angle[-1] - angle[0] - np.pi * (right + origin / 2)) < np.pi / 2


def peak(values, w, of_loop):
    """The largest of the grid's three highest summits, each looked at more closely."""
    inner = np.flatnonzero((values[1:-1] >= values[:-2]) & (values[1:-1] >= values[2:])) + 1
    highest = max(values[0], values[-1])
    for i in inner[np.argsort(values[inner])[-3:]]:
        highest = max(highest, np.max(of_loop(np.linspace(w[i - 1], w[i + 1], 401))))
    return highest


def peaks(loop, w):
    """Ms and Mt of the loop, a function of frequency, that a grid `w` shows."""
    def sensitivity(w):
        return np.abs(1 / (1 + loop(w)))

    def complementary(w):
        at = loop(w)
        return np.abs(at / (1 + at))

    return peak(sensitivity(w), w, sensitivity), peak(complementary(w), w, complementary)


def excess(plant, answer, points=POINTS):
    """By how much the larger peak exceeds its limit, relative; infinite where the loop is not stable."""
    w = plant.omega if points == POINTS else plant.omega[::POINTS // points]

    def loop(w):
        return plant(w) * controller(w, *answer)

    at = loop(w)
    if not (np.all(np.isfinite(at)) and stable(at, 0, 1 + plant.integrators)):
        return np.inf
    return max(peaks(loop, w)) / LIMIT - 1


def held(plant, answer):
    """The answer with its gain lowered in steps of 1 % until the limits hold, as its user would have to; None where no
    gain down to a twentieth does."""
    for step in range(300):
        lowered = (answer[0] * 0.99 ** step, *answer[1:])
        if excess(plant, lowered, 1000) <= TOLERANCE and excess(plant, lowered) <= TOLERANCE:
            return lowered
    return None


def reference_name(row):
    """The batch's name of a row of tests/data/robust: "P7_T1_L0.02" is "P7 1.020000"."""
    family, parameters = row["id"].split("_", 1)
    return "%s %.6f" % (family, sum(float(number) for number in re.findall(r"[\d.]+", parameters)))
