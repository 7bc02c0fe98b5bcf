"""The command `tunewright code`: its refusals, and its statement of the controller's origin."""

import json
import subprocess
import tempfile
import unittest

from languages import BINARY, code, command, ideal, result_of
from structured_text import FunctionBlock


class CommandTest(unittest.TestCase):
    def refused(self, result, *arguments):
        done = command(result, *arguments)
        self.assertEqual((done.returncode, done.stdout), (1, ""))
        return json.loads(done.stderr)

    def test_every_wrong_word_is_told_at_once(self):
        problem = self.refused(result_of(ideal()), "--language", "pascal", "--sample-time", "soon", "--u-min", "5", "--u-max",
                               "x", "--integral", "simpson", "--anti-windup", "clampin")
        told = {error["pointer"]: error["detail"] for error in problem["errors"]}
        self.assertEqual(sorted(told), ["/anti_windup", "/integral", "/language", "/sample_time", "/u_max"])
        self.assertIn("it must be st, c, python or arduino", told["/language"])
        self.assertIn("Did you mean clamping?", told["/anti_windup"])
        for arguments, pointer in ((("--u-min", "5", "--u-max", "-5"), "/u_max"),
                                   (("--derivative", "slope"), "/slope_samples"),
                                   (("--slope-samples", "3"), "/slope_samples"),
                                   (("--form", "velocity", "--anti-windup", "clamping"), "/anti_windup"),
                                   (("--anti-windup", "clamping", "--tracking-time", "3"), "/tracking_time"),
                                   (("--rate-limit", "-1"), "/rate_limit"), (("--sample-time", "0"), "/sample_time")):
            problem = self.refused(result_of(ideal()), "--language", "c", *arguments)
            self.assertEqual([error["pointer"] for error in problem["errors"]], [pointer], arguments)
        self.assertIn("language is missing", self.refused(result_of(ideal()))["detail"])

    def test_what_a_controller_cannot_be_is_told(self):
        fast = ("--language", "st", "--derivative", "filtered_forward", "--sample-time", "2")
        self.assertIn("stable only for Tf above half", self.refused(result_of(ideal("derivative")), *fast)["detail"])
        self.assertIn("no time from which one can be proposed", self.refused(result_of(ideal(Ti=None, Td=0)), "--language", "st")["detail"])
        self.assertIn("u would not return", self.refused(
            result_of(ideal(Ti=None)), "--language", "st", "--form", "velocity")["detail"])
        problem = self.refused(result_of(ideal(), units={"time": "weeks"}), "--language", "st")
        self.assertEqual(problem["errors"][0]["pointer"], "/units/time")
        self.assertIn("can convert s, ms, min, h and d", problem["detail"])

    def test_what_has_no_controller_is_told(self):
        self.assertEqual(self.refused({"anything": 1}, "--language", "c")["status"], 404)
        for index in ("1", "-1", "one", "99999999999999999999"):
            problem = self.refused(result_of(ideal()), "--language", "c", "--controller=" + index)
            self.assertEqual(problem["status"], 404)
            self.assertIn("the result has only number 0", problem["detail"])
        failed = {"controllers": [{"method": "simc", "error": {"detail": "The plant has no dead time."}}]}
        problem = self.refused(failed, "--language", "c")
        self.assertIn("Number 0 (simc) has no controller: The plant has no dead time.", problem["detail"])
        for other in ("a text", [], 3, {"controllers": 1}, {"controllers": [1]}, {"controllers": [{"method": 1}]},
                      dict(result_of(ideal()), partial="no"), dict(result_of(ideal()), ranking={"a": 1}), {"result": None}):
            self.assertEqual(self.refused(other, "--language", "c", "--sample-time", "1")["status"], 404, other)
        done = subprocess.run([BINARY, "code", "/nothing/here"], capture_output=True, text=True)
        self.assertEqual((done.returncode, json.loads(done.stderr)["status"]), (1, 404))

    def test_times_become_seconds(self):
        minutes = {"form": "ideal", "Kp": 2, "Ti": 5, "Td": 0.5, "filter": {"type": "derivative", "Tf": 0.1}}
        block = FunctionBlock(code(result_of(minutes, units={"time": "min"}), "st",
                                   {"sample_time": 0.05, "rate_limit": 30, "tracking_time": 0.5, "u_min": -5}))
        for name, value in (("Ti", 300), ("Td", 30), ("Tf", 6), ("Ts", 3), ("rate_limit", 0.5), ("Tt", 30), ("u_min", -5)):
            self.assertAlmostEqual(block[name], value, 12, name)

    def test_the_sample_time_is_asked_for_or_requested_or_proposed(self):
        result = result_of(ideal("measurement_first_order"))
        for result, arguments, words, Ts in (
                (result, ("--sample-time", "0.25"), "0.25 s, as asked for", 0.25),
                ({"result": result, "request": {"implement": {"sample_time": 0.4}}}, (), "0.4 s, from the request", 0.4),
                (result, (), "0.1 s, proposed, because none was given", 0.1)):
            text = command(result, "--language", "st", *arguments).stdout
            self.assertIn(words, text)
            self.assertEqual(FunctionBlock(text)["Ts"], Ts)

    def test_the_sample_time_proposed_is_one_that_the_loop_bears(self):
        # 1.0 s, a tenth of Ti, would leave the loop unstable: the dead time is 0.1 s.
        request = {"plant": "1 e^(-0.1s)/(10s+1)", "tune": [{"method": "haalman"}], "evaluate": {"points": 0}}
        tuned = subprocess.run([BINARY, "tune", "-"], input=json.dumps(request), capture_output=True, text=True)
        result = json.loads(tuned.stdout)
        longest = result["controllers"][0]["longest_sample_time"]
        text = command(result, "--language", "st").stdout
        self.assertIn("the longest that raises Ms by no more than 5 %", " ".join(text.split()))
        self.assertLessEqual(FunctionBlock(text)["Ts"], longest)
        self.assertGreater(FunctionBlock(text)["Ts"], longest / 2.5)
        asked = command(result, "--language", "st", "--sample-time", "1").stdout
        self.assertIn("1 s, as asked for; beyond", " ".join(asked.split()))

    def test_the_rules_are_those_that_the_request_was_judged_with(self):
        request = {"plant": "2 e^(-3s)/(10s+1)", "evaluate": {"points": 0}, "tune": [{"method": "robust", "Ms": 1.4}],
                   "implement": {"sample_time": 1.5, "integral": "trapezoidal", "derivative": "backward"}}
        tuned = subprocess.run([BINARY, "tune", "-"], input=json.dumps(request), capture_output=True, text=True)
        result = json.loads(tuned.stdout)
        implemented = result["controllers"][0]["implemented"]["robustness"]["Ms"]
        both = {"result": result, "request": request}
        text = command(both, "--language", "python").stdout
        same = command(both, "--language", "python", "--integral", "trapezoidal", "--derivative", "difference").stdout
        other = command(both, "--language", "python", "--integral", "backward").stdout
        self.assertEqual(text, same)
        self.assertNotEqual(text, other)
        self.assertIn("%.5g" % implemented, text)

    def test_the_request_beside_it_is_the_results_own(self):
        request = {"plant": "2 e^(-3s)/(10s+1)", "evaluate": {"points": 0}}
        tuned = subprocess.run([BINARY, "tune", "-"], input=json.dumps(request), capture_output=True, text=True)
        with tempfile.TemporaryDirectory() as folder:
            for name, text in (("own", json.dumps(request)), ("other", '{"plant": "5/(3s+1)"}'), ("none", "no request")):
                with open(f"{folder}/{name}.json", "w", encoding="utf-8") as file:
                    file.write(text)
            result = json.loads(tuned.stdout)
            text = command(result, "--language", "c", "--request", f"{folder}/own.json").stdout
            self.assertIn("fopdt, K 2, T 10, L 3", text)
            problem = self.refused(result, "--language", "c", "--request", f"{folder}/other.json")
            self.assertIn("not the request of the result", problem["detail"])
            self.assertIn("none.json", self.refused(result, "--language", "c", "--request", f"{folder}/none.json")["detail"])

    def test_an_output_that_cannot_be_written_is_no_success(self):
        with open("/dev/full", "w", encoding="utf-8") as full:
            for arguments in (("code", "-", "--language", "c"), ("report", "-"), ("completion", "bash"), ("manual",)):
                done = subprocess.run([BINARY, *arguments], input=json.dumps(result_of(ideal())), stdout=full,
                                      stderr=subprocess.PIPE, text=True)
                self.assertEqual(done.returncode, 1, arguments)
                self.assertIn("cannot be written", done.stderr)

    def test_the_head_says_where_the_controller_comes_from(self):
        request = {"name": "TIC-101 */ x", "units": {"time": "min", "u": "%"}, "plant": {"type": "fopdt", "K": 2, "T": 10, "L": 3},
                   "tune": [{"method": "simc"}, {"method": "robust"}], "evaluate": {"points": 0}}
        tuned = subprocess.run([BINARY, "tune", "-"], input=json.dumps(request), capture_output=True, text=True)
        result = json.loads(tuned.stdout)
        text = command({"result": result, "request": request}, "--language", "python").stdout
        best = result["controllers"][result["ranking"][0]]
        for part in ("TIC-101", "fopdt, K 2, T 10, L 3", best["title"], result["request_hash"], "u in %, time in min",
                     "%.5g" % best["robustness"]["Ms"], "%.5g" % best["performance"]["load"]["IAE"]):
            self.assertIn(part, text)
        self.assertNotIn("*/", code(result, "c", {"sample_time": 1}).split("#ifndef")[0].rstrip().removesuffix("*/"))
        other = command(result, "--language", "python", "--controller", str(result["ranking"][1])).stdout
        self.assertIn(result["controllers"][result["ranking"][1]]["title"], other)


if __name__ == "__main__":
    unittest.main()
