#!/usr/bin/python3
"""Random problems for the calls that design structures, their answers checked without the engine.

    tests/independent/structures/run.py http://127.0.0.1:8080 [--process ID] [--seed N] [--count N] [NAME ...]

NAME: cascades, interactions, triples (three loops), feedforwards, predictors, levels; all without one. Of cascades and
pairs of loops --count problems, of feedforwards, predictors and levels half as many, of triples a tenth. --process: the id of the service, whose
processor time is then reported in place of the time that passes. Prints each failure with its request, then counts;
exit code 1 after a failure."""

import argparse
import sys

import cascades
import feedforwards
import interactions
import levels
import predictors
from client import Client

KINDS = {
    "cascades": lambda client, seed, n: cascades.check(client, seed, n, n * 3 // 10),
    "interactions": lambda client, seed, n: interactions.check(client, seed, n, 2),
    "triples": lambda client, seed, n: interactions.check(client, seed, (n + 9) // 10, 3),
    "feedforwards": lambda client, seed, n: feedforwards.check(client, seed, n // 2),
    "predictors": lambda client, seed, n: predictors.check(client, seed, n // 2),
    "levels": lambda client, seed, n: levels.check(client, seed, n // 2),
}


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("address")
    parser.add_argument("--process", type=int)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--count", type=int, default=200)
    parser.add_argument("names", nargs="*")
    chosen = parser.parse_intermixed_args()
    client = Client(chosen.address, chosen.process)
    tallies = []
    for name in chosen.names or KINDS:
        tallies += KINDS[name](client, chosen.seed, chosen.count)
    for tally in tallies:
        tally.report()
    return int(any(tally.failed for tally in tallies))


if __name__ == "__main__":
    sys.exit(main())
