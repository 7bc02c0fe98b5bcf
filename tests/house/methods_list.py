#!/usr/bin/python3
"""Holds the list of methods in docs/methods.md to the registry: methods_list.py BINARY; with --write it writes the list."""
import json
import pathlib
import subprocess
import sys

DOCUMENT = pathlib.Path(__file__).resolve().parents[2] / "docs" / "methods.md"
BEGIN = "<!-- The list down to the next mark is made from the registry: tests/house/methods_list.py --write. -->\n"
END = "<!-- End of the list. -->\n"


def cell(text: str) -> str:
    return text.replace("|", "\\|")


def methods_list(binary: str) -> str:
    answer = subprocess.run([binary, "methods"], capture_output=True, text=True, check=True)
    rows = ["| id | method | works on | range | source |", "| --- | --- | --- | --- | --- |"]
    for method in json.loads(answer.stdout)["methods"]:
        cells = [f"`{method['id']}`", *(cell(method[name]) for name in ("title", "needs", "validity", "source"))]
        rows.append("| " + " | ".join(cells) + " |")
    return "\n".join(rows) + "\n"


def main() -> int:
    write = "--write" in sys.argv
    binary = next(argument for argument in sys.argv[1:] if argument != "--write")
    document = DOCUMENT.read_text(encoding="utf-8")
    before, rest = document.split(BEGIN)
    _, after = rest.split(END)
    current = before + BEGIN + methods_list(binary) + END + after
    if write:
        DOCUMENT.write_text(current, encoding="utf-8")
    elif current != document:
        print("docs/methods.md does not list the methods of the registry. Run tests/house/methods_list.py --write "
              f"{binary}.")
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
