"""Step response of the character: from standing to a commanded speed, and the time to nine tenths of it.

Usage: step_response.py [SPEED_MPS]
"""
import sys

import footing

speed_mps = float(sys.argv[1]) if len(sys.argv) > 1 else 1.2
with footing.connect(role="control") as f:
    f.gait("step")
    begin_s, reached_s = None, None
    for tick in f.ticks("characters", seconds=15):
        gait = tick.characters.characters[0].gait
        if begin_s is None and abs(gait.speed_mps) < 0.1:
            begin_s = tick.time_s
            f.gait("walk", speed_mps)
        # Speed of the whole body's COM goes up and down with each step, so the first time counts.
        if begin_s is not None and gait.speed_mps >= 0.9 * speed_mps:
            reached_s = tick.time_s - begin_s
            break
    f.release_gait()
print(f"{speed_mps} m/s: " + ("not reached" if reached_s is None else f"nine tenths after {reached_s:.2f} s"))
