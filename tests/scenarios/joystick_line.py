"""A simulated stick to the screen: every gait is seen, the viewer names the interface, a recording
runs again bit for bit, and without the controller the character rests. Then a person changes from
one interface to another between two trials.

Usage: joystick_line.py BINARY_FOLDER
"""
import sys

from harness import Stage


def last_line(stage):
    done = stage.run("footing-view", "--connect", stage.simulation, "--connect", stage.sensor,
                     "--seconds", 2, "--text")
    assert done.returncode == 0, done.stderr
    return done.stdout.strip().splitlines()[-1]


def replays(stage, recording):
    result = stage.run_json("footing-eval", "replay", recording)
    print(result)
    assert result["frames_compared"] > 400, result
    assert result["frames_equal"] == result["frames_compared"], result


def refused(stage, name, *words):
    done = stage.run("footing-ctl", "--connect", stage.simulation, "interface", name)
    assert done.returncode == 1 and all(word in done.stderr for word in words), done


def changes(stage):
    """Another interface between trials: not within one, and not without its devices."""
    stage.start("footing-sim", "--sensor", stage.sensor, "--listen", stage.simulation, "--track",
                "straight", name="second")
    stage.wait_for_socket(stage.simulation)
    recording = stage.folder / "changes.mcap"
    stage.start("footing-log", "record", "--from-ring", "--connect", stage.simulation, "--out", recording)
    stage.start_user("demo", "--link", "good")
    stage.wait_for(lambda: "wrist: hands" in last_line(stage), "the hands")
    console = ("footing-ctl", "--connect", stage.simulation)
    refused(stage, "boards", "left_board, right_board")
    assert stage.run(*console, "trial", "start", "p1", "--track", "1").returncode == 0
    refused(stage, "arm", "trial (p1)")
    assert stage.run(*console, "trial", "stop").returncode == 0
    assert stage.run(*console, "interface", "telepathy").returncode == 2
    assert stage.run_json(*console, "interface", "arm") == {"interface": "arm"}
    stage.wait_for(lambda: "arm: arms" in last_line(stage), "the arms")
    assert stage.run(*console, "trial", "start", "p2", "--track", "2").returncode == 0
    assert "arm: " in last_line(stage)
    assert stage.stop("footing-log") == 0
    replays(stage, recording)


def main(binaries):
    with Stage(binaries) as stage:
        done = stage.run("footing-sim", "--interface", "telepathy")
        assert done.returncode == 2, done
        assert "wrist, arm, leg, joystick, boards" in done.stderr, done.stderr
        stage.start_servers(interface="joystick")
        stage.start_user("demo", "--link", "good", interface="joystick")
        stage.wait_for_devices(1)
        recording = stage.folder / "recording.mcap"
        done = stage.run("footing-log", "record", "--from-ring", "--connect", stage.sensor, "--connect",
                         stage.simulation, "--out", recording, "--seconds", 8)
        assert done.returncode == 0, done.stderr
        # The motion repeats after 29 s: whenever this begins, it sees every gait.
        seen = stage.run_json("footing-view", "--connect", stage.simulation, "--connect",
                              stage.sensor, "--seconds", 32, "--text", timeout_s=75)
        print(seen)
        assert {"walk", "run", "jump"} <= set(seen["gaits_seen"]), seen
        assert seen["falls"] == 0, seen
        assert seen["responses"] >= 3, seen
        assert "joystick: " in last_line(stage)
        replays(stage, recording)
        assert stage.stop("footing-stream") == 0
        missing = "joystick: no devices -> STEP; missing: the joystick in the right hand"
        stage.wait_for(lambda: missing in last_line(stage), "the loss on the screen")
        line = last_line(stage)  # Later than every timeout: footingd still answers.
        assert "!! No signal from the joystick in the right hand" in line, line
        assert stage.stop("footing-sim") == 0
        changes(stage)


if __name__ == "__main__":
    main(sys.argv[1])
