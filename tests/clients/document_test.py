"""Requirements of client generators on /openapi.json: a name for every type, and a schema for every value."""

import re
import unittest

from service import Service

METHODS = {"get", "put", "post", "delete", "patch", "head", "options"}
SHAPES = {"type", "$ref", "oneOf", "anyOf", "allOf", "const", "enum"}


def operations(document):
    for part in ("paths", "webhooks"):
        for path, item in document[part].items():
            for method in METHODS & item.keys():
                yield "%s %s" % (method.upper(), path), item[method]


def schemas(value, place=""):
    """Every schema of the document with its place; examples and defaults are values, not schemas."""
    if isinstance(value, list):
        for i, each in enumerate(value):
            yield from schemas(each, "%s/%d" % (place, i))
    elif isinstance(value, dict):
        parent = place.rsplit("/", 1)[-1]
        within = place.rsplit("/", 2)[-2:]
        if parent in ("schema", "items", "additionalProperties") or within[0] in ("oneOf", "anyOf", "allOf") or (
                within[0] in ("schemas", "properties")):
            yield place, value
        for name, each in value.items():
            if parent == "properties" or name not in ("example", "examples", "default", "const", "enum", "not"):
                yield from schemas(each, "%s/%s" % (place, name.replace("/", "~1")))


class DocumentTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        with Service() as service:
            cls.document = service.get("/openapi.json").json

    def test_every_operation_has_a_name_a_sentence_and_a_known_tag(self):
        tags = {tag["name"] for tag in self.document["tags"]}
        names = []
        for where, operation in operations(self.document):
            self.assertRegex(operation["operationId"], r"^[a-z][A-Za-z]*$", where)
            self.assertTrue(operation["summary"] and not operation["summary"].endswith("."), where)
            self.assertTrue(operation["tags"] and set(operation["tags"]) <= tags, where)
            self.assertTrue([status for status in operation["responses"] if status.startswith("2")], where)
            names.append(operation["operationId"].lower())
        self.assertEqual(len(names), len(set(names)))
        self.assertGreater(len(names), 35)

    def test_what_it_is_where_it_is_and_under_which_licence(self):
        self.assertRegex(self.document["openapi"], r"^3\.1\.")
        self.assertTrue(self.document["servers"])
        info = self.document["info"]
        self.assertTrue(info["title"] and info["description"] and info["version"] and info["license"]["identifier"])

    def test_names_stay_apart_as_identifiers(self):
        names = list(self.document["components"]["schemas"])
        folded = {re.sub(r"[^a-z0-9]", "", name.lower()) for name in names}
        self.assertEqual(len(folded), len(names))

    def test_no_value_is_without_a_shape(self):
        found = list(schemas(self.document))
        self.assertGreater(len(found), 1000)
        self.assertEqual([place for place, schema in found if not SHAPES & schema.keys()], [])
        bare = [place for place, schema in found if schema.get("type") == "object"
                and not {"properties", "additionalProperties"} & schema.keys()]
        self.assertEqual(bare, [])
        self.assertEqual([place for place, schema in found if schema.get("type") == "array" and "items" not in schema],
                         [])


if __name__ == "__main__":
    unittest.main()
