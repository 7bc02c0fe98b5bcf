#!/usr/bin/python3
"""Checks that the report and the page describe the conclusions, series, steps and loops of structures with the same
words: the tables of api/report/structure/structure_words.cpp and of web/src/words/structure.ts are equal, and have a
sentence for each code of the engine."""
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
REPORT, PAGE = "api/report/structure/structure_words.cpp", "web/src/words/structure.ts"
CODES = "engine/structure/conclusions.cpp"
TABLES = {"kConclusions": "SENTENCES", "kSeries": "OF", "kInputs": "INPUTS", "kLoops": "LOOPS"}
STRING = r'"((?:[^"\\]|\\.)*)"'


def of_report(source: str, name: str) -> dict[str, str]:
    body = re.search(rf"constexpr Word {name}\[\] = \{{(.*?\}})\}};", source, re.S)[1]
    joined = re.sub(r'"\s*\n\s*"', "", body)
    return dict(re.findall(rf"\{{{STRING},\s*{STRING}\}}", joined))


def of_page(source: str, name: str) -> dict[str, str]:
    body = re.search(rf"^const {name}\b[^=]*= \{{\n(.*?)^\}};", source, re.S | re.M)[1]
    rows = re.findall(rf'^\s*"?([\w-]+)"?: (?:\["\w+", )?{STRING}\]?,$', body, re.M)
    return dict(rows)


def differences(report: str, page: str, codes: str) -> list[str]:
    found = []
    for own, other in TABLES.items():
        ours, theirs = of_report(report, own), of_page(page, other)
        if not ours or not theirs:
            found.append(f"{own} or {other} was not found.")
        found += [f"{own} and {other} differ at {key}:\n    {ours.get(key)}\n    {theirs.get(key)}"
                  for key in sorted(ours.keys() | theirs.keys()) if ours.get(key) != theirs.get(key)]
    sentences = of_report(report, "kConclusions")
    for code in re.findall(r'^    \{\w+, "([\w-]+)"\},$', codes, re.M):
        if code not in sentences:
            found.append(f"{code} has no sentence.")
    return found


def self_test() -> list[str]:
    report = "\n".join(f'constexpr Word {name}[] = {{{{"a-b",\n     "One "\n     "two."}}}};' for name in TABLES)
    page = "\n".join(f'const {name}: X = {{\n  "a-b": ["bad", "One two."],\n}};' for name in TABLES.values())
    found = []
    if differences(report, page, '    {a_b, "a-b"},\n'):
        found.append("The check takes equal words for different ones.")
    if len(differences(report, page.replace("two", "three"), '    {c, "c-d"},\n')) != len(TABLES) + 1:
        found.append("The check does not see different words, or a code without a sentence.")
    return found


def main() -> int:
    texts = ((ROOT / name).read_text(encoding="utf-8") for name in (REPORT, PAGE, CODES))
    found = self_test() + differences(*texts)
    print("\n".join(found) if found else "Report and page have the same words for structures.")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
