"""A database that does not answer, and one that one client keeps busy: the effect on other clients."""

import os
import pathlib
import signal
import subprocess
import threading
import time
import unittest

import postgres
from faulty_places import OwnPostgres
from service import QUICK, Service


class Frozen:
    """Stops all processes of a cluster: data sent to them arrives, but no answer comes."""

    def __init__(self, cluster):
        children = [int(stat.parent.name) for stat in pathlib.Path("/proc").glob("[0-9]*/stat")
                    if self.parent_of(stat) == cluster.process.pid]
        self.processes = [cluster.process.pid, *children]

    @staticmethod
    def parent_of(stat):
        try:
            return int(stat.read_text().rsplit(")", 1)[1].split()[1])
        except OSError:  # it has ended
            return None

    def send(self, what):
        for process in self.processes:
            os.kill(process, what)

    def __enter__(self):
        self.send(signal.SIGSTOP)

    def __exit__(self, *_):
        self.send(signal.SIGCONT)


class Call(threading.Thread):
    def __init__(self, service, *arguments, **named):
        super().__init__(daemon=True)
        self.call = lambda: service.call(*arguments, timeout=120, **named)
        self.start()

    def run(self):
        self.answer = self.call()

    def result(self):
        self.join(120)
        return self.answer


def until_ready_is(service, status, patience):
    end = time.monotonic() + patience
    while (found := service.get("/readyz").status) != status:
        if time.monotonic() > end:
            raise AssertionError("/readyz is still %d" % found)
        time.sleep(0.1)


class FrozenTest(unittest.TestCase):
    def test_a_database_that_does_not_answer_is_told_to_probes_and_to_whoever_waits(self):
        with OwnPostgres() as place, Service("--workers", "1", store=place.store) as service:
            done = service.post_job(QUICK, wait=30)["id"]
            key = {"Idempotency-Key": "once"}
            with Frozen(place.cluster):
                calls = [Call(service, "POST", "/v1/jobs", dict(QUICK, name="once"), key),
                         Call(service, "GET", "/v1/jobs/" + done), Call(service, "GET", "/v1/jobs")]
                until_ready_is(service, 503, patience=12)
                for call in calls:
                    answer = call.result()
                    self.assertEqual(answer.status, 503, answer.body)
                    self.assertGreater(int(answer.headers["Retry-After"]), 0)
                self.assertEqual(service.get("/healthz").status, 200)
            until_ready_is(service, 200, patience=60)
            self.assertIn(service.post("/v1/jobs", dict(QUICK, name="once"), key).status, (200, 202))
            self.assertEqual(len(service.get("/v1/jobs?name=once").json["jobs"]), 1, "neither lost nor there twice")


class SearchTest(unittest.TestCase):
    # Outlines so long that a search through all of them takes half a second or more.
    FILL = """INSERT INTO tunewright.jobs (id, name, class, turn, owner, flow, created_at, timeout_s, request_hash, request)
        SELECT 'id' || lpad(i::text, 24, '0'), 'loop', 0, i, '', 'f', 1795730000000 + i, 60, 'h', '{}'
        FROM generate_series(1, 1200) i;
        INSERT INTO tunewright.ended (seq, single, status, attempts, cancel_requested, started_at, finished_at, version,
        outline, result) SELECT seq, true, 'succeeded', 1, false, created_at, %d, '0.1.0',
        '{"method": "simc", "more": "' || repeat('a', 300000) || '"}', '{}' FROM tunewright.jobs WHERE id LIKE 'id0%%'"""

    def test_searches_of_one_client_leave_room_for_all_other_reads(self):
        with OwnPostgres() as place, Service("--workers", "1", store=place.store) as service:
            job = service.post_job(QUICK, wait=30)["id"]
            subprocess.run([str(postgres.programs() / "psql"), "-Xq", "-v", "ON_ERROR_STOP=1", "-d", place.store, "-c",
                            self.FILL % (1000 * time.time())], check=True)
            over = threading.Event()
            found = []

            def search():
                while not over.is_set():
                    found.append(service.call("GET", "/v1/jobs?q=nowhere", timeout=120).status)

            searchers = [threading.Thread(target=search) for _ in range(24)]
            for searcher in searchers:
                searcher.start()
            try:
                time.sleep(2)
                end = time.monotonic() + 12
                while time.monotonic() < end:
                    self.assertEqual(service.get("/v1/jobs/" + job).status, 200)
                    self.assertEqual(service.get("/v1/jobs?limit=1").status, 200)
            finally:
                over.set()
                for searcher in searchers:
                    searcher.join(120)
            self.assertIn(200, found)
            self.assertLessEqual(set(found), {200, 503})


if __name__ == "__main__":
    unittest.main()
