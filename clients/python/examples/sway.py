"""Sway on a board, from a recording or live: path, mean velocity, 95 % prediction ellipse. Needs NumPy.

Usage: sway.py [RECORDING.mcap] [SECONDS]    (footing-eval board filters as posturography does; this is the bare sum)
"""
import sys

import numpy as np

import footing

RATE_HZ = 50
FIELDS = ["cop_x_m", "cop_y_m", "cop_valid"]


def sway(table):
    table = table.where(keep=table["cop_valid"])
    cop_mm = table.array(FIELDS[:2], rate_hz=RATE_HZ) * 1000
    path_mm = np.hypot(*np.diff(cop_mm, axis=0).T).sum()
    area_mm2 = np.pi * 5.991 * np.sqrt(np.linalg.det(np.cov(cop_mm.T)))  # Chi-square of two degrees, 95 %.
    return path_mm, path_mm / len(cop_mm) * RATE_HZ, area_mm2


seconds = float(sys.argv[-1]) if sys.argv[-1].replace(".", "").isdigit() else 30
if len(sys.argv) > 1 and sys.argv[1].endswith(".mcap"):
    with footing.read(sys.argv[1]) as recording:
        boards = recording.table("boards", role="left_board", fields=FIELDS)
else:
    with footing.connect() as f:
        boards = next(f.blocks("boards", every_s=seconds, role="left_board", fields=FIELDS))
print("path {:.1f} mm, mean velocity {:.2f} mm/s, 95 % ellipse {:.1f} mm2".format(*sway(boards)))
