#!/usr/bin/python3
"""Checks the includes of the sources: each part and each folder includes only those it may, without cycles, and headers
outside the engine do not include a matrix library."""
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]

# Parts may include themselves and those named.
PARTS = {"engine": set(), "api": {"engine"}, "server": {"api", "engine"}}

# Folders of a part, each with those that it may include in addition to itself and the files at the top. A file at the
# top may have a line of its own, by its stem; "top" are the others, which all may include.
ROOMS = {
    "engine": {
        "top": set(),
        "numerics": set(),
        "plant": {"numerics"},
        "controller": {"numerics"},
        "code": {"controller", "numerics"},
        "loop": {"plant", "controller", "numerics"},
        "simulation": {"loop", "plant", "controller", "numerics"},
        "blocks": {"simulation", "loop", "plant", "controller", "numerics"},
        "reduction": {"simulation", "loop", "plant", "numerics"},
        "identification": {"simulation", "loop", "plant", "controller", "numerics"},
        "evaluation": {"simulation", "loop", "plant", "controller", "numerics"},
        "certificate": {"simulation", "loop", "plant", "controller", "numerics"},
        "tuning": {"certificate", "evaluation", "reduction", "simulation", "loop", "plant", "controller", "numerics"},
        "score": {"certificate", "tuning", "evaluation", "reduction", "plant", "controller"},
        "verify": {"blocks", "evaluation", "simulation", "loop", "plant", "controller", "numerics"},
        "check": {"identification", "simulation", "loop", "plant", "controller", "numerics"},
        "structure": {"blocks", "code", "tuning", "evaluation", "simulation", "loop", "plant", "controller", "numerics"},
        "range": {"tuning", "evaluation", "simulation", "loop", "plant", "controller", "numerics"},
        "request": {"check", "range", "evaluation", "tuning", "identification", "reduction", "simulation", "loop", "plant",
                    "controller", "numerics"},
    },
    "engine/tuning": {
        "device": set(),
        "method": {"device"},
        "reaction_curve": {"method", "device"},
        "ultimate": {"method", "device"},
        "model_based": {"method", "device", "reaction_curve"},
        "arrieta": {"method", "device"},
        "npid": {"method", "device"},
        "formula": {"method", "device"},
        "rimc": {"method", "device", "model_based"},
        "robust": {"method", "device", "reaction_curve"},
        # The first level is designed by any other method, chosen by its id.
        "emulation": {"method", "device", "model_based", "ultimate", "robust", "registry"},
        "registry": {"method", "reaction_curve", "ultimate", "model_based", "arrieta", "npid", "rimc", "robust",
                     "emulation", "formula"},
    },
    "api": {
        "json": set(),
        "embed": set(),
        "formula": set(),
        "outcome": {"json"},
        "describe": {"json"},
        "csv": {"describe", "json"},
        "contract": {"certificate", "csv", "describe", "formula", "json"},
        "historian": {"csv", "describe", "json"},
        "certificate": {"chosen_entry", "embed", "json"},
        "chosen_entry": {"csv", "json"},
        "code": {"chosen_entry", "contract", "csv", "describe", "json"},
        "report": {"chosen_entry", "contract", "embed", "json"},
        "examples": {"outcome", "contract", "describe", "embed", "json"},
        "openapi": {"examples", "contract", "describe", "embed"},
        "outline": {"contract", "json"},
        "shorthand": {"contract", "csv", "json"},
        "registries": {"outcome", "contract", "describe", "formula"},
        "services": {"outcome", "certificate", "chosen_entry", "code", "contract", "csv", "describe", "historian", "json"},
        "service": {"outcome", "outline", "services", "shorthand", "contract", "describe", "json"},
        "batch": {"service", "contract", "historian", "csv", "describe", "json"},
        "mcp": {"outcome", "service", "code", "report", "registries", "contract", "describe", "json"},
    },
    "server": {
        "top": set(),
        "threads": set(),
        "http": set(),
        "access": {"http"},
        "store": set(),
        "jobs": {"store", "threads"},
        "notify": {"access", "store", "threads"},
        "config": {"access", "store"},
        "metrics": {"config", "http", "jobs", "notify"},
        "routes": {"access", "http", "jobs", "metrics", "notify", "store", "threads"},
        "startup_server": {"config", "http", "routes", "store"},
        "serve": {"access", "config", "http", "jobs", "startup_server", "metrics", "notify", "routes", "store", "threads"},
        "cli": {"access", "config", "http", "notify", "serve", "store", "threads"},
        "main": {"cli"},
    },
}

INCLUDE = re.compile(r'^#include "((?:engine|api|server)/[^"]+)"', re.MULTILINE)
# It costs a second of compile time for each source that includes it, and the engine's answers do not use it.
EIGEN = re.compile(r"^#include <(?:unsupported/)?Eigen/", re.MULTILINE)


def room(path: str, level: str) -> str:
    """The folder of a path below a level: for engine/plant/linear/factor.h below "engine" it is plant; for a file at
    the top its stem if that has a line, else "top"."""
    names = path[len(level) + 1:].split("/")
    stem = names[0].split(".")[0]
    return names[0] if len(names) > 1 else stem if stem in ROOMS[level] else "top"


def wrong_arrows(includes: dict[str, list[str]]) -> list[str]:
    """One sentence for each include in the wrong direction."""
    wrong = []
    for source, headers in sorted(includes.items()):
        part = source.split("/")[0]
        for header in headers:
            other = header.split("/")[0]
            if other != part and other not in PARTS[part]:
                wrong.append(f"{source} includes {header}: {part} must not use {other}.")
            for level in ROOMS:
                if source.startswith(level + "/") and header.startswith(level + "/"):
                    here, there = room(source, level), room(header, level)
                    if there not in {here, "top"} | ROOMS[level].get(here, set()):
                        wrong.append(f"{source} includes {header}: {here} of {level} must not use {there}.")
    return wrong


def circles() -> list[str]:
    """One sentence for each level whose table has a cycle: folders that cannot be ordered."""
    wrong = []
    for level, rooms in ROOMS.items():
        # The registry names every method, and the first level of emulation looks them up there.
        left = {name: uses - {"registry"} if name == "emulation" else set(uses) for name, uses in rooms.items()}
        while free := [name for name, uses in left.items() if not uses & set(left)]:
            left = {name: uses for name, uses in left.items() if name not in free}
        if left:
            wrong.append(f"The rooms {', '.join(sorted(left))} of {level} use each other in a circle.")
    return wrong


def ways_to_eigen(includes: dict[str, list[str]], with_eigen: set[str]) -> list[str]:
    """One sentence for each source or header outside the engine that includes Eigen, with the chain of includes."""
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
    faults += circles()
    for level, rooms in ROOMS.items():
        here = {room(name, level) for name in includes if name.startswith(level + "/")} - {"top"}
        faults += [f"{level}/{name} has no line in tests/house/arrows_test.py." for name in sorted(here - set(rooms))]
        faults += [f"tests/house/arrows_test.py has a line for {level}/{name}, which is not there."
                   for name in sorted(set(rooms) - here - {"top"})]
    # The check itself must find an include in the wrong direction.
    turned = wrong_arrows({"engine/plant/plant.h": ["engine/loop/loop.h"], "engine/error.h": ["api/outcome.h"],
                           "engine/tuning/method/method.h": ["engine/tuning/robust/robust.h"],
                           "engine/progress.h": ["engine/controller/pid.h"], "server/store/queue.h": ["server/jobs/service.h"],
                           "server/log.cpp": ["server/http/app/router.h"], "api/outline.cpp": ["api/service.h"]})
    if len(turned) != 7:
        faults.append("The check does not see arrows that are turned on purpose.")
    seen = ways_to_eigen({"api/a.h": ["engine/b.h"], "engine/b.h": ["engine/c.h"], "engine/c.h": []}, {"engine/c.h"})
    if len(seen) != 1 or "api/a.h includes engine/b.h includes engine/c.h" not in seen[0]:
        faults.append("The check does not see Eigen behind two headers.")
    print("\n".join(faults) if faults else f"{len(includes)} files keep the arrows.")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
