"""The data file of the library: reading, writing, and the requests that a problem becomes.

problems.json holds one problem a line, sorted by name. Figures have ten digits; a lower bound is rounded down."""

import fnmatch
import json
import math
import pathlib

HERE = pathlib.Path(__file__).resolve().parent
FILE = HERE / "problems.json"

# What a person writes, and what the program adds.
GIVEN = ("name", "plant", "num", "den", "L", "structure", "Tf", "Ms", "Mt")
FOUND = ("best", "by", "upper", "lower", "gap", "proved", "boxes", "root", "certificate")

STRUCTURES = ("pi", "pid_tied", "pid_fixed")
TIED = 0.1  # Tf/Td of pid_tied

MAX_LIMIT_EXCESS = 1e-5  # of Ms and Mt, relative: the accuracy to which the service keeps and computes them


def read(path=FILE):
    return json.loads(path.read_text(encoding="utf-8"))


def text_of(library):
    head = {key: value for key, value in library.items() if key != "problems"}
    lines = json.dumps(head, ensure_ascii=False, indent=1).rstrip("}").rstrip()
    problems = sorted(library["problems"], key=lambda problem: problem["name"])
    rows = ",\n".join(json.dumps(in_order(problem), ensure_ascii=False) for problem in problems)
    return f'{lines},\n "problems": [\n{rows}\n]}}\n'


def in_order(problem):
    return {key: problem[key] for key in GIVEN + FOUND if key in problem}


def figure(x):
    return float(f"{x:.10g}")


def figure_below(x):
    """The nearest figure of ten digits that is not above x."""
    near = figure(x)
    if near <= x:
        return near
    return figure(near - 10.0 ** (math.floor(math.log10(abs(near))) - 9))


def matching(problems, patterns):
    if not patterns:
        return problems
    return [p for p in problems if any(fnmatch.fnmatchcase(p["name"], pattern) for pattern in patterns)]


def family_of(name, families):
    """The family is the longest of the listed beginnings of the name."""
    held = [family for family in families if name.startswith(family + "/")]
    return max(held, key=len) if held else None


def design_request(problem, gap, seconds):
    """The service's request whose answer has the best known controller and the bound."""
    method = {"method": "robust", "controller": "PI" if problem["structure"] == "pi" else "PID",
              "Ms": problem["Ms"], "Mt": problem["Mt"], "certify": {"gap": gap}}
    if problem["structure"] == "pid_tied":
        method["filter"] = {"Tf_over_Td": TIED}
    elif problem.get("Tf"):
        method["filter"] = {"Tf": problem["Tf"]}
    return {"plant": problem["plant"], "tune": [method], "evaluate": {"points": 0}, "timeout_s": seconds}


def filter_time(problem, Td):
    return TIED * Td if problem["structure"] == "pid_tied" else problem.get("Tf", 0)


def evaluate_request(problem, controller):
    """`controller`: Kp, Ti, Td; the filter is the problem's."""
    Td = controller.get("Td", 0)
    given = {"form": "ideal", "Kp": controller["Kp"], "Ti": controller["Ti"], "Td": Td}
    Tf = filter_time(problem, Td)
    if Tf:
        given["filter"] = {"type": "measurement_second_order", "Tf": Tf}
    return {"plant": problem["plant"], "controllers": [given], "evaluate": {"points": 0}}


def keeps_limits(entry, problem):
    """True if an entry of an answer is stable and within the problem's limits."""
    figures = entry["robustness"]
    return bool(figures["stable"]) and all(figures[name] is not None
                                           and figures[name] <= problem[name] * (1 + MAX_LIMIT_EXCESS)
                                           for name in ("Ms", "Mt"))


def gap_of(upper, lower):
    return figure(max(0.0, (upper - lower) / upper))
