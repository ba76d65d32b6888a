"""kill -9 of footing-study, footing-sim and footingd at instants from a seed, in sessions one after the other: no line
of a journal is lost or torn, a trial that was cut is marked and attempted again, every survey is answered in the end,
and every session finishes.

Usage: kill_scenario.py SCENARIOS_FOLDER BINARY_FOLDER [KILLS_OF_EACH [SEED]]
"""
import json
import random
import signal
import sys
import time

sys.path.insert(0, sys.argv[1])
from harness import Stage  # noqa: E402

RATINGS = [f"item {number}" for number in range(30)]  # A survey that lasts long enough to be hit.
PROTOCOL = {
    "version": 1, "name": "kills", "participants": [f"P{number:02}" for number in range(1, 16)],
    "interfaces": ["arm", "wrist"], "control": "arm", "seed": 5, "straight_tasks": ["walk_run"], "straight_trials": 2,
    "test_tracks": ["1", "2"], "trial_limit_s": 3, "disk_mb": 1,
    "survey": {"ratings": RATINGS, "questions": ["good", "bad"], "exertion": True},
    "final_survey": {"ratings": RATINGS, "questions": ["good", "bad"], "overall": ["preferred interface", "remarks"]},
}
PROGRAMS = ("footing-study", "footing-sim", "footingd")
LATEST_KILL_S, LATEST_IN_TRIAL_S, LATEST_IN_SURVEY_S, RUN_WITHIN_S = 4.0, 1.5, 0.01, 90
CUT = ("broken_off", "device_lost", None)  # None: footing-study itself was killed, so the journal has no end.


class Study:
    """The sessions of one study, which are killed and resumed."""

    def __init__(self, stage):
        self.stage = stage
        (stage.folder / "s.json").write_text(json.dumps(PROTOCOL))
        self.participants = iter(PROTOCOL["participants"])
        self.finished, self.in_surveys = [], 0
        self.next_participant()

    def next_participant(self):
        self.participant, self.lines = next(self.participants), []
        self.path = self.stage.folder / "s.study" / self.participant / "journal.jsonl"

    def start(self):
        return self.stage.start("footing-study", "run", self.stage.folder / "s.json", "--participant", self.participant,
                                "--sensor", self.stage.sensor, "--simulation", self.stage.simulation, "--unattended")

    def new_text(self):
        """What the journal says since the run began."""
        text = self.path.read_text() if self.path.exists() else ""
        return text[sum(len(line) + 1 for line in self.lines):]

    def wait(self, process, what):
        """Until the journal says it, or the session has ended."""
        deadline = time.monotonic() + RUN_WITHIN_S
        while process.poll() is None and what not in self.new_text():
            assert time.monotonic() < deadline, f"no {what} in {self.path}"
            time.sleep(0.002)

    def reach_trial(self, process):
        """A session that is in a trial: this one, or the next one where this one had no trial left."""
        self.wait(process, '"trial_started"')
        if process.poll() is None:
            return process
        self.check_prefix()
        process = self.start()
        self.wait(process, '"trial_started"')
        return process

    def run_with_kill(self, program, draw, in_trial):
        """Runs the session until its end or, where that is earlier, a kill, which may be in its first trial for certain."""
        process, where = self.start(), draw.random()
        latest_s = LATEST_KILL_S
        if program == "footing-study" and where < 0.5:
            self.wait(process, '"kind":"survey"')
            latest_s = LATEST_IN_SURVEY_S
        elif in_trial:
            process, latest_s = self.reach_trial(process), LATEST_IN_TRIAL_S
        elif where < 0.8:  # Else even the connections may be cut.
            self.wait(process, "{")
        time.sleep(draw.uniform(0, latest_s))
        if process.poll() is not None:
            assert process.poll() == 0, (self.stage.folder / "footing-study.log").read_text()
        else:
            self.stage.stop(program, signal.SIGKILL)
            if program == "footing-study":
                phase = [one for one in map(json.loads, self.new_text().splitlines()) if "phase" in one][-1:]
                self.in_surveys += bool(phase) and phase[0].get("kind") == "survey"
            else:
                code = process.wait(RUN_WITHIN_S)
                assert code in (0, 1, 3), (code, (self.stage.folder / "footing-study.log").read_text())
                start_server(self.stage, program)
        self.check_prefix()

    def check_prefix(self):
        """What the journal held before is there still, each line whole; a line that was torn is the newest one."""
        text = self.path.read_text() if self.path.exists() else ""
        now = text.split("\n")[:-1]
        assert now[:len(self.lines)] == self.lines, (self.lines[-1:], now[-1:])
        assert [json.loads(one)["number"] for one in now] == list(range(1, len(now) + 1))
        self.lines = now
        if now and json.loads(now[-1])["event"] == "session_finished":
            self.finished.append([json.loads(one) for one in now])
            self.next_participant()

    def finish(self):
        """The session that is under way, without further kills."""
        sessions = len(self.finished)
        code = self.start().wait(2 * RUN_WITHIN_S)
        assert code == 0, (self.stage.folder / "footing-study.log").read_text()
        self.check_prefix()
        assert len(self.finished) == sessions + 1


def start_server(stage, program):
    if program == "footingd":
        stage.start("footingd", "--listen", stage.sensor, "--source", f"stream:{stage.devices}")
        stage.wait_for_socket(stage.sensor)
    else:
        stage.start("footing-sim", "--sensor", stage.sensor, "--listen", stage.simulation)
        stage.wait_for_socket(stage.simulation)


def check_trials(events):
    """Returns how many attempts were cut."""
    trials = [one for one in events if one["event"] == "trial_started"]
    ends = {one["trial"]: one["outcome"] for one in events if one["event"] == "trial_finished"}
    resumed = {one["interrupted_trial"] for one in events if one["event"] == "session_resumed"}
    assert len({one["trial"] for one in trials}) == len(trials), trials
    assert {one["trial"] for one in trials} - set(ends) <= resumed, (trials, ends)  # Without an end, it is named.
    cut = [one for one in trials if ends.get(one["trial"]) in CUT]
    phases = {one["phase"] for one in trials}
    assert len(phases) == 6, phases
    for phase in phases:  # The last attempt counts, and those before it were cut.
        attempts = [one for one in trials if one["phase"] == phase]
        assert [one["attempt"] for one in attempts] == list(range(1, len(attempts) + 1)), attempts
        assert [one in cut for one in attempts] == [True] * (len(attempts) - 1) + [False], attempts
    return len(cut)


def check_surveys(events):
    """Every question has its answer, and none was asked again after a kill."""
    asked = [(one["at_end"], one["interface"], one.get("item", one.get("question"))) for one in events
             if one["event"] in ("rating", "exertion", "answer")]
    expected = {(at_end, interface, item) for interface in ("arm", "wrist") for at_end in (False, True)
                for item in (*RATINGS, "good", "bad")}
    expected |= {(False, interface, "exertion") for interface in ("arm", "wrist")}
    expected |= {(True, "", item) for item in ("preferred interface", "remarks")}
    assert set(asked) == expected, set(asked) ^ expected
    assert len(asked) == len(expected), sorted(asked)


def main():
    kills_of_each = int(sys.argv[3]) if len(sys.argv) > 3 else 3
    draw = random.Random(int(sys.argv[4]) if len(sys.argv) > 4 else 11)
    with Stage(sys.argv[2]) as stage:
        stage.start_servers()
        stage.start_user("demo")
        study = Study(stage)
        for _ in range(kills_of_each):
            for program in PROGRAMS:
                study.run_with_kill(program, draw, in_trial=program == "footing-sim")
        if study.lines:
            study.finish()
        cut = sum(check_trials(events) for events in study.finished)
        for events in study.finished:
            check_surveys(events)
        resumed = sum(one["event"] == "session_resumed" for events in study.finished for one in events)
        print(f"{len(study.finished)} sessions, {kills_of_each} kills of each program, {study.in_surveys} of "
              f"footing-study in a survey, {cut} attempts cut, resumed {resumed} times")
        assert cut >= kills_of_each and resumed >= kills_of_each, (cut, resumed)
    return 0


if __name__ == "__main__":
    sys.exit(main())
