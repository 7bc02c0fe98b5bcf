"""The parts of script/release that need no compiler: images and bills of materials."""

import gzip
import hashlib
import io
import json
import os
import pathlib
import re
import subprocess
import tarfile
import tempfile
import unittest

from service import ROOT

CONTAINER = ROOT / "deploy" / "container"
ENVIRONMENT = {**os.environ, "SOURCE_DATE_EPOCH": "1700000000"}


def text(name):
    return (ROOT / name).read_text()


class ImageTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="tunewright-image-")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def image(self, name, order):
        """An archive of a root whose files were made in this order."""
        root = self.folder / name
        files = {"opt/tunewright/bin/tunewright": b"program", "etc/passwd": b"root", "var/lib/tunewright/.keep": b""}
        for path in order(files):
            (root / path).parent.mkdir(parents=True, exist_ok=True)
            (root / path).write_bytes(files[path])
        (root / "opt/tunewright/bin/tunewright").chmod(0o755)
        (root / "lib").symlink_to("usr/lib")
        archive = self.folder / (name + ".tar")
        subprocess.run([CONTAINER / "oci", "1.2.3", archive, "arm64=%s" % root, "amd64=%s" % root], check=True, env=ENVIRONMENT)
        return archive.read_bytes()

    def test_equal_roots_become_equal_archives(self):
        self.assertEqual(self.image("one", sorted), self.image("two", lambda files: sorted(files, reverse=True)))

    def test_every_blob_has_its_digest_and_the_layer_is_what_runs(self):
        with tarfile.open(fileobj=io.BytesIO(self.image("one", sorted))) as archive:
            files = {entry.name: archive.extractfile(entry).read() for entry in archive}
        for name, content in files.items():
            if name.startswith("blobs/"):
                self.assertEqual(name, "blobs/sha256/" + hashlib.sha256(content).hexdigest())

        def blob(descriptor):
            content = files["blobs/" + descriptor["digest"].replace(":", "/")]
            self.assertEqual(len(content), descriptor["size"])
            return content

        index = json.loads(blob(json.loads(files["index.json"])["manifests"][0]))
        self.assertEqual([image["platform"]["architecture"] for image in index["manifests"]], ["amd64", "arm64"])
        manifest = json.loads(blob(index["manifests"][1]))
        config = json.loads(blob(manifest["config"]))
        layer = gzip.decompress(blob(manifest["layers"][0]))
        self.assertEqual(config["rootfs"]["diff_ids"], ["sha256:" + hashlib.sha256(layer).hexdigest()])
        with tarfile.open(fileobj=io.BytesIO(layer)) as archive:
            entries = {entry.name: entry for entry in archive}
        program = entries[config["config"]["Entrypoint"][0].lstrip("/")]
        self.assertEqual((program.mode & 0o777, program.uid, program.mtime), (0o755, 0, 1700000000))
        self.assertEqual(entries["var/lib/tunewright"].uid, int(config["config"]["User"]))
        self.assertEqual(entries["lib"].linkname, "usr/lib")

    def test_it_runs_as_the_dockerfile_says(self):
        """The words of the Dockerfile are those of the image that is made without it."""
        dockerfile, script = text("Dockerfile"), (CONTAINER / "oci").read_text()
        for words in ("TUNEWRIGHT_LISTEN=0.0.0.0:8080", "TUNEWRIGHT_ALLOW_ANONYMOUS=true", "/opt/tunewright/bin/tunewright",
                      "10001", "Tunes PID controllers over HTTP, in a browser and on the command line"):
            self.assertIn(words, dockerfile)
            self.assertIn(words, script)


class BillOfMaterialsTest(unittest.TestCase):
    def bill(self, names, packages, more):
        with tempfile.TemporaryDirectory(prefix="tunewright-bill-") as folder:
            pathlib.Path(folder, "packages").write_text(packages)
            pathlib.Path(folder, "more").write_text(json.dumps(more))
            return subprocess.run([CONTAINER / "cyclonedx", "1.2.3", "trixie", "arm64", folder + "/packages", folder + "/more"],
                                  input=names, capture_output=True, text=True, env=ENVIRONMENT)

    def test_it_has_libraries_headers_and_the_pages_packages_and_nothing_else(self):
        page = {"dependencies": {"katex": {"version": "1.0", "dependencies": {"@x/y": {"version": "2.0"}}}, "absent": {}}}
        packages = "libc6\t2.41-12+deb13u1\tamd64\nlibc6\t2.41-12+deb13u2\tarm64\nlibeigen3-dev\t3.4\tall\nbash\t5\tarm64\n"
        done = self.bill("libc6 (>= 2.34)", packages, page)
        bill = json.loads(done.stdout)
        self.assertEqual([component["purl"] for component in bill["components"]],
                         ["pkg:deb/debian/libc6@2.41-12%2Bdeb13u2?arch=arm64&distro=trixie",
                          "pkg:deb/debian/libeigen3-dev@3.4?arch=all&distro=trixie", "pkg:npm/%40x/y@2.0", "pkg:npm/katex@1.0"])
        self.assertEqual(bill["metadata"]["timestamp"], "2023-11-14T22:13:20Z")
        self.assertEqual(done.stdout, self.bill("libc6 (>= 2.34)", packages, page).stdout)
        image = json.loads(self.bill("bash\nlibc6\n", packages, bill).stdout)
        self.assertEqual(len(image["components"]), 5)

    def test_a_library_may_be_named_by_what_its_package_provides(self):
        packages = "libspdlog1.10\t1:1.10\tarm64\tlibspdlog1.10-fmt9, libspdlog-abi (= 1)\n"
        done = self.bill("libspdlog1.10-fmt9, libspdlog1.10 (>= 1)", packages, {})
        self.assertEqual([component["name"] for component in json.loads(done.stdout)["components"]], ["libspdlog1.10"])

    def test_a_library_without_a_version_is_an_error(self):
        done = self.bill("libc6, libgone1", "libc6\t2.41\tarm64\n", {})
        self.assertIn("libgone1", done.stderr)
        self.assertNotEqual(done.returncode, 0)


class VersionTest(unittest.TestCase):
    def test_every_file_that_states_the_version_states_the_same(self):
        version = re.search(r"project\(tunewright VERSION ([0-9.]+)", text("CMakeLists.txt")).group(1)
        self.assertIn("Tunewright %s is ready" % version, text("README.md"))
        self.assertIn("newTag: %s\n" % version, text("deploy/kubernetes/kustomization.yaml"))
        self.assertIn('version = "%s"' % version, text("api/clients/python/pyproject.toml"))
        self.assertEqual(json.loads(text("web/package.json"))["version"], version)
        self.assertEqual(json.loads(text("web/package-lock.json"))["version"], version)
        self.assertIn("## %s\n" % version, text("CHANGELOG.md"))


if __name__ == "__main__":
    unittest.main()
