"""Batches with failures: a killed service, a stop amid uploads, a full queue, bodies that are too large."""

import json
import socket
import tempfile
import time
import unittest

from batch_bodies import NDJSON, Upload, lines, rows_of, wait_for_end
from service import LONG, QUICK, Service


class BatchFaultsTest(unittest.TestCase):
    def test_a_killed_service_ends_its_batches_after_the_next_start(self):
        with tempfile.TemporaryDirectory() as folder:
            store = folder + "/jobs.db"
            service = Service("--workers", "2", store=store)
            batch = service.post("/v1/batches", lines(3000), NDJSON).json["id"]
            upload = Upload(service, path="/v1/batches?name=broken")
            upload.send(lines(2000))
            end = time.monotonic() + 30
            while len(service.get("/v1/batches").json["batches"]) < 2:
                self.assertLess(time.monotonic(), end)
                time.sleep(0.01)
            for _ in range(3):
                while service.get("/v1/batches/" + batch).json["counts"]["running"] == 0:
                    if service.get("/v1/batches/" + batch).json["status"] == "ended":
                        break
                service.kill()
                service.start()
            upload.close()
            wait_for_end(service, batch)
            rows = rows_of(service.get("/v1/batches/%s/results?follow=true" % batch))
            self.assertEqual([row["index"] for row in rows], list(range(3000)))
            self.assertEqual({row["status"] for row in rows}, {"succeeded"})
            self.assertEqual([one["id"] for one in service.get("/v1/batches").json["batches"]], [batch])
            self.assertEqual(service.stop(), 0)
            service.folder.cleanup()

    def test_a_stop_amid_uploads_and_followers_is_clean(self):
        with tempfile.TemporaryDirectory() as folder:
            service = Service("--workers", "2", "--drain-timeout", "0", store=folder + "/jobs.db")
            uploads = [Upload(service) for _ in range(3)]
            for upload in uploads:
                upload.send(lines(3000))
            batch = service.post("/v1/batches", "".join(json.dumps(LONG) + "\n" for _ in range(20)), NDJSON).json["id"]
            follower = socket.create_connection(("127.0.0.1", service.port), timeout=60)
            follower.sendall(("GET /v1/batches/%s/results?follow=true HTTP/1.1\r\nHost: localhost\r\n\r\n" % batch).encode())
            self.assertEqual(service.stop(), 0, service.read_log()[-2000:])
            for connection in [follower] + [upload.socket for upload in uploads]:
                connection.close()
            service.start()
            self.assertEqual([one["id"] for one in service.get("/v1/batches").json["batches"]], [batch])
            service.post("/v1/batches/%s/cancel" % batch, "")
            wait_for_end(service, batch)
            self.assertEqual(service.stop(), 0)
            service.folder.cleanup()

    def test_a_full_queue_of_entries_is_429_and_keeps_nothing(self):
        with Service("--workers", "1", "--entry-limit", "1000") as service:
            answer = service.post("/v1/batches", "".join(json.dumps(LONG) + "\n" for _ in range(2000)), NDJSON)
            self.assertEqual(answer.status, 429, answer.body)
            self.assertIn("Retry-After", answer.headers)
            self.assertEqual(service.get("/v1/batches").json["batches"], [])

    def test_what_is_too_large_is_refused(self):
        with Service("--max-body", "1", "--max-batch-body", "2") as service:
            big = json.dumps({**QUICK, "name": "x" * 1_200_000})
            batch = service.post("/v1/batches", big + "\n" + lines(1), NDJSON)
            self.assertEqual(batch.status, 202, batch.body)
            rows = rows_of(service.get("/v1/batches/%s/results?follow=true" % batch.json["id"]))
            self.assertEqual(rows[0]["error"]["status"], 413)
            self.assertEqual(rows[1]["status"], "succeeded")
            self.assertEqual(service.post("/v1/batches", lines(30_000), NDJSON).status, 413)
            self.assertEqual(len(service.get("/v1/batches").json["batches"]), 1)


if __name__ == "__main__":
    unittest.main()
