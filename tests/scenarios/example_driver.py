#!/usr/bin/env python3
"""docs/examples/drive.py drives a live footing-sim that has no devices, and lets go of it at its end.

Usage: example_driver.py BINARY_FOLDER
"""
import pathlib
import subprocess
import sys
import time

from harness import PATIENCE_S, Stage, read_ticks

GAIT_STEP = 1  # As in character.proto.
DRIVE = pathlib.Path(__file__).resolve().parents[2] / "docs/examples/drive.py"


def driver(address):
    return subprocess.Popen([sys.executable, "-B", DRIVE, address], stdin=subprocess.PIPE, text=True,
                            stdout=subprocess.PIPE, stderr=subprocess.PIPE)


def read_until(process, holds):
    """Rows of the driver until one holds; the last of them."""
    deadline = time.monotonic() + PATIENCE_S
    while time.monotonic() < deadline:
        row = process.stdout.readline().strip().split(",")
        assert len(row) == 4, (row, process.stderr.read())
        if holds(row):
            return row
    raise AssertionError(f"no such row; the last one is {row}")


def commanded(stage):
    """The gait that the character is commanded now, by its number."""
    for tick in read_ticks(stage.simulation, 5, ["characters"]):
        if "characters" in tick:
            return tick["characters"]["characters"][0]["gait"]["commanded_gait"]
    raise AssertionError("no character")


def main():
    with Stage(sys.argv[1]) as stage:
        stage.start("footing-sim", "--sensor", stage.sensor, "--listen", stage.simulation)
        stage.wait_for_socket(stage.simulation)
        with driver(stage.simulation) as process:
            process.stdin.write("walk 1.2\n")
            process.stdin.flush()
            read_until(process, lambda row: row[1] == "walk" and float(row[2]) > 0.8 and float(row[3]) > 1)
            process.stdin.write("run 3 2\n")
            process.stdin.flush()
            read_until(process, lambda row: row[1] == "run" and float(row[2]) > 2)
            _, error = process.communicate("fly 3\n", timeout=PATIENCE_S)
            assert process.returncode == 1 and "'fly 3" in error and "step, walk, run, jump" in error, error
        # Killed or not, a driver that is gone leaves nobody who could stop the character.
        stage.wait_for(lambda: commanded(stage) == GAIT_STEP, "the character to be released")

        with driver(stage.simulation) as process:
            out, error = process.communicate("walk 1\n", timeout=PATIENCE_S)
            assert process.returncode == 0, error
    return 0


if __name__ == "__main__":
    sys.exit(main())
