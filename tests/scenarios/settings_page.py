"""docs/setup.md lists every setting of footingd and footing-sim with its default.

Usage: settings_page.py BINARY_FOLDER
"""
import json
import os
import pathlib
import re
import subprocess
import sys

PAGE = pathlib.Path(__file__).resolve().parents[2] / "docs/setup.md"
WORDS = {"empty": ("", []), "none": (None,), "true": (True,), "false": (False,), "`{}`": ({},)}


def tables():
    """Server -> key -> default, as the page has them."""
    found, server = {}, None
    for line in PAGE.read_text().splitlines():
        head = re.match(r"\| key of (both servers|footingd|footing-sim) \|", line)
        row = re.match(r"\| `(\w+)` \| ([^|]*) \|", line)
        if head:
            server = head[1]
            found[server] = {}
        elif row and server:
            found[server][row[1]] = row[2].strip()
        elif not line.startswith("|"):
            server = None
    return found


def matches(shown, value):
    if shown in WORDS:
        return value in WORDS[shown]
    return shown == (f"{value:g}" if isinstance(value, float) else str(value))


def main():
    folder = pathlib.Path(sys.argv[1])
    page = tables()
    assert set(page) == {"both servers", "footingd", "footing-sim"}, page.keys()
    without = {key: value for key, value in os.environ.items() if not key.startswith("FOOTING_")}
    for server in ("footingd", "footing-sim"):
        done = subprocess.run([folder / server, "--print-config"], capture_output=True, text=True, timeout=60, env=without,
                              check=True)
        settings = json.loads(done.stdout)
        listed = {**page["both servers"], **page[server]}
        assert set(listed) == set(settings), (server, set(listed) ^ set(settings))
        wrong = {key: (shown, settings[key]) for key, shown in listed.items() if not matches(shown, settings[key])}
        assert not wrong, (server, wrong)


main()
