"""A simulated stick to the screen: every gait is seen, the viewer names the interface, a recording
runs again bit for bit, and without the controller the character rests.

Usage: joystick_line.py BINARY_FOLDER
"""
import sys

from harness import Stage


def last_line(stage):
    done = stage.run("footing-view", "--connect", stage.simulation, "--connect", stage.sensor,
                     "--seconds", 2, "--text")
    assert done.returncode == 0, done.stderr
    return done.stdout.strip().splitlines()[-1]


def main(binaries):
    with Stage(binaries) as stage:
        done = stage.run("footing-sim", "--interface", "telepathy")
        assert done.returncode == 2, done
        assert "wrist, arm, leg, joystick, boards" in done.stderr, done.stderr
        stage.start_servers(interface="joystick")
        stage.start_user("demo", "--link", "good", interface="joystick")
        recording = stage.folder / "recording.mcap"
        done = stage.run("footing-log", "record", "--connect", stage.sensor, "--connect",
                         stage.simulation, "--out", recording, "--seconds", 8)
        assert done.returncode == 0, done.stderr
        seen = stage.run_json("footing-view", "--connect", stage.simulation, "--connect",
                              stage.sensor, "--seconds", 22, "--text", timeout_s=60)
        print(seen)
        assert {"walk", "run", "jump"} <= set(seen["gaits_seen"]), seen
        assert seen["falls"] == 0, seen
        assert seen["responses"] >= 3, seen
        assert "joystick: " in last_line(stage)
        result = stage.run_json("footing-eval", "replay", recording)
        print(result)
        assert result["frames_compared"] > 400, result
        assert result["frames_equal"] == result["frames_compared"], result
        assert stage.stop("footing-stream") == 0
        line = last_line(stage)
        assert "joystick: no devices -> STEP; missing: right hand" in line, line


if __name__ == "__main__":
    main(sys.argv[1])
