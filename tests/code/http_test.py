"""The code of a job's controller over HTTP."""

import pathlib
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "server"))
from service import FOPDT, LONG, QUICK, Service  # noqa: E402

JOB = {"name": "TIC-101", "units": {"time": "min"}, "plant": FOPDT, "evaluate": {"points": 0},
       "tune": [{"method": "robust"}, {"method": "visioli_integrating"}, {"method": "simc"}]}


class CodeTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.service = Service()
        cls.addClassCleanup(lambda: (cls.service.stop(), cls.service.folder.cleanup()))
        cls.job = cls.service.post_job(JOB, wait=30)

    def get(self, index, query, headers=None):
        return self.service.get("/v1/jobs/%s/controllers/%s/code%s" % (self.job["id"], index, query), headers)

    def test_each_language_is_a_file_of_its_own(self):
        for language, media_type, name, part in (
                ("st", "text/plain", "TunewrightPid.st", b"FUNCTION_BLOCK TunewrightPid"),
                ("c", "text/x-c", "tunewright_pid.h", b"tunewright_pid_step("),
                ("python", "text/x-python", "tunewright_pid.py", b"class TunewrightPid:")):
            answer = self.get(0, "?language=%s&u_min=0&u_max=100" % language)
            self.assertEqual((answer.status, answer.media_type), (200, media_type))
            self.assertEqual(answer.headers["Content-Disposition"], 'attachment; filename="%s"' % name)
            for told in (part, b"TIC-101", b"fopdt, K 2, T 10, L 3", self.job["result"]["request_hash"].encode()):
                self.assertIn(told, answer.body)

    def test_a_test_that_a_controller_runs_is_a_file_too(self):
        asked = {"experiment": "relay", "sample_time": 0.5, "u_step": 5, "y_max": 90}
        for language, media_type, name, part in (
                ("st", "text/plain", "TunewrightRelay.st", b"FUNCTION_BLOCK TunewrightRelay"),
                ("c", "text/x-c", "tunewright_relay.h", b"tunewright_relay_step("),
                ("python", "text/x-python", "tunewright_relay.py", b"class TunewrightRelay:"),
                ("arduino", "text/x-arduino", "tunewright_relay.ino", b"void loop()")):
            answer = self.service.post("/v1/experiments/code", {**asked, "language": language})
            self.assertEqual((answer.status, answer.media_type), (200, media_type))
            self.assertEqual(answer.headers["Content-Disposition"], 'attachment; filename="%s"' % name)
            self.assertIn(part, answer.body)
        for body, pointer in (({**asked, "language": "c", "u_step": 0}, "/u_step"), ({**asked}, "/language"),
                              ({**asked, "language": "c", "y_move": 2}, "/y_move"),
                              ({**asked, "language": "c", "quiet_time": 9, "max_time": 5}, "/max_time")):
            answer = self.service.post("/v1/experiments/code", body)
            self.assertEqual((answer.status, [each["pointer"] for each in answer.json["errors"]]), (422, [pointer]))

    def test_parameters_are_those_of_the_command(self):
        text = self.get(2, "?language=python&sample_time=0.05&integral=trapezoidal&anti_windup=clamping&rate_limit=30").body
        for told in (b"self.Ts = 3.0 ", b"self.rate_limit = 0.5 ", b"trapezoidal rule", b"Anti-windup by clamping",
                     b"3 s, as asked for"):
            self.assertIn(told, text)
        answer = self.get(0, "?language=fortran&sampletime=1&u_min=low&u_min=3&%ff=1")
        self.assertEqual((answer.status, answer.media_type), (422, "application/problem+json"))
        told = {error["pointer"]: error["detail"] for error in answer.json["errors"]}
        self.assertIn("did you mean sample_time?", told["/sampletime"])
        self.assertIn("it must be st, c, python or arduino", told["/language"])
        self.assertIn("given twice", answer.body.decode())

    def test_what_is_not_there_is_told(self):
        self.assertIn("numbers 0 to 2", self.get(3, "?language=c").json["detail"])
        for index, status in ((3, 404), ("first", 404), ("-0", 404), (1, 404)):
            self.assertEqual(self.get(index, "?language=c").status, status)
        self.assertIn("(visioli_integrating) has no controller: ", self.get(1, "?language=c").json["detail"])
        self.assertEqual(self.service.get("/v1/jobs/none/controllers/0/code?language=c").status, 404)
        answer = self.get(0, "?language=c", {"Accept": "application/json"})
        self.assertEqual(answer.status, 406)
        self.assertEqual(self.get(0, "?language=c", {"Accept": "text/*"}).status, 200)

    def test_a_job_that_has_no_result_has_no_code(self):
        running = self.service.post_job(LONG)["id"]
        answer = self.service.get("/v1/jobs/%s/controllers/0/code?language=c" % running)
        self.assertEqual(answer.status, 409)
        self.service.post("/v1/jobs/%s/cancel" % running, "")
        failed = self.service.post_job(dict(QUICK, tune=[{"method": "visioli_integrating"}]), wait=30)
        answer = self.service.get("/v1/jobs/%s/controllers/0/code?language=c" % failed["id"])
        self.assertEqual((failed["status"], answer.status), ("failed", 404))


if __name__ == "__main__":
    unittest.main()
