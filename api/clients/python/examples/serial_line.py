"""A board on a serial line that answers "T" with y and takes "Q 30" as u, which it repeats.

    python3 serial_line.py /dev/ttyUSB0
"""

import sys
from typing import Callable, Tuple

import serial

from tunewright import Client, autotune


def connect(port: str) -> Tuple[Callable[[], float], Callable[[float], float]]:
    line = serial.Serial(port, 115200, timeout=0.5)

    def ask(words: str) -> float:
        line.reset_input_buffer()
        line.write(words.encode() + b"\n")
        answer = line.readline()
        if not answer.endswith(b"\n"):
            raise ConnectionError("The board does not answer.")
        return float(answer)

    return lambda: ask("T"), lambda u: ask("Q %.3f" % u)


def main(port: str, address: str = "http://127.0.0.1:8080") -> None:
    read, write = connect(port)
    tuned = autotune(read, write, u=30, sample_time=1, u_step=10, u_min=0, u_max=100, y_min=0, y_max=90, u_safe=0,
                     client=Client(address), keep="record.csv")
    print(tuned.controller)


if __name__ == "__main__":
    main(*sys.argv[1:])
