"""Averaging level control: the figures against the vessel's equations integrated over time."""

import numpy as np
from scipy.integrate import solve_ivp

from client import Tally


def log_uniform(random, low, high):
    return float(np.exp(random.uniform(np.log(low), np.log(high))))


def simulated(A, D, Kc, Ti):
    """Highest level, its time, largest rate of the outflow, its largest overshoot."""
    w = np.sqrt(Kc / (A * Ti)) if Ti else Kc / A

    def slope(_, x):
        h, integral = x
        return [(D - Kc * (h + (integral / Ti if Ti else 0))) / A, h]

    horizon = 60 / w * max(1, (np.sqrt(Kc * Ti / A) / 2) ** 2 if Ti else 1)
    run = solve_ivp(slope, (0, horizon), [0, 0], rtol=1e-10, atol=1e-12 * D / Kc, dense_output=True)
    t = np.concatenate([np.linspace(0, 12 / w, 200001), np.linspace(12 / w, horizon, 20001)[1:]])
    h, integral = run.sol(t)
    out = Kc * (h + (integral / Ti if Ti else 0))
    rate = Kc * ((D - out) / A + (h / Ti if Ti else 0))
    return h.max(), t[h.argmax()], np.abs(rate).max(), max(0.0, out.max() / D - 1)


def check(client, seed, count):
    random = np.random.default_rng(seed)
    tally = Tally("level", 0.005)
    for _ in range(count):
        A, D, H = (log_uniform(random, 0.1, 100) for _ in range(3))
        aim = str(random.choice(["rate", "no_outflow_overshoot", "zeta"]))
        request = {"volume": A, "largest_step": D, "allowed": H, "aim": aim}
        if aim == "zeta":
            request["zeta"] = round(log_uniform(random, 0.15, 3), 4)
        tally.cases += 1
        status, answer, seconds = client.ask("level", request)
        tally.time(seconds, request)
        tally.expect(status == 200, f"status {status}: {answer}", request)
        if status != 200:
            continue
        d = answer["design"]
        highest, when, rate, overshoot = simulated(A, D, d["Kc"], d["Ti"])
        tally.expect(abs(highest / H - 1) < 1e-6, f"the level reaches {highest}, allowed {H}", request)
        tally.expect(abs(d["highest"] / highest - 1) < 1e-6, f"highest {highest}, answered {d['highest']}", request)
        tally.expect(abs(d["largest_rate"] / rate - 1) < 1e-6, f"rate {rate}, answered {d['largest_rate']}", request)
        tally.expect(abs(d["overshoot_percent"] / 100 - overshoot) < 1e-6, f"overshoot {overshoot}", request)
        tally.expect(abs(answer["bound"] / (D * D / (2 * A * H)) - 1) < 1e-12, "the bound", request)
        tally.expect(rate >= answer["bound"], "the rate is below the bound", request)
        if d["Ti"]:
            tally.expect(abs(d["time_of_highest"] / when - 1) < 1e-3, f"highest at {when}", request)
    return [tally]
