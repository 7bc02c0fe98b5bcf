"""Runs the programs of structures in every language and compares their outputs with those of the engine's interpreter.

    structures.py FOLDER        each FOLDER/*.json: texts, inputs (in their order), flags among them, outputs, rows, expected

tests/engine/structure/program_texts_test.cpp writes the files.
"""

import array
import json
import pathlib
import subprocess
import sys

from languages import SANITIZERS, WARNINGS
from structured_text import FunctionBlock


def in_structured_text(case):
    block = FunctionBlock(case["texts"]["st"])
    for row in case["rows"]:
        block.call(**{name: bool(x) if name in case["flags"] else x for name, x in zip(case["inputs"], row)})
        yield [block[name] for name in case["outputs"]]


def in_python(case):
    space = {}
    exec(compile(case["texts"]["python"], case["name"], "exec"), space)
    program = next(space[name] for name in space if name.startswith("Tunewright"))()
    for row in case["rows"]:
        u = program.step(**{name: bool(x) if name in case["flags"] else x for name, x in zip(case["inputs"], row)})
        yield list(u) if isinstance(u, tuple) else [u]


def in_c(case, folder):
    kind, inputs, outputs = "tunewright_" + case["name"], case["inputs"], case["outputs"]
    (folder / "program.h").write_text(case["texts"]["c"])
    given = ", ".join("row[%d]%s" % (i, " > 0.5" if name in case["flags"] else "") for i, name in enumerate(inputs))
    call = "%s_step(&program, %s)" % (kind, given)
    steps = ["u[0] = %s;" % call] if len(outputs) == 1 else [call + ";"] + [
        "u[%d] = program.%s;" % (i, name) for i, name in enumerate(outputs)]
    (folder / "main.c").write_text("""#include <stdio.h>
#include "program.h"
int main(void) {
    %s program;
    double row[%d], u[%d];
    %s_init(&program);
    while (fread(row, sizeof row, 1, stdin) == 1) {
        %s
        fwrite(u, sizeof u, 1, stdout);
    }
    return 0;
}
""" % (kind, len(inputs), len(outputs), kind, "\n        ".join(steps)))
    subprocess.run(["gcc", *WARNINGS, "-O1", *SANITIZERS, "main.c", "-o", "main", "-lm"], cwd=folder, check=True)
    rows = array.array("d", [x for row in case["rows"] for x in row])
    done = subprocess.run([folder / "main"], input=rows.tobytes(), capture_output=True, check=True)
    u = array.array("d", done.stdout).tolist()
    return [u[i:i + len(outputs)] for i in range(0, len(u), len(outputs))]


def main(folder):
    files = sorted(folder.glob("*.json"))
    for file in files:
        case = json.loads(file.read_text(), parse_int=float)
        for language, outputs in (("c", in_c(case, folder)), ("python", in_python(case)), ("st", in_structured_text(case))):
            outputs = list(outputs)
            if len(outputs) != len(case["expected"]):
                sys.exit("%s in %s: %d calls, not %d" % (file.stem, language, len(outputs), len(case["expected"])))
            worst = max(abs(a - b) for got, wanted in zip(outputs, case["expected"]) for a, b in zip(got, wanted))
            if not worst <= 1e-9:
                sys.exit("%s in %s: outputs differ by %g" % (file.stem, language, worst))
            print("%s in %s: %g" % (file.stem, language, worst))
    if not files:
        sys.exit("no programs")


if __name__ == "__main__":
    main(pathlib.Path(sys.argv[1]))
