"""Seeds of the fuzz targets of skeletons over OSC, camera previews and motion files; make_seeds.py writes them."""
import struct


BONES = ["Hips", "Spine", "Chest", "UpperChest", "Neck", "Head"] + [
    side + part for side in ("Left", "Right")
    for part in ("Shoulder", "UpperArm", "LowerArm", "Hand", "UpperLeg", "LowerLeg", "Foot")]


def string(data: bytes) -> bytes:
    return bytes([len(data)]) + data


def osc_text(text: str) -> bytes:
    data = text.encode() + b"\0"
    return data.ljust((len(data) + 3) // 4 * 4, b"\0")


def osc(address: str, types: str, *arguments: object) -> bytes:
    packed = {"i": ">i", "h": ">q", "f": ">f", "d": ">d", "t": ">Q"}
    with_bytes = [t for t in types if t not in "TFNI"]
    return osc_text(address) + osc_text("," + types) + b"".join(
        osc_text(a) if t in "sS" else struct.pack(packed[t], a) for t, a in zip(with_bytes, arguments))


def bundle(*messages: bytes) -> bytes:
    return b"#bundle\0" + struct.pack(">Q", 1) + b"".join(
        struct.pack(">I", len(m)) + m for m in messages)


def blocks(packet: bytes) -> bytes:
    parts = [packet[i:i + 255] for i in range(0, len(packet), 255)][:16] or [b""]
    return bytes([len(parts) - 1]) + b"".join(map(string, parts))


def skeletons() -> dict[str, bytes]:
    names = ["head", "neck", "l_hand", "r_shoulder", "l_knee"]
    point = (0.5, 0.25, 1.5)
    stamped = (*point, 1.0, 5.0)
    place = (*point, 0.0, 0.0, 0.0, 1.0)
    packets = {
        "sensebloom": [bundle(*[osc("/joint", "sifff", n, 1, *point) for n in names])],
        "quartz": [bundle(*[osc(f"/joint/{n}/1", "fff", *point) for n in names])],
        "zillode": [bundle(*[osc("/joint", "siiffffd", n, 0, 1, *stamped) for n in names])],
        "sdk2": [osc("/osceleton2/joint", "siiffffd", n, 0, 1, *stamped) for n in names],
        "footing": [bundle(osc("/footing/skeleton", "hi", 7, 1),
                           *[osc("/footing/joint", "sffff", n, *point, 1.0) for n in names])],
        "vmc": [bundle(osc("/VMC/Ext/Bone/Pos", "sfffffff", n, *point, 0.0, 0.0, 0.0, 1.0),
                       osc("/VMC/Ext/T", "f", 1.0)) for n in ["Hips", "Head", "LeftHand"]],
    }
    options = {name: bytes([i]) for i, name in enumerate(["footing", "quartz", "sdk2", "sensebloom", "vmc", "zillode"])}
    seeds = {f"osc/{name}": options[name] + b"".join(map(blocks, sent)) for name, sent in packets.items()}
    person = bundle(osc("/VMC/Ext/Root/Pos", "sfffffff", "root", *place), *[osc("/VMC/Ext/Bone/Pos", "sfffffff", n, *place)
                                                                             for n in BONES])
    return seeds | other_packets() | {"osc/vmc_person": b"\x02" + (blocks(person) + blocks(osc("/VMC/Ext/T", "f", 1.0))) * 2,
                                      "osc/vmc_twice": b"\x30" + blocks(person) * 2}


def other_packets() -> dict[str, bytes]:
    """What a sender says besides, and what none should say."""
    point = (0.5, 0.25, 1.5)
    long = osc("/" + "a" * 300, "f", 1.0)
    deep = osc("/hit", "")
    for _ in range(12):
        deep = bundle(deep)
    blob = osc_text("/blob") + osc_text(",b") + struct.pack(">I", 3) + b"abc\0"
    packets = {
        "types": [osc("/types", "ihfdTFsSbtNI"[:8], 1, 2, 3.0, 4.0, "s", "S"), osc("/types", "tNIT", 1 << 40), blob],
        "known": [osc(address, "i", 1) for address in ("/new_user", "/lost_user", "/user/1", "/orient", "/hit")],
        "unknown": [osc("/joint", "sff", "head", 0.1, 0.2), osc("/joint/head", "fff", *point), osc("/joint/head/x", "fff", *point),
                    osc("/else", "i", 1), osc("/joint", "sifff", "tail", 1, *point)],
        "not_sane": [osc("/joint", "sifff", "head", 1, 1e9, 0.0, 0.0), osc("/joint", "siiffffd", "head", 0, 1, *point, 7.0, 5.0)],
        "crowd": [osc("/joint", "sifff", "head", user, *point) for user in range(12)] * 2,
        "repeated": [osc("/joint", "sifff", name, 1, *point) for name in ("head", "neck", "head", "head")],
        "late": [osc("/joint", "siiffffd", "head", 0, 1, *point, 1.0, sent) for sent in (5.0, 6.0, 5.0, 6.0, 6.0)],
        "heads": [osc("/footing/skeleton", "hi", 7, 1), osc("/footing/joint", "sffff", "head", *point, 1.0)] * 2,
        "broken": [b"", b"abc", b"abcd", osc_text("/a\x01"), osc_text("/a"), osc_text("/a") + osc_text(",q"), osc("/a", "i", 1)[:-4],
                   osc("/a", "i", 1) + bytes(4), long, deep, osc_text("/a") + osc_text("," + "i" * 300), blob[:-4],
                   osc_text("/a") + osc_text(",s") + b"abcd", b"/abc", osc_text("/a") + osc_text(",b") + struct.pack(">I", 900)],
        "broken_bundles": [b"#bundle\0", b"#bundle\0" + bytes(8) + bytes(4), b"#bundle\0" + bytes(8) + struct.pack(">I", 400)],
    }
    packets["times"] = [b"#bundle\0" + struct.pack(">Q", time) + struct.pack(">I", len(one)) + one
                        for time in (1 << 63, 1 << 33) for one in [osc("/footing/joint", "sffff", "head", *point, 1.0)]]
    # After more than a second, of packets that say nothing, those who are away make place.
    quiet = blocks(osc("/hit", "i", 1)) * 150
    gone = quiet + blocks(osc("/joint", "sifff", "head", 99, *point))
    return {f"osc/{name}": b"\x30" + b"".join(map(blocks, sent)) + (gone if name == "crowd" else b"")
            for name, sent in packets.items()} | {"osc/units": b"\x20" + blocks(osc("/joint", "sifff", "head", 1, *point))}


def motion_files() -> dict[str, bytes]:
    bvh = ("HIERARCHY\nROOT a\n{\nOFFSET 0 0 0\nCHANNELS 6 Xposition Yposition Zposition Zrotation "
           "Xrotation Yrotation\nJOINT b\n{\nOFFSET 1 0 0\nCHANNELS 3 Zrotation Xrotation Yrotation\n"
           "End Site\n{\nOFFSET 1 0 0\n}\n}\n}\nMOTION\nFrames: 1\nFrame Time: 0.01\n"
           "0 1 0 0 0 0 10 20 30\n")
    asf = (":units\nlength 0.45\nangle deg\n:root\norder TX TY TZ RX RY RZ\naxis XYZ\n:bonedata\nbegin\n"
           "name a\ndirection 0 1 0\nlength 1\naxis 0 90 0 XYZ\ndof rx ry\nlimits (-1 2)\n(-3 4)\nend\n"
           ":hierarchy\nbegin\nroot a\nend\n")
    amc = ":FULLY-SPECIFIED\n:DEGREES\n1\nroot 0 1 2 3 4 5\na 6 7\n2\nroot 0 1 2 3 4 5\na 6 7\n"
    trc = ("PathFileType\t4\t(X/Y/Z)\tx\nDataRate\tUnits\n100\tmm\nFrame#\tTime\ta\t\t\n\t\tX1\tY1\tZ1\n\n"
           "1\t0\t1\t2\t3\n2\t0.01\t\t\t\n")
    mot = ("x\nversion=1\nnRows=2\nnColumns=7\ninDegrees=no\nendheader\ntime\tavx\tavy\tavz\tapx\tapy\tapz\n"
           "0\t1\t2\t3\t4\t5\t6\n0.01\t1\t2\t3\t4\t5\t6\n")
    texts = [bvh, asf, amc, trc, mot]
    names = ["bvh", "asf", "amc", "trc", "mot"]
    seeds = {f"motion/{name}": bytes([i]) + text.encode() for i, (name, text) in
             enumerate(zip(names, texts))}
    return seeds | more_texts(*texts) | {f"motion/c3d_{name}": b"\x05" + data for name, data in c3d_files().items()}


def more_texts(bvh: str, asf: str, amc: str, trc: str, mot: str) -> dict[str, bytes]:
    """Files that differ from those in more than a line or a word."""
    moving = bvh.replace("CHANNELS 3 Z", "CHANNELS 6 Xposition Yposition Zposition Z").replace(
        "Frames: 1", "Frames: 2").replace("0 1 0 0 0 0 10 20 30\n", "0 1 0 0 0 0 1 0 0 10 20 30\n0 1 0 0 0 0 @ 0 0 10 20 30\n")
    bones = "".join(f"begin\nname b{i}\ndirection 0 1 0\nlength 1\naxis 0 0 0 XYZ\nend\n" for i in range(300))
    chain = "".join(f"JOINT j{i}\n{{\nOFFSET 0 1 0\nCHANNELS 3 Zrotation Xrotation Yrotation\n" for i in range(300))
    ground = "".join(f"\t{group}{axis}" for group in ("ground_force_v", "ground_force_p", "ground_torque_") for axis in "xyz")
    forces = "x\nversion=1\nnRows=3\nnColumns=10\ninDegrees={}\nendheader\ntime" + ground + "\n" + "".join(
        f"{{}}\t{row}\t700\t0\t0\t0\t0\t0\t0\t0\n" for row in range(3))
    files = {
        "0_moving": moving.replace("@", "1"), "0_moves": moving.replace("@", "2"), "0_deep": bvh.replace("JOINT b", chain + "JOINT b"),
        "0_twice": bvh.replace("Yrotation\nEnd", "Yrotation\nOFFSET 1 0 0\nEnd"),
        "0_channels_twice": bvh.replace("End Site", "CHANNELS 3 Zrotation Xrotation Yrotation\nEnd Site"),
        "0_second_root": bvh.replace("JOINT b", "ROOT b"), "0_no_root": bvh.replace("ROOT a", "JOINT a"),
        "1_root": asf.replace("axis XYZ\n:bone", "axis XYZ\nposition 1 2 3\norientation 4 5 6\n:bone"),
        "1_root_wrong": asf.replace("axis XYZ\n:bone", "axis XYZ\nposition 1 2\n:bone"),
        "1_many": asf.replace(":hierarchy", bones + ":hierarchy"),
        "1_second": asf.replace(":hierarchy", "begin\nname a\ndirection 0 1 0\nlength 1\naxis 0 0 0 XYZ\nend\n:hierarchy"),
        "4_forces": forces.format("no", 0, 0.01, 0.02), "4_unequal": forces.format("no", 0, 0.01, 0.5),
        "4_degrees": forces.format("yes", 0, 0.01, 0.02), "4_backwards": forces.format("no", 0, 0.01, 0.005),
        "4_one_row": mot.replace("nRows=2", "nRows=1").replace("0.01\t1\t2\t3\t4\t5\t6\n", ""),
    }
    return {f"motion/{name}": bytes([int(name[0])]) + one.encode() for name, one in files.items()}


def parameter(name: str, kind: int, dimensions: list[int], data: bytes, group: int = 1) -> bytes:
    body = struct.pack("bB", kind, len(dimensions)) + bytes(dimensions) + data + b"\0"
    return struct.pack("bb", len(name), group) + name.encode() + struct.pack("<H", len(body) + 2) + body


def group(number: int, name: str) -> bytes:
    return struct.pack("bb", len(name), -number) + name.encode() + struct.pack("<H", 3) + b"\0"


def words(name: str, *values: int, group: int = 1) -> bytes:
    return parameter(name, 2, [len(values)], struct.pack(f"<{len(values)}h", *values), group)


def floats(name: str, *values: float, group: int = 1) -> bytes:
    return parameter(name, 4, [len(values)], struct.pack(f"<{len(values)}f", *values), group)


def texts_of(name: str, *values: str, group: int = 1) -> bytes:
    width = max(map(len, values))
    return parameter(name, -1, [width, len(values)], "".join(v.ljust(width) for v in values).encode(), group)


def c3d(parameters: bytes, data: bytes, points: int = 1, analog: int = 0, per_frame: int = 0, scale: float = -1.0,
        frames: int = 2, processor: int = 84, block: int = 0) -> bytes:
    section = b"\x01\x50\x01" + bytes([processor]) + parameters + b"\0\0"
    blocks_of = -(-len(section) // 512)
    header = struct.pack("<BBHHHHHfHHf", 2, 0x50, points, analog, 1, frames, 0, scale, block or 2 + blocks_of, per_frame, 100.0)
    return header.ljust(512, b"\0") + section.ljust(512 * blocks_of, b"\0") + data


def c3d_files() -> dict[str, bytes]:
    point = group(1, "POINT") + texts_of("LABELS", "ab", "c") + texts_of("UNITS", "mm") + floats("RATE", 100)
    corners = (400, 300, 0, -400, 300, 0, -400, -300, 0, 400, -300, 0)
    def plate(kind: int = 2, at: tuple = corners, wires: tuple = (1, 2, 3, 4, 5, 6), unit: str = "Nmm") -> bytes:
        return (point + group(2, "FORCE_PLATFORM") + words("USED", 1, group=2) + words("TYPE", kind, group=2)
                + floats("CORNERS", *at, group=2) + floats("ORIGIN", 0, 0, -40, group=2) + words("CHANNEL", *wires, group=2)
                + group(3, "ANALOG") + floats("SCALE", *[1.0] * 6, group=3) + words("OFFSET", *[0] * 6, group=3)
                + texts_of("UNITS", *["N"] * 3, *[unit] * 3, group=3) + texts_of("FORMAT", "UNSIGNED", group=3)
                + floats("GEN_SCALE", 1, group=3))
    place = struct.pack("<4f", 1, 2, 3, 0)
    forces = struct.pack("<6f", 1, 2, -700, 4, 5, 6)
    analog = dict(analog=6, per_frame=1)
    whole = struct.pack("<4h6H", 1, 2, 3, 0, 1, 2, 700, 4, 5, 6) * 2
    long = group(4, "TRIAL") + words("ACTUAL_START_FIELD", 1, 0, group=4) + words("ACTUAL_END_FIELD", 2, 0, group=4)
    return {
        "plain": c3d(point, place * 2),
        "plate": c3d(plate(), (place + forces) * 2, **analog),
        "newton_metres": c3d(plate(4, unit="Nm"), (place + forces) * 2, **analog),
        "integers": c3d(plate(), whole, scale=0.1, **analog),
        "signed": c3d(plate().replace(b"UNSIGNED", b"SIGNED  "), whole, scale=0.1, **analog),
        "kind_of_plate": c3d(plate(3), (place + forces) * 2, **analog),
        "channels_of_plate": c3d(plate(wires=(1, 2, 3, 4, 5, 60)), (place + forces) * 2, **analog),
        "huge_numbers": c3d(plate() + floats("CHANNEL", *[3e9] * 6, group=2) + floats("TYPE", 1e30, group=2), (place + forces) * 2, **analog),
        "huge_trial": c3d(point + group(4, "TRIAL") + floats("ACTUAL_START_FIELD", 1, 0, group=4) + floats("ACTUAL_END_FIELD", 2, 1e30, group=4), place * 2),
        "corners_of_plate": c3d(plate(at=(0,) * 12), (place + forces) * 2, **analog),
        "not_a_number": c3d(plate(), (place + struct.pack("<6f", *[float("nan")] * 6)) * 2, **analog),
        "long_trial": c3d(point + long, place * 2, frames=1),
        "bytes": c3d(point + parameter("B", 1, [3], b"abc"), place * 2),
        "no_dimension": c3d(point + parameter("T", -1, [], b"t"), place * 2),
        "kind_of_parameter": c3d(point + parameter("K", 3, [1], b"abc"), place * 2),
        "no_such_unit": c3d(point.replace(b"mm", b"in"), place * 2),
        "centimetres": c3d(point.replace(b"mm", b"cm"), place * 2),
        "cut": c3d(point, place),
        "not_whole": c3d(point, place * 2, analog=3, per_frame=2),
        "no_frames": c3d(point, place * 2, frames=0),
        "no_points": c3d(point, place * 2, points=0),
        "too_many": c3d(point, place * 2, points=60000),
        "no_scale": c3d(point, place * 2, scale=0.0),
        "block": c3d(point, place * 2, block=1),
        "big_endian": c3d(point, place * 2, processor=86),
        "vax": c3d(point, place * 2, processor=85),
        "processor": c3d(point, place * 2, processor=1),
        "open_end": c3d(point, b"")[:-40],
        "cut_parameter": c3d(point, b"")[:520] + bytes(504),
        "beyond": b"\xff\x50" + bytes(1022),
        "mark": bytes(1024),
    }


def preview(kind: int, body: bytes) -> bytes:
    return b"FCP1" + struct.pack("<II", kind, len(body)) + body


def previews() -> dict[str, bytes]:
    """How the bytes are cut, then messages (docs/camera.md)."""
    def picture(spheres: bytes = b"", lights: bytes = b"", side: int = 2, rgb: bytes = bytes(range(12)), most: int = 640) -> bytes:
        counts = bytes([len(spheres) // 24, len(lights) // 16])
        return preview(1, struct.pack("<QqHHHHH", 7, 5, most, 480, side, side, 3) + counts + spheres + lights + rgb)
    sphere = lambda confidence=0.5, u=3.0: struct.pack("<BBHfffff", 1, 3, 1, confidence, 2.0, u, 2.0, 9.0)
    light = struct.pack("<Ifff", 2, 5.0, 6.0, 4.0)
    none = preview(2, b"no camera\n")
    streams = {
        "pictures": picture() + picture(sphere() * 2, light) + none,
        "numbers": picture(sphere(float("nan"), -1.0) + sphere(7.0, 1e9)),
        "unknown": picture(b"\xff\xff\xff\xff" + sphere()[4:], b"\xff" * 4 + light[4:]),
        "many": picture(sphere() * 17) + none,
        "cut": picture(sphere())[:-1],
        "size": picture(side=0, rgb=b""), "wide": picture(side=2000), "small_camera": picture(most=1),
        "kind": preview(3, b"abc"), "long": b"FCP1" + struct.pack("<II", 2, 513), "mark": b"FCP2", "short": preview(1, bytes(27)),
    }
    return {f"preview/{name}": string(bytes([2, 0, 9, 1])) + data for name, data in streams.items()}


def seeds() -> dict[str, bytes]:
    return {**motion_files(), **skeletons(), **previews()}
