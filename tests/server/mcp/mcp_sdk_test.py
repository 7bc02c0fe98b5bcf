"""Each tool once through the protocol's own client, @modelcontextprotocol/sdk, over both transports."""

import json
import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest

from service import BINARY, ROOT, Service

CLIENT = pathlib.Path(__file__).parent / "sdk_client.mjs"


class SdkTest(unittest.TestCase):
    def test_every_tool_through_the_client_of_the_protocol(self):
        if shutil.which("node") is None or not (ROOT / "web/node_modules/@modelcontextprotocol/sdk").is_dir():
            self.skipTest("node or the client is missing: script/bootstrap page, then npm ci in web/")
        with tempfile.TemporaryDirectory() as folder:
            keys = os.path.join(folder, "keys")
            key = subprocess.run([BINARY, "key", "agent", "--keys", keys], capture_output=True, text=True,
                                 check=True).stdout.split()[-1]
            with Service("--auth", "keys", "--keys", keys) as service:
                done = subprocess.run(["node", str(CLIENT), BINARY, "http://127.0.0.1:%d/mcp" % service.port, key],
                                      capture_output=True, text=True, timeout=120)
        self.assertEqual(done.returncode, 0, done.stderr[-3000:])
        for transport, session in json.loads(done.stdout).items():
            with self.subTest(transport):
                self.assertEqual(session["server"], "tunewright")
                self.assertEqual(sorted(session["seen"]), sorted(session["tools"]))
                self.assertEqual([name for name, seen in session["seen"].items() if seen["refused"]], [])
                self.assertTrue(all(seen["text"] > 0 for seen in session["seen"].values()))
                self.assertEqual(session["seen"]["tune"]["status"], "succeeded")
                self.assertEqual((session["wrong"], session["unknown"], session["templates"]), (True, -32602, 1))


if __name__ == "__main__":
    unittest.main()
