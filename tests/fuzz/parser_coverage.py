#!/usr/bin/env python3
"""Reads what `llvm-cov export -summary-only` prints and shows how many lines of each parser the
fuzzing covers: llvm-cov export ... | parser_coverage.py parsers.txt. Exit 1 when all of them together
are below 95 %, or a file of the list was not compiled."""
import fnmatch
import json
import pathlib
import sys

LEAST_PERCENT = 95.0


def main() -> int:
    patterns = [line for line in pathlib.Path(sys.argv[1]).read_text().splitlines()
                if line and not line.startswith("#")]
    root = pathlib.Path(__file__).resolve().parents[2]
    files = {}
    for entry in json.load(sys.stdin)["data"][0]["files"]:
        path = pathlib.Path(entry["filename"])
        if path.is_relative_to(root):
            files[str(path.relative_to(root))] = entry["summary"]["lines"]
    count = covered = 0
    missing = []
    for pattern in patterns:
        found = sorted(fnmatch.filter(files, pattern))
        if not found:
            missing.append(pattern)
        for name in found:
            lines = files[name]
            count += lines["count"]
            covered += lines["covered"]
            print(f"{name:52} {lines['covered']:5} of {lines['count']:5} lines {lines['percent']:6.1f} %")
    percent = 100 * covered / max(count, 1)
    print(f"{'all parsers':52} {covered:5} of {count:5} lines {percent:6.1f} %")
    for pattern in missing:
        print(f"error: no compiled file is {pattern}", file=sys.stderr)
    if percent < LEAST_PERCENT:
        print(f"error: at least {LEAST_PERCENT:.0f} % are wanted", file=sys.stderr)
    return 1 if missing or percent < LEAST_PERCENT else 0


if __name__ == "__main__":
    sys.exit(main())
