"""Blink calibration end to end: footing-camera switches the lights of two simulated PS Moves through footingd,
the rendered frames follow them, and what it stores lets it track the hands.

Usage: camera_calibrate.py BINARY_FOLDER
"""
import json
import os
import signal
import sys

from harness import Stage, read_ticks

# The camera stands 0.9 m in front of the hands and looks along -x of W: w, x, y, z of the turn.
PLACE = {"position_W_m": (1.5, 0.0, 1.3), "rotation_WC": (0.5, -0.5, -0.5, 0.5), "rate_hz": 20}
# A person who holds both hands out in front.
MOTION = {"sway_mm": 3, "keys": [{"seconds": 0.7, "both_front_deg": 75}, {"seconds": 60}, {"seconds": 0.7, "both_front_deg": 0}]}
ROLES = {1: "left_hand", 2: "right_hand"}


def shown(led):
    """What the simulated camera shows of a light (clients/stream/boards.cc): LEDs on the sensor's colours."""
    rgb = [int(led[i:i + 2], 16) / 255 for i in (1, 3, 5)]
    rows = ((150, 20, 12), (22, 150, 30), (12, 30, 150))
    return [unlit + sum(a * b for a, b in zip(row, rgb)) for unlit, row in zip((16, 15, 17), rows)]


def start_world(stage):
    """Moves in the fists of a person who stands still, and a FIFO with what the camera sees of them."""
    seen_by = stage.folder / "world.json"
    # The lights of the Moves take the place of these colours.
    spheres = [{"role": role, "colour_dn": colour} for role, colour in zip(ROLES.values(), ([9, 90, 9], [9, 9, 90]))]
    seen_by.write_text(json.dumps({**PLACE, "spheres": spheres}))
    fifo = stage.folder / "fifo"
    motion = stage.folder / "motion.json"
    motion.write_text(json.dumps(MOTION))
    stage.start("footing-stream", "boards", "--motion", motion, "--hands", "camera", "--moves", "--camera", seen_by,
                "--frames-to", fifo, "--to", stage.devices)
    return fifo


def calibrate(stage, camera):
    fifo = start_world(stage)
    report = stage.run_json("footing-camera", "calibrate", "--camera", camera, "--fifo", fifo, "--stamped",
                            "--sensor", stage.sensor, timeout_s=120)
    stage.stop("footing-stream")
    assert [one["role"] for one in report["spheres"]] == list(ROLES.values()), report
    for one in report["spheres"]:
        truth = shown(one["led"])
        # The middle of the disc differs from the light by limb darkening and the hot spot: 6 % at most.
        assert all(abs(a - b) < 4 + 0.06 * b for a, b in zip(one["colour_dn"], truth)), (one, truth)
    # The renderer's: a point spread of 0.9 px with a pixel's own 1/sqrt(12), and 0.15.
    assert abs(report["blur_px"] - 0.945) < 0.05, report
    assert abs(report["limb"] - 0.15) < 0.06, report
    stored = json.loads(camera.read_text())
    assert stored["rate_hz"] == 20 and stored["position_W_m"] == list(PLACE["position_W_m"]), stored
    assert [one["led"] for one in stored["spheres"]] == [one["led"] for one in report["spheres"]], stored
    return stored


def track(stage, camera):
    """A later run lights the spheres by itself, makes sure that they follow and finds them."""
    fifo = stage.folder / "fifo"
    stage.start("footing-camera", "--camera", camera, "--fifo", fifo, "--stamped", "--simulated", "--to", stage.devices,
                "--sensor", stage.sensor, "--json")
    start_world(stage)
    samples = []

    def seen(role):
        return [one for one in samples if one["role"] == role and one.get("confidence", 0) > 0.5]

    for tick in read_ticks(stage.sensor, 90, ("hands",)):
        samples += tick.get("hands", {}).get("samples", [])
        if all(len(seen(role)) > 60 for role in ROLES):
            break
    assert stage.stop("footing-camera", signal.SIGINT) == 0
    stage.stop("footing-stream")
    lines = (stage.folder / "footing-camera.log").read_text().splitlines()
    report = json.loads(next(line for line in lines if line.startswith("{")))
    assert report["challenges_passed"] >= len(ROLES), report
    for role in ROLES:
        assert len(seen(role)) > 60, (role, len(seen(role)))
        assert all(0.3 < one["position_m"]["x"] < 0.8 and one["sd_m"]["x"] < 0.01 for one in seen(role)[-10:]), seen(role)[-1]


def main(binaries):
    with Stage(binaries) as stage:
        camera = stage.folder / "camera.json"
        camera.write_text(json.dumps(PLACE))
        fifo = stage.folder / "fifo"
        os.mkfifo(fifo)
        held_open = os.open(fifo, os.O_RDWR)
        absent = stage.run("footing-camera", "calibrate", "--camera", camera, "--fifo", fifo, "--sensor", stage.sensor)
        assert absent.returncode == 3 and "no footingd" in absent.stderr, absent
        absent = stage.run("footing-camera", "calibrate", "--camera", camera, "--frames", stage.folder, "--sensor",
                           stage.sensor)
        assert absent.returncode == 4, absent  # No frames in the folder.
        stage.start("footingd", "--listen", stage.sensor, "--source", f"stream:{stage.devices}", "--set",
                    "state_directory=none")
        stage.wait_for_socket(stage.sensor)
        stage.wait_for_socket(stage.devices)
        none = stage.run("footing-camera", "calibrate", "--camera", camera, "--fifo", fifo, "--sensor", stage.sensor)
        assert none.returncode == 3 and "no PS Move" in none.stderr, none
        os.close(held_open)
        calibrate(stage, camera)
        track(stage, camera)
    print("ok")


if __name__ == "__main__":
    main(sys.argv[1])
