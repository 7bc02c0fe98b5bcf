"""Reads the commands of a document with their documented output, runs them, and compares the outputs.

A fenced block `sh` has commands. The blocks `json` and `text` that follow it, up to the next heading or the next
commands, are together its complete output. In them

- blanks and line ends do not count: an answer may be formatted for readability;
- a number is right if the actual one rounds to it, to the digits shown; one that is cut off, 0.695..., if the actual
  one begins with it;
- `...` stands for omitted text: inside brackets for whole members, as the last word for everything.

A block below a remark `<!-- not run: REASON -->` is not run. Blocks of one document share a shell and a folder.
"""

import dataclasses
import decimal
import os
import pathlib
import re
import subprocess

FENCE = re.compile(r"^```(\w*)\s*$")
NOT_RUN = re.compile(r"^<!-- not run: \S.* -->$")
NUMBER = re.compile(r"[+-]?\d+(?:\.\d+)?(?:[eE][+-]?\d+)?$")
TOKEN = re.compile(r"(?<![\w.])[+-]?\d+\.\d+\.\.\."
                   r"|\.\.\."
                   r"|(?<![\w.])[+-]?\d+(?:\.\d+)?(?:[eE][+-]?\d+)?(?![\w])"
                   r"|\w+|[^\w\s]")
OPENING, CLOSING = "{[", "}]"
REST = "..."
PROBLEM = re.compile(r'^\{\s*"type":\s*"[^"]*",\s*"title":\s*"[^"]*",\s*"status":\s*[45]\d\d\b', re.MULTILINE)


@dataclasses.dataclass
class Commands:
    """One block of commands, its line, and the blocks of its output (none: the document does not show it)."""

    line: int
    text: str
    run: bool = True
    printed: list = dataclasses.field(default_factory=list)


def commands_of(document: str) -> list[Commands]:
    found, latest, kind, block, begin, before = [], None, None, [], 0, ""
    for number, line in enumerate(document.splitlines(), 1):
        fence = FENCE.match(line)
        if kind is None and fence:
            kind, block, begin = fence[1], [], number
        elif kind is not None and fence:
            text = "\n".join(block)
            if kind == "sh":
                latest = Commands(begin, text, run=not NOT_RUN.match(before))
                found.append(latest)
            elif latest and kind in ("json", "text"):
                latest.printed.append(text)
            kind, before = None, ""
        elif kind is not None:
            block.append(line)
        elif line.startswith("#"):
            latest = None
        elif line.strip():
            before = line.strip()
    return found


def same(expected: str, came: str) -> bool:
    """True if one word of the document matches the actual word; numbers to the digits shown."""
    if expected == came:
        return True
    if expected.endswith(REST):
        return bool(NUMBER.match(came)) and came.startswith(expected.removesuffix(REST))
    if not (NUMBER.match(expected) and NUMBER.match(came)):
        return False
    shown = decimal.Decimal(expected)
    digit = decimal.Decimal((0, (1,), shown.as_tuple().exponent))
    return abs(decimal.Decimal(came) - shown) <= digit / 2


def without_commas_beside_rest(words: list[str]) -> list[str]:
    """Omitted text may be empty, and then has no comma of its own."""
    return [word for at, word in enumerate(words)
            if word != "," or REST not in (words[at - 1] if at else "", words[at + 1] if at + 1 < len(words) else "")]


def difference(expected: str, came: str) -> str | None:
    """A sentence about the first difference between the actual and the documented output; None if there is none."""
    want, have = without_commas_beside_rest(TOKEN.findall(expected)), TOKEN.findall(came)
    farthest = [0, 0]
    dead = set()

    def matches(i: int, j: int) -> bool:
        while i < len(want) and want[i] != REST:
            if j >= len(have) or not same(want[i], have[j]):
                if i >= farthest[0]:
                    farthest[:] = i, j
                return False
            i, j = i + 1, j + 1
        if i == len(want):
            if j < len(have):
                farthest[:] = i, j
            return j == len(have)
        if i == len(want) - 1:
            return True
        if (i, j) in dead:
            return False
        dead.add((i, j))
        depth = 0
        while depth >= 0:
            if depth == 0 and matches(i + 1, j):
                return True
            if j == len(have):
                return False
            depth += (have[j] in OPENING) - (have[j] in CLOSING)
            j += 1
        return False

    if matches(0, 0):
        return None
    i, j = farthest
    wanted = " ".join(want[max(0, i - 6):i + 1]) or "nothing"
    return (f"The document goes on with ...{wanted!r}{' and ends' if i >= len(want) else ''}; "
            f"what came has {' '.join(have[max(0, j - 6):j + 6])!r} there.")


def script(blocks: list[Commands], mark: str) -> str:
    """All blocks as one script for bash; after each output it prints a line with the mark and the exit code."""
    return "set -o pipefail\n" + "".join(f"{block.text}\nprintf '\\n{mark} %s\\n' \"$?\"\n" for block in blocks)


def faults(name: str, document: str, port: int, binary: str, folder: pathlib.Path) -> list[str]:
    """One sentence for each block of the document that fails or whose output differs. The commands run in `folder`,
    with the service at `port` and the program `binary`."""
    blocks = [block for block in commands_of(document) if block.run]
    mark = "--- end of a block of this document, exit code"
    text = script(blocks, mark).replace("127.0.0.1:8080", f"127.0.0.1:{port}")
    lay_out(folder, binary)
    path = f"{folder / 'bin'}:{os.environ['PATH']}"
    done = subprocess.run(["bash"], input=text, cwd=folder, env={**os.environ, "PATH": path}, text=True, timeout=600,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)
    parts = done.stdout.replace(f"127.0.0.1:{port}", "127.0.0.1:8080").split(mark)
    if len(parts) != len(blocks) + 1:
        return [f"{name}: the commands ended after {len(parts) - 1} of {len(blocks)} blocks: {done.stdout[-2000:]}"]
    found = []
    for at, block in enumerate(blocks):
        came = parts[at] if at == 0 else parts[at].split("\n", 1)[1]
        code = parts[at + 1].split()[0]
        where = f"{name}:{block.line}"
        if block.printed:
            if wrong := difference("\n".join(block.printed), came):
                found.append(f"{where}: {wrong}\n{came[:4000]}")
        elif code != "0" or PROBLEM.search(came):
            found.append(f"{where}: exit code {code}: {came[:2000]}")
    for file in sorted(folder.glob("*.json")):
        if PROBLEM.search(kept := file.read_text(encoding="utf-8")):
            found.append(f"{name}: {file.name} holds a problem: {kept[:2000]}")
    return found


def lay_out(folder: pathlib.Path, binary: str) -> None:
    """Prepares the folder for the commands: the repository's folders, and the program at the place of script/build
    and in the path."""
    root = pathlib.Path(__file__).resolve().parents[2]
    for name in ("api", "docs", "tests"):
        (folder / name).symlink_to(root / name)
    for place in ("build/release", "bin"):
        (folder / place).mkdir(parents=True)
        (folder / place / "tunewright").symlink_to(pathlib.Path(binary).resolve())
