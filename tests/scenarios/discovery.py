"""A server that listens beyond its host is found by mDNS under its name, with a real avahi-daemon on a
bus and in a network of their own; after avahi-daemon was restarted, too; and without one there is one
line and nothing else changes: discovery.py BINARY_FOLDER."""
import json
import os
import shutil
import signal
import subprocess
import sys
import time

import harness

BUS = """<!DOCTYPE busconfig PUBLIC "-//freedesktop//DTD D-Bus Bus Configuration 1.0//EN"
 "http://www.freedesktop.org/standards/dbus/1.0/busconfig.dtd">
<busconfig><type>system</type><listen>unix:path={socket}</listen><auth>EXTERNAL</auth>
<policy context="default"><allow send_destination="*" eavesdrop="true"/><allow eavesdrop="true"/>
<allow own="*"/></policy></busconfig>
"""
AVAHI = """[server]
use-ipv4=yes
use-ipv6=no
enable-dbus=yes
[publish]
publish-hinfo=no
publish-workstation=no
[rlimits]
"""


def skip(why):
    print(f"skipped: {why}")
    sys.exit(77)


class Network:
    """A bus, and avahi-daemon on it."""

    def __init__(self, stage):
        self.stage = stage
        socket = stage.folder / "bus"
        (stage.folder / "bus.conf").write_text(BUS.format(socket=socket))
        (stage.folder / "avahi.conf").write_text(AVAHI)
        os.environ["DBUS_SYSTEM_BUS_ADDRESS"] = f"unix:path={socket}"
        self._start("bus", "dbus-daemon", f"--config-file={stage.folder}/bus.conf", "--nofork", "--nopidfile")
        wait(lambda: socket.exists(), "the bus")

    def _start(self, name, *words):
        with open(self.stage.folder / f"{name}.log", "a") as log:
            self.stage.processes[name] = subprocess.Popen(words, stdout=log, stderr=log, stdin=subprocess.DEVNULL)

    def start_avahi(self):
        self._start("avahi", "avahi-daemon", "--no-drop-root", "--no-chroot", "--no-rlimits",
                    f"--file={self.stage.folder}/avahi.conf")


def wait(condition, what, within_s=20):
    deadline = time.monotonic() + within_s
    while not condition():
        assert time.monotonic() < deadline, f"{what}: not within {within_s} s"
        time.sleep(0.1)


def servers(stage):
    done = stage.run("footing-ctl", "discover", "--json")
    return json.loads(done.stdout)["servers"] if done.returncode == 0 else []


def scenario(stage):
    token = stage.folder / "token"
    token.write_text("0123456789abcdef\n")
    token.chmod(0o600)
    network = Network(stage)

    def start(name, *words):
        stage.start("footingd", "--set", "sources=[]", "--set", f'sources=["stream:{stage.devices}"]', "--set",
                    f'listen=["{stage.sensor}","tls:0.0.0.0:0"]', "--set", f"token_file={token}",
                    "--set", f"state_directory={stage.folder}/state", *words, name=name)
        wait(lambda: stage.run("footing-ctl", "--connect", stage.sensor, "status").returncode == 0, "footingd")
        return lambda: (stage.folder / f"{name}.log").read_text()

    log = start("footingd", "--set", "advertise=lab 3")
    wait(lambda: "not advertised in the network (avahi-daemon does not answer" in log(), "the line")
    missing = stage.run("footing-ctl", "discover")
    assert missing.returncode == 1 and "avahi-daemon does not answer" in missing.stderr, missing

    network.start_avahi()
    wait(lambda: 'advertised in the network as "lab 3"' in log(), "advertising")
    wait(lambda: servers(stage), "discovery")
    (found,) = servers(stage)
    fingerprint = next(word for word in log().split() if word.startswith("sha256:"))
    assert (found["name"], found["program"], found["fingerprint"]) == ("lab 3", "footingd", fingerprint), found
    assert found["address"].startswith("tls:"), found
    os.environ["FOOTING_TOKEN_FILE"] = str(token)
    os.environ["FOOTING_KNOWN_SERVERS"] = str(stage.folder / "known")
    status = stage.run("footing-ctl", "--connect", found["address"], "status")
    assert status.returncode == 0, status.stderr
    assert fingerprint in (stage.folder / "known").read_text()

    stage.stop("avahi")
    network.start_avahi()
    wait(lambda: log().count("advertised in the network as") == 2, "advertising again")
    wait(lambda: servers(stage), "discovery again")

    assert stage.stop("footingd") == 0
    wait(lambda: not servers(stage), "the end of it")
    quiet = start("quiet")
    time.sleep(1)
    assert "advertised" not in quiet() and not servers(stage)


def main():
    if os.environ.get("FOOTING_OWN_NETWORK") is None:
        for program in ("avahi-daemon", "dbus-daemon", "unshare", "ip"):
            if shutil.which(program) is None:
                skip(f"there is no {program}")
        # It listens beyond loopback, so the network is one that nobody else is in; avahi-daemon writes to /run.
        own = ["unshare", "--net", "--mount", "--"]
        if os.geteuid() != 0 or subprocess.run([*own, "true"], capture_output=True).returncode != 0:
            skip("only root has a network of its own and may start avahi-daemon")
        os.environ["FOOTING_OWN_NETWORK"] = "1"
        os.execvp("unshare", [*own, sys.executable, "-B", *sys.argv])
    subprocess.run(["mount", "-t", "tmpfs", "tmpfs", "/run"], check=True)
    subprocess.run(["ip", "link", "set", "lo", "multicast", "on", "up"], check=True)
    with harness.Stage(sys.argv[1]) as stage:
        scenario(stage)


main()
