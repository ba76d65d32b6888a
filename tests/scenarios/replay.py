"""A recording of both servers runs again to the same features and state hashes, bit for bit.

Usage: replay.py BINARY_FOLDER
"""
import sys

from harness import Stage


def main(binaries):
    with Stage(binaries) as stage:
        stage.start_servers()
        stage.start_user("demo", "--link", "poor")
        stage.wait_for_devices()
        recording = stage.folder / "recording.mcap"
        done = stage.run("footing-log", "record", "--from-ring", "--connect", stage.sensor, "--connect",
                         stage.simulation, "--out", recording, "--seconds", 9)
        assert done.returncode == 0, done.stderr
        result = stage.run_json("footing-eval", "replay", recording)
        print(result)
        assert result["features_compared"] > 500, result
        assert result["features_equal"] == result["features_compared"], result
        assert result["frames_compared"] > 500, result
        assert result["frames_equal"] == result["frames_compared"], result

        cut = stage.folder / "cut.mcap"
        cut.write_bytes(recording.read_bytes()[:-1000])
        done = stage.run("footing-eval", "replay", cut)
        assert done.returncode == 4 and "footing-log repair" in done.stderr, done
        done = stage.run("footing-log", "repair", cut, "--out", stage.folder / "mended.mcap")
        assert done.returncode == 0, done.stderr
        result = stage.run_json("footing-eval", "replay", stage.folder / "mended.mcap")
        assert result["frames_equal"] == result["frames_compared"] > 400, result


if __name__ == "__main__":
    main(sys.argv[1])
