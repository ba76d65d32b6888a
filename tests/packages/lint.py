"""lintian has nothing to say against the packages: neither an error nor a warning.

Usage: lint.py BUILD_FOLDER

77: lintian is not installed.
"""
import pathlib
import shutil
import subprocess
import sys
import tempfile

import debian


def main(build):
    if not shutil.which("lintian"):
        print("skipped: there is no lintian; install what scripts/dependencies-packages.txt lists")
        return 77
    with tempfile.TemporaryDirectory(prefix="footing-lintian.") as folder:
        packages = debian.make(build, folder)
        done = subprocess.run(["lintian", "--allow-root", "--tag-display-limit", "0", "--show-overrides", "--fail-on",
                               "error,warning", *packages.values()], capture_output=True, text=True, timeout=300,
                              check=False)
    print(done.stdout + done.stderr + ("" if done.stdout else "no tag"))
    return 1 if done.returncode else 0


if __name__ == "__main__":
    sys.exit(main(pathlib.Path(sys.argv[1]).resolve()))
