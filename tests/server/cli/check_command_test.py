"""tunewright check: files, folders, standard input and requests; Ctrl-C."""

import json
import os
import signal
import subprocess
import tempfile
import time
import unittest

from command_line_test import run
from service import BINARY


def plant(tags, rows=400, first=0, quiet=False):
    """A table of loops with a row every 10 s of 2026-05-04."""
    lines = ["Time," + ",".join("%s.PV,%s.OP" % (tag, tag) for tag in tags)]
    for k in range(first, first + rows):
        stamp = "2026-05-04 %02d:%02d:%02d" % (k // 360, k // 6 % 60, k % 6 * 10)
        values = ["Bad" if quiet else "%.2f" % (20 + (k * (3 + i) % 17) * 0.25) for i in range(len(tags))]
        lines.append(stamp + "," + ",".join("%s,%d" % (value, 30 + k % 7) for value in values))
    return "\n".join(lines) + "\n"


class CheckCommandTest(unittest.TestCase):
    def checked(self, *arguments, text=None):
        done = run("check", *arguments, text=text)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        return json.loads(done.stdout)

    def tags(self, answer):
        return [loop["tag"] for loop in answer["loops"]]

    def test_a_file_of_many_loops(self):
        answer = self.checked("-", text=plant(["FIC101", "TIC102", "LIC103"]))
        self.assertEqual(self.tags(answer), ["FIC101", "LIC103", "TIC102"])
        self.assertEqual(sorted(rank["loop"] for rank in answer["ranking"]), [0, 1, 2])
        self.assertFalse(answer["partial"])

    def test_a_folder_joins_the_parts_of_a_loop_and_keeps_a_broken_file_apart(self):
        with tempfile.TemporaryDirectory() as folder:
            files = {"b.csv": plant(["FIC101"], first=400), "a.csv": plant(["FIC101", "FIC102"]),
                     "broken.csv": "no table\n", "notes.pdf": "%"}
            for name, text in files.items():
                with open(os.path.join(folder, name), "w") as file:
                    file.write(text)
            answer = self.checked(folder)
            rows = {loop["tag"]: loop["quality"]["rows"] for loop in answer["loops"]}
            self.assertEqual(rows, {"FIC101": 800, "FIC102": 400, os.path.join(folder, "broken.csv"): 0})
            alone = run("check", os.path.join(folder, "broken.csv"))
            self.assertEqual((alone.returncode, json.loads(alone.stderr)["status"]), (1, 422))

    def test_a_single_loop_has_the_name_of_its_file(self):
        with tempfile.TemporaryDirectory() as folder:
            name = os.path.join(folder, "FIC7.csv")
            with open(name, "w") as file:
                file.write(plant(["X"]).replace("X.PV", "PV").replace("X.OP", "OP"))
            self.assertEqual(self.tags(self.checked(name)), ["FIC7"])
            answer = self.checked(name, "--answer-unit", "min")
            self.assertAlmostEqual(answer["loops"][0]["quality"]["sample_time"], 10 / 60, places=9)

    def test_a_file_for_each_tag_and_a_table_of_the_loops(self):
        with tempfile.TemporaryDirectory() as folder, tempfile.NamedTemporaryFile("w", suffix=".csv") as table:
            lines = [line.split(",") for line in plant(["FIC1"]).splitlines()]
            for name, column in (("FIC1.PV.csv", 1), ("FIC1.OP.csv", 2), ("TI3.PV.csv", 1)):
                with open(os.path.join(folder, name), "w") as file:
                    file.write("Time,Value\n" + "".join("%s,%s\n" % (line[0], line[column]) for line in lines[1:]))
            table.write("tag,kind,weight\nFIC1,pressure,3\nFIC8,flow,\n")
            table.flush()
            answer = self.checked(folder, "--loops", table.name)
            self.assertEqual(self.tags(answer), ["FIC1"])
            self.assertEqual(answer["loops"][0]["quality"]["rows"], 400)
            self.assertEqual(answer["loops"][0]["weight"], 3)
            self.assertEqual(answer["notes"],
                             ["TI3 has only a measurement or only a controller output and is not checked.",
                              "FIC8 is in the table of loops, but no record has this tag."])
            self.assertIn("Note: TI3 has only", run("check", folder, "--loops", table.name, "--table").stdout)
            table.write("FIC2,flw,\n")
            table.flush()
            done = run("check", folder, "--loops", table.name)
            self.assertEqual(done.returncode, 1)
            self.assertIn("Line 4, kind", json.loads(done.stderr)["detail"])
        self.assertEqual(run("check", "-", "--loops", "/nowhere", text=plant(["A"])).returncode, 1)

    def test_requests(self):
        loop = {"tag": "A", "csv": plant(["A"]), "columns": {"t": 1, "y": 2, "u": 3}}
        request = json.dumps({"loops": [loop]})
        self.assertEqual(self.tags(self.checked("-", text=request)), ["A"])
        answer = self.checked("-", text=request + "\n" + json.dumps({"loops": [dict(loop, tag="B")] * 2}) + "\n")
        self.assertEqual(self.tags(answer), ["A", "B", "B"])
        for text, status in (('{"plant": "2/(s+1)"}', 422), ('{"loops": []}', 422), ("{", 400)):
            done = run("check", "-", text=text)
            self.assertEqual((done.returncode, json.loads(done.stderr)["status"]), (1, status), text)

    def test_what_is_no_file(self):
        with tempfile.TemporaryDirectory() as folder:
            for name in (folder, os.path.join(folder, "nothing.csv")):
                self.assertEqual(run("check", name).returncode, 1)
        self.assertEqual(run("check").returncode, 2)

    def test_ctrl_c_answers_with_what_was_checked(self):
        with tempfile.NamedTemporaryFile("w", suffix=".csv") as file:
            file.write(plant(["FIC%d" % i for i in range(200)], rows=3000))
            file.flush()
            process = subprocess.Popen([BINARY, "check", file.name], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                       text=True)
            # Blocked is bit 1 (SIGINT): the signal is waited for.
            while process.poll() is None and "SigBlk:\t0000000000000002" not in open("/proc/%d/status" % process.pid).read():
                time.sleep(0.01)
            process.send_signal(signal.SIGINT)
            out, errors = process.communicate(timeout=60)
            self.assertEqual(process.returncode, 130)
            if out:
                self.assertTrue(json.loads(out)["partial"])
            else:
                self.assertIn("no loop was checked", errors)
