"""What systemd and udev make of the installed files.

Usage: units.py BINARY_FOLDER units|sysusers|rule

77: this machine has no tool that could tell.
"""
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

SOURCE = pathlib.Path(__file__).resolve().parents[2]
FOLDER = SOURCE / "systemd"
SKIPPED = 77
MOST_EXPOSURE = 0.6
MOST_NETWORK_EXPOSURE = 1.4  # Of what needs the network: it cannot have one of its own.


def run(*words):
    return subprocess.run([str(word) for word in words], capture_output=True, text=True, timeout=60,
                          stdin=subprocess.DEVNULL, check=False)


def check_units(binaries):
    """systemd-analyze finds no unknown key, no missing unit, and the program in its place."""
    if not shutil.which("systemd-analyze"):
        print("skipped: there is no systemd-analyze")
        return SKIPPED
    with tempfile.TemporaryDirectory(prefix="footing-units.") as name:
        folder = pathlib.Path(name)
        for file in FOLDER.iterdir():
            if file.suffix not in (".service", ".socket"):
                continue
            # As installed, but for the place of the program.
            text = file.read_text().replace("@FOOTING_BIN_FOLDER@", str(binaries))
            text = text.replace("@FOOTING_CONFIG_FOLDER@", "/etc/footing")
            name_here = file.name.replace("@.", "@publish.")  # An instance of a template.
            (folder / name_here).write_text(text.replace("@FOOTING_DOC_FOLDER@", "/usr/share/doc/footing"))
        units = sorted(folder.iterdir())
        assert len(units) >= 5, units
        done = run("systemd-analyze", "verify", *units)
        # It also tells of other units of the host.
        ours = [line for line in (done.stdout + done.stderr).splitlines()
                if name in line or "footing" in line]
        assert done.returncode == 0 and not ours, "\n".join(ours) or done.stderr
        # The pauses only sleep.
        services = [unit for unit in units if unit.suffix == ".service" and "-pause" not in unit.name]
        exposures = {unit.name: exposure(unit) for unit in services}
    print("accepted: " + ", ".join(unit.name for unit in units) + f"; exposure {exposures}")
    for unit, found in exposures.items():
        assert found <= (MOST_NETWORK_EXPOSURE if "relay" in unit or "web" in unit else MOST_EXPOSURE), exposures
    return 0


def exposure(unit):
    """How much of the host a service could reach, 0 (nothing) to 10, as systemd counts it."""
    done = run("systemd-analyze", "security", "--offline=true", "--no-pager", unit)
    found = re.search(r"Overall exposure level for \S+: ([0-9.]+)", done.stdout)
    assert found, done.stdout + done.stderr
    return float(found[1])


def check_sysusers(_):
    """systemd-sysusers would make the user and the group that units and rule name."""
    if not shutil.which("systemd-sysusers"):
        print("skipped: there is no systemd-sysusers")
        return SKIPPED
    with tempfile.TemporaryDirectory(prefix="footing-sysusers.") as root:
        (pathlib.Path(root) / "etc").mkdir()
        done = run("systemd-sysusers", "--dry-run", f"--root={root}", FOLDER / "footing.sysusers")
    said = done.stdout + done.stderr
    assert done.returncode == 0, said
    assert "Creating group 'footing'" in said and "Creating user 'footing'" in said, said
    for name in ("footingd.service", "footing-sim.service"):
        service = (FOLDER / name).read_text()
        assert "\nUser=footing\n" in service and "\nGroup=footing\n" in service, f"{name} has another user"
    print("user and group footing")
    return 0


def check_rule(_):
    """The rule that footingd prints for a node it may not open is the one that is installed."""
    rules = [line for line in (FOLDER / "70-footing.rules").read_text().splitlines()
             if line and not line.startswith("#")]
    assert len(rules) == 1, rules
    code = (SOURCE / "daemon/sensor/devices/hid_source.cc").read_text()
    literals = re.search(r'kUdevRule =((?:\s*"(?:[^"\\]|\\.)*")+);', code)
    assert literals, "hid_source.cc has no kUdevRule any more"
    printed = "".join(re.findall(r'"((?:[^"\\]|\\.)*)"', literals[1])).replace('\\"', '"')
    assert printed == rules[0], f"printed:   {printed}\ninstalled: {rules[0]}"
    print(printed)
    return 0


CHECKS = {"units": check_units, "sysusers": check_sysusers, "rule": check_rule}

if __name__ == "__main__":
    sys.exit(CHECKS[sys.argv[2]](pathlib.Path(sys.argv[1]).resolve()))
