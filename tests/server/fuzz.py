#!/usr/bin/python3
"""Random bytes and damaged requests against a running service, for a given time: it must answer and survive.

Not a unit test: its length is an argument; its seed is printed and can be given again."""

import argparse
import json
import pathlib
import random
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
from service import FOPDT, QUICK, Service  # noqa: E402

ODD_VALUES = [None, True, -1, 0, 1e308, -1e308, 1e-308, 10**30, "", "NaN", "\0", "x" * 5000, [], {}, [[]], [1e9] * 50]


def bend(value, chance):
    """The same JSON with a random change."""
    if chance.random() < 0.08:
        return chance.choice(ODD_VALUES)
    if isinstance(value, dict):
        bent = {key: bend(item, chance) for key, item in value.items() if chance.random() > 0.04}
        if chance.random() < 0.05:
            bent[chance.choice(["L", "type", "extra", "", "num"])] = chance.choice(ODD_VALUES)
        return bent
    if isinstance(value, list):
        return [bend(item, chance) for item in value for _ in range(chance.choice([1, 1, 1, 0, 2]))]
    return value


def bent_bytes(data, chance):
    data = bytearray(data)
    for _ in range(chance.randrange(1, 8)):
        at = chance.randrange(len(data))
        kind = chance.randrange(3)
        if kind == 0:
            data[at] = chance.randrange(256)
        elif kind == 1:
            del data[at:at + chance.randrange(1, 20)]
        else:
            data[at:at] = chance.randbytes(chance.randrange(1, 20))
        if not data:
            break
    return bytes(data)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seconds", type=float, default=30)
    parser.add_argument("--seed", type=int, default=random.SystemRandom().randrange(2**32))
    given = parser.parse_args()
    print("seed", given.seed)
    chance = random.Random(given.seed)
    counts = {}
    with Service("--queue-limit", "50", "--drain-timeout", "0") as service:
        examples = [example["request"] for example in service.get("/v1/examples").json["examples"]] + [QUICK]
        evaluate = {"plant": FOPDT, "controllers": [{"form": "ideal", "Kp": 1, "Ti": 10, "Td": 1}], "evaluate": {}}
        relay = {"plant": FOPDT, "relay": {"u_plus": 1.3, "u_minus": -0.7, "hysteresis": 0.2, "noise_std": 0.01,
                                           "relay_sample_time": 0.1, "record_interval": 0.2, "cycles": 3, "seed": 1}}
        end = time.monotonic() + given.seconds
        while time.monotonic() < end:
            request = bend(chance.choice(examples), chance)
            if isinstance(request, dict):
                request["timeout_s"] = 1
            body = json.dumps(request).encode()
            if chance.random() < 0.3:
                body = bent_bytes(body, chance)
            path, body = chance.choice([("/v1/jobs", body), ("/v1/evaluate", json.dumps(bend(evaluate, chance)).encode()),
                                        ("/v1/experiments/relay", json.dumps(bend(relay, chance)).encode()),
                                        ("/v1/identify", body)])
            answer = service.post(path, body, {"Prefer": "wait=2"})
            counts[answer.status] = counts.get(answer.status, 0) + 1
            if answer.status == 500 or b'"internal"' in answer.body:
                print("a fault of ours:", path, body[:2000], answer.body[:500])
                return 1
            head = b"POST /v1/jobs HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\nContent-Length: 2\r\n\r\n{}"
            service.raw(bent_bytes(head, chance), patience=0.05)
            if service.process.poll() is not None:
                print("the service died:", path, body[:2000], service.read_log()[-3000:])
                return 1
        code = service.stop()
    print("answers by status:", dict(sorted(counts.items())), "exit code", code)
    return 1 if code != 0 else 0


if __name__ == "__main__":
    sys.exit(main())
