"""The preview of footing-camera: shown by footing-view, and unharmed by clients that read nothing or send.

Usage: camera_preview.py BINARY_FOLDER
"""
import pathlib
import socket
import sys

from harness import Stage

MOST_VIEWERS = 4


def memory_kb(process):
    lines = pathlib.Path(f"/proc/{process.pid}/status").read_text().splitlines()
    return int(next(line for line in lines if line.startswith("VmRSS:")).split()[1])


def connect(path):
    client = socket.socket(socket.AF_UNIX)
    client.connect(str(path))
    return client


def look(stage, path, seconds):
    """What footing-view saw of the camera."""
    return stage.run_json("footing-view", "--camera-preview", "--camera-address", f"unix:{path}", "--text", "--seconds",
                          seconds, "--json")["camera"]


def main(binaries):
    with Stage(binaries) as stage:
        frames, path = stage.folder / "frames", stage.folder / "camera.sock"
        stage.run_json("footing-eval", "spheres", "--distance-m", "1.5", "--frames", 3, "--out", frames, "--seed", 3)
        camera = stage.start("footing-camera", "--camera", frames / "camera.json", "--frames", frames, "--repeat",
                             "--simulated", "--to", stage.devices, "--sensor", stage.sensor, "--preview",
                             f"unix:{path}", "--json")
        stage.wait_for_socket(f"unix:{path}")
        seen = look(stage, path, 3)
        assert seen["frame"] > 0, seen
        assert {one["role"] for one in seen["spheres"]} == {"left_hand", "right_hand"}, seen
        assert all(one["sight"] == "seen" for one in seen["spheres"]), seen

        before_kb = memory_kb(camera)
        idle = [connect(path) for _ in range(MOST_VIEWERS - 1)]
        for _ in range(200):
            with connect(path) as hostile:
                try:
                    hostile.sendall(b"x" * 100_000)
                except (BrokenPipeError, ConnectionResetError):
                    pass
        stage.wait_for(lambda: look(stage, path, 2)["frame"] > seen["frame"], "pictures after hostile clients")
        # A picture for each of them, and what their sockets cost.
        grown_kb = memory_kb(camera) - before_kb
        assert grown_kb < 8_000, grown_kb
        del idle

        # A second program runs without a preview, unless one was asked for.
        words = ("--camera", frames / "camera.json", "--frames", frames, "--to", stage.devices, "--preview")
        taken = stage.run("footing-camera", *words, f"unix:{path}")
        assert taken.returncode == 1 and "in use" in taken.stderr, taken
        assert stage.run("footing-camera", *words, "tcp:127.0.0.1:0").returncode == 2
        assert stage.run("footing-camera", *words, "none").returncode == 3  # No footingd.

        assert stage.stop("footing-camera") == 0
        gone = look(stage, path, 0.5)
        assert "footing-camera is not running" in gone["trouble"] and gone["frame"] == 0, gone
    print("ok: memory grew by", grown_kb, "kB")


if __name__ == "__main__":
    main(sys.argv[1])
