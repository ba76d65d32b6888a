"""Ten minutes of the demos of all five interfaces: the bird never leaves its track and never falls.

Usage: demo_ten_minutes.py BINARY_FOLDER [--live] [--seconds 600] [--seed N]

In simulated time users who see the track steer along the endless track that the demo has, one after the other. With --live
the demos run as scripts/demo starts them, all at once and in real time; those of wrist and joystick follow a script.
"""
import argparse
import contextlib
import json
import subprocess
import sys

from harness import Stage

INTERFACES = ("wrist", "arm", "leg", "joystick", "boards")
SCRIPTED = ("wrist", "joystick")


def simulated(options):
    for interface in INTERFACES:
        done = subprocess.run([f"{options.binaries}/footing-eval", "--json", "tracks", "--interface", interface, "--track",
                               "endless", "--seconds", str(options.seconds), "--seed", str(options.seed)],
                              capture_output=True, text=True, check=False)
        assert done.returncode == 0, done
        seen = json.loads(done.stdout)
        print(interface, seen["failures"], f"{seen['distance_m']:.0f} m", flush=True)
        assert sum(seen["failures"].values()) == 0 and seen["off_track_s"] == 0, (interface, seen)
        assert seen["distance_m"] > options.seconds / 2, (interface, seen)


def live(options):
    with contextlib.ExitStack() as stages:
        viewers = {}
        for interface in INTERFACES:
            stage = stages.enter_context(Stage(options.binaries))
            stage.start_servers(interface=interface)
            source = ("--script", "demo") if interface in SCRIPTED else ("--see", stage.simulation)
            stage.start("footing-stream", "user", "--interface", interface, *source, "--to", stage.devices, "--link", "good",
                        "--seed", options.seed)
            viewers[interface] = subprocess.Popen(
                [f"{options.binaries}/footing-view", "--connect", stage.simulation, "--connect", stage.sensor, "--seconds",
                 str(options.seconds), "--text", "--json"], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
        for interface, viewer in viewers.items():
            seen = json.loads(viewer.communicate(timeout=options.seconds + 60)[0])
            print(interface, {key: seen[key] for key in ("falls", "off_track_s", "distance_m")}, flush=True)
            assert viewer.returncode == 0 and seen["falls"] == 0 and seen["off_track_s"] == 0, (interface, seen)
            assert seen["distance_m"] > options.seconds / 4, (interface, seen)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("binaries")
    parser.add_argument("--live", action="store_true")
    parser.add_argument("--seconds", type=int, default=600)
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    (live if options.live else simulated)(options)


if __name__ == "__main__":
    sys.exit(main())
