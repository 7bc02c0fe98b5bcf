"""Files of many kinds of loggers are read correctly: the identified plant agrees with the true one within its stated
errors."""

import json
import os
import subprocess
import tempfile
import unittest

import log_files as made
from log_files import Plant, Test
from service import BINARY


def identify(text, *words, suffix=".csv"):
    """The answer of the command line, or its problem."""
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "log" + suffix)
        with open(path, "w", encoding="utf-8") as file:
            file.write(text)
        done = subprocess.run([BINARY, "identify", path, "--json", *words], capture_output=True, text=True, timeout=300)
    return json.loads(done.stdout or done.stderr)


STEP = [(10, 12), (30, 150)]  # levels of u and their rows
KILN = Plant(K=2.2, T1=180, L=12, T2=20)


def step(plant=KILN, levels=None, row=5, **more):
    return Test(plant, levels or STEP, row, **more)


class LogFileTest(unittest.TestCase):
    def model(self, text, *words):
        answer = identify(text, *words)
        self.assertIn("model", answer, answer.get("errors", answer))
        return answer["model"]

    def holds(self, model, plant, widest=0.3, lag_total=True):
        """Checks K, and the sum of lags and dead time, within four stated errors, which are at most `widest` of the
        values."""
        found, errors = model["plant"], model["standard_errors"]
        K, K_error = found["K"], errors["K"]
        shown = json.dumps({"plant": found, "errors": errors})
        self.assertLess(abs(K - plant.K), 4 * K_error + 0.01 * abs(plant.K), shown)
        self.assertLess(K_error, widest * abs(plant.K), shown)
        if not lag_total:
            return
        total = sum(found.get(name, 0) for name in ("T", "T1", "T2", "L"))
        spread = sum(errors.get(name, 0) ** 2 for name in ("T", "T1", "T2", "L")) ** 0.5
        true = plant.T1 + plant.T2 + plant.L
        self.assertLess(abs(total - true), 4 * spread + 0.03 * true, shown)

    def notes(self, model):
        return " ".join(model["data_quality"]["notes"])


class SeveralKindsOfLines(LogFileTest):
    def test_reports_are_read_and_a_dump_of_traffic_is_not(self):
        plant = Plant(K=640, T1=150, L=1.5, T2=6)
        test = step(plant, [(0, 20), (0.25, 120), (0.1, 60)], row=1, noise=0.15, digits=1)
        for dump_first in (False, True):
            for words in ((), ("--u", "extruder.pwm", "--y", "extruder.temp")):
                with self.subTest(dump_first=dump_first, words=words):
                    self.holds(self.model(made.klipper(test, 600, dump_first), *words), plant)

    def test_seconds_of_settling_that_count_down_come_first(self):
        plant = Plant(K=0.2, T1=150, L=9)
        test = step(plant, [(480, 4), (780, 400)], row=1, noise=0.05, y0=21.85)
        model = self.model(made.countdown(test))
        self.holds(model, plant)
        self.assertLess(abs(model["plant"]["L"] - 9), 4 * model["standard_errors"]["L"])
        self.assertIn("count down", self.notes(model))

    def test_of_several_runs_the_longest_that_tests_something_is_read_and_others_can_be_chosen(self):
        idle = step(levels=[(10, 300)])
        short = step(Plant(K=1.1, T1=60, L=12), levels=[(10, 12), (30, 60)], seed=2)
        text = made.restarts([idle, short, step()])
        model = self.model(text)
        self.holds(model, KILN)
        self.assertIn("contains 3 runs", " ".join(warning["detail"] for warning in model["warnings"]))
        self.holds(self.model(text, "--run", "2"), Plant(K=1.1, T1=60, L=12))
        problem = identify(text, "--run", "7")
        self.assertEqual(problem["errors"][0]["pointer"], "/record/run")

    def test_messages_of_several_kinds_are_read_by_the_names_of_their_columns(self):
        plant = Plant(K=12, T1=0.4, L=0.04)
        test = step(plant, [(0, 40), (0.1, 80), (-0.1, 80), (0, 60)], row=0.02, noise=0.005, y0=0, digits=4)
        text = made.ardupilot(test)
        self.holds(self.model(text, "--u", "RATE.ROut", "--y", "RATE.R"), plant)
        self.holds(self.model(text, "--u", "ROut", "--y", "PIDR.Act"), plant)
        problem = identify(text)
        self.assertIn("RATE (TimeUS, RDes, R, ROut and A)", problem["errors"][0]["detail"])


class RangesOfU(LogFileTest):
    def test_percent_is_never_cut_to_one(self):
        test = step(levels=[(0, 12), (100, 60), (40, 40), (100, 60), (65, 40), (0, 60)])
        for heading in ("time_s,ssr_output_percent,temp_c", "time_s,output,temp_c"):
            model = self.model(made.csv(test, heading))
            self.holds(model, KILN)
            self.assertNotIn("u_limits", model["data_quality"])

    def test_a_gain_that_falls_is_no_reason_to_cut(self):
        levels = [(0, 12), (100, 170), (40, 40), (100, 170), (65, 40), (0, 140)]
        test = step(Plant(K=2.6, T1=280, L=10), levels, noise=0)
        test.y = [round(24 + 420 * (1 - 2.718281828 ** (-(y - 20) / 420)), 2) for y in test.y]
        model = self.model(made.csv(test, "time_s,ssr_output_percent,temp_c"))
        self.assertGreater(model["plant"]["K"], 1.2)
        self.assertLess(model["plant"]["K"], 2.8)


class DamagedCells(LogFileTest):
    def test_the_damaged_line_is_left_out_and_named(self):
        test = step(Plant(K=45, T1=180, L=12), [(0, 12), (1, 60), (0, 30), (1, 60)], row=10, digits=1)
        model = self.model(made.switched(test, bad=58))
        warning = [w["detail"] for w in model["warnings"] if w["code"] == "lines-left-out"]
        self.assertIn("Line 60", warning[0])
        self.holds(model, Plant(K=45, T1=180, L=12))

    def test_first_readings_and_spikes_come_together(self):
        plant = Plant(K=2, T1=40, L=6)
        levels = [(10, 10), (30, 110)]
        for first, single in (((85.0, 1), (60,)), ((85.0, 3), (50, 90)), (None, (70,)), ((-127.0, 2), (40, 41))):
            with self.subTest(first=first, single=single):
                test = made.with_false_readings(step(plant, levels, row=2, noise=0.08), first, single)
                self.holds(self.model(made.csv(test)), plant)

    def test_runs_of_a_sensors_errors_are_left_out(self):
        plant = Plant(K=2, T1=40, L=6)
        for value, run in ((85.0, (60, 66)), (-127.0, (70, 80)), (0.0, (90, 95)), (850.0, (40, 44)), (1820.0, (80, 81))):
            with self.subTest(value=value):
                test = step(plant, [(10, 10), (30, 110)], row=2, noise=0.08)
                model = self.model(made.csv(made.with_false_readings(test, run=run, value=value)))
                self.holds(model, plant)
                self.assertEqual(model["data_quality"]["outliers"]["count"], run[1] - run[0])

    def test_a_process_that_stands_at_such_a_value_keeps_it(self):
        plant = Plant(K=1, T1=0.2, L=0.5)
        test = step(plant, [(60, 20), (85, 30), (60, 30), (85, 30)], row=2, noise=0, y0=60, digits=0)
        model = self.model(made.csv(test))
        self.assertNotIn("outliers", model["data_quality"])
        self.holds(model, plant, lag_total=False)


class WhatIsU(LogFileTest):
    def test_a_switch_is_and_the_quality_of_a_radio_is_not(self):
        plant = Plant(K=44, T1=180, L=12)
        test = step(plant, [(0, 12), (1, 150)], row=5)
        model = self.model(made.zigbee(test))
        self.holds(model, plant)
        self.assertIn('"state" is read as u', self.notes(model))


class OtherShapes(LogFileTest):
    def test_one_line_for_each_tag_and_time(self):
        for name, text in (("home assistant", made.home_assistant(step())), ("others", made.home_assistant(step(), 1)),
                           ("historian", made.historian(step())), ("influx", made.influx(step())),
                           ("wincc", made.wincc(step())), ("mqtt", made.mqtt(step()))):
            with self.subTest(name):
                words = ("--u", "number.boiler_power", "--y", "sensor.boiler_temperature") if name == "others" else ()
                self.holds(self.model(text, *words), KILN)

    def test_json(self):
        for name, text in (("array", made.json_array(step())), ("nested", made.json_array(step(), nested=True)),
                           ("columns", made.json_columns(step())), ("lines", made.json_lines(step()))):
            with self.subTest(name):
                self.holds(self.model(text), KILN)

    def test_a_duty_that_is_written_where_it_changes(self):
        plant = Plant(K=300, T1=150, L=1.5, T2=5)
        test = step(plant, [(0, 1), (1, 120)] + [(0, 36), (1, 36)] * 5, row=0.5, noise=0.05, y0=22, digits=3)
        self.holds(self.model(made.heater_test(test)), plant)

    def test_keys_and_values_above_a_trend(self):
        self.holds(self.model(made.trend_export(step())), KILN)

    def test_a_sampling_frequency_in_a_column_or_above(self):
        rows = "".join("%g,%.2f" % row[1:] + "%s\n" for row in step(row=0.5, plant=Plant(K=2.2, T1=18, L=1.2)).rows())
        plant = Plant(K=2.2, T1=18, L=1.2)
        for text in ("u,y,fs\n" + rows.replace("%s", ",2"), "# fs = 2 Hz\nu,y\n" + rows.replace("%s", ""),
                     "Sample rate: 2 Hz\nu,y\n" + rows.replace("%s", "")):
            with self.subTest(text[:20]):
                self.holds(self.model(text), plant)

    def test_a_step_at_the_start_of_a_file_without_u(self):
        plant = Plant(K=0.9, T1=300, L=40)
        test = step(plant, [(0, 1), (50, 200)], row=10)
        text = "t,y\n" + "".join("%g,%.2f\n" % (t - 10, y) for t, _, y in list(test.rows())[1:])
        self.holds(self.model(text, "--u-step", "0", "50"), plant)
        self.assertIn("u_step", identify(text)["errors"][0]["detail"])
        with_u = "t,u,y\n" + "".join("%g,%g,%.2f\n" % (t - 10, u, y) for t, u, y in list(test.rows())[1:])
        self.holds(self.model(with_u, "--u0", "0"), plant)

    def test_the_unit_of_the_files_times_is_not_that_of_the_answer(self):
        test = step()
        text = "t,output,temp\n" + "".join("%.6f,%g,%.2f\n" % (t / 60, u, y) for t, u, y in test.rows())
        self.holds(self.model(text, "--time-unit", "min"), KILN)
        in_hours = self.model(text, "--time-unit", "min", "--answer-unit", "h")
        self.assertLess(abs(in_hours["plant"].get("T", in_hours["plant"].get("T1")) * 3600 - 180), 40)


class PublicLogs(LogFileTest):
    def test_each_is_read_without_a_word(self):
        for name, text in made.public_logs(step()).items():
            with self.subTest(name):
                self.holds(self.model(text), Plant(K=0.22 if "x10" in name else 2.2, T1=180, L=12, T2=20))

    def test_what_is_not_plain_is_refused_with_the_headings(self):
        text = made.csv(step(), "Time,burner,ET").replace("\n", ",21.5\n").replace("ET,21.5", "ET,BT")
        problem = identify(text)
        self.assertIn('"burner", "ET" and "BT"', problem["errors"][0]["detail"])


if __name__ == "__main__":
    unittest.main()
