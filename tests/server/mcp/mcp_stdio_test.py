"""`tunewright mcp`: one message a line on standard input and output, in the order of the protocol."""

import json
import signal
import subprocess
import time
import unittest

from mcp_clients import HELLO, StdioClient, call, text_of
from service import BINARY, FOPDT, LONG, ROOT

TUNE = {"plant": "2 e^(-3s)/(10s+1)", "tune": [{"method": "robust", "Ms": 1.4}]}
RECORD = (ROOT / "tests" / "data" / "records" / "tclab-step.csv").read_text()


class StdioTest(unittest.TestCase):
    def setUp(self):
        self.client = StdioClient()
        self.addCleanup(self.client.close)

    def test_a_session_from_its_greeting_to_its_end(self):
        hello = self.client.request("initialize", HELLO)["result"]
        self.assertEqual(hello["protocolVersion"], "2025-06-18")
        self.assertEqual(hello["serverInfo"]["name"], "tunewright")
        self.assertIn("tools", hello["capabilities"])
        self.client.send({"jsonrpc": "2.0", "method": "notifications/initialized"})
        names = [tool["name"] for tool in self.client.request("tools/list")["result"]["tools"]]
        self.assertIn("tune", names)
        self.assertTrue(self.client.alive())
        self.assertEqual(self.client.close(), 0)

    def test_each_revision_is_spoken_and_an_unknown_one_gets_the_newest(self):
        for revision, spoken in (("2024-11-05", "2024-11-05"), ("2025-03-26", "2025-03-26"), ("2025-06-18", "2025-06-18"),
                                 ("2099-01-01", "2025-06-18"), ("x", "2025-06-18")):
            hello = self.client.request("initialize", {**HELLO, "protocolVersion": revision})["result"]
            self.assertEqual(hello["protocolVersion"], spoken)

    def test_notifications_get_no_answer(self):
        for method in ("notifications/initialized", "notifications/cancelled", "notifications/unknown"):
            self.client.send({"jsonrpc": "2.0", "method": method})
        self.client.send({"jsonrpc": "2.0", "method": "tools/call", "params": {"name": "tune", "arguments": TUNE}})
        self.client.send({"jsonrpc": "2.0", "id": 5, "result": {}})
        self.client.send({"jsonrpc": "2.0", "id": "p", "method": "ping"})
        self.assertEqual(self.client.read(), {"jsonrpc": "2.0", "id": "p", "result": {}})

    def test_answers_that_were_asked_for_before_the_end_of_the_input_come(self):
        lines = "".join(json.dumps({"jsonrpc": "2.0", "id": i, "method": "tools/call",
                                    "params": {"name": "tune", "arguments": TUNE}}) + "\n" for i in range(3))
        done = subprocess.run([BINARY, "mcp"], input=lines, capture_output=True, text=True, timeout=60)
        self.assertEqual(done.returncode, 0)
        self.assertEqual([json.loads(line)["id"] for line in done.stdout.splitlines()], [0, 1, 2])
        self.assertEqual(done.stderr, "")

    def test_a_last_line_without_its_end_counts(self):
        done = subprocess.run([BINARY, "mcp"], input='\n\r\n{"jsonrpc":"2.0","id":1,"method":"ping"}', capture_output=True,
                              text=True, timeout=60)
        self.assertEqual(done.stdout, '{"jsonrpc":"2.0","id":1,"result":{}}\n')

    def test_an_array_of_messages_gets_an_array_of_answers(self):
        self.client.send([{"jsonrpc": "2.0", "id": 1, "method": "ping"},
                          {"jsonrpc": "2.0", "method": "notifications/initialized"},
                          {"jsonrpc": "2.0", "id": 2, "method": "tools/call",
                           "params": {"name": "tune", "arguments": TUNE}}])
        answers = self.client.read()
        self.assertEqual([answer["id"] for answer in answers], [1, 2])
        self.assertIn("Kp", text_of(answers[1]["result"]))

    def test_a_ping_is_answered_while_a_call_computes_and_a_cancelled_call_is_not(self):
        self.client.send({"jsonrpc": "2.0", "id": "long", "method": "tools/call",
                          "params": {"name": "tune", "arguments": {k: v for k, v in LONG.items() if k != "name"}}})
        start = time.monotonic()
        self.assertTrue(self.client.alive())
        self.client.send({"jsonrpc": "2.0", "method": "notifications/cancelled", "params": {"requestId": "long"}})
        # Calls are answered in their order: this one comes when the long one has stopped.
        result = call(self.client, "tune", TUNE)
        self.assertNotIn("isError", result)
        self.assertLess(time.monotonic() - start, 20)

    def test_a_line_that_is_too_long_is_refused_and_the_next_is_read(self):
        self.client.write(b'{"jsonrpc":"2.0","id":1,"method":"' + b"x" * (33 << 20) + b'"}\n')
        answer = self.client.read()
        self.assertEqual(answer["error"]["code"], -32600)
        self.assertIn("32 MiB", answer["error"]["message"])
        self.assertTrue(self.client.alive())

    def test_ctrl_c_ends_it(self):
        self.assertTrue(self.client.alive())
        self.client.process.send_signal(signal.SIGINT)
        self.assertEqual(self.client.process.wait(10), -signal.SIGINT)

    def test_a_client_that_reads_no_more_ends_it(self):
        process = subprocess.Popen([BINARY, "mcp"], stdin=subprocess.PIPE, stdout=subprocess.PIPE)
        self.addCleanup(process.kill)
        process.stdout.close()
        process.stdin.write(b'{"jsonrpc":"2.0","id":1,"method":"ping"}\n')
        process.stdin.flush()
        self.assertEqual(process.wait(10), -signal.SIGPIPE)
        process.stdin.close()

    def test_the_whole_answer_is_a_resource_and_a_later_call_finds_it(self):
        answer = call(self.client, "tune", TUNE)["structuredContent"]
        self.assertEqual(answer["whole"]["resource"], "tunewright://answer/1")
        read = self.client.request("resources/read", {"uri": "tunewright://answer/1"})["result"]["contents"][0]
        whole = json.loads(read["text"])
        exact, short = whole["result"]["controllers"][0]["controller"], answer["best"]["controller"]
        self.assertAlmostEqual(exact["Kp"], short["Kp"], delta=1e-4 * exact["Kp"])
        self.assertEqual(whole["request"]["plant"], FOPDT)
        listed = self.client.request("resources/list")["result"]["resources"]
        self.assertEqual([resource["uri"] for resource in listed], ["tunewright://answer/1"])
        self.assertEqual(call(self.client, "job_status", {"job": "1"})["structuredContent"]["best"], answer["best"])
        code = text_of(call(self.client, "code", {"job": "1", "language": "python", "sample_time": 0.5}))
        self.assertIn("class TunewrightPid", code)

    def test_kept_answers_are_few(self):
        evaluate = {"plant": FOPDT, "controllers": [{"form": "ideal", "Kp": 0.5, "Ti": 10}]}
        for _ in range(55):
            self.assertNotIn("isError", call(self.client, "evaluate", evaluate))
        listed = self.client.request("resources/list")["result"]["resources"]
        self.assertEqual(len(listed), 50)
        gone = self.client.request("resources/read", {"uri": "tunewright://answer/1"})["error"]
        self.assertEqual(gone["code"], -32002)
        self.assertIn("6 to 55", gone["message"])

    def test_from_a_record_to_the_settings_of_a_block(self):
        model = call(self.client, "identify", {"record": {"csv": RECORD}})
        self.assertIn("A good model.", text_of(model))
        plant = model["structuredContent"]["model"]["plant"]
        result = call(self.client, "tune", {"plant": plant, "implement": {
            "product": "emerson_deltav_standard", "y_span": [0, 100], "u_span": [0, 100]}})
        self.assertIn("Settings of emerson_deltav_standard: GAIN", text_of(result))
        settings = result["structuredContent"]["best"]["settings"]
        back = call(self.client, "settings", {"product": "emerson_deltav_standard", "y_span": [0, 100], "u_span": [0, 100],
                                              "settings": {"GAIN": float(settings["GAIN"]), "RESET": float(settings["RESET"]),
                                                           "RATE": float(settings["RATE"])}})["structuredContent"]
        self.assertAlmostEqual(back["controller"]["Kp"], float(settings["GAIN"]), delta=1e-3)


if __name__ == "__main__":
    unittest.main()
