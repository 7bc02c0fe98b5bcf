#!/usr/bin/python3
"""Compares the figures of two binaries: of this machine and of 64-bit ARM under an emulator.

    compare_figures.py [--reference COMMAND] [--other COMMAND] [--only WORD] [--list N]

Both answer the same requests: the examples, the AMIGO batch, the recorded tests, products, structures and problems of the
library. Each figure of both answers is compared in two ways:

- settings given: the controllers of the reference's answers are evaluated by both. No search is involved, so every figure
  has to be the same within 1e-12 of itself, or of the largest value of its trace;
- whole answer: a search ends where a difference in the last digits lets it end. What it found has to be the same within
  1e-4, which is what the search promises of the cost; most are the same to 1e-7. Models that are not chosen and that the
  record does not determine are left out: their standard errors are differences of numbers that are nearly equal."""

import argparse
import concurrent.futures
import json
import pathlib
import shlex
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
# Relative differences that are allowed. Of whole answers: searches end where the cost is flat.
ALLOWED = {"whole answer": 1e-4, "settings given": 1e-12}
# Figures that are searched for with given settings too.
SEARCHED = {"longest_sample_time"}
# What a check found to be left over is rounding itself: its size is no figure. Counts of a search are no figures either.
LEFT_OUT = {"version", "compute_ms", "verification", "evaluations", "iterations", "starts", "candidates"}


def own_binary():
    return str(ROOT / "build" / "release" / "tunewright")


def emulated_binary():
    return "qemu-aarch64-static -L %s %s" % (ROOT / "build" / "arm64-root", ROOT / "build" / "arm64" / "tunewright")


class Program:
    """One of the two binaries, with its command line."""

    def __init__(self, command):
        self.command = shlex.split(command)

    def answer(self, command, request):
        with tempfile.NamedTemporaryFile("w", suffix=".json") as file:
            json.dump(request, file)
            file.flush()
            done = subprocess.run([*self.command, command, file.name, "--json"], capture_output=True, text=True)
        text = done.stdout if done.stdout.strip() else done.stderr
        try:
            return json.loads(text)
        except ValueError:
            return {"exit": done.returncode, "said": text}

    def examples(self):
        done = subprocess.run([*self.command, "examples"], capture_output=True, text=True, check=True)
        return json.loads(done.stdout)


def amigo_plants():
    times = (0.02, 0.05, 0.1, 0.2, 0.3, 0.5, 0.7, 1, 1.3, 1.5, 2, 4, 6, 8, 10, 20, 50, 100, 200, 500, 1000)
    for T in times:
        yield "amigo lag %g" % T, {"type": "fopdt", "K": 1, "T": T, "L": 1}
        yield "amigo two lags %g" % T, {"type": "sopdt", "K": 1, "T1": T, "T2": T, "L": 1}
    for n in range(3, 9):
        yield "amigo equal lags %d" % n, {"type": "zpk", "K": 1, "poles": [-1] * n}
    for L in (0.01, 0.05, 0.1, 0.3, 0.5, 0.7, 0.9):
        yield "amigo integrating %g" % L, {"type": "zpk", "K": 1 / (1 - L), "poles": [0, -1 / (1 - L)], "L": L}
    for a in (0.1, 0.3, 0.5, 0.8, 1.0):
        yield "amigo inverse response %g" % a, {"type": "zpk", "K": -a, "zeros": [1 / a], "poles": [-1, -1, -1]}


def problem_plants():
    problems = json.loads((ROOT / "bench" / "problems" / "problems.json").read_text())["problems"]
    for problem in problems[::9]:
        if "plant" in problem:
            yield "problem %s" % problem.get("id", problem.get("name", "?")), problem["plant"]


def requests(examples):
    """Each request as name, command, request."""
    for example in examples["examples"]:
        yield "example " + example["id"], "tune", example["request"]
    for example in examples["ranges"]:
        yield "example " + example["id"], "range", example["request"]
    rules = [{"method": "robust"}, {"method": "robust", "controller": "PI", "Ms": 1.6}, {"method": "simc"}, {"method": "amigo"}]
    for name, plant in [*amigo_plants(), *problem_plants()]:
        yield name, "tune", {"plant": plant, "tune": rules, "evaluate": {"points": 50}}
    plant = {"type": "fopdt", "K": 2, "T": 10, "L": 3}
    for each in (plant, {"type": "ipdt", "K": 0.1, "L": 2}, {"type": "zpk", "K": 9, "poles": [-1, [-0.5, 2.958], [-0.5, -2.958]]}):
        yield "all methods on " + each["type"], "tune", {"plant": each, "tune": [{"method": "all"}], "evaluate": {"points": 50}}
    for product in ("siemens_pid_compact", "beckhoff_fb_ctrl_pid", "matlab_pidstd", "controlsystems_jl_pid"):
        yield "product " + product, "tune", {"plant": plant, "tune": [{"method": "robust"}, {"method": "simc"}],
                                             "implement": {"product": product, "sample_time": 0.5}, "evaluate": {"points": 50}}
    for path in sorted((ROOT / "tests" / "data" / "records").glob("*.csv")):
        yield "record " + path.stem, "tune", {"record": {"csv": path.read_text()}, "evaluate": {"points": 50}}


def given_settings(request, answer):
    """The request that evaluates the settings of an answer; None where nothing can be given."""
    entries = answer.get("controllers") or []
    laws = [entry["controller"] for entry in entries if entry.get("controller") and entry["method"] not in ("baseline", "given")]
    laws = [{name: value for name, value in law.items() if value is not None and name in
             ("form", "Kp", "Ti", "Td", "Ki", "Kd", "b", "c", "filter", "setpoint_filter")} for law in laws if law["form"] != "npid"]
    plant = request.get("plant") or (answer.get("model") or {}).get("plant")
    if not laws or not plant:
        return None
    return {"plant": plant, "controllers": laws[:8], "tune": [], "evaluate": request.get("evaluate", {})}


class Comparison:
    """The largest difference of the figures of two answers, each with its place."""

    def __init__(self):
        self.count = 0
        self.differences = []

    def values(self, place, a, b):
        if isinstance(a, dict) and isinstance(b, dict):
            for name in sorted(a.keys() | b.keys()):
                if name in LEFT_OUT:
                    continue
                if name not in a or name not in b:
                    self.differences.append((float("inf"), "%s/%s" % (place, name), "only in one answer"))
                else:
                    self.values("%s/%s" % (place, name), a[name], b[name])
        elif isinstance(a, list) and isinstance(b, list) and len(a) == len(b):
            numbers = [abs(value) for value in [*a, *b] if is_number(value)]
            size = max(numbers) if len(a) > 3 and len(numbers) == 2 * len(a) else 0.0
            for i, (one, two) in enumerate(zip(a, b)):
                if size:
                    self.number("%s/%d" % (place, i), one, two, size)
                else:
                    self.values("%s/%d" % (place, i), one, two)
        elif is_number(a) and is_number(b):
            self.number(place, a, b, max(abs(a), abs(b)))
        elif a != b and not (isinstance(a, str) and isinstance(b, str)):
            self.differences.append((float("inf"), place, "%.60r and %.60r" % (a, b)))

    def number(self, place, a, b, size):
        self.count += 1
        if a != b and not (place.rsplit("/", 1)[-1] in SEARCHED and abs(a - b) <= ALLOWED["whole answer"] * size):
            self.differences.append((abs(a - b) / size, place, "%.17g and %.17g" % (a, b)))


def is_number(value):
    return isinstance(value, (int, float)) and not isinstance(value, bool)


def compared(a, b):
    comparison = Comparison()
    comparison.values("", a, b)
    return comparison


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--reference", default=own_binary())
    parser.add_argument("--other", default=emulated_binary())
    parser.add_argument("--only", default="", help="requests whose name has this word")
    parser.add_argument("--list", type=int, default=3, help="differences to list of each request")
    words = parser.parse_args()
    reference, other = Program(words.reference), Program(words.other)

    def both(task):
        name, command, request = task
        one, two = reference.answer(command, request), other.answer(command, request)
        given = given_settings(request, one) if command == "tune" else None
        pair = (reference.answer("tune", given), other.answer("tune", given)) if given else None
        return name, compared(one, two), compared(*pair) if pair else None

    tasks = [task for task in requests(reference.examples()) if words.only in task[0]]
    figures, worst, beyond = 0, {kind: 0.0 for kind in ALLOWED}, 0
    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        for name, *comparisons in pool.map(both, tasks):
            for kind, comparison in zip(ALLOWED, comparisons):
                if comparison is None:
                    continue
                figures += comparison.count
                rows = sorted(comparison.differences, key=lambda row: -row[0])
                largest = rows[0][0] if rows else 0.0
                worst[kind] = max(worst[kind], largest)
                beyond += sum(row[0] > ALLOWED[kind] for row in rows)
                print("%-42s %-16s %7d figures, worst %.1e" % (name, kind, comparison.count, largest), flush=True)
                for size, place, values in rows[:words.list]:
                    if size > ALLOWED[kind]:
                        print("    %.1e %s: %s" % (size, place, values))
    print("%d figures of %d requests; worst: %s; beyond what is allowed: %d" % (
        figures, len(tasks), ", ".join("%s %.1e" % item for item in worst.items()), beyond))
    return 1 if beyond else 0


if __name__ == "__main__":
    sys.exit(main())
