"""The disk is full in the middle of a trial: the session says so and ends, nothing of its journal is lost, and with space
again it goes on with a second attempt. The disk is a small tmpfs in a mount namespace of the test's own; where the
kernel allows none to this user the test is skipped (77).

Usage: disk_full_scenario.py SCENARIOS_FOLDER BINARY_FOLDER
"""
import json
import sys

sys.path.insert(0, sys.argv[1])
import small_disk  # noqa: E402
from harness import Stage  # noqa: E402

PROTOCOL = {
    "version": 1, "name": "full", "participants": ["P01"], "interfaces": ["wrist"], "seed": 6, "straight_trials": 0,
    "test_tracks": ["1"], "trial_limit_s": 15, "disk_mb": 2,
}
DISK = "24m"


def main():
    if small_disk.INSIDE not in sys.argv:
        return small_disk.enter_namespace()
    with Stage(sys.argv[2]) as stage, small_disk.mounted(stage.folder / "disk", DISK) as disk:
        check(stage, disk)
    return 0


def check(stage, disk):
    (stage.folder / "s.json").write_text(json.dumps(PROTOCOL))
    command = ("run", stage.folder / "s.json", "--participant", "P01", "--sensor", stage.sensor, "--simulation",
               stage.simulation, "--unattended", "--folder", disk / "s.study")
    path = disk / "s.study/P01/journal.jsonl"
    stage.start_servers()
    stage.start_user("demo")
    running = stage.start("footing-study", *command)
    stage.wait_for(lambda: path.exists() and '"trial_started"' in path.read_text(), "a trial", 60)
    recording = disk / "s.study/P01/wrist.test.1.mcap"
    stage.wait_for(lambda: recording.exists() and recording.stat().st_size > 500_000, "a recording", 60)
    before = path.read_text().splitlines()
    filler = small_disk.fill(disk)
    assert running.wait(30) == 1
    said = (stage.folder / "footing-study.log").read_text()
    assert said.count("No space left on device") == 1 and str(recording) in said, said
    assert "does not count" in said and "run the same command" in said, said
    after = path.read_text().splitlines()
    assert after[:len(before)] == before, (before[-1], after[-1])
    # Without space the session does not even begin.
    done = stage.run("footing-study", *command)
    assert done.returncode == 1 and "0 MB free on the disk" in done.stderr, done
    assert path.read_text().splitlines() == after
    filler.unlink()
    # What was written of the cut recording is there.
    repaired = stage.run("footing-log", "repair", recording, "--out", stage.folder / "repaired.mcap")
    assert repaired.returncode == 0, repaired
    assert stage.run_json("footing-log", "info", stage.folder / "repaired.mcap")["duration_s"] > 0.5
    done = stage.run("footing-study", *command, timeout_s=120)
    assert done.returncode == 0, done
    events = [json.loads(line) for line in path.read_text().splitlines()]
    assert [one["number"] for one in events] == list(range(1, len(events) + 1))
    assert [json.dumps(one, separators=(",", ":")) for one in events][:len(after)] == after
    trials = [one for one in events if one["event"] == "trial_started"]
    ends = {one["trial"]: one for one in events if one["event"] == "trial_finished"}
    assert [one["attempt"] for one in trials] == [1, 2], trials
    resumed = [one for one in events if one["event"] == "session_resumed"]
    if trials[0]["trial"] in ends:
        cut = ends[trials[0]["trial"]]
        assert cut["outcome"] == "broken_off" and "No space" in cut["reason"], cut
    else:  # Not even that fitted on the disk.
        assert resumed[0]["interrupted_trial"] == trials[0]["trial"], resumed
    assert ends[trials[1]["trial"]]["outcome"] in ("finished", "timed_out"), ends
    assert events[-1]["event"] == "session_finished", events[-1]


if __name__ == "__main__":
    sys.exit(main())
