"""Calls to the service that computes the bounds: one that runs, or one that is started for the purpose."""

import contextlib
import http.client
import json
import os
import pathlib
import sys
import time
import urllib.parse

ROOT = pathlib.Path(__file__).resolve().parents[2]

LONGEST_CALL_S = 900  # the file of a proof with thousands of boxes, on a busy machine


class Calls:
    def __init__(self, address):
        self.host = urllib.parse.urlsplit(address).netloc

    def send(self, verb, path, body=None, headers=None):
        """Status and bytes of the answer."""
        connection = http.client.HTTPConnection(self.host, timeout=LONGEST_CALL_S)
        try:
            connection.request(verb, path, None if body is None else json.dumps(body),
                               {"Content-Type": "application/json", **(headers or {})})
            response = connection.getresponse()
            return response.status, response.read()
        finally:
            connection.close()

    def call(self, verb, path, body=None, headers=None):
        status, text = self.send(verb, path, body, headers)
        return status, json.loads(text)

    def ask(self, path, body):
        status, answer = self.call("POST", path, body)
        if status != 200:
            raise ValueError(answer.get("detail", str(status)))
        return answer

    def certificate(self, job):
        """The file of the proof of a job's first controller."""
        status, text = self.send("GET", f"/v1/jobs/{job}/controllers/0/certificate")
        if status != 200:
            raise ValueError(json.loads(text).get("detail", str(status)))
        return text

    def job(self, request):
        """A job that has ended: its id and its result."""
        status, job = self.call("POST", "/v1/jobs", request, {"Prefer": "wait=60"})
        if status >= 400:
            raise ValueError(job.get("detail", str(status)))
        while job["status"] in ("queued", "running"):
            time.sleep(0.2)
            _, job = self.call("GET", "/v1/jobs/" + job["id"])
        if job["status"] != "succeeded":
            raise ValueError((job.get("error") or {}).get("detail", job["status"]))
        return job["id"], job["result"]


@contextlib.contextmanager
def calls(address=None):
    """`address`: a running service. Without it one is started: build/release/tunewright, or TUNEWRIGHT_BIN."""
    if address:
        yield Calls(address)
        return
    os.environ.setdefault("TUNEWRIGHT_BIN", str(ROOT / "build" / "release" / "tunewright"))
    sys.path.insert(0, str(ROOT / "tests" / "server"))
    from service import Service
    with Service() as service:
        yield Calls(f"http://127.0.0.1:{service.port}")
