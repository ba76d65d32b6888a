"""A made body on two simulated boards with tracked hands, from raw reports to what clients hear.

Usage: body_on_boards.py BINARY_FOLDER
"""
import json
import math
import sys

from harness import Stage, read_ticks

MASS_KG = 68
GRAVITY = 9.80665
LEFT_HAND, RIGHT_HAND, LEFT_BOARD, RIGHT_BOARD = 1, 2, 6, 7
LIVE = 2
# In a T-pose all the time; it repeats. The longer a script, the longer it is performed before the devices attach.
MOTION = {"sway_mm": 2, "keys": [{"seconds": 6}]}
LEAST = {"boards": 800, "hands": 160, "reference": 80}


def collect(stage):
    """Samples of each channel, enough of all."""
    seen = {name: [] for name in LEAST}
    devices = {}
    for tick in read_ticks(stage.sensor, 40, ("status", *LEAST)):
        for status in tick.get("status", {}).get("devices", []):
            devices[status["device"]] = status
        seen["boards"] += tick.get("boards", {}).get("samples", [])
        seen["hands"] += tick.get("hands", {}).get("samples", [])
        seen["reference"] += tick.get("reference", {}).get("poses", [])
        if all(len(seen[name]) > least for name, least in LEAST.items()):
            return devices, seen
    raise AssertionError(f"not enough of {({name: len(samples) for name, samples in seen.items()})}")


def check_boards(devices, boards):
    roles = {device: status["role"] for device, status in devices.items()}
    assert sorted(roles.values()) == [LEFT_BOARD, RIGHT_BOARD], devices
    assert all(status["state"] == LIVE and status["simulated"] for status in devices.values())
    means = {}
    for device, role in roles.items():
        loads = [sample["total_n"] for sample in boards if sample["device"] == device]
        assert len(loads) > LEAST["boards"] / 4, (role, len(loads))
        means[role] = sum(loads) / len(loads)
    total_kg = sum(means.values()) / GRAVITY
    assert abs(total_kg - MASS_KG) < 0.01 * MASS_KG, means
    # The plates' front edges face each other; a T-pose stands on both alike, its feet within the
    # boards' inner halves.
    assert abs(means[LEFT_BOARD] - means[RIGHT_BOARD]) < 0.05 * MASS_KG * GRAVITY, means
    assert all(0 < sample["cop_y_m"] < 0.119 for sample in boards), boards[-1]


def check_hands(hands, reference):
    assert {sample["role"] for sample in hands} == {LEFT_HAND, RIGHT_HAND}
    poses = {pose["sampled_ns"]: pose for pose in reference}
    compared = 0
    for sample in hands:
        assert sample["simulated"] and sample["rig"] == "main" and sample["tracker"], sample
        assert sample["received_ns"] >= sample["sampled_ns"]
        nearest = min(poses, key=lambda ns: abs(ns - sample["sampled_ns"]))
        if abs(nearest - sample["sampled_ns"]) > 5e6:
            continue
        compared += 1
        side = 1 if sample["role"] == LEFT_HAND else -1
        joints = poses[nearest]["positions_m"]
        tip = max(joints, key=lambda p: side * p["y"])  # In a T-pose the hand is outermost.
        hand = sample["position_m"]
        off = math.hypot(hand["x"] - tip["x"], hand["z"] - tip["z"])
        assert off < 0.06 and 0 < side * (tip["y"] - hand["y"]) + 0.05 < 0.2, (hand, tip)
    assert compared > len(hands) / 2, (compared, len(hands))
    com = reference[-1]["com_m"]
    assert abs(com["x"]) < 0.06 and abs(com["y"]) < 0.02 and 0.8 < com["z"] < 1.2, com


def main(binaries):
    with Stage(binaries) as stage:
        stage.start("footingd", "--listen", stage.sensor, "--source", f"stream:{stage.devices}")
        stage.wait_for_socket(stage.sensor)
        stage.wait_for_socket(stage.devices)
        motion = stage.folder / "motion.json"
        motion.write_text(json.dumps(MOTION))
        stream = stage.start("footing-stream", "boards", "--motion", motion, "--hands", "move",
                             "--mass-kg", MASS_KG, "--seconds", 12, "--to", stage.devices)
        log = stage.folder / "footing-stream.log"
        stage.wait_for(lambda: "attached" in log.read_text(), "the stand-ins to attach", 300)
        devices, seen = collect(stage)
        assert stream.wait(40) == 0, "footing-stream ends after its seconds"
        check_boards(devices, seen["boards"])
        check_hands(seen["hands"], seen["reference"])
        print({name: len(samples) for name, samples in seen.items()})
        assert stage.stop("footingd") == 0


if __name__ == "__main__":
    main(sys.argv[1])
