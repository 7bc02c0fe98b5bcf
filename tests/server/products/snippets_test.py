"""Text to paste into a program or a file: each snippet is read by a reader of its language, which finds the settings as
they are typed, and nothing else; a damaged text is refused or read as something else."""

import concurrent.futures
import itertools
import os
import re
import unittest

from service import Service
from snippet_readers import OCTAVE, block_parameters, octave, same
from snippet_table import PERIOD_S, SNIPPETS, expected

DESIGNS = {
    "PID": {"Kp": 1.5, "Ti": 120, "Td": 20, "b": 0.6, "filter": {"type": "derivative", "Tf": 2}},
    "PID without a filter, of the other sign": {"Kp": -1.5, "Ti": 120, "Td": 20},
    "PI": {"Kp": 0.02, "Ti": 3},
    "PI of the other sign": {"Kp": -0.7, "Ti": 4321},
    "PD": {"Kp": 2.5, "Td": 0.75, "filter": {"type": "derivative", "Tf": 0.25}},
    "P": {"Kp": 37},
    "P of the other sign": {"Kp": -4},
    "small": {"Kp": 3.2e-9, "Ti": 45000, "Td": 0.004, "filter": {"type": "derivative", "Tf": 0.0002}},
    "large": {"Kp": 8.123e7, "Ti": 0.02, "Td": 0.0051},
}
SKETCHES = ("arduino_pid_v1", "quickpid")
MATLAB = ("matlab_pidstd", "matlab_pid", "simulink_pid_parallel", "simulink_pid_ideal", "octave_control")
FREQUENCIES = [10 ** (i / 2) for i in range(-6, 5)]


def misread(read, sources, typed, text):
    """Why a reader does not find the settings in a text; "" if it finds them."""
    try:
        found = read(text)
    except Exception as error:  # of whatever runs the text
        return f"{type(error).__name__}: {error}"
    wanted = expected(sources, typed)
    if set(found) != set(wanted):
        return f"other names: {set(found) ^ set(wanted)}"
    return "".join(f"{name} is {found[name]}, not {value}; "
                   for name, value in wanted.items() if not same(found[name], value))


def damaged(text):
    """The text with two of its numbers swapped, without one of its lines, and with one of its words misspelt."""
    numbers = list(re.finditer(r"(?<![A-Za-z_\d.])-?\d+(?:\.\d+)?|(?<=\b[PID])\d+\.\d+", text))
    for one, other in itertools.combinations(numbers, 2):
        if float(one[0]) != float(other[0]):
            yield (f"{one[0]} and {other[0]} swapped",
                   text[:one.start()] + other[0] + text[one.end():other.start()] + one[0] + text[other.end():])
    lines = text.split("\n")
    for i, line in enumerate(lines):
        if line:
            yield f"without {line}", "\n".join(lines[:i] + lines[i + 1:])
    for word in re.finditer(r"[A-Za-z_]\w*", text):
        last = "x" if word[0][-1] != "x" else "y"
        yield f"{word[0]} misspelt", text[:word.end() - 1] + last + text[word.end():]


class SnippetsTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.service = Service()
        cls.addClassCleanup(cls.service.__exit__)

    def answer(self, product, design):
        request = {"controller": {"form": "ideal", **DESIGNS[design]}, "nearest": True, "y_span": [0, 200],
                   "u_span": [0, 100], "sample_time": PERIOD_S}
        answer = self.service.post(f"/v1/controllers/{product}/settings", request)
        self.assertEqual(answer.status, 200, answer.body)
        return answer.json

    def texts(self, products, designs=DESIGNS):
        """Product, design, typed settings, reader, sources and text of each snippet."""
        for product, design in itertools.product(products, designs):
            answer = self.answer(product, design)
            self.assertEqual(len(answer["snippets"]), len(SNIPPETS[product]), (product, design))
            for (read, sources), snippet in zip(SNIPPETS[product], answer["snippets"]):
                yield product, design, answer["as_typed"], read, sources, snippet["text"]

    def test_every_product_with_texts_has_its_readers(self):
        for product in self.service.get("/v1/controllers").json["controllers"]:
            snippets = self.answer(product["id"], "PID").get("snippets", [])
            self.assertEqual(len(snippets), len(SNIPPETS.get(product["id"], ())), product["id"])

    def test_every_text_holds_the_settings_as_typed(self):
        for product, design, typed, read, sources, text in self.texts(SNIPPETS):
            with self.subTest(product=product, design=design):
                self.assertEqual(misread(read, sources, typed, text), "", text)

    def test_no_damage_goes_unnoticed(self):
        with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
            for product, _, typed, read, sources, text in self.texts(SNIPPETS, ["PID"]):
                kinds = list(damaged(text))
                self.assertGreater(len(kinds), 5, product)
                reasons = (pool.map if product in SKETCHES else map)(
                    lambda kind: misread(read, sources, typed, kind[1]), kinds)
                unnoticed = [what for (what, _), reason in zip(kinds, reasons) if not reason]
                self.assertEqual(unnoticed, [], f"{product}:\n{text}")

    def test_a_setting_of_another_design_is_noticed(self):
        for product, _, _, read, sources, text in self.texts(SNIPPETS, ["PID"]):
            if product not in SKETCHES:
                other = self.answer(product, "PI of the other sign")["as_typed"]
                self.assertNotEqual(misread(read, sources, other, text), "", product)

    @unittest.skipUnless(OCTAVE, "Octave is not installed; script/bootstrap peers installs it")
    def test_octave_runs_the_texts_of_matlab_and_octave(self):
        cases = list(self.texts(MATLAB))
        for (product, design, *case), found in zip(cases, self.run_in_octave(cases)):
            self.assertEqual(self.octave_misread(product, *case, found), "", f"{product}, {design}:\n{case[-1]}")

    @unittest.skipUnless(OCTAVE, "Octave is not installed; script/bootstrap peers installs it")
    def test_octave_notices_damage(self):
        cases = [(product, what, *case, harmed) for product, _, *case, text in self.texts(MATLAB, ["PID"])
                 for what, harmed in damaged(text)]
        for (product, what, *case), found in zip(cases, self.run_in_octave(cases)):
            self.assertNotEqual(self.octave_misread(product, *case, found), "", f"{product}, {what}:\n{case[-1]}")

    def run_in_octave(self, cases):
        return octave([text for *_, text in cases], [product != "octave_control" for product, *_ in cases], FREQUENCIES)

    def octave_misread(self, product, typed, _, sources, text, found):
        """The same for what Octave leaves: the parameters of the block, or the frequency response of C, which must be
        that of the controller that the settings realise."""
        if "error" in found:
            return found["error"]
        if product.startswith("simulink"):
            return misread(lambda _: block_parameters(found["parameters"].items()), sources, typed, text)
        if "real" not in found:
            return "no C"
        settings = {name: float(value) for name, value in typed.items()}
        realised = self.service.post(f"/v1/controllers/{product}/controller", {"settings": settings}).json["controller"]
        for w, real, imaginary in zip(FREQUENCIES, found["real"], found["imaginary"]):
            s = 1j * w
            wanted = realised["Kp"] * (1 + (1 / (realised["Ti"] * s) if realised.get("Ti") else 0)
                                       + realised.get("Td", 0) * s / (realised.get("filter", {}).get("Tf", 0) * s + 1))
            if abs(complex(real, imaginary) - wanted) > 1e-9 * abs(wanted):
                return f"C({s}) is {complex(real, imaginary)}, not {wanted}"
        return ""

    def test_a_design_has_them_too(self):
        request = {"plant": {"type": "fopdt", "K": 2, "T": 40, "L": 5}, "tune": [{"method": "simc"}],
                   "implement": {"product": "klipper", "y_span": [0, 300], "u_span": [0, 1]}}
        entered = self.service.post("/v1/design", request).json["controllers"][0]["as_entered"]
        self.assertIn("pid_Kp: " + entered["as_typed"]["pid_Kp"], entered["snippets"][0]["text"])

    def test_a_product_without_text_has_none(self):
        self.assertNotIn("snippets", self.answer("emerson_deltav_standard", "PID"))


if __name__ == "__main__":
    unittest.main()
