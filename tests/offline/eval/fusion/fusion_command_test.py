"""footing-eval fusion on recorded squats: boards help where a camera loses the legs.

Usage: fusion_command_test.py FOOTING_EVAL
"""
import json
import os
import pathlib
import subprocess
import sys
import unittest

EVAL = sys.argv.pop(1)
DATA = pathlib.Path(os.environ.get("FOOTING_TEST_DATA") or "/nowhere") / "mocap" / "hdm05"
if not DATA.is_dir():
    print("skipped: FOOTING_TEST_DATA has no mocap/hdm05")
    sys.exit(77)


def run(person, clip, *arguments):
    done = subprocess.run([EVAL, "fusion", "--motion", DATA / f"HDM_{person}_squat1Reps_{clip}_120.amc", "--skeleton",
                           DATA / f"HDM_{person}.asf", "--json", *map(str, arguments)],
                          capture_output=True, text=True, timeout=60)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


class Fusion(unittest.TestCase):
    def test_fused_hips_are_better_than_either_source_over_three_people(self):
        hips = {"skeleton": 0, "skeleton_solved": 0, "boards_and_hands": 0, "fused": 0}
        knees = dict(hips)
        for seed, (person, clip) in enumerate((("bd", "007"), ("bk", "019"), ("dg", "031"), ("bd", "001")), 1):
            report = run(person, clip, "--seed", seed)
            self.assertGreater(report["squat_frames"], 30)
            for way in hips:
                hips[way] += report[way]["hip_cm"]
                knees[way] += report[way]["knee_cm"]
        for way in ("skeleton", "skeleton_solved", "boards_and_hands"):
            self.assertLess(hips["fused"], 0.75 * hips[way], way)
            self.assertLess(knees["fused"], knees[way], way)

    def test_no_frame_is_a_squat_below_a_height_that_nobody_reaches(self):
        report = run("bd", "001", "--squat-share", 0.3)
        self.assertEqual(report["squat_frames"], 0)
        self.assertEqual(report["hip_ratio"], 0)

    def test_a_motion_that_is_missing_is_said(self):
        done = subprocess.run([EVAL, "fusion", "--motion", "none.bvh"], capture_output=True, text=True, timeout=60)
        self.assertNotEqual(done.returncode, 0)
        self.assertIn("none.bvh", done.stderr)


if __name__ == "__main__":
    unittest.main()
