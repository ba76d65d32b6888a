"""footing-ctl beside footingd with simulated devices: what it shows, what it sets, how it refuses.

Usage: ctl_scenario.py SCENARIOS_FOLDER BINARY_FOLDER
"""
import json
import pathlib
import re
import signal
import subprocess
import sys
import time

sys.path.insert(0, sys.argv[1])
from harness import Stage  # noqa: E402


class Console:
    """footing-ctl with the stage's footingd."""

    def __init__(self, stage):
        self.stage = stage

    def run(self, *words):
        return self.stage.run("footing-ctl", "--connect", self.stage.sensor, *words)

    def json(self, *words):
        return self.stage.run_json("footing-ctl", "--connect", self.stage.sensor, *words)

    def refused(self, code, *words, says):
        done = self.run(*words)
        assert done.returncode == code and says in done.stderr, (words, done)
        assert done.stderr.count("\n") == 1, done.stderr

    def roles(self):
        return {device["serial"]: device["role"] for device in self.json("devices")["devices"]}


def log_of(stage, name):
    return (stage.folder / f"{name}.log").read_text()


def check_without_footingd(stage):
    console = Console(stage)
    for words in (("devices",), ("status",), ("watch", "--seconds", "1"), ("led", "1", "1000")):
        console.refused(3, *words, says="no footingd")
    assert console.run("led", "1").returncode == 2
    done = console.run("frobnicate")
    assert done.returncode == 2 and "frobnicate" in done.stderr, done
    assert stage.run("footing-ctl", "--connect", "nonsense", "devices").returncode == 2


def check_help(stage):
    for command in ("devices", "status", "watch", "rumble", "led", "tare", "assign", "doctor", "pair",
                    "setup", "layout", "acceptance", "sway", "trust", "sessions"):
        done = stage.run("footing-ctl", command, "--help")
        assert done.returncode == 0 and "Example" in done.stdout, (command, done)


def check_page(stage):
    """Every command of docs/setup.md is one: without footingd it ends, and not as a usage error."""
    page = pathlib.Path(sys.argv[1]).parent.parent / "docs" / "setup.md"
    commands = [line.split("#", 1)[0].split() if "#00" not in line else line.split()[:4]
                for line in page.read_text().splitlines() if line.startswith("    footing-ctl ")]
    assert len(commands) > 15, commands
    running = [(words, subprocess.Popen(
        [stage.binaries / "footing-ctl", "--connect", f"unix:{stage.folder}/none.sock", *words[1:]],
        cwd=stage.folder, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE, text=True)) for words in commands]
    for words, process in running:
        said = process.communicate(timeout=60)[1]
        assert process.returncode in (0, 1, 3), (words, process.returncode, said)


def check_devices(stage, console):
    empty = console.run("devices", "--json")
    assert empty.returncode == 3 and json.loads(empty.stdout) == {"devices": []}, empty
    status = console.run("status")
    assert status.returncode == 0 and "no device: run footing-ctl setup" in status.stdout, status
    stage.start_user("demo")

    def both_live():
        done = console.run("devices", "--json")
        devices = json.loads(done.stdout)["devices"]
        return len(devices) == 2 and all(one["state"] == "live" for one in devices) and devices

    devices = stage.wait_for(both_live, "two live devices")
    assert {one["role"] for one in devices} == {"left_hand", "right_hand"}, devices
    assert all(one["simulated"] and one["kind"] == "wiimote" for one in devices), devices
    assert all(one["calibration"] == "device" and one["rig"] == "main" for one in devices), devices
    table = console.run("devices").stdout
    assert all(one["serial"] in table for one in devices), table
    return devices


def check_status(console):
    status = console.json("status")
    assert status["server"] == "footingd" and status["epoch"] > 0, status
    assert status["limits"]["tick_rate_hz"] == 100, status
    assert len(status["devices"]) == 2 and isinstance(status["setup"], list), status


def check_watch(stage, console):
    watched = console.json("watch", "--seconds", "2")
    assert watched["seconds"] == 2, watched
    for device in watched["devices"]:
        assert 50 < device["samples"] < 260, device  # 100 Hz for 2 s, or less of it on a machine that stalls.
        assert len(device["motion"]["specific_force_mps2"]) == 3, device
    lines = console.run("watch", "--seconds", "2.5").stdout.splitlines()
    assert len(lines) == 3 and all("main/left_hand live" in line for line in lines), lines
    watch = stage.start("footing-ctl", "--connect", stage.sensor, "watch", name="watch")
    stage.wait_for(lambda: "Hz" in log_of(stage, "watch"), "a line of watch")
    assert watch.poll() is None
    assert stage.stop("watch", signal.SIGINT) == 0


def check_led(stage, console, devices):
    left = next(one for one in devices if one["role"] == "left_hand")
    console.json("led", "left_hand", "1011")
    line = f"{left['serial']} LEDs 13"  # Bits 0, 2 and 3.
    stage.wait_for(lambda: line in log_of(stage, "footing-stream"), line)
    stage.wait_for(lambda: console.json("devices")["devices"][left["device"] - 1]["leds"] == "1011",
                   "the lamps in the list")
    console.refused(2, "led", "left_hand", "10", says="neither four LEDs")
    console.refused(2, "led", "left_hand", "#00ff40", says="has four LEDs, not a colour")
    console.refused(3, "led", "9", "1000", says="there are: 1 = ")


def check_rumble(stage, console, devices):
    right = next(one for one in devices if one["role"] == "right_hand")
    on, off = (f"{right['serial']} rumble {word}" for word in ("on", "off"))
    console.json("rumble", right["serial"].upper(), "--seconds", "1.2")
    # The device may get the last command a moment after the console has its answer.
    stage.wait_for(lambda: off in log_of(stage, "footing-stream"), "the motor to stop")
    log = log_of(stage, "footing-stream")
    assert log.count(on) == 1 and log.count(off) == 1, log  # Renewed without a pause.
    # Killed it can't say stop: the motor stops with the session.
    stage.start("footing-ctl", "--connect", stage.sensor, "rumble", "right_hand", "--seconds", "30",
                name="rumble")
    stage.wait_for(lambda: log_of(stage, "footing-stream").count(on) == 2, "the motor to run")
    stage.stop("rumble", signal.SIGKILL)
    stage.wait_for(lambda: log_of(stage, "footing-stream").count(off) == 2, "the motor to stop", 20)
    # SIGINT ends it at once and in order.
    stage.start("footing-ctl", "--connect", stage.sensor, "rumble", "right_hand", "--seconds", "30",
                name="rumble")
    stage.wait_for(lambda: log_of(stage, "footing-stream").count(on) == 3, "the motor to run")
    assert stage.stop("rumble", signal.SIGINT, 20) == 0
    stage.wait_for(lambda: log_of(stage, "footing-stream").count(off) == 3, "the motor to stop", 20)


def check_assign(console, devices):
    left, right = (next(one["serial"] for one in devices if one["role"] == f"{side}_hand")
                   for side in ("left", "right"))
    now = console.json("assign", left, "main/right_hand")
    assert now["serial"] == left and now["role"] == "right_hand", now
    # The device that had the role is named, too.
    assert now["swapped"]["serial"] == right and now["swapped"]["role"] == "left_hand", now
    assert console.roles() == {left: "right_hand", right: "left_hand"}
    said = console.run("assign", "main/right_hand", "left_hand").stdout
    assert said == f"{left} is now main/left_hand, {right} is now main/right_hand\n", said
    assert "swapped" not in console.json("assign", "main/left_hand", "left_hand")
    assert console.roles() == {left: "left_hand", right: "right_hand"}
    console.refused(2, "assign", left, "main/foot", says="left_hand, right_hand")
    console.refused(3, "assign", "00:00:00:00:00:00", "head", says="no device")


def check_refusals(console):
    console.refused(3, "tare", "all", says="no board")
    console.refused(2, "tare", "left_hand", says="is not a Balance Board")
    console.refused(2, "pair", "dualsense", says="joycon")
    console.refused(1, "assign", "left_hand", "r" * 65 + "/head", says="must be 1 to 64 bytes")
    console.refused(1, "assign", "left_hand", "a\x1b[2J/head", says="assign_role.rig has control characters")
    console.refused(2, "lease", says="add --of footingd")


def check_other_side(stage):
    """TLS to a port that does not speak it: not the server that is missing."""
    tcp = re.search(r"listening on tcp:(\S+)", log_of(stage, "footingd"))[1]
    done = stage.run("footing-ctl", "--connect", f"tls:{tcp}", "devices")
    assert done.returncode == 3 and "does not speak TLS" in done.stderr and "start it" not in done.stderr, done


def make_host(root):
    """A host with a Wiimote whose node is root's alone and a blacklisted driver, but no adapter."""
    def write(path, text):
        file = pathlib.Path(root, path)
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text)
        return file

    device = "sys/bus/hid/devices/0005:057E:0306.0001"
    write(f"{device}/uevent", "DRIVER=wiimote\nHID_NAME=Nintendo RVL-CNT-01\nHID_UNIQ=00:1f:32:aa:bb:cc\n")
    write(f"{device}/hidraw/hidraw0/dev", "241:0\n")
    write("dev/hidraw0", "").chmod(0o600)
    write("etc/modprobe.d/wii.conf", "blacklist hid-wiimote\n")
    write("etc/passwd", "footing:x:12345:12345::/:/bin/false\n")
    for number in (7, 8):
        write(f"proc/{number}/comm", "footingd\n")
        write(f"proc/{number}/status", "Uid:\t12345\t12345\nGid:\t12345\t12345\n")


def check_doctor(stage, console):
    root = stage.folder / "host"
    make_host(root)
    done = console.run("doctor", "--json", "--root", root)
    report = json.loads(done.stdout)
    found = {one["id"]: one for one in report["findings"]}
    assert done.returncode == 1 and report["ok"] is False, done
    assert {"node_without_permission", "second_daemon", "driver_blacklisted", "driver_in_the_way",
            "udev_rule_missing"} <= set(found), found
    assert found["node_without_permission"]["where"] == "/dev/hidraw0", found
    assert "udevadm" in found["node_without_permission"]["remedy"], found
    # Simulated devices do without an adapter.
    assert found["no_adapter"]["severity"] == "note", found
    assert "footingd_not_running" not in found, found
    assert all(one["remedy"] and one["what"] for one in report["findings"]), report

    nowhere = stage.run("footing-ctl", "--connect", f"unix:{root}/none.sock", "doctor", "--json",
                        "--root", stage.folder / "empty")
    ids = [one["id"] for one in json.loads(nowhere.stdout)["findings"]]
    assert nowhere.returncode == 1 and ids[0] == "footingd_not_running", nowhere

    healthy = console.run("doctor", "--json", "--root", stage.folder / "empty")
    report = json.loads(healthy.stdout)
    assert healthy.returncode == 0 and report["ok"] is True, healthy


def check_pair(stage, console):
    steps = console.json("pair", "board", "--root", stage.folder / "empty")["steps"]
    assert any(step["run"] == "pair ADDRESS" for step in steps), steps
    assert all(set(step) == {"say", "run", "wait_for"} for step in steps), steps
    waited = console.run("pair", "board", "--seconds", "0.5", "--root", stage.folder / "empty")
    assert waited.returncode == 3 and "no new board" in waited.stderr, waited


def main():
    with Stage(sys.argv[2]) as stage:
        check_without_footingd(stage)
        check_help(stage)
        check_page(stage)
        stage.start("footingd", "--listen", stage.sensor, "--listen", "tcp:127.0.0.1:0", "--source",
                    f"stream:{stage.devices}")
        stage.wait_for_socket(stage.sensor)
        stage.wait_for_socket(stage.devices)
        console = Console(stage)
        started_s = time.monotonic()
        devices = check_devices(stage, console)
        check_status(console)
        check_watch(stage, console)
        check_led(stage, console, devices)
        check_rumble(stage, console, devices)
        check_assign(console, devices)
        check_refusals(console)
        check_other_side(stage)
        check_doctor(stage, console)
        check_pair(stage, console)
        print(f"all said and done in {time.monotonic() - started_s:.1f} s")


if __name__ == "__main__":
    main()
