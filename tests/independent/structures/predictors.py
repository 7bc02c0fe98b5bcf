"""Random predictors: the peak and the window of the dead time within their limits on the true plant."""

import numpy as np

from client import Tally
from frequency import grid, peak, unstable_zeros
from responses import absolute_integral
from transfer import Pid, Rational, Transfer

WITHIN = 1e-5


def log_uniform(random, low, high):
    return float(np.exp(random.uniform(np.log(low), np.log(high))))


def problem(random):
    kind = str(random.choice(["smith", "filtered_smith", "predictive_pi"], p=[0.45, 0.45, 0.1]))
    K, T, L = log_uniform(random, 0.2, 5) * float(random.choice([-1, 1])), log_uniform(random, 1, 60), 1.0
    L = T * log_uniform(random, 0.1, 10)
    nature = random.random()
    if kind == "filtered_smith" and nature < 0.2:
        model = Transfer(K, [], L, integrators=1)
    elif kind == "filtered_smith" and nature < 0.35:
        model = Transfer(K, [-T], T * log_uniform(random, 0.05, 0.3))
    else:
        model = Transfer(K, [T], L)
    request = {"plant": model.text(), "kind": kind, "Ms": round(float(random.uniform(1.3, 1.95)), 3)}
    if model.unstable_poles():
        request["Ms"] = round(float(random.uniform(1.9, 1.98)), 3)
    plant = model
    if nature > 0.8 and kind != "predictive_pi":  # the plant is of second order, the model a rough one
        plant = Transfer(K * log_uniform(random, 0.85, 1.15), [T, 0.15 * T], L * log_uniform(random, 0.9, 1.1))
        request.update(plant=plant.text(), model=model.text())
    if random.random() < 0.4 and kind != "predictive_pi":
        request["dead_time_error"] = round(log_uniform(random, 0.05, 0.6), 3)
    return request, plant, model


class Loop:
    def __init__(self, plant, model, answer):
        self.P, self.L = plant, model.L
        self.Gm = Transfer(model.K, model.lags, 0.0, integrators=model.integrators)
        self.C, self.F = Rational(answer["controller"]["C"]), Rational(answer["controller"]["F"])
        knobs = [answer[k] for k in ("lambda", "Tf", "beta") if answer.get(k)]
        self.times = plant.times() + model.times() + [abs(k) for k in knobs]
        self.unstable_model = model.unstable_poles()
        self.integrators = 1 + model.integrators

    def inside(self, s):
        """1 + the loop through the model, alone."""
        return 1 + self.C(s) * self.Gm(s) * (1 - self.F(s) * np.exp(-self.L * s))

    def characteristic(self, error=0.0):
        plant = self.P.changed(dead_time=error)
        return lambda s: self.inside(s) + plant(s) * self.C(s) * self.F(s)

    def unstable(self, error=0.0):
        # The model's own pole at 0 or on the right has a zero of 1 - F e^(-Ls) there, so it is none of `inside`.
        poles = self.P.unstable_poles()
        return unstable_zeros(self.characteristic(error), 1 + self.P.integrators, self.times, poles)

    def sensitivity(self, s):
        inside = self.inside(s)
        return inside / (inside + self.P(s) * self.C(s) * self.F(s))


def check_window(tally, request, answer, loop, plant):
    robustness = answer["robustness"]
    up, down = robustness["dead_time_up"], robustness["dead_time_down"]
    for share in (0.1, 0.37, 0.7, 0.9, 0.998):
        if up is not None:
            tally.expect(loop.unstable(share * up) == 0, f"not stable with {share} of dead_time_up {up}", request)
        tally.expect(loop.unstable(-share * down) == 0, f"not stable with {share} of dead_time_down {down}", request)
    if up is not None:
        tally.expect(loop.unstable(1.002 * up) != 0, f"still stable beyond dead_time_up {up}", request)
    if down < plant.L * (1 - 1e-9):
        tally.expect(loop.unstable(-min(1.002 * down, plant.L)) != 0, f"still stable beyond dead_time_down {down}", request)
    wanted = request.get("dead_time_error")
    if wanted is None:
        return
    tally.expect(min(up or np.inf, down) >= wanted * loop.L * (1 - 1e-4) or down >= plant.L, f"the window is {up}, {down}, wanted "
                 f"{wanted * loop.L}", request)
    for error in np.linspace(-wanted, wanted, 9) * loop.L * (1 - 1e-4):
        if plant.L + error >= 0:
            tally.expect(loop.unstable(error) == 0, f"not stable with an error of {error}", request)


def check(client, seed, count):
    random = np.random.default_rng(seed)
    tally = Tally("predictor", 0.2)
    for i in range(count):
        request, plant, model = problem(random)
        tally.cases += 1
        status, answer, seconds = client.ask("predictor", request)
        tally.time(seconds, request)
        if status != 200:
            tally.refuse(answer)
            print("refused", request, answer, flush=True)
            continue
        loop = Loop(plant, model, answer)
        told = answer["robustness"]
        found = loop.unstable()
        tally.expect(found == 0, f"{found} unstable poles", request)
        tally.expect(told["stable"], "answered as not stable", request)
        if not told["stable"]:
            continue
        Ms, omega = peak(loop.sensitivity, grid(loop.times))
        tally.expect(abs(told["Ms"] / Ms - 1) < 2e-5, f"Ms is {Ms} at {omega}, answered {told['Ms']}", request)
        if request["kind"] != "predictive_pi":
            tally.expect(Ms <= request["Ms"] * (1 + WITHIN), f"Ms is {Ms}, limit {request['Ms']}", request)
        check_window(tally, request, answer, loop, plant)
        alone = unstable_zeros(loop.inside, 1, loop.times, 0)
        if not model.integrators and not model.unstable_poles() and alone is not None:
            tally.expect((alone == 0) == told["controller_stable"], f"the controller has {alone} unstable poles", request)
        if i % 5 == 0 and not model.unstable_poles():
            load = absolute_integral(lambda s: plant(s) * loop.sensitivity(s) / s, sum(loop.times), min(loop.times))
            tally.note("IAE error", abs(answer["load"]["IAE"] / load - 1))
            tally.expect(abs(answer["load"]["IAE"] / load - 1) < 1e-3, f"IAE is {load}, answered {answer['load']['IAE']}",
                         request)
        if i % 5 == 0 and answer.get("pid"):
            C = Pid(answer["pid"])
            pid_peak = peak(lambda s: 1 / (1 + C(s) * plant(s)), grid(plant.times() + C.times()))[0]
            same = max(request["Ms"], answer["robustness"]["Ms"])  # a predictive PI has no limit
            tally.expect(pid_peak <= same * (1 + 2 * WITHIN), f"Ms of the PID is {pid_peak}", request)
    return [tally]
