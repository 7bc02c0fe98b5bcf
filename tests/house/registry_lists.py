#!/usr/bin/python3
"""Checks the lists in documents that come from the engine's registries: registry_lists.py BINARY; with --write it
updates them."""
import json
import pathlib
import subprocess
import sys

DOCS = pathlib.Path(__file__).resolve().parents[2] / "docs"
BEGIN = "<!-- The list down to the next mark is made from the registry: tests/house/registry_lists.py --write. -->\n"
END = "<!-- End of the list. -->\n"


def cell(text: str) -> str:
    return text.replace("|", "\\|")


def table(heads: list[str], rows: list[list[str]]) -> str:
    lines = ["| " + " | ".join(heads) + " |", "|" + " --- |" * len(heads)]
    lines += ["| " + " | ".join(cell(text) for text in row) + " |" for row in rows]
    return "\n".join(lines) + "\n"


def methods_list(answer: dict) -> str:
    return table(["id", "method", "works on", "range", "source"],
                 [[f"`{method['id']}`", *(method[name] for name in ("title", "needs", "validity", "source"))]
                  for method in answer["methods"]])


def controllers_list(answer: dict) -> str:
    return table(["id", "maker", "name", "form", "needs", "evidence", "parameters"],
                 [[f"`{entry['id']}`", entry["maker"], entry["name"], entry["form"],
                   ", ".join(f"`{name}`" for name in entry["needs"]), entry["evidence"],
                   ", ".join(f"`{name}`" for name in entry["parameters"])]
                  for entry in answer["controllers"]])


# For each document: the command that prints the registry, and the function that makes the list.
LISTS = {"methods.md": ("methods", methods_list), "controllers.md": ("controllers", controllers_list)}


def current_text(document: str, binary: str, command: str, make) -> str:
    answer = subprocess.run([binary, command], capture_output=True, text=True, check=True)
    before, rest = document.split(BEGIN)
    _, after = rest.split(END)
    return before + BEGIN + make(json.loads(answer.stdout)) + END + after


def main() -> int:
    write = "--write" in sys.argv
    binary = next(argument for argument in sys.argv[1:] if argument != "--write")
    bad = 0
    for name, (command, make) in LISTS.items():
        document = (DOCS / name).read_text(encoding="utf-8")
        current = current_text(document, binary, command, make)
        if write:
            (DOCS / name).write_text(current, encoding="utf-8")
        elif current != document:
            print(f"docs/{name} does not list what the registry holds. Run tests/house/registry_lists.py --write {binary}.")
            bad = 1
    return bad


if __name__ == "__main__":
    sys.exit(main())
