"""Bodies of batches, their rows, and a body that is sent in pieces."""

import http.client
import json
import socket
import time

from service import FOPDT

NDJSON = {"Content-Type": "application/x-ndjson"}
CSV = {"Content-Type": "text/csv"}


def lines(count, **more):
    return "".join(json.dumps({"name": "loop %d" % i, "plant": {**FOPDT, "K": 1 + i / 1000}, "tune": [{"method": "simc"}],
                               **more}) + "\n" for i in range(count))


def rows_of(answer):
    return [json.loads(line) for line in answer.body.decode().splitlines()]


def wait_for_end(service, batch, patience=120):
    end = time.monotonic() + patience
    while True:
        shown = service.get("/v1/batches/" + batch).json
        if shown["status"] == "ended":
            return shown
        if time.monotonic() > end:
            raise AssertionError("the batch is still %s" % shown)
        time.sleep(0.02)


class Upload:
    """A chunked body that is sent in pieces."""

    def __init__(self, service, headers=NDJSON, path="/v1/batches"):
        self.socket = socket.create_connection(("127.0.0.1", service.port), timeout=60)
        head = "".join("%s: %s\r\n" % item for item in headers.items())
        self.socket.sendall(("POST %s HTTP/1.1\r\nHost: localhost\r\n%sTransfer-Encoding: chunked\r\n\r\n" % (path, head)).encode())

    def send(self, text):
        data = text.encode()
        self.socket.sendall(b"%x\r\n%s\r\n" % (len(data), data))

    def end(self):
        try:
            self.socket.sendall(b"0\r\n\r\n")
        except BrokenPipeError:
            pass  # the answer may have come earlier
        response = http.client.HTTPResponse(self.socket)
        response.begin()
        return response.status, response.read()

    def close(self):
        self.socket.close()


def amigo_batch():
    """The 134 plants of Hägglund and Åström (2004), as in bench/batch.h."""
    def lags(times, gain=1):
        product = gain
        for T in times:
            product /= T
        return {"type": "zpk", "K": product, "zeros": [], "poles": [-1 / T for T in times]}

    first = [0.02, 0.05, 0.1, 0.2, 0.3, 0.5, 0.7, 1, 1.3, 1.5, 2, 4, 6, 8, 10, 20, 50, 100, 200, 500, 1000]
    dead = [0.01, 0.02, 0.05, 0.1, 0.3, 0.5, 0.7, 0.9, 1.0]
    plants = [{"type": "fopdt", "K": 1, "T": T, "L": 1} for T in first]
    plants += [{"type": "sopdt", "K": 1, "T1": T, "T2": T, "L": 1} for T in [0.01] + first[:-1]]
    plants += [lags([1, T, T]) for T in (0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 2.0, 5.0, 10.0)]
    plants += [lags([1.0] * n) for n in (3, 4, 5, 6, 7, 8)]
    plants += [lags([1, 0.1 * i, (0.1 * i) ** 2, (0.1 * i) ** 3]) for i in range(1, 10)]
    plants += [{"type": "ipdt", "K": 1, "L": L, "T": 1 - L} for L in (0.01, 0.02, 0.05, 0.1, 0.2, 0.3, 0.5, 0.7, 0.9, 1.0)]
    plants += [{"type": "sopdt", "K": T, "T1": T, "T2": 1 - L, "L": L} for T in (1.0, 2.0, 5.0, 10.0) for L in dead]
    plants += [{"type": "zpk", "K": -0.1 * i, "zeros": [10 / i], "poles": [-1, -1, -1]} for i in range(1, 12)]
    plants += [{"type": "zpk", "K": 100 / i ** 2, "zeros": [], "poles": [-1, [-7 / i, 10 / i * 0.51 ** 0.5], [-7 / i, -10 / i * 0.51 ** 0.5]]}
               for i in range(1, 11)]
    return plants
