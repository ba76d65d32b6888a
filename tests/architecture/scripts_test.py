"""Every script for people explains itself with --help, and refuses an option that it does not have; figures of pages.

Usage: scripts_test.py SOURCE_ROOT
"""
import csv
import importlib.machinery
import importlib.util
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(sys.argv.pop(1) if len(sys.argv) > 1 else ".").resolve()
# They take no options: what their names say, for other scripts.
BARE = ("check-format", "check-tidy")


def run(script, *words):
    return subprocess.run([script, *words], capture_output=True, text=True, timeout=60, stdin=subprocess.DEVNULL, check=False)


class Scripts(unittest.TestCase):
    def setUp(self):
        self.scripts = [path for path in sorted((ROOT / "scripts").iterdir())
                        if path.suffix != ".txt" and path.name not in BARE]
        self.assertGreater(len(self.scripts), 8)

    def test_help_is_printed(self):
        for script in self.scripts:
            done = run(script, "--help")
            self.assertEqual(done.returncode, 0, (script, done))
            self.assertIn(script.name, done.stdout + done.stderr)

    def test_unknown_options_are_refused(self):
        for script in self.scripts:
            done = run(script, "--no-such-option")
            self.assertEqual(done.returncode, 2, (script, done))
            self.assertTrue(done.stderr, script)

    def test_a_list_of_dependencies_that_is_not_there_is_named(self):
        done = run(ROOT / "scripts/install-dependencies", "nowhere.txt")
        self.assertEqual(done.returncode, 2, done)
        self.assertIn("error: no list nowhere.txt; there are:", done.stderr)

    def test_what_will_be_downloaded_is_said_before_the_wait(self):
        apt = """#!/bin/bash
echo "apt-get $*" >&2
[[ " $* " != *" --assume-no "* ]] || { echo "Need to get 9 MB of archives."; exit 1; }
"""
        with tempfile.TemporaryDirectory(prefix="footing-scripts.") as name:
            folder = pathlib.Path(name)
            (folder / "list.txt").write_text("some-package\n")
            for program, text in (("apt-get", apt), ("dpkg-query", "#!/bin/sh\n"), ("id", "#!/bin/sh\necho 0\n")):
                (folder / program).write_text(text)
                (folder / program).chmod(0o755)
            done = subprocess.run([ROOT / "scripts/install-dependencies", folder / "list.txt"], capture_output=True,
                                  text=True, check=False, env=dict(os.environ, PATH=f"{folder}:{os.environ['PATH']}"))
        self.assertEqual(done.returncode, 0, done)
        said = done.stderr.splitlines()
        self.assertEqual(said[0], "Installing 1 packages: some-package")
        self.assertLess(said.index("Need to get 9 MB of archives."),
                        next(i for i, line in enumerate(said) if " install -y " in line), said)

    def test_a_build_in_a_terminal_says_how_long_it_still_takes(self):
        build = (ROOT / "scripts/build").read_text()
        shown = build[build.index("show_time_left() {"):build.index("\n}\n", build.index("show_time_left() {")) + 3]
        lines = "[0/12, 0.0 s] first\n[5/12, 100.5 s] second\nerror: of a compiler\n"
        done = subprocess.run(["bash", "-c", shown + "show_time_left"], input=lines, capture_output=True, text=True,
                              timeout=60, check=False)
        self.assertEqual(done.returncode, 0, done)
        self.assertIn("[5/12, about 3 min left] second", done.stdout)  # 7 steps of 20 s.
        self.assertIn("error: of a compiler\n", done.stdout)


class Figures(unittest.TestCase):
    """What scripts/measurements draws into a sentence, from a table of its own."""

    def setUp(self):
        sys.dont_write_bytecode = True
        loader = importlib.machinery.SourceFileLoader("measurements", str(ROOT / "scripts/measurements"))
        self.measurements = importlib.util.module_from_spec(importlib.util.spec_from_loader("measurements", loader))
        loader.exec_module(self.measurements)
        folder = tempfile.TemporaryDirectory(prefix="footing-figures.")
        self.addCleanup(folder.cleanup)
        self.measurements.FOLDER = pathlib.Path(folder.name)
        with open(self.measurements.FOLDER / "t.csv", "w", newline="", encoding="utf-8") as file:
            csv.writer(file).writerows([self.measurements.COLUMNS, ["error", "5.2; 7.2", "cm", "", "", "2026-11-28", "", ""]])

    def test_a_figure_is_the_value_of_its_row_or_one_part_of_it(self):
        for name, value in (("error", "5.2; 7.2"), ("error [1]", "5.2"), ("error [2]", "7.2")):
            drawn = self.measurements.redraw(f"It is <!-- figure: t: {name} -->0<!-- --> cm.")
            self.assertEqual(drawn, f"It is <!-- figure: t: {name} -->{value}<!-- --> cm.")
        for name in ("error [3]", "other"):
            with self.assertRaises(SystemExit):
                self.measurements.redraw(f"It is <!-- figure: t: {name} -->0<!-- --> cm.")

    def test_a_comment_that_markdown_would_show_or_end_a_paragraph_with_is_found(self):
        for text in ("of\n<!-- figure: t: error -->0<!-- -->", "- <!-- figure: t: error -->0<!-- -->",
                     "is <!-- figure: t: test --fast -->0<!-- -->"):
            self.assertTrue(self.measurements.BROKEN.search(text), text)
        self.assertFalse(self.measurements.BROKEN.search("is <!-- figure: t: error -->0<!-- --> and <!-- figure: t: x -->0"))


if __name__ == "__main__":
    unittest.main()
