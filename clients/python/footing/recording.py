"""Recordings of footing-log (MCAP, docs/recordings.md) as tables."""
import bisect
import datetime
import mmap
import os
import struct
import zlib
from dataclasses import dataclass, field
from typing import Any, Dict, Iterator, List, Optional, Sequence, Tuple, Union

from footing.columns import FieldError, Table, name_of, need_numpy
from footing.v1 import character_pb2, device_pb2, game_pb2, sensor_pb2, session_pb2, stats_pb2, study_pb2
from footing.wire import FootingError

_MAGIC = b"\x89MCAP0\r\n"
_FOOTER, _SCHEMA, _CHANNEL, _MESSAGE, _CHUNK, _INDEX, _METADATA, _DATA_END = 2, 3, 4, 5, 6, 7, 12, 15
_MESSAGE_HEAD = struct.Struct("<QHIQ")  # Size of the record, channel, sequence, log time.


class DamagedRecording(FootingError):
    """The file is not a recording, or part of it cannot be read; the text names the repair."""


@dataclass
class _Chunk:
    begin: int  # Of its records in the file.
    size: int
    whole: int  # Uncompressed.
    crc: int
    compression: str
    index: Dict[int, List[int]] = field(default_factory=dict)  # Offsets of a channel's messages; empty: not known.


class _Cursor:
    """Numbers and texts of one record."""

    def __init__(self, data: Any, at: int):
        self.data, self.at = data, at

    def number(self, form: str) -> int:
        value = struct.unpack_from("<" + form, self.data, self.at)[0]
        self.at += struct.calcsize("<" + form)
        return value

    def text(self) -> str:
        size = self.number("I")
        self.at += size
        return bytes(self.data[self.at - size:self.at]).decode("utf-8", "replace")

    def texts(self) -> Dict[str, str]:
        end, found = self.number("I") + self.at, {}
        while self.at < end:
            key = self.text()
            found[key] = self.text()
        return found


def _records(data: Any, at: int, end: int) -> Iterator[Tuple[int, int, int]]:
    """(opcode, begin, end) of whole records."""
    while at + 9 <= end:
        size = struct.unpack_from("<Q", data, at + 1)[0]
        if at + 9 + size > end:
            return
        yield data[at], at + 9, at + 9 + size
        at += 9 + size


_MOST_UNPACKED = 256 << 20  # Bytes, as footing-log reads.


def _unpack(compression: str, data: bytes, size: int) -> Optional[bytes]:
    """Nothing when the chunk says that it takes more memory than any recorder gives it."""
    if not compression:
        return data
    if size > _MOST_UNPACKED:
        return None
    if compression != "zstd":
        raise FootingError(f"the recording is compressed with {compression!r}, which this package does not read")
    try:
        from compression import zstd  # type: ignore[import-not-found]  # Python 3.14.
        return zstd.decompress(data)
    except ImportError:
        pass
    try:
        import zstandard
    except ImportError as error:
        raise FootingError("the recording is compressed with zstd: apt install python3-zstandard, or pip install "
                           "zstandard") from error
    return zstandard.ZstdDecompressor().decompress(data, max_output_size=size)


class Recording:
    """One file. Made by `footing.read`; `with` closes it. Times are seconds since the first message."""

    def __init__(self, path: Union[str, "os.PathLike[str]"]):
        self.path = os.fspath(path)
        try:
            with open(self.path, "rb") as file:
                self._data: Any = mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ)
        except ValueError as error:
            raise DamagedRecording(f"{self.path} is empty") from error
        if self._data[:8] != _MAGIC:
            raise DamagedRecording(f"{self.path} is not an MCAP file, as footing-log record writes it")
        self.metadata: List[Tuple[str, Dict[str, str]]] = []
        self.complete = False  # False: its recorder was killed; what is there is read.
        self._schemas: Dict[int, str] = {}
        self._topics: Dict[str, Tuple[int, int]] = {}  # Channel id and schema id.
        self._chunks: List[_Chunk] = []
        self.zero_ns, self._end_ns = (1 << 63) - 1, 0
        for opcode, begin, end in _records(self._data, 8, len(self._data)):
            self._take(opcode, begin, end)
        if not self._topics:  # Without a summary they stand within the chunks.
            for chunk in self._chunks:
                records = self._load(chunk)
                for opcode, begin, end in _records(records, 0, len(records)):
                    if opcode in (_SCHEMA, _CHANNEL):
                        self._define(opcode, records, begin)
        self._names: Dict[str, Dict[str, str]] = {}
        self._statuses: Dict[str, Tuple[List[float], List[Any]]] = {}

    def __enter__(self) -> "Recording":
        return self

    def __exit__(self, *_: Any) -> None:
        self.close()

    def close(self) -> None:
        self._data.close()

    def __repr__(self) -> str:
        whole = "" if self.complete else ", incomplete"
        return f"<footing.Recording {self.path}: {self.duration_s:.1f} s{whole}: {', '.join(self.topics)}>"

    @property
    def topics(self) -> List[str]:
        """Such as "/footingd/motion"."""
        return sorted(name for name, (_, schema) in self._topics.items() if self._type(name) is not None)

    @property
    def duration_s(self) -> float:
        return max(0, self._end_ns - self.zero_ns) * 1e-9

    @property
    def began(self) -> Optional[datetime.datetime]:
        """UTC of time 0; None where the recording does not say it."""
        for name, values in self.metadata:
            if name == "session" and "server_wall_time_ns" in values:
                wall_ns = int(values["server_wall_time_ns"]) + self.zero_ns - int(values["server_host_ns"])
                return datetime.datetime.fromtimestamp(wall_ns * 1e-9, datetime.timezone.utc)
        return None

    def _take(self, opcode: int, begin: int, end: int) -> None:
        cursor = _Cursor(self._data, begin)
        if opcode == _CHUNK:
            first, last, whole, crc = (cursor.number(form) for form in "QQQI")
            compression, size = cursor.text(), cursor.number("Q")
            self._chunks.append(_Chunk(cursor.at, size, whole, crc, compression))
            self.zero_ns, self._end_ns = min(self.zero_ns, first), max(self._end_ns, last)
        elif opcode == _INDEX and self._chunks:
            channel, size = cursor.number("H"), cursor.number("I")
            pairs = struct.unpack_from(f"<{size // 8}Q", self._data, cursor.at)
            self._chunks[-1].index[channel] = list(pairs[1::2])
        elif opcode in (_SCHEMA, _CHANNEL):
            self._define(opcode, self._data, begin)
        elif opcode == _METADATA:
            self.metadata.append((cursor.text(), cursor.texts()))
        elif opcode == _FOOTER:
            self.complete = True

    def _define(self, opcode: int, data: Any, begin: int) -> None:
        cursor = _Cursor(data, begin)
        number = cursor.number("H")
        if opcode == _SCHEMA:
            self._schemas[number] = cursor.text()
        else:
            schema = cursor.number("H")
            self._topics[cursor.text()] = (number, schema)

    def _load(self, chunk: _Chunk) -> bytes:
        try:
            records = _unpack(chunk.compression, self._data[chunk.begin:chunk.begin + chunk.size], chunk.whole)
        except FootingError:
            raise
        except Exception:  # Each module of zstd has an error of its own.
            records = None
        if records is None or chunk.crc and zlib.crc32(records) != chunk.crc:
            raise DamagedRecording(f"{self.path} is damaged at byte {chunk.begin}: footing-log repair {self.path} --out "
                                   "whole.mcap keeps the rest")
        return records

    def _type(self, topic: str) -> Any:
        """Class of a topic's messages; None for those of other programs."""
        package, _, name = self._schemas.get(self._topics[topic][1], "").rpartition(".")
        fields = session_pb2.Tick.DESCRIPTOR.fields
        types = [one.message_type for one in fields if one.message_type and one.message_type.name == name]
        if package != "footing.v1" or not types:
            return None
        return next(getattr(module, name) for module in _MODULES if hasattr(module, name))

    def _topic(self, channel: str, server: Optional[str]) -> str:
        found = [name for name in self.topics if channel in (name, name.rpartition("/")[2])
                 and server in (None, name.split("/")[1])]
        if not found:
            raise FieldError(f"{self.path} has no {channel!r}; it has {', '.join(self.topics)}")
        return found[0]

    def _raw(self, topic: str) -> Tuple[List[bytes], List[int], List[int]]:
        """Messages of a topic, their log times and sequences."""
        wanted = self._topics[topic][0]
        parts, times, numbers = [], [], []
        for chunk in self._chunks:
            if chunk.index and wanted not in chunk.index:
                continue
            records = self._load(chunk)
            places = chunk.index.get(wanted)
            if places is None:
                places = [begin - 9 for code, begin, _ in _records(records, 0, len(records)) if code == _MESSAGE]
            for at in places:
                size, channel, sequence, log_ns = _MESSAGE_HEAD.unpack_from(records, at + 1)
                if channel == wanted:
                    parts.append(records[at + 31:at + 9 + size])
                    times.append(log_ns)
                    numbers.append(sequence)
        return parts, times, numbers

    def messages(self, channel: str, server: Optional[str] = None) -> Iterator[Tuple[float, Any]]:
        """(time_s, message) of a channel or topic, one after the other; the fields are those of proto/footing/v1."""
        topic = self._topic(channel, server)
        kind = self._type(topic)
        for data, log_ns in zip(*self._raw(topic)[:2]):
            yield (log_ns - self.zero_ns) * 1e-9, kind.FromString(data)

    def table(self, channel: str, *, role: Optional[str] = None, device: Optional[str] = None,
              fields: Optional[Sequence[str]] = None, server: Optional[str] = None) -> Table:
        """Rows of a channel ("motion") or topic ("/footingd/motion") as columns.

        `role` or `device` ("main/left_hand", or a serial) takes one device's rows, `fields` only these columns: names, or
        their beginnings ("specific_force_mps2").
        """
        from footing.columns import np
        topic = self._topic(channel, server)
        name, server = topic.rpartition("/")[2], topic.split("/")[1]
        labels = self._labels(name, server)
        if fields is not None:
            back = sorted(((label, start) for start, label in labels.items()), key=lambda one: -len(one[0]))
            fields = [_renamed(one, dict(back)) for one in fields]
        parts, times, numbers = self._raw(topic)
        if np is not None:
            table = Table.of_bytes(name, parts, times, numbers, self.zero_ns, fields)
        else:
            kind = self._type(topic)
            held = [(ns, number, kind.FromString(data)) for data, ns, number in zip(parts, times, numbers)]
            table = Table.of_messages(name, held, self.zero_ns, fields)
        if name != "status" and "device" in table.columns:
            changes_s, lists = self._devices(server)
            table.add_devices(lambda number, at_s: self._status(lists, changes_s, number, at_s), changes_s)
        table.columns = {_renamed(one, labels): values for one, values in table.columns.items()}
        return table.where(role=role, device=device) if role or device else table

    def array(self, channel: str, fields: Sequence[str], *, rate_hz: Optional[float] = None, role: Optional[str] = None,
              device: Optional[str] = None, server: Optional[str] = None) -> Any:
        """Columns side by side as doubles; with `rate_hz` at an even rate."""
        need_numpy("an array")
        return self.table(channel, role=role, device=device, fields=fields, server=server).array(fields, rate_hz)

    def frame(self, channel: str, *, role: Optional[str] = None, device: Optional[str] = None,
              fields: Optional[Sequence[str]] = None, server: Optional[str] = None) -> Any:
        """A pandas DataFrame: times in `time_s`, units in the columns' names, enums as words."""
        return self.table(channel, role=role, device=device, fields=fields, server=server).frame()

    # --- Labels ---------------------------------------------------------------------------------------
    def _devices(self, server: str) -> Tuple[List[float], List[Any]]:
        """Times from which a list of devices holds, and the lists; only those that change a label."""
        if server not in self._statuses:
            times, lists, before = [], [], None
            if f"/{server}/status" in self._topics:
                for time_s, status in self.messages(f"/{server}/status"):
                    labels = [(one.device, one.rig, one.role, one.serial) for one in status.devices]
                    if labels != before:
                        times.append(time_s)
                        lists.append({one.device: one for one in status.devices})
                    before = labels
            self._statuses[server] = (times, lists)
        return self._statuses[server]

    @staticmethod
    def _status(lists: List[Any], changes_s: List[float], number: int, at_s: float) -> Optional[device_pb2.DeviceStatus]:
        """Before the first list that has the device: as it is there."""
        place = max(0, bisect.bisect_right(changes_s, at_s) - 1)
        earlier = next((one[number] for one in reversed(lists[:place + 1]) if number in one), None)
        return earlier or next((one[number] for one in lists[place + 1:] if number in one), None)

    def _labels(self, name: str, server: str) -> Dict[str, str]:
        """Of a character's list entries, such as "links_3": the joint's name."""
        topic = f"/{server}/skeletons"
        if name != "characters" or topic not in self._topics:
            return {}
        if server not in self._names:
            one = next((one for _, message in self.messages(topic) for one in message.skeletons), character_pb2.Skeleton())
            self._names[server] = {**{f"links_{i}": link.name for i, link in enumerate(one.links)},
                                   **{f"contacts_{i}": f"contact_{point}" for i, point in enumerate(one.contact_points)}}
        return self._names[server]


_MODULES = (sensor_pb2, character_pb2, device_pb2, stats_pb2, study_pb2, game_pb2)


def _renamed(column: str, labels: Dict[str, str]) -> str:
    """With a label in place of the beginning that it is for."""
    start = next((one for one in labels if column == one or column.startswith(one + "_")), "")
    return labels[start] + column[len(start):] if start else column


def read(path: Union[str, "os.PathLike[str]"]) -> Recording:
    """Opens a recording that footing-log made. A file whose recorder was killed is read to its last whole part."""
    return Recording(path)
