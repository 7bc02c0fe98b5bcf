"""Where the jobs of a run are kept: a SQLite file, or a database of a private cluster; and what SQL says of them."""

import os
import re
import sqlite3
import subprocess
import tempfile

# What differs from run to run of the same request.
VOLATILE = re.compile(r'"compute_ms":[^,}]*')


def plain(result):
    return VOLATILE.sub("", result or "")


class SqlitePlace:
    replicas = 1

    def __init__(self):
        self.folder = tempfile.TemporaryDirectory(prefix="tunewright-endurance-")
        self.path = os.path.join(self.folder.name, "jobs.db")
        self.store = "sqlite:" + self.path

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.folder.cleanup()

    def rows(self, sql):
        connection = sqlite3.connect("file:%s?mode=ro" % self.path, uri=True, timeout=60)
        try:
            yield from connection.execute(sql)
        finally:
            connection.close()

    def change(self, script):
        connection = sqlite3.connect(self.path, timeout=600, isolation_level=None)
        connection.execute("PRAGMA synchronous = OFF")
        connection.executescript(script)
        connection.close()

    def bytes(self):
        return sum(os.path.getsize(self.path + end) for end in ("", "-wal") if os.path.exists(self.path + end))

    def crash(self):
        raise NotImplementedError("a file has no process of its own")


class PostgresPlace:
    replicas = 3

    def __init__(self):
        from postgres import Cluster
        self.cluster = Cluster(max_wal_size="4GB", shared_buffers="256MB")
        self.cluster.start()
        self.store = self.cluster.url("endurance")

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.cluster.remove()

    def psql(self, sql, timeout=None):
        command = [self.cluster.bin / "psql", "-X", "-A", "-t", "-q", "-v", "ON_ERROR_STOP=1", "-F", "\x1f", "-d",
                   self.store]
        return subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True), \
            "SET search_path TO tunewright; " + sql

    def rows(self, sql):
        process, text = self.psql(r"\set FETCH_COUNT 1000" + "\n" + "SET search_path TO tunewright;\n" + sql + ";\n")
        process.stdin.write(text.split("; ", 1)[1])
        process.stdin.close()
        for line in process.stdout:
            yield tuple(line.rstrip("\n").split("\x1f"))
        if process.wait() != 0:
            raise RuntimeError("psql failed on " + sql)

    def change(self, script):
        process, text = self.psql(script)
        process.communicate(text)
        if process.returncode != 0:
            raise RuntimeError("psql failed")

    def bytes(self):
        return int(next(self.rows("SELECT pg_database_size(current_database())"))[0])

    def crash(self):
        self.cluster.stop("immediate")
        self.cluster.start()


def place_of(store):
    return SqlitePlace() if store == "sqlite" else PostgresPlace()
