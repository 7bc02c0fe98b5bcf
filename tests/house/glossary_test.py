#!/usr/bin/python3
"""Checks documents, labels and messages against docs/glossary.md: they contain none of the synonyms in its last
column."""
import pathlib
import re
import sys

from links_test import ROOT, prose, tracked, without_code

GLOSSARY = "docs/glossary.md"
HEAD = "not used"  # the column of the synonyms
# History, measured results, and titles of papers keep their words.
EXEMPT = ("CHANGELOG.md", "bench/results/", "docs/references.md", GLOSSARY)
SOURCES = (("web/src/", ".ts"), ("server/cli/", ".cpp"))
LITERAL = re.compile(r'"((?:[^"\\\n]|\\.)*)"|`((?:[^`\\]|\\.)*)`')
PATTERN = re.compile(r"(?:(?<=[(=,:])|(?<=return))(\s*)/(?![/*])(?:\[[^]\n]*\]|\\.|[^/\n\\[])+/")  # a regular expression of TypeScript
CLASSES = re.compile(r'\bclass: "[^"\n]*"')
COMMENT = re.compile(r"(?<![:\"'`])//[^\n]*|/\*.*?\*/", re.DOTALL)


def refused(glossary: str) -> dict[str, str]:
    """Each synonym of the glossary's tables with the term that replaces it."""
    found, heads = {}, []
    for line in glossary.splitlines():
        cells = [cell.strip() for cell in line.strip().strip("|").split("|")] if line.startswith("|") else []
        if not cells or HEAD in cells:
            heads = cells
        elif heads and not set(cells[0]) <= {"-"}:
            row = dict(zip(heads, cells))
            found |= {synonym.strip(): row.get("write", cells[0]) for synonym in row[HEAD].split(";") if synonym != "-"}
    return found


def sentences_of(path: str, text: str) -> list[tuple[int, str]]:
    """The text that a reader sees: the prose of a document, the literals of a source that have a blank or begin with
    a capital letter (names of fields and styles do not), with their lines."""
    if path.endswith(".md"):
        return [(number, without_code(line)) for number, line in prose(text)]
    text = COMMENT.sub(lambda comment: re.sub(r"[^\n]", " ", comment[0]), text)
    if path.endswith(".ts"):
        text = CLASSES.sub("class: 0", PATTERN.sub(r"\1 0", text))
    else:
        text = re.sub(r'"(\s*\n\s*)"', "", text)  # one literal over several lines
    literals = [(text.count("\n", 0, found.start()) + 1, re.sub(r"\$\{[^}]*\}", "0", found[1] or found[2] or ""))
                for found in LITERAL.finditer(text)]
    return [(number, literal) for number, literal in literals if " " in literal.strip() or literal[:1].isupper()]


def uses(path: str, text: str, synonyms: dict[str, str]) -> list[str]:
    """One sentence for each synonym in the document or source, also across the end of a line."""
    lines = sentences_of(path, text)
    whole, starts = "", []
    for number, line in lines:
        starts.append((len(whole), number))
        whole += re.sub(r"[*_]", "", line) + (" " if path.endswith(".md") else " \0 ")
    faults = []
    for synonym, term in synonyms.items():
        pattern = r"(?<![\w-])" + r"\s+".join(map(re.escape, synonym.split())) + r"s?(?![\w-])"
        for found in re.finditer(pattern, whole, re.IGNORECASE):
            number = max(line for start, line in starts if start <= found.start())
            faults.append(f'{path}:{number} says "{" ".join(found[0].split())}"; {GLOSSARY} has "{term}".')
    return faults


def check_of_the_check() -> list[str]:
    """The findings in a glossary, a document and sources written for this check."""
    glossary = ("# G\n| term | meaning | not used |\n| --- | --- | --- |\n| comparison | m | league; as built |\n"
                "| job | m | - |\n\n| a | b |\n| --- | --- |\n| c | thing |\n")
    synonyms = refused(glossary)
    made = {"a.md": "The League, as\nbuilt.\n```\nleague\n```\n`league` league-table thing\n",
            "web/src/a.ts": "// the league says\nconst a = \"league\", b = \"The leagues of all\", c = `of ${league} league`;\n"
                            "const d = text.split(/[,\"]/), e = { class: \"card league\" }, f = \"League\"; // \"a league\"\n",
            "server/cli/a.cpp": 'x = "as it is "\n    "league";  // a league here\n'}
    faults = [fault for path, text in made.items() for fault in uses(path, text, synonyms)]
    expected = ['a.md:1 says "League"', 'a.md:1 says "as built"', 'web/src/a.ts:2 says "leagues"',
                'web/src/a.ts:2 says "league"', 'web/src/a.ts:3 says "League"', 'server/cli/a.cpp:1 says "league"']
    good = list(synonyms) == ["league", "as built"] and len(faults) == len(expected) \
        and all(fault.startswith(start) for fault, start in zip(faults, expected))
    return [] if good else [f"The check does not see exactly what is wrong on purpose: {synonyms} {faults}"]


def main() -> int:
    files = {name: (ROOT / name).read_text(encoding="utf-8") for name in tracked()
             if name.endswith(".md") or any(name.startswith(folder) and name.endswith(end) for folder, end in SOURCES)
             if (ROOT / name).is_file()}
    synonyms = refused(files[GLOSSARY])
    faults = check_of_the_check() + [fault for path, text in sorted(files.items()) if not path.startswith(EXEMPT)
                                     for fault in uses(path, text, synonyms)]
    if not synonyms:
        faults.append(f'{GLOSSARY} has no column "{HEAD}".')
    print("\n".join(faults) if faults else f"{len(synonyms)} synonyms stand in none of {len(files)} files.")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
