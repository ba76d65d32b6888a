"""footing-eval spirals against Fahlman & Lebiere's figures of 1990, section 3.1, over a hundred seeds.

Usage: spirals_command_test.py FOOTING_EVAL
"""
import json
import subprocess
import sys
import unittest

EVAL = sys.argv.pop(1)


class Spirals(unittest.TestCase):
    def test_a_hundred_seeds_are_solved_as_in_1990(self):
        done = subprocess.run([EVAL, "spirals", "--json"], capture_output=True, text=True, check=True)
        report = json.loads(done.stdout)
        self.assertEqual((report["trials"], report["solved"]), (100, 100))
        self.assertLessEqual(report["hidden_mean"], 15.2 + 1)
        self.assertLessEqual(report["epochs_mean"], 1700)
        self.assertLessEqual(report["wrong_between"], 0.07)

    def test_other_seeds_give_other_networks(self):
        runs = [subprocess.run([EVAL, "spirals", "--seeds", "2", "--first-seed", seed, "--json"], capture_output=True,
                               text=True, check=True).stdout for seed in ("1", "1", "7")]
        counts = [{k: v for k, v in json.loads(run).items() if k != "seconds_mean"} for run in runs]
        self.assertEqual(counts[0], counts[1])
        self.assertNotEqual(counts[0], counts[2])


if __name__ == "__main__":
    unittest.main()
