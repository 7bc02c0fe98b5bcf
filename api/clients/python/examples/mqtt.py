"""Two topics of an MQTT broker: the sensor publishes y, the actuator listens to u.

    python3 mqtt.py broker.local house/boiler/temperature house/boiler/valve
"""

import sys
import time
from typing import Callable, Tuple

import paho.mqtt.client as mqtt

from tunewright import Client, autotune


def connect(host: str, port: int, y_topic: str, u_topic: str,
            longest_silence: float) -> Tuple[Callable[[], Tuple[float, bool]], Callable[[float], None]]:
    last = {"y": 0.0, "at": -1e9}

    def heard(_client: mqtt.Client, _data: object, message: mqtt.MQTTMessage) -> None:
        last.update(y=float(message.payload), at=time.monotonic())

    client = mqtt.Client()
    client.on_message = heard
    client.on_connect = lambda *_: client.subscribe(y_topic)  # again after a lost connection
    client.connect(host, port)
    client.loop_start()

    def read() -> Tuple[float, bool]:
        return last["y"], time.monotonic() - last["at"] < longest_silence

    def write(u: float) -> None:
        client.publish(u_topic, "%g" % u, qos=1).wait_for_publish(timeout=1)
        if not client.is_connected():
            raise ConnectionError("The broker is lost.")

    return read, write


def main(host: str, y_topic: str, u_topic: str, address: str = "http://127.0.0.1:8080") -> None:
    read, write = connect(host, 1883, y_topic, u_topic, longest_silence=5)
    time.sleep(5)  # for the first value
    tuned = autotune(read, write, u=30, sample_time=1, u_step=10, u_min=0, u_max=100, y_min=0, y_max=90, u_safe=0,
                     client=Client(address), keep="record.csv")
    print(tuned.controller)


if __name__ == "__main__":
    main(*sys.argv[1:])
