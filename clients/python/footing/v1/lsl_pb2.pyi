from google.protobuf.internal import containers as _containers
from google.protobuf import descriptor as _descriptor
from google.protobuf import message as _message
from typing import ClassVar as _ClassVar, Iterable as _Iterable, Mapping as _Mapping, Optional as _Optional, Union as _Union

DESCRIPTOR: _descriptor.FileDescriptor

class LslClock(_message.Message):
    __slots__ = ["correction_s", "time_s", "uncertainty_s"]
    CORRECTION_S_FIELD_NUMBER: _ClassVar[int]
    TIME_S_FIELD_NUMBER: _ClassVar[int]
    UNCERTAINTY_S_FIELD_NUMBER: _ClassVar[int]
    correction_s: float
    time_s: float
    uncertainty_s: float
    def __init__(self, time_s: _Optional[float] = ..., correction_s: _Optional[float] = ..., uncertainty_s: _Optional[float] = ...) -> None: ...

class LslSample(_message.Message):
    __slots__ = ["host_ns", "texts", "time_s", "values"]
    HOST_NS_FIELD_NUMBER: _ClassVar[int]
    TEXTS_FIELD_NUMBER: _ClassVar[int]
    TIME_S_FIELD_NUMBER: _ClassVar[int]
    VALUES_FIELD_NUMBER: _ClassVar[int]
    host_ns: int
    texts: _containers.RepeatedScalarFieldContainer[str]
    time_s: float
    values: _containers.RepeatedScalarFieldContainer[float]
    def __init__(self, host_ns: _Optional[int] = ..., time_s: _Optional[float] = ..., values: _Optional[_Iterable[float]] = ..., texts: _Optional[_Iterable[str]] = ...) -> None: ...

class LslSamples(_message.Message):
    __slots__ = ["samples"]
    SAMPLES_FIELD_NUMBER: _ClassVar[int]
    samples: _containers.RepeatedCompositeFieldContainer[LslSample]
    def __init__(self, samples: _Optional[_Iterable[_Union[LslSample, _Mapping]]] = ...) -> None: ...
