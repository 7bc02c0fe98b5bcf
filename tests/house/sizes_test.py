#!/usr/bin/python3
"""Holds the sizes of the house: entries of a folder, lines of a file, and how many files are very short."""
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
PARTS = ("engine", "api", "server", "tests", "web/src", "bench")
SOURCES = (".h", ".cpp", ".ts", ".py", ".mjs", ".css")
GENERATED = (".gen.ts",)
MOST_ENTRIES = 30
MOST_LINES = 400
# A header that is the narrow face of a large source may be short; many of them are a tree that nobody finds his way in.
SHORT = 30
MOST_SHORT_FILES = 40


def faults(lines: dict[str, int]) -> list[str]:
    """One sentence for each fault; `lines` has the number of lines of each file by its path."""
    found = []
    entries: dict[str, set[str]] = {}
    for path in lines:
        names = path.split("/")
        for depth in range(1, len(names)):
            entries.setdefault("/".join(names[:depth]), set()).add(names[depth])
    for folder, inside in sorted(entries.items()):
        if folder.startswith(PARTS) and len(inside) > MOST_ENTRIES:
            found.append(f"{folder} has {len(inside)} entries; part it into rooms of at most {MOST_ENTRIES}.")
    sources = {path: n for path, n in lines.items()
               if path.endswith(SOURCES) and path.startswith(PARTS) and not path.endswith(GENERATED)}
    found += [f"{path} has {n} lines; part it where it holds two things, at most {MOST_LINES}."
              for path, n in sorted(sources.items()) if n > MOST_LINES]
    short = [path for path, n in sources.items() if n < SHORT]
    if len(short) > MOST_SHORT_FILES:
        found.append(f"{len(short)} files have fewer than {SHORT} lines, more than {MOST_SHORT_FILES}; join what is "
                     f"always read together: {', '.join(sorted(short))}.")
    return found


def tracked() -> dict[str, int]:
    names = subprocess.run(["git", "-C", str(ROOT), "ls-files", "-z"], check=True, capture_output=True).stdout
    paths = [ROOT / name.decode() for name in names.split(b"\0") if name]
    return {str(path.relative_to(ROOT)): path.read_bytes().count(b"\n") for path in paths if path.is_file()}


def main() -> int:
    found = faults(tracked())
    # The check itself must see what is too much.
    crowded = {f"engine/a/{i}.h": 10 for i in range(MOST_SHORT_FILES + 1)} | {"api/long.cpp": MOST_LINES + 1}
    if len(faults(crowded)) != 3:
        found.append("The check does not see sizes that are too large on purpose.")
    print("\n".join(found) if found else "The sizes hold.")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
