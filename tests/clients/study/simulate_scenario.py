"""A whole study of synthetic participants on simulated time: footingd, footing-sim, footing-stream and footing-study as
processes that wait for each other, equal journals from equal seeds, and what is made of them.

Usage: simulate_scenario.py SCENARIOS_FOLDER BINARY_FOLDER
"""
import json
import sys

sys.path.insert(0, sys.argv[1])
from harness import Stage  # noqa: E402

PROTOCOL = {
    "version": 1, "name": "simulated", "participants": ["P01", "P02"], "interfaces": ["wrist", "joystick"], "seed": 3,
    "straight_tasks": ["walk_run"], "straight_trials": 1, "test_tracks": ["1", "2"], "trial_limit_s": 12, "disk_mb": 1,
}


def simulate(stage, folder, *words):
    return stage.run_json("footing-study", "simulate", stage.folder / "s.json", "--folder", stage.folder / folder,
                          *words, timeout_s=250)


def journal(stage, folder, participant):
    path = stage.folder / folder / participant / "journal.jsonl"
    return [json.loads(line) for line in path.read_text().splitlines()]


def undated(events):
    return [{key: value for key, value in event.items() if key != "wall_ns"} for event in events]


def check_sessions(stage):
    """Each session is whole, everything in it is marked synthetic, and its times are simulated."""
    simulated_s = {}
    for participant in PROTOCOL["participants"]:
        events = journal(stage, "a", participant)
        assert events[0]["synthetic"] and events[0]["simulated_time"], events[0]
        assert events[-1]["event"] == "session_finished", events[-1]
        trials = [one for one in events if one["event"] == "trial_started"]
        ends = [one for one in events if one["event"] == "trial_finished"]
        assert len(trials) == len(ends) == 4 and all(one["synthetic"] for one in trials), trials
        assert {one["outcome"] for one in ends} <= {"finished", "timed_out"}, ends
        # The user was at the track: it moved on, at no more than the speed of a run.
        assert all(1 < one["distance_m"] < 60 for one in ends), ends
        assert all(one["wall_s"] < 13 for one in ends), ends
        for trial in trials:
            info = stage.run_json("footing-log", "info", stage.folder / "a" / participant / trial["recording"])
            assert info["complete"], info
        simulated_s[participant] = (events[-1]["wall_ns"] - events[0]["wall_ns"]) * 1e-9
    return simulated_s


def main():
    with Stage(sys.argv[2]) as stage:
        (stage.folder / "s.json").write_text(json.dumps(PROTOCOL))
        made = simulate(stage, "a", "--jobs", 2)
        simulated_s = check_sessions(stage)
        for one in made["sessions"]:
            assert not one["before"] and abs(one["simulated_s"] - simulated_s[one["participant"]]) < 1e-6, made
        # What is there stays; the draft of an interrupted one is thrown away.
        before = (stage.folder / "a/P01/journal.jsonl").read_bytes()
        assert all(one["before"] for one in simulate(stage, "a")["sessions"])
        assert (stage.folder / "a/P01/journal.jsonl").read_bytes() == before
        # The same seed in another folder, alone: the same journal. Another one: another person.
        (stage.folder / "b/.drafts/P02").mkdir(parents=True)
        done = stage.run("footing-study", "simulate", stage.folder / "s.json", "--folder", stage.folder / "b",
                         "--participant", "P02", timeout_s=250)
        # A line for each phase, so that whoever waits sees it go on.
        phases = [one for one in journal(stage, "b", "P02") if one["event"] == "phase_started"]
        assert len(phases) > 4 and all(f"P02: {one['phase']} begins after " in done.stderr for one in phases), done
        assert "P02: finished, 1 of 1 session\n" in done.stderr, done
        assert undated(journal(stage, "b", "P02")) == undated(journal(stage, "a", "P02"))
        simulate(stage, "c", "--participant", "P02", "--seed", 2)
        other = undated(journal(stage, "c", "P02"))
        assert [one for one in other if one["event"] == "trial_finished"] != \
            [one for one in undated(journal(stage, "a", "P02")) if one["event"] == "trial_finished"]
        # Analysis, report and export take it as any study.
        words = (stage.folder / "s.json", "--folder", stage.folder / "a")
        analysis = stage.run_json("footing-study", "analyze", *words)
        assert analysis["synthetic"] and analysis["participants"] == 2, analysis
        assert stage.run("footing-study", "report", *words).returncode == 0
        wrote = stage.run_json("footing-study", "export", *words, "--out", stage.folder / "a.bids")
        assert wrote["trials"] == 8 and not wrote["remarks"], wrote
        check_camera_roll(stage)
        check_refusals(stage)
    return 0


def check_camera_roll(stage):
    """What the protocol chooses of the interface leg is in force, and the recording says so."""
    protocol = {**PROTOCOL, "participants": ["P01"], "interfaces": ["leg"], "straight_trials": 0, "test_tracks": ["1"],
                "trial_limit_s": 2, "camera_roll": True}
    (stage.folder / "r.json").write_text(json.dumps(protocol))
    words = (stage.folder / "r.json", "--folder", stage.folder / "r")
    stage.run_json("footing-study", "simulate", *words, timeout_s=250)
    stage.run_json("footing-study", "export", *words, "--out", stage.folder / "r.bids")
    config = json.loads(next((stage.folder / "r.bids/sourcedata/config").iterdir()).read_text())
    assert config["interface"]["name"] == "leg" and config["interface"]["camera_roll"] is True, config
    assert config["settings"]["camera_roll"] is False and config["features"] == "best", config


def check_refusals(stage):
    """A folder with the session of a person, and a participant whom the protocol does not have."""
    path = stage.folder / "a/P01/journal.jsonl"
    path.write_text(path.read_text().replace('"synthetic":true', '"synthetic":false', 1))
    for words, says in (((), "is of a person"), (("--participant", "P09"), "not in the protocol")):
        done = stage.run("footing-study", "simulate", stage.folder / "s.json", "--folder", stage.folder / "a", *words)
        assert done.returncode == 2 and says in done.stderr, done


if __name__ == "__main__":
    sys.exit(main())
