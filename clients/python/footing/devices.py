"""Simulated devices and trackers: what they send goes through the same code as a real device's reports."""
import threading
import time
import zlib
from typing import Any, Dict, Iterable, List, Optional, Sequence, Tuple

from google.protobuf.message import DecodeError

from footing.session import _role
from footing.v1 import device_pb2, session_pb2
from footing.wire import FootingError, NotRunning, Refused, Wire, default_address, read_token

G_MPS2 = 9.80665
_READY_S = 5       # A handshake takes a tenth of it.
_ABSENT = 7        # Error of a memory that is not there.
_NO_SUCH_MODE = 3


class _Link:
    """The device socket of footingd, or on another host a session that carries devices."""

    def __init__(self, address: Optional[str], token: Optional[str], name: str):
        address = address or default_address("devices")
        self.in_session = address.startswith("tls:")
        program = "footingd" if self.in_session else "footingd with --source stream:" + address
        self.wire = Wire(address, program, timeout_s=10)
        self.error: Optional[FootingError] = None
        self._closing = False
        if self.in_session:
            self.wire.send(session_pb2.Envelope(hello=session_pb2.Hello(
                protocol_major=1, role="ROLE_CONTROL", token=read_token(token), client_name=name)))
            answer = session_pb2.Envelope.FromString(self.wire.receive())
            if "devices" not in answer.welcome.capabilities:
                self.wire.close()
                raise Refused(answer.refused.message or "this footingd takes no devices; start it with --source stream:" + address)
        self._thread = threading.Thread(target=self._run, name=f"footing {name}", daemon=True)
        self._thread.start()

    def send(self, **body: Any) -> None:
        if self.error:
            raise self.error
        message = device_pb2.DeviceEnvelope(**body)
        try:
            self.wire.send(session_pb2.Envelope(device=message) if self.in_session else message)
        except OSError as error:
            raise self.error or NotRunning(f"footingd closed the connection: {error}") from error

    def take(self, output: device_pb2.DeviceOutput) -> None:
        """Of footingd to the device."""

    def _run(self) -> None:
        while not self._closing:
            try:
                data = self.wire.receive()
                message = device_pb2.DeviceEnvelope()
                if self.in_session:
                    envelope = session_pb2.Envelope.FromString(data)
                    if envelope.HasField("ping"):
                        now_ns, ping = time.monotonic_ns(), envelope.ping
                        self.wire.send(session_pb2.Envelope(pong=session_pb2.Pong(
                            id=ping.id, t0_ns=ping.t0_ns, t1_ns=now_ns, t2_ns=now_ns)))
                    message = envelope.device
                else:
                    message.ParseFromString(data)
                if message.HasField("refused"):
                    self.error = Refused(f"footingd refused it: {message.refused.reason}")
                elif message.HasField("output"):
                    self.take(message.output)
            except TimeoutError:
                continue  # Nothing needs to come on the device socket.
            except (OSError, DecodeError, FootingError) as error:
                if "timed out" in str(error):  # Python before 3.10.
                    continue
                self.error = self.error or NotRunning(f"footingd closed the connection: {error}")
                return

    def close(self) -> None:
        self._closing = True
        self.wire.close()

    def __enter__(self) -> Any:
        return self

    def __exit__(self, *_: Any) -> None:
        self.close()


# Vendor, product and name by which footingd knows the kind; the first byte of the serial.
_KINDS = {"wiimote": (0x057E, 0x0306, "Nintendo RVL-CNT-01", "02"),
          "balance_board": (0x057E, 0x0306, "Nintendo RVL-WBC-01", "03")}
_ZERO, _ONE_G = 520, 624                       # Accelerometer, counts; every axis alike.
_CELL_EMPTY, _CELL_COUNTS_PER_KG, _STEP_KG = 4000, 100, 17
_HOST_FACTOR = 0.99908                         # By which the host corrects kilograms (WiiBrew).
_REFERENCE_TEMPERATURE = 25


class Device(_Link):
    """A Wiimote or a balance board that footingd reads like a real one. Made by `footing.device`."""

    def __init__(self, kind: str, role: str = "", rig: str = "", serial: Optional[str] = None,
                 address: Optional[str] = None, token: Optional[str] = None):
        if kind not in _KINDS:
            raise FootingError(f"{kind!r} is none of the simulated kinds: {', '.join(_KINDS)}")
        vendor, product, name, first = _KINDS[kind]
        mark = zlib.crc32(f"{kind} {role} {rig}".encode())
        self.kind = kind
        self.serial = serial or ":".join([first, "00", *(f"{mark >> shift & 255:02x}" for shift in (24, 16, 8, 0))])
        self.leds, self.rumble = 0, False  # As footingd set them.
        self._sequence, self._buttons, self._continuous, self._battery = 0, 0, False, 200
        self._ready = threading.Event()
        self._plain = False  # The board's cells are read in the clear.
        self._memory = _wiimote_memory() if kind == "wiimote" else _board_memory()
        super().__init__(address, token, self.serial)
        self.send(attach=device_pb2.DeviceAttach(slot=1, bus=5, vendor=vendor, product=product, name=name, serial=self.serial,
                                                 rig=rig, role=_role(role) if role else 0))
        end = time.monotonic() + _READY_S
        while not self._ready.wait(0.02):
            if self.error or time.monotonic() > end:
                self.close()
                raise self.error or NotRunning(f"footingd did not ask the device for its reports within {_READY_S} s")

    def send_force(self, force_mps2: Sequence[float], buttons: int = 0) -> None:
        """One sample of a Wiimote: specific force in its frame S (x left, y front, z down), m/s^2; at rest (0, 0, -9.81)."""
        if self.kind != "wiimote":
            raise FootingError("a balance board has loads: send_loads")
        counts = [round(_ZERO + sign * value / G_MPS2 * (_ONE_G - _ZERO)) for sign, value in zip((1, -1, -1), force_mps2)]
        x, y, z = (max(0, min(1023, count)) for count in counts)
        self._buttons = buttons & 0x1F9F
        first, second = self._buttons >> 8 | (x & 3) << 5, self._buttons & 0x9F | (y >> 1 & 1) << 5 | (z >> 1 & 1) << 6
        self.report(bytes([0x31, first, second, x >> 2, y >> 2, z >> 2]))

    def send_loads(self, top_left_n: float, top_right_n: float, bottom_left_n: float, bottom_right_n: float) -> None:
        """One sample of a balance board: the load of each corner, N; the top is the side away from the power button."""
        if self.kind != "balance_board":
            raise FootingError("a Wiimote has forces: send_force")
        cells = b"".join(_cell(load / G_MPS2) for load in (top_right_n, bottom_right_n, top_left_n, bottom_left_n))
        tail = bytes([_REFERENCE_TEMPERATURE, 0, self._battery]) + bytes(8)
        self.report(b"\x34\0\0" + (cells + tail if self._plain else b"\xff" * 19))

    def play(self, rows: Iterable[Sequence[float]], rate_hz: float = 100) -> None:
        """Sends rows at an even rate: three numbers each of a Wiimote, four of a board; see send_force and send_loads."""
        begin = time.monotonic()
        for number, row in enumerate(rows):
            time.sleep(max(0, begin + number / rate_hz - time.monotonic()))
            if self.kind == "wiimote":
                self.send_force(row)
            else:
                self.send_loads(*row)

    def report(self, report: bytes) -> None:
        """Any HID report, its id byte first."""
        self._sequence += 1
        self.send(input_report=device_pb2.DeviceInputReport(slot=1, sequence=self._sequence, report=report))

    def take(self, output: device_pb2.DeviceOutput) -> None:
        """Answers as docs/protocol.md says, section "The device socket"."""
        report = output.report
        if len(report) < 2 or output.channel != device_pb2.DeviceOutput.CHANNEL_INTERRUPT:
            return
        kind, self.rumble = report[0], bool(report[1] & 1)
        buttons = bytes([self._buttons >> 8, self._buttons & 0xFF])
        if kind == 0x11:
            self.leds = report[1] >> 4
        if kind == 0x15:
            flags = self.leds << 4 | (2 if self.kind == "balance_board" else 0)
            self.report(b"\x20" + buttons + bytes([flags, 0, 0, self._battery]))
        elif kind == 0x17 and len(report) >= 7:
            self._answer_read(report, buttons)
        elif kind == 0x16 and len(report) >= 7:
            register = int.from_bytes(report[2:5], "big")
            there = not report[1] & 4 or self.kind == "balance_board" and register >> 8 == 0xA400
            if there and register == 0xA400FB:
                self._plain = report[6] == 0
            self.report(b"\x22" + buttons + bytes([kind, 0 if there else _ABSENT]))
        elif kind == 0x12 and len(report) >= 3:
            known = report[2] == (0x31 if self.kind == "wiimote" else 0x34)
            self.report(b"\x22" + buttons + bytes([kind, 0 if known else _NO_SUCH_MODE]))
            if known:
                self._ready.set()
        elif report[1] & 2 and kind != 0x10:
            self.report(b"\x22" + buttons + bytes([kind, 0]))

    def _answer_read(self, report: bytes, buttons: bytes) -> None:
        address, left = int.from_bytes(report[2:5], "big"), int.from_bytes(report[5:7], "big")
        memory = self._memory.get((address >> 8 << 8) if report[1] & 4 else 0)
        while left > 0:
            size, at = min(left, 16), address & 0xFF if report[1] & 4 else address
            error = 0 if memory is not None and at + size <= len(memory) else _ABSENT if report[1] & 4 else 8
            data = memory[at:at + size] if memory is not None and not error else b""
            self.report(b"\x21" + buttons + bytes([(15 if error else size - 1) << 4 | error]) +
                        (address & 0xFFFF).to_bytes(2, "big") + data.ljust(16, b"\0"))
            if error:
                return
            address, left = address + size, left - size


def _wiimote_memory() -> Dict[int, bytes]:
    """Calibration of the accelerometer, twice, with the checksum of WiiBrew."""
    def axes(counts: int) -> List[int]:
        return [counts >> 2] * 3 + [(counts & 3) * 0b010101]

    block = bytes([*axes(_ZERO), *axes(_ONE_G), 0x40])
    block += bytes([(sum(block) + 0x55) & 0xFF])
    memory = bytearray(0x1700)
    memory[0x16:0x20] = memory[0x20:0x2A] = block
    return {0: bytes(memory)}


def _board_memory() -> Dict[int, bytes]:
    """Calibration of the cells at 0, 17 and 34 kg, its check, and the identity of a board."""
    page = bytearray(0x100)
    page[0x20:0x22] = b"\x01\x69"
    points = [_CELL_EMPTY + step * _STEP_KG * _CELL_COUNTS_PER_KG for step in range(3) for _ in range(4)]
    page[0x24:0x3C] = b"".join(point.to_bytes(2, "big") for point in points)
    page[0x60:0x62] = bytes([_REFERENCE_TEMPERATURE, 1])
    page[0x3C:0x40] = zlib.crc32(page[0x24:0x3C] + page[0x20:0x22] + page[0x60:0x62]).to_bytes(4, "big")
    page[0xFA:0x100] = b"\0\0\xa4\x20\x04\x02"
    return {0: bytes(0x1700), 0xA40000: bytes(page)}


def _cell(kg: float) -> bytes:
    counts = _CELL_EMPTY + kg / _HOST_FACTOR * _CELL_COUNTS_PER_KG
    return max(0, min(0xFFFF, round(counts))).to_bytes(2, "big")


class Tracker(_Link):
    """A tracker of hands or joints. Made by `footing.tracker`."""

    def __init__(self, name: str, rig: str = "", simulated: bool = False, address: Optional[str] = None,
                 token: Optional[str] = None):
        self.name, self.rig, self.simulated = name, rig, simulated
        super().__init__(address, token, name)

    def hands(self, left: Optional[Tuple[float, float, float]] = None, right: Optional[Tuple[float, float, float]] = None,
              sd_m: float = 0.01, age_s: float = 0, **joints: Tuple[float, float, float]) -> None:
        """Places in the world frame W, m: the middle of each fist, or None where it is not seen; and other joints by their
        names, such as head=(0, 0, 1.7). `sd_m` is their standard deviation, `age_s` the time since the exposure."""
        points = [self._point(place, sd_m, role=role) for place, role in
                  ((left, "DEVICE_ROLE_LEFT_HAND"), (right, "DEVICE_ROLE_RIGHT_HAND"))]
        for joint, place in joints.items():
            name = "BODY_JOINT_" + joint.upper()
            if name not in device_pb2.BodyJoint.keys():
                known = ", ".join(key[11:].lower() for key in device_pb2.BodyJoint.keys()[1:])
                raise FootingError(f"{joint!r} is not a joint: {known}")
            points.append(self._point(place, sd_m, joint=name))
        # Of another host the clock does not count.
        self.send(hand_frame=device_pb2.HandFrame(tracker=self.name, rig=self.rig, age_ns=round(age_s * 1e9), points=points,
                                                  simulated=self.simulated))

    @staticmethod
    def _point(place: Optional[Sequence[float]], sd_m: float, **what: str) -> device_pb2.TrackedPoint:
        if place is None:
            return device_pb2.TrackedPoint(confidence=0, **what)
        x, y, z = map(float, place)
        return device_pb2.TrackedPoint(x_m=x, y_m=y, z_m=z, sd_x_m=sd_m, sd_y_m=sd_m, sd_z_m=sd_m, confidence=1, **what)


def device(kind: str, role: str = "", **options: Any) -> Device:
    """Attaches a simulated "wiimote" or "balance_board" in a role such as "left_hand"; waits until footingd reads it.

    Options: rig, serial, address (of the device socket, or tls:HOST:PORT of another host's footingd), token.
    """
    return Device(kind, role, **options)


def tracker(name: str, **options: Any) -> Tracker:
    """A hand tracker of this name. Options: rig, simulated, address, token."""
    return Tracker(name, **options)
