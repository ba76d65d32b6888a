"""A disk that is full under the recorder and under footingd's state: the recorder ends, says why, and what it wrote can be
repaired; footingd goes on with its ticks, says that a role is not stored, and stores it with the next one that has space.

Usage: disk_full.py BINARY_FOLDER

footing-study's test is tests/clients/study/disk_full_scenario.py. 77: this user may not mount a disk of its own.
"""
import sys

import small_disk
from harness import Stage, read_ticks

DISK = "8m"
RECORDED_BYTES = 300_000
SECONDS = 2
LEAST_TICKS = 150  # Of 200: the machine may not let it run all the time.


def roles(stage):
    """Serial -> role, as footingd has them now."""
    devices = stage.run_json("footing-ctl", "--connect", stage.sensor, "devices")["devices"]
    return {device["serial"]: device["role"] for device in devices}


def start_daemon(stage, disk):
    stage.start("footingd", "--listen", stage.sensor, "--source", f"stream:{stage.devices}", "--set",
                f"state_directory={disk}/state")
    stage.wait_for_socket(stage.devices)
    stage.start_user("walk", "--seconds", 300)
    stage.wait_for_devices()


def swap(stage, serial, role):
    return stage.run("footing-ctl", "--connect", stage.sensor, "assign", serial, f"main/{role}")


def check(stage, disk):
    start_daemon(stage, disk)
    before = roles(stage)
    left, right = (next(serial for serial, role in before.items() if role == wanted) for wanted in ("left_hand", "right_hand"))
    recording = disk / "all.mcap"
    recorder = stage.start("footing-log", "record", "--connect", stage.sensor, "--out", recording)
    stage.wait_for(lambda: recording.exists() and recording.stat().st_size > RECORDED_BYTES, "a recording", 60)
    filler = small_disk.fill(disk)

    assert recorder.wait(30) == 1
    said = (stage.folder / "footing-log.log").read_text()
    assert said.count("No space left on device") == 1 and f"footing-log repair {recording}" in said, said
    repaired = stage.folder / "repaired.mcap"
    done = stage.run("footing-log", "repair", recording, "--out", repaired)
    assert done.returncode == 0, done
    info = stage.run_json("footing-log", "info", repaired)
    assert info["complete"] and info["duration_s"] > 0.5, info

    done = swap(stage, left, "right_hand")
    said = done.stdout + done.stderr
    assert done.returncode == 0 and "lasts until footingd ends" in said and "No space left on device" in said, done
    ticks = sum(not tick.get("snapshot") for tick in read_ticks(stage.sensor, SECONDS, ["motion"]))
    assert ticks >= LEAST_TICKS, ticks
    filler.unlink()
    done = swap(stage, right, "left_hand")
    assert done.returncode == 0 and "lasts until" not in done.stdout + done.stderr, done
    chosen = roles(stage)
    assert (chosen[left], chosen[right]) == ("right_hand", "left_hand"), chosen
    for program in ("footing-stream", "footingd"):
        assert stage.stop(program) == 0, program
    start_daemon(stage, disk)
    assert roles(stage) == chosen, "stored, and read again"


def main():
    if small_disk.INSIDE not in sys.argv:
        return small_disk.enter_namespace()
    with Stage(sys.argv[1]) as stage, small_disk.mounted(stage.folder / "disk", DISK) as disk:
        try:
            check(stage, disk)
        finally:
            for process in stage.processes.values():
                process.kill()
                process.wait()
    return 0


if __name__ == "__main__":
    sys.exit(main())
