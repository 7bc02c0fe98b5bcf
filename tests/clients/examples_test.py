"""The examples of autotune against local servers and a pseudo-terminal, in real time: a quick plant behind each.

Each is skipped where Debian's package of its library or server is not installed."""

import importlib.util
import math
import os
import pty
import shutil
import subprocess
import sys
import threading
import time
import tty
import unittest

from service import ROOT, Service

CLIENT = ROOT / "api" / "clients" / "python"
sys.path[:0] = [str(CLIENT), str(CLIENT / "examples")]
from tunewright import Client, TestStopped, autotune  # noqa: E402

U0, TS = 30.0, 0.05
BROKER = shutil.which("mosquitto") or shutil.which("/usr/sbin/mosquitto")


def has(package):
    return importlib.util.find_spec(package) is not None


class Plant:
    """40 + 1.2 e^(-0.2 s)/(0.8 s + 1) (u - 30), in real time."""

    def __init__(self):
        self.lock, self.time, self.u, self.x = threading.Lock(), time.monotonic(), U0, 0.0
        self.line = [0.0] * 20  # 0.01 s each

    def advance(self):
        now = time.monotonic()
        while self.time + 0.01 <= now:
            self.time += 0.01
            self.line.append(self.u - U0)
            self.x += (1 - math.exp(-0.01 / 0.8)) * (1.2 * self.line.pop(0) - self.x)

    @property
    def y(self):
        with self.lock:
            self.advance()
            return 40 + self.x

    def set(self, u):
        with self.lock:
            self.advance()
            self.u = u


class ExamplesTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.service = Service("--workers", "1")
        cls.addClassCleanup(lambda: (cls.service.stop(), cls.service.folder.cleanup()))
        cls.client = Client("http://127.0.0.1:%d" % cls.service.port)

    def tuned(self, plant, read, write):
        """The plant is found through the connection, and u is given back."""
        for left in (2, 1, 0):
            try:
                result = autotune(read, write, U0, sample_time=TS, u_step=10, u_min=0, u_max=100, y_min=0, y_max=90,
                                  u_safe=U0, cycles=5, max_time=60, client=self.client, show=None)
                break
            except TestStopped as stopped:  # a loaded machine calls late
                if stopped.reason != 15 or left == 0:
                    raise
                time.sleep(3)
        model = result.result["model"]["plant"]
        self.assertEqual(model["type"], "fopdt")
        for name, value, error in (("K", 1.2, 0.3), ("T", 0.8, 0.3), ("L", 0.25, 0.1)):  # calls come late by milliseconds
            self.assertAlmostEqual(model[name], value, delta=error)
        time.sleep(0.2)
        self.assertAlmostEqual(plant.u, U0, delta=0.06)

    @unittest.skipUnless(has("pymodbus"), "python3-pymodbus is not installed; script/bootstrap peers installs it")
    def test_modbus(self):
        import modbus
        from pymodbus.datastore import ModbusServerContext, ModbusSlaveContext
        from pymodbus.server import ServerStop, StartTcpServer

        plant = Plant()

        class Registers:
            """Register 0 reads y in tenths, register 1 is u in tenths."""

            def validate(self, address, count=1):
                return address in (0, 1) and count == 1

            def getValues(self, address, count=1):
                return [round(10 * (plant.y if address == 0 else plant.u))]

            def setValues(self, address, values):
                plant.set(values[0] / 10)

        slave = ModbusSlaveContext(hr=Registers(), zero_mode=True)
        port = free_port()
        threading.Thread(target=StartTcpServer, kwargs={"context": ModbusServerContext(slave), "address": ("127.0.0.1", port)},
                         daemon=True).start()
        self.addCleanup(ServerStop)
        time.sleep(0.5)
        self.tuned(plant, *modbus.connect("127.0.0.1", port))

    @unittest.skipUnless(has("paho.mqtt") if has("paho") else False,
                         "python3-paho-mqtt is not installed; script/bootstrap peers installs it")
    @unittest.skipUnless(BROKER, "mosquitto is not installed; script/bootstrap peers installs it")
    def test_mqtt(self):
        import mqtt
        import paho.mqtt.client as paho

        plant, port = Plant(), free_port()
        broker = subprocess.Popen([BROKER, "-p", str(port)], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.addCleanup(lambda: (broker.terminate(), broker.wait(10)))
        time.sleep(0.5)
        device = paho.Client()
        device.on_message = lambda _client, _data, message: plant.set(float(message.payload))
        device.connect("127.0.0.1", port)
        device.subscribe("plant/u")
        device.loop_start()
        over = threading.Event()

        def publish():
            while not over.wait(TS / 4):
                device.publish("plant/y", "%.4f" % plant.y)

        threading.Thread(target=publish, daemon=True).start()
        self.addCleanup(lambda: (over.set(), device.loop_stop(), device.disconnect()))
        read, write = mqtt.connect("127.0.0.1", port, "plant/y", "plant/u", longest_silence=1)
        time.sleep(0.3)
        self.tuned(plant, read, write)
        over.set()
        time.sleep(1.2)
        self.assertFalse(read()[1], "a silent sensor is a bad measurement")

    @unittest.skipUnless(has("serial"), "python3-serial is not installed; script/bootstrap peers installs it")
    def test_a_serial_line(self):
        import serial_line

        plant = Plant()
        board, line = pty.openpty()
        tty.setraw(line)

        def answer():
            with os.fdopen(board, "rb", buffering=0) as heard:
                words = b""
                while True:
                    try:
                        words += heard.read(1)
                    except OSError:
                        return
                    if not words.endswith(b"\n"):
                        continue
                    if words[:1] == b"Q":
                        plant.set(float(words[1:]))
                    os.write(board, b"%.4f\n" % (plant.u if words[:1] == b"Q" else plant.y))
                    words = b""

        threading.Thread(target=answer, daemon=True).start()
        self.addCleanup(lambda: os.close(line))
        self.tuned(plant, *serial_line.connect(os.ttyname(line)))

    def test_every_example_is_valid_and_named_by_the_readme(self):
        folder = CLIENT / "examples"
        named = (folder / "README.md").read_text()
        for file in sorted(folder.glob("*.py")):
            compile(file.read_text(), file.name, "exec")
            self.assertIn("`%s`" % file.name, named)


def free_port():
    import socket
    with socket.socket() as any_port:
        any_port.bind(("127.0.0.1", 0))
        return any_port.getsockname()[1]


if __name__ == "__main__":
    unittest.main()
