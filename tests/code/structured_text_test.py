"""The reader of Structured Text itself."""

import unittest

from structured_text import FunctionBlock


class StructuredTextTest(unittest.TestCase):
    """The parser of the tests must itself refuse programs that are not valid."""

    def block(self, body, variables="x : LREAL := 1.5; i : INT; yes : BOOL; a : ARRAY[0..2] OF LREAL;"):
        return FunctionBlock("FUNCTION_BLOCK F VAR %s END_VAR %s END_FUNCTION_BLOCK" % (variables, body))

    def test_it_executes_by_the_standard(self):
        for body, value in (("x := 2.0 - 3.0 - 4.0;", -5.0), ("x := 12.0 / 2.0 / 3.0;", 2.0), ("x := 1.0 + 2.0 * 3.0;", 7.0),
                            ("x := -(x + 1.0E-1);", -1.6), ("IF yes THEN x := 1.0; ELSIF 2 > 1 THEN x := 2.0; END_IF;", 2.0),
                            ("IF NOT yes AND 1.0 <> 2.0 OR yes THEN x := 3.0; ELSE x := 4.0; END_IF;", 3.0),
                            ("FOR i := 0 TO 2 DO a[i] := x; x := x + a[i]; END_FOR;", 12.0), ("X := Exp(0.0);", 1.0)):
            block = self.block(body)
            block.call()
            self.assertEqual(block["x"], value, body)

    def test_it_refuses_what_a_plc_would(self):
        for body in ("x := 1;", "i := 1.0;", "x := yes;", "z := 1.0;", "x := 1.0", "IF x THEN x := 1.0; END_IF;", "x = 1.0;",
                     "x := 1.e5;", "IF yes x := 1.0; END_IF;", "a[1.0] := 1.0;", "x := a;", "(* (* *) *) x := 1.0;",
                     "x := x AND yes;", "x := i + x;", "x := 1.0; ELSE", "x := 5 MOD 2;"):
            with self.assertRaises(SyntaxError, msg=body):
                self.block(body)
        for variables in ("if : LREAL;", "x : FLOAT;", "x : LREAL; X : INT;", "x : LREAL := 1;", "x__y : INT;", "R : LREAL;"):
            with self.assertRaises(SyntaxError, msg=variables):
                self.block("", variables)
        with self.assertRaises(IndexError):
            self.block("i := 3; a[i] := 1.0;").call()
        with self.assertRaises(RuntimeError):
            FunctionBlock("FUNCTION_BLOCK F VAR_TEMP t : LREAL; END_VAR t := t + 1.0; END_FUNCTION_BLOCK").call()


if __name__ == "__main__":
    unittest.main()
