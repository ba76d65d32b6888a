"""The terrain game with two synthetic players through real processes: both play a round in each part, segments of all
kinds are laid and run over, none is refused, a second game is refused by the first one's name, every viewer shows the
same game, and a recording gives the published scores again.

Usage: game.py BINARY_FOLDER
"""
import json
import signal
import sys

from harness import Stage


def start_players(stage):
    stage.start("footing-stream", "runner", "--watch", stage.simulation, "--to", stage.devices, name="runner")
    stage.start("footing-stream", "builder", "--to", stage.devices, "--seed", 1, name="builder")


def game_command(stage, *words):
    return ("footing-game", "--sensor", stage.sensor, "--simulation", stage.simulation, "--countdown-s", 1,
            "--pause-s", 1, *words)


def view(stage, *words):
    return stage.run_json("footing-view", "--text", *words).get("game")


def refuses(stage):
    """While one game is led, another one and other hands on the track."""
    second = stage.run(*game_command(stage))
    assert second.returncode == 1 and "footing-game leads a terrain game" in second.stderr, second
    trial = stage.run("footing-ctl", "--connect", stage.simulation, "trial", "start", "p1")
    assert trial.returncode == 1 and "terrain game" in trial.stderr, trial


def is_led(stage):
    seen = view(stage, "--connect", stage.simulation, "--seconds", 1)
    return seen and seen["phase"] in ("countdown", "round") and seen["host"] == "footing-game"


def check(game):
    assert game["phase"] == "over" and game["segments_refused"] == 0, game
    assert [r["runner"] for r in game["rounds"]] == ["Ann", "Ben"], game
    assert game["slopes"] and game["curves"] and game["steps"] and not game["pits"], game
    for one in game["rounds"]:
        assert one["distance_m"] > 16 and one["segments_laid"] >= 5, one
        assert one["segments_passed"] >= 1, one
        assert sum(one["failures"].values()) <= 2, one
    assert sum(one["difficulty"] for one in game["rounds"]) > 0, game
    for index, player in enumerate(game["players"]):
        ran, built = game["rounds"][index], game["rounds"][1 - index]
        assert player["points"] == ran["runner_points"] + built["builder_points"], game
    best = max(game["players"], key=lambda player: player["points"])
    assert game["winner"] == best["name"], game


def check_left(stage):
    """The trial of a game that is killed ends: what becomes of its runner counts no more."""
    def phase():
        return stage.run_json("footing-view", "--text", "--connect", stage.simulation, "--seconds", 0.5)["trial"]["phase"]

    stage.start(*game_command(stage, "--round-s", 60), name="left")
    stage.wait_for(lambda: phase() == "running", "a round")
    stage.stop("left", signal.SIGKILL)
    stage.wait_for(lambda: phase() == "stopped", "the end of its trial")


def main(binaries):
    with Stage(binaries) as stage:
        stage.start("footingd", "--listen", stage.sensor, "--source", f"stream:{stage.devices}")
        stage.wait_for_socket(stage.sensor)
        stage.wait_for_socket(stage.devices)
        stage.start("footing-sim", "--sensor", stage.sensor, "--listen", stage.simulation, "--track", "build")
        stage.wait_for_socket(stage.simulation)
        recording = stage.folder / "game.mcap"
        stage.start("footing-log", "record", "--from-ring", "--connect", stage.simulation, "--connect", stage.sensor, "--out",
                    recording)
        start_players(stage)
        stage.start(*game_command(stage, "--round-s", 15, "--json"))
        stage.wait_for(lambda: is_led(stage), "the game to begin")
        refuses(stage)
        stage.wait_for(lambda: stage.processes["footing-game"].poll() is not None, "the game to end", 180)
        assert stage.processes["footing-game"].returncode == 0
        published = json.loads((stage.folder / "footing-game.log").read_text().splitlines()[-1])
        # Who comes later sees the same, and so does who plays the recording.
        after = view(stage, "--connect", stage.simulation, "--seconds", 1)
        assert stage.stop("footing-log") == 0
        game = stage.run_json("footing-game", "--recording", recording)
        print(game)
        check(game)
        assert game["rounds"] == published["rounds"] and game["players"] == published["players"], published
        assert after["players"] == game["players"], (after, game)
        replayed = view(stage, "--recording", recording, "--from", 20, "--speed", 8)
        assert replayed == after, (replayed, after)
        check_left(stage)
        replay = stage.run_json("footing-eval", "replay", recording)
        assert replay["frames_equal"] == replay["frames_compared"] > 1000, replay
        assert stage.stop("footing-sim") == 0


if __name__ == "__main__":
    main(sys.argv[1])
