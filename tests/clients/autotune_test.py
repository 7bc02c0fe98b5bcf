"""autotune: the test between any two functions, its ends, and the settings, with the real service."""

import contextlib
import io
import math
import pathlib
import random
import re
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest

from service import BINARY, ROOT, Service

CLIENT = ROOT / "api" / "clients" / "python"
sys.path.insert(0, str(CLIENT))
from tunewright import Client, Problem, TestStopped, autotune  # noqa: E402

U0, Y0, SAFE = 40.0, 20.0, 7.0
LIMITS = {"u_min": 0, "u_max": 100, "y_min": 0, "y_max": 60, "u_safe": SAFE}


class Plant:
    """K e^(-Ls)/(T s + 1) whose clock runs in sleep() alone, so that a test of ten minutes takes none."""

    def __init__(self, K=1.5, T=10.0, calls_late=5, Ts=0.5, noise=0.02):
        self.K, self.T, self.Ts, self.noise = K, T, Ts, noise
        self.y, self.line, self.u, self.time, self.chance = 0.0, [0.0] * calls_late, U0, 0.0, random.Random(1)
        self.written, self.before_read, self.before_write = [], lambda: None, lambda u: None

    def read(self):
        self.before_read()
        return Y0 + self.y + self.chance.gauss(0, self.noise)

    def write(self, u):
        self.before_write(u)
        self.written.append(u)
        self.u = u

    def clock(self):
        return self.time

    def sleep(self, seconds):
        self.time += seconds
        self.line.append(self.u - U0)
        fall = math.exp(-self.Ts / self.T)
        self.y = fall * self.y + self.K * (1 - fall) * self.line.pop(0)

    @property
    def tested(self):
        """True once u has moved."""
        return any(u != U0 for u in self.written)


class AutotuneTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.service = Service("--workers", "2")
        cls.addClassCleanup(lambda: (cls.service.stop(), cls.service.folder.cleanup()))
        cls.client = Client("http://127.0.0.1:%d" % cls.service.port, timeout=60)

    def tune(self, plant, **rest):
        given = dict(LIMITS, sample_time=plant.Ts, u_step=10, clock=plant.clock, sleep=plant.sleep, background=False,
                     show=None, client=self.client)
        return autotune(plant.read, plant.write, U0, **dict(given, **rest))

    def test_from_two_functions_to_settings(self):
        for experiment in ("relay", "bump"):
            plant, lines = Plant(), []
            tuned = self.tune(plant, experiment=experiment, product="siemens_pid_compact", show=lines.append,
                              settings={"y_span": [0, 100], "u_span": [0, 100]}, name="TIC-7")
            model = tuned.result["model"]["plant"]
            self.assertEqual(model["type"], "fopdt")
            for name, value in (("K", 1.5), ("T", 10), ("L", 2.5)):
                self.assertAlmostEqual(model[name], value, delta=0.04 * value)
            self.assertEqual(tuned.controller, tuned.result.best["controller"])
            self.assertEqual(tuned.result.job["name"], "TIC-7")
            self.assertIn("Gain", tuned.settings["as_typed"])
            self.assertEqual(plant.u, U0)
            self.assertEqual({len(tuned.record[name]) for name in "tuy"}, {len(tuned.record["t"])})
            self.assertRegex(lines[-1], r"^complete: fopdt \(K 1\.\d+ \+- [\d.]+, T .*\), fit 9\d\.\d %, grade \w+; Ms 1\.\d\d at worst")

    def test_u_goes_back_at_its_rate(self):
        for rest in ({"cycles": 3}, {"cycles": 25, "most_cost": 9}):
            plant = Plant(noise=0.001)
            self.tune(plant, rate_limit=4, **rest)
            self.assertEqual(plant.u, U0)
            moves = [abs(b - a) for a, b in zip(plant.written, plant.written[1:])]
            self.assertLessEqual(max(moves), 4 * plant.Ts + 1e-9)

    def test_it_ends_early_when_the_design_is_good_enough(self):
        plant = Plant(noise=0.001)
        tuned = self.tune(plant, cycles=25)
        self.assertEqual(tuned.ended, "the design is good enough")
        self.assertTrue(tuned.enough and not tuned.missing)
        self.assertEqual(plant.u, U0)
        self.assertLess(len(tuned.record["t"]), 25 * 22)
        again = self.tune(Plant(noise=0.001), cycles=4, most_cost=0)
        self.assertEqual(again.ended, "complete: the number of cycles is reached")
        self.assertFalse(again.enough)

    def test_a_record_that_is_not_enough_says_what_is_missing(self):
        tuned = self.tune(Plant(noise=2), cycles=1)
        self.assertFalse(tuned.enough)
        self.assertTrue(tuned.missing)
        found = [each["detail"] for each in tuned.result["model"]["warnings"] + tuned.result.best.get("warnings", [])]
        found += [each["text"] for each in tuned.result.best["verdict"]]
        for sentence in tuned.missing:
            self.assertIn(sentence, found)

    def stopped(self, plant, reason, **rest):
        with self.assertRaises(TestStopped) as caught:
            self.tune(plant, **rest)
        self.assertEqual(caught.exception.reason, reason)
        self.assertEqual(plant.u, SAFE)
        return caught.exception

    def test_every_fault_ends_in_the_safe_value(self):
        def lost():
            raise ConnectionError("no route to host")

        def once_moved(plant, act):
            plant.before_read = lambda: act() if plant.tested else None

        plant = Plant()
        once_moved(plant, lost)
        self.assertGreater(len(self.stopped(plant, 10).record["t"]), 25)
        plant = Plant()
        read = plant.read
        plant.read = lambda: (read(), not plant.tested)
        self.stopped(plant, 10)
        plant = Plant()
        plant.read = lambda: float("nan") if plant.tested else Y0
        self.stopped(plant, 10)
        plant = Plant(K=8)
        self.stopped(plant, 13)
        plant = Plant()
        once_moved(plant, lambda: setattr(plant, "time", plant.time + 60))
        self.stopped(plant, 15)
        plant = Plant()
        write = plant.write
        plant.write = lambda u: (write(u), U0 + 1.5 if plant.tested and plant.u != SAFE else u)[1]  # it stays in manual
        self.stopped(plant, 14)
        plant = Plant()
        write = plant.write
        plant.write = lambda u: (write(u), U0)[1]  # and takes no safe value either
        with self.assertRaisesRegex(TestStopped, "could NOT be set to its safe value 7: the actuator reads back 40"):
            self.tune(plant)
        plant = Plant()
        plant.read = lambda: unknown_name if plant.tested else Y0  # noqa: F821
        stopped = self.stopped(plant, 10)
        self.assertIn("NameError", str(stopped))
        self.assertIsInstance(stopped.__cause__, NameError)
        plant = Plant()
        plant.read = lambda: "warm" if plant.tested else Y0
        self.assertIn("ValueError", str(self.stopped(plant, 10)))
        plant = Plant()
        plant.read = lambda: Y0
        self.stopped(plant, 17, max_time=200)

    def test_a_connection_that_is_lost_while_writing_is_tried_again_for_the_safe_value(self):
        plant, left = Plant(), [2]

        def fails(u):
            if plant.tested and left[0] > 0:
                left[0] -= 1
                raise ConnectionError("lost")

        plant.before_write = fails
        self.assertIn("lost", str(self.stopped(plant, 0)))
        plant = Plant()
        plant.before_write = lambda u: fails_for_good(u)

        def fails_for_good(u):
            if plant.tested:
                raise ConnectionError("gone")

        with self.assertRaisesRegex(TestStopped, "could NOT be set to its safe value 7: gone. Set it by hand now."):
            self.tune(plant)

    def test_an_interrupt_ends_in_the_safe_value(self):
        for end in (KeyboardInterrupt, SystemExit):
            plant = Plant()

            def stop(plant=plant, end=end):
                if plant.tested:
                    raise end

            plant.before_read = stop
            with self.assertRaises(end) as caught:
                self.tune(plant)
            self.assertEqual(plant.u, SAFE)
            self.assertGreater(len(caught.exception.record["t"]), 25)

    def test_a_program_that_is_ended_in_real_time_leaves_the_safe_value(self):
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            self.ended_by(number)

    def ended_by(self, number):
        with tempfile.TemporaryDirectory() as name:
            script = pathlib.Path(name, "loop.py")
            script.write_text(LOOP % (str(CLIENT), name, name, name, self.client.base_url))
            child = subprocess.Popen([sys.executable, str(script)], stderr=subprocess.DEVNULL,
                                     preexec_fn=lambda: signal.signal(signal.SIGINT, signal.default_int_handler))
            told = pathlib.Path(name, "u")
            until = time.monotonic() + 30
            while time.monotonic() < until and not (told.exists() and told.read_text() not in ("", "40.0")):
                time.sleep(0.02)
            child.send_signal(number)
            child.wait(20)
            self.assertEqual(told.read_text(), "7.0")

    def test_what_is_not_valid_is_refused_before_anything_moves(self):
        plant = Plant()
        with self.assertRaises(Problem) as caught:
            self.tune(plant, y_max=-5)
        self.assertEqual(caught.exception.errors[0].pointer, "/y_max")
        for wrong in ({"colour": "red"}, {"Ms": 0.9}, {"tune": [{"method": "robst"}]}, {"product": "simens"}):
            with self.assertRaises(Problem):
                self.tune(plant, **wrong)
        with self.assertRaisesRegex(ValueError, "u is 40: the test cannot begin"):
            self.tune(plant, u_max=40)
        self.assertEqual(plant.written, [])

    def test_each_row_is_kept_as_it_comes(self):
        with tempfile.TemporaryDirectory() as folder:
            kept = pathlib.Path(folder, "record.csv")
            plant = Plant()
            plant.before_read = lambda: (_ for _ in ()).throw(ConnectionError()) if plant.tested and plant.time > 60 else None
            rows = len(self.stopped(plant, 10, keep=str(kept)).record["t"])
            lines = kept.read_text().splitlines()
            self.assertEqual((lines[0], len(lines) - 1), ("t,u,y", rows))

    def test_the_service_may_be_away_during_the_test(self):
        service = Service("--workers", "1")
        self.addCleanup(lambda: (service.stop(), service.folder.cleanup()))
        again = [BINARY, "serve", "--listen", "127.0.0.1:%d" % service.port, "--store", service.store]
        service.command = lambda: again
        plant, kills = Plant(), []
        client = Client("http://127.0.0.1:%d" % service.port, timeout=60)

        def away():
            if len(kills) < 3 and plant.time > 20 + 8 * len(kills):
                for earlier in kills:
                    earlier.join()
                service.kill()
                kills.append(threading.Timer(0.5, service.start))
                kills[-1].start()

        plant.before_read = away
        tuned = self.tune(plant, client=client)
        self.assertEqual(len(kills), 3)
        self.assertAlmostEqual(tuned.result["model"]["plant"]["K"], 1.5, delta=0.06)

    def test_a_service_that_stays_away_leaves_the_record(self):
        service = Service("--workers", "1")
        self.addCleanup(lambda: (service.stop(), service.folder.cleanup()))
        plant, client = Plant(), Client("http://127.0.0.1:%d" % service.port, timeout=2)
        plant.before_read = lambda: service.kill() if plant.tested and service.process.poll() is None else None
        with self.assertRaises(OSError) as caught:
            self.tune(plant, client=client, cycles=1)
        self.assertGreater(len(caught.exception.record["t"]), 40)
        self.assertEqual(plant.u, U0)

    def test_its_programs_are_those_of_the_command(self):
        for kind in ("relay", "bump"):
            made = subprocess.run([BINARY, "code", "--experiment", kind, "--language", "python", "--sample-time", "1",
                                   "--u-step", "1"], capture_output=True, text=True, check=True).stdout
            kept = (CLIENT / "tunewright" / (kind + "_program.py")).read_text().removeprefix("# mypy: ignore-errors\n")
            self.assertEqual(*(re.sub(r"Tunewright \d+\.\d+\.\d+", "Tunewright", text) for text in (made, kept)))

    def test_the_example_of_a_lab_kit_runs_from_nothing_to_settings(self):
        sys.path.insert(0, str(CLIENT / "examples"))
        import simulated
        said = io.StringIO()
        with contextlib.redirect_stdout(said):
            simulated.main(self.client.base_url)
        self.assertRegex(said.getvalue().splitlines()[-1], r"^\{'Kp': \d+\.\d+, 'Ti': \d+\.\d+, 'Td': \d+\.\d+\} enough: True$")


LOOP = """
import sys
sys.path.insert(0, %r)
from tunewright import Client, autotune
y = [20.0]
def write(u):
    open("%s/u.new", "w").write(str(float(u)))
    __import__("os").replace("%s/u.new", "%s/u")
autotune(lambda: y[0], write, 40, sample_time=0.02, u_step=10, u_safe=7, max_time=60, client=Client(%r))
"""

if __name__ == "__main__":
    unittest.main()
