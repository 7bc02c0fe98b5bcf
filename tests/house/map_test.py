#!/usr/bin/python3
"""Checks the map of the tree: a source has a header with its name, a folder has a README, and a README names its
contents.

Sources of the listed families have no header each: one header lists them, and declares a function of each."""
import fnmatch
import pathlib
import posixpath
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
PARTS = ("engine/", "api/", "server/", "web/src/")
SOURCES = (".h", ".cpp", ".ts", ".css")

# Sources without a header of their name: the header that declares them, and the reason.
FAMILIES = {
    "engine/controller/product/catalogue/*.cpp": ("engine/controller/product/catalogue.h", "data, a maker each"),
    "engine/code/c.cpp": ("engine/code/print.h", "a printer for each language"),
    "engine/code/arduino.cpp": ("engine/code/print.h", "a printer for each language"),
    "engine/code/python.cpp": ("engine/code/print.h", "a printer for each language"),
    "engine/code/structured_text.cpp": ("engine/code/print.h", "a printer for each language"),
    "engine/request/verdict/*.cpp": ("engine/request/verdict/findings.h", "findings, a subject each"),
    "api/contract/reports/*.cpp": ("api/contract/reports/reports.h", "descriptions, a report each"),
    "api/csv/shape/*.cpp": ("api/csv/shape/shapes.h", "a layout of files each"),
    "api/mcp/tools/*_tools.cpp": ("api/mcp/tools.h", "tools, a subject each"),
    "api/report/*.cpp": ("api/report/sections.h", "sections of the report"),
    "server/cli/*.cpp": ("server/cli/command_tree.h", "commands, a group each"),
    "server/routes/*_routes.cpp": ("server/routes/routes.h", "routes, a kind of call each"),
}
ALONE = {"server/main.cpp": "the program"}

DEFINED = re.compile(r"^[A-Za-z_][\w:<>,&* ]*?[ &*](\w+)\([^;{}]*\)[^;{}]*\{", re.MULTILINE)
NAME = re.compile(r"[\w*][\w./*-]*\.(?:h|cpp|ts|css|py|mjs|cmake|md)\b|[\w.][\w./-]*/(?=$|[\s,;])")
# Headings of the first column in the tables of a README.
HEADS = re.compile(r"\| *(?:file|room|folder|file or room|file or folder|here|part)s? *\|", re.IGNORECASE)


def without_header(texts: dict[str, str]) -> list[str]:
    """One sentence for each source that has neither a header with its name nor a place in a family."""
    found = []
    for path in sorted(texts):
        if not path.endswith(".cpp") or path[:-4] + ".h" in texts or path in ALONE:
            continue
        lists = [header for family, (header, _) in FAMILIES.items() if fnmatch.fnmatchcase(path, family)]
        if not lists:
            found.append(f"{path} has no header of its name; give it one, or join it with the source of the header that "
                         "declares what it defines.")
        elif not any(re.search(rf"\b{name}\(", texts.get(lists[0], "")) for name in DEFINED.findall(texts[path])):
            found.append(f"{path} defines nothing that {lists[0]} declares; give it a header of its name.")
    return found


def rooms(paths: list[str]) -> dict[str, set[str]]:
    """The stems of the sources in each folder."""
    stems: dict[str, set[str]] = {}
    for path in paths:
        if path.startswith(PARTS) and path.endswith(SOURCES):
            folder, name = posixpath.split(path)
            stems.setdefault(folder, set()).add(name.split(".")[0])
    return stems


def unnamed(paths: list[str], readmes: dict[str, str]) -> list[str]:
    """One sentence for each folder without a README, and for each stem that its README does not name."""
    found = []
    for folder, stems in sorted(rooms(paths).items()):
        text = readmes.get(folder + "/README.md")
        if text is None:
            found.append(f"{folder} has no README.md; say what the room is for and what each file holds.")
            continue
        found += [f"{folder}/README.md does not name {stem}." for stem in sorted(stems)
                  if not re.search(rf"(?<![\w-]){re.escape(stem)}(?![\w-])", text)]
    return found


def names_in(text: str) -> set[str]:
    """Files and folders that a README names: in code marks, and in the first column of tables of files or folders."""
    text = re.sub(r"^(?: {4}|\t).*$|```.*?```", "", text, flags=re.MULTILINE | re.DOTALL)
    names = {name for marked in re.findall(r"`([^`\n]+)`", text) if not re.search(r"[{}<>=]|://|^/|^-", marked)
             for name in NAME.findall(marked)}
    of_files = False
    for line in text.splitlines():
        if not line.startswith("|"):
            of_files = False
        elif HEADS.match(line):
            of_files = True
        elif of_files:
            names |= {name for cell in re.findall(r"`([^`]+)`", line.split("|")[1]) for name in re.split(r"[\s,]+", cell)}
    return names - {""}


def ghosts(paths: list[str], readmes: dict[str, str]) -> list[str]:
    """One sentence for each name in a README that is not a file or folder there, below, or in a folder above."""
    known = set(paths) | {folder for path in paths for folder in map(str, pathlib.PurePosixPath(path).parents)}
    known |= {posixpath.splitext(path)[0] for path in paths}
    found = []
    for readme, text in sorted(readmes.items()):
        above = [str(folder) for folder in pathlib.PurePosixPath(readme).parents]
        for name in sorted(names_in(text)):
            places = [posixpath.normpath(posixpath.join(folder, name)) for folder in above]
            below = above[0] + "/*/" + name.rstrip("/")
            if not any(place in known or "*" in place and fnmatch.filter(known, place) for place in places) and \
                    not fnmatch.filter(known, below):
                found.append(f"{readme} names {name}, which is not there.")
    return found


def tracked() -> list[str]:
    names = subprocess.run(["git", "-C", str(ROOT), "ls-files", "-z"], check=True, capture_output=True).stdout
    return [name.decode() for name in names.split(b"\0") if name and (ROOT / name.decode()).is_file()]


def blind() -> list[str]:
    """Faults that the checks miss in a tree written with them."""
    wrong = {"engine/a/b.cpp": "int b() {}\n", "engine/request/verdict/c.cpp": "int c() {}\n", "server/main.cpp": ""}
    paths = ["engine/a/b.cpp", "engine/a/d.h", "engine/c/e.h", "engine/a/README.md"]
    readmes = {"engine/a/README.md": "`b` and `gone.h`, `lost/`\n\n| file | holds |\n| --- | --- |\n| `ghost` | - |\n"}
    seen = {"sources without a header": (without_header(wrong), 2), "rooms and stems": (unnamed(paths, readmes), 2),
            "names of what is gone": (ghosts(paths, readmes), 3)}
    return [f"The check does not see {what}: {found}" for what, (found, count) in seen.items() if len(found) != count]


def main() -> int:
    paths = tracked()
    texts = {path: (ROOT / path).read_text(encoding="utf-8") for path in paths
             if path.startswith(PARTS) and path.endswith((".h", ".cpp"))}
    readmes = {path: (ROOT / path).read_text(encoding="utf-8") for path in paths
               if path.endswith("README.md") and path.startswith(PARTS)}
    found = without_header(texts) + unnamed(paths, readmes) + ghosts(paths, readmes) + blind()
    print("\n".join(found) if found else f"{len(rooms(paths))} rooms have their map.")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
