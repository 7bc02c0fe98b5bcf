"""Batches over HTTP: three forms of upload, two forms of results, lists, owners."""

import csv
import io
import json
import socket
import tempfile
import threading
import time
import unittest

import jsonschema

from access_test import bearer, make_key
from batch_bodies import CSV, NDJSON, Upload, amigo_batch, lines, rows_of, wait_for_end
from service import LONG, QUICK, Service


class BatchesTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.service = Service("--workers", "2")
        cls.document = cls.service.get("/openapi.json").json

    @classmethod
    def tearDownClass(cls):
        code = cls.service.stop()
        assert code == 0, "exit code %d: %s" % (code, cls.service.read_log()[-3000:])
        cls.service.folder.cleanup()

    def post(self, body, headers=NDJSON, path="/v1/batches"):
        answer = self.service.post(path, body, headers)
        self.assertEqual(answer.status, 202, answer.body)
        self.check(answer.json, "Batch")
        self.assertEqual(answer.headers["Location"], "/v1/batches/" + answer.json["id"])
        return answer.json["id"]

    def check(self, value, schema):
        jsonschema.Draft202012Validator({"$ref": "#/components/schemas/" + schema},
                                        resolver=jsonschema.RefResolver.from_schema(self.document)).validate(value)

    def follow(self, batch, query=""):
        answer = self.service.get("/v1/batches/%s/results?follow=true%s" % (batch, query))
        self.assertEqual(answer.status, 200, answer.body)
        return answer

    def test_requests_in_json_come_back_in_order(self):
        jobs = [json.loads(line) for line in lines(5).splitlines()]
        batch = self.post({"name": "unit 7", "jobs": jobs}, {"Content-Type": "application/json"})
        rows = rows_of(self.follow(batch))
        self.assertEqual([row["index"] for row in rows], list(range(5)))
        self.assertEqual([row["name"] for row in rows], [job["name"] for job in jobs])
        for row, job in zip(rows, jobs):
            self.check(row, "BatchRow")
            self.assertEqual(row["status"], "succeeded")
            entry = row["result"]["controllers"][0]
            # SIMC with tau_c = L: Kp = T/(K (tau_c + L)).
            self.assertAlmostEqual(entry["controller"]["Kp"], 10 / (job["plant"]["K"] * 6), places=12)
            self.assertNotIn("responses", entry)
        shown = wait_for_end(self.service, batch)
        self.assertEqual((shown["name"], shown["total"], shown["counts"]["succeeded"]), ("unit 7", 5, 5))
        self.assertEqual(shown["progress"]["fraction"], 1)
        self.assertIsNotNone(shown["finished_at"])

    def test_the_name_may_stand_behind_the_requests(self):
        batch = self.post(json.dumps({"jobs": [QUICK] * 1200, "name": "late"}), {"Content-Type": "application/json"})
        self.assertEqual(self.service.get("/v1/batches/" + batch).json["name"], "late")

    def test_an_entry_is_a_job(self):
        batch = self.post(lines(2) + "{}\n")
        rows = rows_of(self.follow(batch))
        job = self.service.job(rows[1]["id"])
        self.check(job, "Job")
        self.assertEqual((job["batch"], job["index"]), (batch, 1))
        self.assertEqual(job["request"]["evaluate"], {"points": 0})
        self.assertEqual(job["result"], rows[1]["result"])
        unread = self.service.job(rows[2]["id"])
        self.check(unread, "Job")
        self.assertIsNone(unread["request"])
        self.assertNotIn("requeue", unread["links"])
        listed = self.service.get("/v1/jobs?batch=" + batch).json["jobs"]
        self.assertEqual({job["id"] for job in listed}, {row["id"] for row in rows})
        self.assertNotIn(job["id"], [job["id"] for job in self.service.get("/v1/jobs?limit=200").json["jobs"]])

    def test_a_bad_line_fails_alone_and_says_where(self):
        batch = self.post(lines(1) + "\nnot json\n" + '{"name": "x", "plant": {"type": "fopdt", "K": 0, "T": 1, "L": 1}}\n' + lines(1))
        rows = rows_of(self.follow(batch))
        self.assertEqual([row["status"] for row in rows], ["succeeded", "failed", "failed", "succeeded"])
        self.assertIn("Request 2, line 3:", rows[1]["error"]["detail"])
        self.assertEqual(rows[2]["name"], "x")
        self.assertEqual(rows[2]["error"]["errors"][0]["pointer"], "/plant/K")
        self.check(rows[2], "BatchRow")

    def test_a_csv_of_loops_and_a_csv_of_results(self):
        body = "Tag;Gain;T [min];L [min]\nTIC-1;2;10;3\n=1+1;0,5;20;4\nbad;x;1;1\n"
        batch = self.post(body, CSV, "/v1/batches?method=robust&Ms=1.6&controller=PI&name=loops")
        answer = self.service.get("/v1/batches/%s/results?follow=true" % batch, {"Accept": "text/csv"})
        self.assertEqual(answer.media_type, "text/csv")
        self.assertIn("batch-%s.csv" % batch, answer.headers["Content-Disposition"])
        table = list(csv.DictReader(io.StringIO(answer.body.decode(), newline="")))
        self.assertEqual([row["name"] for row in table], ["TIC-1", "'=1+1", "bad"])
        self.assertEqual([row["status"] for row in table], ["succeeded", "succeeded", "failed"])
        self.assertEqual([row["Td"] for row in table], ["0", "0", ""])
        for row in table[:2]:
            self.assertEqual(row["method"], "robust")
            self.assertLessEqual(float(row["Ms"]), 1.6 * (1 + 1e-6))
        self.assertIn('line 4: K is "x"', table[2]["error"])
        result = rows_of(self.follow(batch))[0]["result"]
        self.assertEqual(float(table[0]["Kp"]), result["controllers"][0]["controller"]["Kp"])
        self.assertEqual(result["units"], {"time": "min"})
        self.assertEqual(self.service.get("/v1/batches/" + batch).json["name"], "loops")

    def test_what_curl_sends_is_known_by_its_first_bytes(self):
        form = {"Content-Type": "application/x-www-form-urlencoded"}
        for body, count in (('{"jobs": [%s]}' % json.dumps(QUICK), 1), (lines(2), 2), ("K,T,L\n1,2,1\n1,2,2\n1,2,3\n", 3)):
            self.assertEqual(self.service.get("/v1/batches/" + self.post(body, form)).json["total"], count)

    def test_what_is_wrong_with_the_whole_keeps_nothing(self):
        before = self.known()
        json_type = {"Content-Type": "application/json"}
        for body, headers, path, status, words in (
                ('{"jobs": [%s' % json.dumps(QUICK), json_type, "", 400, "ends too early"),
                ('{"jobs": [%s] "x"}' % json.dumps(QUICK), json_type, "", 400, "where a comma or }"),
                ('{"jobs": []}', json_type, "", 422, "no requests"),
                ('{"plant": 1}', json_type, "", 422, "not a member of a batch"),
                ("[]", json_type, "", 422, "is an array"),
                ("{}\n" * 100001, NDJSON, "", 422, "more than 100000"),
                ("name,K,L\na,1,1\n", CSV, "", 422, "T is missing"),
                ("K,T,L\n1,1,1\n", CSV, "?method=simk", 422, "Did you mean simc"),
                ("K,T,L\n1,1,1\n", CSV, "?Ms=0.5", 422, "Ms is 0.5"),
                (lines(1), NDJSON, "?Ms=1.5", 422, "for a CSV of loops"),
                (lines(1), {"Content-Type": "text/plain"}, "", 415, "application/x-ndjson"),
                (lines(1), {**NDJSON, "Content-Encoding": "gzip"}, "", 415, ""),
                (lines(1), {**NDJSON, "Accept": "text/html"}, "", 406, "")):
            answer = self.service.post("/v1/batches" + path, body, headers)
            self.assertEqual(answer.status, status, answer.body)
            self.check(answer.json, "Problem")
            self.assertIn(words, answer.json["detail"])
        self.assertEqual(self.known(), before)

    def known(self):
        return [batch["id"] for batch in self.service.get("/v1/batches?limit=200").json["batches"]]

    def test_ten_thousand_run_and_come_in_order(self):
        batch = self.post(lines(10_000))
        # While it runs, a single job is not delayed.
        single = self.service.post_job(QUICK, wait=30)
        self.assertEqual(single["status"], "succeeded")
        rows = rows_of(self.follow(batch))
        self.assertEqual([row["index"] for row in rows], list(range(10_000)))
        self.assertEqual({row["status"] for row in rows}, {"succeeded"})
        self.assertEqual([row["name"] for row in rows], ["loop %d" % i for i in range(10_000)])
        part = rows_of(self.service.get("/v1/batches/%s/results?from=9990" % batch))
        self.assertEqual(part, rows[9990:])
        table = self.service.get("/v1/batches/%s/results?format=csv" % batch).body.decode().splitlines()
        self.assertEqual(len(table), 10_001)

    def test_the_134_plants_get_robust_controllers(self):
        plants = amigo_batch()
        self.assertEqual(len(plants), 134)
        body = {"jobs": [{"plant": plant, "tune": [{"method": "robust", "Ms": 1.4, "Mt": 1.4}]} for plant in plants]}
        rows = rows_of(self.follow(self.post(body, {"Content-Type": "application/json"})))
        self.assertEqual([row["status"] for row in rows], ["succeeded"] * 134)
        for row in rows:
            robustness = row["result"]["controllers"][0]["robustness"]
            self.assertLessEqual(max(robustness["Ms"], robustness["Mt"]), 1.4 * (1 + 1e-6), row["index"])

    def test_results_of_the_moment_do_not_wait(self):
        batch = self.post(json.dumps(LONG) + "\n" + lines(1))
        rows = rows_of(self.service.get("/v1/batches/%s/results" % batch))
        self.assertEqual(len(rows), 2)
        self.assertIn(rows[0]["status"], ("queued", "running"))
        self.assertEqual(self.service.call("DELETE", "/v1/batches/" + batch).status, 409)
        self.assertEqual(self.service.post("/v1/batches/%s/cancel" % batch, "").status, 202)
        wait_for_end(self.service, batch)

    def test_cancel_stops_what_waits_and_what_runs(self):
        batch = self.post("".join(json.dumps(LONG) + "\n" for _ in range(300)))
        self.service.wait_for_any("running&batch=" + batch)
        follower = threading.Thread(target=lambda: setattr(self, "followed", rows_of(self.follow(batch))))
        follower.start()
        answer = self.service.post("/v1/batches/%s/cancel" % batch, "")
        self.assertEqual(answer.status, 202)
        self.check(answer.json, "Batch")
        self.assertTrue(answer.json["cancel_requested"])
        shown = wait_for_end(self.service, batch, 30)
        self.assertEqual(shown["counts"]["cancelled"], 300)
        follower.join(30)
        self.assertEqual([row["status"] for row in self.followed], ["cancelled"] * 300)
        # Jobs of a batch that was cancelled as a whole cannot be queued again, and have no link for it.
        for job in self.service.get("/v1/jobs?batch=" + batch).json["jobs"][:3]:
            self.assertNotIn("requeue", job["links"])
            self.assertNotIn("requeue", self.service.job(job["id"])["links"])
            self.assertEqual(self.service.post("/v1/jobs/%s/requeue" % job["id"], "").status, 409)
        # A second cancellation changes nothing; then the batch can be deleted, with its jobs.
        self.assertEqual(self.service.post("/v1/batches/%s/cancel" % batch, "").status, 202)
        self.assertEqual(self.service.call("DELETE", "/v1/batches/" + batch).status, 204)
        for path in ("/v1/batches/" + batch, "/v1/batches/%s/results" % batch, "/v1/jobs/" + self.followed[0]["id"]):
            self.assertEqual(self.service.get(path).status, 404)

    def test_the_same_key_and_body_give_the_same_batch(self):
        headers = {**NDJSON, "Idempotency-Key": "key 1"}
        first = self.post(lines(3), headers)
        self.assertEqual(self.post(lines(3), headers), first)
        self.assertEqual(self.service.post("/v1/batches", lines(4), headers).status, 409)
        self.assertEqual(self.service.post("/v1/batches?name=x", lines(3), headers).status, 409)
        self.assertEqual(self.service.post("/v1/batches", lines(1), {**NDJSON, "Idempotency-Key": "k" * 201}).status, 422)
        self.assertEqual(len(rows_of(self.follow(first))), 3)
        self.assertEqual(self.service.call("DELETE", "/v1/batches/" + first).status, 204)
        self.assertNotEqual(self.post(lines(4), headers), first)

    def test_an_upload_that_breaks_off_leaves_nothing(self):
        upload = Upload(self.service, path="/v1/batches?name=broken")
        upload.send(lines(3000))
        end = time.monotonic() + 30
        while not (seen := [batch for batch in self.named("broken") if batch["total"] > 0]):
            self.assertLess(time.monotonic(), end)
            time.sleep(0.01)
        self.assertEqual(seen[0]["status"], "receiving")
        self.check(seen[0], "Batch")
        job = rows_of(self.service.get("/v1/batches/%s/results" % seen[0]["id"]))[0]["id"]
        upload.close()
        while self.named("broken"):
            self.assertLess(time.monotonic(), end)
            time.sleep(0.01)
        self.assertEqual(self.service.get("/v1/jobs/" + job).status, 404)
        self.assertEqual(self.service.get("/v1/jobs?batch=" + seen[0]["id"]).json["jobs"], [])

    def test_a_batch_that_is_cancelled_while_it_comes_is_refused(self):
        upload = Upload(self.service, path="/v1/batches?name=stopped")
        upload.send(lines(3000))
        end = time.monotonic() + 30
        while not (seen := self.named("stopped")):
            self.assertLess(time.monotonic(), end)
            time.sleep(0.01)
        # It is deleted as soon as its receiver knows of the cancellation.
        self.assertIn(self.service.post("/v1/batches/%s/cancel" % seen[0]["id"], "").status, (202, 404))
        upload.send(lines(1500))
        status, body = upload.end()
        self.assertEqual(status, 409, body)
        upload.close()
        # Entries that came after the refusal take no place in the queue.
        figures = self.service.get("/metrics").body.decode()
        waiting = float(next(line for line in figures.splitlines() if line.startswith("tunewright_jobs_queued")).split()[1])
        self.assertLess(waiting, 20_000)

    def named(self, name):
        return [batch for batch in self.service.get("/v1/batches?limit=200").json["batches"] if batch["name"] == name]

    def test_lists_go_from_page_to_page(self):
        made = [self.post(lines(1)) for _ in range(5)]
        found, path = [], "/v1/batches?limit=2"
        while path:
            page = self.service.get(path).json
            self.check(page, "BatchList")
            found += [batch["id"] for batch in page["batches"]]
            path = page["next"]
        self.assertEqual(found[:5], made[::-1])
        self.assertEqual(len(found), len(set(found)))
        for query in ("limit=0", "limit=201", "cursor=x", "color=red"):
            self.assertEqual(self.service.get("/v1/batches?" + query).status, 422)

    def test_conditional_and_other_methods(self):
        batch = self.post(lines(1))
        wait_for_end(self.service, batch)
        path = "/v1/batches/" + batch
        answer = self.service.get(path)
        self.assertEqual(self.service.get(path, {"If-None-Match": answer.headers["ETag"]}).status, 304)
        for path, allowed in (("/v1/batches", "POST, GET, HEAD, OPTIONS"), (path, "GET, DELETE, HEAD, OPTIONS"),
                              (path + "/results", "GET, HEAD, OPTIONS"), (path + "/cancel", "POST, OPTIONS")):
            answer = self.service.call("PUT", path, "")
            self.assertEqual((answer.status, answer.headers["Allow"]), (405, allowed))
        head = self.service.call("HEAD", "/v1/batches/%s/results" % batch)
        self.assertEqual((head.status, head.media_type, head.body), (200, "application/x-ndjson", b""))
        for query in ("format=xml", "follow=yes", "from=-1", "color=red"):
            self.assertEqual(self.service.get("/v1/batches/%s/results?%s" % (batch, query)).status, 422)
        self.assertEqual(self.service.get("/v1/batches/%s/results" % batch, {"Accept": "image/png"}).status, 406)
        for method, path in (("GET", "none"), ("DELETE", "none"), ("GET", "none/results"), ("POST", "none/cancel")):
            self.assertEqual(self.service.call(method, "/v1/batches/" + path).status, 404)

    def test_slow_readers_of_results_hold_nobody_up(self):
        batch = self.post(lines(3000))
        wait_for_end(self.service, batch)
        readers = []
        for _ in range(20):
            reader = socket.create_connection(("127.0.0.1", self.service.port), timeout=30)
            reader.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
            reader.sendall(("GET /v1/batches/%s/results HTTP/1.1\r\nHost: localhost\r\n\r\n" % batch).encode())
            readers.append(reader)
        self.assertEqual(len(rows_of(self.follow(batch))), 3000)
        self.assertEqual(self.service.post_job(QUICK, wait=30)["status"], "succeeded")
        for reader in readers:
            reader.close()


class OwnersTest(unittest.TestCase):
    def test_a_batch_is_its_owners_alone(self):
        with tempfile.TemporaryDirectory() as folder:
            mine, yours = (bearer(make_key(name, folder + "/keys")) for name in ("ann", "bob"))
            with Service("--auth", "keys", "--keys", folder + "/keys") as service:
                batch = service.post("/v1/batches", lines(3), {**NDJSON, **mine}).json["id"]
                for path in ("", "/results"):
                    self.assertEqual(service.get("/v1/batches/" + batch + path, mine).status, 200)
                    self.assertEqual(service.get("/v1/batches/" + batch + path, yours).status, 404)
                self.assertEqual(service.call("POST", "/v1/batches/%s/cancel" % batch, "", yours).status, 404)
                self.assertEqual(service.call("DELETE", "/v1/batches/" + batch, None, yours).status, 404)
                self.assertEqual(len(service.get("/v1/batches", mine).json["batches"]), 1)
                self.assertEqual(service.get("/v1/batches", yours).json["batches"], [])
                self.assertEqual(service.get("/v1/jobs?batch=" + batch, yours).json["jobs"], [])
                self.assertEqual(service.post("/v1/batches", lines(1), NDJSON).status, 401)


if __name__ == "__main__":
    unittest.main()
