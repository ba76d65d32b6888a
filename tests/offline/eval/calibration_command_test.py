"""footing-eval calibration: a sphere on the boards' marks, rendered, found and solved for the camera's place.

Usage: calibration_command_test.py FOOTING_EVAL
"""
import json
import subprocess
import sys
import unittest

EVAL = sys.argv.pop(1)


def run(*words):
    done = subprocess.run([EVAL, "calibration", *words, "--json"], capture_output=True, text=True,
                          check=True)
    return json.loads(done.stdout)


class Calibration(unittest.TestCase):
    def test_marks_give_the_direction_and_a_hand_over_the_origin(self):
        report = run("--method", "marks", "--trials", "9", "--seed", "3")
        self.assertEqual((report["trials"], report["refused"]), (9, 0))
        self.assertLessEqual(report["turn_p50_deg"], 0.4)
        self.assertLessEqual(report["hand_p50_mm"], 7)

    def test_poses_in_the_air_are_worse(self):
        report = run("--method", "poses", "--trials", "9", "--seed", "3")
        self.assertGreater(report["turn_p50_deg"], 1)


if __name__ == "__main__":
    unittest.main()
