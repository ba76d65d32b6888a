"""footing-eval hand on a recorded clip: readings bridge what the camera does not see.

Usage: hand_command_test.py FOOTING_EVAL
"""
import json
import os
import pathlib
import subprocess
import sys
import unittest

EVAL = sys.argv.pop(1)
DATA = pathlib.Path(os.environ.get("FOOTING_TEST_DATA") or "/nowhere") / "mocap" / "cmu_amc"
if not DATA.is_dir():
    print("skipped: FOOTING_TEST_DATA has no mocap/cmu_amc")
    sys.exit(77)


def run(*arguments):
    done = subprocess.run([EVAL, "hand", "--motion", DATA / "14_14.amc", "--skeleton",
                           DATA / "14_reconstructed.asf", "--hidden-s", "0.25", "--json", *arguments],
                          capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)["rows"]


class Hand(unittest.TestCase):
    def test_a_hidden_hand_is_nearer_to_where_it_is(self):
        for row in run():
            alone, joined = row["camera_alone"]["at_its_end"], row["with_inertial"]["at_its_end"]
            self.assertLess(joined["rms_mm"], 0.3 * alone["rms_mm"], row)
            self.assertLess(joined["nees"], 2, row)

    def test_a_lamp_is_not_taken_for_the_hand(self):
        for row in run("--lamp-m", "0.4"):
            self.assertGreater(row["refused"], 100, row)
            self.assertLess(row["with_inertial"]["at_its_end"]["rms_mm"], 100, row)
            self.assertGreater(row["camera_alone"]["at_its_end"]["rms_mm"], 300, row)


unittest.main(verbosity=2)
