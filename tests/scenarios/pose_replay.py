"""A recording of the pose engine, with boards and a Kinect's joints, spheres that footing-camera finds in rendered
frames, or Wiimotes strapped on the arms, runs again to the same frames, bit for bit.

Usage: pose_replay.py BINARY_FOLDER kinect|camera|straps
"""
import json
import sys

from harness import Stage
from pose_hands import start
from pose_line import TPoseMissed, Watcher, with_t_pose


def main(binaries, hands):
    return with_t_pose(lambda: run(binaries, hands))


def run(binaries, hands):
    with Stage(binaries) as stage:
        stage.start("footingd", "--listen", stage.sensor, "--source", f"stream:{stage.devices}")
        stage.wait_for_socket(stage.sensor)
        stage.wait_for_socket(stage.devices)
        stage.start("footing-sim", "--engine", "pose", "--sensor", stage.sensor, "--listen",
                    stage.simulation)
        stage.wait_for_socket(stage.simulation)
        start(stage, hands)
        recording = stage.folder / "recording.mcap"
        logger = stage.start("footing-log", "record", "--from-ring", "--connect", stage.sensor, "--connect",
                             stage.simulation, "--out", recording, "--seconds", 22)
        stage.wait_for(lambda: "footing-sim" in (stage.folder / "footing-log.log").read_text(),
                       "the logger to be connected")
        # A T-pose, then the paper's mode, then a second subject in the middle of the motion.
        source = {"straps": "wiimote"}.get(hands, hands)
        try:
            Watcher(stage.simulation).wait(lambda body: body["calibrated"] and body["hands_source"] == source, "the hands", 14)
        except AssertionError as missed:
            raise TPoseMissed(missed) from missed
        done = stage.run("footing-ctl", "--connect", stage.simulation, "mode", "paper", "--leave-out", "angular_momentum")
        assert done.returncode == 0, done
        Watcher(stage.simulation).wait(
            lambda body: body["mode"] == "paper" and body["left_out"] == ["angular_momentum"] and body["calibrated"],
            "the paper's mode with the T-pose", 4)
        subject = stage.folder / "p02.json"
        subject.write_text('{"code": "p02", "height_m": 1.62}')
        done = stage.run("footing-ctl", "--connect", stage.simulation, "subject", subject)
        assert done.returncode == 0, done
        assert logger.wait(60) == 0
        result = stage.run_json("footing-eval", "replay", recording)
        print(result)
        assert result["frames_compared"] > 600, result
        assert result["frames_equal"] == result["frames_compared"], result
        assert result["features_equal"] == result["features_compared"], result
        smooth(stage, recording, result["frames_compared"])


def smooth(stage, recording, frames):
    """With a lag the same frames come out, each with an earlier pose, and they run again, too."""
    copy = stage.folder / "smooth.mcap"
    result = stage.run_json("footing-eval", "smooth", recording, "--out", copy)
    assert result["frames"] == frames, result
    again = stage.run_json("footing-eval", "replay", copy)
    assert again["frames_equal"] == again["frames_compared"] == frames, again
    begins = []
    for name in (recording, copy):
        out = stage.folder / name.stem
        done = stage.run("footing-log", "export", name, "--format", "mot", "--lag-ms", 0, "--out", out, "--json")
        assert done.returncode == 0, done
        begins.append(json.loads(done.stdout)["files"][0]["begin_s"])
    assert abs(begins[0] - begins[1] - 0.2) < 0.03, begins
    # By default an export does the same.
    out = stage.folder / "default"
    done = stage.run_json("footing-log", "export", recording, "--format", "mot", "--out", out)
    assert done["smoothed_ms"] == 200 and "not_smoothed" not in done, done
    assert sorted(file.name for file in out.iterdir()) == sorted(file.name for file in (stage.folder / copy.stem).iterdir())
    for file in sorted(out.glob("*.mot")):
        assert file.read_text() == (stage.folder / copy.stem / file.name).read_text(), file


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2])
