"""Makes the Debian packages of a build folder and reads them."""
import pathlib
import re
import stat
import subprocess

PACKAGES = ("footing", "footing-clients", "footing-common", "footing-daemon", "footing-simulation",
            "python3-footing")


def run(*words, timeout_s=300, **options):
    """Output of a command that must succeed."""
    done = subprocess.run([str(word) for word in words], capture_output=True, text=True, timeout=timeout_s,
                          check=False, stdin=subprocess.DEVNULL, **options)
    if done.returncode != 0:
        raise AssertionError(f"{' '.join(map(str, words))}: exit code {done.returncode}\n"
                             f"{done.stdout[-4000:]}{done.stderr[-4000:]}")
    return done.stdout


def make(build, folder, version=None):
    """The packages of a build folder by name, as files in `folder`."""
    run("cpack", "-G", "DEB", "-B", folder, *(("-R", version) if version else ()), cwd=build)
    made = {file.name.split("_")[0]: file for file in pathlib.Path(folder).glob("*.deb")}
    assert tuple(sorted(made)) == PACKAGES, sorted(made)
    return made


def field(package, name):
    return run("dpkg-deb", "--field", package, name).strip()


def unpack(package, folder):
    """Its files below `folder`, its control files in `folder`/DEBIAN."""
    run("dpkg-deb", "--raw-extract", package, folder)
    return files_below(folder)


def files_below(folder):
    """Path below the folder -> the file, of all that are not folders, but for control files."""
    folder = pathlib.Path(folder)
    found = {}
    for path in folder.rglob("*"):
        name = path.relative_to(folder)
        if name.parts[0] != "DEBIAN" and (path.is_symlink() or not path.is_dir()):
            found[str(name)] = path
    return found


def same_file(one, other):
    """Same kind, mode and content. Programs are stripped in a package: of them mode and build-id count."""
    if one.is_symlink() or other.is_symlink():
        return one.is_symlink() and other.is_symlink() and one.readlink() == other.readlink()
    mode = stat.S_IMODE(one.stat().st_mode) == stat.S_IMODE(other.stat().st_mode)
    content, other_content = one.read_bytes(), other.read_bytes()
    program = content.startswith(b"\x7fELF") and other_content.startswith(b"\x7fELF")
    return mode and (build_id(one) == build_id(other) if program else content == other_content)


def build_id(program):
    """The linker's hash of what it linked: stripping keeps it."""
    notes = run("readelf", "--notes", program)
    found = re.search(r"Build ID: ([0-9a-f]+)", notes)
    assert found, f"{program} has no build-id: {notes}"
    return found[1]
