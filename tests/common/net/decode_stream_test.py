"""Runs the independent decoder against a live server whose every number is known.

Usage: decode_stream_test.py STREAM_SERVER DECODE_STREAM
"""
import json
import math
import subprocess
import sys
import tempfile

TICKS = 50


def decode(decoder, address, *arguments):
    done = subprocess.run([sys.executable, decoder, address, *arguments], capture_output=True,
                          text=True, timeout=30)
    assert done.returncode == 0, done.stderr
    return [json.loads(line) for line in done.stdout.splitlines()]


def check_tick(tick, n):
    assert tick["sequence"] == n and tick["host_ns"] == n * 10_000_000, tick
    assert tick["channels"] == ["motion", "boards", "raw"], tick
    [sample] = tick["motion"]["samples"]
    assert sample["device"] == 1 and sample["report_count"] == n and sample["simulated"]
    assert sample["received_ns"] == -n
    force = sample["specific_force_mps2"]
    assert force["x"] == n / 2 and force["z"] == -9.75
    assert math.isclose(force["y"], math.sin(n), abs_tol=1e-12)
    [board] = tick["boards"]["samples"]
    assert board["device"] == 2 and board["total_n"] == n / 4
    assert tick["raw"]["reports"][0]["report"] == "3100%02x" % (n % 256)


def check_stream(lines):
    assert lines[0]["welcome"]["server_id"] == "stream-server"
    assert lines[0]["welcome"]["channels"] == ["status", "motion", "boards", "raw"]
    snapshot, ticks = lines[1], lines[2:]
    assert snapshot["snapshot"] and snapshot["channels"] == ["status"], snapshot
    assert snapshot["status"]["devices"][0]["serial"] == "Größe 42"
    assert len(ticks) == TICKS, len(ticks)
    for index, tick in enumerate(ticks):
        check_tick(tick, snapshot["sequence"] + 1 + index)


def check_decimated(lines):
    ticks = lines[2:]
    assert all(tick["channels"] == ["boards"] for tick in ticks), ticks
    assert all("gap" not in line for line in lines)
    steps = {b["sequence"] - a["sequence"] for a, b in zip(ticks, ticks[1:])}
    assert steps == {4}, steps  # 100 Hz thinned out to 25 Hz.


def main():
    server_program, decoder = sys.argv[1:]
    with tempfile.TemporaryDirectory() as folder:
        for address in (f"unix:{folder}/s", "tcp:127.0.0.1:0"):
            server = subprocess.Popen([server_program, address], stdin=subprocess.PIPE,
                                      stdout=subprocess.PIPE, text=True)
            try:
                real = server.stdout.readline().strip()
                check_stream(decode(decoder, real, "--ticks", str(TICKS)))
                check_decimated(decode(decoder, real, "--ticks", "10", "--max-hz", "25",
                                       "--channel", "boards"))
            finally:
                server.stdin.close()
                server.wait(10)
                server.stdout.close()
    print("the decoder and the server agree")


if __name__ == "__main__":
    main()
