#!/usr/bin/env python3
"""docs/examples/client.py against a live footingd: controllers, boards, and a server that is not there.

Usage: example_client.py BINARY_FOLDER
"""
import json
import pathlib
import subprocess
import sys

from harness import Stage

CLIENT = pathlib.Path(__file__).resolve().parents[2] / "docs/examples/client.py"


def client(address, *words):
    return subprocess.run([sys.executable, "-B", CLIENT, address, *words], capture_output=True,
                          text=True, timeout=60, check=False)


def rows_of(stage, samples):
    done = client(stage.sensor, "--samples", str(samples))
    assert done.returncode == 0, done.stderr
    rows = [line.split(",") for line in done.stdout.splitlines()]
    assert len(rows) == samples, f"{len(rows)} rows of {samples}"
    assert all(len(row) == 6 for row in rows), rows[:3]
    return rows


def main():
    with Stage(sys.argv[1]) as stage:
        stage.start("footing-sim", "--sensor", stage.sensor, "--listen", stage.simulation)
        stage.wait_for_socket(stage.simulation)
        other = client(stage.simulation)
        assert other.returncode == 1 and "no channels boards, motion" in other.stderr, other
        absent = client(stage.sensor)
        assert absent.returncode == 1 and "error:" in absent.stderr and "start footingd" in absent.stderr, absent
        unspoken = client("tls:127.0.0.1:7431")
        assert unspoken.returncode == 1 and "not unix:PATH or tcp:HOST:PORT" in unspoken.stderr, unspoken

        stage.start("footingd", "--listen", stage.sensor, "--source", f"stream:{stage.devices}")
        stage.wait_for_socket(stage.sensor)
        stage.wait_for_socket(stage.devices)
        stage.start_user("demo")
        stage.wait_for_devices()
        rows = rows_of(stage, 200)
        assert len({row[1] for row in rows}) == 2, "the serials of two controllers"
        assert {row[2] for row in rows} == {"force_mps2"}
        times = [float(row[0]) for row in rows if row[1] == rows[0][1]]
        assert times == sorted(times), "the samples of a device are in order"
        stage.stop("footing-stream")

        motion = stage.folder / "motion.json"
        motion.write_text(json.dumps({"sway_mm": 2, "keys": [{"seconds": 6}]}))
        stage.start("footing-stream", "boards", "--motion", motion, "--hands", "none",
                    "--to", stage.devices, name="boards")
        log = stage.folder / "boards.log"
        stage.wait_for(lambda: "attached" in log.read_text(), "the boards to attach", 300)
        rows = rows_of(stage, 200)
        boards = [row for row in rows if row[2] == "cop_n_m_m"]
        assert boards, "no board row"
        assert all(float(row[3]) > 40 and abs(float(row[4])) < 0.3 for row in boards), boards[:3]
    return 0


if __name__ == "__main__":
    sys.exit(main())
