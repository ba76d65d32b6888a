"""Seeds of the fuzz targets of the protocol, of config files and of recordings; make_seeds.py
writes them."""
import pathlib
import random
import re
import struct

PROTOCOL = pathlib.Path(__file__).parents[2] / "docs" / "protocol.md"
RAW, GREET, SUBSCRIBE, PUBLISH, RUN, LOOK = 0, 3, 4, 5, 6, 7
WELCOME, ANSWER, COMMAND = 3, 4, 6
MAGIC = b"\x89MCAP0\r\n"


def string(data: bytes) -> bytes:
    return bytes([len(data)]) + data


def examples() -> list[tuple[str, bytes]]:
    """Name and bytes of every frame in the protocol's page."""
    found = []
    for text in re.findall(r"```frame\n(.*?)\n=\n", PROTOCOL.read_text(), re.S):
        lines = text.splitlines()
        data = bytes.fromhex("".join(line.split("#")[0] for line in lines))
        found.append((lines[1].split("#")[1].split(",")[0].strip(), data))
    return found


def raw(data: bytes) -> bytes:
    return b"".join(bytes([RAW]) + string(data[i:i + 255]) for i in range(0, len(data), 255))


def sessions() -> dict[str, bytes]:
    begun = bytes([GREET, 4, SUBSCRIBE, 2])
    seeds = {f"session/{name}": b"\x02" + begun + raw(data) + bytes([PUBLISH, 5, 7, LOOK])
             for name, data in examples()}
    hello = dict(examples())["hello"]
    seeds["session/quiet"] = b"\x00" + raw(hello) + bytes([RUN, 150, LOOK])
    seeds["session/never_hello"] = b"\x00" + bytes([RUN, 50, LOOK])
    seeds["session/token"] = b"\x15" + bytes([GREET, 64 + 128 + 3, SUBSCRIBE, 2, LOOK])
    seeds["session/wrong_token"] = b"\x15" + bytes([GREET, 64 + 3, LOOK])
    seeds["session/no_token"] = b"\x11" + bytes([GREET, 3, LOOK])
    seeds["session/resume"] = b"\x02" + bytes([GREET, 1, PUBLISH, 31, 6, SUBSCRIBE, 34, 3, 0, PUBLISH, 31, 6,
                                              LOOK, RUN, 20, LOOK])
    seeds["session/other_epoch"] = b"\x02" + bytes([GREET, 1, PUBLISH, 9, 7, SUBSCRIBE, 35, 3, 1, LOOK])
    seeds["session/slow_reliable"] = b"\x02" + bytes([GREET, 1, SUBSCRIBE, 3]) + bytes([PUBLISH, 31, 255]) * 40
    return seeds


def clients() -> dict[str, bytes]:
    begun = bytes([WELCOME, 3, ANSWER, ANSWER])
    seeds = {f"client/{name}": b"\x00" + begun + raw(data) + bytes([COMMAND, 5, RUN - 1, 20])
             for name, data in examples()}
    seeds["client/stale"] = b"\x02" + begun + bytes([5, 40, 5, 100, 5, 20]) + begun
    seeds["client/reconnects"] = b"\x00" + begun + bytes([COMMAND, 9, 8]) + begun + bytes([8]) + begun
    return seeds


def messages() -> dict[str, bytes]:
    """Any bytes make fields; how these come to be is what counts."""
    source = random.Random(16)
    return {f"wire/{kind:02}": bytes([kind, 0]) + source.randbytes(700) for kind in range(39)}


def configs() -> dict[str, bytes]:
    text = ('// comment\n{"number": 1.5, "integer": 7, "flag": true, "text": "t", "list": ["a", "b"],\n'
            ' "map": {"k": "v"}}\n').encode()
    fingerprint = "sha256:" + "0123456789abcdef" * 4
    clients_file = f"# wall\n{fingerprint}  view  Ada at the wall screen\n{fingerprint[:-1]}1 log x\n"
    seeds = {
        "config/file": b"\x00\x00" + text,
        "config/settings": b"\x00" + string(string(b"text=x") + string(b"integer=3") + string(b"flag=maybe")
                                            + string(b"nothing") + string(b"no=1")) + text,
        "config/wrong": b"\x00\x00" + b'{"integer": 7.5}',
        "config/too_large": b"\x00\x00" + b'{"integer": 1e999}',
        "config/not_utf8": b"\x00" + string(string(b"integer=\xf3") + string(b"text=\xf3")) + b"{}",
        "config/unknown": b"\x00\x00" + b'{"integr": 7}',
        "config/not_json": b"\x00\x00" + b'{"integer": 7',
        "config/clients": b"\x02" + clients_file.encode(),
    }
    addresses = ["unix:/run/x.sock", "tcp:127.0.0.1:7450", "tls:[::1]:7450", "fd:sensor", "tcp:x", "udp:1:2"]
    return seeds | {f"config/address_{i}": b"\x01" + a.encode() for i, a in enumerate(addresses)}


def text(value: str | bytes) -> bytes:
    data = value.encode() if isinstance(value, str) else value
    return struct.pack("<I", len(data)) + data


def text_map(values: dict[str, str]) -> bytes:
    return text(b"".join(text(k) + text(v) for k, v in values.items()))


def record(opcode: int, body: bytes) -> bytes:
    return struct.pack("<BQ", opcode, len(body)) + body


def recording(with_index: bool, cut: int = 0) -> bytes:
    """A recording without checksums, which are 0: two channels, two chunks."""
    schema = record(3, struct.pack("<H", 1) + text("s") + text("protobuf") + text(""))
    channels = b"".join(record(4, struct.pack("<HH", i, 1) + text(f"/footingd/{name}") + text("protobuf")
                                  + text_map({})) for i, name in ((1, "status"), (2, "motion")))
    out = MAGIC + record(1, text("") + text("seed"))
    metadata_at = len(out)
    clock = {"server": "footingd", "offset_ns": "5", "epoch": "7", "server_id": "footingd",
             "tick_rate_hz": "100", "server_host_ns": "1000", "server_wall_time_ns": "2000"}
    session = record(12, text("session") + text_map(clock))
    out += session + record(12, text("clock") + text_map(clock))
    attachment_at = len(out)
    attachment = record(9, struct.pack("<QQ", 1, 1) + text("a") + text("b") + struct.pack("<Q", 1) + b"x" + bytes(4))
    out += attachment
    chunk_indexes = b""
    for start in (1000, 2000):
        records, offsets = schema + channels, {1: [], 2: []}
        for i in range(4):
            channel = 1 + i % 2
            offsets[channel].append((start + i, len(records)))
            records += record(5, struct.pack("<HIQQ", channel, i, start + i, start + i) + b"\x0a\x02\x08\x01")
        chunk_at = len(out)
        chunk = record(6, struct.pack("<QQQI", start, start + 3, len(records), 0) + text("")
                       + struct.pack("<Q", len(records)) + records)
        out += chunk
        places = b""
        indexes_at = len(out)
        for channel, entries in offsets.items():
            places += struct.pack("<HQ", channel, len(out))
            out += record(7, struct.pack("<H", channel) + text(b"".join(struct.pack("<QQ", *e) for e in entries)))
        chunk_indexes += record(8, struct.pack("<QQQQ", start, start + 3, chunk_at, len(chunk)) + text(places)
                                + struct.pack("<Q", len(out) - indexes_at) + text("")
                                + struct.pack("<QQ", len(records), len(records)))
    out += record(15, bytes(4))
    summary_at = len(out) if with_index else 0
    if with_index:
        counts = text(struct.pack("<HQHQ", 1, 4, 2, 4))
        out += schema + channels + chunk_indexes
        out += record(10, struct.pack("<QQQQQ", attachment_at, len(attachment), 1, 1, 1) + text("a") + text("b"))
        out += record(13, struct.pack("<QQ", metadata_at, len(session)) + text("session"))
        out += record(11, struct.pack("<QHIIIIQQ", 8, 1, 2, 1, 2, 2, 1000, 2003) + counts)
    out += record(2, struct.pack("<QQI", summary_at, 0, 0)) + MAGIC
    return out[:len(out) - cut]


def devices() -> dict[str, bytes]:
    """Steps of tests/fuzz/device.cc: 0 plug, 1 pull, 2 pull the MotionPlus, 3 refuse, 4 lose, 9 wait, 10 go on."""
    on = bytes([10, 250])
    nunchuk, classic, motion_plus, unknown = (bytes([0, kind]) for kind in (1, 2, 3, 4))
    return {
        "device/plain": b"\x00" + on * 3 + bytes([7]) + on + bytes([8]) + on,
        "device/nunchuk": b"\x00" + on + nunchuk + on + bytes([1]) + on + unknown + on,
        "device/classic": b"\x04" + classic + on + bytes([1]) + on,
        "device/motion_plus": b"\x00" + motion_plus + on * 2 + nunchuk + on * 2 + bytes([1]) + on + classic + on
                              + bytes([2]) + on,
        "device/inside": b"\x02" + on * 2 + nunchuk + on * 2 + bytes([1]) + on * 2,
        "device/camera": b"\x09" + on + bytes([6, 0]) + on + bytes([22, 0]) + on,
        "device/refuses": b"\x01" + bytes([3, 7]) + on + nunchuk + bytes([3, 3]) + on * 2,
        "device/loses": b"\x00" + bytes([4, 3]) * 6 + on + nunchuk + bytes([4, 2]) * 6 + on + bytes([9, 200]) + on,
    }


def seeds() -> dict[str, bytes]:
    frames = b"".join(data for _, data in examples()[:1]) + struct.pack("<I", 301)
    return {
        "frames/pieces": string(bytes([1, 4, 9, 0])) + frames,
        "frames/tls": string(b"") + bytes([22, 3, 1, 0, 200, 1, 0, 0, 196]) + bytes(20),
        **devices(), **sessions(), **clients(), **messages(), **configs(),
        "recording/whole": recording(True),
        "recording/no_index": recording(False),
        "recording/cut": recording(True, 300),
        "recording/cut_in_chunk": recording(True, 900),
    }
