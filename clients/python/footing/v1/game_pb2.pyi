from footing.v1 import character_pb2 as _character_pb2
from google.protobuf.internal import containers as _containers
from google.protobuf.internal import enum_type_wrapper as _enum_type_wrapper
from google.protobuf import descriptor as _descriptor
from google.protobuf import message as _message
from typing import ClassVar as _ClassVar, Iterable as _Iterable, Mapping as _Mapping, Optional as _Optional, Union as _Union

DESCRIPTOR: _descriptor.FileDescriptor

class GamePlayer(_message.Message):
    __slots__ = ["name", "points"]
    NAME_FIELD_NUMBER: _ClassVar[int]
    POINTS_FIELD_NUMBER: _ClassVar[int]
    name: str
    points: float
    def __init__(self, name: _Optional[str] = ..., points: _Optional[float] = ...) -> None: ...

class GameRound(_message.Message):
    __slots__ = ["builder_points", "difficulty", "distance_m", "failures", "runner", "runner_points", "segments_laid", "segments_passed", "time_s", "trial"]
    BUILDER_POINTS_FIELD_NUMBER: _ClassVar[int]
    DIFFICULTY_FIELD_NUMBER: _ClassVar[int]
    DISTANCE_M_FIELD_NUMBER: _ClassVar[int]
    FAILURES_FIELD_NUMBER: _ClassVar[int]
    RUNNER_FIELD_NUMBER: _ClassVar[int]
    RUNNER_POINTS_FIELD_NUMBER: _ClassVar[int]
    SEGMENTS_LAID_FIELD_NUMBER: _ClassVar[int]
    SEGMENTS_PASSED_FIELD_NUMBER: _ClassVar[int]
    TIME_S_FIELD_NUMBER: _ClassVar[int]
    TRIAL_FIELD_NUMBER: _ClassVar[int]
    builder_points: float
    difficulty: float
    distance_m: float
    failures: _character_pb2.FailureCounts
    runner: int
    runner_points: float
    segments_laid: int
    segments_passed: int
    time_s: float
    trial: str
    def __init__(self, runner: _Optional[int] = ..., trial: _Optional[str] = ..., time_s: _Optional[float] = ..., distance_m: _Optional[float] = ..., failures: _Optional[_Union[_character_pb2.FailureCounts, _Mapping]] = ..., segments_laid: _Optional[int] = ..., segments_passed: _Optional[int] = ..., difficulty: _Optional[float] = ..., runner_points: _Optional[float] = ..., builder_points: _Optional[float] = ...) -> None: ...

class GameState(_message.Message):
    __slots__ = ["ghost", "ghost_curve_rad", "ghost_step_m", "host", "left_s", "note", "phase", "pits", "players", "refused", "results", "rounds"]
    class Phase(int, metaclass=_enum_type_wrapper.EnumTypeWrapper):
        __slots__ = []
    GHOST_CURVE_RAD_FIELD_NUMBER: _ClassVar[int]
    GHOST_FIELD_NUMBER: _ClassVar[int]
    GHOST_STEP_M_FIELD_NUMBER: _ClassVar[int]
    HOST_FIELD_NUMBER: _ClassVar[int]
    LEFT_S_FIELD_NUMBER: _ClassVar[int]
    NOTE_FIELD_NUMBER: _ClassVar[int]
    PHASE_COUNTDOWN: GameState.Phase
    PHASE_FIELD_NUMBER: _ClassVar[int]
    PHASE_LEFT: GameState.Phase
    PHASE_OVER: GameState.Phase
    PHASE_PAUSE: GameState.Phase
    PHASE_ROUND: GameState.Phase
    PHASE_UNSPECIFIED: GameState.Phase
    PHASE_WAITING: GameState.Phase
    PITS_FIELD_NUMBER: _ClassVar[int]
    PLAYERS_FIELD_NUMBER: _ClassVar[int]
    REFUSED_FIELD_NUMBER: _ClassVar[int]
    RESULTS_FIELD_NUMBER: _ClassVar[int]
    ROUNDS_FIELD_NUMBER: _ClassVar[int]
    ghost: _character_pb2.TrackSegment
    ghost_curve_rad: float
    ghost_step_m: float
    host: str
    left_s: float
    note: str
    phase: GameState.Phase
    pits: bool
    players: _containers.RepeatedCompositeFieldContainer[GamePlayer]
    refused: int
    results: _containers.RepeatedCompositeFieldContainer[GameRound]
    rounds: int
    def __init__(self, host: _Optional[str] = ..., phase: _Optional[_Union[GameState.Phase, str]] = ..., left_s: _Optional[float] = ..., players: _Optional[_Iterable[_Union[GamePlayer, _Mapping]]] = ..., rounds: _Optional[int] = ..., results: _Optional[_Iterable[_Union[GameRound, _Mapping]]] = ..., ghost: _Optional[_Union[_character_pb2.TrackSegment, _Mapping]] = ..., ghost_curve_rad: _Optional[float] = ..., ghost_step_m: _Optional[float] = ..., refused: _Optional[int] = ..., note: _Optional[str] = ..., pits: bool = ...) -> None: ...
