"""Notifications of the end of a job or a batch: once, signed, and repeated after a failed delivery."""

import json
import os
import re
import shutil
import ssl
import subprocess
import tempfile
import time
import unittest

from receiver import Receiver, signature
from service import BINARY, FOPDT, LONG, QUICK, Service

RECORD = {"t": list(range(40)), "u": [0] * 5 + [1] * 35, "y": [0] * 8 + [2 - 2 * 0.9 ** i for i in range(32)]}


def make_secret(name, path):
    made = subprocess.run([BINARY, "secret", name, "--file", path], capture_output=True, text=True, check=True)
    return made.stdout.strip()


class WebhookTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="tunewright-webhook-")
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        self.path = os.path.join(folder.name, "secrets")
        self.secret = make_secret("first", self.path)

    def receiver(self, *arguments, **named):
        made = Receiver(*arguments, **named)
        self.addCleanup(made.__exit__)
        return made

    def service(self, *targets, **named):
        options = [part for target in targets for part in ("--notify-target", target)]
        made = Service("--workers", "1", "--notify-secrets", self.path, *options, **named)
        self.addCleanup(made.__exit__)
        return made

    def wait_for_log(self, service, text, patience=30):
        end = time.monotonic() + patience
        while text not in service.read_log():
            self.assertLess(time.monotonic(), end, "%r is not in the log: %s" % (text, service.read_log()[-2000:]))
            time.sleep(0.05)

    def metric(self, service, outcome):
        line = 'tunewright_notify_deliveries_total{outcome="%s"} ' % outcome
        return next(float(one[len(line):]) for one in service.get("/metrics").body.decode().splitlines()
                    if one.startswith(line))

    def told(self, receiver, url="/in", **more):
        return dict(QUICK, notify={"url": receiver.origin + url}, **more)


class ToldTest(WebhookTest):
    def test_the_trace_of_the_call_goes_on_in_the_note(self):
        trace, span = "4bf92f3577b34da6a3ce929d0e0e4736", "00f067aa0ba902b7"
        receiver = self.receiver()
        service = self.service(receiver.origin)
        service.post("/v1/jobs", self.told(receiver), {"traceparent": "00-%s-%s-01" % (trace, span)})
        receiver.note()
        service.call("POST", "/v1/batches?notify_url=" + receiver.origin + "/in", json.dumps({"plant": FOPDT}),
                     {"Content-Type": "application/x-ndjson", "traceparent": "00-%s-%s-01" % (trace, span)})
        receiver.wait_for(2)
        spans = [re.fullmatch("00-%s-([0-9a-f]{16})-01" % trace, note[2]["traceparent"])[1] for note in receiver.notes]
        self.assertEqual(len({span, *spans}), 3, "each note is a span of its own")

    def test_a_job_that_succeeded_is_told_once_with_a_valid_signature(self):
        receiver = self.receiver()
        service = self.service(receiver.origin)
        request = self.told(receiver, "/in?token=s3cret", evaluate={"points": 100})
        job = service.wait_for(service.post_job(request)["id"])
        note = receiver.note()
        _, path, headers, body = receiver.notes[0]
        self.assertEqual(path, "/in?token=s3cret")
        self.assertEqual(headers["Content-Type"], "application/json")
        self.assertEqual(headers["webhook-signature"], signature(self.secret, headers, body))
        self.assertRegex(headers["webhook-id"], "^evt_%s_[0-9]+$" % job["id"])
        self.assertLess(abs(int(headers["webhook-timestamp"]) - time.time()), 10)
        self.assertEqual((note["type"], note["timestamp"]), ("job.ended", job["finished_at"]))
        # As returned by GET, without the traces.
        for controller in job["result"]["controllers"]:
            self.assertTrue(controller.pop("responses") and controller.pop("frequency"))
        self.assertEqual(note["data"], job)
        self.assertIn("was reported to " + receiver.origin, service.read_log())
        self.assertNotIn("s3cret", service.read_log())
        self.assertEqual(self.metric(service, "delivered"), 1)

    def test_a_note_carries_no_record(self):
        receiver = self.receiver()
        service = self.service(receiver.origin)
        job = service.wait_for(service.post_job({"record": RECORD, "notify": {"url": receiver.origin}})["id"])
        self.assertIn("record", job["request"])
        data = receiver.note()["data"]
        self.assertEqual((data["status"], data["id"]), (job["status"], job["id"]))
        self.assertNotIn("record", data["request"])

    def test_jobs_that_failed_or_were_cancelled_are_told_too(self):
        receiver = self.receiver()
        service = self.service(receiver.origin)
        notify = {"notify": {"url": receiver.origin + "/x"}}
        running = service.post_job({**LONG, **notify})["id"]
        service.wait_for(running, ("running",))
        waiting = service.post_job({**QUICK, **notify})["id"]
        for job in (waiting, running):
            service.post("/v1/jobs/%s/cancel" % job, "")
        failed = service.post_job({**LONG, **notify, "timeout_s": 0.2})["id"]
        seen = {note["data"]["id"]: note["data"] for note in
                (json.loads(one[3]) for one in receiver.wait_for(3))}
        self.assertEqual({seen[job]["status"] for job in (running, waiting)}, {"cancelled"})
        self.assertEqual(seen[failed]["error"]["type"], "timeout")

    def test_another_secret_signs_where_it_is_named_and_two_of_one_name_both_sign(self):
        other = make_secret("other", self.path)
        newer = make_secret("other", self.path)
        receiver = self.receiver()
        service = self.service(receiver.origin)
        service.post_job(dict(QUICK, notify={"url": receiver.origin, "secret_id": "other"}))
        _, _, headers, body = receiver.wait_for(1)[0]
        self.assertEqual(headers["webhook-signature"],
                         " ".join(signature(secret, headers, body) for secret in (other, newer)))

    def test_a_batch_is_told_as_a_whole(self):
        receiver = self.receiver()
        service = self.service(receiver.origin)
        url = receiver.origin + "/batch"
        jobs = '"jobs": [%s]' % ", ".join([json.dumps(QUICK), '{"plant": 1}', json.dumps(QUICK)])
        notify = '"notify": %s' % json.dumps({"url": url})
        loops = "name,K,T,L\na,1,2,3\nb,2,3,4\n"
        ways = [("{%s, %s}" % (notify, jobs), "application/json", ""), ("{%s, %s}" % (jobs, notify), "application/json", ""),
                ("{%s, %s}" % (jobs, notify), "", ""), (loops, "text/csv", "?method=simc&notify_url=" + url),
                (json.dumps(QUICK) + "\n", "application/x-ndjson", "?notify_url=%s&notify_secret_id=first" % url)]
        for count, (body, media, query) in enumerate(ways, 1):
            answer = service.post("/v1/batches" + query, body, {"Content-Type": media} if media else {
                "Content-Type": "application/x-www-form-urlencoded"})
            self.assertEqual(answer.status, 202, answer.body)
            receiver.wait_for(count)
            _, path, headers, body = receiver.notes[-1]
            note = json.loads(body)
            self.assertEqual((path, note["type"], note["data"]["id"]), ("/batch", "batch.ended", answer.json["id"]))
            self.assertEqual(note["data"], service.get("/v1/batches/" + answer.json["id"]).json)
            self.assertEqual(note["timestamp"], note["data"]["finished_at"])
            self.assertEqual(headers["webhook-signature"], signature(self.secret, headers, body))
        time.sleep(1.5)
        self.assertEqual(len(receiver.notes), len(ways))
        self.assertIn("notify_url=...", service.read_log())
        self.assertNotIn("notify_url=http", service.read_log())

    def test_no_value_of_a_query_is_in_the_log(self):
        service = self.service("http://127.0.0.1:9")
        for query in ("notify%5Furl=http://h/SECRET", "notify_url=x&notify_url=http://h/SECRET", "notify_url%3Dhttp://h/SECRET",
                      "notify_url=http://h/x%3Fa=1&token=SECRET&SECRET", "Notify_url=SECRET", "x&SECRET=http://h/", "&&SECRET"):
            service.post("/v1/batches?" + query.replace("SECRET=", "SEC%52ET="), "{}")
        log = service.read_log()
        self.assertNotIn("SECRET", log)
        self.assertNotIn("SEC%52ET", log)
        self.assertIn("/v1/batches?notify_url=...&token=...&... ", log.replace('"', " "))

    def test_a_low_priority_job_comes_after_normal_ones(self):
        receiver = self.receiver()
        service = self.service(receiver.origin)
        running = service.post_job(LONG)["id"]
        service.wait_for(running, ("running",))
        low = service.post_job(self.told(receiver, name="low", priority="low"))["id"]
        normal = service.post_job(self.told(receiver, name="normal"))["id"]
        service.post("/v1/jobs/%s/cancel" % running, "")
        self.assertLessEqual(service.wait_for(normal)["started_at"], service.wait_for(low)["started_at"])
        receiver.wait_for(2)


class AgainTest(WebhookTest):
    def test_a_receiver_that_fails_first_is_tried_again_with_the_same_id(self):
        receiver = self.receiver([500])
        service = self.service(receiver.origin)
        service.post_job(self.told(receiver))
        (first, _, one, body), (second, _, two, again) = receiver.wait_for(2)
        self.assertGreater(second - first, 4.4)
        self.assertLess(second - first, 9)
        self.assertEqual((one["webhook-id"], body), (two["webhook-id"], again))
        self.assertEqual(two["webhook-signature"], signature(self.secret, two, again))
        self.assertLess(int(one["webhook-timestamp"]), int(two["webhook-timestamp"]))
        self.wait_for_log(service, "attempt 2")
        self.assertIn("it answers 500; the next attempt is in", service.read_log())
        self.assertEqual((self.metric(service, "failed"), self.metric(service, "delivered")), (1, 1))

    def test_retry_after_is_respected(self):
        receiver = self.receiver([(503, {"Retry-After": "8"})])
        service = self.service(receiver.origin)
        service.post_job(self.told(receiver))
        first, second = (note[0] for note in receiver.wait_for(2))
        self.assertGreater(second - first, 7.5)

    def test_redirects_are_not_followed(self):
        elsewhere = self.receiver()
        receiver = self.receiver([(307, {"Location": elsewhere.origin + "/x"})])
        service = self.service(receiver.origin, elsewhere.origin)
        service.post_job(self.told(receiver))
        receiver.wait_for(2)
        self.assertEqual(elsewhere.notes, [])
        self.assertIn("it answers 307, and redirects are not followed", service.read_log())

    def test_a_receiver_that_is_gone_is_given_up(self):
        receiver = self.receiver([410])
        service = self.service(receiver.origin)
        service.post_job(self.told(receiver, "/in?token=s3cret"))
        self.wait_for_log(service, "will not be reported to %s any more" % receiver.origin)
        time.sleep(7)
        self.assertEqual(len(receiver.notes), 1)
        self.assertEqual(self.metric(service, "given_up"), 1)
        self.assertNotIn("s3cret", service.read_log())

    def test_a_service_that_was_killed_tells_after_its_restart(self):
        receiver = self.receiver()
        port = receiver.server.server_address[1]
        receiver.__exit__()
        service = self.service(receiver.origin)
        job = service.wait_for(service.post_job(self.told(receiver))["id"])
        self.wait_for_log(service, "it cannot be reached; the next attempt is in")
        service.kill()
        back = self.receiver(port=port)
        service.start()
        self.assertEqual(back.note()["data"]["id"], job["id"])

    def test_a_target_that_is_no_longer_allowed_is_given_up(self):
        receiver = self.receiver([500])
        service = self.service(receiver.origin)
        service.wait_for(service.post_job(self.told(receiver))["id"])
        self.wait_for_log(service, "the next attempt is in")
        service.stop()
        service.arguments = service.arguments[:-1] + ("http://127.0.0.1:1",)
        service.start()
        self.wait_for_log(service, "has not allowed it")
        self.assertEqual(len(receiver.notes), 1)

    def test_a_job_that_was_deleted_is_given_up_quietly(self):
        receiver = self.receiver([500])
        service = self.service(receiver.origin)
        job = service.wait_for(service.post_job(self.told(receiver))["id"])["id"]
        self.wait_for_log(service, "the next attempt is in")
        self.assertEqual(service.call("DELETE", "/v1/jobs/" + job).status, 204)
        time.sleep(8)
        self.assertEqual(len(receiver.notes), 1)
        self.assertEqual(self.metric(service, "given_up"), 0)
        self.assertNotIn("will not be reported", service.read_log())

    def test_a_slow_receiver_holds_up_no_other_and_no_stop(self):
        slow, quick = self.receiver(), self.receiver()
        slow.hold.clear()
        service = self.service(slow.origin, quick.origin)
        for _ in range(12):
            service.post_job(self.told(slow))
        slow.wait_for(2)
        begun = time.monotonic()
        service.post_job(self.told(quick))
        quick.wait_for(1)
        self.assertLess(time.monotonic() - begun, 5)
        self.assertEqual(len(slow.notes), 2)
        begun = time.monotonic()
        self.assertEqual(service.stop(), 0)
        self.assertLess(time.monotonic() - begun, 8)


class RefusedTest(WebhookTest):
    def errors(self, answer):
        self.assertEqual(answer.status, 422, answer.body)
        return {error["pointer"]: error["detail"] for error in answer.json["errors"]}

    def test_what_the_operator_has_not_allowed(self):
        service = self.service("https://hooks.example.com/in")
        for url in ("https://evil.example/in", "http://hooks.example.com/in", "https://hooks.example.com/in/../x",
                    "https://hooks.example.com@evil.example/in", "https://hooks.example.com.evil.example/in", "x", ""):
            errors = self.errors(service.post("/v1/jobs", dict(QUICK, notify={"url": url})))
            self.assertIn("notify.url is", errors["/notify/url"])
        self.assertIn("--notify-target https://evil.example", self.errors(
            service.post("/v1/jobs", dict(QUICK, notify={"url": "https://evil.example/in"})))["/notify/url"])
        unknown = {"url": "https://hooks.example.com/in", "secret_id": "third"}
        self.assertIn("third", self.errors(service.post("/v1/jobs", dict(QUICK, notify=unknown)))["/notify/secret_id"])
        self.assertEqual(service.get("/v1/jobs").json["jobs"], [])
        for batch in ({"notify": unknown, "jobs": [QUICK]}, {"jobs": [QUICK], "notify": unknown}):
            self.assertIn("/notify/secret_id", self.errors(service.post("/v1/batches", batch)))
        loops = "name,K,T,L\na,1,2,3\n"
        csv = {"Content-Type": "text/csv"}
        self.assertIn("notify_url is", self.errors(
            service.post("/v1/batches?notify_url=https://evil.example", loops, csv))["/notify_url"])
        self.assertIn("missing", self.errors(
            service.post("/v1/batches?notify_secret_id=first", loops, csv))["/notify_secret_id"])
        self.assertEqual(service.get("/v1/batches").json["batches"], [])

    def test_nothing_without_targets_or_without_secrets(self):
        service = Service("--workers", "1")
        self.addCleanup(service.__exit__)
        errors = self.errors(service.post("/v1/jobs", dict(QUICK, notify={"url": "https://hooks.example.com"})))
        self.assertIn("--notify-target", errors["/notify/url"])
        service = Service("--workers", "1", "--notify-target", "https://hooks.example.com")
        self.addCleanup(service.__exit__)
        errors = self.errors(service.post("/v1/jobs", dict(QUICK, notify={"url": "https://hooks.example.com"})))
        self.assertIn("--notify-secrets", errors["/notify/url"])

    def test_entries_that_want_to_be_told_themselves(self):
        receiver = self.receiver()
        service = self.service(receiver.origin)
        batch = service.post("/v1/batches", {"jobs": [self.told(receiver), QUICK]}).json["id"]
        rows = [json.loads(row) for row in
                service.get("/v1/batches/%s/results?follow=true" % batch).body.splitlines()]
        self.assertEqual([row["status"] for row in rows], ["failed", "succeeded"])
        self.assertIn("has one notification as a whole", rows[0]["error"]["detail"])

    def test_calls_that_are_answered_at_once_do_not_know_it(self):
        service = self.service("https://hooks.example.com")
        answer = service.post("/v1/design", {"plant": FOPDT, "tune": [{"method": "simc"}],
                                             "notify": {"url": "https://hooks.example.com"}})
        self.assertIn("/notify", self.errors(answer))

    def test_options_that_cannot_be_used_end_the_start(self):
        for options, word in ((["--notify-target", "hooks.example.com"], "https://hooks.example.com/path"),
                              (["--notify-secrets", self.path + ".none"], "cannot be read")):
            done = subprocess.run([BINARY, "serve", "--listen", "127.0.0.1:0", "--store",
                                   "sqlite:" + self.folder + "/jobs.db", *options], capture_output=True, text=True)
            self.assertEqual(done.returncode, 2)
            self.assertIn(word, done.stderr)
        self.assertEqual(os.stat(self.path).st_mode & 0o777, 0o600)
        self.assertEqual(subprocess.run([BINARY, "secret", "a b"], capture_output=True).returncode, 2)


@unittest.skipUnless(shutil.which("openssl"), "openssl is not installed: run script/bootstrap test")
class TlsTest(WebhookTest):
    def test_only_a_receiver_with_a_trusted_certificate_is_told(self):
        key, certificate = self.folder + "/key.pem", self.folder + "/certificate.pem"
        subprocess.run(["openssl", "req", "-x509", "-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:prime256v1", "-nodes",
                        "-days", "2", "-subj", "/CN=receiver", "-addext", "subjectAltName=IP:127.0.0.1", "-keyout", key,
                        "-out", certificate], check=True, capture_output=True)
        context = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
        context.load_cert_chain(certificate, key)
        receiver = self.receiver(tls=context)
        strict = self.service(receiver.origin)
        strict.post_job(self.told(receiver))
        self.wait_for_log(strict, "this machine does not trust its certificate")
        self.assertEqual(receiver.notes, [])
        trusting = self.service(receiver.origin, environment={"SSL_CERT_FILE": certificate})
        job = trusting.post_job(self.told(receiver))["id"]
        self.assertEqual(receiver.note()["data"]["id"], job)


if __name__ == "__main__":
    unittest.main()
