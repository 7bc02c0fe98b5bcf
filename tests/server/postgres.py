#!/usr/bin/python3
"""A private PostgreSQL from Debian's package, for tests and measurements: in a folder and on a port of its own.

    tests/server/postgres.py run -- COMMAND ...

runs COMMAND with TUNEWRIGHT_TEST_POSTGRES set to the address of such a cluster, and always stops it.
"""

import argparse
import ctypes
import os
import pathlib
import pwd
import secrets
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time
import urllib.parse

USER = "tunewright"
SIGNALS = {"smart": signal.SIGTERM, "fast": signal.SIGINT, "immediate": signal.SIGQUIT}


def programs():
    """The folder of the newest server's programs. Debian keeps them out of PATH."""
    found = sorted(pathlib.Path("/usr/lib/postgresql").glob("*/bin/postgres"), key=lambda path: int(path.parts[-3]))
    if not found:
        raise SystemExit("PostgreSQL is not installed: run script/bootstrap test, or apt-get install postgresql.")
    return found[-1].parent


def die_with_parent():
    """Runs in the child process: if the test is killed, the server ends too."""
    pr_set_pdeathsig = 1
    ctypes.CDLL(None).prctl(pr_set_pdeathsig, signal.SIGQUIT)


class Cluster:
    """A server that listens on 127.0.0.1 only and asks for a password. PostgreSQL refuses to run as root: then it
    runs as the user of Debian's package."""

    def __init__(self, where=None, **settings):
        self.bin = programs()
        self.settings = settings
        self.password = secrets.token_hex(8)
        self.identity = {}
        self.folder = tempfile.mkdtemp(prefix="tunewright-postgres-", dir=where)
        if os.getuid() == 0:
            user = pwd.getpwnam("postgres")
            self.identity = {"user": user.pw_uid, "group": user.pw_gid, "extra_groups": []}
            os.chown(self.folder, user.pw_uid, user.pw_gid)
        self.data = os.path.join(self.folder, "data")
        self.port = None
        self.process = None
        self._make()

    def __enter__(self):
        self.start()
        return self

    def __exit__(self, *_):
        self.remove()

    def _make(self):
        secret = os.path.join(self.folder, "password")
        with open(secret, "w") as file:
            file.write(self.password + "\n")
        if self.identity:
            os.chown(secret, self.identity["user"], self.identity["group"])
        self._run("initdb", "-D", self.data, "-U", USER, "-A", "scram-sha-256", "--pwfile", secret, "-E", "UTF8",
                  "--locale=C.UTF-8", "--no-sync")

    def _run(self, program, *arguments):
        done = subprocess.run([self.bin / program, *arguments], cwd=self.folder, stdin=subprocess.DEVNULL,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, **self.identity,
                              env={**os.environ, "PGPASSWORD": self.password, "LC_ALL": "C.UTF-8"})
        if done.returncode != 0:
            raise RuntimeError("%s failed: %s" % (program, done.stdout))
        return done.stdout

    def start(self, patience=30):
        """On its previous port, if it had one."""
        if self.process and self.process.poll() is None:
            return
        if self.port is None:
            with socket.socket() as probe:
                probe.bind(("127.0.0.1", 0))
                self.port = probe.getsockname()[1]
        options = {"listen_addresses": "127.0.0.1", "port": self.port, "unix_socket_directories": "",
                   "max_connections": 200, **self.settings}
        command = [self.bin / "postgres", "-D", self.data]
        for name, value in options.items():
            command += ["-c", "%s=%s" % (name, value)]
        with open(os.path.join(self.folder, "log"), "ab") as log:
            self.process = subprocess.Popen(command, cwd=self.folder, stdin=subprocess.DEVNULL, stdout=log, stderr=log,
                                            preexec_fn=die_with_parent, start_new_session=True, **self.identity)
        end = time.monotonic() + patience
        while not self._ready():
            if self.process.poll() is not None or time.monotonic() > end:
                raise RuntimeError("PostgreSQL does not start: " + self.read_log())
            time.sleep(0.02)

    def _ready(self):
        try:
            with open(os.path.join(self.data, "postmaster.pid")) as file:
                lines = file.read().splitlines()
        except FileNotFoundError:
            return False
        return len(lines) >= 8 and lines[0].strip() == str(self.process.pid) and lines[7].strip() == "ready"

    def stop(self, mode="fast", patience=30):
        """fast: connections are cut; immediate: like a crash, with recovery at the next start."""
        if self.process is None:
            return
        if self.process.poll() is None:
            self.process.send_signal(SIGNALS[mode])
        self.process.wait(patience)

    def remove(self):
        try:
            self.stop("immediate")
        finally:
            shutil.rmtree(self.folder, ignore_errors=True)

    def read_log(self):
        with open(os.path.join(self.folder, "log"), errors="replace") as log:
            return log.read()

    def url(self, database="postgres"):
        """The address of that database, which is created if it does not exist."""
        address = "postgresql://%s:%s@127.0.0.1:%d/" % (USER, self.password, self.port)
        return make_database(address + "postgres", database)


def make_database(address, database):
    """The address of a database with that name in the cluster of `address`; it is created if it does not exist."""
    parts = urllib.parse.urlsplit(address)
    wanted = urllib.parse.urlunsplit(parts._replace(path="/" + database))
    if parts.path == "/" + database:
        return wanted
    psql = [programs() / "psql", "-X", "-A", "-t", "-q", "-v", "ON_ERROR_STOP=1", "-d", address, "-c"]
    there = subprocess.run([*psql, "SELECT 1 FROM pg_database WHERE datname = '%s'" % database], check=True,
                           stdout=subprocess.PIPE, text=True).stdout.strip()
    if there != "1":
        subprocess.run([*psql, 'CREATE DATABASE "%s"' % database], check=True)
    return wanted


def run(command):
    """The exit code of the command, run with a cluster."""
    def stop(number, _frame):
        raise SystemExit(128 + number)

    for number in (signal.SIGTERM, signal.SIGHUP, signal.SIGINT):
        signal.signal(number, stop)
    with Cluster() as cluster:
        child = subprocess.Popen(command, env={**os.environ, "TUNEWRIGHT_TEST_POSTGRES": cluster.url()})
        try:
            return child.wait()
        finally:
            if child.poll() is None:
                child.terminate()
                child.wait()


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    actions = parser.add_subparsers(dest="action", required=True)
    runner = actions.add_parser("run", help="run a command with a cluster")
    runner.add_argument("command", nargs="+")
    return run(parser.parse_args().command)


if __name__ == "__main__":
    sys.exit(main())
