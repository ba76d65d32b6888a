"""Two studies and an operator at one footingd and one footing-sim: only who has their leases controls them.

Usage: lease_scenario.py SCENARIOS_FOLDER BINARY_FOLDER
"""
import json
import signal
import sys

sys.path.insert(0, sys.argv[1])
from harness import Stage, read_ticks  # noqa: E402

PROTOCOL = {
    "version": 1, "name": "lease", "participants": ["P01", "P02"], "interfaces": ["wrist"], "seed": 4, "practice_s": 0,
    "straight_trials": 0, "test_tracks": ["1"], "trial_limit_s": 60, "disk_mb": 1,
}
LEASE = 19
HOLDER = "footing-study, participant P01 has the lease"
OF_FOOTINGD = HOLDER + " of this footingd; wait until that ends, or take it over: footing-ctl lease --of footingd --take-over"


def journal(stage, folder, participant):
    path = stage.folder / folder / participant / "journal.jsonl"
    return [json.loads(line) for line in path.read_text().splitlines()] if path.exists() else []


def words(stage, folder, participant):
    return ("run", stage.folder / "s.json", "--participant", participant, "--sensor", stage.sensor, "--simulation",
            stage.simulation, "--unattended", "--folder", stage.folder / folder)


def begin_trial(stage, folder, participant):
    """A session that is in its trial."""
    already = len(journal(stage, folder, participant))
    process = stage.start("footing-study", *words(stage, folder, participant), name=participant)
    stage.wait_for(lambda: any(one["event"] == "trial_started" for one in
                               journal(stage, folder, participant)[already:]), "a trial", 60)
    return process


def console(stage, *command):
    return stage.run("footing-ctl", *command, "--connect", stage.simulation)


def at_footingd(stage, *command):
    return stage.run("footing-ctl", *command, "--connect", stage.sensor)


def assign_back(stage):
    """The left hand's device is that already: only who may set devices up is asked."""
    return at_footingd(stage, "assign", "main/left_hand", "main/left_hand")


def check_devices_are_kept(stage):
    """In a trial nobody else changes the devices; the refusal says who has them, and how to take them."""
    for command in (("assign", "main/left_hand", "main/right_hand"), ("led", "left_hand", "1010"), ("rumble", "left_hand")):
        done = at_footingd(stage, *command)
        assert done.returncode == 1 and OF_FOOTINGD in done.stderr, done
    roles = {device["role"] for device in stage.run_json("footing-ctl", "--connect", stage.sensor, "status")["devices"]}
    assert roles == {"left_hand", "right_hand"}, roles


def check_refusals(stage):
    assert HOLDER in console(stage, "lease").stdout
    for command in (("trial", "start", "x"), ("trial", "stop"), ("trial", "put-back"), ("trial", "withdraw", 1),
                    ("interface", "arm")):
        done = console(stage, *command)
        assert done.returncode == 1 and HOLDER in done.stderr and "--take-over" in done.stderr, done
    done = stage.run("footing-study", *words(stage, "other.study", "P02"))
    assert done.returncode == 1 and HOLDER in done.stderr, done
    assert not journal(stage, "other.study", "P02")


def check_take_over(stage, process):
    """The study ends with who took the lease, or that it is lost; the events say so."""
    ticks = read_ticks(stage.simulation, 60, ("events",))
    next(ticks)
    done = console(stage, "lease", "--take-over")
    assert done.returncode == 0 and "taken over from" in done.stdout, done
    texts = []
    for tick in ticks:
        texts += [event["text"] for event in tick.get("events", {}).get("events", []) if event["kind"] == LEASE]
        if len(texts) == 2:
            break
    assert "footing-ctl takes it over from" in texts[0] and "participant P01" in texts[0], texts
    assert "footing-ctl releases it" in texts[1], texts
    assert process.wait(60) == 1
    assert "take_lease: " in (stage.folder / "P01.log").read_text()
    assert console(stage, "lease").stdout == "nobody has the lease\n"
    assert console(stage, "trial", "stop").returncode == 0
    stage.wait_for(lambda: assign_back(stage).returncode == 0, "footingd's lease, which the study gave back")


def check_devices_taken_over(stage):
    """Who takes footingd's lease over ends the study, too, and its trial counts no more."""
    process = begin_trial(stage, "s.study", "P01")
    done = at_footingd(stage, "lease", "--of", "footingd", "--take-over")
    assert done.returncode == 0, done
    assert process.wait(60) == 1
    log = (stage.folder / "P01.log").read_text()
    assert f"footingd at {stage.sensor}: " in log and "take_lease: " in log, log
    last = journal(stage, "s.study", "P01")[-1]
    assert last["event"] == "trial_finished" and last["outcome"] == "broken_off", last
    assert assign_back(stage).returncode == 0


def check_end(stage):
    """After kill -9 the lease runs out; the next session has it, and gives it back at its end."""
    begin_trial(stage, "s.study", "P01")
    stage.stop("P01", signal.SIGKILL)
    assert HOLDER in console(stage, "lease").stdout
    assert OF_FOOTINGD in assign_back(stage).stderr
    stage.wait_for(lambda: assign_back(stage).returncode == 0, "the end of footingd's lease")
    stage.wait_for(lambda: console(stage, "lease").stdout == "nobody has the lease\n", "the end of the lease")
    (stage.folder / "s.json").write_text(json.dumps({**PROTOCOL, "trial_limit_s": 3}))
    done = stage.run("footing-study", *words(stage, "short.study", "P02"))
    assert done.returncode == 0, done
    assert console(stage, "lease").stdout == "nobody has the lease\n"
    assert assign_back(stage).returncode == 0


def main():
    with Stage(sys.argv[2]) as stage:
        (stage.folder / "s.json").write_text(json.dumps(PROTOCOL))
        stage.start_servers()
        stage.start_user("demo")
        process = begin_trial(stage, "s.study", "P01")
        check_refusals(stage)
        check_devices_are_kept(stage)
        check_take_over(stage, process)
        check_devices_taken_over(stage)
        check_end(stage)
    return 0


if __name__ == "__main__":
    sys.exit(main())
