"""The chain runs on recordings that nobody here made: accelerations and board corners, live.

Usage: real_input.py BINARY_FOLDER accelerations|short|board [SECONDS]

Needs the recordings (FOOTING_TEST_DATA); without them it says so and is skipped (exit code 77). The
recorded accelerations have no rate, and wiimote_grt no unit: its files are scaled so that rest is
1 g, at 50 samples a second (at 100 its shakes would be 7 to 9 Hz, faster than a wrist swings);
wiimote_moocow is in g, at 100.
"""
import math
import os
import pathlib
import statistics
import sys

from harness import Stage, read_ticks

G = 9.80665
DATA = pathlib.Path(os.environ.get("FOOTING_TEST_DATA") or "/nonexistent")


def grt_rows(path, rest):
    """Rows of a GRT file as m/s2 in the sensor frame; `rest` are rows in which it lies still."""
    lines = path.read_text().split("LabelledTrainingData:")[1].split("\n")
    raw = [[float(cell) - 0.5 for cell in line.split()[1:4]] for line in lines if line.strip()]
    middle = [statistics.median(row[axis] for row in raw[rest]) for axis in range(3)]
    scale = G / math.hypot(*middle)
    print(f"{path.name}: scaled by {scale:.2f} m/s2 so that rest is 1 g; 50 Hz assumed")
    return [(x * scale, y * scale, -z * scale) for x, y, z in raw]


def write_csv(path, header, rows):
    path.write_text(header + "\n" + "\n".join(",".join(f"{v:.6f}" for v in row) for row in rows))


def features_of(stage, seconds):
    for tick in read_ticks(stage.sensor, seconds, ["features"]):
        for rig in tick.get("features", {}).get("rigs", []):
            for device in rig["devices"]:
                yield device


def accelerations(stage, seconds):
    rows = grt_rows(DATA / "devices/wiimote_grt/WiiAccShakeData.grt", slice(0, 100))
    csv = stage.folder / "left.csv"
    write_csv(csv, "ax,ay,az", rows)
    stage.start_servers()
    stage.start("footing-stream", "accel", "--left", csv, "--rate-hz", 50, "--to", stage.devices,
                "--link", "ideal")
    stage.wait_for_devices(1)
    devices = list(features_of(stage, seconds or len(rows) / 50))
    moving = [device for device in devices if device["moving"]]
    print(f"{len(moving)} of {len(devices)} features moving")
    assert len(devices) > 500 and 0.1 < len(moving) / len(devices) < 0.9
    assert all(math.isfinite(value) for device in devices for value in device.values())
    shaken = [d for d in moving if d["amplitude_valid"]]
    assert shaken and max(d["amplitude_mps2"] for d in shaken) > 4


def short(stage, _):
    folder = DATA / "devices/wiimote_moocow/wiiuse/samples/advanced"
    stage.start_servers()
    moved = 0
    files = sorted(path for path in folder.rglob("*") if path.is_file())
    for path in files:
        rows = [[float(cell) * G for cell in line.split()[:3]]
                for line in path.read_text().splitlines() if line.strip()]
        csv = stage.folder / "short.csv"
        # The short gesture after half a second of its first value, so that it has a beginning.
        write_csv(csv, "ax,ay,az", [rows[0]] * 50 + rows + [rows[-1]] * 30)
        stage.start("footing-stream", "accel", "--right", csv, "--rate-hz", 100, "--to",
                    stage.devices, "--link", "ideal")
        moved += any(device["moving"] for device in features_of(stage, 10 + (len(rows) + 80) / 100))
        stage.processes.pop("footing-stream").wait(60)
    print(f"{moved} of {len(files)} gestures are seen as motion")
    assert files and moved == len(files)


def board(stage, seconds):
    seconds = seconds or 60
    rows = []
    for line in (DATA / "devices/wbb_corkine/subject01_scr.log").read_text().splitlines():
        cells = line.split()
        if len(cells) < 5:
            continue
        rows.append([float(cells[0]) / 1000] + [float(cell) for cell in cells[1:5]])
    start = next(i for i, row in enumerate(rows) if sum(row[1:]) > 30)  # The person stands.
    part = [row for row in rows[start:] if row[0] < rows[start][0] + seconds + 5]
    csv = stage.folder / "board.csv"
    write_csv(csv, "time_s,tl_kg,tr_kg,bl_kg,br_kg", part)
    stage.start_servers()
    stage.start("footing-stream", "corners", "--left", csv, "--to", stage.devices, "--link", "good")
    totals, centres, valid = [], [], 0
    for tick in read_ticks(stage.sensor, seconds, ["boards"]):
        for sample in tick.get("boards", {}).get("samples", []):
            assert sample["simulated"]
            totals.append(sample["total_n"] / G)
            if sample["cop_valid"]:
                valid += 1
                centres.append(math.hypot(sample["cop_x_m"], sample["cop_y_m"]))
    recorded = statistics.median(sum(row[1:]) for row in part)
    print(f"{len(totals)} board samples, median {statistics.median(totals):.2f} kg, recorded "
          f"{recorded:.2f} kg, COP defined in {valid}")
    assert len(totals) > 60 * seconds, len(totals)
    # The stand-in's cells carry the board's own resolution, 10 g each, and nothing else.
    assert abs(statistics.median(totals) - recorded) < 0.1
    assert valid > 0.9 * len(totals) and max(centres) < 0.3


def main(binaries, what, seconds=0):
    if not DATA.is_dir():
        print("skipped: FOOTING_TEST_DATA names no folder of recordings")
        return 77
    with Stage(binaries) as stage:
        {"accelerations": accelerations, "short": short, "board": board}[what](stage, float(seconds))
    return 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
