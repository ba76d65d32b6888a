"""footing-eval tracks: synthetic users finish the tracks; what is wrong is said; plan draws them.

Usage: tracks_command_test.py FOOTING_EVAL
"""
import json
import pathlib
import resource
import signal
import subprocess
import sys
import tempfile

CAUSES = ["simulation", "curve", "jump", "straightness", "transition"]


def run(*words, command="tracks", most_bytes=resource.RLIM_INFINITY):
    def limit():
        signal.signal(signal.SIGXFSZ, signal.SIG_IGN)  # The write fails instead.
        resource.setrlimit(resource.RLIMIT_FSIZE, (most_bytes, resource.RLIM_INFINITY))

    return subprocess.run([sys.argv[1], command, *map(str, words), "--json"], preexec_fn=limit,
                          capture_output=True, text=True, check=False)


def report(*words):
    done = run(*words)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


for interface in ("direct", "wrist", "arm", "leg", "joystick", "boards"):
    for track in ("curves", "corners") if interface in ("direct", "wrist") else ("curves",):
        out = report("--interface", interface, "--track", track, "--trials", 1, "--seed", 21)
        assert out["trials"] == out["completed"] == 1, out
        assert out["failures"] == dict.fromkeys(CAUSES, 0), out
        assert 25 < out["median_time_s"] < 120, out  # 94 to 97 m at 1 to 3.5 m/s.
        assert out["tasks"] == {}, out
        assert out["gait_agreement"] > 0.9, out
        assert all(abs(sum(row.values()) - 1) < 1e-9 for row in out["gait_confusion"].values()), out
    assert out["jump_to_command"] == out["jump_to_take_off"] == {"count": 0, "mean_s": 0, "sd_s": 0}, out
    assert out["jumps"] == {"meant": 0, "recognised": 0, "late": 0, "recall": 1, "commanded": 0, "not_meant": 0}, out

# Joy-Cons, and phones over Wi-Fi, in place of Wiimotes: by their protocols and footingd's hub.
for devices, interface in (("joycon", "arm"), ("phone", "wrist")):
    out = report("--interface", interface, "--track", "curves", "--seed", 21, "--devices", devices)
    assert out["devices"] == devices and out["completed"] == 1 and out["gait_agreement"] > 0.9, out
    assert out["failures"] == dict.fromkeys(CAUSES, 0), out

# Every task of the straight track is drawn, done and paid for with few failures.
out = report("--interface", "wrist", "--track", "straight", "--trials", 12, "--seed", 2)
assert out["trials"] == out["completed"] == sum(out["tasks"].values()) == 12, out
assert len(out["tasks"]) >= 4, out
assert out["failures"]["curve"] == out["failures"]["jump"] == 0, out
assert sum(out["failures"].values()) <= 4, out

# Nobody helps over the pits of a test track: each is tried until a jump is timed well.
out = report("--interface", "wrist", "--track", "3", "--trials", 2, "--seed", 3)
assert out["trials"] == out["completed"] == 2, out
assert out["failures"]["jump"] <= 60, out
jumps = out["jumps"]
assert jumps["recognised"] >= 6 and jumps["recall"] == jumps["recognised"] / jumps["meant"] > 0.9, out  # Three pits each.
assert jumps["commanded"] >= jumps["recognised"] - jumps["not_meant"], out
assert 0 < out["jump_to_command"]["count"] <= jumps["recognised"] and 0.4 < out["jump_to_command"]["mean_s"] < 2, out
assert 0 < out["jump_to_take_off"]["mean_s"] < 1.25, out

# A demo in simulated time: on a track that grows the user goes on, on the track and on its feet.
out = report("--interface", "leg", "--track", "endless", "--seconds", 40, "--seed", 5)
assert out["failures"] == dict.fromkeys(CAUSES, 0) and out["off_track_s"] == 0, out
assert out["completed"] == 0 and 30 < out["distance_m"] < 160, out

again = [run("--interface", "wrist", "--track", 1, "--seed", 4).stdout for _ in range(2)]
assert again[0] == again[1], again

# However the remotes lie in the hands: as mirror images, or both rotated to one side or the other.
for words in (("mirrored", 45), ("same", 45), ("same", -45)):
    grip = report("--interface", "arm", "--track", "curves", "--seed", 21, "--grip-way", *words[:1], "--grip-deg", words[1])
    assert grip["completed"] == 1 and (grip["grip_way"], grip["grip_deg"]) == words, grip
    assert grip["failures"] == dict.fromkeys(CAUSES, 0) and grip["gait_agreement"] > 0.9, grip

# A grip that a run has shown holds in the walk after it.
running = report("--interface", "arm", "--track", "curves", "--seed", 21, "--start", "run", "--grip-way", "same",
                 "--grip-deg", 40)
assert running["start"] == "run" and running["completed"] == 1, running
assert running["failures"] == dict.fromkeys(CAUSES, 0) and running["gait_agreement"] > 0.9, running

# What turns with the interface leg can be chosen; a trace shows every look at the picture.
with tempfile.TemporaryDirectory() as folder:
    trace = pathlib.Path(folder, "trace.csv")
    trunk = report("--interface", "leg", "--turn-by", "trunk", "--track", "curves", "--seed", 21,
                   "--trace", trace)
    assert trunk["completed"] == 1 and trunk["turn_by"] == "trunk", trunk
    assert trunk["failures"]["curve"] == 0 and trunk["gait_agreement"] > 0.9, trunk
    rows = [line.split(",") for line in trace.read_text().splitlines()]
    names = rows[0]
    assert all(len(row) == len(names) for row in rows), names
    commanded = {row[names.index("commanded")] for row in rows[2:]}
    assert {"walk", "run"} <= commanded <= {"step", "walk", "run", "jump"}, commanded
    times = [float(row[names.index("time")]) for row in rows[2:]]
    assert abs(times[-1] - times[0] - 0.01 * (len(times) - 1)) < 0.05, times[-1]
    bad = run("--interface", "leg", "--trace", pathlib.Path(folder, "none", "trace.csv"))
    assert bad.returncode == 1 and "cannot write" in bad.stderr, bad
    # A disk that fills in the first trial: the second one is not run.
    full = run("--interface", "direct", "--track", "straight", "--trials", 2, "--trace", trace, most_bytes=100_000)
    assert full.returncode == 1 and f"cannot write {trace}: File too large" in full.stderr, full
    assert "trial 1 of" not in full.stderr, full

# A mapping table and a style of one's own: a slower run, and a body that moves in another way.
with tempfile.TemporaryDirectory() as folder:
    built_in = pathlib.Path(__file__).parents[3] / "daemon/simulation/data/joystick_mapping.json"
    slow, wrong = pathlib.Path(folder, "slow.json"), pathlib.Path(folder, "wrong.json")
    slow.write_text(json.dumps(json.loads(built_in.read_text()) | {"run_speed_max_mps": 1.6}))
    wrong.write_text(json.dumps(json.loads(built_in.read_text()) | {"run_speed": 1.6}))
    words = "--interface", "joystick", "--track", "plain", "--seconds", 10, "--seed", 6
    assert report(*words, "--table", slow)["distance_m"] < report(*words)["distance_m"] - 3
    bad = run(*words, "--table", wrong)
    assert bad.returncode == 4 and str(wrong) in bad.stderr and "run_speed" in bad.stderr, bad
words = "--interface", "wrist", "--track", "plain", "--seconds", 4, "--seed", 6
styles = [report(*words, *style) for style in ((), ("--tempo", 0.6), ("--amplitude", 0.5), ("--asymmetry", 0.3))]
assert [style["tempo"] for style in styles] == [None, 0.6, None, None], styles
assert len({style["distance_m"] for style in styles}) == 4, styles

for words, code, listed in ((("--interface", "telepathy"), 2, "wrist, arm, leg, joystick, boards"),
                            (("--interface", "boards", "--grip-deg", "45"), 2, "remotes"),
                            (("--interface", "arm", "--grip-deg", "45", "--grip-way", "askew"), 2, "mirrored, same"),
                            (("--interface", "leg", "--turn-by", "tail"), 2, "head, feet, trunk"),
                            (("--interface", "arm", "--turn-by", "feet"), 2, "leg"),
                            (("--interface", "direct", "--tempo", "0.9"), 2, "neither a body nor a mapping table"),
                            (("--interface", "wrist", "--asymmetry", "0.9"), 2, "asymmetry"),
                            (("--interface", "boards", "--devices", "joycon"), 2, "wrist, arm, leg or joystick"),
                            (("--interface", "joystick", "--devices", "phone"), 2, "wrist, arm or leg"),
                            (("--track", "9"), 2, "there are: 1, 2, 3, 4, build"),
                            (("--track", "endless"), 2, "no finish line"),
                            (("--trials", "0"), 2, "")):
    bad = run(*words)
    assert bad.returncode == code, (words, bad)
    assert listed in bad.stderr and not bad.stdout, (words, bad)

with tempfile.TemporaryDirectory() as folder:
    svg = pathlib.Path(folder, "plan.svg")
    assert run("straight", "1", "hills", "--out", svg, command="plan").returncode == 0
    text = svg.read_text()
    # A mark; a start and a finish line each; two steps.
    assert text.count("fill='none'") == 1 + 3 * 2 + 2, text.count("fill='none'")
    assert run("9", "--out", svg, command="plan").returncode == 2
