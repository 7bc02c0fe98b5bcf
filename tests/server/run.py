#!/usr/bin/python3
"""Runs every *_test.py next to it and in the folders next to it, in tests/docs and in tests/clients, and prints the
counts that script/test adds up.

    tests/server/run.py [--jobs N] [NAME ...]

A NAME is a module, a class or a test, such as jobs_test or jobs_test.JobTest.test_ids_cannot_be_guessed. With --jobs N
this number of classes run at a time, in N lanes with a PostgreSQL each: most tests mainly wait.
"""

import argparse
import os
import pathlib
import queue
import subprocess
import sys
import threading
import time
import unittest

HERE = pathlib.Path(__file__).resolve().parent
ROOMS = [HERE, *sorted({test.parent for test in HERE.glob("*/*_test.py")}), HERE.parent / "docs",
         HERE.parent / "clients"]
sys.path[:0] = map(str, ROOMS)


def tests_of(suite):
    for part in suite:
        if isinstance(part, unittest.TestSuite):
            yield from tests_of(part)
        else:
            yield part


def discovered():
    """The tests of all folders, by class, in the order in which they are found."""
    classes = {}
    for room in ROOMS:
        for test in tests_of(unittest.TestLoader().discover(str(room), pattern="*_test.py")):
            classes.setdefault(unittest.util.strclass(type(test)), []).append(test)
    return classes


def run_here(suite):
    result = unittest.TextTestRunner(verbosity=2).run(suite)
    bad = len(result.failures) + len(result.errors) + len(result.unexpectedSuccesses)
    for test, reason in result.skipped:
        print("skipped: %s: %s" % (test, reason))
    print("passed: %d" % (result.testsRun - bad - len(result.skipped)))
    print("failed: %d" % bad)
    return 1 if bad or result.testsRun == 0 else 0


def run_beside_each_other(names, jobs):
    """Runs each class in a process of its own, `jobs` at a time; the output of a process is printed as a whole."""
    from postgres import Cluster

    waiting, printing, codes = queue.SimpleQueue(), threading.Lock(), []
    for name in names:
        waiting.put(name)

    def work():
        with Cluster() as cluster:
            environment = {**os.environ, "TUNEWRIGHT_TEST_POSTGRES": cluster.url()}
            while True:
                try:
                    name = waiting.get_nowait()
                except queue.Empty:
                    return
                start = time.monotonic()
                done = subprocess.run([sys.executable, __file__, name], env=environment, stdin=subprocess.DEVNULL,
                                      stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
                with printing:
                    codes.append(done.returncode)
                    print("%s: %.1f s\n%s" % (name, time.monotonic() - start, done.stdout), flush=True)

    workers = [threading.Thread(target=work) for _ in range(jobs)]
    for worker in workers:
        worker.start()
    for worker in workers:
        worker.join()
    return 1 if len(codes) < len(names) or any(codes) else 0


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--jobs", type=int, default=1, help="classes at a time")
    parser.add_argument("names", nargs="*", metavar="NAME")
    options = parser.parse_args()
    if options.names:
        return run_here(unittest.defaultTestLoader.loadTestsFromNames(options.names))
    classes = discovered()
    if options.jobs > 1:
        return run_beside_each_other(list(classes), options.jobs)
    return run_here(unittest.TestSuite(test for tests in classes.values() for test in tests))


if __name__ == "__main__":
    sys.exit(main())
