"""A root file system with Debian in it, whose programs are run by chroot."""
import os
import pathlib
import subprocess
import sys

import debian

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "scenarios"))
from harness import Stage, read_ticks  # noqa: E402

ENVIRONMENT = {"PATH": "/usr/sbin:/usr/bin:/sbin:/bin", "LC_ALL": "C", "DEBIAN_FRONTEND": "noninteractive", "HOME": "/root"}


class Root:
    def __init__(self, path):
        """The caller has mounts of its own, which end with it."""
        self.path = path
        debian.run("mount", "-t", "proc", "proc", path / "proc")
        # apt asks the network by the names and the way of this machine.
        (path / "etc/resolv.conf").write_bytes(pathlib.Path("/etc/resolv.conf").read_bytes())
        self.environment = dict(ENVIRONMENT, **{name: value for name, value in os.environ.items()
                                                if name.lower().endswith("_proxy")})

    def run(self, *words, merge=False):
        """Output of a command that must succeed; with what it said of errors if `merge`."""
        words = ("sh", "-c", '"$@" 2>&1', "sh", *words) if merge else words
        return debian.run("chroot", self.path, *words, timeout_s=600, env=self.environment)

    def apt(self, *words):
        return self.run("apt-get", "--yes", "--quiet", "--no-install-recommends", "-o", "APT::Sandbox::User=root", *words)

    def install(self, packages):
        self.apt("install", *(f"/{file.relative_to(self.path)}" for file in packages.values()))

    def programs(self):
        found = sorted(file.name for file in (self.path / "usr/bin").glob("footing*"))
        assert len(found) >= 14, found
        return found

    def state_of(self, unit):
        done = subprocess.run(["chroot", self.path, "systemctl", "is-enabled", unit], capture_output=True, text=True,
                              env=self.environment, timeout=60, check=False)
        return done.stdout.strip()

    def leftovers(self):
        """Files named after us; not what dpkg and apt keep of removed packages, nor these packages themselves."""
        names = [str(file.relative_to(self.path)) for top in ("etc", "run", "usr", "var")
                 for file in (self.path / top).rglob("*footing*")]
        return [name for name in names if not name.startswith(("var/lib/dpkg/", "var/cache/", "var/lib/apt/"))]

    def check_line(self):
        """A synthetic user's walk, from the device socket to the biped, as the services' user."""
        folder = self.path / "run/footing"
        folder.mkdir()
        account = self.run("getent", "passwd", "footing").split(":")
        os.chown(folder, int(account[2]), int(account[3]))
        os.chdir(folder)  # So that the addresses of sockets are short.
        at = "unix:/run/footing/"  # Of the kernel's list of sockets, too: it has the names that were bound.
        with Stage(self.path / "usr/bin") as stage:
            def start(*words):
                with open(stage.folder / f"{words[0]}.log", "w") as log:
                    stage.processes[words[0]] = subprocess.Popen(
                        ["chroot", "--userspec=footing:footing", self.path, *words], stdout=log, stderr=log,
                        stdin=subprocess.DEVNULL, env=dict(ENVIRONMENT, HOME="/tmp"))
            start("footingd", "--listen", at + "sensor.sock", "--source", f"stream:{at}devices.sock")
            stage.wait_for_socket(at + "sensor.sock")
            stage.wait_for_socket(at + "devices.sock")
            start("footing-sim", "--sensor", at + "sensor.sock", "--listen", at + "simulation.sock")
            stage.wait_for_socket(at + "simulation.sock")
            start("footing-stream", "user", "--script", "walk", "--interface", "wrist", "--to", at + "devices.sock")
            walked = any(tick.get("characters") for tick in read_ticks("unix:simulation.sock", 20, ["characters"]))
            assert walked, "no character within 20 s"
            status = self.run("footing-ctl", "--connect", at + "sensor.sock", "status", "--json")
            assert '"devices"' in status, status
        os.chdir("/")
        print("the line runs")
