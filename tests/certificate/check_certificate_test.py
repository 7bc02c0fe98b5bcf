#!/usr/bin/python3
"""The checker of certificates: what it accepts, and each forgery that it must refuse."""
import copy
import importlib.util
import json
import pathlib
import random
import subprocess
import sys
import tempfile
import unittest
from fractions import Fraction

ROOT = pathlib.Path(__file__).resolve().parents[2]
SPEC = importlib.util.spec_from_file_location("check_certificate", ROOT / "tools" / "check_certificate.py")
checker = importlib.util.module_from_spec(SPEC)
SPEC.loader.exec_module(checker)


def certificate(name):
    text = (ROOT / "tests" / "data" / "certificate" / f"{name}.jsonl").read_text(encoding="utf-8")
    return [json.loads(line) for line in text.splitlines()]


def check(lines):
    return checker.check([json.dumps(line) for line in lines])


NAMES = ("pi", "pid_fixed", "pid_tied")


def leaves_with(lines, reason):
    return [line for line in lines[1:] if line["reason"] == reason]


def first_with(lines, reason):
    return leaves_with(lines, reason)[0]


def changed(lines, *path, by):
    """Puts by(value) in place of the value that `path` leads to."""
    *way, last = path
    for key in way:
        lines = lines[key]
    lines[last] = by(lines[last])


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

    def refused(self, forge, names=NAMES, because=""):
        """`because`: a regular expression of the reason, so that the forgery is not refused for something else."""
        for name in names:
            with self.subTest(name):
                lines = copy.deepcopy(certificate(name))
                result = forge(lines)
                forged = lines if result is None else result
                self.assertNotEqual(forged, certificate(name))
                with self.assertRaisesRegex((checker.Refused, KeyError, TypeError, ValueError, IndexError, ArithmeticError),
                                            because):
                    check(forged)

    # ---- the claim

    def test_another_version(self):
        self.refused(lambda lines: lines[0].__setitem__("certificate", 2), because="version 1")
        self.refused(lambda lines: lines[0].__delitem__("certificate"))

    def test_a_goal_that_is_higher(self):
        self.refused(lambda lines: changed(lines, 0, "goal", by=lambda x: x * 1.0001))

    def test_a_goal_that_is_higher_and_a_root_to_match(self):
        def forge(lines):
            lines[0]["goal"] *= 1.02
            least = lines[0]["root"]["low"][1]
            for box in [lines[0]["root"], *lines[1:]]:
                for end in ("low", "high"):
                    if box[end][1] == least:
                        box[end][1] = least / 1.03
        self.refused(forge, because=r"leaf \d+")

    def test_a_digit_of_the_plant(self):
        self.refused(lambda lines: changed(lines, 0, "plant", "num", 0, by=lambda x: x * 0.95), because=r"leaf \d+")
        self.refused(lambda lines: changed(lines, 0, "plant", "den", 0, by=lambda x: x * 0.95), because=r"leaf \d+")

    def test_a_dead_time_that_is_shorter(self):
        self.refused(lambda lines: changed(lines, 0, "plant", "L", by=lambda x: x * 0.9), ("pi", "pid_tied"),
                     because=r"leaf \d+")

    def test_a_dead_time_that_is_negative(self):
        self.refused(lambda lines: lines[0]["plant"].__setitem__("L", -0.1), because="a time is negative")

    def test_limits_that_are_wider(self):
        for limit in ("Ms", "Mt"):
            self.refused(lambda lines, limit=limit: lines[0].__setitem__(limit, 1.6), because=r"leaf \d+")

    def test_a_limit_that_is_below_1(self):
        self.refused(lambda lines: lines[0].__setitem__("Mt", 0.5), because="out of range")

    def test_a_root_that_is_larger(self):
        for i in (0, 1):
            self.refused(lambda lines, i=i: changed(lines, 0, "root", "high", i, by=lambda x: x * 2), because="tile")

    def test_a_root_that_is_larger_and_its_leaves_too(self):
        def forge(lines):
            end = lines[0]["root"]["high"][0]
            for box in [lines[0]["root"], *lines[1:]]:
                box["high"][0] *= 2 if box["high"][0] == end else 1
        self.refused(forge, because=r"leaf \d+")

    def test_a_structure_that_is_another(self):
        self.refused(lambda lines: lines[0].__setitem__("structure", "pid_fixed"), ("pid_tied",), because=r"leaf \d+")
        self.refused(lambda lines: lines[0].__setitem__("structure", "pid_tied"), ("pid_fixed",), because=r"leaf \d+")
        self.refused(lambda lines: lines[0].__setitem__("structure", "p"), because="structure")

    def test_a_sign_function_that_is_another(self):
        for of in (lambda phi: changed(phi, "changes", by=lambda x: [0.2, *x]), lambda phi: changed(phi, "first", by=lambda x: -x)):
            def forge(lines, of=of):
                for phi in lines[0]["phis"]:
                    of(phi)
            self.refused(forge, because=r"leaf \d+ \(bound\)")

    def test_a_sign_function_of_size_2(self):
        self.refused(lambda lines: lines[0]["phis"][0].__setitem__("first", 2), because="sign function")

    def test_changes_that_do_not_ascend(self):
        self.refused(lambda lines: changed(lines, 0, "phis", 0, "changes", by=lambda x: x[::-1] if len(x) > 1 else [*x, x[0]]),
                     because="sign function")

    def test_harmonics_that_are_fewer(self):
        self.refused(lambda lines: lines[0].__setitem__("harmonics", 2), because=r"leaf \d+ \(bound\)")

    # ---- the boxes

    def test_a_box_that_is_a_little_narrower(self):
        for end, i, factor in (("high", 1, 0.9999), ("low", 0, 0.9999), ("high", 0, 1.0001)):
            self.refused(lambda lines, way=(5, end, i), f=factor: changed(lines, *way, by=lambda x: x * f or 1e-9),
                         because="tile|no width")

    def test_a_box_without_width(self):
        self.refused(lambda lines: lines[5].__setitem__("high", lines[5]["low"]), because="no width")

    def test_a_leaf_that_is_missing(self):
        def forge(lines):
            del lines[7]
            lines[0]["leaves"] -= 1
        self.refused(forge, because="tile")
        self.refused(lambda lines: lines[:-1], because="announces")

    def test_a_leaf_that_stands_twice(self):
        def forge(lines):
            lines.insert(7, lines[7])
            lines[0]["leaves"] += 1
        self.refused(forge, because="tile")

    def test_leaves_that_change_places(self):
        def forge(lines):
            lines[3], lines[-3] = lines[-3], lines[3]
        self.refused(forge, because="tile")

    # ---- the reasons

    def test_multipliers_that_are_too_large(self):
        def forge(lines):
            for leaf in lines[1:]:
                for cut in leaf.get("cuts", []):
                    cut["multiplier"] *= 1.5
        self.refused(forge, because=r"leaf \d+ \((bound|empty)\)")

    def test_a_multiplier_that_is_negative(self):
        def forge(lines):
            cut = next(leaf["cuts"][0] for leaf in lines[1:] if leaf.get("cuts"))
            cut["multiplier"] *= -1
        self.refused(forge, because="malformed")

    def test_cuts_that_are_left_out(self):
        def forge(lines):
            for leaf in lines[1:]:
                if "cuts" in leaf:
                    leaf["cuts"] = []
        self.refused(forge, because=r"leaf \d+ \((bound|empty)\)")

    def test_cuts_of_the_other_limit(self):
        def forge(lines):
            for leaf in lines[1:]:
                for cut in leaf.get("cuts", []):
                    cut["of"] = {"S": "T", "T": "S"}[cut["of"]]
        self.refused(forge, because=r"leaf \d+ \((bound|empty)\)")

    def test_a_sign_function_that_does_not_exist(self):
        for index in (99, -1, 0.5, "0"):
            self.refused(lambda lines, i=index: first_with(lines, "bound").__setitem__("phi", i), because="bound")

    def test_sign_functions_of_other_leaves(self):
        def forge(lines):
            count = len(lines[0]["phis"])
            for leaf in leaves_with(lines, "bound"):
                leaf["phi"] = (leaf["phi"] + 1) % count
        self.refused(forge, because=r"leaf \d+ \(bound\)")

    def test_reasons_that_change_places(self):
        def forge(lines):
            for leaf in lines[1:]:
                leaf["reason"] = {"sensitivity": "complementary", "complementary": "sensitivity"}.get(leaf["reason"], leaf["reason"])
        self.refused(forge, because=r"leaf \d+ \((sensitivity|complementary)\)")

    def test_a_reason_that_is_another(self):
        self.refused(lambda lines: first_with(lines, "bound").update(reason="sensitivity", omega=1.0), because="sensitivity")
        self.refused(lambda lines: first_with(lines, "bound").update(reason="empty"), because="empty")
        self.refused(lambda lines: first_with(lines, "bound").update(reason="error", s=[0.0, 0.0]), because="error")

    def test_a_reason_that_does_not_exist(self):
        self.refused(lambda lines: first_with(lines, "sensitivity").__setitem__("reason", "trust me"), because="trust me")

    def test_a_stable_box_that_is_called_unstable(self):
        def forge(lines):
            for leaf in leaves_with(lines, "bound"):
                leaf.update(reason="unstable", s=[lines[0]["w0"], lines[0]["w0"]])
        self.refused(forge, because="unstable")

    def test_a_pole_in_the_left_half_plane(self):
        self.refused(lambda lines: changed(first_with(lines, "unstable"), "s", 0, by=lambda x: -x), ("pi", "pid_fixed"),
                     because="unstable")

    def test_an_error_in_the_left_half_plane(self):
        self.refused(lambda lines: first_with(lines, "bound").update(reason="error", s=[-1.0, 0.5]), because="error")

    def test_a_frequency_that_is_negative_or_zero(self):
        for factor in (-1, 0):
            self.refused(lambda lines, f=factor: changed(first_with(lines, "sensitivity"), "omega", by=lambda x: f * x),
                         because="sensitivity")
            self.refused(lambda lines, f=factor: changed(next(leaf for leaf in lines[1:] if leaf.get("cuts")), "cuts", 0, "omega",
                                                         by=lambda x: f * x), because="malformed")

    # ---- the file

    def test_numbers_that_are_not_finite(self):
        for value in (float("nan"), float("inf"), float("-inf")):
            for forge in (lambda lines, x=value: lines[0].__setitem__("goal", x),
                          lambda lines, x=value: lines[0].__setitem__("upper", x),
                          lambda lines, x=value: lines[0]["root"]["low"].__setitem__(0, x),
                          lambda lines, x=value: lines[4]["high"].__setitem__(0, x),
                          lambda lines, x=value: first_with(lines, "sensitivity").__setitem__("omega", x)):
                self.refused(forge, because="not a finite number")

    def test_a_number_that_becomes_infinite_when_it_is_read(self):
        with self.assertRaises(checker.Refused):
            text = [json.dumps(line) for line in certificate("pi")]
            text[0] = text[0].replace('"goal": 5.11711893', '"goal": 1e999')
            checker.check(text)

    def test_numbers_that_are_words_or_true(self):
        for value in ("1.4", True, None, [1.4]):
            self.refused(lambda lines, x=value: lines[0].__setitem__("Ms", x), because="not a finite number")

    def test_an_empty_file(self):
        with self.assertRaises(ValueError):
            checker.check([])


class CommandTest(unittest.TestCase):
    def run_checker(self, *files):
        return subprocess.run([sys.executable, ROOT / "tools" / "check_certificate.py", *files], capture_output=True, text=True,
                              check=False)

    def test_a_refused_file_among_others_is_named_and_the_exit_code_is_1(self):
        good = ROOT / "tests" / "data" / "certificate" / "pi.jsonl"
        with tempfile.TemporaryDirectory() as folder:
            bad = pathlib.Path(folder) / "bad.jsonl"
            bad.write_text(good.read_text(encoding="utf-8").replace('"Ms":1.4', '"Ms":1.5'), encoding="utf-8")
            done = self.run_checker(good, bad, pathlib.Path(folder) / "missing.jsonl")
        self.assertEqual(done.returncode, 1, done.stderr)
        self.assertIn(f"{good}: 25 leaves hold", done.stdout)
        self.assertIn(f"{bad}: refused: leaf", done.stdout)
        self.assertIn("missing.jsonl: refused", done.stdout)
        self.assertIn("1 of 3 certificates hold.", done.stdout)
        self.assertEqual(self.run_checker(good).returncode, 0)


def exactly(m):
    return Fraction(m.real), Fraction(m.imag)


class ArithmeticTest(unittest.TestCase):
    def within(self, disc, exact):
        """`exact`: real and imaginary part as fractions."""
        (x, y), (re, im) = exactly(disc.m), exact
        self.assertLessEqual((x - re) ** 2 + (y - im) ** 2, Fraction(disc.r) ** 2)

    def test_discs_hold_the_exact_sums_products_and_quotients(self):
        source = random.Random(1)

        def number():
            return complex(source.uniform(-1, 1) * 10 ** source.uniform(-8, 8), source.uniform(-1, 1) * 10 ** source.uniform(-8, 8))
        for _ in range(2000):
            m, n = number(), number()
            (a, b), (c, d) = exactly(m), exactly(n)
            x, y = checker.Z(m), checker.Z(n)
            self.within(x + y, (a + c, b + d))
            self.within(x - y, (a - c, b - d))
            self.within(x * y, (a * c - b * d, a * d + b * c))
            self.within(x.inverse(), (a / (a * a + b * b), -b / (a * a + b * b)))
            for disc in (x + y, x * y, x.inverse()):
                self.assertLess(disc.r, 1e-14 * abs(disc.m) + 1e-140)
            self.assertLessEqual(Fraction(x.least()) ** 2, a * a + b * b)
            self.assertGreaterEqual(Fraction(x.most()) ** 2, a * a + b * b)

    def test_discs_hold_what_their_points_become(self):
        source = random.Random(2)

        def disc_and_point():
            m, r = complex(source.uniform(-1, 1), source.uniform(-1, 1)), source.uniform(0, 0.3)
            turn = complex(source.choice((-1, 1)), 0) if source.random() < 0.5 else complex(0.6, source.choice((-0.8, 0.8)))
            x, y = (Fraction(v) for v in (r * 0.999 * turn.real, r * 0.999 * turn.imag))
            return checker.Z(m, r), (Fraction(m.real) + x, Fraction(m.imag) + y)
        inverses = 0
        for _ in range(2000):
            (x, (a, b)), (y, (c, d)) = disc_and_point(), disc_and_point()
            self.within(x + y, (a + c, b + d))
            self.within(x * y, (a * c - b * d, a * d + b * c))
            inverse = x.inverse()
            if inverse.r < checker.HUGE:
                inverses += 1
                self.within(inverse, (a / (a * a + b * b), -b / (a * a + b * b)))
            value = sum(k * complex(float(a), float(b)) ** i for i, k in enumerate((-19, -27, 1.5, 5)))
            self.assertGreaterEqual(checker.top((-19, -27, 1.5, 5), x), abs(value) * (1 - 1e-12))
        self.assertGreater(inverses, 1000)

    def test_discs_that_are_not_finite_hold_everything(self):
        for disc in (checker.Z(1e200 + 0j) * checker.Z(1e200 + 0j), checker.Z(complex("nan"), float("nan")),
                     checker.Z(1e308 + 0j) + checker.Z(1e308 + 0j), checker.Z(0j).inverse(), checker.Z(0.5 + 0j, 1.0).inverse()):
            self.assertEqual(disc.r, checker.INF)
            self.assertEqual((disc.re().a, disc.re().b), (-checker.INF, checker.INF))
            self.assertEqual(checker.farthest([disc, checker.Z(1 + 0j)], 0.0), checker.INF)

    def test_terms_hold_the_loop_of_every_controller_of_the_box(self):
        """D in complex doubles, at the corners, the centre and random points of boxes, next to centre + sum d g + rest."""
        import cmath
        source = random.Random(3)
        for name in NAMES:
            lines = certificate(name)
            problem = checker.Problem(lines[0])
            for leaf in source.sample(lines[1:], min(20, len(lines) - 1)):
                box = checker.Box(problem, leaf)
                for _ in range(5):
                    s = complex(source.choice((0.0, 0.3)), problem.w0 * 10 ** source.uniform(-1, 1.5))
                    centre, g, rest = box.terms(problem.at(checker.I(s.real), checker.I(s.imag)))
                    den = sum(a * s ** i for i, a in enumerate(reversed(problem.den)))
                    num = sum(b * s ** i for i, b in enumerate(reversed(problem.num)))
                    for _ in range(5):
                        d = [source.choice((-1, 0, 1, source.uniform(-1, 1))) for _ in range(3)]
                        k, ki, third = ((a + b) / 2 + x * (b - a) / 2 for a, b, x in zip(leaf["low"], leaf["high"], d))
                        tied = name == "pid_tied"
                        x = s * (third / 10 if tied else problem.Tf)
                        law = s * k * (1 + s * third) + ki if tied else s * k + ki + s * s * third
                        loop = s * den / num * cmath.exp(s * problem.L) + law / (1 + x + x * x / 2)
                        away = abs(loop - centre.m - sum(x * y.m for x, y in zip(d, g)))
                        self.assertLessEqual(away, rest * (1 + 1e-9) + 1e-11 * (abs(loop) + sum(abs(y.m) for y in g)))

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
