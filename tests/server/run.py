#!/usr/bin/python3
"""Runs every *_test.py beside it, in cli/, deploy/, records/ and stores/, and in tests/docs and tests/clients, and
prints the counts that script/test adds up."""

import pathlib
import sys
import unittest

HERE = pathlib.Path(__file__).resolve().parent
ROOMS = [HERE, *(HERE / room for room in ("cli", "deploy", "records", "stores")), HERE.parent / "docs",
         HERE.parent / "clients"]
sys.path[:0] = map(str, ROOMS)


def main():
    names = sys.argv[1:]
    suite = unittest.TestSuite(unittest.TestLoader().discover(str(room), pattern="*_test.py") for room in ROOMS)
    if names:
        suite = unittest.defaultTestLoader.loadTestsFromNames(names)
    result = unittest.TextTestRunner(verbosity=2).run(suite)
    bad = len(result.failures) + len(result.errors) + len(result.unexpectedSuccesses)
    for test, reason in result.skipped:
        print("skipped: %s: %s" % (test, reason))
    print("passed: %d" % (result.testsRun - bad - len(result.skipped)))
    print("failed: %d" % bad)
    return 1 if bad or result.testsRun == 0 else 0


if __name__ == "__main__":
    sys.exit(main())
