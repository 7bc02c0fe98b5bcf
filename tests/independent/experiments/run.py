#!/usr/bin/python3
"""Simulated plants under the programs of `tunewright code --experiment`: do they end by themselves within their limits,
and do settings from their record hold Ms on the true plant?

    tests/independent/experiments/run.py [--binary FILE] [--experiment relay] [--seed 1] [--Ms 1.4] [--keep FOLDER]
    tests/independent/experiments/run.py --client [...]

--client: through autotune of the Python client, with a service that is killed and started again every ten seconds.

Prints a line for each plant, then counts; exit code 1 if a test did not end or broke a limit, or if fewer than 95 % of the
settings hold Ms within 1.25 times the limit."""

import argparse
import json
import pathlib
import random
import socket
import subprocess
import sys
import tempfile
import threading

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "structures"))
from frequency import grid, peak, unstable_zeros  # noqa: E402
from plants import Simulation, sixty  # noqa: E402

ROOT = pathlib.Path(__file__).resolve().parents[3]
U0, Y0, STEP = 40.0, 20.0, 10.0


def program(binary, kind, options):
    words = [word for name, value in options.items() for word in ("--" + name.replace("_", "-"), str(value))]
    text = subprocess.run([binary, "code", "--experiment", kind, "--language", "python", *words], check=True,
                          capture_output=True, text=True).stdout
    space = {}
    exec(compile(text, kind, "exec"), space)
    return space["Tunewright" + kind.capitalize()](), space["REASONS"]


def simulate(test, plant, Ts, case, size, chance, most=6000):
    """Rows, and whether u and y stayed within the limits."""
    process, rows = Simulation(plant, Ts), ["t,u,y"]
    test.step(Y0, U0, False)
    for k in range(most):
        y = Y0 + process.sample() + chance.gauss(0, 1) * case["noise"] * size
        if case["quantum"]:
            quantum = case["quantum"] * size
            y = round(y / quantum) * quantum
        u, mode, reason, recording = test.step(y, U0, True)
        if recording:
            rows.append(test.row())
        if mode >= 4:
            return rows, reason, u
        process.advance(u - U0 + case["drift"] * STEP * min(1, k * Ts / (20 * case["period"])))
    return rows, None, u


class RestartedService:
    """A service on one port and one store that is killed and started again every ten seconds, and a client of it."""

    def __init__(self, binary, folder):
        with socket.socket() as free:
            free.bind(("127.0.0.1", 0))
            self.port = free.getsockname()[1]
        self.command = [binary, "serve", "--listen", "127.0.0.1:%d" % self.port, "--store", "sqlite:%s/jobs.db" % folder]
        self.kills, self.over = 0, threading.Event()
        self.start()
        sys.path.insert(0, str(ROOT / "api" / "clients" / "python"))
        from tunewright import Client
        self.client = Client("http://127.0.0.1:%d" % self.port)
        self.client.get("/v1/methods")
        threading.Thread(target=self.restart, daemon=True).start()

    def start(self):
        self.process = subprocess.Popen(self.command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
        self.process.stdout.readline()

    def restart(self):
        while not self.over.wait(10.0):
            self.process.kill()
            self.process.wait()
            self.kills += 1
            self.start()

    def stop(self):
        self.over.set()
        self.process.kill()


def through_client(service, kind, options, plant, Ts, case, size, chance, Ms):
    """The same test by autotune; its result in the place of the file's."""
    from tunewright import Problem, TestStopped, autotune
    process, now = Simulation(plant, Ts), {"t": 0.0, "u": U0}

    def read():
        y = Y0 + process.sample() + chance.gauss(0, 1) * case["noise"] * size
        quantum = case["quantum"] * size
        return round(y / quantum) * quantum if quantum else y

    def write(u):
        now["u"] = u

    def sleep(seconds):
        process.advance(now["u"] - U0 + case["drift"] * STEP * min(1, now["t"] / (20 * case["period"])))
        now["t"] += seconds

    def tuned_with(limit):
        return autotune(read, write, U0, experiment=kind, Ms=limit, client=service.client,
                        clock=lambda: now["t"], sleep=sleep, background=False, show=None, **options)

    try:
        return Ms, tuned_with(Ms).result, now["u"], None
    except TestStopped as stopped:
        return Ms, {}, now["u"], str(stopped)
    except Problem as problem:  # no controller of the model keeps the limit: the record again with the least that one keeps
        limit = float(problem.body["cure"]["options"]["Ms"])
        request = {"record": problem.record, "tune": [{"method": "robust", "Ms": limit, "Mt": limit}], "evaluate": {"points": 0}}
        return limit, service.client.run(request), now["u"], None


def controller_of(entry):
    c = entry["controller"]
    filt, Tf = c.get("filter", {"type": "none"})["type"], c.get("filter", {}).get("Tf", 0)

    def C(s):
        Ti = c.get("Ti")
        P = c["Kp"] * (1 + (1 / (Ti * s) if Ti else 0) + c.get("Td", 0) * s)
        x = s * Tf
        return P / {"none": 1, "measurement_first_order": 1 + x, "measurement_second_order": 1 + x + x * x / 2}[filt]
    return C


def judge(plant, entry):
    """Ms on the true plant; infinity if unstable."""
    C = controller_of(entry)
    c = entry["controller"]
    times = plant.times + [c.get("Ti") or 1, *([c["Td"]] if c.get("Td") else [])]
    omega = grid(times, 400)
    stable = unstable_zeros(lambda s: 1 + plant(s) * C(s), plant.integrators + (1 if c.get("Ti") else 0), times, plant.unstable)
    if stable != 0:
        return float("inf")
    return peak(lambda s: 1 / (1 + plant(s) * C(s)), omega)[0]


def tuned(binary, file, Ms):
    """The limit and the answer; where no controller of the model keeps the limit, with the smallest that one keeps."""
    for limit in (Ms, None):
        if limit is None:
            cure = answer.get("cure", {}).get("options", {}).get("Ms")
            if not cure:
                break
            limit = Ms = float(cure)
        done = subprocess.run([binary, "tune", str(file), "--Ms", str(limit), "--set", "evaluate.points=0"],
                              capture_output=True, text=True)
        answer = json.loads(done.stdout or done.stderr)
        if done.returncode == 0:
            break
    return Ms, answer


def run(case, chosen, chance, folder, number):
    plant = case["plant"]
    omega, gain = plant.ultimate()
    case["period"] = 2 * np.pi / omega
    Ts = float("%.2g" % (case["period"] / case["samples"]))
    size = 4 / np.pi * STEP * gain  # amplitude by the describing function
    reach = 8 * max(size, STEP * abs(plant.K) if not plant.integrators and not plant.unstable else size)
    options = dict(sample_time=Ts, u_step=STEP, u_min=0, u_max=100, y_min=Y0 - reach, y_max=Y0 + reach)
    if chosen.experiment == "relay" and case["told"] and not chosen.untold:
        options["action"] = "reverse" if plant.K > 0 else "direct"
    if chosen.experiment == "bump" and plant.integrators:
        options["y_move"] = 3 * size
    if chosen.client:
        return run_client(case, chosen, options, Ts, size, chance, number)
    test, sentences = program(chosen.binary, chosen.experiment, options)
    rows, reason, u = simulate(test, plant, Ts, case, size, chance)
    file = folder / ("%02d.csv" % number)
    file.write_text("\n".join(rows) + "\n")
    line = "%02d %-18s %5d rows, %s" % (number, case["kind"], len(rows) - 1,
                                        "did not end" if reason is None else sentences[reason])
    if chosen.experiment == "relay":
        line += ", %d cycles, period %.3g of %.3g" % (test.cycles_done, test.period, case["period"])
    ended = reason in (1, 2) and u == U0
    ratio = None
    if ended:
        limit, answer = tuned(chosen.binary, file, chosen.Ms)
        if "controllers" in answer:
            Ms = judge(plant, answer["controllers"][0])
            ratio = Ms / limit
            data = answer["model"]["data_quality"]
            line += ", %s %s, Ms %.3f of %.3g" % (data["kind"], answer["model"]["plant"]["type"], Ms, limit)
        else:
            line += ", not tuned: " + json.dumps(answer)[:300]
    print(line, flush=True)
    return ended, ratio


def run_client(case, chosen, options, Ts, size, chance, number):
    limit, answer, u, why = through_client(chosen.service, chosen.experiment, options, case["plant"], Ts, case, size, chance,
                                           chosen.Ms)
    Ms = judge(case["plant"], answer["controllers"][0]) if "controllers" in answer else None
    print("%02d %-18s %s" % (number, case["kind"], why or "Ms %.3f of %.3g" % (Ms, limit)), flush=True)
    return why is None and u == U0, None if Ms is None else Ms / limit


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--binary", default=str(ROOT / "build" / "release" / "tunewright"))
    parser.add_argument("--experiment", default="relay")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--Ms", type=float, default=1.4)
    parser.add_argument("--keep")
    parser.add_argument("--only", type=int)
    parser.add_argument("--untold", action="store_true", help="the sign of the gain is never told")
    parser.add_argument("--client", action="store_true")
    chosen = parser.parse_args()
    chance = random.Random(chosen.seed)
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as temporary:
        folder = pathlib.Path(chosen.keep or temporary)
        folder.mkdir(exist_ok=True)
        if chosen.client:
            chosen.service = RestartedService(chosen.binary, folder)
        cases = sixty(chance)
        results = [run(case, chosen, random.Random(1000 * chosen.seed + i), folder, i) for i, case in enumerate(cases)
                   if chosen.only is None or i == chosen.only]
    if chosen.client:
        chosen.service.stop()
        print("the service was killed %d times" % chosen.service.kills)
    ended = sum(e for e, _ in results)
    held = sum(ratio is not None and ratio <= 1.25 for _, ratio in results)
    print("%d plants: %d ended by themselves within limits, settings hold Ms within 1.25 times %g on %d" %
          (len(results), ended, chosen.Ms, held))
    return int(ended < len(results) or held < 0.95 * len(results))


if __name__ == "__main__":
    sys.exit(main())
