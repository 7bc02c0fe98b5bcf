"""Hostile clients: streams that two parsers could read differently, floods, and crowds that never finish. Each bad
stream gets at most one answer and a closed connection, and the service is as healthy after it as before."""

import collections
import json
import os
import re
import resource
import shutil
import socket
import subprocess
import threading
import time
import unittest

from api_fuzz import OPTIONS, Api, round_of_calls
from service import BINARY, LONG, QUICK, Service

HOST = b"Host: localhost\r\n"
CHUNKED = b"Transfer-Encoding: chunked\r\n"
SECOND = b"GET /metrics HTTP/1.1\r\n" + HOST + b"\r\n"


def get(target=b"/healthz", fields=b""):
    return b"GET " + target + b" HTTP/1.1\r\n" + HOST + fields + b"\r\n"


def post(target=b"/v1/batches", fields=b"", body=b""):
    return b"POST " + target + b" HTTP/1.1\r\n" + HOST + b"Content-Type: application/x-ndjson\r\n" + fields + b"\r\n" + body


# The input, and the statuses of all answers. Each ends with a complete second request that must not be answered.
MALFORMED = {
    "a length and chunks": (post(fields=b"Content-Length: 5\r\n" + CHUNKED, body=b"0\r\n\r\n"), [400]),
    "chunks and a length": (post(fields=CHUNKED + b"Content-Length: 5\r\n", body=b"0\r\n\r\n"), [400]),
    "chunks where a length is wanted": (post(b"/v1/jobs", CHUNKED, b"2\r\n{}\r\n0\r\n\r\n"), [411]),
    "chunks with a GET": (get(fields=CHUNKED) + b"0\r\n\r\n", [411]),
    "chunks twice": (post(fields=CHUNKED + CHUNKED, body=b"0\r\n\r\n"), [400]),
    "chunks behind another coding": (post(fields=b"Transfer-Encoding: gzip, chunked\r\n", body=b"0\r\n\r\n"), [400]),
    "a coding that looks like chunks": (post(fields=b"Transfer-Encoding: xchunked\r\n", body=b"0\r\n\r\n"), [400]),
    "chunks of HTTP/1.0": (b"POST /v1/batches HTTP/1.0\r\n" + CHUNKED + b"\r\n0\r\n\r\n", [400]),
    "a chunk of -2": (post(fields=CHUNKED, body=b"-2\r\nab\r\n0\r\n\r\n"), [400]),
    "a chunk of 0x2": (post(fields=CHUNKED, body=b"0x2\r\nab\r\n0\r\n\r\n"), [400]),
    "a chunk of no size": (post(fields=CHUNKED, body=b"\r\nab\r\n0\r\n\r\n"), [400]),
    "a chunk whose size overflows": (post(fields=CHUNKED, body=b"FFFFFFFFFFFFFFFF2\r\nab\r\n0\r\n\r\n"), [400]),
    "a chunk beyond the limit": (post(fields=CHUNKED, body=b"7fffffff\r\nab\r\n0\r\n\r\n"), [413]),
    "a chunk with an extension": (post(fields=CHUNKED, body=b"2;a=b\r\n{}\r\n0\r\n\r\n"), [400]),
    "a chunk without its line end": (post(fields=CHUNKED, body=b"2\r\n{}0\r\n\r\n"), [400]),
    "a chunk longer than it says": (post(fields=CHUNKED, body=b"1\r\n{}\r\n0\r\n\r\n"), [400]),
    "a chunk with bare line feeds": (post(fields=CHUNKED, body=b"2\n{}\n0\n\n"), [400]),
    "trailers": (post(fields=CHUNKED, body=b"0\r\nHost: y\r\n\r\n"), [400]),
    "a compressed body": (post(fields=b"Content-Encoding: gzip\r\nContent-Length: 2\r\n", body=b"\x1f\x8b"), [415]),
    "two lengths": (post(fields=b"Content-Length: 1\r\nContent-Length: 2\r\n", body=b"ab"), [400]),
    "two lengths in one": (post(fields=b"Content-Length: 1, 1\r\n", body=b"a"), [400]),
    "a length of +1": (post(fields=b"Content-Length: +1\r\n", body=b"a"), [400]),
    "a length of -1": (post(fields=b"Content-Length: -1\r\n"), [400]),
    "a length beyond the limit": (post(fields=b"Content-Length: 999999999999\r\n"), [413]),
    "two hosts": (get(fields=b"Host: y\r\n"), [400]),
    "no host": (b"GET /healthz HTTP/1.1\r\n\r\n", [400]),
    "another site's target": (get(b"http://other/healthz"), [400]),
    "an authority as target": (b"CONNECT other:80 HTTP/1.1\r\n" + HOST + b"\r\n", [400]),
    "a folded field": (get(fields=b"A: b\r\n Content-Length: 5\r\n"), [400]),
    "a space before the colon": (get(fields=b"Content-Length : 5\r\n"), [400]),
    "a field without a name": (get(fields=b": b\r\n"), [400]),
    "a NUL in a field": (get(fields=b"A: b\x00c\r\n"), [400]),
    "a NUL in the target": (get(b"/health\x00z"), [400]),
    "a NUL in a name": (get(fields=b"A\x00: b\r\n"), [400]),
    "a bare carriage return": (get(fields=b"A: b\rContent-Length: 5\r\n"), [400]),
    "bare line feeds": (b"GET /healthz HTTP/1.1\nHost: localhost\n\n" + b"\r\n\r\n", [400]),
    "a target beyond the limit": (get(b"/" + b"a" * 9000), [414]),
    "a field beyond the limit": (get(fields=b"A: " + b"b" * 9000 + b"\r\n"), [431]),
    "200 fields": (get(fields=b"A: b\r\n" * 200), [431]),
    "a head beyond the limit": (get(fields=(b"A: " + b"b" * 1000 + b"\r\n") * 20), [431]),
    "HTTP/2 by prior knowledge": (b"PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n", [505]),
    "TLS": (b"\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03" + b"\xaa" * 40 + b"\r\n\r\n", [400]),
    "garbage behind a request": (get() + b"\x00\xff\r\n\r\n", [200, 400]),
    "half a request behind one": (get() + b"GET /healthz HTTP/1.1\r\nbroken\r\n\r\n", [200, 400]),
}


class MalformedTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.service = Service()
        cls.addClassCleanup(cls.service.__exit__)

    def conversation(self, data, cut):
        """The statuses of all answers until the service closes; fails if it does not close."""
        received = b""
        with socket.create_connection(("127.0.0.1", self.service.port), timeout=10) as connection:
            try:
                for at in range(0, len(data), cut):
                    connection.sendall(data[at:at + cut])
                while part := connection.recv(65536):
                    received += part
            except ConnectionError:
                pass
            except socket.timeout:
                self.fail("the connection is still open after %r" % received[:200])
        return [int(status) for status in re.findall(rb"HTTP/1\.1 (\d\d\d) ", received)]

    def test_a_malformed_stream_gets_one_refusal_and_the_connection_is_closed(self):
        for name, (data, expected) in MALFORMED.items():
            for cut in (1 << 20, 7):
                with self.subTest(name, cut=cut):
                    self.assertEqual(self.conversation(data + SECOND, cut), expected)
                    self.assertEqual(self.service.get("/healthz").status, 200)

    def test_a_request_in_front_of_a_malformed_one_is_answered(self):
        data = get() + get(b"/readyz") + post(fields=CHUNKED, body=b"-2\r\n") + SECOND
        self.assertEqual(self.conversation(data, 1 << 20), [200, 200, 400])

    def test_an_upload_of_endless_fields_is_cut_off(self):
        for flood in (b"X: " + b"y" * 4000 + b"\r\n", b"y" * 4096, b"\r\n" * 2048):
            with self.subTest(flood[:8]):
                connection = socket.create_connection(("127.0.0.1", self.service.port), timeout=20)
                with self.assertRaises(OSError):
                    connection.sendall(b"GET /healthz HTTP/1.1\r\n" + HOST if flood[:1] == b"X" else b"")
                    for _ in range(10_000):
                        connection.sendall(flood)
                connection.close()
                self.assertEqual(self.service.get("/healthz").status, 200)


class CrowdTest(unittest.TestCase):
    """Many clients at once, together with an ordinary client."""

    def open(self, data=b""):
        connection = socket.create_connection(("127.0.0.1", self.service.port), timeout=30)
        self.crowd.append(connection)
        if data:
            connection.sendall(data)
        return connection

    def close_all(self):
        for connection in self.crowd:
            connection.close()

    def test_idle_slow_waiting_and_listening_clients_stop_nobody(self):
        most = resource.getrlimit(resource.RLIMIT_NOFILE)
        resource.setrlimit(resource.RLIMIT_NOFILE, (most[1], most[1]))
        self.addCleanup(resource.setrlimit, resource.RLIMIT_NOFILE, most)
        self.service = Service("--workers", "1")
        self.addCleanup(self.service.__exit__)
        self.crowd = []
        self.addCleanup(self.close_all)
        body = json.dumps(LONG).encode()
        waiting = post(b"/v1/jobs", b"Prefer: wait=60\r\nContent-Length: %d\r\n" % len(body), body).replace(
            b"x-ndjson", b"json")
        long_job = self.service.post_job(LONG)["id"].encode()

        listening = [self.open(get(b"/v1/jobs/" + long_job + b"/events")) for _ in range(200)]
        for connection in listening:
            self.assertTrue(connection.recv(100).startswith(b"HTTP/1.1 200 "))
        idle = [self.open(get()) for _ in range(500)]
        for connection in idle:
            self.assertTrue(connection.recv(1000).startswith(b"HTTP/1.1 200 "))
        slow = [self.open() for _ in range(50)]
        for _ in range(200):
            self.open(waiting)

        stop = threading.Event()

        def drip():
            for byte in post(b"/v1/jobs", b"Content-Length: 1000\r\n"):
                for connection in slow:
                    connection.send(bytes([byte]))
                if stop.wait(1):
                    return

        dripping = threading.Thread(target=drip)
        dripping.start()
        try:
            for _ in range(100):
                self.assertEqual(self.service.get("/v1/methods").status, 200)
                self.assertEqual(self.service.post("/v1/jobs", QUICK).status, 202)
        finally:
            stop.set()
            dripping.join()
        # One thread for each connection, and some of the service's own.
        self.assertLess(len(os.listdir("/proc/%d/task" % self.service.process.pid)), 950 + 50)


class ManyAtOnceTest(unittest.TestCase):
    def test_sockets_that_send_nothing_keep_nobody_else_out(self):
        most = resource.getrlimit(resource.RLIMIT_NOFILE)
        resource.setrlimit(resource.RLIMIT_NOFILE, (most[1], most[1]))
        self.addCleanup(resource.setrlimit, resource.RLIMIT_NOFILE, most)
        with Service() as service:
            crowd = []
            for _ in range(3000):  # there is room for 2,048
                crowd.append(socket.socket())
                crowd[-1].bind(("127.0.0.2", 0))
                crowd[-1].settimeout(20)
                crowd[-1].connect(("127.0.0.1", service.port))
                crowd[-1].sendall(b"G")
            for _ in range(50):
                start = time.monotonic()
                self.assertEqual(service.get("/v1/methods").status, 200)
                if "san" not in BINARY:  # incomplete heads would keep a slot for 10 s
                    self.assertLess(time.monotonic() - start, 10)
            for connection in crowd:
                connection.close()

    def test_many_large_bodies_stay_within_the_budget(self):
        body = b'{"plant": {"type": "fopdt", "K": 1, "T": 10, "L": 2}, "tune": {"method": "simc"}, "name": "%s"}' % (
            b"x" * 6_000_000)
        head = post(b"/v1/jobs", b"Content-Length: %d\r\n" % len(body), b"").replace(b"x-ndjson", b"json")
        answers = []

        def upload(service):
            with socket.create_connection(("127.0.0.1", service.port), timeout=60) as connection:
                try:
                    connection.sendall(head + body)
                except OSError:
                    pass  # refused before all of it was sent
                answers.append(connection.recv(100)[:12])

        with Service() as service:
            uploads = [threading.Thread(target=upload, args=(service,)) for _ in range(40)]
            for each in uploads:
                each.start()
            for each in uploads:
                each.join()
            self.assertEqual(len(answers), 40)
            self.assertLessEqual(set(answers), {b"HTTP/1.1 422", b"HTTP/1.1 503"})
            status = open("/proc/%d/status" % service.process.pid).read()
            peak = int(re.search(r"VmHWM:\s+(\d+) kB", status).group(1))
            if "san" not in BINARY:
                self.assertLess(peak, 200_000)  # kB; the budget is 128 MiB, the process itself takes about 30

    def test_a_client_that_never_reads_does_not_keep_the_service_from_stopping(self):
        with Service() as service:
            connection = socket.create_connection(("127.0.0.1", service.port), timeout=20)
            connection.sendall(get(b"/openapi.json") * 100)
            self.assertEqual(service.get("/healthz").status, 200)
            started = time.monotonic()
            self.assertEqual(service.stop(), 0)
            self.assertLess(time.monotonic() - started, 15)
            connection.close()


class FewThreads(Service):
    """A service whose user may have this number of threads. It runs from a folder that this user can read."""

    AS_ANOTHER = ["setpriv", "--reuid", "54321", "--regid", "54321", "--clear-groups"]

    def start(self):
        os.chmod(self.folder.name, 0o777)
        shutil.copy(BINARY, self.folder.name)
        super().start()

    def command(self):
        _, *arguments = super().command()
        return [*self.AS_ANOTHER, "prlimit", "--nproc=100", os.path.join(self.folder.name, os.path.basename(BINARY)), *arguments]


@unittest.skipUnless(os.getuid() == 0, "a limit on another user's threads needs root: run script/test as root")
class FewThreadsTest(unittest.TestCase):
    def test_an_idle_connection_gives_way_where_there_are_no_more_threads(self):
        with FewThreads("--workers", "1") as service:
            idle = []
            for _ in range(150):
                idle.append(socket.create_connection(("127.0.0.1", service.port), timeout=20))
                self.addCleanup(idle[-1].close)
                idle[-1].sendall(b"GET /healthz HTTP/1.1\r\nHost: localhost\r\n\r\n")
                self.assertIn(b" 200 OK", idle[-1].recv(4096))
            for _ in range(10):
                self.assertEqual(service.call("GET", "/healthz", timeout=10).status, 200)


class MadeUpCallsTest(unittest.TestCase):
    """A short round of calls generated from the service's own document, always the same."""

    def test_made_up_calls_get_documented_answers(self):
        counts = collections.Counter()
        with Service(*OPTIONS) as service:
            api = Api(service.get("/openapi.json").json)
            round_of_calls(service, api, 2000, counts=counts)
        self.assertEqual({name for name, _ in counts}, {operation["operationId"] for _, _, operation in api.operations})
        self.assertGreater(sum(count for (_, status), count in counts.items() if status < 300), 200)


if __name__ == "__main__":
    unittest.main()
