"""The content of /metrics, and a check that rules, dashboard and documents mention only existing metrics."""

import json
import os
import re
import shutil
import signal
import subprocess
import time
import unittest

import yaml

from faulty_places import OwnPostgres
from service import FOPDT, QUICK, ROOT, Service

RULES = ROOT / "deploy" / "prometheus" / "rules.yaml"
DASHBOARD = ROOT / "deploy" / "grafana" / "tunewright.json"
# Long enough to be observed, and to keep the only worker from the next job.
SLOW = {"plant": FOPDT, "tune": [{"method": "all"}], "evaluate": {"points": 1500}}
# Written only after a fault.
OF_FAULTS = {"tunewright_store_faults_total"}


def figures(service):
    """{name with labels: value}; checks that each line has Prometheus' text form."""
    answer = service.get("/metrics")
    assert answer.status == 200, answer.status
    found = {}
    for line in answer.body.decode().splitlines():
        if line.startswith("#"):
            continue
        sample = re.fullmatch(r'([a-z_]+)(\{(?:[a-z_]+="(?:[^"\\]|\\.)*",?)*\})? (\S+)', line)
        assert sample, line
        found[sample[1] + (sample[2] or "")] = float(sample[3])
    return found


def family_of(parent):
    """A process and its children."""
    children = []
    for entry in os.listdir("/proc"):
        try:
            with open("/proc/%s/stat" % entry) as file:
                if int(file.read().rpartition(")")[2].split()[1]) == parent:
                    children.append(int(entry))
        except (OSError, ValueError, IndexError):
            continue
    return [parent, *children]


def names_in(text):
    names = re.findall(r"\b(?:tunewright|process)_[a-z_]+", text)
    return {re.sub(r"_(bucket|sum|count)$", "", name) for name in names}


class MetricsTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.service = Service("--workers", "1")
        cls.service.__enter__()
        for _ in range(3):
            cls.service.post("/v1/jobs", QUICK, {"Prefer": "wait=20"})
        cls.service.post("/v1/evaluate", {"plant": FOPDT, "controllers": [{"form": "ideal", "Kp": 1}]})

    @classmethod
    def tearDownClass(cls):
        cls.service.__exit__(None, None, None)

    def exposed(self):
        return {re.sub(r"_(bucket|sum|count)$", "", name.split("{")[0]) for name in figures(self.service)}

    def test_rules_dashboard_and_document_name_what_there_is(self):
        there = self.exposed() | OF_FAULTS
        document = (ROOT / "docs" / "operations.md").read_text()
        for text in (RULES.read_text(), DASHBOARD.read_text(), document):
            named = names_in(text) - {"process_"}
            self.assertGreater(len(named), 5)
            self.assertEqual(sorted(named - there), [])
        own = {name for name in there if name.startswith("tunewright_")}
        self.assertEqual(sorted(own - names_in(document)), [])

    def test_alerts_are_those_of_the_document(self):
        alerts = {rule["alert"] for group in yaml.safe_load(RULES.read_text())["groups"] for rule in group["rules"]}
        document = (ROOT / "docs" / "operations.md").read_text()
        self.assertEqual(alerts, set(re.findall(r"^\| `(Tunewright\w+)` \|", document, re.M)))

    @unittest.skipUnless(shutil.which("promtool"), "promtool is not installed: run script/bootstrap test")
    def test_promtool_takes_the_rules_and_the_figures(self):
        checked = subprocess.run(["promtool", "check", "rules", str(RULES)], capture_output=True, text=True)
        self.assertEqual(checked.returncode, 0, checked.stdout + checked.stderr)
        checked = subprocess.run(["promtool", "check", "metrics"], input=self.service.get("/metrics").body,
                                 capture_output=True)
        self.assertEqual(checked.returncode, 0, checked.stdout + checked.stderr)

    def test_the_dashboard_is_one(self):
        board = json.loads(DASHBOARD.read_text())
        self.assertEqual(len({panel["id"] for panel in board["panels"]}), len(board["panels"]))
        taken = set()
        for panel in board["panels"]:
            place = panel["gridPos"]
            cells = {(x, y) for x in range(place["x"], place["x"] + place["w"])
                     for y in range(place["y"], place["y"] + place["h"])}
            self.assertLessEqual(place["x"] + place["w"], 24)
            self.assertFalse(cells & taken, panel["title"])
            taken |= cells
            self.assertTrue(panel["targets"] and all(target["expr"] for target in panel["targets"]))

    def test_jobs_are_counted_with_their_wait(self):
        end = time.monotonic() + 20
        while (before := figures(self.service))["tunewright_jobs_running"] > 0:
            self.assertLess(time.monotonic(), end)
            time.sleep(0.1)
        self.service.post("/v1/jobs", QUICK, {"Prefer": "wait=20"})
        after = figures(self.service)
        wait = 'tunewright_job_wait_seconds_count{class="single"}'
        self.assertEqual(after[wait] - before[wait], 1)
        ended = 'tunewright_jobs_ended_total{status="succeeded"}'
        self.assertEqual(after[ended] - before[ended], 1)
        self.assertIn("3600", [name.split('le="')[1].rstrip('"}') for name in after
                               if name.startswith("tunewright_job_duration_seconds_bucket")])

    def test_a_waiting_job_grows_old(self):
        for _ in range(40):
            self.service.post("/v1/jobs", SLOW)
        end = time.monotonic() + 20
        age = 'tunewright_queue_age_seconds{class="single"}'
        while (seen := figures(self.service))[age] <= 0.5:
            self.assertLess(time.monotonic(), end)
            time.sleep(0.1)
        self.assertGreater(seen["tunewright_jobs_queued"], 0)
        for job in self.service.get("/v1/jobs?status=queued&limit=200").json["jobs"]:
            self.service.post("/v1/jobs/%s/cancel" % job["id"], "")
        while figures(self.service)[age] > 0:
            self.assertLess(time.monotonic(), end)
            time.sleep(0.1)

    def test_the_process_is_told(self):
        seen = figures(self.service)
        self.assertGreater(seen["process_open_fds"], 5)
        self.assertLess(seen["process_open_fds"], seen["process_max_fds"])
        self.assertGreater(seen["process_resident_memory_bytes"], 1e6)
        self.assertGreater(seen["process_cpu_seconds_total"], 0)
        self.assertLess(abs(time.time() - seen["process_start_time_seconds"]), 600)
        self.assertEqual([value for name, value in seen.items() if name.startswith("tunewright_build_info")], [1])
        self.assertGreaterEqual(seen["tunewright_http_connections"], 1)


class HangingStoreTest(unittest.TestCase):
    def test_metrics_and_health_answer_while_the_store_hangs(self):
        with OwnPostgres() as postgres, Service(store=postgres.store) as service:
            processes = family_of(postgres.cluster.process.pid)
            self.assertGreater(len(processes), 1)
            try:
                for process in processes:
                    os.kill(process, signal.SIGSTOP)
                time.sleep(1.5)
                for path in ("/metrics", "/healthz"):
                    started = time.monotonic()
                    self.assertEqual(service.get(path).status, 200)
                    self.assertLess(time.monotonic() - started, 2)
            finally:
                for process in processes:
                    os.kill(process, signal.SIGCONT)


if __name__ == "__main__":
    unittest.main()
