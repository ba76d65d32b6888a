"""Installs, upgrades, removes and purges the packages in a new Debian 12, and runs the line there.

Usage: clean_root.py BUILD_FOLDER

The new Debian is made by debootstrap, once, in BUILD_FOLDER/clean_root/base; a copy of it is what the packages go to. No
service starts there: it has no running systemd. Needs root. 77: a tool, a right or the mirror is missing.
"""
import os
import pathlib
import shutil
import subprocess
import sys

import debian
from root import Root

SKIPPED = 77
NEXT_VERSION = "99.0"
UNITS = ("footingd.service", "footingd.socket", "footingd-devices.socket", "footing-sim.service", "footing-sim.socket",
         "footingd-metrics.socket", "footing-sim-metrics.socket")
# What the machine does by itself: footing-sim waits for its first client.
ENABLED = ("footingd.service", "footingd.socket", "footingd-devices.socket", "footing-sim.socket")
STATE = "var/lib/footing/roles.json"


def mirror():
    """Where this machine's apt has Debian 12 from; empty when it does not say."""
    rows = debian.run("apt-get", "indextargets", "--format", "$(REPO_URI) $(RELEASE) $(COMPONENT)",
                      "Created-By: Packages").split("\n")
    found = [row.split()[0] for row in rows if row.split()[1:] == ["bookworm", "main"]]
    return found[0] if found else ""


def make_base(folder):
    """A new Debian 12; the reason why there is none, or None."""
    base = folder / "base"
    if (folder / "base_is_complete").exists():
        return None
    if os.geteuid() != 0:
        return "only root can make a root file system"
    for tool in ("debootstrap", "unshare", "chroot"):
        if not shutil.which(tool, path=os.environ["PATH"] + ":/usr/sbin:/sbin"):
            return f"{tool} is not installed; install what scripts/dependencies-packages.txt lists"
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    done = subprocess.run(["debootstrap", "--variant=minbase", "bookworm", base, *filter(None, [mirror()])],
                          capture_output=True, text=True, timeout=900, check=False)
    if done.returncode != 0:
        return f"debootstrap: {done.stdout[-500:]}{done.stderr[-500:]}"
    (folder / "base_is_complete").touch()
    return None


def check_installed(root, version):
    for program in root.programs():
        said = root.run(f"/usr/bin/{program}", "--version").split()
        assert said, f"{program} does not say its version"
        libraries = root.run("ldd", f"/usr/bin/{program}")
        assert "not found" not in libraries, f"{program}: {libraries}"
    for package in debian.PACKAGES:
        state = root.run("dpkg-query", "--show", "--showformat", "${Status} ${Version}", package)
        assert state == f"install ok installed {version}", f"{package}: {state}"
    account = root.run("getent", "passwd", "footing").strip().split(":")
    assert account[5:] == ["/var/lib/footing", "/usr/sbin/nologin"], account
    root.run("getent", "group", "footing")
    root.run("dpkg", "--verify", *debian.PACKAGES)


def check_units(root):
    """No unknown key, no missing program or unit, with the files in their places."""
    found = root.run("systemd-analyze", "verify", *UNITS, merge=True)
    assert "footing" not in found, found


def check_enabled(root, expected):
    states = {unit: root.state_of(unit) for unit in UNITS}
    assert states == expected, states


def enabled_at_first():
    return {unit: "enabled" if unit in ENABLED else "disabled" for unit in UNITS}


def upgrade(root, newer):
    """Settings and state of the administrator outlive it."""
    (root.path / STATE).parent.mkdir(exist_ok=True)
    (root.path / STATE).write_text("kept")
    root.run("systemctl", "disable", "footingd.service")  # Its sockets with it.
    root.run("systemctl", "mask", "footing-sim.socket")
    chosen = {unit: root.state_of(unit) for unit in UNITS}
    assert chosen["footingd.service"] == "disabled" and chosen["footing-sim.socket"] == "masked", chosen
    root.install(newer)
    check_installed(root, NEXT_VERSION)
    check_enabled(root, chosen)
    assert (root.path / STATE).read_text() == "kept"
    root.run("systemctl", "unmask", "footing-sim.socket")


def remove(root):
    root.apt("remove", *debian.PACKAGES)
    left = root.leftovers()
    assert not [name for name in left if name.startswith("usr/")], left
    assert (root.path / STATE).read_text() == "kept", "removal is not to forget the devices' calibrations"


def purge(root):
    root.apt("purge", *debian.PACKAGES)
    assert not root.leftovers(), root.leftovers()
    root.run("getent", "passwd", "footing")  # Stays, lest its number goes to somebody else.


def inside(build, folder):
    root = Root(folder / "root")
    first = debian.make(build, root.path / "packages/first")
    newer = debian.make(build, root.path / "packages/newer", NEXT_VERSION)
    version = debian.field(first["footing"], "Version")
    root.apt("update")
    root.install(first)
    check_installed(root, version)
    check_units(root)
    check_enabled(root, enabled_at_first())
    print("installed " + version)
    root.check_line()
    upgrade(root, newer)
    print("upgraded to " + NEXT_VERSION)
    remove(root)
    root.install(newer)
    assert (root.path / STATE).read_text() == "kept"
    purge(root)
    print("removed and purged")
    root.install(first)
    check_enabled(root, enabled_at_first())
    purge(root)
    print("installed again and purged")


def main(build, here=None):
    folder = build / "clean_root"
    if here == "--inside":
        return inside(build, folder)
    reason = make_base(folder)
    if reason:
        print("skipped: " + reason)
        return SKIPPED
    shutil.rmtree(folder / "root", ignore_errors=True)
    debian.run("cp", "--archive", folder / "base", folder / "root")
    # What is mounted is mounted for the child alone, and ends with it.
    done = subprocess.run(["unshare", "--mount", "--propagation", "private", sys.executable, "-B", __file__, build,
                           "--inside"], check=False, timeout=1500)
    if done.returncode == 0:
        shutil.rmtree(folder / "root")
    return done.returncode


if __name__ == "__main__":
    sys.exit(main(pathlib.Path(sys.argv[1]).resolve(), *sys.argv[2:]))
