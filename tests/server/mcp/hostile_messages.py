"""Messages and arguments that are wrong on purpose: types, sizes, depth, bytes, and names as attackers send them."""

import json

NAMES = ["", " ", "tune ", "TUNE", "<script>alert(1)</script>", "../../etc/passwd", "..%2f..%2fetc%2fpasswd", "\u0000",
         "tune\u0000", "'; DROP TABLE jobs; --", "1 OR 1=1", "$(id)", "`id`", "${jndi:ldap://x/a}", "%s%n%x", "\r\nX: y",
         "\u202etxet", "\ud7ff\ue000\uffff", "𝕥𝕦𝕟𝕖", "a" * 5000, "__proto__", "constructor", "file:///etc/passwd",
         "tunewright://answer/1", "-1", "0", "null", "true", "~0~1", "/", "//", "{{7*7}}"]
VALUES = [None, True, False, 0, -1, 1.5, 10 ** 18, -10 ** 18, 1e308, "", "text", "10 s", [], [[]], [None], {}, {"a": {}},
          list(range(200)), "x" * 20000, "\u0000", "<img src=x onerror=alert(1)>", "/etc/passwd", "../../etc/passwd"]
IDS = [None, True, 1.5, [], {}, [1], {"a": 1}, "x" * 5000]


def request(method, params=None, id_=1):
    message = {"jsonrpc": "2.0", "id": id_, "method": method}
    return message if params is None else {**message, "params": params}


def tool_call(name, arguments=None):
    return request("tools/call", {"name": name} if arguments is None else {"name": name, "arguments": arguments})


def messages():
    """JSON values that are no right message, or a message about something that does not exist."""
    yield from (value for value in VALUES if not isinstance(value, dict) or value)
    yield from (request("ping", id_=id_) for id_ in IDS)
    for version in ("1.0", 2, 2.0, None, "2", [], {}):
        yield {"jsonrpc": version, "id": 1, "method": "ping"}
    yield {"id": 1, "method": "ping"}
    yield {"jsonrpc": "2.0", "id": 1}
    for method in VALUES:
        yield request(method)
    for name in NAMES:
        yield request(name)
        yield request("tools/call", {"name": name})
        yield request("resources/read", {"uri": name})
        yield request("resources/read", {"uri": "tunewright://answer/" + name})
    for value in VALUES:
        yield request("tools/call", value)
        yield request("tools/call", {"name": value})
        yield request("initialize", {"protocolVersion": value})
        yield request("resources/read", {"uri": value})
        yield {"jsonrpc": "2.0", "method": "notifications/cancelled", "params": {"requestId": value}}
    yield [request("ping")] * 11
    yield [[request("ping")]]


def arguments(tools):
    """Calls of real tools with wrong arguments: (tool, arguments)."""
    for tool in tools:
        members = list(tool["inputSchema"]["properties"])
        for value in VALUES:
            if value is not None and not isinstance(value, dict):
                yield tool["name"], value
        for i, name in enumerate(NAMES):
            yield tool["name"], {name: 1}
            yield tool["name"], {members[i % len(members)]: name}
        for member in members:
            for value in VALUES[::3]:
                yield tool["name"], {member: value}


def nested(depth):
    """Brackets that are no message, and one whose arguments are nested."""
    yield b"[" * depth
    yield b"[" * depth + b"]" * depth
    yield b'{"a":' * depth + b"1" + b"}" * depth
    yield (b'{"jsonrpc":"2.0","id":7,"method":"tools/call","params":{"name":"tune","arguments":' + b'{"a":' * depth +
           b"1" + b"}" * depth + b"}}")


def texts():
    """Lines of bytes that are no message."""
    good = json.dumps(tool_call("tune", {"plant": {"type": "fopdt", "K": 2, "T": 10, "L": 3}})).encode()
    for cut in range(0, len(good), 5):
        yield good[:cut] or b"{"
    for word in (b"NaN", b"Infinity", b"-Infinity", b"1e999", b"-1e999", b"0x10", b"01", b"1.", b".5", b"+1", b"undefined",
                 b"'2'", b"2,", b'"\\ud800"', b'"\xff"', b'"\xc0\x80"', b'"\xed\xa0\x80"', b'"\x01"', b'"\t"', b"2}}}}"):
        yield good.replace(b'"K": 2', b'"K": ' + word)
    yield good.replace(b'"K": 2', b'"K": 2, "K": 3')
    yield b"\xef\xbb\xbf\xef\xbb\xbf" + good
    yield good.decode().encode("utf-16-le").replace(b"\n", b"")
    yield b"\x00" * 100
    yield bytes(range(11, 256))
    yield b"Content-Length: 5"
    yield b"GET / HTTP/1.1"
    for depth in (33, 1000, 100000):
        yield from nested(depth)
    yield b'{"jsonrpc":"2.0","id":1,"method":"' + b"m" * 100000 + b'"}'
    yield b'{"jsonrpc":"2.0","id":1,"method":"ping","params":{' + b",".join(b'"m%d":1' % i for i in range(2000)) + b"}}"
