"""Two holding registers of a Modbus TCP device: y in register 0, u in register 1, both in tenths.

    python3 modbus.py 192.168.1.20 502
"""

import sys
from typing import Callable, Tuple

from pymodbus.client import ModbusTcpClient

from tunewright import Client, autotune


def connect(host: str, port: int) -> Tuple[Callable[[], float], Callable[[float], float]]:
    device = ModbusTcpClient(host, port=port, timeout=1)
    device.connect()

    def register(address: int) -> float:
        answer = device.read_holding_registers(address, 1)
        if answer.isError():
            raise ConnectionError(str(answer))
        return answer.registers[0] / 10

    def write(u: float) -> float:
        answer = device.write_register(1, round(10 * u))
        if answer.isError():
            raise ConnectionError(str(answer))
        return register(1)  # what the device has accepted

    return lambda: register(0), write


def main(host: str, port: str = "502", address: str = "http://127.0.0.1:8080") -> None:
    read, write = connect(host, int(port))
    tuned = autotune(read, write, u=30, sample_time=1, u_step=10, u_min=0, u_max=100, y_min=0, y_max=90, u_safe=0,
                     client=Client(address), keep="record.csv")
    print(tuned.controller)


if __name__ == "__main__":
    main(*sys.argv[1:])
