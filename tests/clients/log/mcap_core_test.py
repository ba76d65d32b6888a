"""Lets the reference implementation of MCAP, npm's @mcap/core, read a recording of ours.

Usage: mcap_core_test.py WRITE_SAMPLE_RECORDING READER_FOLDER WORK_FOLDER
Ends with 77 (skipped) where node or npm is missing or the package cannot be installed.
"""
import json
import pathlib
import shutil
import subprocess
import sys

EXPECTED = {"/footingd/motion": 300, "/footingd/status": 6, "/footingd/gaps": 1}


def skip(why):
    print(f"skipped: {why}")
    sys.exit(77)


def install(reader, work):
    work.mkdir(parents=True, exist_ok=True)
    lock = work / "package-lock.json"
    is_same = lock.is_file() and lock.read_bytes() == (reader / lock.name).read_bytes()
    for name in ("package.json", "package-lock.json"):
        shutil.copy(reader / name, work / name)
    if is_same and (work / "node_modules" / ".package-lock.json").is_file():  # npm writes it when all is in place.
        return
    try:
        done = subprocess.run(["npm", "ci", "--no-audit", "--no-fund"], cwd=work, check=False,
                              capture_output=True, text=True, timeout=120)
    except subprocess.TimeoutExpired:
        skip("npm ci did not end within 120 s")
    if done.returncode != 0:
        skip(f"npm ci failed: {done.stderr.strip()[-300:]}")


def main(writer, reader, work):
    if shutil.which("node") is None or shutil.which("npm") is None:
        skip("node or npm is not installed")
    install(reader, work)
    recordings = work / "sample.mcap", work / "compressed.mcap"
    subprocess.run([writer, recordings[0]], check=True)
    subprocess.run([writer, recordings[1], "zstd"], check=True)
    for recording in recordings:
        check(recording, reader, work)


def check(recording, reader, work):
    done = subprocess.run(["node", reader / "read.mjs", recording], cwd=work, check=False,
                          capture_output=True, text=True, timeout=60)
    assert done.returncode == 0, done.stderr
    seen = json.loads(done.stdout)
    assert seen["indexed"]["counts"] == EXPECTED, seen
    assert seen["stream"] == {"counts": EXPECTED, "done": True}, seen
    assert seen["indexed"]["statistics"] == sum(EXPECTED.values()), seen
    assert seen["indexed"]["attachments"] == ["config.json"], seen
    assert seen["indexed"]["metadata"] == ["session", "clock"], seen
    assert "footing.v1.MotionSamples protobuf" in seen["indexed"]["schemas"], seen
    print("both readers of @mcap/core found", seen["indexed"]["counts"])


if __name__ == "__main__":
    main(sys.argv[1], pathlib.Path(sys.argv[2]), pathlib.Path(sys.argv[3]))
