"""The administrator's view and calls: everybody's jobs, the queue as a whole, jobs queued again, logs."""

import json
import os
import subprocess
import tempfile
import time
import unittest

from service import BINARY, LONG, QUICK, Service

TRACE = "00-4bf92f3577b34da6a3ce929d0e0e4736-00f067aa0ba902b7-01"


def make_key(name, path, *more):
    return subprocess.run([BINARY, "key", name, "--keys", path, *more], check=True, capture_output=True,
                          text=True).stdout.strip()


def bearer(key):
    return {"Authorization": "Bearer " + key}


class OperatorTest(unittest.TestCase):
    """With keys: two owners, and an administrator."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="tunewright-operator-")
        self.addCleanup(folder.cleanup)
        path = os.path.join(folder.name, "keys")
        self.ann, self.bob, self.boss = (bearer(make_key(name, path, *more)) for name, *more in
                                         (("ann",), ("bob",), ("boss", "--admin")))
        self.service = Service("--auth", "keys", "--keys", path, "--workers", "1", "--drain-timeout", "0")
        self.addCleanup(self.service.__exit__)

    def post(self, request, key):
        answer = self.service.call("POST", "/v1/jobs", request, key)
        self.assertEqual(answer.status, 202, answer.body)
        return answer.json["id"]

    def ended(self, job_id):
        while (job := self.service.get("/v1/jobs/" + job_id, self.boss).json)["status"] in ("queued", "running"):
            time.sleep(0.01)
        return job

    def listed(self, key, more=""):
        return [job["id"] for job in self.service.get("/v1/jobs" + more, key).json["jobs"]]

    def test_whoever_runs_it_sees_everybodys_jobs_and_the_others_their_own(self):
        of_ann, of_bob = self.post(QUICK, self.ann), self.post(QUICK, self.bob)
        self.assertEqual(self.listed(self.ann), [of_ann])
        self.assertEqual(self.listed(self.boss), [of_bob, of_ann])
        self.assertEqual(self.listed(self.boss, "?owner=ann"), [of_ann])
        owners = [job["owner"] for job in self.service.get("/v1/jobs", self.boss).json["jobs"]]
        self.assertEqual(owners, ["bob", "ann"])
        self.assertEqual(self.service.get("/v1/jobs?owner=bob", self.ann).status, 422)
        self.assertEqual(self.service.get("/v1/jobs/" + of_bob, self.ann).status, 404)

    def test_he_cancels_and_deletes_them(self):
        job_id = self.post(LONG, self.ann)
        self.assertEqual(self.service.call("POST", "/v1/jobs/%s/cancel" % job_id, "", self.bob).status, 404)
        self.assertEqual(self.service.call("POST", "/v1/jobs/%s/cancel" % job_id, "", self.boss).status, 202)
        self.assertEqual(self.ended(job_id)["status"], "cancelled")
        self.assertEqual(self.service.call("DELETE", "/v1/jobs/" + job_id, headers=self.boss).status, 204)

    def test_the_queue_is_his_alone(self):
        for method, path in (("GET", "/v1/queue"), ("POST", "/v1/queue/pause"), ("POST", "/v1/queue/resume")):
            refused = self.service.call(method, path, "" if method == "POST" else None, self.ann)
            self.assertEqual((refused.status, refused.json["type"]), (403, "forbidden"), path)
            self.assertIn("--admin", refused.json["detail"])

    def test_a_paused_queue_takes_jobs_and_begins_none_through_a_restart_too(self):
        self.assertEqual(self.service.call("POST", "/v1/queue/pause", "", self.boss).json, {"paused": True})
        job_id = self.post(QUICK, self.ann)
        self.service.kill()
        self.service.start()
        time.sleep(1.2)
        queue = self.service.get("/v1/queue", self.boss).json
        self.assertTrue(queue["paused"])
        self.assertEqual((queue["queued"]["single"], queue["this_process"]["running"]), (1, 0))
        self.assertIsNotNone(queue["next_accepted_at"]["single"])
        self.assertEqual(self.service.call("POST", "/v1/queue/resume", "", self.boss).json, {"paused": False})
        self.assertEqual(self.ended(job_id)["status"], "succeeded")

    def test_the_queue_says_at_once_whether_it_is_paused(self):
        for word, paused in (("pause", True), ("resume", False)) * 3:
            self.service.call("POST", "/v1/queue/" + word, "", self.boss)
            self.assertEqual(self.service.get("/v1/queue", self.boss).json["paused"], paused)

    def test_a_job_that_failed_is_queued_again_by_its_owner_or_by_him(self):
        job_id = self.post(dict(LONG, timeout_s=0.05), self.ann)
        failed = self.ended(job_id)
        self.assertEqual((failed["status"], failed["attempts"]), ("failed", 1))
        again = failed["links"]["requeue"]
        self.assertEqual(self.service.call("POST", again, "", self.bob).status, 404)
        for key, attempts in ((self.ann, 2), (self.boss, 3)):
            waiting = self.service.call("POST", again, "", key)
            self.assertEqual(waiting.status, 202)
            self.assertIn(waiting.json["status"], ("queued", "running", "failed"))
            self.assertEqual(self.ended(job_id)["attempts"], attempts)

    def test_a_cancelled_batch_that_had_ended_before_keeps_its_entries_fit_for_another_try(self):
        lines = json.dumps(dict(LONG, timeout_s=0.05))
        batch = self.service.call("POST", "/v1/batches", lines, {"Content-Type": "application/x-ndjson", **self.ann}).json
        while self.service.get("/v1/batches/" + batch["id"], self.ann).json["status"] != "ended":
            time.sleep(0.02)
        self.assertFalse(self.service.call("POST", "/v1/batches/%s/cancel" % batch["id"], "", self.ann).json["cancel_requested"])
        entry = self.service.get("/v1/jobs?batch=" + batch["id"], self.ann).json["jobs"][0]
        self.assertEqual(self.service.call("POST", entry["links"]["requeue"], "", self.ann).status, 202)

    def test_what_succeeded_is_not_queued_again(self):
        job_id = self.post(QUICK, self.ann)
        self.assertNotIn("requeue", self.ended(job_id)["links"])
        refused = self.service.call("POST", "/v1/jobs/%s/requeue" % job_id, "", self.ann)
        self.assertEqual(refused.status, 409)
        self.assertIn("failed or was cancelled", refused.json["detail"])

    def test_an_entry_that_is_queued_again_opens_its_batch(self):
        lines = "\n".join(json.dumps(dict(LONG, timeout_s=0.05)) for _ in range(2))
        batch = self.service.call("POST", "/v1/batches", lines, {"Content-Type": "application/x-ndjson", **self.ann}).json

        def now():
            return self.service.get("/v1/batches/" + batch["id"], self.ann).json

        while now()["status"] != "ended":
            time.sleep(0.02)
        self.service.call("POST", "/v1/queue/pause", "", self.boss)
        entry = self.service.get("/v1/jobs?batch=" + batch["id"], self.ann).json["jobs"][0]["id"]
        self.assertEqual(self.service.call("POST", "/v1/jobs/%s/requeue" % entry, "", self.ann).status, 202)
        self.assertEqual((now()["counts"]["queued"], now()["counts"]["failed"], now()["finished_at"]), (1, 1, None))
        self.service.call("POST", "/v1/queue/resume", "", self.boss)
        while now()["status"] != "ended":
            time.sleep(0.02)
        self.assertEqual(now()["counts"]["failed"], 2)


class OwnMachineTest(unittest.TestCase):
    """Without keys every caller on the machine is an administrator, but not through a proxy."""

    def test_on_loopback_the_queue_is_at_hand(self):
        with Service() as service:
            self.assertEqual(service.get("/v1/queue").json["paused"], False)

    def test_behind_a_proxy_it_is_not(self):
        with Service("--behind-proxy") as service:
            self.assertEqual(service.get("/v1/queue").status, 403)

    def test_batches_go_on_however_many_single_jobs_come(self):
        with Service("--workers", "1") as service:
            service.post("/v1/queue/pause", "")
            for _ in range(60):
                service.post_job(QUICK)
            batch = service.call("POST", "/v1/batches", "\n".join([json.dumps(QUICK)] * 3),
                                 {"Content-Type": "application/x-ndjson"}).json["id"]
            service.post("/v1/queue/resume", "")
            while service.get("/v1/batches/" + batch).json["status"] != "ended":
                time.sleep(0.005)
            ends = [job["started_at"] for job in service.get("/v1/jobs?limit=200").json["jobs"]]
            first = min(job["started_at"] for job in service.get("/v1/jobs?batch=" + batch).json["jobs"])
            self.assertLess(first, max(end for end in ends if end), "an entry began before the last single job")


class LogTest(unittest.TestCase):
    def events(self, service, kind, count):
        """The log is written a moment after the event."""
        for _ in range(1000):
            lines = [json.loads(line) for line in service.read_log().splitlines() if line.startswith("{")]
            found = [line for line in lines if line.get("event") == kind and line.get("method") != "GET"]
            if len(found) >= count:
                return found
            time.sleep(0.01)
        self.fail(f"{len(found)} lines of {kind}, not {count}")

    def test_a_jobs_line_names_the_call_that_posted_it_and_its_trace(self):
        with Service("--log-format", "json") as service:
            job = service.call("POST", "/v1/jobs", QUICK, {"X-Request-Id": "call-7", "traceparent": TRACE,
                                                           "Prefer": "wait=20"}).json
            line = self.events(service, "job", 1)[0]
            self.assertEqual((line["id"], line["request_id"], line["traceparent"]), (job["id"], "call-7", TRACE))
            call = self.events(service, "request", 1)[0]
            self.assertEqual((call["id"], call["traceparent"]), ("call-7", TRACE))

    def test_a_trace_that_is_none_goes_nowhere(self):
        with Service("--log-format", "json") as service:
            all_wrong = (TRACE.upper(), TRACE + "-x", "00-" + "0" * 32 + TRACE[35:], 'x","a":"b')
            for wrong in all_wrong:
                service.call("POST", "/v1/jobs", QUICK, {"traceparent": wrong, "Prefer": "wait=20"})
            self.assertEqual({line["traceparent"] for line in self.events(service, "job", len(all_wrong))}, {""})
