"""The Python client as a package: its installation without a network, its types, and its README."""

import contextlib
import io
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

from service import BINARY, ROOT, Service

CLIENT = ROOT / "api" / "clients" / "python"
sys.path.insert(0, str(CLIENT))
import tunewright  # noqa: E402

MODULES = ("__init__", "answers", "autotune", "bump_program", "client", "notebook", "relay_program", "systems", "tables")
TYPED_USE = """
import tunewright
result = tunewright.Client(key="k").tune(plant="1/(s+1)", tune=["simc", {"method": "robust"}])
reveal_type(result.best)
tunewright.Client(timeout="soon")
"""


class PackageTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory(prefix="tunewright-client-")
        cls.addClassCleanup(cls.folder.cleanup)
        # Like a clone: pip must not leave files in the tree.
        cls.source = pathlib.Path(cls.folder.name, "python")
        shutil.copytree(CLIENT, cls.source, ignore=shutil.ignore_patterns("__pycache__"))
        venv = pathlib.Path(cls.folder.name, "venv")
        subprocess.run(["/usr/bin/python3", "-m", "venv", str(venv)], check=True)
        cls.python = str(venv / "bin" / "python")
        cls.run_in_folder(cls.python, "-m", "pip", "install", "--no-index", "--disable-pip-version-check", str(cls.source),
                          environment={"PIP_CONFIG_FILE": os.devnull})

    @classmethod
    def run_in_folder(cls, *command, environment=None, fails=False):
        done = subprocess.run(command, cwd=cls.folder.name, env={**os.environ, **(environment or {})},
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        if (done.returncode != 0) != fails:
            raise AssertionError("%s: %s" % (" ".join(command), done.stdout))
        return done.stdout

    def test_pip_installs_it_without_a_network(self):
        shown = self.run_in_folder(self.python, "-m", "pip", "show", "--files", "tunewright")
        self.assertIn("Name: tunewright", shown)
        self.assertIn("tunewright/py.typed", shown)
        self.assertEqual(self.run_in_folder(self.python, "-c", "import tunewright; print(tunewright.Client.__name__)"),
                         "Client\n")
        kept = sorted(path.name for path in self.source.rglob("*") if "__pycache__" not in path.parts)
        self.assertEqual(kept, sorted([
            "README.md", "backend", "wheel_backend.py", "pyproject.toml", "tunewright", *(name + ".py" for name in MODULES),
            "examples", "README.md", "modbus.py", "mqtt.py", "opcua.py", "serial_line.py", "simulated.py"]))
        files = re.findall(r"^  (tunewright/\S+\.py)$", shown, re.MULTILINE)
        self.assertEqual(files, ["tunewright/%s.py" % name for name in MODULES])

    def test_its_source_archive_installs_too_and_both_are_the_same_every_time(self):
        build = ("import sys; sys.path.insert(0, sys.argv[1]); import wheel_backend as backend; "
                 "backend.build_wheel(sys.argv[2]); print(backend.build_sdist(sys.argv[2]))")
        folders = [pathlib.Path(self.folder.name, name) for name in ("once", "twice")]
        for folder in folders:
            folder.mkdir()
            sdist = self.run_in_folder(self.python, "-c", build, str(self.source / "backend"), str(folder)).strip()
        made = [{path.name: path.read_bytes() for path in folder.iterdir()} for folder in folders]
        self.assertEqual(len(made[0]), 2)
        self.assertEqual(made[0], made[1])
        shutil.unpack_archive(folders[0] / sdist, folders[0])
        for name in MODULES:
            module = pathlib.Path("tunewright", name + ".py")
            self.assertEqual((folders[0] / sdist[:-len(".tar.gz")] / module).read_bytes(), (self.source / module).read_bytes())
        self.run_in_folder(self.python, "-m", "pip", "install", "--no-index", "--force-reinstall", "--no-deps",
                           "--disable-pip-version-check", str(folders[0] / sdist),
                           environment={"PIP_CONFIG_FILE": os.devnull})

    def test_its_version_is_the_services(self):
        version = re.search(r"\d+\.\d+\.\d+", subprocess.run([BINARY, "--version"], check=True, capture_output=True,
                                                            text=True).stdout).group()
        self.assertIn("Version: %s\n" % version, self.run_in_folder(self.python, "-m", "pip", "show", "tunewright"))

    def test_its_types_are_strict_from_python_3_9_on(self):
        checked = ("/usr/bin/mypy", "--strict", "--cache-dir", os.path.join(self.folder.name, "cache"))
        self.run_in_folder(*checked, "--python-version", "3.9", str(self.source / "tunewright"),
                           str(self.source / "backend" / "wheel_backend.py"))
        program = pathlib.Path(self.folder.name, "use.py")
        program.write_text(TYPED_USE)
        seen = self.run_in_folder(*checked, "--python-executable", self.python, str(program), fails=True)
        self.assertRegex(seen, r'Revealed type is "builtins.dict\[builtins.str, Any\]"')
        self.assertRegex(seen, r'"timeout" to "Client" has incompatible type "str"')
        self.assertIn("Found 1 error in 1 file", seen)

    def test_the_readmes_examples_run_as_they_stand(self):
        text = (CLIENT / "README.md").read_text("utf-8")
        blocks = re.findall(r"^```python\n(.*?)^```$", text, re.MULTILINE | re.DOTALL)
        self.assertEqual(text.count("```"), 2 * len(blocks))
        self.assertGreater(len(blocks), 4)
        at_home = os.getcwd()
        with Service("--workers", "2") as service, tempfile.TemporaryDirectory() as folder:
            shutil.copy(ROOT / "api" / "examples" / "tclab-step.csv", os.path.join(folder, "step.csv"))
            given = tunewright.Client.__init__.__defaults__
            tunewright.Client.__init__.__defaults__ = ("http://127.0.0.1:%d" % service.port, *given[1:])
            os.chdir(folder)
            try:
                said, names = io.StringIO(), {}
                with contextlib.redirect_stdout(said):
                    for block in blocks:
                        exec(compile(block, "README.md", "exec"), names)
                report = pathlib.Path("TIC-101.html").read_text("utf-8")
            finally:
                os.chdir(at_home)
                tunewright.Client.__init__.__defaults__ = given
        self.assertIn("TIC-101", report)
        self.assertIn("100 of 100", said.getvalue())
        self.assertEqual(names["places"], ["/plant/K", "/plant/L"])
        self.assertAlmostEqual(names["kept"]["Kp"], 10 / (2 * 2 * 100), places=12)  # SIMC, tau_c = L = 100
        self.assertIn("FUNCTION_BLOCK", names["program"])


if __name__ == "__main__":
    unittest.main()
