#!/usr/bin/env python3
"""Writes the fuzz targets' seeds from real packets: make_seeds.py [--variants] [FOLDER].

With --variants it writes what scripts/fuzz adds to them instead: each seed that is a text, with each of its lines and
each of its words left out, doubled, or replaced. So nearly every error of a parser is met from the start.

The bytes are those of the tests of daemon/sensor/reports and calibration, which name their sources.
A seed has the form that the target of its folder reads (see its .cc file).
"""
import pathlib
import re
import struct
import sys

import make_motion_seeds
import make_protocol_seeds
import make_recording_seeds

ACCELERATION = "82 82 82 15 9C 9C 9E 38 40 3E"
NUNCHUK = "7D 7A 7E 0A B0 AF B1 12 E5 21 7C E7 23 7A FC 51"
MOTION_PLUS = ("7B EC 76 CA 76 2C 32 DC CC D7 2E A8 C8 77 5E 02 "
               "76 0F 79 3D 77 9B 39 43 CA A8 31 C8 2D 1C BC 33")
BOARD_POINTS = [2779, 4163, 8300, 7056, 4379, 5863, 9900, 8656, 6079, 7563, 11600, 10356]
BOARD_REPORT = "34 00 00 03 D0 19 1A 00 17 15 23 19 00 6E 00 00 00 00 00 00 00 00"
STATUS = "20 00 00 02 00 00 D5"
MOVE_PIECES = [
    "10 00 46 07 73 7f 9f 7f e8 8f 85 6e ca 7f f4 7e 55 7f f1 7f 1a 6e 98 90 0a 80 5b 7f 67 7f c9 90"
    "4c 7f b7 7f e6 6e 06 7f 87 08 a5 7f 06 80 80 81 76",
    "10 01 07 a8 7f 00 80 8b 81 00 00 00 00 00 00 00 01 00 01 92 08 e0 01 e5 94 e6 7f a1 81 e0 01 4b"
    "7f d6 91 59 81 e0 01 a1 7f 2c 80 a6 95 89 07 36 0c",
    "10 82 50 c3 5b c8 fb 42 68 3d b5 42 cd 13 7d 3f 93 5b 81 3f 70 ea 76 3f ff 80 4f 3f c6 ea 9c 3d"
    "00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00",
]
MOVE2_PIECES = [
    "10 00 22 10 fd ff 3c 00 1b f0 07 00 d3 ff 2a 00 07 10 e2 ff 15 00 04 f0 11 00 f9 ff 0a 00 fe 0f"
    "46 00 dc ff d6 ef fb ff 07 00 ff ff 9c 00 00 00 00",
    "10 81 1a 05 00 17 00 9b ff ac 1a 0d 00 5a ff 06 00 9a 1a 59 e5 08 00 e5 ff 58 00 63 e5 ef ff 81"
    "00 06 00 62 e5 1c 02 1c 02 04 00 00 00 00 00 00 00",
]
MOVE_REPORT = ("01 00 00 00 06 00 00 7f 7f 7f 7f c0 05 2d 89 a8 7f 77 8d 1e 89 a0 7f 6f 8d f8 7f 02 80"
               "fb 7f f8 7f 03 80 fb 7f 7d 10 9e fa 10 55 0a 00 00 00 00 00")
JOYCON_INFO = "21 14 8e 00 00 00 17 53 85 00 00 00 c0 82 02 04 07 01 02 58 2f 40 f8 c6 18 03 01" + "00" * 22
JOYCON_MOTION = "30 3b 8e 00 00 00 55 77 8b 00 00 00 c0" + "5e 01 20 00 f1 0f 0b 00 f0 ff 02 00" * 3
JOYCON_BLOCK = "14 ff 9d ff 53 00 00 40 00 40 00 40 f5 ff f0 ff 02 00 e7 3b e7 3b e7 3b"
JOYCON_STICK = "ba 15 62 11 b8 7f 29 06 5b"
MOTION_PLUS_PACKET = "00 20 F0 7E 7E 76"
NUNCHUK_PACKET = "80 81 7D 7A B1 0B"


def raw(text: str) -> bytes:
    return bytes.fromhex(text)


def string(data: bytes) -> bytes:
    return bytes([len(data)]) + data


def with_byte(data: bytes, at: int, value: int) -> bytes:
    return data[:at] + bytes([value]) + data[at + 1:]


def memory(offset: int, data: bytes) -> bytes:
    return bytes([0x21, 0, 0, (len(data) - 1) << 4, offset >> 8, offset & 0xFF]) + data.ljust(16, b"\0")


def phone(number: int, *ages_us: int) -> bytes:
    """A report of a phone that lies face up."""
    return struct.pack("<BBBBHQB", 1, 2, 0, 80, number, 16_667 * number, len(ages_us)) + b"".join(
        struct.pack("<I6f", age, 0.1, -0.2, 9.8, 0.01, 0.02, -0.03) for age in ages_us)


def slime(kind: int, rest: bytes) -> bytes:
    return struct.pack(">IQ", kind, 7) + rest


def osc(address: str, *values: float) -> bytes:
    text = address.encode() + b"\0"
    return text + bytes(-len(text) % 4) + b",fff\0\0\0\0" + struct.pack(">fff", *values)


def seeds() -> dict[str, bytes]:
    board_block = raw("00 69 00 00") + b"".join(p.to_bytes(2, "big") for p in BOARD_POINTS) + bytes(4)
    data35 = raw("35 40 60 82 82 9C") + raw(MOTION_PLUS_PACKET) + bytes(10)
    answers = [raw(STATUS), raw("22 00 00 16 00"), raw("22 00 00 16 00")]
    wiimote = answers + [memory(0xFA, raw("00 00 A4 20 00 00")),
                         memory(0x16, raw(ACCELERATION + ACCELERATION[:17])),
                         memory(0x26, raw(ACCELERATION)[6:]), raw("22 00 00 12 00"), data35,
                         raw("20 00 00 00 00 00 60"), data35]
    board = answers + [memory(0xFA, raw("00 00 A4 20 04 02")), memory(0x20, board_block[:16]),
                       memory(0x30, board_block[16:]), memory(0x60, raw("19 01")),
                       raw("22 00 00 12 00"), raw(BOARD_REPORT)]
    ids = [bytes([i]) + bytes(range(1, 22)) for i in [*range(0x30, 0x38), 0x3D, 0x3E, 0x3F]]
    steps = lambda reports: b"".join(b"\x02" + string(r) for r in reports)
    return {
        "reports/every_id": b"".join(map(string, ids)),
        "reports/wiimote": b"".join(map(string, wiimote)),
        "reports/board": b"".join(map(string, board)),
        "reports/short": b"".join(string(bytes([kind] + [0] * size)) for kind in (0x20, 0x21, 0x22, 0x30, 0x31, 0x35)
                                  for size in (0, 1, 2, 4)) + string(b"") + string(b"\x31" + bytes(22))
                         + string(bytes([0x21, 0, 0, 0xF0, 0, 0, 1])),
        "reports/packets": string(raw(MOTION_PLUS_PACKET)) + string(raw(NUNCHUK_PACKET)),
        "calibration/acceleration": string(raw(ACCELERATION)) + string(b"") + raw("02 00 02 00 02 6A"),
        "calibration/nunchuk": string(raw(NUNCHUK) * 2) + string(b"") + raw(NUNCHUK_PACKET),
        "calibration/motion_plus": string(raw(MOTION_PLUS)) + string(b"") + raw(MOTION_PLUS_PACKET) * 4,
        "calibration/still": string(raw(MOTION_PLUS)) + string(b"") + b"".join(
            bytes([60, 0, 0, 0x7E, 0x7F, 0x7E]) for _ in range(40)),
        "calibration/turning": string(raw(MOTION_PLUS)) + string(b"") + b"".join(
            bytes([60 + i % 5, 0, 0, 0x7E, 0x7F, 0x7E]) for i in range(60)),
        "calibration/board": string(board_block) + string(raw("19 01")) + raw(BOARD_REPORT)[3:14],
        "move/zcm1": b"\x06" + b"".join(string(raw(p)) for p in MOVE_PIECES) + string(b"")
                     + string(raw(MOVE_REPORT)),
        "move/zcm2": b"\x05" + b"".join(string(raw(p)) for p in MOVE2_PIECES) + string(b"")
                     + string(raw(MOVE_REPORT)[:44]),
        "move/at_charger": b"\x00" + string(b"") + string(with_byte(raw(MOVE_REPORT), 12, 0xEF))
                           + string(with_byte(with_byte(raw(MOVE_REPORT), 37, 0xFF), 38, 0xFF))
                           + string(with_byte(raw(MOVE_REPORT), 12, 0x77)) + string(raw(MOVE_REPORT)[:20]),
        "move/fast": b"\x00" + string(b"") + string(raw(MOVE_REPORT)[:25] + b"\xff" * 24),
        **make_motion_seeds.seeds(),
        **make_protocol_seeds.seeds(),
        **make_recording_seeds.seeds(),
        "joycon/blocks": b"\x00" + string(raw(JOYCON_BLOCK)) + string(raw("b2 a1 " + JOYCON_BLOCK))
                         + string(raw(JOYCON_STICK * 2)) + string(raw(("b2 a1 " + JOYCON_STICK) * 2)),
        "joycon/handshake": b"\x81" + string(b"") * 4 + steps(
            [raw(JOYCON_INFO)] + [raw("ff " + JOYCON_BLOCK), raw("ff b2 a1 " + JOYCON_BLOCK)]
            + [raw("ff " + JOYCON_STICK * 2), raw("ff " + ("b2 a1 " + JOYCON_STICK) * 2)] + [raw("ff"), raw("ff")]
            + [raw(JOYCON_MOTION)] * 6 + [raw("3f 00 00 08 00 80 00 80 00 80 00 80")]),
        "joycon/off": b"\x02" + string(b"") * 4 + steps([raw("ff")] * 8 + [bytes([0x30]) + bytes(48)] * 8),
        "joycon/attitude": b"\x00" + string(b"") * 4 + steps([raw("ff")] * 8 + [
            bytes([0x30, i]) + bytes(range(i, i + 47)) for i in range(0, 200, 9)]),
        "inertial/phone": steps([phone(i, 33_000, 16_667, 0) for i in range(5, 60, 3)]),
        "inertial/shaped": steps([b"\xff" + bytes(range(i, i + 80)) for i in range(0, 170, 11)]),
        "sensors/slimevr": steps([
            slime(3, bytes(40)), slime(15, b"\x01\x01\x02"), slime(12, struct.pack(">ff", 3.9, 0.4)),
            slime(4, struct.pack(">fff", 1, 2, 3) + b"\x01")] + [
            slime(17, struct.pack(">BBffffB", i % 2, 1, 0, 0.1 * i, 0, 1, 0)) for i in range(5)] + [
            slime(16, struct.pack(">ffff", 1, 0, 0, 0)), slime(1, struct.pack(">ffff", 0, 1, 0, 0)),
            slime(23, struct.pack(">Bhhhhhhh", 0, 0, 0, 0, 32767, 128, -256, 0)),
            slime(100, struct.pack(">HIBBffffB", 23, 17, 0, 1, 0, 0, 0, 1, 0)),
            slime(101, struct.pack(">BBBhhhhhhh", 16, 23, 1, 0, 0, 0, 32767, 1, 2, 3))]),
        "sensors/osc": steps([
            osc("/gyroscope", 0.1, 0.2, 0.3), osc("/accelerometer", 0.001, -0.001, 9.79), osc("/p/gyro", 0, 1, 0),
            osc("/p/gravity", 0, 0, -1), osc("/p/accel", 0, 0.5, 0), b"#bundle\0" + bytes(7) + b"\1"]),
        "sensors/own": steps([phone(i, 20_000, 0) for i in range(2, 9)]),
        "handshake/wiimote": b"\x00" + steps(wiimote),
        "handshake/board": b"\x01" + steps(board),
    }


REPLACEMENTS = ["-1", "1e999", "nan", "999999999999", "x", "{", "2 2"]
TEXT_FROM = {"motion": 1, "config": 2, "nats": 4, "lsl": 2}  # Bytes in front of the text.
VARIED = {"bvh", "asf", "amc", "trc", "mot"}  # Of motion files; the others differ from these already.


def changed(pieces: list[str], joint: str) -> list[str]:
    """Each piece left out, doubled, and replaced by one of the words in turn."""
    texts = []
    for i in range(len(pieces)):
        others = [[], [pieces[i]] * 2, [REPLACEMENTS[i % len(REPLACEMENTS)]], [REPLACEMENTS[(i + 3) % len(REPLACEMENTS)]]]
        texts += [joint.join(pieces[:i] + other + pieces[i + 1:]) for other in others]
    return texts


def variants() -> dict[str, bytes]:
    found = {}
    for name, data in seeds().items():
        folder, _, seed = name.partition("/")
        start = TEXT_FROM.get(folder) if folder != "motion" or seed in VARIED else None
        try:
            text = data[start:].decode("ascii") if start else ""
        except UnicodeDecodeError:
            continue
        words = re.split(r"([ \t\n,:{}\[\]()]+)", text)
        lines = text.split("\n")
        texts = changed(lines, "\n") + changed(words, "")
        found |= {f"{name}_{i}": data[:start] + one.encode() for i, one in enumerate(texts) if start}
    return found


def main() -> None:
    words = [word for word in sys.argv[1:] if word != "--variants"]
    folder = pathlib.Path(words[0]) if words else pathlib.Path(__file__).parent / "corpus"
    for name, data in (variants() if "--variants" in sys.argv else seeds()).items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(data)


if __name__ == "__main__":
    main()
