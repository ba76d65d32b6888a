from footing.v1 import character_pb2 as _character_pb2
from footing.v1 import device_pb2 as _device_pb2
from footing.v1 import game_pb2 as _game_pb2
from footing.v1 import sensor_pb2 as _sensor_pb2
from footing.v1 import stats_pb2 as _stats_pb2
from footing.v1 import study_pb2 as _study_pb2
from google.protobuf.internal import containers as _containers
from google.protobuf import descriptor as _descriptor
from google.protobuf import message as _message
from typing import ClassVar as _ClassVar, Iterable as _Iterable, Mapping as _Mapping, Optional as _Optional, Union as _Union

DESCRIPTOR: _descriptor.FileDescriptor

class AppendSegment(_message.Message):
    __slots__ = ["curve_rad", "length_m", "pit", "slope_rad", "step_m"]
    CURVE_RAD_FIELD_NUMBER: _ClassVar[int]
    LENGTH_M_FIELD_NUMBER: _ClassVar[int]
    PIT_FIELD_NUMBER: _ClassVar[int]
    SLOPE_RAD_FIELD_NUMBER: _ClassVar[int]
    STEP_M_FIELD_NUMBER: _ClassVar[int]
    curve_rad: float
    length_m: float
    pit: bool
    slope_rad: float
    step_m: float
    def __init__(self, length_m: _Optional[float] = ..., slope_rad: _Optional[float] = ..., curve_rad: _Optional[float] = ..., step_m: _Optional[float] = ..., pit: bool = ...) -> None: ...

class AssignRole(_message.Message):
    __slots__ = ["rig", "role", "serial"]
    RIG_FIELD_NUMBER: _ClassVar[int]
    ROLE_FIELD_NUMBER: _ClassVar[int]
    SERIAL_FIELD_NUMBER: _ClassVar[int]
    rig: str
    role: _device_pb2.DeviceRole
    serial: str
    def __init__(self, serial: _Optional[str] = ..., rig: _Optional[str] = ..., role: _Optional[_Union[_device_pb2.DeviceRole, str]] = ...) -> None: ...

class CalibrateTPose(_message.Message):
    __slots__ = ["character"]
    CHARACTER_FIELD_NUMBER: _ClassVar[int]
    character: int
    def __init__(self, character: _Optional[int] = ...) -> None: ...

class Command(_message.Message):
    __slots__ = ["append_segment", "assign_role", "calibrate_t_pose", "correct_failure", "deadline_ms", "direct_gait", "end_sessions", "id", "list_sessions", "marker", "push", "put_back", "record_setup", "release_lease", "request_device_status", "set_board_layout", "set_camera", "set_game", "set_interface", "set_leds", "set_pose_mode", "set_rumble", "set_sphere", "set_study", "set_subject", "show_prompt", "solve_mounting", "start_trial", "stop_trial", "take_lease", "tare"]
    APPEND_SEGMENT_FIELD_NUMBER: _ClassVar[int]
    ASSIGN_ROLE_FIELD_NUMBER: _ClassVar[int]
    CALIBRATE_T_POSE_FIELD_NUMBER: _ClassVar[int]
    CORRECT_FAILURE_FIELD_NUMBER: _ClassVar[int]
    DEADLINE_MS_FIELD_NUMBER: _ClassVar[int]
    DIRECT_GAIT_FIELD_NUMBER: _ClassVar[int]
    END_SESSIONS_FIELD_NUMBER: _ClassVar[int]
    ID_FIELD_NUMBER: _ClassVar[int]
    LIST_SESSIONS_FIELD_NUMBER: _ClassVar[int]
    MARKER_FIELD_NUMBER: _ClassVar[int]
    PUSH_FIELD_NUMBER: _ClassVar[int]
    PUT_BACK_FIELD_NUMBER: _ClassVar[int]
    RECORD_SETUP_FIELD_NUMBER: _ClassVar[int]
    RELEASE_LEASE_FIELD_NUMBER: _ClassVar[int]
    REQUEST_DEVICE_STATUS_FIELD_NUMBER: _ClassVar[int]
    SET_BOARD_LAYOUT_FIELD_NUMBER: _ClassVar[int]
    SET_CAMERA_FIELD_NUMBER: _ClassVar[int]
    SET_GAME_FIELD_NUMBER: _ClassVar[int]
    SET_INTERFACE_FIELD_NUMBER: _ClassVar[int]
    SET_LEDS_FIELD_NUMBER: _ClassVar[int]
    SET_POSE_MODE_FIELD_NUMBER: _ClassVar[int]
    SET_RUMBLE_FIELD_NUMBER: _ClassVar[int]
    SET_SPHERE_FIELD_NUMBER: _ClassVar[int]
    SET_STUDY_FIELD_NUMBER: _ClassVar[int]
    SET_SUBJECT_FIELD_NUMBER: _ClassVar[int]
    SHOW_PROMPT_FIELD_NUMBER: _ClassVar[int]
    SOLVE_MOUNTING_FIELD_NUMBER: _ClassVar[int]
    START_TRIAL_FIELD_NUMBER: _ClassVar[int]
    STOP_TRIAL_FIELD_NUMBER: _ClassVar[int]
    TAKE_LEASE_FIELD_NUMBER: _ClassVar[int]
    TARE_FIELD_NUMBER: _ClassVar[int]
    append_segment: AppendSegment
    assign_role: AssignRole
    calibrate_t_pose: CalibrateTPose
    correct_failure: CorrectFailure
    deadline_ms: int
    direct_gait: DirectGait
    end_sessions: EndSessions
    id: int
    list_sessions: ListSessions
    marker: Marker
    push: Push
    put_back: PutBack
    record_setup: RecordSetup
    release_lease: ReleaseLease
    request_device_status: RequestDeviceStatus
    set_board_layout: SetBoardLayout
    set_camera: SetCamera
    set_game: SetGame
    set_interface: SetInterface
    set_leds: SetLeds
    set_pose_mode: SetPoseMode
    set_rumble: SetRumble
    set_sphere: SetSphere
    set_study: SetStudy
    set_subject: SetSubject
    show_prompt: ShowPrompt
    solve_mounting: SolveMounting
    start_trial: StartTrial
    stop_trial: StopTrial
    take_lease: TakeLease
    tare: Tare
    def __init__(self, id: _Optional[int] = ..., deadline_ms: _Optional[int] = ..., set_rumble: _Optional[_Union[SetRumble, _Mapping]] = ..., set_leds: _Optional[_Union[SetLeds, _Mapping]] = ..., assign_role: _Optional[_Union[AssignRole, _Mapping]] = ..., put_back: _Optional[_Union[PutBack, _Mapping]] = ..., push: _Optional[_Union[Push, _Mapping]] = ..., direct_gait: _Optional[_Union[DirectGait, _Mapping]] = ..., tare: _Optional[_Union[Tare, _Mapping]] = ..., solve_mounting: _Optional[_Union[SolveMounting, _Mapping]] = ..., set_board_layout: _Optional[_Union[SetBoardLayout, _Mapping]] = ..., record_setup: _Optional[_Union[RecordSetup, _Mapping]] = ..., set_sphere: _Optional[_Union[SetSphere, _Mapping]] = ..., set_camera: _Optional[_Union[SetCamera, _Mapping]] = ..., request_device_status: _Optional[_Union[RequestDeviceStatus, _Mapping]] = ..., append_segment: _Optional[_Union[AppendSegment, _Mapping]] = ..., calibrate_t_pose: _Optional[_Union[CalibrateTPose, _Mapping]] = ..., set_subject: _Optional[_Union[SetSubject, _Mapping]] = ..., set_pose_mode: _Optional[_Union[SetPoseMode, _Mapping]] = ..., start_trial: _Optional[_Union[StartTrial, _Mapping]] = ..., stop_trial: _Optional[_Union[StopTrial, _Mapping]] = ..., correct_failure: _Optional[_Union[CorrectFailure, _Mapping]] = ..., set_interface: _Optional[_Union[SetInterface, _Mapping]] = ..., take_lease: _Optional[_Union[TakeLease, _Mapping]] = ..., release_lease: _Optional[_Union[ReleaseLease, _Mapping]] = ..., set_study: _Optional[_Union[SetStudy, _Mapping]] = ..., list_sessions: _Optional[_Union[ListSessions, _Mapping]] = ..., end_sessions: _Optional[_Union[EndSessions, _Mapping]] = ..., show_prompt: _Optional[_Union[ShowPrompt, _Mapping]] = ..., set_game: _Optional[_Union[SetGame, _Mapping]] = ..., marker: _Optional[_Union[Marker, _Mapping]] = ...) -> None: ...

class CommandResult(_message.Message):
    __slots__ = ["id", "message", "more_sessions", "ok", "residual", "sessions", "unit"]
    ID_FIELD_NUMBER: _ClassVar[int]
    MESSAGE_FIELD_NUMBER: _ClassVar[int]
    MORE_SESSIONS_FIELD_NUMBER: _ClassVar[int]
    OK_FIELD_NUMBER: _ClassVar[int]
    RESIDUAL_FIELD_NUMBER: _ClassVar[int]
    SESSIONS_FIELD_NUMBER: _ClassVar[int]
    UNIT_FIELD_NUMBER: _ClassVar[int]
    id: int
    message: str
    more_sessions: bool
    ok: bool
    residual: float
    sessions: _containers.RepeatedCompositeFieldContainer[ConnectedSession]
    unit: str
    def __init__(self, id: _Optional[int] = ..., ok: bool = ..., message: _Optional[str] = ..., residual: _Optional[float] = ..., unit: _Optional[str] = ..., sessions: _Optional[_Iterable[_Union[ConnectedSession, _Mapping]]] = ..., more_sessions: bool = ...) -> None: ...

class ConnectedSession(_message.Message):
    __slots__ = ["certificate", "granted_by", "host", "own", "stats", "user"]
    CERTIFICATE_FIELD_NUMBER: _ClassVar[int]
    GRANTED_BY_FIELD_NUMBER: _ClassVar[int]
    HOST_FIELD_NUMBER: _ClassVar[int]
    OWN_FIELD_NUMBER: _ClassVar[int]
    STATS_FIELD_NUMBER: _ClassVar[int]
    USER_FIELD_NUMBER: _ClassVar[int]
    certificate: str
    granted_by: str
    host: str
    own: bool
    stats: _stats_pb2.SessionStats
    user: int
    def __init__(self, stats: _Optional[_Union[_stats_pb2.SessionStats, _Mapping]] = ..., user: _Optional[int] = ..., host: _Optional[str] = ..., granted_by: _Optional[str] = ..., certificate: _Optional[str] = ..., own: bool = ...) -> None: ...

class CorrectFailure(_message.Message):
    __slots__ = ["failure", "reason", "restore"]
    FAILURE_FIELD_NUMBER: _ClassVar[int]
    REASON_FIELD_NUMBER: _ClassVar[int]
    RESTORE_FIELD_NUMBER: _ClassVar[int]
    failure: int
    reason: str
    restore: bool
    def __init__(self, failure: _Optional[int] = ..., restore: bool = ..., reason: _Optional[str] = ...) -> None: ...

class DirectGait(_message.Message):
    __slots__ = ["character", "gait", "height_m", "release", "speed_mps", "turn_rad"]
    CHARACTER_FIELD_NUMBER: _ClassVar[int]
    GAIT_FIELD_NUMBER: _ClassVar[int]
    HEIGHT_M_FIELD_NUMBER: _ClassVar[int]
    RELEASE_FIELD_NUMBER: _ClassVar[int]
    SPEED_MPS_FIELD_NUMBER: _ClassVar[int]
    TURN_RAD_FIELD_NUMBER: _ClassVar[int]
    character: int
    gait: _character_pb2.Gait
    height_m: float
    release: bool
    speed_mps: float
    turn_rad: float
    def __init__(self, character: _Optional[int] = ..., release: bool = ..., gait: _Optional[_Union[_character_pb2.Gait, str]] = ..., speed_mps: _Optional[float] = ..., height_m: _Optional[float] = ..., turn_rad: _Optional[float] = ...) -> None: ...

class EndSessions(_message.Message):
    __slots__ = ["reason", "sessions"]
    REASON_FIELD_NUMBER: _ClassVar[int]
    SESSIONS_FIELD_NUMBER: _ClassVar[int]
    reason: str
    sessions: _containers.RepeatedScalarFieldContainer[int]
    def __init__(self, sessions: _Optional[_Iterable[int]] = ..., reason: _Optional[str] = ...) -> None: ...

class ListSessions(_message.Message):
    __slots__ = ["after"]
    AFTER_FIELD_NUMBER: _ClassVar[int]
    after: int
    def __init__(self, after: _Optional[int] = ...) -> None: ...

class Marker(_message.Message):
    __slots__ = ["host_ns", "text", "value"]
    HOST_NS_FIELD_NUMBER: _ClassVar[int]
    TEXT_FIELD_NUMBER: _ClassVar[int]
    VALUE_FIELD_NUMBER: _ClassVar[int]
    host_ns: int
    text: str
    value: float
    def __init__(self, text: _Optional[str] = ..., value: _Optional[float] = ..., host_ns: _Optional[int] = ...) -> None: ...

class Push(_message.Message):
    __slots__ = ["character", "impulse_x_ns", "impulse_y_ns"]
    CHARACTER_FIELD_NUMBER: _ClassVar[int]
    IMPULSE_X_NS_FIELD_NUMBER: _ClassVar[int]
    IMPULSE_Y_NS_FIELD_NUMBER: _ClassVar[int]
    character: int
    impulse_x_ns: float
    impulse_y_ns: float
    def __init__(self, character: _Optional[int] = ..., impulse_x_ns: _Optional[float] = ..., impulse_y_ns: _Optional[float] = ...) -> None: ...

class PutBack(_message.Message):
    __slots__ = ["character"]
    CHARACTER_FIELD_NUMBER: _ClassVar[int]
    character: int
    def __init__(self, character: _Optional[int] = ...) -> None: ...

class RecordSetup(_message.Message):
    __slots__ = ["forget", "item", "rig"]
    FORGET_FIELD_NUMBER: _ClassVar[int]
    ITEM_FIELD_NUMBER: _ClassVar[int]
    RIG_FIELD_NUMBER: _ClassVar[int]
    forget: bool
    item: _sensor_pb2.SetupItem
    rig: str
    def __init__(self, rig: _Optional[str] = ..., item: _Optional[_Union[_sensor_pb2.SetupItem, _Mapping]] = ..., forget: bool = ...) -> None: ...

class ReleaseLease(_message.Message):
    __slots__ = []
    def __init__(self) -> None: ...

class RequestDeviceStatus(_message.Message):
    __slots__ = ["device"]
    DEVICE_FIELD_NUMBER: _ClassVar[int]
    device: int
    def __init__(self, device: _Optional[int] = ...) -> None: ...

class SetBoardLayout(_message.Message):
    __slots__ = ["layout"]
    LAYOUT_FIELD_NUMBER: _ClassVar[int]
    layout: _sensor_pb2.BoardLayout
    def __init__(self, layout: _Optional[_Union[_sensor_pb2.BoardLayout, _Mapping]] = ...) -> None: ...

class SetCamera(_message.Message):
    __slots__ = ["device", "on"]
    DEVICE_FIELD_NUMBER: _ClassVar[int]
    ON_FIELD_NUMBER: _ClassVar[int]
    device: int
    on: bool
    def __init__(self, device: _Optional[int] = ..., on: bool = ...) -> None: ...

class SetGame(_message.Message):
    __slots__ = ["game", "leave"]
    GAME_FIELD_NUMBER: _ClassVar[int]
    LEAVE_FIELD_NUMBER: _ClassVar[int]
    game: _game_pb2.GameState
    leave: bool
    def __init__(self, game: _Optional[_Union[_game_pb2.GameState, _Mapping]] = ..., leave: bool = ...) -> None: ...

class SetInterface(_message.Message):
    __slots__ = ["character", "interface", "table", "turn_by"]
    CHARACTER_FIELD_NUMBER: _ClassVar[int]
    INTERFACE_FIELD_NUMBER: _ClassVar[int]
    TABLE_FIELD_NUMBER: _ClassVar[int]
    TURN_BY_FIELD_NUMBER: _ClassVar[int]
    character: int
    interface: _character_pb2.UserInterface
    table: str
    turn_by: _character_pb2.TurnSource
    def __init__(self, character: _Optional[int] = ..., interface: _Optional[_Union[_character_pb2.UserInterface, str]] = ..., turn_by: _Optional[_Union[_character_pb2.TurnSource, str]] = ..., table: _Optional[str] = ...) -> None: ...

class SetLeds(_message.Message):
    __slots__ = ["device", "leds"]
    DEVICE_FIELD_NUMBER: _ClassVar[int]
    LEDS_FIELD_NUMBER: _ClassVar[int]
    device: int
    leds: int
    def __init__(self, device: _Optional[int] = ..., leds: _Optional[int] = ...) -> None: ...

class SetPoseMode(_message.Message):
    __slots__ = ["character", "left_out", "mode"]
    CHARACTER_FIELD_NUMBER: _ClassVar[int]
    LEFT_OUT_FIELD_NUMBER: _ClassVar[int]
    MODE_FIELD_NUMBER: _ClassVar[int]
    character: int
    left_out: _containers.RepeatedScalarFieldContainer[str]
    mode: str
    def __init__(self, character: _Optional[int] = ..., mode: _Optional[str] = ..., left_out: _Optional[_Iterable[str]] = ...) -> None: ...

class SetRumble(_message.Message):
    __slots__ = ["device", "lease_ms", "on"]
    DEVICE_FIELD_NUMBER: _ClassVar[int]
    LEASE_MS_FIELD_NUMBER: _ClassVar[int]
    ON_FIELD_NUMBER: _ClassVar[int]
    device: int
    lease_ms: int
    on: bool
    def __init__(self, device: _Optional[int] = ..., on: bool = ..., lease_ms: _Optional[int] = ...) -> None: ...

class SetSphere(_message.Message):
    __slots__ = ["device", "rgb"]
    DEVICE_FIELD_NUMBER: _ClassVar[int]
    RGB_FIELD_NUMBER: _ClassVar[int]
    device: int
    rgb: int
    def __init__(self, device: _Optional[int] = ..., rgb: _Optional[int] = ...) -> None: ...

class SetStudy(_message.Message):
    __slots__ = ["study"]
    STUDY_FIELD_NUMBER: _ClassVar[int]
    study: _study_pb2.StudyState
    def __init__(self, study: _Optional[_Union[_study_pb2.StudyState, _Mapping]] = ...) -> None: ...

class SetSubject(_message.Message):
    __slots__ = ["code", "foot_length_m", "height_m", "mass_kg"]
    CODE_FIELD_NUMBER: _ClassVar[int]
    FOOT_LENGTH_M_FIELD_NUMBER: _ClassVar[int]
    HEIGHT_M_FIELD_NUMBER: _ClassVar[int]
    MASS_KG_FIELD_NUMBER: _ClassVar[int]
    code: str
    foot_length_m: float
    height_m: float
    mass_kg: float
    def __init__(self, code: _Optional[str] = ..., height_m: _Optional[float] = ..., mass_kg: _Optional[float] = ..., foot_length_m: _Optional[float] = ...) -> None: ...

class ShowPrompt(_message.Message):
    __slots__ = ["prompt", "rig"]
    PROMPT_FIELD_NUMBER: _ClassVar[int]
    RIG_FIELD_NUMBER: _ClassVar[int]
    prompt: _sensor_pb2.SetupPrompt
    rig: str
    def __init__(self, rig: _Optional[str] = ..., prompt: _Optional[_Union[_sensor_pb2.SetupPrompt, _Mapping]] = ...) -> None: ...

class SolveMounting(_message.Message):
    __slots__ = ["clear", "serial", "steps_from_ns", "steps_to_ns", "still_from_ns", "still_to_ns"]
    CLEAR_FIELD_NUMBER: _ClassVar[int]
    SERIAL_FIELD_NUMBER: _ClassVar[int]
    STEPS_FROM_NS_FIELD_NUMBER: _ClassVar[int]
    STEPS_TO_NS_FIELD_NUMBER: _ClassVar[int]
    STILL_FROM_NS_FIELD_NUMBER: _ClassVar[int]
    STILL_TO_NS_FIELD_NUMBER: _ClassVar[int]
    clear: bool
    serial: str
    steps_from_ns: int
    steps_to_ns: int
    still_from_ns: int
    still_to_ns: int
    def __init__(self, serial: _Optional[str] = ..., still_from_ns: _Optional[int] = ..., still_to_ns: _Optional[int] = ..., steps_from_ns: _Optional[int] = ..., steps_to_ns: _Optional[int] = ..., clear: bool = ...) -> None: ...

class StartTrial(_message.Message):
    __slots__ = ["character", "seed", "task", "track", "trial"]
    CHARACTER_FIELD_NUMBER: _ClassVar[int]
    SEED_FIELD_NUMBER: _ClassVar[int]
    TASK_FIELD_NUMBER: _ClassVar[int]
    TRACK_FIELD_NUMBER: _ClassVar[int]
    TRIAL_FIELD_NUMBER: _ClassVar[int]
    character: int
    seed: int
    task: str
    track: str
    trial: str
    def __init__(self, character: _Optional[int] = ..., trial: _Optional[str] = ..., track: _Optional[str] = ..., seed: _Optional[int] = ..., task: _Optional[str] = ...) -> None: ...

class StopTrial(_message.Message):
    __slots__ = ["character", "trial"]
    CHARACTER_FIELD_NUMBER: _ClassVar[int]
    TRIAL_FIELD_NUMBER: _ClassVar[int]
    character: int
    trial: str
    def __init__(self, character: _Optional[int] = ..., trial: _Optional[str] = ...) -> None: ...

class TakeLease(_message.Message):
    __slots__ = ["holder", "renew_only", "seconds", "take_over"]
    HOLDER_FIELD_NUMBER: _ClassVar[int]
    RENEW_ONLY_FIELD_NUMBER: _ClassVar[int]
    SECONDS_FIELD_NUMBER: _ClassVar[int]
    TAKE_OVER_FIELD_NUMBER: _ClassVar[int]
    holder: str
    renew_only: bool
    seconds: float
    take_over: bool
    def __init__(self, holder: _Optional[str] = ..., seconds: _Optional[float] = ..., take_over: bool = ..., renew_only: bool = ...) -> None: ...

class Tare(_message.Message):
    __slots__ = ["clear", "serial", "window_s"]
    CLEAR_FIELD_NUMBER: _ClassVar[int]
    SERIAL_FIELD_NUMBER: _ClassVar[int]
    WINDOW_S_FIELD_NUMBER: _ClassVar[int]
    clear: bool
    serial: str
    window_s: float
    def __init__(self, serial: _Optional[str] = ..., window_s: _Optional[float] = ..., clear: bool = ...) -> None: ...
