"""A problem's loop from its num, den and L: peaks, stability, load IAE, the largest gain within the limits. numpy alone."""

import pathlib
import sys

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "structures"))
from frequency import unstable_zeros  # noqa: E402
from responses import absolute_integral  # noqa: E402

TIED = 0.1


class Loop:
    """`scale`: a frequency near the loop's peak; the grids lie around it and around the plant's corners."""

    def __init__(self, problem, scale, per_decade=200):
        self.problem = problem
        self.num, self.den, self.L = np.array(problem["num"], float), np.array(problem["den"], float), problem["L"]
        poles = np.roots(self.den)
        small = 1e-9 * max(1e-300, np.abs(poles).max(initial=0))
        self.integrators = int(np.sum(np.abs(poles) <= small))
        self.unstable = int(np.sum(poles.real > small))
        self.scale = scale
        corners = [abs(r) for r in [*poles, *np.roots(self.num)] if abs(r) > small]
        low = 1e-3 * min([scale, *corners])
        high = 1e3 * scale if len(self.den) > len(self.num) else 1e5 * scale  # without lags the filter alone ends it
        if self.L:
            high = max(high, 50 / self.L)
        omega = np.exp(np.linspace(np.log(low), np.log(high), int(per_decade * np.log10(high / low))))
        if self.L:  # turns of the dead time, evenly
            omega = np.union1d(omega, np.arange(1, 2000) * min(0.02 * np.pi / self.L, 0.05 * scale))
        for pole in poles:  # resonances
            if 0 < -pole.real < 0.3 * abs(pole.imag):
                omega = np.union1d(omega, abs(pole.imag) + abs(pole.real) * np.linspace(-20, 20, 801))
        self.omega = omega[omega > 0]
        self.on_axis = self.plant(1j * self.omega)

    def plant(self, s):
        return np.polyval(self.num, s) / np.polyval(self.den, s) * np.exp(-self.L * s)

    def filter_time(self, Td):
        return TIED * Td if self.problem["structure"] == "pid_tied" else self.problem.get("Tf", 0)

    def shape(self, s, Ti, Td):
        """C for Kp = 1."""
        x = s * self.filter_time(Td)
        return (1 + 1 / (s * Ti) + s * Td) / (1 + x + x * x / 2)

    def excess(self, Kp, Ti, Td):
        """The larger of max|S|/Ms and max|T|/Mt on the grid."""
        open_loop = Kp * self.on_axis * self.shape(1j * self.omega, Ti, Td)
        return self.excess_of(open_loop)

    def excess_of(self, open_loop):
        distance = np.abs(1 + open_loop)
        return max((1 / distance).max() / self.problem["Ms"], (np.abs(open_loop) / distance).max() / self.problem["Mt"])

    def fine_excess(self, Kp, Ti, Td):
        """The same with every maximum near the largest searched on finer grids."""
        worst = 0.0
        for which, limit in ((0, self.problem["Ms"]), (1, self.problem["Mt"])):
            def size(omega):
                s = 1j * omega
                open_loop = Kp * self.plant(s) * self.shape(s, Ti, Td)
                return np.abs((open_loop if which else 1) / (1 + open_loop)) / limit
            values = size(self.omega)
            tops = [k for k in range(1, len(values) - 1)
                    if values[k] >= values[k - 1] and values[k] >= values[k + 1] and values[k] > 0.98 * values.max()]
            worst = max(worst, values.max())
            for k in tops:
                low, high = self.omega[k - 1], self.omega[k + 1]
                for _ in range(3):
                    near = np.linspace(low, high, 101)
                    there = size(near)
                    j = int(np.argmax(there))
                    worst = max(worst, there[j])
                    low, high = near[max(j - 1, 0)], near[min(j + 1, 100)]
        return worst

    def stable(self, Kp, Ti, Td):
        """Cauchy's argument principle; False if it cannot tell."""
        def function(s):
            return 1 + Kp * self.plant(s) * self.shape(s, Ti, Td)
        zeros = unstable_zeros(function, self.integrators + 1, [1 / self.scale], self.unstable, 1e-6, 3e3)
        return zeros == 0

    def IAE(self, Kp, Ti, Td):
        def transform(s):
            plant = self.plant(s)
            return plant / (1 + Kp * plant * self.shape(s, Ti, Td)) / s
        return absolute_integral(transform, 20 / self.scale + 4 * Ti, 1 / self.scale)

    def largest_gain(self, Ti, Td, around):
        """The largest Kp up to 4 times `around` (of either sign) within the limits, 1e-4 below them; None: there is
        none."""
        base = self.on_axis * self.shape(1j * self.omega, Ti, Td)
        gains = around * np.geomspace(4, 0.01, 40)
        for i, Kp in enumerate(gains):
            if self.excess_of(Kp * base) > 1 - 1e-4 or not self.stable(Kp, Ti, Td):
                continue
            inside, outside = Kp, gains[i - 1] if i else Kp
            for _ in range(14):
                middle = 0.5 * (inside + outside)
                if self.excess_of(middle * base) <= 1 - 1e-4:
                    inside = middle
                else:
                    outside = middle
            return inside if self.stable(inside, Ti, Td) else Kp
        return None


def peak_frequency(problem, controller):
    """Where |S| of a controller is largest, on a wide grid."""
    corners = [abs(r) for r in [*np.roots(problem["num"]), *np.roots(problem["den"])] if abs(r) > 0]
    corners += [1 / problem["L"]] if problem["L"] else []
    corners += [1 / controller["Ti"]]
    omega = np.geomspace(1e-3 * min(corners), 1e3 * max(corners), 20000)
    s = 1j * omega
    x = s * controller["Tf"]
    C = controller["Kp"] * (1 + 1 / (s * controller["Ti"]) + s * controller["Td"]) / (1 + x + x * x / 2)
    P = np.polyval(problem["num"], s) / np.polyval(problem["den"], s) * np.exp(-problem["L"] * s)
    return omega[int(np.argmax(np.abs(1 / (1 + P * C))))]
