"""The table of docs/problems.md: families, their share of proved problems, gaps, the hardest."""

import pathlib
import statistics

from library import family_of

PAGE = pathlib.Path(__file__).resolve().parents[2] / "docs" / "problems.md"
BEGIN, END = "<!-- problems -->\n", "<!-- /problems -->"


def hardest(problems):
    """The problem with the largest gap; among proved ones that with the most boxes."""
    return max(problems, key=lambda p: (not p["proved"], p["gap"] if not p["proved"] else 0, p.get("boxes", 0)))


def table(library):
    rows = ["| family | plants | problems | proved | median gap | hardest: gap, or boxes to prove it |",
            "| --- | --- | --- | --- | --- | --- |"]
    total = []
    for family, about in library["families"].items():
        own = [p for p in library["problems"] if family_of(p["name"], library["families"]) == family]
        if not own:
            continue
        worst = hardest(own)
        effort = f"{worst['boxes']:,} boxes" if worst["proved"] else f"{100 * worst['gap']:.2g} %"
        rows.append(f"| `{family}` | {about['plants']} | {len(own)} | {share(own)} | {median_gap(own)} | "
                    f"`{worst['name'][len(family) + 1:]}`: {effort} |")
        total += own
    rows.append(f"| all |  | {len(total)} | {share(total)} | {median_gap(total)} |  |")
    return "\n".join(rows) + "\n"


def share(problems):
    return f"{sum(p['proved'] for p in problems)} of {len(problems)}"


def median_gap(problems):
    return f"{100 * statistics.median(p['gap'] for p in problems):.2g} %"


def page(text, library):
    before, rest = text.split(BEGIN)
    return before + BEGIN + table(library) + END + rest.split(END)[1]
