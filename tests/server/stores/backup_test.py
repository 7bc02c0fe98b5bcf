"""The backup of an SQLite store according to docs/operations.md: made while the service writes, restored after a
kill."""

import os
import re
import sqlite3
import subprocess
import tempfile
import threading
import time
import unittest

from service import BINARY, QUICK, ROOT, Service


def documented():
    """The commands of that section of the document: the statement that copies, and the lines that restore the copy."""
    text = (ROOT / "docs" / "operations.md").read_text(encoding="utf-8")
    part = text.split("\n## Backup\n")[1].split("\nPostgreSQL ")[0]
    lines = [line.strip() for line in part.splitlines() if line.startswith("    ")]
    return re.fullmatch(r'sqlite3 /var/lib/tunewright/jobs\.db "(.*)"', lines[0]).group(1), lines[1:]


class BackupTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="tunewright-backup-")
        self.addCleanup(folder.cleanup)
        self.file, self.copy = folder.name + "/jobs.db", folder.name + "/copy.db"
        self.service = Service("--workers", "1", store=self.file)
        self.addCleanup(lambda: self.service.stop())

    def back_up(self):
        database = sqlite3.connect(self.file)
        self.addCleanup(database.close)
        database.execute(documented()[0].replace("/backup/jobs.db", self.copy))
        database.close()

    def put_back(self, commands):
        for command in commands:
            command = command.replace("/var/lib/tunewright/jobs.db", self.file).replace("/backup/jobs.db", self.copy)
            subprocess.run(command, shell=True, check=True)

    def kill_after_more_jobs(self):
        for job in self.service.get("/v1/jobs").json["jobs"]:
            self.service.call("DELETE", "/v1/jobs/" + job["id"])
        for _ in range(20):
            self.service.post_job(dict(QUICK, name="after"), wait=10)
        self.service.kill()
        self.assertGreater(os.path.getsize(self.file + "-wal"), 0)

    def names(self):
        return [job["name"] for job in self.service.get("/v1/jobs").json["jobs"]]

    def test_a_copy_is_put_in_the_place_of_a_file_whose_service_was_killed(self):
        for _ in range(20):
            self.service.post_job(dict(QUICK, name="before"), wait=10)
        self.back_up()
        self.kill_after_more_jobs()
        self.put_back(documented()[1])
        self.service.start()
        self.assertEqual(["before"] * 20, self.names())
        self.assertEqual(200, self.service.post("/v1/jobs", QUICK, {"Prefer": "wait=10"}).status)
        with sqlite3.connect(self.file) as database:
            self.assertEqual([("ok",)], database.execute("PRAGMA integrity_check").fetchall())

    def test_a_copy_beside_the_log_of_another_file_is_refused_and_left_alone(self):
        self.service.post_job(dict(QUICK, name="before"), wait=10)
        self.back_up()
        self.kill_after_more_jobs()
        removes, copies = documented()[1]
        self.put_back([copies])
        for command in ("serve", "migrate"):
            made = subprocess.run([BINARY, command, "--store", "sqlite:" + self.file], capture_output=True, text=True,
                                  timeout=30)
            self.assertEqual(4, made.returncode, made)
            self.assertIn("%s-wal belongs to the original; remove it" % self.file, made.stderr)
        self.put_back([removes])
        self.service.start()
        self.assertEqual(["before"], self.names())

    def test_a_copy_is_made_while_the_service_writes(self):
        stop = threading.Event()

        def post():
            while not stop.is_set():
                self.service.post_job(QUICK)

        for _ in range(300):
            self.service.post_job(QUICK)
        poster = threading.Thread(target=post)
        poster.start()
        try:
            begun = time.monotonic()
            self.back_up()
            self.assertLess(time.monotonic() - begun, 20)
        finally:
            stop.set()
            poster.join()
        with sqlite3.connect(self.copy) as database:
            self.assertGreaterEqual(database.execute("SELECT count(*) FROM jobs").fetchone()[0], 300)


class OneProcessTest(unittest.TestCase):
    def test_a_link_to_a_file_that_a_service_has_is_no_other_file(self):
        with tempfile.TemporaryDirectory(prefix="tunewright-link-") as folder:
            link = folder + "/link.db"
            with Service("--workers", "1", store=folder + "/jobs.db"):
                os.symlink(folder + "/jobs.db", link)
                made = subprocess.run([BINARY, "serve", "--listen", "127.0.0.1:0", "--store", "sqlite:" + link],
                                      capture_output=True, text=True, timeout=30)
            self.assertEqual(4, made.returncode, made)
            self.assertIn("another tunewright is using it", made.stderr)


if __name__ == "__main__":
    unittest.main()
