from footing.v1 import device_pb2 as _device_pb2
from google.protobuf.internal import containers as _containers
from google.protobuf import descriptor as _descriptor
from google.protobuf import message as _message
from typing import ClassVar as _ClassVar, Iterable as _Iterable, Mapping as _Mapping, Optional as _Optional, Union as _Union

DESCRIPTOR: _descriptor.FileDescriptor

class DeviceStats(_message.Message):
    __slots__ = ["battery_fraction", "device", "gaps", "jitter_s", "kind", "queue_drops", "report_rate_hz", "reports", "rig", "role", "serial", "simulated", "state", "undecodable", "writes_failed"]
    BATTERY_FRACTION_FIELD_NUMBER: _ClassVar[int]
    DEVICE_FIELD_NUMBER: _ClassVar[int]
    GAPS_FIELD_NUMBER: _ClassVar[int]
    JITTER_S_FIELD_NUMBER: _ClassVar[int]
    KIND_FIELD_NUMBER: _ClassVar[int]
    QUEUE_DROPS_FIELD_NUMBER: _ClassVar[int]
    REPORTS_FIELD_NUMBER: _ClassVar[int]
    REPORT_RATE_HZ_FIELD_NUMBER: _ClassVar[int]
    RIG_FIELD_NUMBER: _ClassVar[int]
    ROLE_FIELD_NUMBER: _ClassVar[int]
    SERIAL_FIELD_NUMBER: _ClassVar[int]
    SIMULATED_FIELD_NUMBER: _ClassVar[int]
    STATE_FIELD_NUMBER: _ClassVar[int]
    UNDECODABLE_FIELD_NUMBER: _ClassVar[int]
    WRITES_FAILED_FIELD_NUMBER: _ClassVar[int]
    battery_fraction: float
    device: int
    gaps: int
    jitter_s: float
    kind: _device_pb2.DeviceKind
    queue_drops: int
    report_rate_hz: float
    reports: int
    rig: str
    role: _device_pb2.DeviceRole
    serial: str
    simulated: bool
    state: _device_pb2.DeviceState
    undecodable: int
    writes_failed: int
    def __init__(self, device: _Optional[int] = ..., serial: _Optional[str] = ..., kind: _Optional[_Union[_device_pb2.DeviceKind, str]] = ..., state: _Optional[_Union[_device_pb2.DeviceState, str]] = ..., rig: _Optional[str] = ..., role: _Optional[_Union[_device_pb2.DeviceRole, str]] = ..., simulated: bool = ..., report_rate_hz: _Optional[float] = ..., jitter_s: _Optional[float] = ..., reports: _Optional[int] = ..., gaps: _Optional[int] = ..., queue_drops: _Optional[int] = ..., undecodable: _Optional[int] = ..., writes_failed: _Optional[int] = ..., battery_fraction: _Optional[float] = ...) -> None: ...

class ServerStats(_message.Message):
    __slots__ = ["channels_left_out", "devices", "ring_bytes", "session_count", "sessions", "sessions_accepted", "sessions_refused", "slowed", "ticks", "ticks_dropped", "uptime_s"]
    CHANNELS_LEFT_OUT_FIELD_NUMBER: _ClassVar[int]
    DEVICES_FIELD_NUMBER: _ClassVar[int]
    RING_BYTES_FIELD_NUMBER: _ClassVar[int]
    SESSIONS_ACCEPTED_FIELD_NUMBER: _ClassVar[int]
    SESSIONS_FIELD_NUMBER: _ClassVar[int]
    SESSIONS_REFUSED_FIELD_NUMBER: _ClassVar[int]
    SESSION_COUNT_FIELD_NUMBER: _ClassVar[int]
    SLOWED_FIELD_NUMBER: _ClassVar[int]
    TICKS_DROPPED_FIELD_NUMBER: _ClassVar[int]
    TICKS_FIELD_NUMBER: _ClassVar[int]
    UPTIME_S_FIELD_NUMBER: _ClassVar[int]
    channels_left_out: int
    devices: _containers.RepeatedCompositeFieldContainer[DeviceStats]
    ring_bytes: int
    session_count: int
    sessions: _containers.RepeatedCompositeFieldContainer[SessionStats]
    sessions_accepted: int
    sessions_refused: int
    slowed: int
    ticks: TickStats
    ticks_dropped: int
    uptime_s: float
    def __init__(self, uptime_s: _Optional[float] = ..., ticks: _Optional[_Union[TickStats, _Mapping]] = ..., session_count: _Optional[int] = ..., sessions_accepted: _Optional[int] = ..., sessions_refused: _Optional[int] = ..., ticks_dropped: _Optional[int] = ..., slowed: _Optional[int] = ..., channels_left_out: _Optional[int] = ..., ring_bytes: _Optional[int] = ..., sessions: _Optional[_Iterable[_Union[SessionStats, _Mapping]]] = ..., devices: _Optional[_Iterable[_Union[DeviceStats, _Mapping]]] = ...) -> None: ...

class SessionStats(_message.Message):
    __slots__ = ["client_name", "clock_offset_s", "clock_uncertainty_s", "clock_valid", "connected_s", "lag_s", "local", "policy", "queue_capacity", "queue_ticks", "role", "session", "slowed", "ticks_dropped", "ticks_sent"]
    CLIENT_NAME_FIELD_NUMBER: _ClassVar[int]
    CLOCK_OFFSET_S_FIELD_NUMBER: _ClassVar[int]
    CLOCK_UNCERTAINTY_S_FIELD_NUMBER: _ClassVar[int]
    CLOCK_VALID_FIELD_NUMBER: _ClassVar[int]
    CONNECTED_S_FIELD_NUMBER: _ClassVar[int]
    LAG_S_FIELD_NUMBER: _ClassVar[int]
    LOCAL_FIELD_NUMBER: _ClassVar[int]
    POLICY_FIELD_NUMBER: _ClassVar[int]
    QUEUE_CAPACITY_FIELD_NUMBER: _ClassVar[int]
    QUEUE_TICKS_FIELD_NUMBER: _ClassVar[int]
    ROLE_FIELD_NUMBER: _ClassVar[int]
    SESSION_FIELD_NUMBER: _ClassVar[int]
    SLOWED_FIELD_NUMBER: _ClassVar[int]
    TICKS_DROPPED_FIELD_NUMBER: _ClassVar[int]
    TICKS_SENT_FIELD_NUMBER: _ClassVar[int]
    client_name: str
    clock_offset_s: float
    clock_uncertainty_s: float
    clock_valid: bool
    connected_s: float
    lag_s: float
    local: bool
    policy: str
    queue_capacity: int
    queue_ticks: int
    role: str
    session: int
    slowed: int
    ticks_dropped: int
    ticks_sent: int
    def __init__(self, session: _Optional[int] = ..., client_name: _Optional[str] = ..., role: _Optional[str] = ..., local: bool = ..., connected_s: _Optional[float] = ..., policy: _Optional[str] = ..., queue_ticks: _Optional[int] = ..., queue_capacity: _Optional[int] = ..., lag_s: _Optional[float] = ..., ticks_sent: _Optional[int] = ..., ticks_dropped: _Optional[int] = ..., slowed: _Optional[int] = ..., clock_valid: bool = ..., clock_offset_s: _Optional[float] = ..., clock_uncertainty_s: _Optional[float] = ...) -> None: ...

class TickStats(_message.Message):
    __slots__ = ["late_max_s", "left_out", "overruns", "rate_hz", "ticks"]
    LATE_MAX_S_FIELD_NUMBER: _ClassVar[int]
    LEFT_OUT_FIELD_NUMBER: _ClassVar[int]
    OVERRUNS_FIELD_NUMBER: _ClassVar[int]
    RATE_HZ_FIELD_NUMBER: _ClassVar[int]
    TICKS_FIELD_NUMBER: _ClassVar[int]
    late_max_s: float
    left_out: int
    overruns: int
    rate_hz: float
    ticks: int
    def __init__(self, ticks: _Optional[int] = ..., rate_hz: _Optional[float] = ..., late_max_s: _Optional[float] = ..., overruns: _Optional[int] = ..., left_out: _Optional[int] = ...) -> None: ...
