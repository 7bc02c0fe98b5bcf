"""Compares the Dockerfile with the tree, the binary and Debian, without a daemon; and checks the rights of the
image's user."""

import os
import pathlib
import re
import shlex
import shutil
import subprocess
import tempfile
import unittest
import urllib.error
import urllib.request

from service import BINARY, ROOT

USER = 10001
SANITIZERS = ("libasan", "libubsan", "libtsan")


def instructions():
    """Each stage as a list of (instruction, rest), with continued lines joined; lines before the first are left out."""
    text = re.sub(r"^\s*#.*\n", "", (ROOT / "Dockerfile").read_text(), flags=re.M)
    stages = []
    for line in re.sub(r"\\\n\s*", " ", text).splitlines():
        if not line.strip():
            continue
        name, rest = line.split(None, 1)
        if name == "FROM":
            stages.append([])
        if stages:
            stages[-1].append((name, rest))
    return stages


class DockerfileTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.binary, cls.page, cls.last = instructions()

    def values(self, name):
        return [rest for instruction, rest in self.last if instruction == name]

    def test_what_is_copied_is_there_and_is_let_in(self):
        let_in = [line[1:] for line in (ROOT / ".dockerignore").read_text().splitlines() if line.startswith("!")]
        sources = [source for stage in (self.binary, self.page, self.last) for name, rest in stage
                   if name == "COPY" and "--from" not in rest for source in rest.split()[:-1]]
        self.assertIn("script/bootstrap", sources)
        for source in sources:
            self.assertTrue((ROOT / source).exists(), source)
            self.assertTrue(any(source == path or source.startswith(path + "/") for path in let_in), source)

    def test_every_part_that_is_compiled_is_copied(self):
        parts = re.findall(r"^add_subdirectory\((\w+)\)", (ROOT / "CMakeLists.txt").read_text(), re.M)
        self.assertIn("engine", parts)
        copied = [rest.split()[0] for name, rest in self.binary if name == "COPY"]
        self.assertEqual([part for part in parts if part not in copied], [])

    def test_packages_to_build_with_have_one_home_and_come_before_the_sources(self):
        for stage, purpose, source in ((self.binary, "build", "engine engine"), (self.page, "page", "web web")):
            self.assertNotIn("apt-get", str(stage))
            self.assertLess(stage.index(("COPY", "script/bootstrap script/bootstrap")), stage.index(("RUN", "script/bootstrap " + purpose)))
            self.assertLess(stage.index(("RUN", "script/bootstrap " + purpose)), stage.index(("COPY", source)))

    def test_the_image_has_every_library_that_the_binary_needs(self):
        self.assertIn(" deploy/container/libraries build/release/tunewright >libraries.txt", str(self.binary))
        run = next(rest for rest in self.values("RUN") if "apt-get install" in rest)
        self.assertRegex(run, r"--no-install-recommends( [a-z-]+)* \$\(cat /tmp/libraries.txt\)")
        named = subprocess.run([ROOT / "deploy" / "container" / "libraries", BINARY], capture_output=True, text=True,
                               check=True).stdout.split()
        listed = subprocess.run(["objdump", "-p", BINARY], capture_output=True, text=True, check=True).stdout
        libraries = [name for name in re.findall(r"NEEDED\s+(\S+)", listed) if not name.startswith(SANITIZERS)]
        self.assertIn("libnlopt.so.0", libraries)
        files = set()
        for package in named:
            shown = subprocess.run(["dpkg-query", "-L", package], capture_output=True, text=True)
            self.assertEqual(shown.returncode, 0, package + " is no package that is installed here")
            files |= {os.path.basename(line) for line in shown.stdout.splitlines()}
        self.assertEqual([library for library in libraries if library not in files], [])
        # No other packages: at most one for each library.
        self.assertLessEqual(len(named), len(libraries))

    def test_one_line_says_which_debian(self):
        text = (ROOT / "Dockerfile").read_text()
        self.assertEqual(len(re.findall(r"^ARG DEBIAN=[a-z]+$", text, re.M)), 1)
        self.assertEqual(set(re.findall(r"^FROM (\S+)", text, re.M)), {"debian:$DEBIAN-slim"})

    def test_the_version_is_the_programs(self):
        version = re.search(r"project\(tunewright VERSION ([0-9.]+)", (ROOT / "CMakeLists.txt").read_text()).group(1)
        self.assertIn("VERSION=" + version, self.values("ARG"))
        shown = subprocess.run([BINARY, "--version"], capture_output=True, text=True, check=True).stdout
        self.assertIn(version, shown)

    def test_the_image_says_what_it_is(self):
        labels = dict(word.split("=", 1) for word in shlex.split(self.values("LABEL")[0]))
        prefix = "org.opencontainers.image."
        self.assertEqual(set(labels), {prefix + name for name in ("title", "description", "licenses", "version", "source")})
        self.assertEqual((labels[prefix + "licenses"], labels[prefix + "version"]), ("MIT", "$VERSION"))
        self.assertTrue((ROOT / "LICENSE").read_text().startswith("MIT License"))
        self.assertTrue(all(labels.values()))

    def test_it_runs_as_a_number_that_owns_its_folder_alone(self):
        self.assertEqual(self.values("USER"), [str(USER)])
        run = next(rest for rest in self.values("RUN") if "useradd" in rest)
        self.assertIn("useradd --uid %d " % USER, run)
        self.assertIn("install -d -o tunewright -g tunewright " + self.values("VOLUME")[0], run)
        order = [name for name, _ in self.last]
        self.assertNotIn("RUN", order[order.index("USER"):])


class BillOfMaterialsTest(unittest.TestCase):
    def test_it_names_version_and_licence_of_each_package(self):
        done = subprocess.run([ROOT / "deploy" / "container" / "sbom", "libc6"], capture_output=True, text=True, check=True)
        name, version, architecture, source, licence = done.stdout.splitlines()[0].split("\t")
        self.assertEqual((name, source.split()[0], licence), ("libc6", "glibc", "/usr/share/doc/libc6/copyright"))
        installed = subprocess.run(["dpkg-query", "-W", "-f", "${Version} ${Architecture}", "libc6:" + architecture],
                                   capture_output=True, text=True, check=True).stdout
        self.assertEqual(version + " " + architecture, installed)


class KeysTest(unittest.TestCase):
    """As documented: the key is made inside, by the user of the service, in the folder of the volume."""

    def test_the_user_of_the_image_makes_keys_and_reads_them(self):
        folder = tempfile.TemporaryDirectory(prefix="tunewright-container-")
        self.addCleanup(folder.cleanup)
        place = pathlib.Path(folder.name)
        program = place / "tunewright"
        shutil.copy(BINARY, program)
        program.chmod(0o755)
        place.chmod(0o711)
        data = place / "data"
        data.mkdir(mode=0o700)
        as_user = {}
        if os.getuid() == 0:
            os.chown(data, USER, USER)
            as_user = {"user": USER, "group": USER, "extra_groups": []}
        keys = str(data / "keys")
        made = subprocess.run([program, "key", "line-1", "--keys", keys], capture_output=True, text=True, cwd="/", **as_user)
        self.assertEqual(made.returncode, 0, made.stderr)
        self.assertEqual(os.stat(keys).st_mode & 0o777, 0o600)

        environment = {**os.environ, "TUNEWRIGHT_LISTEN": "0.0.0.0:0", "TUNEWRIGHT_AUTH": "keys", "TUNEWRIGHT_KEYS": keys,
                       "TUNEWRIGHT_STORE": "sqlite:%s/jobs.db" % data, "TUNEWRIGHT_ALLOW_ANONYMOUS": "true"}
        service = subprocess.Popen([program, "serve"], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=environment,
                                   cwd="/", **as_user)
        self.addCleanup(service.communicate)
        self.addCleanup(service.terminate)
        port = re.search(r":(\d+)/?\s*$", service.stdout.readline()).group(1)
        asked = "http://127.0.0.1:%s/v1/jobs" % port
        with self.assertRaises(urllib.error.HTTPError) as refused:
            urllib.request.urlopen(asked, timeout=30)
        self.assertEqual(refused.exception.code, 401)
        refused.exception.close()
        call = urllib.request.Request(asked, headers={"Authorization": "Bearer " + made.stdout.strip()})
        with urllib.request.urlopen(call, timeout=30) as answer:
            self.assertEqual(answer.status, 200)


if __name__ == "__main__":
    unittest.main()
