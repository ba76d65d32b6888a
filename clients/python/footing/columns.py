"""Rows of a channel as columns: NumPy arrays where NumPy is there, else lists.

Names are those of footing-log's CSV files: a nested field is OUTER_FIELD (`specific_force_mps2_x`), an entry of a list
LIST_INDEX (`links_0_position_m_x`), and the unit is in the name. With NumPy the bytes of all rows are read together,
field by field, which takes a tenth of the time of reading message by message.
"""
import math
from typing import Any, Callable, Dict, Iterable, Iterator, List, Optional, Sequence, Tuple

from footing.v1 import device_pb2, session_pb2

try:
    import numpy as np
except ImportError:  # Lists then.
    np = None  # type: ignore[assignment]

# The list that gives a channel's rows; other channels have one row a message.
ROWS = {"status": "devices", "motion": "samples", "features": "rigs", "boards": "samples", "raw": "reports",
        "nunchuk": "samples", "camera": "samples", "hands": "samples", "reference": "poses", "contacts": "samples",
        "gamepad": "samples", "characters": "characters", "events": "events", "inputs": "inputs", "boards_uniform": "samples",
        "skeletons": "skeletons", "setup": "rigs"}
_UNITS = {"s": "s", "ns": "ns", "ms": "ms", "us": "us", "hz": "Hz", "m": "m", "mm": "mm", "mps": "m/s", "mps2": "m/s^2",
          "rad": "rad", "radps": "rad/s", "n": "N", "kg": "kg", "m2": "m^2", "kgm2ps": "kg m^2/s", "c": "degC"}
_NO_TAG = 1 << 32
_BATCH = 2048  # Messages.


class FieldError(KeyError):
    """There is no such column."""

    def __str__(self) -> str:
        return str(self.args[0])


def name_of(enum: Any, number: int) -> str:
    """Name of an enum's value without the enum's own: "left_hand"; empty for the unspecified 0."""
    if not number:
        return ""
    value = enum.DESCRIPTOR.values_by_number.get(number)
    prefix = enum.DESCRIPTOR.values_by_number[0].name[:-len("UNSPECIFIED")]
    return value.name[len(prefix):].lower() if value else str(number)


def need_numpy(purpose: str) -> Any:
    if np is None:
        raise ImportError(f"{purpose} needs NumPy: apt install python3-numpy, or pip install numpy")
    return np


def _kind(field: Any) -> str:
    types = {field.TYPE_DOUBLE: "f8", field.TYPE_FLOAT: "f4", field.TYPE_BOOL: "?", field.TYPE_STRING: "text",
             field.TYPE_BYTES: "bytes", field.TYPE_MESSAGE: "message", field.TYPE_SINT32: "zigzag", field.TYPE_SINT64: "zigzag",
             field.TYPE_UINT64: "u8"}
    return types.get(field.type, "i8")


def _repeated(field: Any) -> bool:
    own = getattr(field, "is_repeated", None)  # `label` goes with a later protobuf.
    return field.label == field.LABEL_REPEATED if own is None else own


# --- Without NumPy: one message after the other -------------------------------------------------------
def flatten(message: Any, prefix: str = "", cells: Optional[Dict[str, Any]] = None, without: str = "") -> Dict[str, Any]:
    """Fields of a message by their column's name. A nested message that is absent has none."""
    cells = {} if cells is None else cells
    for field in message.DESCRIPTOR.fields:
        value, name = getattr(message, field.name), prefix + field.name
        if name == without:
            continue
        if _repeated(field):
            for index, entry in enumerate(value):
                if field.message_type:
                    flatten(entry, f"{name}_{index}_", cells)
                else:
                    cells[f"{name}_{index}"] = entry
        elif not field.message_type:
            cells[name] = value
        elif message.HasField(field.name):
            flatten(value, name + "_", cells)
    return cells


def _engine(name: str) -> str:
    """Simulated time of a character's frame has another name than the column of every table; and back."""
    return {"time_s": "engine_time_s", "engine_time_s": "time_s"}.get(name, name)


def _missing(value: Any) -> Any:
    return math.nan if isinstance(value, float) else type(value)()


def columns_of_messages(rows: Iterable[Any]) -> Dict[str, List[Any]]:
    return _columns_of([flatten(row) for row in rows])


def _columns_of(cells: Sequence[Dict[str, Any]]) -> Dict[str, List[Any]]:
    missing = {name: _missing(value) for row in reversed(cells) for name, value in row.items()}
    return {name: [row.get(name, default) for row in cells] for name, default in missing.items()}


# --- With NumPy: all messages together ---------------------------------------------------------------
class _Bytes:
    """Bytes of many messages, read at many places at once."""

    def __init__(self, data: bytes):
        self.text = data
        self.size = len(data)
        padded = data + b"\0" * 16  # So that a number that is cut off lies within.
        self.u1 = np.frombuffer(padded, np.uint8)
        self.f8 = np.ndarray((self.size + 8,), "<f8", padded, 0, (1,))
        self.f4 = np.ndarray((self.size + 8,), "<f4", padded, 0, (1,))

    def varint(self, at: Any) -> Tuple[Any, Any]:
        """Values and the places behind them."""
        byte = self.u1[at]
        if not len(byte) or byte.max() < 0x80:
            return byte, at + 1
        value, at = (byte & 0x7F).astype(np.uint64), at + 1
        more = np.flatnonzero(byte & 0x80)
        for shift in range(7, 70, 7):
            if not len(more):
                break
            byte = self.u1[np.minimum(at[more], self.size)]
            value[more] |= (byte & 0x7F).astype(np.uint64) << np.uint64(shift)
            at[more] += 1
            more = more[(byte & 0x80) != 0]
        return value, at

    def scalar(self, kind: str, at: Any) -> Tuple[Any, Any]:
        if kind in ("f8", "f4"):
            return (self.f8 if kind == "f8" else self.f4)[at], at + (8 if kind == "f8" else 4)
        value, at = self.varint(at)
        if kind == "zigzag":
            value = (value >> np.uint64(1)).astype(np.int64) ^ -(value & np.uint64(1)).astype(np.int64)
        return (value if kind == "u8" else value != 0 if kind == "?" else value.astype(np.int64)), at


_WIRE = {"f8": 1, "f4": 5, "text": 2, "bytes": 2, "message": 2}


def _steps(data: _Bytes, at: Any, end: Any) -> Iterator[Tuple[int, int, Any, Any, Any]]:
    """Yields (field number, wire type, messages, where the value begins, where it ends), the lowest field first."""
    at = at.copy()
    tag = np.full(len(at), _NO_TAG, np.uint64)
    live = np.flatnonzero(at < end)
    while True:
        if len(live):
            tag[live], at[live] = data.varint(at[live])
        lowest = int(tag.min()) if len(tag) else _NO_TAG
        if lowest == _NO_TAG:
            return
        one = np.flatnonzero(tag == lowest)
        begin, wire = at[one], lowest & 7
        if wire == 2:
            size, begin = data.varint(begin)
            stop = begin + size.astype(np.int64)
        else:
            stop = begin + 8 if wire == 1 else begin + 4 if wire == 5 else data.varint(begin)[1]
        if wire not in (0, 1, 2, 5) or (stop > end[one]).any() or (stop < begin).any():
            raise ValueError("a message is damaged")
        yield lowest >> 3, wire, one, begin, stop
        at[one], tag[one] = stop, _NO_TAG
        live = one[stop < end[one]]


class _Reader:
    """Columns of rows that begin and end somewhere in the bytes."""

    def __init__(self, data: _Bytes, rows: int, fields: Optional[Sequence[str]], without: str = ""):
        self.data, self.rows, self.fields, self.without = data, rows, fields, without
        self.columns: Dict[str, Any] = {}

    def wants(self, name: str) -> bool:
        """A column that is asked for, the beginning of one, or one with such a beginning."""
        return name.split("_")[0] != self.without and (self.fields is None or any(one == name or one.startswith(name + "_") or name.startswith(one + "_")
                                                                                   for one in self.fields))

    def column(self, name: str, kind: str) -> Any:
        if name not in self.columns:
            self.columns[name] = _blank(kind, self.rows)
        return self.columns[name]

    def read(self, descriptor: Any, at: Any, end: Any, row: Any, prefix: str = "") -> None:
        for field in descriptor.fields:  # What a message does not say is 0.
            name, kind = prefix + field.name, _kind(field)
            if not _repeated(field) and kind in ("f8", "f4", "i8", "u8", "?", "zigzag", "text", "bytes") and self.wants(name):
                column = self.column(name, kind)
                if kind in ("f8", "f4"):
                    column[row] = 0
        counts: Dict[int, Any] = {}
        for number, wire, one, begin, stop in _steps(self.data, at, end):
            field = descriptor.fields_by_number.get(number)
            if field is None or not self.wants(prefix + field.name):
                continue  # Of a later version, or nobody asks for it.
            name, kind = prefix + field.name, _kind(field)
            if not _repeated(field):
                self.value(field, kind, wire, name, row[one], begin, stop)
                continue
            count = counts.setdefault(number, np.zeros(len(at), np.int64))
            while len(one):  # One entry, or a packed list of them.
                for index in np.unique(count[one]):
                    same = count[one] == index
                    self.value(field, kind, _WIRE.get(kind, 0), f"{name}_{index}", row[one[same]], begin[same], stop[same])
                count[one] += 1
                if wire != 2 or _WIRE.get(kind, 0) == 2:
                    break
                begin = self.data.scalar(kind, begin)[1]
                left = begin < stop
                one, begin, stop = one[left], begin[left], stop[left]

    def value(self, field: Any, kind: str, wire: int, name: str, row: Any, begin: Any, stop: Any) -> None:
        if not self.wants(name) or wire != _WIRE.get(kind, 0):
            return
        if kind == "message":
            self.read(field.message_type, begin, stop, row, name + "_")
        elif kind in ("text", "bytes"):
            pieces = [self.data.text[b:e] for b, e in zip(begin.tolist(), stop.tolist())]
            self.column(name, kind)[row] = [p.decode("utf-8", "replace") for p in pieces] if kind == "text" else pieces
        else:
            self.column(name, kind)[row] = self.data.scalar(kind, begin)[0]


def _blank(kind: str, rows: int) -> Any:
    """What a row has that does not say it: an absent nested number is NaN."""
    if kind in ("text", "bytes"):
        return np.full(rows, "" if kind == "text" else b"", object)
    return np.full(rows, np.nan, kind) if kind in ("f8", "f4") else np.zeros(rows, "i8" if kind == "zigzag" else kind)


def _joined(parts: Sequence[Dict[str, Any]]) -> Dict[str, Any]:
    """Columns of one batch behind those of the other; a batch may lack some."""
    kinds = {name: values for columns in parts for name, values in columns.items() if len(values) or name == "time_s"}
    rows = [len(columns["time_s"]) for columns in parts]

    def blank(like: Any, count: int) -> Any:
        kind = like.dtype.str[1:] if like.dtype != object else "bytes" if isinstance(like[0], bytes) else "text"
        return _blank({"b1": "?"}.get(kind, kind), count)

    return {name: np.concatenate([columns[name] if name in columns else blank(like, count) for columns, count in zip(parts, rows)])
            for name, like in kinds.items()}


def _split(data: _Bytes, at: Any, end: Any, number: int) -> Tuple[Any, Any, Any]:
    """Begin, end and message of every entry of a list of messages, in their order."""
    found = [(begin, stop, one) for field, wire, one, begin, stop in _steps(data, at, end) if field == number and wire == 2]
    if not found:
        return (np.zeros(0, np.int64),) * 3
    begin, stop, of = (np.concatenate([part[i] for part in found]) for i in range(3))
    order = np.argsort(begin, kind="stable")
    return begin[order], stop[order], of[order]


class Table:
    """Columns of equal length by their names: `table["cop_x_m"]`. Times are in `time_s`."""

    def __init__(self, columns: Dict[str, Any], enums: Optional[Dict[str, Any]] = None):
        self.columns, self._enums = columns, enums or {}

    @classmethod
    def of_messages(cls, channel: str, held: Sequence[Tuple[int, int, Any]], zero_ns: int,
                    fields: Optional[Sequence[str]] = None) -> "Table":
        """Rows of (host_ns, sequence, message of the channel)."""
        if np is not None:
            parts = [message.SerializeToString() for _, _, message in held]
            return cls.of_bytes(channel, parts, [ns for ns, _, _ in held], [number for _, number, _ in held], zero_ns, fields)
        rows = []
        for ns, number, message in held:
            outer = {_engine(name): value for name, value in flatten(message, without=ROWS[channel]).items()} \
                if channel in ROWS else {}
            rows += [(ns, number, {**outer, **flatten(row)})
                     for row in (getattr(message, ROWS[channel]) if channel in ROWS else [message])]
        columns = _columns_of([cells for _, _, cells in rows]) if rows else _no_rows(_row_type(channel), lambda *_: [])
        at_ns = [own or ns for own, (ns, _, _) in zip(columns.get("sampled_ns", [0] * len(rows)), rows)]
        head = {"time_s": [(ns - zero_ns) * 1e-9 for ns in at_ns], "sequence": [number for _, number, _ in rows]}
        kept = {name: values for name, values in columns.items()
                if fields is None or any(one == name or name.startswith(one + "_") for one in fields) or name == "device"}
        return cls({**head, **kept}, _enums_of(channel))

    @classmethod
    def of_bytes(cls, channel: str, parts: Sequence[bytes], host_ns: Sequence[int], sequence: Sequence[int], zero_ns: int,
                 fields: Optional[Sequence[str]] = None) -> "Table":
        """The same out of serialised messages; needs NumPy."""
        # So many at once that what is worked on stays in the processor's cache.
        tables = [cls._of_batch(channel, parts[i:i + _BATCH], host_ns[i:i + _BATCH], sequence[i:i + _BATCH], zero_ns, fields)
                  for i in range(0, max(1, len(parts)), _BATCH)]
        table = cls(_joined([table.columns for table in tables]), _enums_of(channel)) if len(tables) > 1 else tables[0]
        if not len(table):
            table.columns.update(_no_rows(_row_type(channel), _blank))
        return table

    @classmethod
    def _of_batch(cls, channel: str, parts: Sequence[bytes], host_ns: Sequence[int], sequence: Sequence[int], zero_ns: int,
                  fields: Optional[Sequence[str]]) -> "Table":
        sizes = np.fromiter(map(len, parts), np.int64, len(parts))
        end = np.cumsum(sizes)
        at, data, message = end - sizes, _Bytes(b"".join(parts)), _message_type(channel)
        of, outer = np.arange(len(parts)), {}
        wanted = None if fields is None else [*map(_engine, fields), "sampled_ns", "device"]
        if channel in ROWS:
            rows = message.fields_by_name[ROWS[channel]]
            frame = _Reader(data, len(parts), wanted, rows.name)
            frame.read(message, at, end, np.arange(len(parts)))
            outer = frame.columns
            at, end, of = _split(data, at, end, rows.number)
            message = rows.message_type
        reader = _Reader(data, len(at), wanted)
        reader.read(message, at, end, np.arange(len(at)))
        columns = reader.columns
        at_ns = np.asarray(host_ns, np.int64)[of]
        if "sampled_ns" in columns:
            at_ns = np.where(columns["sampled_ns"] != 0, columns["sampled_ns"], at_ns)
        # Whole nanoseconds are subtracted first: a double has no place for those of a day.
        head = {"time_s": (at_ns - zero_ns) * 1e-9, "sequence": np.asarray(sequence, np.int64)[of]}
        return cls({**head, **{_engine(name): values[of] for name, values in outer.items()}, **columns},
                   _enums_of(channel))

    def add_devices(self, device_at: Callable[[int, float], Any], changes_s: Sequence[float]) -> None:
        """Columns device_rig, device_role and device_serial by the status that `device_at` gives at a time."""
        numbers, times = self.columns.get("device"), self.columns["time_s"]
        if numbers is None:
            return
        names = ("device_rig", "device_role", "device_serial")

        def texts(number: int, time_s: float) -> Tuple[str, str, str]:
            status = device_at(number, time_s) or device_pb2.DeviceStatus()
            return status.rig, name_of(device_pb2.DeviceRole, status.role), status.serial

        if np is None:
            rows = [texts(number, time_s) for number, time_s in zip(numbers, times)]
            self.columns.update({name: [row[i] for row in rows] for i, name in enumerate(names)})
            return
        edges = [-math.inf, *changes_s, math.inf]
        made = [np.full(len(times), "", object) for _ in names]
        for number in np.unique(numbers).tolist():
            own = numbers == number
            for low, high in zip(edges, edges[1:]):
                values = texts(number, low)
                here = own if len(edges) == 2 else own & (times >= low) & (times < high)
                for column, value in zip(made, values):
                    column[here] = value
        self.columns.update(zip(names, made))

    def __len__(self) -> int:
        return len(self.columns["time_s"])

    def __getitem__(self, name: str) -> Any:
        if name not in self.columns:
            raise FieldError(f"no column {name!r}; there are {', '.join(self.columns)}")
        return self.columns[name]

    def __repr__(self) -> str:
        return f"<footing.Table of {len(self)} rows: {', '.join(self.columns)}>"

    @property
    def names(self) -> List[str]:
        return list(self.columns)

    def unit(self, name: str) -> str:
        """Unit of a column, from its name: "m/s^2" of specific_force_mps2_x; empty without one."""
        return next((_UNITS[word] for word in reversed(name.split("_")) if word in _UNITS), "")

    def where(self, role: Optional[str] = None, device: Optional[str] = None, keep: Any = None) -> "Table":
        """Rows of a role ("left_hand"), of a device (its "rig/role" or serial), or where `keep` is true."""
        if role is None and device is not None:
            rows = zip(self["device_rig"], self["device_role"], self["device_serial"])
            keep = [device in (f"{rig}/{own}", serial) for rig, own, serial in rows]
        elif role is not None:
            if "device_role" in self.columns:
                keep = [own == role for own in self["device_role"]]
            else:
                number = device_pb2.DeviceRole.Value("DEVICE_ROLE_" + role.upper())
                keep = [own == number for own in self["role"]]
        if np is not None:
            keep = np.asarray(keep, bool)
            return Table({name: values[keep] for name, values in self.columns.items()}, self._enums)
        chosen = [i for i, one in enumerate(keep) if one]
        return Table({name: [values[i] for i in chosen] for name, values in self.columns.items()}, self._enums)

    def array(self, fields: Sequence[str], rate_hz: Optional[float] = None) -> Any:
        """The columns side by side, rows by fields, as doubles; with `rate_hz` at an even rate."""
        need_numpy("an array")
        table = self.resample(rate_hz) if rate_hz else self
        return np.column_stack([np.asarray(table[name], float) for name in fields])

    def resample(self, rate_hz: float) -> "Table":
        """At an even rate from the first row to the last, linearly between rows; flags and numbers as they were before."""
        need_numpy("resampling")
        if "device" in self.columns and len(np.unique(self["device"])) > 1:
            raise ValueError("rows of several devices do not have one rate: choose one with role= or device=")
        order = np.argsort(self["time_s"], kind="stable")
        time_s = np.asarray(self["time_s"])[order]
        even = np.arange(time_s[0], time_s[-1], 1 / rate_hz) if len(time_s) else time_s
        before = np.clip(np.searchsorted(time_s, even, "right") - 1, 0, None)
        columns = {name: np.interp(even, time_s, values[order]) if values.dtype.kind == "f" else values[order][before]
                   for name, values in self.columns.items()}
        return Table({**columns, "time_s": even}, self._enums)

    def frame(self) -> Any:
        """As a pandas DataFrame; enums are their names."""
        try:
            import pandas
        except ImportError as error:
            raise ImportError("a data frame needs pandas: apt install python3-pandas, or pip install pandas") from error
        data = {}
        for name, values in self.columns.items():
            enum = self._enums.get(name)
            if enum is not None:
                first = len(enum.values_by_number[0].name) - len("UNSPECIFIED")
                known = {number: value.name[first:].lower() for number, value in enum.values_by_number.items()}
                known[0] = ""
                values = pandas.Categorical([known.get(one, str(one)) for one in values])
            elif name.startswith("device_"):
                values = pandas.Categorical(values)
            data[name] = values
        return pandas.DataFrame(data)


def _message_type(channel: str) -> Any:
    return session_pb2.Tick.DESCRIPTOR.fields_by_name[channel].message_type


def _row_type(channel: str) -> Any:
    message = _message_type(channel)
    return message.fields_by_name[ROWS[channel]].message_type if channel in ROWS else message


def _no_rows(descriptor: Any, column: Callable[[str, int], Any], prefix: str = "") -> Dict[str, Any]:
    """Columns of no rows: a block in which nothing came has them, too."""
    found = {}
    for field in descriptor.fields:
        if not _repeated(field):
            found.update(_no_rows(field.message_type, column, f"{prefix}{field.name}_") if field.message_type else
                         {prefix + field.name: column(_kind(field), 0)})
    return found


def _enums_of(channel: str) -> Dict[str, Any]:
    """Enums of a row's own fields by their column."""
    return {field.name: field.enum_type for field in _row_type(channel).fields if field.enum_type and not _repeated(field)}
