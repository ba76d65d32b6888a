"""Another program starts, marks and stops recordings with LabRecorder's commands; markers keep their times and texts in
every export; a recorder that is killed keeps what it had.

Usage: serve_control_scenario.py SCENARIOS_FOLDER BINARY_FOLDER [MARKERS]
"""
import csv
import json
import signal
import socket
import sys
import time

sys.path.insert(0, sys.argv[1])
from harness import Stage  # noqa: E402

MARKERS = int(sys.argv[3]) if len(sys.argv) > 3 else 60


class Remote:
    """A client such as a script for PsychoPy or MATLAB: lines over TCP."""

    def __init__(self, port):
        self.socket = socket.create_connection(("127.0.0.1", port))
        self.socket.settimeout(20)

    def ask(self, line):
        self.socket.sendall(line.encode() + b"\n")
        return self.socket.recv(4096).decode()

    def do(self, *lines):
        for line in lines:
            answer = self.ask(line)
            assert answer == "OK", (line, answer)

    def refused(self, line, says):
        answer = self.ask(line)
        assert answer.startswith("ERROR: ") and answer.endswith("\n") and says in answer, (line, answer)


def start_control(stage, name, *connect, root):
    stage.start("footing-log", "serve-control", "--listen", "tcp:127.0.0.1:0", "--root", root, *connect, name=name)
    log = stage.folder / f"{name}.log"
    line = stage.wait_for(lambda: [line for line in log.read_text().splitlines() if line.startswith("listening on ")],
                          "serve-control to listen")[0]
    remote = Remote(int(line.split(";")[0].rsplit(":", 1)[1]))
    wanted = sum(word == "--connect" for word in connect)
    stage.wait_for(lambda: sum(server["live"] for server in json.loads(remote.ask("status"))["servers"]) == wanted,
                   "serve-control to connect")
    return remote


def markers_of(stage, recording, folder):
    """Rows of the CSV of events that are markers, of every server."""
    stage.run_json("footing-log", "export", recording, "--format", "csv", "--out", folder)
    rows = []
    for path in sorted(folder.glob("*_events.csv")):
        with open(path, encoding="utf-8", newline="") as table:
            rows += [row for row in csv.DictReader(table) if row["kind"] == "KIND_MARKER"]
    return rows


def errors_us(remote, count):
    """Sends markers at odd times, and returns when each was sent."""
    sent_ns = {}
    for i in range(count):
        time.sleep(0.003 + 0.007 * (i * 37 % 11) / 11)
        sent_ns[f"pulse {i}"] = time.monotonic_ns()
        remote.do(f"mark pulse {i} {{value:{i}}}")
    return sent_ns


def check_times(name, rows, sent_ns):
    errors = sorted(abs(int(row["host_ns"]) - sent_ns[row["text"]]) / 1e3 for row in rows if row["text"] in sent_ns)
    assert len(errors) == len(sent_ns), (len(errors), len(sent_ns))
    p50, p90, p99 = (errors[min(len(errors) - 1, int(share * len(errors)))] for share in (0.5, 0.9, 0.99))
    print(f"{name}: {len(errors)} markers, error of their times p50 {p50:.0f} us, p99 {p99:.0f} us, most {errors[-1]:.0f} us")
    assert p90 < 1000, p90  # Above it are stalls of this script itself, between its clock and its send.


def check_session(stage, remote, root):
    """What LabRecorder's README shows, and what it does not foresee."""
    remote.refused("mark", says="takes a text")
    remote.refused("dance", says="there are: start, stop")
    remote.refused("filename {root:/etc}", says="is not within")
    remote.refused("mark " + "x" * 1_000_000, says="at most 4096 bytes")
    remote.refused("mark " + "x" * 2000, says="1 to 1024")
    remote.do("stop", "update", "select all",
              "filename {template:exp%n\\%p_block_%b.xdf} {run:2} {participant:P003} {task:MemoryGuided}", "start")
    remote.refused("start", says="is being recorded")
    first = root / "exp002" / "P003_block_MemoryGuided.mcap"
    assert first.exists(), list(root.rglob("*"))
    sent_ns = errors_us(remote, MARKERS)
    stage.run_json("footing-ctl", "--connect", stage.sensor, "mark", "begin sway", "--value", "-1.5")
    started_ns = time.monotonic_ns() - 1_000_000_000
    remote.do(f"mark earlier {{time_ns:{started_ns}}}")
    stage.run_json("footing-ctl", "--connect", stage.simulation, "mark", "of the simulation")
    long = stage.run("footing-ctl", "--connect", stage.sensor, "mark", "x" * 2000)
    assert long.returncode == 2 and "at most 1024" in long.stderr, long
    time.sleep(0.3)
    stage.run_json("footing-ctl", "--connect", stage.sensor, "mark", "end sway")
    remote.do("stop")
    rows = markers_of(stage, first, stage.folder / "csv")
    check_times("footingd", rows, sent_ns)
    by_text = {row["text"]: row for row in rows}
    assert int(by_text["earlier"]["host_ns"]) == started_ns, by_text["earlier"]
    assert float(by_text["pulse 7"]["marker_value"]) == 7 and by_text["earlier"]["marker_value"] == "", by_text
    assert by_text["begin sway"]["marker_client"] == "footing-ctl", by_text["begin sway"]
    assert "of the simulation" in by_text, sorted(by_text)
    return first, sent_ns


def check_exports(stage, first):
    """The same markers in BIDS and on the viewer's timeline, where a pair of them frames a trial."""
    bids = stage.folder / "bids"
    stage.run_json("footing-log", "export", first, "--format", "bids", "--out", bids, "--task", "sway")
    rows = [line.split("\t") for line in (bids / "sub-01/motion/sub-01_task-sway_events.tsv").read_text().splitlines()]
    assert rows[0] == ["onset", "duration", "trial_type", "counts", "value"], rows[0]
    onsets = [float(row[0]) for row in rows[1:]]
    assert onsets == sorted(onsets), onsets
    sway = next(row for row in rows if row[2] == "sway")
    assert 0.3 < float(sway[1]) < 20 and sway[4] == "-1.5", sway
    done = stage.run_json("footing-log", "export", first, "--format", "xdf", "--out", stage.folder / "xdf")
    assert any(stream["name"] == "footingd/events" for stream in done["streams"]), done
    played = stage.run_json("footing-view", "--recording", first, "--text", "--at", "0.5")["playback"]
    assert [trial["trial"] for trial in played["trials"]] == ["sway"], played["trials"]
    assert {"text": "pulse 7", "value": 7} in [{k: m[k] for k in ("text", "value")} for m in played["markers"]]


def check_again_and_killed(stage, remote, root, first):
    """The same name again keeps the file that there was; a killed recorder loses a second at most."""
    size = first.stat().st_size
    remote.do("start")
    started_s = time.monotonic()
    old = first.with_name("P003_block_MemoryGuided_old1.mcap")
    assert old.stat().st_size == size, list(root.rglob("*"))
    second = stage.run("footing-log", "serve-control", "--port", remote.socket.getpeername()[1], "--root", root)
    assert second.returncode != 0 and "in use" in second.stderr, second
    remote.do("mark before the end")
    time.sleep(1.5)
    stage.stop("control", signal.SIGKILL)
    ran_s = time.monotonic() - started_s
    fixed = stage.folder / "fixed.mcap"
    stage.run_json("footing-log", "repair", first, "--out", fixed)
    kept_s = stage.run_json("footing-log", "info", fixed)["duration_s"]
    assert kept_s > ran_s - 1.5, (kept_s, ran_s)
    assert [row["text"] for row in markers_of(stage, fixed, stage.folder / "fixed")] == ["before the end"]


def main():
    with Stage(sys.argv[2]) as stage:
        stage.start("footingd", "--listen", stage.sensor, "--listen", "tcp:127.0.0.1:0", "--source",
                    f"stream:{stage.devices}")
        stage.wait_for_socket(stage.sensor)
        stage.start("footing-sim", "--sensor", stage.sensor, "--listen", stage.simulation)
        stage.wait_for_socket(stage.simulation)
        root = stage.folder / "study"
        remote = start_control(stage, "control", "--connect", stage.sensor, "--connect", stage.simulation, root=root)
        first, _ = check_session(stage, remote, root)
        check_exports(stage, first)
        check_again_and_killed(stage, remote, root, first)

        # Over TCP the times go over the clock offset. SIGTERM ends the recording in order.
        port = (stage.folder / "footingd.log").read_text().split("tcp:127.0.0.1:")[1].split()[0]
        remote = start_control(stage, "control", "--connect", f"tcp:127.0.0.1:{port}", root=root)
        web = socket.create_connection(remote.socket.getpeername())
        web.sendall(b"POST /start HTTP/1.1\r\nHost: localhost\r\n\r\nstart\r\n")
        assert b"not a web server" in web.recv(4096) and web.recv(4096) == b""
        assert not json.loads(remote.ask("status"))["recording"]
        remote.do("filename {template:tcp.mcap}", "start")
        sent_ns = errors_us(remote, MARKERS)
        assert stage.stop("control") == 0
        check_times("footingd over TCP", markers_of(stage, root / "tcp.mcap", stage.folder / "tcp"), sent_ns)


if __name__ == "__main__":
    main()
