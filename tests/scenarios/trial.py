"""A trial through real processes: started on another track, run to its finish line, with a failure
that is put back and withdrawn, an operator's put-back that is not one, a task at a line, and a
recording that runs again bit for bit.

Usage: trial.py BINARY_FOLDER
"""
import struct
import sys
import time

import decode_stream
from decode_stream import bytes_field, number_field
from harness import Stage

CONTROL = 3
LOADED = 4  # Times as long as on an idle machine.
READY, RUNNING, FINISHED, STOPPED = 1, 2, 3, 4
AHEAD, DUE, DONE = 1, 2, 3
FALL, PUT_BACK, TRIAL, TASK, CORRECTION = 1, 2, 16, 17, 18
CURVE, STRAIGHTNESS, TRANSITION = 2, 4, 5
STEP, WALK, RUN = 1, 2, 3


def double_field(number, value):
    return decode_stream.varint(number << 3 | 1) + struct.pack("<d", value)


class Operator:
    """A client with the role control: drives the character by hand and reads what is published."""

    def __init__(self, address):
        self.stream = decode_stream.Stream(address, 20)
        self.stream.send(1, number_field(1, 1) + number_field(3, CONTROL))
        while "welcome" not in self.stream.receive():
            pass
        wish = b"".join(bytes_field(1, name) for name in (b"characters", b"events", b"track"))
        self.stream.send(4, wish + number_field(3, 2) + number_field(4, 1024))
        self.last_id, self.events, self.tracks = 0, [], 0
        self.frames = []  # The gait and the trial of each.

    def receive(self):
        message = self.stream.receive()
        assert "refused" not in message and "goodbye" not in message, message
        if "ping" in message:
            now_ns, ping = time.monotonic_ns(), message["ping"]
            self.stream.send(7, b"".join(number_field(i + 1, value) for i, value in
                                         enumerate((ping["id"], ping["t0_ns"], now_ns, now_ns))))
        tick = message.get("tick", {})
        self.events += tick.get("events", {}).get("events", [])
        self.tracks += "track" in tick
        if "characters" in tick:
            character = tick["characters"]["characters"][0]
            self.frames.append((character["gait"], character["trial"]))
        return message

    def command(self, number, message):
        """The answer."""
        self.last_id += 1
        self.stream.send(8, number_field(1, self.last_id) + bytes_field(number, message))
        while True:
            result = self.receive().get("command_result")
            if result and result["id"] == self.last_id:
                return result

    def drive(self, gait, speed_mps, turn_rad=0.0):
        result = self.command(13, number_field(1, 1) + number_field(3, gait) +
                              double_field(4, speed_mps) + double_field(6, turn_rad))
        assert result["ok"], result

    def start(self, trial, track, task=""):
        return self.command(40, number_field(1, 1) + bytes_field(2, trial.encode()) +
                            bytes_field(3, track.encode()) + number_field(4, 5) +
                            bytes_field(5, task.encode()))

    def correct(self, failure, restore=False):
        return self.command(42, number_field(1, failure) + number_field(2, restore) +
                            bytes_field(3, b"the operator stumbled"))

    def until(self, condition, seconds, since=None):
        """The trial of the first frame for which the condition holds: from now on, or from the frame of that number on,
        which a command may have read meanwhile."""
        at = len(self.frames) if since is None else since
        deadline = time.monotonic() + LOADED * seconds
        while time.monotonic() < deadline:
            if at == len(self.frames):
                self.receive()
                continue
            self.gait, self.trial = self.frames[at]
            at += 1
            if condition(self.trial):
                return self.trial
        raise AssertionError(f"not within {LOADED * seconds} s: {self.trial}")

    def of_kind(self, kind):
        return [event for event in self.events if event["kind"] == kind]


def refusals(operator):
    for trial, track, task, words in (("", "1", "", "1 to 64 letters"),
                                      ("a", "9", "", "there are: 1, 2, 3, 4"),
                                      ("a", "/etc/passwd", "", "built-in"),
                                      ("a", "straight", "dance", "walk_run")):
        result = operator.start(trial, track, task)
        assert not result["ok"] and words in result["message"], result
    assert not operator.correct(1)["ok"]
    assert not operator.of_kind(TRIAL)


def straight_track(operator):
    """Falls off the track once, is put back once, does its task and crosses the finish line."""
    operator.drive(RUN, 2.5)
    before = len(operator.frames)
    assert operator.start("p07-1", "straight", "run_walk")["ok"]
    trial = operator.until(lambda t: t["trial"] == "p07-1", 5, before)
    assert trial["phase"] == READY and trial["track"] == "straight" and trial["seed"] == 5, trial
    assert trial["instruction"] == "run to the line, then walk", trial
    assert trial["task_phase"] == AHEAD and 29 < trial["to_mark_m"] <= 30.1, trial

    operator.until(lambda t: t["phase"] == RUNNING and t["distance_m"] > 6, 15)
    operator.drive(RUN, 2.5, 0.05)
    trial = operator.until(lambda t: t["failed_attempts"] == 1, 15)
    before = len(operator.frames)
    operator.drive(RUN, 2.5)
    assert trial["failures"]["straightness"] == 1 and operator.gait["falls"] == 1, trial
    fall, = operator.of_kind(FALL)
    failed_m = fall["failure"]["distance_m"]
    assert fall["failure_cause"] == fall["failure"]["cause"] == STRAIGHTNESS, fall
    assert fall["failure"]["trial"] == "p07-1" and fall["failure"]["number"] == 1, fall
    assert fall["failure"]["lateral_offset_m"] > 1.5 and fall["failure"]["trial_time_s"] > 0, fall
    trial = operator.until(lambda t: t["on_track"] and abs(t["lateral_offset_m"]) < 0.3, 5, before)
    assert failed_m - 3.2 < trial["distance_m"] < failed_m - 2.5, (failed_m, trial)
    assert trial["phase"] == RUNNING, trial

    before = len(operator.frames)
    assert operator.correct(1)["ok"]
    trial = operator.until(lambda t: t["withdrawn_failures"] == 1, 5, before)
    assert trial["failed_attempts"] == 0 and operator.gait["falls"] == 0, trial
    correction, = operator.of_kind(CORRECTION)
    assert correction["failure"]["number"] == 1 and correction["failure"]["withdrawn"], correction
    assert "the operator stumbled" in correction["text"], correction

    assert operator.command(11, number_field(1, 1))["ok"]  # put_back
    trial = operator.until(lambda t: t["operator_put_backs"] == 1, 5)
    assert trial["failed_attempts"] == 0 and operator.gait["falls"] == 0, trial
    assert operator.of_kind(PUT_BACK)[-1]["by_operator"], operator.of_kind(PUT_BACK)

    operator.until(lambda t: t["task_phase"] == DUE, 30)
    operator.drive(WALK, 1.4)
    operator.until(lambda t: t["task_phase"] == DONE, 15)
    assert len(operator.of_kind(TASK)) == 1
    operator.drive(RUN, 3)
    trial = operator.until(lambda t: t["phase"] == FINISHED, 30)
    assert trial["failed_attempts"] == 0 and 59.9 < trial["distance_m"] < 60.5, trial
    marks = [(e["trial"]["trial"], e["trial"]["phase"]) for e in operator.of_kind(TRIAL)]
    assert marks == [("p07-1", READY), ("p07-1", RUNNING), ("p07-1", FINISHED)], marks
    assert operator.of_kind(TRIAL)[-1]["trial"]["time_s"] == trial["time_s"], trial
    # Over the end of the track: it stands again, and nothing has failed.
    operator.until(lambda t: t["distance_m"] > 64, 10)
    trial = operator.until(lambda t: t["distance_m"] < 63, 10)
    assert operator.gait["falls"] == 0 and trial["phase"] == FINISHED, (operator.gait, trial)


def test_track(stage, operator):
    """The console starts the next one on a test track, and stops it."""
    operator.drive(STEP, 0)
    done = stage.run("footing-ctl", "trial", "start", "p07-2", "--track", "2", "--connect",
                     stage.simulation)
    assert done.returncode == 0, done
    trial = operator.until(lambda t: t["trial"] == "p07-2", 5)
    assert trial["track"] == "2" and trial["task"] == "" and trial["number"] == 2, trial
    operator.drive(WALK, 1.3, -0.09)
    operator.until(lambda t: t["failures"]["curve"] == 1, 20)
    operator.drive(STEP, 0)
    done = stage.run("footing-ctl", "trial", "withdraw", 2, "--reason", "test", "--connect",
                     stage.simulation)
    assert done.returncode == 0, done
    operator.until(lambda t: t["withdrawn_failures"] == 1, 5)
    done = stage.run("footing-ctl", "trial", "stop", "p07-1", "--connect", stage.simulation)
    assert done.returncode == 1 and "p07-2" in done.stderr, done
    assert stage.run("footing-ctl", "trial", "stop", "--connect",
                     stage.simulation).returncode == 0
    operator.until(lambda t: t["phase"] == STOPPED, 5)
    done = stage.run("footing-ctl", "trial", "stop", "--connect", stage.simulation)
    assert done.returncode == 1 and '"p07-2" is over' in done.stderr and not done.stdout, done


def main(binaries):
    with Stage(binaries) as stage:
        stage.start("footing-sim", "--sensor", stage.sensor, "--listen", stage.simulation)
        stage.wait_for_socket(stage.simulation)
        recording = stage.folder / "trial.mcap"
        stage.start("footing-log", "record", "--from-ring", "--connect", stage.simulation, "--out", recording)
        operator = Operator(stage.simulation)
        refusals(operator)
        straight_track(operator)
        test_track(stage, operator)
        seen = stage.run_json("footing-view", "--connect", stage.simulation, "--text", "--seconds",
                              2)
        assert seen["trial"]["trial"] == "p07-2" and seen["trial"]["phase"] == "stopped", seen
        assert stage.stop("footing-log") == 0
        replay = stage.run_json("footing-eval", "replay", recording)
        assert replay["frames_equal"] == replay["frames_compared"] > 1000, replay
        assert stage.stop("footing-sim") == 0


if __name__ == "__main__":
    main(sys.argv[1])
