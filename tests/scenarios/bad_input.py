"""Bad input ends in one clear line and the right exit code, and disturbs no other client.

Usage: bad_input.py BINARY_FOLDER
"""
import socket
import struct
import sys

from harness import Stage, read_ticks

USAGE, FAILURE, NO_DEVICE, INVALID = 2, 1, 3, 4


def expect(stage, exit_code, words, program, *arguments):
    done = stage.run(program, *arguments)
    lines = [line for line in done.stderr.splitlines() if line.startswith("error: ")]
    assert done.returncode == exit_code, (program, arguments, done)
    assert len(lines) == 1 and words in lines[0], (program, arguments, done.stderr)


def wrong_starts(stage):
    config = stage.folder / "config.json"
    for program in ("footingd", "footing-sim"):
        config.write_text('{"no_such_key": 1}')
        expect(stage, USAGE, "no_such_key", program, "--config", config)
        config.write_text("{")
        expect(stage, USAGE, "is not JSON", program, "--config", config)
        expect(stage, USAGE, "cannot open", program, "--config", "/nonexistent.json")
        expect(stage, USAGE, "key=value", program, "--set", "nonsense")
        expect(stage, USAGE, "address", program, "--listen", "nonsense")
        assert stage.run(program, "--no-such-flag").returncode == USAGE
        assert stage.run(program, "--print-config").returncode == 0
        assert stage.run(program, "--version").stdout.startswith(program)
        assert "Examples:" in stage.run(program, "--help").stdout
    expect(stage, USAGE, "beyond this host", "footingd", "--listen", "tcp:0.0.0.0:0")
    expect(stage, USAGE, "every user of this host may attach devices", "footingd", "--source", "stream:tcp:127.0.0.1:0")
    expect(stage, USAGE, "there are: gait, pose", "footing-sim", "--engine", "walkies")
    expect(stage, USAGE, "wrist, arm, leg, joystick, boards", "footing-sim", "--interface", "telepathy")
    expect(stage, USAGE, "subject does not apply to --engine gait", "footing-sim", "--engine", "gait",
           "--subject", "p07.json")
    expect(stage, USAGE, "track does not apply to --engine pose", "footing-sim", "--engine", "pose",
           "--track", "1")
    expect(stage, USAGE, "there are: 1, 2, 3, 4, build, corners, curves, endless, hills, pits, plain, straight", "footing-sim", "--track", "9",
           "--listen", f"unix:{stage.folder}/unused.sock")
    expect(stage, USAGE, "demo", "footing-stream", "user", "--script", "dance")
    expect(stage, FAILURE, "/nonexistent.csv", "footing-stream", "accel", "--left",
           "/nonexistent.csv", "--rate-hz", 100)
    expect(stage, USAGE, "\"no_such_track\" is not built in (no tracks/no_such_track.json)", "footing-sim", "--track", "no_such_track",
           "--listen", f"unix:{stage.folder}/unused.sock")
    expect(stage, INVALID, f"{config} is not JSON: parse error at line 1, column ", "footing-sim", "--track", config, "--listen",
           f"unix:{stage.folder}/unused.sock")
    expect(stage, INVALID, "is not JSON", "footing-sim", "--engine", "pose", "--subject", config, "--listen",
           f"unix:{stage.folder}/unused.sock")
    expect(stage, INVALID, f"{config}, in place of wrist_mapping.json", "footing-sim", "--set",
           f"mapping_table={config}", "--listen", f"unix:{stage.folder}/unused.sock")


def wrong_words(stage):
    (stage.folder / "no_such_key.json").write_text('{\n  "no_such_key": 1}')
    config = stage.folder / "engine.json"
    config.write_text('{\n  "engine": "pose"}')
    shown = stage.run_json("footing-ctl", "config", "show", "--of", "footing-sim", "--origin", "--config", config)
    assert shown["engine"] == {"value": "pose", "origin": f"{config}:2"}, shown
    expect(stage, USAGE, "a subcommand is missing; there are: devices", "footing-ctl")
    expect(stage, USAGE, "connects to no server", "footing-ctl", "config", "show", "--connect", stage.sensor)
    expect(stage, USAGE, "no_such_key", "footing-ctl", "config", "show", "--config", stage.folder / "no_such_key.json")
    expect(stage, USAGE, "connects to no server", "footing-ctl", "trust", "--connect", "tls:127.0.0.1:1")
    expect(stage, USAGE, "is named twice", "footing-log", "record", "--out", stage.folder / "twice.mcap", "--connect",
           stage.sensor, "--connect", stage.sensor)
    expect(stage, USAGE, "takes two names", "footing-game", "--players", "Ann", "--seconds", 1)
    expect(stage, USAGE, "1 to 24 bytes", "footing-game", "--players", "Ann", "", "--seconds", 1)
    expect(stage, USAGE, "footing-web", "footing-skeleton", "--web", "127.0.0.1:7180", "--no-publish")
    broker = ("--nats", "tcp:127.0.0.1:1", "--seconds", 1)
    expect(stage, USAGE, "--insecure-lan", "footing-relay", "serve", *broker, "--listen", "tcp:0.0.0.0:7460")
    expect(stage, USAGE, "--token-file", "footing-relay", "serve", *broker, "--listen", "tls:127.0.0.1:7460")
    expect(stage, USAGE, "unknown --channel nonsense; there are: status, motion", "footing-relay", "publish", *broker,
           "--channel", "nonsense")
    expect(stage, USAGE, "not a broker's address", "footing-relay", "publish", "--nats", "nonsense")


def wrong_motions(stage):
    def boards(exit_code, words, *arguments):
        expect(stage, exit_code, words, "footing-stream", "boards", *arguments)

    file = stage.folder / "motion.json"
    file.write_text('{"keys": [{"seconds": 1}, {"seconds": 1, "left_lift_m": 0.1}]}')
    boards(INVALID, "key 2: the left foot leaves the ground", "--motion", file)
    file.write_text('{"keys": ')
    boards(INVALID, "motion.json", "--motion", file)
    file = stage.folder / "motion.bvh"
    file.write_text("HIERARCHY\nROOT x\n{\n")
    boards(INVALID, "motion.bvh", "--motion", file)
    boards(USAGE, "demo own_motion quiet", "--motion", "dance")
    boards(USAGE, "none, move, wiimote, straps, kinect, camera", "--motion", "quiet", "--hands", "leap")
    boards(FAILURE, "/nonexistent.c3d", "--motion", "/nonexistent.c3d")
    file = stage.folder / "motion.amc"
    file.write_text(":FULLY-SPECIFIED\n:DEGREES\n")
    boards(USAGE, "--skeleton", "--motion", file)


def no_server(stage):
    """What has waited for a server for as long as it was to run has failed, and says for whom."""
    nobody = f"unix:{stage.folder}/nobody.sock"
    broker = "tcp:127.0.0.1:1"  # Nothing listens on that port.
    waits = f"{nobody}: no such file"
    expect(stage, NO_DEVICE, waits, "footing-game", "--sensor", nobody, "--simulation", nobody, "--seconds", 1)
    expect(stage, NO_DEVICE, waits, "footing-relay", "publish", "--connect", nobody, "--nats", broker, "--seconds", 1)
    expect(stage, FAILURE, "connection refused", "footing-relay", "serve", "--nats", broker, "--listen",
           f"unix:{stage.folder}/edge.sock", "--seconds", 1)
    starts_it = f"footingd --source stream:{nobody}"
    expect(stage, NO_DEVICE, starts_it, "footing-stream", "user", "--script", "walk", "--to", nobody, "--seconds", 1)
    # A footingd without options listens at the user's own address.
    done = stage.run("/usr/bin/env", f"XDG_RUNTIME_DIR={stage.folder}/nobody", stage.binaries / "footing-stream", "user",
                     "--script", "walk", "--seconds", 1)
    assert done.returncode == NO_DEVICE and done.stderr.endswith("; start it with: footingd\n"), done
    expect(stage, NO_DEVICE, starts_it, "footing-skeleton", "--listen", "127.0.0.1:0", "--to", nobody, "--seconds", 1)
    assert stage.run("footing-skeleton", "--listen", "127.0.0.1:0", "--no-publish", "--seconds", 1).returncode == 0


def evaluations(stage):
    """Of footing-eval, and of frames that it makes."""
    expect(stage, USAGE, "does not apply to --mode paper", "footing-eval", "momentum", "--motion", "clip.bvh", "--mode",
           "paper", "--lag-ms", 100)
    expect(stage, USAGE, "--test t: must be one of dunnett, ", "footing-eval", "stats", "--test", "t", "--data", "a.csv")
    expect(stage, USAGE, "--trials -1: must be from 1 to ", "footing-eval", "monkey", "--trials", -1)
    nobody = f"unix:{stage.folder}/nobody.sock"
    frames = stage.folder / "frames"
    stage.run_json("footing-eval", "spheres", "--distance-m", "1.5", "--frames", 1, "--out", frames)
    expect(stage, NO_DEVICE, f"footingd --source stream:{nobody}", "footing-camera", "--camera", frames / "camera.json",
           "--frames", frames, "--repeat", "--to", nobody, "--sensor", nobody, "--preview", "none", "--seconds", 1)
    # The same for frames that end by themselves.
    expect(stage, NO_DEVICE, f"footingd --source stream:{nobody}", "footing-camera", "--camera", frames / "camera.json",
           "--frames", frames, "--to", nobody, "--sensor", nobody, "--preview", "none")


def garbage(address):
    """Connections that make no sense, on one socket."""
    path = address.removeprefix("unix:")
    half_open = []
    for data in (b"GET / HTTP/1.1\r\n\r\n", b"\xff" * 4096, struct.pack("<I", 1 << 28),
                 struct.pack("<I", 5) + b"\x00" * 5, struct.pack("<I", 100) + b"abc", b"", b"\x05"):
        one = socket.socket(socket.AF_UNIX)
        one.connect(path)
        try:
            one.sendall(data)
        except BrokenPipeError:
            pass  # The server was faster to close.
        half_open.append(one)
    return half_open


def one_server(stage):
    """A game needs footingd, too; a server prints where it listens."""
    nobody = f"unix:{stage.folder}/nobody.sock"
    stage.start("footing-sim", "--json", "--sensor", nobody, "--listen", stage.simulation)
    stage.wait_for_socket(stage.simulation)
    log = stage.folder / "footing-sim.log"
    stage.wait_for(lambda: f'{{"listening_on":["{stage.simulation}"]}}' in log.read_text(), "the addresses")
    expect(stage, NO_DEVICE, f"no footingd: cannot connect to {nobody}", "footing-game", "--sensor", nobody,
           "--simulation", stage.simulation, "--seconds", 2)
    assert stage.stop("footing-sim") == 0


def disturb_nobody(stage):
    stage.start_servers()
    table = stage.folder / "config.json"
    expect(stage, FAILURE, f"with --table {table}: set_interface:", "footing-ctl", "interface", "wrist", "--table", table,
           "--connect", stage.simulation)
    stage.start_user("walk", "--link", "ideal")
    for ticks in (read_ticks(stage.sensor, 30, ["motion"]),):
        next(ticks)
        open_sockets = [one for address in (stage.sensor, stage.devices, stage.simulation)
                        for one in garbage(address)]
        last, samples, missing = 0, 0, 0
        for tick in ticks:
            missing += tick["sequence"] - last - 1 if last else 0
            last = tick["sequence"]
            samples += len(tick.get("motion", {}).get("samples", []))
            if samples > 400:
                break
        assert samples > 400, samples
        stage.check_missing(stage.sensor, missing)
        for one in open_sockets:
            one.close()
    for name, address in (("footingd", stage.sensor), ("footing-sim", stage.simulation)):
        expect(stage, FAILURE, "in use", name, "--listen", address)
    for name in ("footing-stream", "footing-sim", "footingd"):
        assert stage.stop(name) == 0, name


def main(binaries):
    with Stage(binaries) as stage:
        wrong_starts(stage)
        wrong_words(stage)
        wrong_motions(stage)
        no_server(stage)
        if (stage.binaries / "footing-eval").exists():  # No part of a build with sanitizers.
            evaluations(stage)
        one_server(stage)
        disturb_nobody(stage)


if __name__ == "__main__":
    main(sys.argv[1])
