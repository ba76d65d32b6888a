"""Fails when a build file or a test sets a limit of wall time of its own.

Usage: check_limits.py SOURCE_ROOT

Limits of tests guard against hangs, by the one rule of common/cmake/test.cmake: ten times the time that a test takes alone
on a quiet machine. A test states that time (set_quiet_time, QUIET_S). Checked are the build files, which name no TIMEOUT in
figures, and the tests of commands, which leave it to CTest to end a program that hangs. Checked too: every test that
tests/release_only.txt names exists.
"""
import pathlib
import re
import sys

ROOT = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ".").resolve()
RULE = ROOT / "common/cmake/test.cmake"
IN_BUILD_FILES = re.compile(r"\bTIMEOUT\s+\d")
CASE = re.compile(r"\bTEST(?:_[FP])?\((\w+), (\w+)\)")
IN_COMMAND_TESTS = re.compile(r"\btimeout=\d")


def lines_with(pattern, paths):
    for path in paths:
        for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
            if pattern.search(line):
                yield f"{path.relative_to(ROOT)}:{number}: {line.strip()}"


def unknown_release_only():
    """Lines of tests/release_only.txt without such a program or case."""
    path = ROOT / "tests/release_only.txt"
    lists = "\n".join(file.read_text(encoding="utf-8") for file in (ROOT / "tests").rglob("CMakeLists.txt"))
    cases = set()
    for file in (ROOT / "tests").rglob("*_test.cc"):
        cases |= set(CASE.findall(file.read_text(encoding="utf-8")))
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
        program, *case = line.split(".")
        case = [name.removesuffix("/*").split("/")[-1] for name in case]  # With every parameter.
        if not line.startswith("#") and (f"({program}\n" not in lists.replace(" ", "\n") or case and tuple(case) not in cases):
            yield f"{path.relative_to(ROOT)}:{number}: no such test: {line}"


def main():
    build_files = [path for top in ("common", "daemon", "clients", "tests") for path in (ROOT / top).rglob("CMakeLists.txt")]
    build_files += (ROOT / "common/cmake").glob("*.cmake")
    found = list(lines_with(IN_BUILD_FILES, build_files))
    found += lines_with(IN_COMMAND_TESTS, (ROOT / "tests/offline").rglob("*.py"))
    found += unknown_release_only()
    rule = RULE.read_text(encoding="utf-8")
    if "set(factor 10)" not in rule or "function(set_quiet_time" not in rule:
        found.append(f"{RULE.relative_to(ROOT)}: the rule of ten times the quiet time is missing")
    for line in found:
        print(line)
    if found:
        print("error: limits of wall time follow one rule; state the quiet time instead: common/cmake/test.cmake")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
