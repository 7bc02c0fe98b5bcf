"""A receiver of notifications: an HTTP server on loopback, and the signature that it expects."""

import base64
import contextlib
import hashlib
import hmac
import http.server
import json
import threading
import time


class Receiver:
    """Receives notifications on loopback and gives prepared answers: `answers` has a status, or status and headers,
    for each call in turn, then 204. It waits for `hold` before an answer."""

    def __init__(self, answers=(), port=0, tls=None):
        self.notes, self.answers = [], list(answers)
        self.arrived = threading.Condition()
        self.hold = threading.Event()
        self.hold.set()
        receiver = self

        class Handler(http.server.BaseHTTPRequestHandler):
            protocol_version = "HTTP/1.1"

            def do_POST(self):
                body = self.rfile.read(int(self.headers["Content-Length"]))
                with receiver.arrived:
                    receiver.notes.append((time.monotonic(), self.path, dict(self.headers.items()), body))
                    answer = receiver.answers.pop(0) if receiver.answers else 204
                    receiver.arrived.notify_all()
                receiver.hold.wait(60)
                status, headers = answer if isinstance(answer, tuple) else (answer, {})
                with contextlib.suppress(OSError):
                    self.send_response(status)
                    for name, value in headers.items():
                        self.send_header(name, value)
                    if status != 204:
                        self.send_header("Content-Length", "0")
                    self.end_headers()

            def log_message(self, *_):
                pass

        self.server = http.server.ThreadingHTTPServer(("127.0.0.1", port), Handler)
        self.server.handle_error = lambda *_: None
        self.server.daemon_threads = True
        if tls:
            self.server.socket = tls.wrap_socket(self.server.socket, server_side=True)
        self.origin = "%s://127.0.0.1:%d" % ("https" if tls else "http", self.server.server_address[1])
        threading.Thread(target=self.server.serve_forever, daemon=True).start()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.hold.set()
        self.server.shutdown()
        self.server.server_close()

    def wait_for(self, count, patience=30):
        with self.arrived:
            if not self.arrived.wait_for(lambda: len(self.notes) >= count, patience):
                raise AssertionError("%d notes of %d" % (len(self.notes), count))
        return self.notes

    def note(self, patience=30):
        """The only notification, as JSON, after enough time for a second one."""
        self.wait_for(1, patience)
        time.sleep(1.5)
        if len(self.notes) != 1:
            raise AssertionError("%d notes" % len(self.notes))
        return json.loads(self.notes[0][3])


def signature(secret, headers, body):
    key = base64.b64decode(secret.removeprefix("whsec_"))
    text = b".".join([headers["webhook-id"].encode(), headers["webhook-timestamp"].encode(), body])
    return "v1," + base64.b64encode(hmac.new(key, text, hashlib.sha256).digest()).decode()
