"""The demo of an interface whose synthetic user sees the track, as scripts/demo starts it: from the devices to the
screen, the character moves, stays on its track and on its feet. When its devices are gone the screen says so at once.

Usage: demo_interface.py BINARY_FOLDER INTERFACE
"""
import sys
import time

from harness import Stage


def main(binaries, interface):
    with Stage(binaries) as stage:
        stage.start_servers(interface=interface)
        stage.start("footing-stream", "user", "--interface", interface, "--see", stage.simulation, "--to",
                    stage.devices, "--link", "good", "--seed", 1)
        seen = stage.run_json("footing-view", "--connect", stage.simulation, "--connect", stage.sensor, "--seconds", 15,
                              "--text")
        print(seen)
        assert {"walk", "run"} & set(seen["gaits_seen"]) and seen["simulated"], seen
        assert seen["falls"] == 0 and seen["off_track_s"] == 0, seen
        assert seen["distance_m"] > 5, seen
        assert stage.stop("footing-stream") == 0
        time.sleep(1)  # A device that has been silent for 0.5 s is missing.
        gone = stage.run("footing-view", "--connect", stage.simulation, "--seconds", 2, "--text")
        assert "!! No signal from " in gone.stdout.splitlines()[-1], gone
        for name in ("footing-sim", "footingd"):
            assert stage.stop(name) == 0, name


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2])
