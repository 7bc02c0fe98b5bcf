#!/usr/bin/python3
"""Checks that the sources use codes and figures: only the writers of answers read the text of a message.

A message is the sentence of an error, a warning, a finding, a note or an exception. Read means: searched, cut,
compared or matched, directly or under another name. Tests may read messages, in lines that are counted; their number
may only fall."""
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
PARTS = ("engine/", "api/", "server/", "web/src/")

MESSAGES = r"(?:message|detail|reason|sentence|why|remark|what\(\)|text\(\)|finding\.text|warning\.text|note)"
CPP_READS = r"(?:find\w*|rfind|starts_with|ends_with|contains|compare|substr|erase|replace)\s*\("
TS_READS = r"(?:includes|startsWith|endsWith|match|matchAll|search|split|indexOf|lastIndexOf|slice|substring|replace\w*)\("
CPP_FAULTS = (
    re.compile(rf"\b{MESSAGES}\)?\s*(?:\.|->){CPP_READS}"),
    re.compile(r"\b(?:message|detail|sentence|what\(\))\s*(?:==|!=)"),
    re.compile(r"(?:==|!=)\s*[\w.>\[\]()*-]*(?:\.|->)(?:message|detail|sentence|what\(\))(?![\w(])"),
    # The place of a figure in a sentence. The place of a fault is a path, whose beginning may be checked.
    re.compile(r"(?:\.|->)where\.(?:ends_with|find|contains)\s*\(\""),
    # A member that is searched for in the text of a request or an answer.
    re.compile(r'(?:\.|->)(?:request|result|error|body|json)\.(?:find|contains)\("\\"'),
    # In a parsed answer: the text of a finding or a fault.
    re.compile(r'(?:value|at)\("(?:text|detail|reason|message|title)"[^;]*?\)\.(?:get<[\w:]+>\(\)\.)?' + CPP_READS),
)
TS_FAULTS = (
    re.compile(rf"\b(?:message|detail|reason|sentence|why|finding\.text|warning\.text|fault\.text)\)?[!?]?\.{TS_READS}"),
    re.compile(rf"(?:test|exec)\(\s*[\w.?!\[\]]*\.(?:detail|message|reason|why|sentence)\b"),
    re.compile(r"\.(?:detail|message|reason|sentence)\b[^=!\n]{0,12}(?:===|!==)\s*[\w.\"'?]"),
    re.compile(r"finding\.text\)\.split\("),
)
# A variable for a message, and its later use.
NAMED = (
    re.compile(r"\b(\w+)\s*(?:=|\()\s*[^;=]*(?:\.|->)(?:message|detail|what\(\))\s*[;)]"),
    re.compile(r'\b(\w+)\s*=\s*[^;=]*(?:value|at)\("(?:text|detail|message)"[^;]*;'),
    re.compile(r"const (\w+) = [^;=]*\.(?:detail|message)\s*;"),
)
# Writers: their use of a sentence, and the number of uses.
WRITERS = {
    "api/describe/members.cpp": (2, "takes the first sentence of a member's description"),
    "api/report/terminal/terminal.cpp": (1, "names the file in place of the body in a problem for the terminal"),
    "web/src/form/errors.ts": (2, "writes the page's labels in place of the names of members"),
    "web/src/range/result_cards.ts": (1, "sets the first sentence of a verdict as its heading"),
    "web/src/views/cards/verdict_card.ts": (1, "leaves out a fault that repeats the problem's own sentence"),
    "web/src/words/numbers.ts": (1, "writes a true minus into a sentence"),
    "web/src/words/products.ts": (1, "says it or them in a sentence of its own"),
}
# Lines of tests of the engine, the API and the service that assert the text of a sentence.
ASSERTED = re.compile(r"\b(?:message|detail|text|what\(\))\b[^\n]*(?:HasSubstr|StartsWith|EndsWith|MatchesRegex|\.find)\(\"|"
                      r"EXPECT_EQ\([^\n]*(?:\.|->)(?:message|detail|text), *\"[^\"\n]* ")
MOST_ASSERTED = 186


def without_comments(text: str) -> str:
    return re.sub(r"//[^\n]*|/\*.*?\*/", lambda found: "\n" * found[0].count("\n"), text, flags=re.S)


def reads(path: str, source: str) -> list[str]:
    """The lines of a source that read a message."""
    text = without_comments(source)
    cpp = not path.endswith(".ts")
    lines = text.splitlines()
    bad = {number for number, line in enumerate(lines) for fault in (CPP_FAULTS if cpp else TS_FAULTS) if fault.search(line)}
    names = {name for pattern in NAMED for name in pattern.findall(text)} - {"", "if", "return", "while"}
    if names:
        under_a_name = re.compile(rf"\b(?:{'|'.join(map(re.escape, sorted(names)))})\.{CPP_READS if cpp else TS_READS}")
        bad |= {number for number, line in enumerate(lines) if under_a_name.search(line)}
    return [f"{path}:{number + 1}: {lines[number].strip()}" for number in sorted(bad)]


def faults(sources: dict[str, str]) -> list[str]:
    found = []
    for path, source in sorted(sources.items()):
        if not path.startswith(PARTS) or not path.endswith((".h", ".cpp", ".ts")):
            continue
        lines = reads(path, source)
        allowed = WRITERS.get(path, (0, ""))[0]
        if len(lines) > allowed:
            found += [f"{line}\n    reads a message. Let what it is about carry a code or a figure." for line in lines]
        elif len(lines) < allowed:
            found.append(f"{path} reads {len(lines)} messages; WRITERS says {allowed}.")
    asserted = sum(len(ASSERTED.findall(source)) for path, source in sources.items()
                   if path.startswith("tests/") and path.endswith((".h", ".cpp")))
    if asserted > MOST_ASSERTED:
        found.append(f"{asserted} lines of tests assert what a sentence says, more than {MOST_ASSERTED}. "
                     "Assert the code and the figures.")
    return found


def tracked() -> dict[str, str]:
    names = subprocess.run(["git", "-C", str(ROOT), "ls-files", "-z", *PARTS, "tests/"], check=True,
                           capture_output=True).stdout.decode().split("\0")
    paths = [ROOT / name for name in names if name.endswith((".h", ".cpp", ".ts"))]
    return {str(path.relative_to(ROOT)): path.read_text(encoding="utf-8") for path in paths if path.is_file()}


# Examples of lines that read a message, once in the tree, and of lines that do not.
READERS = {
    "engine/a.cpp": 'const std::size_t at = error.message.find(kNamesLimit);',
    "engine/b.cpp": 'if (peak.where.ends_with("plant")) wide = true;',
    "engine/c.cpp": 'for (auto& note : notes)\n    if (note.starts_with("Changes:")) note = other;',
    "server/d.cpp": 'if (job.request.find("\\"notify\\"") != std::string::npos) wake();',
    "api/e.cpp": 'const std::string& first = faults.front().message;\nout = first.substr(0, first.find(". "));',
    "api/f.cpp": 'const std::string line = one.value("text", "");\nif (line.ends_with(own)) return;',
    "engine/g.cpp": 'if (error.message == "No controller.") return;',
    "web/src/h.ts": 'if (problem.detail?.includes("is not valid")) return;',
    "web/src/i.ts": 'const words = problem.detail;\nif (words.startsWith("No")) return;',
    "web/src/j.ts": 'if (/no model/.test(fault.detail)) return;',
}
OTHERS = {
    "engine/a.cpp": 'if (error.where.starts_with("filter")) error.where = "options/" + error.where;  // message.find',
    "engine/b.cpp": 'error.message = "At " + place + ": " + error.message;\nif (figure.why.empty()) return;',
    "api/c.cpp": 'const std::size_t end = text.find(decimal);',
    "web/src/d.ts": 'if (kind.endsWith("no-feasible-controller")) return fault.detail;',
}


def main() -> int:
    found = faults(tracked())
    for path, source in READERS.items():
        if not reads(path, source):
            found.append(f"The check does not see that this reads a message: {source}")
    for path, source in OTHERS.items():
        if reads(path, source):
            found.append(f"The check takes this for reading a message: {source}")
    counted = {"tests/a.cpp": 'EXPECT_THAT(error.message, HasSubstr("no"));\n' * (MOST_ASSERTED + 1)}
    if not any("lines of tests" in fault for fault in faults(counted)):
        found.append("The check does not count the lines of tests that assert a sentence.")
    print("\n".join(found) if found else "No source reads a message.")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
