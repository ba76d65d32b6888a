from google.protobuf.internal import containers as _containers
from google.protobuf.internal import enum_type_wrapper as _enum_type_wrapper
from google.protobuf import descriptor as _descriptor
from google.protobuf import message as _message
from typing import ClassVar as _ClassVar, Iterable as _Iterable, Mapping as _Mapping, Optional as _Optional, Union as _Union

BODY_JOINT_HEAD: BodyJoint
BODY_JOINT_LEFT_ELBOW: BodyJoint
BODY_JOINT_LEFT_FOOT: BodyJoint
BODY_JOINT_LEFT_HIP: BodyJoint
BODY_JOINT_LEFT_KNEE: BodyJoint
BODY_JOINT_LEFT_SHOULDER: BodyJoint
BODY_JOINT_NECK: BodyJoint
BODY_JOINT_RIGHT_ELBOW: BodyJoint
BODY_JOINT_RIGHT_FOOT: BodyJoint
BODY_JOINT_RIGHT_HIP: BodyJoint
BODY_JOINT_RIGHT_KNEE: BodyJoint
BODY_JOINT_RIGHT_SHOULDER: BodyJoint
BODY_JOINT_TORSO: BodyJoint
BODY_JOINT_UNSPECIFIED: BodyJoint
CALIBRATION_ORIGIN_DEFAULTS: CalibrationOrigin
CALIBRATION_ORIGIN_DEVICE: CalibrationOrigin
CALIBRATION_ORIGIN_DEVICE_COPY: CalibrationOrigin
CALIBRATION_ORIGIN_STORED: CalibrationOrigin
CALIBRATION_ORIGIN_UNSPECIFIED: CalibrationOrigin
CONTACT_BODY_LEFT_FOOT: ContactBody
CONTACT_BODY_RIGHT_FOOT: ContactBody
CONTACT_BODY_UNSPECIFIED: ContactBody
DESCRIPTOR: _descriptor.FileDescriptor
DEVICE_KIND_BALANCE_BOARD: DeviceKind
DEVICE_KIND_INERTIAL: DeviceKind
DEVICE_KIND_JOY_CON_LEFT: DeviceKind
DEVICE_KIND_JOY_CON_RIGHT: DeviceKind
DEVICE_KIND_PRO_CONTROLLER: DeviceKind
DEVICE_KIND_PS_MOVE: DeviceKind
DEVICE_KIND_SWITCH_PRO_CONTROLLER: DeviceKind
DEVICE_KIND_UNSPECIFIED: DeviceKind
DEVICE_KIND_WIIMOTE: DeviceKind
DEVICE_ROLE_EDITOR: DeviceRole
DEVICE_ROLE_HEAD: DeviceRole
DEVICE_ROLE_LEFT_BOARD: DeviceRole
DEVICE_ROLE_LEFT_FOREARM: DeviceRole
DEVICE_ROLE_LEFT_HAND: DeviceRole
DEVICE_ROLE_LEFT_LEG: DeviceRole
DEVICE_ROLE_LEFT_THIGH: DeviceRole
DEVICE_ROLE_LEFT_UPPER_ARM: DeviceRole
DEVICE_ROLE_PELVIS: DeviceRole
DEVICE_ROLE_RIGHT_BOARD: DeviceRole
DEVICE_ROLE_RIGHT_FOREARM: DeviceRole
DEVICE_ROLE_RIGHT_HAND: DeviceRole
DEVICE_ROLE_RIGHT_LEG: DeviceRole
DEVICE_ROLE_RIGHT_THIGH: DeviceRole
DEVICE_ROLE_RIGHT_UPPER_ARM: DeviceRole
DEVICE_ROLE_TRUNK: DeviceRole
DEVICE_ROLE_UNSPECIFIED: DeviceRole
DEVICE_STATE_CONNECTING: DeviceState
DEVICE_STATE_LIVE: DeviceState
DEVICE_STATE_LOST: DeviceState
DEVICE_STATE_STALE: DeviceState
DEVICE_STATE_UNSPECIFIED: DeviceState
EXTENSION_CLASSIC: Extension
EXTENSION_MOTION_PLUS: Extension
EXTENSION_MOTION_PLUS_CLASSIC: Extension
EXTENSION_MOTION_PLUS_NUNCHUK: Extension
EXTENSION_NONE: Extension
EXTENSION_NUNCHUK: Extension
EXTENSION_UNKNOWN: Extension
EXTENSION_UNSPECIFIED: Extension

class ContactCell(_message.Message):
    __slots__ = ["load_n", "x_m", "y_m", "z_m"]
    LOAD_N_FIELD_NUMBER: _ClassVar[int]
    X_M_FIELD_NUMBER: _ClassVar[int]
    Y_M_FIELD_NUMBER: _ClassVar[int]
    Z_M_FIELD_NUMBER: _ClassVar[int]
    load_n: float
    x_m: float
    y_m: float
    z_m: float
    def __init__(self, x_m: _Optional[float] = ..., y_m: _Optional[float] = ..., z_m: _Optional[float] = ..., load_n: _Optional[float] = ...) -> None: ...

class ContactFrame(_message.Message):
    __slots__ = ["age_ns", "body", "cells", "rig", "sent_ns", "simulated", "source"]
    AGE_NS_FIELD_NUMBER: _ClassVar[int]
    BODY_FIELD_NUMBER: _ClassVar[int]
    CELLS_FIELD_NUMBER: _ClassVar[int]
    RIG_FIELD_NUMBER: _ClassVar[int]
    SENT_NS_FIELD_NUMBER: _ClassVar[int]
    SIMULATED_FIELD_NUMBER: _ClassVar[int]
    SOURCE_FIELD_NUMBER: _ClassVar[int]
    age_ns: int
    body: ContactBody
    cells: _containers.RepeatedCompositeFieldContainer[ContactCell]
    rig: str
    sent_ns: int
    simulated: bool
    source: str
    def __init__(self, source: _Optional[str] = ..., rig: _Optional[str] = ..., age_ns: _Optional[int] = ..., body: _Optional[_Union[ContactBody, str]] = ..., cells: _Optional[_Iterable[_Union[ContactCell, _Mapping]]] = ..., simulated: bool = ..., sent_ns: _Optional[int] = ...) -> None: ...

class DeviceAttach(_message.Message):
    __slots__ = ["bus", "hardware", "name", "product", "rig", "role", "serial", "slot", "vendor"]
    BUS_FIELD_NUMBER: _ClassVar[int]
    HARDWARE_FIELD_NUMBER: _ClassVar[int]
    NAME_FIELD_NUMBER: _ClassVar[int]
    PRODUCT_FIELD_NUMBER: _ClassVar[int]
    RIG_FIELD_NUMBER: _ClassVar[int]
    ROLE_FIELD_NUMBER: _ClassVar[int]
    SERIAL_FIELD_NUMBER: _ClassVar[int]
    SLOT_FIELD_NUMBER: _ClassVar[int]
    VENDOR_FIELD_NUMBER: _ClassVar[int]
    bus: int
    hardware: bool
    name: str
    product: int
    rig: str
    role: DeviceRole
    serial: str
    slot: int
    vendor: int
    def __init__(self, slot: _Optional[int] = ..., bus: _Optional[int] = ..., vendor: _Optional[int] = ..., product: _Optional[int] = ..., name: _Optional[str] = ..., serial: _Optional[str] = ..., rig: _Optional[str] = ..., role: _Optional[_Union[DeviceRole, str]] = ..., hardware: bool = ...) -> None: ...

class DeviceDetach(_message.Message):
    __slots__ = ["reason", "slot"]
    REASON_FIELD_NUMBER: _ClassVar[int]
    SLOT_FIELD_NUMBER: _ClassVar[int]
    reason: str
    slot: int
    def __init__(self, slot: _Optional[int] = ..., reason: _Optional[str] = ...) -> None: ...

class DeviceEnvelope(_message.Message):
    __slots__ = ["attach", "contact_frame", "detach", "fault", "hand_frame", "input_report", "output", "reference_frame", "refused"]
    ATTACH_FIELD_NUMBER: _ClassVar[int]
    CONTACT_FRAME_FIELD_NUMBER: _ClassVar[int]
    DETACH_FIELD_NUMBER: _ClassVar[int]
    FAULT_FIELD_NUMBER: _ClassVar[int]
    HAND_FRAME_FIELD_NUMBER: _ClassVar[int]
    INPUT_REPORT_FIELD_NUMBER: _ClassVar[int]
    OUTPUT_FIELD_NUMBER: _ClassVar[int]
    REFERENCE_FRAME_FIELD_NUMBER: _ClassVar[int]
    REFUSED_FIELD_NUMBER: _ClassVar[int]
    attach: DeviceAttach
    contact_frame: ContactFrame
    detach: DeviceDetach
    fault: DeviceFault
    hand_frame: HandFrame
    input_report: DeviceInputReport
    output: DeviceOutput
    reference_frame: ReferenceFrame
    refused: DeviceRefused
    def __init__(self, attach: _Optional[_Union[DeviceAttach, _Mapping]] = ..., input_report: _Optional[_Union[DeviceInputReport, _Mapping]] = ..., output: _Optional[_Union[DeviceOutput, _Mapping]] = ..., fault: _Optional[_Union[DeviceFault, _Mapping]] = ..., detach: _Optional[_Union[DeviceDetach, _Mapping]] = ..., hand_frame: _Optional[_Union[HandFrame, _Mapping]] = ..., reference_frame: _Optional[_Union[ReferenceFrame, _Mapping]] = ..., contact_frame: _Optional[_Union[ContactFrame, _Mapping]] = ..., refused: _Optional[_Union[DeviceRefused, _Mapping]] = ...) -> None: ...

class DeviceFault(_message.Message):
    __slots__ = ["error_number", "slot"]
    ERROR_NUMBER_FIELD_NUMBER: _ClassVar[int]
    SLOT_FIELD_NUMBER: _ClassVar[int]
    error_number: int
    slot: int
    def __init__(self, slot: _Optional[int] = ..., error_number: _Optional[int] = ...) -> None: ...

class DeviceInputReport(_message.Message):
    __slots__ = ["feature", "report", "sequence", "slot", "true_ns"]
    FEATURE_FIELD_NUMBER: _ClassVar[int]
    REPORT_FIELD_NUMBER: _ClassVar[int]
    SEQUENCE_FIELD_NUMBER: _ClassVar[int]
    SLOT_FIELD_NUMBER: _ClassVar[int]
    TRUE_NS_FIELD_NUMBER: _ClassVar[int]
    feature: bool
    report: bytes
    sequence: int
    slot: int
    true_ns: int
    def __init__(self, slot: _Optional[int] = ..., sequence: _Optional[int] = ..., report: _Optional[bytes] = ..., true_ns: _Optional[int] = ..., feature: bool = ...) -> None: ...

class DeviceOutput(_message.Message):
    __slots__ = ["channel", "report", "size", "slot"]
    class Channel(int, metaclass=_enum_type_wrapper.EnumTypeWrapper):
        __slots__ = []
    CHANNEL_FEATURE_GET: DeviceOutput.Channel
    CHANNEL_FEATURE_SET: DeviceOutput.Channel
    CHANNEL_FIELD_NUMBER: _ClassVar[int]
    CHANNEL_INTERRUPT: DeviceOutput.Channel
    CHANNEL_UNSPECIFIED: DeviceOutput.Channel
    REPORT_FIELD_NUMBER: _ClassVar[int]
    SIZE_FIELD_NUMBER: _ClassVar[int]
    SLOT_FIELD_NUMBER: _ClassVar[int]
    channel: DeviceOutput.Channel
    report: bytes
    size: int
    slot: int
    def __init__(self, slot: _Optional[int] = ..., channel: _Optional[_Union[DeviceOutput.Channel, str]] = ..., report: _Optional[bytes] = ..., size: _Optional[int] = ...) -> None: ...

class DeviceRefused(_message.Message):
    __slots__ = ["reason", "slot"]
    REASON_FIELD_NUMBER: _ClassVar[int]
    SLOT_FIELD_NUMBER: _ClassVar[int]
    reason: str
    slot: int
    def __init__(self, slot: _Optional[int] = ..., reason: _Optional[str] = ...) -> None: ...

class DeviceStatus(_message.Message):
    __slots__ = ["battery_fraction", "battery_low", "bus", "calibration", "clipped", "clock_offset_sd_ms", "device", "driver", "extension", "extension_calibration", "extension_changes", "gaps", "gyroscope_calibration", "jitter_ms", "kind", "last_report_ns", "leds", "mode_reasserts", "mounted", "moved", "name", "note", "place", "product", "queue_drops", "repeats", "report_rate_hz", "reports", "rig", "role", "rumble", "serial", "simulated", "slipped", "sphere_rgb", "state", "stored_calibration", "tared", "undecodable", "vendor", "writes_failed"]
    BATTERY_FRACTION_FIELD_NUMBER: _ClassVar[int]
    BATTERY_LOW_FIELD_NUMBER: _ClassVar[int]
    BUS_FIELD_NUMBER: _ClassVar[int]
    CALIBRATION_FIELD_NUMBER: _ClassVar[int]
    CLIPPED_FIELD_NUMBER: _ClassVar[int]
    CLOCK_OFFSET_SD_MS_FIELD_NUMBER: _ClassVar[int]
    DEVICE_FIELD_NUMBER: _ClassVar[int]
    DRIVER_FIELD_NUMBER: _ClassVar[int]
    EXTENSION_CALIBRATION_FIELD_NUMBER: _ClassVar[int]
    EXTENSION_CHANGES_FIELD_NUMBER: _ClassVar[int]
    EXTENSION_FIELD_NUMBER: _ClassVar[int]
    GAPS_FIELD_NUMBER: _ClassVar[int]
    GYROSCOPE_CALIBRATION_FIELD_NUMBER: _ClassVar[int]
    JITTER_MS_FIELD_NUMBER: _ClassVar[int]
    KIND_FIELD_NUMBER: _ClassVar[int]
    LAST_REPORT_NS_FIELD_NUMBER: _ClassVar[int]
    LEDS_FIELD_NUMBER: _ClassVar[int]
    MODE_REASSERTS_FIELD_NUMBER: _ClassVar[int]
    MOUNTED_FIELD_NUMBER: _ClassVar[int]
    MOVED_FIELD_NUMBER: _ClassVar[int]
    NAME_FIELD_NUMBER: _ClassVar[int]
    NOTE_FIELD_NUMBER: _ClassVar[int]
    PLACE_FIELD_NUMBER: _ClassVar[int]
    PRODUCT_FIELD_NUMBER: _ClassVar[int]
    QUEUE_DROPS_FIELD_NUMBER: _ClassVar[int]
    REPEATS_FIELD_NUMBER: _ClassVar[int]
    REPORTS_FIELD_NUMBER: _ClassVar[int]
    REPORT_RATE_HZ_FIELD_NUMBER: _ClassVar[int]
    RIG_FIELD_NUMBER: _ClassVar[int]
    ROLE_FIELD_NUMBER: _ClassVar[int]
    RUMBLE_FIELD_NUMBER: _ClassVar[int]
    SERIAL_FIELD_NUMBER: _ClassVar[int]
    SIMULATED_FIELD_NUMBER: _ClassVar[int]
    SLIPPED_FIELD_NUMBER: _ClassVar[int]
    SPHERE_RGB_FIELD_NUMBER: _ClassVar[int]
    STATE_FIELD_NUMBER: _ClassVar[int]
    STORED_CALIBRATION_FIELD_NUMBER: _ClassVar[int]
    TARED_FIELD_NUMBER: _ClassVar[int]
    UNDECODABLE_FIELD_NUMBER: _ClassVar[int]
    VENDOR_FIELD_NUMBER: _ClassVar[int]
    WRITES_FAILED_FIELD_NUMBER: _ClassVar[int]
    battery_fraction: float
    battery_low: bool
    bus: int
    calibration: CalibrationOrigin
    clipped: int
    clock_offset_sd_ms: float
    device: int
    driver: str
    extension: Extension
    extension_calibration: CalibrationOrigin
    extension_changes: int
    gaps: int
    gyroscope_calibration: CalibrationOrigin
    jitter_ms: float
    kind: DeviceKind
    last_report_ns: int
    leds: int
    mode_reasserts: int
    mounted: bool
    moved: bool
    name: str
    note: str
    place: str
    product: int
    queue_drops: int
    repeats: int
    report_rate_hz: float
    reports: int
    rig: str
    role: DeviceRole
    rumble: bool
    serial: str
    simulated: bool
    slipped: bool
    sphere_rgb: int
    state: DeviceState
    stored_calibration: bytes
    tared: bool
    undecodable: int
    vendor: int
    writes_failed: int
    def __init__(self, device: _Optional[int] = ..., serial: _Optional[str] = ..., kind: _Optional[_Union[DeviceKind, str]] = ..., state: _Optional[_Union[DeviceState, str]] = ..., rig: _Optional[str] = ..., role: _Optional[_Union[DeviceRole, str]] = ..., simulated: bool = ..., calibration: _Optional[_Union[CalibrationOrigin, str]] = ..., report_rate_hz: _Optional[float] = ..., jitter_ms: _Optional[float] = ..., reports: _Optional[int] = ..., gaps: _Optional[int] = ..., repeats: _Optional[int] = ..., clipped: _Optional[int] = ..., undecodable: _Optional[int] = ..., battery_fraction: _Optional[float] = ..., battery_low: bool = ..., leds: _Optional[int] = ..., rumble: bool = ..., note: _Optional[str] = ..., name: _Optional[str] = ..., last_report_ns: _Optional[int] = ..., extension: _Optional[_Union[Extension, str]] = ..., extension_calibration: _Optional[_Union[CalibrationOrigin, str]] = ..., gyroscope_calibration: _Optional[_Union[CalibrationOrigin, str]] = ..., driver: _Optional[str] = ..., place: _Optional[str] = ..., mode_reasserts: _Optional[int] = ..., queue_drops: _Optional[int] = ..., writes_failed: _Optional[int] = ..., extension_changes: _Optional[int] = ..., tared: bool = ..., mounted: bool = ..., slipped: bool = ..., moved: bool = ..., clock_offset_sd_ms: _Optional[float] = ..., sphere_rgb: _Optional[int] = ..., bus: _Optional[int] = ..., vendor: _Optional[int] = ..., product: _Optional[int] = ..., stored_calibration: _Optional[bytes] = ...) -> None: ...

class DeviceStatusList(_message.Message):
    __slots__ = ["devices"]
    DEVICES_FIELD_NUMBER: _ClassVar[int]
    devices: _containers.RepeatedCompositeFieldContainer[DeviceStatus]
    def __init__(self, devices: _Optional[_Iterable[_Union[DeviceStatus, _Mapping]]] = ...) -> None: ...

class HandFrame(_message.Message):
    __slots__ = ["age_ns", "points", "rig", "sent_ns", "simulated", "tracker", "tracker_pose"]
    AGE_NS_FIELD_NUMBER: _ClassVar[int]
    POINTS_FIELD_NUMBER: _ClassVar[int]
    RIG_FIELD_NUMBER: _ClassVar[int]
    SENT_NS_FIELD_NUMBER: _ClassVar[int]
    SIMULATED_FIELD_NUMBER: _ClassVar[int]
    TRACKER_FIELD_NUMBER: _ClassVar[int]
    TRACKER_POSE_FIELD_NUMBER: _ClassVar[int]
    age_ns: int
    points: _containers.RepeatedCompositeFieldContainer[TrackedPoint]
    rig: str
    sent_ns: int
    simulated: bool
    tracker: str
    tracker_pose: TrackerPose
    def __init__(self, tracker: _Optional[str] = ..., rig: _Optional[str] = ..., age_ns: _Optional[int] = ..., points: _Optional[_Iterable[_Union[TrackedPoint, _Mapping]]] = ..., simulated: bool = ..., tracker_pose: _Optional[_Union[TrackerPose, _Mapping]] = ..., sent_ns: _Optional[int] = ...) -> None: ...

class RawReport(_message.Message):
    __slots__ = ["device", "feature", "received_ns", "report", "simulated", "to_device", "true_ns"]
    DEVICE_FIELD_NUMBER: _ClassVar[int]
    FEATURE_FIELD_NUMBER: _ClassVar[int]
    RECEIVED_NS_FIELD_NUMBER: _ClassVar[int]
    REPORT_FIELD_NUMBER: _ClassVar[int]
    SIMULATED_FIELD_NUMBER: _ClassVar[int]
    TO_DEVICE_FIELD_NUMBER: _ClassVar[int]
    TRUE_NS_FIELD_NUMBER: _ClassVar[int]
    device: int
    feature: bool
    received_ns: int
    report: bytes
    simulated: bool
    to_device: bool
    true_ns: int
    def __init__(self, device: _Optional[int] = ..., received_ns: _Optional[int] = ..., report: _Optional[bytes] = ..., to_device: bool = ..., simulated: bool = ..., feature: bool = ..., true_ns: _Optional[int] = ...) -> None: ...

class RawReports(_message.Message):
    __slots__ = ["reports"]
    REPORTS_FIELD_NUMBER: _ClassVar[int]
    reports: _containers.RepeatedCompositeFieldContainer[RawReport]
    def __init__(self, reports: _Optional[_Iterable[_Union[RawReport, _Mapping]]] = ...) -> None: ...

class ReferenceFrame(_message.Message):
    __slots__ = ["age_ns", "com_m", "parents", "position_m", "rig", "sent_ns"]
    AGE_NS_FIELD_NUMBER: _ClassVar[int]
    COM_M_FIELD_NUMBER: _ClassVar[int]
    PARENTS_FIELD_NUMBER: _ClassVar[int]
    POSITION_M_FIELD_NUMBER: _ClassVar[int]
    RIG_FIELD_NUMBER: _ClassVar[int]
    SENT_NS_FIELD_NUMBER: _ClassVar[int]
    age_ns: int
    com_m: _containers.RepeatedScalarFieldContainer[float]
    parents: _containers.RepeatedScalarFieldContainer[int]
    position_m: _containers.RepeatedScalarFieldContainer[float]
    rig: str
    sent_ns: int
    def __init__(self, rig: _Optional[str] = ..., age_ns: _Optional[int] = ..., parents: _Optional[_Iterable[int]] = ..., position_m: _Optional[_Iterable[float]] = ..., com_m: _Optional[_Iterable[float]] = ..., sent_ns: _Optional[int] = ...) -> None: ...

class TrackedPoint(_message.Message):
    __slots__ = ["confidence", "cov_xy_m2", "cov_xz_m2", "cov_yz_m2", "joint", "occluded", "role", "saturated", "sd_x_m", "sd_y_m", "sd_z_m", "x_m", "y_m", "z_m"]
    CONFIDENCE_FIELD_NUMBER: _ClassVar[int]
    COV_XY_M2_FIELD_NUMBER: _ClassVar[int]
    COV_XZ_M2_FIELD_NUMBER: _ClassVar[int]
    COV_YZ_M2_FIELD_NUMBER: _ClassVar[int]
    JOINT_FIELD_NUMBER: _ClassVar[int]
    OCCLUDED_FIELD_NUMBER: _ClassVar[int]
    ROLE_FIELD_NUMBER: _ClassVar[int]
    SATURATED_FIELD_NUMBER: _ClassVar[int]
    SD_X_M_FIELD_NUMBER: _ClassVar[int]
    SD_Y_M_FIELD_NUMBER: _ClassVar[int]
    SD_Z_M_FIELD_NUMBER: _ClassVar[int]
    X_M_FIELD_NUMBER: _ClassVar[int]
    Y_M_FIELD_NUMBER: _ClassVar[int]
    Z_M_FIELD_NUMBER: _ClassVar[int]
    confidence: float
    cov_xy_m2: float
    cov_xz_m2: float
    cov_yz_m2: float
    joint: BodyJoint
    occluded: bool
    role: DeviceRole
    saturated: bool
    sd_x_m: float
    sd_y_m: float
    sd_z_m: float
    x_m: float
    y_m: float
    z_m: float
    def __init__(self, role: _Optional[_Union[DeviceRole, str]] = ..., x_m: _Optional[float] = ..., y_m: _Optional[float] = ..., z_m: _Optional[float] = ..., sd_x_m: _Optional[float] = ..., sd_y_m: _Optional[float] = ..., sd_z_m: _Optional[float] = ..., confidence: _Optional[float] = ..., cov_xy_m2: _Optional[float] = ..., cov_xz_m2: _Optional[float] = ..., cov_yz_m2: _Optional[float] = ..., saturated: bool = ..., occluded: bool = ..., joint: _Optional[_Union[BodyJoint, str]] = ...) -> None: ...

class TrackerPose(_message.Message):
    __slots__ = ["qw", "qx", "qy", "qz", "x_m", "y_m", "z_m"]
    QW_FIELD_NUMBER: _ClassVar[int]
    QX_FIELD_NUMBER: _ClassVar[int]
    QY_FIELD_NUMBER: _ClassVar[int]
    QZ_FIELD_NUMBER: _ClassVar[int]
    X_M_FIELD_NUMBER: _ClassVar[int]
    Y_M_FIELD_NUMBER: _ClassVar[int]
    Z_M_FIELD_NUMBER: _ClassVar[int]
    qw: float
    qx: float
    qy: float
    qz: float
    x_m: float
    y_m: float
    z_m: float
    def __init__(self, x_m: _Optional[float] = ..., y_m: _Optional[float] = ..., z_m: _Optional[float] = ..., qw: _Optional[float] = ..., qx: _Optional[float] = ..., qy: _Optional[float] = ..., qz: _Optional[float] = ...) -> None: ...

class DeviceKind(int, metaclass=_enum_type_wrapper.EnumTypeWrapper):
    __slots__ = []

class Extension(int, metaclass=_enum_type_wrapper.EnumTypeWrapper):
    __slots__ = []

class DeviceRole(int, metaclass=_enum_type_wrapper.EnumTypeWrapper):
    __slots__ = []

class DeviceState(int, metaclass=_enum_type_wrapper.EnumTypeWrapper):
    __slots__ = []

class CalibrationOrigin(int, metaclass=_enum_type_wrapper.EnumTypeWrapper):
    __slots__ = []

class BodyJoint(int, metaclass=_enum_type_wrapper.EnumTypeWrapper):
    __slots__ = []

class ContactBody(int, metaclass=_enum_type_wrapper.EnumTypeWrapper):
    __slots__ = []
