"""The packages hold together what `cmake --install` makes, each file once, and name what they need.

Usage: contents.py BUILD_FOLDER
"""
import gzip
import os
import pathlib
import re
import subprocess
import sys
import tempfile

import debian

# What a package says of itself; and what of `cmake --install` a package leaves to Debian's own copy.
OF_A_PACKAGE = re.compile(r"usr/share/(doc/(footing[a-z-]*|python3-footing)/(copyright|changelog\.gz)|lintian/overrides/.*)"
                          r"|usr/(lib/python3/dist-packages|share/doc/python3-footing)/.*")
UNPACKAGED = {"usr/share/doc/footing/LICENSE"}
PLACES = {
    "footing-daemon": {"usr/bin/footingd", "usr/lib/systemd/system/footingd.service",
                       "usr/lib/systemd/system/footingd.socket", "usr/lib/systemd/system/footingd-devices.socket",
                       "usr/lib/systemd/system/footingd-metrics.socket", "usr/lib/systemd/system/footingd-pause.service",
                       "etc/footing/footingd.json",
                       "usr/lib/udev/rules.d/70-footing.rules", "usr/share/man/man8/footingd.8.gz"},
    "footing-simulation": {"usr/bin/footing-sim", "usr/lib/systemd/system/footing-sim.service",
                           "usr/lib/systemd/system/footing-sim.socket", "etc/footing/footing-sim.json",
                           "usr/lib/systemd/system/footing-sim-metrics.socket",
                           "usr/lib/systemd/system/footing-sim-pause.service", "usr/share/man/man8/footing-sim.8.gz"},
    "footing-clients": {"usr/bin/footing-ctl", "usr/bin/footing-view", "usr/share/man/man1/footing-ctl.1.gz",
                        "usr/lib/systemd/system/footing-relay@.service",
                        "usr/lib/systemd/system/footing-web.service"},
    "footing-common": {"usr/lib/sysusers.d/footing.conf", "usr/share/footing/biped.json",
                       "usr/share/footing/proto/footing/v1/session.proto", "usr/share/doc/footing/docs/setup.md",
                       "usr/share/bash-completion/completions/footing"},
    "python3-footing": {"usr/lib/python3/dist-packages/footing/session.py", "usr/lib/python3/dist-packages/footing/py.typed",
                        "usr/lib/python3/dist-packages/footing/v1/session_pb2.py",
                        "usr/lib/python3/dist-packages/footing/v1/session_pb2.pyi",
                        "usr/share/doc/python3-footing/examples/live_cop.py"},
    "footing": set(),
}
# Of the same version: the packages of one build belong together.
NEEDED = {"footing": ("footing-clients", "footing-daemon", "footing-simulation"), "footing-common": (),
          "python3-footing": (), "footing-clients": ("footing-common",), "footing-daemon": ("footing-common",),
          "footing-simulation": ("footing-common",)}


def check_files(contents, installed):
    """Every installed file is in one package, as it was installed."""
    owners = {}
    for package, files in contents.items():
        missing = PLACES[package] - set(files)
        assert not missing, f"{package} lacks {sorted(missing)}"
        for name, file in files.items():
            if OF_A_PACKAGE.fullmatch(name):
                continue
            assert name not in owners, f"{name} is in {package} and in {owners[name][0]}"
            owners[name] = (package, file)
    expected = set(installed) - UNPACKAGED
    assert set(owners) == expected, f"differ: {sorted(set(owners) ^ expected)}"
    for name, (package, file) in owners.items():
        assert debian.same_file(file, installed[name]), f"{name} of {package} is not as installed"
    return owners


def check_programs(owners):
    """A program brings its manual page and its completion along."""
    programs = [name for name in owners if name.startswith("usr/bin/")]
    assert len(programs) >= 14, programs
    for program in programs:
        name = pathlib.Path(program).name
        section = 8 if name in ("footingd", "footing-sim") else 1
        for other in (f"usr/share/man/man{section}/{name}.{section}.gz",
                      f"usr/share/bash-completion/completions/{name}"):
            assert owners[other][0] == owners[program][0], f"{other} is not beside {name}"
    page = gzip.decompress(owners["usr/share/man/man1/footing-eval.1.gz"][1].read_bytes()).decode()
    assert '.SH "GAIT"' in page and "\\-\\-push\\-direction" in page, "footing-eval(1) has no page of its subcommands"


def check_places(owners):
    """Units name the programs where the packages put them, and nothing names the build."""
    for unit in [file for name, (_, file) in owners.items() if "/systemd/system/" in name]:
        text = unit.read_text()
        assert "@FOOTING" not in text and "_CPack" not in text and "/local/" not in text, unit.name
        for program in re.findall(r"^ExecStart=/(usr/\S+)", text, re.M):
            assert program in owners, f"{unit.name} starts {program}, which no package has"


def check_links(owners):
    """Links between the installed pages lead to installed pages and pictures."""
    for name, (_, file) in owners.items():
        if not name.endswith(".md"):
            continue
        for link in re.findall(r"\]\(([^)#\s]+\.(?:md|png|svg))", file.read_text()):
            if "://" not in link:
                target = os.path.normpath(pathlib.Path(name).parent / link)
                assert target in owners, f"{name} links to {link}, which is not installed"


def check_control(package, file, folder):
    version, depends = debian.field(file, "Version"), debian.field(file, "Depends")
    for name in NEEDED[package]:
        assert f"{name} (= {version})" in depends, f"{package} depends on {depends}"
    libraries = {"footing-daemon": ("libhidapi-hidraw0", "libprotobuf32"),
                 "footing-simulation": ("libmujoco2.2.2", "libprotobuf32"),
                 "footing-clients": ("libegl1", "libglfw3", "libprotobuf32")}.get(package, ())
    for library in libraries:
        assert re.search(rf"\b{re.escape(library)}\b", depends), f"{package} does not depend on {library}: {depends}"
    assert ("libmujoco" in depends) == (package in ("footing-simulation", "footing-clients")), depends
    for script in ("preinst", "postinst", "prerm", "postrm"):
        path = folder / "DEBIAN" / script
        if path.exists():
            debian.run("sh", "-n", path)
            assert not re.search(r"@[A-Z_]+@", path.read_text()), f"{script} of {package}: a place is not filled in"
    listed = folder / "DEBIAN/conffiles"
    settings = {f"/{path.relative_to(folder)}" for path in (folder / "etc").rglob("*.json")}
    assert set(listed.read_text().split() if listed.exists() else ()) == settings, f"{package}: dpkg would replace {settings}"
    about = folder / "usr/share/doc" / package
    first = gzip.decompress((about / "changelog.gz").read_bytes()).decode().split("\n")[0]
    assert first.startswith(f"footing ({version}) "), f"the changelog begins with {first}, not with {version}"
    assert "Apache-2.0" in (about / "copyright").read_text()


def main(build):
    with tempfile.TemporaryDirectory(prefix="footing-packages.") as name:
        folder = pathlib.Path(name)
        subprocess.run(["cmake", "--install", build, "--prefix", "/usr"], check=True, stdout=subprocess.DEVNULL,
                       env=dict(os.environ, DESTDIR=str(folder / "installed")), timeout=120)
        installed = debian.files_below(folder / "installed")
        packages = debian.make(build, folder / "made")
        contents = {package: debian.unpack(file, folder / package) for package, file in packages.items()}
        owners = check_files(contents, installed)
        check_programs(owners)
        check_places(owners)
        check_links(owners)
        for package, file in packages.items():
            check_control(package, file, folder / package)
            print(f"{package}: {len(contents[package])} files, {file.stat().st_size / 1e6:.1f} MB")


if __name__ == "__main__":
    main(pathlib.Path(sys.argv[1]).resolve())
