"""A recording served in a server's place reaches clients whole; footing-sim and footing-view run from it.

Usage: served_recording.py BINARY_FOLDER
"""
import json
import signal
import sys

from harness import Stage

SECONDS = 5


def topics_of(stage, recording):
    info = stage.run_json("footing-log", "info", recording)
    return {topic["topic"]: topic["messages"] for topic in info["topics"]}


def record(stage):
    """Both servers of a walking user."""
    recording = stage.folder / "walk.mcap"
    stage.start_servers()
    stage.start_user("demo")
    stage.wait_for_devices()
    done = stage.run("footing-log", "record", "--from-ring", "--connect", stage.sensor, "--connect",
                     stage.simulation, "--out", recording, "--seconds", SECONDS)
    assert done.returncode == 0, done.stderr
    for name in ("footing-stream", "footing-sim", "footingd"):
        stage.stop(name)
    return recording


def check_logger(stage, recording):
    """A logger gets every tick of the server that it would have recorded, and the clear end."""
    again = stage.folder / "again.mcap"
    server = stage.start("footing-log", "serve", recording, "--listen", stage.sensor, "--json",
                         name="serve")
    stage.wait_for_socket(stage.sensor)
    stage.start("footing-log", "record", "--from-ring", "--connect", stage.sensor, "--out", again, name="record")
    log = stage.folder / "record.log"
    stage.wait_for(lambda: "the recording has ended" in log.read_text(), "the end of the recording", 60)
    assert server.wait(60) == 0
    assert stage.stop("record", signal.SIGINT) == 0
    assert '"complete":true' in (stage.folder / "serve.log").read_text()
    before, after = topics_of(stage, recording), topics_of(stage, again)
    for channel in ("raw", "motion", "features"):
        topic = f"/footingd/{channel}"
        assert before[topic] > 100 and after[topic] == before[topic], (topic, before, after)


def check_simulation(stage, recording):
    """footing-sim walks by a recording of footingd."""
    stage.start("footing-log", "serve", recording, "--listen", stage.sensor, name="serve")
    stage.wait_for_socket(stage.sensor)
    stage.start("footing-sim", "--sensor", stage.sensor, "--listen", stage.simulation)
    stage.wait_for_socket(stage.simulation)
    done = stage.run_json("footing-view", "--connect", stage.simulation, "--text", "--seconds",
                          SECONDS + 1)
    assert done["frames_received"] > 100, done
    assert stage.processes.pop("serve").wait(60) == 0
    stage.stop("footing-sim")


def check_viewer(stage, recording):
    shown = stage.run_json("footing-view", "--recording", recording, "--text")
    assert shown["frames_received"] > 100, shown
    picture = stage.folder / "walk.png"
    done = stage.run("footing-view", "--recording", recording, "--screenshot", picture, "--at", 2,
                     "--width", 640, "--height", 400)
    assert done.returncode == 0 and picture.read_bytes()[:4] == b"\x89PNG", done
    both = stage.run("footing-view", "--recording", recording, "--connect", stage.sensor)
    assert both.returncode == 2, both


def check_refusals(stage, recording):
    done = stage.run("footing-log", "serve", recording, "--server", "footing-camera")
    assert done.returncode == 2 and "there are: footing" in done.stderr, done
    cut = stage.folder / "cut.mcap"
    cut.write_bytes(recording.read_bytes()[:-1000])
    done = stage.run("footing-log", "serve", cut)
    assert done.returncode == 4 and "footing-log repair" in done.stderr, done


def main(binaries):
    with Stage(binaries) as stage:
        recording = record(stage)
        check_logger(stage, recording)
        check_simulation(stage, recording)
        check_viewer(stage, recording)
        check_refusals(stage, recording)


if __name__ == "__main__":
    main(sys.argv[1])
