"""The experimenter's side of footing-study on a terminal: consent, practice that is ended early, the stop key, the undo
of a failure in and after a trial, a repeated trial, surveys, and the journal of it all.

Usage: attended_scenario.py SCENARIOS_FOLDER BINARY_FOLDER
"""
import json
import os
import pty
import re
import select
import subprocess
import sys
import time

sys.path.insert(0, sys.argv[1])
from harness import Stage, read_ticks  # noqa: E402

PROTOCOL = {
    "version": 1, "name": "attended", "participants": ["P01", "P02", "P03", "P04"], "interfaces": ["wrist"], "seed": 2,
    "practice_s": 100, "straight_trials": 0, "test_tracks": ["3"],
    "survey": {"ratings": ["fun"], "questions": ["good"], "exertion": True},
    "final_survey": {"ratings": ["like"], "overall": ["preferred interface", "remarks"]},
    "devices": {"allow_simulated": True}, "disk_mb": 1, "active_limit_min": 0.05, "active_rest_s": 1,
}
PRACTICE, GET_READY, TRIAL, STOPPED, SURVEY = 4, 5, 6, 8, 10  # StudyActivity.


class Experimenter:
    """Types into the terminal of footing-study and reads what it says."""

    def __init__(self, stage, *command, name="attended"):
        self.terminal, slave = pty.openpty()
        self.process = subprocess.Popen([stage.binaries / "footing-study", *command], stdin=slave,
                                        stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
        stage.processes[name] = self.process
        os.close(slave)
        self.said = ""

    def read(self, pattern, seconds=90):
        """The match, once it has been said; what was said before it is forgotten."""
        deadline = time.monotonic() + seconds
        while time.monotonic() < deadline:
            found = re.search(pattern, self.said)
            if found:
                self.said = self.said[found.end():]
                return found
            if select.select([self.process.stderr], [], [], 0.1)[0]:
                more = os.read(self.process.stderr.fileno(), 4096).decode()
                assert more, f"it ended before {pattern}: {self.said}"
                self.said += more
        raise AssertionError(f"not within {seconds} s: {pattern}; said: {self.said}")

    def type(self, text):
        os.write(self.terminal, text.encode())

    def answer(self, pattern, text):
        self.read(pattern)
        self.type(text + "\n")


def check_lock(stage):
    """While a session runs nothing else writes into its journals."""
    path = stage.folder / "a.study/P01/journal.jsonl"
    before = path.read_text()
    for change in (("--withdraw",), ("--undo-failure", 1), ("--restore-failure", 1)):
        done = stage.run("footing-study", "run", stage.folder / "a.json", "--participant", "P01", *change)
        assert done.returncode == 1 and "the session of P01 is in use by" in done.stderr, done
    assert path.read_text() == before
    second = ("run", stage.folder / "a.json", "--participant", "P02", "--unattended")
    done = stage.run("footing-study", *second)
    assert done.returncode == 1 and "the study is in use by" in done.stderr, done


def check_other(stage):
    """Who has been here before may withdraw while somebody else's session runs."""
    other = stage.folder / "a.study/P02"
    other.mkdir()
    other.joinpath("journal.jsonl").write_text(
        '{"number":1,"wall_ns":1,"event":"session_started","participant":"P02","interfaces":["wrist"]}\n')
    done = stage.run("footing-study", "run", stage.folder / "a.json", "--participant", "P02", "--withdraw")
    assert done.returncode == 0 and '"withdrawn"' in other.joinpath("journal.jsonl").read_text(), done


def check_shown(stage, doing, activity):
    """What all screens are told once the experimenter's says this; the activity is what the participant's shows."""
    state = next(tick["study"] for tick in read_ticks(stage.simulation, 30, ("study", "characters"))
                 if doing in tick.get("study", {}).get("doing", ""))
    assert state["activity"] == activity, state
    return state


def session(stage, start):
    experimenter = start()
    experimenter.answer("Type yes to confirm", "yes")
    experimenter.read("show all commands")
    check_lock(stage)
    check_other(stage)
    experimenter.type("\n")
    experimenter.read("Practice of wrist: 100 s left")
    assert check_shown(stage, "Practice of wrist", PRACTICE)["left_s"] > 90
    experimenter.type("\n")
    experimenter.read("Press Enter to begin")
    assert check_shown(stage, "Next: track 3", GET_READY)["attempt"] == 1
    experimenter.type("\n")
    experimenter.read("Keys: s stops the trial")
    assert check_shown(stage, "The trial is running", TRIAL)["left_s"] == 3  # The participant is counted in.
    experimenter.type("u")
    experimenter.read("no failure to undo")
    # A user who does not look at the track leaves it, again and again.
    experimenter.read(r"failure \d+: \w+", 90)
    experimenter.type("u")
    first = experimenter.read(r"failure (\d+) undone")
    second = experimenter.read(r"failure (\d+): (\w+)", 90)
    experimenter.type("s")
    shown = experimenter.read(r"test: stopped, [\d.]+ s, failures: (\d+)")
    doing = check_shown(stage, "The trial is over", STOPPED)["doing"]
    assert re.search(r"has moved for \d+ min: a rest of \d+ min comes next", doing), doing
    experimenter.answer("r to repeat", f"undo {second[1]}")
    experimenter.read(f"'undo {second[1]}' is none of these; nothing was changed")
    experimenter.answer("r to repeat", f"u {second[1]}")
    experimenter.read(f"failure {second[1]} undone")
    experimenter.answer("u NUMBER to undo", "u 999")
    experimenter.read("has no failure 999")
    experimenter.answer("u NUMBER to undo", "r")
    experimenter.answer("Press Enter to begin", "")
    experimenter.read("Keys: s stops the trial")
    experimenter.type("s")
    experimenter.read(r"test: stopped[^:]*failures: \d+\n.*u NUMBER")
    # Killed at the question, the session asks it again, and the trial is kept.
    experimenter.process.kill()
    experimenter.process.wait()
    experimenter = start()
    experimenter.type("\n3\n")  # Ahead of any prompt: answers none of them.
    experimenter.read("has ended before: stopped")
    experimenter.answer("r to repeat", "")
    experimenter.read("fun, 1 to 5")
    check_shown(stage, "answers the survey", SURVEY)
    experimenter.type("6\n")
    experimenter.answer("whole number(?s:.*)fun, 1 to 5", "4")  # What is typed before the prompt is dropped.
    experimenter.answer("exertion", "7")
    experimenter.answer("good .one line", "it walks")
    experimenter.answer("Survey at the end(?s:.*)wrist: like, 1 to 5", "5")
    experimenter.answer(r"preferred interface \(1 wrist\):", "the first")
    experimenter.answer(r"Type one of them(?s:.*)preferred interface \(1 wrist\):", "1")
    experimenter.answer("remarks .one line", "")
    assert experimenter.process.wait(60) == 0
    return int(first[1]), int(second[1]), int(shown[1])


def check_next(start):
    """The next participant: two prompts to answer before they practise."""
    experimenter = start()
    experimenter.answer("Type yes to confirm", "yes")
    said = experimenter.read(r"([\s\S]*)show all commands\. Press Enter when done:")[1]
    assert "Press Enter" not in said and "Type" not in said, said
    experimenter.type("\n")
    said = experimenter.read(r"([\s\S]*)Practice of wrist: 100 s left")[1]
    assert "Press Enter" not in said and "Type" not in said, said
    experimenter.process.kill()
    experimenter.process.wait()


def check_remedy(stage, start):
    """While a device check waits for a remedy, the experimenter may set devices up; from then on nobody may."""
    def assign(device, role):
        return stage.run("footing-ctl", "--connect", stage.sensor, "assign", device, role)

    # The lease of the session that was killed runs out.
    stage.wait_for(lambda: assign("main/left_hand", "main/head").returncode == 0, "footingd's lease")
    experimenter = start()
    experimenter.answer("Type yes to confirm", "yes")
    # What it waits for is said at once, long before the check gives up.
    experimenter.read("Waiting for the devices: [^\n]*left_hand is missing", 5)
    experimenter.read("The devices are not ready: [^\n]*left_hand")
    experimenter.read("Press Enter to check again")
    stage.wait_for(lambda: assign("main/head", "main/left_hand").returncode == 0, "a remedy")
    experimenter.type("\n")
    experimenter.read("show all commands")
    done = assign("main/left_hand", "main/head")
    assert done.returncode == 1 and "participant P04 has the lease of this footingd" in done.stderr, done
    experimenter.process.kill()
    experimenter.process.wait()


def check_rests(events):
    """Who has moved for the limit rests before they move again, and the journal says after how long."""
    rests = [one for one in events if "rested_at_active_s" in one]
    assert rests and all("Rest after" in one["text"] and one["took_s"] == 1 for one in rests), rests
    at_s = [one["rested_at_active_s"] for one in rests]
    assert at_s[0] >= 3 and all(later - before >= 3 for before, later in zip(at_s, at_s[1:])), at_s
    for one in rests:  # The next event is a phase with motion: none rests before a survey.
        following = events[one["number"]]
        assert following["event"] == "phase_started", following
        assert following["kind"] in ("demonstration", "practice", "test_track"), following


def check_journal(stage, first, second, shown):
    events = [json.loads(line) for line in (stage.folder / "a.study/P01/journal.jsonl").read_text().splitlines()]
    of = {}
    for event in events:
        of.setdefault(event["event"], []).append(event)
    assert not events[0]["synthetic"] and events[-1]["event"] == "session_finished", events
    check_rests(events)
    notes = [one for one in of["note"] if "rested_at_active_s" not in one]
    assert [one["text"] for one in notes][1:] == ["Practice of wrist ended early"], notes
    assert notes[1]["planned_s"] == 100 > notes[1]["took_s"], notes
    assert [one["failure"] for one in of["failure_undone"]] == [first, second], of["failure_undone"]
    repeated = of["trial_started"][1]["number"]
    failed = [one for one in of["failure"] if one["number"] < repeated]
    assert shown == len(failed) - 1 >= 1, (shown, of["failure"])  # The second was undone after it was shown.
    assert [one["attempt"] for one in of["trial_started"]] == [1, 2], of["trial_started"]
    assert all(one["synthetic"] for one in of["trial_started"]), of["trial_started"]  # Simulated devices.
    assert [one["outcome"] for one in of["trial_finished"]] == ["stopped", "stopped"], of["trial_finished"]
    assert of["trial_finished"][0]["failed_attempts"] == 1, of["trial_finished"]
    assert [(one["item"], one["interface"], one["at_end"], one["value"]) for one in of["rating"]] == [
        ("fun", "wrist", False, 4), ("like", "wrist", True, 5)], of["rating"]
    assert of["exertion"][0]["value"] == 7, of["exertion"]
    assert [one["text"] for one in of["answer"]] == ["it walks", "wrist", ""], of["answer"]


def check_unattended(stage):
    """Random answers and simulated devices do not get among the sessions of people."""
    done = stage.run("footing-study", "run", stage.folder / "a.json", "--participant", "P03", "--unattended",
                     "--sensor", stage.sensor, "--simulation", stage.simulation)
    assert done.returncode == 2 and "P01/journal.jsonl is of a person" in done.stderr, done
    assert not (stage.folder / "a.study/P03").exists()


def main():
    with Stage(sys.argv[2]) as stage:
        protocol = stage.folder / "a.json"
        protocol.write_text(json.dumps(PROTOCOL))
        stage.start_servers()
        stage.start_user("demo")

        def start(participant):
            return Experimenter(stage, "run", protocol, "--participant", participant, "--sensor", stage.sensor,
                                "--simulation", stage.simulation)

        check_journal(stage, *session(stage, lambda: start("P01")))
        check_unattended(stage)
        check_next(lambda: start("P03"))
        check_remedy(stage, lambda: start("P04"))
    return 0


if __name__ == "__main__":
    sys.exit(main())
