"""Random cascades: three peaks within their limits, stability, IAE, and joint against sequential design."""

import numpy as np

from client import Tally
from frequency import grid, peak, unstable_zeros
from responses import absolute_integral
from transfer import Pid, Transfer

WITHIN = 1e-5
LEAST_IAE_COMPARED = 1e-6


def log_uniform(random, low, high):
    return float(np.exp(random.uniform(np.log(low), np.log(high))))


def plant(random, lag):
    """First or second order, with a dead time; either sign of the gain."""
    gain = log_uniform(random, 0.2, 5) * random.choice([-1, 1])
    lags = [lag] if random.random() < 0.5 else [lag, lag * log_uniform(random, 0.05, 1)]
    return Transfer(float(gain), lags, lag * log_uniform(random, 0.02, 2))


def problem(random):
    ratio = log_uniform(random, 1, 30)
    inner = plant(random, log_uniform(random, 0.3, 30))
    outer = plant(random, inner.lags[0] * ratio)
    kinds = [str(random.choice(["PI", "PID"], p=[0.75, 0.25])) for _ in range(2)]
    limits = [round(float(random.uniform(1.3, 1.8)), 3) for _ in range(2)]
    request = {
        "inner": {"plant": inner.text(), "tune": {"controller": kinds[0], "Ms": limits[0], "Mt": limits[0]}},
        "outer": {"plant": outer.text(), "tune": {"controller": kinds[1], "Ms": limits[1], "Mt": limits[1]}},
        "compare_single": False,
        "arrangement": "parallel" if random.random() < 0.15 else "series",
    }
    if random.random() < 0.5:
        request["limits"] = {"Ms_valve": round(float(random.uniform(1.3, 1.8)), 3)}
    return request, inner, outer


class Loops:
    """The functions of a cascade in s."""

    def __init__(self, request, answer, inner, outer):
        self.P2, self.P1 = inner, outer
        self.parallel = request["arrangement"] == "parallel"
        self.C2, self.C1 = Pid(answer["inner"]["controller"]), Pid(answer["outer"]["controller"])
        self.times = inner.times() + outer.times() + self.C1.times() + self.C2.times()

    def from_valve(self, s):
        """From the valve to the outer measurement."""
        return self.P1(s) if self.parallel else self.P1(s) * self.P2(s)

    def inner_difference(self, s):
        return 1 + self.C2(s) * self.P2(s)

    def valve_difference(self, s):
        return self.inner_difference(s) + self.C1(s) * self.C2.of_setpoint(s) * self.from_valve(s)

    def after_inner_load(self, s):
        return self.from_valve(s) / self.valve_difference(s) / s

    def after_outer_load(self, s):
        return self.P1(s) * self.inner_difference(s) / self.valve_difference(s) / s

    def after_setpoint(self, s):
        moved = self.C1.of_setpoint(s) * self.C2.of_setpoint(s) * self.from_valve(s)
        return (1 - moved / self.valve_difference(s)) / s


def check_limits(tally, request, answer, loops):
    inner, outer, valve = loops.inner_difference, loops.valve_difference, loops.valve_difference
    tally.expect(unstable_zeros(inner, 1, loops.times) == 0, "the inner loop is not stable", request)
    tally.expect(unstable_zeros(outer, 2, loops.times) == 0, "the loops are not stable together", request)
    omega = grid(loops.times)
    found = {"inner": peak(lambda s: 1 / inner(s), omega)[0],
             "outer": peak(lambda s: inner(s) / valve(s), omega)[0],
             "valve": peak(lambda s: 1 / valve(s), omega)[0]}
    limit = {"inner": request["inner"]["tune"]["Ms"], "outer": request["outer"]["tune"]["Ms"],
             "valve": answer["Ms_valve_limit"]}
    told = {"inner": answer["inner"]["robustness"]["Ms"], "outer": answer["outer"]["robustness"]["Ms"],
            "valve": answer["outer"]["robustness"]["Ms_valve"]}
    for name, value in found.items():
        tally.expect(value <= limit[name] * (1 + WITHIN), f"Ms_{name} is {value}, limit {limit[name]}", request)
        tally.expect(abs(told[name] / value - 1) < 2e-5, f"Ms_{name} is {value}, answered {told[name]}", request)


def check_IAE(tally, request, answer, loops):
    start = 4 * sum(loops.times)
    for name, transform in (("inner_load", loops.after_inner_load), ("outer_load", loops.after_outer_load),
                            ("setpoint", loops.after_setpoint)):
        told = answer["performance"][name]["IAE"]
        # The jump of the set point is smoothed over a point or two.
        fine = 0.1 if name == "setpoint" else 1
        found = absolute_integral(transform, start, fine * min(loops.P2.times()))
        tally.note("IAE error", abs(told / found - 1))
        tally.expect(abs(told / found - 1) < 1e-3, f"IAE of {name} is {found}, answered {told}", request)


def cost(answer):
    return answer["performance"]["inner_load"]["IAE"] + answer["performance"]["outer_load"]["IAE"]


def check(client, seed, count, joints):
    random = np.random.default_rng(seed)
    tally, joint_tally = Tally("cascade", 0.1), Tally("joint", 1)
    for i in range(count):
        request, inner, outer = problem(random)
        tally.cases += 1
        status, answer, seconds = client.ask("cascade", request)
        tally.time(seconds, request)
        if status != 200:
            tally.refuse(answer)
            tally.expect(status == 422, f"status {status}", request)
            print("refused", request)
            continue
        loops = Loops(request, answer, inner, outer)
        check_limits(tally, request, answer, loops)
        if i % 10 == 0:
            check_IAE(tally, request, answer, loops)
        if i >= joints:
            continue
        both = dict(request, search="joint")
        status, found, seconds = client.ask("cascade", both)
        joint_tally.cases += 1
        joint_tally.time(seconds, both)
        joint_tally.expect(status == 200, f"status {status}", both)
        check_limits(joint_tally, both, found, Loops(both, found, inner, outer))
        ratio = cost(found) / cost(answer)
        joint_tally.note("cost over that of the sequential design", ratio)
        joint_tally.expect(ratio <= 1 + 1e-5, f"joint is worse: {ratio}", both)
    return [tally, joint_tally]
