"""Readers of exported files and sent packets that share no code with the product.

Of other projects, by npm: @mcap/core, three's BVHLoader and GLTFLoader, Khronos' gltf-validator, osc. By the rules of the
format: C3D (c3d.org's user guide), TRC, MOT and STO (OpenSim's documentation).
"""
import fcntl
import json
import math
import pathlib
import shutil
import struct
import subprocess

SOURCES = pathlib.Path(__file__).parent / "node_readers"


class NoNode(Exception):
    """The readers that need node cannot be had here; the text says why."""


def node_folder(work):
    """A folder with the scripts and their packages. One installation serves all tests of a build."""
    if shutil.which("node") is None or shutil.which("npm") is None:
        raise NoNode("node or npm is not installed")
    work = pathlib.Path(work).resolve()
    work.mkdir(parents=True, exist_ok=True)
    with open(work / "lock", "w", encoding="utf-8") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        kept = work / "package-lock.json"
        is_same = kept.is_file() and kept.read_bytes() == (SOURCES / kept.name).read_bytes()
        for source in SOURCES.iterdir():
            shutil.copy(source, work)
        if is_same and (work / "node_modules" / ".package-lock.json").is_file():  # npm writes it when all is in place.
            return work
        try:
            done = subprocess.run(["npm", "ci", "--omit=optional", "--no-audit", "--no-fund"], cwd=work, check=False,
                                  capture_output=True, text=True, timeout=120)
        except subprocess.TimeoutExpired as error:
            raise NoNode("npm ci did not end within 120 s") from error
        if done.returncode != 0:
            raise NoNode(f"npm ci failed: {done.stderr.strip()[-300:]}")
    return work


def run_node(folder, script, *words):
    done = subprocess.run(["node", folder / script, *map(str, words)], cwd=folder, check=False, capture_output=True,
                          text=True, timeout=60)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


def check_rising(times, what):
    assert all(b > a for a, b in zip(times, times[1:])), f"{what}: the times do not rise"


def read_trc(path):
    """Times in s, and points in mm by marker."""
    lines = pathlib.Path(path).read_text(encoding="ascii").split("\n")
    assert lines[0].split("\t")[:3] == ["PathFileType", "4", "(X/Y/Z)"], lines[0]
    head = dict(zip(lines[1].split("\t"), lines[2].split("\t")))
    names = [name for name in lines[3].split("\t")[2:] if name]
    assert lines[3].startswith("Frame#\tTime\t") and len(names) == int(head["NumMarkers"]), lines[3]
    assert head["Units"] == "mm" and lines[4].split("\t")[2:5] == ["X1", "Y1", "Z1"], lines[4]
    times, points = [], {name: [] for name in names}
    for number, line in enumerate((line for line in lines[5:] if line.strip()), 1):
        cells = line.split("\t")
        assert int(cells[0]) == number, line
        times.append(float(cells[1]))
        for i, name in enumerate(names):
            cell = cells[2 + 3 * i:5 + 3 * i]
            points[name].append(tuple(map(float, cell)) if all(cell) else None)
    assert len(times) == int(head["NumFrames"]), head
    rate_hz = float(head["DataRate"])
    assert abs((times[-1] - times[0]) * rate_hz - (len(times) - 1)) < 0.01, "the rate is not that of the times"
    check_rising(times, path)
    return times, points


def read_storage(path):
    """OpenSim's MOT or STO: times in s, and columns by label."""
    head, _, body = pathlib.Path(path).read_text(encoding="ascii").partition("endheader\n")
    fields = dict(line.split("=", 1) for line in head.split("\n") if "=" in line)
    labels, *rows = [line.split("\t") for line in body.split("\n") if line.strip()]
    assert labels[0] == "time" and len(set(labels)) == len(labels), labels
    assert int(fields["nRows"]) == len(rows) and int(fields["nColumns"]) == len(labels), fields
    assert fields["inDegrees"] in ("yes", "no") and fields["version"] == "1", fields
    columns = [list(map(float, column)) for column in zip(*rows)]
    assert all(len(row) == len(labels) for row in rows) and all(map(math.isfinite, sum(columns, []))), path
    check_rising(columns[0], path)
    return columns[0], dict(zip(labels[1:], columns[1:]))


def c3d_parameters(block):
    """GROUP:PARAMETER of a parameter section, as lists of numbers or of texts."""
    assert block[3] == 84, "the processor is not Intel's"
    at, groups, found = 4, {}, []
    while block[at]:
        length, number = abs(struct.unpack_from("b", block, at)[0]), struct.unpack_from("b", block, at + 1)[0]
        name = block[at + 2:at + 2 + length].decode("ascii")
        pointer = at + 2 + length
        step, = struct.unpack_from("<h", block, pointer)
        if number < 0:
            groups[-number] = name
        else:
            kind, dimensions = struct.unpack_from("bB", block, pointer + 2)
            sizes = block[pointer + 4:pointer + 4 + dimensions]
            start = pointer + 4 + dimensions
            count = math.prod(sizes)
            data = block[start:start + count * abs(kind)]
            if kind == -1:
                width = sizes[0] if sizes else 1
                values = [data[i:i + width].decode("ascii").rstrip() for i in range(0, count, width)] if width else []
            else:
                values = list(struct.unpack(f"<{count}{ {1: 'B', 2: 'h', 4: 'f'}[kind] }", data))
            found.append((number, name, values))
        if step == 0:
            break
        at = pointer + step
    return {f"{groups[number]}:{name}": values for number, name, values in found}


def read_c3d(path):
    """Rate in Hz, and points by label as (x, y, z, residual) in the file's units."""
    data = pathlib.Path(path).read_bytes()
    assert len(data) % 512 == 0 and data[1] == 0x50, "no C3D"
    points, analog, first, last, _, scale, start, samples, rate_hz = struct.unpack_from("<5HfHHf", data, 2)
    parameters = c3d_parameters(data[512 * (data[0] - 1):512 * (start - 1)])
    frames = last - first + 1
    labels = parameters["POINT:LABELS"]
    assert parameters["POINT:USED"] == [points] and len(labels) >= points and scale < 0, parameters
    assert parameters["POINT:DATA_START"] == [start] and abs(parameters["POINT:RATE"][0] - rate_hz) < 1e-4
    assert analog == samples * parameters.get("ANALOG:USED", [0])[0], (analog, samples)
    width = 4 * points + analog
    values = struct.unpack_from(f"<{frames * width}f", data, 512 * (start - 1))
    assert all(map(math.isfinite, values)), path
    rows = {label: [values[frame * width + 4 * i:frame * width + 4 * i + 4] for frame in range(frames)]
            for i, label in enumerate(labels[:points])}
    return rate_hz, parameters["POINT:UNITS"][0], rows


def same(ours, theirs, within, what):
    assert all(abs(a - b) <= within for a, b in zip(ours, theirs)), f"{what}: {ours} and {theirs}"


def check_bodies(stage, recording, work, with_forces):
    """Every format of a body says the same place for every joint: TRC, C3D, and where node is, BVH and glTF as well."""
    files = {}
    for name, words in (("trc", ()), ("c3d", ()), ("mot", ()), ("bvh", ()), ("gltf", ()),
                        ("humanoid", ("--skeleton", "humanoid"))):
        out = stage.folder / f"outside-{name}"
        stage.run_json("footing-log", "export", recording, "--format", "bvh" if words else name, "--out", out, *words)
        files[name] = sorted(path for path in out.iterdir() if not path.name.endswith("_errors.csv"))
    first = files["trc"][0].stem  # Of several subjects.
    times, points = read_trc(files["trc"][0])
    frame = next(i for i in range(len(times) // 2, len(times)) if all(row[i] for row in points.values()))
    rate_hz, unit, rows = read_c3d(files["c3d"][0])
    assert unit == "mm" and abs(rate_hz * (times[1] - times[0]) - 1) < 1e-3, (unit, rate_hz)
    for name, row in points.items():
        x, up, right = row[frame]
        same((x, -right, up), rows[name][frame][:3], 0.01, f"C3D, {name}")
    storages = [path for path in files["mot"] if path.suffix in (".mot", ".sto") and path.name.startswith(first)]
    lengths = {path.name: len(read_storage(path)[0]) for path in storages}
    assert len(storages) >= (3 if with_forces else 2) and set(lengths.values()) == {len(times)}, lengths
    folder = node_folder(work)
    bvh, humanoid, glb = run_node(folder, "read_bodies.mjs", times[frame], files["bvh"][0], files["humanoid"][0],
                                  files["gltf"][0])
    for seen in (bvh, humanoid, glb):
        assert seen["finite"] and seen["rising"] and abs(seen["duration_s"] - times[-1]) < 0.01, seen
    assert glb["errors"] == 0 and glb["warnings"] == 0, glb
    for name, place in bvh["joints"].items():  # In cm; x left, y up, z ahead.
        x, up, right = points[name][frame]
        same((-right / 10, up / 10, x / 10), place, 0.002, f"BVH, {name}")
    assert {"Hips", "LeftUpperLeg", "Head"} <= set(humanoid["joints"]), humanoid["joints"]
    for name, place in humanoid["joints"].items():
        same(place, [100 * value for value in glb["joints"][name]], 0.002, f"glTF, {name}")
    same(humanoid["joints"]["LeftFoot"], bvh["joints"]["lfoot"], 0.002, "both skeletons")


def check_osc(work, send):
    """npm's osc understands every packet of `send(address)`, which returns the number of frames sent; and times rise.

    Returns the longest time between two frames, s.
    """
    folder = node_folder(work)
    with subprocess.Popen(["node", folder / "receive_osc.mjs"], cwd=folder, stdout=subprocess.PIPE, text=True) as reader:
        try:
            frames = send(f"127.0.0.1:{reader.stdout.readline().strip()}")
            heard = json.loads(reader.communicate(timeout=30)[0])
        finally:
            reader.kill()
    assert not heard["errors"], heard["errors"]
    assert heard["seen"]["/VMC/Ext/T"]["count"] == frames and heard["seen"]["/VMC/Ext/T"]["rises"], (frames, heard)
    assert heard["seen"]["/VMC/Ext/Bone/Pos"]["types"] == "sfffffff", heard["seen"]
    return heard["seen"]["/VMC/Ext/T"]["largest_step"]
