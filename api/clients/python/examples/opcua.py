"""Two nodes of an OPC UA server. Not run by the tests: Debian has no package of the library.

    python3 opcua.py opc.tcp://plc.local:4840 "ns=2;s=TIC101.PV" "ns=2;s=TIC101.OP"
"""

import sys
from typing import Callable, Tuple

from opcua import Client as OpcClient
from opcua import ua

from tunewright import Client, autotune


def connect(url: str, y_node: str, u_node: str) -> Tuple[Callable[[], Tuple[float, bool]], Callable[[float], float]]:
    server = OpcClient(url, timeout=2)
    server.connect()
    y, u = server.get_node(y_node), server.get_node(u_node)

    def read() -> Tuple[float, bool]:
        value = y.get_data_value()
        return float(value.Value.Value), value.StatusCode.is_good()

    def write(value: float) -> float:
        u.set_value(ua.DataValue(ua.Variant(float(value), ua.VariantType.Double)))
        return float(u.get_value())  # what the server has accepted

    return read, write


def main(url: str, y_node: str, u_node: str, address: str = "http://127.0.0.1:8080") -> None:
    read, write = connect(url, y_node, u_node)
    tuned = autotune(read, write, u=30, sample_time=1, u_step=10, u_min=0, u_max=100, y_min=0, y_max=90, u_safe=0,
                     client=Client(address), keep="record.csv")
    print(tuned.controller)


if __name__ == "__main__":
    main(*sys.argv[1:])
