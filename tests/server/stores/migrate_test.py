"""A store of an older program: migrated at the start or by hand, with its data, by a role with the rights."""

import gzip
import http.client
import json
import os
import pathlib
import signal
import sqlite3
import subprocess
import tempfile
import threading
import time
import unittest

from faulty_places import OwnPostgres
from service import BINARY, QUICK, ROOT, Service

DATA = ROOT / "tests" / "data" / "store"


def migrate(store, *more):
    return subprocess.run([BINARY, "migrate", "--store", store, *more], capture_output=True, text=True)


class Starting:
    """A service that is not ready yet, on a known port."""

    def __init__(self, port, *arguments):
        self.port = port
        self.process = subprocess.Popen([BINARY, "serve", "--listen", "127.0.0.1:%d" % port, *arguments],
                                        stdout=subprocess.PIPE, stderr=subprocess.PIPE)

    def get(self, path):
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=10)
        try:
            connection.request("GET", path)
            return connection.getresponse().status
        except OSError:
            return None
        finally:
            connection.close()

    def until(self, path, status, patience=30):
        end = time.monotonic() + patience
        while (found := self.get(path)) != status:
            if time.monotonic() > end:
                raise AssertionError("%s answers %s" % (path, found))
            time.sleep(0.05)

    def stop(self):
        self.process.send_signal(signal.SIGTERM)
        self.process.communicate(timeout=30)
        return self.process.returncode


def free_port():
    import socket
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


class PostgresTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.place = OwnPostgres().__enter__()
        cls.addClassCleanup(cls.place.__exit__)

    def database(self, name, *files):
        store = self.place.cluster.url(name)
        for file in files:
            self.psql(store, "-f", str(file))
        return store

    def psql(self, store, *words):
        done = subprocess.run([str(self.place.cluster.bin / "psql"), "-X", "-q", "-A", "-t", "-v", "ON_ERROR_STOP=1",
                               "-d", store, *words], capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout.strip()

    def test_what_an_older_program_kept_reads_the_same_and_goes_on(self):
        store = self.database("third", DATA / "postgres_third_version.sql")
        with Service("--role", "api", "--lease", "1s", store=store) as service:
            jobs = {job["name"]: job for job in service.get("/v1/jobs").json["jobs"]}
            self.assertEqual({name: job["status"] for name, job in jobs.items()},
                             {"queued": "queued", "running": "queued", "cancelled": "cancelled", "failed": "failed",
                              "succeeded": "succeeded"}, "the process of the running one has gone")
            whole = service.job(jobs["succeeded"]["id"])
            self.assertIn("Kp", whole["result"]["controllers"][0]["controller"])
            self.assertEqual(service.job(jobs["failed"]["id"])["error"]["type"], "timeout")
            same = service.post("/v1/jobs", dict(QUICK, name="succeeded"), {"Idempotency-Key": "key-1"})
            self.assertEqual(same.json["id"], jobs["succeeded"]["id"])
            batches = {batch["name"]: batch for batch in service.get("/v1/batches").json["batches"]}
            self.assertEqual(batches["ended"]["counts"],
                             {"queued": 0, "running": 0, "succeeded": 2, "failed": 1, "cancelled": 0})
            self.assertIsNotNone(batches["ended"]["finished_at"])
            self.assertEqual(batches["waiting"]["counts"]["queued"], 4)
            with Service("--role", "worker", "--workers", "2", store=store):
                self.assertEqual(service.wait_for(jobs["queued"]["id"])["status"], "succeeded")
                while service.get("/v1/batches/" + batches["waiting"]["id"]).json["status"] != "ended":
                    time.sleep(0.02)
                service.post("/v1/jobs/%s/cancel" % jobs["running"]["id"], "")

    def test_a_role_without_rights_on_the_schema_runs_the_service(self):
        store = self.database("granted")
        self.psql(store, "-c", "CREATE ROLE plain LOGIN PASSWORD 'plain'; REVOKE ALL ON DATABASE granted FROM PUBLIC; "
                               "GRANT CONNECT ON DATABASE granted TO plain")
        plain = "postgresql://plain:plain@" + store.split("@")[1]
        refused = subprocess.run([BINARY, "serve", "--listen", "127.0.0.1:0", "--store", plain], capture_output=True,
                                 text=True, timeout=60)
        self.assertEqual(refused.returncode, 4)
        self.assertIn("may not create tables", refused.stderr)
        done = migrate(store, "--grant", "plain")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("plain", done.stdout)
        with Service(store=plain) as service:
            self.assertEqual(service.post_job(QUICK, wait=30)["status"], "succeeded")
            batch = service.call("POST", "/v1/batches", '{"jobs": [%s]}' % "{}", {}).json["id"]
            while service.get("/v1/batches/" + batch).json["status"] != "ended":
                time.sleep(0.02)
            self.assertEqual(service.call("DELETE", "/v1/batches/" + batch).status, 204)

    def test_a_service_that_is_to_leave_it_waits_alive_and_not_ready(self):
        store = self.database("manual", DATA / "postgres_third_version.sql")
        service = Starting(free_port(), "--store", store, "--migrate", "manual", "--workers", "1", "--drain-timeout", "0")
        try:
            service.until("/healthz", 200)
            self.assertEqual(service.get("/readyz"), 503)
            self.assertEqual(service.get("/v1/jobs"), 503)
            self.assertIn("it was at 3", migrate(store).stdout)
            service.until("/readyz", 200)
        finally:
            self.assertEqual(service.stop(), 0)

    def test_one_that_waits_can_be_stopped(self):
        store = self.database("stopped", DATA / "postgres_third_version.sql")
        service = Starting(free_port(), "--store", store, "--migrate", "manual")
        service.until("/healthz", 200)
        self.assertEqual(service.stop(), 0)
        self.assertEqual(self.psql(store, "-c", "SELECT max(step) FROM tunewright.schema_steps"), "3")

    def test_while_another_takes_the_steps_the_port_says_so(self):
        store = self.database("slow", DATA / "postgres_third_version.sql")
        holding = subprocess.Popen([str(self.place.cluster.bin / "psql"), "-X", "-q", "-d", store], stdin=subprocess.PIPE,
                                   stdout=subprocess.DEVNULL, text=True)
        holding.stdin.write("BEGIN; SELECT pg_advisory_xact_lock(x'74756e6577726967'::bigint);\n")
        holding.stdin.flush()
        time.sleep(0.5)
        service = Starting(free_port(), "--store", store, "--workers", "1", "--drain-timeout", "0")
        try:
            service.until("/healthz", 200)
            self.assertEqual(service.get("/readyz"), 503)
            holding.communicate("COMMIT;\n", timeout=20)
            service.until("/readyz", 200)
        finally:
            holding.kill()
            service.stop()


class SqliteTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="tunewright-migrate-")
        self.addCleanup(folder.cleanup)
        self.path = os.path.join(folder.name, "jobs.db")

    def fill(self, file):
        connection = sqlite3.connect(self.path)
        connection.executescript(pathlib.Path(file).read_text())
        connection.close()

    def test_the_steps_are_taken_and_told(self):
        self.fill(DATA / "fourth_version.sql")
        done = migrate("sqlite:" + self.path)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertRegex(done.stdout, r"The schema is at step \d+; it was at 4\.")
        newest = done.stdout.split("at step ")[1].split(";")[0]
        self.assertGreater(int(newest), 4)
        self.assertIn("it was at %s." % newest, migrate("sqlite:" + self.path).stdout)

    def listed(self, service):
        """Every job of the service by its id, page by page."""
        jobs, path = {}, "/v1/jobs?limit=100"
        while path:
            page = service.get(path).json
            jobs.update((job["id"], job) for job in page["jobs"])
            path = page["next"]
        return jobs

    def test_every_job_of_the_first_program_with_a_store_is_kept_and_what_waited_runs(self):
        connection = sqlite3.connect(self.path)
        connection.executescript(gzip.decompress((DATA / "first_version_filled.sql.gz").read_bytes()).decode())
        old = {row[0]: row[1:] for row in connection.execute(
            "SELECT id, status, name, requests.body, results.body, error FROM jobs JOIN requests USING (seq) "
            "LEFT JOIN results USING (seq)")}
        (key, job_of_key), = connection.execute("SELECT key, id FROM idempotency_keys JOIN jobs USING (seq) WHERE key = 'key-5'")
        connection.close()
        self.assertEqual(len(old), 273)
        ended = {}
        with Service("--workers", "2", "--retention", "0", store=self.path) as service:
            jobs = self.listed(service)
            self.assertEqual(jobs.keys(), old.keys())
            running = next(id for id, row in old.items() if row[0] == "running")
            service.post("/v1/jobs/%s/cancel" % running, "")
            for id, (status, name, request, result, error) in old.items():
                self.assertEqual(jobs[id]["name"], name)
                job = service.job(id)
                self.assertEqual(job["request"], json.loads(request))
                if status in ("succeeded", "failed", "cancelled"):
                    self.assertEqual(job["status"], status)
                    self.assertEqual(job.get("result"), json.loads(result) if result else None)
                    self.assertEqual(job.get("error"), json.loads(error) if error else None)
                elif status == "queued":
                    job = service.wait_for(id)
                    self.assertEqual(job["status"], "succeeded", job.get("error"))
                    ended[id] = job["result"]
            again = service.post("/v1/jobs", old[job_of_key][2], {"Idempotency-Key": key})
            self.assertEqual(again.json["id"], job_of_key)
        self.assertEqual(len(ended), 53)
        with Service("--workers", "1", "--retention", "0", store=self.path) as service:
            self.assertEqual(self.listed(service).keys(), old.keys())
            for id, result in ended.items():
                self.assertEqual(service.job(id)["result"], result)

    def test_one_that_was_killed_is_done_again(self):
        self.fill(DATA / "fourth_version.sql")
        connection = sqlite3.connect(self.path)
        connection.executescript("""
            BEGIN;
            WITH RECURSIVE n (i) AS (SELECT 0 UNION ALL SELECT i + 1 FROM n WHERE i < 99999)
            INSERT INTO jobs (id, name, status, class, turn, owner, flow, created_at, started_at, finished_at, attempts,
                              timeout_s, request_hash) SELECT 'many' || i, '', 'cancelled', 0, i, '', '', 1, 1, 2, 1, 60, 'h'
                FROM n;
            COMMIT;""")
        kept = connection.execute("SELECT count(*) FROM jobs").fetchone()[0]
        connection.close()
        for pause in (0.02, 0.1, 0.25):
            migrating = subprocess.Popen([BINARY, "migrate", "--store", "sqlite:" + self.path], stdout=subprocess.DEVNULL)
            time.sleep(pause)
            migrating.kill()
            migrating.wait()
        self.assertEqual(migrate("sqlite:" + self.path).returncode, 0)
        connection = sqlite3.connect(self.path)
        counts = connection.execute("SELECT (SELECT count(*) FROM jobs), (SELECT count(*) FROM ended WHERE seq IN "
                                    "(SELECT seq FROM jobs WHERE id LIKE 'many%'))").fetchone()
        self.assertEqual(counts, (kept, 100000))
        self.assertEqual(connection.execute("PRAGMA integrity_check").fetchall(), [("ok",)])
        connection.close()

    def test_a_file_in_use_is_left_alone(self):
        with Service(store=self.path):
            done = migrate("sqlite:" + self.path)
            self.assertNotEqual(done.returncode, 0)
            self.assertIn("another tunewright is using it", done.stderr)

    def test_what_deleted_jobs_left_is_given_back(self):
        with Service(store=self.path) as service:
            request = dict(QUICK, evaluate={"points": 2000})
            threads = [threading.Thread(target=lambda: [service.post_job(request, wait=30) for _ in range(5)])
                       for _ in range(4)]
            for thread in threads:
                thread.start()
            for thread in threads:
                thread.join()
            for job in service.get("/v1/jobs").json["jobs"]:
                self.assertEqual(service.call("DELETE", "/v1/jobs/" + job["id"]).status, 204)
        before = os.path.getsize(self.path)
        done = migrate("sqlite:" + self.path, "--compact")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertLess(os.path.getsize(self.path), before / 4)

    def test_options_that_do_not_go_together_are_told(self):
        self.assertIn("--grant is for PostgreSQL", migrate("sqlite:" + self.path, "--grant", "x").stderr)
        self.assertIn("--compact is for SQLite", migrate("postgresql://nowhere/x", "--compact").stderr)


if __name__ == "__main__":
    unittest.main()
