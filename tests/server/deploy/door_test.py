"""Resources that clients may hold: memory, threads, readers of the store, room on the disk. Each case once blocked
other clients."""

import concurrent.futures
import json
import os
import socket
import time
import unittest

from faulty_places import SmallDisk, all_end, assert_intact, may_mount
from service import FOPDT, LONG, QUICK, Service
from slow_clients_test import metric, resident

MEGABYTE = 1 << 20


def connect(service):
    return socket.create_connection(("127.0.0.1", service.port), timeout=20)


def head(path, length, fields=""):
    return ("POST %s HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\nContent-Length: %d\r\n%s\r\n"
            % (path, length, fields)).encode()


def threads(service):
    return len(os.listdir("/proc/%d/task" % service.process.pid))


class BodiesTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.service = Service("--workers", "1")
        cls.addClassCleanup(cls.service.__exit__)

    def hold(self, *requests):
        """Connections that have sent these bytes and send no more."""
        made = []
        for request in requests:
            made.append(connect(self.service))
            self.addCleanup(made[-1].close)
            made[-1].sendall(request)
        return made

    def test_a_length_that_is_declared_takes_nothing(self):
        self.hold(*[head(path, length) for path in ("/x", "/v1/jobs") for length in (8388608, 8388608, 5592405)] * 4)
        time.sleep(0.2)
        self.assertEqual(metric(self.service, "tunewright_http_body_bytes"), 0)
        begun = time.monotonic()
        self.assertEqual(self.service.post("/v1/jobs", QUICK).status, 202)
        self.assertLess(time.monotonic() - begun, 3)

    def test_what_nobody_takes_is_refused_before_its_body(self):
        for path, status in (("/x", b"404"), ("/v1/nothing", b"404"), ("/healthz", b"405")):
            (connection,) = self.hold(head(path, 100))
            self.assertEqual(connection.recv(65536).split()[1], status)

    def test_small_values_in_large_numbers_are_refused_and_leave_nothing(self):
        """The tree of such values takes thirty times the memory of their text."""
        body = b"[" + b",".join([b'{"":0}'] * (8 * MEGABYTE // 7 - 1)) + b"]"
        with concurrent.futures.ThreadPoolExecutor(6) as pool:
            calls = [pool.submit(self.service.post, path, body) for path in ("/v1/jobs", "/v1/design", "/v1/evaluate") * 4]
            statuses = {call.result().status for call in calls}
        self.assertEqual(statuses, {413})
        self.assertLess(resident(self.service), 400 * MEGABYTE)

    def test_an_answer_has_so_many_points(self):
        controllers = [{"form": "ideal", "Kp": 0.5 + 0.01 * i, "Ti": 10} for i in range(50)]
        answer = self.service.post("/v1/evaluate", {"plant": FOPDT, "controllers": controllers, "evaluate": {"points": 20000}})
        self.assertEqual(answer.status, 422)
        self.assertEqual(answer.json["errors"][0]["pointer"], "/evaluate/points")
        answer = self.service.post("/v1/evaluate", {"plant": FOPDT, "controllers": controllers[:5], "evaluate": {"points": 20000}})
        self.assertEqual(answer.status, 200)


class WaitsTest(unittest.TestCase):
    def test_nobody_waits_for_who_has_gone(self):
        with Service("--workers", "1") as service:
            before = threads(service)
            text = json.dumps(LONG).encode()
            gone = [connect(service) for _ in range(60)]
            for connection in gone:
                connection.sendall(head("/v1/jobs", len(text), "Prefer: wait=60\r\n") + text)
            end = time.monotonic() + 10
            while len(service.get("/v1/jobs?limit=200").json["jobs"]) < 60:
                self.assertLess(time.monotonic(), end)
            for connection in gone:
                connection.close()
            # Their threads serve other connections, or end after some seconds without work.
            end = time.monotonic() + 30
            while threads(service) > before + 5:
                self.assertLess(time.monotonic(), end)
                time.sleep(0.1)
            for job in service.get("/v1/jobs?limit=200").json["jobs"]:
                service.post("/v1/jobs/%s/cancel" % job["id"], "")


class ListsTest(unittest.TestCase):
    def test_lists_open_few_files_and_let_single_jobs_through(self):
        with Service("--workers", "1") as service:
            job = service.post_job(QUICK, wait=30)
            for _ in range(50):
                service.post_job(QUICK)
            end = time.monotonic() + 3
            slowest = 0

            def list_on():
                while time.monotonic() < end:
                    service.get("/v1/jobs?limit=200")

            with concurrent.futures.ThreadPoolExecutor(60) as pool:
                lists = [pool.submit(list_on) for _ in range(60)]
                while time.monotonic() < end:
                    begun = time.monotonic()
                    self.assertEqual(service.get("/v1/jobs/" + job["id"]).status, 200)
                    slowest = max(slowest, time.monotonic() - begun)
                files = os.listdir("/proc/%d/fd" % service.process.pid)
                for one in lists:
                    one.result()
            database = sum("jobs.db" in os.readlink("/proc/%d/fd/%s" % (service.process.pid, name))
                           for name in os.listdir("/proc/%d/fd" % service.process.pid))
            self.assertLess(database, 40)
            self.assertLess(len(files), 200)
            self.assertLess(slowest, 2)


class QueueTest(unittest.TestCase):
    def test_a_full_queue_knows_the_keys_that_it_has_taken(self):
        with Service("--workers", "1", "--queue-limit", "1") as service:
            running = service.post_job(LONG)
            while service.job(running["id"])["status"] != "running":
                time.sleep(0.01)
            key = {"Idempotency-Key": "once"}
            first = service.post("/v1/jobs", QUICK, key)
            self.assertEqual(first.status, 202)
            self.assertEqual(service.post("/v1/jobs", QUICK).status, 429)
            again = service.post("/v1/jobs", QUICK, key)
            self.assertEqual((again.status, again.json["id"]), (202, first.json["id"]))
            self.assertEqual(service.post("/v1/jobs", {**QUICK, "name": "other"}, key).status, 409)
            service.post("/v1/jobs/%s/cancel" % running["id"], "")

    def test_nothing_begins_after_a_pause(self):
        with Service("--workers", "2") as service:
            ids = [service.post_job(QUICK)["id"] for _ in range(400)]
            self.assertEqual(service.post("/v1/queue/pause", "").status, 200)
            begun = [service.job(one)["status"] for one in ids]
            time.sleep(0.5)
            later = [service.job(one)["status"] for one in ids]
            self.assertEqual(later.count("queued"), begun.count("queued"))
            service.post("/v1/queue/resume", "")


@unittest.skipUnless(may_mount(), "a small file system needs the right to mount one: run script/test as root, in a container with CAP_SYS_ADMIN")
class FullDiskTest(unittest.TestCase):
    LARGE = {**QUICK, "evaluate": {"points": 5000}}

    def test_a_full_disk_loses_nothing_deletes_and_recovers(self):
        with SmallDisk(12) as disk:
            path = disk.folder + "/jobs.db"
            with Service("--workers", "1", store=path) as service:
                ids = []
                end = time.monotonic() + 60
                while (answer := service.post("/v1/jobs", self.LARGE, {"Prefer": "wait=2"})).status in (200, 202):
                    ids.append(answer.json["id"])
                    self.assertLess(time.monotonic(), end)
                self.assertEqual(answer.status, 507)
                disk.fill()
                while (answer := service.post("/v1/jobs", self.LARGE)).status == 202:
                    ids.append(answer.json["id"])
                    self.assertLess(time.monotonic(), end)
                self.assertEqual((answer.status, service.get("/readyz").status), (507, 503))
                self.assertEqual({service.get("/v1/jobs/" + one).status for one in ids}, {200})
                ended = [one for one in ids if service.job(one)["status"] == "succeeded"]
                for one in ended[:len(ended) // 2]:
                    self.assertEqual(service.call("DELETE", "/v1/jobs/" + one).status, 204)
                    ids.remove(one)
                service.stop()
                service.start()
                self.assertEqual({service.get("/v1/jobs/" + one).status for one in ids}, {200})
                disk.empty()
                end = time.monotonic() + 30
                while (answer := service.post("/v1/jobs", QUICK)).status != 202:
                    self.assertLess(time.monotonic(), end)
                    time.sleep(0.2)
                all_end(service, [*ids, answer.json["id"]])
            assert_intact(path)


class MovedFileTest(unittest.TestCase):
    def test_a_file_that_is_gone_takes_no_more_jobs(self):
        for change in (os.remove, lambda path: os.replace(path, path + ".away")):
            with Service("--workers", "1") as service:
                service.post_job(QUICK, wait=30)
                change(service.store.removeprefix("sqlite:"))
                time.sleep(1.2)
                self.assertEqual(service.get("/readyz").status, 503)
                self.assertEqual(service.post("/v1/jobs", QUICK).status, 503)
                self.assertIn("removed or replaced", service.read_log())


class SitesTest(unittest.TestCase):
    def test_what_a_browser_marks_as_anothers_reads_nothing(self):
        with Service("--workers", "1") as service:
            marked = {"Sec-Fetch-Site": "cross-site"}
            self.assertEqual(service.get("/v1/jobs", marked).status, 403)
            self.assertEqual(service.get("/", {**marked, "Sec-Fetch-Mode": "navigate"}).status, 200)


if __name__ == "__main__":
    unittest.main()
