from footing.v1 import character_pb2 as _character_pb2
from footing.v1 import command_pb2 as _command_pb2
from footing.v1 import device_pb2 as _device_pb2
from footing.v1 import game_pb2 as _game_pb2
from footing.v1 import sensor_pb2 as _sensor_pb2
from footing.v1 import stats_pb2 as _stats_pb2
from footing.v1 import study_pb2 as _study_pb2
from google.protobuf.internal import containers as _containers
from google.protobuf.internal import enum_type_wrapper as _enum_type_wrapper
from google.protobuf import descriptor as _descriptor
from google.protobuf import message as _message
from typing import ClassVar as _ClassVar, Iterable as _Iterable, Mapping as _Mapping, Optional as _Optional, Union as _Union

DESCRIPTOR: _descriptor.FileDescriptor
QUEUE_POLICY_DROP_OLDEST: QueuePolicy
QUEUE_POLICY_LATEST: QueuePolicy
QUEUE_POLICY_RELIABLE: QueuePolicy
QUEUE_POLICY_UNSPECIFIED: QueuePolicy
ROLE_ADMIN: Role
ROLE_CONTROL: Role
ROLE_LOG: Role
ROLE_UNSPECIFIED: Role
ROLE_VIEW: Role

class Envelope(_message.Message):
    __slots__ = ["command", "command_result", "device", "gap", "goodbye", "hello", "notice", "ping", "pong", "refill", "refused", "subscribe", "subscribed", "tick", "welcome"]
    COMMAND_FIELD_NUMBER: _ClassVar[int]
    COMMAND_RESULT_FIELD_NUMBER: _ClassVar[int]
    DEVICE_FIELD_NUMBER: _ClassVar[int]
    GAP_FIELD_NUMBER: _ClassVar[int]
    GOODBYE_FIELD_NUMBER: _ClassVar[int]
    HELLO_FIELD_NUMBER: _ClassVar[int]
    NOTICE_FIELD_NUMBER: _ClassVar[int]
    PING_FIELD_NUMBER: _ClassVar[int]
    PONG_FIELD_NUMBER: _ClassVar[int]
    REFILL_FIELD_NUMBER: _ClassVar[int]
    REFUSED_FIELD_NUMBER: _ClassVar[int]
    SUBSCRIBED_FIELD_NUMBER: _ClassVar[int]
    SUBSCRIBE_FIELD_NUMBER: _ClassVar[int]
    TICK_FIELD_NUMBER: _ClassVar[int]
    WELCOME_FIELD_NUMBER: _ClassVar[int]
    command: _command_pb2.Command
    command_result: _command_pb2.CommandResult
    device: _device_pb2.DeviceEnvelope
    gap: Gap
    goodbye: Goodbye
    hello: Hello
    notice: Notice
    ping: Ping
    pong: Pong
    refill: Refill
    refused: Refused
    subscribe: Subscribe
    subscribed: Subscribed
    tick: Tick
    welcome: Welcome
    def __init__(self, hello: _Optional[_Union[Hello, _Mapping]] = ..., welcome: _Optional[_Union[Welcome, _Mapping]] = ..., refused: _Optional[_Union[Refused, _Mapping]] = ..., subscribe: _Optional[_Union[Subscribe, _Mapping]] = ..., subscribed: _Optional[_Union[Subscribed, _Mapping]] = ..., ping: _Optional[_Union[Ping, _Mapping]] = ..., pong: _Optional[_Union[Pong, _Mapping]] = ..., command: _Optional[_Union[_command_pb2.Command, _Mapping]] = ..., command_result: _Optional[_Union[_command_pb2.CommandResult, _Mapping]] = ..., goodbye: _Optional[_Union[Goodbye, _Mapping]] = ..., refill: _Optional[_Union[Refill, _Mapping]] = ..., notice: _Optional[_Union[Notice, _Mapping]] = ..., device: _Optional[_Union[_device_pb2.DeviceEnvelope, _Mapping]] = ..., tick: _Optional[_Union[Tick, _Mapping]] = ..., gap: _Optional[_Union[Gap, _Mapping]] = ...) -> None: ...

class Gap(_message.Message):
    __slots__ = ["from_sequence", "reason", "to_sequence"]
    class Reason(int, metaclass=_enum_type_wrapper.EnumTypeWrapper):
        __slots__ = []
    FROM_SEQUENCE_FIELD_NUMBER: _ClassVar[int]
    REASON_DAMAGED: Gap.Reason
    REASON_FIELD_NUMBER: _ClassVar[int]
    REASON_NEW_EPOCH: Gap.Reason
    REASON_QUEUE_FULL: Gap.Reason
    REASON_RING_PASSED: Gap.Reason
    REASON_UNSPECIFIED: Gap.Reason
    TO_SEQUENCE_FIELD_NUMBER: _ClassVar[int]
    from_sequence: int
    reason: Gap.Reason
    to_sequence: int
    def __init__(self, from_sequence: _Optional[int] = ..., to_sequence: _Optional[int] = ..., reason: _Optional[_Union[Gap.Reason, str]] = ...) -> None: ...

class Goodbye(_message.Message):
    __slots__ = ["reason"]
    REASON_FIELD_NUMBER: _ClassVar[int]
    reason: str
    def __init__(self, reason: _Optional[str] = ...) -> None: ...

class Hello(_message.Message):
    __slots__ = ["client_name", "protocol_major", "protocol_minor", "role", "token", "wanted_capabilities"]
    CLIENT_NAME_FIELD_NUMBER: _ClassVar[int]
    PROTOCOL_MAJOR_FIELD_NUMBER: _ClassVar[int]
    PROTOCOL_MINOR_FIELD_NUMBER: _ClassVar[int]
    ROLE_FIELD_NUMBER: _ClassVar[int]
    TOKEN_FIELD_NUMBER: _ClassVar[int]
    WANTED_CAPABILITIES_FIELD_NUMBER: _ClassVar[int]
    client_name: str
    protocol_major: int
    protocol_minor: int
    role: Role
    token: str
    wanted_capabilities: _containers.RepeatedScalarFieldContainer[str]
    def __init__(self, protocol_major: _Optional[int] = ..., protocol_minor: _Optional[int] = ..., role: _Optional[_Union[Role, str]] = ..., token: _Optional[str] = ..., client_name: _Optional[str] = ..., wanted_capabilities: _Optional[_Iterable[str]] = ...) -> None: ...

class Limits(_message.Message):
    __slots__ = ["max_message_burst", "max_message_in_bytes", "max_message_out_bytes", "max_messages_per_s", "max_queue_ticks", "ring_s", "tick_rate_hz"]
    MAX_MESSAGES_PER_S_FIELD_NUMBER: _ClassVar[int]
    MAX_MESSAGE_BURST_FIELD_NUMBER: _ClassVar[int]
    MAX_MESSAGE_IN_BYTES_FIELD_NUMBER: _ClassVar[int]
    MAX_MESSAGE_OUT_BYTES_FIELD_NUMBER: _ClassVar[int]
    MAX_QUEUE_TICKS_FIELD_NUMBER: _ClassVar[int]
    RING_S_FIELD_NUMBER: _ClassVar[int]
    TICK_RATE_HZ_FIELD_NUMBER: _ClassVar[int]
    max_message_burst: int
    max_message_in_bytes: int
    max_message_out_bytes: int
    max_messages_per_s: float
    max_queue_ticks: int
    ring_s: float
    tick_rate_hz: float
    def __init__(self, max_message_in_bytes: _Optional[int] = ..., max_message_out_bytes: _Optional[int] = ..., max_queue_ticks: _Optional[int] = ..., ring_s: _Optional[float] = ..., tick_rate_hz: _Optional[float] = ..., max_messages_per_s: _Optional[float] = ..., max_message_burst: _Optional[int] = ...) -> None: ...

class Notice(_message.Message):
    __slots__ = ["count", "kind", "text"]
    class Kind(int, metaclass=_enum_type_wrapper.EnumTypeWrapper):
        __slots__ = []
    COUNT_FIELD_NUMBER: _ClassVar[int]
    KIND_FIELD_NUMBER: _ClassVar[int]
    KIND_NOTHING_TO_REFILL: Notice.Kind
    KIND_SLOWED: Notice.Kind
    KIND_TICKS_LATE: Notice.Kind
    KIND_UNSPECIFIED: Notice.Kind
    TEXT_FIELD_NUMBER: _ClassVar[int]
    count: int
    kind: Notice.Kind
    text: str
    def __init__(self, kind: _Optional[_Union[Notice.Kind, str]] = ..., text: _Optional[str] = ..., count: _Optional[int] = ...) -> None: ...

class Ping(_message.Message):
    __slots__ = ["id", "t0_ns"]
    ID_FIELD_NUMBER: _ClassVar[int]
    T0_NS_FIELD_NUMBER: _ClassVar[int]
    id: int
    t0_ns: int
    def __init__(self, id: _Optional[int] = ..., t0_ns: _Optional[int] = ...) -> None: ...

class Pong(_message.Message):
    __slots__ = ["id", "t0_ns", "t1_ns", "t2_ns"]
    ID_FIELD_NUMBER: _ClassVar[int]
    T0_NS_FIELD_NUMBER: _ClassVar[int]
    T1_NS_FIELD_NUMBER: _ClassVar[int]
    T2_NS_FIELD_NUMBER: _ClassVar[int]
    id: int
    t0_ns: int
    t1_ns: int
    t2_ns: int
    def __init__(self, id: _Optional[int] = ..., t0_ns: _Optional[int] = ..., t1_ns: _Optional[int] = ..., t2_ns: _Optional[int] = ...) -> None: ...

class Refill(_message.Message):
    __slots__ = ["from_sequence", "to_sequence"]
    FROM_SEQUENCE_FIELD_NUMBER: _ClassVar[int]
    TO_SEQUENCE_FIELD_NUMBER: _ClassVar[int]
    from_sequence: int
    to_sequence: int
    def __init__(self, from_sequence: _Optional[int] = ..., to_sequence: _Optional[int] = ...) -> None: ...

class Refused(_message.Message):
    __slots__ = ["message", "reason"]
    class Reason(int, metaclass=_enum_type_wrapper.EnumTypeWrapper):
        __slots__ = []
    MESSAGE_FIELD_NUMBER: _ClassVar[int]
    REASON_BAD_MESSAGE: Refused.Reason
    REASON_FIELD_NUMBER: _ClassVar[int]
    REASON_HELLO_TIMEOUT: Refused.Reason
    REASON_PROTOCOL_VERSION: Refused.Reason
    REASON_ROLE: Refused.Reason
    REASON_TOKEN: Refused.Reason
    REASON_TOO_MANY_SESSIONS: Refused.Reason
    REASON_UNSPECIFIED: Refused.Reason
    message: str
    reason: Refused.Reason
    def __init__(self, reason: _Optional[_Union[Refused.Reason, str]] = ..., message: _Optional[str] = ...) -> None: ...

class Subscribe(_message.Message):
    __slots__ = ["channels", "from_epoch", "from_sequence", "max_hz", "policy", "queue_ticks"]
    CHANNELS_FIELD_NUMBER: _ClassVar[int]
    FROM_EPOCH_FIELD_NUMBER: _ClassVar[int]
    FROM_SEQUENCE_FIELD_NUMBER: _ClassVar[int]
    MAX_HZ_FIELD_NUMBER: _ClassVar[int]
    POLICY_FIELD_NUMBER: _ClassVar[int]
    QUEUE_TICKS_FIELD_NUMBER: _ClassVar[int]
    channels: _containers.RepeatedScalarFieldContainer[str]
    from_epoch: int
    from_sequence: int
    max_hz: float
    policy: QueuePolicy
    queue_ticks: int
    def __init__(self, channels: _Optional[_Iterable[str]] = ..., max_hz: _Optional[float] = ..., policy: _Optional[_Union[QueuePolicy, str]] = ..., queue_ticks: _Optional[int] = ..., from_sequence: _Optional[int] = ..., from_epoch: _Optional[int] = ...) -> None: ...

class Subscribed(_message.Message):
    __slots__ = ["channels", "first_sequence", "max_hz", "policy", "queue_ticks", "unknown_channels"]
    CHANNELS_FIELD_NUMBER: _ClassVar[int]
    FIRST_SEQUENCE_FIELD_NUMBER: _ClassVar[int]
    MAX_HZ_FIELD_NUMBER: _ClassVar[int]
    POLICY_FIELD_NUMBER: _ClassVar[int]
    QUEUE_TICKS_FIELD_NUMBER: _ClassVar[int]
    UNKNOWN_CHANNELS_FIELD_NUMBER: _ClassVar[int]
    channels: _containers.RepeatedScalarFieldContainer[str]
    first_sequence: int
    max_hz: float
    policy: QueuePolicy
    queue_ticks: int
    unknown_channels: _containers.RepeatedScalarFieldContainer[str]
    def __init__(self, channels: _Optional[_Iterable[str]] = ..., max_hz: _Optional[float] = ..., policy: _Optional[_Union[QueuePolicy, str]] = ..., queue_ticks: _Optional[int] = ..., first_sequence: _Optional[int] = ..., unknown_channels: _Optional[_Iterable[str]] = ...) -> None: ...

class Tick(_message.Message):
    __slots__ = ["boards", "boards_uniform", "camera", "characters", "config", "contacts", "epoch", "events", "features", "game", "gamepad", "hands", "host_ns", "inputs", "motion", "nunchuk", "raw", "reference", "refilled", "sequence", "setup", "skeletons", "snapshot", "stats", "status", "study", "track"]
    BOARDS_FIELD_NUMBER: _ClassVar[int]
    BOARDS_UNIFORM_FIELD_NUMBER: _ClassVar[int]
    CAMERA_FIELD_NUMBER: _ClassVar[int]
    CHARACTERS_FIELD_NUMBER: _ClassVar[int]
    CONFIG_FIELD_NUMBER: _ClassVar[int]
    CONTACTS_FIELD_NUMBER: _ClassVar[int]
    EPOCH_FIELD_NUMBER: _ClassVar[int]
    EVENTS_FIELD_NUMBER: _ClassVar[int]
    FEATURES_FIELD_NUMBER: _ClassVar[int]
    GAMEPAD_FIELD_NUMBER: _ClassVar[int]
    GAME_FIELD_NUMBER: _ClassVar[int]
    HANDS_FIELD_NUMBER: _ClassVar[int]
    HOST_NS_FIELD_NUMBER: _ClassVar[int]
    INPUTS_FIELD_NUMBER: _ClassVar[int]
    MOTION_FIELD_NUMBER: _ClassVar[int]
    NUNCHUK_FIELD_NUMBER: _ClassVar[int]
    RAW_FIELD_NUMBER: _ClassVar[int]
    REFERENCE_FIELD_NUMBER: _ClassVar[int]
    REFILLED_FIELD_NUMBER: _ClassVar[int]
    SEQUENCE_FIELD_NUMBER: _ClassVar[int]
    SETUP_FIELD_NUMBER: _ClassVar[int]
    SKELETONS_FIELD_NUMBER: _ClassVar[int]
    SNAPSHOT_FIELD_NUMBER: _ClassVar[int]
    STATS_FIELD_NUMBER: _ClassVar[int]
    STATUS_FIELD_NUMBER: _ClassVar[int]
    STUDY_FIELD_NUMBER: _ClassVar[int]
    TRACK_FIELD_NUMBER: _ClassVar[int]
    boards: _sensor_pb2.BoardSamples
    boards_uniform: _sensor_pb2.UniformBoardSamples
    camera: _sensor_pb2.CameraSamples
    characters: _character_pb2.CharacterFrame
    config: _character_pb2.EffectiveConfig
    contacts: _sensor_pb2.ContactSamples
    epoch: int
    events: _character_pb2.Events
    features: _sensor_pb2.FeatureFrame
    game: _game_pb2.GameState
    gamepad: _sensor_pb2.GamepadSamples
    hands: _sensor_pb2.HandSamples
    host_ns: int
    inputs: _character_pb2.AppliedInputs
    motion: _sensor_pb2.MotionSamples
    nunchuk: _sensor_pb2.NunchukSamples
    raw: _device_pb2.RawReports
    reference: _sensor_pb2.ReferencePoses
    refilled: bool
    sequence: int
    setup: _sensor_pb2.SetupState
    skeletons: _character_pb2.Skeletons
    snapshot: bool
    stats: _stats_pb2.ServerStats
    status: _device_pb2.DeviceStatusList
    study: _study_pb2.StudyState
    track: _character_pb2.Track
    def __init__(self, epoch: _Optional[int] = ..., sequence: _Optional[int] = ..., host_ns: _Optional[int] = ..., snapshot: bool = ..., refilled: bool = ..., status: _Optional[_Union[_device_pb2.DeviceStatusList, _Mapping]] = ..., motion: _Optional[_Union[_sensor_pb2.MotionSamples, _Mapping]] = ..., features: _Optional[_Union[_sensor_pb2.FeatureFrame, _Mapping]] = ..., boards: _Optional[_Union[_sensor_pb2.BoardSamples, _Mapping]] = ..., raw: _Optional[_Union[_device_pb2.RawReports, _Mapping]] = ..., nunchuk: _Optional[_Union[_sensor_pb2.NunchukSamples, _Mapping]] = ..., camera: _Optional[_Union[_sensor_pb2.CameraSamples, _Mapping]] = ..., boards_uniform: _Optional[_Union[_sensor_pb2.UniformBoardSamples, _Mapping]] = ..., skeletons: _Optional[_Union[_character_pb2.Skeletons, _Mapping]] = ..., track: _Optional[_Union[_character_pb2.Track, _Mapping]] = ..., characters: _Optional[_Union[_character_pb2.CharacterFrame, _Mapping]] = ..., events: _Optional[_Union[_character_pb2.Events, _Mapping]] = ..., inputs: _Optional[_Union[_character_pb2.AppliedInputs, _Mapping]] = ..., setup: _Optional[_Union[_sensor_pb2.SetupState, _Mapping]] = ..., hands: _Optional[_Union[_sensor_pb2.HandSamples, _Mapping]] = ..., reference: _Optional[_Union[_sensor_pb2.ReferencePoses, _Mapping]] = ..., contacts: _Optional[_Union[_sensor_pb2.ContactSamples, _Mapping]] = ..., gamepad: _Optional[_Union[_sensor_pb2.GamepadSamples, _Mapping]] = ..., config: _Optional[_Union[_character_pb2.EffectiveConfig, _Mapping]] = ..., study: _Optional[_Union[_study_pb2.StudyState, _Mapping]] = ..., game: _Optional[_Union[_game_pb2.GameState, _Mapping]] = ..., stats: _Optional[_Union[_stats_pb2.ServerStats, _Mapping]] = ...) -> None: ...

class Welcome(_message.Message):
    __slots__ = ["capabilities", "channels", "epoch", "granted_role", "host_ns", "limits", "protocol_major", "protocol_minor", "server_id", "version", "wall_time_ns"]
    CAPABILITIES_FIELD_NUMBER: _ClassVar[int]
    CHANNELS_FIELD_NUMBER: _ClassVar[int]
    EPOCH_FIELD_NUMBER: _ClassVar[int]
    GRANTED_ROLE_FIELD_NUMBER: _ClassVar[int]
    HOST_NS_FIELD_NUMBER: _ClassVar[int]
    LIMITS_FIELD_NUMBER: _ClassVar[int]
    PROTOCOL_MAJOR_FIELD_NUMBER: _ClassVar[int]
    PROTOCOL_MINOR_FIELD_NUMBER: _ClassVar[int]
    SERVER_ID_FIELD_NUMBER: _ClassVar[int]
    VERSION_FIELD_NUMBER: _ClassVar[int]
    WALL_TIME_NS_FIELD_NUMBER: _ClassVar[int]
    capabilities: _containers.RepeatedScalarFieldContainer[str]
    channels: _containers.RepeatedScalarFieldContainer[str]
    epoch: int
    granted_role: Role
    host_ns: int
    limits: Limits
    protocol_major: int
    protocol_minor: int
    server_id: str
    version: str
    wall_time_ns: int
    def __init__(self, server_id: _Optional[str] = ..., epoch: _Optional[int] = ..., protocol_major: _Optional[int] = ..., protocol_minor: _Optional[int] = ..., granted_role: _Optional[_Union[Role, str]] = ..., capabilities: _Optional[_Iterable[str]] = ..., channels: _Optional[_Iterable[str]] = ..., limits: _Optional[_Union[Limits, _Mapping]] = ..., host_ns: _Optional[int] = ..., wall_time_ns: _Optional[int] = ..., version: _Optional[str] = ...) -> None: ...

class Role(int, metaclass=_enum_type_wrapper.EnumTypeWrapper):
    __slots__ = []

class QueuePolicy(int, metaclass=_enum_type_wrapper.EnumTypeWrapper):
    __slots__ = []
