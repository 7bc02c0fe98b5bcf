"""Starts the real service on a free port for a test, and calls it."""

import http.client
import json
import os
import pathlib
import signal
import socket
import subprocess
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
BINARY = os.environ.get("TUNEWRIGHT_BIN", str(ROOT / "build" / "release" / "tunewright"))

FOPDT = {"type": "fopdt", "K": 2, "T": 10, "L": 3}
QUICK = {"plant": FOPDT, "tune": [{"method": "simc"}], "evaluate": {"points": 0}}
# Grid searches over an oscillatory plant of high order: more than half a minute of work, so that it can be interrupted.
LONG = {
    "name": "long",
    "plant": {"type": "zpk", "zeros": [], "K": 7, "L": 0.5,
              "poles": [[-0.02, 1], [-0.02, -1], [-0.03, 1.7], [-0.03, -1.7], -0.5, -1.5, -1.4, -1.3]},
    "tune": [{"method": "robust", "search": "grid", "surface": True, "Ms": 1.2 + 0.02 * i} for i in range(50)],
    "timeout_s": 600,
}


class Answer:
    def __init__(self, response):
        self.status = response.status
        self.headers = response.headers
        self.body = response.read()

    @property
    def json(self):
        return json.loads(self.body)

    @property
    def media_type(self):
        return (self.headers.get("Content-Type") or "").split(";")[0]


class Service:
    """One running process. A given store, as a path or as for --store, outlives it and may be shared by several;
    otherwise each service has an SQLite file of its own."""

    def __init__(self, *arguments, store=None, environment=None):
        self.folder = tempfile.TemporaryDirectory(prefix="tunewright-test-")
        self.store = store or os.path.join(self.folder.name, "jobs.db")
        if not self.store.startswith(("sqlite:", "postgresql:")):
            self.store = "sqlite:" + self.store
        self.arguments = arguments
        self.environment = environment or {}
        self.process = None
        self.start()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.stop()
        self.folder.cleanup()

    def start(self):
        self.log = open(os.path.join(self.folder.name, "log"), "ab")
        self.process = subprocess.Popen(self.command(), stdout=subprocess.PIPE, stderr=self.log,
                                        env={**os.environ, **self.environment})
        self.ready_line = self.process.stdout.readline().decode()
        if " is ready at http://127.0.0.1:" not in self.ready_line:
            raise AssertionError("no ready line but %r; log: %s" % (self.ready_line, self.read_log()))
        self.port = int(self.ready_line.rsplit(":", 1)[1].strip().rstrip("/"))

    def command(self):
        return [BINARY, "serve", "--listen", "127.0.0.1:0", "--store", self.store, *self.arguments]

    def read_log(self):
        """The log of the service, which collects lines for some milliseconds before it writes them."""
        time.sleep(0.05)
        with open(os.path.join(self.folder.name, "log"), errors="replace") as log:
            return log.read()

    def kill(self):
        self.process.kill()
        self.process.wait()
        self.process.stdout.close()

    def stop(self, patience=30):
        if self.process.poll() is None:
            self.process.send_signal(signal.SIGTERM)
        code = self.process.wait(patience)
        self.process.stdout.close()
        self.log.close()
        return code

    def call(self, method, path, body=None, headers=None, timeout=60):
        """One call on a connection of its own. A body that is not text or bytes is sent as JSON."""
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=timeout)
        try:
            headers = dict(headers or {})
            if body is not None and not isinstance(body, (bytes, str)):
                body = json.dumps(body)
            if body is not None:
                headers.setdefault("Content-Type", "application/json")
            connection.request(method, path, body, headers)
            return Answer(connection.getresponse())
        finally:
            connection.close()

    def get(self, path, headers=None):
        return self.call("GET", path, headers=headers)

    def post(self, path, body, headers=None):
        return self.call("POST", path, body, headers)

    def post_job(self, request, wait=None):
        """The job as in the service's first answer."""
        answer = self.post("/v1/jobs", request, {"Prefer": "wait=%d" % wait} if wait else None)
        if answer.status not in (200, 202):
            raise AssertionError("%d %s" % (answer.status, answer.body[:300]))
        return answer.json

    def job(self, job_id):
        answer = self.get("/v1/jobs/" + job_id)
        if answer.status != 200:
            raise AssertionError("%d %s" % (answer.status, answer.body[:300]))
        return answer.json

    def wait_for(self, job_id, states=("succeeded", "failed", "cancelled"), patience=60):
        end = time.monotonic() + patience
        while True:
            job = self.job(job_id)
            if job["status"] in states:
                return job
            if time.monotonic() > end:
                raise AssertionError("job is still %s" % job["status"])
            time.sleep(0.01)

    def wait_for_any(self, status, patience=60):
        """The first job with that status in a list."""
        end = time.monotonic() + patience
        while not (jobs := self.get("/v1/jobs?status=" + status).json["jobs"]):
            if time.monotonic() > end:
                raise AssertionError("no job is " + status)
            time.sleep(0.01)
        return jobs[0]

    def raw(self, *parts, patience=20):
        """Sends the parts one after the other and reads until the service closes or `patience` is over."""
        connection = socket.create_connection(("127.0.0.1", self.port), timeout=patience)
        received = b""
        try:
            for part in parts:
                connection.sendall(part)
                if len(parts) > 1:
                    time.sleep(0.02)
            while chunk := connection.recv(65536):
                received += chunk
        except (ConnectionError, socket.timeout):
            pass
        finally:
            connection.close()
        return received
