"""The Python client with the real service: every call, its errors, and its handling of abandoned jobs."""

import json
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import time
import unittest

from access_test import make_key
from service import FOPDT, LONG, QUICK, ROOT, Service

sys.path.insert(0, str(ROOT / "api" / "clients" / "python"))
import tunewright  # noqa: E402

# SIMC on K e^(-L s)/(T s + 1) with tau_c = L: Kp = T/(2 K L), Ti = min(T, 8 L).
SIMC_KP, SIMC_TI = 10 / (2 * 2 * 3), 10


def step_csv():
    """The exact step response of a first-order plant with dead time: a record with a known model."""
    times = [0.5 * i for i in range(121)]
    rows = ["%g,1,%.9f" % (t, 0 if t < 3 else 2 * (1 - 2.718281828459045 ** (-(t - 3) / 10))) for t in times]
    return "\n".join(["t,u,y", "-1,0,0", "-0.5,0,0", *rows]) + "\n"


class Frame:
    """The part of a pandas DataFrame that the client uses."""

    class RangeIndex:
        name = None

    class DatetimeIndex:
        name = None

    def __init__(self, text, index):
        self.index, self.asked, self.text = index, None, text

    def to_csv(self, index, index_label):
        self.asked = (index, index_label)
        return self.text


class Array:
    def __init__(self, values):
        self.values = values

    def tolist(self):
        return self.values


class ClientTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.service = Service("--workers", "2")
        cls.url = "http://127.0.0.1:%d" % cls.service.port
        cls.client = tunewright.Client(cls.url, timeout=60)

    @classmethod
    def tearDownClass(cls):
        assert cls.service.stop() == 0, cls.service.read_log()[-3000:]
        cls.service.folder.cleanup()

    def check_model(self, answer):
        plant = answer["model"]["plant"]
        self.assertEqual(plant["type"], "fopdt")
        for name in "KTL":  # the record is exact up to nine digits and its sampling grid
            self.assertAlmostEqual(plant[name], FOPDT[name], delta=0.01 * FOPDT[name])

    def test_tune_returns_the_result_with_its_job(self):
        result = self.client.tune(plant=FOPDT, tune=["simc"], name="TIC-101", evaluate={"points": 0},
                                  baseline={"Kp": 0.5, "Ti": 20})
        self.assertAlmostEqual(result.best["controller"]["Kp"], SIMC_KP, places=12)
        self.assertAlmostEqual(result.best["controller"]["Ti"], SIMC_TI, places=12)
        self.assertEqual(result["controllers"][-1]["method"], "baseline")
        self.assertNotIn("responses", result.best)
        self.assertEqual((result.job["name"], result.job["status"]), ("TIC-101", "succeeded"))
        self.assertEqual(self.client.job(result)["result"], dict(result))
        self.assertEqual(self.client.wait(result.job["id"]), result)

    def test_a_plant_may_be_typed_and_methods_have_options(self):
        result = self.client.tune("2 e^(-3s)/(10s+1)", tune=[{"method": "simc", "tau_c": 6}])
        self.assertAlmostEqual(result.best["controller"]["Kp"], 10 / (2 * 9), places=12)

    def test_an_example_runs_as_it_stands(self):
        example = self.client.get("/v1/examples")["examples"][0]
        self.assertEqual(self.client.run(example["request"])["version"], self.client.get("/healthz")["version"])

    def test_a_record_may_be_a_file_a_text_a_frame_or_arrays(self):
        text = step_csv()
        with tempfile.TemporaryDirectory() as folder:
            for name, encoding in (("plain.csv", "utf-8"), ("mark.csv", "utf-8-sig"), ("wide.csv", "utf-16")):
                path = pathlib.Path(folder, name)
                path.write_text(text.replace("t,", "t [s],", 1), encoding)
                self.check_model(self.client.identify(path))
            self.check_model(self.client.identify(str(path)))
        self.check_model(self.client.identify(text))
        columns = [list(map(float, column)) for column in zip(*(row.split(",") for row in text.split()[1:]))]
        self.check_model(self.client.identify(dict(zip("tuy", map(Array, columns)))))
        renamed = tunewright.record(text.replace("t,u,y", "a,b,c"), columns={"t": "a", "u": "b", "y": "c"})
        self.check_model(self.client.identify(renamed, identify={"model": "fopdt"}))
        self.assertAlmostEqual(self.client.tune(record=text, tune=["simc"])["model"]["plant"]["L"], 3, delta=0.03)

    def test_a_frame_gives_its_index_where_that_is_a_column(self):
        plain, dated, named = Frame.RangeIndex(), Frame.DatetimeIndex(), Frame.RangeIndex()
        named.name = "t"
        for index, asked in ((plain, (False, None)), (dated, (True, "time")), (named, (True, "t"))):
            frame = Frame(step_csv(), index)
            self.check_model(self.client.identify(frame))
            self.assertEqual(frame.asked, asked)

    def test_letters_that_only_windows_writes_are_read(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder, "trend.csv")
            path.write_bytes("t,u,y [°C]\n".encode("cp1252") + step_csv().split("\n", 1)[1].encode())
            self.assertIn("°C", tunewright.record(path)["csv"])
            self.check_model(self.client.identify(path))

    def test_compare_ranks_the_methods_named(self):
        result = self.client.compare(FOPDT, methods=["simc", {"method": "robust", "controller": "PI"}, "amigo"])
        self.assertEqual([entry["method"] for entry in result["controllers"]], ["simc", "robust", "amigo"])
        self.assertEqual(sorted(result["ranking"]), [0, 1, 2])
        everything = self.client.compare(FOPDT, evaluate={"points": 0})
        self.assertGreater(len(everything["controllers"]), 10)

    def test_a_batch_tells_of_each_row_and_of_the_bad_one(self):
        told = []
        requests = [QUICK, {"plant": {"type": "fopdt", "K": 2, "L": 3}}, {**QUICK, "name": "last"}]
        rows = list(self.client.batch(requests, lambda *at: told.append(at), name="unit 7"))
        self.assertEqual([row["status"] for row in rows], ["succeeded", "failed", "succeeded"])
        self.assertEqual([row["index"] for row in rows], [0, 1, 2])
        self.assertAlmostEqual(rows[2]["result"]["controllers"][0]["controller"]["Kp"], SIMC_KP, places=12)
        problem = tunewright.Problem(rows[1]["error"])
        self.assertIn("line 2", problem.detail)
        self.assertEqual([fault.pointer for fault in problem.errors], ["/plant/T"])
        self.assertEqual(told, [(1, 3), (2, 3), (3, 3)])
        self.assertEqual(self.client.get("/v1/batches")["batches"][0]["name"], "unit 7")

    def test_a_check_of_given_loops_is_a_job_with_a_report(self):
        rows = [(t, 20 + (3 * t) % 17 * 0.25, 30 + t % 7) for t in range(400)]
        columns = dict(zip("tyu", map(Array, map(list, zip(*rows)))))
        check = self.client.check([{"tag": "FIC1", "record": columns}, {"tag": "FIC2", "csv": "t,y,u\nno,1,2\n"}],
                                  name="unit 7", cluster=False)
        self.assertEqual([loop["tag"] for loop in check["loops"]], ["FIC1", "FIC2"])
        self.assertEqual(check["loops"][0]["quality"]["rows"], 400)
        self.assertEqual(sorted(loop["tag"] for loop in check.work_list), ["FIC1", "FIC2"])
        self.assertEqual(check["loops"][1]["cause"]["verdict"], "insufficient-data")
        self.assertIn("unit 7: loop check", self.client.report_html(check))
        with self.assertRaisesRegex(LookupError, "no batch"):
            self.client.changes("other", check)
        with self.assertRaisesRegex(LookupError, "work list"):
            self.client.wait(check.job["id"]).best

    def test_a_check_of_a_file_judges_its_loops_together_and_is_compared_later(self):
        head = "Time,FIC1.PV,FIC1.OP,FIC2.PV,FIC2.OP"
        lines = ["%d,%.2f,%d,%.2f,%d" % (t, 20 + 3 * t % 17 * 0.25, 30 + t % 7, 20 + 5 * t % 17 * 0.25, 30 + t % 9)
                 for t in range(400)]
        told = []
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder, "plant.csv")
            path.write_text("\n".join([head, *lines]) + "\n")
            checks = [self.client.check(path, lambda *at: told.append(at), name="unit 7") for _ in range(2)]
        for check in checks:
            self.assertEqual(sorted(loop["tag"] for loop in check.work_list), ["FIC1", "FIC2"])
            self.assertTrue(check["complete"])
        self.assertEqual(told, [(1, 2), (2, 2)] * 2)
        changes = self.client.changes(checks[0], checks[1])["changes"]
        self.assertEqual([each["change"]["significant"] for each in changes], [False, False])

    def test_leaving_the_rows_early_cancels_the_rest(self):
        rows = self.client.batch([QUICK, LONG, LONG, LONG], name="left")
        self.assertEqual(next(rows)["status"], "succeeded")
        rows.close()
        end = time.monotonic() + 60
        while (batch := self.client.get("/v1/batches")["batches"][0])["status"] != "ended":
            self.assertLess(time.monotonic(), end)
            time.sleep(0.02)
        self.assertEqual((batch["name"], batch["counts"]["cancelled"]), ("left", 3))

    def test_an_interrupt_cancels_the_job(self):
        program = ("import sys, json, tunewright\n"
                   "tunewright.Client(sys.argv[1]).run(json.loads(sys.argv[2]))\n")
        process = subprocess.Popen([sys.executable, "-c", program, self.url, json.dumps({**LONG, "name": "unwanted"})],
                                   cwd=str(ROOT / "api" / "clients" / "python"), stderr=subprocess.PIPE,
                                   # What runs in the background of a shell ignores interrupts, and its children do.
                                   preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL))
        job = self.service.wait_for_any("running")
        process.send_signal(signal.SIGINT)
        self.assertIn(b"KeyboardInterrupt", process.communicate(timeout=60)[1])
        self.assertEqual(self.service.wait_for(job["id"])["status"], "cancelled")
        self.assertEqual(job["name"], "unwanted")

    def test_what_is_wrong_is_said_by_field(self):
        with self.assertRaises(tunewright.Problem) as caught:
            self.client.tune(plant={"type": "fopdt", "K": "2", "T": 10}, tune=["rubust"])
        problem = caught.exception
        self.assertEqual(problem.status, 422)
        self.assertEqual({fault.pointer for fault in problem.errors}, {"/plant/K", "/plant/L", "/tune/0/method"})
        for sentence in ("/plant/K: K is \"2\"", "Did you mean robust?"):
            self.assertIn(sentence, str(problem))
        with self.assertRaises(tunewright.Problem) as caught:
            self.client.job("none")
        self.assertEqual(caught.exception.status, 404)

    def test_a_job_that_fails_raises_its_problem(self):
        with self.assertRaises(tunewright.Problem) as caught:
            self.client.run({**LONG, "tune": LONG["tune"][:1], "timeout_s": 0.05})
        self.assertEqual(caught.exception.type, "timeout")

    def test_who_waits_no_longer_is_told_the_job(self):
        with self.assertRaises(TimeoutError) as caught:
            tunewright.Client(self.url, timeout=1).run(LONG)
        job = self.service.wait_for_any("running")["id"]
        self.assertIn(job, str(caught.exception))
        self.assertIn(self.client.cancel(job)["status"], ("running", "cancelled"))
        with self.assertRaisesRegex(tunewright.Problem, "was cancelled"):
            self.client.wait(job)
        self.client.delete(job)
        with self.assertRaisesRegex(tunewright.Problem, job):
            self.client.job(job)

    def test_calls_that_keep_nothing(self):
        judged = self.client.evaluate(FOPDT, [{"Kp": SIMC_KP, "Ti": SIMC_TI}], evaluate={"points": 0})
        designed = self.client.design(FOPDT, {"method": "simc"}, evaluate={"points": 0})
        self.assertAlmostEqual(judged["controllers"][0]["robustness"]["Ms"],
                               designed["controllers"][0]["robustness"]["Ms"], places=9)
        front = self.client.frontier(FOPDT, controller="PI", Ms={"from": 1.3, "to": 1.8, "points": 4})["points"]
        self.assertEqual(sorted((point["load_IAE"] for point in front), reverse=True),
                         [point["load_IAE"] for point in front])
        test = self.client.relay_test(FOPDT, {"u_plus": 1, "u_minus": -1, "hysteresis": 0.1})
        self.check_model(self.client.identify(test["record"]))

    def test_settings_are_those_that_the_product_takes(self):
        # The published example: computed from the maker's formula, to six digits.
        example = self.client.get("/v1/controllers/emerson_deltav_series")["example"]
        expected, controller = example.pop("settings"), example.pop("controller")
        settings = self.client.settings("emerson_deltav_series", controller, **example)["settings"]
        for name, value in expected.items():
            if isinstance(value, float):
                self.assertAlmostEqual(settings[name], value, delta=1e-5 * abs(value))
        self.assertIn("GAIN", expected)
        with self.assertRaisesRegex(tunewright.Problem, "There is no such controller"):
            self.client.settings("a/b", {"Kp": 1})

    def test_jobs_are_listed_over_all_pages(self):
        made = [self.client.tune(FOPDT, tune=["simc"], name="page %d" % i).job["id"] for i in range(3)]
        self.assertEqual([job["id"] for job in self.client.jobs(limit=1, q="page ")], made[::-1])

    def test_a_result_becomes_a_report_and_a_program(self):
        result = self.client.tune(FOPDT, tune=["simc", "amigo"], name="TIC-101")
        page = self.client.report_html(result)
        self.assertTrue(page.startswith("<!DOCTYPE html>"), page[:40])
        self.assertIn("TIC-101", page)
        compile(self.client.code(result.job["id"], "python", sample_time=0.5), "controller.py", "exec")
        self.assertIn("amigo", self.client.code(result, "st", controller=1).lower())

    def test_an_operating_range_has_a_schedule_in_place_of_a_best(self):
        result = self.client.run({"scheduling": {"name": "load", "unit": "%"},
                                  "points": [{"at": 20, "plant": "2 e^(-s)/(10s+1)"},
                                             {"at": 80, "plant": "1 e^(-s)/(3s+1)"}]})
        with self.assertRaisesRegex(LookupError, "range"):
            result.best
        for job in (result, result.job["id"]):
            self.assertIn("scheduling", self.client.code(job, "c", sample_time=0.1))

    def test_who_has_a_key_is_let_in(self):
        with tempfile.TemporaryDirectory() as folder:
            keys = os.path.join(folder, "keys")
            ann = make_key("ann", keys)
            with Service("--auth", "keys", "--keys", keys) as service:
                url = "http://127.0.0.1:%d/" % service.port
                with self.assertRaises(tunewright.Problem) as caught:
                    tunewright.Client(url).tune(FOPDT)
                self.assertEqual(caught.exception.status, 401)
                result = tunewright.Client(url, key=ann).tune(FOPDT, tune=["simc"])
                self.assertAlmostEqual(result.best["controller"]["Kp"], SIMC_KP, places=12)


if __name__ == "__main__":
    unittest.main()
