"""footing-eval tracks: made users finish the tracks without pits, and bad words are told.

Usage: tracks_command_test.py FOOTING_EVAL
"""
import json
import subprocess
import sys


def run(*words):
    return subprocess.run([sys.argv[1], "tracks", *words, "--json"], timeout=60,
                          capture_output=True, text=True, check=False)


for interface in ("direct", "wrist"):
    for track in ("straight", "1", "2"):
        done = run("--interface", interface, "--track", track, "--trials", "1", "--seed", "21")
        assert done.returncode == 0, done.stderr
        out = json.loads(done.stdout)
        assert out["trials"] == out["completed"] == 1, out
        assert out["failures"] == {"simulation": 0, "curve": 0, "jump": 0}, out
        assert 25 < out["median_time_s"] < 120, out  # 97 to 100 m at 1 to 3.5 m/s.

again = [run("--interface", "wrist", "--track", "1", "--seed", "4").stdout for _ in range(2)]
assert again[0] == again[1], again

for words, listed in ((("--interface", "boards"), "wrist, direct"), (("--track", "9"), "tracks/9"),
                      (("--trials", "0"), "")):
    bad = run(*words)
    assert bad.returncode == (1 if "--track" in words else 2), (words, bad)
    assert listed in bad.stderr and not bad.stdout, (words, bad)
