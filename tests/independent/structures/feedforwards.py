"""Random feedforward problems: the optimum against the other compensators and an own search, exact inverses, IAE."""

import numpy as np
from scipy.optimize import minimize

from client import Tally
from frequency import unstable_zeros
from responses import absolute_integral
from transfer import Pid, Transfer


def log_uniform(random, low, high):
    return float(np.exp(random.uniform(np.log(low), np.log(high))))


def problem(random, exact):
    K, T = log_uniform(random, 0.3, 3) * float(random.choice([-1, 1])), log_uniform(random, 3, 60)
    second = not exact and random.random() < 0.3
    plant = Transfer(K, [T, T * log_uniform(random, 0.1, 0.7)] if second else [T], T * log_uniform(random, 0.05, 1.5))
    Td = T * log_uniform(random, 0.1, 4)
    Ld = plant.L * (log_uniform(random, 1, 3) if exact else float(random.uniform(0, 1)))
    disturbance = Transfer(log_uniform(random, 0.3, 3) * float(random.choice([-1, 1])), [Td], Ld)
    jump = abs(disturbance.K / K) * (max(T / Td, 1) * 1.01 if exact else log_uniform(random, 1.2, 12))
    request = {"plant": plant.text(), "disturbance": disturbance.text(), "feedforward": {"jump": jump},
               "feedback": {"tune": {"controller": str(random.choice(["PI", "PID"])), "Ms": 1.5, "Mt": 1.5}}}
    return request, plant, disturbance


class Loop:
    def __init__(self, plant, disturbance, feedback):
        self.P, self.Pd, self.C = plant, disturbance, feedback
        self.times = plant.times() + disturbance.times() + feedback.times()

    def IAE(self, f):
        Kf, Tz, Tp, Lf = (f.get(k, 0) for k in ("Kf", "Tz", "Tp", "Lf")) if f else (0, 0, 0, 0)

        def transform(s):
            F = Kf * (Tz * s + 1) / (Tp * s + 1) * np.exp(-Lf * s)
            return (self.Pd(s) - self.P(s) * F) / (1 + self.P(s) * self.C(s)) / s

        fine = min(self.times + [t for t in (Tp,) if t > 0])
        return absolute_integral(transform, sum(self.times), max(fine, 0.02 * max(self.times)))


def least(loop, start, jump):
    """An own search from several starts; the lag is lengthened to the bound."""
    def compensator(x):
        Kf, Tz, Tp = start["Kf"] * np.exp(x[0]), np.exp(x[1]), np.exp(x[2])
        return {"Kf": Kf, "Tz": Tz, "Tp": max(Tp, abs(Kf) * Tz / jump), "Lf": start.get("Lf", 0)}

    T, Td = loop.P.lags[0], loop.Pd.lags[0]
    best = np.inf
    for Tz, Tp in ((T, Td), (T, 0.1 * T), (0.3 * T, 0.1 * T)):
        found = minimize(lambda x: loop.IAE(compensator(x)), [0, np.log(Tz), np.log(Tp)], method="Nelder-Mead",
                         options={"maxfev": 150, "xatol": 1e-4, "fatol": 1e-6})
        best = min(best, found.fun)
    return best


def check(client, seed, count):
    random = np.random.default_rng(seed)
    tally = Tally("feedforward", 0.1)
    for i in range(count):
        exact = i % 4 == 0
        request, plant, disturbance = problem(random, exact)
        tally.cases += 1
        status, answer, seconds = client.ask("feedforward", request)
        tally.time(seconds, request)
        if status != 200:
            tally.refuse(answer)
            print("refused", request, answer, flush=True)
            continue
        variants = {v["kind"]: v for v in answer["variants"]}
        loop = Loop(plant, disturbance, Pid(answer["feedback"]))
        tally.expect(unstable_zeros(lambda s: 1 + loop.P(s) * loop.C(s), 1, loop.times) == 0, "not stable", request)
        best, jump = variants["optimum"], request["feedforward"]["jump"]
        f = best["compensator"]
        if f["Tp"]:
            tally.expect(abs(f["Kf"]) * f["Tz"] / f["Tp"] <= jump * (1 + 1e-9), f"the optimum jumps by more: {f}", request)
        for kind in ("none", "static", "inverse", "guzman_hagglund"):
            other = variants[kind]
            if other["IAE"] is None:
                continue
            allowed = other["IAE"] * (1 + 1e-5) + 1e-6 * variants["none"]["IAE"]
            tally.expect(best["IAE"] <= allowed, f"the optimum {best['IAE']} is worse than {kind} {other['IAE']}", request)
        if exact:
            tally.expect(best["IAE"] < 1e-6 * variants["none"]["IAE"], "the exact inverse is not found", request)
            continue
        if i % 5 == 1:
            for kind, variant in variants.items():
                if variant["IAE"] is None:
                    continue
                found = loop.IAE(variant["compensator"])
                tally.note("IAE error", abs(variant["IAE"] / found - 1))
                tally.expect(abs(variant["IAE"] / found - 1) < 1e-3, f"IAE of {kind} is {found}, answered "
                             f"{variant['IAE']}", request)
        if i % 10 == 1:
            ratio = best["IAE"] / least(loop, variants["optimum"]["compensator"], jump)
            tally.note("IAE over that of an own search", ratio)
            tally.expect(ratio <= 1.002, f"{ratio} times the IAE of an own search", request)
    return [tally]
