"""The binary at a terminal: tables and sentences for a person, and the answers to wrong arguments."""

import json
import os
import pty
import re
import subprocess
import tempfile
import unittest

from command_line_test import run
from service import BINARY

RECORD = os.path.join(os.path.dirname(__file__), "..", "..", "data", "records", "tclab-step.csv")
PLANT = "2 e^(-3s)/(10s+1)"


def at_terminal(*arguments):
    """The exit code, with standard output and standard error together."""
    master, slave = pty.openpty()
    process = subprocess.Popen([BINARY, *arguments], stdin=subprocess.DEVNULL, stdout=slave, stderr=slave)
    os.close(slave)
    shown = b""
    while True:
        try:
            part = os.read(master, 65536)
        except OSError:  # the other end is closed
            break
        if not part:
            break
        shown += part
    os.close(master)
    return process.wait(timeout=60), shown.decode().replace("\r\n", "\n")


def cells(table, name):
    """The words of the table row that begins with that name."""
    return next(line.split() for line in table.splitlines() if line.startswith(name))


class TableTest(unittest.TestCase):
    def test_tune_shows_settings_margins_and_the_verdict(self):
        code, shown = at_terminal("tune", "--plant", PLANT, "--method", "robust", "--method", "simc", "--Ms", "1.4")
        self.assertEqual(code, 0, shown)
        self.assertRegex(shown.splitlines()[0], r"^method +controller +Kp +Ti \(s\) +Td \(s\) +Ms +Mt +load IAE +verdict$")
        # Kp, Ti and the smallest load IAE of this plant at Ms = Mt = 1.4, to the digits shown.
        row = cells(shown, "robust")
        self.assertIn("0.8381", row)
        self.assertIn("5.691", row)
        self.assertIn("1.4", row)
        self.assertEqual(cells(shown, "simc")[0], "simc")
        self.assertNotIn("{", shown)

    def test_a_table_is_written_elsewhere_where_it_is_asked_for(self):
        done = run("tune", "--plant", PLANT, "--table")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertIn("load IAE", done.stdout)

    def test_json_is_one_line_and_pretty_says_the_same_in_many(self):
        compact = run("tune", "--plant", PLANT)
        self.assertEqual(compact.stdout.count("\n"), 1)
        self.assertTrue(compact.stdout.endswith("}\n"))
        pretty = run("tune", "--plant", PLANT, "--pretty")
        self.assertGreater(pretty.stdout.count("\n"), 100)
        first, second = json.loads(compact.stdout), json.loads(pretty.stdout)
        self.assertEqual(first["controllers"][0]["controller"], second["controllers"][0]["controller"])
        code, shown = at_terminal("tune", "--plant", PLANT, "--json")
        self.assertEqual(code, 0)
        self.assertEqual(json.loads(shown)["controllers"][0]["controller"], first["controllers"][0]["controller"])

    def test_answers_are_indented_at_a_terminal(self):
        code, shown = at_terminal("plant", PLANT)
        self.assertEqual(code, 0)
        self.assertTrue(shown.startswith("{\n  \"plant\""), shown)
        self.assertEqual(json.loads(shown)["plant"], {"type": "fopdt", "K": 2, "T": 10, "L": 3})

    def test_compare_ranks_every_method_beside_todays_settings(self):
        code, shown = at_terminal("compare", "--plant", PLANT, "--baseline", "0.5 10 0")
        self.assertEqual(code, 0, shown)
        for method in ("robust", "simc", "amigo", "baseline"):
            self.assertTrue(any(line.startswith(method) for line in shown.splitlines()), method)
        row = cells(shown, "baseline")
        self.assertIn("0.5", row)
        self.assertIn("10", row)

    def test_a_record_is_tuned_as_it_was_exported(self):
        code, shown = at_terminal("tune", RECORD, "--t", "Time", "--u", "Q1", "--y", "T1", "--time-unit", "s")
        self.assertEqual(code, 0, shown)
        self.assertRegex(shown, r"Model sopdt, fit 97\.\d+ %: K 0\.695\d* \+- 0\.0086")
        asked = {"record": {"csv": open(RECORD).read(), "columns": {"t": "Time", "u": "Q1", "y": "T1"}}}
        whole = json.loads(run("tune", "-", text=json.dumps(asked)).stdout)
        words = json.loads(run("tune", RECORD, "--t", "Time", "--u", "Q1", "--y", "T1").stdout)
        self.assertEqual([entry.get("controller") for entry in words["controllers"]],
                         [entry.get("controller") for entry in whole["controllers"]])

    def test_identify_shows_the_candidates(self):
        code, shown = at_terminal("identify", RECORD, "--u", "Q1", "--y", "T1")
        self.assertEqual(code, 0, shown)
        self.assertRegex(shown, r"(?m)^candidate +fit \(%\) +parameters$")
        self.assertRegex(shown, r"(?m)^fopdt +9\d")

    def test_responses_are_drawn_in_dots_and_in_a_file(self):
        with tempfile.TemporaryDirectory() as folder:
            drawing = folder + "/loop.svg"
            done = run("tune", "--plant", PLANT, "--plot", "--svg", drawing)
            self.assertEqual((done.returncode, done.stderr), (0, ""))
            self.assertIn("load IAE", done.stdout)
            for title in ("Set-point step: y", "Load step: y", "Set-point step: u", "Load step: u"):
                self.assertIn(title, done.stdout)
            dots = re.findall("[\u2801-\u28ff]", done.stdout)
            self.assertGreater(len(dots), 200)
            self.assertTrue(all(len(line) <= 80 for line in done.stdout.splitlines() if re.search("[\u2800-\u28ff]", line)))
            with open(drawing) as file:
                text = file.read()
            self.assertTrue(text.startswith("<svg") and text.count("<path") >= 4)
            subprocess.run(["/usr/bin/python3", "-c", "import sys, xml.etree.ElementTree as t; t.parse(sys.argv[1])",
                            drawing], check=True)
            done = run("tune", "--plant", PLANT, "--svg", folder + "/nowhere/loop.svg")
            self.assertEqual(done.returncode, 1)
            self.assertIn("/nowhere/loop.svg", json.loads(done.stderr)["detail"])

    def test_lists_are_short_and_examples_can_be_tuned(self):
        for command, word in (("methods", "robust"), ("controllers", "siemens_pid_compact"), ("examples", "compare-methods")):
            code, shown = at_terminal(command)
            self.assertEqual(code, 0)
            self.assertRegex(shown, r"(?m)^%s " % word)
            json.loads(run(command).stdout)
        by_number, by_id = run("examples", "3"), run("examples", "compare-methods")
        self.assertEqual(by_number.stdout, by_id.stdout)
        self.assertEqual(run("tune", "-", text=by_id.stdout).returncode, 0)
        self.assertEqual(json.loads(run("methods", "simc").stdout)["id"], "simc")
        self.assertEqual(json.loads(run("controllers", "siemens_pid_compact").stdout)["id"], "siemens_pid_compact")
        done = run("examples", "compare-method")
        self.assertEqual(done.returncode, 1)
        self.assertIn("compare-methods", json.loads(done.stderr)["detail"])


class WrongWordTest(unittest.TestCase):
    def test_a_problem_is_a_sentence_at_a_terminal_and_names_the_file(self):
        with tempfile.TemporaryDirectory() as folder:
            path = folder + "/request.json"
            for text, start in (("{", path + " is not JSON"), ("", path + " is empty")):
                with open(path, "w") as file:
                    file.write(text)
                code, shown = at_terminal("tune", path)
                self.assertEqual(code, 1)
                self.assertTrue(shown.startswith("tunewright: " + start), shown)
                detail = json.loads(run("tune", path).stderr)["detail"]
                self.assertTrue(detail.startswith(start), detail)
        self.assertTrue(json.loads(run("tune", "-", text="{").stderr)["detail"].startswith("standard input is not JSON"))
        code, shown = at_terminal("tune", "--plant", PLANT, "--method", "robst", "--Ms", "0.5")
        self.assertEqual(code, 1)
        self.assertIn("Did you mean robust?", shown)

    def test_usage_errors_have_one_form_and_end_with_2(self):
        for arguments, words in ((("tun",), "Did you mean tune?"), ((), "name a command"), (("tune", "--plnat", "1"), "Did you mean --plant?"),
                                 (("tune", "a", "b"), "\"b\" is more than tune takes"), (("identify",), "file"),
                                 (("serve", "--workers", "0"), "--workers"), (("completion", "fish"), "bash"),
                                 (("tune", "--json", "--pretty", "--plant", "1/(s+1)"), "--pretty"), (("serve", "--lease", "x"), "--lease")):
            done = run(*arguments)
            self.assertEqual((done.returncode, done.stdout), (2, ""), arguments)
            self.assertTrue(done.stderr.startswith("tunewright: "), done.stderr)
            self.assertEqual(done.stderr.count("\n"), 1, done.stderr)
            self.assertIn("--help` lists the possibilities.", done.stderr)
            self.assertIn(words, done.stderr)

    def test_nothing_and_too_much_to_tune_are_told(self):
        self.assertIn("--plant", json.loads(run("tune").stderr)["detail"])
        self.assertIn("Leave one of them out", json.loads(run("tune", RECORD, "--plant", PLANT).stderr)["detail"])
        self.assertIn("Kp, Ti and Td", json.loads(run("tune", "--plant", PLANT, "--baseline", "1 2 3 4").stderr)["detail"])
        problem = json.loads(run("tune", "--plant", PLANT, "--Ms", "high").stderr)
        self.assertEqual({error["pointer"] for error in problem["errors"]}, {"/tune/0/Ms", "/tune/0/Mt"})

    def test_a_second_key_of_a_name_is_asked_for(self):
        with tempfile.TemporaryDirectory() as folder:
            keys = folder + "/keys"
            self.assertEqual(run("key", "ann", "--keys", keys).returncode, 0)
            done = run("key", "ann", "--keys", keys)
            self.assertEqual((done.returncode, done.stdout), (2, ""))
            self.assertIn("--rotate", done.stderr)
            self.assertEqual(run("key", "bob", "--keys", keys).returncode, 0)
            self.assertEqual(run("key", "ann", "--keys", keys, "--rotate").returncode, 0)
            with open(keys) as file:
                self.assertEqual([line.split()[0] for line in file], ["ann", "bob", "ann"])


class ShellTest(unittest.TestCase):
    def complete(self, *words):
        """The completions of bash for the last word."""
        script = ('eval "$("$0" completion bash)"; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); _tunewright; '
                  'printf "%s\\n" "${COMPREPLY[@]}"')
        return subprocess.run(["bash", "-c", script, BINARY, *words], check=True, capture_output=True,
                              text=True).stdout.split()

    def test_bash_completes_commands_and_options(self):
        self.assertEqual(self.complete("tunewright", "id"), ["identify"])
        self.assertEqual(self.complete("tunewright", "tune", "--pl"), ["--plant", "--plot"])
        self.assertEqual(self.complete("tunewright", "serve", "--retention-f"), ["--retention-failed"])

    def test_zsh_and_the_manual_name_every_command_and_option(self):
        listed = re.findall(r"(?m)^  ([a-z]+) ", run("--help").stdout.split("Subcommands:")[1])
        self.assertGreater(len(listed), 12)
        zsh, manual = run("completion", "zsh").stdout, run("manual").stdout
        self.assertTrue(zsh.startswith("#compdef tunewright\n"))
        for command in listed:
            self.assertIn("\n        %s)\n" % command, zsh)
            self.assertIn("\n.SS %s\n" % command, manual)
        for option in set(re.findall(r"--[a-zA-Z][a-zA-Z-]*", run("serve", "--help").stdout + run("tune", "--help").stdout)) - {"--help"}:
            self.assertIn("'%s[" % option, zsh)
            self.assertIn(option.replace("-", "\\-"), manual)


if __name__ == "__main__":
    unittest.main()
