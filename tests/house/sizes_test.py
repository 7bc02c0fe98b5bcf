#!/usr/bin/python3
"""Checks sizes: entries of a folder, lines of a file, and the number of very short files. A source is split by idea,
not at a count: a long one is listed, and fails only above the limit for any reader."""
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
PARTS = ("engine", "api", "server", "tests", "web/src", "bench")
SOURCES = (".h", ".cpp", ".ts", ".py", ".mjs", ".css")
GENERATED = (".gen.ts",)
MOST_ENTRIES = 30
LONG = 600
MOST_LINES = 900
# Many files with little content make a tree hard to navigate. The narrow header of a larger source does not count.
SHORT = 30
MOST_SHORT_FILES = 20


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
    short = [path for path, n in sources.items()
             if n < SHORT and not (path.endswith(".h") and sources.get(path[:-2] + ".cpp", 0) >= SHORT)]
    if len(short) > MOST_SHORT_FILES:
        found.append(f"{len(short)} files have fewer than {SHORT} lines, more than {MOST_SHORT_FILES}; join what is "
                     f"always read together: {', '.join(sorted(short))}.")
    return found


def long_ones(lines: dict[str, int]) -> list[str]:
    """One sentence for each source that may contain two ideas."""
    return [f"{path} has {n} lines, more than {LONG}; does it hold two things?" for path, n in sorted(lines.items())
            if LONG < n <= MOST_LINES and path.endswith(SOURCES) and path.startswith(PARTS)]


def tracked() -> dict[str, int]:
    names = subprocess.run(["git", "-C", str(ROOT), "ls-files", "-z"], check=True, capture_output=True).stdout
    paths = [ROOT / name.decode() for name in names.split(b"\0") if name]
    return {str(path.relative_to(ROOT)): path.read_bytes().count(b"\n") for path in paths if path.is_file()}


def main() -> int:
    lines = tracked()
    found = faults(lines)
    # The check itself must find excess.
    crowded = {f"engine/a/{i}.h": 10 for i in range(max(MOST_ENTRIES, MOST_SHORT_FILES) + 1)} | {"api/long.cpp": MOST_LINES + 1}
    faces = {f"engine/a/{i}{end}": n for i in range(MOST_ENTRIES // 2) for end, n in ((".h", 10), (".cpp", SHORT))}
    if len(faults(crowded)) != 3 or faults(faces) or len(long_ones({"api/long.cpp": LONG + 1})) != 1:
        found.append("The check does not see sizes that are too large on purpose.")
    print("\n".join(long_ones(lines) + (found or ["The sizes hold."])))
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
