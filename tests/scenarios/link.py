"""A client's link: the server's clock is known at once, a server that was away is found again, one that stood still blames
nobody, and footing-ctl looks over TCP as well.

Usage: link.py BINARY_FOLDER
"""
import re
import signal
import sys
import time

import decode_stream
from harness import Stage

MOST_OFFSET_NS = 100_000  # Over loopback both clocks are one.
ABSENCE_S = 8
PAUSE_S = 11.5  # A silence of 10 s ends a session.
MOST_RETURN_S = 2
RETURN_TRIES = 3  # It may delay a return, too.
TRIES = 10  # Other work on the machine may delay every one of a few pings.


def offset_ns(path):
    """How the recorder says the server's clock stood to its own: metadata of the file, as text."""
    found = re.search(rb"server_minus_recorder_ns.{0,4}?(-?[0-9]+)", path.read_bytes(), re.S)
    assert found, "the recording says nothing of the clock"
    return int(found[1])


def check_clock(stage):
    time.sleep(5)  # The ring holds something that would stand before the first answers.
    offsets = []
    for number in range(TRIES):
        path = stage.folder / f"clock{number}.mcap"
        done = stage.run("footing-log", "record", "--connect", stage.sensor, "--out", path, "--from-ring",
                         "--seconds", 1)
        assert done.returncode == 0, done.stderr
        offsets.append(offset_ns(path))
        if abs(offsets[-1]) <= MOST_OFFSET_NS:
            break
    print(f"clock after 1 s: off by {[offset * 1e-6 for offset in offsets]} ms")
    assert min(map(abs, offsets)) <= MOST_OFFSET_NS, offsets


def check_return(stage):
    path = stage.folder / "long.mcap"
    stage.start("footing-log", "record", "--connect", stage.sensor, "--out", path)
    log = stage.folder / "footing-log.log"
    for connections in range(1, RETURN_TRIES + 1):
        stage.wait_for(lambda: log.read_text().count("connected to footingd") == connections, "the connection")
        stage.stop("footingd", signal.SIGKILL)
        time.sleep(ABSENCE_S)
        start_daemon(stage)
        returned_s = time.monotonic()
        stage.wait_for(lambda: log.read_text().count("connected to footingd") > connections, "the next connection")
        took_s = time.monotonic() - returned_s
        print(f"back {took_s:.2f} s after the server was, which was away for {ABSENCE_S} s")
        if took_s <= MOST_RETURN_S:
            break
    assert took_s <= MOST_RETURN_S, took_s
    assert stage.stop("footing-log", signal.SIGINT) == 0


def check_pause(stage):
    """After its own pause it takes nobody's silence meanwhile for theirs."""
    stream = decode_stream.Stream(stage.sensor, 30)
    stream.send(1, decode_stream.number_field(1, 1) + decode_stream.number_field(3, 1))
    while "welcome" not in stream.receive():
        pass
    daemon = stage.processes["footingd"]
    daemon.send_signal(signal.SIGSTOP)
    time.sleep(PAUSE_S)
    daemon.send_signal(signal.SIGCONT)
    while "ping" not in (message := stream.receive()):
        assert "goodbye" not in message, message


def check_tcp(stage, address):
    devices = stage.run_json("footing-ctl", "--connect", address, "devices")
    assert devices, devices
    done = stage.run("footing-ctl", "--connect", address, "doctor", "--json")
    assert "footingd_not_running" not in done.stdout, done.stdout
    done = stage.run("footing-ctl", "--connect", address, "assign", "1", "main/left_hand")
    assert done.returncode == 1 and "need the role control" in done.stderr, done


def start_daemon(stage, *words):
    stage.start("footingd", "--listen", stage.sensor, "--source", f"stream:{stage.devices}", *words)
    log = stage.folder / "footingd.log"
    stage.wait_for(lambda: "simulated devices on" in log.read_text(), "footingd to listen")


def main(binaries):
    with Stage(binaries) as stage:
        start_daemon(stage, "--listen", "tcp:127.0.0.1:0")
        tcp = re.search(r"listening on (tcp:\S+)", (stage.folder / "footingd.log").read_text())[1]
        stage.start_user("walk", "--seconds", 600)
        stage.wait_for_devices()
        check_clock(stage)
        check_tcp(stage, tcp)
        check_pause(stage)
        check_return(stage)


if __name__ == "__main__":
    main(sys.argv[1])
