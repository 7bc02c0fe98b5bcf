"""Failures around the service while it works: of itself, its database, its disk. On both stores.

The tests do not depend on the speed of the machine: loads end when their jobs have ended, with long timeouts."""

import signal
import threading
import time
import unittest

from faulty_places import (Caller, OwnPostgres, Poster, SmallDisk, SqliteFile, all_end, all_jobs, assert_intact,
                           may_mount)
from service import LONG, QUICK, Service

# About 20 ms of work: long enough to be interrupted, short enough for hundreds.
SOME_WORK = {"plant": {"type": "sopdt", "K": 1, "T1": 5, "T2": 2, "L": 1},
             "tune": [{"method": "robust", "search": "nelder_mead", "Ms": ms} for ms in (1.4, 1.6, 1.8)],
             "evaluate": {"points": 0}}
LEASE = 2
OPTIONS = ("--workers", "2", "--lease", str(LEASE), "--drain-timeout", "0")


class KillTest(unittest.TestCase):
    """kill -9 of the only server, five times, while hundreds of jobs are posted and computed."""

    def hold(self, place):
        wanted = 500
        with place, Service(*OPTIONS, store=place.store) as service:
            poster = Poster(service, SOME_WORK, wanted, threads=4)
            seen = {}
            for fifth in range(1, 6):
                poster.wait_for(fifth * wanted // 6)
                self.note_ended(service, seen)
                service.kill()
                service.start()
            poster.join()
            jobs = all_end(service, poster.ids)
            self.assertEqual(len(set(poster.ids)), wanted)
            self.assertEqual(sorted(jobs), sorted(poster.ids), "what is kept is what was accepted, each once")
            self.assertEqual({job["status"] for job in jobs.values()}, {"succeeded"})
            self.assertLessEqual(max(job["attempts"] for job in jobs.values()), 6)
            for job_id, moment in seen.items():
                self.assertEqual(jobs[job_id]["finished_at"], moment, "a job that had ended has ended again")
            self.assertGreater(len(seen), 0)

    def note_ended(self, service, seen):
        for job in service.get("/v1/jobs?status=succeeded&limit=200").json["jobs"]:
            self.assertEqual(seen.setdefault(job["id"], job["finished_at"]), job["finished_at"])

    def test_on_sqlite_every_accepted_job_ends_once(self):
        self.hold(SqliteFile())

    def test_on_postgresql_every_accepted_job_ends_once(self):
        self.hold(OwnPostgres())


class ReplicaTest(unittest.TestCase):
    def test_jobs_of_a_killed_replica_end_on_the_others_when_its_leases_are_over(self):
        with OwnPostgres() as place:
            replicas = [Service("--workers", "1", "--lease", str(LEASE), store=place.store) for _ in range(3)]
            self.addCleanup(lambda: [replica.__exit__() for replica in replicas])
            victim = replicas[2]
            # A job may end between the choice of the victim and its kill: then the test repeats it.
            for _ in range(5):
                poster = Poster(replicas[0], SOME_WORK, 300, threads=4)
                poster.wait_for(100)
                self.wait_until_it_computes(victim)
                victim.kill()
                killed = time.time()
                poster.join()
                jobs = all_end(replicas[1], poster.ids)
                victim.start()
                self.assertEqual(sorted(jobs), sorted(poster.ids))
                self.assertEqual({job["status"] for job in jobs.values()}, {"succeeded"})
                again = [job for job in jobs.values() if job["attempts"] > 1]
                if again:
                    break
            # The job that the victim computed, and those that it had claimed ahead (claims.cpp: at most 16 short ones).
            self.assertIn(len(again), range(1, 18))
            late = max(self.seconds(job["finished_at"]) for job in again) - killed
            print("%d jobs of the killed replica had ended %.1f s after it, with a lease of %d s" % (len(again), late, LEASE))
            self.assertLess(late, 5 * LEASE)

    def wait_until_it_computes(self, service):
        end = time.monotonic() + 60
        while "tunewright_jobs_running 1" not in service.get("/metrics").body.decode():
            self.assertLess(time.monotonic(), end, "the replica never had a job")

    @staticmethod
    def seconds(moment):
        import calendar
        return calendar.timegm(time.strptime(moment[:19], "%Y-%m-%dT%H:%M:%S")) + float(moment[19:-1])


class DatabaseTest(unittest.TestCase):
    def test_while_postgresql_is_away_clients_see_503_and_no_accepted_job_is_lost(self):
        with OwnPostgres() as place, Service(*OPTIONS, store=place.store) as service:
            poster = Poster(service, SOME_WORK, 300, threads=4)
            for mode in ("fast", "immediate"):
                poster.wait_for(len(poster.ids) + 60)
                place.cluster.stop(mode)
                poster.wait_for_refusal()
                self.assertEqual(service.get("/healthz").status, 200)
                self.assertEqual(service.get("/v1/jobs/" + poster.ids[0]).status, 503)
                place.cluster.start()
            poster.join()
            jobs = all_end(service, poster.ids)
            self.assertEqual(sorted(jobs), sorted(poster.ids))
            self.assertEqual({job["status"] for job in jobs.values()}, {"succeeded"})
            self.assertLessEqual(set(poster.refusals), {503}, poster.refusals)
            self.assertEqual(service.get("/readyz").status, 200)

    def test_numbers_that_a_crashed_server_gives_a_second_time_prove_nothing(self):
        # A commit waits for the disk as long as possible: a crash interrupts it, its transaction is lost, and the next
        # transaction gets its number and is committed.
        slow = {"commit_delay": "100000", "commit_siblings": "0", "wal_writer_delay": "10s"}
        with OwnPostgres(**slow) as place, Service(*OPTIONS, store=place.store) as service:
            poster = Poster(service, SOME_WORK, 400, threads=6)
            for crash in range(6):
                poster.wait_for(len(poster.ids) + 20)
                place.cluster.stop("immediate")
                place.cluster.start()
            poster.join()
            jobs = all_end(service, poster.ids)
            self.assertEqual(sorted(jobs), sorted(poster.ids))


class DrainTest(unittest.TestCase):
    """SIGTERM under load: every complete request is answered completely, and accepted jobs are kept."""

    def hold(self, place):
        with place, Service("--workers", "2", "--lease", str(LEASE), "--drain-timeout", "1", store=place.store) as service:
            busy = [service.post_job(LONG)["id"] for _ in range(2)]
            for job_id in busy:
                service.wait_for(job_id, ("running",))
            waiting = [Waiting(service) for _ in range(20)]
            self.wait_until_queued(service, len(waiting))
            callers = [Caller(service.port, QUICK) for _ in range(4)]
            self.wait_until_queued(service, len(waiting) + 50)
            service.process.send_signal(signal.SIGTERM)
            code = service.process.wait(60)
            service.process.stdout.close()
            self.assertEqual(code, 0)
            for caller in callers:
                caller.thread.join(60)
                self.assertEqual(caller.cut, [])
                self.assertLessEqual(caller.statuses, {202, 503})
            accepted = [job_id for caller in callers for job_id in caller.ids]
            for one in waiting:
                self.assertEqual(one.result(), 202, "a request that was being waited for is answered")
            accepted += [one.job_id for one in waiting]
            service.start()
            self.assertLessEqual({*accepted, *busy}, set(all_jobs(service)))
            for job_id in busy:
                service.post("/v1/jobs/%s/cancel" % job_id, "")
            jobs = all_end(service, accepted)
            self.assertEqual({jobs[job_id]["status"] for job_id in accepted}, {"succeeded"})

    def wait_until_queued(self, service, count):
        end = time.monotonic() + 60
        while len(service.get("/v1/jobs?status=queued&limit=200").json["jobs"]) < count:
            self.assertLess(time.monotonic(), end)

    def test_on_sqlite_no_accepted_request_is_cut_off(self):
        self.hold(SqliteFile())

    def test_on_postgresql_no_accepted_request_is_cut_off(self):
        self.hold(OwnPostgres())


@unittest.skipUnless(may_mount(), "a small file system needs the right to mount one: run script/test as root, in a container with CAP_SYS_ADMIN")
class DiskTest(unittest.TestCase):
    """The disk of the store becomes full, and is emptied again."""

    # About 50 kB: a step test with reproducible noise.
    LARGE = {"record": {"dt": 1, "u": [0] * 20 + [1] * 4980,
                        "y": [0] * 20 + [round(2 - 2 * 0.99**i + 1e-4 * (i * 7919 % 13), 6) for i in range(4980)]},
             "tune": [{"method": "simc", "tau_c": 10}], "evaluate": {"points": 0}}

    def fill_up(self, disk, service, leave_kib):
        """Posts until the service refuses for lack of room; returns the accepted jobs."""
        before = service.post_job(QUICK, wait=30)
        disk.fill(leave_kib)
        poster = Poster(service, self.LARGE, 10_000, threads=2)
        poster.wait_for_refusal()
        poster.stop()
        poster.join()
        return before, poster

    def test_sqlite_on_a_full_disk_is_507_and_recovers_undamaged(self):
        with SmallDisk(16) as disk:
            path = disk.folder + "/jobs.db"
            with Service(*OPTIONS, store=path) as service:
                before, poster = self.fill_up(disk, service, 1500)
                self.assertEqual(set(poster.refusals), {507})
                while (answer := service.post("/v1/jobs", self.LARGE)).status == 202:
                    poster.ids.append(answer.json["id"])  # a little room had been left
                self.assertEqual((answer.status, answer.media_type), (507, "application/problem+json"))
                self.assertIn("full", answer.json["detail"])
                self.assertEqual(service.job(before["id"]), before, "reading goes on")
                self.assertEqual(service.get("/healthz").status, 200)
                disk.empty()
                jobs = all_end(service, poster.ids)
                self.assertEqual({jobs[job_id]["status"] for job_id in poster.ids}, {"succeeded"})
                self.assertEqual(service.post_job(QUICK, wait=30)["status"], "succeeded")
                self.assertEqual(service.get("/readyz").status, 200)
            assert_intact(path)

    def test_postgresql_on_a_full_disk_is_507_or_503_and_recovers(self):
        with SmallDisk(160) as disk, OwnPostgres(where=disk.folder) as place:
            with Service(*OPTIONS, store=place.store) as service:
                before, poster = self.fill_up(disk, service, 1500)
                self.assertLessEqual(set(poster.refusals), {503, 507})
                self.assertEqual(service.get("/healthz").status, 200)
                disk.empty()
                # PostgreSQL ends if it cannot write its log; its supervisor would restart it.
                place.cluster.start()
                jobs = all_end(service, poster.ids)
                self.assertEqual({jobs[job_id]["status"] for job_id in poster.ids}, {"succeeded"})
                self.assertEqual(service.job(before["id"]), before)
                self.assertEqual(service.post_job(QUICK, wait=30)["status"], "succeeded")
                self.assertEqual(service.get("/readyz").status, 200)


class Waiting:
    """A client that waits for its job on a thread of its own."""

    def __init__(self, service):
        self.answer = None
        self.thread = threading.Thread(target=self.run, args=(service,))
        self.thread.start()

    def run(self, service):
        self.answer = service.post("/v1/jobs", QUICK, {"Prefer": "wait=60"})

    def result(self):
        self.thread.join(60)
        return self.answer and self.answer.status

    @property
    def job_id(self):
        return self.answer.json["id"]


if __name__ == "__main__":
    unittest.main()
