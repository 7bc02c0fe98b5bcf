"""Scheduled jobs, unique jobs, and a limit of jobs per client: on SQLite and, if available, on PostgreSQL, whose
processes share them."""

import datetime
import time
import unittest

from faulty_places import OwnPostgres
from service import LONG, QUICK, Service


def moment(seconds):
    """The time this number of seconds from now, in the notation of a request."""
    at = datetime.datetime.now(datetime.timezone.utc) + datetime.timedelta(seconds=seconds)
    return at.strftime("%Y-%m-%dT%H:%M:%S.") + "%03dZ" % (at.microsecond // 1000)


def seconds(text):
    return datetime.datetime.fromisoformat(text.replace("Z", "+00:00")).timestamp()


class Cases:
    """Properties of every store. `processes` share one."""

    @classmethod
    def start(cls, count, *options):
        cls.processes = []
        for _ in range(count):
            service = Service("--workers", "1", "--drain-timeout", "0", *options, store=cls.store)
            cls.addClassCleanup(service.__exit__)
            cls.processes.append(service)

    @property
    def first(self):
        return self.processes[0]

    @property
    def last(self):
        return self.processes[-1]

    def tearDown(self):
        for status in ("queued", "running"):
            for job in self.first.get("/v1/jobs?limit=200&status=" + status).json["jobs"]:
                self.first.post("/v1/jobs/%s/cancel" % job["id"], "")
                self.first.wait_for(job["id"])

    def test_a_job_starts_at_its_time(self):
        at = moment(3)
        job = self.first.post_job(dict(QUICK, not_before=at))
        self.assertEqual((job["status"], job["not_before"]), ("queued", at))
        self.assertEqual(job["progress"]["message"], "Waits for its time.")
        # Counted once a second: no job's turn has come, and none is late.
        while self.first.get("/v1/queue").json["next_accepted_at"]["single"] is not None:
            self.assertLess(time.time(), seconds(at))
            time.sleep(0.02)
        listed = self.last.get("/v1/jobs?status=queued").json["jobs"]
        self.assertEqual([(each["id"], each["not_before"]) for each in listed], [(job["id"], at)])
        ended = self.last.wait_for(job["id"])
        self.assertEqual((ended["status"], ended["not_before"]), ("succeeded", at))
        self.assertGreaterEqual(seconds(ended["started_at"]), seconds(at))
        self.assertLess(seconds(ended["started_at"]) - seconds(at), 5)  # half a second on a quiet machine

    def test_a_time_in_the_past_means_at_once(self):
        job = self.first.post_job(dict(QUICK, not_before="2020-01-01T00:00:00Z"), wait=30)
        self.assertEqual(job["status"], "succeeded")
        self.assertNotIn("not_before", job)

    def test_a_time_that_cannot_be_is_refused_with_its_cure(self):
        for value, part in (("tomorrow", "it must be a time such as"), (17, "it must be a time such as"),
                            ("2026-05-04T06:00:00", "end it with Z"), ("2026-05-04", "it must be a time such as"),
                            ("04.05.2026 06:00Z", "it must be a time such as"),
                            (moment(31 * 86400), "more than 30 days ahead")):
            answer = self.first.post("/v1/jobs", dict(QUICK, not_before=value))
            self.assertEqual(answer.status, 422, answer.body)
            self.assertEqual(answer.json["errors"][0]["pointer"], "/not_before")
            self.assertIn(part, answer.json["errors"][0]["detail"])
        job = self.first.post_job(dict(QUICK, not_before=moment(29 * 86400)))
        self.assertEqual(job["status"], "queued")
        east = datetime.datetime.now(datetime.timezone(datetime.timedelta(hours=9))) + datetime.timedelta(hours=1)
        job = self.first.post_job(dict(QUICK, not_before=east.isoformat(timespec="seconds")))
        self.assertAlmostEqual(seconds(job["not_before"]), east.timestamp(), delta=1)

    def test_a_job_that_waits_for_its_time_is_cancelled_and_queued_again(self):
        job = self.first.post_job(dict(QUICK, not_before=moment(3600)))
        self.assertEqual(self.last.call("DELETE", "/v1/jobs/" + job["id"]).status, 409)
        answer = self.last.post("/v1/jobs/%s/cancel" % job["id"], "")
        self.assertEqual(answer.json["status"], "cancelled")
        again = self.last.post("/v1/jobs/%s/requeue" % job["id"], "").json
        self.assertEqual((again["status"], again["not_before"]), ("queued", job["not_before"]))
        time.sleep(1)
        self.assertEqual(self.first.job(job["id"])["status"], "queued")

    def test_a_job_at_a_time_outlives_a_kill_and_a_pause(self):
        at = moment(2)
        job = self.first.post_job(dict(QUICK, not_before=at))
        self.first.post("/v1/queue/pause", "")
        for service in self.processes:
            service.kill()
            service.start()
        time.sleep(max(0, seconds(at) - time.time()) + 1)
        self.assertEqual(self.first.job(job["id"])["status"], "queued")
        self.last.post("/v1/queue/resume", "")
        self.assertEqual(self.last.wait_for(job["id"])["attempts"], 1)

    def test_a_unique_job_is_computed_once(self):
        request = dict(QUICK, name="unique at %s" % time.time(), unique=True)
        job = self.first.post_job(request, wait=30)
        self.assertEqual(job["status"], "succeeded")
        for service in self.processes:
            self.assertEqual(service.post_job(request)["id"], job["id"])
            # The order of members is irrelevant, and so are the start time and the notification.
            same = dict(reversed(list(request.items())), priority="low", not_before=moment(60))
            self.assertEqual(service.post_job(same, wait=5)["id"], job["id"])
        self.assertNotEqual(self.last.post_job(dict(request, timeout_s=7))["id"], job["id"])
        self.assertNotEqual(self.last.post_job(dict(request, unique=False))["id"], job["id"])

    def test_a_unique_job_that_failed_or_was_cancelled_is_made_anew(self):
        request = dict(LONG, name="unique at %s" % time.time(), unique=True, timeout_s=0.2)
        failed = self.first.post_job(request, wait=30)
        self.assertEqual(failed["status"], "failed")
        second = self.last.post_job(request, wait=30)
        self.assertNotEqual(second["id"], failed["id"])
        later = dict(request, name=request["name"] + "b", not_before=moment(3600))
        third = self.first.post_job(later)["id"]
        self.assertEqual(self.last.post_job(later)["id"], third)
        self.last.post("/v1/jobs/%s/cancel" % third, "")
        self.assertNotEqual(self.first.post_job(later)["id"], third)

    def test_a_unique_job_is_not_queued_again_beside_the_one_that_took_its_place(self):
        request = dict(QUICK, name="unique at %s" % time.time(), unique=True, not_before=moment(3600))
        first = self.first.post_job(request)["id"]
        self.last.post("/v1/jobs/%s/cancel" % first, "")
        second = self.last.post_job(request)["id"]
        for service in self.processes:
            answer = service.post("/v1/jobs/%s/requeue" % first, "")
            self.assertEqual((answer.status, answer.media_type), (409, "application/problem+json"))
            self.assertIn("Post the request again", answer.json["detail"])
            self.assertEqual(service.post_job(request)["id"], second)
        self.first.post("/v1/jobs/%s/cancel" % second, "")
        self.assertEqual(self.last.post("/v1/jobs/%s/requeue" % first, "").status, 202)
        self.assertEqual(self.first.post_job(request)["id"], first)
        self.assertEqual(self.first.post("/v1/jobs/%s/requeue" % second, "").status, 409)

    def test_unique_and_an_idempotency_key_are_refused_together(self):
        answer = self.first.post("/v1/jobs", dict(QUICK, unique=True), {"Idempotency-Key": "k"})
        self.assertEqual(answer.status, 422)
        self.assertIn("Remove one", answer.json["detail"])

    def test_entries_of_a_batch_have_neither(self):
        jobs = [QUICK, dict(QUICK, not_before=moment(60)), dict(QUICK, unique=True)]
        batch = self.first.post("/v1/batches", {"jobs": jobs}).json["id"]
        rows = [self.first.wait_for(each["id"]) for each in
                reversed(self.first.get("/v1/jobs?batch=" + batch).json["jobs"])]
        self.assertEqual([row["status"] for row in rows], ["succeeded", "failed", "failed"])
        for row, name in zip(rows[1:], ("not_before", "unique")):
            self.assertEqual(row["error"]["errors"][0]["pointer"], "/" + name)
            self.assertIn("POST /v1/jobs", row["error"]["errors"][0]["detail"])


class SqliteTest(Cases, unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.store = None
        cls.start(1)


class PostgresTest(Cases, unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.place = OwnPostgres().__enter__()
        cls.addClassCleanup(cls.place.__exit__)
        cls.store = cls.place.store
        cls.start(2)


class LimitTest(unittest.TestCase):
    def under_way(self, first, second):
        """The limit is 3 jobs of a client on both services."""
        soon = dict(QUICK, not_before=moment(3600))
        ids = [first.post_job(LONG)["id"], second.post_job(LONG)["id"], first.post_job(soon)["id"]]
        answers = [service.post("/v1/jobs", QUICK) for service in (first, second)]
        for answer in answers:
            self.assertEqual((answer.status, answer.media_type), (429, "application/problem+json"))
            self.assertEqual(answer.json["type"], "too-many-jobs")
            self.assertIn("has 3 jobs", answer.json["detail"])
            self.assertIn(int(answer.headers["Retry-After"]), range(1, 61))
        self.assertEqual(second.post("/v1/batches", {"jobs": [QUICK] * 5}).status, 202)
        self.assertIn("tunewright_client_limit_refusals_total 1", first.get("/metrics").body.decode())
        second.post("/v1/jobs/%s/cancel" % ids[2], "")
        self.assertEqual(first.post("/v1/jobs", soon).status, 202)
        self.assertEqual(second.post("/v1/jobs", QUICK).status, 429)
        first.post("/v1/jobs/%s/cancel" % ids[0], "")
        first.wait_for(ids[0])
        self.assertEqual(second.post("/v1/jobs", QUICK).status, 202)

    def test_a_client_has_so_many_jobs_under_way(self):
        with Service("--workers", "1", "--drain-timeout", "0", "--client-jobs", "3") as service:
            self.assertEqual(service.post("/v1/queue/pause", "").status, 200)
            first = [service.post_job(QUICK)["id"] for _ in range(3)]
            self.assertEqual(service.post("/v1/jobs", QUICK).status, 429)
            service.post("/v1/queue/resume", "")
            for each in first:
                service.wait_for(each)
            self.assertEqual(service.post("/v1/jobs", QUICK).status, 202)

    def test_each_client_has_a_count_of_its_own(self):
        with Service("--workers", "1", "--drain-timeout", "0", "--client-jobs", "1", "--behind-proxy") as service:
            def post(client, key=None):
                headers = {"X-Forwarded-For": client, **({"Idempotency-Key": key} if key else {})}
                return service.post("/v1/jobs", dict(QUICK, not_before=at), headers).status

            at = moment(3600)
            self.assertEqual([post("192.0.2.1", "k"), post("192.0.2.1"), post("192.0.2.2")], [202, 429, 202])
            self.assertEqual(post("192.0.2.1", "k"), 202)  # the existing job

    def test_it_counts_in_all_processes_together(self):
        with OwnPostgres() as place:
            options = ("--workers", "1", "--drain-timeout", "0", "--client-jobs", "3")
            with Service(*options, store=place.store) as first, Service(*options, store=place.store) as second:
                self.under_way(first, second)


if __name__ == "__main__":
    unittest.main()
