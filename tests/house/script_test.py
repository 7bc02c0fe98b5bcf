#!/usr/bin/python3
"""Checks the scripts: they describe themselves, refuse unknown arguments before they install or build anything, and
count skipped tests. Quick: installation and build are replaced by programs that leave a mark."""

import os
import pathlib
import re
import shutil
import subprocess
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
SCRIPTS = sorted(path.name for path in (ROOT / "script").iterdir() if path.suffix == "")
# An argument that a script does not have, and the text of its refusal.
WRONG = {
    "bootstrap": (["biuld"], ["build", "page", "test", "style", "check", "bench", "peers", "package", "arm64"]),
    "build": (["alles"], ["all"]),
    "test": (["engine"], ["--style", "--long", "tests/README.md"]),
    "check": (["tydi"], ["format", "tidy", "asan", "tsan", "fuzz", "api-fuzz", "arm64", "--changed"]),
    "format": (["--chek"], ["--check"]),
    "bench": (["robust"], ["robust_batch", "comparison_bench", "load", "endurance", "records", "peers", "families"]),
    "release": (["--system", "bokworm/amd64"], ["bookworm/amd64", "bookworm/arm64", "trixie/amd64", "trixie/arm64", "none"]),
    "newcomer": (["bokworm"], ["bookworm", "trixie"]),
    "pictures": (["--only", "desing"], ["design", "identify"]),
}


class WordsTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="tunewright-script-")
        self.addCleanup(folder.cleanup)
        self.mark = pathlib.Path(folder.name, "mark")
        for name in ("apt-get", "sudo", "dpkg-query", "cmake", "ninja", "npm", "clang-format", "clang-tidy"):
            stub = pathlib.Path(folder.name, name)
            stub.write_text('#!/bin/sh\necho "%s" >> "%s"\nexit 1\n' % (name, self.mark))
            stub.chmod(0o755)
        self.environment = {**os.environ, "PATH": folder.name + os.pathsep + os.environ["PATH"]}

    def run_script(self, name, *words):
        done = subprocess.run([ROOT / "script" / name, *words], capture_output=True, text=True, env=self.environment, timeout=60)
        self.assertFalse(self.mark.exists(), "it began: " + (self.mark.read_text() if self.mark.exists() else ""))
        return done

    def test_every_script_says_what_it_does(self):
        for name in SCRIPTS:
            for word in ("--help", "-h"):
                with self.subTest(script=name, word=word):
                    done = self.run_script(name, word)
                    self.assertEqual((done.returncode, done.stderr), (0, ""))
                    self.assertTrue(done.stdout.startswith("script/" + name + " "), done.stdout)
                    self.assertTrue(all(len(line) <= 120 for line in done.stdout.splitlines()), done.stdout)

    def test_the_servers_help_leads_to_its_options(self):
        self.assertIn("tunewright serve --help", self.run_script("server", "--help").stdout)

    def test_what_a_script_does_not_know_it_refuses_with_what_there_is(self):
        self.assertEqual(sorted([*WRONG, "server"]), SCRIPTS, "what is given to script/server is for the service to judge")
        for name, (words, there_is) in WRONG.items():
            with self.subTest(script=name):
                done = self.run_script(name, *words)
                self.assertEqual((done.returncode, done.stdout), (2, ""))
                self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)
                self.assertIn('"%s"' % words[-1], done.stderr)
                for word in there_is:
                    self.assertIn(word, done.stderr)

    def test_a_second_word_is_no_less_wrong(self):
        for name, words in (("build", ["all", "page"]), ("format", ["--check", "engine"]), ("check", ["format", "tydi"]),
                            ("bench", ["robust_batch", "robust"]), ("pictures", ["--quick"]), ("release", ["--native", "all"]), ("release", ["--into", "/"])):
            with self.subTest(script=name):
                self.assertEqual(self.run_script(name, *words).returncode, 2)

    def test_the_readme_has_every_script(self):
        text = (ROOT / "script" / "README.md").read_text()
        self.assertEqual([name for name in SCRIPTS if "| `%s`" % name not in text], [])


CTEST = """add_test(house_passes "true")
add_test(room_tests_0 "sh" "-c" "%s")
"""
PASSED = "echo '[  PASSED  ] 1 test.'"
SKIPPED = "echo '/here/disk_test.cpp:3: Skipped'; echo 'no disk here'; echo '[  PASSED  ] 0 tests.'"
NODE = """import test from "node:test";
test("passes", () => {});
test("has no browser", { skip: "none here" }, () => {});
"""
POSTGRES = """#!/usr/bin/python3
import os, sys
class Cluster:
    def __enter__(self): return self
    def __exit__(self, *_): pass
    def url(self): return ""
if __name__ == "__main__": os.execvp(sys.argv[3], sys.argv[3:])
"""
PYTHON = """import unittest
class Box(unittest.TestCase):
    def test_passes(self): pass
    @unittest.skipUnless(%s, "no proxy here")
    def test_proxy(self): pass
"""


class CountsTest(unittest.TestCase):
    """script/test in a tree of its own, in which each kind of suite has few tests."""

    def tree(self, skipping):
        folder = tempfile.TemporaryDirectory(prefix="tunewright-counts-")
        self.addCleanup(folder.cleanup)
        files = {
            "script/bootstrap": "#!/bin/sh\n",
            "script/build": "#!/bin/sh\n",
            "bin/npm": '#!/bin/sh\nexec node --test "$(dirname "$0")/some.test.mjs"\n',
            "bin/some.test.mjs": NODE if skipping else NODE.replace('{ skip: "none here" }, ', ""),
            "web/package.json": "{}",
            "build/release/CTestTestfile.cmake": CTEST % (SKIPPED if skipping else PASSED),
            "tests/server/postgres.py": POSTGRES,
            "tests/server/box_test.py": PYTHON % (not skipping),
        }
        listed = re.search(r"^ROOMS = \[.*?\]$", (ROOT / "tests/server/run.py").read_text(), re.MULTILINE | re.DOTALL)
        rooms = re.findall(r'"([a-z]+)"', listed[0])
        for room in rooms:
            files |= {f"tests/server/{room}/README.md": "", f"tests/{room}/README.md": ""}
        for name, text in files.items():
            path = pathlib.Path(folder.name, name)
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text)
            path.chmod(0o755)
        for name in ("script/test", "tests/server/run.py"):
            shutil.copy(ROOT / name, pathlib.Path(folder.name, name))
        return pathlib.Path(folder.name)

    def run_tests(self, root):
        # A runner of node tests makes nested runners report to it.
        environment = {key: value for key, value in os.environ.items() if key != "NODE_TEST_CONTEXT"}
        environment["PATH"] = str(root / "bin") + os.pathsep + environment["PATH"]
        done = subprocess.run([root / "script" / "test"], capture_output=True, text=True, env=environment, timeout=120)
        return done.returncode, done.stdout.splitlines()

    def test_nothing_is_said_of_skips_where_there_are_none(self):
        code, lines = self.run_tests(self.tree(skipping=False))
        self.assertEqual((code, lines[-1]), (0, "8 passed, 0 failed"), "\n".join(lines))

    def test_what_is_skipped_is_named_and_counted_apart(self):
        code, lines = self.run_tests(self.tree(skipping=True))
        self.assertEqual((code, lines[-1]), (0, "4 passed, 0 failed, 4 skipped"), "\n".join(lines))
        named = [line for line in lines[-5:-1] if line.startswith("skipped: ")]
        self.assertEqual(len(named), 4, "\n".join(lines))
        for word in ("disk_test.cpp:3: no disk here", "has no browser", "test_proxy", "no proxy here"):
            self.assertTrue(any(word in line for line in named), word)

    def test_a_failure_is_counted_and_ends_with_it(self):
        root = self.tree(skipping=True)
        (root / "tests/server/box_test.py").write_text((PYTHON % "True").replace("test_passes(self): pass", "test_passes(self): self.fail()"))
        code, lines = self.run_tests(root)
        self.assertEqual((code, lines[-1]), (1, "4 passed, 1 failed, 3 skipped"), "\n".join(lines))


if __name__ == "__main__":
    unittest.main()
