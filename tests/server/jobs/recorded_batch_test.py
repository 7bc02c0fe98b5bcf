"""Records of many loops over HTTP: each loop becomes a job."""

import csv
import io
import unittest
import xml.etree.ElementTree

from batch_bodies import rows_of, wait_for_end
from check_command_test import plant
from service import Service

TEXT = {"Content-Type": "text/csv"}
FORM = {"Content-Type": "multipart/form-data; boundary=cut"}


def form(*parts):
    """A body of parts (name, file, text), as curl -F sends them."""
    body = ""
    for name, file, text in parts:
        head = 'form-data; name="%s"' % name + ('; filename="%s"' % file if file else "")
        body += "--cut\r\nContent-Disposition: %s\r\nContent-Type: text/csv\r\n\r\n%s\r\n" % (head, text)
    return body + "--cut--\r\n"


def tag_file(tag, part, rows=400):
    """Time and value of one tag of plant([tag])."""
    column = {"PV": 1, "OP": 2}[part]
    lines = plant([tag], rows).splitlines()
    return "\n".join(["Time,Value"] + [",".join((line.split(",")[0], line.split(",")[column])) for line in lines[1:]])


class RecordedBatchTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.service = Service("--workers", "2")

    @classmethod
    def tearDownClass(cls):
        code = cls.service.stop()
        assert code == 0, "exit code %d: %s" % (code, cls.service.read_log()[-3000:])
        cls.service.folder.cleanup()

    def post(self, body, query="", headers=TEXT, status=202):
        answer = self.service.post("/v1/batches?kind=check" + query, body, headers)
        self.assertEqual(answer.status, status, answer.body)
        return answer.json

    def rows(self, batch):
        return rows_of(self.service.get("/v1/batches/%s/results?follow=true" % batch["id"]))

    def test_each_loop_is_a_job(self):
        tags = ["FIC%d" % i for i in range(30)]
        batch = self.post(plant(tags, rows=2000), "&name=unit+7&units.time=min")
        self.assertEqual((batch["name"], batch["total"]), ("unit 7", len(tags)))
        rows = self.rows(batch)
        self.assertEqual([row["name"] for row in rows], tags)
        for row in rows:
            self.assertEqual(row["status"], "succeeded")
            self.assertEqual(row["result"]["loops"][0]["tag"], row["name"])
            self.assertAlmostEqual(row["result"]["loops"][0]["quality"]["sample_time"], 1 / 6, places=9)
        self.assertEqual(wait_for_end(self.service, batch["id"])["counts"]["succeeded"], len(tags))

    def test_the_judgement_together_keeps_what_each_loop_has_by_itself(self):
        batch = self.post(plant(["FIC1", "FIC2"], rows=2000))
        alone = {row["name"]: row["result"]["loops"][0] for row in self.rows(batch)}
        answer = self.service.get("/v1/batches/%s/check" % batch["id"]).json
        self.assertEqual([loop["tag"] for loop in answer["loops"]], ["FIC1", "FIC2"])
        disturbed = {rank["loop"] for rank in answer["ranking"] if "after" in rank}
        for place, loop in enumerate(answer["loops"]):
            if place not in disturbed:
                self.assertEqual((loop["cause"], loop["action"]), (alone[loop["tag"]]["cause"], alone[loop["tag"]]["action"]))

    def test_a_loop_that_cannot_be_read_fails_alone(self):
        good, bad = plant(["FIC1"]).splitlines(), plant(["FIC2"], quiet=True).splitlines()
        table = [good[0] + "," + bad[0].split(",", 1)[1]]
        table += [a + "," + b.split(",", 1)[1] for a, b in zip(good[1:], bad[1:])]
        rows = self.rows(self.post("\n".join(table)))
        self.assertEqual([(row["name"], row["status"]) for row in rows], [("FIC1", "succeeded"), ("FIC2", "failed")])
        self.assertIn("FIC2", rows[1]["error"]["detail"])

    def test_what_is_known_of_the_loops_comes_with_them(self):
        table = "tag,kind,op_low,op_high,weight\nFIC2,level,0,40,12.5\nFIC9,flow,,,\n"
        batch = self.post(form(("loops", "", table), ("file", "day.csv", plant(["FIC1", "FIC2"]))), "&settings=true",
                          FORM)
        self.assertEqual(batch["notes"], ["FIC9 is in the table of loops, but no record has this tag."])
        self.assertNotIn("notes", self.service.get("/v1/batches/" + batch["id"]).json)
        rows = self.rows(batch)
        request = self.service.get("/v1/jobs/" + rows[1]["id"]).json["request"]
        self.assertTrue(request["settings"])
        self.assertEqual({name: request["loops"][0][name] for name in ("tag", "kind", "range", "weight")},
                         {"tag": "FIC2", "kind": "level", "range": {"op": [0, 40]}, "weight": 12.5})
        self.assertEqual([row["result"]["loops"][0].get("weight") for row in rows], [None, 12.5])
        problem = self.post(form(("loops", "", "tag,kind\nFIC1,flow\nFIC2,flw\n"), ("file", "a", plant(["FIC1"]))),
                            headers=FORM, status=422)
        self.assertIn("Line 3, kind", problem["errors"][0]["detail"])
        self.assertEqual(self.service.post("/v1/batches", form(), FORM).status, 422)
        self.assertEqual(self.service.post("/v1/batches?kind=check", "x", {"Content-Type": "multipart/form-data"}).status,
                         400)

    def test_a_file_for_each_tag(self):
        whole = self.rows(self.post(plant(["FIC1"])))[0]["result"]["loops"][0]
        batch = self.post(form(("file", "FIC1.PV.csv", tag_file("FIC1", "PV")),
                               ("file", "FIC1.OP.csv", tag_file("FIC1", "OP")),
                               ("file", "TI3.PV.csv", tag_file("TI3", "PV"))), headers=FORM)
        self.assertEqual(batch["total"], 1)
        self.assertIn("TI3 has only a measurement", batch["notes"][0])
        loop = self.rows(batch)[0]["result"]["loops"][0]
        self.assertEqual((loop["tag"], loop["quality"]["rows"], loop["cause"]["verdict"]),
                         ("FIC1", 400, whole["cause"]["verdict"]))
        self.assertEqual(loop["performance"], whole["performance"])

    def test_findings_of_reading_are_remarks_on_the_record(self):
        lines = plant(["FIC1"]).splitlines()
        lines[7] = lines[7].split(",")[0] + ",Bad," + lines[7].split(",")[2]
        loop = self.rows(self.post("\n".join(lines)))[0]["result"]["loops"][0]
        self.assertIn({"code": "file-read", "level": "warning",
                       "detail": "1 value of the measurement or the output is of bad quality and counts as missing."},
                      loop["quality"]["remarks"])

    def test_the_batch_has_a_report_and_a_line_for_each_loop(self):
        good, bad = plant(["FIC1", "FIC2"]).splitlines(), plant(["FIC3"], quiet=True).splitlines()
        table = [a + "," + b.split(",", 1)[1] for a, b in zip(good, bad)]
        batch = self.post("\n".join(table), "&name=unit+7")
        wait_for_end(self.service, batch["id"])
        address = "/v1/batches/" + batch["id"]
        report = self.service.get(address + "/report.html?utc_offset=60")
        self.assertEqual((report.status, report.headers["Content-Type"]), (200, "text/html; charset=utf-8"))
        text = report.body.decode()
        xml.etree.ElementTree.fromstring(text.replace("<!DOCTYPE html>", ""))
        self.assertIn("<h1>unit 7: loop check</h1>", text)
        self.assertEqual(text.count('<section class="loop">'), 2)
        self.assertIn("Whole record", text)
        self.assertIn("FIC3: Request 3, FIC3: FIC3.PV has no value of good quality.", text)
        self.assertEqual(self.service.get(address + "/report.html?from=3").status, 422)
        self.assertEqual(self.service.get("/v1/batches/none/report.html").status, 404)
        lines = list(csv.DictReader(io.StringIO(self.service.get(address + "/results?format=csv").body.decode())))
        self.assertEqual([(line["tag"], line["status"]) for line in lines],
                         [("FIC1", "succeeded"), ("FIC2", "succeeded"), ("", "failed")])
        alone = self.rows(batch)[0]["result"]
        self.assertEqual(lines[0]["verdict"], alone["loops"][0]["cause"]["verdict"])
        self.assertEqual(float(lines[0]["mean_error"]), alone["loops"][0]["performance"]["mean_error"])
        self.assertIn("no value of good quality", lines[2]["error"])
        tuned = self.service.post("/v1/batches", "name,K,T,L\na,1,2,3\n", TEXT).json
        wait_for_end(self.service, tuned["id"])
        self.assertEqual(self.service.get("/v1/batches/%s/report.html" % tuned["id"]).status, 409)
        self.assertIn("Kp", self.service.get("/v1/batches/%s/results?format=csv" % tuned["id"]).body.decode().splitlines()[0])

    def test_parameters(self):
        body = plant(["FIC1"])
        for query, pointer in (("&Ms=1.6", "/Ms"), ("&method=simc", "/method")):
            problem = self.post(body, query, status=422)
            self.assertEqual(problem["errors"][0]["pointer"], pointer)
        answer = self.service.post("/v1/batches?kind=chek", body, TEXT)
        self.assertEqual((answer.status, answer.json["errors"][0]["pointer"]), (422, "/kind"))
        self.post("name,K,T,L\na,1,2,3\n", status=422)
        same = self.service.post("/v1/batches?kind=tune&Ms=1.6", "name,K,T,L\na,1,2,3\n", TEXT)
        self.assertEqual(same.status, 202)

    def test_requests_need_no_parameter(self):
        loop = '{"loops": [{"tag": "A", "csv": "%s"}]}' % plant(["A"]).replace("\n", "\\n")
        headers = {"Content-Type": "application/x-ndjson"}
        for query in ("?kind=check", ""):
            answer = self.service.post("/v1/batches" + query, loop + "\n" + loop, headers)
            self.assertEqual((answer.status, answer.json["total"]), (202, 2))
