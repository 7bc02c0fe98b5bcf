"""The documented behaviour of jobs."""

import json
import csv
import io
import re
import threading
import time
import unittest

from service import FOPDT, LONG, QUICK, Service


class JobTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.service = Service("--workers", "2")
        cls.addClassCleanup(cls.service.__exit__)

    def test_a_posted_job_is_accepted_with_its_address(self):
        answer = self.service.post("/v1/jobs", dict(QUICK, name="TIC-101"))
        self.assertEqual(answer.status, 202)
        self.assertEqual(answer.headers["Location"], "/v1/jobs/" + answer.json["id"])
        self.assertEqual(answer.json["name"], "TIC-101")
        self.assertIn(answer.json["status"], ("queued", "running", "succeeded"))
        job = self.service.wait_for(answer.json["id"])
        self.assertEqual(job["status"], "succeeded", job.get("error"))
        self.assertEqual(job["request"]["plant"]["K"], 2)
        self.assertEqual(job["attempts"], 1)
        self.assertEqual(job["result"]["controllers"][0]["method"], "simc")
        for moment in ("created_at", "started_at", "finished_at"):
            self.assertRegex(job[moment], r"^\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d\.\d{3}Z$")

    def test_ids_cannot_be_guessed(self):
        ids = {self.service.post_job(QUICK)["id"] for _ in range(20)}
        self.assertEqual(len(ids), 20)
        for job_id in ids:
            self.assertTrue(re.fullmatch("[0-9a-z]{26}", job_id), job_id)

    def test_prefer_wait_answers_with_the_finished_job(self):
        answer = self.service.post("/v1/jobs", QUICK, {"Prefer": "respond-async, wait=30"})
        self.assertEqual(answer.status, 200)
        self.assertEqual(answer.json["status"], "succeeded")
        self.assertEqual(answer.headers["Preference-Applied"], "wait=30")

    def test_without_prefer_even_a_quick_job_is_202(self):
        for _ in range(5):
            self.assertEqual(self.service.post("/v1/jobs", QUICK).status, 202)

    def test_a_wait_that_is_over_answers_with_the_unfinished_job(self):
        answer = self.service.post("/v1/jobs", LONG, {"Prefer": "wait=1"})
        self.assertEqual(answer.status, 202)
        self.assertIn(answer.json["status"], ("queued", "running"))
        self.service.post("/v1/jobs/%s/cancel" % answer.json["id"], "")

    def test_what_curl_sends_by_default_is_taken_as_json(self):
        answer = self.service.call("POST", "/v1/jobs", '{"plant":{"type":"fopdt","K":1,"T":1,"L":1}}',
                                   {"Content-Type": "application/x-www-form-urlencoded"})
        self.assertEqual(answer.status, 202)

    def test_a_running_job_can_be_cancelled_within_a_second(self):
        job_id = self.service.post_job(LONG)["id"]
        self.service.wait_for(job_id, ("running",))
        start = time.monotonic()
        answer = self.service.post("/v1/jobs/%s/cancel" % job_id, "")
        self.assertEqual(answer.status, 202)
        job = self.service.wait_for(job_id)
        self.assertEqual(job["status"], "cancelled")
        self.assertLess(time.monotonic() - start, 5)  # about a second on an idle machine
        self.assertIsNotNone(job["finished_at"])

    def test_a_running_job_shows_its_progress(self):
        job_id = self.service.post_job(LONG)["id"]
        progress = self.service.wait_for(job_id, ("running",))["progress"]
        self.assertGreaterEqual(progress["fraction"], 0)
        self.assertIsInstance(progress["message"], str)
        self.service.post("/v1/jobs/%s/cancel" % job_id, "")

    def test_cancelling_an_ended_job_changes_nothing(self):
        job = self.service.post_job(QUICK, wait=30)
        answer = self.service.post("/v1/jobs/%s/cancel" % job["id"], "")
        self.assertEqual(answer.status, 202)
        self.assertEqual(answer.json, job)

    def test_a_job_that_takes_too_long_fails_as_timeout(self):
        job = self.service.post_job(dict(LONG, timeout_s=0.2), wait=30)
        self.assertEqual(job["status"], "failed")
        self.assertEqual(job["error"]["type"], "timeout")
        self.assertIn("timeout_s", job["error"]["detail"])

    def test_only_ended_jobs_can_be_deleted(self):
        job_id = self.service.post_job(LONG)["id"]
        self.assertEqual(self.service.call("DELETE", "/v1/jobs/" + job_id).status, 409)
        self.service.post("/v1/jobs/%s/cancel" % job_id, "")
        self.service.wait_for(job_id)
        answer = self.service.call("DELETE", "/v1/jobs/" + job_id)
        self.assertEqual((answer.status, answer.body), (204, b""))
        self.assertEqual(self.service.get("/v1/jobs/" + job_id).status, 404)
        self.assertEqual(self.service.call("DELETE", "/v1/jobs/" + job_id).status, 404)

    def test_unknown_jobs_are_404_everywhere(self):
        for method, path in (("GET", ""), ("DELETE", ""), ("POST", "/cancel")):
            answer = self.service.call(method, "/v1/jobs/0123456789abcdefghjkmnpqrs" + path)
            self.assertEqual((answer.status, answer.media_type), (404, "application/problem+json"))

    def test_what_is_asked_for_is_quoted_as_utf_8_whatever_its_bytes_are(self):
        for method, path in (("GET", "/v1/jobs/%ff"), ("POST", "/v1/jobs/%ff/cancel"), ("GET", "/v1/batches/%ff"),
                             ("GET", "/v1/jobs/" + "a" * 63 + "%c3%a9")):
            answer = self.service.call(method, path)
            self.assertEqual(answer.status, 404)
            self.assertIn("There is no", json.loads(answer.body.decode("utf-8"))["detail"])

    def test_an_unchanged_job_is_304(self):
        job = self.service.post_job(QUICK, wait=30)
        tag = self.service.get("/v1/jobs/" + job["id"]).headers["ETag"]
        answer = self.service.get("/v1/jobs/" + job["id"], {"If-None-Match": tag})
        self.assertEqual((answer.status, answer.body, answer.headers["ETag"]), (304, b"", tag))
        self.assertEqual(self.service.get("/v1/jobs/" + job["id"], {"If-None-Match": '"other"'}).status, 200)

    def test_a_job_is_deleted_only_in_the_state_that_is_named(self):
        job = self.service.post_job(QUICK, wait=30)
        path = "/v1/jobs/" + job["id"]
        refused = self.service.call("DELETE", path, headers={"If-Match": '"other"'})
        self.assertEqual((refused.status, refused.json["type"]), (412, "precondition-failed"))
        tag = self.service.get(path, {"Accept-Encoding": "gzip"}).headers["ETag"]
        self.assertEqual(self.service.call("DELETE", path, headers={"If-Match": '"other", ' + tag}).status, 204)
        self.assertEqual(self.service.call("DELETE", path, headers={"If-Match": "*"}).status, 404)

    def test_the_tag_of_a_job_changes_when_the_job_does(self):
        job_id = self.service.post_job(LONG)["id"]
        self.service.wait_for(job_id, ("running",))
        tag = self.service.get("/v1/jobs/" + job_id).headers["ETag"]
        self.service.post("/v1/jobs/%s/cancel" % job_id, "")
        self.service.wait_for(job_id)
        answer = self.service.get("/v1/jobs/" + job_id, {"If-None-Match": tag})
        self.assertEqual((answer.status, answer.json["status"]), (200, "cancelled"))
        self.assertNotEqual(answer.headers["ETag"], tag)

    def test_a_cancelled_search_keeps_its_best_design_marked_as_such(self):
        job_id = self.service.post_job(LONG)["id"]
        while not (self.service.job(job_id)["progress"] or {}).get("best"):
            time.sleep(0.01)
        self.service.post("/v1/jobs/%s/cancel" % job_id, "")
        job = self.service.wait_for(job_id)
        self.assertEqual((job["status"], job["partial"]), ("cancelled", True))
        self.assertIn("controller", job["result"]["controllers"][0])

    def test_an_idempotency_key_gives_the_same_job(self):
        key = {"Idempotency-Key": "key-%d" % time.monotonic_ns()}
        first = self.service.post("/v1/jobs", QUICK, key)
        again = self.service.post("/v1/jobs", QUICK, key)
        self.assertEqual((first.status, again.status), (202, 202))
        self.assertEqual(first.json["id"], again.json["id"])
        other = self.service.post("/v1/jobs", dict(QUICK, name="other"), key)
        self.assertEqual((other.status, other.media_type), (409, "application/problem+json"))

    def test_a_request_that_cannot_be_done_ends_failed_with_the_cause(self):
        # A record without any change: no plant follows from it.
        request = {"record": {"t": list(range(50)), "u": [1] * 50, "y": [2] * 50}}
        job = self.service.post_job(request, wait=50)
        self.assertEqual(job["status"], "failed", job.get("result"))
        self.assertEqual(job["error"]["type"], "not-identifiable", job["error"])
        self.assertGreater(len(job["error"]["detail"]), 20)


class ListTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.service = Service()
        cls.addClassCleanup(cls.service.__exit__)
        cls.ids = []
        for i in range(25):
            cls.ids.append(cls.service.post_job(dict(QUICK, name="even & odd" if i % 2 else "even"), wait=30)["id"])

    def pages(self, path):
        seen = []
        while path:
            answer = self.service.get(path)
            self.assertEqual(answer.status, 200, answer.body)
            seen.append(answer.json["jobs"])
            path = answer.json["next"]
        return seen

    def test_pages_hold_every_job_once_newest_first(self):
        pages = self.pages("/v1/jobs?limit=10")
        self.assertEqual([len(page) for page in pages], [10, 10, 5])
        self.assertEqual([job["id"] for page in pages for job in page], self.ids[::-1])

    def test_pages_do_not_move_when_jobs_are_added(self):
        first = self.service.get("/v1/jobs?limit=10").json
        added = self.service.post_job(QUICK, wait=30)["id"]
        second = self.service.get(first["next"]).json
        self.assertEqual([job["id"] for job in first["jobs"] + second["jobs"]], self.ids[::-1][:20])
        self.assertEqual(self.service.call("DELETE", "/v1/jobs/" + added).status, 204)

    def test_a_list_leaves_out_requests_and_results(self):
        for job in self.pages("/v1/jobs")[0]:
            self.assertFalse({"request", "result", "error"} & set(job))

    def test_filters_hold_on_every_page(self):
        jobs = [job for page in self.pages("/v1/jobs?name=even%20%26%20odd&limit=5&status=succeeded") for job in page]
        self.assertEqual([job["id"] for job in jobs], self.ids[1::2][::-1])
        self.assertEqual(self.pages("/v1/jobs?status=failed"), [[]])

    def test_a_list_says_what_came_out_and_is_searched_by_it(self):
        outline = self.service.get("/v1/jobs?q=EVEN&limit=1").json["jobs"][0]["outline"]
        self.assertEqual(outline["plant"]["type"], "fopdt")
        self.assertEqual(self.service.get("/v1/jobs?q=" + outline["method"] + "&limit=200").json["jobs"][0]["id"], self.ids[-1])
        self.assertEqual(self.pages("/v1/jobs?q=nowhere"), [[]])

    def test_wrong_parameters_are_all_named(self):
        answer = self.service.get("/v1/jobs?status=done&limit=0&cursor=x&colour=red")
        self.assertEqual(answer.status, 422)
        self.assertEqual({error["pointer"] for error in answer.json["errors"]},
                         {"/status", "/limit", "/cursor", "/colour"})
        answer = self.service.post("/v1/jobs?Ms=1.2&wait=5", QUICK)
        self.assertEqual(answer.status, 422)
        self.assertEqual({error["pointer"] for error in answer.json["errors"]}, {"/Ms", "/wait"})


class QueueTest(unittest.TestCase):
    def test_a_full_queue_is_429_with_retry_after(self):
        with Service("--workers", "1", "--queue-limit", "2", "--drain-timeout", "0") as service:
            running = service.post_job(LONG)["id"]
            service.wait_for(running, ("running",))
            waiting = [service.post_job(LONG)["id"] for _ in range(2)]
            answer = service.post("/v1/jobs", LONG)
            self.assertEqual((answer.status, answer.media_type), (429, "application/problem+json"))
            self.assertIn(int(answer.headers["Retry-After"]), range(1, 61))
            self.assertEqual(len(answer.headers.get_all("Retry-After")), 1)
            # A queued job is cancelled at once, which makes room.
            self.assertEqual(service.post("/v1/jobs/%s/cancel" % waiting[0], "").json["status"], "cancelled")
            self.assertEqual(service.post("/v1/jobs", LONG).status, 202)
            # A job that is queued again waits like any other.
            full = service.post("/v1/jobs/%s/requeue" % waiting[0], "")
            self.assertEqual(full.status, 429)
            self.assertIn(int(full.headers["Retry-After"]), range(1, 61))
            service.post("/v1/jobs/%s/cancel" % waiting[1], "")
            self.assertEqual(service.post("/v1/jobs/%s/requeue" % waiting[0], "").status, 202)
            self.assertEqual(service.post("/v1/jobs", LONG).status, 429)

    def test_a_single_job_overtakes_the_entries_of_a_batch(self):
        with Service("--workers", "1", "--drain-timeout", "0") as service:
            entry = dict(LONG, timeout_s=1)
            batch = service.post("/v1/batches", {"jobs": [entry] * 5}).json["id"]
            job = service.post_job(QUICK, wait=50)
            self.assertEqual(job["status"], "succeeded")
            waiting = service.get("/v1/jobs?status=queued&batch=" + batch).json["jobs"]
            self.assertGreaterEqual(len(waiting), 2)
            self.assertEqual(service.get("/v1/jobs?status=queued").json["jobs"], [])

    def test_ended_jobs_are_deleted_when_their_retention_is_over(self):
        with Service("--retention", "1s") as service:
            job_id = service.post_job(QUICK, wait=30)["id"]
            while service.get("/v1/jobs/" + job_id).status != 404:
                time.sleep(0.05)

    def test_a_thousand_jobs_of_eight_clients_all_end_and_health_stays_quick(self):
        with Service("--workers", "2") as service:
            ids, faults, slow = [], [], []
            lock = threading.Lock()
            posting = threading.Event()

            def client():
                for _ in range(125):
                    answer = service.post("/v1/jobs", QUICK)
                    with lock:
                        (ids if answer.status == 202 else faults).append(answer.json)

            def probe():
                while not posting.is_set():
                    start = time.monotonic()
                    status = service.get("/healthz").status
                    slow.append(time.monotonic() - start)
                    if status != 200:
                        faults.append(status)

            clients = [threading.Thread(target=client) for _ in range(8)]
            prober = threading.Thread(target=probe)
            prober.start()
            for thread in clients:
                thread.start()
            for thread in clients:
                thread.join()
            posting.set()
            prober.join()
            self.assertEqual(faults, [])
            self.assertEqual(len({job["id"] for job in ids}), 1000)
            for job in ids:
                self.assertEqual(service.wait_for(job["id"], patience=120)["status"], "succeeded")
            slow.sort()
            print("healthz during 1,000 jobs: p99 %.1f ms" % (1e3 * slow[int(0.99 * len(slow))]))


class TracesTest(unittest.TestCase):
    def test_traces_of_a_job_are_columns(self):
        with Service() as service:
            job = service.post_job({"plant": FOPDT, "units": {"y": "degC"}, "tune": [{"method": "simc"}, {"method": "robust"}],
                                    "evaluate": {"points": 11, "horizon": 50}}, wait=30)
            answer = service.get("/v1/jobs/%s/result.csv" % job["id"])
            self.assertEqual((answer.status, answer.media_type), (200, "text/csv"))
            table = list(csv.reader(io.StringIO(answer.body.decode(), newline="")))
            self.assertEqual(table[0][:3], ["t [s]", "simc setpoint y [degC]", "simc setpoint u"])
            self.assertEqual([float(row[0]) for row in table[1:]], [5.0 * i for i in range(11)])
            robust = job["result"]["controllers"][1]["responses"]["load"]["u"]
            self.assertEqual([float(row[table[0].index("robust load u")]) for row in table[1:]], robust)
            frequency = service.get("/v1/jobs/%s/result.csv?traces=frequency" % job["id"]).body.decode()
            self.assertTrue(frequency.startswith("simc omega [rad/s],simc L re"), frequency[:100])
            for path, status in (("none/result.csv", 404), (job["id"] + "/result.csv?traces=all", 422),
                                 (job["id"] + "/result.csv?traces=model", 404)):
                self.assertEqual(service.get("/v1/jobs/" + path).status, status)
            without = service.post_job(QUICK, wait=30)
            answer = service.get("/v1/jobs/%s/result.csv" % without["id"])
            self.assertEqual(answer.status, 404)
            self.assertIn("evaluate.points 0", answer.json["detail"])
            running = service.post_job(LONG)
            self.assertEqual(service.get("/v1/jobs/%s/result.csv" % running["id"]).status, 409)
            service.post("/v1/jobs/%s/cancel" % running["id"], "")


if __name__ == "__main__":
    unittest.main()
