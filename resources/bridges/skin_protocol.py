"""Presents a robot skin that has its own driver to SkinCal: its skin protocol, version 1, on stdin and stdout.

Whoever has a driver writes down the cells, how they are linked, and functions that set LEDs and read accelerometers.
`Bridge` then answers for all cells of the skin as if they hung behind one serial link:

    Bridge([Cell(b"uniqueid0001", "hex", 4), Cell(b"uniqueid0002", "hex", 4)], links=[((0, 2), (1, 0))], root=(0, 0),
           set_leds=lambda colours: ..., acceleration=lambda cell: (0.0, 0.0, 9.81)).run()

The application starts it as `exec:python3 my_skin.py`. Cells go by their index in that list here; the numbers that an
exploration gives them stay inside. Only the standard library is needed.
"""
from __future__ import annotations

import os
import random
import select
import struct
import time
import zlib
from collections import deque
from dataclasses import astuple, dataclass, field
from typing import Callable, Iterator, Optional

ACK, HELLO, EXPLORE, EXPLORED, SUBTREE, ASSIGN, NEIGHBOUR, CELL_INFO, BOOTED = 1, 10, 11, 12, 13, 14, 15, 16, 17
REPORT, PATTERN, MASK, WORDS, LATCHED, TALLY, TALLIED = 20, 30, 31, 32, 33, 34, 35
TIME_MARK, MEASURE, REST, TACTILE, STREAM, REFUSED = 40, 50, 51, 52, 53, 60
INFO_SUBJECT, LATCHED_SUBJECT, REST_SUBJECT, TACTILE_SUBJECT = range(4)
FROM_NONE, FROM_ALL, FROM_CELL, FROM_WORD, FROM_MASK = range(5)
UNKNOWN_TYPE, UNKNOWN_FLAG, MALFORMED, OTHER_VERSION = range(4)
LOCAL, DOWN, UP = range(3)
RELIABLE, FIRST = 1, 2  # bits of the header's `compatible`
HEADER = struct.Struct("<BBBBHBBHHI")
SCHEMA = 0  # unknown: messages are written by hand here
WINDOW = 32  # how far one Ack looks back
Vector = tuple[float, float, float]
Colour = tuple[int, int, int]


# Protocol Buffers, as far as skin.proto needs them

def varint(value: int) -> bytes:
    """Seven bits a byte, the lowest first; all bytes but the last have the top bit."""
    return bytes([value]) if value < 128 else bytes([value & 127 | 128]) + varint(value >> 7)


def uint(number: int, value: int) -> bytes:
    """A field uint32, bool or enum; proto3 leaves zeros out."""
    return varint(number << 3) + varint(value) if value else b""


def fixed(number: int, layout: str, value: float) -> bytes:
    """A field fixed32 "<I", fixed64 "<Q" or float "<f"."""
    data = struct.pack(layout, value)
    return varint(number << 3 | (5 if len(data) == 4 else 1)) + data if value else b""


def block(number: int, data: bytes) -> bytes:
    """A field of bytes, a string, packed numbers or a message."""
    return varint(number << 3 | 2) + varint(len(data)) + data


def parse(data: bytes) -> dict:
    """The fields of a message by number, unknown ones too; the last counts. ValueError where it is malformed."""
    at, fields = 0, {}

    def take(size: int) -> bytes:
        nonlocal at
        at += size
        if at > len(data):
            raise ValueError("a field does not end")
        return data[at - size:at]

    def number() -> int:
        value, shift, byte = 0, 0, 128
        while byte > 127:
            byte = take(1)[0]
            value, shift = value | (byte & 127) << shift, shift + 7
        return value & 2**64 - 1

    while at < len(data):
        key = number()
        kind = key & 7
        if kind not in (0, 1, 2, 5):
            raise ValueError("no such kind of field")
        fields[key >> 3] = (number() if kind == 0 else take(number()) if kind == 2 else
                            int.from_bytes(take(8 if kind == 1 else 4), "little"))
    return fields


# Frames

@dataclass
class Frame:
    """Header, in its order, and payload."""
    version: int = 1
    incompatible: int = 0
    compatible: int = 0
    type: int = ACK
    sequence: int = 0
    epoch: int = 0
    direction: int = LOCAL
    first: int = 0
    count: int = 0
    time: int = 0
    payload: bytes = b""

    def wire(self) -> bytes:
        """Stuffed (COBS; no frame is so long that a piece would have to be cut), with the zero that ends it."""
        body = HEADER.pack(*astuple(self)[:-1]) + self.payload
        body += zlib.crc32(body).to_bytes(4, "little")
        return b"".join(bytes([len(piece) + 1]) + piece for piece in body.split(b"\0")) + b"\0"


def unframe(stuffed: bytes) -> Optional[Frame]:
    """The frame between two zeros, or None where it is damaged or empty."""
    pieces, at = [], 0
    while at < len(stuffed):
        pieces.append(stuffed[at + 1:at + stuffed[at]])
        at += stuffed[at]
    body = b"\0".join(pieces)
    if (at != len(stuffed) or not HEADER.size + 4 <= len(body) <= 254
            or zlib.crc32(body[:-4]) != int.from_bytes(body[-4:], "little")):
        return None
    return Frame(*HEADER.unpack_from(body), body[HEADER.size:-4])


def ahead(a: int, b: int) -> int:
    """How far sequence or pattern number `a` is ahead of `b`; both wrap at 16 bits."""
    return (a - b + 0x8000 & 0xFFFF) - 0x8000


# One link

@dataclass
class Sent:
    """A frame under way."""
    frame: Frame
    wire: bytes
    tries: int = 0
    again: float = 0.0  # when it is to be sent again
    turns: list[int] = field(default_factory=list)  # its places among all transmissions


class Link:
    """Brings frames over a link that loses and damages some: numbers, acknowledges, repeats, and drops doubles."""

    def __init__(self, write: Callable[[bytes], None], retry_s: float = 0.02) -> None:
        self.write, self.retry_s = write, retry_s
        self.queue: deque[Frame] = deque()  # not sent yet
        self.sent: dict[int, Sent] = {}  # not acknowledged yet, by sequence, the oldest first
        self.next, self.first, self.turn, self.room = random.randrange(65536), FIRST, 0, 1
        self.highest: Optional[int] = None  # sequence received
        self.came = 0  # bit i: highest - 1 - i came, too
        self.owes_ack, self.rest = False, b""

    def send(self, frame: Frame, reliable: bool = True) -> None:
        frame.compatible = RELIABLE if reliable else 0
        self.queue.append(frame)

    def forget(self, stale: Callable[[Frame], bool]) -> None:
        self.queue = deque(frame for frame in self.queue if not stale(frame))
        self.sent = {sequence: sent for sequence, sent in self.sent.items() if not stale(sent.frame)}

    def frames(self, data: bytes) -> Iterator[Frame]:
        """Cuts what came into frames, and deals with Acks itself. Who obeys one asks `take` first."""
        *whole, self.rest = (self.rest + data).split(b"\0")
        self.rest = self.rest[-512:]  # noise without zeros must not fill the memory
        for frame in filter(None, map(unframe, whole)):
            if frame.type == ACK and frame.version == 1 and not frame.incompatible:
                self._acknowledged(frame)
            else:
                yield frame

    def take(self, frame: Frame) -> bool:
        """Notes that a frame came, to acknowledge it. False where it came before, or is too old."""
        steps = 0 if self.highest is None else ahead(frame.sequence, self.highest)
        if self.highest is None or steps < -WINDOW and frame.compatible & FIRST:  # the sender has started (anew)
            self.highest, self.came, new = frame.sequence, 0, True
        elif steps < -WINDOW:  # too old: it is acknowledged, or it would come again
            new = False
        elif steps > 0:
            self.came = (self.came << 1 | 1) << steps - 1 & 0xFFFFFFFF if steps <= WINDOW else 0
            self.highest, new = frame.sequence, True
        else:
            bit = 1 << -steps >> 1  # 0 for the highest itself, which has come
            new = bool(bit & ~self.came)
            self.came |= bit
        self.owes_ack |= bool(frame.compatible & RELIABLE)
        return new

    def _acknowledged(self, ack: Frame) -> None:
        self.room = ack.count
        bits = ack.time << 1 | 1  # bit i: ack.sequence - i came
        got = [sequence for sequence in self.sent if 0 <= (back := ahead(ack.sequence, sequence)) and bits >> back & 1]
        if got:
            self.first = 0
            newest = max(self.sent.pop(sequence).turns[0] for sequence in got)
            for sent in self.sent.values():
                if sent.turns[-1] < newest:  # lost, as nothing overtakes on a wire
                    sent.again = 0.0

    def work(self, now: float) -> float:
        """Sends what may be sent; gives when it is to be called again."""
        if self.owes_ack and self.highest is not None:
            self.write(Frame(sequence=self.highest, time=self.came, count=WINDOW).wire())
            self.owes_ack = False
        for sequence, sent in list(self.sent.items()):
            if sent.again <= now and sent.tries >= 16:
                del self.sent[sequence]
            elif sent.again <= now:
                self._transmit(sent, now)
        while self.queue and ahead(self.next, next(iter(self.sent), self.next)) < WINDOW:
            reliable = self.queue[0].compatible & RELIABLE
            if reliable and len(self.sent) >= max(1, self.room):
                break
            frame = self.queue.popleft()
            frame.sequence, self.next = self.next, self.next + 1 & 0xFFFF
            frame.compatible |= self.first
            sent = Sent(frame, frame.wire())
            if reliable:
                self.sent[frame.sequence] = sent
            self._transmit(sent, now)
        return min((sent.again for sent in self.sent.values()), default=now + 1.0)

    def _transmit(self, sent: Sent, now: float) -> None:
        sent.again, sent.tries, self.turn = now + self.retry_s * 2 ** (sent.tries // 4), sent.tries + 1, self.turn + 1
        sent.turns.append(self.turn)
        self.write(sent.wire)


# The skin

@dataclass
class Cell:
    unique_id: bytes  # 12 bytes
    type: str  # the name of a module template that the application knows
    ports: int
    firmware: int = 0


@dataclass
class State:
    """What a cell shows and has shown, and its word."""
    newest: Optional[int] = None
    history: int = 0  # bit i: newest - i was shown
    late_us: int = 0
    word: int = 0
    words: Optional[int] = None  # the set that it is of
    colour: Colour = (0, 0, 0)

    def has_shown(self, number: int) -> bool:
        return self.newest is not None and bool(self.history >> (self.newest - number & 0xFFFF) & 1)


@dataclass
class Picture:
    """A Pattern that some cells have still to show."""
    number: int
    source: int
    argument: int
    inverted: bool
    colour: Colour
    due: float  # where it is for at once, when it came
    words: int  # the set of words that is meant
    waiting: set[int] = field(default_factory=set)


@dataclass
class Job:
    """A Measure (run from 1; kept after its end, to tell what it gave) or a Stream (run 0)."""
    subject: int
    run: int
    readings: dict[int, list[Vector]]  # of each of its cells
    due: float
    period_s: float = 0.0
    change: float = 0.0


class Bridge:
    """All cells of a skin, behind one link.

    `links` are pairs of (cell, port); `root` is the (cell, port) on which the computer hangs. `set_leds` gets the new
    colours, 0 to 255, of the cells whose colour changes, and returns once they are set; `acceleration` gives a cell's
    specific force in its module frame in m/s^2 (at rest, upward, 9.81); `temperature` degrees Celsius; `touch` a
    proximity (0 to 1, touching) and three forces in N. `run` calls them, one at a time; they should return at once,
    from what the driver told last. `spoil` is for tests: it gets every frame that goes out.
    """

    def __init__(self, cells: list[Cell], links: list[tuple[tuple[int, int], tuple[int, int]]], root: tuple[int, int],
                 set_leds: Callable[[dict[int, Colour]], None], acceleration: Callable[[int], Vector],
                 temperature: Optional[Callable[[int], float]] = None,
                 touch: Optional[Callable[[int], tuple[float, Vector]]] = None, name: str = "skin bridge",
                 sample_s: float = 0.02, spoil: Callable[[bytes], bytes] = bytes) -> None:
        self.cells, self.root, self.set_leds, self.acceleration, self.touch = cells, root, set_leds, acceleration, touch
        self.temperature, self.name, self.sample_s = temperature or (lambda cell: 0.0), name, sample_s
        self.other: dict[tuple[int, int], tuple[int, int]] = {}  # who is at the other end of a (cell, port)
        for end, other in [*links, *((b, a) for a, b in links)]:
            if end in self.other or end == root or not 0 <= end[1] < cells[end[0]].ports:
                raise ValueError(f"cell {end[0]} has no free port {end[1]}")
            self.other[end] = other
        if any(len(cell.unique_id) != 12 for cell in cells):
            raise ValueError("a unique id has 12 bytes")
        self.order = self._depth_first()
        self.out, self.offset_us = bytearray(), 0
        self.link = Link(lambda wire: self.out.extend(spoil(wire)))
        self._begin(0)

    def _depth_first(self) -> list[int]:
        """The cells in the order of their numbers: branches in the order of the ports, each one run of numbers."""
        order: dict[int, None] = {}
        stack = [self.root[0]]
        while stack:
            if (cell := stack.pop()) not in order:
                order[cell] = None
                ports = reversed(range(self.cells[cell].ports))
                stack += [self.other[cell, port][0] for port in ports if (cell, port) in self.other]
        if len(order) < len(self.cells):
            raise ValueError(f"no links lead to cells {[i for i in range(len(self.cells)) if i not in order][:9]}")
        return list(order)

    def _begin(self, epoch: int) -> None:
        """A new exploration: nothing of the last one counts."""
        self.epoch, self.base = epoch, 0  # the first cell's number, 0 while it has none
        self.number: dict[int, int] = {}
        self.computer: Optional[tuple[int, int]] = None  # its number and port, once told
        self.info_until, self.info_wanted = 0.0, set[int]()
        self.states = [State() for _ in self.cells]
        self.pictures: dict[int, Picture] = {}  # by number, like the masks: what each cell is to show
        self.masks: dict[int, dict[int, bool | Colour]] = {}
        self.tallies: dict[int, int] = {}  # pattern by query
        self.jobs: list[Job] = []
        self.rest_wanted: set[tuple[int, int]] = set()  # (cell, run)
        self.next_sample, self.dirty = 0.0, False  # dirty: pictures or tallies may be ready
        self.last_touch: dict[int, tuple[float, ...]] = {}
        self.orders: dict[int, int] = {}  # of the last Stream, by subject

    # What is told to the computer

    def _time(self) -> int:
        """Synchronised time."""
        return int(time.monotonic() * 1e6) + self.offset_us & 0xFFFFFFFF

    def _local(self, kind: int, payload: bytes = b"") -> None:
        self.link.send(Frame(type=kind, epoch=self.epoch, time=self._time(), payload=payload))

    def _up(self, cell: int, kind: int, payload: bytes, reliable: bool = True) -> None:
        self.link.send(Frame(type=kind, epoch=self.epoch, direction=UP, first=self.number[cell], count=1,
                             time=self._time(), payload=payload), reliable)

    def _refuse(self, frame: Frame, reason: int) -> None:
        self._local(REFUSED, uint(1, frame.type) + uint(2, reason))

    def _tell_info(self, cell: int) -> None:
        about, heard = self.cells[cell], b""
        for port in range(about.ports):
            if (cell, port) == self.root and self.computer:
                heard += block(4, uint(1, port) + uint(2, self.computer[0]) + uint(3, self.computer[1]))
            elif (cell, port) in self.other:
                neighbour, its_port = self.other[cell, port]
                heard += block(4, uint(1, port) + uint(2, self.number[neighbour]) + uint(3, its_port))
        self._up(cell, CELL_INFO, block(1, about.unique_id) + block(2, about.type.encode()) + uint(3, about.ports)
                 + heard + uint(5, about.firmware))

    def _tell_latched(self, cell: int) -> None:
        state = self.states[cell]
        self._up(cell, LATCHED, uint(1, state.newest or 0) + fixed(2, "<Q", state.history) + fixed(3, "<Q", state.word)
                 + uint(4, state.late_us * 2))  # sint32 has its sign below; it is never early

    def _tell_rest(self, cell: int, run: int, readings: list[Vector]) -> None:
        readings = readings or [self.acceleration(cell)]
        axes, count = list(zip(*readings)), len(readings)
        means = [sum(axis) / count for axis in axes]
        variances = [sum((a - mean) ** 2 for a in axis) / max(1, count - 1) for axis, mean in zip(axes, means)]
        self._up(cell, REST, uint(1, count) + block(2, struct.pack("<3f", *means))
                 + block(3, struct.pack("<3f", *variances)) + fixed(4, "<f", self.temperature(cell)) + uint(5, run))

    def _tell_tactile(self, cells: list[int], change: float = 0.0) -> None:
        """Samples of those cells whose touch has changed by that share, five a frame."""
        samples = []
        for cell in cells:
            proximity, forces = self.touch(cell) if self.touch else (0.0, (0.0, 0.0, 0.0))
            shares, last = (proximity, *(force / 10 for force in forces)), self.last_touch.get(cell)
            if not change or not last or any(abs(a - b) >= change for a, b in zip(shares, last)):
                self.last_touch[cell] = shares
                small = [round(100 * value) for value in (self.temperature(cell), *self.acceleration(cell))]
                samples.append((cell, struct.pack(
                    "<HHHHHhhhhH", self.number[cell], *(max(0, min(65535, round(value))) for value in (
                        65535 * proximity, *(1000 * force for force in forces))),
                    *(max(-32768, min(32767, value)) for value in small), 0)))
        for i in range(0, len(samples), 5):
            some = samples[i:i + 5]
            self._up(some[0][0], TACTILE, block(1, b"".join(sample for _, sample in some)), reliable=False)

    # What the computer tells

    def _receive(self, frame: Frame, now: float) -> None:
        if frame.version != 1:
            return self._refuse(frame, OTHER_VERSION)
        if frame.direction == DOWN and frame.epoch == self.epoch and not self.base:
            return None  # without an Ack: it comes again, after the number
        if not self.link.take(frame):
            return None
        if frame.incompatible:
            return self._refuse(frame, UNKNOWN_FLAG)
        try:
            message = parse(frame.payload)
            if frame.direction == LOCAL:
                self._obey_local(frame, message, now)
            elif frame.direction == DOWN and frame.epoch == self.epoch:
                places = range(max(0, self.base - frame.first),
                               min(frame.count, self.base - frame.first + len(self.order)))
                cells = {self.order[frame.first + place - self.base]: place for place in places}
                if cells:
                    self._obey(frame, message, cells, now)
        except (ValueError, TypeError, AttributeError):  # a field of another kind than it should be
            self._refuse(frame, MALFORMED)

    def _hello(self) -> None:
        self._local(HELLO, uint(1, 1) + uint(2, 1) + uint(3, 0b1111 if self.touch else 0b1101)
                    + fixed(4, "<I", SCHEMA) + block(5, self.name.encode()[:100]))

    def _obey_local(self, frame: Frame, message: dict, now: float) -> None:
        if frame.type == HELLO:
            if message.get(6):  # please answer
                self._hello()
        elif frame.type == EXPLORE:
            new = 0 < (frame.epoch - self.epoch & 0xFF) < 128 or not self.epoch
            if new:
                self.link.forget(lambda old: old.type not in (HELLO, REFUSED))
                self._begin(frame.epoch)
            if frame.epoch == self.epoch:
                self._local(EXPLORED, uint(1, 1) + uint(2, self.root[1]))
            else:  # of a computer that was never told how far this is
                self._hello()
            if new:
                self._local(SUBTREE, uint(1, len(self.cells)))
        elif frame.type in (ASSIGN, NEIGHBOUR):
            if frame.type == NEIGHBOUR and frame.epoch == self.epoch:
                self.computer = message.get(1, 0), message.get(2, 0)
            elif frame.epoch == self.epoch:
                self.base, self.info_until = message.get(1, 0), now + 0.5
                self.number = {cell: self.base + i for i, cell in enumerate(self.order)}
                self._local(NEIGHBOUR, uint(1, self.base) + uint(2, self.root[1]))
        elif frame.type not in (EXPLORED, SUBTREE, BOOTED, TALLIED, REFUSED):
            self._refuse(frame, UNKNOWN_TYPE)

    def _obey(self, frame: Frame, message: dict, cells: dict[int, int], now: float) -> None:
        """Does what is told to cells: a dict of their places in the range that the frame is for."""
        one, two, three = (message.get(i, 0) for i in (1, 2, 3))  # most messages have three numbers
        if frame.type == REPORT:
            if one == INFO_SUBJECT:
                self.info_wanted.update(cells)
            elif one == LATCHED_SUBJECT:
                for cell in cells:
                    self._tell_latched(cell)
            elif one == REST_SUBJECT:
                self.rest_wanted.update((cell, two) for cell in cells)
            elif one == TACTILE_SUBJECT:
                self._tell_tactile(list(cells))
        elif frame.type == PATTERN:
            if two > FROM_MASK:
                raise ValueError("no such source")
            wait_us = (frame.time - self._time() + 2**31 & 2**32 - 1) - 2**31 if frame.time else 0
            rgb = message.get(5, 0) or 0xFFFFFF
            picture = Picture(one, two, three, bool(message.get(4)), (rgb >> 16 & 255, rgb >> 8 & 255, rgb & 255),
                              now + wait_us / 1e6, message.get(6, 0))
            picture = self.pictures.setdefault(one, picture)
            picture.waiting.update(cell for cell in cells if not self.states[cell].has_shown(one))
            self.masks = {number: mask for number, mask in self.masks.items() if ahead(number, one) >= -64}
        elif frame.type == MASK:
            lit, bits = message.get(2, b""), three or 1
            mask = self.masks.setdefault(one, {})
            for cell, place in cells.items():
                if place * bits // 8 < len(lit):
                    value = lit[place * bits // 8] >> place * bits % 8
                    red, green, blue = (255 * (value >> i & 1) for i in range(3))
                    mask[cell] = bool(value & 1) if bits == 1 else (red, green, blue)
        elif frame.type == WORDS:
            for cell, place in cells.items():
                if (place + 1) * one <= len(message.get(2, b"")):
                    self.states[cell].word = int.from_bytes(message[2][place * one:(place + 1) * one], "little")
                    self.states[cell].words = three
        elif frame.type == TALLY:
            self.tallies = dict([*self.tallies.items(), (one, two)][-16:])
        elif frame.type == TIME_MARK:
            self.offset_us = frame.time - int(time.monotonic() * 1e6)
        elif frame.type == MEASURE:
            if not any(job.run == two and cell in job.readings for job in self.jobs for cell in cells):
                self._start(Job(REST_SUBJECT, two, {cell: [] for cell in cells}, now + one / 1e3))
        elif frame.type == STREAM and one in (REST_SUBJECT, TACTILE_SUBJECT):
            order = message.get(4, 0)
            if ahead(order, self.orders.setdefault(one, order)) < 0:
                return  # a newer one has overtaken it
            self.orders[one] = order
            self._start(Job(one, 0, {cell: [] for cell in cells}, now + two / 1e3, two / 1e3, three / 100))
        self.dirty = True

    def _start(self, new: Job) -> None:
        """A measurement or stream takes the place of the cells' last of its kind."""
        for job in self.jobs:
            if job.subject == new.subject and bool(job.run) == bool(new.run):
                job.readings = {cell: readings for cell, readings in job.readings.items() if cell not in new.readings}
        self.jobs = [job for job in [*self.jobs, new] if job.readings and (job.run or job.period_s)]
        self.next_sample = 0.0

    # What takes its time

    def _work(self, now: float) -> float:
        """Does what is due; gives when something will be."""
        waits = self.root[0] in self.info_wanted and not self.computer and now < self.info_until
        for cell in sorted(self.info_wanted, key=self.number.get):
            if not waits or cell != self.root[0]:
                self.info_wanted.remove(cell)
                self._tell_info(cell)
        if self.dirty or any(picture.due <= now for picture in self.pictures.values()):
            self.dirty = False
            self._show(now)
            for query, number in list(self.tallies.items()):
                if all(state.has_shown(number) for state in self.states):
                    del self.tallies[query]
                    self._local(TALLIED, uint(1, query) + uint(2, len(self.cells)))
        self._measure(now)
        dues = [self.info_until] * waits + [picture.due for picture in self.pictures.values()]
        dues += [job.due for job in self.jobs] + [self.next_sample] * bool(self.jobs)
        return min((due for due in dues if due > now), default=now + 1.0)

    def _show(self, now: float) -> None:
        """Shows the pictures that are due, in the order of their numbers."""
        changed: dict[int, Colour] = {}
        due = [picture for picture in self.pictures.values() if picture.due <= now]
        for picture in sorted(due, key=lambda picture: ahead(picture.number, due[0].number)):
            mask = self.masks.get(picture.number, {})
            for cell in list(picture.waiting):
                state = self.states[cell]
                steps = 64 if state.newest is None else ahead(picture.number, state.newest)
                if steps > 0 and picture.source == FROM_MASK and cell not in mask:
                    continue  # waits for its mask
                if steps > 0 and picture.source == FROM_WORD and state.words != picture.words:
                    continue  # waits for its word
                picture.waiting.remove(cell)
                if steps <= 0:
                    continue  # a newer one overtook it
                lit = (picture.source == FROM_ALL
                       or picture.source == FROM_CELL and picture.argument == self.number[cell]
                       or picture.source == FROM_WORD and (state.word >> picture.argument & 1) != picture.inverted
                       or picture.source == FROM_MASK and mask[cell])
                colour = lit if isinstance(lit, tuple) else picture.colour if lit else (0, 0, 0)
                state.newest, state.history = picture.number, (state.history << min(64, steps) | 1) & 2**64 - 1
                state.late_us = int((now - picture.due) * 1e6)
                if colour != state.colour:
                    state.colour = changed[cell] = colour
        self.pictures = {number: picture for number, picture in self.pictures.items() if picture.waiting}
        if changed:
            self.set_leds(changed)

    def _measure(self, now: float) -> None:
        """Reads accelerometers for those who average, and tells what is due."""
        if now >= self.next_sample:
            self.next_sample = now + self.sample_s
            for job in self.jobs:
                if job.subject == REST_SUBJECT and (job.due > now or not job.run):
                    for cell, readings in job.readings.items():
                        readings.append(self.acceleration(cell))
        for job in self.jobs:
            if job.due > now:
                continue
            if job.run:
                for cell in [cell for cell in job.readings if (cell, job.run) in self.rest_wanted]:
                    self.rest_wanted.remove((cell, job.run))
                    self._tell_rest(cell, job.run, job.readings[cell])
                continue
            job.due = max(job.due + job.period_s, now)
            if len(self.link.queue) > 2 * len(self.cells):
                continue  # more than the link can carry: leave this turn out
            if job.subject == TACTILE_SUBJECT:
                self._tell_tactile(sorted(job.readings), job.change)
                continue
            for cell, readings in job.readings.items():
                self._tell_rest(cell, 0, readings)
                readings.clear()

    def run(self) -> None:
        """Serves until stdin closes. Stdout is kept for frames: what else the program prints goes to stderr."""
        into, out = 0, os.dup(1)
        os.dup2(2, 1)
        os.set_blocking(into, False)
        os.set_blocking(out, False)
        self.out += b"\0"
        self._local(BOOTED)
        try:
            while True:
                now = time.monotonic()
                wake = self._work(now)
                if len(self.out) < 65536:  # else the computer is to read first
                    wake = min(wake, self.link.work(now))
                wait_s = max(0.0, wake - time.monotonic())
                readable, writable, _ = select.select([into], [out] if self.out else [], [], wait_s)
                if writable:
                    del self.out[:os.write(out, self.out[:65536])]
                if readable:
                    data = os.read(into, 65536)
                    if not data:
                        return
                    for frame in self.link.frames(data):
                        self._receive(frame, time.monotonic())
        except (BrokenPipeError, ConnectionResetError, KeyboardInterrupt):
            return
        finally:
            os.close(out)
