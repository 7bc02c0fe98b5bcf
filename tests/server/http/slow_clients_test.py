"""Clients that end their sending and still read, that disconnect before their answer, and that do not read it."""

import concurrent.futures
import json
import os
import re
import socket
import sqlite3
import time
import unittest

from service import FOPDT, LONG, QUICK, Service

CHEAP = {"plant": FOPDT, "tune": [{"method": "simc"}]}
# Takes seconds on all cores; a call gets ten.
HEAVY = {"plant": {"type": "set", "plants": [{**LONG["plant"], "K": 7 + 0.1 * i} for i in range(50)]},
         "tune": [{"method": "robust", "search": "grid", "surface": True, "Ms": 1.4}]}
MEGABYTE = 1 << 20


def post(path, body):
    text = json.dumps(body).encode()
    return (b"POST %s HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\nContent-Length: %d\r\n\r\n"
            % (path.encode(), len(text)) + text)


def read_all(connection):
    received = b""
    while chunk := connection.recv(65536):
        received += chunk
    return received


def final(received):
    """Status and body of the answer after interim ones."""
    while received.startswith(b"HTTP/1.1 100 "):
        received = received.partition(b"\r\n\r\n")[2]
    head, _, body = received.partition(b"\r\n\r\n")
    return int(head.split()[1]) if head else 0, body


def metric(service, name):
    text = service.get("/metrics").body.decode()
    return float(re.search(r"^%s (\S+)$" % re.escape(name), text, re.M).group(1))


def resident(service):
    """Bytes of memory in use by the process."""
    with open("/proc/%d/statm" % service.process.pid) as figures:
        return int(figures.read().split()[1]) * 4096


class LeavingTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.service = Service("--workers", "1")
        cls.addClassCleanup(cls.service.__exit__)

    def connect(self, request):
        connection = socket.create_connection(("127.0.0.1", self.service.port), timeout=60)
        self.addCleanup(connection.close)
        connection.sendall(request)
        return connection

    def half_closed(self, request):
        """The bytes that a client receives after it has ended its sending."""
        connection = self.connect(request)
        connection.shutdown(socket.SHUT_WR)
        return final(read_all(connection))

    def until_logged(self, sentence, patience=10):
        end = time.monotonic() + patience
        while sentence not in self.service.read_log():
            self.assertLess(time.monotonic(), end, self.service.read_log()[-1000:])

    def test_who_has_ended_its_sending_gets_its_answer(self):
        controller = {"form": "ideal", "Kp": 1, "Ti": 10}
        for path, body in (("/v1/evaluate", {"plant": FOPDT, "controllers": [controller]}), ("/v1/design", CHEAP),
                           ("/v1/frontier", {"plant": FOPDT, "Ms": {"from": 1.2, "to": 2, "points": 5}}),
                           ("/v1/experiments/relay", {"plant": FOPDT}), ("/v1/plants/parse", {"text": "2/(s+1)"})):
            with self.subTest(path=path):
                status, answer = self.half_closed(post(path, body))
                self.assertEqual((status, json.loads(answer).keys()), (200, self.service.post(path, body).json.keys()))

    def test_who_has_ended_its_sending_follows_a_job_to_its_end(self):
        job = self.service.post_job(QUICK)
        request = b"GET /v1/jobs/%s/events HTTP/1.1\r\nHost: localhost\r\n\r\n" % job["id"].encode()
        self.assertIn(b"event: done", self.half_closed(request)[1])

    def test_turns_leaving_and_waiting_for_too_long(self):
        calls = 12 * len(os.sched_getaffinity(0))
        with concurrent.futures.ThreadPoolExecutor(calls) as pool:
            heavy = [pool.submit(self.service.post, "/v1/design", HEAVY) for _ in range(calls)]
            end = time.monotonic() + 8
            while metric(self.service, "tunewright_synchronous_waiting") < 1:
                self.assertLess(time.monotonic(), end)
            waiting = self.connect(post("/v1/design", CHEAP))
            waiting.shutdown(socket.SHUT_WR)
            self.connect(post("/v1/range", HEAVY)).close()
            self.until_logged('"/v1/range" 499')
            answers = [call.result() for call in heavy]
        self.assertIn(final(read_all(waiting))[0], (200, 503, 504))
        self.assertLessEqual({answer.status for answer in answers}, {200, 503, 504})
        stopped = [answer for answer in answers if answer.status == 504]
        late = [answer for answer in answers if answer.status == 503]
        # A call whose turn comes at the last moment is stopped as it begins: either status is possible.
        self.assertTrue(stopped or late, "the calls of one client wait for its others")
        for answer in stopped:
            self.assertIn("stopped after 10 s", answer.json["detail"])
        for answer in late:
            self.assertIn("was not started", answer.json["detail"])
            self.assertIn("Retry-After", answer.headers)

    def test_a_computation_ends_with_its_client(self):
        self.connect(post("/v1/design", HEAVY)).close()
        self.until_logged('"/v1/design" 499')


class UnreadTest(unittest.TestCase):
    def test_answers_that_nobody_reads_take_bounded_memory(self):
        with Service("--workers", "2") as service:
            job = service.post_job({"plant": FOPDT, "tune": [{"method": "all"}], "evaluate": {"points": 1500}}, wait=60)
            path = "/v1/jobs/" + job["id"]
            size = len(service.get(path).body)
            self.assertGreater(size, 6 * MEGABYTE)
            readers = [self.unread(service, path) for _ in range(40)]
            most = 0
            for _ in range(40):
                most = max(most, resident(service))
                self.assertEqual(service.get("/healthz").status, 200)
                time.sleep(0.1)
            self.assertLess(most, 128 * MEGABYTE + 16 * size)
            self.assertLessEqual(metric(service, "tunewright_http_unsent_bytes"), 128 * MEGABYTE + 4 * size)
            self.assertEqual(len(service.get(path).body), size, "who reads is served")
            for reader in readers:
                reader.close()

    def test_long_results_of_batches_come_row_by_row(self):
        with Service("--workers", "2") as service:
            entry = {"plant": FOPDT, "tune": [{"method": "all"}], "evaluate": {"points": 1500}}
            batch = service.post("/v1/batches", {"jobs": [entry] * 12}).json["id"]
            path = "/v1/batches/%s/results" % batch
            whole = service.get(path + "?follow=true").body
            self.assertEqual(whole.count(b"\n"), 12)
            before = resident(service)
            readers = [self.unread(service, path) for _ in range(20)]
            time.sleep(4)
            self.assertLess(resident(service) - before, 256 * MEGABYTE + len(whole))
            for reader in readers:
                reader.close()

    def unread(self, service, path):
        connection = socket.socket()
        self.addCleanup(connection.close)
        connection.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
        connection.connect(("127.0.0.1", service.port))
        connection.sendall(b"GET %s HTTP/1.1\r\nHost: localhost\r\n\r\n" % path.encode())
        return connection


class BrokenOffTest(unittest.TestCase):
    def test_results_of_a_batch_that_is_deleted_meanwhile_lack_their_end(self):
        with Service("--workers", "2") as service:
            entry = {**QUICK, "evaluate": {"points": 400}}
            batch = service.post("/v1/batches", {"jobs": [entry] * 400}).json["id"]
            service.get("/v1/batches/%s/results?follow=true" % batch)
            connection = socket.socket()
            self.addCleanup(connection.close)
            connection.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
            connection.connect(("127.0.0.1", service.port))
            connection.settimeout(60)
            connection.sendall(b"GET /v1/batches/%s/results HTTP/1.1\r\nHost: localhost\r\n\r\n" % batch.encode())
            connection.recv(1)
            self.assertEqual(service.call("DELETE", "/v1/batches/" + batch).status, 204)
            received = read_all(connection)
            self.assertLess(received.count(b'"index":'), 400)
            self.assertFalse(received.endswith(b"0\r\n\r\n"))
            self.assertIn("was deleted meanwhile", service.read_log())


class StoreOwesAnAnswerTest(unittest.TestCase):
    def until_bodies_hold(self, service, expected):
        end = time.monotonic() + 30
        while not expected(held := metric(service, "tunewright_http_body_bytes")):
            self.assertLess(time.monotonic(), end, "bodies hold %d bytes" % held)
            time.sleep(0.02)

    def test_a_small_body_is_counted_until_the_store_has_answered(self):
        with Service("--workers", "1", "--drain-timeout", "0") as service, \
                concurrent.futures.ThreadPoolExecutor(5) as threads:
            running = service.post_job(LONG)["id"]
            service.wait_for(running, ("running",))
            body = dict(CHEAP, name="n" * 200)
            other = sqlite3.connect(service.store[len("sqlite:"):], timeout=60, isolation_level=None)
            self.addCleanup(other.close)
            other.execute("BEGIN IMMEDIATE")  # the store cannot write
            posts = [threads.submit(service.post_job, body, wait) for wait in (None, 60, 60, 60)]
            self.until_bodies_hold(service, lambda held: held >= 4 * len(json.dumps(body)))
            design = service.post("/v1/design", dict(CHEAP, name="x" * 100_000))
            self.assertIn(design.status, (200, 422), "what waits for the store keeps nobody from being answered")
            other.execute("ROLLBACK")
            # The store has them; three calls continue to wait for their ends and hold no memory.
            first = posts[0].result(30)["id"]
            self.until_bodies_hold(service, lambda held: held == 0)
            self.assertFalse(any(post.done() for post in posts[1:]))
            service.post("/v1/jobs/%s/cancel" % running, "")
            self.assertEqual([post.result(60)["status"] for post in posts[1:]], ["succeeded"] * 3)
            self.assertEqual(service.wait_for(first)["status"], "succeeded")

    def test_a_client_that_leaves_while_the_store_owes_an_answer_is_counted_until_then(self):
        with Service("--workers", "1") as service:
            other = sqlite3.connect(service.store[len("sqlite:"):], timeout=60, isolation_level=None)
            self.addCleanup(other.close)
            other.execute("BEGIN IMMEDIATE")
            with socket.create_connection(("127.0.0.1", service.port)) as connection:
                connection.sendall(post("/v1/jobs", CHEAP).replace(b"\r\n", b"\r\nPrefer: wait=60\r\n", 1))
                self.until_bodies_hold(service, lambda held: held > 0)
            time.sleep(0.6)  # the connection is checked every quarter of a second
            self.assertGreater(metric(service, "tunewright_http_body_bytes"), 0)
            other.execute("ROLLBACK")
            self.until_bodies_hold(service, lambda held: held == 0)
            self.assertEqual(len(service.get("/v1/jobs").json["jobs"]), 1)


@unittest.skipIf("TSAN_OPTIONS" in os.environ, "the memory of the sanitizer counts too")
class LargeRecordTest(unittest.TestCase):
    """A file as a text of JSON, with the shortest possible numbers."""

    def test_it_takes_no_more_than_its_share(self):
        memory = 256 * MEGABYTE
        with Service("--workers", "1", "--memory", "256MiB", "--max-body", "64MiB") as service:
            self.assertIn("--max-body is lowered from 65536KiB to 8192KiB", service.read_log())
            self.assertEqual(service.get("/healthz").json["max_body_bytes"], 8 * MEGABYTE)
            self.assertEqual(service.post("/v1/jobs", b"x" * (9 * MEGABYTE)).status, 413)
            rows = "t,u,y\n" + "".join("%d,%d,%d\n" % (i, i // 100 % 2, i % 10) for i in range(600_000))
            body = json.dumps({"record": {"csv": rows[:7_500_000]}})
            self.assertLess(len(body), 8 * MEGABYTE)
            with concurrent.futures.ThreadPoolExecutor(6) as threads:
                answers = list(threads.map(lambda _: service.post("/v1/jobs", body).status, range(6)))
            self.assertLessEqual(set(answers), {200, 202, 422, 503}, answers)
            with open("/proc/%d/status" % service.process.pid) as status:
                peak = 1024 * int(re.search(r"VmHWM:\s+(\d+)", status.read()).group(1))
            print("peak %.0f MiB, %r" % (peak / MEGABYTE, answers))
            self.assertLess(peak, memory)


if __name__ == "__main__":
    unittest.main()
