"""Progress as server-sent events."""

import http.client
import json
import threading
import unittest

from service import LONG, QUICK, Service


class Stream:
    """One open stream of events."""

    def __init__(self, service, job_id, last_id=None, patience=30):
        self.connection = http.client.HTTPConnection("127.0.0.1", service.port, timeout=patience)
        headers = {"Accept": "text/event-stream"}
        if last_id:
            headers["Last-Event-ID"] = last_id
        self.connection.request("GET", "/v1/jobs/%s/events" % job_id, headers=headers)
        self.response = self.connection.getresponse()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.connection.close()
        self.response.close()

    def __iter__(self):
        """(event, id, data) of each event, without comments and retry."""
        fields = {}
        for line in self.response:
            line = line.decode().rstrip("\n")
            if line and not line.startswith(":"):
                name, _, value = line.partition(": ")
                fields[name] = value
            elif not line and "event" in fields:
                yield fields["event"], fields["id"], json.loads(fields["data"])
                fields = {}


class EventsTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.service = Service("--workers", "1")
        cls.addClassCleanup(cls.service.__exit__)

    def cancel(self, job_id):
        return self.service.post("/v1/jobs/%s/cancel" % job_id, "")

    def running(self):
        job_id = self.service.post_job(LONG)["id"]
        self.addCleanup(self.cancel, job_id)
        self.service.wait_for(job_id, ("running",))
        return job_id

    def test_progress_comes_until_the_end_and_then_done(self):
        job_id = self.service.post_job(dict(LONG, timeout_s=1))["id"]
        with Stream(self.service, job_id) as stream:
            self.assertEqual(stream.response.status, 200)
            self.assertEqual(stream.response.headers["Content-Type"], "text/event-stream")
            self.assertEqual(stream.response.headers["Cache-Control"], "no-store")
            self.assertEqual(stream.response.headers["X-Accel-Buffering"], "no")
            events = list(stream)
        self.assertEqual([event for event, _, _ in events[:-1]], ["progress"] * (len(events) - 1))
        self.assertGreater(len(events), 2)
        fractions = [data["fraction"] for _, _, data in events[:-1]]
        self.assertEqual(fractions, sorted(fractions))
        self.assertLess(len(events), 40)  # far fewer than the steps of the search
        best = [data["best"] for _, _, data in events[:-1] if data.get("best")]
        self.assertIn("Kp", best[-1]["controller"])
        event, event_id, job = events[-1]
        self.assertEqual((event, event_id, job["status"]), ("done", "done", "failed"))
        self.assertEqual(job["error"]["type"], "timeout")
        self.assertFalse({"request", "result"} & set(job))

    def test_ids_name_states_and_are_never_repeated_in_a_stream(self):
        job_id = self.service.post_job(dict(LONG, timeout_s=1))["id"]
        with Stream(self.service, job_id) as stream:
            ids = [event_id for _, event_id, _ in stream]
        self.assertEqual(len(ids), len(set(ids)))

    def test_a_state_that_the_client_has_is_not_sent_again(self):
        blocker = self.running()
        queued = self.service.post_job(QUICK)["id"]
        with Stream(self.service, queued) as stream:
            event, event_id, progress = next(iter(stream))
        self.assertEqual((event, progress["stage"]), ("progress", "queued"))
        with Stream(self.service, queued, event_id) as again:
            self.cancel(blocker)
            for event, other_id, _ in again:
                self.assertNotEqual(other_id, event_id)
        self.assertEqual(event, "done")

    def test_after_done_nothing_more_comes(self):
        job_id = self.service.post_job(QUICK, wait=30)["id"]
        with Stream(self.service, job_id, "done") as stream:
            self.assertEqual((stream.response.status, stream.response.read()), (204, b""))

    def test_after_done_the_next_run_of_a_job_that_is_queued_again_comes(self):
        busy = self.running()
        job_id = self.service.post_job(LONG)["id"]
        self.cancel(job_id)
        with Stream(self.service, job_id, "done") as stream:
            self.assertEqual(stream.response.status, 204)
        self.assertEqual(self.service.post("/v1/jobs/%s/requeue" % job_id, "").status, 202)
        with Stream(self.service, job_id, "done") as stream:
            self.assertEqual(stream.response.status, 200)
            self.assertEqual(next(iter(stream))[0], "progress")
        self.cancel(job_id)
        self.cancel(busy)

    def test_a_finished_job_is_done_at_once(self):
        job_id = self.service.post_job(QUICK, wait=30)["id"]
        with Stream(self.service, job_id) as stream:
            events = list(stream)
        self.assertEqual([event for event, _, _ in events], ["done"])
        self.assertEqual(events[0][2]["status"], "succeeded")

    def test_a_queued_job_that_is_cancelled_is_done(self):
        self.running()
        queued = self.service.post_job(QUICK)["id"]
        with Stream(self.service, queued) as stream:
            events = iter(stream)
            self.assertEqual(next(events)[0], "progress")
            self.cancel(queued)
            event, _, job = next(events)
        self.assertEqual((event, job["status"], job["attempts"]), ("done", "cancelled", 0))

    def test_unknown_jobs_and_other_forms_are_refused(self):
        self.assertEqual(self.service.get("/v1/jobs/0123456789abcdefghjkmnpqrs/events").status, 404)
        job_id = self.service.post_job(QUICK, wait=30)["id"]
        answer = self.service.get("/v1/jobs/%s/events" % job_id, {"Accept": "application/json"})
        self.assertEqual((answer.status, answer.media_type), (406, "application/problem+json"))

    def test_two_hundred_open_streams_do_not_stop_the_service_and_all_see_the_end(self):
        job_id = self.running()
        streams = [Stream(self.service, job_id) for _ in range(200)]
        for stream in streams:
            self.assertEqual(stream.response.status, 200)
        for _ in range(20):
            self.assertEqual(self.service.get("/healthz").status, 200)
            self.assertEqual(self.service.get("/v1/jobs?limit=1").status, 200)
        self.cancel(job_id)
        for stream in streams:
            with stream:
                self.assertEqual(list(stream)[-1][2]["status"], "cancelled")

    def test_streams_whose_clients_have_gone_are_let_go(self):
        job_id = self.running()
        for _ in range(50):
            Stream(self.service, job_id).__exit__()
        self.assertEqual(self.service.get("/healthz").status, 200)


class StopTest(unittest.TestCase):
    def test_streams_end_without_done_when_the_service_is_stopped(self):
        with Service("--workers", "1", "--drain-timeout", "0") as service:
            job_id = service.post_job(LONG)["id"]
            with Stream(service, job_id) as stream:
                events = iter(stream)
                next(events)
                stopper = threading.Thread(target=service.stop)
                stopper.start()
                rest = [event for event, _, _ in events]
                stopper.join()
            self.assertNotIn("done", rest)


if __name__ == "__main__":
    unittest.main()
