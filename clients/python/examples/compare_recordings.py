"""Two recordings side by side: what was walked, how fast, how often it fell, and how the hands moved. Needs NumPy.

Usage: compare_recordings.py A.mcap B.mcap
"""
import sys

import numpy as np

import footing


def summary(path):
    with footing.read(path) as recording:
        gait = recording.table("characters", fields=["gait_speed_mps", "gait_distance_m", "gait_falls"])
        hand = recording.table("motion", role="left_hand", fields=["specific_force_mps2"])
        force = np.linalg.norm(hand.array(["specific_force_mps2_x", "specific_force_mps2_y", "specific_force_mps2_z"]), axis=1)
        return {"duration, s": recording.duration_s, "distance, m": np.ptp(gait["gait_distance_m"]),
                "mean speed, m/s": gait["gait_speed_mps"].mean(), "falls": np.ptp(gait["gait_falls"]),
                "left hand: samples a second": (len(hand) - 1) / max(np.ptp(hand["time_s"]), 1e-9) if len(hand) else 0,
                "left hand: SD of force, m/s2": force.std() if len(force) else 0}


first, second = map(summary, sys.argv[1:3])
for name, value in first.items():
    print(f"{name:30} {value:10.3f} {second[name]:10.3f} {second[name] - value:+10.3f}")
