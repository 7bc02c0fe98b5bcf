"""How the cost of answers grows: with the loops of a batch, the rows of a record, the workers, the processes."""

import json
import os
import random
import time

from batches import batch, loops_csv, peak_mib, processor_seconds
from postgres import Cluster
from service import Service

WORKERS = "2"
BODY = "1GiB"         # the largest record has a body of some 200 MB
QUICK_LOOPS = 20000   # of the tables of workers and processes


def store_mib(running):
    path = running.store.split(":", 1)[1]
    return sum(os.path.getsize(path + end) for end in ("", "-wal") if os.path.exists(path + end)) / 2**20


def line(*cells):
    print("| " + " | ".join("%.3g" % x if isinstance(x, float) else str(x) for x in cells) + " |", flush=True)


def head(*names):
    print()
    line(*names)
    line(*["---"] * len(names))


def of_loops(largest):
    head("loops in a batch", "method", "s until all have ended", "processor ms a loop", "of two cores", "CSV s",
         "peak MiB", "store MiB")
    for method, most in (("robust", min(largest, 10**5)), ("simc", largest)):
        loops = 100
        while loops <= most:
            with Service("--workers", WORKERS, "--max-body", BODY) as running:
                took, each, csv, peak = batch(running, loops, method)
                line(loops, method, took, each, "%.0f %%" % (100 * each * loops / 1e3 / took / 2), csv, peak,
                     store_mib(running))
            loops *= 10


def record_csv(rows, seed=3):
    """A bump test of a first-order plant with dead time, with noise: t,u,y."""
    draw = random.Random(seed)
    step, T, late = 400 / rows, 20, round(3 / (400 / rows))
    y, moved, share = 0.0, [], step / T
    for i in range(rows):
        u = 1.0 if 0.1 * rows <= i - late < 0.6 * rows else 0.0
        y += share * (2 * u - y)
        moved.append("%.6g,%d,%.5f" % (i * step, 0.1 * rows <= i < 0.6 * rows, y + draw.gauss(0, 0.01)))
    return "t,u,y\n" + "\n".join(moved)


def of_rows():
    head("rows of a record", "MB", "s until the model", "processor s", "peak MiB")
    for rows in (10**3, 10**4, 10**5, 10**6, 10**7):
        text = record_csv(rows)
        with Service("--workers", WORKERS, "--max-body", BODY, "--memory", "8GiB") as running:
            before, start = processor_seconds(running.process), time.monotonic()
            answer = running.call("POST", "/v1/identify", json.dumps({"record": {"csv": text}}),
                                  {"Content-Type": "application/json"}, timeout=600)
            took = time.monotonic() - start
            if answer.status != 200:
                line(rows, len(text) / 1e6, "refused: %s" % answer.json["detail"], "", "")
            else:
                line(rows, len(text) / 1e6, took, processor_seconds(running.process) - before,
                     peak_mib(running.process))


def of_workers():
    head("workers", "loops a second, SIMC", "processor ms a loop", "robust", "processor ms a loop")
    for workers in (1, 2, 4, 8, 16):
        cells = []
        for method, loops in (("simc", QUICK_LOOPS), ("robust", QUICK_LOOPS // 5)):
            with Service("--workers", str(workers)) as running:
                took, each, _, _ = batch(running, loops, method)
                cells += [loops / took, each]
        line(workers, *cells)


def of_processes():
    """Processes with one worker each on one PostgreSQL; the batch comes in at the first."""
    head("processes on one PostgreSQL", "loops a second, SIMC", "robust")
    cluster = Cluster()
    cluster.start()
    try:
        for count in (1, 2, 4, 8):
            rates = []
            for method, loops in (("simc", QUICK_LOOPS), ("robust", QUICK_LOOPS // 5)):
                url = cluster.url("growth_%d_%s" % (count, method))
                services = [Service("--workers", "1", store=url) for _ in range(count)]
                try:
                    rates.append(loops / batch(services[0], loops, method)[0])
                finally:
                    for running in services:
                        running.stop()
            line(count, *rates)
    finally:
        cluster.remove()


def tables(largest):
    of_loops(largest)
    of_rows()
    of_workers()
    of_processes()
