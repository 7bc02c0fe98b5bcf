#!/usr/bin/python3
"""Checks that defaults and tolerances are only in their table, engine/tuning/limits.h, those of structures only in their
headers, and that all texts state the settling band of its one constant: defaults_test.py BINARY.

No other source defines one; the binary's description of its methods, its help and the documents state the values of
the table. The defaults of every method's options in the documents are compared with the description as well."""
import json
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
TABLE = "engine/tuning/limits.h"
# A published rule has its own levels of Ms, and a paper its own example.
OTHER_MS = ("engine/tuning/arrieta/", "engine/tuning/reaction_curve/kappa_tau", "api/contract/reports/tradeoff.cpp",
            "api/examples/", "api/clients/")
SCALE = re.compile(r"[\d.]+ is (?:calm|sharp)")
TOLERANCE = re.compile(r"\b(?:k(?:Allowed|Reached|HeldOn|Holds|Noticeable)\w*|LIMIT_TOLERANCE)\b\s*=\s*(?:0?\.0|1\.0|\d[\d.]*e-)")


def constants(table: str) -> dict[str, float]:
    found = {name: value for name, value in re.findall(r"\b(k\w+) = (k[A-Z]\w*|\d[\w.e-]*)", table)}
    return {name: float(found.get(value, value)) for name, value in found.items()}


def without_comments(text: str) -> str:
    return re.sub(r"//[^\n]*|/\*.*?\*/", lambda found: "\n" * found[0].count("\n"), text, flags=re.S)


def second_definitions(path: str, source: str, default_Ms: str) -> list[str]:
    if path == TABLE or path.startswith(OTHER_MS):
        return []
    number = rf"(?<![\d.]){re.escape(default_Ms)}(?![\d.])"
    named = re.compile(rf"\b(?:Ms|Mt|\w*(?:[lL]imit|LIMIT|[dD]efault\w*|DEFAULT\w*))\b[^;\n\w]{{1,20}}{number}")
    return [f"{path}:{at}: {line.strip()}\n    states a default or a tolerance of {TABLE} again. Use that."
            for at, line in enumerate(without_comments(source).splitlines(), 1)
            if (named.search(line) and not SCALE.search(line)) or TOLERANCE.search(line)]


def text_of(value) -> str:
    return str(value).lower() if isinstance(value, bool) else f"{value:g}" if isinstance(value, float | int) else str(value)


def stated_defaults(document: str) -> list[tuple[list[str], list[str], list[str]]]:
    """Ids of the section, and names and defaults of each row of its table of options."""
    rows, ids, inside = [], [], False
    for line in document.splitlines():
        if line.startswith("## "):
            ids, inside = re.findall(r"\w+", line[3:].split(":")[0]), False
        elif line.startswith("| option | default"):
            inside = True
        elif not line.startswith("|"):
            inside = False
        elif inside and not line.startswith("| ---"):
            cells = line.split("|")
            rows.append((ids, re.findall(r"`([\w.]+)`", cells[1]), [one.strip().strip("`") for one in cells[2].split(",")]))
    return rows


def wrong_defaults(document: str, methods: dict) -> list[str]:
    """Rows whose default is a number or a word of the option, but differs from the description."""
    wrong = []
    for ids, names, stated in stated_defaults(document):
        for method in (methods[one] for one in ids if one in methods):
            for name, text in zip(names, stated if len(stated) == len(names) else stated[:1] * len(names)):
                option = method["options"]["properties"].get(name, {})
                if "default" not in option or (not re.fullmatch(r"[\d.]+", text) and text not in option.get("enum", ())):
                    continue
                if text != text_of(option["default"]):
                    wrong.append(f"docs/methods.md: {method['id']} has {name} {text_of(option['default'])}, not {text}.")
    return wrong


def stated(limits: dict[str, float], band: str) -> dict[str, list[str]]:
    """Sentences and rows with a default or a tolerance of the table, or with the settling band in percent, by document."""
    Ms, Mt, greatest = (f"{limits[name]:g}" for name in ("kDefaultMs", "kDefaultMt", "kMaxMs"))
    shown, of_worst = (f"{100 * limits[name]:g} %" for name in ("kMaxRelativeExcessShown", "kMaxRelativeExcessShownOfWorst"))
    return {
        "../README.md": [f"The first design keeps Ms below {Ms} on every plant"],
        "methods.md": [f"| `Ms`, `Mt` | {Ms}, {Mt} | limits, in (1, {greatest}] |",
                       f"| `{{\"overshoot\": {limits['kDefaultMaxOvershootPercent']:g}}}` |",
                       f"Tf is {limits['kDefaultTf_over_Td']:g} Td if the plant",
                       f"more than {limits['kMaxRelativeExcessJudged']:g}".replace("e-05", "e-5")],
        "range.md": [f"| `Ms`, `Mt` | {Ms} | limits, in (1, {greatest}], everywhere in the range |"],
        "tutorial.md": [f"| {Ms} | calm (the default) |"],
        "uncertain.md": [f"`robust` keeps Ms at {Ms} on"],
        "verdicts.md": [f"overshoots by at most {band} percentage points more than the limit",
                        f"is above its limit by {shown}, on the worst plant by {of_worst}",
                        f"(reached to {shown})"],
    }


# The defaults of structures, each in its engine's header; the contract reads them.
STRUCTURES = "engine/structure/{}.h"
STRUCTURE_DEFAULTS = {"cascade": ["kDefaultValveOverLoops"], "feedforward": ["kDefaultJump", "kDefaultWrong"],
                      "interaction": ["kDefaultMu"], "predictor": ["kMaxPredictorMs"]}
STATED_AGAIN = re.compile(r"\b(?:jump|uncertainty|mu)\s*=\s*[\d.]+;|exclusive_maximum = 2\b|\b1\.15\b")


def structure_sentences(defaults: dict[str, float]) -> list[str]:
    over, jump, wrong, mu, most = (f"{defaults[name]:g}" for names in STRUCTURE_DEFAULTS.values() for name in names)
    return [f"Its limit is {over} times the larger Ms", f"`jump` is {jump} if none is given",
            f"differs by `uncertainty` ({100 * float(wrong):g} %)", f"within `limit.mu` ({mu})", f"`Ms` may be at most {most}"]


def wrong_structures() -> list[str]:
    defaults = {}
    for name, wanted in STRUCTURE_DEFAULTS.items():
        found = constants((ROOT / STRUCTURES.format(name)).read_text(encoding="utf-8"))
        defaults |= {one: found[one] for one in wanted}
    document = " ".join((ROOT / "docs/structures.md").read_text(encoding="utf-8").split())
    found = [f"docs/structures.md does not say \"{one}\"." for one in structure_sentences(defaults) if one not in document]
    for path in sorted((ROOT / "api/contract/structure").iterdir()):
        for at, line in enumerate(without_comments(path.read_text(encoding="utf-8")).splitlines(), 1):
            if path.suffix in (".h", ".cpp") and STATED_AGAIN.search(line):
                found.append(f"{path.relative_to(ROOT)}:{at}: {line.strip()}\n    states a default of the engine again.")
    return found


# What states the band within which a response counts as settled.
BAND = "engine/evaluation/performance_figures.h"
STATE_BAND = ("engine/evaluation/performance_figures.cpp", "api/contract/result/evaluation.cpp", "web/src/words/figures.ts",
              "web/src/words/comparison.ts", "docs/verdicts.md", "docs/tutorial.md")


def wrong_band(name: str, text: str, percent: str) -> list[str]:
    stated_bands = re.findall(r"(?:within|outside)\s([\d.]+)\s%\sof\b", text)
    return [] if set(stated_bands) == {percent} else [f"{name} states the settling band {percent} % as {stated_bands} %."]


def run(binary: str, *words: str) -> str:
    return subprocess.run([binary, *words], capture_output=True, text=True, check=True).stdout


def faults(binary: str) -> list[str]:
    limits = constants((ROOT / TABLE).read_text(encoding="utf-8"))
    Ms = f"{limits['kDefaultMs']:g}"
    found = []
    names = subprocess.run(["git", "-C", str(ROOT), "ls-files", "engine", "api", "server", "web/src"], check=True,
                           capture_output=True, text=True).stdout.split()
    for name in names:
        if name.endswith((".h", ".cpp", ".ts")) and (ROOT / name).is_file():
            found += second_definitions(name, (ROOT / name).read_text(encoding="utf-8"), Ms)
    band = f"{100 * constants((ROOT / BAND).read_text(encoding='utf-8'))['kSettlingBand']:g}"
    for name in STATE_BAND:
        found += wrong_band(name, (ROOT / name).read_text(encoding="utf-8"), band)
    methods = {method["id"]: method for method in json.loads(run(binary, "methods"))["methods"]}
    for option, value in (("Ms", limits["kDefaultMs"]), ("Mt", limits["kDefaultMt"])):
        described = methods["robust"]["options"]["properties"][option]["default"]
        if described != value:
            found.append(f"GET /v1/methods has {option} {described}, {TABLE} has {value}.")
    if f"default {Ms}" not in run(binary, "tune", "--help"):
        found.append(f"tunewright tune --help does not say that the default Ms is {Ms}.")
    for name, sentences in stated(limits, band).items():
        document = " ".join((ROOT / "docs" / name).read_text(encoding="utf-8").split())
        found += [f"docs/{name} does not say \"{sentence}\"." for sentence in sentences if sentence not in document]
    return found + wrong_structures() + wrong_defaults((ROOT / "docs/methods.md").read_text(encoding="utf-8"), methods)


def self_test() -> list[str]:
    seen = {"engine/a.h": "double Ms = 1.4;", "web/src/b.ts": 'const DEFAULT_TUNE = [{ method: "robust", Ms: 1.4, Mt: 1.4 }];',
            "web/src/c.ts": 'placeholder: "default (1.4)",', "engine/d.cpp": "constexpr double kAllowedInside = 5e-5;",
            "web/src/e.ts": "const LIMIT_TOLERANCE = 1e-3;", "engine/f.cpp": "constexpr double kDefaultLimit = 1.4;"}
    unseen = {"engine/a.cpp": "double Ms = limits::kDefaultMs;  // 1.4", "web/src/b.ts": 'title: "Ms: 1.4 is calm, 2 is sharp"',
              "engine/c.cpp": "constexpr double kWiderLimits = 11.4;", TABLE: "inline constexpr double kDefaultMs = 1.4;"}
    found = [f"The check does not see: {source}" for path, source in seen.items() if not second_definitions(path, source, "1.4")]
    found += [f"The check takes this for a default: {source}" for path, source in unseen.items()
              if second_definitions(path, source, "1.4")]
    changed = {"robust": {"id": "robust", "options": {"properties": {"Ms": {"default": 1.5}, "Mt": {"default": 1.4}}}}}
    if len(wrong_defaults("## robust\n| option | default | is |\n| --- | --- | --- |\n| `Ms`, `Mt` | 1.4, 1.4 | limits |\n",
                          changed)) != 1:
        found.append("The check does not see that a document has an old default.")
    if len(wrong_band("a.md", "outside 2 % of the step, within 5 % of it", "2") + wrong_band("b.md", "", "2")) != 2:
        found.append("The check does not see another settling band.")
    if [bool(STATED_AGAIN.search(line)) for line in ("double jump = 10;", "double jump = structure::kDefaultJump;")] != [True, False]:
        found.append("The check does not see a default of a structure.")
    if constants("kDefaultMs = 1.5, kDefaultMt = kDefaultMs;\nkX = 2e-5;") != {"kDefaultMs": 1.5, "kDefaultMt": 1.5, "kX": 2e-5}:
        found.append("The check does not read the table.")
    return found


def main() -> int:
    found = self_test() + faults(sys.argv[1])
    print("\n".join(found) if found else "Defaults and tolerances stand in one table.")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
