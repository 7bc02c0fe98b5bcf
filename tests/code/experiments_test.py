"""Tests that controllers run by themselves: the same u in all languages to the last bit, sketches that compile, a record
that `identify` reads without an option, and refusals."""

import json
import math
import pathlib
import random
import shutil
import subprocess
import tempfile
import unittest

from languages import BINARY, WARNINGS
from structures import in_c, in_python, in_structured_text

SAMPLES = 10_000
LANGUAGES = ("st", "c", "python", "arduino")
OPTIONS = {"sample_time": 0.5, "u_step": 10, "u_min": 0, "u_max": 100, "y_min": 0, "y_max": 60, "u_safe": 7}
SKETCH = dict(OPTIONS, y_max=90, u_safe=50)  # its placeholder of the controller
INPUTS = ("measurement", "u_controller", "start", "measurement_ok", "now", "u_actual")
FLAGS = ("start", "measurement_ok")
OUTPUTS = ("u", "mode", "reason", "recording")
AVR = shutil.which("avr-g++")


def command(*arguments):
    return subprocess.run([BINARY, "code", *arguments], capture_output=True, text=True, timeout=60)


def text_of(kind, language, options):
    words = [word for name, value in options.items() for word in ("--" + name.replace("_", "-"), str(value))]
    done = command("--experiment", kind, "--language", language, *words)
    if done.returncode != 0:
        raise AssertionError(done.stderr)
    return done.stdout


def program_of(text):
    space = {}
    exec(compile(text, "experiment", "exec"), space)
    return next(space[name] for name in space if name.startswith("Tunewright"))()


class Lag:
    """K e^(-Ls)/(T s + 1), u held from call to call; the dead time in calls."""

    def __init__(self, K=1.0, T=10.0, late=4, Ts=0.5):
        self.K, self.fall, self.y, self.line = K, math.exp(-Ts / T), 0.0, [0.0] * late

    def advance(self, u):
        self.line.append(u)
        self.y = self.fall * self.y + self.K * (1 - self.fall) * self.line.pop(0)


def hard_rows(program, seed):
    """Tests one after the other on a noisy plant, with faults of every kind, stops and losses of the clock between them."""
    chance, plant, rows, now = random.Random(seed), Lag(K=chance_gain(seed)), [], 0.0
    start, idle, frozen = 0, 3, None
    for k in range(SAMPLES):
        if idle > 0:
            idle -= 1
        start = 1 if idle == 0 else 0
        now += program.Ts
        y = 20 + plant.y + chance.gauss(0, 0.1)
        ok, u_actual, u_controller = 1, 1e30, 40.0
        fault = chance.random()
        if fault < 0.0015:
            ok = 0
        elif fault < 0.003:
            y = math.nan
        elif fault < 0.0045:
            y = 80.0
        elif fault < 0.006:
            now += 50
        elif fault < 0.0075:
            u_actual = -3.0
        elif fault < 0.009:
            idle = 2
        elif fault < 0.0105:
            frozen = (k + 60, y)
        if frozen and k < frozen[0]:
            y = frozen[1]
        row = [y, u_controller, start, ok, now, u_actual]
        u, mode, _, _ = program.step(**{n: bool(x) if n in FLAGS else x for n, x in zip(INPUTS, row)})
        if mode >= 4 and chance.random() < 0.1:
            idle = 5
        plant.advance(u - 40 + (0.5 if k % 2000 > 1000 else 0))
        rows.append(row)
    return rows


def chance_gain(seed):
    return 1.0 if seed % 2 else -2.0


class ExperimentsTest(unittest.TestCase):
    def test_every_language_gives_the_same_bits(self):
        for seed, (kind, extra) in enumerate((("relay", {}), ("relay", {"action": "reverse", "rate_limit": 8}),
                                              ("bump", {}), ("bump", {"y_move": 6, "u_step": -8}))):
            options = dict(OPTIONS, **extra)
            texts = {language: text_of(kind, language, options) for language in LANGUAGES}
            rows = hard_rows(program_of(texts["python"]), seed)
            case = {"name": kind, "inputs": INPUTS, "outputs": OUTPUTS, "flags": FLAGS, "rows": rows, "texts": texts}
            python = list(in_python(case))
            reasons = {reason for _, _, reason, _ in python}
            self.assertGreater(len(reasons), 6, "the rows are hard: %s" % reasons)
            with tempfile.TemporaryDirectory() as folder:
                self.assertEqual(in_c(case, pathlib.Path(folder)), python, (kind, extra, "c"))
            self.assertEqual(list(in_structured_text(case)), python, (kind, extra, "st"))

    def test_identify_reads_the_rows_without_an_option(self):
        for kind, late in (("relay", 4), ("bump", 4)):
            program, plant, chance = program_of(text_of(kind, "python", OPTIONS)), Lag(K=1.6, late=late), random.Random(7)
            rows = ["t,u,y"]
            program.step(20.0, 40.0, False)
            for _ in range(6000):
                u, mode, reason, recording = program.step(20 + plant.y + chance.gauss(0, 0.03), 40.0, True)
                plant.advance(u - 40)
                if recording:
                    rows.append(program.row())
                if mode >= 4:
                    break
            self.assertEqual(reason, 1)
            done = subprocess.run([BINARY, "identify", "-"], input="\n".join(rows) + "\n", capture_output=True, text=True)
            self.assertEqual(done.returncode, 0, done.stderr)
            model = json.loads(done.stdout)["model"]["plant"]
            self.assertEqual(model["type"], "fopdt")
            for name, value in (("K", 1.6), ("T", 10.0), ("L", 2.0)):
                self.assertAlmostEqual(model[name], value, delta=0.05 * value, msg=kind)

    def test_a_sketch_compiles_and_runs_as_cpp11(self):
        for kind in ("relay", "bump"):
            with tempfile.TemporaryDirectory() as name:
                folder = pathlib.Path(name)
                (folder / "Arduino.h").write_text(ARDUINO)
                (folder / "sketch.cpp").write_text('#include "Arduino.h"\n' + text_of(kind, "arduino", SKETCH))
                (folder / "main.cpp").write_text('#include "sketch.cpp"\n' + MAIN)
                warnings = [flag for flag in WARNINGS if not flag.startswith("-std")]
                subprocess.run(["g++", "-std=c++11", *warnings, "-Wno-unused-function", "-I.", "main.cpp", "-o", "main"],
                               cwd=folder, check=True)
                done = subprocess.run([folder / "main"], capture_output=True, text=True, check=True, timeout=60)
                head, *rows, end = done.stdout.splitlines()
                self.assertEqual((head, end), ("t,u,y", "# complete: the response is steady"))
                self.assertGreater(len(rows), 60)
                self.assertRegex(rows[-1], r"^\d+\.\d{6},-?\d+\.\d{6},-?\d+\.\d{6}$")
                done = subprocess.run([BINARY, "identify", "-"], input=done.stdout, capture_output=True, text=True)
                self.assertEqual(done.returncode, 0, done.stderr)
                model = json.loads(done.stdout)["model"]
                self.assertEqual(model["data_quality"]["kind"], {"relay": "relay", "bump": "several_steps"}[kind])
                self.assertGreater(model["fit_percent"], 90)

    @unittest.skipUnless(AVR, "gcc-avr is not installed; script/bootstrap peers installs it")
    def test_a_sketch_compiles_for_an_8_bit_board(self):
        for kind in ("relay", "bump"):
            with tempfile.TemporaryDirectory() as name:
                folder = pathlib.Path(name)
                (folder / "Arduino.h").write_text(STUB)
                (folder / "sketch.cpp").write_text('#include "Arduino.h"\n' + text_of(kind, "arduino", SKETCH))
                subprocess.run([AVR, "-mmcu=atmega328p", "-std=c++11", "-Os", "-Wall", "-c", "-I.", "sketch.cpp"],
                               cwd=folder, check=True)

    def test_a_controller_as_a_sketch_compiles_too(self):
        result = {"controllers": [{"method": "test", "controller": {"form": "ideal", "Kp": 1.7, "Ti": 8, "Td": 1.3}}]}
        done = subprocess.run([BINARY, "code", "-", "--language", "arduino", "--sample-time", "0.5"],
                              input=json.dumps(result), capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            (folder / "Arduino.h").write_text(ARDUINO)
            (folder / "sketch.cpp").write_text('#include "Arduino.h"\n' + done.stdout)
            subprocess.run(["g++", "-std=c++11", "-Wall", "-Wextra", "-Werror", "-Wno-unused-function", "-c", "-I.",
                            "sketch.cpp"], cwd=folder, check=True)

    def test_what_is_wrong_is_named_with_its_cure(self):
        whole = ["--experiment", "relay", "--language", "c", "--sample-time", "1", "--u-step", "5"]
        for words, wanted in ((["--experiment", "relay", "--language", "c"], "sample_time is missing"),
                              ([*whole[:4], "--sample-time", "1"], "u_step is missing"),
                              ([*whole, "--u-safe", "7", "--u-max", "5"], "u_safe is 7"),
                              ([*whole, "--y-min", "5", "--y-max", "2"], "y_max must be > y_min"),
                              ([*whole, "--action", "backward"], "action"),
                              ([*whole, "--cycles", "1.5"], "cycles"),
                              ([*whole, "--y0", "3"], "y0"),
                              ([*whole, "--y-move", "3"], "y_move belongs to a bump"),
                              (["--experiment", "bump", *whole[2:], "--cycles", "3"], "cycles belongs to a relay test"),
                              (["--experiment", "ramp", *whole[2:]], "relay or bump"),
                              (["--language", "c"], "--experiment relay or bump")):
            done = command(*words)
            self.assertNotEqual(done.returncode, 0, words)
            self.assertIn(wanted, done.stderr, words)


STUB = """
#define A0 0
void pinMode(int, int);
int analogRead(int);
void analogWrite(int, int);
unsigned long millis();
struct Line {
    void begin(long);
    int available();
    int read();
    void print(double, int);
    void print(const char *);
    void print(char);
    void println(double, int);
    void println(const char *);
};
extern Line Serial;
"""
ARDUINO = "#include <cstdio>\n" + STUB
# A board whose hardware is a plant: y from 0 to 100 % at the analogue pin, u from the written pin.
MAIN = """
#include <cmath>
#include <cstdio>
Line Serial;
static double y = 0, u = 50, line[4] = {50, 50, 50, 50};
static int at = 0, asked = 0;
static unsigned long ms = 0;
static bool ended = false;
int analogRead(int) { return (int)(std::floor((50 + y) * 10.23 + 0.5)); }
void analogWrite(int, int value) { u = value * 100.0 / 255.0; }
unsigned long millis() { return ms; }
void Line::begin(long) {}
int Line::available() { return asked++ == 20 ? 1 : 0; }
int Line::read() { return 's'; }
void Line::print(double x, int n) { std::printf("%.*f", n, x); }
void Line::print(const char *text) { std::printf("%s", text); }
void Line::print(char c) { std::printf("%c", c); }
void Line::println(double x, int n) { std::printf("%.*f\\n", n, x); }
void Line::println(const char *text) { std::printf("%s\\n", text); ended = text[0] != 't'; }
int main()
{
    setup();
    for (long i = 0; i < 1000000 && !ended; ++i) {
        loop();
        if (ms % 500 == 0) {
            const double late = line[at];
            line[at] = u;
            at = (at + 1) % 4;
            y = std::exp(-0.05) * y + (1 - std::exp(-0.05)) * (late - 50);
        }
        ms += 100;
    }
    return ended ? 0 : 1;
}
"""

if __name__ == "__main__":
    unittest.main()
