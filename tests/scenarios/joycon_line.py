"""Joy-Cons from their raw reports to the screen: a simulated pair, or one as a joystick, makes the character walk, and
footingd knows it for what it is. footing-sim has the interface's own settings.

Usage: joycon_line.py BINARY_FOLDER INTERFACE
"""
import sys

from harness import Stage

ROLES = {"wrist": ["left_hand", "right_hand"], "leg": ["left_leg", "right_leg"], "joystick": ["right_hand"]}


def main(binaries, interface):
    roles = ROLES[interface]
    with Stage(binaries) as stage:
        stage.start("footingd", "--listen", stage.sensor, "--source", f"stream:{stage.devices}")
        stage.wait_for_socket(stage.devices)
        feet = interface == "leg"  # A pair without a head that turns.
        stage.start("footing-sim", "--sensor", stage.sensor, "--listen", stage.simulation, "--interface", interface,
                    *(["--set", "turn_by=feet"] if feet else []))
        stage.wait_for_socket(stage.simulation)
        how = ["--see", stage.simulation, "--turn-by", "feet"] if feet else ["--script", "walk"]
        stage.start("footing-stream", "user", "--interface", interface, "--devices", "joycon", "--to", stage.devices,
                    "--link", "good", *how)
        stage.wait_for_devices(len(roles))
        seen = stage.run_json("footing-view", "--connect", stage.simulation, "--connect", stage.sensor, "--seconds", 7,
                              "--text")
        print(seen)
        assert "walk" in seen["gaits_seen"] or "run" in seen["gaits_seen"], seen
        assert seen["falls"] == 0 and seen["distance_m"] > 1.5, seen
        devices = stage.run_json("footing-ctl", "--connect", stage.sensor, "devices")["devices"]
        assert sorted(device["role"] for device in devices) == sorted(roles), devices
        for device in devices:
            side = "right" if device["role"].startswith("right") else "left"
            assert device["kind"] == f"joy_con_{side}", device
            assert device["rate_hz"] > 50 and device["undecodable"] == 0, device
        for name in ("footing-stream", "footing-sim", "footingd"):
            assert stage.stop(name) == 0, name


if __name__ == "__main__":
    main(*sys.argv[1:])
