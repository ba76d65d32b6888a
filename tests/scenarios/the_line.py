"""Simulated controllers to the screen: every gait is seen, commanded by received features, no fall.

Usage: the_line.py BINARY_FOLDER
"""
import sys

from harness import Stage


def main(binaries):
    with Stage(binaries) as stage:
        stage.start_servers()
        stage.start_user("demo", "--link", "good")
        stage.wait_for_devices()
        seen = stage.run_json("footing-view", "--connect", stage.simulation, "--connect",
                              stage.sensor, "--seconds", 32, "--text")
        print(seen)
        assert set(seen["gaits_seen"]) == {"step", "walk", "run", "jump"}, seen
        assert seen["falls"] == 0 and seen["off_track_s"] == 0, seen
        assert seen["distance_m"] > 5, seen
        assert seen["frames_published"] > 2500, seen
        for name in ("footing-stream", "footing-sim", "footingd"):
            assert stage.stop(name) == 0, name


if __name__ == "__main__":
    main(sys.argv[1])
