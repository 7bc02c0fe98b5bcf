"""Writes the wheel and the source archive of the client for pip (PEP 517) with the standard library alone.

py.typed tells type checkers to use the package's annotations (PEP 561). Name, version and description are those of
pyproject.toml.
"""

import base64
import gzip
import hashlib
import io
import os
import pathlib
import re
import tarfile
import zipfile
from typing import Any, Dict, Optional, Tuple

HERE = pathlib.Path(__file__).resolve().parents[1]
MODULES = sorted((HERE / "tunewright").glob("*.py"))
SOURCES = ("README.md", "backend/wheel_backend.py", "pyproject.toml", *("tunewright/" + path.name for path in MODULES))


def project() -> Dict[str, str]:
    """The texts of the table [project]. The standard library reads TOML only since Python 3.11."""
    table = (HERE / "pyproject.toml").read_text("utf-8").split("[project]")[1].split("\n[")[0]
    return dict(re.findall(r'^([\w-]+) = "(.*)"$', table, re.MULTILINE))


def build_wheel(wheel_directory: str, config_settings: Optional[Dict[str, Any]] = None,
                metadata_directory: Optional[str] = None) -> str:
    name = _name()
    files = {
        **{"tunewright/" + path.name: path.read_bytes() for path in MODULES},
        "tunewright/py.typed": b"",
        name + ".dist-info/METADATA": _metadata(),
        name + ".dist-info/WHEEL": b"Wheel-Version: 1.0\nGenerator: tunewright\nRoot-Is-Purelib: true\nTag: py3-none-any\n",
    }
    record = name + ".dist-info/RECORD"
    files[record] = "".join(map(_row, files.items())).encode() + record.encode() + b",,\n"
    wheel = name + "-py3-none-any.whl"
    with zipfile.ZipFile(os.path.join(wheel_directory, wheel), "w", zipfile.ZIP_DEFLATED) as archive:
        for path, content in files.items():
            archive.writestr(zipfile.ZipInfo(path), content, zipfile.ZIP_DEFLATED)  # no date: equal wheels
    return wheel


def build_sdist(sdist_directory: str, config_settings: Optional[Dict[str, Any]] = None) -> str:
    name = _name()
    archived = io.BytesIO()
    with tarfile.open(fileobj=archived, mode="w", format=tarfile.PAX_FORMAT) as archive:
        for path, content in [("PKG-INFO", _metadata()), *((path, (HERE / path).read_bytes()) for path in SOURCES)]:
            entry = tarfile.TarInfo("%s/%s" % (name, path))  # no date and no owner: equal archives
            entry.size = len(content)
            archive.addfile(entry, io.BytesIO(content))
    sdist = name + ".tar.gz"
    pathlib.Path(sdist_directory, sdist).write_bytes(gzip.compress(archived.getvalue(), mtime=0))
    return sdist


def _name() -> str:
    return "%(name)s-%(version)s" % project()


def _metadata() -> bytes:
    head = ("Metadata-Version: 2.1\nName: %(name)s\nVersion: %(version)s\nSummary: %(description)s\nLicense: MIT\n"
            "Requires-Python: %(requires-python)s\nDescription-Content-Type: text/markdown\n\n" % project())
    return head.encode() + (HERE / "README.md").read_bytes()


def _row(file: Tuple[str, bytes]) -> str:
    path, content = file
    digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=").decode()
    return "%s,sha256=%s,%d\n" % (path, digest, len(content))
