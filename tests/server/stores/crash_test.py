"""Data that survive the end of the process, requested or not."""

import signal
import threading
import unittest

from service import LONG, QUICK, Service


class CrashTest(unittest.TestCase):
    def test_a_finished_job_is_the_same_after_a_kill(self):
        with Service() as service:
            job = service.post_job(QUICK, wait=30)
            service.kill()
            service.start()
            self.assertEqual(service.job(job["id"]), job)

    def test_an_interrupted_job_runs_again_and_counts_its_attempts(self):
        with Service("--workers", "1", "--drain-timeout", "0") as service:
            job_id = service.post_job(LONG)["id"]
            self.assertEqual(service.wait_for(job_id, ("running",))["attempts"], 1)
            service.kill()
            service.start()
            self.assertEqual(service.wait_for(job_id, ("running",))["attempts"], 2)
            service.post("/v1/jobs/%s/cancel" % job_id, "")
            self.assertEqual(service.wait_for(job_id)["attempts"], 2)

    def test_a_job_whose_cancel_was_accepted_does_not_run_again(self):
        with Service("--workers", "1", "--drain-timeout", "0") as service:
            job_id = service.post_job(LONG)["id"]
            service.wait_for(job_id, ("running",))
            self.assertEqual(service.post("/v1/jobs/%s/cancel" % job_id, "").status, 202)
            service.kill()
            service.start()
            self.assertEqual(service.job(job_id)["status"], "cancelled")

    def test_every_accepted_job_ends_once_through_several_kills(self):
        with Service("--workers", "2") as service:
            ids = []
            for _ in range(3):
                ids += [service.post_job(QUICK)["id"] for _ in range(30)]
                service.kill()
                service.start()
            for job_id in ids:
                self.assertEqual(service.wait_for(job_id)["status"], "succeeded")
            listed = []
            path = "/v1/jobs?limit=200"
            while path:
                page = service.get(path).json
                listed += [job["id"] for job in page["jobs"]]
                path = page["next"]
            self.assertEqual(sorted(listed), sorted(ids))

    def test_sigterm_ends_with_0_and_gives_running_jobs_back_to_the_queue(self):
        with Service("--workers", "1", "--drain-timeout", "0.1") as service:
            job_id = service.post_job(LONG)["id"]
            service.wait_for(job_id, ("running",))
            service.process.send_signal(signal.SIGTERM)
            self.assertEqual(service.process.wait(20), 0)
            service.process.stdout.close()
            service.start()
            job = service.wait_for(job_id, ("running",))
            self.assertEqual(job["attempts"], 2)

    def test_sigterm_lets_a_running_job_end_within_its_grace(self):
        with Service("--workers", "1", "--drain-timeout", "20") as service:
            ids = [service.post_job(QUICK)["id"] for _ in range(5)]
            self.assertEqual(service.stop(), 0)
            service.start()
            for job_id in ids:
                self.assertEqual(service.wait_for(job_id)["status"], "succeeded")

    def test_a_waiting_client_is_answered_when_the_service_stops(self):
        with Service("--workers", "1", "--drain-timeout", "0.2") as service:
            answers = []
            client = threading.Thread(
                target=lambda: answers.append(service.post("/v1/jobs", LONG, {"Prefer": "wait=60"})))
            client.start()
            service.wait_for_any("running")
            service.process.send_signal(signal.SIGTERM)
            client.join(30)
            self.assertEqual([answer.status for answer in answers], [202])
            service.process.wait(20)


if __name__ == "__main__":
    unittest.main()
