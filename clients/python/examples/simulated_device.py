"""Two simulated remotes that are swung like the arms of a walker: the character of footing-sim walks.

Usage: simulated_device.py [SECONDS] [SWINGS_A_SECOND]
"""
import math
import sys
import time

import footing

seconds = float(sys.argv[1]) if len(sys.argv) > 1 else 20
swings_hz = float(sys.argv[2]) if len(sys.argv) > 2 else 1.0
with footing.device("wiimote", role="left_hand") as left, footing.device("wiimote", role="right_hand") as right:
    begin = time.monotonic()
    for tick in range(round(100 * seconds)):
        time.sleep(max(0, begin + tick / 100 - time.monotonic()))
        swing = 12 * math.sin(2 * math.pi * swings_hz * tick / 100)
        left.send_force((0, swing, -9.81))    # Frame S: x left, y front, z down.
        right.send_force((0, -swing, -9.81))  # Half a cycle later: the arms alternate.
print(f"sent {round(100 * seconds)} samples of each; rumble was {'on' if left.rumble else 'off'} at the end")
