"""Installed anywhere, the programs run from there alone: no unit, no program names the place of the build.

Usage: install.py BINARY_FOLDER BUILD_FOLDER

Installs footingd, footing-sim, footing-stream, units and data to a temporary prefix, and runs the line
from there, once with a data file missing in the installed folder to see that no other one is read.
"""
import gzip
import json
import pathlib
import re
import subprocess
import sys
import tempfile

from harness import Stage, read_ticks

PROGRAMS = ("footingd", "footing-sim", "footing-stream")


def install(build, prefix, components=(*PROGRAMS, "completion", "data", "documentation", "system_user")):
    for component in components:
        done = subprocess.run(["cmake", "--install", build, "--prefix", prefix, "--component", component],
                              capture_output=True, text=True, timeout=120, check=False)
        assert done.returncode == 0, done.stderr


def check_units(build, prefix):
    units = sorted((prefix / "lib/systemd/system").iterdir())
    names = [unit.name for unit in units]
    assert names == ["footing-sim-metrics.socket", "footing-sim-pause.service", "footing-sim.service", "footing-sim.socket",
                     "footingd-devices.socket", "footingd-metrics.socket", "footingd-pause.service", "footingd.service",
                     "footingd.socket"], names
    for unit in units:
        text = unit.read_text()
        assert "@FOOTING" not in text, f"{unit.name}: a place is not filled in"
        assert str(build) not in text and "/usr/local" not in text, unit.name
        for line in text.splitlines():
            if line.startswith("ExecStart=") and "-pause" not in unit.name:
                words = line.removeprefix("ExecStart=").split()
                program, config = pathlib.Path(words[0]), pathlib.Path(words[words.index("--config") + 1])
                assert program.parent == prefix / "bin" and program.is_file(), line
                assert config.parent == prefix / "etc/footing" and config.is_file(), line
                # A reload checks the same file first.
                assert f"ExecReload={program} --config {config} --check-config\nExecReload=/bin/kill" in text, text


def check_files(prefix):
    for name in ("share/footing/biped.json", "share/footing/proto/footing/v1/session.proto",
                 "share/doc/footing/README.md", "share/doc/footing/docs/README.md", "share/doc/footing/docs/protocol.md",
                 "share/doc/footing/CHANGELOG.md", "share/doc/footing/SECURITY.md", "share/doc/footing/CITATION.cff",
                 "share/doc/footing/docs/examples/study.json", "share/doc/footing/docs/examples/short-study.json",
                 "share/man/man8/footingd.8.gz", "share/man/man1/footing-stream.1.gz",
                 "share/bash-completion/completions/footing",
                 "share/footing/prometheus-alerts.yml", "lib/udev/rules.d/70-footing.rules", "lib/sysusers.d/footing.conf"):
        assert (prefix / name).is_file(), f"{name} is not installed"
    page = gzip.decompress((prefix / "share/man/man8/footingd.8.gz").read_bytes()).decode()
    assert "\\-\\-listen" in page


def check_config_files(build, prefix):
    """The config files hold defaults and comments, every setting in a comment is one, and an edited file stays."""
    for program in ("footingd", "footing-sim"):
        def settings(*words):
            done = subprocess.run([prefix / "bin" / program, "--print-config", *words], capture_output=True, text=True,
                                  timeout=60, check=False)
            assert done.returncode == 0, done.stderr
            return json.loads(done.stdout)
        file = prefix / "etc/footing" / f"{program}.json"
        assert settings("--config", file) == settings(), f"{file.name} changes a default"
        text, count = re.subn(r'^  // (")', r"  \1", file.read_text(), flags=re.M)
        assert count >= 5, text
        file.write_text(text)
        assert settings("--config", file)["metrics"] == "fd:metrics"
        install(build, prefix, (program,))
        assert file.read_text() == text, f"{file.name}: the administrator's settings are lost"


def check_line(prefix):
    with Stage(prefix / "bin") as stage:
        stage.start_servers()
        stage.start_user("walk", "--seconds", 60)
        for tick in read_ticks(stage.simulation, 60, ["characters"]):
            if tick.get("characters"):
                return
    raise AssertionError("no character within 60 s")


def check_data(prefix):
    """It is the installed data that is read, and nothing stands in for what is missing there."""
    biped = prefix / "share/footing/biped.json"
    biped.rename(biped.with_suffix(".away"))
    with Stage(prefix / "bin") as stage:
        done = stage.run("footing-sim", "--listen", stage.simulation, timeout_s=20)
        assert done.returncode == 1, done
        assert "biped.json" in done.stderr and str(prefix) in done.stderr, done.stderr


def main(build):
    with tempfile.TemporaryDirectory(prefix="footing-install.") as folder:
        prefix = pathlib.Path(folder) / "anywhere"
        install(build, prefix)
        check_files(prefix)
        check_units(build, prefix)
        check_config_files(build, prefix)
        check_line(prefix)
        check_data(prefix)
    print("installed, run and read from " + prefix.name)


if __name__ == "__main__":
    main(pathlib.Path(sys.argv[2]).resolve())
