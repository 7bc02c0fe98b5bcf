#!/usr/bin/python3
"""Holds the arrows of the house: which part and which room of the engine may include which, and that no matrix comes out
of the engine, read from the includes."""
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]

# Parts may include themselves and what is named.
PARTS = {"engine": set(), "api": {"engine"}, "server": {"api", "engine"}}

# Rooms of the engine, each with those that it may include beside itself and the files at the engine's top.
ROOMS = {
    "numerics": set(),
    "plant": {"numerics"},
    "controller": {"numerics"},
    "code": {"controller", "numerics"},
    "loop": {"plant", "controller", "numerics"},
    "simulation": {"loop", "plant", "controller", "numerics"},
    "reduction": {"simulation", "loop", "plant", "numerics"},
    "identification": {"simulation", "loop", "plant", "numerics"},
    "evaluation": {"simulation", "loop", "plant", "controller", "numerics"},
    "tuning": {"evaluation", "reduction", "simulation", "loop", "plant", "controller", "numerics"},
    "range": {"tuning", "evaluation", "simulation", "loop", "plant", "controller", "numerics"},
    "request": {"range", "evaluation", "tuning", "identification", "reduction", "simulation", "loop", "plant",
                "controller", "numerics"},
}
# What stands at the engine's top is for all rooms and uses none, but for the controller that progress shows.
TOP_MAY_USE = {"controller"}

INCLUDE = re.compile(r'^#include "((?:engine|api|server)/[^"]+)"', re.MULTILINE)
# A second of compiling for each source that sees it, and nothing of it in the engine's answers.
EIGEN = re.compile(r"^#include <(?:unsupported/)?Eigen/", re.MULTILINE)


def room(path: str) -> str:
    """The engine's room of a path such as engine/plant/linear/factor.h; "top" for engine/error.h."""
    names = path.split("/")
    return names[1] if len(names) > 2 else "top"


def wrong_arrows(includes: dict[str, list[str]]) -> list[str]:
    """One sentence for each include that turns an arrow."""
    wrong = []
    for source, headers in sorted(includes.items()):
        part = source.split("/")[0]
        for header in headers:
            other = header.split("/")[0]
            if other != part:
                if other not in PARTS[part]:
                    wrong.append(f"{source} includes {header}: {part} must not use {other}.")
            elif part == "engine":
                here, there = room(source), room(header)
                allowed = TOP_MAY_USE if here == "top" else ROOMS.get(here, set()) | {"top"}
                if there != here and there not in allowed:
                    wrong.append(f"{source} includes {header}: room {here} must not use room {there}.")
    return wrong


def ways_to_eigen(includes: dict[str, list[str]], with_eigen: set[str]) -> list[str]:
    """One sentence for each source or header outside the engine that sees Eigen, with the way there."""
    wrong = []
    for source in sorted(name for name in includes if not name.startswith("engine/")):
        came_from, open_ends = {source: ""}, [source]
        for name in open_ends:
            for header in includes.get(name, []):
                if header not in came_from:
                    came_from[header] = name
                    open_ends.append(header)
        for header in sorted(with_eigen & set(came_from)):
            way = [header]
            while came_from[way[-1]]:
                way.append(came_from[way[-1]])
            wrong.append(f"{' includes '.join(reversed(way))}, which includes Eigen; keep it in headers of the engine's "
                         "own sources.")
    return wrong


def sources() -> list[pathlib.Path]:
    return [path for part in PARTS for path in (ROOT / part).rglob("*") if path.suffix in (".h", ".cpp")]


def main() -> int:
    texts = {str(p.relative_to(ROOT)): p.read_text(encoding="utf-8") for p in sources()}
    includes = {name: INCLUDE.findall(text) for name, text in texts.items()}
    faults = wrong_arrows(includes) + ways_to_eigen(includes, {name for name in texts if EIGEN.search(texts[name])})
    rooms = {room(name) for name in includes if name.startswith("engine/")} - {"top"}
    faults += [f"engine/{name} has no line in tests/house/arrows_test.py." for name in sorted(rooms - set(ROOMS))]
    # The check itself must see a turned arrow.
    turned = wrong_arrows({"engine/plant/plant.h": ["engine/loop/loop.h"], "engine/error.h": ["api/problem.h"]})
    if len(turned) != 2:
        faults.append("The check does not see arrows that are turned on purpose.")
    seen = ways_to_eigen({"api/a.h": ["engine/b.h"], "engine/b.h": ["engine/c.h"], "engine/c.h": []}, {"engine/c.h"})
    if len(seen) != 1 or "api/a.h includes engine/b.h includes engine/c.h" not in seen[0]:
        faults.append("The check does not see Eigen behind two headers.")
    print("\n".join(faults) if faults else f"{len(includes)} files keep the arrows.")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
