from footing.v1 import device_pb2 as _device_pb2
from footing.v1 import sensor_pb2 as _sensor_pb2
from google.protobuf.internal import containers as _containers
from google.protobuf.internal import enum_type_wrapper as _enum_type_wrapper
from google.protobuf import descriptor as _descriptor
from google.protobuf import message as _message
from typing import ClassVar as _ClassVar, Iterable as _Iterable, Mapping as _Mapping, Optional as _Optional, Union as _Union

ACTIVITY_ABSENT: Activity
ACTIVITY_ALTERNATE: Activity
ACTIVITY_BUTTON: Activity
ACTIVITY_HEEL_RISE: Activity
ACTIVITY_OFF_BOARDS: Activity
ACTIVITY_REST: Activity
ACTIVITY_STICK: Activity
ACTIVITY_TOGETHER: Activity
ACTIVITY_UNCLEAR: Activity
ACTIVITY_UNEQUAL: Activity
ACTIVITY_UNSPECIFIED: Activity
DESCRIPTOR: _descriptor.FileDescriptor
FAILURE_CAUSE_CURVE: FailureCause
FAILURE_CAUSE_JUMP: FailureCause
FAILURE_CAUSE_SIMULATION: FailureCause
FAILURE_CAUSE_STRAIGHTNESS: FailureCause
FAILURE_CAUSE_TRANSITION: FailureCause
FAILURE_CAUSE_UNSPECIFIED: FailureCause
GAIT_JUMP: Gait
GAIT_RUN: Gait
GAIT_STEP: Gait
GAIT_UNSPECIFIED: Gait
GAIT_WALK: Gait
TURN_SOURCE_FEET: TurnSource
TURN_SOURCE_HANDS: TurnSource
TURN_SOURCE_HEAD: TurnSource
TURN_SOURCE_LEAN: TurnSource
TURN_SOURCE_STICK: TurnSource
TURN_SOURCE_TRUNK: TurnSource
TURN_SOURCE_UNSPECIFIED: TurnSource
USER_INTERFACE_ARM: UserInterface
USER_INTERFACE_BOARDS: UserInterface
USER_INTERFACE_JOYSTICK: UserInterface
USER_INTERFACE_LEG: UserInterface
USER_INTERFACE_UNSPECIFIED: UserInterface
USER_INTERFACE_WRIST: UserInterface

class AppendedSegment(_message.Message):
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

class AppliedInput(_message.Message):
    __slots__ = ["append_number", "appends", "boards_may_be_left", "direct", "direct_gait", "direct_height_m", "direct_speed_mps", "direct_turn_rad", "features_number", "head", "interface", "interface_number", "left", "left_board", "left_leg", "legs_phase_rad", "legs_phase_valid", "phase_rad", "phase_valid", "pose", "push_number", "push_x_ns", "push_y_ns", "put_back_number", "right", "right_board", "right_leg", "sensor_epoch", "sensor_sequence", "simulated", "step", "stick", "track_number", "trial_number", "trial_task", "trials_stopped_below", "trunk", "turn_by"]
    APPENDS_FIELD_NUMBER: _ClassVar[int]
    APPEND_NUMBER_FIELD_NUMBER: _ClassVar[int]
    BOARDS_MAY_BE_LEFT_FIELD_NUMBER: _ClassVar[int]
    DIRECT_FIELD_NUMBER: _ClassVar[int]
    DIRECT_GAIT_FIELD_NUMBER: _ClassVar[int]
    DIRECT_HEIGHT_M_FIELD_NUMBER: _ClassVar[int]
    DIRECT_SPEED_MPS_FIELD_NUMBER: _ClassVar[int]
    DIRECT_TURN_RAD_FIELD_NUMBER: _ClassVar[int]
    FEATURES_NUMBER_FIELD_NUMBER: _ClassVar[int]
    HEAD_FIELD_NUMBER: _ClassVar[int]
    INTERFACE_FIELD_NUMBER: _ClassVar[int]
    INTERFACE_NUMBER_FIELD_NUMBER: _ClassVar[int]
    LEFT_BOARD_FIELD_NUMBER: _ClassVar[int]
    LEFT_FIELD_NUMBER: _ClassVar[int]
    LEFT_LEG_FIELD_NUMBER: _ClassVar[int]
    LEGS_PHASE_RAD_FIELD_NUMBER: _ClassVar[int]
    LEGS_PHASE_VALID_FIELD_NUMBER: _ClassVar[int]
    PHASE_RAD_FIELD_NUMBER: _ClassVar[int]
    PHASE_VALID_FIELD_NUMBER: _ClassVar[int]
    POSE_FIELD_NUMBER: _ClassVar[int]
    PUSH_NUMBER_FIELD_NUMBER: _ClassVar[int]
    PUSH_X_NS_FIELD_NUMBER: _ClassVar[int]
    PUSH_Y_NS_FIELD_NUMBER: _ClassVar[int]
    PUT_BACK_NUMBER_FIELD_NUMBER: _ClassVar[int]
    RIGHT_BOARD_FIELD_NUMBER: _ClassVar[int]
    RIGHT_FIELD_NUMBER: _ClassVar[int]
    RIGHT_LEG_FIELD_NUMBER: _ClassVar[int]
    SENSOR_EPOCH_FIELD_NUMBER: _ClassVar[int]
    SENSOR_SEQUENCE_FIELD_NUMBER: _ClassVar[int]
    SIMULATED_FIELD_NUMBER: _ClassVar[int]
    STEP_FIELD_NUMBER: _ClassVar[int]
    STICK_FIELD_NUMBER: _ClassVar[int]
    TRACK_NUMBER_FIELD_NUMBER: _ClassVar[int]
    TRIALS_STOPPED_BELOW_FIELD_NUMBER: _ClassVar[int]
    TRIAL_NUMBER_FIELD_NUMBER: _ClassVar[int]
    TRIAL_TASK_FIELD_NUMBER: _ClassVar[int]
    TRUNK_FIELD_NUMBER: _ClassVar[int]
    TURN_BY_FIELD_NUMBER: _ClassVar[int]
    append_number: int
    appends: _containers.RepeatedCompositeFieldContainer[AppendedSegment]
    boards_may_be_left: bool
    direct: bool
    direct_gait: Gait
    direct_height_m: float
    direct_speed_mps: float
    direct_turn_rad: float
    features_number: int
    head: HandInput
    interface: UserInterface
    interface_number: int
    left: HandInput
    left_board: BoardInput
    left_leg: HandInput
    legs_phase_rad: float
    legs_phase_valid: bool
    phase_rad: float
    phase_valid: bool
    pose: PoseInput
    push_number: int
    push_x_ns: float
    push_y_ns: float
    put_back_number: int
    right: HandInput
    right_board: BoardInput
    right_leg: HandInput
    sensor_epoch: int
    sensor_sequence: int
    simulated: bool
    step: int
    stick: StickInput
    track_number: int
    trial_number: int
    trial_task: int
    trials_stopped_below: int
    trunk: HandInput
    turn_by: TurnSource
    def __init__(self, step: _Optional[int] = ..., sensor_epoch: _Optional[int] = ..., sensor_sequence: _Optional[int] = ..., features_number: _Optional[int] = ..., left: _Optional[_Union[HandInput, _Mapping]] = ..., right: _Optional[_Union[HandInput, _Mapping]] = ..., phase_valid: bool = ..., phase_rad: _Optional[float] = ..., simulated: bool = ..., direct: bool = ..., direct_gait: _Optional[_Union[Gait, str]] = ..., direct_speed_mps: _Optional[float] = ..., direct_height_m: _Optional[float] = ..., direct_turn_rad: _Optional[float] = ..., push_number: _Optional[int] = ..., push_x_ns: _Optional[float] = ..., push_y_ns: _Optional[float] = ..., put_back_number: _Optional[int] = ..., append_number: _Optional[int] = ..., appends: _Optional[_Iterable[_Union[AppendedSegment, _Mapping]]] = ..., pose: _Optional[_Union[PoseInput, _Mapping]] = ..., left_leg: _Optional[_Union[HandInput, _Mapping]] = ..., right_leg: _Optional[_Union[HandInput, _Mapping]] = ..., legs_phase_valid: bool = ..., legs_phase_rad: _Optional[float] = ..., head: _Optional[_Union[HandInput, _Mapping]] = ..., trunk: _Optional[_Union[HandInput, _Mapping]] = ..., stick: _Optional[_Union[StickInput, _Mapping]] = ..., left_board: _Optional[_Union[BoardInput, _Mapping]] = ..., right_board: _Optional[_Union[BoardInput, _Mapping]] = ..., interface: _Optional[_Union[UserInterface, str]] = ..., turn_by: _Optional[_Union[TurnSource, str]] = ..., boards_may_be_left: bool = ..., interface_number: _Optional[int] = ..., trial_number: _Optional[int] = ..., trial_task: _Optional[int] = ..., trials_stopped_below: _Optional[int] = ..., track_number: _Optional[int] = ...) -> None: ...

class AppliedInputs(_message.Message):
    __slots__ = ["inputs"]
    INPUTS_FIELD_NUMBER: _ClassVar[int]
    inputs: _containers.RepeatedCompositeFieldContainer[AppliedInput]
    def __init__(self, inputs: _Optional[_Iterable[_Union[AppliedInput, _Mapping]]] = ...) -> None: ...

class BoardInput(_message.Message):
    __slots__ = ["cop_valid", "cop_x_m", "cop_y_m", "corners_n", "present"]
    COP_VALID_FIELD_NUMBER: _ClassVar[int]
    COP_X_M_FIELD_NUMBER: _ClassVar[int]
    COP_Y_M_FIELD_NUMBER: _ClassVar[int]
    CORNERS_N_FIELD_NUMBER: _ClassVar[int]
    PRESENT_FIELD_NUMBER: _ClassVar[int]
    cop_valid: bool
    cop_x_m: float
    cop_y_m: float
    corners_n: _containers.RepeatedScalarFieldContainer[float]
    present: bool
    def __init__(self, present: bool = ..., corners_n: _Optional[_Iterable[float]] = ..., cop_valid: bool = ..., cop_x_m: _Optional[float] = ..., cop_y_m: _Optional[float] = ...) -> None: ...

class BodyFoot(_message.Message):
    __slots__ = ["airborne_s", "contact", "cop_m", "cop_valid", "load_n", "position_m", "valid", "variance_m2"]
    AIRBORNE_S_FIELD_NUMBER: _ClassVar[int]
    CONTACT_FIELD_NUMBER: _ClassVar[int]
    COP_M_FIELD_NUMBER: _ClassVar[int]
    COP_VALID_FIELD_NUMBER: _ClassVar[int]
    LOAD_N_FIELD_NUMBER: _ClassVar[int]
    POSITION_M_FIELD_NUMBER: _ClassVar[int]
    VALID_FIELD_NUMBER: _ClassVar[int]
    VARIANCE_M2_FIELD_NUMBER: _ClassVar[int]
    airborne_s: float
    contact: bool
    cop_m: _sensor_pb2.Vector3
    cop_valid: bool
    load_n: float
    position_m: _sensor_pb2.Vector3
    valid: bool
    variance_m2: _sensor_pb2.Vector3
    def __init__(self, contact: bool = ..., valid: bool = ..., position_m: _Optional[_Union[_sensor_pb2.Vector3, _Mapping]] = ..., variance_m2: _Optional[_Union[_sensor_pb2.Vector3, _Mapping]] = ..., load_n: _Optional[float] = ..., cop_valid: bool = ..., cop_m: _Optional[_Union[_sensor_pb2.Vector3, _Mapping]] = ..., airborne_s: _Optional[float] = ...) -> None: ...

class BodyState(_message.Message):
    __slots__ = ["angle_sd_rad", "angular_momentum_kgm2ps", "angular_momentum_variance", "calibrated", "calibration_progress", "calibration_restarts", "com_acceleration_mps2", "com_variance_m2", "contact_source", "feet", "feet_told", "hands_seen", "hands_source", "height_m", "lag_s", "left_out", "link_sd_m", "mass_kg", "mode", "momentum_valid", "note", "resets", "solve_us", "subject"]
    ANGLE_SD_RAD_FIELD_NUMBER: _ClassVar[int]
    ANGULAR_MOMENTUM_KGM2PS_FIELD_NUMBER: _ClassVar[int]
    ANGULAR_MOMENTUM_VARIANCE_FIELD_NUMBER: _ClassVar[int]
    CALIBRATED_FIELD_NUMBER: _ClassVar[int]
    CALIBRATION_PROGRESS_FIELD_NUMBER: _ClassVar[int]
    CALIBRATION_RESTARTS_FIELD_NUMBER: _ClassVar[int]
    COM_ACCELERATION_MPS2_FIELD_NUMBER: _ClassVar[int]
    COM_VARIANCE_M2_FIELD_NUMBER: _ClassVar[int]
    CONTACT_SOURCE_FIELD_NUMBER: _ClassVar[int]
    FEET_FIELD_NUMBER: _ClassVar[int]
    FEET_TOLD_FIELD_NUMBER: _ClassVar[int]
    HANDS_SEEN_FIELD_NUMBER: _ClassVar[int]
    HANDS_SOURCE_FIELD_NUMBER: _ClassVar[int]
    HEIGHT_M_FIELD_NUMBER: _ClassVar[int]
    LAG_S_FIELD_NUMBER: _ClassVar[int]
    LEFT_OUT_FIELD_NUMBER: _ClassVar[int]
    LINK_SD_M_FIELD_NUMBER: _ClassVar[int]
    MASS_KG_FIELD_NUMBER: _ClassVar[int]
    MODE_FIELD_NUMBER: _ClassVar[int]
    MOMENTUM_VALID_FIELD_NUMBER: _ClassVar[int]
    NOTE_FIELD_NUMBER: _ClassVar[int]
    RESETS_FIELD_NUMBER: _ClassVar[int]
    SOLVE_US_FIELD_NUMBER: _ClassVar[int]
    SUBJECT_FIELD_NUMBER: _ClassVar[int]
    angle_sd_rad: _containers.RepeatedScalarFieldContainer[float]
    angular_momentum_kgm2ps: _sensor_pb2.Vector3
    angular_momentum_variance: _sensor_pb2.Vector3
    calibrated: bool
    calibration_progress: float
    calibration_restarts: int
    com_acceleration_mps2: _sensor_pb2.Vector3
    com_variance_m2: _sensor_pb2.Vector3
    contact_source: str
    feet: _containers.RepeatedCompositeFieldContainer[BodyFoot]
    feet_told: _containers.RepeatedScalarFieldContainer[bool]
    hands_seen: _containers.RepeatedScalarFieldContainer[bool]
    hands_source: str
    height_m: float
    lag_s: float
    left_out: _containers.RepeatedScalarFieldContainer[str]
    link_sd_m: _containers.RepeatedScalarFieldContainer[float]
    mass_kg: float
    mode: str
    momentum_valid: bool
    note: str
    resets: int
    solve_us: float
    subject: str
    def __init__(self, subject: _Optional[str] = ..., mode: _Optional[str] = ..., calibrated: bool = ..., calibration_progress: _Optional[float] = ..., calibration_restarts: _Optional[int] = ..., mass_kg: _Optional[float] = ..., height_m: _Optional[float] = ..., lag_s: _Optional[float] = ..., momentum_valid: bool = ..., com_variance_m2: _Optional[_Union[_sensor_pb2.Vector3, _Mapping]] = ..., com_acceleration_mps2: _Optional[_Union[_sensor_pb2.Vector3, _Mapping]] = ..., angular_momentum_kgm2ps: _Optional[_Union[_sensor_pb2.Vector3, _Mapping]] = ..., angular_momentum_variance: _Optional[_Union[_sensor_pb2.Vector3, _Mapping]] = ..., feet: _Optional[_Iterable[_Union[BodyFoot, _Mapping]]] = ..., resets: _Optional[int] = ..., link_sd_m: _Optional[_Iterable[float]] = ..., note: _Optional[str] = ..., solve_us: _Optional[float] = ..., hands_seen: _Optional[_Iterable[bool]] = ..., contact_source: _Optional[str] = ..., feet_told: _Optional[_Iterable[bool]] = ..., hands_source: _Optional[str] = ..., left_out: _Optional[_Iterable[str]] = ..., angle_sd_rad: _Optional[_Iterable[float]] = ...) -> None: ...

class Character(_message.Message):
    __slots__ = ["body", "character", "com_m", "com_velocity_mps", "contacts", "gait", "interface", "links", "rig", "simulated_input", "trial", "valid"]
    BODY_FIELD_NUMBER: _ClassVar[int]
    CHARACTER_FIELD_NUMBER: _ClassVar[int]
    COM_M_FIELD_NUMBER: _ClassVar[int]
    COM_VELOCITY_MPS_FIELD_NUMBER: _ClassVar[int]
    CONTACTS_FIELD_NUMBER: _ClassVar[int]
    GAIT_FIELD_NUMBER: _ClassVar[int]
    INTERFACE_FIELD_NUMBER: _ClassVar[int]
    LINKS_FIELD_NUMBER: _ClassVar[int]
    RIG_FIELD_NUMBER: _ClassVar[int]
    SIMULATED_INPUT_FIELD_NUMBER: _ClassVar[int]
    TRIAL_FIELD_NUMBER: _ClassVar[int]
    VALID_FIELD_NUMBER: _ClassVar[int]
    body: BodyState
    character: int
    com_m: _sensor_pb2.Vector3
    com_velocity_mps: _sensor_pb2.Vector3
    contacts: _containers.RepeatedCompositeFieldContainer[Contact]
    gait: GaitState
    interface: InterfaceState
    links: _containers.RepeatedCompositeFieldContainer[LinkPose]
    rig: str
    simulated_input: bool
    trial: TrialState
    valid: bool
    def __init__(self, character: _Optional[int] = ..., rig: _Optional[str] = ..., valid: bool = ..., links: _Optional[_Iterable[_Union[LinkPose, _Mapping]]] = ..., contacts: _Optional[_Iterable[_Union[Contact, _Mapping]]] = ..., com_m: _Optional[_Union[_sensor_pb2.Vector3, _Mapping]] = ..., com_velocity_mps: _Optional[_Union[_sensor_pb2.Vector3, _Mapping]] = ..., gait: _Optional[_Union[GaitState, _Mapping]] = ..., simulated_input: bool = ..., body: _Optional[_Union[BodyState, _Mapping]] = ..., interface: _Optional[_Union[InterfaceState, _Mapping]] = ..., trial: _Optional[_Union[TrialState, _Mapping]] = ...) -> None: ...

class CharacterFrame(_message.Message):
    __slots__ = ["characters", "lease_holder", "overruns", "state_hash", "step", "time_s", "world"]
    CHARACTERS_FIELD_NUMBER: _ClassVar[int]
    LEASE_HOLDER_FIELD_NUMBER: _ClassVar[int]
    OVERRUNS_FIELD_NUMBER: _ClassVar[int]
    STATE_HASH_FIELD_NUMBER: _ClassVar[int]
    STEP_FIELD_NUMBER: _ClassVar[int]
    TIME_S_FIELD_NUMBER: _ClassVar[int]
    WORLD_FIELD_NUMBER: _ClassVar[int]
    characters: _containers.RepeatedCompositeFieldContainer[Character]
    lease_holder: str
    overruns: int
    state_hash: int
    step: int
    time_s: float
    world: str
    def __init__(self, world: _Optional[str] = ..., step: _Optional[int] = ..., time_s: _Optional[float] = ..., characters: _Optional[_Iterable[_Union[Character, _Mapping]]] = ..., overruns: _Optional[int] = ..., state_hash: _Optional[int] = ..., lease_holder: _Optional[str] = ...) -> None: ...

class Contact(_message.Message):
    __slots__ = ["normal_force_n", "position_m", "touching"]
    NORMAL_FORCE_N_FIELD_NUMBER: _ClassVar[int]
    POSITION_M_FIELD_NUMBER: _ClassVar[int]
    TOUCHING_FIELD_NUMBER: _ClassVar[int]
    normal_force_n: float
    position_m: _sensor_pb2.Vector3
    touching: bool
    def __init__(self, touching: bool = ..., position_m: _Optional[_Union[_sensor_pb2.Vector3, _Mapping]] = ..., normal_force_n: _Optional[float] = ...) -> None: ...

class EffectiveConfig(_message.Message):
    __slots__ = ["json"]
    JSON_FIELD_NUMBER: _ClassVar[int]
    json: str
    def __init__(self, json: _Optional[str] = ...) -> None: ...

class Event(_message.Message):
    __slots__ = ["by_operator", "character", "device", "failure", "failure_cause", "gait", "host_ns", "kind", "marker", "response", "segment_refused", "text", "trial"]
    class Kind(int, metaclass=_enum_type_wrapper.EnumTypeWrapper):
        __slots__ = []
    BY_OPERATOR_FIELD_NUMBER: _ClassVar[int]
    CHARACTER_FIELD_NUMBER: _ClassVar[int]
    DEVICE_FIELD_NUMBER: _ClassVar[int]
    FAILURE_CAUSE_FIELD_NUMBER: _ClassVar[int]
    FAILURE_FIELD_NUMBER: _ClassVar[int]
    GAIT_FIELD_NUMBER: _ClassVar[int]
    HOST_NS_FIELD_NUMBER: _ClassVar[int]
    KIND_COMMAND: Event.Kind
    KIND_CORRECTION: Event.Kind
    KIND_DEVICE: Event.Kind
    KIND_FALL: Event.Kind
    KIND_FIELD_NUMBER: _ClassVar[int]
    KIND_GAIT_CHANGED: Event.Kind
    KIND_LEASE: Event.Kind
    KIND_MARKER: Event.Kind
    KIND_PUT_BACK: Event.Kind
    KIND_RESPONSE: Event.Kind
    KIND_STREAM_BACK: Event.Kind
    KIND_STREAM_LOST: Event.Kind
    KIND_TASK: Event.Kind
    KIND_TRIAL: Event.Kind
    KIND_UNSPECIFIED: Event.Kind
    MARKER_FIELD_NUMBER: _ClassVar[int]
    RESPONSE_FIELD_NUMBER: _ClassVar[int]
    SEGMENT_REFUSED_FIELD_NUMBER: _ClassVar[int]
    TEXT_FIELD_NUMBER: _ClassVar[int]
    TRIAL_FIELD_NUMBER: _ClassVar[int]
    by_operator: bool
    character: int
    device: int
    failure: Failure
    failure_cause: FailureCause
    gait: Gait
    host_ns: int
    kind: Event.Kind
    marker: EventMarker
    response: ResponseStages
    segment_refused: bool
    text: str
    trial: TrialState
    def __init__(self, kind: _Optional[_Union[Event.Kind, str]] = ..., host_ns: _Optional[int] = ..., character: _Optional[int] = ..., text: _Optional[str] = ..., gait: _Optional[_Union[Gait, str]] = ..., response: _Optional[_Union[ResponseStages, _Mapping]] = ..., device: _Optional[int] = ..., failure_cause: _Optional[_Union[FailureCause, str]] = ..., by_operator: bool = ..., failure: _Optional[_Union[Failure, _Mapping]] = ..., trial: _Optional[_Union[TrialState, _Mapping]] = ..., segment_refused: bool = ..., marker: _Optional[_Union[EventMarker, _Mapping]] = ...) -> None: ...

class EventMarker(_message.Message):
    __slots__ = ["client", "received_ns", "value"]
    CLIENT_FIELD_NUMBER: _ClassVar[int]
    RECEIVED_NS_FIELD_NUMBER: _ClassVar[int]
    VALUE_FIELD_NUMBER: _ClassVar[int]
    client: str
    received_ns: int
    value: float
    def __init__(self, value: _Optional[float] = ..., received_ns: _Optional[int] = ..., client: _Optional[str] = ...) -> None: ...

class Events(_message.Message):
    __slots__ = ["events"]
    EVENTS_FIELD_NUMBER: _ClassVar[int]
    events: _containers.RepeatedCompositeFieldContainer[Event]
    def __init__(self, events: _Optional[_Iterable[_Union[Event, _Mapping]]] = ...) -> None: ...

class Failure(_message.Message):
    __slots__ = ["cause", "distance_m", "heading_error_rad", "lateral_offset_m", "number", "position_m", "trial", "trial_time_s", "withdrawn"]
    CAUSE_FIELD_NUMBER: _ClassVar[int]
    DISTANCE_M_FIELD_NUMBER: _ClassVar[int]
    HEADING_ERROR_RAD_FIELD_NUMBER: _ClassVar[int]
    LATERAL_OFFSET_M_FIELD_NUMBER: _ClassVar[int]
    NUMBER_FIELD_NUMBER: _ClassVar[int]
    POSITION_M_FIELD_NUMBER: _ClassVar[int]
    TRIAL_FIELD_NUMBER: _ClassVar[int]
    TRIAL_TIME_S_FIELD_NUMBER: _ClassVar[int]
    WITHDRAWN_FIELD_NUMBER: _ClassVar[int]
    cause: FailureCause
    distance_m: float
    heading_error_rad: float
    lateral_offset_m: float
    number: int
    position_m: _sensor_pb2.Vector3
    trial: str
    trial_time_s: float
    withdrawn: bool
    def __init__(self, number: _Optional[int] = ..., cause: _Optional[_Union[FailureCause, str]] = ..., trial: _Optional[str] = ..., trial_time_s: _Optional[float] = ..., distance_m: _Optional[float] = ..., lateral_offset_m: _Optional[float] = ..., heading_error_rad: _Optional[float] = ..., position_m: _Optional[_Union[_sensor_pb2.Vector3, _Mapping]] = ..., withdrawn: bool = ...) -> None: ...

class FailureCounts(_message.Message):
    __slots__ = ["curve", "jump", "simulation", "straightness", "transition"]
    CURVE_FIELD_NUMBER: _ClassVar[int]
    JUMP_FIELD_NUMBER: _ClassVar[int]
    SIMULATION_FIELD_NUMBER: _ClassVar[int]
    STRAIGHTNESS_FIELD_NUMBER: _ClassVar[int]
    TRANSITION_FIELD_NUMBER: _ClassVar[int]
    curve: int
    jump: int
    simulation: int
    straightness: int
    transition: int
    def __init__(self, simulation: _Optional[int] = ..., curve: _Optional[int] = ..., jump: _Optional[int] = ..., straightness: _Optional[int] = ..., transition: _Optional[int] = ...) -> None: ...

class GaitState(_message.Message):
    __slots__ = ["commanded_by_stream", "commanded_gait", "commanded_height_m", "commanded_speed_mps", "commanded_turn_rad", "distance_m", "failures", "falls", "gait", "heading_rad", "next_foothold_x_m", "next_foothold_y_m", "operator_put_backs", "pending", "phase", "speed_mps", "steps"]
    COMMANDED_BY_STREAM_FIELD_NUMBER: _ClassVar[int]
    COMMANDED_GAIT_FIELD_NUMBER: _ClassVar[int]
    COMMANDED_HEIGHT_M_FIELD_NUMBER: _ClassVar[int]
    COMMANDED_SPEED_MPS_FIELD_NUMBER: _ClassVar[int]
    COMMANDED_TURN_RAD_FIELD_NUMBER: _ClassVar[int]
    DISTANCE_M_FIELD_NUMBER: _ClassVar[int]
    FAILURES_FIELD_NUMBER: _ClassVar[int]
    FALLS_FIELD_NUMBER: _ClassVar[int]
    GAIT_FIELD_NUMBER: _ClassVar[int]
    HEADING_RAD_FIELD_NUMBER: _ClassVar[int]
    NEXT_FOOTHOLD_X_M_FIELD_NUMBER: _ClassVar[int]
    NEXT_FOOTHOLD_Y_M_FIELD_NUMBER: _ClassVar[int]
    OPERATOR_PUT_BACKS_FIELD_NUMBER: _ClassVar[int]
    PENDING_FIELD_NUMBER: _ClassVar[int]
    PHASE_FIELD_NUMBER: _ClassVar[int]
    SPEED_MPS_FIELD_NUMBER: _ClassVar[int]
    STEPS_FIELD_NUMBER: _ClassVar[int]
    commanded_by_stream: bool
    commanded_gait: Gait
    commanded_height_m: float
    commanded_speed_mps: float
    commanded_turn_rad: float
    distance_m: float
    failures: FailureCounts
    falls: int
    gait: Gait
    heading_rad: float
    next_foothold_x_m: float
    next_foothold_y_m: float
    operator_put_backs: int
    pending: bool
    phase: str
    speed_mps: float
    steps: int
    def __init__(self, gait: _Optional[_Union[Gait, str]] = ..., commanded_gait: _Optional[_Union[Gait, str]] = ..., pending: bool = ..., phase: _Optional[str] = ..., commanded_speed_mps: _Optional[float] = ..., commanded_height_m: _Optional[float] = ..., commanded_turn_rad: _Optional[float] = ..., speed_mps: _Optional[float] = ..., heading_rad: _Optional[float] = ..., steps: _Optional[int] = ..., falls: _Optional[int] = ..., distance_m: _Optional[float] = ..., commanded_by_stream: bool = ..., next_foothold_x_m: _Optional[float] = ..., next_foothold_y_m: _Optional[float] = ..., failures: _Optional[_Union[FailureCounts, _Mapping]] = ..., operator_put_backs: _Optional[int] = ...) -> None: ...

class HandInput(_message.Message):
    __slots__ = ["amplitude_mps2", "amplitude_valid", "axial_rad", "axial_valid", "frequency_hz", "frequency_valid", "inclination_valid", "mounted", "moving", "pitch_rad", "present", "roll_rad", "swing_rad", "swing_valid"]
    AMPLITUDE_MPS2_FIELD_NUMBER: _ClassVar[int]
    AMPLITUDE_VALID_FIELD_NUMBER: _ClassVar[int]
    AXIAL_RAD_FIELD_NUMBER: _ClassVar[int]
    AXIAL_VALID_FIELD_NUMBER: _ClassVar[int]
    FREQUENCY_HZ_FIELD_NUMBER: _ClassVar[int]
    FREQUENCY_VALID_FIELD_NUMBER: _ClassVar[int]
    INCLINATION_VALID_FIELD_NUMBER: _ClassVar[int]
    MOUNTED_FIELD_NUMBER: _ClassVar[int]
    MOVING_FIELD_NUMBER: _ClassVar[int]
    PITCH_RAD_FIELD_NUMBER: _ClassVar[int]
    PRESENT_FIELD_NUMBER: _ClassVar[int]
    ROLL_RAD_FIELD_NUMBER: _ClassVar[int]
    SWING_RAD_FIELD_NUMBER: _ClassVar[int]
    SWING_VALID_FIELD_NUMBER: _ClassVar[int]
    amplitude_mps2: float
    amplitude_valid: bool
    axial_rad: float
    axial_valid: bool
    frequency_hz: float
    frequency_valid: bool
    inclination_valid: bool
    mounted: bool
    moving: bool
    pitch_rad: float
    present: bool
    roll_rad: float
    swing_rad: float
    swing_valid: bool
    def __init__(self, present: bool = ..., moving: bool = ..., frequency_valid: bool = ..., frequency_hz: _Optional[float] = ..., amplitude_valid: bool = ..., amplitude_mps2: _Optional[float] = ..., inclination_valid: bool = ..., roll_rad: _Optional[float] = ..., pitch_rad: _Optional[float] = ..., swing_valid: bool = ..., swing_rad: _Optional[float] = ..., mounted: bool = ..., axial_valid: bool = ..., axial_rad: _Optional[float] = ...) -> None: ...

class InterfaceState(_message.Message):
    __slots__ = ["activity", "bent_rad", "border_hz", "elevation_rad", "elevation_valid", "frequency_hz", "frequency_valid", "gait", "interface", "left_share", "load_valid", "missing_roles", "next_gait", "next_share", "phase_rad", "phase_valid", "stick_valid", "stick_x", "stick_y", "together_rad", "turn_share", "turn_source", "turn_valid", "unmounted_roles", "view_roll_rad"]
    ACTIVITY_FIELD_NUMBER: _ClassVar[int]
    BENT_RAD_FIELD_NUMBER: _ClassVar[int]
    BORDER_HZ_FIELD_NUMBER: _ClassVar[int]
    ELEVATION_RAD_FIELD_NUMBER: _ClassVar[int]
    ELEVATION_VALID_FIELD_NUMBER: _ClassVar[int]
    FREQUENCY_HZ_FIELD_NUMBER: _ClassVar[int]
    FREQUENCY_VALID_FIELD_NUMBER: _ClassVar[int]
    GAIT_FIELD_NUMBER: _ClassVar[int]
    INTERFACE_FIELD_NUMBER: _ClassVar[int]
    LEFT_SHARE_FIELD_NUMBER: _ClassVar[int]
    LOAD_VALID_FIELD_NUMBER: _ClassVar[int]
    MISSING_ROLES_FIELD_NUMBER: _ClassVar[int]
    NEXT_GAIT_FIELD_NUMBER: _ClassVar[int]
    NEXT_SHARE_FIELD_NUMBER: _ClassVar[int]
    PHASE_RAD_FIELD_NUMBER: _ClassVar[int]
    PHASE_VALID_FIELD_NUMBER: _ClassVar[int]
    STICK_VALID_FIELD_NUMBER: _ClassVar[int]
    STICK_X_FIELD_NUMBER: _ClassVar[int]
    STICK_Y_FIELD_NUMBER: _ClassVar[int]
    TOGETHER_RAD_FIELD_NUMBER: _ClassVar[int]
    TURN_SHARE_FIELD_NUMBER: _ClassVar[int]
    TURN_SOURCE_FIELD_NUMBER: _ClassVar[int]
    TURN_VALID_FIELD_NUMBER: _ClassVar[int]
    UNMOUNTED_ROLES_FIELD_NUMBER: _ClassVar[int]
    VIEW_ROLL_RAD_FIELD_NUMBER: _ClassVar[int]
    activity: Activity
    bent_rad: float
    border_hz: float
    elevation_rad: float
    elevation_valid: bool
    frequency_hz: float
    frequency_valid: bool
    gait: Gait
    interface: UserInterface
    left_share: float
    load_valid: bool
    missing_roles: int
    next_gait: Gait
    next_share: float
    phase_rad: float
    phase_valid: bool
    stick_valid: bool
    stick_x: float
    stick_y: float
    together_rad: float
    turn_share: float
    turn_source: TurnSource
    turn_valid: bool
    unmounted_roles: int
    view_roll_rad: float
    def __init__(self, interface: _Optional[_Union[UserInterface, str]] = ..., activity: _Optional[_Union[Activity, str]] = ..., gait: _Optional[_Union[Gait, str]] = ..., next_gait: _Optional[_Union[Gait, str]] = ..., next_share: _Optional[float] = ..., frequency_valid: bool = ..., frequency_hz: _Optional[float] = ..., border_hz: _Optional[float] = ..., phase_valid: bool = ..., phase_rad: _Optional[float] = ..., together_rad: _Optional[float] = ..., elevation_valid: bool = ..., elevation_rad: _Optional[float] = ..., bent_rad: _Optional[float] = ..., stick_valid: bool = ..., stick_x: _Optional[float] = ..., stick_y: _Optional[float] = ..., load_valid: bool = ..., left_share: _Optional[float] = ..., turn_valid: bool = ..., turn_source: _Optional[_Union[TurnSource, str]] = ..., turn_share: _Optional[float] = ..., missing_roles: _Optional[int] = ..., unmounted_roles: _Optional[int] = ..., view_roll_rad: _Optional[float] = ...) -> None: ...

class Link(_message.Message):
    __slots__ = ["name", "parent", "size_m"]
    NAME_FIELD_NUMBER: _ClassVar[int]
    PARENT_FIELD_NUMBER: _ClassVar[int]
    SIZE_M_FIELD_NUMBER: _ClassVar[int]
    name: str
    parent: int
    size_m: _sensor_pb2.Vector3
    def __init__(self, name: _Optional[str] = ..., parent: _Optional[int] = ..., size_m: _Optional[_Union[_sensor_pb2.Vector3, _Mapping]] = ...) -> None: ...

class LinkPose(_message.Message):
    __slots__ = ["orientation", "position_m"]
    ORIENTATION_FIELD_NUMBER: _ClassVar[int]
    POSITION_M_FIELD_NUMBER: _ClassVar[int]
    orientation: _sensor_pb2.Quaternion
    position_m: _sensor_pb2.Vector3
    def __init__(self, position_m: _Optional[_Union[_sensor_pb2.Vector3, _Mapping]] = ..., orientation: _Optional[_Union[_sensor_pb2.Quaternion, _Mapping]] = ...) -> None: ...

class PoseArm(_message.Message):
    __slots__ = ["forearm", "forearm_sd", "hinge", "hinge_sd", "upper", "upper_sd"]
    FOREARM_FIELD_NUMBER: _ClassVar[int]
    FOREARM_SD_FIELD_NUMBER: _ClassVar[int]
    HINGE_FIELD_NUMBER: _ClassVar[int]
    HINGE_SD_FIELD_NUMBER: _ClassVar[int]
    UPPER_FIELD_NUMBER: _ClassVar[int]
    UPPER_SD_FIELD_NUMBER: _ClassVar[int]
    forearm: _sensor_pb2.Vector3
    forearm_sd: _sensor_pb2.Vector3
    hinge: _sensor_pb2.Vector3
    hinge_sd: _sensor_pb2.Vector3
    upper: _sensor_pb2.Vector3
    upper_sd: _sensor_pb2.Vector3
    def __init__(self, upper: _Optional[_Union[_sensor_pb2.Vector3, _Mapping]] = ..., hinge: _Optional[_Union[_sensor_pb2.Vector3, _Mapping]] = ..., forearm: _Optional[_Union[_sensor_pb2.Vector3, _Mapping]] = ..., upper_sd: _Optional[_Union[_sensor_pb2.Vector3, _Mapping]] = ..., hinge_sd: _Optional[_Union[_sensor_pb2.Vector3, _Mapping]] = ..., forearm_sd: _Optional[_Union[_sensor_pb2.Vector3, _Mapping]] = ...) -> None: ...

class PoseCell(_message.Message):
    __slots__ = ["load_n", "position_m"]
    LOAD_N_FIELD_NUMBER: _ClassVar[int]
    POSITION_M_FIELD_NUMBER: _ClassVar[int]
    load_n: float
    position_m: _sensor_pb2.Vector3
    def __init__(self, position_m: _Optional[_Union[_sensor_pb2.Vector3, _Mapping]] = ..., load_n: _Optional[float] = ...) -> None: ...

class PoseFoot(_message.Message):
    __slots__ = ["cells", "impulse_ns", "insole_cells", "sampled_s", "valid"]
    CELLS_FIELD_NUMBER: _ClassVar[int]
    IMPULSE_NS_FIELD_NUMBER: _ClassVar[int]
    INSOLE_CELLS_FIELD_NUMBER: _ClassVar[int]
    SAMPLED_S_FIELD_NUMBER: _ClassVar[int]
    VALID_FIELD_NUMBER: _ClassVar[int]
    cells: _containers.RepeatedCompositeFieldContainer[PoseCell]
    impulse_ns: _containers.RepeatedScalarFieldContainer[float]
    insole_cells: _containers.RepeatedCompositeFieldContainer[PoseCell]
    sampled_s: float
    valid: bool
    def __init__(self, valid: bool = ..., cells: _Optional[_Iterable[_Union[PoseCell, _Mapping]]] = ..., insole_cells: _Optional[_Iterable[_Union[PoseCell, _Mapping]]] = ..., sampled_s: _Optional[float] = ..., impulse_ns: _Optional[_Iterable[float]] = ...) -> None: ...

class PoseHand(_message.Message):
    __slots__ = ["arm", "covariance_m2", "of_skeleton", "position_m", "sd_m", "valid"]
    ARM_FIELD_NUMBER: _ClassVar[int]
    COVARIANCE_M2_FIELD_NUMBER: _ClassVar[int]
    OF_SKELETON_FIELD_NUMBER: _ClassVar[int]
    POSITION_M_FIELD_NUMBER: _ClassVar[int]
    SD_M_FIELD_NUMBER: _ClassVar[int]
    VALID_FIELD_NUMBER: _ClassVar[int]
    arm: PoseArm
    covariance_m2: _sensor_pb2.Vector3
    of_skeleton: bool
    position_m: _sensor_pb2.Vector3
    sd_m: _sensor_pb2.Vector3
    valid: bool
    def __init__(self, valid: bool = ..., position_m: _Optional[_Union[_sensor_pb2.Vector3, _Mapping]] = ..., sd_m: _Optional[_Union[_sensor_pb2.Vector3, _Mapping]] = ..., arm: _Optional[_Union[PoseArm, _Mapping]] = ..., covariance_m2: _Optional[_Union[_sensor_pb2.Vector3, _Mapping]] = ..., of_skeleton: bool = ...) -> None: ...

class PoseInput(_message.Message):
    __slots__ = ["calibrate_number", "hands_of_skeleton", "joints", "left_foot", "left_hand", "left_out", "mode", "right_foot", "right_hand", "same_person", "subject_code", "subject_foot_length_m", "subject_height_m", "subject_mass_kg", "subject_number", "turns"]
    CALIBRATE_NUMBER_FIELD_NUMBER: _ClassVar[int]
    HANDS_OF_SKELETON_FIELD_NUMBER: _ClassVar[int]
    JOINTS_FIELD_NUMBER: _ClassVar[int]
    LEFT_FOOT_FIELD_NUMBER: _ClassVar[int]
    LEFT_HAND_FIELD_NUMBER: _ClassVar[int]
    LEFT_OUT_FIELD_NUMBER: _ClassVar[int]
    MODE_FIELD_NUMBER: _ClassVar[int]
    RIGHT_FOOT_FIELD_NUMBER: _ClassVar[int]
    RIGHT_HAND_FIELD_NUMBER: _ClassVar[int]
    SAME_PERSON_FIELD_NUMBER: _ClassVar[int]
    SUBJECT_CODE_FIELD_NUMBER: _ClassVar[int]
    SUBJECT_FOOT_LENGTH_M_FIELD_NUMBER: _ClassVar[int]
    SUBJECT_HEIGHT_M_FIELD_NUMBER: _ClassVar[int]
    SUBJECT_MASS_KG_FIELD_NUMBER: _ClassVar[int]
    SUBJECT_NUMBER_FIELD_NUMBER: _ClassVar[int]
    TURNS_FIELD_NUMBER: _ClassVar[int]
    calibrate_number: int
    hands_of_skeleton: bool
    joints: _containers.RepeatedCompositeFieldContainer[PoseJoint]
    left_foot: PoseFoot
    left_hand: PoseHand
    left_out: _containers.RepeatedScalarFieldContainer[str]
    mode: str
    right_foot: PoseFoot
    right_hand: PoseHand
    same_person: bool
    subject_code: str
    subject_foot_length_m: float
    subject_height_m: float
    subject_mass_kg: float
    subject_number: int
    turns: _containers.RepeatedCompositeFieldContainer[PoseTurn]
    def __init__(self, left_foot: _Optional[_Union[PoseFoot, _Mapping]] = ..., right_foot: _Optional[_Union[PoseFoot, _Mapping]] = ..., left_hand: _Optional[_Union[PoseHand, _Mapping]] = ..., right_hand: _Optional[_Union[PoseHand, _Mapping]] = ..., calibrate_number: _Optional[int] = ..., subject_number: _Optional[int] = ..., subject_code: _Optional[str] = ..., subject_height_m: _Optional[float] = ..., subject_mass_kg: _Optional[float] = ..., subject_foot_length_m: _Optional[float] = ..., joints: _Optional[_Iterable[_Union[PoseJoint, _Mapping]]] = ..., hands_of_skeleton: bool = ..., mode: _Optional[str] = ..., left_out: _Optional[_Iterable[str]] = ..., same_person: bool = ..., turns: _Optional[_Iterable[_Union[PoseTurn, _Mapping]]] = ...) -> None: ...

class PoseJoint(_message.Message):
    __slots__ = ["covariance_m2", "joint", "position_m", "sd_m"]
    COVARIANCE_M2_FIELD_NUMBER: _ClassVar[int]
    JOINT_FIELD_NUMBER: _ClassVar[int]
    POSITION_M_FIELD_NUMBER: _ClassVar[int]
    SD_M_FIELD_NUMBER: _ClassVar[int]
    covariance_m2: _sensor_pb2.Vector3
    joint: _device_pb2.BodyJoint
    position_m: _sensor_pb2.Vector3
    sd_m: _sensor_pb2.Vector3
    def __init__(self, joint: _Optional[_Union[_device_pb2.BodyJoint, str]] = ..., position_m: _Optional[_Union[_sensor_pb2.Vector3, _Mapping]] = ..., sd_m: _Optional[_Union[_sensor_pb2.Vector3, _Mapping]] = ..., covariance_m2: _Optional[_Union[_sensor_pb2.Vector3, _Mapping]] = ...) -> None: ...

class PoseTurn(_message.Message):
    __slots__ = ["heading_sd_rad", "inclination_sd_rad", "segment", "x", "y", "z"]
    HEADING_SD_RAD_FIELD_NUMBER: _ClassVar[int]
    INCLINATION_SD_RAD_FIELD_NUMBER: _ClassVar[int]
    SEGMENT_FIELD_NUMBER: _ClassVar[int]
    X_FIELD_NUMBER: _ClassVar[int]
    Y_FIELD_NUMBER: _ClassVar[int]
    Z_FIELD_NUMBER: _ClassVar[int]
    heading_sd_rad: float
    inclination_sd_rad: float
    segment: str
    x: _sensor_pb2.Vector3
    y: _sensor_pb2.Vector3
    z: _sensor_pb2.Vector3
    def __init__(self, segment: _Optional[str] = ..., x: _Optional[_Union[_sensor_pb2.Vector3, _Mapping]] = ..., y: _Optional[_Union[_sensor_pb2.Vector3, _Mapping]] = ..., z: _Optional[_Union[_sensor_pb2.Vector3, _Mapping]] = ..., heading_sd_rad: _Optional[float] = ..., inclination_sd_rad: _Optional[float] = ...) -> None: ...

class ResponseStages(_message.Message):
    __slots__ = ["command_ns", "contact_ns", "decoded_ns", "features_computed_ns", "features_received_ns", "first_frame_ns", "report_received_ns", "to"]
    COMMAND_NS_FIELD_NUMBER: _ClassVar[int]
    CONTACT_NS_FIELD_NUMBER: _ClassVar[int]
    DECODED_NS_FIELD_NUMBER: _ClassVar[int]
    FEATURES_COMPUTED_NS_FIELD_NUMBER: _ClassVar[int]
    FEATURES_RECEIVED_NS_FIELD_NUMBER: _ClassVar[int]
    FIRST_FRAME_NS_FIELD_NUMBER: _ClassVar[int]
    FROM_FIELD_NUMBER: _ClassVar[int]
    REPORT_RECEIVED_NS_FIELD_NUMBER: _ClassVar[int]
    TO_FIELD_NUMBER: _ClassVar[int]
    command_ns: int
    contact_ns: int
    decoded_ns: int
    features_computed_ns: int
    features_received_ns: int
    first_frame_ns: int
    report_received_ns: int
    to: Gait
    def __init__(self, to: _Optional[_Union[Gait, str]] = ..., report_received_ns: _Optional[int] = ..., decoded_ns: _Optional[int] = ..., features_computed_ns: _Optional[int] = ..., features_received_ns: _Optional[int] = ..., command_ns: _Optional[int] = ..., contact_ns: _Optional[int] = ..., first_frame_ns: _Optional[int] = ..., **kwargs) -> None: ...

class Skeleton(_message.Message):
    __slots__ = ["character", "contact_points", "links", "name"]
    CHARACTER_FIELD_NUMBER: _ClassVar[int]
    CONTACT_POINTS_FIELD_NUMBER: _ClassVar[int]
    LINKS_FIELD_NUMBER: _ClassVar[int]
    NAME_FIELD_NUMBER: _ClassVar[int]
    character: int
    contact_points: _containers.RepeatedScalarFieldContainer[str]
    links: _containers.RepeatedCompositeFieldContainer[Link]
    name: str
    def __init__(self, character: _Optional[int] = ..., name: _Optional[str] = ..., links: _Optional[_Iterable[_Union[Link, _Mapping]]] = ..., contact_points: _Optional[_Iterable[str]] = ...) -> None: ...

class Skeletons(_message.Message):
    __slots__ = ["skeletons", "world"]
    SKELETONS_FIELD_NUMBER: _ClassVar[int]
    WORLD_FIELD_NUMBER: _ClassVar[int]
    skeletons: _containers.RepeatedCompositeFieldContainer[Skeleton]
    world: str
    def __init__(self, world: _Optional[str] = ..., skeletons: _Optional[_Iterable[_Union[Skeleton, _Mapping]]] = ...) -> None: ...

class StickInput(_message.Message):
    __slots__ = ["present", "pressed", "presses", "role", "x", "y"]
    PRESENT_FIELD_NUMBER: _ClassVar[int]
    PRESSED_FIELD_NUMBER: _ClassVar[int]
    PRESSES_FIELD_NUMBER: _ClassVar[int]
    ROLE_FIELD_NUMBER: _ClassVar[int]
    X_FIELD_NUMBER: _ClassVar[int]
    Y_FIELD_NUMBER: _ClassVar[int]
    present: bool
    pressed: bool
    presses: int
    role: _device_pb2.DeviceRole
    x: float
    y: float
    def __init__(self, present: bool = ..., x: _Optional[float] = ..., y: _Optional[float] = ..., pressed: bool = ..., presses: _Optional[int] = ..., role: _Optional[_Union[_device_pb2.DeviceRole, str]] = ...) -> None: ...

class Track(_message.Message):
    __slots__ = ["endless", "extendable", "finish_m", "first_m", "help_over_pits", "mark_m", "name", "number", "open", "revision", "segments", "start_m", "task_within_m", "tasks"]
    ENDLESS_FIELD_NUMBER: _ClassVar[int]
    EXTENDABLE_FIELD_NUMBER: _ClassVar[int]
    FINISH_M_FIELD_NUMBER: _ClassVar[int]
    FIRST_M_FIELD_NUMBER: _ClassVar[int]
    HELP_OVER_PITS_FIELD_NUMBER: _ClassVar[int]
    MARK_M_FIELD_NUMBER: _ClassVar[int]
    NAME_FIELD_NUMBER: _ClassVar[int]
    NUMBER_FIELD_NUMBER: _ClassVar[int]
    OPEN_FIELD_NUMBER: _ClassVar[int]
    REVISION_FIELD_NUMBER: _ClassVar[int]
    SEGMENTS_FIELD_NUMBER: _ClassVar[int]
    START_M_FIELD_NUMBER: _ClassVar[int]
    TASKS_FIELD_NUMBER: _ClassVar[int]
    TASK_WITHIN_M_FIELD_NUMBER: _ClassVar[int]
    endless: bool
    extendable: bool
    finish_m: float
    first_m: float
    help_over_pits: bool
    mark_m: float
    name: str
    number: int
    open: bool
    revision: int
    segments: _containers.RepeatedCompositeFieldContainer[TrackSegment]
    start_m: float
    task_within_m: float
    tasks: _containers.RepeatedCompositeFieldContainer[TrackTask]
    def __init__(self, name: _Optional[str] = ..., segments: _Optional[_Iterable[_Union[TrackSegment, _Mapping]]] = ..., revision: _Optional[int] = ..., number: _Optional[int] = ..., open: bool = ..., extendable: bool = ..., endless: bool = ..., help_over_pits: bool = ..., first_m: _Optional[float] = ..., start_m: _Optional[float] = ..., finish_m: _Optional[float] = ..., mark_m: _Optional[float] = ..., task_within_m: _Optional[float] = ..., tasks: _Optional[_Iterable[_Union[TrackTask, _Mapping]]] = ...) -> None: ...

class TrackSegment(_message.Message):
    __slots__ = ["heading_rad", "length_m", "pit", "slope_rad", "start_m", "width_m"]
    HEADING_RAD_FIELD_NUMBER: _ClassVar[int]
    LENGTH_M_FIELD_NUMBER: _ClassVar[int]
    PIT_FIELD_NUMBER: _ClassVar[int]
    SLOPE_RAD_FIELD_NUMBER: _ClassVar[int]
    START_M_FIELD_NUMBER: _ClassVar[int]
    WIDTH_M_FIELD_NUMBER: _ClassVar[int]
    heading_rad: float
    length_m: float
    pit: bool
    slope_rad: float
    start_m: _sensor_pb2.Vector3
    width_m: float
    def __init__(self, start_m: _Optional[_Union[_sensor_pb2.Vector3, _Mapping]] = ..., heading_rad: _Optional[float] = ..., slope_rad: _Optional[float] = ..., length_m: _Optional[float] = ..., width_m: _Optional[float] = ..., pit: bool = ...) -> None: ...

class TrackTask(_message.Message):
    __slots__ = ["after", "before", "instruction", "name"]
    AFTER_FIELD_NUMBER: _ClassVar[int]
    BEFORE_FIELD_NUMBER: _ClassVar[int]
    INSTRUCTION_FIELD_NUMBER: _ClassVar[int]
    NAME_FIELD_NUMBER: _ClassVar[int]
    after: Gait
    before: Gait
    instruction: str
    name: str
    def __init__(self, name: _Optional[str] = ..., before: _Optional[_Union[Gait, str]] = ..., after: _Optional[_Union[Gait, str]] = ..., instruction: _Optional[str] = ...) -> None: ...

class TrialState(_message.Message):
    __slots__ = ["distance_m", "failed_attempts", "failures", "finish_m", "heading_error_rad", "instruction", "lateral_offset_m", "number", "on_track", "operator_put_backs", "phase", "seed", "task", "task_phase", "time_s", "to_mark_m", "track", "trial", "withdrawn_failures"]
    class Phase(int, metaclass=_enum_type_wrapper.EnumTypeWrapper):
        __slots__ = []
    class TaskPhase(int, metaclass=_enum_type_wrapper.EnumTypeWrapper):
        __slots__ = []
    DISTANCE_M_FIELD_NUMBER: _ClassVar[int]
    FAILED_ATTEMPTS_FIELD_NUMBER: _ClassVar[int]
    FAILURES_FIELD_NUMBER: _ClassVar[int]
    FINISH_M_FIELD_NUMBER: _ClassVar[int]
    HEADING_ERROR_RAD_FIELD_NUMBER: _ClassVar[int]
    INSTRUCTION_FIELD_NUMBER: _ClassVar[int]
    LATERAL_OFFSET_M_FIELD_NUMBER: _ClassVar[int]
    NUMBER_FIELD_NUMBER: _ClassVar[int]
    ON_TRACK_FIELD_NUMBER: _ClassVar[int]
    OPERATOR_PUT_BACKS_FIELD_NUMBER: _ClassVar[int]
    PHASE_FIELD_NUMBER: _ClassVar[int]
    PHASE_FINISHED: TrialState.Phase
    PHASE_READY: TrialState.Phase
    PHASE_RUNNING: TrialState.Phase
    PHASE_STOPPED: TrialState.Phase
    PHASE_UNSPECIFIED: TrialState.Phase
    SEED_FIELD_NUMBER: _ClassVar[int]
    TASK_FIELD_NUMBER: _ClassVar[int]
    TASK_PHASE_AHEAD: TrialState.TaskPhase
    TASK_PHASE_DONE: TrialState.TaskPhase
    TASK_PHASE_DUE: TrialState.TaskPhase
    TASK_PHASE_FIELD_NUMBER: _ClassVar[int]
    TASK_PHASE_UNSPECIFIED: TrialState.TaskPhase
    TIME_S_FIELD_NUMBER: _ClassVar[int]
    TO_MARK_M_FIELD_NUMBER: _ClassVar[int]
    TRACK_FIELD_NUMBER: _ClassVar[int]
    TRIAL_FIELD_NUMBER: _ClassVar[int]
    WITHDRAWN_FAILURES_FIELD_NUMBER: _ClassVar[int]
    distance_m: float
    failed_attempts: int
    failures: FailureCounts
    finish_m: float
    heading_error_rad: float
    instruction: str
    lateral_offset_m: float
    number: int
    on_track: bool
    operator_put_backs: int
    phase: TrialState.Phase
    seed: int
    task: str
    task_phase: TrialState.TaskPhase
    time_s: float
    to_mark_m: float
    track: str
    trial: str
    withdrawn_failures: int
    def __init__(self, trial: _Optional[str] = ..., number: _Optional[int] = ..., phase: _Optional[_Union[TrialState.Phase, str]] = ..., track: _Optional[str] = ..., seed: _Optional[int] = ..., time_s: _Optional[float] = ..., distance_m: _Optional[float] = ..., finish_m: _Optional[float] = ..., lateral_offset_m: _Optional[float] = ..., heading_error_rad: _Optional[float] = ..., on_track: bool = ..., failures: _Optional[_Union[FailureCounts, _Mapping]] = ..., failed_attempts: _Optional[int] = ..., withdrawn_failures: _Optional[int] = ..., operator_put_backs: _Optional[int] = ..., task: _Optional[str] = ..., task_phase: _Optional[_Union[TrialState.TaskPhase, str]] = ..., to_mark_m: _Optional[float] = ..., instruction: _Optional[str] = ...) -> None: ...

class Gait(int, metaclass=_enum_type_wrapper.EnumTypeWrapper):
    __slots__ = []

class FailureCause(int, metaclass=_enum_type_wrapper.EnumTypeWrapper):
    __slots__ = []

class UserInterface(int, metaclass=_enum_type_wrapper.EnumTypeWrapper):
    __slots__ = []

class Activity(int, metaclass=_enum_type_wrapper.EnumTypeWrapper):
    __slots__ = []

class TurnSource(int, metaclass=_enum_type_wrapper.EnumTypeWrapper):
    __slots__ = []
