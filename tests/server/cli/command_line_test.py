"""The binary as its user calls it."""

import json
import os
import socket
import subprocess
import tempfile
import unittest

from service import BINARY, QUICK, Service


def run(*arguments, text=None, environment=None):
    return subprocess.run([BINARY, *arguments], input=text, capture_output=True, text=True, timeout=120,
                          env={**os.environ, **(environment or {})})


class CommandLineTest(unittest.TestCase):
    def test_version_and_help(self):
        self.assertRegex(run("--version").stdout, r"^tunewright \d+\.\d+\.\d+\n$")
        for option in ("--listen", "--store", "--workers", "--queue-limit", "--max-body", "--web"):
            self.assertIn(option, run("serve", "--help").stdout)

    def test_tune_writes_the_result_and_ends_with_0(self):
        done = run("tune", "-", text=json.dumps(QUICK))
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertEqual(json.loads(done.stdout)["controllers"][0]["method"], "simc")

    def test_tune_writes_a_problem_and_ends_with_1(self):
        for text, status in (("{", 400), ('{"plant":{"type":"nope"}}', 422)):
            done = run("tune", "-", text=text)
            self.assertEqual((done.returncode, done.stdout), (1, ""))
            self.assertEqual(json.loads(done.stderr)["status"], status)
        done = run("tune", "/nothing/here.json")
        self.assertEqual(done.returncode, 1)
        self.assertIn("/nothing/here.json", json.loads(done.stderr)["detail"])

    def test_tune_reads_a_file(self):
        with tempfile.NamedTemporaryFile("w", suffix=".json") as file:
            file.write(json.dumps(QUICK))
            file.flush()
            self.assertEqual(run("tune", file.name).returncode, 0)

    def test_plant_says_what_a_line_means(self):
        done = run("plant", "K=2 T=10 min L=30 s", "--time-unit", "min")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertEqual(json.loads(done.stdout)["plant"], {"type": "fopdt", "K": 2, "T": 10, "L": 0.5})
        self.assertEqual(run("plant", "-", text="2/(10s+1)\n").returncode, 0)
        done = run("plant", "2/(10s+1")
        self.assertEqual((done.returncode, done.stdout), (1, ""))
        self.assertIn("position 3", json.loads(done.stderr)["detail"])

    def test_health_is_0_for_a_service_that_answers_and_1_for_none(self):
        with Service() as service:
            address = "127.0.0.1:%d" % service.port
            self.assertEqual(run("health", "http://%s/readyz" % address).returncode, 0)
            for listen in (address, "0.0.0.0:%d" % service.port):
                done = run("health", environment={"TUNEWRIGHT_LISTEN": listen})
                self.assertEqual((done.returncode, done.stderr), (0, ""))
            done = run("health", "http://%s/nothing" % address)
            self.assertEqual(done.returncode, 1)
            self.assertIn("404", done.stderr)
        done = run("health", "--listen", address)
        self.assertEqual(done.returncode, 1)
        self.assertIn("nothing answers", done.stderr)
        for url in ("https://localhost:1/", "http://localhost", "localhost:80"):
            done = run("health", url)
            self.assertEqual(done.returncode, 2)
            self.assertIn("http://HOST:PORT/PATH", done.stderr)

    def test_a_taken_port_is_told_and_ends_with_3(self):
        with socket.socket() as taken:
            taken.bind(("127.0.0.1", 0))
            taken.listen()
            address = "127.0.0.1:%d" % taken.getsockname()[1]
            with tempfile.TemporaryDirectory() as folder:
                done = run("serve", "--listen", address, "--store", "sqlite:" + folder + "/jobs.db")
            self.assertEqual(done.returncode, 3)
            self.assertIn("the port is taken", done.stderr)
            self.assertIn(address, done.stderr)

    def test_a_second_service_cannot_share_the_port_or_the_store(self):
        with Service() as service:
            with tempfile.TemporaryDirectory() as folder:
                done = run("serve", "--listen", "127.0.0.1:%d" % service.port, "--store", "sqlite:" + folder + "/jobs.db")
            self.assertEqual(done.returncode, 3)
            done = run("serve", "--listen", "127.0.0.1:0", "--store", service.store)
            self.assertEqual(done.returncode, 4)
            self.assertIn("another tunewright is using it", done.stderr)

    def test_a_store_that_cannot_be_opened_is_told_and_ends_with_4(self):
        for path in ("/proc/nothing/jobs.db", "/"):
            done = run("serve", "--listen", "127.0.0.1:0", "--store", "sqlite:" + path)
            self.assertEqual(done.returncode, 4, done.stderr)
            self.assertIn("Cannot open the store", done.stderr)

    def test_a_store_whose_folders_are_missing_is_told_and_makes_none(self):
        with tempfile.TemporaryDirectory() as folder:
            done = run("serve", "--listen", "127.0.0.1:0", "--store", "sqlite:" + folder + "/a/b/jobs.db")
            self.assertEqual(done.returncode, 4, done.stderr)
            self.assertIn("there is no folder %s/a/b; create it, or correct the path" % folder, done.stderr)
            self.assertEqual(os.listdir(folder), [])
        done = run("serve", "--listen", "127.0.0.1:0", "--store", "sqlite:/tunewright-none/jobs.db")
        self.assertEqual(done.returncode, 4, done.stderr)
        self.assertFalse(os.path.exists("/tunewright-none"))

    def test_a_folder_for_a_file_is_told_with_its_option(self):
        with tempfile.TemporaryDirectory() as folder:
            for arguments in (("--auth", "keys", "--keys", folder), ("--notify-secrets", folder)):
                done = run("serve", "--listen", "127.0.0.1:0", "--store", "sqlite:" + folder + "/jobs.db", *arguments)
                self.assertEqual(done.returncode, 2, done.stderr)
                self.assertIn("cannot be used: it is a folder; %s names a file" % arguments[-2], done.stderr)

    def test_a_file_that_is_no_database_is_told(self):
        with tempfile.TemporaryDirectory() as folder:
            path = folder + "/jobs.db"
            with open(path, "w") as file:
                file.write("this is not a database\n" * 100)
            done = run("serve", "--listen", "127.0.0.1:0", "--store", "sqlite:" + path)
            self.assertEqual(done.returncode, 4)
            self.assertIn("not a database", done.stderr)

    def test_the_limit_on_a_body_is_set_by_its_option(self):
        padded = json.dumps(QUICK).encode() + b" " * (9 << 20)
        with Service() as service:
            self.assertEqual(service.post("/v1/jobs", padded).status, 413)
        with Service("--max-body", "16") as service:
            self.assertEqual(service.post("/v1/jobs", padded).status, 202)

    def test_identify_reads_a_file_as_exported(self):
        record = os.path.join(os.path.dirname(__file__), "..", "..", "data", "records", "tclab-step.csv")
        done = run("identify", record, "--u", "Q1", "--y", "T1", "--time-unit", "min")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertGreater(json.loads(done.stdout)["model"]["fit_percent"], 97)

    def test_ku_and_pu_alone_are_tuned_by_the_rules_that_need_no_more(self):
        done = run("tune", "--Ku", "0.903", "--Pu", "30.5", "--json")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        result = json.loads(done.stdout)
        entries = {entry["title"]: entry for entry in result["controllers"] if "controller" in entry}
        self.assertGreaterEqual(len(entries), 5)
        classic = [entry for title, entry in entries.items() if title == "Ziegler-Nichols, ultimate gain (PID)"][0]
        # Ziegler and Nichols (1942): 0.6 Ku, Pu/2, Pu/8.
        self.assertAlmostEqual(classic["controller"]["Kp"], 0.6 * 0.903, places=12)
        self.assertAlmostEqual(classic["controller"]["Ti"], 30.5 / 2, places=12)
        self.assertAlmostEqual(classic["controller"]["Td"], 30.5 / 8, places=12)
        for entry in entries.values():
            self.assertEqual(entry["verdict"][0]["code"], "robustness-unknown")
            self.assertNotIn("robustness", entry)
        with_gain = json.loads(run("tune", "--Ku", "0.903", "--Pu", "30.5", "--K", "4", "--json").stdout)
        self.assertGreater(len(with_gain["ranking"]), len(result["ranking"]))

    def test_what_ku_and_pu_alone_cannot_answer_is_refused(self):
        for words, pointer in ((("--Ku", "0.903"), "/ultimate/Pu"), (("--Ku", "0", "--Pu", "30"), "/ultimate/Ku"),
                               (("--Ku", "1", "--Pu", "30", "--method", "robust"), None),
                               (("--Ku", "1", "--Pu", "30", "--baseline", "1 2 3"), "/baseline"),
                               (("--Ku", "1", "--Pu", "30", "--plant", "2/(s+1)"), None)):
            with self.subTest(words):
                done = run("tune", *words)
                self.assertEqual(done.returncode, 1, done.stdout)
                problem = json.loads(done.stderr)
                if pointer:
                    self.assertIn(pointer, [fault["pointer"] for fault in problem["errors"]])

    def test_identify_answers_traces_only_where_asked(self):
        record = os.path.join(os.path.dirname(__file__), "..", "..", "data", "records", "tclab-step.csv")
        without = json.loads(run("identify", record).stdout)["model"]
        self.assertNotIn("fit", without)
        self.assertTrue(all("y_model" not in candidate for candidate in without["candidates"]))
        traces = json.loads(run("identify", record, "--traces").stdout)["model"]
        self.assertEqual(len(traces["fit"]["t"]), len(traces["fit"]["y_model"]))
        self.assertTrue(all(len(candidate["y_model"]) == len(traces["fit"]["t"]) for candidate in traces["candidates"]))
        self.assertEqual(traces["plant"], without["plant"])

    def test_identify_takes_a_set_point_and_the_ends_of_the_actuator(self):
        with tempfile.TemporaryDirectory() as folder:
            path = folder + "/trend.csv"
            with open(path, "w") as file:
                file.write("time,Ramp,temp,valve\n")
                for k in range(60):
                    file.write("%d,40,%.3f,%d\n" % (k, 20 + max(0, k - 12) * 0.4, 20 if k < 10 else 50))
            done = run("identify", path, "--r", "Ramp", "--u-limits", "0", "100")
            self.assertEqual(done.returncode, 0, done.stderr)
            problem = json.loads(run("identify", path, "--r", "Rump").stderr)
            self.assertEqual(problem["errors"][0]["pointer"], "/record/columns/r")
            problem = json.loads(run("identify", path, "--u-limits", "100", "0").stderr)
            self.assertEqual(problem["errors"][0]["pointer"], "/record/u_limits")
            problem = json.loads(run("identify", path, "--u-limits", "low", "0").stderr)
            self.assertEqual(problem["errors"][0]["pointer"], "/record/u_limits/0")

    def test_a_record_without_a_model_is_shown_by_three_rows(self):
        with tempfile.TemporaryDirectory() as folder:
            path = folder + "/flat.csv"
            with open(path, "w") as file:
                file.write("timestamp,u,y\n")
                file.writelines("%d.5,7,%d\n" % (1747040000 + k, k % 3) for k in range(1001))
            done = run("identify", path)
            self.assertEqual((done.returncode, done.stdout), (1, ""))
            self.assertLess(len(done.stderr), 1500)
            record = json.loads(done.stderr)["record"]
            self.assertEqual(record["samples"], 1001)
            self.assertEqual(record["t"], [1747040000.5, 1747040500.5, 1747041000.5])

    def test_identify_reads_lines_of_json(self):
        with tempfile.TemporaryDirectory() as folder:
            path = folder + "/log.ndjson"
            with open(path, "w") as file:
                for k in range(80):
                    y = 20 if k < 12 else 40 - 20 * 0.9 ** (k - 12)
                    file.write(json.dumps({"t": k, "u": 20 if k < 10 else 50, "y": round(y, 3)}) + "\n")
            done = run("identify", path)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertAlmostEqual(json.loads(done.stdout)["model"]["plant"]["K"], 20 / 30, delta=0.02)

    def test_any_member_of_the_request_can_be_set(self):
        plant = ("tune", "--plant", "2 e^(-3s)/(10s+1)", "--method", "robust", "--set", "tune.0.Mks=2")
        done = run(*plant, "--set", 'evaluate.own_step={"y": 20, "u": 10, "target": 60, "u_max": 100}', "--with-request")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        answer = json.loads(done.stdout)
        self.assertEqual(answer["request"]["evaluate"]["own_step"]["target"], 60)
        entry = answer["result"]["controllers"][0]
        self.assertAlmostEqual(entry["own_step"]["u_needed"], 10 + (60 - 20) / 2, delta=1e-6)
        self.assertAlmostEqual(entry["robustness"]["Mks"], 2, delta=2e-3)
        for setting, told in (("tune.3.Ms=2", "tune.3"), ("evaluate", "MEMBER=VALUE"), ("evalute.points=3", "evaluate")):
            done = run(*plant, "--set", setting)
            self.assertEqual((done.returncode, done.stdout), (1, ""), setting)
            self.assertIn(told, json.dumps(json.loads(done.stderr)), setting)

    def test_wrong_options_are_told(self):
        for arguments in (("--listen", "nowhere"), ("--listen", "127.0.0.1:99999"), ("--store", "mysql:x"),
                          ("--log-format", "xml"), ("--store", "sqlite::memory:"), ("--rate-limit", "nan")):
            done = run("serve", *arguments)
            self.assertEqual(done.returncode, 2, arguments)
            self.assertIn(arguments[1], done.stderr)
        self.assertNotEqual(run("serve", "--workers", "0").returncode, 0)
        self.assertNotEqual(run().returncode, 0)

    def test_options_come_from_the_environment_too(self):
        with tempfile.TemporaryDirectory() as folder:
            done = run("serve", environment={"TUNEWRIGHT_LISTEN": "nowhere", "TUNEWRIGHT_STORE": "sqlite:" + folder})
            self.assertEqual(done.returncode, 2)
            self.assertIn("nowhere", done.stderr)

    def test_a_variable_that_is_no_setting_is_told_with_the_nearest_one(self):
        strange = {"TUNEWRIGHT_RETENTON": "30d", "TUNEWRIGHT_NOTHING_AT_ALL": "1", "TUNEWRIGHT_WORKERS": "1",
                   "TUNEWRIGHT_SERVICE_HOST": "10.0.0.1", "TUNEWRIGHT_PORT": "tcp://10.0.0.1:80",
                   "TUNEWRIGHT_PORT_80_TCP_ADDR": "10.0.0.1"}
        with Service(environment=strange) as service:
            log = service.read_log()
        self.assertIn("the variable TUNEWRIGHT_RETENTON is set, but there is no such setting. Did you mean "
                      "TUNEWRIGHT_RETENTION?", log)
        self.assertIn("TUNEWRIGHT_NOTHING_AT_ALL is set, but there is no such setting. `tunewright serve --help`", log)
        for known in ("WORKERS", "SERVICE_HOST", "PORT", "PORT_80_TCP_ADDR"):
            self.assertNotIn("TUNEWRIGHT_%s is set" % known, log)

    def test_a_variable_of_an_option_that_may_be_repeated_is_a_list(self):
        hosts = {"TUNEWRIGHT_ALLOWED_HOST": "a.example,b.example"}
        with Service(environment=hosts) as service:
            for host, expected in (("a.example", 200), ("b.example", 200), ("c.example", 421)):
                self.assertEqual(service.get("/v1/methods", {"Host": host}).status, expected, host)

    def test_the_log_has_one_json_line_for_each_request_and_job(self):
        with Service("--log-format", "json") as service:
            service.post_job(dict(QUICK, name='a "quoted" name'), wait=30)
            service.get('/nothing?"%0a')
            service.stop()
            lines = [json.loads(line) for line in service.read_log().splitlines()]
        events = [line.get("event") for line in lines]
        self.assertEqual(events.count("job"), 1)
        self.assertEqual(events.count("request"), 2)
        self.assertEqual([line["status"] for line in lines if line.get("event") == "request"], [200, 404])


class PageFolderTest(unittest.TestCase):
    def test_the_page_comes_from_the_named_folder(self):
        with tempfile.TemporaryDirectory() as folder:
            os.mkdir(folder + "/assets")
            for name, text in (("index.html", "<!doctype html>hello"), ("assets/a-1.js", "1"), (".hidden", "secret")):
                with open(folder + "/" + name, "w") as file:
                    file.write(text)
            with Service("--web", folder) as service:
                self.assertEqual(service.get("/").body, b"<!doctype html>hello")
                script = service.get("/assets/a-1.js")
                self.assertEqual(script.media_type, "text/javascript")
                self.assertIn("immutable", script.headers["Cache-Control"])
                self.assertEqual(service.get("/.hidden").status, 404)

    def test_without_a_page_the_root_says_how_to_build_it(self):
        with Service("--web", "/nothing") as service:
            answer = service.get("/")
            self.assertEqual(answer.status, 200)
            self.assertIn(b"script/server", answer.body)


if __name__ == "__main__":
    unittest.main()
