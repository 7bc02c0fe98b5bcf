"""Machines whose clocks differ by days share one database: only its clock counts."""

import glob
import time
import unittest

from faulty_places import OwnPostgres
from service import LONG, QUICK, Service

LIBRARY = glob.glob("/usr/lib/*/faketime/libfaketimeMT.so.1")


def days_away(days):
    """The environment of a process whose wall clock has this offset; its steady clock is unchanged."""
    return {"LD_PRELOAD": LIBRARY[0], "FAKETIME": "%+dd" % days, "FAKETIME_DONT_FAKE_MONOTONIC": "1"}


@unittest.skipUnless(LIBRARY, "faketime is not installed: run script/bootstrap test")
class ClocksTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.place = OwnPostgres().__enter__()
        cls.addClassCleanup(cls.place.__exit__)

    def start(self, days, *options):
        service = Service("--drain-timeout", "0", "--lease", "2s", "--retention", "1h", "--workers", "1", *options,
                          store=self.place.store, environment=days_away(days) if days else None)
        self.addCleanup(service.__exit__)
        return service

    def test_jobs_go_between_clocks_eight_days_apart_and_stay(self):
        behind, right, ahead = self.start(-8, "--role", "api"), self.start(0), self.start(8)
        ids = []
        for service in (behind, right, ahead) * 4:
            answer = service.post("/v1/jobs", QUICK, {"Prefer": "wait=30"})
            self.assertEqual((answer.status, answer.json["status"]), (200, "succeeded"))
            ids.append(answer.json["id"])
            # All times are the database's: a job that was begun elsewhere is not begun before it arrived.
            self.assertLessEqual(answer.json["created_at"], answer.json["finished_at"])
            self.assertEqual(answer.json["finished_at"][:10], time.strftime("%Y-%m-%d", time.gmtime()))
        time.sleep(2.5)  # every process has swept and rescued
        listed = [job["id"] for job in right.get("/v1/jobs").json["jobs"]]
        self.assertEqual(sorted(listed), sorted(ids), "nothing is deleted too early")
        self.assertEqual({job["attempts"] for job in right.get("/v1/jobs").json["jobs"]}, {1}, "nor taken from anybody")

    def test_nobody_is_thought_dead_for_his_clock_and_who_dies_is_missed(self):
        ahead = self.start(8)
        job_id = ahead.post_job(LONG)["id"]
        ahead.wait_for(job_id, ("running",))
        right = self.start(0)
        time.sleep(4)  # two leases
        self.assertEqual((right.job(job_id)["status"], right.job(job_id)["attempts"]), ("running", 1))
        ahead.kill()
        end = time.monotonic() + 20
        while right.job(job_id)["attempts"] == 1:
            self.assertLess(time.monotonic(), end)
            time.sleep(0.05)
        right.post("/v1/jobs/%s/cancel" % job_id, "")
        right.wait_for(job_id)


if __name__ == "__main__":
    unittest.main()
