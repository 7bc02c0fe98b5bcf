"""Several processes on one PostgreSQL: a client's answers do not depend on the process that it asks."""

import json
import os
import tempfile
import threading
import time
import unittest

from events_test import Stream
from faulty_places import OwnPostgres
from service import LONG, QUICK, Service
from webhook_test import Receiver, make_secret


class ReplicasTest(unittest.TestCase):
    """One process that only answers, one that only computes, and a third that does both but is busy."""

    @classmethod
    def setUpClass(cls):
        cls.place = OwnPostgres().__enter__()
        cls.addClassCleanup(cls.place.__exit__)
        cls.api = cls.start("--role", "api")
        cls.worker = cls.start("--role", "worker", "--workers", "1")

    @classmethod
    def start(cls, *options):
        service = Service("--drain-timeout", "0", *options, store=cls.place.store)
        cls.addClassCleanup(service.__exit__)
        return service

    def running(self, **changes):
        job_id = self.api.post_job(dict(LONG, **changes))["id"]
        self.addCleanup(lambda: (self.cancel(self.api, job_id), self.api.wait_for(job_id)))
        self.api.wait_for(job_id, ("running",))
        return job_id

    @staticmethod
    def cancel(service, job_id):
        return service.post("/v1/jobs/%s/cancel" % job_id, "")

    def test_a_wait_is_answered_when_another_process_has_ended_the_job(self):
        answer = self.api.post("/v1/jobs", QUICK, {"Prefer": "wait=50"})
        self.assertEqual((answer.status, answer.json["status"]), (200, "succeeded"))

    def test_a_cancel_stops_a_job_that_runs_elsewhere(self):
        job_id = self.running()
        start = time.monotonic()
        self.assertEqual(self.cancel(self.api, job_id).status, 202)
        job = self.api.wait_for(job_id)
        self.assertEqual(job["status"], "cancelled")
        self.assertLess(time.monotonic() - start, 5)  # a second on a quiet machine

    def test_progress_and_best_design_come_from_another_process(self):
        job_id = self.running()
        with Stream(self.api, job_id) as stream:
            for event, _, progress in stream:
                self.assertEqual(event, "progress")
                if progress.get("best"):
                    break
            self.assertIn("Kp", progress["best"]["controller"])
            self.assertEqual(self.api.job(job_id)["progress"]["stage"], progress["stage"])
            self.cancel(self.api, job_id)
            last = list(stream)[-1]
        self.assertEqual((last[0], last[2]["status"]), ("done", "cancelled"))

    def test_a_stream_goes_on_at_another_process_without_repeating_what_was_seen(self):
        blocker = self.running()
        queued = self.api.post_job(QUICK)["id"]
        with Stream(self.api, queued) as stream:
            _, event_id, _ = next(iter(stream))
        other = Service("--role", "api", store=self.place.store)
        self.addCleanup(other.__exit__)
        with Stream(other, queued, event_id) as stream:
            self.cancel(self.api, blocker)
            ids = [other_id for _, other_id, _ in stream]
        self.assertNotIn(event_id, ids)
        self.assertEqual(ids[-1], "done")

    def test_a_key_gives_the_same_job_on_every_process(self):
        other = Service("--role", "api", store=self.place.store)
        self.addCleanup(other.__exit__)
        key = {"Idempotency-Key": "key-%d" % time.monotonic_ns()}
        first, again = self.api.post("/v1/jobs", QUICK, key), other.post("/v1/jobs", QUICK, key)
        self.assertEqual((first.status, again.status), (202, 202))
        self.assertEqual(first.json["id"], again.json["id"])

    def test_a_stopped_process_gives_its_job_to_another(self):
        job_id = self.running(timeout_s=10)
        helper = Service("--role", "worker", "--workers", "1", store=self.place.store)
        self.addCleanup(helper.__exit__)
        self.worker.stop()
        try:
            job = self.api.wait_for(job_id)
        finally:
            self.worker.start()
        # The job ran again, this time until its time limit.
        self.assertEqual((job["attempts"], job["error"]["type"]), (2, "timeout"))

    def test_waits_are_answered_when_their_process_is_stopped(self):
        other = Service("--role", "api", store=self.place.store)
        self.running()
        answers = []
        waiter = threading.Thread(
            target=lambda: answers.append(other.post("/v1/jobs", QUICK, {"Prefer": "wait=50"})))
        waiter.start()
        self.api.wait_for_any("queued")
        other.__exit__()
        waiter.join()
        self.assertEqual((answers[0].status, answers[0].json["status"]), (202, "queued"))


class ToldByReplicasTest(unittest.TestCase):
    """Two processes send notifications, and a third without permission gives up none of theirs."""

    def test_each_end_is_told_once(self):
        with OwnPostgres() as place, Receiver() as receiver, tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "secrets")
            make_secret("first", path)
            options = ("--notify-target", receiver.origin, "--notify-secrets", path)
            with Service("--workers", "1", store=place.store), Service("--workers", "1", *options, store=place.store), \
                    Service("--role", "api", *options, store=place.store) as api:
                notify = {"url": receiver.origin + "/in"}
                ids = {api.post_job(dict(QUICK, notify=notify))["id"] for _ in range(40)}
                ids |= {api.post("/v1/batches", {"jobs": [QUICK] * 3, "notify": notify}).json["id"],
                        api.post("/v1/batches", {"notify": notify, "jobs": [QUICK]}).json["id"]}
                told = [json.loads(note[3])["data"]["id"] for note in receiver.wait_for(len(ids))]
                time.sleep(2)
                self.assertEqual(len(receiver.notes), len(ids))
                self.assertEqual(set(told), ids)


if __name__ == "__main__":
    unittest.main()
