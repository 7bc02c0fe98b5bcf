"""A queue of very many rows: what a claim takes, how soon a dead process's jobs run again, how fast ended ones go."""

import json
import subprocess
import time

from figures import Table
from places import place_of
from service import LONG, Service

LEASE = 3
GROUP = 8

FILL = {
    "sqlite": """
BEGIN;
INSERT INTO batches (id, name, owner, flow, created_at, heard_at, state, queued)
    VALUES ('filled', '', '', '', 1, 1, 'sealed', {rows});
WITH RECURSIVE n (i) AS (SELECT 0 UNION ALL SELECT i + 1 FROM n WHERE i + 1 < {rows})
INSERT INTO jobs (id, name, owner, flow, class, turn, batch, batch_index, created_at, timeout_s, request_hash, request)
    SELECT printf('filled%018d', i), '', '', '', 1, i + 1, (SELECT seq FROM batches WHERE id = 'filled'), i, 1, 60,
           'hash', '{request}' FROM n;
INSERT INTO waiting (class, turn, seq, flow, batch) SELECT class, turn, seq, flow, batch FROM jobs
    WHERE batch = (SELECT seq FROM batches WHERE id = 'filled') ORDER BY turn;
COMMIT;
""",
    "postgresql": """
INSERT INTO batches (id, name, owner, flow, created_at, state) VALUES ('filled', '', '', '', 1, 'sealed');
INSERT INTO batch_counts SELECT seq, 99, {rows}, 0, 0, 0, 0, 0 FROM batches WHERE id = 'filled';
INSERT INTO jobs (id, name, owner, flow, class, turn, batch, batch_index, created_at, timeout_s, request_hash, request)
    SELECT 'filled' || lpad(i::text, 18, '0'), '', '', '', 1, i + 1, b.seq, i, 1, 60, 'hash', '{request}'
    FROM generate_series(0, {rows} - 1) i, batches b WHERE b.id = 'filled';
INSERT INTO waiting (class, turn, seq, flow, batch) SELECT class, turn, seq, flow, batch FROM jobs WHERE class = 1;
ANALYZE;
""",
}
END = {
    "sqlite": """
BEGIN;
WITH RECURSIVE n (i) AS (SELECT 0 UNION ALL SELECT i + 1 FROM n WHERE i + 1 < {rows})
INSERT INTO jobs (id, name, owner, flow, class, turn, created_at, timeout_s, request_hash, request)
    SELECT printf('old%018d', i), '', '', '', 0, 1, 1, 60, 'hash', '{request}' FROM n;
INSERT INTO ended (seq, single, status, attempts, cancel_requested, started_at, finished_at, result)
    SELECT seq, 1, 'succeeded', 1, 0, 1, 2, '{request}' FROM jobs WHERE batch IS NULL AND id LIKE 'old%';
COMMIT;
""",
    "postgresql": """
INSERT INTO jobs (id, name, owner, flow, class, turn, created_at, timeout_s, request_hash, request)
    SELECT 'old' || lpad(i::text, 18, '0'), '', '', '', 0, 1, 1, 60, 'hash', '{request}'
    FROM generate_series(0, {rows} - 1) i;
INSERT INTO ended (seq, single, status, attempts, cancel_requested, started_at, finished_at, result)
    SELECT seq, true, 'succeeded', 1, false, 1, 2, '{request}' FROM jobs WHERE batch IS NULL AND id LIKE 'old%';
""",
}
REQUEST = json.dumps({"plant": {"type": "fopdt", "K": 1, "T": 10, "L": 2}, "tune": [{"method": "simc"}]})


def latency(build, place, *words):
    done = subprocess.run([str(build / "bench" / "store" / "store_latency"), place.store, *words], check=True,
                          capture_output=True, text=True)
    return json.loads(done.stdout)


def running_again(services, jobs, patience):
    """Seconds until each of the jobs is begun a second time."""
    begun = time.monotonic()
    while time.monotonic() < begun + patience:
        if all(services[-1].job(job)["attempts"] > 1 for job in jobs):
            return time.monotonic() - begun
        time.sleep(0.02)
    return float("inf")


def rescue(place):
    """Kills a process in the middle of two long jobs; another takes them."""
    arguments = ("--workers", "2", "--lease", "%ds" % LEASE, "--drain-timeout", "0", "--log-level", "error")
    first = Service(*arguments, store=place.store)
    jobs = [first.post_job(LONG)["id"] for _ in range(2)]
    for job in jobs:
        first.wait_for(job, ("running",))
    others = [Service(*arguments, store=place.store)] if place.replicas > 1 else []
    first.kill()
    begun = time.monotonic()
    if not others:
        first.start()
    seconds = running_again(others or [first], jobs, LEASE + 30) if others else \
        time.monotonic() - begun + running_again([first], jobs, LEASE + 30)
    for job in jobs:
        (others or [first])[0].post("/v1/jobs/%s/cancel" % job, "")
    for service in others or [first]:
        service.__exit__()
    return seconds


def run(store, given, build):
    table = Table("rows", store)
    request = REQUEST.replace("'", "''")
    with place_of(store) as place:
        with Service("--role", "api" if place.replicas > 1 else "all", "--workers", "1", store=place.store):
            pass  # makes the tables
        begun = time.monotonic()
        place.change(FILL[store].format(rows=given.rows, request=request))
        table.row("rows that wait, made by SQL", given.rows)
        table.row("which took", time.monotonic() - begun, "s")
        claims = latency(build, place, "claim", "2000", str(GROUP))
        table.row("a claim of %d jobs and their ends: p50" % GROUP, claims["p50_ms"], "ms")
        table.row("p99", claims["p99_ms"], "ms", 20)
        table.row("jobs of a dead process run again after", rescue(place), "s", LEASE + 2)
        old = max(50_000, given.rows // 10)
        place.change(END[store].format(rows=old, request=request))
        swept = latency(build, place, "sweep", str(old))
        table.row("ended jobs swept", swept["rows"], "", old, at_most=False)
        table.row("sweeping", swept["per_second"], "/s", 20000, at_most=False)
    return table.held
