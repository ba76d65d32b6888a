"""footing-eval style measures a settled gait beside the published curves, and refuses what the gait cannot do.

Usage: style_command_test.py FOOTING_EVAL
"""
import json
import subprocess
import sys
import unittest

EVAL = sys.argv.pop(1)


def run(*words):
    return subprocess.run([EVAL, "style", *words], capture_output=True, text=True, check=False)


class Style(unittest.TestCase):
    def test_a_walk_and_its_references(self):
        done = run("--gait", "walk", "--speeds", "0.8,1.2", "--seconds", "5", "--json")
        self.assertEqual(done.returncode, 0, done.stderr)
        rows = json.loads(done.stdout)["rows"]
        self.assertEqual([row["speed_mps"] for row in rows], [0.8, 1.2])
        for row in rows:
            self.assertFalse(row["fell"])
            self.assertAlmostEqual(row["speed_mean_mps"], row["cadence_hz"] * row["step_length_m"], places=6)
            self.assertAlmostEqual(row["speed_mean_mps"], row["speed_mps"], delta=0.05)
            deviation = row["cadence_hz"] / row["reference_cadence_hz"] - 1
            self.assertAlmostEqual(row["cadence_deviation"], deviation, places=6)
            self.assertEqual(row["flight_share"], 0)
            self.assertLess(row["asymmetry"], 0.02)
        self.assertLess(rows[0]["reference_bob_m"], rows[1]["reference_bob_m"])

    def test_a_speed_beyond_the_gait_is_refused(self):
        done = run("--gait", "walk", "--speeds", "3")
        self.assertEqual(done.returncode, 2)
        self.assertIn("limit of walk is 1.75 m/s", done.stderr)


if __name__ == "__main__":
    unittest.main()
