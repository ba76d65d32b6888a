"""Rendered frames on a FIFO, through footing-camera, to hands that clients of footingd get.

Usage: camera_line.py BINARY_FOLDER
"""
import csv
import json
import os
import sys
import threading
import time

from harness import Stage, read_ticks

LEFT_HAND, RIGHT_HAND = 1, 2
FRAMES = 6
# The camera stands at (2, 0, 1) and looks along -x of W: w, x, y, z of the turn.
PLACE_M = (2.0, 0.0, 1.0)
TURN = (0.5, -0.5, -0.5, 0.5)


def in_world(p):
    """From x right, y down, z forward of the camera."""
    return PLACE_M[0] - p[2], PLACE_M[1] + p[0], PLACE_M[2] - p[1]


def render(stage):
    frames = stage.folder / "frames"
    stage.run_json("footing-eval", "spheres", "--distance-m", "1.5", "--frames", FRAMES, "--out", frames, "--seed", 3)
    camera = json.loads((frames / "camera.json").read_text())
    camera.update(position_W_m=PLACE_M, rotation_WC=TURN)
    (frames / "camera.json").write_text(json.dumps(camera))
    truth = {}
    with open(frames / "truth.csv", newline="") as file:
        for row in csv.DictReader(file):
            place = in_world([float(row[axis]) for axis in ("x_m", "y_m", "z_m")])
            truth.setdefault(row["frame"], {})[LEFT_HAND if row["role"] == "left_hand" else RIGHT_HAND] = place
    return frames, truth


def feed(fifo, frames, names, arrives):
    """The first frame until hands arrive, then each for half a second, at 10 Hz, in two pieces."""
    with open(fifo, "wb") as pipe:
        def write(name):
            image = (frames / name).read_bytes()
            pipe.write(image[:1000])
            pipe.flush()
            pipe.write(image[1000:])
            pipe.flush()
            time.sleep(0.1)

        while not arrives.is_set():
            write(names[0])
        for name in names:
            for _ in range(5):
                write(name)


def check(samples, truth, names):
    for role in (LEFT_HAND, RIGHT_HAND):
        seen = [sample for sample in samples if sample["role"] == role]
        assert len(seen) >= 5 * FRAMES - 10, (role, len(seen))  # It skips frames when it is late.
        assert all(s["tracker"] == "camera" and s["simulated"] and s["confidence"] > 0.5 for s in seen), seen[0]
        assert all(0 <= s["received_ns"] - s["sampled_ns"] < 5e9 for s in seen)
        for name in names[1:-1]:
            place = truth[name][role]
            best = min(max(abs(s["position_m"].get(axis, 0) - place[i]) / s["sd_m"][axis]
                           for i, axis in enumerate("xyz")) for s in seen)
            assert best < 5, (name, role, best)
        # Depth lies along x mostly, and it is what a camera is least sure of.
        assert all(s["sd_m"]["x"] > 2 * s["sd_m"]["z"] for s in seen)
        assert all("covariance_m2" in s for s in seen)


def main(binaries):
    with Stage(binaries) as stage:
        frames, truth = render(stage)
        names = sorted(truth)
        stage.start("footingd", "--listen", stage.sensor, "--source", f"stream:{stage.devices}", "--set",
                    "state_directory=none")
        fifo = stage.folder / "fifo"
        os.mkfifo(fifo)
        camera = stage.start("footing-camera", "--camera", frames / "camera.json", "--fifo", fifo, "--to",
                             stage.devices, "--simulated", "--json")
        stage.wait_for_socket(stage.sensor)
        arrives = threading.Event()
        feeder = threading.Thread(target=feed, args=(fifo, frames, names, arrives), daemon=True)
        feeder.start()
        samples = []
        for tick in read_ticks(stage.sensor, 60, ("hands",)):
            samples += tick.get("hands", {}).get("samples", [])
            if samples:
                arrives.set()
            if camera.poll() is not None and not tick.get("hands"):
                break  # It ends with its frames, and footingd has published what came before.
        feeder.join()
        assert camera.wait(20) == 0
        check(samples, truth, names)
        # A folder that is no folder, and two sources.
        assert stage.run("footing-camera", "--camera", frames / "camera.json", "--frames", "/nowhere").returncode == 1
        assert stage.run("footing-camera", "--camera", frames / "camera.json").returncode == 2
        assert stage.run("footing-camera", "--camera", frames / "truth.csv", "--fifo", "-").returncode == 4
        assert stage.run("footing-camera", "--camera", frames / "camera.json", "--device",
                         "/nowhere/video0").returncode == 3
    print("ok")


if __name__ == "__main__":
    main(sys.argv[1])
