"""A made body on two simulated boards, recorded by footing-log, beside its motion file: footing-train
finds by its stomps when the recording began.

Usage: own_recording.py BINARY_FOLDER WRITE_OWN_RECORDING
"""
import csv
import subprocess
import sys

from harness import Stage

MASS_KG = 64
WITHIN_S = 0.010


def reference_heights(folder):
    """(seconds from the first reading of a board, height of the root) of the stand-in's body."""
    with open(folder / "footingd_boards.csv", newline="") as text:
        first_ns = min(int(row["sampled_ns"]) for row in csv.DictReader(text))
    with open(folder / "footingd_reference.csv", newline="") as text:
        return [((int(row["sampled_ns"]) - first_ns) * 1e-9, float(row["positions_m_0_z"]))
                for row in csv.DictReader(text)]


def motion_heights(path):
    """Frames a second and the root's height in each of a BVH of our own."""
    lines = path.read_text().splitlines()
    start = lines.index("MOTION")
    rows = [line.split() for line in lines[start + 3:] if line]
    return 1 / float(lines[start + 2].split()[-1]), [0.01 * float(row[1]) for row in rows]


def true_offset(told, rate_hz, heights):
    """When the motion's first frame was: the shift at which the told heights are the motion's, but
    for a constant."""
    def spread(offset_s):
        off = []
        for time_s, height in told:
            at = (time_s - offset_s) * rate_hz
            if 0 <= at < len(heights) - 1:
                k, part = int(at), at % 1
                off.append(height - (1 - part) * heights[k] - part * heights[k + 1])
        mean = sum(off) / len(off)
        return sum((value - mean) ** 2 for value in off) / len(off)

    best = min((0.02 * k for k in range(250, 500)), key=spread)
    for step in (0.002, 0.0002):
        best = min((best + step * k for k in range(-12, 13)), key=spread)
    return best


def main(binaries, writer):
    with Stage(binaries) as stage:
        subprocess.run([writer, stage.folder], check=True, timeout=60)
        motion, recording = stage.folder / "me_01.bvh", stage.folder / "boards.mcap"
        stage.start("footingd", "--listen", stage.sensor, "--source", f"stream:{stage.devices}")
        stage.wait_for_socket(stage.sensor)
        stage.wait_for_socket(stage.devices)
        record = stage.start("footing-log", "record", "--from-ring", "--connect", stage.sensor, "--out", recording,
                             "--seconds", 40)
        # A T-pose of 6 s is put before the motion, which has one, too.
        stage.start("footing-stream", "boards", "--motion", motion, "--hands", "move", "--mass-kg",
                    MASS_KG, "--cell-noise-kg", 0.05, "--to", stage.devices)
        assert record.wait(70) == 0
        report = stage.run_json("footing-train", "basis", "--recording", recording, "--motion", motion,
                                "--out", stage.folder / "me.fmodel", timeout_s=120)
        take = report["own"]["takes"][0]
        exported = stage.folder / "csv"
        assert stage.run("footing-log", "export", recording, "--format", "csv", "--out",
                         exported).returncode == 0
        truth_s = true_offset(reference_heights(exported), *motion_heights(motion))
        print({"true_offset_s": truth_s, **take})
        middle_s = take["offset_s"] + 1e-6 * take["drift_ppm"] * take["overlap_s"] / 2
        assert abs(middle_s - truth_s) < WITHIN_S, (take, truth_s)
        assert take["stomps_both"] >= 3 and take["correlation"] > 0.95, take
        # The boards' clocks have just begun to be known, on a machine with other work.
        assert take["residual_ms"] < 5 and abs(take["drift_ppm"]) < 1000, take
        assert abs(take["mass_kg"] - MASS_KG) < 0.01 * MASS_KG, take
        assert take["hands"] == "recorded", take


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2])
