"""Seeds of the fuzz target of recordings, whole ones and damaged ones; make_seeds.py writes them."""
import struct
import zlib

MAGIC = b"\x89MCAP0\r\n"
MESSAGE, CHUNK, CHANNEL, SCHEMA, METADATA = 5, 6, 4, 3, 12


def text(value: str | bytes) -> bytes:
    data = value.encode() if isinstance(value, str) else value
    return struct.pack("<I", len(data)) + data


def text_map(values: dict[str, str]) -> bytes:
    return text(b"".join(text(k) + text(v) for k, v in values.items()))


def record(opcode: int, body: bytes) -> bytes:
    return struct.pack("<BQ", opcode, len(body)) + body


def schema(name: str = "s") -> bytes:
    return record(SCHEMA, struct.pack("<H", 1) + text(name) + text("protobuf") + text(""))


def channel(number: int, topic: str, schema_id: int = 1) -> bytes:
    return record(CHANNEL, struct.pack("<HH", number, schema_id) + text(topic) + text("protobuf") + text_map({}))


def message(number: int, sequence: int, time_ns: int, data: bytes = b"\x0a\x02\x08\x01") -> bytes:
    return record(MESSAGE, struct.pack("<HIQQ", number, sequence, time_ns, time_ns) + data)


def chunk_of(records: bytes, start: int = 1000, crc: int = 0, compression: str = "", size: int | None = None) -> bytes:
    size = len(records) if size is None else size
    return record(CHUNK, struct.pack("<QQQI", start, start + 3, size, crc) + text(compression)
                  + struct.pack("<Q", len(records)) + records)


SETUP = schema() + channel(1, "/footingd/status") + channel(2, "/footingd/motion")
CLOCK = {"server": "footingd", "offset_ns": "5", "epoch": "7", "server_id": "footingd",
         "tick_rate_hz": "100", "server_host_ns": "1000", "server_wall_time_ns": "2000"}


def recording(with_index: bool, cut: int = 0, crcs: bool = False, wrong: str = "") -> bytes:
    """Two channels, two chunks; without `crcs` the checksums are 0, and `wrong` names one that is not right."""
    out = MAGIC + record(1, text("") + text("seed"))
    metadata_at = len(out)
    session = record(METADATA, text("session") + text_map(CLOCK))
    out += session + record(METADATA, text("clock") + text_map(CLOCK))
    attachment_at = len(out)
    attachment = record(9, struct.pack("<QQ", 1, 1) + text("a") + text("b") + struct.pack("<Q", 1) + b"x" + bytes(4))
    out += attachment
    chunk_indexes = b""
    for start in (1000, 2000):
        records, offsets = SETUP, {1: [], 2: []}
        for i in range(4):
            number = 1 + i % 2
            offsets[number].append((start + i, len(records)))
            records += message(number, i, start + i)
        chunk_at = len(out)
        crc = zlib.crc32(records) + (wrong == "chunk") if crcs else 0
        chunk = chunk_of(records, start, crc)
        out += chunk
        places = b""
        indexes_at = len(out)
        for number, entries in offsets.items():
            places += struct.pack("<HQ", number, len(out))
            out += record(7, struct.pack("<H", number) + text(b"".join(struct.pack("<QQ", *e) for e in entries)))
        chunk_indexes += record(8, struct.pack("<QQQQ", start, start + 3, chunk_at, len(chunk)) + text(places)
                                + struct.pack("<Q", len(out) - indexes_at) + text("")
                                + struct.pack("<QQ", len(records), len(records)))
    out += record(15, struct.pack("<I", zlib.crc32(out) + (wrong == "data") if crcs else 0))
    summary_at = len(out) if with_index else 0
    if with_index:
        counts = text(struct.pack("<HQHQ", 1, 4, 2, 4))
        out += SETUP + chunk_indexes
        out += record(10, struct.pack("<QQQQQ", attachment_at, len(attachment), 1, 1, 1) + text("a") + text("b"))
        out += record(13, struct.pack("<QQ", metadata_at, len(session)) + text("session"))
        out += record(11, struct.pack("<QHIIIIQQ", 8, 1, 2, 1, 2, 2, 1000, 2003) + counts)
        out += record(14, struct.pack("<BQQ", 3, summary_at, 1)) if wrong != "summary record" else record(11, b"x")
    head = struct.pack("<BQQQ", 2, 20, summary_at, 0)
    crc = zlib.crc32(out[summary_at or len(out):] + head) + (wrong == "summary") if crcs else 0
    out += head + struct.pack("<I", crc) + MAGIC
    return out[:len(out) - cut]


def with_records(*records: bytes) -> bytes:
    """A recording without chunks or summary that has these."""
    return MAGIC + record(1, text("") + text("seed")) + b"".join(records) + record(15, bytes(4)) + record(
        2, struct.pack("<QQI", 0, 0, 0)) + MAGIC


def damaged() -> dict[str, bytes]:
    first = message(1, 0, 1000)
    inside = {
        "metadata": record(METADATA, text("a") + text_map({})),
        "other_schema": SETUP + schema("t"),
        "no_schema": channel(3, "/footingd/raw", 9),
        "other_channel": SETUP + channel(1, "/footing-sim/status"),
        "unknown_channel": SETUP + message(9, 0, 1000),
        "bad_schema": record(SCHEMA, b"x"),
        "bad_channel": record(CHANNEL, b"x"),
        "bad_message": SETUP + record(MESSAGE, b"x"),
        "not_protobuf": SETUP + message(1, 0, 1000, b"\x0a\xff"),
        "same_topic": SETUP + channel(3, "/footingd/status") + first,
        "other_topic": SETUP + channel(3, "/nowhere") + channel(4, "/footing-sim/track") + first + message(4, 1, 1001),
    }
    outside = {
        "message": SETUP + first,
        "message_beside_chunk": chunk_of(SETUP) + first,
        "kind_0": record(0, b""),
        "bad_chunk": record(CHUNK, b"x"),
        "compressed": chunk_of(SETUP, compression="lz4"),
        "two_sizes": chunk_of(SETUP, size=1),
        "bad_metadata": record(METADATA, b"x"),
        "bad_end": record(15, b"x"),
        "bad_footer": record(2, struct.pack("<QQI", 1 << 40, 0, 0)),
        "cut_compressed": chunk_of(SETUP, compression="lz4")[:-40],
        "three_chunks": chunk_of(SETUP + first) * 3,
        "two_sessions": (record(METADATA, text("session") + text_map({**CLOCK, "epoch": "8"})) + chunk_of(SETUP + first)) * 2,
    }
    return {f"recording/in_chunk_{name}": with_records(chunk_of(records)) for name, records in inside.items()} | {
        f"recording/outside_{name}": with_records(records) for name, records in outside.items()}


def seeds() -> dict[str, bytes]:
    wrong = {f"recording/wrong_{name.replace(' ', '_')}": recording(True, crcs=True, wrong=name)
             for name in ("chunk", "data", "summary", "summary record")}
    return wrong | damaged() | {
        "recording/whole": recording(True),
        "recording/crcs": recording(True, crcs=True),
        "recording/no_index": recording(False),
        "recording/no_index_crcs": recording(False, crcs=True),
        "recording/cut": recording(True, 300),
        "recording/cut_in_chunk": recording(True, 900),
        "recording/cut_in_magic": recording(True, 3),
        "recording/other_end": recording(True, 8) + b"12345678",
    }
