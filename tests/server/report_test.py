"""The report of a job: one well-formed file without scripts, with the job's figures and a request that can be run
again."""

import base64
import html.parser
import json
import pathlib
import re
import subprocess
import tempfile
import unittest
import xml.etree.ElementTree

from service import BINARY, FOPDT, LONG, Service

XHTML = "{http://www.w3.org/1999/xhtml}"
ATTACK = "</title><script>alert(1)</script><img src=x onerror=alert(1)> & \" ' ]]> \u0001"
EXAMPLES = pathlib.Path(__file__).resolve().parents[2] / "api" / "examples"
BASE = {"name": "TIC-101", "units": {"time": "s", "u": "%", "y": "degC"}, "plant": FOPDT,
        "tune": [{"method": "robust"}, {"method": "simc"}], "baseline": {"form": "ideal", "Kp": 1.2, "Ti": 10}}


class Checker(html.parser.HTMLParser):
    """Checks tags like a browser: each must be closed in order."""

    def __init__(self):
        super().__init__()
        self.open, self.tags = [], set()

    def handle_starttag(self, tag, attributes):
        self.open.append(tag)
        self.tags.add(tag)

    def handle_startendtag(self, tag, attributes):
        self.tags.add(tag)

    def handle_endtag(self, tag):
        assert self.open.pop() == tag, tag


def number(text):
    return float(text.replace("\u2212", "-"))


class ReportTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.service = Service()
        cls.addClassCleanup(lambda: (cls.service.stop(), cls.service.folder.cleanup()))

    def job(self, request):
        job = self.service.post_job(request, wait=60)
        self.assertEqual(job["status"], "succeeded", job.get("error"))
        return job

    def report(self, job, query="", page="report.html"):
        answer = self.service.get("/v1/jobs/%s/%s%s" % (job["id"], page, query), {"Accept": "text/html"})
        self.assertEqual((answer.status, answer.media_type), (200, "text/html"), answer.body[:300])
        return answer

    def checked(self, job, query="", page="report.html"):
        """The tree of a report, after checks of its figures and its form."""
        answer = self.report(job, query, page)
        text = answer.body.decode()
        checker = Checker()
        checker.feed(text)
        checker.close()
        self.assertEqual(checker.open, [])
        self.assertFalse(checker.tags & {"script", "img", "iframe", "link", "object", "form", "foreignobject"})
        self.assertNotRegex(text, r"<[^>]* (on\w+|style)=")
        tree = xml.etree.ElementTree.fromstring(text)
        figures = [element for element in tree.iter() if element.get("data-at")]
        for element in figures:
            value = self.at(job, element.get("data-at"))
            shown = number(element.text)
            digits = len(re.sub(r"e.*|[^0-9]", "", element.text).lstrip("0")) or 1
            self.assertLessEqual(abs(shown - value), 0.51 * 10 ** (1 - max(digits, 2)) * abs(value) + 1e-300,
                                 element.get("data-at"))
        for element in tree.iter():
            if element.get("data-typed"):
                self.assertEqual(element.text, self.at(job, element.get("data-typed")))
        return tree, text, {element.get("data-at"): element.text for element in figures}

    def at(self, job, pointer):
        value = {"result": job["result"], "request": job["request"]}
        for name in pointer.split("/")[1:]:
            name = name.replace("~1", "/").replace("~0", "~")
            value = value[int(name)] if isinstance(value, list) else value[name]
        return value

    def request_of(self, tree):
        link = next(element for element in tree.iter(XHTML + "a") if element.get("download"))
        return json.loads(base64.b64decode(link.get("href").split(",", 1)[1]))

    def sheets(self, batch, query="", status=200):
        answer = self.service.get("/v1/batches/%s/change-sheet.html%s" % (batch, query), {"Accept": "text/html"})
        self.assertEqual(answer.status, status, answer.body[:300])
        return answer.body.decode()

    def batch(self, jobs, name="unit 7"):
        answer = self.service.post("/v1/batches", {"name": name, "jobs": jobs})
        self.assertEqual(answer.status, 202, answer.body)
        self.service.get("/v1/batches/%s/results?follow=true" % answer.json["id"])
        return answer.json["id"]

    def headings(self, text):
        tree = xml.etree.ElementTree.fromstring(text)
        return ["".join(element.itertext()) for element in tree.iter(XHTML + "h1")]

    def test_a_batch_has_a_sheet_for_each_loop_and_a_list_of_the_others(self):
        nameless = {key: value for key, value in BASE.items() if key != "name"}
        batch = self.batch([BASE, {"name": "LIC-3", "plant": {"type": "fopdt", "K": 2}}, nameless,
                            {**BASE, "name": "TIC-103" + ATTACK}])
        text = self.sheets(batch)
        self.assertEqual(self.headings(text)[:2], ["TIC-101: change sheet", "Loop 3: change sheet"])
        self.assertEqual(self.headings(text)[3:], ["unit 7: loops without a change sheet"])
        self.assertIn("Loop 2", text)
        self.assertIn("LIC-3", text)
        self.assertIn("T is missing", text)
        self.assertNotIn("<script", text)
        # A sheet is that of the job.
        job = self.service.get("/v1/jobs?batch=%s" % batch).json["jobs"]
        alone = self.service.get("/v1/jobs/%s/change-sheet.html" % next(one["id"] for one in job if one["index"] == 0))
        body = re.search(r"<main class=.sheet.>(.*)</main>", alone.body.decode(), re.S).group(1)
        self.assertIn(body, text)
        # A part begins where it is asked to.
        self.assertEqual(self.headings(self.sheets(batch, "?from=2"))[0], "Loop 3: change sheet")
        self.assertIn("4 loops", self.sheets(batch, "?from=4", 404))
        self.assertIn("whole number", self.sheets(batch, "?from=x", 422))
        self.sheets("nobody", "", 404)

    def test_a_large_batch_comes_in_parts(self):
        batch = self.batch([{"name": "L%d" % i, "plant": FOPDT, "tune": [{"method": "simc"}]} for i in range(230)], "many")
        seen, query = [], ""
        for part in range(3):
            text = self.sheets(batch, query)
            seen += self.headings(text)
            link = re.search(r'href="change-sheet.html(\?from=\d+)"', text)
            self.assertEqual(link is None, part == 2)
            query = link.group(1) if link else ""
        self.assertEqual(seen, ["L%d: change sheet" % i for i in range(230)])

    def test_dates_are_in_the_time_of_the_reader(self):
        job = self.job(BASE)
        for page in ("report.html", "change-sheet.html"):
            for query, zone in (("", " UTC"), ("?utc_offset=120", " UTC+02:00"), ("?utc_offset=-570", " UTC-09:30")):
                self.assertIn(zone + " ", self.report(job, query, page).body.decode())
            refused = self.service.get("/v1/jobs/%s/%s?utc_offset=900" % (job["id"], page))
            self.assertEqual(refused.status, 422)
            self.assertIn("840", refused.body.decode())

    def test_figures_are_the_jobs_and_the_request_runs_again(self):
        job = self.job(BASE)
        tree, text, figures = self.checked(job)
        first = next(i for i in job["result"]["ranking"] if job["result"]["controllers"][i]["method"] != "baseline")
        for place in ("robustness/Ms", "robustness/Mt", "robustness/phase_margin_deg", "performance/load/IAE",
                      "performance/setpoint/overshoot_percent", "controller/Kp", "controller/Ti"):
            self.assertIn("/result/controllers/%d/%s" % (first, place), figures)
            self.assertTrue(any(at.endswith(place) and not at.startswith("/result/controllers/%d/" % first)
                                for at in figures), "today's " + place)
        for told in ("TIC-101", job["id"], job["result"]["request_hash"], job["result"]["version"], "Prepared by",
                     "Garpinger", "Series", "Parallel", "°C"):
            self.assertIn(told, text)
        self.assertEqual(len(list(tree.iter(XHTML + "figure"))), 6)
        for request in (self.request_of(tree), json.loads("".join(tree.find(".//*[@id='request']").itertext()))):
            self.assertEqual(request, job["request"])
        again = self.job(self.request_of(tree))
        self.assertEqual([entry["controller"] for entry in again["result"]["controllers"]],
                         [entry["controller"] for entry in job["result"]["controllers"]])
        self.assertEqual(again["result"]["request_hash"], job["result"]["request_hash"])

    def test_the_users_own_step_is_told_with_its_figures_next_to_todays(self):
        step = {"y": 20, "target": 120, "ramp_rate": 5, "u_max": 60,
                "load": {"size": -10, "at": "output", "shape": "pulse", "duration": 30}}
        job = self.job(BASE | {"evaluate": {"own_step": step}})
        tree, text, figures = self.checked(job)
        told = "".join(tree.itertext())
        self.assertIn("From rest at y = 20 °C and u = 0 % the set point goes to 120 °C, by 5 °C per s. A load of "
                      "\u221210 °C at the plant's output follows, for 30 s. u is at most 60 %.", told)
        first = next(i for i in job["result"]["ranking"] if job["result"]["controllers"][i]["method"] != "baseline")
        today = next(i for i, entry in enumerate(job["result"]["controllers"]) if entry["method"] == "baseline")
        for place in ("setpoint/IAE", "setpoint/settling_time", "load/peak", "u_max", "travel", "time_at_max"):
            for entry in (first, today):
                self.assertIn("/result/controllers/%d/own_step/%s" % (entry, place), figures)
        self.assertNotIn("/result/controllers/%d/own_step/time_at_min" % first, figures)
        self.assertEqual(len(list(tree.iter(XHTML + "figure"))), 6 + 2)
        for unit in ("ISE (°C² s)", "ITAE (°C s²)"):
            self.assertIn(unit, told)
        self.assertNotIn("own step", "".join(self.checked(self.job(BASE))[0].itertext()).lower())

    def test_an_own_step_that_is_not_simulated_is_told_with_its_reason(self):
        job = self.job(BASE | {"tune": [], "controllers": [{"form": "npid", "Kp": 0.5, "Ti": 8, "Td": 0, "delta_r": 3}],
                               "evaluate": {"own_step": {"target": 1}}})
        self.assertIn("The nonlinear integral of this controller is not supported here.",
                      "".join(self.checked(job, "?controller=0")[0].itertext()))

    def test_the_command_in_it_is_one_that_a_shell_runs(self):
        job = self.job(BASE | {"name": "it's TIC-101"})
        tree, _, _ = self.checked(job)
        command = "".join(tree.find(".//*[@id='command']").itertext())
        done = subprocess.run(["/bin/sh", "-c", command], capture_output=True, text=True, timeout=60)
        answer = json.loads(done.stdout)
        self.assertEqual((answer["name"], answer["status"]), ("it's TIC-101", "succeeded"))

    def test_the_product_its_ranges_and_the_way_from_old_to_new_are_at_its_head(self):
        implement = {"product": "emerson_deltav_standard", "y_span": [0, 200], "u_span": [0, 100], "sample_time": 0.5}
        job = self.job({"name": "TIC-101", "units": {"time": "s", "u": "%", "y": "degC"}, "plant": FOPDT,
                        "implement": implement, "evaluate": {"actuator": {"min": -40, "max": 60}},
                        "baseline": {"product": "emerson_deltav_standard", "settings": {"GAIN": 1.1, "RESET": 14}}})
        tree, text, figures = self.checked(job)
        head = "".join(tree.find(".//" + XHTML + "header").itertext())
        self.assertIn("Settings of Emerson DeltaV PID, FORM Standard", head)
        self.assertRegex(head, r"\d{4}-\d\d-\d\d \d\d:\d\d UTC")
        tables = {table.find(XHTML + "caption").text: ["".join(cell.itertext()) for cell in table.iter() if
                                                       cell.tag in (XHTML + "th", XHTML + "td")]
                  for table in tree.iter(XHTML + "table")}
        change = tables["On your controller, Emerson DeltaV PID, FORM Standard"]
        self.assertEqual(change[:3], ["", "Today", "New"])
        gain = change.index("GAIN (%/%)")
        self.assertEqual(change[gain + 1], "1.10")
        self.assertIn("STRUCTURE", change)
        for place in ("/request/implement/y_span/1", "/request/implement/u_span/0", "/request/implement/sample_time",
                      "/request/evaluate/actuator/max"):
            self.assertIn(place, figures)
        # The product's own settings come first; generic forms come after the lines for signatures.
        captions = list(tables)
        self.assertEqual(captions[0], "On your controller, Emerson DeltaV PID, FORM Standard")
        self.assertLess(text.index("Prepared by"), text.index("New settings, by the form of the controller"))
        self.assertNotIn("uncertainty &quot;", text)

    def test_a_change_sheet_goes_from_todays_settings_to_the_new_ones(self):
        implement = {"product": "emerson_deltav_standard", "y_span": [0, 200], "u_span": [0, 100], "sample_time": 0.5}
        today = {"product": "emerson_deltav_standard", "settings": {"GAIN": 1.1, "RESET": 14}}
        request = {"name": "TIC-101 <b>", "units": {"time": "s", "u": "%", "y": "degC"}, "plant": FOPDT,
                   "implement": implement}

        def gain_row(job):
            tree, text, figures = self.checked(job, "", "change-sheet.html")
            for told in ("TIC-101 &lt;b&gt;: change sheet", "Emerson DeltaV PID, FORM Standard", "Prepared by",
                         "Entered in the controller by", job["id"], "<svg"):
                self.assertIn(told, text)
            row = next(row for row in tree.iter(XHTML + "tr") if (row[0].text or "").startswith("GAIN"))
            entry = job["result"]["controllers"][0]
            self.assertIn(entry["verdict"][0]["text"], [element.text for element in tree.iter(XHTML + "li")])
            return ["".join(cell.itertext()) for cell in row.iter(XHTML + "td")], figures, entry

        known = self.job(request | {"baseline": today})
        row, figures, entry = gain_row(known)
        self.assertEqual(row, ["1.10", entry["as_entered"]["as_typed"]["GAIN"]])
        for place in ("performance/load/IAE", "performance/load/TV", "robustness/Ms"):
            for index in (0, 1):
                self.assertIn("/result/controllers/%d/implemented/%s" % (index, place), figures)
        row, _, entry = gain_row(self.job(request))
        self.assertEqual(row, ["", entry["as_entered"]["as_typed"]["GAIN"]])
        address = "/v1/jobs/%s/change-sheet.html" % known["id"]
        for query, status in (("?controller=0", 200), ("?controller=1", 422), ("?controller=2", 404), ("?entry=0", 422)):
            self.assertEqual(self.service.get(address + query).status, status, query)
        self.assertEqual(self.service.get("/v1/jobs/nothing/change-sheet.html").status, 404)
        self.assertEqual(self.service.get(address, {"Accept": "application/json"}).status, 406)

    def test_without_a_product_the_change_sheet_has_the_ideal_form(self):
        _, _, figures = self.checked(self.job(BASE), "", "change-sheet.html")
        for place in ("0/controller/Kp", "0/controller/Ti", "2/controller/Kp", "2/controller/Ti"):
            self.assertIn("/result/controllers/" + place, figures)

    def test_the_set_point_is_drawn_and_what_was_asked_stands_beside_what_was_reached(self):
        job = self.job(BASE | {"tune": [{"method": "robust", "setpoint": {"overshoot": 5}}]})
        _, text, figures = self.checked(job)
        self.assertEqual(text.count("Set point</span>"), 1)
        self.assertTrue(any(at.endswith("options/setpoint/overshoot") for at in figures))
        self.assertIn(", limit: ", text)

    def test_one_step_of_the_set_point_is_called_one_step(self):
        # A PI loop on 2/(20 s + 1) after 3 s, with a controller that moves u in every row.
        y, x, u, integral, rows, delayed = 0.0, 0.0, 0.0, 0.0, [], [0.0] * 6
        noise = [((i * 7919) % 101 - 50) / 5000 for i in range(1200)]
        for i in range(1200):
            r = 10.0 if i < 300 else 12.0
            measured = 10 + y + noise[i]
            integral += 0.5 * (r - measured) * 0.6 / 20
            u = 0.6 * (r - measured) + integral
            rows.append("%g,%.3f,%.4f,%.5f" % (i * 0.5, r, measured, 30 + u))
            delayed.append(u)
            x += 0.5 * (2 * delayed.pop(0) - x) / 20
            y = x
        job = self.job({"record": {"csv": "t,r,y,u\n" + "\n".join(rows)}})
        quality = job["result"]["model"]["data_quality"]
        self.assertEqual(quality["closed_loop"]["set_point_moves"], 1)
        self.assertIn(job["result"]["model"]["grade"], ("good", "usable", "doubtful"))
        _, text, _ = self.checked(job)
        self.assertIn("one step of the set point, in automatic", text)
        self.assertNotIn("several_steps", text)
        self.assertNotIn("several steps", text)

    def test_each_controller_has_a_report(self):
        job = self.job(BASE)
        for index, told in enumerate(("Robust", "SIMC")):
            self.assertIn(told, self.checked(job, "?controller=%d" % index)[1])
        for query, status, told in (("?controller=9", 404, b"numbers 0 to 2"), ("?controller=x", 404, b"There is no controller"),
                                    ("?colour=red", 422, b"the only parameters are controller and utc_offset")):
            answer = self.service.get("/v1/jobs/%s/report.html%s" % (job["id"], query), {"Accept": "text/html"})
            self.assertEqual(answer.status, status, answer.body)
            self.assertIn(told, answer.body)
        self.assertEqual(self.service.get("/v1/jobs/%s/report.html" % job["id"], {"Accept": "application/json"}).status, 406)

    def test_its_policy_allows_its_own_style_alone(self):
        answer = self.report(self.job(BASE))
        policy = answer.headers["Content-Security-Policy"]
        self.assertRegex(policy, r"^default-src 'none'; style-src 'sha256-[A-Za-z0-9+/]{43}=';")
        self.assertNotIn("unsafe", policy)

    def test_whatever_is_typed_stays_text(self):
        units = {"time": "s", "u": "<b>%", "y": "'\"&<i>"}
        attack = ATTACK.replace("\u0001", "")
        job = self.job(BASE | {"name": attack, "units": units})
        tree, text, _ = self.checked(job)
        self.assertNotIn("<script", text)
        self.assertNotIn("<img", text)
        self.assertIn(attack, tree.find(".//" + XHTML + "h1").text)
        nonlinear = {"type": "nonlinear", "states": {"h": 0.5}, "parameters": {"A": 0.5, "k": 0.1},
                     "equations": {"h": "(q - k*sqrt(h))/A + 0*(1<2)"}, "input": {"name": "q", "nominal": 0.07, "min": 0},
                     "output": "h"}
        tree, text, _ = self.checked(self.job({"plant": nonlinear, "name": attack}))
        self.assertIn("0*(1&lt;2)", text)
        csv = "time,<script>u</script>,y</table>\n" + "".join(
            "%d,%g,%g\n" % (t, 0 if t < 5 else 1, 0 if t < 8 else 2 - 2 * 0.8 ** (t - 8)) for t in range(40))
        record = {"csv": csv, "columns": {"t": 1, "u": 2, "y": 3}}
        _, text, _ = self.checked(self.job({"record": record, "identify": {"traces": True}}))
        self.assertNotIn("<script", text)

    def test_a_record_shows_its_model_fit_and_quality(self):
        csv = (EXAMPLES / "tclab-step.csv").read_text()
        job = self.job({"record": {"csv": csv}, "identify": {"traces": True}, "units": {"u": "%", "y": "degC"}})
        tree, text, figures = self.checked(job)
        for place in ("/result/model/fit_percent", "/result/model/plant/K", "/result/model/standard_errors/K",
                      "/result/model/data_quality/noise_std"):
            self.assertIn(place, figures)
        self.assertIn("Record and model", text)
        self.assertEqual(len(list(tree.iter(XHTML + "figure"))), 8)
        self.assertEqual(self.request_of(tree), job["request"])

    def test_a_long_record_is_cut_in_print_and_whole_in_the_file(self):
        t = [0.1 * i for i in range(4000)]
        y = [0 if x < 20 else 2 - 2 * 2.718281828 ** (-(x - 20) / 30) for x in t]
        job = self.job({"record": {"t": t, "u": [0 if x < 15 else 1 for x in t], "y": y}})
        tree, text, _ = self.checked(job)
        self.assertEqual(self.request_of(tree), job["request"])
        self.assertLess(len("".join(tree.find(".//*[@id='request']").itertext())), 12000)
        self.assertIn("4000 in all", text)

    def test_plants_of_every_kind(self):
        points = {"omega": [0.02, 0.05, 0.1, 0.2, 0.3, 0.45, 0.7, 1, 1.5],
                  "re": [1.89655, 1.46248, 0.659816, -0.12158, -0.345674, -0.392635, -0.261892, -0.0475484, 0.127895],
                  "im": [-0.499239, -1.03012, -1.25086, -0.886125, -0.529631, -0.184589, 0.106829, 0.193244, 0.0366325]}
        for request, told in (
                ({"plant": {"type": "set", "plants": ["2 e^(-3s)/(10s+1)", "2.5 e^(-4s)/(8s+1)"]}}, "Several plants"),
                ({"plant": FOPDT | {"uncertainty": {"K": [0.8, 1.2]}}}, "K 0.8 to 1.2"),
                ({"plant": {"type": "frequency_response"} | points}, "Measured points"),
                ({"plant": {"type": "state_space", "A": [[-1, 0], [1, -2]], "B": [1, 0], "C": [0, 1]}}, "<mtable>"),
                ({"plant": FOPDT, "baseline": {"form": "ideal", "Kp": 50, "Ti": 1}}, "Today"),
                ({"plant": FOPDT, "evaluate": {"points": 0}}, "no traces"),
                ({"plant": FOPDT, "evaluate": {"actuator": {"min": -1, "max": 1}, "horizon": 50}}, "max of u"),
                ({"plant": FOPDT, "tune": [{"method": "npid_iae"}]}, "npid"),
                ({"plant": FOPDT, "implement": {"product": "siemens_pid_compact", "y_span": [0, 200], "u_span": [0, 100],
                                                "sample_time": 0.1}}, "On your controller, Siemens PID_Compact")):
            self.assertIn(told, self.checked(self.job(request))[1], request)
        for name in ("spherical-tank", "oscillatory-mass", "unstable-first-order"):
            example = json.loads(next(EXAMPLES.glob("*-" + name + ".json")).read_text())
            self.checked(self.job(example.get("request", example)))

    def test_an_unstable_loop_is_said_to_be_one(self):
        job = self.job({"plant": FOPDT, "tune": [{"method": "simc"}], "baseline": {"form": "ideal", "Kp": 50, "Ti": 1}})
        self.assertIn("The loop is unstable with these settings", self.checked(job, "?controller=1")[1])

    def test_jobs_without_a_result_have_no_report(self):
        impossible = self.service.post_job({"plant": FOPDT, "tune": [{"method": "robust", "Ms": 1.001, "Mks": 0.001}]}, wait=30)
        answer = self.service.get("/v1/jobs/%s/report.html" % impossible["id"], {"Accept": "text/html"})
        self.assertEqual((answer.status, answer.media_type), (404, "application/problem+json"))
        self.assertEqual(self.service.get("/v1/jobs/nothing/report.html", {"Accept": "*/*"}).status, 404)
        running = self.service.post_job(LONG)
        answer = self.service.get("/v1/jobs/%s/report.html" % running["id"], {"Accept": "*/*"})
        self.assertEqual(answer.status, 409)
        self.service.post("/v1/jobs/%s/cancel" % running["id"], {})

    def test_entries_of_a_batch_have_reports(self):
        body = {"jobs": [{"plant": FOPDT, "tune": [{"method": "simc"}]}]}
        batch = self.service.post("/v1/batches", body).json
        for _ in range(200):
            jobs = self.service.get("/v1/jobs?batch=%s" % batch["id"]).json["jobs"]
            if jobs and jobs[0]["status"] == "succeeded":
                break
        job = self.service.get("/v1/jobs/%s" % jobs[0]["id"]).json
        self.assertIn("no traces", self.checked(job)[1])

    def test_the_command_writes_the_same_page(self):
        job = self.job(BASE)
        with tempfile.NamedTemporaryFile("w", suffix=".json") as file:
            json.dump(job, file)
            file.flush()
            done = subprocess.run([BINARY, "report", file.name, "--controller", "1"], capture_output=True, text=True)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        xml.etree.ElementTree.fromstring(done.stdout)
        body = self.report(job, "?controller=1").body.decode()
        self.assertEqual(re.sub(r"http://[^/]*", "", done.stdout), re.sub(r"http://[^/]*", "", body))
        done = subprocess.run([BINARY, "report", "-"], input="{}", capture_output=True, text=True)
        self.assertEqual((done.returncode, done.stdout), (1, ""))


if __name__ == "__main__":
    unittest.main()
