"""The installed packages on a running Debian 12: systemd starts, watches, restarts, upgrades and removes the services.

Usage: booted.py BUILD_FOLDER

A copy of the new Debian of clean_root.py, with the packages installed, is booted in QEMU with the kernel of
tests/vm. guest/check does the checks there. 77: a tool, a right or the mirror is missing.
"""
import pathlib
import re
import shutil
import subprocess
import sys

import clean_root
import debian
from root import Root

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "vm"))
import machine  # noqa: E402

CHECKS = re.findall(r"^check (\w+) ", (HERE / "guest/check").read_text(), re.M)
ALL_S = {"kvm": 500, "tcg": 2100}
MEMORY_MB = 1536
# Never used there, and most of the size: what draws, and what apt has fetched.
NOT_NEEDED = ("usr/lib/x86_64-linux-gnu/libLLVM*", "usr/lib/x86_64-linux-gnu/dri/*", "usr/lib/x86_64-linux-gnu/libz3*",
              "var/cache/apt/*", "var/lib/apt/lists/*", "usr/share/locale/*")


def inside(build, folder):
    """The root file system: packages installed, the newer ones beside them, and what the checks need."""
    root = Root(folder / "root")
    first = debian.make(build, root.path / "packages/first")
    debian.make(build, root.path / "packages/newer", clean_root.NEXT_VERSION)
    for made in ("first", "newer"):
        shutil.rmtree(root.path / "packages" / made / "_CPack_Packages")
    root.apt("update")
    root.apt("install", "udev", "kmod")
    root.install(first)
    root.run("systemd-machine-id-setup")  # Otherwise systemd would think of this boot as the first one.
    root.run("useradd", "--create-home", "--groups", "footing", "student")
    root.run("useradd", "--create-home", "visitor")
    (root.path / "etc/fstab").write_text("")
    guest = root.path / "guest"
    guest.mkdir()
    for file in (HERE / "guest/check", build / "tests/kernel_device", build / "tests/stream_client"):
        shutil.copy(file, guest)
    shutil.copy(HERE / "guest/check.service", root.path / "etc/systemd/system")
    root.run("systemctl", "add-wants", "multi-user.target", "check.service")
    root.run("systemctl", "mask", "serial-getty@ttyS0.service")  # The console is the checks'.


def pack(folder, packages):
    """An initramfs that holds the root file system as an archive."""
    root = folder / "root"
    for pattern in NOT_NEEDED:
        for path in root.glob(pattern):
            shutil.rmtree(path) if path.is_dir() and not path.is_symlink() else path.unlink()
    machine.add_modules(root, packages, ("uhid", "hid-wiimote"))
    image = machine.Image(folder / "image", packages)
    (image.folder / "root").mkdir()
    image.add(machine.find_tool("busybox"), "bin/busybox")
    image.add(HERE / "guest/init", "init")
    debian.run("tar", "-C", root, "-I", "gzip -1", "-cf", image.folder / "root.tar.gz", ".")
    image.pack(folder / "initramfs.cpio")
    shutil.rmtree(folder / "image")
    return folder / "initramfs.cpio"


def judge(console):
    found = dict(re.findall(r"^check (\w+): (\w+)", console, re.M))
    for line in re.findall(r"^(?:check|said) .*", console, re.M):
        print(line)
    failed = [name for name in CHECKS if found.get(name) != "ok"]
    if failed or "checks: done" not in console:
        print(console[-12000:])
        print(f"failed: {', '.join(failed)}")
        return 1
    return 0


def main(build, here=None):
    if here == "--inside":
        return inside(build, build / "booted")
    folder = build / "booted"
    reason = clean_root.make_base(build / "clean_root")
    if reason:
        print("skipped: " + reason)
        return clean_root.SKIPPED
    try:
        for tool in machine.TOOLS:
            machine.find_tool(tool)
        packages = machine.fetch_packages(build / "vm/packages")
    except machine.Missing as missing:
        print(f"skipped: {missing}")
        return clean_root.SKIPPED
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir()
    debian.run("cp", "--archive", build / "clean_root/base", folder / "root")
    subprocess.run(["unshare", "--mount", "--propagation", "private", sys.executable, "-B", __file__, build,
                    "--inside"], check=True, timeout=1200)
    initramfs = pack(folder, packages)
    kernel = next((packages / "boot").glob("vmlinuz-*"))
    console, accelerator = machine.boot_as_can_be(kernel, initramfs, "systemd.show_status=0", ALL_S, MEMORY_MB)
    (folder / "console.txt").write_text(console)
    print(f"with {accelerator}; console in {folder / 'console.txt'}")
    shutil.rmtree(folder / "root")
    initramfs.unlink()
    return judge(console)


if __name__ == "__main__":
    sys.exit(main(pathlib.Path(sys.argv[1]).resolve(), *sys.argv[2:]))
