#!/usr/bin/python3
"""Scores of rules, recomputed by a program that shares nothing with the engine.

    tests/independent/problems/scores.py BINARY [METHOD ...]        all rules of the service without names

The settings are the service's; stability, limits, IAE and ratio are computed again. Exit code 1 if a status differs or
a ratio by more than 0.1 %; peaks within 1e-4 of their limit decide nothing."""

import json
import pathlib
import subprocess
import sys

from loop import Loop, peak_frequency

FILE = pathlib.Path(__file__).resolve().parents[3] / "bench" / "problems" / "problems.json"

RATIO, NEAR = 1e-3, 1e-4
RULES = ("amigo", "simc", "lambda", "imc", "ziegler_nichols_step", "ziegler_nichols_ultimate", "tyreus_luyben",
         "cohen_coon", "chien_hrones_reswick", "tavakoli_iae", "robust", "arrieta_ms", "kappa_tau")


def compared(problem, scored):
    """What is wrong, and the deviation of the ratio."""
    if scored["status"] == "no-settings":
        return [], None
    settings = scored["controller"]
    gains = settings["Kp"], settings["Ti"], settings["Td"]
    if gains[1] is None:
        return [], None
    known = {"Kp": gains[0], "Ti": gains[1], "Td": gains[2], "Tf": settings["filter"].get("Tf", 0)}
    loop = Loop(problem, peak_frequency(problem, known))
    stable = loop.stable(*gains)
    if not stable or scored["status"] == "unstable":
        agree = stable == (scored["status"] != "unstable")
        return [] if agree else [f"stable: {stable}, answered {scored['status']}"], None
    excess = loop.fine_excess(*gains) - 1
    wrong = []
    if abs(excess) > NEAR and (excess > 0) != (scored["status"] == "limits-broken"):
        wrong.append(f"a limit is exceeded by {excess:.2g}, answered {scored['status']}")
    deviation = loop.IAE(*gains) / problem["lower"] / scored["ratio"] - 1
    if scored["status"] == "kept" and not abs(deviation) < RATIO:
        wrong.append(f"the ratio {scored['ratio']} deviates by {deviation:.2g}")
    return wrong, deviation if scored["status"] == "kept" else None


def main():
    binary, *methods = sys.argv[1:]
    problems = {p["name"]: p for p in json.loads(FILE.read_text())["problems"]}
    failures = 0
    for method in methods or RULES:
        answer = json.loads(subprocess.run([binary, "score", "--method", method, "--json"], capture_output=True,
                                           check=True, text=True).stdout)
        largest = 0.0
        for scored in answer["problems"]:
            wrong, deviation = compared(problems[scored["name"]], scored)
            largest = max(largest, abs(deviation or 0))
            failures += len(wrong)
            for sentence in wrong:
                print(method, scored["name"], sentence, flush=True)
        print(f"{method}: {len(answer['problems'])} problems, {answer['kept']} kept, largest deviation {largest:.1e}",
              flush=True)
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
