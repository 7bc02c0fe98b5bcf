"""From nothing to settings for a simulated heater, in one call."""

import math
import sys

from tunewright import Client, autotune


class Heater:
    """The energy balance of a TCLab's first heater: 0.004 kg, 500 J/(kg K), 12 cm2, 1 W at 100 %, with radiation, and a
    sensor with a lag of 20 s. The clock only runs in sleep()."""

    def __init__(self) -> None:
        self.T = self.sensor = 296.15
        self.Q = self.time = 0.0

    def read(self) -> float:
        return round((self.sensor - 273.15) / 0.0322) * 0.0322  # the sensor's resolution in degC

    def write(self, Q: float) -> None:
        self.Q = min(max(Q, 0.0), 100.0)

    def clock(self) -> float:
        return self.time

    def sleep(self, seconds: float) -> None:
        steps = max(1, math.ceil(seconds / 0.1))
        for _ in range(steps):
            loss = 10.0 * 1.2e-3 * (self.T - 296.15) + 0.9 * 5.67e-8 * 1.2e-3 * (self.T ** 4 - 296.15 ** 4)
            self.T += seconds / steps * (0.01 * self.Q - loss) / (0.004 * 500)
            self.sensor += seconds / steps * (self.T - self.sensor) / 20
        self.time += seconds


def main(address: str = "http://127.0.0.1:8080") -> None:
    lab = Heater()
    lab.write(30)
    lab.sleep(1200)  # it is warm
    tuned = autotune(lab.read, lab.write, u=30, sample_time=2, u_step=15, u_min=0, u_max=100, y_max=80, u_safe=0,
                     clock=lab.clock, sleep=lab.sleep, background=False, client=Client(address))
    print({name: tuned.controller[name] for name in ("Kp", "Ti", "Td")}, "enough:", tuned.enough)


if __name__ == "__main__":
    main(*sys.argv[1:])
