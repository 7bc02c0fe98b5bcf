"""Batches for the measurements: made loops, and one batch from its sending to its results."""

import pathlib
import os
import random
import time

TICK = os.sysconf("SC_CLK_TCK")


def processor_seconds(process):
    fields = pathlib.Path("/proc/%d/stat" % process.pid).read_text().rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / TICK


def peak_mib(process):
    line = next(x for x in pathlib.Path("/proc/%d/status" % process.pid).read_text().splitlines() if "VmHWM" in x)
    return int(line.split()[1]) / 1024


LARGEST = 100000  # loops of one batch: more are sent as several


def loops_csv(count, seed):
    draw = random.Random(seed)
    lines = ["name,K,T,L"]
    for i in range(count):
        T = 10 ** draw.uniform(-1, 2)
        lines.append("L%d,%.6g,%.6g,%.6g" % (i, 10 ** draw.uniform(-1, 1), T, T * 10 ** draw.uniform(-1.3, 0.7)))
    return "\n".join(lines)


def sent(running, loops, method, seed):
    """The path of a batch that has been sent."""
    answer = running.call("POST", "/v1/batches?method=" + method, loops_csv(loops, seed), {"Content-Type": "text/csv"},
                          timeout=3600)
    if answer.status not in (200, 202):
        raise SystemExit("%d %s" % (answer.status, answer.body[:400]))
    return "/v1/batches/" + answer.json["id"]


def batch(running, loops, method="robust"):
    """Seconds until all have ended, processor milliseconds a job, seconds of the CSV, peak MiB."""
    before, start = processor_seconds(running.process), time.monotonic()
    sizes = [min(LARGEST, loops - first) for first in range(0, loops, LARGEST)]
    paths = [sent(running, size, method, seed) for seed, size in enumerate(sizes, 7)]
    for path in paths:
        while running.get(path).json["status"] != "ended":
            time.sleep(0.05)
    took, used = time.monotonic() - start, processor_seconds(running.process) - before
    start = time.monotonic()
    lines = sum(running.call("GET", path + "/results?format=csv", timeout=3600).body.count(b"\n") - 1 for path in paths)
    if lines != loops:
        raise SystemExit("the CSV has %d loops" % lines)
    return took, 1e3 * used / loops, time.monotonic() - start, peak_mib(running.process)
