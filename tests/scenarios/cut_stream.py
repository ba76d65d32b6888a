"""Cutting the sensor stream stops the walk, at each of three places, and it goes on when it is back.

Usage: cut_stream.py BINARY_FOLDER
"""
import signal
import sys

from harness import Stage, read_ticks

STEP, WALK = 1, 2


def wait_for_gait(stage, gait, still_within_s=40):
    """Reads frames until the character is in that gait (and, stepping, at rest)."""
    for tick in read_ticks(stage.simulation, still_within_s, ["characters"]):
        for character in tick.get("characters", {}).get("characters", []):
            state = character["gait"]
            if state["gait"] == gait and (gait != STEP or abs(state["speed_mps"]) < 0.3):
                return state
    raise AssertionError(f"not in gait {gait} within {still_within_s} s")


def main(binaries):
    with Stage(binaries) as stage:
        stage.start_servers()
        stage.start_user("walk")
        state = wait_for_gait(stage, WALK)
        assert state["commanded_by_stream"], state

        stage.stop("footing-stream")  # The devices go.
        state = wait_for_gait(stage, STEP)
        stage.start_user("walk")
        wait_for_gait(stage, WALK)

        stage.processes["footingd"].send_signal(signal.SIGSTOP)  # The daemon hangs.
        state = wait_for_gait(stage, STEP)
        assert not state["commanded_by_stream"], state
        stage.processes["footingd"].send_signal(signal.SIGCONT)
        wait_for_gait(stage, WALK)

        stage.stop("footingd", signal.SIGKILL)  # The daemon dies, and is started anew.
        state = wait_for_gait(stage, STEP)
        assert not state["commanded_by_stream"], state
        stage.start("footingd", "--listen", stage.sensor, "--source", f"stream:{stage.devices}")
        state = wait_for_gait(stage, WALK)
        assert state["falls"] == 0, state
        print("the walk stopped three times and went on three times, without a fall")


if __name__ == "__main__":
    main(sys.argv[1])
