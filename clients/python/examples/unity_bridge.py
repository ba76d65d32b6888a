"""The body or the character as JSON over UDP, 60 times a second.

A datagram is {"time": s, "joints": {name: [x, y, z, qx, qy, qz, qw]}}. In Unity: JsonUtility or Newtonsoft on a UdpClient of the port. Axes are Unity's: x right, y up, z forward, left-handed.

Usage: unity_bridge.py [HOST:PORT] [SECONDS]
"""
import json
import socket
import sys

import footing

host, _, port = (sys.argv[1] if len(sys.argv) > 1 else "127.0.0.1:9050").rpartition(":")
out = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
with footing.connect() as f:
    names = [link.name for link in f.skeletons[0].links]
    for tick in f.ticks("characters", max_hz=60, seconds=float(sys.argv[2]) if len(sys.argv) > 2 else None):
        joints = {}
        for name, link in zip(names, tick.characters.characters[0].links):
            p, q = link.position_m, link.orientation
            # Footing: x forward, y left, z up, right-handed. The mirror turns rotations round.
            joints[name] = [-p.y, p.z, p.x, q.y, -q.z, -q.x, q.w]
        out.sendto(json.dumps({"time": tick.time_s, "joints": joints}).encode(), (host, int(port)))
