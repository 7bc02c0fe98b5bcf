"""The code of a tuned controller: Structured Text, C and Python give the same u, and from rest it is that of the
sampled law."""

import itertools
import math
import random
import sys
import unittest

from languages import LANGUAGES, CProgram, code, ideal, result_of, run_python, run_structured_text

COLUMNS = ("setpoint", "measurement", "manual", "manual_output", "Kp", "Ti", "Td", "b", "at_rest", "restart")
SAMPLES = 10_000
INTEGRALS = ("backward", "forward", "trapezoidal")
# Each rule of the derivative with the filters that it allows.
DERIVATIVES = (("difference", "none"), ("difference", "measurement_second_order"), ("filtered_backward", "derivative"),
               ("filtered_forward", "derivative"), ("filtered_trapezoidal", "derivative"),
               ("slope", "measurement_first_order"), ("four_points", "measurement_second_order"))
FORMS = ({"anti_windup": "back_calculation"}, {"anti_windup": "clamping"}, {"form": "velocity"})


def rule_options(integral, derivative):
    options = {"sample_time": 0.5, "integral": integral, "derivative": derivative}
    return dict(options, slope_samples=4) if derivative == "slope" else options


def hard_rows(seed, count=SAMPLES, at_rest=False):
    """Noise, steps of the set point, manual phases, new settings, restarts; u is at its limits for much of the time."""
    chance = random.Random(seed)
    rows, settings = [], {"Kp": 1.7, "Ti": 8.0, "Td": 1.35, "b": 0.6}
    setpoint, level = 50.0, 50.0
    for k in range(count):
        if k % 170 == 0:
            setpoint = chance.uniform(20, 80)
        if k % 410 == 230:
            settings = {"Kp": chance.uniform(0.2, 4), "Ti": chance.choice([0.0, chance.uniform(1, 30)]),
                        "Td": chance.uniform(0, 3), "b": chance.uniform(0, 1)}
        level += 0.02 * (setpoint - level) + chance.gauss(0, 0.4)
        rows.append(dict(settings, setpoint=setpoint, measurement=level + chance.gauss(0, 0.3), manual=k // 130 % 7 == 3,
                         manual_output=30 + 60 * math.sin(k / 40), at_rest=at_rest, restart=k % 3100 == 3099))
    return rows


def law(controller, options, rows):
    """u of the law, computed directly, with all values 0 before the first row."""
    Ts, M = options["sample_time"], options.get("slope_samples", 1)
    Kp, b, c = controller["Kp"], controller["b"], controller["c"]
    Ki, Kd, Tf = Kp / controller["Ti"], Kp * controller["Td"], controller["filter"].get("Tf", 0)
    kind, rule = controller["filter"]["type"], options["derivative"]
    Tr = controller.get("setpoint_filter", {"T": 0})["T"]
    r_f = y_f = v = I = D = 0.0
    e, f, out = [0.0], [0.0] * max(M, 3), []
    for row in rows:
        r_f = (Tr * r_f + Ts * row["setpoint"]) / (Tr + Ts)
        r, y = r_f, row["measurement"]
        if kind == "measurement_first_order":
            y_f = (Tf * y_f + Ts * y) / (Tf + Ts)
        elif kind == "measurement_second_order":
            v = (v + 2 * Ts / Tf ** 2 * (y - y_f)) / (1 + 2 * Ts / Tf + 2 * (Ts / Tf) ** 2)
            y_f += Ts * v
        else:
            y_f = y
        e.append(r - y_f)
        f.append(c * r - y_f)
        I += Ki * Ts * {"backward": e[-1], "forward": e[-2], "trapezoidal": (e[-1] + e[-2]) / 2}[options["integral"]]
        step = f[-1] - f[-2]
        D = {"difference": lambda: Kd * step / Ts,
             "filtered_backward": lambda: (Tf * D + Kd * step) / (Tf + Ts),
             "filtered_forward": lambda: (1 - Ts / Tf) * D + Kd * step / Tf,
             "filtered_trapezoidal": lambda: ((2 * Tf - Ts) * D + 2 * Kd * step) / (2 * Tf + Ts),
             "slope": lambda: Kd * (f[-1] - f[-1 - M]) / (M * Ts),
             "four_points": lambda: Kd * (3 * f[-1] + f[-2] - f[-3] - 3 * f[-4]) / (10 * Ts)}[rule]()
        out.append(Kp * (b * r - y_f) + I + D)
    return out


def largest(a, b):
    """The largest difference of two lists of the same length, without NaN."""
    if len(a) != len(b) or not all(map(math.isfinite, a + b)):
        raise AssertionError("%d and %d values, or one that is not finite" % (len(a), len(b)))
    return max(abs(x - y) for x, y in zip(a, b))


class LanguagesTest(unittest.TestCase):
    def run_all(self, cases):
        """Each case is (controller, options, rows); yields the case with u in every language."""
        texts = [{language: code(result_of(controller), language, options) for language in LANGUAGES}
                 for controller, options, _ in cases]
        binary = CProgram([text["c"] for text in texts], COLUMNS)
        self.addCleanup(binary.folder.cleanup)
        for i, (case, text) in enumerate(zip(cases, texts)):
            rows = case[2]
            yield case, {"c": binary.run(i, rows), "python": run_python(text["python"], COLUMNS, rows),
                         "st": run_structured_text(text["st"], COLUMNS, rows)}

    def assert_same(self, cases):
        worst = 0
        for (controller, options, rows), u in self.run_all(cases):
            with self.subTest(controller=controller, options=options):
                worst = max(worst, largest(u["c"], u["python"]), largest(u["c"], u["st"]))
                self.assertLessEqual(worst, 1e-12)
                low, high = options.get("u_min", -math.inf), options.get("u_max", math.inf)
                self.assertTrue(all(low <= x <= high for x in u["c"]))
                # The rows are difficult: limits are reached and left.
                if "u_min" in options:
                    held = sum(x in (low, high) for x in u["c"])
                    self.assertTrue(50 < held < len(rows) - 50, held)
        return worst

    def test_every_rule_gives_the_same_u_in_all_languages(self):
        cases = []
        for (derivative, filter_), integral, form in itertools.product(DERIVATIVES, INTEGRALS, FORMS):
            options = dict(rule_options(integral, derivative), u_min=0, u_max=90, bias=40, **form)
            if len(cases) % 2:
                options["rate_limit"] = 12
            cases.append((ideal(filter_), options, hard_rows(len(cases), at_rest=len(cases) % 3 == 0)))
        worst = self.assert_same(cases)
        print("largest difference of u between languages, %d programs over %d samples: %g" %
              (len(cases), SAMPLES, worst), file=sys.stderr)

    def test_other_controllers_give_the_same_u_in_all_languages(self):
        limits = {"sample_time": 0.5, "u_min": 0, "u_max": 90, "bias": 40, "y0": 50}
        npid = {"form": "npid", "Kp": 1.7, "Ti": 8, "Td": 1.35, "delta_r": 6}
        controllers = [ideal("measurement_second_order", setpoint_filter={"T": 2.5}), ideal(Td=0), ideal(Ti=None),
                       ideal(Ti=None, Td=0), ideal(sign=-1), npid,
                       {"form": "parallel", "Kp": 0, "Ki": 0.4}, {"form": "parallel", "Kp": 2, "Ki": -0.1, "Kd": 0.5},
                       {"form": "series", "Kp": 1.2, "Ti": 8, "Td": 1, "filter": {"type": "derivative", "Tf": 0.2}}]
        cases = [(controller, limits, hard_rows(100 + i, 2000)) for i, controller in enumerate(controllers)]
        self.assert_same(cases)

    def test_from_rest_u_is_the_sampled_law(self):
        worst, cases = 0, []
        for (derivative, filter_), integral, form in itertools.product(DERIVATIVES, INTEGRALS, FORMS[::2]):
            chance = random.Random(len(cases))
            rows = [{"setpoint": 1.0 if k < 300 else -2.0, "measurement": chance.gauss(0, 1), "manual": False,
                     "manual_output": 0.0, "Kp": 1.7, "Ti": 8.0, "Td": 1.35, "b": 0.6, "at_rest": True, "restart": False}
                    for k in range(1000)]
            filtered = {"setpoint_filter": {"T": 2.5}} if integral == "trapezoidal" else {}
            cases.append((ideal(filter_, **filtered), dict(rule_options(integral, derivative), **form), rows))
        for (controller, options, rows), u in self.run_all(cases):
            with self.subTest(options=options):
                worst = max(worst, *(largest(u[language], law(controller, options, rows)) for language in LANGUAGES))
                self.assertLessEqual(worst, 1e-10)
        print("largest difference of u from the law, %d programs: %g" % (len(cases), worst), file=sys.stderr)

    def test_the_header_compiles_alone_and_with_optimisation(self):
        text = code(result_of(ideal("derivative")), "c", {"sample_time": 0.5})
        binary = CProgram([text], COLUMNS, sanitized=False)
        self.addCleanup(binary.folder.cleanup)
        for optimisation in ("-O0", "-O3"):
            binary.compile(["-x", "c", optimisation, "-fsyntax-only", "pid_0.h"])

    def test_two_programs_do_not_pass_for_one(self):
        texts = [code(result_of(ideal("derivative")), "c", {"sample_time": Ts}) for Ts in (0.5, 0.25)]
        binary = CProgram(texts, COLUMNS, sanitized=False)
        self.addCleanup(binary.folder.cleanup)
        for second, refused in (("pid_0.h", False), ("pid_1.h", True)):
            with open(binary.path("both.c"), "w") as file:
                file.write('#include "pid_0.h"\n#include "%s"\n' % second)
            with self.subTest(second=second):
                if refused:
                    with self.assertRaisesRegex(AssertionError, "Two programs of Tunewright"):
                        binary.compile(["-fsyntax-only", "-Wno-unused-function", "both.c"])
                else:
                    binary.compile(["-fsyntax-only", "-Wno-unused-function", "both.c"])


if __name__ == "__main__":
    unittest.main()
