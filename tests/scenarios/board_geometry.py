"""The distances between a board's sensors in footingd's config reach the pose engine: twice as far apart,
the same forces have their centre of pressure twice as far from the middle of each board.

Usage: board_geometry.py BINARY_FOLDER

Forces of constant corners, so that neither the load of the machine nor the time of day counts.
"""
import sys

from harness import Stage, read_ticks

# Half the gap between the boards of the default layout and half a plate: 2 cm and 316 mm.
MIDDLE_M = 0.168
STANDARD_M = (0.433, 0.238)
# Kilograms on the corners top left, top right, bottom left, bottom right.
LEFT_KG, RIGHT_KG = (14, 12, 8, 6), (11, 15, 5, 9)
FRAMES = 20
WITHIN_S = 40


def corners(path, kilograms):
    rows = [",".join(map(str, (second, *kilograms))) for second in range(121)]
    path.write_text("time_s,tl_kg,tr_kg,bl_kg,br_kg\n" + "\n".join(rows) + "\n")
    return path


def plate_cop(kilograms, distances_m):
    """COP in the plate frame: half the distance times the share to that side."""
    top_left, top_right, bottom_left, bottom_right = kilograms
    total = sum(kilograms)
    return (distances_m[0] / 2 * (top_right + bottom_right - top_left - bottom_left) / total,
            distances_m[1] / 2 * (top_left + top_right - bottom_left - bottom_right) / total)


def in_world(side, at_m):
    """Long sides fore and aft, power buttons outwards: the left board's front looks to the right."""
    x, y = at_m
    return (-x, MIDDLE_M - y) if side == 0 else (x, -MIDDLE_M + y)


def published_geometry(stage):
    for tick in read_ticks(stage.sensor, WITHIN_S, ("setup",)):
        for rig in tick.get("setup", {}).get("rigs", []):
            if rig["rig"] == "main":
                return rig["layout"]
    raise AssertionError("footingd publishes no geometry")


def mean_cops(stage):
    """Of the first frames in which both feet have a COP."""
    sums, frames = [[0, 0], [0, 0]], 0
    for tick in read_ticks(stage.simulation, WITHIN_S, ("characters",)):
        for character in tick.get("characters", {}).get("characters", []):
            feet = character["body"]["feet"]
            if not all(foot["cop_valid"] for foot in feet):
                continue
            frames += 1
            for side, foot in enumerate(feet):
                sums[side][0] += foot["cop_m"]["x"]
                sums[side][1] += foot["cop_m"]["y"]
        if frames >= FRAMES:
            return [(x / frames, y / frames) for x, y in sums]
    raise AssertionError(f"{frames} frames with a COP under both feet")


def run(binaries, distances_m, *config):
    with Stage(binaries) as stage:
        stage.start("footingd", "--listen", stage.sensor, "--source", f"stream:{stage.devices}",
                    *config)
        stage.wait_for_socket(stage.sensor)
        stage.wait_for_socket(stage.devices)
        stage.start("footing-sim", "--engine", "pose", "--sensor", stage.sensor, "--listen",
                    stage.simulation)
        stage.wait_for_socket(stage.simulation)
        stage.start("footing-stream", "corners", "--left", corners(stage.folder / "left.csv", LEFT_KG),
                    "--right", corners(stage.folder / "right.csv", RIGHT_KG), "--to", stage.devices)
        layout = published_geometry(stage)
        for side in ("left_geometry", "right_geometry"):
            found = layout[side]
            assert abs(found["sensor_distance_x_m"] - distances_m[0]) < 1e-9, layout
            assert abs(found["sensor_distance_y_m"] - distances_m[1]) < 1e-9, layout
            assert found["plate_x_m"] == 0.511 and found["plate_y_m"] == 0.316, layout
        cops = mean_cops(stage)
        for name in ("footing-stream", "footing-sim", "footingd"):
            assert stage.stop(name) == 0, name
    return cops


def main(binaries):
    doubled_m = tuple(2 * distance for distance in STANDARD_M)
    standard = run(binaries, STANDARD_M)
    doubled = run(binaries, doubled_m, "--set", f"board_sensor_distance_x_m={doubled_m[0]}",
                  "--set", f"board_sensor_distance_y_m={doubled_m[1]}")
    print(standard, doubled)
    for side, kilograms in enumerate((LEFT_KG, RIGHT_KG)):
        for cop, distances_m in ((standard, STANDARD_M), (doubled, doubled_m)):
            expected = in_world(side, plate_cop(kilograms, distances_m))
            assert all(abs(a - b) < 0.004 for a, b in zip(cop[side], expected)), (cop, expected)


if __name__ == "__main__":
    main(sys.argv[1])
