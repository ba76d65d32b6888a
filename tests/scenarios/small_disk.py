"""A small disk to fill: a tmpfs in a mount namespace of the test's own."""
import contextlib
import os
import subprocess
import sys

INSIDE = "--inside"


def enter_namespace():
    """This program again, as root of a user namespace with mounts of its own; 77 where the kernel allows none to this user."""
    command = ["unshare", "--user", "--map-root-user", "--mount"]
    if subprocess.run([*command, "mount", "-t", "tmpfs", "tmpfs", "/mnt"], capture_output=True, check=False).returncode:
        print("skipped: this user may not mount a tmpfs in a namespace of its own")
        return 77
    os.execvp(command[0], [*command, sys.executable, "-B", *sys.argv, INSIDE])


@contextlib.contextmanager
def mounted(folder, size):
    """Makes the folder a disk of that size, as mount writes it (24m)."""
    folder.mkdir()
    subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={size}", "tmpfs", folder], check=True)
    try:
        yield folder
    finally:
        subprocess.run(["umount", "--lazy", folder], check=True)


def fill(folder):
    """Takes all the space that is left, in the file that it returns."""
    filler = folder / "filler"
    with open(filler, "wb", buffering=0) as file:
        for size in (1 << 16, 1):
            try:
                while True:
                    file.write(bytes(size))
            except OSError:
                pass
    assert os.statvfs(folder).f_bavail == 0
    return filler
