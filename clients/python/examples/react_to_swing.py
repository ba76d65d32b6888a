"""The remote that is swung rumbles, and its delay is printed. Needs the right to control: the server's own user has it.

Usage: react_to_swing.py [SECONDS]
"""
import math
import sys
import time

import footing

SWING_MPS2 = 20  # Twice the force of a remote at rest.

with footing.connect(role="control") as f:
    quiet_until = {}
    for sample in f.samples("motion", seconds=float(sys.argv[1]) if len(sys.argv) > 1 else None):
        force = sample.data.specific_force_mps2
        size = math.sqrt(force.x**2 + force.y**2 + force.z**2)
        if size > SWING_MPS2 and sample.time_s > quiet_until.get(sample.device, 0):
            quiet_until[sample.device] = sample.time_s + 0.5
            f.rumble(sample.device, 0.1)
            delay_ms = (time.monotonic_ns() - sample.data.received_ns) * 1e-6
            print(f"{sample.time_s:.3f} s {sample.role}: {size:.1f} m/s2, answered after {delay_ms:.1f} ms", flush=True)
