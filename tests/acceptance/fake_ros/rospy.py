"""As much of ROS 1 as a bridge asks for, and a skin's driver behind it: a chain of cells from port 2 to port 0, each with
a fixed acceleration of its own. What the LEDs are told goes to the file that FAKE_ROS_LEDS names."""
import math
import os
import threading
import time
from types import SimpleNamespace

CELLS = [100 + 3 * i for i in range(12)]


def _neighbours():
    cells = []
    for i, cell in enumerate(CELLS):
        before = CELLS[i - 1] if i > 0 else 0
        after = CELLS[i + 1] if i + 1 < len(CELLS) else 0
        cells.append(SimpleNamespace(cellId=cell, neighId=[before, 0, after, 0]))
    return SimpleNamespace(neighbors=cells)


def _set_leds(color):
    with open(os.environ["FAKE_ROS_LEDS"], "a", encoding="ascii") as log:
        log.write(f"{[(led.cellId, (led.r, led.g, led.b)) for led in color]}\n")


_SERVICES = {"getSkinCellIds": lambda: SimpleNamespace(cellId=list(reversed(CELLS))),
             "getSkinCellNeighbors": _neighbours, "setSkinCellLedColor": _set_leds}


def init_node(name, anonymous, disable_signals):
    del name, anonymous, disable_signals


def wait_for_service(name, timeout):
    if name.rsplit("/", 1)[-1] not in _SERVICES:
        raise RuntimeError(f"timeout exceeded while waiting for service {name}: {timeout} s")


def ServiceProxy(name, service_class, persistent):  # pylint: disable=invalid-name
    del service_class, persistent
    return _SERVICES[name.rsplit("/", 1)[-1]]


def _cell(cell):
    angle = 0.1 + 0.01 * cell
    return SimpleNamespace(cellId=cell, acc=[math.sin(angle), 0.0, math.cos(angle)], prox=[0.5], temp=[30.0],
                           force=[0.01, 0.02, 0.03])


def Subscriber(topic, data_class, callback, queue_size):  # pylint: disable=invalid-name
    del topic, data_class, queue_size

    def publish():
        while True:
            callback(SimpleNamespace(data=[_cell(cell) for cell in CELLS]))
            time.sleep(0.02)

    threading.Thread(target=publish, daemon=True).start()


def get_time():
    return time.monotonic()


def sleep(seconds):
    time.sleep(seconds)
