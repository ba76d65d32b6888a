"""Three synthetic users, each with other devices, who see the track through the protocol do a trial of the straight
track unattended: they wait for its start, do the task at the mark and cross the finish line.

Usage: synthetic_users.py BINARY_FOLDER
"""
import json
import sys
import time

from harness import Stage

RUNNING, FINISHED = "running", "finished"


def trial_of(stage):
    seen = stage.run_json("footing-view", "--connect", stage.simulation, "--text", "--seconds", 1)
    return seen["trial"] | {"gaits_seen": seen["gaits_seen"]}


def does_a_trial(stage, interface, seed):
    """The user alone, from the announcement to the finish line."""
    stage.start("footing-stream", "user", "--interface", interface, "--see", stage.simulation, "--seed", seed, "--to",
                stage.devices, name=f"user-{interface}")
    console = ("footing-ctl", "--connect", stage.simulation)
    # Its devices have to be there before the interface can change over to them.
    stage.wait_for(lambda: stage.run(*console, "interface", interface).returncode == 0, f"the {interface} devices")
    name = f"p-{interface}"
    done = stage.run(*console, "trial", "start", name, "--track", "straight", "--task", "walk_run")
    assert done.returncode == 0, done
    deadline = time.monotonic() + 180
    while True:
        trial = trial_of(stage)
        assert trial["trial"] == name, trial
        if trial["phase"] == FINISHED:
            break
        assert time.monotonic() < deadline, trial
    print(interface, json.dumps(trial))
    # Behind the finish line the user stands, and so does the character.
    stage.wait_for(lambda: set(trial_of(stage)["gaits_seen"]) <= {"step"}, "the user to stop", 60)
    # Who does not do the task within 15 m of the mark is put back, so it was done.
    assert trial["time_s"] < 100 and sum(trial["failures"].values()) <= 3, trial
    assert stage.stop(f"user-{interface}") == 0


def main(binaries):
    with Stage(binaries) as stage:
        stage.start_servers(interface="joystick")
        done = stage.run("footing-stream", "user", "--interface", "telepathy", "--see", stage.simulation)
        assert done.returncode == 2 and "wrist, arm, leg, joystick, boards" in done.stderr, done
        done = stage.run("footing-stream", "user", "--interface", "leg", "--turn-by", "tail", "--see", stage.simulation)
        assert done.returncode == 2 and "head, feet, trunk" in done.stderr, done
        does_a_trial(stage, "joystick", 3)
        does_a_trial(stage, "leg", 4)
        does_a_trial(stage, "boards", 11)


if __name__ == "__main__":
    main(sys.argv[1])
