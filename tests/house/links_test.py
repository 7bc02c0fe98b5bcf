#!/usr/bin/python3
"""Checks the documents: relative links lead to tracked files, anchors to headings, and no line is too long."""
import pathlib
import re
import subprocess
import sys
import urllib.parse

ROOT = pathlib.Path(__file__).resolve().parents[2]
MOST_COLUMNS = 120

LINKS = re.compile(r']\(\s*<?([^\s()<>]+)>?(?:\s+"[^"]*")?\s*\)'         # [text](target "title"), also over two lines
                   r'|^ {0,3}\[[^\]]+\]:\s*<?([^\s>]+)>?'                # [name]: target
                   r'|<(?:a|img)\s[^>]*?(?:href|src)="([^"]+)"')          # <a href="target">
HEADING = re.compile(r"^ {0,3}#{1,6}\s+(.*?)\s*#*\s*$")
SCHEME = re.compile(r"^[a-zA-Z][a-zA-Z0-9+.-]*:|^//")
FENCE = re.compile(r"^ {0,3}(```+|~~~+)")


def prose(text: str) -> list[tuple[int, str]]:
    """The numbered lines outside blocks of code, fenced or indented."""
    kept, fence, code, blank = [], None, False, True
    for number, line in enumerate(text.splitlines(), 1):
        mark = FENCE.match(line)
        if fence:
            if mark and mark[1].startswith(fence):
                fence = None
            continue
        if mark:
            fence = mark[1]
            continue
        empty = not line.strip()
        code = line.startswith("    ") and (code or blank) or code and empty
        blank = empty
        if not code:
            kept.append((number, line))
    return kept


def without_code(line: str) -> str:
    """The line without inline code, and without remarks, which are not displayed."""
    line = re.sub(r"<!--.*?-->", "", line)
    return re.sub(r"(`+)(?!`).*?(?<!`)\1(?!`)", "``", line)


def slug(heading: str) -> str:
    """The anchor that GitHub gives a heading: its text in small letters, without punctuation, with hyphens for
    blanks."""
    text = re.sub(r"!?\[([^\]]*)\]\([^)]*\)", r"\1", heading)
    # Emphasis marks are not text, but an underscore inside a word is.
    text = re.sub(r"\*+|(?<!\w)_+|_+(?!\w)", "", text) if "`" not in text else text.replace("*", "")
    return re.sub(r"[^\w\- ]", "", text.lower()).replace(" ", "-")


def anchors(text: str) -> set[str]:
    found: dict[str, int] = {}
    named = set(re.findall(r'<a (?:id|name)="([^"]+)"', text))
    for _, line in prose(text):
        if heading := HEADING.match(line):
            name = slug(heading[1])
            found[name] = found.get(name, -1) + 1
            named.add(f"{name}-{found[name]}" if found[name] else name)
    return named


def wrong_links(documents: dict[str, str], files: set[str]) -> list[str]:
    """One sentence for each broken link of the documents (text by path); `files` are all paths."""
    folders = {str(parent) for name in files for parent in pathlib.PurePosixPath(name).parents}
    headings = {path: anchors(text) for path, text in documents.items()}
    wrong = []
    for path, text in sorted(documents.items()):
        for number, line in prose(text):
            for groups in LINKS.findall(without_code(line)):
                target = next(filter(None, groups))
                if SCHEME.match(target):
                    continue
                name, _, anchor = (urllib.parse.unquote(part) for part in target.partition("#"))
                where = f"{path}:{number}: {target}"
                parts: list[str] = [] if name.startswith("/") else list(pathlib.PurePosixPath(path).parent.parts)
                for part in name.strip("/").split("/") if name else pathlib.PurePosixPath(path).name.split("/"):
                    if part == ".." and parts:
                        parts.pop()
                    elif part not in ("", "."):
                        parts.append(part)
                there = "/".join(parts) or "."
                if there not in files and there not in folders:
                    wrong.append(f"{where} leads to no tracked file.")
                elif anchor and there in headings and anchor not in headings[there]:
                    wrong.append(f"{where}: {there} has no heading with that anchor.")
    return wrong


def long_lines(documents: dict[str, str]) -> list[str]:
    """One sentence for each line that is too long, except in tables and code."""
    return [f"{path}:{number} has {len(line)} columns; at most {MOST_COLUMNS}."
            for path, text in sorted(documents.items()) if path == "README.md" or path.startswith("docs/")
            for number, line in prose(text) if len(line) > MOST_COLUMNS and not line.lstrip().startswith("|")]


def tracked() -> set[str]:
    names = subprocess.run(["git", "-C", str(ROOT), "ls-files", "-z"], check=True, capture_output=True).stdout
    return {name.decode() for name in names.split(b"\0") if name}


def check_of_the_check() -> list[str]:
    """Faults that the check misses, or reports wrongly, in documents written for it."""
    long = "x" * (MOST_COLUMNS + 1)
    made = {"README.md": f"# A `b_c` (d), e: f\n# Twice\n# Twice\n[a](docs/a.md#twice) [b](#a-b_c-d-e-f)\n"
                         f"[c](#twice-1)\n| {long} |\n\n    [code](nowhere) {long}\n\n`[code](nowhere)` "
                         "[d](https://example.com/x) <!-- [r](nowhere) -->\n[e\nf](docs/)\n",
            "docs/a.md": f"## Twice\n```\n[code](nowhere)\n```\n[f](../README.md#twice-1) ![g](p.webp)\n[h](b.md)\n"
                         f"[i](../README.md#none) [j](../../out.md)\n[k]: c.md\n{long}\n"}
    faults = wrong_links(made, set(made) | {"docs/p.webp"}) + long_lines(made)
    expected = ["docs/a.md:6: b.md", "docs/a.md:7: ../README.md#none", "docs/a.md:7: ../../out.md", "docs/a.md:8: c.md",
                "docs/a.md:9 has"]
    if len(faults) == len(expected) and all(fault.startswith(start) for fault, start in zip(faults, expected)):
        return []
    return ["The check does not see exactly what is wrong on purpose: " + " ".join(faults)]


def main() -> int:
    files = tracked()
    documents = {name: (ROOT / name).read_text(encoding="utf-8") for name in files
                 if name.endswith(".md") and (ROOT / name).is_file()}
    found = check_of_the_check() + wrong_links(documents, files) + long_lines(documents)
    print("\n".join(found) if found else f"The links of {len(documents)} documents hold.")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
