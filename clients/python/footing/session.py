"""A connection to footingd and footing-sim: live samples, commands, the lease."""
import collections
import itertools
import threading
import time
from dataclasses import dataclass
from typing import Any, Deque, Dict, Generic, Iterator, List, Literal, Optional, Sequence, Tuple, TypeVar, Union, overload

from google.protobuf.message import DecodeError

from footing.columns import ROWS, Table, name_of
from footing.v1 import character_pb2, command_pb2, device_pb2, sensor_pb2, session_pb2
from footing.wire import ConnectionLost, FootingError, NotRunning, Refused, Wire, default_address, read_token

_OF_SIMULATION = {"put_back", "push", "direct_gait", "append_segment", "calibrate_t_pose", "set_subject", "set_pose_mode",
                  "start_trial", "stop_trial", "correct_failure", "set_game", "set_study", "set_interface"}
_KEEP_TICKS = 6000  # A minute: what waits for a program that reads slowly.
_SILENT_S = 10      # A server sends a ping each second.
_LEASE_S = 5
_NEW_DEVICE_S = 1.5  # The list of devices comes once a second.
_RECORDING_ENDED = "the recording has ended"  # Goodbye of footing-log serve.

_IDLE = session_pb2.Subscribe(channels=["status", "skeletons"], policy="QUEUE_POLICY_LATEST", max_hz=1)
Message = TypeVar("Message")


@dataclass
class Sample(Generic[Message]):
    """One row of a channel. `data` is its message: the fields and their units are those of proto/footing/v1."""
    channel: str
    time_s: float  # When the sensor took it, else when the server published it; `Client.zero_ns` is 0.
    device: int
    rig: str
    role: str      # Such as "left_hand"; empty without one.
    serial: str
    data: Message


@dataclass
class Tick:
    """Everything that a server published for one instant. Each channel is an attribute of `message`."""
    server: str
    time_s: float
    message: session_pb2.Tick

    def __getattr__(self, channel: str) -> Any:
        return getattr(self.message, channel)


class _Session:
    """One server: a thread that receives, answers pings, renews the lease and connects again."""

    def __init__(self, client: "Client", address: str, program: str):
        self.client, self.address, self.program = client, address, program
        self.error: Optional[FootingError] = None
        self.ended = self.closing = False
        self.next_sequence: Optional[int] = None
        self._answers: Dict[int, List[Any]] = {}
        self._ids = itertools.count(1)
        self._lease: Tuple[str, float] = ("", 0)  # Holder, and when it is to be renewed.
        self._known = threading.Event()
        self._connect()
        self.subscribe(_IDLE)
        self._thread = threading.Thread(target=self._run, name=f"footing {address}", daemon=True)
        self._thread.start()
        self._known.wait(_SILENT_S)

    def _connect(self) -> None:
        client = self.client
        self.wire = Wire(self.address, self.program)
        try:
            self.wire.send(session_pb2.Envelope(hello=session_pb2.Hello(
                protocol_major=1, role=client.role, token=client.token, client_name=client.name)))
            answer = session_pb2.Envelope.FromString(self.wire.receive())
        except (OSError, DecodeError) as error:
            self.wire.close()
            raise NotRunning(f"what listens at {self.address} does not answer like {self.program}: {error}") from error
        if answer.WhichOneof("body") != "welcome":
            self.wire.close()
            raise Refused(f"{self.address}: {answer.refused.message or answer.goodbye.reason}")
        self.welcome = answer.welcome

    def send(self, **body: Any) -> None:
        self.wire.send(session_pb2.Envelope(**body))

    def subscribe(self, subscription: session_pb2.Subscribe) -> None:
        self._subscription, self.next_sequence = subscription, None
        self.send(subscribe=subscription)

    def rest(self) -> None:
        """Nobody reads: only the list of devices is of interest."""
        try:
            self.subscribe(_IDLE)
        except OSError:
            pass  # The thread notices, too.

    def command(self, command: command_pb2.Command, timeout_s: float) -> command_pb2.CommandResult:
        command.id = next(self._ids)
        answer = self._answers[command.id] = [threading.Event(), None]
        try:
            self.send(command=command)
            if not answer[0].wait(timeout_s) or answer[1] is None:
                raise ConnectionLost(f"{self.program} did not answer within {timeout_s:g} s; it may have done it")
        except OSError as error:
            raise ConnectionLost(f"{self.address}: {error}") from error
        finally:
            del self._answers[command.id]
        return answer[1]

    def renew(self, holder: str) -> None:
        self._lease = (holder, time.monotonic() + _LEASE_S / 2)

    def _run(self) -> None:
        while not self.closing:
            try:
                while True:
                    self._handle(self.wire.receive())
            except (OSError, Refused, DecodeError) as error:
                self.wire.close()
                if not self.closing and not self.ended:
                    self._connect_again(error)
            if self.ended or self.error:
                break
        with self.client.news:
            self.client.news.notify_all()

    def _connect_again(self, why: Exception) -> None:
        end, wait_s = time.monotonic() + self.client.patience_s, 0.1
        while not self.closing:
            time.sleep(wait_s)
            wait_s = min(1.0, 2 * wait_s)
            try:
                epoch = self.welcome.epoch
                self._connect()
            except (FootingError, OSError) as error:
                if time.monotonic() > end:
                    self.error = ConnectionLost(f"{self.address}: {why}; then for {self.client.patience_s:g} s: {error}")
                    return
                continue
            again = session_pb2.Subscribe()
            again.CopyFrom(self._subscription)
            if self.next_sequence is not None:
                # Of a new epoch everything that its ring still has.
                again.from_sequence = self.next_sequence if self.welcome.epoch == epoch else 0
                again.from_epoch = self.welcome.epoch
            self.send(subscribe=again)
            return

    def _handle(self, data: bytes) -> None:
        envelope = session_pb2.Envelope.FromString(data)
        kind = envelope.WhichOneof("body")
        if kind == "tick":
            self._take(envelope.tick)
        elif kind == "ping":
            now_ns, ping = time.monotonic_ns(), envelope.ping
            self.send(pong=session_pb2.Pong(id=ping.id, t0_ns=ping.t0_ns, t1_ns=now_ns, t2_ns=time.monotonic_ns()))
            holder, due = self._lease
            if holder and time.monotonic() > due:
                self.renew(holder)
                self.send(command=command_pb2.Command(
                    id=next(self._ids), take_lease=dict(holder=holder, seconds=_LEASE_S, renew_only=True)))
        elif kind == "command_result":
            answer = self._answers.get(envelope.command_result.id)
            if answer:
                answer[1] = envelope.command_result
                answer[0].set()
            elif not envelope.command_result.ok and self._lease[0]:
                self._lease = ("", 0)  # Another session took it over.
        elif kind == "gap":
            self._take_gap(envelope.gap)
        elif kind == "goodbye":
            self.ended = envelope.goodbye.reason == _RECORDING_ENDED
            raise Refused(envelope.goodbye.reason)

    def _take_gap(self, gap: session_pb2.Gap) -> None:
        if gap.reason == session_pb2.Gap.REASON_QUEUE_FULL:
            self.send(refill=session_pb2.Refill(from_sequence=gap.from_sequence, to_sequence=gap.to_sequence))
        else:
            self.client.lost += max(0, gap.to_sequence - gap.from_sequence + 1)

    def _take(self, tick: session_pb2.Tick) -> None:
        client = self.client
        if tick.HasField("status"):
            client.devices = {one.device: one for one in tick.status.devices}
        if tick.HasField("skeletons"):
            client.skeletons = list(tick.skeletons.skeletons)
        if tick.snapshot:
            self._known.set()
        elif not tick.refilled or tick.sequence == self.next_sequence:
            self.next_sequence = tick.sequence + 1
        if client.reading:
            with client.news:
                if len(client.waiting) >= _KEEP_TICKS:
                    client.waiting.popleft()
                    client.lost += 1
                client.waiting.append((self, tick))
                client.news.notify()

    def close(self) -> None:
        self.closing = True
        self.wire.close()
        self._thread.join(_SILENT_S)


class Client:
    """Both servers of a host, or one. Made by `footing.connect`; `with` closes it."""

    def __init__(self, addresses: Sequence[Tuple[str, str]], role: str, name: str, token: Optional[str], patience_s: float):
        self.role, self.name, self.token, self.patience_s = "ROLE_" + role.upper(), name, read_token(token), patience_s
        if self.role not in session_pb2.Role.keys()[1:]:
            raise FootingError(f"{role!r} is not a role: view, log, control or admin")
        self.devices: Dict[int, device_pb2.DeviceStatus] = {}  # By their number, lost ones too.
        self.skeletons: List[Any] = []
        self.lost = 0  # Ticks that never came, or that this program was too slow to take.
        self.reading = False
        self.news = threading.Condition()
        self.waiting: Deque[Tuple[_Session, session_pb2.Tick]] = collections.deque()
        self._sessions: List[_Session] = []
        try:
            for address, program in addresses:
                self._sessions.append(_Session(self, address, program))
        except BaseException:
            self.close()
            raise
        first = self._sessions[0].welcome
        self.zero_ns = first.host_ns  # Clock of the server, where time_s is 0; UNIX time then:
        self.zero_wall_ns = first.wall_time_ns

    def __enter__(self) -> "Client":
        return self

    def __exit__(self, *_: Any) -> None:
        self.close()

    def __repr__(self) -> str:
        simulated = ", simulated devices" if any(one.simulated for one in self.devices.values()) else ""
        return f"<footing.Client {', '.join(one.address for one in self._sessions)}{simulated}>"

    def close(self) -> None:
        for session in self._sessions:
            session.close()

    @property
    def channels(self) -> List[str]:
        return list(dict.fromkeys(name for session in self._sessions for name in session.welcome.channels))

    def _zero_of(self, session: _Session) -> int:
        """On the session's own clock. Servers on Unix sockets share one; others are compared by the time of day."""
        first, own = self._sessions[0], session.welcome
        if session is first or session.address.startswith("unix:") and first.address.startswith("unix:"):
            return self.zero_ns
        return own.host_ns - (own.wall_time_ns - self.zero_wall_ns)

    # --- Reading -------------------------------------------------------------------------------------
    def ticks(self, *channels: str, max_hz: float = 0, seconds: Optional[float] = None) -> Iterator[Tick]:
        """Ticks of the named channels as they come, until `seconds` have passed or the loop is left.

        Without names all channels come. Missing ticks are asked for again; what is lost for good counts in `lost`.
        After a break of the connection the ticks go on where they stopped, within the 30 s that a server holds.
        """
        for session, tick in self._receive(channels, max_hz, seconds):
            if tick is not None and not tick.snapshot and (not channels or any(map(tick.HasField, channels))):
                yield Tick(session.welcome.server_id, (tick.host_ns - self._zero_of(session)) * 1e-9, tick)

    @overload
    def samples(self, channel: Literal["motion"], *, role: Optional[str] = ..., max_hz: float = ...,
                seconds: Optional[float] = ...) -> Iterator[Sample[sensor_pb2.MotionSample]]: ...
    @overload
    def samples(self, channel: Literal["boards"], *, role: Optional[str] = ..., max_hz: float = ...,
                seconds: Optional[float] = ...) -> Iterator[Sample[sensor_pb2.BoardSample]]: ...
    @overload
    def samples(self, channel: Literal["characters"], *, role: Optional[str] = ..., max_hz: float = ...,
                seconds: Optional[float] = ...) -> Iterator[Sample[character_pb2.Character]]: ...
    @overload
    def samples(self, *channels: str, role: Optional[str] = ..., max_hz: float = ...,
                seconds: Optional[float] = ...) -> Iterator[Sample]: ...

    def samples(self, *channels: str, role: Optional[str] = None, max_hz: float = 0,
                seconds: Optional[float] = None) -> Iterator[Sample]:
        """Rows of the channels one by one, such as every sample of "motion"; `role` takes one device's."""
        for session, tick in self._receive(channels, max_hz, seconds):
            if tick is None or tick.snapshot:
                continue
            zero_ns = self._zero_of(session)
            for channel in channels or tick.DESCRIPTOR.fields_by_name:
                if channel in ROWS and tick.HasField(channel):
                    for row in getattr(getattr(tick, channel), ROWS[channel]):
                        sample = self._sample(channel, row, tick.host_ns, zero_ns)
                        if role is None or sample.role == role:
                            yield sample

    def _sample(self, channel: str, row: Any, host_ns: int, zero_ns: int) -> Sample:
        number = getattr(row, "device", 0)
        device = self.devices.get(number) or device_pb2.DeviceStatus()
        at_ns = getattr(row, "sampled_ns", 0) or host_ns
        role = name_of(device_pb2.DeviceRole, device.role or getattr(row, "role", 0))
        rig = device.rig or getattr(row, "rig", "")
        return Sample(channel, (at_ns - zero_ns) * 1e-9, number, rig, role, device.serial, row)

    def blocks(self, channel: str, every_s: float = 0.1, role: Optional[str] = None, fields: Optional[Sequence[str]] = None,
               seconds: Optional[float] = None) -> Iterator[Table]:
        """Every so many seconds a Table of what has come since; it may be empty. The way to live plots and filters."""
        due, held = time.monotonic() + every_s, []
        session = next((one for one in self._sessions if channel in one.welcome.channels), self._sessions[0])
        for _, tick in self._receive([channel], 0, seconds, every_s / 4):
            if tick is not None and not tick.snapshot and tick.HasField(channel):
                held.append((tick.host_ns, tick.sequence, getattr(tick, channel)))
            if time.monotonic() >= due:
                due = max(due + every_s, time.monotonic())
                yield self._table(channel, held, session, role, fields)
                held = []
        yield self._table(channel, held, session, role, fields)

    def _table(self, channel: str, held: Sequence[Tuple[int, int, Any]], session: _Session, role: Optional[str],
               fields: Optional[Sequence[str]]) -> Table:
        table = Table.of_messages(channel, held, self._zero_of(session), fields)
        table.add_devices(lambda number, _: self.devices.get(number), [])
        return table.where(role=role) if role else table

    def _receive(self, channels: Sequence[str], max_hz: float, seconds: Optional[float],
                 look_s: float = 0.5) -> Iterator[Tuple[_Session, Optional[session_pb2.Tick]]]:
        """Ticks, and None whenever nothing came for `look_s`."""
        if self.reading:
            raise FootingError("this client is being read already: leave that loop first, or connect a second client")
        unknown = [name for name in channels if name not in self.channels]
        if unknown:
            raise FootingError(f"no channel {', '.join(unknown)} here; there are {', '.join(self.channels)}")
        end = None if seconds is None else time.monotonic() + seconds
        self.waiting.clear()
        self.reading = True
        try:
            for session in self._sessions:
                own = [name for name in session.welcome.channels if not channels or name in channels or name == "status"]
                session.subscribe(session_pb2.Subscribe(channels=own, max_hz=max_hz, queue_ticks=1024,
                                                        policy="QUEUE_POLICY_DROP_OLDEST"))
            while end is None or time.monotonic() < end:
                with self.news:
                    if not self.waiting:
                        self._raise_if_over()
                        self.news.wait(look_s)
                    got = list(self.waiting)
                    self.waiting.clear()
                if not got:
                    if all(one.ended for one in self._sessions):
                        return
                    yield self._sessions[0], None
                yield from got
        finally:
            self.reading = False
            for session in self._sessions:
                session.rest()

    def _raise_if_over(self) -> None:
        for session in self._sessions:
            if session.error:
                raise session.error

    # --- Commands: connect(role="control") ------------------------------------------------------------
    def command(self, timeout_s: float = 10, **action: Any) -> command_pb2.CommandResult:
        """Any command of the protocol by its name: `command(push=dict(impulse_x_ns=20))`. Refused: raises the reason."""
        command = command_pb2.Command(**action)
        name = command.WhichOneof("action") or ""
        program = "footing-sim" if name in _OF_SIMULATION else "footingd"
        if name != "marker" and self.role not in ("ROLE_CONTROL", "ROLE_ADMIN"):
            raise FootingError(f"{name} needs footing.connect(role=\"control\")")
        targets = [one for one in self._sessions if one.welcome.server_id == program] or (
            self._sessions if name in ("marker", "list_sessions", "end_sessions") else [])
        if not targets:
            raise NotRunning(f"{name} is a command of {program}, which this client is not connected to: start {program}")
        result = targets[0].command(command, timeout_s)
        if not result.ok:
            raise Refused(result.message if result.message.startswith(name) else f"{name}: {result.message}")
        return result

    def find(self, device: Union[str, int]) -> device_pb2.DeviceStatus:
        """A device by its role ("left_hand"), serial or number; one that has just come may take a second to be known."""
        end = time.monotonic() + _NEW_DEVICE_S
        while True:
            present = [one for one in self.devices.values() if one.state != device_pb2.DEVICE_STATE_LOST]
            for one in present:
                if device in (one.device, one.serial, name_of(device_pb2.DeviceRole, one.role)):
                    return one
            if time.monotonic() > end:
                break
            time.sleep(0.05)
        there = ", ".join(f"{name_of(device_pb2.DeviceRole, one.role) or 'no role'} ({one.serial})" for one in present)
        raise FootingError(f"no device {device!r}; there are: {there or 'none: switch one on, or start footing-stream'}")

    def lease(self, holder: str, take_over: bool = False) -> "_Lease":
        """The exclusive right to send commands to these servers, renewed until `release` or the end of a `with`."""
        for session in self._sessions:
            wanted = dict(holder=holder, seconds=_LEASE_S, take_over=take_over)
            result = session.command(command_pb2.Command(take_lease=wanted), 10)
            if not result.ok:
                raise Refused(result.message)
            session.renew(holder)
        return _Lease(self._sessions)

    def rumble(self, device: Union[str, int], seconds: float = 0.3) -> None:
        self.command(set_rumble=dict(device=self.find(device).device, on=seconds > 0, lease_ms=round(seconds * 1000)))

    def leds(self, device: Union[str, int], leds: int) -> None:
        """Bits 0 to 3."""
        self.command(set_leds=dict(device=self.find(device).device, leds=leds))

    def assign(self, device: Union[str, int], role: str, rig: str = "") -> None:
        self.command(assign_role=dict(serial=self.find(device).serial, role=_role(role), rig=rig))

    def tare(self, board: Union[str, int], window_s: float = 2) -> float:
        """Takes the empty board's load of the last seconds as its zero. Returns the residual, N."""
        return self.command(tare=dict(serial=self.find(board).serial, window_s=window_s)).residual

    def gait(self, gait: str, speed_mps: float = 0, turn_rad: float = 0, height_m: float = 0) -> None:
        """Commands the character in place of the devices: step, walk, run or jump; until `release_gait`."""
        self.command(direct_gait=dict(gait=_gait(gait), speed_mps=speed_mps, turn_rad=turn_rad, height_m=height_m))

    def release_gait(self) -> None:
        self.command(direct_gait=dict(release=True))

    def mark(self, text: str, value: Optional[float] = None) -> None:
        """A marker of this instant in every recording and export. A pair "begin NAME", "end NAME" frames a trial.
        Needs connect(role="log") or above."""
        self.command(marker=dict(text=text) if value is None else dict(text=text, value=value))

    def start_trial(self, trial: str, track: str = "", seed: int = 0, task: str = "") -> None:
        self.command(start_trial=dict(trial=trial, track=track, seed=seed, task=task))

    def stop_trial(self, trial: str = "") -> None:
        self.command(stop_trial=dict(trial=trial))


class _Lease:
    def __init__(self, sessions: Sequence[_Session]):
        self._sessions = sessions

    def __enter__(self) -> "_Lease":
        return self

    def __exit__(self, *_: Any) -> None:
        self.release()

    def release(self) -> None:
        for session in self._sessions:
            session.renew("")
            session.command(command_pb2.Command(release_lease={}), 10)


def _role(role: str) -> str:
    name = "DEVICE_ROLE_" + role.upper()
    if name not in device_pb2.DeviceRole.keys():
        raise FootingError(f"{role!r} is not a role: {', '.join(k[12:].lower() for k in device_pb2.DeviceRole.keys()[1:])}")
    return name


def _gait(gait: str) -> str:
    if gait not in ("step", "walk", "run", "jump"):
        raise FootingError(f"{gait!r} is not a gait: step, walk, run or jump")
    return "GAIT_" + gait.upper()


def connect(address: Optional[str] = None, simulation: Optional[str] = None, *, role: str = "view", name: str = "python",
            token: Optional[str] = None, patience_s: float = 10) -> Client:
    """Connects to footingd, footing-sim, or both.

    Without addresses those of this user, or of the installed service, whichever run. `address` is a footingd's,
    `simulation` a footing-sim's: unix:/PATH, tcp:HOST:PORT or tls:HOST:PORT. `token` is the server's; without it
    FOOTING_TOKEN_FILE names its file. For `patience_s` after a break it tries to connect again.
    """
    named = [(place, program) for place, program in ((address, "footingd"), (simulation, "footing-sim")) if place]
    if named:
        return Client(named, role, name, token, patience_s)
    reasons: List[str] = []
    found = [pair for pair in ((default_address("sensor"), "footingd"), (default_address("simulation"), "footing-sim"))
             if _runs(*pair, reasons)]
    if not found:
        raise NotRunning("neither footingd nor footing-sim runs here. Start them, without hardware too: "
                         "`footingd --source stream:unix:/tmp/devices.sock`, `footing-sim`, and `footing-stream user "
                         "--script demo --interface wrist --to unix:/tmp/devices.sock`. " + "; ".join(reasons))
    return Client(found, role, name, token, patience_s)


def _runs(address: str, program: str, reasons: List[str]) -> bool:
    try:
        Wire(address, program).close()
        return True
    except NotRunning as error:
        reasons.append(str(error))
        return False
