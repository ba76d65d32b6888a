"""footing-train on made tables: what it reports, what it writes, what it refuses.

Usage: train_command_test.py FOOTING_TRAIN
"""
import hashlib
import json
import math
import pathlib
import random
import subprocess
import sys
import tempfile
import unittest

PROGRAM = sys.argv.pop(1)


def run(*arguments):
    return subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True, timeout=60)


class Train(unittest.TestCase):
    def setUp(self):
        self.holder = tempfile.TemporaryDirectory()
        self.addCleanup(self.holder.cleanup)
        self.folder = pathlib.Path(self.holder.name)
        self.data = self.folder / "curve.csv"
        draw = random.Random(1)
        rows = ["# made", "a,b,y"]
        for _ in range(600):
            a, b = draw.uniform(-1, 1), draw.uniform(-1, 1)
            rows.append(f"{a:.6f},{b:.6f},{math.sin(3 * a) + a * b:.6f}")
        self.data.write_text("\n".join(rows) + "\n")
        self.out = self.folder / "curve.fmodel"

    def train(self, kind, *more):
        return run(kind, "--data", self.data, "--inputs", 2, "--out", self.out, *more)

    def refused(self, code, words, *arguments):
        result = run(*arguments)
        self.assertEqual(result.returncode, code, result.stderr)
        self.assertIn(words, result.stderr)
        self.assertEqual(result.stdout, "")
        self.assertNotIn("\n", result.stderr.strip())

    def test_cascade_reports_and_repeats_its_bits(self):
        result = self.train("cascade", "--seed", 7, "--json")
        self.assertEqual(result.returncode, 0, result.stderr)
        report = json.loads(result.stdout)
        self.assertEqual(
            list(report), ["hidden_units", "epochs", "train_mse", "validation_mse", "seconds"])
        self.assertGreaterEqual(report["hidden_units"], 3)
        self.assertLess(report["validation_mse"], 1e-3)  # The best plane leaves 0.2.
        first = self.out.read_bytes()
        # The last 34 bytes are the checksum of the rest, with its head.
        self.assertEqual(first[-32:], hashlib.sha256(first[:-34]).digest())
        self.assertIn(hashlib.sha256(self.data.read_bytes()).digest(), first)
        self.assertIn(b"--seed 7", first)
        again = self.train("cascade", "--seed", 7, "--json", "--force")
        self.assertEqual(json.loads(again.stdout)["epochs"], report["epochs"])
        self.assertEqual(self.out.read_bytes().replace(b" --force", b"")[-400:-34], first[-400:-34])

    def test_mlp_stops_at_an_equal_error(self):
        result = self.train("mlp", "--mse-goal", 0.02, "--json")
        self.assertEqual(result.returncode, 0, result.stderr)
        report = json.loads(result.stdout)
        self.assertTrue(report["goal_reached"])
        self.assertLessEqual(report["validation_mse"], 0.02)
        self.assertGreater(report["epochs"], 0)

    def test_noise_on_fed_back_columns_raises_the_error(self):
        clean = json.loads(self.train("cascade", "--json").stdout)
        noisy = json.loads(
            self.train("cascade", "--feedback", "a", "--noise", 0.1, "--json", "--force").stdout)
        self.assertGreater(noisy["train_mse"], 3 * clean["train_mse"])

    def test_an_existing_model_is_not_overwritten(self):
        self.out.write_text("precious")
        result = self.train("cascade")
        self.assertEqual(result.returncode, 2)
        self.assertIn("--force", result.stderr)
        self.assertEqual(self.out.read_text(), "precious")

    def test_bad_tables_are_refused_by_line(self):
        for text, words in (("a,b,y\n1,2,3\n1,2\n", "line 3: 2 cells where 3 belong"),
                            ("a,b,y\n1,2,3\n1,nan,2\n", "line 3: no number within"),
                            ("a,b,a\n1,2,3\n", "line 1: the first line must name every column"),
                            ("a,b,y\n", "no rows"),
                            ("a,b,y\n1,2,3\n", "at least 10 are needed")):
            self.data.write_text(text)
            self.refused(4, words, "cascade", "--data", self.data, "--inputs", 2, "--out", self.out)
            self.assertFalse(self.out.exists())

    def test_wrong_command_lines_are_refused(self):
        base = ["cascade", "--data", self.data, "--out", self.out]
        self.refused(2, "leaves 0 of the 3 columns", *base, "--inputs", 3)
        self.refused(2, "y is none of the first 2 columns", *base, "--inputs", 2, "--feedback", "y",
                     "--noise", 1)
        self.refused(1, "cannot open", "cascade", "--data", self.folder / "none.csv", "--inputs", 2,
                     "--out", self.out)
        self.refused(4, "--sigmoid outputs lie within", *base, "--inputs", 2, "--sigmoid")

    def test_what_is_not_built_is_said_with_what_is(self):
        for kind in ("com", "arm", "basis"):
            self.refused(2, "there are cascade and mlp", kind, "--motions", ".", "--out", "x")


if __name__ == "__main__":
    unittest.main()
