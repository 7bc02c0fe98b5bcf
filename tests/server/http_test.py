"""HTTP itself: methods, media types, sizes, and clients that are hostile or slow."""

import gzip
import http.client
import json
import re
import socket
import threading
import time
import unittest

from service import FOPDT, QUICK, Service

HOST = b"Host: localhost\r\n"


def statuses(received):
    """The statuses of all answers in the bytes from a socket."""
    return [int(status) for status in re.findall(rb"HTTP/1\.1 (\d\d\d) ", received)]


class HttpTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.service = Service("--cors-origin", "https://plant.example")
        cls.addClassCleanup(cls.service.__exit__)

    def assertProblem(self, answer, status):
        self.assertEqual((answer.status, answer.media_type), (status, "application/problem+json"), answer.body[:200])
        problem = answer.json
        self.assertEqual(problem["status"], status)
        self.assertTrue(problem["type"] and problem["title"])
        self.assertGreater(len(problem["detail"]), 10)

    def test_a_wrong_method_is_405_with_allow(self):
        for method, path, allowed in (("PUT", "/v1/jobs", {"GET", "HEAD", "POST", "OPTIONS"}),
                                      ("GET", "/v1/evaluate", {"POST", "OPTIONS"}),
                                      ("GET", "/v1/experiments/relay", {"POST", "OPTIONS"}),
                                      ("POST", "/healthz", {"GET", "HEAD", "OPTIONS"}),
                                      ("PATCH", "/v1/jobs/x", {"GET", "HEAD", "DELETE", "OPTIONS"}),
                                      ("TRACE", "/v1/methods", {"GET", "HEAD", "OPTIONS"}),
                                      ("POST", "/", {"GET", "HEAD", "OPTIONS"})):
            with self.subTest(method=method, path=path):
                answer = self.service.call(method, path)
                self.assertProblem(answer, 405)
                self.assertEqual(set(answer.headers["Allow"].split(", ")), allowed)

    def test_options_names_the_methods(self):
        answer = self.service.call("OPTIONS", "/v1/jobs")
        self.assertEqual(answer.status, 204)
        self.assertEqual(set(answer.headers["Allow"].split(", ")), {"GET", "HEAD", "POST", "OPTIONS"})

    def test_head_is_get_without_the_body(self):
        for path in ("/healthz", "/openapi.json", "/"):
            head, get = self.service.call("HEAD", path), self.service.get(path)
            self.assertEqual((head.status, head.body), (200, b""))
            self.assertEqual(head.headers["Content-Length"], get.headers["Content-Length"])

    def test_unknown_paths_are_404(self):
        for path in ("/nothing", "/v1", "/v1/jobs/", "/v1/jobs/a/b", "/v1/methods/nothing", "/../etc/passwd",
                     "/%2e%2e/etc/passwd", "/v1%2Fjobs", "//v1/jobs"):
            with self.subTest(path=path):
                self.assertProblem(self.service.get(path), 404)

    def test_a_body_that_is_not_json_is_400_or_415(self):
        self.assertProblem(self.service.post("/v1/jobs", "{"), 400)
        self.assertProblem(self.service.post("/v1/jobs", ""), 400)
        self.assertProblem(self.service.post("/v1/jobs", b"\xff\xfe"), 400)
        for media_type in ("text/plain", "application/xml", "multipart/form-data; boundary=x"):
            self.assertProblem(self.service.post("/v1/jobs", QUICK, {"Content-Type": media_type}), 415)
        self.assertProblem(self.service.post("/v1/jobs", b"\x1f\x8b", {"Content-Encoding": "gzip"}), 415)

    def test_an_invalid_request_names_each_fault(self):
        answer = self.service.post("/v1/jobs", {"plant": {"type": "fopdt", "K": "x", "T": 1}, "speed": 1})
        self.assertProblem(answer, 422)
        self.assertLessEqual({"/plant/K", "/plant/L", "/speed"}, {error["pointer"] for error in answer.json["errors"]})

    def test_what_the_client_does_not_accept_is_406(self):
        self.assertProblem(self.service.get("/v1/methods", {"Accept": "text/html"}), 406)
        self.assertProblem(self.service.get("/v1/methods", {"Accept": "application/json;q=0"}), 406)
        for accept in ("application/*", "text/html, */*;q=0.1", "application/json"):
            self.assertEqual(self.service.get("/v1/methods", {"Accept": accept}).status, 200)

    def test_the_largest_body_that_healthz_states_is_read_and_one_byte_more_is_413(self):
        health = self.service.get("/healthz").json
        self.assertEqual([health["max_body_bytes"], health["retention_s"]], [8 * 1024 * 1024, 7 * 86400])
        with Service("--max-body", "300KiB") as small:
            self.assertEqual(small.get("/healthz").json["max_body_bytes"], 300 * 1024)
            for service in (self.service, small):
                largest = service.get("/healthz").json["max_body_bytes"]
                self.assertProblem(service.post("/v1/jobs", b" " * (largest + 1)), 413)
                self.assertEqual(service.post("/v1/jobs", json.dumps(QUICK).encode().ljust(largest)).status, 202)

    def test_pages_of_other_sites_cannot_post(self):
        refused = self.service.post("/v1/jobs", QUICK, {"Sec-Fetch-Site": "cross-site"})
        self.assertProblem(refused, 403)
        self.assertEqual(refused.json["type"], "cross-site-request")
        self.assertEqual(self.service.post("/v1/jobs", QUICK, {"Sec-Fetch-Site": "same-origin"}).status, 202)

    def test_the_page_has_its_policy_and_everything_is_nosniff(self):
        page = self.service.get("/")
        self.assertEqual(page.media_type, "text/html")
        self.assertIn("require-trusted-types-for 'script'", page.headers["Content-Security-Policy"])
        for path in ("/", "/healthz", "/nothing", "/v1/methods"):
            self.assertEqual(self.service.get(path).headers["X-Content-Type-Options"], "nosniff")

    def test_what_is_refused_before_it_is_read_is_named_too(self):
        long_target = b"GET /" + b"x" * 9000 + b" HTTP/1.1\r\n"
        for status, head in ((400, b"GET / HTTP/1.1\r\n" + HOST + b"Bad Field: x\r\n"), (414, long_target + HOST),
                             (411, b"POST /v1/jobs HTTP/1.1\r\n" + HOST + b"Transfer-Encoding: chunked\r\n"),
                             (413, b"POST /v1/jobs HTTP/1.1\r\n" + HOST + b"Content-Length: 99999999\r\n"),
                             (415, b"POST /v1/jobs HTTP/1.1\r\n" + HOST + b"Content-Encoding: gzip\r\n"),
                             (417, b"POST /v1/jobs HTTP/1.1\r\n" + HOST + b"Expect: much\r\n"),
                             (431, b"GET / HTTP/1.1\r\n" + HOST + b"A: b\r\n" * 101),
                             (505, b"GET / HTTP/3.0\r\n" + HOST)):
            name = b"early-%d" % status
            received = self.service.raw(head + b"Origin: https://plant.example\r\nX-Request-Id: " + name + b"\r\n\r\n")
            self.assertEqual(statuses(received), [status])
            self.assertIn(b"X-Request-Id: " + name, received)
            self.assertIn(b"Access-Control-Allow-Origin: https://plant.example", received)
            self.assertIn("request %s refused" % name.decode(), self.service.read_log())
        self.assertRegex(self.service.raw(b"GET / HTTP/3.0\r\n\r\n"), rb"X-Request-Id: [0-9a-f]{8}-[0-9a-f]{8}")

    def test_hosts_queries_and_methods_that_are_none_are_refused(self):
        for status, head in ((400, b"GET /healthz HTTP/1.1\r\nHost: localhost:abc\r\n\r\n"),
                             (400, b"GET /v1/jobs?q=%zz HTTP/1.1\r\n" + HOST + b"\r\n"),
                             (400, b"GET /v1/jobs?q=x%2 HTTP/1.1\r\n" + HOST + b"\r\n"),
                             (501, b"BREW / HTTP/1.1\r\n" + HOST + b"\r\n")):
            self.assertEqual(statuses(self.service.raw(head)), [status], head)
        for field in (b"localhost:80", b"localhost:", b"[::1]:8080", b"[::1]"):
            received = self.service.raw(b"GET /healthz HTTP/1.1\r\nHost: " + field + b"\r\nConnection: close\r\n\r\n")
            self.assertEqual(statuses(received), [200], field)
        self.assertEqual(self.service.get("/v1/jobs?q=%25zz").status, 200)

    def test_files_are_304_when_unchanged(self):
        tag = self.service.get("/").headers["ETag"]
        self.assertEqual(self.service.get("/", {"If-None-Match": tag}).status, 304)

    def test_the_service_describes_itself(self):
        for path, key in (("/openapi.json", "paths"), ("/v1/methods", "methods"), ("/v1/examples", "examples"),
                          ("/healthz", "status"), ("/readyz", "status")):
            self.assertIn(key, self.service.get(path).json)
        self.assertIn("tunewright_jobs_queued", self.service.get("/metrics").body.decode())

    def test_evaluate_answers_at_once_and_tells_its_time(self):
        body = {"plant": FOPDT, "controllers": [{"form": "ideal", "Kp": 1, "Ti": 10, "Td": 0}]}
        answer = self.service.post("/v1/evaluate", body)
        self.assertEqual(answer.status, 200, answer.body[:300])
        self.assertRegex(answer.headers["Server-Timing"], r"^compute;dur=[\d.]+$")
        self.assertEqual(len(answer.json["controllers"]), 1)

    def test_a_relay_test_is_simulated_at_once(self):
        answer = self.service.post("/v1/experiments/relay", {"plant": FOPDT, "relay": {"hysteresis": 0.2, "cycles": 3}})
        self.assertEqual(answer.status, 200, answer.body[:300])
        self.assertRegex(answer.headers["Server-Timing"], r"^compute;dur=[\d.]+$")
        self.assertEqual(answer.json["limit_cycle"]["periods"], 2)
        refused = self.service.post("/v1/experiments/relay", {"plant": FOPDT, "relay": {"hysteresis": 100}})
        self.assertProblem(refused, 422)

    def test_a_typed_plant_is_a_plant_everywhere(self):
        line = "2 e^(-3s)/(10s+1)"
        parsed = self.service.post("/v1/plants/parse", {"text": line})
        self.assertEqual((parsed.status, parsed.json["text"]), (200, "2 e^(-3 s)/(10 s + 1)"))
        self.assertIn("<mfrac>", parsed.json["formula"])
        self.assertEqual(self.service.post("/v1/plants/parse", {"text": "2/"}).json["errors"][0]["pointer"], "/text")
        relay = self.service.post("/v1/experiments/relay", {"plant": line, "relay": {"cycles": 3}})
        self.assertEqual(relay.status, 200)
        design = self.service.post("/v1/design", {"plant": line, "tune": [{"method": "simc"}]})
        self.assertEqual(design.status, 200, design.body)
        job = self.service.post("/v1/jobs", {"plant": line, "tune": [{"method": "simc"}]}, {"Prefer": "wait=30"}).json
        self.assertEqual(job["request"]["plant"], {"type": "fopdt", "K": 2, "T": 10, "L": 3})
        body = {"jobs": [{"plant": line, "tune": [{"method": "simc"}]}, {"plant": "2/(10s", "tune": [{"method": "simc"}]}]}
        batch = self.service.post("/v1/batches", body).json
        self.assertEqual(batch["total"], 2)

    def test_a_file_is_previewed_as_it_is(self):
        csv = "Zeit [s];Stellgröße;Temperatur\r\n" + "".join("%d;%d,0;2%d,5\r\n" % (k, k // 5, k % 10) for k in range(30))
        for encoding, name in (("utf-8", "utf-8"), ("cp1252", "iso-8859-1"), ("utf-16", "utf-16le")):
            answer = self.service.post("/v1/records/preview", csv.encode(encoding), {"Content-Type": "text/csv"})
            self.assertEqual(answer.status, 200, answer.body[:300])
            found = answer.json
            self.assertEqual([column["guess"] for column in found["columns"]], ["t", "u", "y"])
            self.assertEqual((found["encoding"], found["rows"], found["columns"][1]["heading"]), (name, 30, "Stellgröße"))
        asked = self.service.post("/v1/records/preview", {"csv": csv, "time_unit": "min"})
        self.assertEqual(asked.json["time"]["dt"], 60)
        self.assertProblem(self.service.post("/v1/records/preview", b"<a/>", {"Content-Type": "text/xml"}), 415)

    def test_a_connection_serves_many_requests_and_pipelined_ones_in_order(self):
        connection = http.client.HTTPConnection("127.0.0.1", self.service.port)
        for _ in range(50):
            connection.request("GET", "/healthz")
            self.assertEqual(connection.getresponse().read()[:1], b"{")
        connection.close()
        one = b"GET /%s HTTP/1.1\r\n" + HOST + b"\r\n"
        received = self.service.raw(one % b"healthz" + one % b"nothing" +
                                    b"GET /readyz HTTP/1.1\r\nConnection: close\r\n" + HOST + b"\r\n")
        self.assertEqual(statuses(received), [200, 404, 200])

    def test_answers_are_compressed_for_those_who_take_it(self):
        job = "/v1/jobs/" + self.service.post_job({**QUICK, "evaluate": {}}, wait=30)["id"]
        for path in ("/openapi.json", "/v1/methods", job):
            with self.subTest(path):
                plain = self.service.get(path)
                packed = self.service.get(path, {"Accept-Encoding": "br, gzip;q=0.8"})
                self.assertEqual(packed.headers["Content-Encoding"], "gzip")
                self.assertEqual(gzip.decompress(packed.body), plain.body)
                self.assertLess(len(packed.body), len(plain.body) / 2)
                self.assertIsNone(plain.headers["Content-Encoding"])
                for answer in (plain, packed):
                    self.assertIn("Accept-Encoding", answer.headers.get_all("Vary"))
                    self.assertNotEqual(answer.headers["ETag"], None)
                self.assertEqual(packed.headers["ETag"], "W/" + plain.headers["ETag"])
                for tag in (plain.headers["ETag"], packed.headers["ETag"]):
                    for encoding in ("identity", "gzip"):
                        again = self.service.get(path, {"If-None-Match": tag, "Accept-Encoding": encoding})
                        self.assertEqual((again.status, again.body), (304, b""))
                head = self.service.call("HEAD", path, headers={"Accept-Encoding": "gzip"})
                self.assertEqual(head.headers["Content-Length"], packed.headers["Content-Length"])
                refused = self.service.get(path, {"Accept-Encoding": "gzip;q=0"})
                self.assertIsNone(refused.headers["Content-Encoding"])

    def test_a_batch_may_come_in_chunks_and_its_results_go_out_compressed(self):
        lines = b"".join(json.dumps({"name": "r%d" % i, **QUICK}).encode() + b"\n" for i in range(50))
        connection = http.client.HTTPConnection("127.0.0.1", self.service.port, timeout=60)
        self.addCleanup(connection.close)
        connection.request("POST", "/v1/batches", (lines[k:k + 777] for k in range(0, len(lines), 777)),
                           {"Content-Type": "application/x-ndjson", "Transfer-Encoding": "chunked"},
                           encode_chunked=True)
        answer = connection.getresponse()
        batch = json.loads(answer.read())
        self.assertEqual((answer.status, batch["total"]), (202, 50))
        # On the same connection: nothing of the body remains in it.
        results = answer.headers["Location"] + "/results"
        connection.request("GET", results + "?follow=true", headers={"Accept-Encoding": "gzip"})
        answer = connection.getresponse()
        self.assertEqual(answer.headers["Content-Encoding"], "gzip")
        rows = gzip.decompress(answer.read())
        self.assertEqual([json.loads(row)["name"] for row in rows.splitlines()], ["r%d" % i for i in range(50)])
        self.assertEqual(self.service.get(results).body, rows)

    def test_a_client_that_waits_for_100_gets_it(self):
        body = json.dumps(QUICK).encode()
        connection = socket.create_connection(("127.0.0.1", self.service.port), timeout=20)
        connection.sendall(b"POST /v1/jobs HTTP/1.1\r\n" + HOST + b"Expect: 100-continue\r\nContent-Length: %d\r\n\r\n" %
                           len(body))
        self.assertEqual(connection.recv(100), b"HTTP/1.1 100 Continue\r\n\r\n")
        connection.sendall(body)
        self.assertIn(b" 202 ", connection.recv(100))
        connection.close()

    def refused(self, *parts):
        """The status of the only answer, after which the connection is closed."""
        received = self.service.raw(*parts)
        self.assertEqual(len(statuses(received)), 1, received[:300])
        self.assertIn(b"Connection: close", received)
        return statuses(received)[0]

    def test_shapes_that_two_parsers_read_differently_are_refused(self):
        post = b"POST /v1/jobs HTTP/1.1\r\n"
        smuggled = b"GET /metrics HTTP/1.1\r\n" + HOST + b"\r\n"
        cases = {
            "length and chunks": (post + HOST + b"Content-Length: 4\r\nTransfer-Encoding: chunked\r\n\r\n0\r\n\r\n" +
                                  smuggled, 400),
            "chunks": (post + HOST + b"Transfer-Encoding: chunked\r\n\r\n0\r\n\r\n" + smuggled, 411),
            "two lengths": (post + HOST + b"Content-Length: 1\r\nContent-Length: 2\r\n\r\nab", 400),
            "negative length": (post + HOST + b"Content-Length: -1\r\n\r\n" + smuggled, 400),
            "length that is no number": (post + HOST + b"Content-Length: 1e1\r\n\r\n", 400),
            "length with a plus": (post + HOST + b"Content-Length: +4\r\n\r\nabcd", 400),
            "no host": (b"GET /healthz HTTP/1.1\r\n\r\n", 400),
            "two hosts": (b"GET /healthz HTTP/1.1\r\n" + HOST + HOST + b"\r\n", 400),
            "folded line": (b"GET /healthz HTTP/1.1\r\n" + HOST + b"A: b\r\n c\r\n\r\n", 400),
            "space before the colon": (b"GET /healthz HTTP/1.1\r\n" + HOST + b"Content-Length : 4\r\n\r\n", 400),
            "bare line feeds": (b"GET /healthz HTTP/1.1\nHost: localhost\r\n\r\n", 400),
            "control character": (b"GET /healthz HTTP/1.1\r\n" + HOST + b"A: \x00\r\n\r\n", 400),
            "no version": (b"GET /healthz\r\n" + HOST + b"\r\n", 400),
            "HTTP/2.0": (b"GET /healthz HTTP/2.0\r\n" + HOST + b"\r\n", 505),
            "absolute target": (b"GET http://x/healthz HTTP/1.1\r\n" + HOST + b"\r\n", 400),
            "long target": (b"GET /" + b"a" * 9000 + b" HTTP/1.1\r\n" + HOST + b"\r\n", 414),
            "long field": (b"GET / HTTP/1.1\r\n" + HOST + b"A: " + b"b" * 9000 + b"\r\n\r\n", 431),
            "many fields": (b"GET / HTTP/1.1\r\n" + HOST + b"A: b\r\n" * 200 + b"\r\n", 431),
            "noise": (b"\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03\r\n\r\n", 400),
        }
        for name, (data, status) in cases.items():
            with self.subTest(name):
                self.assertEqual(self.refused(data), status)

    def test_a_body_sent_with_get_is_never_run_as_a_request(self):
        inner = b"GET /metrics HTTP/1.1\r\n" + HOST + b"\r\n"
        received = self.service.raw(b"GET /healthz HTTP/1.1\r\nConnection: close\r\n" + HOST +
                                    b"Content-Length: %d\r\n\r\n" % len(inner), inner)
        self.assertEqual(statuses(received), [200])

    def test_a_flood_of_headers_is_cut_off(self):
        connection = socket.create_connection(("127.0.0.1", self.service.port), timeout=20)
        sent = 0
        with self.assertRaises(OSError):
            connection.sendall(b"GET /healthz HTTP/1.1\r\n" + HOST)
            while sent < 40_000_000:
                connection.sendall(b"X-A: " + b"y" * 4000 + b"\r\n")
                sent += 4007
        connection.close()

    def test_idle_and_slow_clients_do_not_keep_others_waiting(self):
        port = self.service.port
        idle = [socket.create_connection(("127.0.0.1", port), timeout=20) for _ in range(300)]
        slow = [socket.create_connection(("127.0.0.1", port), timeout=20) for _ in range(60)]
        for connection in slow:
            connection.sendall(b"POST /v1/jobs HTTP/1.1\r\nContent-Le")
        answers = []

        def normal():
            for _ in range(20):
                answers.append(self.service.post("/v1/jobs", QUICK, {"Prefer": "wait=30"}).status)

        client = threading.Thread(target=normal)
        client.start()
        client.join(60)
        self.assertEqual(answers, [200] * 20)
        for connection in idle + slow:
            connection.close()

    def test_a_request_that_never_ends_is_408(self):
        start = time.monotonic()
        received = self.service.raw(b"GET /healthz HTTP/1.1\r\nHos", patience=30)
        self.assertIn(b" 408 ", received[:20])
        self.assertGreater(time.monotonic() - start, 5)


if __name__ == "__main__":
    unittest.main()
