"""The hands of the pose engine, from devices to the body: Wiimotes with MotionPlus in the fists, one of
which is lost and told so, or strapped on upper arms and forearms; a Kinect, late; rendered frames of two spheres through footing-camera; of a third one on a cap; and none.
Or a tracker's hands, with Wiimotes worn on a belt and the thighs, which count from the first squat on.

Usage: pose_hands.py BINARY_FOLDER wiimote|straps|kinect|camera|cap|none|worn
"""
import json
import os
import pathlib
import sys

import harness
from pose_line import SKIPPED, Watcher, check_t_pose, with_t_pose

# Joints, wrists, cm. Generous: the made person moves at ease, but every latency counts as an error,
# and other people's arms are what the Wiimotes' are learned from.
BOUNDS = {"wiimote": (12, 30), "straps": (11, 16), "kinect": (11, 16), "camera": (11, 16), "cap": (8, 16),
          "none": (25, 70), "worn": (8, 8)}
SECONDS = 17
LOST_FOR_S = 2


def check_the_body(stage, hands):
    seen = stage.run_json("footing-view", "--connect", stage.simulation, "--connect", stage.sensor,
                          "--text", "--seconds", SECONDS)
    print(hands, seen)
    check_t_pose(seen)
    assert seen["resets"] == 0, seen
    assert seen["hands"] == {"straps": "wiimote", "cap": "camera", "worn": "move"}.get(hands, hands), seen
    assert seen["compared_frames"] > 400, seen
    mpjpe_cm, wrists_cm = BOUNDS[hands]
    assert seen["mpjpe_cm"] < mpjpe_cm, seen
    assert seen["wrists_cm"] < wrists_cm, seen
    return seen


def start(stage, hands, *words):
    if hands in ("camera", "cap"):
        stage.run("footing-stream", "sample", stage.folder)
        camera, fifo = stage.folder / "camera.json", stage.folder / "frames"
        if hands == "cap":
            file = json.loads(camera.read_text())
            file["spheres"].append({"role": "head", "colour_dn": [170, 150, 30]})
            camera.write_text(json.dumps(file))
            hands = "camera"
        os.mkfifo(fifo)
        stage.start("footing-camera", "--camera", camera, "--fifo", fifo, "--stamped", "--simulated", "--json", "--to",
                    stage.devices)
        words += ("--camera", camera, "--frames-to", fifo)
    if hands == "worn":
        hands = "move"
        words += ("--worn", "pelvis,left_thigh,right_thigh")
    stage.start("footing-stream", "boards", "--motion", "demo", "--hands", hands, "--to",
                stage.devices, *words)
    log = stage.folder / "footing-stream.log"
    stage.wait_for(lambda: "attached" in log.read_text(), "the stand-ins to attach", 60)


def check_worn(stage, watcher):
    """They wait for a squat after the T-pose, and say so."""
    body = watcher.wait(lambda body: "squat once" in body["note"], "the wish for a squat", 40)
    assert "pelvis, left thigh, right thigh" in body["note"], body
    watcher.wait(lambda body: body["calibrated"] and "squat once" not in body["note"], "the squat", 60)


def check_loss(stage, watcher):
    """The left Wiimote falls silent; the body goes on, and who wears it is told what to do."""
    body = watcher.wait(lambda body: "nothing comes from the left Wiimote" in body["note"],
                        "the loss to be told", 40)
    assert body["hands_source"] == "wiimote", body
    body = watcher.wait(lambda body: "take the T-pose again" in body["note"],
                        "the way back to be told", LOST_FOR_S + 30)
    assert body["calibrated"] and body["hands_source"] == "wiimote", body
    assert body["resets"] == 0, body


def main(binaries, hands):
    return with_t_pose(lambda: run(binaries, hands))


def run(binaries, hands):
    data = pathlib.Path(__file__).parents[2] / "daemon/simulation/data"
    if not (data / "pose.fmodel").exists() or not (data / "arm.fmodel").exists():
        print("no pose.fmodel and arm.fmodel are carried")
        return SKIPPED
    with harness.Stage(binaries) as stage:
        stage.start("footingd", "--listen", stage.sensor, "--source", f"stream:{stage.devices}")
        stage.wait_for_socket(stage.sensor)
        stage.wait_for_socket(stage.devices)
        stage.start("footing-sim", "--engine", "pose", "--sensor", stage.sensor, "--listen",
                    stage.simulation)
        stage.wait_for_socket(stage.simulation)
        loses = ("--lose-hand", "left", "--lose-from-s", SECONDS + 8, "--lose-for-s", LOST_FOR_S)
        start(stage, hands, *(loses if hands == "wiimote" else ()))
        if hands == "worn":
            check_worn(stage, Watcher(stage.simulation))
        check_the_body(stage, hands)
        if hands == "wiimote":
            check_loss(stage, Watcher(stage.simulation))
        if hands == "none":
            body = next(Watcher(stage.simulation).bodies(1))
            assert "no hand is seen" in body["note"] and body["hands_source"] == "", body
        for name in ("footing-stream", "footing-sim", "footingd"):
            assert stage.stop(name) == 0, name
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1], sys.argv[2]))
