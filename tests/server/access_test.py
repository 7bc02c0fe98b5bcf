"""Access: keys, owners of jobs, rates, other sites, and the requirements of an address beyond loopback."""

import http.client
import json
import os
import re
import socket
import subprocess
import tempfile
import time
import unittest

from service import BINARY, LONG, QUICK, Service


def make_key(name, path):
    return subprocess.run([BINARY, "key", name, "--keys", path], check=True, capture_output=True,
                          text=True).stdout.strip()


def bearer(key, **more):
    return {"Authorization": "Bearer " + key, **more}


class KeysTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="tunewright-keys-")
        self.addCleanup(folder.cleanup)
        self.path = os.path.join(folder.name, "keys")
        self.ann = make_key("ann", self.path)
        self.bob = make_key("bob", self.path)

    def serve(self, *arguments):
        service = Service("--auth", "keys", "--keys", self.path, *arguments)
        self.addCleanup(service.__exit__)
        return service

    def test_metrics_have_a_port_of_their_own_where_one_is_given(self):
        with socket.socket() as probe:
            probe.bind(("127.0.0.1", 0))
            port = probe.getsockname()[1]
        with self.serve("--metrics-listen", "127.0.0.1:%d" % port) as service:
            self.assertEqual(service.get("/metrics").status, 401)
            for path, expected in (("/metrics", 200), ("/healthz", 200), ("/readyz", 200), ("/v1/jobs", 404)):
                connection = http.client.HTTPConnection("127.0.0.1", port, timeout=20)
                # Like Prometheus: by an address that the service does not know.
                connection.request("GET", path, headers={"Host": "10.1.2.3:9090"})
                self.assertEqual(connection.getresponse().status, expected, path)
                connection.close()

    def test_the_file_has_digests_only_and_belongs_to_its_owner(self):
        text = open(self.path).read()
        self.assertNotIn(self.ann, text)
        self.assertEqual(len(text.splitlines()), 2)
        self.assertEqual(os.stat(self.path).st_mode & 0o077, 0)

    def test_what_goes_to_standard_error_is_a_file_of_keys(self):
        made = subprocess.run([BINARY, "key", "eve"], check=True, capture_output=True, text=True)
        with open(self.path, "w") as file:
            file.write(made.stderr)
        self.assertEqual(self.serve().get("/v1/jobs", bearer(made.stdout.strip())).status, 200)

    def test_without_a_key_nothing_below_v1_is_answered(self):
        service = self.serve()
        for method, path in (("GET", "/v1/jobs"), ("POST", "/v1/jobs"), ("POST", "/v1/evaluate"), ("GET", "/metrics"),
                             ("POST", "/v1/batches"), ("GET", "/v1/jobs/x/events"), ("GET", "/v1/nothing")):
            answer = service.call(method, path, "" if method == "POST" else None)
            self.assertEqual(answer.status, 401, path)
            self.assertEqual(answer.media_type, "application/problem+json")
            self.assertIn("Bearer", answer.headers["WWW-Authenticate"])
        for path in ("/", "/healthz", "/readyz", "/openapi.json"):
            self.assertEqual(service.get(path).status, 200, path)

    def test_each_name_sees_its_own_jobs_alone(self):
        service = self.serve()
        posted = service.post("/v1/jobs", QUICK, bearer(self.ann, Prefer="wait=30"))
        self.assertEqual(posted.status, 200)
        path = "/v1/jobs/" + posted.json["id"]
        self.assertEqual(service.get(path, bearer(self.ann)).status, 200)
        for method, below in (("GET", ""), ("DELETE", ""), ("POST", "/cancel"), ("GET", "/events"),
                              ("GET", "/result.csv")):
            self.assertEqual(service.call(method, path + below, headers=bearer(self.bob)).status, 404, below)
        self.assertEqual(len(service.get("/v1/jobs", bearer(self.ann)).json["jobs"]), 1)
        self.assertEqual(service.get("/v1/jobs", bearer(self.bob)).json["jobs"], [])

    def test_an_idempotency_key_is_its_owners(self):
        service = self.serve()
        first = service.post("/v1/jobs", QUICK, bearer(self.ann, **{"Idempotency-Key": "k"})).json["id"]
        again = service.post("/v1/jobs", QUICK, bearer(self.ann, **{"Idempotency-Key": "k"})).json["id"]
        other = service.post("/v1/jobs", QUICK, bearer(self.bob, **{"Idempotency-Key": "k"})).json["id"]
        self.assertEqual(first, again)
        self.assertNotEqual(first, other)

    def test_a_key_that_is_added_later_works_without_a_restart(self):
        service = self.serve()
        eve = make_key("eve", self.path)
        for _ in range(100):
            if service.get("/v1/jobs", bearer(eve)).status == 200:
                break
            time.sleep(0.1)
        self.assertEqual(service.get("/v1/jobs", bearer(eve)).status, 200)
        self.assertEqual(service.get("/v1/jobs", bearer(self.ann)).status, 200)

    def test_a_comment_may_stand_behind_a_key(self):
        with open(self.path) as file:
            lines = file.read().splitlines()
        with open(self.path, "w") as file:
            file.write("# keys of the plant\n%s  # shift A\n%s admin # who runs it\n" % tuple(lines))
        service = self.serve()
        self.assertEqual(service.get("/v1/jobs", bearer(self.ann)).status, 200)
        self.assertEqual(service.get("/v1/queue", bearer(self.bob)).status, 200)

    def test_streams_end_soon_after_their_key_is_deleted(self):
        service = self.serve("--workers", "1")
        job = service.post("/v1/jobs", LONG, bearer(self.ann)).json["id"]
        batch = service.post("/v1/batches", {"jobs": [LONG]}, bearer(self.ann)).json["id"]
        streams = []
        for path in ("/v1/jobs/%s/events" % job, "/v1/batches/%s/results?follow=true" % batch):
            connection = http.client.HTTPConnection("127.0.0.1", service.port, timeout=30)
            self.addCleanup(connection.close)
            connection.request("GET", path, headers=bearer(self.ann))
            streams.append(connection.getresponse())
        with open(self.path) as file:
            rest = [line for line in file.read().splitlines(True) if not line.startswith("ann ")]
        with open(self.path, "w") as file:
            file.writelines(rest)
        self.assertNotIn(b"event: done", streams[0].read())
        with self.assertRaises(http.client.IncompleteRead):
            streams[1].read()

    def test_a_key_never_appears_in_the_log(self):
        service = self.serve("--log-level", "debug")
        service.get("/v1/jobs", bearer(self.ann))
        service.get("/v1/jobs", bearer("wrong-" + self.ann))
        service.stop()
        log = service.read_log()
        self.assertIn("/v1/jobs", log)
        self.assertNotIn(self.ann, log)


class PortTest(unittest.TestCase):
    def test_beyond_loopback_the_service_wants_keys_or_to_be_told(self):
        for listen in ("0.0.0.0:0", ":0", "[::]:0"):
            ended = subprocess.run([BINARY, "serve", "--listen", listen, "--store", "sqlite:/nonexistent/x.db"],
                                   capture_output=True, text=True, timeout=30)
            self.assertEqual(ended.returncode, 2, listen)
            self.assertIn("--auth keys", ended.stderr)
            self.assertIn("--allow-anonymous", ended.stderr)

    def test_calls_beyond_the_rate_are_told_when_to_come_back(self):
        with Service("--rate-limit", "2") as service:
            answers = [service.get("/v1/methods") for _ in range(12)]
            refused = [answer for answer in answers if answer.status == 429]
            self.assertTrue(refused)
            self.assertEqual(answers[0].status, 200)
            self.assertGreaterEqual(int(refused[0].headers["Retry-After"]), 1)
            self.assertEqual(refused[0].json["type"], "rate-limit")
            self.assertEqual(service.get("/healthz").status, 200)

    def test_other_sites_are_kept_out_unless_they_are_named(self):
        with Service() as service:
            answer = service.get("/v1/methods", {"Origin": "https://a.example"})
            self.assertEqual(answer.status, 403)
            self.assertIsNone(answer.headers["Access-Control-Allow-Origin"])
        with Service("--cors-origin", "https://a.example") as service:
            answer = service.get("/v1/methods", {"Origin": "https://a.example"})
            self.assertEqual(answer.headers["Access-Control-Allow-Origin"], "https://a.example")
            preflight = service.call("OPTIONS", "/v1/jobs", headers={
                "Origin": "https://a.example", "Access-Control-Request-Method": "POST"})
            self.assertEqual(preflight.status, 204)
            self.assertIn("POST", preflight.headers["Access-Control-Allow-Methods"])

    def test_a_rebound_name_reads_and_posts_nothing(self):
        body = json.dumps({"plant": {"type": "fopdt", "K": 1, "T": 1, "L": 1}, "tune": "simc"}).encode()
        form = {"Content-Type": "application/x-www-form-urlencoded"}
        with Service() as service:
            evil = {"Host": "evil.example:%d" % service.port}
            same = {**evil, "Origin": "http://evil.example:%d" % service.port}
            for headers in (evil, same):
                for method, path in (("GET", "/v1/jobs"), ("GET", "/"), ("POST", "/v1/jobs"), ("OPTIONS", "/v1/jobs")):
                    answer = service.call(method, path, body=body if method == "POST" else None,
                                          headers={**headers, **form})
                    self.assertEqual(answer.status, 421, (method, path, headers))
            self.assertEqual(service.get("/healthz", evil).status, 200)
            own = "localhost:%d" % service.port
            self.assertEqual(service.get("/v1/jobs", {"Host": own, "Origin": "http://" + own}).status, 200)
            for origin in ("http://evil.example", "null", "http://localhost:1"):
                for method in ("GET", "POST", "DELETE"):
                    answer = service.call(method, "/v1/jobs", headers={"Host": own, "Origin": origin})
                    self.assertEqual(answer.status, 403, (method, origin))
        with Service("--allowed-host", "Plant.example") as service:
            for host in ("plant.example", "plant.example:8443"):
                self.assertEqual(service.get("/v1/jobs", {"Host": host, "Origin": "https://" + host}).status, 200)

    def test_a_header_is_sent_back_as_it_came_or_not_at_all(self):
        with Service("--cors-origin", "*") as service:
            self.assertNotEqual(service.get("/v1/methods", {"X-Request-Id": "abc%2Ddef"}).headers["X-Request-Id"], "abc-def")
            answer = service.get("/v1/methods", {"Origin": "http://x%0d%0aSet-Cookie:a=b"})
            self.assertIsNone(answer.headers["Set-Cookie"])
            self.assertEqual(answer.headers["Access-Control-Allow-Origin"], "http://x%0d%0aSet-Cookie:a=b")

    def test_answers_and_log_name_the_request(self):
        with Service("--log-format", "json") as service:
            answer = service.get("/v1/methods", {"X-Request-Id": "trace-42"})
            self.assertEqual(answer.headers["X-Request-Id"], "trace-42")
            own = service.get("/v1/nothing").headers["X-Request-Id"]
            self.assertRegex(own, re.compile(r"^[0-9a-f]+-[0-9a-f]+$"))
            service.stop()
            self.assertIn('"id":"trace-42"', service.read_log())
            self.assertIn('"id":"%s"' % own, service.read_log())


if __name__ == "__main__":
    unittest.main()
