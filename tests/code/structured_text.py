"""A function block in Structured Text (IEC 61131-3): read by its grammar, its types checked, and executed.

Supported are FUNCTION_BLOCK; the sections VAR_INPUT, VAR_OUTPUT, VAR and VAR_TEMP with LREAL, BOOL, INT, arrays of them
and initial values; assignments, IF with ELSIF and ELSE, FOR with BY; every operator of the standard except ** on these
types; EXP, SQRT and ABS. Everything else is a SyntaxError with its line. There is no implicit conversion, no keyword
may be a name, and a temporary that is read before it is assigned is a RuntimeError.

    block = FunctionBlock(text)
    block.call(setpoint=1.0, measurement=0.0, manual=False, manual_output=0.0)
    block["u"]
"""

import math
import re

KEYWORDS = set("""
    ABS ACOS ACTION ADD AND ANDN ANY ARRAY ASIN AT ATAN BOOL BY BYTE CAL CALC CALCN CASE CD CONCAT CONFIGURATION CONSTANT
    COS CTD CTU CTUD CU CV D DATE DELETE DINT DIV DO DT DWORD ELSE ELSIF END_ACTION END_CASE END_CONFIGURATION END_FOR
    END_FUNCTION END_FUNCTION_BLOCK END_IF END_PROGRAM END_REPEAT END_RESOURCE END_STEP END_STRUCT END_TRANSITION END_TYPE
    END_VAR END_WHILE EN ENO EQ ET EXIT EXP EXPT F_EDGE F_TRIG FALSE FIND FOR FROM FUNCTION FUNCTION_BLOCK GE GT IF IN
    INITIAL_STEP INSERT INT INTERVAL JMP JMPC JMPCN L LD LDN LE LEFT LEN LIMIT LINT LN LOG LREAL LT LWORD MAX MID MIN MOD
    MOVE MUL MUX N NE NEG NON_RETAIN NOT OF ON OR ORN P PRIORITY PROGRAM PT PV Q Q1 QU QD R R1 R_TRIG READ_ONLY READ_WRITE
    REAL REPEAT REPLACE RESOURCE RET RETAIN RETC RETCN RETURN RIGHT ROL ROR RS RTC R_EDGE S S1 SD SEL SEMA SHL SHR SIN
    SINGLE SINT SL SQRT SR ST STEP STN STRING STRUCT SUB TAN TASK THEN TIME TIME_OF_DAY TO TOD TOF TON TP TRANSITION TRUE
    TYPE UDINT UINT ULINT UNTIL USINT VAR VAR_ACCESS VAR_CONFIG VAR_EXTERNAL VAR_GLOBAL VAR_INPUT VAR_IN_OUT VAR_OUTPUT
    VAR_TEMP WHILE WITH WORD WSTRING XOR XORN""".split())

TOKEN = re.compile(r"""
    (?P<blank>\s+) | (?P<comment>\(\*.*?\*\)) |
    (?P<real>\d+\.\d+(?:E[+-]?\d+)?) | (?P<integer>\d+) |
    (?P<word>[A-Za-z_][A-Za-z_0-9]*) |
    (?P<mark>:=|<=|>=|<>|\.\.|[-+*/<>=()\[\]:;,])""", re.VERBOSE | re.DOTALL | re.IGNORECASE)

FUNCTIONS = {"EXP": math.exp, "SQRT": math.sqrt, "ABS": abs}
SECTIONS = ("VAR_INPUT", "VAR_OUTPUT", "VAR", "VAR_TEMP")
DEFAULTS = {"LREAL": 0.0, "BOOL": False, "INT": 0}


class Token:
    def __init__(self, kind, text, line):
        self.kind, self.line = kind, line
        # Words are not case-sensitive.
        self.text = text.upper() if kind == "word" else text
        self.spelling = text


def tokens_of(text):
    tokens, at = [], 0
    while at < len(text):
        line = text.count("\n", 0, at) + 1
        match = TOKEN.match(text, at)
        if not match:
            raise SyntaxError("line %d: %r is no token" % (line, text[at:at + 20]))
        at = match.end()
        if match.lastgroup == "comment" and "(*" in match.group()[2:]:
            raise SyntaxError("line %d: a comment inside a comment" % line)
        if match.lastgroup == "real" and text[at:at + 1].isalpha():
            raise SyntaxError("line %d: a letter behind a number" % line)
        if match.lastgroup not in ("blank", "comment"):
            tokens.append(Token(match.lastgroup, match.group(), line))
    tokens.append(Token("end", "", text.count("\n") + 1))
    return tokens


class Variable:
    def __init__(self, section, type_, bounds, initial, slot):
        self.section, self.type, self.bounds, self.initial, self.slot = section, type_, bounds, initial, slot


class Parser:
    """Recursive descent. An expression becomes (type, function of the cells); a statement a function of the cells."""

    def __init__(self, text):
        self.tokens, self.at = tokens_of(text), 0
        self.variables = {}
        self.expect("FUNCTION_BLOCK")
        self.name = self.identifier()
        while self.peek().text in SECTIONS:
            self.section()
        self.body = self.statements("END_FUNCTION_BLOCK")
        self.expect("END_FUNCTION_BLOCK")
        if self.peek().kind != "end":
            self.fail("nothing may follow the function block")

    # ---- tokens
    def peek(self):
        return self.tokens[self.at]

    def next(self):
        self.at += 1
        return self.tokens[self.at - 1]

    def fail(self, what):
        raise SyntaxError("line %d, at %r: %s" % (self.peek().line, self.peek().spelling, what))

    def accept(self, text):
        if self.peek().text == text and self.peek().kind in ("word", "mark"):
            return self.next()
        return None

    def expect(self, text):
        return self.accept(text) or self.fail("%s is expected" % text)

    def identifier(self):
        if self.peek().kind != "word" or self.peek().text in KEYWORDS:
            self.fail("a name is expected")
        if "__" in self.peek().text or self.peek().text.endswith("_"):
            self.fail("underlines stand alone and inside a name")
        return self.next().text

    # ---- declarations
    def section(self):
        section = self.next().text
        while not self.accept("END_VAR"):
            name = self.identifier()
            if name in self.variables:
                self.fail("%s is declared twice" % name)
            self.expect(":")
            bounds = self.bounds() if self.accept("ARRAY") else None
            type_ = self.next().text
            if type_ not in DEFAULTS:
                self.fail("the type must be LREAL, BOOL or INT")
            initial = self.literal(type_) if self.accept(":=") else DEFAULTS[type_]
            self.expect(";")
            self.variables[name] = Variable(section, type_, bounds, initial, len(self.variables))

    def bounds(self):
        self.expect("[")
        low = self.literal("INT")
        self.expect("..")
        high = self.literal("INT")
        self.expect("]")
        self.expect("OF")
        return low, high

    def literal(self, type_):
        sign = -1 if type_ != "BOOL" and self.accept("-") else 1
        found, value = self.constant()
        if found != type_:
            self.fail("a literal of type %s is expected" % type_)
        return value if type_ == "BOOL" else sign * value

    def constant(self):
        token = self.next()
        if token.kind == "real":
            return "LREAL", float(token.text)
        if token.kind == "integer":
            return "INT", int(token.text)
        if token.text in ("TRUE", "FALSE"):
            return "BOOL", token.text == "TRUE"
        self.at -= 1
        return self.fail("a literal is expected")

    # ---- statements
    def statements(self, *ends):
        found = []
        while self.peek().text not in ends:
            found.append(self.statement())
        return found

    def statement(self):
        if self.accept("IF"):
            return self.decision()
        if self.accept("FOR"):
            return self.repetition()
        return self.assignment()

    def assignment(self):
        variable, index = self.place()
        if variable.section == "VAR_INPUT":
            self.fail("an input is not assigned")
        self.expect(":=")
        value = self.typed(variable.type)
        self.expect(";")
        slot = variable.slot
        if index is None:
            def run(cells):
                cells[slot] = value(cells)
        else:
            def run(cells):
                cells[slot][index(cells)] = value(cells)
        return run

    def decision(self):
        branches = []
        while True:
            condition = self.typed("BOOL")
            self.expect("THEN")
            branches.append((condition, self.statements("ELSIF", "ELSE", "END_IF")))
            if not self.accept("ELSIF"):
                break
        otherwise = self.statements("END_IF") if self.accept("ELSE") else []
        self.expect("END_IF")
        self.expect(";")

        def run(cells):
            for condition, body in branches:
                if condition(cells):
                    break
            else:
                body = otherwise
            for statement in body:
                statement(cells)
        return run

    def repetition(self):
        variable, index = self.place()
        if index is not None or variable.type != "INT":
            self.fail("FOR counts a variable of type INT")
        self.expect(":=")
        first = self.typed("INT")
        self.expect("TO")
        last = self.typed("INT")
        step = self.typed("INT") if self.accept("BY") else lambda cells: 1
        self.expect("DO")
        body = self.statements("END_FOR")
        self.expect("END_FOR")
        self.expect(";")

        def run(cells):
            by = step(cells)
            for value in range(first(cells), last(cells) + (1 if by > 0 else -1), by):
                cells[variable.slot] = value
                for statement in body:
                    statement(cells)
        return run

    def place(self):
        name = self.identifier()
        if name not in self.variables:
            self.fail("%s is not declared" % name)
        variable = self.variables[name]
        if variable.bounds is None:
            return variable, None
        self.expect("[")
        index = self.typed("INT")
        self.expect("]")
        low, high = variable.bounds

        def checked(cells):
            value = index(cells)
            if not low <= value <= high:
                raise IndexError("%s[%d]" % (name, value))
            return value - low
        return variable, checked

    # ---- expressions, the loosest operator first
    def typed(self, type_):
        found, value = self.expression()
        if found != type_:
            self.fail("the expression before is %s and must be %s" % (found, type_))
        return value

    def expression(self):
        return self.logical("OR", lambda: self.logical("XOR", lambda: self.logical("AND", self.equality)))

    def logical(self, word, inner):
        type_, left = inner()
        while self.accept(word):
            other, right = inner()
            if (type_, other) != ("BOOL", "BOOL"):
                self.fail("%s joins BOOL and BOOL" % word)
            # Both sides are evaluated: the standard leaves open whether they are.
            left = {"OR": lambda c, a=left, b=right: a(c) | b(c), "XOR": lambda c, a=left, b=right: a(c) ^ b(c),
                    "AND": lambda c, a=left, b=right: a(c) & b(c)}[word]
        return type_, left

    def binary(self, operations, inner, result=None, types=("LREAL", "INT")):
        type_, left = inner()
        while self.peek().kind == "mark" and self.peek().text in operations:
            operation = operations[self.next().text]
            other, right = inner()
            if type_ != other or type_ not in types:
                self.fail("%s and %s do not go together here" % (type_, other))
            left = operation(left, right)
            type_ = result or type_
        return type_, left

    def equality(self):
        return self.binary({"=": lambda a, b: lambda c: a(c) == b(c), "<>": lambda a, b: lambda c: a(c) != b(c)},
                           self.comparison, "BOOL", ("LREAL", "INT", "BOOL"))

    def comparison(self):
        return self.binary({"<": lambda a, b: lambda c: a(c) < b(c), ">": lambda a, b: lambda c: a(c) > b(c),
                            "<=": lambda a, b: lambda c: a(c) <= b(c), ">=": lambda a, b: lambda c: a(c) >= b(c)},
                           self.sum, "BOOL")

    def sum(self):
        return self.binary({"+": lambda a, b: lambda c: a(c) + b(c), "-": lambda a, b: lambda c: a(c) - b(c)},
                           self.product)

    def product(self):
        return self.binary({"*": lambda a, b: lambda c: a(c) * b(c), "/": lambda a, b: lambda c: a(c) / b(c)},
                           self.unary, types=("LREAL",))

    def unary(self):
        if self.accept("-"):
            type_, value = self.unary()
            if type_ == "BOOL":
                self.fail("- needs a number")
            return type_, lambda c: -value(c)
        if self.accept("NOT"):
            type_, value = self.unary()
            if type_ != "BOOL":
                self.fail("NOT needs BOOL")
            return type_, lambda c: not value(c)
        return self.primary()

    def primary(self):
        if self.accept("("):
            found = self.expression()
            self.expect(")")
            return found
        if self.peek().text in FUNCTIONS:
            function = FUNCTIONS[self.next().text]
            self.expect("(")
            value = self.typed("LREAL")
            self.expect(")")
            return "LREAL", lambda c: function(value(c))
        if self.peek().kind in ("real", "integer") or self.peek().text in ("TRUE", "FALSE"):
            type_, constant = self.constant()
            return type_, lambda c: constant
        name = self.peek().spelling
        variable, index = self.place()
        slot = variable.slot
        if index is not None:
            return variable.type, lambda c: c[slot][index(c)]
        if variable.section != "VAR_TEMP":
            return variable.type, lambda c: c[slot]

        def temporary(cells):
            if cells[slot] is None:
                raise RuntimeError("%s is read before it is assigned" % name)
            return cells[slot]
        return variable.type, temporary


class FunctionBlock:
    """An instance. Inputs keep their last value, as they do in a PLC."""

    def __init__(self, text):
        parser = Parser(text)
        self.name, self.variables, self.body = parser.name, parser.variables, parser.body
        self.cells = []
        for variable in self.variables.values():
            low, high = variable.bounds or (0, 0)
            self.cells.append([variable.initial] * (high - low + 1) if variable.bounds else variable.initial)
        self.temporaries = [v.slot for v in self.variables.values() if v.section == "VAR_TEMP"]

    def call(self, **inputs):
        for name, value in inputs.items():
            variable = self.variables[name.upper()]
            if variable.section != "VAR_INPUT" or DEFAULTS[variable.type].__class__ is not value.__class__:
                raise TypeError("%s := %r" % (name, value))
            self.cells[variable.slot] = value
        for slot in self.temporaries:
            self.cells[slot] = None
        for statement in self.body:
            statement(self.cells)

    def __getitem__(self, name):
        return self.cells[self.variables[name.upper()].slot]

    def has(self, name):
        return name.upper() in self.variables
