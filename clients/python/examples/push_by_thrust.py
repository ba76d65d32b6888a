"""A thrust with one more remote pushes the biped: ahead or back along where the remote points, or to a side.

The remote has the role editor: footing-ctl assign SERIAL main/editor. Hold it level, buttons up. A thrust pushes ahead along
the biped's heading, 12 N s for each m/s, at most 80 N s. Needs the right to control, and no study that has the lease.

Usage: push_by_thrust.py [SECONDS]
"""
import math
import sys

import footing

BEGIN_MPS2, END_MPS2 = 15, 6   # Across gravity: a remote at rest has up to 9.8 when it is tilted, and then no thrust.
NS_PER_MPS, MOST_NS = 12, 80
QUIET_S = 0.6                  # The hand stops and goes back: not another thrust.

with footing.connect(role="control") as f:
    heading_rad, thrust, last_s, quiet_until_s = 0.0, None, 0.0, 0.0
    for sample in f.samples("motion", "characters", seconds=float(sys.argv[1]) if len(sys.argv) > 1 else None):
        if sample.channel == "characters":
            heading_rad = sample.data.gait.heading_rad
            continue
        if sample.role != "editor":
            continue
        force, passed_s = sample.data.specific_force_mps2, min(max(sample.time_s - last_s, 0), 0.05)
        last_s = sample.time_s
        ahead, left = force.y, force.x  # Frame S: x left, y front, z down.
        if thrust is None and math.hypot(ahead, left) > BEGIN_MPS2 and sample.time_s > quiet_until_s:
            thrust = [math.atan2(left, ahead), 0.0]
        if thrust is None:
            continue
        along = ahead * math.cos(thrust[0]) + left * math.sin(thrust[0])
        thrust[1] += along * passed_s  # Speed of the hand.
        if along > END_MPS2:
            continue
        impulse_ns, to_rad = min(NS_PER_MPS * thrust[1], MOST_NS), heading_rad + thrust[0]
        f.command(push=dict(impulse_x_ns=impulse_ns * math.cos(to_rad), impulse_y_ns=impulse_ns * math.sin(to_rad)))
        print(f"{sample.time_s:.3f} s: {impulse_ns:.0f} N s, {math.degrees(thrust[0]):+.0f} degrees from the heading", flush=True)
        thrust, quiet_until_s = None, sample.time_s + QUIET_S
