"""Behind a pooler that gives each transaction another connection: the store must not depend on a session."""

import json
import os
import pwd
import shutil
import signal
import socket
import subprocess
import tempfile
import time
import unittest
import urllib.parse

from faulty_places import OwnPostgres
from service import LONG, QUICK, Service

PGBOUNCER = "/usr/sbin/pgbouncer"


class Pooler:
    """PgBouncer in transaction mode, with fewer connections to the database than clients have to it."""

    def __init__(self, store):
        target = urllib.parse.urlsplit(store)
        self.folder = tempfile.mkdtemp(prefix="tunewright-pooler-")
        with socket.socket() as probe:
            probe.bind(("127.0.0.1", 0))
            self.port = probe.getsockname()[1]
        settings = os.path.join(self.folder, "pgbouncer.ini")
        with open(settings, "w") as file:
            file.write("""[databases]
jobs = host=127.0.0.1 port=%d dbname=%s user=%s password=%s
[pgbouncer]
listen_addr = 127.0.0.1
listen_port = %d
unix_socket_dir =
auth_type = any
pool_mode = transaction
default_pool_size = 4
logfile = %s/log
""" % (target.port, target.path.strip("/"), target.username, target.password, self.port, self.folder))
        identity = {}
        if os.getuid() == 0:
            user = pwd.getpwnam("postgres")
            identity = {"user": user.pw_uid, "group": user.pw_gid, "extra_groups": []}
            for path in (self.folder, settings):
                os.chown(path, user.pw_uid, user.pw_gid)
        self.process = subprocess.Popen([PGBOUNCER, "-q", settings], stdout=subprocess.DEVNULL,
                                        stderr=subprocess.DEVNULL, **identity)
        self.store = "postgresql://anybody@127.0.0.1:%d/jobs" % self.port
        end = time.monotonic() + 20
        while socket.socket().connect_ex(("127.0.0.1", self.port)) != 0:
            if time.monotonic() > end or self.process.poll() is not None:
                raise RuntimeError("PgBouncer does not start")
            time.sleep(0.05)

    def stop(self):
        self.process.send_signal(signal.SIGKILL)
        self.process.wait()
        shutil.rmtree(self.folder, ignore_errors=True)


@unittest.skipUnless(os.path.exists(PGBOUNCER), "PgBouncer is not installed: run script/bootstrap test")
class PoolerTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.place = OwnPostgres().__enter__()
        cls.addClassCleanup(cls.place.__exit__)
        cls.pooler = Pooler(cls.place.store)
        cls.addClassCleanup(cls.pooler.stop)
        cls.api = cls.start("--role", "api")
        cls.worker = cls.start("--role", "worker", "--workers", "1")

    @classmethod
    def start(cls, *options):
        service = Service("--pooled", "--drain-timeout", "0", "--lease", "2s", *options, store=cls.pooler.store)
        cls.addClassCleanup(service.__exit__)
        return service

    def test_a_wait_is_answered_when_another_process_has_ended_the_job(self):
        answer = self.api.post("/v1/jobs", QUICK, {"Prefer": "wait=50"})
        self.assertEqual((answer.status, answer.json["status"]), (200, "succeeded"))

    def test_a_cancel_stops_a_job_that_runs_elsewhere(self):
        job_id = self.api.post_job(LONG)["id"]
        self.api.wait_for(job_id, ("running",))
        self.assertEqual(self.api.post("/v1/jobs/%s/cancel" % job_id, "").status, 202)
        self.assertEqual(self.api.wait_for(job_id)["status"], "cancelled")

    def test_a_batch_goes_through(self):
        lines = "\n".join([json.dumps(QUICK)] * 300)
        batch = self.api.call("POST", "/v1/batches", lines, {"Content-Type": "application/x-ndjson"}).json["id"]
        while (now := self.api.get("/v1/batches/" + batch).json)["status"] != "ended":
            time.sleep(0.05)
        self.assertEqual(now["counts"]["succeeded"], 300)
        self.assertEqual(self.api.call("DELETE", "/v1/batches/" + batch).status, 204)

    def test_the_jobs_of_a_process_that_died_run_again(self):
        other = self.start("--role", "worker", "--workers", "1")
        first, second = (self.api.post_job(dict(LONG, name=name))["id"] for name in ("one", "two"))
        for job_id in (first, second):
            self.api.wait_for(job_id, ("running",))
        other.kill()
        end = time.monotonic() + 20
        self.api.post("/v1/jobs/%s/cancel" % first, "")
        self.api.post("/v1/jobs/%s/cancel" % second, "")
        while {self.api.job(job_id)["status"] for job_id in (first, second)} != {"cancelled"}:
            self.assertLess(time.monotonic(), end, "a cancel holds through the death of whoever ran the job")
            time.sleep(0.05)


if __name__ == "__main__":
    unittest.main()
