#!/usr/bin/python3
"""The library of problems (bench/problems): the file is whole, each best known controller keeps its limits on a grid of
its own, no bound contradicts the integral of the error, and the service's reader takes each plant.

TUNEWRIGHT_BIN names the binary whose reader is asked; without it two tests are skipped."""

import cmath
import json
import math
import os
import pathlib
import subprocess
import sys
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "bench" / "problems"))
import library  # noqa: E402
import table  # noqa: E402
from transfer_function import same_plant  # noqa: E402

BINARY = os.environ.get("TUNEWRIGHT_BIN")
LIBRARY = library.read()
PROBLEMS = LIBRARY["problems"]
ROUNDED = 1e-9  # figures of ten digits


def value(polynomial, s):
    total = 0
    for a in polynomial:
        total = total * s + a
    return total


def open_loop(problem, s):
    best = problem["best"]
    x = s * best["Tf"]
    C = best["Kp"] * (1 + 1 / (s * best["Ti"]) + s * best["Td"]) / (1 + x + x * x / 2)
    return value(problem["num"], s) / value(problem["den"], s) * cmath.exp(-problem["L"] * s) * C


def grid(problem):
    """Frequencies that hold the peaks of every problem: two decades to either side of 1/Ti."""
    low, high = 1e-2 / problem["best"]["Ti"], 1e2 / problem["best"]["Ti"]
    points = 300
    return [low * (high / low) ** (i / points) for i in range(points + 1)]


def of_each(test):
    """Runs a test on every problem, as a subtest of its name."""
    def run(self):
        for problem in PROBLEMS:
            with self.subTest(problem["name"]):
                test(self, problem)
    run.__doc__ = test.__doc__
    return run


class FileTest(unittest.TestCase):
    def test_there_are_problems_and_their_names_are_unique(self):
        names = [problem["name"] for problem in PROBLEMS]
        self.assertGreater(len(names), 150)
        self.assertEqual(len(set(names)), len(names))

    def test_no_problem_stands_there_twice_under_two_names(self):
        seen = {}
        for p in PROBLEMS:
            scaled = [[round(x / p["den"][0], 12) for x in a] for a in (p["num"], p["den"])]
            key = json.dumps([scaled, p["L"], p["structure"], p.get("Tf"), p["Ms"], p["Mt"]])
            self.assertNotIn(key, seen, p["name"])
            seen[key] = p["name"]

    def test_the_file_is_as_the_program_writes_it(self):
        self.assertEqual(library.FILE.read_text(encoding="utf-8"), library.text_of(LIBRARY))

    def test_the_page_has_the_table_of_the_file(self):
        text = table.PAGE.read_text(encoding="utf-8")
        self.assertEqual(text, table.page(text, LIBRARY))

    def test_every_family_has_an_origin_and_problems(self):
        used = {library.family_of(p["name"], LIBRARY["families"]) for p in PROBLEMS}
        self.assertEqual(used, set(LIBRARY["families"]))
        for family, about in LIBRARY["families"].items():
            self.assertTrue(about["origin"] and about["plants"], family)

    @of_each
    def test_a_name_ends_with_structure_and_limit(self, problem):
        self.assertEqual(problem["name"].split("/")[-2:], [problem["structure"], f"{problem['Ms']:g}"])
        self.assertIn(problem["structure"], library.STRUCTURES)
        self.assertEqual("Tf" in problem, problem["structure"] == "pid_fixed")


class ValuesTest(unittest.TestCase):
    @of_each
    def test_the_bound_is_not_above_the_best_known_IAE(self, problem):
        self.assertGreater(problem["lower"], 0)
        self.assertLessEqual(problem["lower"], problem["upper"])
        self.assertAlmostEqual(problem["gap"], (problem["upper"] - problem["lower"]) / problem["upper"], delta=ROUNDED)
        if problem["proved"] and "by" not in problem:
            self.assertAlmostEqual(problem["gap"], LIBRARY["gap"], delta=1e-8)

    @of_each
    def test_the_IAE_is_at_least_the_integral_of_the_error(self, problem):
        best = problem["best"]
        self.assertLessEqual(abs(best["Ti"] / best["Kp"]), problem["upper"] * (1 + library.MAX_LIMIT_EXCESS))

    @of_each
    def test_the_best_known_controller_has_the_structure_and_lies_in_the_root(self, problem):
        best, root = problem["best"], problem["root"]
        third = {"pi": None, "pid_tied": best["Td"], "pid_fixed": best["Kp"] * best["Td"]}[problem["structure"]]
        self.assertAlmostEqual(best["Tf"], library.filter_time(problem, best["Td"]), delta=ROUNDED * best["Ti"])
        gains = {"k": best["Kp"], "ki": best["Kp"] / best["Ti"]}
        if third is None:
            self.assertEqual(best["Td"], 0)
        else:
            self.assertGreater(best["Td"], 0)
            gains["Td" if problem["structure"] == "pid_tied" else "kd"] = third
        self.assertEqual(list(gains), list(root))
        sign = math.copysign(1, gains["ki"])
        for key, gain in gains.items():
            gain = gain if key == "Td" else sign * gain
            self.assertLessEqual(gain, root[key][1], key)
            if key != "ki":  # the bound covers smaller ki too, because the IAE is at least 1/ki
                self.assertGreaterEqual(gain, root[key][0], key)

    @of_each
    def test_the_limits_are_kept_at_every_frequency_of_a_grid(self, problem):
        for omega in grid(problem):
            loop = open_loop(problem, 1j * omega)
            self.assertLessEqual(1 / abs(1 + loop), problem["Ms"] * (1 + 2e-5), omega)
            self.assertLessEqual(abs(loop / (1 + loop)), problem["Mt"] * (1 + 2e-5), omega)


@unittest.skipUnless(BINARY, "no binary given")
class ReaderTest(unittest.TestCase):
    def test_the_service_reads_each_plant_as_its_num_den_and_L(self):
        for problem in {p["plant"]: p for p in PROBLEMS}.values():
            with self.subTest(problem["name"]):
                done = subprocess.run([BINARY, "plant", problem["plant"]], capture_output=True, text=True, timeout=300)
                self.assertEqual(done.returncode, 0, done.stderr)
                self.assertTrue(same_plant(problem, json.loads(done.stdout)["plant"]))

    def test_another_plant_is_noticed(self):
        problem = PROBLEMS[0]
        done = subprocess.run([BINARY, "plant", problem["plant"]], capture_output=True, text=True, timeout=300)
        wrong = {**problem, "den": [problem["den"][0] * 1.000001, *problem["den"][1:]]}
        self.assertFalse(same_plant(wrong, json.loads(done.stdout)["plant"]))


if __name__ == "__main__":
    unittest.main()
