"""The contract that was released does not break: docs/stability.md.

tests/data/contract/released.txt has the names of /openapi.json: a line for each call and each type, with its parts. A part
is `name!kinds` (required) or `name?kinds`, with `=default` behind it. What was added since passes; add it to the file at a
release with

    /usr/bin/python3 tests/clients/contract_test.py --add      # the binary of TUNEWRIGHT_BIN or build/release"""

import json
import pathlib
import sys
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests" / "server"))
from service import Service  # noqa: E402

RELEASED = ROOT / "tests" / "data" / "contract" / "released.txt"
METHODS = ("get", "put", "post", "delete", "patch")


class Contract:
    """Calls and types of a description: {place: {part: (required, kinds, default)}}, and which are read or written."""

    def __init__(self, document):
        self.parts, self.requests, self.answers = {}, set(), set()
        self.document = document
        self.inside = None
        for group in ("paths", "webhooks"):
            for path, item in document.get(group, {}).items():
                for method in METHODS:
                    if method in item:
                        self.call("%s %s" % (method.upper(), path), item[method], item.get("parameters", []))

    def resolved(self, value):
        while "$ref" in value:
            place = self.document
            for name in value["$ref"][2:].split("/"):
                place = place[name.replace("~1", "/")]
            value = place
        return value

    def call(self, place, operation, shared):
        parts = self.parts.setdefault(place, {"operation": (True, {operation["operationId"]}, None)})
        for parameter in map(self.resolved, [*shared, *operation.get("parameters", [])]):
            name = "%s:%s" % (parameter["in"], parameter["name"])
            kinds = self.kinds(place + " " + name, parameter["schema"], self.requests)
            parts[name] = (parameter.get("required", False), kinds, parameter["schema"].get("default"))
        body = self.resolved(operation.get("requestBody", {}))
        for media, content in body.get("content", {}).items():
            kinds = self.kinds(place + " body", content.get("schema", {}), self.requests)
            parts["body:" + media] = (body.get("required", False), kinds, None)
        for status, answer in operation.get("responses", {}).items():
            for media, content in self.resolved(answer).get("content", {"": {}}).items():
                kinds = self.kinds(place + " " + status, content.get("schema", {}), self.answers)
                parts[("%s:%s" % (status, media)).rstrip(":")] = (True, kinds, None)

    def kinds(self, place, schema, used):
        """The kinds of value that a schema allows; types that it names are described on the way."""
        if "$ref" in schema:
            name = schema["$ref"].rsplit("/", 1)[-1]
            if name not in used:
                used.add(name)
                self.kinds(name, self.resolved(schema), used)
            return {name}
        found = set()
        for one in [*schema.get("oneOf", []), *schema.get("anyOf", []), *schema.get("allOf", [])]:
            found |= self.kinds(place, one, used)
        if "const" in schema or "enum" in schema:
            return found | {json.dumps(value) for value in schema.get("enum", [schema.get("const")])}
        types = schema.get("type", [])
        for kind in [types] if isinstance(types, str) else types:
            if kind == "array":
                found |= {"[%s]" % one for one in self.kinds(place + "[]", schema.get("items", {}), used)} or {"[]"}
            else:
                found.add(kind)
        if "properties" in schema or isinstance(schema.get("additionalProperties"), dict):
            self.properties(place, schema, used)
            found = {place if kind == "object" else kind for kind in found}
        return found

    def properties(self, place, schema, used):
        used.add(place)
        parts = self.parts.setdefault(place, {})
        fields = dict(schema.get("properties", {}))
        if isinstance(schema.get("additionalProperties"), dict):
            fields["*"] = schema["additionalProperties"]
        for name, field in fields.items():
            required, kinds = name in schema.get("required", []), self.kinds("%s.%s" % (place, name), field, used)
            if name in parts:  # of another alternative at the same place
                required, kinds = required and parts[name][0], kinds | parts[name][1]
            parts[name] = (required, kinds, field.get("default"))

    def lines(self):
        for place, parts in sorted(self.parts.items()):
            words = [name + ("!" if required else "?") + "|".join(sorted(kinds)) +
                     ("" if default is None else "=" + json.dumps(default, sort_keys=True))
                     for name, (required, kinds, default) in sorted(parts.items())]
            yield "\t".join([place, *words])


def read(lines):
    """The lines as {place: {part: (required, kinds, default)}}."""
    places = {}
    for line in lines:
        place, *words = line.rstrip("\n").split("\t")
        parts = places.setdefault(place, {})
        for word in words:
            mark = min(i for i in (word.find("!"), word.find("?")) if i >= 0)
            kinds, found, default = word[mark + 1:].partition("=")
            parts[word[:mark]] = (word[mark] == "!", set(kinds.split("|")), default if found else None)
    return places


def broken(old, new, requests, answers):
    """One sentence for each part of the contract that does not hold any more."""
    for place, parts in old.items():
        if place not in new:
            yield "%s is gone" % place
            continue
        written, shown = " " in place or place in requests, " " in place or place in answers
        for name, (required, kinds, default) in parts.items():
            where = "%s, %s" % (place, name)
            if name not in new[place]:
                yield where + " is gone"
                continue
            now_required, now_kinds, now_default = new[place][name]
            if kinds - now_kinds - (set() if written else {"null"}):
                yield "%s no longer is %s" % (where, " or ".join(sorted(kinds - now_kinds)))
            if shown and not written and "null" in now_kinds - kinds:
                yield where + " may be null now"
            if written and now_required and not required:
                yield where + " is required now"
            if shown and required and not now_required:
                yield where + " may be missing now"
            if default != now_default and default is not None:
                yield "%s has the default %s, no longer %s" % (where, now_default, default)
        if written:
            for name in new[place].keys() - parts.keys():
                if new[place][name][0] and (place in requests or name.startswith(("query:", "body:"))):
                    yield "%s, %s is new and required" % (place, name)


class ContractTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        with Service() as service:
            cls.contract = Contract(service.get("/openapi.json").json)
        cls.new = read(cls.contract.lines())

    def broken(self, old, new):
        return list(broken(old, new, self.contract.requests, self.contract.answers))

    def test_what_was_released_is_still_there(self):
        old = read(RELEASED.read_text().splitlines())
        self.assertGreater(len(old), 300)
        self.assertEqual(self.broken(old, self.new), [], "docs/stability.md says what may change")

    def test_each_kind_of_break_is_seen(self):
        old = {"Fopdt": {"K": (True, {"number"}, None), "L": (False, {"number"}, "0")},
               "JobSummary": {"id": (True, {"string"}, None), "name": (True, {"string"}, None)},
               "GET /v1/jobs": {"query:status": (False, {'"queued"', '"failed"'}, None)}}

        def change(place, part, value):
            return {**old, place: {**old[place], part: value}}

        self.assertEqual(self.broken(old, old), [])
        self.assertEqual(self.broken(old, change("Fopdt", "more", (False, {"number"}, None))), [])
        self.assertEqual(self.broken(old, change("JobSummary", "more", (True, {"string"}, None))), [])
        self.assertEqual(self.broken(old, {**old, "GET /v1/more": {}}), [])
        without = {place: {name: part for name, part in parts.items() if name != "K"} for place, parts in old.items()}
        breaks = [{place: parts for place, parts in old.items() if place != "GET /v1/jobs"}, without,
                  change("Fopdt", "K", (True, {"string"}, None)), change("Fopdt", "L", (True, {"number"}, "0")),
                  change("Fopdt", "L", (False, {"number"}, "1")), change("Fopdt", "more", (True, {"number"}, None)),
                  change("JobSummary", "id", (False, {"string"}, None)), change("JobSummary", "id", (True, {"string", "null"}, None)),
                  change("GET /v1/jobs", "query:status", (False, {'"queued"'}, None)),
                  change("GET /v1/jobs", "query:more", (True, {"string"}, None))]
        for new in breaks:
            self.assertEqual(len(self.broken(old, new)), 1, new)


def add():
    """Writes the present names over the file, if they break nothing."""
    with Service() as service:
        contract = Contract(service.get("/openapi.json").json)
    lines = list(contract.lines())
    if RELEASED.exists():
        faults = list(broken(read(RELEASED.read_text().splitlines()), read(lines), contract.requests, contract.answers))
        if faults:
            sys.exit("\n".join(["Not written, because this breaks the contract:", *faults]))
    RELEASED.write_text("\n".join(lines) + "\n")
    print("%d calls and types" % len(lines))


if __name__ == "__main__":
    if sys.argv[1:] == ["--add"]:
        add()
    else:
        unittest.main()
