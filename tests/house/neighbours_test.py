#!/usr/bin/python3
"""Checks sources that are compiled together (CMakeLists.txt: tunewright_unity), which see each other's anonymous
names. Two functions with one name and different parameters compile, and a call may silently use the neighbour's: no
helper of a test may have the name of a neighbour's helper, or of a function that a neighbour uses from a header of
the tests."""
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
TOGETHER = 6  # as in tests/CMakeLists.txt
ROOMS = ("engine", "api", "server", "papers", "records")
INCLUDE = re.compile(r'^#include "([^"]+)"', re.MULTILINE)
DEFINED = re.compile(r"^(?!TEST|return|namespace|using)[A-Za-z_][\w:<>,&* \[\]]*?[ &*]([a-z_]\w*)\([^;]*\)(?: const)? *\{",
                     re.MULTILINE)
DECLARED = re.compile(r"^[A-Za-z_][\w:<>,&* \n\[\]]*?[ &*]([a-z_]\w*)\(", re.MULTILINE)


def headers_of(source: pathlib.Path, known: set[pathlib.Path]) -> set[pathlib.Path]:
    """The headers of the tests that a source includes, directly and indirectly."""
    for name in INCLUDE.findall(source.read_text()):
        for header in (ROOT / name, source.parent / name):
            if header.exists() and header.is_relative_to(ROOT / "tests") and header not in known:
                known.add(header)
                headers_of(header, known)
    return known


def declared(headers: set[pathlib.Path]) -> set[str]:
    return {name for header in headers for name in DECLARED.findall(header.read_text())}


def hidden(group: list[pathlib.Path]) -> list[str]:
    """One sentence for each name that occurs twice in a group."""
    taken = {source: declared(headers_of(source, set())) for source in group}
    own = {source: set(DEFINED.findall(source.read_text())) - taken[source] for source in group}
    return [
        f"{name} of {source.relative_to(ROOT)} is also known in {other.relative_to(ROOT)}, which is compiled with it; "
        "give it a name of its own."
        for source in group for name in sorted(own[source]) for other in group
        if other != source and name in own[other] | taken[other]
    ]


def groups() -> list[list[pathlib.Path]]:
    folders = sorted({source.parent for room in ROOMS for source in (ROOT / "tests" / room).rglob("*.cpp")})
    all_of = [sorted(folder.glob("*.cpp")) for folder in folders]
    return [sources[i:i + TOGETHER] for sources in all_of for i in range(0, len(sources), TOGETHER)]


def main() -> int:
    sentences = [sentence for group in groups() for sentence in hidden(group)]
    for sentence in sentences:
        print(sentence)
    if not sentences:
        print(f"{len(groups())} groups have no name twice.")
    return 1 if sentences else 0


if __name__ == "__main__":
    sys.exit(main())
