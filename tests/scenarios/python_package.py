#!/usr/bin/env python3
"""The Python package and its examples beside live servers.

footingd, footing-sim and a synthetic user run, and a board that the package itself simulates: its centre of pressure
goes in a circle, so that its path is known. Every example runs once and its output is checked. A recording is compared
with what footing-log exports as CSV and as BIDS. A client goes on after footingd is restarted, and another one comes
in by TLS with the token and attaches a device.

Usage: python_package.py BINARY_FOLDER
"""
import concurrent.futures
import csv
import json
import math
import os
import pathlib
import re
import socket
import subprocess
import sys
import threading
import time

import ports
from harness import PATIENCE_S, Stage

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "clients/python"))
import footing  # noqa: E402

try:
    import numpy
except ImportError:
    numpy = None
EXAMPLES = ROOT / "clients/python/examples"
TOKEN = "0123456789abcdef0123456789abcdef"
RADIUS_M, TURNS_HZ, WEIGHT_N = 0.02, 0.5, 700
HALF_X_M, HALF_Y_M = 0.433 / 2, 0.238 / 2  # Sensors of a standard board from its middle.


def start_example(name, *words):
    return subprocess.Popen([sys.executable, "-B", EXAMPLES / name, *map(str, words)], text=True, stdout=subprocess.PIPE,
                            stderr=subprocess.PIPE, env=dict(os.environ, PYTHONPATH=str(ROOT / "clients/python")))


def start_page():
    """The first lines of docs/python.md that run."""
    lines = re.search(r"```python\n(.*?)```", (ROOT / "docs/python.md").read_text(), re.S)[1]
    return subprocess.Popen([sys.executable, "-B", "-c", lines], text=True, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                            env=dict(os.environ, PYTHONPATH=str(ROOT / "clients/python")))


def output_of(process):
    out, error = process.communicate(timeout=PATIENCE_S)
    assert process.returncode == 0, f"{process.args}: {process.returncode}\n{out}\n{error}"
    return out


class CircleOnBoard(threading.Thread):
    """Loads whose centre of pressure goes in a circle about the plate's middle."""

    def __init__(self):
        super().__init__(daemon=True)
        self.board = footing.device("balance_board", role="left_board")
        self.done = False

    def run(self):
        begin = time.monotonic()
        while not self.done:
            angle = 2 * math.pi * TURNS_HZ * (time.monotonic() - begin)
            x, y = RADIUS_M * math.cos(angle) / HALF_X_M, RADIUS_M * math.sin(angle) / HALF_Y_M
            self.board.send_loads(*(WEIGHT_N / 4 * (1 + sx * x) * (1 + sy * y) for sy in (1, -1) for sx in (-1, 1)))
            time.sleep(0.01)
        self.board.close()


def check_thrust():
    """A remote that is thrust ahead each 0.8 s: 25 m/s2 for 0.1 s, and back."""
    pusher = start_example("push_by_thrust.py", 5)
    with footing.device("wiimote", role="editor") as remote:
        begin, tick = time.monotonic(), 0
        while pusher.poll() is None:
            time.sleep(max(0, begin + tick / 100 - time.monotonic()))
            remote.send_force((0, {6: 25, 7: -25}.get(tick % 80 // 10, 0), -9.81))
            tick += 1
    pushes = [float(one) for one in re.findall(r"s: (\d+) N s, [+-]0 degrees", output_of(pusher))]
    # 2.5 m/s are 30 N s; of a thrust that is under way at the start less is seen.
    assert len(pushes) >= 3 and all(15 <= one <= 45 for one in pushes[1:]), pushes


def check_readers(stage):
    """The examples that read while the user swings and the board's load turns; together."""
    receiver = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    receiver.bind(("127.0.0.1", 0))
    receiver.settimeout(PATIENCE_S)
    running = {name: start_example(name, *words) for name, *words in (
        ("live_cop.py", 2), ("react_to_swing.py", 3), ("psychopy_task.py", 2),
        ("unity_bridge.py", f"127.0.0.1:{receiver.getsockname()[1]}", 2), *([("sway.py", 4)] if numpy else []))}
    running["page"] = start_page()
    sys.path.append(str(EXAMPLES))
    import matlab_bridge
    live = matlab_bridge.Live("boards")
    joints = json.loads(receiver.recv(65536))["joints"]
    assert all(len(numbers) == 7 and abs(sum(q * q for q in numbers[3:]) - 1) < 1e-6 for numbers in joints.values()), joints
    assert 0.5 < joints["body"][1] < 1.5, f"the body is not at its height along Unity's y: {joints['body']}"
    time.sleep(0.5)
    columns = live.take()
    live.close()
    assert len(columns["time_s"]) == len(columns["total_n"]) > 10 and abs(columns["total_n"][-1] - WEIGHT_N) < 1, columns
    out = {name: output_of(process) for name, process in running.items()}
    assert "left_hand" in out["page"] and len(out["page"].splitlines()) > 300, out["page"][-500:]
    assert re.search(rf"{WEIGHT_N - 1}\.\d|{WEIGHT_N}\.\d N \|.*o", out["live_cop.py"]), out["live_cop.py"]
    delays_ms = [float(one) for one in re.findall(r"answered after ([\d.]+) ms", out["react_to_swing.py"])]
    assert len(delays_ms) > 2 and "left_hand" in out["react_to_swing.py"], out["react_to_swing.py"]
    assert re.search(r"trial 2: (left|right), answered (left|right)_hand, [01]\.\d+ s", out["psychopy_task.py"]), out
    if numpy:
        check_sway(out["sway.py"], 4)


def check_sway(line, seconds):
    path_mm, velocity_mmps, area_mm2 = map(float, re.findall(r"([\d.]+) mm", line))
    speed_mmps = 2000 * math.pi * RADIUS_M * TURNS_HZ
    assert abs(velocity_mmps / speed_mmps - 1) < 0.1, f"{line}: a circle has {speed_mmps:.1f} mm/s"
    assert seconds is None or abs(path_mm / (speed_mmps * seconds) - 1) < 0.2, line
    # Of a circle both variances are r2 / 2.
    assert abs(area_mm2 / (math.pi * 5.991 * (1000 * RADIUS_M)**2 / 2) - 1) < 0.2, line


def check_recording(stage, path):
    """Against footing-log's own exports."""
    for kind in ("csv", "bids"):
        done = stage.run("footing-log", "export", path, "--format", kind, "--out", stage.folder / kind)
        assert done.returncode == 0, done.stderr
    with footing.read(path) as recording:
        assert recording.complete and recording.began is not None, recording
        for topic in ("/footingd/motion", "/footingd/boards", "/footing-sim/characters", "/footingd/status"):
            compare_with_csv(recording, topic, stage.folder / "csv" / (topic[1:].replace("/", "_") + ".csv"))
        left = recording.table("motion", device="main/left_hand", fields=["specific_force_mps2"])
        assert len(left) > 100 and set(left["device_role"]) == {"left_hand"}, left
        check_bids(recording, stage.folder / "bids")
        assert set(recording.table("/footingd/events")["text"]) & {"left", "right"}, "psychopy_task.py's markers are not there"
        if numpy:
            even = recording.array("boards", ["cop_x_m", "cop_y_m"], rate_hz=50, role="left_board")
            assert abs(numpy.hypot(*even[50:-50].T).mean() / RADIUS_M - 1) < 0.05, even
            line = output_of(start_example("sway.py", path))
            check_sway(line, None)
            board = stage.run_json("footing-eval", "board", "--corners", stage.folder / "csv" / "footingd_boards.csv",
                                   "--board", "left_board", "--min-seconds", "1")
            for value, name in zip(re.findall(r"([\d.]+) mm", line), ("path_length_mm", "mean_velocity_mm_s", "ellipse95_area_mm2")):
                assert abs(float(value) / board[name] - 1) < 0.01, (line, board)
            rows = output_of(start_example("compare_recordings.py", path, path)).splitlines()
            assert len(rows) == 6 and all(row.endswith("+0.000") for row in rows), rows
            out = output_of(start_example("matlab_bridge.py", path, "boards", "left_board", "cop_x_m"))
            assert re.fullmatch(r"time_s: (\d{3,}), cop_x_m: \1\n", out), out
        try:
            frame = recording.frame("motion", role="left_hand")
            assert list(frame.columns[:2]) == ["time_s", "sequence"] and len(frame) == len(left)
        except ImportError as error:
            print(f"skipped: the data frame: {error}")


def compare_with_csv(recording, topic, path):
    table = recording.table(topic)
    labels = recording._labels(topic.rpartition("/")[2], topic.split("/")[1])
    with open(path, newline="") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == len(table) > 0, (topic, len(rows), len(table))
    compared = 0
    for name in rows[0]:
        label = "engine_time_s" if name == "time_s" else footing.recording._renamed(name, labels)
        if label not in table.columns:
            continue
        for row, value in zip(rows, table[label]):
            cell = row[name]
            try:
                same = float(cell) == float(value) if cell else not value or value != value
                if name == "sampled_ns":  # An export mends times that do not rise, by a microsecond each.
                    same = 0 <= int(cell) - int(value) < 1_000_000
            except ValueError:  # A text; or an enum, which is a number here.
                same = str(value) == cell or re.fullmatch("[A-Z]+(_[A-Z0-9]+)+", cell) and str(value).isdigit()
            assert same, f"{topic} {name}: {value!r}, in the CSV file {cell!r}"
        compared += 1
    assert compared >= 15, (topic, compared)


def check_bids(recording, folder):
    run, = footing.read_bids(folder, tracksys="leftboard")
    table, own = run.table(), recording.table("boards", role="left_board")
    own = own.where(keep=[time_s >= 0 for time_s in own["time_s"]])  # A data set has no sample of before its run.
    assert len(table) == len(own) and run.subject == "01" and run.units["latency"] == "s", (len(table), len(own), run)
    assert run.units["top_left"] == "N" and max(abs(a - b) for a, b in zip(table["top_left"], own["top_left_n"])) < 0.01
    assert max(abs(a - b) for a, b in zip(table["time_s"], own["time_s"])) < 1e-3


def check_lease():
    with footing.connect(role="control") as one, footing.connect(role="control") as other:
        with one.lease("the first"):
            one.command(put_back={})
            try:
                other.command(put_back={})
                raise AssertionError("a command goes through another session's lease")
            except footing.Refused as error:
                assert "the first has the lease" in str(error), error
        other.command(put_back={})


def check_character(stage):
    """The examples that command the character, and devices that drive it once they let go."""
    out = stage.folder / "trial.csv"
    device = start_example("simulated_device.py", 9)
    printed = output_of(start_example("log_trial.py", out, "--walk", 3))
    with open(out, newline="") as file:
        rows = list(csv.DictReader(file))
    assert "PHASE_READY" in printed and len(rows) > 20 and float(rows[-1]["distance_m"]) > 1, (printed, rows[-1:])
    printed = output_of(start_example("step_response.py", 1.2))
    assert re.fullmatch(r"1\.2 m/s: nine tenths after \d\.\d\d s\n", printed), printed
    with footing.connect() as f:
        for tick in f.ticks("characters", seconds=PATIENCE_S):
            gait = tick.characters.characters[0].gait
            if gait.commanded_by_stream and gait.gait == footing.v1.character_pb2.GAIT_WALK and gait.speed_mps > 0.5:
                break
        else:
            raise AssertionError("the simulated remotes do not make the character walk")
    assert "sent 900 samples" in output_of(device)


def start_footingd(stage, port):
    stage.start("footingd", "--listen", stage.sensor, "--listen", f"tls:127.0.0.1:{port}", "--source",
                f"stream:{stage.devices}", "--source", f"stream:tls:127.0.0.1:{port}", "--set",
                f"token_file={stage.folder}/token", "--set", f"identity_file={stage.folder}/identity.pem")
    stage.wait_for_socket(stage.sensor)
    stage.wait_for_socket(stage.devices)


def check_tls(port):
    address = f"tls:127.0.0.1:{port}"
    with footing.connect(address, token=TOKEN, role="control") as f:
        assert re.fullmatch(rf"127\.0\.0\.1:{port} sha256:[0-9a-f]{{64}}\n", KNOWN.read_text()), KNOWN.read_text()
        with footing.device("wiimote", role="trunk", address=address, token=TOKEN) as trunk:
            f.leds(trunk.serial, 5)
            playing = threading.Thread(target=trunk.play, args=([(1, 2, -9.80665)] * 50,))
            playing.start()
            sample = next(f.samples("motion", role="trunk", seconds=PATIENCE_S))
            assert abs(sample.data.specific_force_mps2.x - 1) < 0.1 and sample.serial == trunk.serial, sample
            playing.join()
            assert trunk.leds == 5, trunk.leds
    for token, words in (("f" * 32, "token"), ("", "token")):
        try:
            footing.connect(address, token=token)
            raise AssertionError("a wrong token comes in")
        except footing.Refused as error:
            assert words in str(error), error
    KNOWN.write_text(f"127.0.0.1:{port} sha256:{'0' * 64}\n")
    try:
        footing.connect(address, token=TOKEN)
        raise AssertionError("another certificate than the known one is taken")
    except footing.Refused as error:
        assert "footing-ctl trust" in str(error), error


def check_restart(stage, port):
    with footing.connect(stage.sensor, patience_s=PATIENCE_S) as f:
        ticks = f.ticks(seconds=2 * PATIENCE_S)
        first = next(ticks)
        stage.stop("footingd")
        start_footingd(stage, port)
        again = next(tick for tick in ticks if tick.epoch != first.epoch)
        assert again.sequence < 100, f"the first ticks of the new epoch are missing: {again.sequence}"
        f.patience_s = 0.5
        stage.stop("footingd")
        try:
            for _ in ticks:
                pass
            raise AssertionError("a server that is gone has ticks")
        except footing.ConnectionLost as error:
            assert "footingd" in str(error), error


def check_tracker():
    with footing.connect() as f, footing.tracker("camera", simulated=True) as eye:
        samples = f.samples("hands", seconds=PATIENCE_S)
        end = time.monotonic() + PATIENCE_S

        def show():
            while time.monotonic() < end and not shown.is_set():
                eye.hands(left=(0.25, 0.5, 1.0), head=(0, 0, 1.75))
                time.sleep(0.02)
        shown = threading.Event()
        threading.Thread(target=show, daemon=True).start()
        hand = next(one for one in samples if one.role == "left_hand")
        head = next(one for one in samples if not one.role)
        shown.set()
        assert (hand.data.position_m.y, head.data.position_m.z, hand.data.tracker) == (0.5, 1.75, "camera"), (hand, head)


def main():
    global KNOWN
    with Stage(sys.argv[1]) as stage:
        os.symlink(".", stage.folder / "footing")
        KNOWN = stage.folder / "known_servers"
        os.environ.update(XDG_RUNTIME_DIR=str(stage.folder), FOOTING_KNOWN_SERVERS=str(KNOWN), MPLBACKEND="Agg")
        (stage.folder / "token").write_text(TOKEN + "\n")
        (stage.folder / "token").chmod(0o600)
        port = ports.free_port()
        start_footingd(stage, port)
        stage.start("footing-sim", "--sensor", stage.sensor, "--listen", stage.simulation)
        stage.wait_for_socket(stage.simulation)
        stage.start_user("run")
        circle = CircleOnBoard()
        circle.start()
        stage.wait_for_devices(3)
        path = stage.folder / "walk.mcap"
        recorder = stage.start("footing-log", "record", "--connect", stage.sensor, "--connect", stage.simulation, "--out", path,
                               "--seconds", 5)
        check_readers(stage)
        check_tracker()
        assert recorder.wait(PATIENCE_S) == 0
        circle.done = True
        stage.stop("footing-stream")
        with concurrent.futures.ThreadPoolExecutor() as beside:
            recording = beside.submit(check_recording, stage, path)
            check_lease()
            check_character(stage)
            recording.result()
        check_thrust()
        check_tls(port)
        stage.stop("footing-sim")
        check_restart(stage, port)
    return 0


if __name__ == "__main__":
    sys.exit(main())
