"""The code of a schedule: the three languages interpolate its rows in the same way, and the head comment names the
scheduling variable."""

import json
import math
import random
import unittest

from languages import CProgram, code, command, ideal, result_of, run_python, run_structured_text
from structured_text import FunctionBlock

COLUMNS = ("setpoint", "measurement", "scheduling", "manual", "manual_output")


def answer(interpolation="linear_in_gains", Tf=0.0, **members):
    rows = [{"at": at, "Kp": Kp, "Ti": Ti, "Td": Td, "Tf": Tf, "b": b}
            for at, Kp, Ti, Td, b in ((20, -0.8, 9, 1.5, 1), (40, -1.6, 5, 0.5, 0.6), (90, -3, 4, 0, 0))]
    schedule = {"interpolation": interpolation, "hysteresis": 4 if interpolation == "steps" else 0, "rows": rows}
    worst = {"schedule": [{"quantity": "Ms", "at": 35, "value": 1.398, "limit": 1.4}]}
    scheduling = {"name": "level", "unit": "cm", "from": 20, "to": 90}
    return dict({"range": {"scheduling": scheduling, "schedule": schedule, "worst": worst}}, **members)


def passing_rows(count=4000):
    chance = random.Random(11)
    level, rows = 50.0, []
    for k in range(count):
        level += chance.gauss(0, 0.5)
        rows.append({"setpoint": 45.0 + 20 * (k // 300 % 2), "measurement": 50 + 5 * math.sin(k / 60) + chance.gauss(0, 0.3),
                     "scheduling": 55 + 50 * math.sin(0.013 * k) + chance.gauss(0, 1), "manual": k // 130 % 7 == 3,
                     "manual_output": 40.0})
    return rows


class ScheduleTest(unittest.TestCase):
    def test_the_languages_follow_the_rows_alike(self):
        cases = [answer(how, Tf) for how in ("steps", "linear_in_gains", "linear_in_times") for Tf in (0, 0.4)]
        options = {"sample_time": 0.5, "u_min": 0, "u_max": 100}
        rows = passing_rows()
        program = CProgram([code(case, "c", options) for case in cases], COLUMNS)
        for i, case in enumerate(cases):
            expected = run_python(code(case, "python", options), COLUMNS, rows)
            self.assertGreater(max(expected) - min(expected), 20)
            self.assertTrue(all(map(math.isfinite, expected)))
            for u in (program.run(i, rows), run_structured_text(code(case, "st", options), COLUMNS, rows)):
                self.assertLessEqual(max(abs(a - b) for a, b in zip(u, expected, strict=True)), 1e-12)

    def test_times_become_seconds_and_the_head_says_what_is_followed(self):
        text = code(answer(units={"time": "min"}), "st", {"sample_time": 0.01})
        self.assertIn("level from 20 to 90 cm", text)
        self.assertIn("Largest Ms    1.398 at 35", text)
        self.assertIn("at 40 Kp 1.6, Ti 300, Td 30", text.replace("\n  ", " "))
        self.assertIn("scheduling := PLACE", text)
        block = FunctionBlock(text)
        block.call(setpoint=1.0, measurement=0.0, scheduling=30.0, manual=False, manual_output=0.0)
        self.assertAlmostEqual(block["Ti"], 60 / (0.5 / 9 + 0.5 / 5), 9)
        self.assertEqual(block["Ts"], 0.6)

    def test_names_of_the_variable_stay_within_the_comment(self):
        for name, unit in (("a */ int injected(void){return 1;} /*", "%"), ("load\nraise SystemExit#", "*)"),
                           ("(* load", "\n+"), ("load // \\", "??/")):
            case = answer()
            case["range"]["scheduling"].update(name=name, unit=unit)
            rows, options = passing_rows(20), {"sample_time": 0.5}
            expected = run_python(code(case, "python", options), COLUMNS, rows)
            c_text = code(case, "c", options)
            self.assertEqual(CProgram([c_text], COLUMNS).run(0, rows), expected)
            self.assertEqual(c_text.count("*/"), code(answer(), "c", options).count("*/"))
            self.assertEqual(len(run_structured_text(code(case, "st", options), COLUMNS, rows)), len(rows))

    def test_what_is_no_schedule_is_told(self):
        def told(result, *arguments):
            done = command(result, "--language", "c", "--sample-time", "1", *arguments)
            self.assertEqual((done.returncode, done.stdout), (1, ""))
            return json.loads(done.stderr)

        nothing = answer()
        nothing["range"]["schedule"] = None
        self.assertEqual(told(nothing)["status"], 404)
        self.assertIn("position", told(answer(), "--form", "velocity")["detail"])
        odd = answer()
        odd["range"]["schedule"]["rows"][1]["Kp"] = 1
        self.assertIn("changes its sign", told(odd)["detail"])
        odd["range"]["schedule"]["rows"] = [1, {}]
        self.assertEqual(told(odd)["status"], 404)
        self.assertIn("interpolation", told(answer("cubic"))["detail"])
        self.assertTrue(code(result_of(ideal()), "c", {"sample_time": 1}))


if __name__ == "__main__":
    unittest.main()
