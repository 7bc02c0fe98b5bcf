"""Runs a generated controller in each of its languages over the same rows of inputs."""

import array
import json
import os
import pathlib
import re
import subprocess
import tempfile

from structured_text import FunctionBlock

ROOT = pathlib.Path(__file__).resolve().parents[2]
BINARY = os.environ.get("TUNEWRIGHT_BIN", str(ROOT / "build" / "release" / "tunewright"))
LANGUAGES = ("st", "c", "python")
SIGNALS = ("setpoint", "measurement", "scheduling", "manual", "manual_output")  # in their order; scheduling is used by
                                                                                # a schedule
FLAGS = ("manual", "at_rest", "restart")
WARNINGS = ["-std=c11", "-Wall", "-Wextra", "-Wconversion", "-Wpedantic", "-Wshadow", "-Werror"]
SANITIZERS = ["-fsanitize=undefined,address", "-fno-sanitize-recover=all"]


def result_of(controller, **members):
    """The smallest possible result of one controller."""
    return dict({"controllers": [{"method": "test", "controller": controller}]}, **members)


def ideal(filter_type="none", sign=1, **members):
    filter_ = {"type": filter_type} if filter_type == "none" else {"type": filter_type, "Tf": 0.9}
    c = 0.3 if filter_type == "derivative" else 0
    return dict({"form": "ideal", "Kp": 1.7 * sign, "Ti": 8, "Td": 1.35, "b": 0.6, "c": c, "filter": filter_}, **members)


def command(result, *arguments):
    return subprocess.run([BINARY, "code", "-", *arguments], input=json.dumps(result), capture_output=True, text=True,
                          timeout=60)


def code(result, language, options):
    words = [word for name, value in options.items() for word in ("--" + name.replace("_", "-"), str(value))]
    done = command(result, "--language", language, *words)
    if done.returncode != 0:
        raise AssertionError(done.stderr)
    return done.stdout


def run_structured_text(text, columns, rows):
    block = FunctionBlock(text)
    names = [name for name in columns if block.has(name)]
    out = []
    for row in rows:
        block.call(**{name: bool(row[name]) if name in FLAGS else row[name] for name in names})
        out.append(block["u"])
    return out


def run_python(text, columns, rows):
    space = {}
    exec(compile(text, "tunewright_pid.py", "exec"), space)
    pid = space["TunewrightPid"]()
    names = [name for name in columns if name not in SIGNALS and hasattr(pid, name)]
    out = []
    for row in rows:
        for name in names:
            setattr(pid, name, bool(row[name]) if name in FLAGS else row[name])
        out.append(pid.step(**{name: bool(row[name]) if name in FLAGS else row[name] for name in columns if name in SIGNALS}))
    return out


class CProgram:
    """Several controllers in one binary, each with its own name."""

    def __init__(self, texts, columns, sanitized=True):
        self.columns = columns
        self.folder = tempfile.TemporaryDirectory(prefix="tunewright-code-")
        source = ["#include <stdio.h>", "#include <stdlib.h>"]
        for i, text in enumerate(texts):
            with open(self.path("pid_%d.h" % i), "w") as file:
                file.write(text)
            for name in ("tunewright_pid", "tunewright_pid_init", "tunewright_pid_step"):
                source += ["#undef " + name, "#define %s %s_%d" % (name, name, i)]
            guards = ["#undef TUNEWRIGHT_PID_H", "#undef " + re.search(r"#ifndef (\w+)", text).group(1)]
            source += [*guards, '#include "pid_%d.h"' % i, self.runner(text, i)]
        source.append(self.main(len(texts)))
        with open(self.path("main.c"), "w") as file:
            file.write("\n".join(source))
        self.compile(["main.c", "-o", "main", "-O1", *(SANITIZERS if sanitized else []), "-lm"])

    def path(self, name):
        return os.path.join(self.folder.name, name)

    def compile(self, arguments):
        done = subprocess.run(["gcc", *WARNINGS, *arguments], cwd=self.folder.name, capture_output=True, text=True)
        if done.returncode != 0:
            raise AssertionError(done.stderr[:3000])

    def runner(self, text, i):
        fields = [name for name in self.columns if name not in SIGNALS and " %s; /*" % name in text]
        at = {name: "row[%d]" % k for k, name in enumerate(self.columns)}
        lines = ["static void run_%d(void) {" % i, "    static double row[%d];" % len(self.columns),
                 "    tunewright_pid pid;", "    tunewright_pid_init(&pid);",
                 "    while (fread(row, sizeof row, 1, stdin) == 1) {"]
        lines += ["        pid.%s = %s%s;" % (name, at[name], " > 0.5" if name in FLAGS else "") for name in fields]
        given = [at[name] + (" > 0.5" if name in FLAGS else "") for name in SIGNALS if name in self.columns]
        lines += ["        double u = tunewright_pid_step(&pid, %s);" % ", ".join(given),
                  "        fwrite(&u, sizeof u, 1, stdout);", "    }", "}"]
        return "\n".join(lines)

    @staticmethod
    def main(count):
        cases = "\n".join("    case %d: run_%d(); break;" % (i, i) for i in range(count))
        return ("int main(int argc, char **argv) {\n    switch (argc > 1 ? atoi(argv[1]) : 0) {\n%s\n    default: return 2;\n"
                "    }\n    return 0;\n}\n" % cases)

    def run(self, i, rows):
        data = array.array("d", [float(row[name]) for row in rows for name in self.columns])
        done = subprocess.run([self.path("main"), str(i)], input=data.tobytes(), capture_output=True, timeout=120)
        if done.returncode != 0 or done.stderr:
            raise AssertionError("exit %d: %s" % (done.returncode, done.stderr.decode(errors="replace")[:2000]))
        return array.array("d", done.stdout).tolist()
