"""Compares deploy/ with the binary, and tests nginx in front of real replicas."""

import http.client
import json
import pathlib
import re
import shutil
import socket
import ssl
import subprocess
import tempfile
import time
import unittest

import yaml

from faulty_places import OwnPostgres
from service import BINARY, FOPDT, QUICK, ROOT, Answer, Service

DEPLOY = ROOT / "deploy"
# Debian does not put it in an ordinary user's PATH.
NGINX = shutil.which("nginx") or shutil.which("nginx", path="/usr/sbin")


def manifests():
    return [document for name in ("api", "worker", "network", "secret.example")
            for document in yaml.safe_load_all((DEPLOY / "kubernetes" / (name + ".yaml")).read_text()) if document]


def of_kind(kind):
    found = [document for document in manifests() if document["kind"] == kind]
    assert found, kind
    return found


class OptionsTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.help = subprocess.run([BINARY, "serve", "--help"], capture_output=True, text=True, check=True).stdout
        cls.flags = set(re.findall(r"^  (?:-\w,)?(--[a-z-]+)", cls.help, re.M))
        cls.variables = set(re.findall(r"Env:(TUNEWRIGHT_[A-Z_]+)", cls.help))
        cls.defaults = dict(re.findall(r"^  (--[a-z-]+) .*?=(.*) \(Env:", cls.help, re.M))

    def test_every_variable_that_is_named_anywhere_exists(self):
        named = {}
        for path in [ROOT / "Dockerfile", ROOT / "docs" / "operations.md", *sorted(DEPLOY.rglob("*"))]:
            if path.is_file() and "secrets" not in path.parts:
                for name in re.findall(r"(?<!-D)TUNEWRIGHT_[A-Z_]+", path.read_text()):
                    named.setdefault(name, path.name)
        self.assertGreater(len(named), 5)
        self.assertEqual({name: where for name, where in named.items() if name not in self.variables}, {})

    def test_every_flag_of_the_manifests_exists(self):
        flags = {word for deployment in of_kind("Deployment") for container in self.containers(deployment)
                 for word in container["args"] if word.startswith("-")}
        self.assertIn("--role", flags)
        self.assertLessEqual(flags, self.flags)

    def test_every_option_is_in_the_operators_document(self):
        text = (ROOT / "docs" / "operations.md").read_text()
        self.assertEqual([flag for flag in sorted(self.flags - {"--help"}) if "`" + flag not in text], [])

    def test_the_operators_document_has_the_defaults_of_the_help(self):
        stated = {}
        for row in re.findall(r"^\| `--.*", (ROOT / "docs" / "operations.md").read_text(), re.M):
            _, options, default, *_ = re.split(r"(?<!\\)\|", row)
            flags, default = re.findall(r"`(--[a-z-]+)", options), default.strip().replace("`", "")
            parts = default.split(", ")
            stated.update(zip(flags, parts if len(parts) == len(flags) else [default] * len(flags)))
        self.assertGreater(len(self.defaults), 15)
        self.assertEqual({flag: stated.get(flag) for flag in self.defaults}, self.defaults)

    def test_what_repeats_a_default_has_that_of_the_help(self):
        body, batch = (int(self.defaults[flag].removesuffix("MiB")) for flag in ("--max-body", "--max-batch-body"))
        days, half = self.defaults["--retention"].removesuffix("d"), int(self.defaults["--queue-limit"]) // 2
        repeated = {
            "docs/records.md": ["--max-body SIZE` (%d MiB by default)" % body],
            "docs/jobs.md": ["after `--retention` (%s days;" % days],
            "docs/operations.md": ["more than {:,} jobs (half the default `--queue-limit`)".format(half)],
            "deploy/prometheus/rules.yaml": ["max(tunewright_jobs_queued) > %d " % half],
            # One more, so that the service's own answer says what is wrong.
            "deploy/nginx/nginx.conf": ["the service's own %d and %d MiB" % (body, batch),
                                        "client_max_body_size %dm;" % (body + 1), "client_max_body_size %dm;" % (batch + 1)]}
        for name, sentences in repeated.items():
            text = " ".join((ROOT / name).read_text().split())
            self.assertEqual([one for one in sentences if one not in text], [], name)

    @staticmethod
    def containers(deployment):
        return deployment["spec"]["template"]["spec"]["containers"]


class KubernetesTest(unittest.TestCase):
    def test_pods_may_do_nothing_that_they_need_not(self):
        for deployment in of_kind("Deployment"):
            pod = deployment["spec"]["template"]["spec"]
            self.assertTrue(pod["securityContext"]["runAsNonRoot"])
            self.assertEqual(pod["securityContext"]["seccompProfile"]["type"], "RuntimeDefault")
            self.assertFalse(pod["automountServiceAccountToken"])
            for container in pod["containers"]:
                may = container["securityContext"]
                self.assertTrue(may["readOnlyRootFilesystem"])
                self.assertFalse(may["allowPrivilegeEscalation"])
                self.assertEqual(may["capabilities"], {"drop": ["ALL"]})
                self.assertIn("memory", container["resources"]["limits"])

    def test_the_user_is_that_of_the_image(self):
        user = int(re.search(r"^USER (\d+)$", (ROOT / "Dockerfile").read_text(), re.M).group(1))
        for deployment in of_kind("Deployment"):
            self.assertEqual(deployment["spec"]["template"]["spec"]["securityContext"]["runAsUser"], user)

    def test_probes_are_answered_by_the_service(self):
        paths = {container[probe]["httpGet"]["path"] for deployment in of_kind("Deployment")
                 for container in deployment["spec"]["template"]["spec"]["containers"]
                 for probe in ("startupProbe", "livenessProbe", "readinessProbe")}
        with Service() as service:
            self.assertEqual({path: service.get(path).status for path in paths}, dict.fromkeys(paths, 200))

    def test_a_pod_is_given_longer_to_end_than_it_takes(self):
        for deployment in of_kind("Deployment"):
            pod = deployment["spec"]["template"]["spec"]
            container = pod["containers"][0]
            drain = float(container["args"][container["args"].index("--drain-timeout") + 1])
            pause = float(container.get("lifecycle", {}).get("preStop", {}).get("exec", {}).get("command", [0, 0])[1])
            self.assertGreater(pod["terminationGracePeriodSeconds"], drain + pause + 5)

    def test_what_refers_to_pods_finds_them(self):
        labels = [deployment["spec"]["template"]["metadata"]["labels"] for deployment in of_kind("Deployment")]
        selectors = [item["spec"]["selector"]["matchLabels"] for item in of_kind("PodDisruptionBudget")]
        selectors += [item["spec"]["selector"] for item in of_kind("Service")]
        selectors += [item["spec"]["podSelector"]["matchLabels"] for item in of_kind("NetworkPolicy")]
        selectors += [item["spec"]["selector"]["matchLabels"] for item in of_kind("Deployment")]
        for selector in selectors:
            self.assertTrue(any(selector.items() <= one.items() for one in labels), selector)
        names = {deployment["metadata"]["name"] for deployment in of_kind("Deployment")}
        self.assertEqual({item["spec"]["scaleTargetRef"]["name"] for item in of_kind("HorizontalPodAutoscaler")}, names)

    def test_mounted_secrets_have_the_keys_that_are_read(self):
        secret = of_kind("Secret")[0]
        for deployment in of_kind("Deployment"):
            pod = deployment["spec"]["template"]["spec"]
            self.assertEqual(pod["volumes"][0]["secret"]["secretName"], secret["metadata"]["name"])
            for item in pod["containers"][0]["env"]:
                if item["value"].startswith("/etc/tunewright/"):
                    self.assertIn(item["value"].rsplit("/", 1)[1], secret["stringData"])

    def test_kustomize_names_every_manifest(self):
        folder = DEPLOY / "kubernetes"
        named = set(yaml.safe_load((folder / "kustomization.yaml").read_text())["resources"])
        there = {path.name for path in folder.glob("*.yaml")} - {"kustomization.yaml", "secret.example.yaml"}
        self.assertEqual(named, there)


class OptionalManifestsTest(unittest.TestCase):
    """Optional manifests for a cluster's operators: ingress, Prometheus, its adapter."""

    @classmethod
    def setUpClass(cls):
        cls.found = {document["kind"]: document for path in (DEPLOY / "kubernetes" / "optional").glob("*.yaml")
                     for document in yaml.safe_load_all(path.read_text())}
        cls.deployments = {deployment["metadata"]["name"]: deployment for deployment in of_kind("Deployment")}

    def test_the_ingress_leads_to_the_service(self):
        service = next(item for item in of_kind("Service") if item["metadata"]["name"] == "tunewright")
        ingress = self.found["Ingress"]
        backend = ingress["spec"]["rules"][0]["http"]["paths"][0]["backend"]["service"]
        self.assertEqual(backend["name"], service["metadata"]["name"])
        self.assertIn(backend["port"]["name"], [port["name"] for port in service["spec"]["ports"]])
        self.assertEqual({host for entry in ingress["spec"]["tls"] for host in entry["hosts"]},
                         {rule["host"] for rule in ingress["spec"]["rules"]})

    def test_prometheus_finds_every_replica(self):
        service, monitor = self.found["Service"], self.found["ServiceMonitor"]
        wanted = monitor["spec"]["selector"]["matchLabels"]
        self.assertLessEqual(wanted.items(), service["metadata"]["labels"].items())
        for other in of_kind("Service"):
            self.assertFalse(wanted.items() <= other["metadata"]["labels"].items(), "it would be scraped twice")
        port = service["spec"]["ports"][0]
        self.assertEqual(monitor["spec"]["endpoints"][0]["port"], port["name"])
        for deployment in self.deployments.values():
            pod = deployment["spec"]["template"]
            self.assertLessEqual(service["spec"]["selector"].items(), pod["metadata"]["labels"].items())
            self.assertIn(port["targetPort"], [one["name"] for one in pod["spec"]["containers"][0]["ports"]])

    def test_workers_scale_by_figures_that_there_are(self):
        scaler = self.found["HorizontalPodAutoscaler"]
        self.assertIn(scaler["spec"]["scaleTargetRef"]["name"], self.deployments)
        self.assertIn(scaler["metadata"]["name"], [item["metadata"]["name"] for item in of_kind(scaler["kind"])])
        with Service() as service:
            figures = service.get("/metrics").body.decode()
        for metric in scaler["spec"]["metrics"]:
            named = metric["external"]["metric"]
            label = '%s{class="%s"}' % (named["name"], named["selector"]["matchLabels"]["class"])
            self.assertIn(label, figures)


class ComposeTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.compose = yaml.safe_load((DEPLOY / "compose.yaml").read_text())
        cls.services = cls.compose["services"]

    def test_every_service_is_locked_down_and_comes_back(self):
        for name, service in self.services.items():
            self.assertTrue(service["read_only"], name)
            self.assertEqual(service["cap_drop"], ["ALL"], name)
            self.assertIn("no-new-privileges:true", service["security_opt"], name)
            self.assertEqual(service["restart"], "unless-stopped", name)

    def test_only_the_proxy_has_a_port_and_a_way_out(self):
        self.assertEqual([name for name, service in self.services.items() if "ports" in service], ["nginx"])
        self.assertEqual([name for name, service in self.services.items() if "outside" in service["networks"]], ["nginx"])

    def test_secrets_are_files_that_are_declared_and_read(self):
        declared = set(self.compose["secrets"])
        self.assertEqual({secret for service in self.services.values() for secret in service["secrets"]}, declared)
        for service in self.services.values():
            for value in service.get("environment", {}).values():
                if value.startswith("/run/secrets/"):
                    self.assertIn(value.rsplit("/", 1)[1], service["secrets"])
                self.assertNotRegex(value, "://[^/]*:", "a password in an address")

    def test_three_replicas_are_the_ones_that_nginx_knows(self):
        replicas = [name for name in self.services if name.startswith("tunewright-")]
        self.assertEqual(len(replicas), 3)
        known = re.findall(r"^\s*server (\S+):8080 ", (DEPLOY / "nginx" / "nginx.conf").read_text(), re.M)
        self.assertEqual(known, replicas)

    def test_a_replica_may_have_a_thread_for_each_connection(self):
        limits = (ROOT / "server" / "http" / "guard" / "server.h").read_text()
        connections = int(re.search(r"connections = (\d+);", limits).group(1))
        for name in ("tunewright-1", "tunewright-2", "tunewright-3"):
            self.assertGreaterEqual(self.services[name]["pids_limit"], connections + 100)


class NginxConfiguration:
    """deploy/nginx/nginx.conf with the addresses and paths of this test, otherwise unchanged."""

    def __init__(self, folder, ports):
        with socket.socket() as probe:
            probe.bind(("127.0.0.1", 0))
            self.port = probe.getsockname()[1]
        text = (DEPLOY / "nginx" / "nginx.conf").read_text()
        text = self.replaced(text, r"/tmp/nginx", folder + "/nginx", 6)
        text = self.replaced(text, r"listen 8443 ", "listen 127.0.0.1:%d " % self.port, 1)
        text = self.replaced(text, r"/run/secrets/tls-certificate", folder + "/certificate.pem", 1)
        text = self.replaced(text, r"/run/secrets/tls-key", folder + "/key.pem", 1)
        for i, port in enumerate(ports, 1):
            text = self.replaced(text, r"tunewright-%d:8080" % i, "127.0.0.1:%d" % port, 1)
        # The logs are in the test's folder, and nginx stays its child process.
        text = self.replaced(text, r"/dev/stdout", folder + "/access.log", 1)
        text = self.replaced(text, r"error_log stderr", "error_log " + folder + "/error.log", 1)
        self.path = pathlib.Path(folder, "nginx.conf")
        self.path.write_text("daemon off;\n" + text)
        subprocess.run(["openssl", "req", "-x509", "-newkey", "rsa:2048", "-nodes", "-days", "1", "-subj", "/CN=localhost",
                        "-keyout", folder + "/key.pem", "-out", folder + "/certificate.pem"], check=True, capture_output=True)

    @staticmethod
    def replaced(text, pattern, by, times):
        text, count = re.subn(pattern, by, text)
        assert count == times, "%s: %d times" % (pattern, count)
        return text


@unittest.skipUnless(NGINX and shutil.which("openssl"), "nginx or openssl is not installed: run script/bootstrap test")
class NginxTest(unittest.TestCase):
    """TLS in front of three replicas on one PostgreSQL."""

    @classmethod
    def setUpClass(cls):
        cls.place = OwnPostgres()
        cls.enterClass(cls.place)
        cls.replicas = [Service("--workers", "1", "--behind-proxy", store=cls.place.store) for _ in range(3)]
        for replica in cls.replicas:
            cls.addClassCleanup(replica.__exit__)
        folder = tempfile.TemporaryDirectory(prefix="tunewright-nginx-")
        cls.addClassCleanup(folder.cleanup)
        pathlib.Path(folder.name).chmod(0o777)
        cls.configuration = NginxConfiguration(folder.name, [replica.port for replica in cls.replicas])
        cls.command = [NGINX, "-p", folder.name, "-c", str(cls.configuration.path), "-e", folder.name + "/error.log"]
        cls.nginx = subprocess.Popen(cls.command)
        cls.addClassCleanup(cls.nginx.wait, 20)
        cls.addClassCleanup(cls.nginx.terminate)
        end = time.monotonic() + 20
        while True:
            try:
                if cls.call("GET", "/healthz").status == 200:
                    return
            except OSError:
                pass
            if cls.nginx.poll() is not None or time.monotonic() > end:
                raise AssertionError(pathlib.Path(folder.name, "error.log").read_text())
            time.sleep(0.05)

    @classmethod
    def enterClass(cls, place):
        place.__enter__()
        cls.addClassCleanup(place.__exit__)

    @classmethod
    def connect(cls):
        context = ssl.create_default_context()
        context.check_hostname = False
        context.verify_mode = ssl.CERT_NONE
        return http.client.HTTPSConnection("127.0.0.1", cls.configuration.port, timeout=60, context=context)

    @classmethod
    def call(cls, method, path, body=None, headers=None):
        connection = cls.connect()
        try:
            connection.request(method, path, body, {"Content-Type": "application/json", **(headers or {})})
            return Answer(connection.getresponse())
        finally:
            connection.close()

    def test_nginx_finds_nothing_wrong(self):
        done = subprocess.run([*self.command, "-t"], capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        # nginx 1.25 has another directive for HTTP/2, which 1.22 of Debian 12 does not have.
        others = [line for line in done.stderr.splitlines() if '"listen ... http2" directive is deprecated' not in line]
        self.assertNotIn("[warn]", "\n".join(others))

    def test_a_tune_is_answered_by_whichever_replica_is_asked(self):
        for _ in range(6):
            answer = self.call("POST", "/v1/jobs", json.dumps(QUICK), {"Prefer": "wait=30"})
            self.assertEqual((answer.status, answer.json["status"]), (200, "succeeded"))
            self.assertEqual(self.call("GET", "/v1/jobs/" + answer.json["id"]).json["status"], "succeeded")
        self.assertTrue(all("/v1/jobs" in replica.read_log() for replica in self.replicas))

    def test_a_batch_goes_in_and_its_results_come_out_in_order(self):
        lines = "".join(json.dumps({"name": "loop %d" % i, "plant": FOPDT, "tune": [{"method": "simc"}]}) + "\n"
                        for i in range(3000))
        answer = self.call("POST", "/v1/batches", lines, {"Content-Type": "application/x-ndjson"})
        self.assertEqual(answer.status, 202, answer.body[:300])
        results = self.call("GET", "/v1/batches/%s/results?follow=true" % answer.json["id"])
        rows = [json.loads(line) for line in results.body.splitlines()]
        self.assertEqual([row["name"] for row in rows], ["loop %d" % i for i in range(3000)])
        self.assertEqual({row["status"] for row in rows}, {"succeeded"})

    def test_rows_that_come_as_their_jobs_end_are_waited_for_and_no_query_is_logged(self):
        dumped = subprocess.run([*self.command, "-T"], capture_output=True, text=True).stdout
        place = re.search(r"location ~ (\S+) \{\s+proxy_read_timeout 1d;", dumped).group(1)
        self.assertRegex("/v1/batches/x/results", place)
        self.assertNotRegex("/v1/batches", place)
        self.call("GET", "/v1/batches/none/results?follow=true&secret=hidden")
        log = pathlib.Path(self.configuration.path.parent, "access.log")
        end = time.monotonic() + 20
        while '"GET /v1/batches/none/results HTTP/1.1" 422' not in log.read_text():
            self.assertLess(time.monotonic(), end, log.read_text()[-2000:])
            time.sleep(0.05)
        self.assertNotIn("hidden", log.read_text())

    def test_events_come_as_they_happen(self):
        slow = {"plant": {"type": "sopdt", "K": 1, "T1": 10, "T2": 4, "L": 3},
                "tune": [{"method": "robust", "search": "grid", "surface": True} for _ in range(4)]}
        job = self.call("POST", "/v1/jobs", json.dumps(slow)).json["id"]
        connection = self.connect()
        connection.request("GET", "/v1/jobs/%s/events" % job)
        answer = connection.getresponse()
        self.assertEqual((answer.status, answer.getheader("Content-Type")), (200, "text/event-stream"))
        events, moments = [], []
        for line in answer:
            if line.startswith(b"event:"):
                events.append(line.split(b":")[1].strip().decode())
                moments.append(self.call("GET", "/v1/jobs/" + job).json["status"])
            if events and events[-1] == "done" and line.strip() == b"":
                break
        connection.close()
        self.assertEqual(events[-1], "done")
        self.assertEqual(set(events[:-1]), {"progress"})
        self.assertIn("running", moments, "an event came while the job was running")

    def test_the_forwarded_address_is_the_one_that_is_logged(self):
        self.call("GET", "/v1/methods/simc", headers={"X-Forwarded-For": "192.0.2.7"})
        logs = "".join(replica.read_log() for replica in self.replicas)
        self.assertNotIn("192.0.2.7", logs)

    def test_metrics_stay_inside(self):
        self.assertEqual(self.call("GET", "/metrics").status, 404)

    def test_a_body_that_is_too_large_gets_the_services_own_answer(self):
        answer = self.call("POST", "/v1/jobs", b" " * (8 * 2**20 + 1000))
        self.assertEqual((answer.status, answer.media_type), (413, "application/problem+json"))


if __name__ == "__main__":
    unittest.main()
