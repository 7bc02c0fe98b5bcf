"""Hypothesis strategies from JSON Schema: values according to a schema, and the same with damage."""

import copy

from hypothesis import strategies as st

ODD = [None, True, False, 0, -1, 1e308, -1e308, 1e-308, 10**25, "", "NaN", "\0", "\u2028", "é" * 40, "x" * 5000, [], {},
       [[]], [1e9] * 50, {"": None}, "2020-13-40", [None, None], -0.0, 2**53 + 1]
NUMBERS = [0, 1, -1, 0.1, 0.5, 1.4, 2, 3, 10, 100, 1e-3, 1e-9, 1e6]
WORDS = st.text(st.characters(blacklist_categories=("Cs",)), max_size=12)


class Values:
    """Strategies for the schemas of one document."""

    def __init__(self, document):
        self.document = document
        self.known = {}

    def of(self, schema, depth=0):
        """The strategy of a schema, always the same object: hypothesis spends most of its time on new ones."""
        key = (id(schema), min(depth, 4))
        if key not in self.known:
            # The schema is stored too, so that no other object gets its id.
            self.known[key] = (schema, self.made(schema, depth))
        return self.known[key][1]

    def made(self, schema, depth):
        if not isinstance(schema, dict):
            return st.none()
        if "$ref" in schema:
            return self.reference(schema["$ref"], depth)
        if "const" in schema:
            return st.just(schema["const"])
        if "enum" in schema:
            return st.sampled_from(schema["enum"])
        for several in ("oneOf", "anyOf"):
            if several in schema:
                return self.one_of(schema, several, depth)
        kind = schema.get("type", "object" if "properties" in schema else "string")
        if isinstance(kind, list):
            return st.one_of([self.of({**schema, "type": one}, depth) for one in kind])
        given = schema.get("examples", []) + ([schema["default"]] if "default" in schema else [])
        made = getattr(self, kind)(schema, depth) if kind != "null" else st.none()
        # The document's own examples get a third of the attempts.
        return st.one_of(made, made, st.sampled_from(given)) if given else made

    def reference(self, name, depth):
        schema = self.document
        for part in name.split("/")[1:]:
            schema = schema[part]
        return st.deferred(lambda: self.of(schema, depth + 1))

    def one_of(self, schema, several, depth):
        beside = {key: value for key, value in schema.items() if key != several}
        branches = []
        for branch in schema[several]:
            if beside.get("properties") and "$ref" not in branch:
                branch = {**beside, **branch, "properties": {**beside["properties"], **branch.get("properties", {})},
                          "required": [*beside.get("required", []), *branch.get("required", [])]}
            elif "type" not in branch and "type" in beside and "$ref" not in branch:
                branch = {**beside, **branch}
            branches.append(self.of(branch, depth))
        return st.one_of(branches)

    def number(self, schema, _):
        low = schema.get("minimum", schema.get("exclusiveMinimum"))
        high = schema.get("maximum", schema.get("exclusiveMaximum"))
        good = [n for n in NUMBERS if (low is None or n >= low) and (high is None or n <= high)]
        edges = [n for n in (low, high) if n is not None]
        plain = st.floats(max(low, -1e3) if low is not None else -1e3, min(high, 1e3) if high is not None else 1e3)
        if low is not None and low > 1e3 or high is not None and high < -1e3:
            plain = st.floats(low, high)
        return st.one_of(st.sampled_from(good or edges or [1]), plain, st.sampled_from(edges or [1]))

    def integer(self, schema, _):
        low, high = schema.get("minimum", 0), schema.get("maximum", 100)
        return st.integers(low, max(low, min(high, low + 200)))

    def boolean(self, *_):
        return st.booleans()

    def string(self, schema, _):
        return WORDS

    def array(self, schema, depth):
        fewest = schema.get("minItems", 0)
        most = min(schema.get("maxItems", fewest + 4), fewest + (4 if depth < 3 else 1))
        return st.lists(self.of(schema.get("items", {"type": "number"}), depth + 1), min_size=fewest, max_size=most)

    def object(self, schema, depth):
        properties = schema.get("properties", {})
        required = {name: self.of(properties[name], depth + 1) for name in schema.get("required", []) if name in properties}
        optional = {name: self.of(value, depth + 1) for name, value in properties.items() if name not in required}
        fixed = st.fixed_dictionaries(required)
        if not properties and schema.get("additionalProperties", True) is not False:
            more = schema.get("additionalProperties")
            inner = self.of(more, depth + 1) if isinstance(more, dict) else st.sampled_from(NUMBERS)
            return st.dictionaries(WORDS, inner, min_size=schema.get("minProperties", 0), max_size=3)
        if not optional:
            return fixed
        # A few of the optional members at a time: with all of them nearly every object would be refused for one.
        names = st.lists(st.sampled_from(sorted(optional)), unique=True, max_size=3)
        some = names.flatmap(lambda chosen: st.fixed_dictionaries({name: optional[name] for name in chosen}))
        return st.tuples(fixed, some).map(lambda both: {**both[0], **both[1]})


def places(value, path=()):
    """The paths of all values inside a JSON value, including itself."""
    yield path
    inner = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for key, item in inner:
        yield from places(item, (*path, key))


@st.composite
def bent(draw, value):
    """The same value with one to three parts replaced, removed, doubled or extended."""
    value = copy.deepcopy(value)
    for _ in range(draw(st.integers(1, 3))):
        *way, last = draw(st.sampled_from([path for path in places(value)][:400])) or (None,)
        if last is None:
            return draw(st.sampled_from(ODD))
        inside = value
        for key in way:
            inside = inside[key]
        what = draw(st.sampled_from(["replace", "replace", "remove", "add"]))
        if what == "replace":
            inside[last] = copy.deepcopy(draw(st.sampled_from(ODD)))
        elif what == "remove":
            del inside[last]
        elif isinstance(inside, dict):
            inside[draw(st.sampled_from(["extra", "", "type", "L", "K", "method", "\0"]))] = draw(st.sampled_from(ODD))
        else:
            inside.append(copy.deepcopy(inside[last]))
    return value


@st.composite
def bent_bytes(draw, data):
    """The same bytes with some removed, inserted or changed."""
    data = bytearray(data)
    for _ in range(draw(st.integers(1, 3))):
        at = draw(st.integers(0, max(0, len(data) - 1)))
        what = draw(st.sampled_from(["cut", "put", "change"]))
        if what == "cut":
            del data[at:at + draw(st.integers(1, 20))]
        elif what == "put":
            data[at:at] = draw(st.one_of(st.binary(max_size=8), st.sampled_from([b"\n", b",", b'"', b"[[[[", b"\xff", b"\r"])))
        elif data:
            data[at] = draw(st.integers(0, 255))
    return bytes(data)
