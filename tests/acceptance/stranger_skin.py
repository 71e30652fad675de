"""A skin for tests: a chain of hexagons, each with a fixed acceleration of its own; it can lose and spoil frames.

    python3 stranger_skin.py [CELLS=7] [--drop P] [--flip P] [--seed S] [--ring] [--log FILE]
"""
import argparse
import math
import pathlib
import random
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "resources" / "bridges"))
from skin_protocol import Bridge, Cell, Vector  # noqa: E402, written from PROTOCOL.md alone

options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
options.add_argument("cells", nargs="?", type=int, default=7, help="how many, in a chain from port 2 to port 0")
options.add_argument("--drop", type=float, default=0.0, metavar="P", help="lose so many of the outgoing frames")
options.add_argument("--flip", type=float, default=0.0, metavar="P", help="flip a bit of so many outgoing bytes")
options.add_argument("--seed", type=int, default=1)
options.add_argument("--ring", action="store_true", help="link the ports 1 of the first and 3 of the last cell, too")
options.add_argument("--log", help="write to this file what the LEDs show")
args = options.parse_args()
dice = random.Random(args.seed)


def acceleration(cell: int) -> Vector:
    """1 g in a direction that only this cell has."""
    angle = 0.1 + 0.01 * cell
    return 9.81 * math.sin(angle), 0.0, 9.81 * math.cos(angle)


def spoil(frame: bytes) -> bytes:
    """What is left of a frame on a bad line."""
    if dice.random() < args.drop:
        return b""
    return bytes(byte ^ (1 << dice.randrange(8) if dice.random() < args.flip else 0) for byte in frame)


def set_leds(colours: dict) -> None:
    if args.log:
        with open(args.log, "a", encoding="ascii") as log:
            log.write(f"{sorted(colours.items())}\n")


links = [((i, 2), (i + 1, 0)) for i in range(args.cells - 1)]
if args.ring and args.cells > 2:
    links.append(((0, 1), (args.cells - 1, 3)))
Bridge([Cell(b"STRANGER" + i.to_bytes(4, "big"), "hex", 4) for i in range(args.cells)], links, (0, 0), set_leds,
       acceleration, temperature=lambda cell: 30.0, touch=lambda cell: (0.5, (0.1, 0.2, 0.3)), name="stranger",
       spoil=spoil if args.drop or args.flip else lambda frame: frame).run()
