#!/usr/bin/python3
"""Checks the words of the engine: it deals with numbers, plants and controllers, and mentions neither JSON and HTTP
nor the contract of the service with its clients, in code, comments or messages."""
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
FOREIGN = {
    "JSON": re.compile(r"\bJSON\b"),
    "HTTP": re.compile(r"\bHTTP\b|\b(?:GET|POST|PUT|PATCH|DELETE) /|/v1/"),
    "the contract": re.compile(r"\b[Cc]ontract(?:'s)?\b"),
    "the text of a JSON object": re.compile(r'\{\\"\w+\\":|\\"\w+\\": (?:\\"|true|false|\d|")'),
}


def faults(texts: dict[str, str]) -> list[str]:
    """One sentence for each line that has a foreign word."""
    return [f"{path}:{number} speaks of {what}; that is the business of api: {line.strip()[:100]}"
            for path, text in sorted(texts.items()) for number, line in enumerate(text.splitlines(), 1)
            for what, word in FOREIGN.items() if word.search(line)]


def main() -> int:
    paths = [path for path in (ROOT / "engine").rglob("*") if path.suffix in (".h", ".cpp")]
    found = faults({str(path.relative_to(ROOT)): path.read_text(encoding="utf-8") for path in paths})
    wrong = '// as in JSON\n"Ask GET /v1/methods."\n// the contract\'s word\n"Give filter {\\"Tf\\": 1}."\n"Use \\"exact\\": true."\n'
    if len(faults({"engine/a.cpp": wrong})) != 5:
        found.append("The check does not see words that are foreign on purpose.")
    print("\n".join(found) if found else f"{len(paths)} files of the engine keep to its words.")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
