#!/usr/bin/python3
"""Calls generated from the service's own /openapi.json: each answer must be documented there.

Every path and method, with parameters and bodies according to the schemas and with damaged ones. Checks: no fault of
the service (5xx other than 503 and 507), a status that the operation documents, the media type and the schema of
that answer.

    tests/server/api_fuzz.py --seconds 300        a new seed for each round; the seed of a fault is printed
    tests/server/api_fuzz.py --seed 7             that round again

hostile_test.py has a short round that is always the same."""

import argparse
import collections
import http.client
import json
import pathlib
import random
import re
import sys
import time
import urllib.parse

import jsonschema
from hypothesis import HealthCheck, Phase, errors, given, seed, settings, strategies as st

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
from schema_values import Values, bent, bent_bytes  # noqa: E402
from service import LONG, QUICK, Service  # noqa: E402

INTENDED = (503, 507)
# For any request: documented as `default`.
REFUSED = (408, 411, 414, 417, 431, 505)
METHODS = ("get", "put", "post", "delete", "patch")
# Short limits: the fuzzer tests answers, not designs.
OPTIONS = ("--queue-limit", "100", "--drain-timeout", "0", "--job-timeout", "200ms", "--max-timeout", "200ms")


def not_a_number(word):
    raise AssertionError("%s in an answer" % word)


class Api:
    """The document: its operations, and their answers."""

    def __init__(self, document):
        self.document = document
        self.values = Values(document)
        self.resolver = jsonschema.RefResolver.from_schema(document)
        self.operations = [(method, path, operation) for path, item in document["paths"].items()
                           for method, operation in item.items() if method in METHODS]
        self.parameters = {path: item.get("parameters", []) for path, item in document["paths"].items()}

    def resolved(self, item):
        while "$ref" in item:
            item = self.resolver.resolve(item["$ref"])[1]
        return item

    def parameters_of(self, path, operation):
        return [self.resolved(item) for item in self.parameters[path] + operation.get("parameters", [])]

    def check(self, operation, answer):
        """Raises AssertionError if the operation does not document the answer."""
        responses = operation["responses"]
        assert answer.status < 500 or answer.status in INTENDED, "a fault of the service"
        status = "default" if answer.status in REFUSED else str(answer.status)
        assert status in responses, "status %d is not documented" % answer.status
        content = self.resolved(responses[status]).get("content")
        if not content:
            assert answer.body == b"", "a body is not documented"
            return
        assert answer.media_type in content, "%r is not documented" % answer.media_type
        schema = content[answer.media_type].get("schema")
        if answer.media_type == "application/x-ndjson":
            schema = {"$ref": "#/components/schemas/BatchRow"}
            values = answer.body.splitlines()
        else:
            values = [answer.body] if answer.media_type.endswith("json") and schema else []
        for text in values:
            value = json.loads(text, parse_constant=not_a_number)
            jsonschema.Draft202012Validator(schema, resolver=self.resolver).validate(value)


class Call:
    def __init__(self, method, path, query, headers, body):
        self.method, self.headers, self.body = method.upper(), headers, body
        self.target = path + ("?" + urllib.parse.urlencode(query) if query else "")

    def __repr__(self):
        return "%s %s %r %r" % (self.method, self.target, self.headers, self.body and self.body[:3000])


def sendable(text):
    """The text with the characters that a header field allows."""
    return re.sub("[^ -~]", "", str(text)).strip()


@st.composite
def bodies(draw, api, content):
    media = draw(st.sampled_from(sorted(content)))
    schema = content[media].get("schema", {})
    examples = [api.resolved(example)["value"] for example in content[media].get("examples", {}).values()]
    examples += [content[media]["example"]] if "example" in content[media] else []
    if media.endswith("ndjson") or media == "text/csv":
        item = api.values.of({"$ref": "#/components/schemas/TuningRequest"})
        if media == "text/csv":
            number = st.one_of(st.sampled_from([1, 2, 0.5, -1, 0, 10]), st.sampled_from(["", "x", "nan", '"', "1e400", "1;2"]))
            row = st.tuples(st.sampled_from(["TIC-1", "", "a,b", '"q"', "é"]), number, number, number)
            text = draw(st.lists(row.map(lambda cells: ",".join(map(str, cells))), max_size=6).map(
                lambda rows: "\n".join(["name,K,T,L", *rows])))
        else:
            text = "\n".join(json.dumps(one) for one in draw(st.lists(item, max_size=4)))
        data = text.encode()
    else:
        value = draw(st.one_of(api.values.of(schema), st.sampled_from(examples)) if examples else api.values.of(schema))
        if draw(st.integers(0, 2)) == 0:
            value = draw(bent(value))
        data = json.dumps(value).encode()
    if draw(st.integers(0, 9)) == 0:
        data = draw(bent_bytes(data))
    if draw(st.integers(0, 29)) == 0:
        media = draw(st.sampled_from(["text/plain", "application/xml", "multipart/form-data", "a", "application/json; x"]))
    return media, data


@st.composite
def calls(draw, api, ids):
    # Operations that only return a document get few attempts; those with input get most of them.
    weighted = [item for item in api.operations for _ in range(4 if item[0] == "post" or "{" in item[1] else 1)]
    method, path, operation = draw(st.sampled_from(weighted))
    query, headers = [], {}
    for parameter in api.parameters_of(path, operation):
        name, schema = parameter["name"], parameter.get("schema", {})
        odd = draw(st.integers(0, 5)) == 0
        value = draw(st.text(max_size=12) if odd else api.values.of(schema))
        if parameter["in"] == "path":
            known = ids["batches" if path.startswith("/v1/batches") else "jobs"]
            if known and path.startswith(("/v1/jobs", "/v1/batches")) and draw(st.integers(0, 4)) > 0:
                value = known[draw(st.integers(0, len(known) - 1))]
            elif path.startswith("/v1/methods") and not odd:
                value = draw(st.sampled_from(["robust", "simc", "all", "rimc"]))
            elif path.startswith("/v1/controllers") and not odd:
                value = draw(st.sampled_from(["emerson_deltav_series", "klipper", "simple_pid", "omron_pid190"]))
            path = path.replace("{%s}" % name, urllib.parse.quote(str(value) or "-", safe=""))
        elif parameter["in"] == "query" and (parameter.get("required") or draw(st.booleans())):
            query.append((name, value if isinstance(value, str) else json.dumps(value)))
        elif parameter["in"] == "header" and draw(st.integers(0, 2)) > 0:
            headers[name] = sendable(value)
    if draw(st.integers(0, 29)) == 0:
        query.append((draw(st.text(max_size=6)), draw(st.text(max_size=6))))
    if draw(st.integers(0, 9)) == 0:
        headers["Accept"] = draw(st.sampled_from(["*/*", "application/json", "text/html", "text/csv", "text/event-stream", "q"]))
    body = None
    content = api.resolved(operation.get("requestBody", {})).get("content")
    if content and draw(st.integers(0, 39)) > 0:
        headers["Content-Type"], body = draw(bodies(api, content))
    elif method == "post":
        body = b""
    return Call(method, path, query, headers, body)


def prepared(service):
    """Ids of jobs in several states, and of a batch."""
    done = service.post_job(QUICK, wait=30)["id"]
    failed = service.post_job({"record": {"t": [0, 1, 2], "u": [1, 1, 1], "y": [2, 2, 2]}}, wait=30)["id"]
    cancelled = service.post_job({**LONG, "timeout_s": 0.2})["id"]
    service.post("/v1/jobs/%s/cancel" % cancelled, "")
    return {"jobs": [done, failed, cancelled, "0123456789abcdefghjkmnpqrs"],
            "batches": [new_batch(service), new_batch(service), "0123456789abcdefghjkmnpqrs"]}


def new_batch(service):
    lines = json.dumps(QUICK) + "\n{\n" + json.dumps(QUICK)
    answer = service.post("/v1/batches", lines, {"Content-Type": "application/x-ndjson"})
    return answer.json["id"] if answer.status == 202 else "none"


def replace_deleted(service, ids, call):
    """Replaces deleted jobs and batches, so that later calls find more than 404."""
    for known, make in ((ids["jobs"], lambda: service.post_job(QUICK, wait=30)["id"]),
                        (ids["batches"], lambda: new_batch(service))):
        for i, name in enumerate(known):
            if call.target.split("?")[0].endswith("/" + name):
                known[i] = make()


def round_of_calls(service, api, examples, number=None, counts=None, shrink=False):
    """`number` is the seed; without it the round is always the same. Raises AssertionError with the call that shows
    a fault."""
    ids = prepared(service)
    phases = [Phase.generate] + ([Phase.shrink] if shrink else [])

    @settings(max_examples=examples, deadline=None, database=None, derandomize=number is None, phases=phases,
              print_blob=False, report_multiple_bugs=False, suppress_health_check=list(HealthCheck))
    @given(calls(api, ids))
    def hold(call):
        operation = next(o for m, p, o in api.operations if m.upper() == call.method and matches(p, call.target))
        try:
            answer = service.call(call.method, call.target, call.body, call.headers)
        except (OSError, http.client.HTTPException) as fault:
            raise AssertionError("no answer, %r\n  call: %r" % (fault, call)) from None
        if call.method == "DELETE" and answer.status == 204:
            replace_deleted(service, ids, call)
        if call.target.split("?")[0].endswith("/queue/pause"):  # otherwise each wait for a job would last its full time
            service.post("/v1/queue/resume", b"")
        if counts is not None:
            counts[operation["operationId"], answer.status] += 1
        try:
            api.check(operation, answer)
        except (AssertionError, ValueError, jsonschema.ValidationError) as fault:
            sentence = getattr(fault, "message", None) or str(fault)
            where = "/".join(map(str, getattr(fault, "absolute_path", [])))
            raise AssertionError("%s %s\n  call: %r\n  answer: %d %s %r" % (
                sentence[:500], where, call, answer.status, answer.media_type, answer.body[:1500])) from None
        assert service.process.poll() is None, "the service has ended after %r" % call

    (seed(number)(hold) if number is not None else hold)()


def matches(template, target):
    return re.fullmatch(re.sub(r"\\{[^/]*\\}", "[^/]+", re.escape(template)), target.split("?")[0])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seconds", type=float, default=30)
    parser.add_argument("--seed", type=int)
    given_arguments = parser.parse_args()
    chance = random.SystemRandom()
    counts = collections.Counter()
    end = time.monotonic() + given_arguments.seconds
    with Service(*OPTIONS) as service:
        api = Api(service.get("/openapi.json").json)
        first = True
        while first or time.monotonic() < end and given_arguments.seed is None:
            first = False
            number = given_arguments.seed if given_arguments.seed is not None else chance.randrange(2**32)
            try:
                round_of_calls(service, api, 100, number, counts, shrink=True)
            except (AssertionError, errors.Flaky) as fault:
                print("seed %d: %s" % (number, fault))
                print(service.process.poll(), service.read_log()[-3000:])
                return 1
        code = service.stop()
    for (name, status), count in sorted(counts.items()):
        print("%-24s %d  %d" % (name, status, count))
    print("%d calls, %d operations of %d" % (sum(counts.values()), len({name for name, _ in counts}), len(api.operations)))
    return 1 if code != 0 else 0


if __name__ == "__main__":
    sys.exit(main())
