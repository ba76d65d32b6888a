"""The biped over thousands of simulated seconds, offline. Prints every figure; part of --long biped.

Usage: biped_long.py BINARY_FOLDER
"""
import sys

from harness import Stage

GAITS = ("step", "walk", "run", "jump")
SPEEDS = {"step": 0, "walk": 1, "run": 2.5, "jump": 0.5}


def main(binaries):
    with Stage(binaries) as stage:
        for gait in GAITS:
            row = stage.run_json("footing-eval", "gait", "--gait", gait, "--speed", SPEEDS[gait],
                                 "--height", 0.3, "--seconds", 600, "--trials", 2, "--seed", 1,
                                 timeout_s=600)
            print(gait, row, flush=True)
            assert row["falls"] == 0 and row["root_force_max_n"] == 0, row
        for start in GAITS:
            for goal in GAITS:
                if start == goal:
                    continue
                row = stage.run_json("footing-eval", "transitions", "--from", start, "--to", goal,
                                     "--trials", 40, "--seed", 1, timeout_s=600)
                print(start, goal, row, flush=True)
                assert row["falls"] == 0 and row["succeeded"] >= 38, row
        row = stage.run_json("footing-eval", "monkey", "--seconds", 600, "--trials", 4, "--seed", 1,
                             timeout_s=900)
        print(row)
        assert row["falls"] <= 1, row


if __name__ == "__main__":
    main(sys.argv[1])
