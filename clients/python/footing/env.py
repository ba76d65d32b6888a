"""The simulation as an environment: footing-sim in simulated time, stepped by commands (docs/python.md, docs/protocol.md).

    from footing.env import Walk
    with Walk(track="2", rate_hz=20) as env:
        observation, info = env.reset(seed=1)
        for _ in range(200):
            observation, reward, terminated, truncated, info = env.step({"gait": 1, "speed": 1.2, "turn": 0.0})
"""
import math
import os
import random
import select
import shutil
import socket
import struct
import subprocess
import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Callable, Dict, List, Mapping, Optional, Sequence, Tuple

from footing.columns import need_numpy
from footing.v1 import character_pb2, command_pb2, session_pb2
from footing.wire import FootingError, NotRunning, Refused, Wire

try:
    from gymnasium import Env as _Base, spaces
except ImportError:
    _Base, spaces = object, None

GAITS = ("step", "walk", "run", "jump")
_TURN_END, _TURN = struct.Struct("=qqBB6x"), struct.Struct("=qqq")
_NEVER = (1 << 63) - 1
_START_NS = 10**12           # Not 0: there is a time before the first instant.
_WALL_NS = 1_700_000_000 * 10**9  # Equal runs have equal dates, too.
_TURN_WITHIN_S = 60
_STARTS_WITHIN_S = 30
_TURNS_TO_LISTEN = 10_000
_AHEAD_M = (1, 2, 4, 8)      # Where an observation looks along the track.


@dataclass
class _Seat:
    socket: socket.socket
    due_ns: int
    listens: bool
    called: bool = False  # Another has acted since its last turn.


class Timekeeper:
    """Gives simulated time to the threads that follow it, one turn at a time (docs/protocol.md, "Simulated time")."""

    def __init__(self, path: str):
        self.now_ns, self._seats = _START_NS, []  # type: Tuple[int, List[_Seat]]
        self._listening = socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        self._listening.bind(path)
        self._listening.listen(16)

    def await_follower(self, within_s: float) -> bool:
        """Waits until another process follows."""
        return bool(select.select([self._listening], [], [], within_s)[0]) and self._accept()

    def _accept(self) -> bool:
        if not select.select([self._listening], [], [], 0)[0]:
            return False
        own, _ = self._listening.accept()
        own.settimeout(_TURN_WITHIN_S)
        _, due_ns, _, listens = _TURN_END.unpack(own.recv(_TURN_END.size))
        self._seats.append(_Seat(own, due_ns, bool(listens)))
        return True

    def call(self) -> None:
        """The timekeeper's own process has acted, such as by a write to a socket: who listens has a turn."""
        for seat in self._seats:
            seat.called = True

    def run_until(self, end_ns: int) -> None:
        """Gives every turn that is due up to this instant, which is the present one then."""
        while self._give_turn(end_ns):
            pass
        self.now_ns = max(self.now_ns, end_ns)

    def _give_turn(self, end_ns: int) -> bool:
        now_ns = self.now_ns
        seat = next((one for one in self._seats if one.listens and one.called or one.due_ns <= now_ns), None)
        if seat is None:
            seat = min(self._seats, key=lambda one: one.due_ns, default=None)
            if seat is None:
                raise NotRunning("nobody follows the timekeeper any more: footing-sim has ended")
            if seat.due_ns > end_ns:
                return False
            now_ns = self.now_ns = seat.due_ns
        alone_ns = min([end_ns] + [now_ns if one.listens and one.called or one.due_ns <= now_ns else one.due_ns
                                   for one in self._seats if one is not seat])
        seat.called = False
        try:
            seat.socket.send(_TURN.pack(now_ns, _WALL_NS + now_ns - _START_NS, alone_ns))
            answer = seat.socket.recv(_TURN_END.size)
        except socket.timeout as error:
            raise NotRunning(f"a thread did not end its turn within {_TURN_WITHIN_S} s") from error
        except OSError:
            answer = b""
        if len(answer) < _TURN_END.size:
            seat.socket.close()
            self._seats.remove(seat)
            self.call()  # Its connections have ended.
            return True
        ended_ns, seat.due_ns, acted, listens = _TURN_END.unpack(answer)
        self.now_ns, seat.listens = max(self.now_ns, ended_ns), bool(listens)
        if acted:
            for one in self._seats:
                one.called |= one is not seat
            while self._accept():
                pass
        return True

    def close(self) -> None:
        for seat in self._seats:
            seat.socket.close()
        self._listening.close()


class Walk(_Base):
    """The biped on a track. An action is {"gait": 0 to 3 of GAITS, "speed": m/s, "turn": rad a step, "height": m of a jump}.

    What is absent from an action is 0. Without an action (None) the devices of `users` command: synthetic people of
    footing-stream, such as ("run",). An observation is an array of doubles, named by `names`. The reward is the progress
    along the track, m, or what `reward(env, info)` returns. An episode ends with a fall or at the finish line; after
    `limit_s` it is truncated. Each reset starts the programs again, so that equal seeds give equal bits; the seed draws
    the trial's task and a wait of up to a second before the first observation. Several may run at once.
    """

    metadata: Dict[str, Any] = {"render_modes": []}

    def __init__(self, track: str = "2", rate_hz: float = 20, limit_s: float = 120, task: str = "", gaits: str = "best",
                 users: Sequence[str] = (), reward: Optional[Callable[["Walk", Dict[str, Any]], float]] = None,
                 programs: Optional[str] = None):
        self._np = need_numpy("an environment")
        if not 0 < rate_hz <= 40:
            raise FootingError("rate_hz must be above 0 and at most 40: a session may send so many commands")
        self._track, self._period_ns, self._limit_s = track, round(1e9 / rate_hz), limit_s
        self._task, self._gaits, self._users, self._reward = task, gaits, tuple(users), reward
        self._programs = programs
        self._children: List[subprocess.Popen] = []
        self._keeper: Optional[Timekeeper] = None
        self._wire: Optional[Wire] = None
        self._folder: Optional[tempfile.TemporaryDirectory] = None
        self._draw = random.Random()
        self.names: List[str] = []       # Of an observation's numbers.
        self.episode: Dict[str, List[Any]] = {}
        self.reset()
        if spaces is not None:
            box = spaces.Box
            self.observation_space = box(-math.inf, math.inf, (len(self.names),), float)
            self.action_space = spaces.Dict({"gait": spaces.Discrete(4), "speed": box(0, 4, (), float),
                                             "turn": box(-0.5, 0.5, (), float), "height": box(0, 0.5, (), float)})

    # --- The calls of Gymnasium -----------------------------------------------------------------------
    def reset(self, *, seed: Optional[int] = None, options: Optional[Mapping[str, Any]] = None) -> Tuple[Any, Dict[str, Any]]:
        if spaces is not None:
            super().reset(seed=seed)
        self.close()
        if seed is not None:
            self._draw = random.Random(seed)  # Without one the next episode is drawn, too.
        draw = self._draw
        self._start()
        self._command(start_trial=dict(trial="episode", track=self._track, seed=draw.getrandbits(32), task=self._task))
        self._advance(self._keeper.now_ns + draw.randrange(100) * 10_000_000)
        while self.character is None or not self.character.links:
            self._advance(self._keeper.now_ns + 10_000_000)
        self._begin_ns, self._steps = self._keeper.now_ns, 0
        self._falls = self.character.gait.falls
        self._distance_m = self.character.gait.distance_m
        self.episode = {"observation": [], "action": [], "reward": [], "state_hash": []}
        observation = self._observe()
        self.episode["observation"].append(observation)
        return observation, self._info()

    def step(self, action: Optional[Mapping[str, Any]]) -> Tuple[Any, float, bool, bool, Dict[str, Any]]:
        if self._keeper is None:
            raise FootingError("the environment is closed: call reset first")
        if action is not None:
            self._command(direct_gait=dict(
                gait=1 + int(action["gait"]), speed_mps=float(action.get("speed", 0)), turn_rad=float(action.get("turn", 0)),
                height_m=float(action.get("height", 0))))
        self._steps, before_m = self._steps + 1, self._distance_m
        self._advance(self._begin_ns + self._steps * self._period_ns)
        gait, trial = self.character.gait, self.character.trial
        self._distance_m = gait.distance_m
        observation, info = self._observe(), self._info()
        reward = self._reward(self, info) if self._reward else self._distance_m - before_m
        terminated = gait.falls > self._falls or trial.phase == character_pb2.TrialState.PHASE_FINISHED
        truncated = not terminated and info["time_s"] >= self._limit_s
        for name, value in (("observation", observation), ("action", dict(action or {})), ("reward", reward),
                            ("state_hash", info["state_hash"])):
            self.episode[name].append(value)
        return observation, reward, terminated, truncated, info

    def arrays(self) -> Dict[str, Any]:
        """The episode so far: observations (one more than steps), actions as gait, speed, turn, height, rewards, hashes."""
        actions = [[one.get(name, 0) for name in ("gait", "speed", "turn", "height")] for one in self.episode["action"]]
        return {"observation": self._np.array(self.episode["observation"]), "action": self._np.array(actions, float),
                "reward": self._np.array(self.episode["reward"]),
                "state_hash": self._np.array(self.episode["state_hash"], self._np.uint64)}

    def close(self) -> None:
        if self._wire is not None:
            self._wire.close()
        for child in self._children:
            child.kill()
            child.wait()
        if self._keeper is not None:
            self._keeper.close()
        if self._folder is not None:
            self._folder.cleanup()
        self._children, self._keeper, self._wire, self._folder = [], None, None, None

    def __enter__(self) -> "Walk":
        return self

    def __exit__(self, *_: Any) -> None:
        self.close()

    # --- The programs ---------------------------------------------------------------------------------
    def _start(self) -> None:
        self.character: Optional[character_pb2.Character] = None
        self._frame, self._map, self._answer = character_pb2.CharacterFrame(), character_pb2.Track(), None
        self._links: List[str] = []
        self._last_id = 0
        self._folder = tempfile.TemporaryDirectory(prefix="footing-env.")
        try:
            place = lambda name: f"unix:{self._folder.name}/{name}"  # noqa: E731
            self._keeper = Timekeeper(f"{self._folder.name}/time")
            if self._users:
                self._child("footingd", "--listen", place("sensor"), "--source", "stream:" + place("devices"))
            self._child("footing-sim", "--sensor", place("sensor"), "--listen", place("simulation"), "--gaits", self._gaits)
            for number, script in enumerate(self._users):
                self._child("footing-stream", "user", "--script", script, "--interface", "wrist", "--to", place("devices"),
                            "--seed", str(number + 1))
            for _ in range(_TURNS_TO_LISTEN):
                try:
                    self._wire = Wire(place("simulation"), "footing-sim")
                    break
                except NotRunning:
                    self._keeper._give_turn(self._keeper.now_ns + self._period_ns)
            else:
                raise NotRunning("footing-sim does not listen: " + self._log("footing-sim"))
            self._send(hello=session_pb2.Hello(protocol_major=1, role="ROLE_CONTROL", client_name="footing.env"))
            self._send(subscribe=session_pb2.Subscribe(channels=["characters", "track", "skeletons"], queue_ticks=1024,
                                                       policy="QUEUE_POLICY_DROP_OLDEST"))
        except BaseException:
            self.close()
            raise

    def _child(self, program: str, *words: str) -> None:
        path = shutil.which(program, path=self._programs)
        if path is None:
            raise NotRunning(f"there is no {program} on PATH: install footing, or pass programs=\"FOLDER\"")
        environment = dict(os.environ, FOOTING_TIMEKEEPER=f"{self._folder.name}/time", XDG_STATE_HOME=self._folder.name)
        with open(f"{self._folder.name}/{program}.log", "wb") as log:
            self._children.append(subprocess.Popen([path, *words], stdin=subprocess.DEVNULL, stdout=log, stderr=log,
                                                   env=environment))
        for _ in range(_STARTS_WITHIN_S * 10):
            if self._keeper.await_follower(0.1):
                return
            if self._children[-1].poll() is not None:
                break
        raise NotRunning(f"{program} does not start: {self._log(program)}")

    def _log(self, program: str) -> str:
        lines = Path(f"{self._folder.name}/{program}.log").read_text(encoding="utf-8", errors="replace").splitlines()
        return lines[-1] if lines else "it says nothing"

    # --- Time and messages ----------------------------------------------------------------------------
    def _send(self, **body: Any) -> None:
        try:
            self._wire.send(session_pb2.Envelope(**body))
        except OSError as error:
            raise self._ended() from error
        self._keeper.call()

    def _ended(self) -> NotRunning:
        return NotRunning("footing-sim has ended; reset starts it again. Its last line: " + self._log("footing-sim"))

    def _advance(self, end_ns: int) -> None:
        """In pieces, so that what footing-sim sends never fills its socket."""
        while True:
            self._keeper.run_until(min(end_ns, self._keeper.now_ns + 100_000_000))
            try:
                while self._wire.waits():
                    self._handle(session_pb2.Envelope.FromString(self._wire.receive()))
            except OSError as error:
                raise self._ended() from error
            if self._keeper.now_ns >= end_ns:
                return

    def _handle(self, envelope: session_pb2.Envelope) -> None:
        kind = envelope.WhichOneof("body")
        if kind == "ping":
            ping, now_ns = envelope.ping, self._keeper.now_ns
            self._send(pong=session_pb2.Pong(id=ping.id, t0_ns=ping.t0_ns, t1_ns=now_ns, t2_ns=now_ns))
        elif kind == "command_result":
            self._answer = envelope.command_result
        elif kind in ("refused", "goodbye"):
            raise Refused(envelope.refused.message or envelope.goodbye.reason)
        elif kind == "tick":
            tick = envelope.tick
            if tick.HasField("skeletons"):
                self._links = [link.name for link in tick.skeletons.skeletons[0].links]
            if tick.HasField("track"):
                self._map = tick.track
            if tick.HasField("characters") and tick.characters.characters:
                self._frame, self.character = tick.characters, tick.characters.characters[0]

    def _command(self, **action: Any) -> None:
        self._last_id, self._answer = self._last_id + 1, None
        self._send(command=command_pb2.Command(id=self._last_id, **action))
        for wait_ns in [0] + [1_000_000] * 1000:  # Most are answered at once.
            self._advance(self._keeper.now_ns + wait_ns)
            if self._answer is not None:
                break
        else:
            raise NotRunning("footing-sim does not answer: " + self._log("footing-sim"))
        if not self._answer.ok:
            raise Refused(self._answer.message)

    # --- What is seen ---------------------------------------------------------------------------------
    def _info(self) -> Dict[str, Any]:
        """Simulated time since the reset, hash of the engine's state, and the message with everything."""
        return {"time_s": self._steps * self._period_ns * 1e-9, "engine_time_s": self._frame.time_s,
                "state_hash": self._frame.state_hash, "distance_m": self.character.gait.distance_m,
                "falls": self.character.gait.falls - self._falls, "character": self.character}

    def _observe(self) -> Any:
        """Links relative to the body's place, turned so that x is its heading; gait; place on the track; what comes."""
        character, gait, trial = self.character, self.character.gait, self.character.trial
        cos, sin = math.cos(gait.heading_rad), math.sin(gait.heading_rad)
        half_cos, half_sin = math.cos(gait.heading_rad / 2), -math.sin(gait.heading_rad / 2)
        root = character.links[0].position_m
        seen: Dict[str, float] = {}
        for name, link in zip(self._links, character.links):
            p, q = link.position_m, link.orientation
            x, y = p.x - root.x, p.y - root.y
            seen.update({f"{name}_x_m": cos * x + sin * y, f"{name}_y_m": cos * y - sin * x, f"{name}_z_m": p.z,
                         f"{name}_qw": half_cos * q.w - half_sin * q.z, f"{name}_qx": half_cos * q.x - half_sin * q.y,
                         f"{name}_qy": half_cos * q.y + half_sin * q.x, f"{name}_qz": half_cos * q.z + half_sin * q.w})
        v = character.com_velocity_mps
        seen.update(com_vx_mps=cos * v.x + sin * v.y, com_vy_mps=cos * v.y - sin * v.x, com_vz_mps=v.z)
        for index, contact in enumerate(character.contacts):
            seen[f"contact_{index}_n"] = contact.normal_force_n
        seen.update({f"gait_{name}": float(gait.gait == number + 1) for number, name in enumerate(GAITS)})
        seen.update(pending=float(gait.pending), speed_mps=gait.speed_mps, distance_m=gait.distance_m,
                    lateral_offset_m=trial.lateral_offset_m, heading_error_rad=trial.heading_error_rad)
        seen.update(self._ahead(trial.distance_m))
        self.names = list(seen)
        return self._np.array(list(seen.values()))

    def _ahead(self, distance_m: float) -> Dict[str, float]:
        """The track's heading (left positive) and slope some way ahead, against where the body is; and the next pit, or 0."""
        begin_m, places = self._map.first_m, []
        for segment in self._map.segments:
            places.append((begin_m, segment))
            begin_m += segment.length_m
        here = next((one for start_m, one in reversed(places) if start_m <= distance_m), self._map.segments[0])
        seen = {}
        for way_m in _AHEAD_M:
            there = next((one for start_m, one in reversed(places) if start_m <= distance_m + way_m), here)
            turn = math.remainder(there.heading_rad - here.heading_rad, 2 * math.pi)
            seen.update({f"ahead_{way_m}m_turn_rad": turn, f"ahead_{way_m}m_slope_rad": there.slope_rad})
        pit_m, length_m = next(((start_m - distance_m, one.length_m) for start_m, one in places
                                if one.pit and start_m + one.length_m > distance_m), (0.0, 0.0))
        return {**seen, "pit_m": pit_m, "pit_length_m": length_m}


def register() -> None:
    """Called by Gymnasium where it is installed: gymnasium.make("Footing/Walk-v0", track="2")."""
    from gymnasium.envs.registration import register as add, registry
    if "Footing/Walk-v0" not in registry:
        add(id="Footing/Walk-v0", entry_point="footing.env:Walk")
