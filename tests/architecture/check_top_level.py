"""Fails when the top folder holds something that is not listed here.

Usage: check_top_level.py SOURCE_ROOT

A program that is run there may leave files behind, and one of them may be committed by mistake.
Ignored are what git ignores; without git (a released archive) everything but build is looked at.
"""
import pathlib
import subprocess
import sys

FOLDERS = {".ci", "clients", "common", "daemon", "docs", "proto", "scripts", "systemd", "tests"}
# Of the pages, these are what every project carries; all others stand in docs/.
FILES = {".clang-format", ".clang-tidy", ".gitignore", "CMakeLists.txt", "CMakePresets.json", "LICENSE", "README.md",
         "CHANGELOG.md", "CITATION.cff", "CONTRIBUTING.md", "SECURITY.md"}


def entries(root):
    git = subprocess.run(["git", "-C", root, "ls-files", "--cached", "--others", "--exclude-standard"],
                         capture_output=True, text=True, check=False)
    if git.returncode == 0 and git.stdout:
        return {line.split("/")[0] + ("/" if "/" in line else "") for line in git.stdout.splitlines()}
    return {path.name + ("/" if path.is_dir() else "")
            for path in pathlib.Path(root).iterdir() if path.name not in ("build", ".git")}


def main():
    strange = entries(sys.argv[1]) - {folder + "/" for folder in FOLDERS} - FILES
    for name in sorted(strange):
        print(f"{name}: not a part of the top folder; move it, remove it or list it in {pathlib.Path(__file__).name}")
    return 1 if strange else 0


if __name__ == "__main__":
    sys.exit(main())
