"""Hundreds of wrong messages on both transports: each is refused or harmless, and the server answers after each."""

import json
import unittest

import hostile_messages as hostile
from mcp_clients import HttpClient, StdioClient
from service import Service


def fault_of(answer):
    """What is wrong with an answer; "" if it is a right one."""
    if not isinstance(answer, dict) or answer.get("jsonrpc") != "2.0" or "id" not in answer:
        return "no answer of JSON-RPC"
    if ("result" in answer) == ("error" in answer):
        return "result and error"
    if "error" in answer:
        error = answer["error"]
        right = isinstance(error["code"], int) and 0 < len(error["message"]) < 2000
        return "" if right else "no sentence"
    result = answer["result"]
    if "content" in result:
        size = sum(len(part["text"]) for part in result["content"])
        if result.get("isError") and not 0 < size < 6000:
            return "a refusal of %d characters" % size
    return ""


class HostileMessagesTest(unittest.TestCase):
    def check(self, answers, sent):
        for answer in answers if isinstance(answers, list) else [answers]:
            self.assertEqual(fault_of(answer), "", "%.200r -> %.300r" % (sent, answer))

    def test_lines(self):
        with StdioClient() as client:
            tools = client.request("tools/list")["result"]["tools"]
            lines = [json.dumps(message).encode() for message in hostile.messages()] + list(hostile.texts())
            lines += [json.dumps(hostile.tool_call(*each)).encode() for each in hostile.arguments(tools)]
            self.assertGreater(len(lines), 800)
            for number, line in enumerate(lines):
                client.write(line + b'\n{"jsonrpc":"2.0","id":"p%d","method":"ping"}\n' % number)
                done, answers = False, 0
                while not done or (answers == 0 and self.must_answer(line)):
                    answer = client.read()
                    self.assertIsNotNone(answer, line[:200])
                    self.check(answer, line)
                    if isinstance(answer, dict) and answer["id"] == "p%d" % number:
                        done = True
                    else:
                        answers += 1
            self.assertTrue(client.alive())
            client.process.stdin.close()
            self.assertEqual(client.process.wait(20), 0)
            self.assertEqual(client.process.stderr.read(), b"")

    @staticmethod
    def must_answer(line):
        """A call computes on another thread, so that its answer may come after that of the ping."""
        return b'"tools/call"' in line and b'"id"' in line

    def test_bodies(self):
        with Service() as service:
            client = HttpClient(service)
            tools = client.request("tools/list")["result"]["tools"]
            bodies = [json.dumps(message).encode() for message in hostile.messages()] + list(hostile.texts())
            bodies += [json.dumps(hostile.tool_call(*each)).encode() for each in list(hostile.arguments(tools))[::3]]
            for body in bodies:
                answer = client.post(body)
                self.assertIn(answer.status, (200, 202, 400), body[:200])
                if answer.status == 202:
                    self.assertEqual(answer.body, b"")
                else:
                    self.check(answer.json, body)
                self.assertTrue(client.alive(), body[:200])
            log = service.read_log()
            self.assertNotIn("failed:", log)


if __name__ == "__main__":
    unittest.main()
