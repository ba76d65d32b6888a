"""Sway on a board, from a recording or live: path, mean velocity, 95 % prediction ellipse. Needs NumPy.

Usage: sway.py [RECORDING.mcap] [SECONDS]

The same resampling, filter and measures as footing-eval board and footing-ctl sway, as NumPy computes them.
"""
import math
import sys

import numpy as np

import footing

RATE_HZ, CUTOFF_HZ = 50, 10
FIELDS = ["cop_x_m", "cop_y_m", "cop_valid"]


def resampled(time_s, values):
    """SWARII: means over a window in which each sample stands for the time nearer to it than to any other."""
    even = time_s[0] + np.arange(int((time_s[-1] - time_s[0]) * RATE_HZ + 1e-6) + 1) / RATE_HZ
    half = max(1 / RATE_HZ, np.median(np.diff(time_s)))
    borders = np.concatenate([time_s[:1], (time_s[1:] + time_s[:-1]) / 2, time_s[-1:]])
    integral = np.concatenate([np.zeros((1, 2)), np.cumsum(np.diff(borders)[:, None] * values, axis=0)])
    ends = np.clip([even - half, even + half], time_s[0], time_s[-1])
    first, last = (np.column_stack([np.interp(at, borders, column) for column in integral.T]) for at in ends)
    return (last - first) / (ends[1] - ends[0])[:, None]


def low_passed(values):
    """Butterworth of second order forwards and backwards, ends continued by point reflection."""
    single = CUTOFF_HZ / RATE_HZ / (math.sqrt(2) - 1) ** 0.25
    w = math.tan(math.pi * single)
    scale = 1 / (1 + math.sqrt(2) * w + w * w)
    a1, a2 = 2 * (w * w - 1) * scale, (1 - math.sqrt(2) * w + w * w) * scale
    pad = min(len(values) - 1, math.ceil(1 / single) + 3)
    wide = np.concatenate([2 * values[0] - values[pad:0:-1], values, 2 * values[-1] - values[-2:-pad - 2:-1]])
    for _ in range(2):
        out = np.concatenate([wide[:1], wide[:1], np.empty_like(wide)])
        fed = np.concatenate([wide[:1], wide[:1], wide])
        for i in range(2, len(fed)):
            out[i] = w * w * scale * (fed[i] + 2 * fed[i - 1] + fed[i - 2]) - a1 * out[i - 1] - a2 * out[i - 2]
        wide = out[:1:-1]
    return wide[pad:pad + len(values)]


def sway(table):
    table = table.where(keep=table["cop_valid"])
    cop_mm = low_passed(resampled(np.asarray(table["time_s"]), table.array(FIELDS[:2]) * 1000))
    path_mm = np.hypot(*np.diff(cop_mm, axis=0).T).sum()
    n = len(cop_mm)
    f95 = (n - 2) / 2 * (0.05 ** (-2 / (n - 2)) - 1)  # Of F with 2 and n - 2 degrees of freedom.
    area_mm2 = math.pi * 2 * (n - 1) * (n + 1) / (n * (n - 2)) * f95 * math.sqrt(np.linalg.det(np.cov(cop_mm.T)))
    return path_mm, path_mm / (n - 1) * RATE_HZ, area_mm2


if __name__ == "__main__":
    seconds = float(sys.argv[-1]) if sys.argv[-1].replace(".", "").isdigit() else 30
    if len(sys.argv) > 1 and sys.argv[1].endswith(".mcap"):
        with footing.read(sys.argv[1]) as recording:
            boards = recording.table("boards", role="left_board", fields=FIELDS)
    else:
        with footing.connect() as f:
            boards = next(f.blocks("boards", every_s=seconds, role="left_board", fields=FIELDS))
    print("path {:.1f} mm, mean velocity {:.2f} mm/s, 95 % ellipse {:.1f} mm2".format(*sway(boards)))
