"""A simulated insole in each shoe drives the body while it walks off the boards: calibrated, on the
insoles, finite, near what the stand-in's body really does; and what is said when the insoles stop.

Usage: insoles.py BINARY_FOLDER

It walks as motion capture of other people does (FOOTING_TEST_DATA); without it or without a model the
scenario is skipped.
"""
import os
import pathlib
import sys

import harness
from pose_line import SKIPPED, Watcher, check_t_pose, models, with_t_pose

WALK_S = 13
# Generous: every latency counts as an error, and the person is another one than the model's.
ROOT_RELATIVE_CM = 12


def walk():
    """A walking clip and its skeleton, or none."""
    data = os.environ.get("FOOTING_TEST_DATA")
    folder = pathlib.Path(data or "/nonexistent", "mocap/cmu_amc2")
    files = folder / "walk_03.amc", folder / "walk.asf"
    return files if all(file.exists() for file in files) else None


def check_contacts(stage):
    """What footingd publishes of the insoles: both feet, the person's weight, their own times."""
    feet = {1: [], 2: []}
    for tick in harness.read_ticks(stage.sensor, 30, ("contacts",)):
        for sample in tick.get("contacts", {}).get("samples", []):
            feet[sample["body"]].append(sample)
        if all(len(samples) > 60 for samples in feet.values()):
            break
    total_n = 0
    for samples in feet.values():
        assert len(samples) > 60, len(samples)
        assert all(sample["simulated"] and sample["rig"] == "main" for sample in samples)
        assert all(sample["received_ns"] >= sample["sampled_ns"] for sample in samples)
        loads = [sum(cell["load_n"] for cell in sample["cells"]) for sample in samples]
        total_n += sum(loads) / len(loads)
    assert abs(total_n / 9.80665 - 75) < 1.5, total_n


def check_the_walk(stage):
    seen = stage.run_json("footing-view", "--connect", stage.simulation, "--connect", stage.sensor,
                          "--text", "--seconds", WALK_S)
    print(seen)
    check_t_pose(seen)
    assert seen["contact_source"] == "insoles", seen
    assert abs(seen["mass_kg"] - 75) < 1.5, seen
    assert seen["compared_frames"] > 400, seen
    assert seen["mpjpe_root_relative_cm"] < ROOT_RELATIVE_CM, seen


def check_silence(stage, watcher):
    before = next(watcher.bodies(1))
    assert before["contact_source"] == "insoles" and "insole" not in before["note"], before
    stage.stop("footing-stream")
    watcher.wait(lambda body: "nothing comes from the insoles" in body["note"], "the loss", 30)
    first = next(watcher.bodies(1))["feet"][0]["variance_m2"]["x"]
    for body in watcher.bodies(1):
        assert body["calibrated"] and body["contact_source"] == "insoles", body
    assert body["feet"][0]["variance_m2"]["x"] > 4 * first, (first, body["feet"])


def main(binaries):
    return with_t_pose(lambda: run(binaries))


def run(binaries):
    with harness.Stage(binaries) as stage:
        folder, clip = models(stage), walk()
        if folder is None or clip is None:
            print("no model is carried, or FOOTING_TEST_DATA is not set to a folder with a walk")
            return SKIPPED
        stage.start("footingd", "--listen", stage.sensor, "--source", f"stream:{stage.devices}")
        stage.wait_for_socket(stage.sensor)
        stage.wait_for_socket(stage.devices)
        stage.start("footing-sim", "--engine", "pose", "--sensor", stage.sensor, "--listen",
                    stage.simulation, "--set", f"data_folder={folder}")
        stage.wait_for_socket(stage.simulation)
        stage.start("footing-stream", "insoles", "--motion", clip[0], "--skeleton", clip[1],
                    "--hands", "move", "--cell-noise-kg", 0.02, "--seconds", 60, "--to",
                    stage.devices)
        log = stage.folder / "footing-stream.log"
        stage.wait_for(lambda: "attached" in log.read_text(), "the stand-ins to attach", 60)
        check_contacts(stage)
        check_the_walk(stage)
        check_silence(stage, Watcher(stage.simulation))
        for name in ("footing-sim", "footingd"):
            assert stage.stop(name) == 0, name
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
