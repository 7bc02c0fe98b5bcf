#!/usr/bin/python3
"""The checker of certificates: what it accepts, and each forgery that it must refuse."""
import copy
import importlib.util
import json
import pathlib
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
SPEC = importlib.util.spec_from_file_location("check_certificate", ROOT / "tools" / "check_certificate.py")
checker = importlib.util.module_from_spec(SPEC)
SPEC.loader.exec_module(checker)


def certificate(name):
    text = (ROOT / "tests" / "data" / "certificate" / f"{name}.jsonl").read_text(encoding="utf-8")
    return [json.loads(line) for line in text.splitlines()]


def check(lines):
    return checker.check([json.dumps(line) for line in lines])


def first_with(lines, reason):
    return next(line for line in lines[1:] if line["reason"] == reason)


class AcceptedTest(unittest.TestCase):
    def test_every_structure_and_every_reason_is_accepted(self):
        seen = set()
        for name in ("pi", "pid_tied", "pid_fixed"):
            with self.subTest(name):
                problem, reasons = check(certificate(name))
                self.assertEqual(problem.structure, name)
                seen |= set(reasons)
        self.assertEqual(seen, set(checker.REASONS))


class ForgedTest(unittest.TestCase):
    """Each forgery changes one thing of a certificate that holds."""

    def refused(self, forge, name="pi"):
        lines = copy.deepcopy(certificate(name))
        changed = forge(lines)
        lines = lines if changed is None else changed
        with self.assertRaises((checker.Refused, KeyError, TypeError, ValueError, IndexError)):
            check(lines)

    def test_a_digit_of_a_box(self):
        self.refused(lambda lines: lines[5]["high"].__setitem__(1, lines[5]["high"][1] * 1.0001))

    def test_a_digit_of_a_multiplier(self):
        def forge(lines):
            for leaf in lines[1:]:
                for cut in leaf.get("cuts", []):
                    cut["multiplier"] *= 1.5
        self.refused(forge)

    def test_a_negative_multiplier(self):
        def forge(lines):
            cut = next(leaf["cuts"][0] for leaf in lines[1:] if leaf.get("cuts"))
            cut["multiplier"] *= -1
        self.refused(forge)

    def test_a_change_of_a_sign_function(self):
        self.refused(lambda lines: [phi.__setitem__("changes", [0.2, *phi["changes"]]) for phi in lines[0]["phis"]] and lines)

    def test_a_goal_that_is_higher(self):
        self.refused(lambda lines: lines[0].__setitem__("goal", lines[0]["goal"] * 1.0001))

    def test_a_goal_that_is_higher_and_a_root_to_match(self):
        def forge(lines):
            lines[0]["goal"] *= 1.02
            least = lines[0]["root"]["low"][1]
            for box in [lines[0]["root"], *lines[1:]]:
                for end in ("low", "high"):
                    if box[end][1] == least:
                        box[end][1] = least / 1.03
        self.refused(forge)

    def test_a_digit_of_the_plant(self):
        self.refused(lambda lines: lines[0]["plant"]["num"].__setitem__(0, lines[0]["plant"]["num"][0] * 0.9))

    def test_a_dead_time_that_is_shorter(self):
        self.refused(lambda lines: lines[0]["plant"].__setitem__("L", lines[0]["plant"]["L"] * 0.9))

    def test_a_leaf_that_is_missing(self):
        def forge(lines):
            del lines[7]
            lines[0]["leaves"] -= 1
        self.refused(forge)

    def test_a_leaf_that_stands_twice(self):
        def forge(lines):
            lines.insert(7, lines[7])
            lines[0]["leaves"] += 1
        self.refused(forge)

    def test_a_last_line_that_is_cut_off(self):
        self.refused(lambda lines: lines[:-1])

    def test_a_reason_that_is_another(self):
        def forge(lines):
            leaf = first_with(lines, "bound")
            leaf.update(reason="sensitivity", omega=1.0)
        self.refused(forge)

    def test_a_reason_that_does_not_exist(self):
        self.refused(lambda lines: first_with(lines, "sensitivity").__setitem__("reason", "trust me"))

    def test_a_root_that_is_larger(self):
        self.refused(lambda lines: lines[0]["root"]["high"].__setitem__(0, lines[0]["root"]["high"][0] * 2))

    def test_a_limit_that_is_wider(self):
        self.refused(lambda lines: lines[0].__setitem__("Ms", 1.6))

    def test_a_stable_box_that_is_called_unstable(self):
        def forge(lines):
            leaf = first_with(lines, "bound")
            leaf.update(reason="unstable", s=first_with(lines, "unstable")["s"])
        self.refused(forge)

    def test_an_error_in_the_left_half_plane(self):
        def forge(lines):
            leaf = first_with(lines, "bound")
            leaf.update(reason="error", s=[-1.0, 0.5])
        self.refused(forge)

    def test_numbers_that_are_not_finite(self):
        self.refused(lambda lines: lines[0].__setitem__("goal", float("nan")))
        self.refused(lambda lines: first_with(lines, "sensitivity").__setitem__("omega", float("inf")))

    def test_a_structure_that_is_another(self):
        self.refused(lambda lines: lines[0].__setitem__("structure", "pid_fixed"), "pid_tied")


class ArithmeticTest(unittest.TestCase):
    def test_elementary_functions_enclose_the_library_and_are_narrow(self):
        import math
        for i in range(1, 400):
            x = (i - 200) * 1.37 ** (i % 40) * 1e-4
            cosine, sine = checker.cos_sin(checker.I(x))
            for interval, value in ((cosine, math.cos(x)), (sine, math.sin(x))):
                self.assertLessEqual(interval.a, math.nextafter(value, 2))
                self.assertGreaterEqual(interval.b, math.nextafter(value, -2))
                self.assertLess(interval.b - interval.a, 1e-14)
            y = x % 30 - 15
            grown = checker.exp(checker.I(y))
            self.assertLessEqual(grown.a, math.exp(y) * (1 + 1e-15))
            self.assertGreaterEqual(grown.b, math.exp(y) * (1 - 1e-15))
            self.assertLess(grown.b - grown.a, 1e-9 * math.exp(y))
        self.assertTrue(checker.PI.a <= math.pi <= checker.PI.b)


if __name__ == "__main__":
    unittest.main()
