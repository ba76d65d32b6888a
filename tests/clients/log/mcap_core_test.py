"""Lets the reference implementation of MCAP, npm's @mcap/core, read a recording of ours.

Usage: mcap_core_test.py WRITE_SAMPLE_RECORDING SCENARIOS_FOLDER WORK_FOLDER
Ends with 77 (skipped) where node or npm is missing or the package cannot be installed.
"""
import pathlib
import subprocess
import sys

sys.path.insert(0, sys.argv[2])
import outside_readers  # noqa: E402

EXPECTED = {"/footingd/motion": 300, "/footingd/status": 6, "/footingd/gaps": 1}


def main(writer, work):
    try:
        folder = outside_readers.node_folder(work)
    except outside_readers.NoNode as error:
        print(f"skipped: {error}")
        return 77
    recordings = folder / "sample.mcap", folder / "compressed.mcap"
    subprocess.run([writer, recordings[0]], check=True)
    subprocess.run([writer, recordings[1], "zstd"], check=True)
    for recording in recordings:
        check(outside_readers.run_node(folder, "read_mcap.mjs", recording))
    return 0


def check(seen):
    assert seen["indexed"]["counts"] == EXPECTED, seen
    assert seen["stream"] == {"counts": EXPECTED, "done": True}, seen
    assert seen["indexed"]["statistics"] == sum(EXPECTED.values()), seen
    assert seen["indexed"]["attachments"] == ["config.json"], seen
    assert seen["indexed"]["metadata"] == ["session", "clock"], seen
    assert "footing.v1.MotionSamples protobuf" in seen["indexed"]["schemas"], seen
    print("both readers of @mcap/core found", seen["indexed"]["counts"])


if __name__ == "__main__":
    sys.exit(main(sys.argv[1], pathlib.Path(sys.argv[3])))
