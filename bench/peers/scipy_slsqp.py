"""The design as one would write it with numpy and scipy: SLSQP over the logarithms of Kp, Ti and Td; the load IAE from
an inverse FFT of the closed loop; the limits as two constraints at each point of a frequency grid.

Reads plants (num, den, dead time between tabs behind a name), writes name, Kp, Ti, Td, ms: the shorter of two runs."""

import sys
import time

import numpy as np
import scipy.optimize

M = 1.4
TF_OVER_TD = 0.1
SAMPLES = 4096
PERIODS = 40  # of the ultimate oscillation: how long the response is looked at
RUNS = 2


def frequency_response(w, num, den, L):
    return np.polyval(num, 1j * w) / np.polyval(den, 1j * w) * np.exp(-1j * w * L)


def controller(w, Kp, Ti, Td):
    s, f = 1j * w, 1j * w * TF_OVER_TD * Td
    return Kp * (1 + 1 / (s * Ti) + s * Td) / (1 + f + f ** 2 / 2)


def phase_crossover(num, den, L):
    lags = den if den[-1] else den[:-1]
    slowest = 1 / (L + (lags[-2] / lags[-1] if len(lags) > 1 else 0))
    w = np.geomspace(1e-3 * slowest, 1e4 * slowest, 20000)
    phase = np.unwrap(np.angle(frequency_response(w, num, den, L)))
    return w[np.argmax(phase < -np.pi)]


class Problem:
    def __init__(self, num, den, L):
        self.w180 = phase_crossover(num, den, L)
        self.Tu = 2 * np.pi / self.w180
        self.Ku = 1 / abs(frequency_response(self.w180, num, den, L))
        self.kappa = 0 if den[-1] == 0 else den[-1] / num[-1] / self.Ku
        self.w = np.geomspace(0.01, 30, 300) * self.w180
        self.P = frequency_response(self.w, num, den, L)
        self.length = PERIODS * self.Tu
        self.w_fft = 2 * np.pi * np.arange(1, SAMPLES // 2 + 1) / self.length
        self.P_fft = frequency_response(self.w_fft, num, den, L)

    def iae(self, x):
        """Y = P/(1 + PC)/s; at s = 0 integral action leaves Ti/Kp."""
        Kp, Ti, Td = np.exp(x)
        Y = self.P_fft / (1 + self.P_fft * controller(self.w_fft, Kp, Ti, Td)) / (1j * self.w_fft)
        y = np.fft.irfft(np.concatenate([[Ti / Kp], Y]), SAMPLES) / self.length * SAMPLES
        return np.sum(np.abs(y)) * self.length / SAMPLES

    def margins(self, x):
        """Not negative where both limits hold."""
        loop = self.P * controller(self.w, *np.exp(x))
        distance = np.abs(1 + loop)
        return np.concatenate([distance - 1 / M, M * distance - np.abs(loop)])

    def stable(self, x):
        angle = np.unwrap(np.angle(1 + self.P * controller(self.w, *np.exp(x))))
        turns_before = 2 * np.pi if angle[0] > np.pi / 2 else 0  # two integrators, and a lag before the lead
        return abs(angle[-1] - turns_before) < 2

    def start(self, more):
        """AMIGO's Ti on the ultimate point and `more` times its Td, with the largest of a few gains that hold the
        limits; slower until there is one."""
        Ti = 0.6 / (1 + 2 * self.kappa) * self.Tu
        Td = max(0.15 * (1 - self.kappa) / (1 - 0.95 * self.kappa), 0.02) * self.Tu
        for slower in 1.5 ** np.arange(12):
            for gain in 0.8 * self.Ku * 0.85 ** np.arange(20):
                x = np.log([gain, Ti * slower, Td * more])
                if np.min(self.margins(x)) >= 0 and self.stable(x):
                    return x
        return None

    def minimum(self, x):
        unit = self.iae(x)
        found = scipy.optimize.minimize(lambda x: self.iae(x) / unit, x, method="SLSQP",
                                        bounds=[(value - 1.5, value + 1.5) for value in x],
                                        constraints={"type": "ineq", "fun": self.margins},
                                        options={"ftol": 1e-7, "maxiter": 100}).x
        return found if np.min(self.margins(found)) > -1e-4 and self.stable(found) else x


def design(num, den, L):
    """The better of two starts: there may be several minima."""
    problem = Problem(num, den, L)
    starts = [x for more in (1, 2) if (x := problem.start(more)) is not None]
    return np.exp(min(map(problem.minimum, starts), key=problem.iae)) if starts else None


def main():
    for line in sys.stdin:
        name, num, den, L = line.rstrip("\n").split("\t")
        num, den = (np.array(field.split(), float) for field in (num, den))
        times = []
        for _ in range(RUNS):
            start = time.process_time()
            answer = design(num, den, float(L))
            times.append(1e3 * (time.process_time() - start))
        if answer is not None:
            print(name, *("%.12g" % value for value in answer), "%.6g" % min(times), sep="\t", flush=True)


if __name__ == "__main__":
    if sys.argv[1:] == ["--version"]:
        print(scipy.__version__)
    else:
        main()
