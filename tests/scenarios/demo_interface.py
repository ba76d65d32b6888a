"""The demo of an interface whose synthetic user sees the track, as scripts/demo starts it: from the devices to the
screen, the character moves, stays on its track and on its feet. When its devices are gone the screen says so at once.

Usage: demo_interface.py BINARY_FOLDER INTERFACE
"""
import sys

from harness import Stage

DEVICES = {"arm": 2, "leg": 3, "boards": 2}


def check_warning(stage):
    """Both feet may leave the boards by explicit choice alone, and the server warns of it."""
    for chosen in ("false", "true"):
        name = f"footing-sim-{chosen}"
        stage.start("footing-sim", "--sensor", stage.sensor, "--listen", stage.simulation, "--interface", "boards",
                    "--set", f"boards_may_be_left={chosen}", name=name)
        log = stage.folder / f"{name}.log"
        stage.wait_for(lambda: "listening on" in log.read_text(), f"{name} to listen")
        stage.stop(name)
        warned = "can fall beside it; keep the floor around" in log.read_text()
        assert warned == (chosen == "true"), (chosen, warned)


def main(binaries, interface):
    with Stage(binaries) as stage:
        stage.start_servers(interface=interface)
        stage.start("footing-stream", "user", "--interface", interface, "--see", stage.simulation, "--to",
                    stage.devices, "--link", "good", "--seed", 1)
        stage.wait_for_devices(DEVICES[interface])
        seen = stage.run_json("footing-view", "--connect", stage.simulation, "--connect", stage.sensor, "--seconds", 15,
                              "--text")
        print(seen)
        assert {"walk", "run"} & set(seen["gaits_seen"]) and seen["simulated"], seen
        assert seen["falls"] == 0 and seen["off_track_s"] == 0, seen
        assert seen["distance_m"] > 5, seen
        assert stage.stop("footing-stream") == 0

        def last_line():
            return stage.run("footing-view", "--connect", stage.simulation, "--seconds", 2, "--text").stdout.splitlines()[-1]

        # A device that has been silent for 0.5 s is missing.
        stage.wait_for(lambda: "!! No signal from " in last_line(), "the screen to say so")
        for name in ("footing-sim", "footingd"):
            assert stage.stop(name) == 0, name
        if interface == "boards":
            check_warning(stage)


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2])
