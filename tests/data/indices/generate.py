#!/usr/bin/env python3
"""Writes loops.json: performance indices of PID loops, by Chebyshev collocation.

Nothing here is shared with the product, neither code nor method; collocation.py says how a response is computed. A
second run with half as long intervals tells how exact the figures are; a loop is kept where that is 1e-9 or better.

    ./generate.py > loops.json
"""
import json
import random
import sys

from collocation import Response


def figures(setpoint, load):
    IAE, ISE, ITAE = setpoint.integrals()
    low, high = setpoint.extremes()
    ten, ninety = setpoint.first_reached(0.1), setpoint.first_reached(0.9)
    servo = {"IAE": IAE, "ISE": ISE, "ITAE": ITAE, "TV": setpoint.variation(),
             "overshoot_percent": max(0.0, 100 * (high - 1)), "settling_time": setpoint.last_outside(0.02),
             "rise_time": None if ninety is None else ninety - ten}
    IAE, ISE, ITAE = load.integrals()
    low, high = load.extremes()
    peak = high if high >= -low else low
    regulation = {"IAE": IAE, "ISE": ISE, "ITAE": ITAE, "TV": load.variation(), "peak": peak,
                  "recovery_time": load.last_outside(0.02 * abs(peak))}
    return {"setpoint": servo, "load": regulation}


def difference(a, b):
    """Largest relative one of the integrals and the total variation."""
    worst = 0.0
    for side in ("setpoint", "load"):
        for name in ("IAE", "ISE", "ITAE", "TV"):
            size = max(abs(a[side][name]), abs(b[side][name]))
            if size > 0:
                worst = max(worst, abs(a[side][name] - b[side][name]) / size)
    return worst


def pair(re, im):
    return [[re, im], [re, -im]]


def random_plant(kind, rng):
    """K is the leading factor of K prod(s - z)/prod(s - p)."""
    T = 10 ** rng.uniform(-1, 1.5)
    ratio = 10 ** rng.uniform(-3, 1)
    plant = {"zeros": [], "poles": [], "L": 0.0 if rng.random() < 0.25 else T * ratio, "K": 1.0}
    lag = lambda t: [-1 / t, 0.0]
    gain = 10 ** rng.uniform(-1.5, 1.5)
    if kind == "fopdt":
        plant["poles"] = [lag(T)]
    elif kind == "sopdt":
        plant["poles"] = [lag(T), lag(T * rng.uniform(0.05, 1))]
    elif kind == "oscillating":
        zeta = rng.uniform(0.1, 0.7)
        plant["poles"] = pair(-zeta / T, (1 - zeta**2) ** 0.5 / T)
    elif kind == "integrating":
        plant["poles"] = [[0.0, 0.0], lag(T * rng.uniform(0.1, 1))]
    elif kind == "high order":
        plant["poles"] = [lag(T * q) for q in rng.sample([1, 1, 1, 0.9, 0.5, 0.3, 0.2, 0.1], rng.randint(3, 8))]
        plant["L"] = rng.choice([0.0, plant["L"]])
    elif kind == "non-minimum phase":
        plant["zeros"] = [[1 / (T * rng.uniform(0.1, 0.8)), 0.0]]
        plant["poles"] = [lag(T), lag(T * rng.uniform(0.3, 0.99)), lag(T * 0.2)]
    else:  # unstable
        plant["poles"] = [[1 / T, 0.0], lag(T * 0.05)]
        plant["L"] = rng.choice([0.0, T * 10 ** rng.uniform(-3, -0.7)])
    value = 1.0
    for p in plant["poles"]:
        if p[0] or p[1]:
            value /= complex(*p)
    for z in plant["zeros"]:
        value *= -complex(*z)
    size = abs(value) or 1.0
    sign = 1.0
    if kind == "non-minimum phase":
        sign = -1.0  # the zero's own: K/(...) > 0 at s = 0
    plant["K"] = sign * gain / size
    plant["K"] = float(plant["K"])
    plant["T"] = T
    return plant, gain


def random_controller(kind, plant, gain, rng):
    T = plant["T"]
    slow = sum(-1 / p[0] for p in plant["poles"] if p[0] < 0)
    dead = plant["L"] + 0.5 * (slow - T if kind in ("high order", "sopdt") else 0.1 * T)
    dead += sum(1 / z[0] for z in plant["zeros"])
    dead = max(dead, 0.03 * T)
    boost = 10 ** rng.uniform(-0.5, 0.45)
    if kind == "integrating":
        Kp, Ti = 0.5 / gain / (dead + 0.4 * T) * boost, 8 * (dead + T) * rng.uniform(0.5, 2)
    elif kind == "unstable":
        Kp, Ti = rng.uniform(2, 6) / gain, 10 * (dead + 0.1 * T) * rng.uniform(1, 3)
    elif kind == "oscillating":
        Kp, Ti = 0.3 / gain * boost, T * rng.uniform(0.5, 2)
    else:
        Kp, Ti = 0.5 * T / gain / dead * boost, min(T, 8 * dead) * rng.uniform(0.6, 2)
    Td = 0.0 if rng.random() < 0.4 else rng.uniform(0.05, 0.5) * min(dead, Ti)
    if kind == "unstable":
        Td = 0.3 * dead
    if kind == "oscillating" and rng.random() < 0.6:
        Td = T * rng.uniform(0.2, 1)
    filter_type = rng.choice(["derivative", "measurement_first_order", "measurement_second_order"])
    if Td == 0 and rng.random() < 0.5:
        filter_type = "none"
    if Td > 0 and len(plant["poles"]) - len(plant["zeros"]) > 1 and rng.random() < 0.15:
        filter_type = "none"
    Tf = rng.choice([0.05, 0.1, 0.2]) * (Td if Td > 0 else 0.3 * dead)
    if filter_type == "derivative" and Td == 0:
        filter_type = "none"
    return {"Kp": Kp, "Ki": Kp / Ti, "Kd": Kp * Td, "b": rng.choice([1.0, 1.0, 0.0, 0.6]),
            "c": rng.choice([0.0, 1.0]) if filter_type == "derivative" else 0.0,
            "filter": filter_type, "Tf": Tf if filter_type != "none" else 0.0}


KINDS = ["fopdt", "sopdt", "oscillating", "integrating", "high order", "non-minimum phase", "unstable"]


def both(plant, c, refine, horizon=None):
    return (Response(plant, c, 1.0, 0.0, refine, horizon=horizon), Response(plant, c, 0.0, 1.0, refine, horizon=horizon))


def entry(kind, rng, horizons):
    plant, gain = random_plant(kind, rng)
    c = random_controller(kind, plant, gain, rng)
    one, two = both(plant, c, 1), both(plant, c, 2)
    to_infinity, check = figures(*two), figures(*one)
    error = difference(to_infinity, check)
    if error > 1e-9:
        raise ValueError("not exact enough: %g" % error)
    end = min(two[0].t0[-1], two[1].t0[-1])
    cuts = []
    for _ in range(horizons):
        T = end * 10 ** rng.uniform(-2.5, -0.05)
        if T <= 1.05 * plant["L"]:
            T = plant["L"] * rng.uniform(1.05, 3)
            if T > end:
                continue
        cuts.append({"horizon": T, **figures(two[0].cut(T), two[1].cut(T))})
    return {"kind": kind, "plant": {k: plant[k] for k in ("K", "zeros", "poles", "L")}, "controller": c,
            "error": error, **to_infinity, "cuts": cuts}


def main():
    loops, horizons, seed = (int(a) for a in (sys.argv[1:] + ["105", "6", "1"][len(sys.argv) - 1:]))
    rng = random.Random(seed)
    found, tried = [], 0
    while len(found) < loops:
        kind = KINDS[len(found) % len(KINDS)]
        tried += 1
        state = random.Random(rng.random())
        try:
            found.append(entry(kind, state, horizons))
            print("[" if len(found) == 1 else ",", json.dumps(found[-1]), flush=True)
            print(len(found), tried, kind, file=sys.stderr)
        except ValueError as why:
            print(kind, why, file=sys.stderr)
    print("]")


if __name__ == "__main__":
    main()
