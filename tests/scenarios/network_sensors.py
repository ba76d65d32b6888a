"""Sensors of the network drive the character: a board of one's own that sends the documented report, and a SlimeVR
tracker. A packet of neither is named, and a sensor that falls silent is detached.

Usage: network_sensors.py BINARY_FOLDER
"""
import socket
import struct
import sys
import time

import harness
from ports import free_port
from web_page import devices_of, swing_until_walking


class Sensor:
    """A sender with an address of its own, as on a network."""

    def __init__(self, port, host):
        six = ":" in host
        self.stream = socket.socket(socket.AF_INET6 if six else socket.AF_INET, socket.SOCK_DGRAM)
        self.stream.bind((host, 0))
        self.stream.connect(("::1" if six else "127.0.0.1", port))
        self.number = 0

    def send(self, packet):
        self.stream.send(packet)
        self.number += 1


class OwnBoard(Sensor):
    def feel(self, ahead_mps2, rate_radps):
        head = struct.pack("<BBBBHQB", 1, 2, 0, 80, self.number % 65536, time.monotonic_ns() // 1000, 1)
        self.send(head + struct.pack("<I6f", 0, 0, ahead_mps2, 9.8, rate_radps, 0, 0))


class SlimeVr(Sensor):
    def feel(self, ahead_mps2, _):
        """Rotation and acceleration: 1 is 32768 and 128."""
        self.send(struct.pack(">IQBhhhhhhh", 23, self.number, 0, 0, 0, 0, 32767, 0, round(128 * ahead_mps2), 0))


def has_ipv6():
    try:
        with socket.socket(socket.AF_INET6, socket.SOCK_DGRAM) as stream:
            stream.bind(("::1", 0))
    except OSError:
        return False
    return True


def main():
    with harness.Stage(sys.argv[1]) as stage:
        stage.start_servers()
        port = free_port()
        refused = stage.run("footing-stream", "sensors", "--to", stage.devices, "--role", "left_ear")
        assert refused.returncode == 2 and "left_hand" in refused.stderr, refused
        # Where there is IPv6 one socket hears both.
        every, tracker = ("[::]", "::1") if has_ipv6() else ("0.0.0.0", "127.0.0.3")
        wrong = stage.run("footing-stream", "sensors", "--to", stage.devices, "--listen", "::1:6969")
        assert wrong.returncode == 2 and "--listen ::1:6969" in wrong.stderr and "[::1]" in wrong.stderr, wrong
        stage.start("footing-stream", "sensors", "--to", stage.devices, "--listen", f"{every}:{port}", "--role",
                    "127.0.0.2=left_hand", "--role", "right_hand", name="sensors")
        log = stage.folder / "sensors.log"
        stage.wait_for(lambda: "listening" in log.read_text(), "the receiver")
        right = SlimeVr(port, tracker)
        right.send(struct.pack(">IQ", 3, 0) + bytes(40))
        assert right.stream.recv(100).startswith(b"\x03Hey OVR =D 5"), "the handshake is answered"
        left = OwnBoard(port, "127.0.0.2")
        left.send(b"hello")
        stage.wait_for(lambda: "127.0.0.2 is of none of the protocols" in log.read_text(), "a line on what is unknown")
        swing_until_walking(stage, left, right)
        devices = devices_of(stage)
        assert {(one["serial"], one["role"]) for one in devices} == {("127.0.0.2", "left_hand"), (tracker, "right_hand")}
        assert not any(one["simulated"] for one in devices), devices
        stage.wait_for(lambda: [one["state"] for one in devices_of(stage)] == ["lost", "lost"], "silent sensors are detached")


if __name__ == "__main__":
    main()
