#!/usr/bin/env python3
"""footing.env: footing-sim in simulated time, stepped by a Python timekeeper.

Equal seeds and actions give equal bits, in two environments that are stepped in turns and again later; another seed or
action gives others. An episode ends at a fall or a limit, synthetic devices may drive it, and errors say what is wrong.

Usage: python_env.py BINARY_FOLDER
"""
import os
import pathlib
import re
import signal
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "clients/python"))
try:
    import numpy  # noqa: F401
except ImportError:
    print("skipped: python3-numpy is not installed")
    sys.exit(77)
from footing import FootingError, NotRunning, Refused  # noqa: E402
from footing.env import Walk  # noqa: E402

WALK = {"gait": 1, "speed": 1.2, "turn": 0.02}


def run(env, seed, actions):
    env.reset(seed=seed)
    for action in actions:
        env.step(action)
    return env.arrays()


def check_equal_bits(programs):
    actions = [WALK] * 40 + [{"gait": 2, "speed": 2.5}] * 20
    with Walk(programs=programs) as one, Walk(programs=programs) as two:
        for env in (one, two):
            env.reset(seed=5)
        for action in actions:  # Two at once.
            for env in (one, two):
                _, _, _, _, info = env.step(action)
        first, second = one.arrays(), two.arrays()
        assert info["time_s"] == 3.0 and abs(info["distance_m"] - first["reward"].sum() - first_distance(one, first)) < 1e-9
        again = run(one, 5, actions)
        for name, values in first.items():
            assert (values == second[name]).all() and (values == again[name]).all(), f"{name} differs with equal seeds"
        assert len(set(first["state_hash"].tolist())) == len(actions), "the hash stands still"
        assert (run(two, 6, actions)["state_hash"] != first["state_hash"]).all(), "another seed gives the same bits"
        assert (run(two, 5, [{**WALK, "turn": 0.0}] * 60)["state_hash"][5:] != first["state_hash"][5:]).any()
        # Commands arrive: the walk turns to the left and has the speed it was given.
        walk = first["observation"][40]
        assert first["observation"].shape == (61, len(one.names)) and first["action"].shape == (60, 4)
        assert 0.6 < walk[one.names.index("speed_mps")] < 1.8 and walk[one.names.index("gait_walk")] == 1, walk
        assert abs(first["observation"][60][one.names.index("ahead_8m_turn_rad")]) < 3.2


def first_distance(env, arrays):
    return arrays["observation"][0][env.names.index("distance_m")]


def check_speed(programs):
    with Walk(programs=programs) as env:
        env.reset(seed=1)
        cpu_s = time.process_time() + children_s()
        for _ in range(200):
            env.step(WALK)
        env.close()
        spent_s = time.process_time() + children_s() - cpu_s
    print(f"10 s of simulated time, 20 commands a second: {spent_s:.2f} s of CPU, {10 / spent_s:.1f} times real time")


def children_s():
    times = os.times()
    return times.children_user + times.children_system


def check_ends(programs):
    with Walk(track="pits", limit_s=1, programs=programs, reward=lambda env, info: -1.0) as env:
        env.reset(seed=1)
        ends = [env.step(WALK)[1:4] for _ in range(20)]
        assert ends[:19] == [(-1.0, False, False)] * 19 and ends[19] == (-1.0, False, True), ends[18:]
    with Walk(track="1", programs=programs) as env:  # Straight on in a curve: it leaves the ribbon.
        env.reset(seed=1)
        for _ in range(1000):
            _, _, terminated, truncated, info = env.step({"gait": 2, "speed": 3.0})
            if terminated:
                break
        assert terminated and not truncated and info["falls"] == 1, info


def check_devices(programs):
    with Walk(track="straight", users=("run",), programs=programs) as env:
        hashes = []
        for _ in range(2):
            env.reset(seed=2)
            infos = [env.step(None)[4] for _ in range(160)]
            hashes.append([info["state_hash"] for info in infos])
        gait = infos[-1]["character"].gait
        assert gait.commanded_by_stream and gait.speed_mps > 1, gait
        assert hashes[0] == hashes[1], "devices of equal seeds give other bits"


def check_page(programs):
    """The lines of docs/python.md run as they stand, with the programs on PATH."""
    page = (pathlib.Path(__file__).resolve().parents[2] / "docs/python.md").read_text()
    lines = re.search(r"```python\n(from footing.env.*?)```", page, re.S)[1]
    os.environ["PATH"] = programs + os.pathsep + os.environ["PATH"]
    found = {}
    exec(compile(lines, "docs/python.md", "exec"), found)
    assert found["info"]["distance_m"] > 3, found["info"]


def check_errors(programs):
    for wrong, words in ((dict(programs="/nowhere"), "no footing-sim on PATH"), (dict(rate_hz=100), "at most 40"),
                         (dict(track="moon"), "moon"), (dict(gaits="fast"), "fast")):
        try:
            Walk(**{"programs": programs, **wrong})
            raise AssertionError(f"{wrong} is taken")
        except FootingError as error:
            assert words in str(error), error
    with Walk(programs=programs) as env:
        try:
            env.step({"gait": 1, "speed": float("nan")})
            raise AssertionError("a speed that is not a number is taken")
        except Refused as error:
            assert "speed" in str(error), error
        env.step(WALK)
        os.kill(env._children[0].pid, signal.SIGKILL)
        try:
            for _ in range(3):
                env.step(WALK)
            raise AssertionError("it goes on without footing-sim")
        except NotRunning as error:
            assert "ended" in str(error), error
        env.reset(seed=1)
        env.step(WALK)


def main():
    programs = sys.argv[1]
    check_equal_bits(programs)
    check_speed(programs)
    check_ends(programs)
    check_devices(programs)
    check_page(programs)
    check_errors(programs)
    return 0


if __name__ == "__main__":
    sys.exit(main())
