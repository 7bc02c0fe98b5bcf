"""Models of other libraries in the Python client, answers as tables and in notebooks."""

import cmath
import csv
import html.parser
import io
import json
import pathlib
import sys
import tempfile
import unittest
import unittest.mock

import control_stand_in
from service import FOPDT, ROOT, Service

sys.path.insert(0, str(ROOT / "api" / "clients" / "python"))
import tunewright  # noqa: E402

try:
    import control
except ImportError:
    control = None
try:
    import pandas
except ImportError:
    pandas = None
try:
    import pyarrow
except ImportError:
    pyarrow = None
try:
    import scipy.signal
except ImportError:
    scipy = None

FREQUENCIES = [10 ** (i / 4) for i in range(-12, 5)]
EVIL = '<script>alert("x")</script>&'


def response(plant, s):
    """P(s) of a plant of an answer, by its formula."""
    kind, delay = plant["type"], cmath.exp(-plant.get("L", 0) * s)
    if kind == "fopdt":
        return plant["K"] * delay / (plant["T"] * s + 1)
    if kind == "sopdt" and "zeta" in plant:
        return plant["K"] * delay / (plant["T"] ** 2 * s * s + 2 * plant["zeta"] * plant["T"] * s + 1)
    if kind == "sopdt":
        return plant["K"] * delay / ((plant["T1"] * s + 1) * (plant["T2"] * s + 1))
    if kind == "ipdt":
        return plant["K"] * delay / (s * (plant.get("T", 0) * s + 1))
    if kind == "transfer_function":
        return control_stand_in.value(plant["num"], s) * delay / control_stand_in.value(plant["den"], s)
    if kind == "zpk":
        out = plant["K"] * delay
        for root in plant["zeros"]:
            out *= s - (complex(*root) if isinstance(root, list) else root)
        for root in plant["poles"]:
            out /= s - (complex(*root) if isinstance(root, list) else root)
        return out
    states = control_stand_in.ss(plant["A"], [[b] for b in plant["B"]], [plant["C"]], [[plant.get("D", 0)]])
    return states(s) * delay


class Model:
    """An object with the attributes of a library's model."""

    def __init__(self, **attributes):
        self.__dict__.update(attributes)


class Array(list):
    """A row as NumPy gives it: it becomes a list by tolist()."""

    def tolist(self):
        return list(self)


PLANTS = [
    FOPDT,
    {"type": "sopdt", "K": 1.5, "T1": 12, "T2": 4},
    {"type": "sopdt", "K": -1, "T": 0.5, "zeta": 0.2},
    {"type": "ipdt", "K": 0.3, "T": 2},
    {"type": "transfer_function", "num": [2, 1], "den": [1, 3, 3, 1]},
    {"type": "zpk", "zeros": [-1], "poles": [-2, [-3, 4], [-3, -4]], "K": 5},
    {"type": "state_space", "A": [[0, 1], [-2, -3]], "B": [0, 1], "C": [1, 0.5], "D": 0.25},
]


class ModelsTest(unittest.TestCase):
    def test_models_are_known_by_their_attributes(self):
        wanted = {"type": "transfer_function", "num": [2.0], "den": [10.0, 1.0]}
        for model in (Model(num=[2], den=[10, 1]), Model(num=Array([2]), den=Array([10, 1]), dt=None),
                      Model(num=[[[2]]], den=[[Array([10, 1])]], dt=0), Model(num=2, den=Array([10, 1])),
                      control_stand_in.tf([2], [10, 1])):
            self.assertEqual(tunewright.plant_of(model), wanted)
        self.assertEqual(tunewright.plant_of(Model(num=[2], den=[10, 1]), delay=3), {**wanted, "L": 3})
        roots = Model(zeros=Array([-1]), poles=Array([-3 + 4j, -3 - 4j]), gain=5.0)
        self.assertEqual(tunewright.plant_of(roots),
                         {"type": "zpk", "zeros": [-1.0], "poles": [[-3.0, 4.0], [-3.0, -4.0]], "K": 5.0})
        states = Model(A=Array([Array([0, 1]), Array([-2, -3])]), B=Array([Array([0]), Array([1])]),
                       C=Array([Array([1, 0])]), D=Array([Array([0])]), dt=0)
        self.assertEqual(tunewright.plant_of(states), {"type": "state_space", "A": [[0, 1], [-2, -3]], "B": [0, 1],
                                                       "C": [1, 0], "D": 0})
        self.assertEqual(tunewright.plant_of("1/(s+1)"), "1/(s+1)")
        self.assertEqual(tunewright.controller_of(Model(num=[1.5, 0.5], den=[1, 0])), "tf([1.5, 0.5], [1.0, 0.0])")

    def test_other_objects_are_refused(self):
        for step in (0.1, True):
            with self.assertRaisesRegex(ValueError, "discrete time"):
                tunewright.plant_of(Model(num=[1], den=[1, 1], dt=step))
        with self.assertRaisesRegex(ValueError, "several inputs or outputs"):
            tunewright.plant_of(Model(num=[[[1], [2]]], den=[[[1, 1], [1, 2]]]))
        with self.assertRaisesRegex(TypeError, "Model is no model of a plant"):
            tunewright.plant_of(Model(gain=1))
        with self.assertRaisesRegex(TypeError, "delay is for models"):
            tunewright.plant_of("1/(s+1)", delay=3)

    @unittest.skipUnless(scipy, "scipy is not installed")
    def test_scipys_models_are_plants(self):
        system = scipy.signal.lti([2], [10, 1])
        for form in (system, system.to_zpk(), system.to_ss()):
            plant = tunewright.plant_of(form, delay=3)
            for w in FREQUENCIES:
                self.assertAlmostEqual(abs(response(plant, 1j * w) / response(FOPDT, 1j * w) - 1), 0, places=12)
        with self.assertRaisesRegex(ValueError, "discrete time"):
            tunewright.plant_of(scipy.signal.dlti([2], [10, 1], dt=0.1))

    def check_back(self, module):
        with unittest.mock.patch.dict(sys.modules, {"control": module}):
            for plant in PLANTS:
                model = tunewright.to_control({**plant, "L": 0})
                for w in FREQUENCIES:
                    wanted = response({**plant, "L": 0}, 1j * w)
                    self.assertAlmostEqual(abs(complex(model(1j * w)) / wanted - 1), 0, places=9, msg=plant)
            with self.assertRaisesRegex(ValueError, "give the order of its Pade approximation"):
                tunewright.to_control(FOPDT)
            slow = tunewright.to_control({"model": {"plant": FOPDT}}, pade=4)
            for w in (0.01, 0.1, 0.5):  # below 2 n/L the approximation is close
                self.assertAlmostEqual(abs(complex(slow(1j * w)) / response(FOPDT, 1j * w) - 1), 0, places=5)
            with self.assertRaisesRegex(ValueError, "type nonlinear has no transfer function"):
                tunewright.to_control({"type": "nonlinear"})
            self.check_controllers()

    def check_controllers(self):
        pid = {"form": "ideal", "Kp": 1.5, "Ti": 120, "Td": 20, "b": 0.6, "c": 0.3,
               "filter": {"type": "derivative", "Tf": 2}}
        parallel = {**pid, "form": "parallel", "Ki": 1.5 / 120, "Kd": 30}
        for w in FREQUENCIES:
            s = 1j * w
            D = 20 * s / (2 * s + 1)
            for controller in (pid, parallel, {"controller": pid}):
                self.assertAlmostEqual(complex(tunewright.to_control(controller)(s)),
                                       1.5 * (1 + 1 / (120 * s) + D), places=9)
                self.assertAlmostEqual(complex(tunewright.to_control(controller, of="setpoint")(s)),
                                       1.5 * (0.6 + 1 / (120 * s) + 0.3 * D), places=9)
            filtered = {"Kp": 1.5, "Ti": 120, "Td": 20, "filter": {"type": "measurement_second_order", "Tf": 2},
                        "setpoint_filter": {"T": 5}}
            self.assertAlmostEqual(complex(tunewright.to_control(filtered)(s)),
                                   1.5 * (1 + 1 / (120 * s) + 20 * s) / (1 + 2 * s + 2 * s * s), places=9)
            self.assertAlmostEqual(complex(tunewright.to_control(filtered, of="setpoint")(s)),
                                   1.5 * (1 + 1 / (120 * s)) / (1 + 5 * s), places=9)
        with self.assertRaisesRegex(ValueError, "equivalents.parallel"):
            tunewright.to_control({"form": "series", "Kp": 1, "Ti": 2, "Td": 0})

    def test_plants_and_controllers_become_models_of_control(self):
        self.check_back(control_stand_in)

    @unittest.skipUnless(control, "python-control is not installed")
    def test_the_real_library_takes_them_too(self):
        self.check_back(control)
        plant = tunewright.plant_of(control.tf([2], [10, 1]), delay=3)
        self.assertEqual(plant, {"type": "transfer_function", "num": [2.0], "den": [10.0, 1.0], "L": 3})

    def test_without_the_library_the_error_names_it(self):
        with unittest.mock.patch.dict(sys.modules, {"control": None}):
            with self.assertRaisesRegex(ImportError, "pip install control"):
                tunewright.to_control(FOPDT, pade=3)


class Fragment(html.parser.HTMLParser):
    """The tags of a fragment with their attributes, and its text; each tag must be closed."""

    EMPTY = {"line", "polyline"}

    def __init__(self, text):
        super().__init__()
        self.tags, self.open, self.words = [], [], []
        self.feed(text)
        self.close()
        assert not self.open, self.open

    def handle_starttag(self, tag, attributes):
        self.tags.append((tag, dict(attributes)))
        self.open.append(tag)

    def handle_startendtag(self, tag, attributes):
        assert tag in self.EMPTY, tag
        self.tags.append((tag, dict(attributes)))

    def handle_endtag(self, tag):
        assert self.open and self.open.pop() == tag, tag

    def handle_data(self, data):
        self.words.append(data)


class AnswersTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.service = Service("--workers", "2")
        cls.addClassCleanup(cls.service.__exit__)
        cls.client = tunewright.Client("http://127.0.0.1:%d" % cls.service.port, timeout=60)
        cls.units = {"time": "min", "u": "%", "y": "degC"}
        cls.result = cls.client.tune(FOPDT, tune=["simc", "robust"], baseline={"Kp": 0.3, "Ti": 12}, name=EVIL,
                                     units=cls.units)

    def test_a_model_is_tuned_like_its_plant(self):
        model = control_stand_in.tf([2], [10, 1])
        mine = self.client.tune(model, delay=3, tune=["simc"], evaluate={"points": 0})
        self.assertAlmostEqual(mine.best["controller"]["Kp"], 10 / (2 * 2 * 3), places=12)
        entry = self.client.evaluate(model, [control_stand_in.tf([0.5 * 20, 0.5], [20, 0])], delay=3)["controllers"][0]
        self.assertAlmostEqual(entry["controller"]["Kp"], 0.5, places=12)
        self.assertAlmostEqual(entry["controller"]["Ti"], 20, places=12)
        rows = list(self.client.batch([{"plant": model, "delay": 3, "tune": [{"method": "simc"}]}]))
        self.assertEqual(rows[0]["status"], "succeeded")

    def test_a_plant_has_every_form(self):
        answer = self.client.plant("2 e^(-3s)/(10s+1)")
        self.assertEqual(answer["plant"], FOPDT)
        self.assertEqual([each["name"] for each in answer["snippets"]],
                         ["MATLAB", "Python, python-control", "Julia, ControlSystems.jl", "Modelica"])
        for snippet in answer["snippets"]:
            if "pade" not in snippet["text"]:
                self.assertEqual(self.client.plant(snippet["text"])["plant"], FOPDT)
        self.assertEqual(self.client.plant(control_stand_in.tf([2], [10, 1]), delay=3)["text"], "2 e^(-3 s)/(10 s + 1)")

    def test_a_table_has_the_figures_of_the_answer_with_their_units(self):
        table = self.result.table()
        self.assertEqual(len(table), 3)
        for heading in ("Kp [%/degC]", "Ti [min]", "Ms", "load_IAE [degC min]", "overshoot [%]", "phase_margin [deg]"):
            self.assertIn(heading, table.columns)
        for i, entry in enumerate(self.result["controllers"]):
            self.assertEqual(table.column("Kp")[i], entry["controller"]["Kp"])
            self.assertEqual(table.column("load_IAE")[i], entry["performance"]["load"]["IAE"])
        self.assertEqual(table.column("rank")[self.result["ranking"][0]], 1)

    def test_csv_has_the_units_in_its_headings(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder, "table.csv")
            text = self.result.table().to_csv(path)
            self.assertEqual(path.read_text("utf-8"), text)
        rows = list(csv.reader(io.StringIO(text)))
        self.assertEqual(rows[0], self.result.table().columns)
        self.assertEqual(float(rows[1][rows[0].index("Ti [min]")]), self.result["controllers"][0]["controller"]["Ti"])

    def test_traces_are_columns_with_units(self):
        table = self.client.traces(self.result)
        self.assertEqual(table.columns[0], "t [min]")
        self.assertIn("simc setpoint y [degC]", table.columns)
        ys = self.result["controllers"][0]["responses"]["setpoint"]["y"]
        for found, wanted in zip(table.column("simc setpoint y"), ys):
            self.assertAlmostEqual(found, wanted, delta=1e-5 * max(1, abs(wanted)))
        self.assertEqual(self.client.traces(self.result, "frequency").columns[0], "simc omega [rad/min]")

    def test_rows_of_a_batch_are_a_table(self):
        requests = [{"name": "TIC-%d" % i, "plant": {**FOPDT, "L": i}, "tune": [{"method": "simc"}],
                     "evaluate": {"points": 0}, **({"units": {"time": unit}} if unit else {})}
                    for i, unit in ((1, "min"), (2, "min"))] + [{"name": "bad", "plant": {"type": "fopdt"}}]
        table = tunewright.table(self.client.batch(requests))
        self.assertEqual(table.column("name"), ["TIC-1", "TIC-2", "bad"])
        self.assertIn("Ti [min]", table.columns)
        self.assertAlmostEqual(table.column("Kp")[0], 10 / (2 * 2 * 1), places=12)
        self.assertIsNone(table.column("Kp")[2])
        self.assertTrue(table.column("error")[2])
        mixed = tunewright.table(self.client.batch([requests[0], {**requests[1], "units": {"time": "h"}}]))
        self.assertIn("Ti", mixed.columns)
        self.assertEqual(mixed.column("time_unit"), ["min", "h"])

    @unittest.skipUnless(pandas, "pandas is not installed")
    def test_frames_of_pandas(self):
        frame = self.result.frame()
        self.assertEqual(list(frame.columns), self.result.table().columns)
        self.assertEqual(frame["Kp [%/degC]"].tolist(), self.result.table().column("Kp"))
        traces = self.client.traces(self.result).frame()
        self.assertEqual(traces["t [min]"].iloc[0], 0)
        with unittest.mock.patch.dict(sys.modules, {"pyarrow": None}):
            with self.assertRaisesRegex(ImportError, "to_parquet\\(\\) needs pyarrow"):
                self.result.table().to_parquet("never.parquet")

    @unittest.skipUnless(pandas and pyarrow, "pyarrow is not installed")
    def test_parquet_keeps_the_table(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder, "table.parquet")
            self.result.table().to_parquet(path)
            self.assertTrue(pandas.read_parquet(path).equals(self.result.frame()))

    def test_a_notebook_shows_sentences_figures_and_responses(self):
        text = self.result._repr_html_()
        fragment = Fragment(text)
        said = " ".join(fragment.words)
        for finding in self.result["verdict"]:
            self.assertIn(finding["text"], said)
        self.assertIn("Ti [min]", said)
        self.assertIn("%.4g" % self.result.best["controller"]["Kp"], said)
        names = [tag for tag, _ in fragment.tags]
        self.assertEqual(names.count("svg"), 4)  # y and u of the set-point and of the load step
        self.assertEqual(names.count("polyline"), 12)
        for tag, attributes in fragment.tags:
            if tag == "svg":
                self.assertNotIn("nan", str(attributes))
        # The plots are those of the answer: the first point of y is that of the response.
        points = [attributes["points"] for tag, attributes in fragment.tags if tag == "polyline"]
        self.assertEqual(len(points[0].split()), len(self.result.best["responses"]["setpoint"]["t"]))
        self.assertNotIn("http://www.w3.org/1999/xhtml", text)

    def test_every_text_of_a_notebook_is_escaped(self):
        poisoned = json.loads(json.dumps(self.result), object_hook=lambda value: {
            name: EVIL if isinstance(each, str) else each for name, each in value.items()})
        for text in (self.result._repr_html_(), tunewright.Answer(poisoned)._repr_html_(),
                     tunewright.Check({"loops": [{"tag": EVIL, "cause": {"verdict": EVIL}}], "ranking": []})._repr_html_()):
            fragment = Fragment(text)
            self.assertNotIn("script", [tag for tag, _ in fragment.tags])
            self.assertNotIn(EVIL, text)
            self.assertIn(EVIL, " ".join(fragment.words))

    def test_answers_of_every_call_show_themselves(self):
        for answer in (self.client.evaluate(FOPDT, ["pidstd(0.5, 20)"]), self.client.design(FOPDT, "simc")):
            self.assertIn("<table", answer._repr_html_())
            self.assertEqual(json.loads(json.dumps(answer)), dict(answer))
        Fragment(tunewright.Answer({})._repr_html_())
        with self.assertRaisesRegex(TypeError, "neither controllers nor loops"):
            tunewright.Answer({}).table()


if __name__ == "__main__":
    unittest.main()
