"""Stores that can be broken, and a load that tolerates it."""

import http.client
import json
import os
import socket
import sqlite3
import subprocess
import tempfile
import threading
import time
import uuid

from postgres import Cluster
from service import Service

ENDED = ("succeeded", "failed", "cancelled")


class SqliteFile:
    """A file that is checked for damage at the end."""

    def __enter__(self):
        self.folder = tempfile.TemporaryDirectory(prefix="tunewright-test-")
        self.path = os.path.join(self.folder.name, "jobs.db")
        self.store = "sqlite:" + self.path
        return self

    def __exit__(self, kind, *_):
        try:
            if kind is None:
                assert_intact(self.path)
        finally:
            self.folder.cleanup()


def assert_intact(path):
    connection = sqlite3.connect(path)
    found = connection.execute("PRAGMA integrity_check").fetchall()
    connection.close()
    if found != [("ok",)]:
        raise AssertionError("the file is damaged: %r" % found[:5])


class OwnPostgres:
    """A cluster for one test, which may stop and start it."""

    def __init__(self, where=None, **settings):
        self.where = where
        self.settings = settings

    def __enter__(self):
        self.cluster = Cluster(where=self.where, **self.settings)
        self.cluster.start()
        self.store = self.cluster.url("tunewright")
        return self

    def __exit__(self, *_):
        self.cluster.remove()


class SmallDisk:
    """A file system of a few MiB that can be filled and emptied. Mounting one needs root."""

    def __init__(self, mib):
        self.mib = mib

    def __enter__(self):
        self.folder = tempfile.mkdtemp(prefix="tunewright-disk-")
        subprocess.run(["mount", "-t", "tmpfs", "-o", "size=%dm,mode=755" % self.mib, "tunewright-test", self.folder],
                       check=True)
        self.filler = os.path.join(self.folder, "filler")
        return self

    def __exit__(self, *_):
        subprocess.run(["umount", "-l", self.folder], check=True)
        os.rmdir(self.folder)

    def fill(self, leave_kib=0):
        """Fills the disk except for this many KiB."""
        with open(self.filler, "ab", buffering=0) as file:
            try:
                while True:
                    file.write(b"x" * 65536)
            except OSError:
                pass
            file.truncate(max(0, file.tell() - 1024 * leave_kib))

    def empty(self):
        os.remove(self.filler)


def may_mount():
    if os.getuid() != 0:
        return False
    try:
        with SmallDisk(1):
            return True
    except (OSError, subprocess.CalledProcessError):
        return False


class Poster:
    """Threads that post this number of jobs, each with a key of its own, and repeat until it is accepted. So every
    job exists once, even if the service is killed between its commit and its answer."""

    def __init__(self, service: Service, request, wanted, threads, patience=240):
        self.service = service
        self.body = json.dumps(request)
        self.wanted = wanted
        self.name = uuid.uuid4().hex  # two posters at one service have different keys
        self.next = 0
        self.ids = []
        self.refusals = []
        self.faults = []
        self.over = False
        self.end = time.monotonic() + patience
        self.lock = threading.Lock()
        self.threads = [threading.Thread(target=self._run, daemon=True) for _ in range(threads)]
        for thread in self.threads:
            thread.start()

    def _run(self):
        while True:
            with self.lock:
                number = self.next
                self.next += 1
            if number >= self.wanted:
                return
            while not self.over and time.monotonic() < self.end:
                if self._post("%s-%d" % (self.name, number)):
                    break
                time.sleep(0.05)

    def _post(self, key):
        try:
            answer = self.service.post("/v1/jobs", self.body, {"Idempotency-Key": key})
        except (OSError, http.client.HTTPException):
            return False  # the service is not running
        with self.lock:
            if answer.status == 202:
                self.ids.append(answer.json["id"])
            else:
                self.refusals.append(answer.status)
        return answer.status == 202

    def _wait(self, there, what):
        while not there():
            if time.monotonic() > self.end:
                raise AssertionError("%s; %d of %d accepted, refusals %r" % (
                    what, len(self.ids), self.wanted, sorted(set(self.refusals))))
            time.sleep(0.005)

    def wait_for(self, count):
        self._wait(lambda: len(self.ids) >= min(count, self.wanted), "too few jobs are accepted")

    def wait_for_refusal(self):
        before = len(self.refusals)
        self._wait(lambda: len(self.refusals) > before, "nothing is refused")

    def stop(self):
        self.over = True

    def join(self):
        for thread in self.threads:
            thread.join(max(1, self.end - time.monotonic()))
        if not self.over and len(self.ids) != self.wanted:
            raise AssertionError("%d of %d accepted, refusals %r" % (
                len(self.ids), self.wanted, sorted(set(self.refusals))))


class Caller:
    """A thread of posts, each on a connection of its own, until the service stops listening. `cut` holds incomplete
    answers."""

    def __init__(self, port, request):
        body = json.dumps(request).encode()
        self.request = (b"POST /v1/jobs HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\n"
                        b"Connection: close\r\nContent-Length: %d\r\n\r\n%s" % (len(body), body))
        self.port = port
        self.ids = []
        self.statuses = set()
        self.cut = []
        self.thread = threading.Thread(target=self._run, daemon=True)
        self.thread.start()

    def _run(self):
        while True:
            try:
                connection = socket.create_connection(("127.0.0.1", self.port), timeout=60)
            except ConnectionError:
                return  # the service has stopped listening
            with connection:
                if not self._call(connection):
                    return

    def _call(self, connection):
        received = b""
        try:
            connection.sendall(self.request)
            while piece := connection.recv(65536):
                received += piece
        except ConnectionError as fault:
            # The system accepted the connection, but not the service.
            if received:
                self.cut.append((fault, received))
            return False
        head, _, body = received.partition(b"\r\n\r\n")
        length = next((int(line.split(b":")[1]) for line in head.split(b"\r\n")
                       if line.lower().startswith(b"content-length")), None)
        if length != len(body):
            self.cut.append(received)
            return False
        self.statuses.add(int(head.split()[1]))
        if head.split()[1] == b"202":
            self.ids.append(json.loads(body)["id"])
        return True


def all_jobs(service):
    """Every job that the service lists, by id. Each must be listed once."""
    jobs = {}
    path = "/v1/jobs?limit=200"
    while path:
        page = service.get(path).json
        for job in page["jobs"]:
            if job["id"] in jobs:
                raise AssertionError("listed twice: " + job["id"])
            jobs[job["id"]] = job
        path = page["next"]
    return jobs


def all_end(service, ids, patience=180):
    """All jobs, once these have ended."""
    end = time.monotonic() + patience
    while True:
        jobs = all_jobs(service)
        lost = set(ids) - set(jobs)
        if lost:
            raise AssertionError("%d accepted jobs are lost, such as %s" % (len(lost), min(lost)))
        left = [jobs[job_id] for job_id in ids if jobs[job_id]["status"] not in ENDED]
        if not left:
            return jobs
        if time.monotonic() > end:
            raise AssertionError("%d jobs have not ended, such as %r" % (len(left), left[0]))
        time.sleep(0.1)
