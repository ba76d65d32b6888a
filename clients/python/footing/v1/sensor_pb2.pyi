from footing.v1 import device_pb2 as _device_pb2
from google.protobuf.internal import containers as _containers
from google.protobuf.internal import enum_type_wrapper as _enum_type_wrapper
from google.protobuf import descriptor as _descriptor
from google.protobuf import message as _message
from typing import ClassVar as _ClassVar, Iterable as _Iterable, Mapping as _Mapping, Optional as _Optional, Union as _Union

DESCRIPTOR: _descriptor.FileDescriptor
GAMEPAD_BUTTON_A: GamepadButton
GAMEPAD_BUTTON_B: GamepadButton
GAMEPAD_BUTTON_DOWN: GamepadButton
GAMEPAD_BUTTON_HOME: GamepadButton
GAMEPAD_BUTTON_L: GamepadButton
GAMEPAD_BUTTON_LEFT: GamepadButton
GAMEPAD_BUTTON_LEFT_STICK: GamepadButton
GAMEPAD_BUTTON_MINUS: GamepadButton
GAMEPAD_BUTTON_PLUS: GamepadButton
GAMEPAD_BUTTON_R: GamepadButton
GAMEPAD_BUTTON_RIGHT: GamepadButton
GAMEPAD_BUTTON_RIGHT_STICK: GamepadButton
GAMEPAD_BUTTON_UNSPECIFIED: GamepadButton
GAMEPAD_BUTTON_UP: GamepadButton
GAMEPAD_BUTTON_X: GamepadButton
GAMEPAD_BUTTON_Y: GamepadButton
GAMEPAD_BUTTON_ZL: GamepadButton
GAMEPAD_BUTTON_ZR: GamepadButton
GESTURE_HOLD_STILL: Gesture
GESTURE_LEAN: Gesture
GESTURE_SHAKE: Gesture
GESTURE_STAND: Gesture
GESTURE_STEP_OFF: Gesture
GESTURE_STEP_ON: Gesture
GESTURE_SWITCH_ON: Gesture
GESTURE_TAKE_STEPS: Gesture
GESTURE_UNSPECIFIED: Gesture

class BoardGeometry(_message.Message):
    __slots__ = ["plate_x_m", "plate_y_m", "sensor_distance_x_m", "sensor_distance_y_m"]
    PLATE_X_M_FIELD_NUMBER: _ClassVar[int]
    PLATE_Y_M_FIELD_NUMBER: _ClassVar[int]
    SENSOR_DISTANCE_X_M_FIELD_NUMBER: _ClassVar[int]
    SENSOR_DISTANCE_Y_M_FIELD_NUMBER: _ClassVar[int]
    plate_x_m: float
    plate_y_m: float
    sensor_distance_x_m: float
    sensor_distance_y_m: float
    def __init__(self, plate_x_m: _Optional[float] = ..., plate_y_m: _Optional[float] = ..., sensor_distance_x_m: _Optional[float] = ..., sensor_distance_y_m: _Optional[float] = ...) -> None: ...

class BoardLayout(_message.Message):
    __slots__ = ["gap_mm", "left", "left_geometry", "preset", "rig", "right", "right_geometry"]
    GAP_MM_FIELD_NUMBER: _ClassVar[int]
    LEFT_FIELD_NUMBER: _ClassVar[int]
    LEFT_GEOMETRY_FIELD_NUMBER: _ClassVar[int]
    PRESET_FIELD_NUMBER: _ClassVar[int]
    RIGHT_FIELD_NUMBER: _ClassVar[int]
    RIGHT_GEOMETRY_FIELD_NUMBER: _ClassVar[int]
    RIG_FIELD_NUMBER: _ClassVar[int]
    gap_mm: float
    left: BoardPose
    left_geometry: BoardGeometry
    preset: str
    rig: str
    right: BoardPose
    right_geometry: BoardGeometry
    def __init__(self, rig: _Optional[str] = ..., left: _Optional[_Union[BoardPose, _Mapping]] = ..., right: _Optional[_Union[BoardPose, _Mapping]] = ..., gap_mm: _Optional[float] = ..., preset: _Optional[str] = ..., left_geometry: _Optional[_Union[BoardGeometry, _Mapping]] = ..., right_geometry: _Optional[_Union[BoardGeometry, _Mapping]] = ...) -> None: ...

class BoardPose(_message.Message):
    __slots__ = ["x_m", "y_m", "yaw_rad"]
    X_M_FIELD_NUMBER: _ClassVar[int]
    YAW_RAD_FIELD_NUMBER: _ClassVar[int]
    Y_M_FIELD_NUMBER: _ClassVar[int]
    x_m: float
    y_m: float
    yaw_rad: float
    def __init__(self, x_m: _Optional[float] = ..., y_m: _Optional[float] = ..., yaw_rad: _Optional[float] = ...) -> None: ...

class BoardSample(_message.Message):
    __slots__ = ["bottom_left_n", "bottom_right_n", "contact", "cop_valid", "cop_x_m", "cop_y_m", "device", "received_ns", "repeated", "report_count", "sampled_ns", "simulated", "tared", "top_left_n", "top_right_n", "total_n", "uncalibrated"]
    BOTTOM_LEFT_N_FIELD_NUMBER: _ClassVar[int]
    BOTTOM_RIGHT_N_FIELD_NUMBER: _ClassVar[int]
    CONTACT_FIELD_NUMBER: _ClassVar[int]
    COP_VALID_FIELD_NUMBER: _ClassVar[int]
    COP_X_M_FIELD_NUMBER: _ClassVar[int]
    COP_Y_M_FIELD_NUMBER: _ClassVar[int]
    DEVICE_FIELD_NUMBER: _ClassVar[int]
    RECEIVED_NS_FIELD_NUMBER: _ClassVar[int]
    REPEATED_FIELD_NUMBER: _ClassVar[int]
    REPORT_COUNT_FIELD_NUMBER: _ClassVar[int]
    SAMPLED_NS_FIELD_NUMBER: _ClassVar[int]
    SIMULATED_FIELD_NUMBER: _ClassVar[int]
    TARED_FIELD_NUMBER: _ClassVar[int]
    TOP_LEFT_N_FIELD_NUMBER: _ClassVar[int]
    TOP_RIGHT_N_FIELD_NUMBER: _ClassVar[int]
    TOTAL_N_FIELD_NUMBER: _ClassVar[int]
    UNCALIBRATED_FIELD_NUMBER: _ClassVar[int]
    bottom_left_n: float
    bottom_right_n: float
    contact: bool
    cop_valid: bool
    cop_x_m: float
    cop_y_m: float
    device: int
    received_ns: int
    repeated: bool
    report_count: int
    sampled_ns: int
    simulated: bool
    tared: bool
    top_left_n: float
    top_right_n: float
    total_n: float
    uncalibrated: bool
    def __init__(self, device: _Optional[int] = ..., report_count: _Optional[int] = ..., received_ns: _Optional[int] = ..., sampled_ns: _Optional[int] = ..., top_left_n: _Optional[float] = ..., top_right_n: _Optional[float] = ..., bottom_left_n: _Optional[float] = ..., bottom_right_n: _Optional[float] = ..., total_n: _Optional[float] = ..., cop_valid: bool = ..., cop_x_m: _Optional[float] = ..., cop_y_m: _Optional[float] = ..., contact: bool = ..., repeated: bool = ..., uncalibrated: bool = ..., simulated: bool = ..., tared: bool = ...) -> None: ...

class BoardSamples(_message.Message):
    __slots__ = ["samples"]
    SAMPLES_FIELD_NUMBER: _ClassVar[int]
    samples: _containers.RepeatedCompositeFieldContainer[BoardSample]
    def __init__(self, samples: _Optional[_Iterable[_Union[BoardSample, _Mapping]]] = ...) -> None: ...

class CameraPoint(_message.Message):
    __slots__ = ["size", "x", "y"]
    SIZE_FIELD_NUMBER: _ClassVar[int]
    X_FIELD_NUMBER: _ClassVar[int]
    Y_FIELD_NUMBER: _ClassVar[int]
    size: int
    x: int
    y: int
    def __init__(self, x: _Optional[int] = ..., y: _Optional[int] = ..., size: _Optional[int] = ...) -> None: ...

class CameraSample(_message.Message):
    __slots__ = ["device", "points", "received_ns", "sampled_ns", "simulated"]
    DEVICE_FIELD_NUMBER: _ClassVar[int]
    POINTS_FIELD_NUMBER: _ClassVar[int]
    RECEIVED_NS_FIELD_NUMBER: _ClassVar[int]
    SAMPLED_NS_FIELD_NUMBER: _ClassVar[int]
    SIMULATED_FIELD_NUMBER: _ClassVar[int]
    device: int
    points: _containers.RepeatedCompositeFieldContainer[CameraPoint]
    received_ns: int
    sampled_ns: int
    simulated: bool
    def __init__(self, device: _Optional[int] = ..., received_ns: _Optional[int] = ..., sampled_ns: _Optional[int] = ..., points: _Optional[_Iterable[_Union[CameraPoint, _Mapping]]] = ..., simulated: bool = ...) -> None: ...

class CameraSamples(_message.Message):
    __slots__ = ["samples"]
    SAMPLES_FIELD_NUMBER: _ClassVar[int]
    samples: _containers.RepeatedCompositeFieldContainer[CameraSample]
    def __init__(self, samples: _Optional[_Iterable[_Union[CameraSample, _Mapping]]] = ...) -> None: ...

class ContactSample(_message.Message):
    __slots__ = ["body", "cells", "received_ns", "rig", "sampled_ns", "simulated", "source"]
    BODY_FIELD_NUMBER: _ClassVar[int]
    CELLS_FIELD_NUMBER: _ClassVar[int]
    RECEIVED_NS_FIELD_NUMBER: _ClassVar[int]
    RIG_FIELD_NUMBER: _ClassVar[int]
    SAMPLED_NS_FIELD_NUMBER: _ClassVar[int]
    SIMULATED_FIELD_NUMBER: _ClassVar[int]
    SOURCE_FIELD_NUMBER: _ClassVar[int]
    body: _device_pb2.ContactBody
    cells: _containers.RepeatedCompositeFieldContainer[_device_pb2.ContactCell]
    received_ns: int
    rig: str
    sampled_ns: int
    simulated: bool
    source: str
    def __init__(self, rig: _Optional[str] = ..., source: _Optional[str] = ..., body: _Optional[_Union[_device_pb2.ContactBody, str]] = ..., received_ns: _Optional[int] = ..., sampled_ns: _Optional[int] = ..., cells: _Optional[_Iterable[_Union[_device_pb2.ContactCell, _Mapping]]] = ..., simulated: bool = ...) -> None: ...

class ContactSamples(_message.Message):
    __slots__ = ["samples"]
    SAMPLES_FIELD_NUMBER: _ClassVar[int]
    samples: _containers.RepeatedCompositeFieldContainer[ContactSample]
    def __init__(self, samples: _Optional[_Iterable[_Union[ContactSample, _Mapping]]] = ...) -> None: ...

class DeviceFeatures(_message.Message):
    __slots__ = ["amplitude_mps2", "amplitude_valid", "axial_rad", "axial_valid", "device", "frequency_hz", "frequency_valid", "held", "inclination_valid", "moving", "pitch_rad", "role", "roll_rad", "simulated", "swing_rad", "swing_valid"]
    AMPLITUDE_MPS2_FIELD_NUMBER: _ClassVar[int]
    AMPLITUDE_VALID_FIELD_NUMBER: _ClassVar[int]
    AXIAL_RAD_FIELD_NUMBER: _ClassVar[int]
    AXIAL_VALID_FIELD_NUMBER: _ClassVar[int]
    DEVICE_FIELD_NUMBER: _ClassVar[int]
    FREQUENCY_HZ_FIELD_NUMBER: _ClassVar[int]
    FREQUENCY_VALID_FIELD_NUMBER: _ClassVar[int]
    HELD_FIELD_NUMBER: _ClassVar[int]
    INCLINATION_VALID_FIELD_NUMBER: _ClassVar[int]
    MOVING_FIELD_NUMBER: _ClassVar[int]
    PITCH_RAD_FIELD_NUMBER: _ClassVar[int]
    ROLE_FIELD_NUMBER: _ClassVar[int]
    ROLL_RAD_FIELD_NUMBER: _ClassVar[int]
    SIMULATED_FIELD_NUMBER: _ClassVar[int]
    SWING_RAD_FIELD_NUMBER: _ClassVar[int]
    SWING_VALID_FIELD_NUMBER: _ClassVar[int]
    amplitude_mps2: float
    amplitude_valid: bool
    axial_rad: float
    axial_valid: bool
    device: int
    frequency_hz: float
    frequency_valid: bool
    held: bool
    inclination_valid: bool
    moving: bool
    pitch_rad: float
    role: _device_pb2.DeviceRole
    roll_rad: float
    simulated: bool
    swing_rad: float
    swing_valid: bool
    def __init__(self, device: _Optional[int] = ..., moving: bool = ..., frequency_valid: bool = ..., frequency_hz: _Optional[float] = ..., amplitude_valid: bool = ..., amplitude_mps2: _Optional[float] = ..., inclination_valid: bool = ..., roll_rad: _Optional[float] = ..., pitch_rad: _Optional[float] = ..., held: bool = ..., simulated: bool = ..., role: _Optional[_Union[_device_pb2.DeviceRole, str]] = ..., swing_valid: bool = ..., swing_rad: _Optional[float] = ..., axial_valid: bool = ..., axial_rad: _Optional[float] = ...) -> None: ...

class DeviceMounting(_message.Message):
    __slots__ = ["residual_rad", "rotation", "serial"]
    RESIDUAL_RAD_FIELD_NUMBER: _ClassVar[int]
    ROTATION_FIELD_NUMBER: _ClassVar[int]
    SERIAL_FIELD_NUMBER: _ClassVar[int]
    residual_rad: float
    rotation: Quaternion
    serial: str
    def __init__(self, serial: _Optional[str] = ..., rotation: _Optional[_Union[Quaternion, _Mapping]] = ..., residual_rad: _Optional[float] = ...) -> None: ...

class FeatureFrame(_message.Message):
    __slots__ = ["rigs"]
    RIGS_FIELD_NUMBER: _ClassVar[int]
    rigs: _containers.RepeatedCompositeFieldContainer[RigFeatures]
    def __init__(self, rigs: _Optional[_Iterable[_Union[RigFeatures, _Mapping]]] = ...) -> None: ...

class GamepadSample(_message.Message):
    __slots__ = ["buttons", "device", "left_trigger", "left_x", "left_y", "received_ns", "repeated", "report_count", "right_trigger", "right_x", "right_y", "sampled_ns", "simulated", "uncalibrated"]
    BUTTONS_FIELD_NUMBER: _ClassVar[int]
    DEVICE_FIELD_NUMBER: _ClassVar[int]
    LEFT_TRIGGER_FIELD_NUMBER: _ClassVar[int]
    LEFT_X_FIELD_NUMBER: _ClassVar[int]
    LEFT_Y_FIELD_NUMBER: _ClassVar[int]
    RECEIVED_NS_FIELD_NUMBER: _ClassVar[int]
    REPEATED_FIELD_NUMBER: _ClassVar[int]
    REPORT_COUNT_FIELD_NUMBER: _ClassVar[int]
    RIGHT_TRIGGER_FIELD_NUMBER: _ClassVar[int]
    RIGHT_X_FIELD_NUMBER: _ClassVar[int]
    RIGHT_Y_FIELD_NUMBER: _ClassVar[int]
    SAMPLED_NS_FIELD_NUMBER: _ClassVar[int]
    SIMULATED_FIELD_NUMBER: _ClassVar[int]
    UNCALIBRATED_FIELD_NUMBER: _ClassVar[int]
    buttons: int
    device: int
    left_trigger: float
    left_x: float
    left_y: float
    received_ns: int
    repeated: bool
    report_count: int
    right_trigger: float
    right_x: float
    right_y: float
    sampled_ns: int
    simulated: bool
    uncalibrated: bool
    def __init__(self, device: _Optional[int] = ..., report_count: _Optional[int] = ..., received_ns: _Optional[int] = ..., sampled_ns: _Optional[int] = ..., left_x: _Optional[float] = ..., left_y: _Optional[float] = ..., right_x: _Optional[float] = ..., right_y: _Optional[float] = ..., left_trigger: _Optional[float] = ..., right_trigger: _Optional[float] = ..., buttons: _Optional[int] = ..., repeated: bool = ..., uncalibrated: bool = ..., simulated: bool = ...) -> None: ...

class GamepadSamples(_message.Message):
    __slots__ = ["samples"]
    SAMPLES_FIELD_NUMBER: _ClassVar[int]
    samples: _containers.RepeatedCompositeFieldContainer[GamepadSample]
    def __init__(self, samples: _Optional[_Iterable[_Union[GamepadSample, _Mapping]]] = ...) -> None: ...

class HandSample(_message.Message):
    __slots__ = ["confidence", "covariance_m2", "joint", "occluded", "position_m", "received_ns", "rig", "role", "sampled_ns", "saturated", "sd_m", "simulated", "tracker", "tracker_pose"]
    CONFIDENCE_FIELD_NUMBER: _ClassVar[int]
    COVARIANCE_M2_FIELD_NUMBER: _ClassVar[int]
    JOINT_FIELD_NUMBER: _ClassVar[int]
    OCCLUDED_FIELD_NUMBER: _ClassVar[int]
    POSITION_M_FIELD_NUMBER: _ClassVar[int]
    RECEIVED_NS_FIELD_NUMBER: _ClassVar[int]
    RIG_FIELD_NUMBER: _ClassVar[int]
    ROLE_FIELD_NUMBER: _ClassVar[int]
    SAMPLED_NS_FIELD_NUMBER: _ClassVar[int]
    SATURATED_FIELD_NUMBER: _ClassVar[int]
    SD_M_FIELD_NUMBER: _ClassVar[int]
    SIMULATED_FIELD_NUMBER: _ClassVar[int]
    TRACKER_FIELD_NUMBER: _ClassVar[int]
    TRACKER_POSE_FIELD_NUMBER: _ClassVar[int]
    confidence: float
    covariance_m2: Vector3
    joint: _device_pb2.BodyJoint
    occluded: bool
    position_m: Vector3
    received_ns: int
    rig: str
    role: _device_pb2.DeviceRole
    sampled_ns: int
    saturated: bool
    sd_m: Vector3
    simulated: bool
    tracker: str
    tracker_pose: _device_pb2.TrackerPose
    def __init__(self, rig: _Optional[str] = ..., role: _Optional[_Union[_device_pb2.DeviceRole, str]] = ..., received_ns: _Optional[int] = ..., sampled_ns: _Optional[int] = ..., position_m: _Optional[_Union[Vector3, _Mapping]] = ..., sd_m: _Optional[_Union[Vector3, _Mapping]] = ..., confidence: _Optional[float] = ..., simulated: bool = ..., tracker: _Optional[str] = ..., covariance_m2: _Optional[_Union[Vector3, _Mapping]] = ..., saturated: bool = ..., occluded: bool = ..., tracker_pose: _Optional[_Union[_device_pb2.TrackerPose, _Mapping]] = ..., joint: _Optional[_Union[_device_pb2.BodyJoint, str]] = ...) -> None: ...

class HandSamples(_message.Message):
    __slots__ = ["samples"]
    SAMPLES_FIELD_NUMBER: _ClassVar[int]
    samples: _containers.RepeatedCompositeFieldContainer[HandSample]
    def __init__(self, samples: _Optional[_Iterable[_Union[HandSample, _Mapping]]] = ...) -> None: ...

class MotionSample(_message.Message):
    __slots__ = ["angular_velocity_clipped", "angular_velocity_radps", "buttons", "clipped_axes", "device", "filtered_mps2", "gyroscope_bias_radps", "gyroscope_uncalibrated", "magnetic_field", "received_ns", "repeated", "report_count", "sampled_ns", "simulated", "specific_force_mps2", "temperature_c", "trigger", "uncalibrated"]
    ANGULAR_VELOCITY_CLIPPED_FIELD_NUMBER: _ClassVar[int]
    ANGULAR_VELOCITY_RADPS_FIELD_NUMBER: _ClassVar[int]
    BUTTONS_FIELD_NUMBER: _ClassVar[int]
    CLIPPED_AXES_FIELD_NUMBER: _ClassVar[int]
    DEVICE_FIELD_NUMBER: _ClassVar[int]
    FILTERED_MPS2_FIELD_NUMBER: _ClassVar[int]
    GYROSCOPE_BIAS_RADPS_FIELD_NUMBER: _ClassVar[int]
    GYROSCOPE_UNCALIBRATED_FIELD_NUMBER: _ClassVar[int]
    MAGNETIC_FIELD_FIELD_NUMBER: _ClassVar[int]
    RECEIVED_NS_FIELD_NUMBER: _ClassVar[int]
    REPEATED_FIELD_NUMBER: _ClassVar[int]
    REPORT_COUNT_FIELD_NUMBER: _ClassVar[int]
    SAMPLED_NS_FIELD_NUMBER: _ClassVar[int]
    SIMULATED_FIELD_NUMBER: _ClassVar[int]
    SPECIFIC_FORCE_MPS2_FIELD_NUMBER: _ClassVar[int]
    TEMPERATURE_C_FIELD_NUMBER: _ClassVar[int]
    TRIGGER_FIELD_NUMBER: _ClassVar[int]
    UNCALIBRATED_FIELD_NUMBER: _ClassVar[int]
    angular_velocity_clipped: bool
    angular_velocity_radps: Vector3
    buttons: int
    clipped_axes: int
    device: int
    filtered_mps2: Vector3
    gyroscope_bias_radps: Vector3
    gyroscope_uncalibrated: bool
    magnetic_field: Vector3
    received_ns: int
    repeated: bool
    report_count: int
    sampled_ns: int
    simulated: bool
    specific_force_mps2: Vector3
    temperature_c: float
    trigger: float
    uncalibrated: bool
    def __init__(self, device: _Optional[int] = ..., report_count: _Optional[int] = ..., received_ns: _Optional[int] = ..., sampled_ns: _Optional[int] = ..., specific_force_mps2: _Optional[_Union[Vector3, _Mapping]] = ..., filtered_mps2: _Optional[_Union[Vector3, _Mapping]] = ..., clipped_axes: _Optional[int] = ..., repeated: bool = ..., uncalibrated: bool = ..., simulated: bool = ..., buttons: _Optional[int] = ..., angular_velocity_radps: _Optional[_Union[Vector3, _Mapping]] = ..., angular_velocity_clipped: bool = ..., gyroscope_uncalibrated: bool = ..., magnetic_field: _Optional[_Union[Vector3, _Mapping]] = ..., trigger: _Optional[float] = ..., temperature_c: _Optional[float] = ..., gyroscope_bias_radps: _Optional[_Union[Vector3, _Mapping]] = ...) -> None: ...

class MotionSamples(_message.Message):
    __slots__ = ["samples"]
    SAMPLES_FIELD_NUMBER: _ClassVar[int]
    samples: _containers.RepeatedCompositeFieldContainer[MotionSample]
    def __init__(self, samples: _Optional[_Iterable[_Union[MotionSample, _Mapping]]] = ...) -> None: ...

class NunchukSample(_message.Message):
    __slots__ = ["c", "clipped_axes", "device", "received_ns", "repeated", "report_count", "sampled_ns", "simulated", "specific_force_mps2", "stick_x", "stick_y", "uncalibrated", "z"]
    CLIPPED_AXES_FIELD_NUMBER: _ClassVar[int]
    C_FIELD_NUMBER: _ClassVar[int]
    DEVICE_FIELD_NUMBER: _ClassVar[int]
    RECEIVED_NS_FIELD_NUMBER: _ClassVar[int]
    REPEATED_FIELD_NUMBER: _ClassVar[int]
    REPORT_COUNT_FIELD_NUMBER: _ClassVar[int]
    SAMPLED_NS_FIELD_NUMBER: _ClassVar[int]
    SIMULATED_FIELD_NUMBER: _ClassVar[int]
    SPECIFIC_FORCE_MPS2_FIELD_NUMBER: _ClassVar[int]
    STICK_X_FIELD_NUMBER: _ClassVar[int]
    STICK_Y_FIELD_NUMBER: _ClassVar[int]
    UNCALIBRATED_FIELD_NUMBER: _ClassVar[int]
    Z_FIELD_NUMBER: _ClassVar[int]
    c: bool
    clipped_axes: int
    device: int
    received_ns: int
    repeated: bool
    report_count: int
    sampled_ns: int
    simulated: bool
    specific_force_mps2: Vector3
    stick_x: float
    stick_y: float
    uncalibrated: bool
    z: bool
    def __init__(self, device: _Optional[int] = ..., report_count: _Optional[int] = ..., received_ns: _Optional[int] = ..., sampled_ns: _Optional[int] = ..., stick_x: _Optional[float] = ..., stick_y: _Optional[float] = ..., c: bool = ..., z: bool = ..., specific_force_mps2: _Optional[_Union[Vector3, _Mapping]] = ..., clipped_axes: _Optional[int] = ..., repeated: bool = ..., uncalibrated: bool = ..., simulated: bool = ...) -> None: ...

class NunchukSamples(_message.Message):
    __slots__ = ["samples"]
    SAMPLES_FIELD_NUMBER: _ClassVar[int]
    samples: _containers.RepeatedCompositeFieldContainer[NunchukSample]
    def __init__(self, samples: _Optional[_Iterable[_Union[NunchukSample, _Mapping]]] = ...) -> None: ...

class PairFeatures(_message.Message):
    __slots__ = ["left_device", "phase_held", "phase_rad", "phase_valid", "right_device"]
    LEFT_DEVICE_FIELD_NUMBER: _ClassVar[int]
    PHASE_HELD_FIELD_NUMBER: _ClassVar[int]
    PHASE_RAD_FIELD_NUMBER: _ClassVar[int]
    PHASE_VALID_FIELD_NUMBER: _ClassVar[int]
    RIGHT_DEVICE_FIELD_NUMBER: _ClassVar[int]
    left_device: int
    phase_held: bool
    phase_rad: float
    phase_valid: bool
    right_device: int
    def __init__(self, left_device: _Optional[int] = ..., right_device: _Optional[int] = ..., phase_valid: bool = ..., phase_rad: _Optional[float] = ..., phase_held: bool = ...) -> None: ...

class Quaternion(_message.Message):
    __slots__ = ["w", "x", "y", "z"]
    W_FIELD_NUMBER: _ClassVar[int]
    X_FIELD_NUMBER: _ClassVar[int]
    Y_FIELD_NUMBER: _ClassVar[int]
    Z_FIELD_NUMBER: _ClassVar[int]
    w: float
    x: float
    y: float
    z: float
    def __init__(self, w: _Optional[float] = ..., x: _Optional[float] = ..., y: _Optional[float] = ..., z: _Optional[float] = ...) -> None: ...

class ReferencePose(_message.Message):
    __slots__ = ["com_m", "parents", "positions_m", "rig", "sampled_ns"]
    COM_M_FIELD_NUMBER: _ClassVar[int]
    PARENTS_FIELD_NUMBER: _ClassVar[int]
    POSITIONS_M_FIELD_NUMBER: _ClassVar[int]
    RIG_FIELD_NUMBER: _ClassVar[int]
    SAMPLED_NS_FIELD_NUMBER: _ClassVar[int]
    com_m: Vector3
    parents: _containers.RepeatedScalarFieldContainer[int]
    positions_m: _containers.RepeatedCompositeFieldContainer[Vector3]
    rig: str
    sampled_ns: int
    def __init__(self, rig: _Optional[str] = ..., sampled_ns: _Optional[int] = ..., parents: _Optional[_Iterable[int]] = ..., positions_m: _Optional[_Iterable[_Union[Vector3, _Mapping]]] = ..., com_m: _Optional[_Union[Vector3, _Mapping]] = ...) -> None: ...

class ReferencePoses(_message.Message):
    __slots__ = ["poses"]
    POSES_FIELD_NUMBER: _ClassVar[int]
    poses: _containers.RepeatedCompositeFieldContainer[ReferencePose]
    def __init__(self, poses: _Optional[_Iterable[_Union[ReferencePose, _Mapping]]] = ...) -> None: ...

class RigFeatures(_message.Message):
    __slots__ = ["computed_ns", "decoded_ns", "devices", "newest_received_ns", "pairs", "rig"]
    COMPUTED_NS_FIELD_NUMBER: _ClassVar[int]
    DECODED_NS_FIELD_NUMBER: _ClassVar[int]
    DEVICES_FIELD_NUMBER: _ClassVar[int]
    NEWEST_RECEIVED_NS_FIELD_NUMBER: _ClassVar[int]
    PAIRS_FIELD_NUMBER: _ClassVar[int]
    RIG_FIELD_NUMBER: _ClassVar[int]
    computed_ns: int
    decoded_ns: int
    devices: _containers.RepeatedCompositeFieldContainer[DeviceFeatures]
    newest_received_ns: int
    pairs: _containers.RepeatedCompositeFieldContainer[PairFeatures]
    rig: str
    def __init__(self, rig: _Optional[str] = ..., devices: _Optional[_Iterable[_Union[DeviceFeatures, _Mapping]]] = ..., pairs: _Optional[_Iterable[_Union[PairFeatures, _Mapping]]] = ..., newest_received_ns: _Optional[int] = ..., decoded_ns: _Optional[int] = ..., computed_ns: _Optional[int] = ...) -> None: ...

class RigSetup(_message.Message):
    __slots__ = ["items", "layout", "mountings", "prompt", "rig"]
    ITEMS_FIELD_NUMBER: _ClassVar[int]
    LAYOUT_FIELD_NUMBER: _ClassVar[int]
    MOUNTINGS_FIELD_NUMBER: _ClassVar[int]
    PROMPT_FIELD_NUMBER: _ClassVar[int]
    RIG_FIELD_NUMBER: _ClassVar[int]
    items: _containers.RepeatedCompositeFieldContainer[SetupItem]
    layout: BoardLayout
    mountings: _containers.RepeatedCompositeFieldContainer[DeviceMounting]
    prompt: SetupPrompt
    rig: str
    def __init__(self, rig: _Optional[str] = ..., layout: _Optional[_Union[BoardLayout, _Mapping]] = ..., items: _Optional[_Iterable[_Union[SetupItem, _Mapping]]] = ..., mountings: _Optional[_Iterable[_Union[DeviceMounting, _Mapping]]] = ..., prompt: _Optional[_Union[SetupPrompt, _Mapping]] = ...) -> None: ...

class SetupItem(_message.Message):
    __slots__ = ["name", "note", "passed", "residual", "serial", "stale", "unit", "wall_time_ns"]
    NAME_FIELD_NUMBER: _ClassVar[int]
    NOTE_FIELD_NUMBER: _ClassVar[int]
    PASSED_FIELD_NUMBER: _ClassVar[int]
    RESIDUAL_FIELD_NUMBER: _ClassVar[int]
    SERIAL_FIELD_NUMBER: _ClassVar[int]
    STALE_FIELD_NUMBER: _ClassVar[int]
    UNIT_FIELD_NUMBER: _ClassVar[int]
    WALL_TIME_NS_FIELD_NUMBER: _ClassVar[int]
    name: str
    note: str
    passed: bool
    residual: float
    serial: str
    stale: bool
    unit: str
    wall_time_ns: int
    def __init__(self, name: _Optional[str] = ..., serial: _Optional[str] = ..., passed: bool = ..., wall_time_ns: _Optional[int] = ..., residual: _Optional[float] = ..., unit: _Optional[str] = ..., note: _Optional[str] = ..., stale: bool = ...) -> None: ...

class SetupPrompt(_message.Message):
    __slots__ = ["gesture", "item", "number", "role", "text"]
    GESTURE_FIELD_NUMBER: _ClassVar[int]
    ITEM_FIELD_NUMBER: _ClassVar[int]
    NUMBER_FIELD_NUMBER: _ClassVar[int]
    ROLE_FIELD_NUMBER: _ClassVar[int]
    TEXT_FIELD_NUMBER: _ClassVar[int]
    gesture: Gesture
    item: str
    number: int
    role: _device_pb2.DeviceRole
    text: str
    def __init__(self, item: _Optional[str] = ..., text: _Optional[str] = ..., gesture: _Optional[_Union[Gesture, str]] = ..., role: _Optional[_Union[_device_pb2.DeviceRole, str]] = ..., number: _Optional[int] = ...) -> None: ...

class SetupState(_message.Message):
    __slots__ = ["rigs"]
    RIGS_FIELD_NUMBER: _ClassVar[int]
    rigs: _containers.RepeatedCompositeFieldContainer[RigSetup]
    def __init__(self, rigs: _Optional[_Iterable[_Union[RigSetup, _Mapping]]] = ...) -> None: ...

class UniformBoardSample(_message.Message):
    __slots__ = ["bottom_left_n", "bottom_right_n", "cop_valid", "cop_x_m", "cop_y_m", "device", "gap", "sampled_ns", "samples", "simulated", "top_left_n", "top_right_n", "total_n"]
    BOTTOM_LEFT_N_FIELD_NUMBER: _ClassVar[int]
    BOTTOM_RIGHT_N_FIELD_NUMBER: _ClassVar[int]
    COP_VALID_FIELD_NUMBER: _ClassVar[int]
    COP_X_M_FIELD_NUMBER: _ClassVar[int]
    COP_Y_M_FIELD_NUMBER: _ClassVar[int]
    DEVICE_FIELD_NUMBER: _ClassVar[int]
    GAP_FIELD_NUMBER: _ClassVar[int]
    SAMPLED_NS_FIELD_NUMBER: _ClassVar[int]
    SAMPLES_FIELD_NUMBER: _ClassVar[int]
    SIMULATED_FIELD_NUMBER: _ClassVar[int]
    TOP_LEFT_N_FIELD_NUMBER: _ClassVar[int]
    TOP_RIGHT_N_FIELD_NUMBER: _ClassVar[int]
    TOTAL_N_FIELD_NUMBER: _ClassVar[int]
    bottom_left_n: float
    bottom_right_n: float
    cop_valid: bool
    cop_x_m: float
    cop_y_m: float
    device: int
    gap: bool
    sampled_ns: int
    samples: int
    simulated: bool
    top_left_n: float
    top_right_n: float
    total_n: float
    def __init__(self, device: _Optional[int] = ..., sampled_ns: _Optional[int] = ..., top_left_n: _Optional[float] = ..., top_right_n: _Optional[float] = ..., bottom_left_n: _Optional[float] = ..., bottom_right_n: _Optional[float] = ..., total_n: _Optional[float] = ..., cop_valid: bool = ..., cop_x_m: _Optional[float] = ..., cop_y_m: _Optional[float] = ..., samples: _Optional[int] = ..., gap: bool = ..., simulated: bool = ...) -> None: ...

class UniformBoardSamples(_message.Message):
    __slots__ = ["samples"]
    SAMPLES_FIELD_NUMBER: _ClassVar[int]
    samples: _containers.RepeatedCompositeFieldContainer[UniformBoardSample]
    def __init__(self, samples: _Optional[_Iterable[_Union[UniformBoardSample, _Mapping]]] = ...) -> None: ...

class Vector3(_message.Message):
    __slots__ = ["x", "y", "z"]
    X_FIELD_NUMBER: _ClassVar[int]
    Y_FIELD_NUMBER: _ClassVar[int]
    Z_FIELD_NUMBER: _ClassVar[int]
    x: float
    y: float
    z: float
    def __init__(self, x: _Optional[float] = ..., y: _Optional[float] = ..., z: _Optional[float] = ...) -> None: ...

class GamepadButton(int, metaclass=_enum_type_wrapper.EnumTypeWrapper):
    __slots__ = []

class Gesture(int, metaclass=_enum_type_wrapper.EnumTypeWrapper):
    __slots__ = []
