"""Text to paste into a program or a file: each snippet read by a reader of its language, with the settings in it."""

import ast
import configparser
import re
import types
import unittest

import yaml

from service import Service

DESIGNS = {
    "PID": {"form": "ideal", "Kp": 1.5, "Ti": 120, "Td": 20, "b": 0.6, "filter": {"type": "derivative", "Tf": 2}},
    "PI": {"form": "ideal", "Kp": 0.02, "Ti": 3},
    "P": {"form": "ideal", "Kp": -4},
}
STATEMENT = re.compile(r'^[\w".]+(\.\w+)* := (T#\d+ms|TRUE|FALSE|-?\d+(\.\d+)?);$')


class SnippetsTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.service = Service()
        cls.addClassCleanup(cls.service.__exit__)

    def answers(self, product):
        """The answer for each design."""
        for name, design in DESIGNS.items():
            request = {"controller": design, "nearest": True, "y_span": [0, 200], "u_span": [0, 100], "sample_time": 0.25}
            answer = self.service.post(f"/v1/controllers/{product}/settings", request)
            self.assertEqual(answer.status, 200, answer.body)
            with self.subTest(product=product, design=name):
                yield answer.json

    def numbers_are(self, found, typed, names):
        for name in names:
            self.assertEqual(float(found[name]), float(typed[name]), name)

    def test_printers_read_lines_of_g_code(self):
        for product, codes in (("marlin", ("M301", "M304")), ("reprapfirmware", ("M301 H1",))):
            for answer in self.answers(product):
                self.assertEqual(len(answer["snippets"]), len(codes))
                for code, snippet in zip(codes, answer["snippets"]):
                    line = snippet["text"].split("\n")[0]
                    self.assertTrue(line.startswith(code + " "), line)
                    words = dict((word[0], word[1:]) for word in line.split()[1:])
                    self.numbers_are(words, answer["as_typed"], "PID")

    def test_klipper_reads_a_section(self):
        for answer in self.answers("klipper"):
            parser = configparser.RawConfigParser(strict=False, inline_comment_prefixes=(";", "#"))
            parser.read_string("[extruder]\n" + answer["snippets"][0]["text"])
            section = parser["extruder"]
            self.assertEqual(section["control"], "pid")
            self.numbers_are(section, answer["as_typed"], ("pid_Kp", "pid_Ki", "pid_Kd", "smooth_time"))

    def test_home_automation_and_robots_read_yaml(self):
        for product, path, names in (
            ("esphome_pid", ["control_parameters"], ("kp", "ki", "kd", "derivative_averaging_samples")),
            ("ha_smart_thermostat", [], ("kp", "ki", "kd")),
            ("ros_control_toolbox", ["gains", "joint"], ("p", "i", "d")),
        ):
            for answer in self.answers(product):
                found = yaml.safe_load(answer["snippets"][0]["text"])
                for name in path:
                    found = found[name]
                self.numbers_are(found, answer["as_typed"], names)

    def test_python_runs(self):
        class PID:
            def __init__(self, Kp, Ki, Kd, setpoint, sample_time):
                self.gains = {"Kp": Kp, "Ki": Ki, "Kd": Kd}
                self.sample_time = sample_time

        for answer in self.answers("simple_pid"):
            text = answer["snippets"][0]["text"]
            ast.parse(text)
            scope = {"PID": PID}
            exec(text.replace("from simple_pid import PID", ""), scope)  # the package is not at hand
            pid = scope["pid"]
            self.numbers_are(pid.gains, answer["as_typed"], ("Kp", "Ki", "Kd"))
            self.assertEqual(pid.sample_time, 0.25)
            typed = types.SimpleNamespace(**answer["as_typed"])
            self.assertEqual(str(pid.proportional_on_measurement).lower(), typed.proportional_on_measurement)
            self.assertEqual(str(pid.differential_on_measurement).lower(), typed.differential_on_measurement)

    def test_a_kiln_reads_settings_in_python(self):
        for answer in self.answers("kiln_controller"):
            scope = {}
            exec(answer["snippets"][0]["text"], scope)
            self.numbers_are(scope, answer["as_typed"], ("pid_kp", "pid_ki", "pid_kd"))

    def test_packages_of_control_read_a_transfer_function(self):
        s = 0.3j  # stands for the variable of a transfer function
        for product, package in (("python_control", r"import control as ct\n\ns = ct\.tf\('s'\)\n"),
                                 ("octave_control", r'pkg load control\n\ns = tf\("s"\);\n')):
            for answer in self.answers(product):
                text = answer["snippets"][0]["text"]
                self.assertRegex(text, "^" + package + r"C = [^;\n]+;?$")
                self.assertEqual(text.endswith(";"), product == "octave_control")
                gains = {name: float(answer["as_typed"].get(name, 0)) for name in ("Kp", "Ki", "Kd", "Tf")}
                expected = gains["Kp"] + gains["Ki"] / s + gains["Kd"] * s / (gains["Tf"] * s + 1)
                self.assertAlmostEqual(eval(text.split("C = ")[1].rstrip(";"), {"s": s}), expected, delta=1e-12)

    def test_controllers_of_plants_read_structured_text(self):
        for product in ("siemens_pid_compact", "rockwell_pid_independent", "rockwell_pid_dependent",
                        "rockwell_pide_independent", "rockwell_pide_dependent", "beckhoff_fb_ctrl_pid",
                        "codesys_util_pid", "oscat_ctrl_pid", "openplc_iec_pid"):
            for answer in self.answers(product):
                for line in answer["snippets"][0]["text"].split("\n"):
                    self.assertRegex(line, STATEMENT)

    def test_flight_controllers_read_one_parameter_a_line(self):
        for product, line in (("ardupilot_ac_pid", r"^ATC_RAT_RLL_\w+,-?\d+(\.\d+)?$"),
                              ("px4_rate", r"^param (set MC_ROLLRATE_\w+ -?\d+(\.\d+)?|save)$"),
                              ("betaflight", r"^(set [a-z0-9_]+ = (\d+|OFF)|save)$")):
            for answer in self.answers(product):
                for text in answer["snippets"][0]["text"].split("\n"):
                    self.assertRegex(text, line)

    def test_a_design_has_them_too(self):
        request = {"plant": {"type": "fopdt", "K": 2, "T": 40, "L": 5}, "tune": [{"method": "simc"}],
                   "implement": {"product": "klipper", "y_span": [0, 300], "u_span": [0, 1]}}
        entered = self.service.post("/v1/design", request).json["controllers"][0]["as_entered"]
        self.assertIn("pid_Kp: " + entered["as_typed"]["pid_Kp"], entered["snippets"][0]["text"])

    def test_a_product_without_text_has_none(self):
        for answer in self.answers("emerson_deltav_standard"):
            self.assertNotIn("snippets", answer)


if __name__ == "__main__":
    unittest.main()
