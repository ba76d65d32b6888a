"""footing-eval attitude on synthetic readings, and on a real trial of BROAD degraded to a Wiimote's sensors.

Usage: attitude_command_test.py FOOTING_EVAL BROAD_CSV
"""
import json
import math
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

EVAL, BROAD_CSV = sys.argv.pop(1), sys.argv.pop(1)
DATA = pathlib.Path(os.environ.get("FOOTING_TEST_DATA") or "/nowhere") / "hands" / "broad"
GRAVITY = 9.80665


def run(*arguments):
    return subprocess.run([EVAL, "attitude", *map(str, arguments)], capture_output=True, text=True)


class Attitude(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.csv = pathlib.Path(self.folder.name, "imu.csv")

    def write(self, rows, header="gx,gy,gz,ax,ay,az"):
        self.csv.write_text("\n".join([header, *(",".join(map(str, row)) for row in rows)]) + "\n")

    def test_rows_follow_a_turn_about_the_vertical(self):
        # Rests for 2 s, then turns by 90 degrees in 1 s.
        self.write([(0, 0, 0, 0, 0, GRAVITY)] * 200 + [(0, 0, math.pi / 2, 0, 0, GRAVITY)] * 100)
        report = json.loads(run("--imu", self.csv, "--rate-hz", 100, "--json").stdout)
        self.assertEqual(len(report["rows"]), 300)
        last = report["rows"][-1]
        self.assertAlmostEqual(last["t_s"], 2.99)
        self.assertAlmostEqual(2 * math.atan2(last["qz"], last["qw"]), math.pi / 2, delta=0.01)
        self.assertGreater(last["heading_sd_rad"], report["rows"][0]["heading_sd_rad"])
        self.assertNotIn("inclination_rmse_deg", report)

    def test_truth_is_scored_where_it_is_known(self):
        tilt = (math.cos(0.05), math.sin(0.05), 0, 0)  # 0.1 rad about x from what the readings say.
        rows = [(0, 0, 0, 0, 0, GRAVITY, *tilt, 1)] * 300 + [(0, 0, 0, 0, 0, GRAVITY, "", "", "", "", 1)] * 5
        self.write(rows, "gx,gy,gz,ax,ay,az,qw,qx,qy,qz,moving")
        report = json.loads(run("--imu", self.csv, "--rate-hz", 100, "--no-rows", "--json").stdout)
        self.assertEqual(report["scored"], 300)
        self.assertAlmostEqual(report["inclination_rmse_deg"], math.degrees(0.1), places=3)
        self.assertNotIn("rows", report)

    def test_says_what_is_wrong_with_a_file(self):
        self.write([(0, 0, 0, 0, 0, "x")] * 3)
        done = run("--imu", self.csv, "--rate-hz", 100)
        self.assertEqual(done.returncode, 4)
        self.assertIn("row 1", done.stderr)
        self.assertEqual(run("--imu", self.csv).returncode, 2)

    def test_real_trial_as_a_wiimote_would_measure_it(self):
        trials = sorted(DATA.glob("*.mat"))
        if not trials:
            self.skipTest("FOOTING_TEST_DATA has no hands/broad")
        with open(self.csv, "w", encoding="ascii") as csv:
            subprocess.run([sys.executable, BROAD_CSV, trials[0]], stdout=csv, stderr=subprocess.DEVNULL, check=True)
        report = json.loads(run("--imu", self.csv, "--rate-hz", 285.714286, "--degrade", "wiimote", "--no-rows",
                                "--json").stdout)
        self.assertAlmostEqual(report["rate_hz"], 95.238, places=2)
        self.assertGreater(report["scored"], 8000)
        self.assertLess(report["inclination_rmse_deg"], 0.8)
        self.assertLess(abs(report["heading_end_deg"]), 2 * report["heading_end_sd_deg"])


if __name__ == "__main__":
    unittest.main()
