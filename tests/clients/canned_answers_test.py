"""The Python client with answers that are refused, cut off or missing: the server gives prepared answers."""

import email
import http.server
import json
import os
import pathlib
import sys
import tempfile
import threading
import unittest

from service import ROOT

sys.path.insert(0, str(ROOT / "api" / "clients" / "python"))
import tunewright  # noqa: E402

BUSY = (429, {"Retry-After": "1"}, {"title": "Too Many Requests", "status": 429, "detail": "The queue is full."})
AGAIN = (503, {"Retry-After": "0"}, {"title": "Service Unavailable", "status": 503, "detail": "Being stopped."})
DONE = {"id": "j", "status": "succeeded", "result": {"controllers": [{"method": "simc"}], "ranking": [0]}}
CUT = None  # the connection ends without an answer


class Canned(http.server.BaseHTTPRequestHandler):
    protocol_version = "HTTP/1.1"

    def answer(self):
        self.server.calls.append((self.command, self.path, dict(self.headers),
                                  self.rfile.read(int(self.headers.get("Content-Length", 0)))))
        given = self.server.answers.pop(0)
        self.close_connection = True
        if given is CUT:
            return
        status, headers, body = given
        data = body if isinstance(body, bytes) else json.dumps(body).encode()
        self.send_response(status)
        for name, value in {"Content-Length": str(len(data)), "Connection": "close", **headers}.items():
            self.send_header(name, value)
        self.end_headers()
        self.wfile.write(data)

    do_GET = do_POST = do_DELETE = answer

    def log_message(self, *_):
        pass


class CannedTest(unittest.TestCase):
    def serve(self, *answers, timeout=30):
        """A client of a server that gives these answers one after the other; its calls are in self.server.calls."""
        self.server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Canned)
        self.server.answers, self.server.calls = list(answers), []
        threading.Thread(target=self.server.serve_forever, args=(0.01,), daemon=True).start()
        self.addCleanup(self.server.server_close)
        self.addCleanup(self.server.shutdown)
        return tunewright.Client("http://127.0.0.1:%d" % self.server.server_port, timeout=timeout)

    def test_a_service_without_room_is_asked_again_with_the_same_key(self):
        client = self.serve(AGAIN, BUSY, (200, {}, DONE))
        self.assertEqual(client.run({})["ranking"], [0])
        keys = [headers["Idempotency-Key"] for _, _, headers, _ in self.server.calls]
        self.assertEqual(keys, keys[:1] * 3)

    def test_where_there_is_no_time_the_refusal_is_told(self):
        late = (429, {"Retry-After": "60"}, BUSY[2])
        with self.assertRaisesRegex(tunewright.Problem, "The queue is full") as caught:
            self.serve(late, timeout=5).run({})
        self.assertEqual((caught.exception.status, len(self.server.calls)), (429, 1))

    def test_a_restart_between_two_looks_at_a_job_is_waited_for(self):
        client = self.serve((202, {}, {"id": "j", "status": "queued"}), CUT, (200, {}, DONE))
        self.assertEqual(client.run({}).best["method"], "simc")
        self.assertEqual([path for _, path, _, _ in self.server.calls], ["/v1/jobs", "/v1/jobs/j", "/v1/jobs/j"])

    def test_rows_go_on_where_they_were_cut_off(self):
        row = [json.dumps({"index": i}).encode() + b"\n" for i in range(3)]
        whole = str(sum(map(len, row)))
        client = self.serve((202, {}, {"id": "b", "total": 3}), (200, {"Content-Length": whole}, row[0] + row[1][:5]),
                            (200, {}, row[1]), (200, {}, row[2]))
        told = []
        rows = list(client.batch([{"name": "a"}, {}, {}], lambda done, total: told.append(done)))
        self.assertEqual([each["index"] for each in rows], [0, 1, 2])
        self.assertEqual(told, [1, 2, 3])
        self.assertEqual([path[-6:] for _, path, _, _ in self.server.calls[1:]], ["from=0", "from=1", "from=2"])
        self.assertEqual(self.server.calls[0][3], b'{"name": "a"}\n{}\n{}\n')

    def check_of(self, source, answer=None, total=1, **rest):
        answer = answer or {"loops": [{"tag": "A"}, {"tag": "B"}], "ranking": [{"loop": 1}, {"loop": 0}], "complete": True}
        rows = b"".join(json.dumps({"index": i}).encode() + b"\n" for i in range(total))
        client = self.serve((202, {}, {"id": "b", "total": total}), (200, {}, rows), (200, {}, answer), (200, {}, answer))
        return client, client.check(source, **rest)

    def test_a_check_of_a_file_is_a_batch(self):
        told = []
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder, "plant.csv")
            path.write_bytes("t,A.PV [°C],A.OP\n".encode("cp1252"))
            client, check = self.check_of(path, progress=lambda *at: told.append(at), name="unit 7",
                                          units={"time": "min"}, total=2)
            posted = self.server.calls[0]
            self.assertEqual(posted[:2], ("POST", "/v1/batches?kind=check&name=unit+7&units.time=min"))
            self.assertEqual(self.parts_posted(), [("file", "plant.csv", path.read_bytes())])
        self.assertEqual([path for _, path, _, _ in self.server.calls[1:]],
                         ["/v1/batches/b/results?follow=true&from=0", "/v1/batches/b/check"])
        self.assertEqual(told, [(1, 2), (2, 2)])
        self.assertEqual([loop["tag"] for loop in check.work_list], ["B", "A"])
        client.changes("old", check)
        self.assertEqual(self.server.calls[-1][1], "/v1/batches/b/check?before=old")
        self.server.answers.append((200, {}, b"<html>"))
        self.assertEqual(client.report_html(check), "<html>")
        self.assertEqual(self.server.calls[-1][1], "/v1/batches/b/report.html")
        with self.assertRaisesRegex(LookupError, "a batch, b"):
            client.code(check, "c")

    def parts_posted(self):
        """The parts of the form of the first call: name, file, bytes."""
        _, _, headers, body = self.server.calls[0]
        head = "MIME-Version: 1.0\r\nContent-Type: %s\r\n\r\n" % headers["Content-Type"]
        return [(part.get_param("name", header="Content-Disposition"), part.get_filename(), part.get_payload(decode=True))
                for part in email.message_from_bytes(head.encode() + body).get_payload()]

    def test_a_check_of_a_folder_posts_its_files(self):
        with tempfile.TemporaryDirectory() as folder:
            for name in ("FIC2.csv", "FIC1.CSV", "notes.pdf"):
                pathlib.Path(folder, name).write_text("t,y,u\n")
            self.check_of(folder, total=2, settings=True)
            parts = [("file", "FIC1.CSV", b"t,y,u\n"), ("file", "FIC2.csv", b"t,y,u\n")]
            self.assertEqual(self.parts_posted(), parts)
            self.assertEqual(self.server.calls[0][1], "/v1/batches?kind=check&settings=true")
            self.check_of([os.path.join(folder, "FIC2.csv")])
            self.assertEqual(self.parts_posted(), parts[1:])
        with tempfile.TemporaryDirectory() as empty, self.assertRaisesRegex(FileNotFoundError, "no file that ends"):
            self.serve().check(empty)

    def test_a_check_of_a_frame_sends_its_columns(self):
        class Frame:
            index = None

            def to_csv(self, index, index_label):
                return "t,A.PV,A.OP\n"

        Frame.index = type("RangeIndex", (), {"name": None})
        self.check_of(Frame())
        self.assertEqual(self.server.calls[0][1], "/v1/batches?kind=check")
        self.assertEqual(self.parts_posted(), [("file", None, b"t,A.PV,A.OP\n")])

    def test_what_is_known_of_loops_is_a_part_of_the_form(self):
        class Table:
            columns = ["kind"]

            def to_csv(self, index_label):
                return index_label + ",kind\nA,flow\n"

        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder, "A.csv")
            path.write_text("t,y,u\n")
            table = pathlib.Path(folder, "table")
            table.write_text("tag\nA\n")
            for loops, text in (({"A": {"kind": "flow", "Ti": 2.5}, "B,1": {"averaging": True, "Ti": None}},
                                 b'tag,kind,Ti,averaging\r\nA,flow,2.5,\r\n"B,1",,,True\r\n'),
                                (Table(), b"tag,kind\nA,flow\n"), (table, b"tag\nA\n")):
                self.check_of(path, loops=loops)
                self.assertEqual(self.parts_posted()[0], ("loops", "loops.csv", text))
        with self.assertRaisesRegex(TypeError, "loops is for files"):
            self.serve().check([{"tag": "A"}], loops={})

    def test_a_design_that_a_cancelled_search_had_is_kept(self):
        ended = {**DONE, "status": "cancelled", "partial": True}
        with self.assertRaisesRegex(tunewright.Problem, "Job j was cancelled") as caught:
            self.serve((200, {}, ended)).run({})
        self.assertEqual(caught.exception.result.best["method"], "simc")
        self.assertTrue(caught.exception.result.job["partial"])

    def test_a_proxys_page_is_a_problem_too(self):
        with self.assertRaisesRegex(tunewright.Problem, "Bad Gateway: http://127.0.0.1") as caught:
            self.serve((502, {"Content-Type": "text/html"}, b"<html>")).get("/v1/methods")
        self.assertEqual(caught.exception.status, 502)

    def test_a_service_that_is_not_there_is_told_at_once(self):
        client = self.serve()
        self.server.shutdown()
        self.server.server_close()
        with self.assertRaisesRegex(ConnectionError, "No answer from http://127.0.0.1:[0-9]+ .*Is the service running"):
            client.run({})

    def test_what_is_no_json_is_named(self):
        with self.assertRaisesRegex(TypeError, "A set cannot be sent"):
            tunewright.Client("http://127.0.0.1:9").run({"plant": {1, 2}})


if __name__ == "__main__":
    unittest.main()
