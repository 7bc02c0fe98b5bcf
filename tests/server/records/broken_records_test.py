"""Records with faults: each is refused, or answered with a warning, which names the line or the reason."""

import json
import math
import random
import subprocess
import unittest

from service import BINARY

LENGTH, SPACING, STEP_AT = 300, 0.5, 40


def plant(u, spacing=SPACING, gain=2.0, lag=10.0, delay=6, start=20.0):
    """y of a first-order lag with a dead time of `delay` samples, from rest at the first u."""
    y, x = [], 0.0
    decay = math.exp(-spacing / lag)
    for k in range(len(u)):
        y.append(start + x)
        held = u[k - delay] if k >= delay else u[0]
        x = decay * x + gain * (1 - decay) * (held - u[0])
    return y


def step(size=1.0, at=STEP_AT, length=LENGTH, noise=0.005, seed=1):
    draw = random.Random(seed)
    u = [10.0 + (size if k >= at else 0.0) for k in range(length)]
    y = [value + draw.gauss(0, noise) for value in plant(u)]
    return [k * SPACING for k in range(length)], u, y


def relay(periods, hysteresis=0.3):
    u, y, x, level, switches = [], [], 0.0, 1.0, 0
    decay = math.exp(-0.01)
    while switches < 2 * periods and len(u) < 20000:
        if (level > 0 and x > hysteresis) or (level < 0 and x < -hysteresis):
            level, switches = -level, switches + 1
        u.append(level)
        y.append(x)
        delayed = u[len(u) - 21] if len(u) > 20 else 0.0
        x = decay * x + (1 - decay) * delayed
    return [0.1 * k for k in range(len(u))], u, y


def text(columns, heading="t,u,y", line="%.6g,%.6g,%.6g"):
    return heading + "\n" + "".join(line % row + "\n" for row in zip(*columns))


def lines(columns=None, **changed):
    """The lines of a good record with some of them (numbered from 1, the heading) replaced."""
    out = text(columns or step()).splitlines()
    for number, line in changed.items():
        out[int(number[1:]) - 1] = line
    return "\n".join(out) + "\n"


def with_y(change, columns=None):
    t, u, y = columns or step()
    return text((t, u, [change(k, value) for k, value in enumerate(y)]))


def request(**record):
    return json.dumps({"record": record})


T, U, Y = step()

# name: the file, arguments, and a text that the answer (an error's text, or a warning's code and text) must contain.
BROKEN = {
    "empty": ("", (), "csv is empty"),
    "header only": ("t,u,y\n", (), "csv has headings but no line of numbers"),
    "two rows": (text(([0, 1], [0, 1], [0, 1])), (), "2 usable samples"),
    "one column": ("y\n1\n2\n3\n", (), "No column is clearly u"),
    "text in the middle": (lines(L57="27.5,11,stuck"), (), 'Line 57, column "y": "stuck" is not a number'),
    "text for a time": (lines(L57="noon,11,20"), (), 'Line 57, column "t": "noon" is not a number'),
    "all NaN": (text((T, U, ["NaN"] * LENGTH), line="%.6g,%.6g,%s"), (), "0 usable samples in 300 rows"),
    "all blank": (text((T, [""] * LENGTH, [""] * LENGTH), line="%.6g,%s,%s"), (), "no complete sample"),
    "infinite": (lines(L57="27.5,11,inf"), (), 'Line 57, column "y": "inf" is not a number'),
    "1e300": (lines(L57="27.5,11,1e300"), (), "Line 57"),
    "beyond double": (lines(L57="27.5,11,1e999"), (), "Line 57"),
    "constant u": (text((T, [10.0] * LENGTH, Y)), (), "u never moves"),
    "u constant within noise": (
        text((T, [10 + 1e-3 * math.sin(77.7 * k * k) for k in range(LENGTH)],
              [20 + 0.01 * random.Random(k).gauss(0, 1) for k in range(LENGTH)])), (), "not respond"),
    "y constant": (text((T, U, [20.0] * LENGTH)), (), "y never moves"),
    "y does not respond": (
        text((T, U, [20 + 0.01 * random.Random(k).gauss(0, 1) for k in range(LENGTH)])), (), "not respond"),
    "all times equal": (text(([5.0] * LENGTH, U, Y)), (), "same time"),
    "time running backward": (text((T[::-1], U[::-1], Y[::-1])), (), "reversed-time"),
    "the same block twice": (text((T + T, U + U, Y + Y)), (), "lines 302 to 601"),
    "one row out of order": (lines(L57="3,11,20.5"), (), "misplaced-times"),
    "one time far ahead": (lines(L57="900,11,20.5"), (), "line 57"),
    "saturated y": (with_y(lambda k, v: min(v, 21.2), step(noise=0)), (), "saturated-output"),
    "saturated noisy y": (with_y(lambda k, v: min(v, 21.2), step(noise=0.02)), (), "saturated-output"),
    "spikes": (with_y(lambda k, v: v + (30 if k in (90, 171) else 0)), (), "line 92"),
    "a number that means none": (with_y(lambda k, v: -9999 if k % 40 == 7 else v), (), "removed-outliers"),
    "huge gap": (text(([t + (400 if k > 60 else 0) for k, t in enumerate(T)], U, Y)), (), "gaps"),
    "y missing for long": (with_y(lambda k, v: math.nan if 60 < k < 100 else v), (), "missing-samples"),
    "step in the last sample": (text(step(at=LENGTH - 1)), (), "the record does not contain the response"),
    "relay that never switched": (text(([0.1 * k for k in range(400)], [1.0] * 400, plant([0.0] + [1.0] * 399))), (),
                                  "u never moves"),
    "swapped u and y": (text((T, Y, U)), (), ""),
    "missing column named": (text((T, U, Y)), ("--y", "T7"), '"T7", which is not a heading'),
    "same column twice": (text((T, U, Y)), ("--u", "y", "--y", "y"), "the same column"),
    "unnamed columns alike": (
        text((T, Y, Y[::-1]), heading="time,A,B"), (), 'The headings are "time", "A" and "B"'),
    "decimal comma between commas": (
        "t,u,y\n" + "".join("%d,0,1,5,%d,25\n" % (k, k) for k in range(20)), (), "decimal comma"),
    "mixed separators": (lines(L57="27.5;11;20.5"), (), "Line 57"),
    "a cell too many": (lines(L57="27.5,11,20,5"), (), "Line 57 has 4 cells"),
    "one line a tag": ("TagName,DateTime,Value\nA,2026-11-21 10:00:00,1\nB,2026-11-21 10:00:00,2\n", (),
                       "\"A\" and \"B\""),
    "stamps without a unit of time": ("time,u,y\n2026-11-21 10:00:00,1,2\n2026-11-21 10:00:01,1,2\n",
                                      ("--time-unit", "shifts"), "must be a unit"),
    "y on two levels": (with_y(lambda k, v: 20.0 if v < 21 else 22.0), (), "coarse-quantisation"),
    "dt that is no number": (text((U, Y), "u,y", "%.6g,%.6g"), ("--dt", "fast"), "dt is"),
    "dt with t": (request(dt=1, t=T, u=U, y=Y), (), "dt and t are both given"),
    "unequal lengths": (request(dt=1, u=U, y=Y[:-1]), (), "they must have the same number"),
    "null in an array": (request(dt=1, u=U, y=Y[:-1] + [None]), (), "y[299] is null"),
    "text in an array": (request(dt=1, u=U, y=Y[:-1] + ["20"]), (), "y[299]"),
    "not JSON": ('{"record": {"dt": 1, "u": [0, NaN]}}', (), "JSON has no NaN"),
    "few samples": (text(tuple(c[::15] for c in step())), (), "few-samples"),
}


def identify(given, arguments):
    return subprocess.run([BINARY, "identify", "-", *arguments], input=given, capture_output=True, text=True, timeout=120)


class BrokenRecordsTest(unittest.TestCase):
    def test_each_is_refused_or_answered_with_a_warning_that_names_the_line_or_the_reason(self):
        for name, (given, arguments, expected) in BROKEN.items():
            with self.subTest(name):
                done = identify(given, arguments)
                self.assertIn(done.returncode, (0, 1), done.stderr)
                if done.returncode == 1:
                    problem = json.loads(done.stderr)
                    self.assertIn(problem["status"], (400, 422))
                    said = done.stderr.replace('\\"', '"')
                else:
                    model = json.loads(done.stdout)["model"]
                    self.assertTrue(model["warnings"], "a model without a warning")
                    said = json.dumps(model["warnings"]).replace('\\"', '"')
                self.assertIn(expected, said)

    def test_the_record_that_they_are_made_of_is_answered_without_a_warning(self):
        done = identify(text(step()), ())
        self.assertEqual(done.returncode, 0, done.stderr)
        model = json.loads(done.stdout)["model"]
        self.assertEqual(model["warnings"], [])
        self.assertEqual(model["data_quality"]["kind"], "step")
        self.assertAlmostEqual(model["plant"]["K"], 2, delta=0.02)

    def test_one_and_a_half_cycles_of_a_relay_are_counted(self):
        done = identify(text(relay(1.5)), ())
        self.assertEqual(done.returncode, 0, done.stderr)
        quality = json.loads(done.stdout)["model"]["data_quality"]
        self.assertEqual((quality["kind"], quality["cycles"]), ("relay", 1))

    def test_spikes_and_holes_cost_no_accuracy(self):
        for name in ("spikes", "a number that means none", "y missing for long", "time running backward"):
            model = json.loads(identify(BROKEN[name][0], ()).stdout)["model"]
            self.assertAlmostEqual(model["plant"]["K"], 2, delta=0.03, msg=name)


if __name__ == "__main__":
    unittest.main()
