"""Clients of the Model Context Protocol for the tests: one starts the command, one calls the service."""

import json
import queue
import signal
import subprocess
import threading

from service import BINARY

REVISION = "2025-06-18"
HELLO = {"protocolVersion": REVISION, "capabilities": {}, "clientInfo": {"name": "test", "version": "1"}}


class StdioClient:
    """`tunewright mcp` as a process. Answers are read by a thread, so that nothing blocks a test."""

    def __init__(self):
        self.process = subprocess.Popen([BINARY, "mcp"], stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                                        stderr=subprocess.PIPE,
                                        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL))
        self.lines = queue.SimpleQueue()
        self.count = 0
        self.reader = threading.Thread(target=self._read, daemon=True)
        self.reader.start()

    def _read(self):
        for line in self.process.stdout:
            self.lines.put(line)
        self.lines.put(None)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def close(self, patience=20):
        """The exit code after the end of the input."""
        if not self.process.stdin.closed:
            self.process.stdin.close()
        try:
            return self.process.wait(patience)
        finally:
            self.process.kill()
            self.reader.join(5)
            self.process.stdout.close()
            self.process.stderr.close()

    def write(self, text):
        self.process.stdin.write(text if isinstance(text, bytes) else text.encode())
        self.process.stdin.flush()

    def send(self, message):
        self.write(json.dumps(message) + "\n")

    def read(self, patience=60):
        """The next message; None at the end of the output."""
        line = self.lines.get(timeout=patience)
        return None if line is None else json.loads(line)

    def request(self, method, params=None, patience=60):
        self.count += 1
        message = {"jsonrpc": "2.0", "id": self.count, "method": method}
        self.send(message if params is None else {**message, "params": params})
        answer = self.read(patience)
        assert answer["id"] == self.count, answer
        return answer

    def alive(self):
        return self.request("ping").get("result") == {}


class HttpClient:
    """POST /mcp of a running service."""

    def __init__(self, service, headers=None):
        self.service = service
        self.headers = headers or {}
        self.count = 0

    def post(self, body, headers=None):
        """The raw answer to a body, which is sent as JSON unless it is text or bytes."""
        return self.service.post("/mcp", body, {"Accept": "application/json, text/event-stream",
                                                "MCP-Protocol-Version": REVISION, **self.headers, **(headers or {})})

    def request(self, method, params=None, patience=60):
        self.count += 1
        message = {"jsonrpc": "2.0", "id": self.count, "method": method}
        answer = self.post(message if params is None else {**message, "params": params})
        assert answer.status == 200, (answer.status, answer.body)
        assert answer.json["id"] == self.count
        return answer.json

    def alive(self):
        return self.request("ping").get("result") == {}


def call(client, tool, arguments=None):
    """The result of a tool."""
    params = {"name": tool} if arguments is None else {"name": tool, "arguments": arguments}
    answer = client.request("tools/call", params)
    assert "result" in answer, answer
    return answer["result"]


def text_of(result):
    return "".join(part["text"] for part in result["content"])
