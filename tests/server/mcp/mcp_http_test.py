"""POST /mcp: the same tools behind the keys, limits and slots of every other call."""

import json
import os
import subprocess
import tempfile
import unittest

from mcp_clients import HELLO, HttpClient, call, text_of
from service import BINARY, FOPDT, LONG, QUICK, Service

TUNE = {"plant": "2 e^(-3s)/(10s+1)", "tune": [{"method": "robust", "Ms": 1.4}]}
PING = {"jsonrpc": "2.0", "id": 1, "method": "ping"}


class McpHttpTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.service = Service("--max-body", "1MiB")

    @classmethod
    def tearDownClass(cls):
        cls.service.stop()

    def setUp(self):
        self.client = HttpClient(self.service)

    def test_a_request_is_answered_and_a_notification_accepted(self):
        answer = self.client.post({"jsonrpc": "2.0", "id": 1, "method": "initialize", "params": HELLO})
        self.assertEqual((answer.status, answer.media_type), (200, "application/json"))
        self.assertEqual(answer.json["result"]["protocolVersion"], "2025-06-18")
        self.assertNotIn("Mcp-Session-Id", answer.headers)
        answer = self.client.post({"jsonrpc": "2.0", "method": "notifications/initialized"})
        self.assertEqual((answer.status, answer.body), (202, b""))
        answer = self.client.post({"jsonrpc": "2.0", "id": 9, "result": {}})
        self.assertEqual((answer.status, answer.body), (202, b""))

    def test_there_is_neither_a_stream_nor_a_session(self):
        for method in ("GET", "DELETE", "PUT"):
            answer = self.service.call(method, "/mcp")
            self.assertEqual(answer.status, 405, method)
            self.assertIn("POST", answer.headers["Allow"])

    def test_the_header_of_the_revision(self):
        for revision, status in (("2025-06-18", 200), ("2025-03-26", 200), ("2024-11-05", 200), ("2019-01-01", 400),
                                 ("x" * 300, 400)):
            answer = self.client.post(PING, {"MCP-Protocol-Version": revision})
            self.assertEqual(answer.status, status, revision[:20])
        self.assertIn("2025-06-18", answer.json["error"]["message"])
        # A client of the revision 2025-03-26 does not send it.
        self.assertEqual(self.service.post("/mcp", PING).status, 200)

    def test_any_accept_field_gets_json(self):
        for accept in ("application/json", "text/event-stream", "*/*", "text/html", "application/json, text/event-stream"):
            answer = self.service.post("/mcp", PING, {"Accept": accept})
            self.assertEqual((answer.status, answer.media_type), (200, "application/json"), accept)

    def test_bodies_that_are_no_message(self):
        for body, code in (("", -32700), ("{", -32700), ("[]", -32600), ("7", -32600), ('{"id":1}', -32600)):
            answer = self.client.post(body)
            self.assertEqual((answer.status, answer.json["error"]["code"]), (400, code), body)
        self.assertEqual(self.client.post("x=1", {"Content-Type": "text/plain"}).status, 415)
        self.assertEqual(self.client.post(b" " * (2 << 20)).status, 413)

    def test_the_id_of_a_message_with_a_number_that_is_none_is_found(self):
        answer = self.client.post('{"jsonrpc":"2.0", "params":{"id":3, "x":"\\"id\\":4"}, "id" : 17 ,"method":"ping","y":NaN}')
        self.assertEqual(answer.json["id"], 17)
        answer = self.client.post('{"method":"ping","id":"a\\"b","y":1e999,"jsonrpc":"2.0"}')
        self.assertEqual(answer.json["id"], 'a"b')

    def test_pages_of_other_sites_are_refused(self):
        self.assertEqual(self.client.post(PING, {"Origin": "https://evil.example"}).status, 403)
        self.assertEqual(self.client.post(PING, {"Host": "evil.example"}).status, 421)
        own = "http://127.0.0.1:%d" % self.service.port
        self.assertEqual(self.client.post(PING, {"Origin": own}).status, 200)

    def test_an_array_gets_an_array(self):
        answer = self.client.post([PING, {"jsonrpc": "2.0", "method": "notifications/initialized"}, {**PING, "id": "b"}])
        self.assertEqual([each["id"] for each in answer.json], [1, "b"])

    def test_a_tuning_is_a_job_with_addresses(self):
        result = call(self.client, "tune", TUNE)
        whole = result["structuredContent"]["whole"]
        job = self.service.get(whole["api"]).json
        self.assertEqual(job["status"], "succeeded")
        self.assertEqual(whole["page"], "/#/jobs/%s/design" % job["id"])
        exact = job["result"]["controllers"][0]["controller"]["Kp"]
        self.assertAlmostEqual(result["structuredContent"]["best"]["controller"]["Kp"], exact, delta=1e-4)
        read = self.client.request("resources/read", {"uri": whole["resource"]})["result"]["contents"][0]
        self.assertEqual(json.loads(read["text"])["result"], job["result"])
        self.assertIn(job["id"], text_of(call(self.client, "job_status")))

    def test_what_a_call_changes_is_told_in_its_annotations(self):
        tools = {tool["name"]: tool["annotations"] for tool in self.client.request("tools/list")["result"]["tools"]}
        stores = {name for name, hints in tools.items() if not hints["readOnlyHint"]}
        self.assertEqual(stores, {"tune", "compare", "check_record"})
        self.assertFalse(any(hints["destructiveHint"] or hints["openWorldHint"] for hints in tools.values()))

    def test_a_long_job_goes_on_and_its_state_can_be_asked_for(self):
        job = self.service.post_job({**LONG, "name": "slow"})
        state = call(self.client, "job_status", {"job": job["id"]})
        self.assertIn(state["structuredContent"]["status"], ("queued", "running"))
        self.assertIn("job_status", text_of(state))
        self.service.post("/v1/jobs/%s/cancel" % job["id"], {})


class McpKeysTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        keys = os.path.join(cls.folder.name, "keys")
        cls.key = {}
        for name in ("one", "two", "hasty"):
            made = subprocess.run([BINARY, "key", name, "--keys", keys], capture_output=True, text=True, check=True)
            cls.key[name] = made.stdout.split()[-1]
        cls.service = Service("--auth", "keys", "--keys", keys, "--rate-limit", "20")

    @classmethod
    def tearDownClass(cls):
        cls.service.stop()
        cls.folder.cleanup()

    def client(self, name):
        return HttpClient(self.service, {"Authorization": "Bearer " + self.key[name]})

    def test_without_a_key_nothing_is_said(self):
        for headers in ({}, {"Authorization": "Bearer tw_wrong"}):
            answer = HttpClient(self.service, headers).post(PING)
            self.assertEqual(answer.status, 401)
            self.assertIn("Bearer", answer.headers["WWW-Authenticate"])

    def test_a_job_of_another_key_does_not_exist(self):
        job = call(self.client("one"), "tune", {**QUICK, "plant": FOPDT})["structuredContent"]["job"]
        for tool, arguments in (("job_status", {"job": job}), ("code", {"job": job, "language": "st"})):
            self.assertNotIn("isError", call(self.client("one"), tool, arguments))
            stranger = call(self.client("two"), tool, arguments)
            self.assertTrue(stranger["isError"])
            self.assertIn("There is no job", text_of(stranger))
        self.assertNotIn(job, text_of(call(self.client("two"), "job_status")))
        self.assertEqual(self.client("two").request("resources/list")["result"]["resources"], [])
        self.assertIn("error", self.client("two").request("resources/read", {"uri": "tunewright://answer/" + job}))

    def test_a_client_that_calls_too_often_waits(self):
        statuses = {self.client("hasty").post(PING).status for _ in range(80)}
        self.assertEqual(statuses, {200, 429})


if __name__ == "__main__":
    unittest.main()
