#!/usr/bin/python3
"""The library of problems, checked by a program that shares nothing with the engine.

    tests/independent/problems/run.py                  best known controllers of all problems, then 10,000 random designs
    tests/independent/problems/run.py --problems 5 --designs 20 --seed 2

1. Each best known controller is stable, its peaks keep the limits, and its IAE is the file's.
2. Random designs within the limits, many of them with the largest gain: none has an IAE below the proved bound.

Exit code 1 if one of these fails; each failure is printed with its problem and its controller."""

import argparse
import json
import multiprocessing
import pathlib
import sys

import numpy as np

from loop import Loop, peak_frequency

ROOT = pathlib.Path(__file__).resolve().parents[3]
FILE = ROOT / "bench" / "problems" / "problems.json"
PEAKS, IAES = 2e-5, 1e-3  # relative
SPREADS = (0.02, 0.1, 0.4, 1.2)  # of ln Ti and ln Td around the best known controller
MAX_TRIES = 4  # for one design within the limits


def best_known(problem):
    """Sentences about what is wrong, the largest relative deviation of peak and IAE."""
    best = problem["best"]
    loop = Loop(problem, peak_frequency(problem, best))
    gains = best["Kp"], best["Ti"], best["Td"]
    wrong = []
    if not loop.stable(*gains):
        wrong.append("the best known controller is not stable")
    excess = loop.fine_excess(*gains) - 1
    if excess > PEAKS:
        wrong.append(f"a limit is exceeded by {excess:.2g}")
    deviation = loop.IAE(*gains) / problem["upper"] - 1
    if not abs(deviation) < IAES:
        wrong.append(f"IAE deviates by {deviation:.2g}")
    return wrong, excess, deviation


def random_design(loop, best, draw):
    """Kp, Ti, Td within the limits, or None."""
    for _ in range(MAX_TRIES):
        spread = draw.choice(SPREADS)
        Ti = best["Ti"] * np.exp(spread * draw.standard_normal())
        Td = best["Td"] * np.exp(spread * draw.standard_normal())
        Kp = loop.largest_gain(Ti, Td, best["Kp"])
        if Kp is None:
            continue
        if draw.random() < 0.3:
            lower = Kp * draw.uniform(0.4, 1)
            if loop.excess(lower, Ti, Td) <= 1 and loop.stable(lower, Ti, Td):
                Kp = lower
        return Kp, Ti, Td
    return None


def random_designs(job):
    """Number of designs and of those simulated, the least IAE over the bound and over the best known, and those below
    the bound.

    The integral of the error of a stable loop is Ti/Kp, and the IAE is not below it. A design where it is at least the
    best known IAE need not be simulated."""
    problem, count, seed = job
    draw = np.random.default_rng([seed, sum(problem["name"].encode())])
    loop = Loop(problem, peak_frequency(problem, problem["best"]), per_decade=100)
    least, below, made, simulated = np.inf, [], 0, 0
    for _ in range(count):
        gains = random_design(loop, problem["best"], draw)
        if gains is None:
            continue
        made += 1
        if abs(gains[1] / gains[0]) >= problem["upper"]:
            continue
        IAE = loop.IAE(*gains)
        if not np.isfinite(IAE):
            raise ValueError(f"{problem['name']}: no IAE of {gains}")
        simulated += 1
        least = min(least, IAE)
        if IAE < problem["lower"] and loop.fine_excess(*gains) <= 1:
            below.append((gains, IAE))
    return problem["name"], made, simulated, least / problem["lower"], least / problem["upper"], below


def best_known_of(problem):
    return problem["name"], *best_known(problem)


def check_best_known(pool, problems):
    wrong, excesses, deviations = 0, [], []
    for name, sentences, excess, deviation in pool.imap_unordered(best_known_of, problems):
        for sentence in sentences:
            print(f"FAILED {name}: {sentence}", flush=True)
        wrong += bool(sentences)
        excesses.append(excess)
        deviations.append(abs(deviation))
    print(f"{len(problems)} best known controllers: largest excess of a limit {max(excesses):.1e}, "
          f"IAE within {max(deviations):.1e} (median {np.median(deviations):.1e}), {wrong} failed", flush=True)
    return wrong


def one_of_each_plant(problems, number):
    """That many problems with different plants, spread over the file, structures and limits in turn."""
    plants = {}
    for problem in problems:
        plants.setdefault(problem["plant"], []).append(problem)
    groups = list(plants.values())
    chosen = [groups[int(i * len(groups) / number)] for i in range(min(number, len(groups)))]
    return [group[i % len(group)] for i, group in enumerate(chosen)]


def check_random(pool, problems, count, seed):
    total, simulated, below, ratios, near = 0, 0, 0, [], []
    jobs = [(problem, count, seed) for problem in problems]
    for name, made, one_simulated, over_lower, over_upper, found in pool.imap_unordered(random_designs, jobs):
        total += made
        simulated += one_simulated
        ratios.append(over_lower)
        near.append(over_upper)
        below += len(found)
        print(f"{name}: {made} designs, {one_simulated} simulated, least IAE over the bound {over_lower:.5f}", flush=True)
        for gains, IAE in found:
            print(f"FAILED {name}: IAE {IAE} of Kp, Ti, Td {gains} is below the bound", flush=True)
    print(f"{total} random designs within the limits on {len(problems)} plants, {simulated} of them simulated, the others "
          f"decided by the integral of the error: the least IAE over the bound is "
          f"{min(ratios):.5f}, over the best known {min(near):.5f}; {below} below the bound", flush=True)
    return below


def main():
    words = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    words.add_argument("--problems", type=int, default=50, help="plants that get random designs (default: 50)")
    words.add_argument("--designs", type=int, default=200, help="random designs of each (default: 200)")
    words.add_argument("--seed", type=int, default=1)
    words.add_argument("--file", type=pathlib.Path, default=FILE)
    given = words.parse_args()
    problems = json.loads(given.file.read_text(encoding="utf-8"))["problems"]
    with multiprocessing.Pool(2) as pool:
        wrong = check_best_known(pool, problems)
        wrong += check_random(pool, one_of_each_plant(problems, given.problems), given.designs, given.seed)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
