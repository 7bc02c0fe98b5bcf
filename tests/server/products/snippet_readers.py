"""Readers of the languages that products take as text. A reader returns what a program finds in a text, by name, and
raises Unreadable where the language or the product refuses the text. Names and types are those of the makers' documents
and code, written independently of the catalogue's templates."""

import configparser
import json
import math
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import types
import unittest.mock

import yaml

STUBS = pathlib.Path(__file__).resolve().parent / "stubs"
COMPILER = os.environ.get("CXX", "c++")
OCTAVE = shutil.which("octave-cli")
NUMBER = r"-?\d+(?:\.\d+)?"
WORDS = {"true": 1, "false": 0}


class Unreadable(Exception):
    pass


def require(condition, sentence):
    if not condition:
        raise Unreadable(sentence)


def same(found, expected):
    """True for equal numbers and switches, however they are spelt, and for equal words; 1e-7 is a float's rounding."""
    if isinstance(expected, complex):
        return abs(found - expected) <= 1e-12 * abs(expected)
    try:
        return math.isclose(*(float(WORDS.get(value, value)) for value in (found, expected)), rel_tol=1e-7)
    except ValueError:
        return found == expected


def added(found, name, value):
    require(name not in found, f"{name} is given twice")
    found[name] = value


def flat(tree, path=""):
    """The leaves of a tree of dictionaries by their paths."""
    if not isinstance(tree, dict):
        return {path: tree}
    paths = {key: f"{path}.{key}" if path else key for key in tree}
    return {name: leaf for key, part in tree.items() for name, leaf in flat(part, paths[key]).items()}


def without_comments(text, comments, start):
    """The lines without comments, and what the comments say: each is a whole line, and one of `comments`."""
    lines, found = [], {}
    for line in text.split("\n"):
        if not line.startswith(start):
            lines.append(line)
            continue
        said = {name: match[1] for name, pattern in comments.items()
                if (match := re.fullmatch(f"{start} {pattern}", line))}
        require(said, f"unknown comment: {line}")
        for name, value in said.items():
            added(found, name, value)
    return lines, found


# Structured text: assignments of literals to members.

def REAL(literal):
    require(re.fullmatch(r"-?\d+\.\d+", literal), f"{literal} is not a REAL")
    require(float(literal) == 0 or 1.2e-38 < abs(float(literal)) < 3.4e38, f"{literal} is out of the range of REAL")
    return literal


def BOOL(literal):
    require(literal in ("TRUE", "FALSE"), f"{literal} is not TRUE or FALSE")
    return literal.lower()


def BIT(literal):
    """A BOOL of Logix, which has no words for its values."""
    require(literal in ("0", "1"), f"{literal} is not 0 or 1")
    return literal


def TIME(literal):
    """In milliseconds."""
    match = re.fullmatch(r"T#(\d+(?:\.\d+)?)(ms|s)", literal, re.IGNORECASE)
    require(match, f"{literal} is not a TIME")
    milliseconds = float(match[1]) * (1000 if match[2].lower() == "s" else 1)
    require(math.isclose(milliseconds, round(milliseconds), abs_tol=1e-6), f"{literal} is not a whole number of ms")
    require(milliseconds < 2 ** 31, f"{literal} does not fit in 32 bits")
    return milliseconds


def structured_text(variable, members):
    def read(text):
        found = {}
        for line in text.split("\n"):
            match = re.fullmatch(r"\s*((?:\"\w+\"|[A-Za-z_]\w*)(?:\.[A-Za-z_]\w*)+)\s*:=\s*(\S+)\s*;\s*", line)
            require(match, f"not an assignment: {line}")
            member = match[1].removeprefix(variable + ".")
            require(member in members, f"{match[1]} is not a member of {variable}")
            added(found, member, members[member](match[2]))
        return found
    return read


# Firmware.

def g_code(words, comments):
    """`words`: the letters that each command knows; a command that stands alone has none."""
    def read(text):
        lines, found = without_comments(text, comments, ";")
        for line in lines:
            command, *given = line.split(" ")
            require(command in words, f"unknown command: {line}")
            if not given:
                added(found, command, "")
            for word in given:
                require(word[:1] in words[command] and re.fullmatch(NUMBER, word[1:]), f"unknown word: {word}")
                added(found, f"{command} {word[0]}", word[1:])
        return found
    return read


def klipper(text):
    parser = configparser.RawConfigParser(inline_comment_prefixes=(";", "#"))
    parser.read_string("[extruder]\n" + text)
    return dict(parser["extruder"])


def yaml_text(comments=()):
    def read(text):
        lines, found = without_comments(text, dict(comments), "#")
        tree = yaml.safe_load("\n".join(lines))
        require(isinstance(tree, dict), "not a mapping")
        return found | flat(tree)
    return read


def lines_of(pattern, alone=()):
    """One parameter a line: the pattern's first group is its name, the second its value; lines that stand alone."""
    def read(text):
        found = {}
        for line in text.split("\n"):
            if line in alone:
                added(found, line, "")
                continue
            match = re.fullmatch(pattern, line)
            require(match, f"not a parameter: {line}")
            added(found, match[1], match[2])
        return found
    return read


# EPICS: fields of a record, as in the database definition of epid; the numbers among them.

EPID = {"KP", "KI", "KD", "MDT", "DRVH", "DRVL", "HOPR", "LOPR", "ODEL", "MDEL", "ADEL", "VAL", "TVAL"}


def ioc_shell(text):
    found = lines_of(rf"dbpf loop\.([A-Z]+) ({NUMBER})")(text)
    require(set(found) <= EPID, "not a field of epid")
    return found


def epics_database(text):
    token = re.compile(r'\s*("[^"]*"|[A-Za-z_]\w*|[(){},])')
    tokens, at = [], 0
    while at < len(text.rstrip()):
        match = token.match(text, at)
        require(match, f"unknown text: {text[at:]}")
        tokens.append(match[1])
        at = match.end()
    require(tokens[:7] == ["record", "(", "epid", ",", '"loop"', ")", "{"], "not the record loop of epid")
    require(tokens[-1] == "}", "the record has no end")
    found, fields = {}, tokens[7:-1]
    require(len(fields) % 6 == 0, "not a list of fields")
    for i in range(0, len(fields), 6):
        word, opened, name, comma, value, closed = fields[i:i + 6]
        require((word, opened, comma, closed) == ("field", "(", ",", ")"), f"not a field: {fields[i:i + 6]}")
        require(name in EPID, f"{name} is not a field of epid")
        require(re.fullmatch(f'"{NUMBER}"', value), f"{value} is not a number")
        added(found, name, value.strip('"'))
    return found


# Python, run.

def python_settings(text):
    scope = {}
    exec(text, {"__builtins__": {}}, scope)
    return scope


class SimplePid:
    """simple_pid.PID: the published arguments and attributes; records what it is given."""

    ATTRIBUTES = ("proportional_on_measurement", "differential_on_measurement", "auto_mode", "output_limits", "tunings",
                  "sample_time", "setpoint")

    def __init__(self, Kp=1.0, Ki=0.0, Kd=0.0, setpoint=0, sample_time=0.01, output_limits=(None, None), auto_mode=True,
                 proportional_on_measurement=False, differential_on_measurement=True, error_map=None, time_fn=None,
                 starting_output=0.0):
        self.__dict__["given"] = {"Kp": Kp, "Ki": Ki, "Kd": Kd, "setpoint": setpoint, "sample_time": sample_time}

    def __setattr__(self, name, value):
        require(name in self.ATTRIBUTES, f"{name} is not an attribute of PID")
        added(self.given, name, value)


def python_program(modules, variables):
    """The variables that the program leaves, with these modules in place of all others."""
    stubs = {name: types.SimpleNamespace(**module) for name, module in modules.items()}

    def read(text):
        scope = {}
        with unittest.mock.patch.dict(sys.modules, stubs):
            exec(text, scope)
        scope.pop("__builtins__")
        require(set(scope) == variables, f"other variables: {sorted(scope)}")
        return scope
    return read


def simple_pid(text):
    return python_program({"simple_pid": {"PID": SimplePid}}, {"PID", "pid"})(text)["pid"].given


# A transfer function, by its values at two places that stand for the variable s.

PLACES = (0.3j, 0.04 + 0.01j)


def only_s(name):
    require(name == "s", f"there is no transfer function {name}")
    return True


def python_control(text):
    def at(place):
        module = {"tf": lambda name: only_s(name) and place}
        return python_program({"control": module}, {"ct", "s", "C"})(text)["C"]
    return {f"C({place})": at(place) for place in PLACES}


def octave_control(text):
    match = re.fullmatch(r'pkg load control\n\ns = tf\("s"\);\nC = ([-+*/(). \ds]+);', text)
    require(match, "not a transfer function C of s")
    return {f"C({place})": eval(match[1], {"__builtins__": {}}, {"s": place}) for place in PLACES}


# MATLAB: calls with numbers and texts. Octave runs the same texts where it is installed.

def matlab_call(line):
    match = re.fullmatch(r"(?:(\w+) = )?(\w+)\((.*)\);", line)
    require(match, f"not a call: {line}")
    arguments = match[3].split(", ")
    for argument in arguments:
        require(re.fullmatch(rf"{NUMBER}|Inf|[A-Za-z]\w*|'[^']*'", argument), f"not an argument: {argument}")
    return match[1], match[2], arguments


def matlab_controller(function, names):
    def read(text):
        variable, called, arguments = matlab_call(text)
        require((variable, called) == ("C", function), f"not a call of {function}: {text}")
        require(len(arguments) == len(names), f"{len(arguments)} arguments")
        for argument in arguments:
            require(re.fullmatch(f"{NUMBER}|Inf", argument), f"{argument} is not a number")
        return dict(zip(names, arguments))
    return read


# Parameters of the block PID Controller and PID Controller (2DOF), and the values of its lists.
BLOCK_NUMBERS = {"P", "I", "D", "N", "b", "c"}
BLOCK_LISTS = {"Controller": {"PID", "PI", "PD"}, "Form": {"Parallel", "Ideal"}}


def block_parameters(pairs):
    found = {}
    for name, value in pairs:
        known = name in BLOCK_NUMBERS and re.fullmatch(NUMBER, value) or value in BLOCK_LISTS.get(name, ())
        require(known, f"the block does not accept {value} as {name}")
        added(found, name, value)
    return found


def set_param(text):
    pairs = []
    for line in text.split("\n"):
        variable, called, (block, *given) = matlab_call(line)
        require((variable, called, block) == (None, "set_param", "block"), f"not set_param of the block: {line}")
        require(len(given) % 2 == 0 and all(word.startswith("'") for word in given), f"not pairs of texts: {line}")
        pairs += zip(*[iter(word.strip("'") for word in given)] * 2)
    return block_parameters(pairs)


def octave(texts, loaded, frequencies):
    """What Octave makes of each text (stubs/read_snippets.m), in one process; `loaded`: with the package control."""
    command = [OCTAVE, "--quiet", "--no-init-file", "--no-history", str(STUBS / "read_snippets.m")]
    with tempfile.NamedTemporaryFile("w", suffix=".json") as request:
        json.dump({"texts": texts, "loaded": loaded, "frequencies": frequencies}, request)
        request.flush()
        done = subprocess.run([*command, request.name], capture_output=True, text=True)
    return json.loads(done.stdout)


# Julia: a grammar of the two calls only, because Debian has no Julia.

JULIA = {
    "ControlSystemsBase": ("C", "pid", ["param_p", "param_i", "param_d"],
                           {"form": ":(standard|series|parallel)", "Tf": NUMBER, "filter_order": "[12]", "Ts": NUMBER}),
    "DiscretePIDs": ("controller", "DiscretePID", [],
                     dict.fromkeys(("K", "Ti", "Td", "Tt", "N", "wp", "wd", "umin", "umax", "Ts", "I", "D", "yold"),
                                   NUMBER)),
}


def julia(text):
    match = re.fullmatch(r"using (\w+)\n\n(\w+) = (\w+)\(([^;]*);([^;]*)\)", text)
    require(match and match[1] in JULIA, "not a call after using")
    variable, function, positions, keywords = JULIA[match[1]]
    require((match[2], match[3]) == (variable, function), f"{match[1]} has no {match[3]}")
    values = [value.strip() for value in match[4].split(",")] if match[4] else []
    require(len(values) == len(positions), f"{len(values)} positional arguments")
    found = {}
    for name, value in zip(positions, values):
        require(re.fullmatch(NUMBER, value), f"{value} is not a number")
        added(found, name, value)
    for argument in match[5].split(","):
        name, equals, value = argument.strip().partition(" = ")
        require(equals and name in keywords, f"{function} has no {argument}")
        require(re.fullmatch(keywords[name], value), f"{value} is not a value of {name}")
        added(found, name, value)
    return found


# Modelica: one declaration of the block LimPID; its parameters are those of the Modelica Standard Library.

LIM_PID = dict.fromkeys(("k", "Ti", "Td", "Nd", "wp", "wd", "Ni", "yMin"), NUMBER) | {
    "controllerType": r"Modelica\.Blocks\.Types\.SimpleController\.(?:P|PI|PD|PID)",
    "yMax": rf"{NUMBER}|Modelica\.Constants\.inf"}


def lim_pid(text):
    match = re.fullmatch(r"Modelica\.Blocks\.Continuous\.LimPID controller\(([^()]*)\);", text)
    require(match, "not a declaration of LimPID")
    found = {}
    for argument in match[1].split(", "):
        name, equals, value = argument.partition("=")
        require(equals and name in LIM_PID, f"LimPID has no {argument}")
        require(re.fullmatch(LIM_PID[name], value), f"{value} is not a value of {name}")
        added(found, name, value.rsplit("SimpleController.", 1)[-1])
    require("yMax" in found, "yMax has no default")
    return found


# Arduino: compiled with the published declarations of the libraries and run, which prints each call.

def sketch(number, calls):
    """`number`: the type of the variables; `calls`: the names of the arguments of each call."""
    def read(text):
        parts = re.split(r"\n// in setup\(\)(?:, in this order)?:\n", text)
        require(len(parts) == 2, "no part for setup()")
        program = (f'#include "arduino_libraries.h"\n{number} Input, Output, Setpoint;\n{parts[0]}\n'
                   f'void setup() {{\n{parts[1]}\n}}\n'
                   'void print_variable(const void* variable) {\n'
                   '    const bool input = variable == &Input, output = variable == &Output;\n'
                   '    std::printf(input ? " Input" : output ? " Output" : " Setpoint");\n}\n'
                   'int main() { setup(); }\n')
        with tempfile.TemporaryDirectory() as folder:
            command = [COMPILER, "-std=c++17", "-Wall", "-Wextra", "-Werror", "-I", str(STUBS), "-x", "c++", "-"]
            built = subprocess.run([*command, "-o", folder + "/sketch"], input=program, capture_output=True, text=True)
            require(built.returncode == 0, built.stderr)
            printed = subprocess.run([folder + "/sketch"], capture_output=True, text=True, check=True).stdout
        found = {}
        for line in printed.splitlines():
            call, *arguments = line.split()
            require(len(arguments) == len(calls.get(call, ())), f"another call: {line}")
            for name, argument in zip(calls[call], arguments):
                added(found, f"{call} {name}", argument)
        return found
    return read
