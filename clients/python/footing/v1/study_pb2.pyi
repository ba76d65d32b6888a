from google.protobuf.internal import enum_type_wrapper as _enum_type_wrapper
from google.protobuf import descriptor as _descriptor
from google.protobuf import message as _message
from typing import ClassVar as _ClassVar, Optional as _Optional, Union as _Union

DESCRIPTOR: _descriptor.FileDescriptor
STUDY_ACTIVITY_DEMONSTRATION: StudyActivity
STUDY_ACTIVITY_FINISHED: StudyActivity
STUDY_ACTIVITY_GET_READY: StudyActivity
STUDY_ACTIVITY_PRACTICE: StudyActivity
STUDY_ACTIVITY_RANGES: StudyActivity
STUDY_ACTIVITY_REST: StudyActivity
STUDY_ACTIVITY_STOPPED: StudyActivity
STUDY_ACTIVITY_SURVEY: StudyActivity
STUDY_ACTIVITY_TRIAL: StudyActivity
STUDY_ACTIVITY_UNSPECIFIED: StudyActivity
STUDY_ACTIVITY_WAIT: StudyActivity

class StudyState(_message.Message):
    __slots__ = ["active_s", "activity", "attempt", "doing", "interface", "keys", "left_s", "next", "number", "participant", "phase", "phases", "study"]
    ACTIVE_S_FIELD_NUMBER: _ClassVar[int]
    ACTIVITY_FIELD_NUMBER: _ClassVar[int]
    ATTEMPT_FIELD_NUMBER: _ClassVar[int]
    DOING_FIELD_NUMBER: _ClassVar[int]
    INTERFACE_FIELD_NUMBER: _ClassVar[int]
    KEYS_FIELD_NUMBER: _ClassVar[int]
    LEFT_S_FIELD_NUMBER: _ClassVar[int]
    NEXT_FIELD_NUMBER: _ClassVar[int]
    NUMBER_FIELD_NUMBER: _ClassVar[int]
    PARTICIPANT_FIELD_NUMBER: _ClassVar[int]
    PHASES_FIELD_NUMBER: _ClassVar[int]
    PHASE_FIELD_NUMBER: _ClassVar[int]
    STUDY_FIELD_NUMBER: _ClassVar[int]
    active_s: float
    activity: StudyActivity
    attempt: int
    doing: str
    interface: str
    keys: str
    left_s: float
    next: str
    number: int
    participant: str
    phase: str
    phases: int
    study: str
    def __init__(self, study: _Optional[str] = ..., participant: _Optional[str] = ..., interface: _Optional[str] = ..., phase: _Optional[str] = ..., number: _Optional[int] = ..., phases: _Optional[int] = ..., doing: _Optional[str] = ..., next: _Optional[str] = ..., keys: _Optional[str] = ..., left_s: _Optional[float] = ..., active_s: _Optional[float] = ..., attempt: _Optional[int] = ..., activity: _Optional[_Union[StudyActivity, str]] = ...) -> None: ...

class StudyActivity(int, metaclass=_enum_type_wrapper.EnumTypeWrapper):
    __slots__ = []
