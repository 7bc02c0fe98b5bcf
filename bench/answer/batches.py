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


def loops_csv(count, seed=7):
    draw = random.Random(seed)
    lines = ["name,K,T,L"]
    for i in range(count):
        T = 10 ** draw.uniform(-1, 2)
        lines.append("L%d,%.6g,%.6g,%.6g" % (i, 10 ** draw.uniform(-1, 1), T, T * 10 ** draw.uniform(-1.3, 0.7)))
    return "\n".join(lines)


def batch(running, loops, method="robust"):
    """Seconds until all have ended, processor milliseconds a job, seconds of the CSV, peak MiB."""
    before, start = processor_seconds(running.process), time.monotonic()
    answer = running.call("POST", "/v1/batches?method=" + method, loops_csv(loops), {"Content-Type": "text/csv"},
                          timeout=3600)
    if answer.status not in (200, 202):
        raise SystemExit("%d %s" % (answer.status, answer.body[:400]))
    path = "/v1/batches/" + answer.json["id"]
    while running.get(path).json["status"] != "ended":
        time.sleep(0.05)
    took, used = time.monotonic() - start, processor_seconds(running.process) - before
    start = time.monotonic()
    lines = running.call("GET", path + "/results?format=csv", timeout=3600).body.count(b"\n")
    if lines != loops + 1:
        raise SystemExit("the CSV has %d lines" % lines)
    return took, 1e3 * used / loops, time.monotonic() - start, peak_mib(running.process)
