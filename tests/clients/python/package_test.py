"""The Python package without a server: columns out of bytes, recordings, simulated devices, generated code.

Usage: package_test.py SOURCE_ROOT [UNITTEST_ARGUMENT...]
"""
import pathlib
import random
import re
import struct
import subprocess
import sys
import tempfile
import unittest
import zlib

ROOT = pathlib.Path(sys.argv.pop(1)).resolve()
sys.path.insert(0, str(ROOT / "clients/python"))

import footing  # noqa: E402
from footing import columns, devices  # noqa: E402
from footing.v1 import character_pb2, device_pb2, sensor_pb2  # noqa: E402

try:
    import numpy as np
except ImportError:
    np = None
try:
    import zstandard
except ImportError:
    zstandard = None


MAGIC = b"\x89MCAP0\r\n"


def fill(message, draw, depth=0):
    """Random fields, about half of them; the extremes of every type among them."""
    for field in message.DESCRIPTOR.fields:
        if draw.random() < 0.5:
            continue
        repeated = columns._repeated(field)
        for _ in range(draw.randint(1, 3) if repeated else 1):
            if field.message_type:
                target = getattr(message, field.name)
                fill(target.add() if repeated else target, draw, depth + 1)
                if not repeated:
                    target.SetInParent()
                continue
            kind = columns._kind(field)
            value = (draw.choice([0.0, -1.5, 1e300]) if kind == "f8" else draw.choice([0.0, 0.5, -2.0]) if kind == "f4" else
                     draw.random() < 0.5 if kind == "?" else draw.choice(["", "Fuß"]) if kind == "text" else
                     draw.choice([b"", b"\xff\0"]) if kind == "bytes" else 2**64 - 1 if kind == "u8" else
                     draw.choice([v.number for v in field.enum_type.values]) if field.enum_type else
                     draw.choice([0, 1, 300, 2**32 - 1]) if field.type == field.TYPE_UINT32 else
                     draw.choice([0, -1, 2**31 - 1, -2**31]))
            if repeated:
                getattr(message, field.name).append(value)
            else:
                setattr(message, field.name, value)


def record(opcode, data):
    return struct.pack("<BQ", opcode, len(data)) + data


def text(value):
    return struct.pack("<I", len(value)) + value.encode()


def recording(messages, compression="", index=True, ends=True, crc=None):
    """Bytes of an MCAP file with one chunk of /footingd/motion."""
    inner = record(3, struct.pack("<H", 1) + text("footing.v1.MotionSamples") + text("protobuf") + text(""))
    inner += record(4, struct.pack("<HH", 1, 1) + text("/footingd/motion") + text("protobuf") + text(""))
    entries = b""
    for number, message in enumerate(messages):
        entries += struct.pack("<QQ", 10**9 + number * 10**7, len(inner))
        inner += record(5, struct.pack("<HIQQ", 1, number, 10**9 + number * 10**7, 0) + message.SerializeToString())
    crc = zlib.crc32(inner) if crc is None else crc
    packed = zstandard.ZstdCompressor().compress(inner) if compression == "zstd" and zstandard else inner
    head = struct.pack("<QQQI", 10**9, 10**9 + (len(messages) - 1) * 10**7, len(inner), crc) + text(compression)
    data = MAGIC + record(1, text("") + text("test")) + record(6, head + struct.pack("<Q", len(packed)) + packed)
    if index:
        data += record(7, struct.pack("<HI", 1, len(entries)) + entries)
    return data + (record(15, bytes(4)) + record(2, bytes(20)) + MAGIC if ends else b"")


MOTION = [sensor_pb2.MotionSamples(samples=[sensor_pb2.MotionSample(
    device=device, sampled_ns=10**9 + i * 10**7 + 500, buttons=i,
    specific_force_mps2=sensor_pb2.Vector3(x=i / 10, y=-i, z=-9.81)) for device in (1, 2)]) for i in range(5)]


class Columns(unittest.TestCase):
    @unittest.skipIf(np is None, "python3-numpy is not installed")
    def test_bytes_give_the_columns_that_the_messages_have(self):
        draw = random.Random(38)
        for channel, kind in (("motion", sensor_pb2.MotionSamples), ("characters", character_pb2.CharacterFrame),
                              ("status", device_pb2.DeviceStatusList), ("inputs", character_pb2.AppliedInputs),
                              ("track", character_pb2.Track), ("reference", sensor_pb2.ReferencePoses)):
            held = [(5, i, kind()) for i in range(20)]
            for _, _, message in held:
                fill(message, draw)
            rows = [row for _, _, m in held for row in (getattr(m, columns.ROWS[channel]) if channel in columns.ROWS else [m])]
            expected = columns.columns_of_messages(rows)
            table = footing.Table.of_messages(channel, held, 0)
            for name, values in expected.items():
                for a, b in zip(table[name].tolist(), values):
                    self.assertTrue(a == b or a != a and b != b, (channel, name, a, b))
            self.assertEqual(len(table), len(rows))

    @unittest.skipIf(np is None, "python3-numpy is not installed")
    def test_damaged_bytes_are_refused_and_never_read_beyond_their_end(self):
        whole = MOTION[3].SerializeToString()
        for size in range(len(whole)):
            try:
                footing.Table.of_bytes("motion", [whole[:size]], [0], [0], 0)
            except ValueError as error:
                self.assertIn("damaged", str(error))
        with self.assertRaises(ValueError):
            footing.Table.of_bytes("motion", [whole[:-3]], [0], [0], 0)

    def test_a_block_in_which_nothing_came_has_the_columns(self):
        table = footing.Table.of_messages("motion", [], 0)
        self.assertEqual((len(table), len(table["specific_force_mps2_x"]), len(table["buttons"])), (0, 0, 0))

    def test_units_are_in_the_names(self):
        table = footing.Table.of_messages("motion", [(0, 0, MOTION[0])], 0)
        self.assertEqual([table.unit(name) for name in ("time_s", "specific_force_mps2_x", "buttons")], ["s", "m/s^2", ""])

    @unittest.skipIf(np is None, "python3-numpy is not installed")
    def test_an_even_rate_lies_on_the_lines_between_rows(self):
        table = footing.Table({"time_s": np.array([0.0, 1.0, 3.0]), "x": np.array([0.0, 2.0, 0.0]), "n": np.array([1, 2, 3])})
        even = table.resample(2)
        self.assertEqual(even["x"].tolist(), [0, 1, 2, 1.5, 1, 0.5])
        self.assertEqual(even["n"].tolist(), [1, 1, 2, 2, 2, 2])

    def test_without_numpy_columns_are_lists_of_the_same_values(self):
        held = [(10**9, i, message) for i, message in enumerate(MOTION)]
        with_arrays = footing.Table.of_messages("motion", held, 10**9, ["specific_force_mps2", "buttons"])
        kept, columns.np = columns.np, None
        try:
            with_lists = footing.Table.of_messages("motion", held, 10**9, ["specific_force_mps2", "buttons"])
            nothing = footing.Table.of_messages("motion", [], 0)
            second = with_lists.where(keep=[device == 2 for device in with_lists["device"]])
            with self.assertRaisesRegex(ImportError, "needs NumPy"):
                with_lists.array(["buttons"])
        finally:
            columns.np = kept
        self.assertEqual(second["buttons"], [0, 1, 2, 3, 4])
        self.assertEqual(list(nothing["specific_force_mps2_x"]), [])
        for name in ("time_s", "specific_force_mps2_x", "buttons"):
            self.assertEqual(list(with_arrays[name]), with_lists[name], name)


class Recordings(unittest.TestCase):
    def read(self, data):
        with tempfile.NamedTemporaryFile(suffix=".mcap") as file:
            file.write(data)
            file.flush()
            with footing.read(file.name) as opened:
                return opened.complete, opened.duration_s, opened.table("motion")

    def test_times_are_those_of_the_samples_from_the_first_message_on(self):
        complete, duration_s, table = self.read(recording(MOTION))
        self.assertTrue(complete)
        self.assertAlmostEqual(duration_s, 0.04)
        self.assertEqual(len(table), 10)
        self.assertAlmostEqual(table["time_s"][2], 0.01 + 500e-9, 12)
        self.assertEqual(list(table["buttons"]), [0, 0, 1, 1, 2, 2, 3, 3, 4, 4])

    def test_a_file_without_index_or_end_is_read_as_far_as_it_goes(self):
        for data in (recording(MOTION, index=False), recording(MOTION, ends=False), recording(MOTION, ends=False) + b"\x06\x99"):
            _, _, table = self.read(data)
            self.assertEqual(len(table), 10)
        self.assertFalse(self.read(recording(MOTION, ends=False))[0])

    def test_what_cannot_be_read_says_so(self):
        for data, words in ((b"", "empty"), (b"RIFF....", "not an MCAP"), (recording(MOTION, crc=1), "footing-log repair"),
                            (recording(MOTION, compression="lz4"), "'lz4'")):
            with self.assertRaisesRegex(footing.FootingError, words):
                self.read(data)
        with tempfile.NamedTemporaryFile() as file:
            file.write(recording(MOTION))
            file.flush()
            with self.assertRaisesRegex(footing.FieldError, "it has /footingd/motion"):
                footing.read(file.name).table("boards")
            with self.assertRaisesRegex(footing.FieldError, "no column 'force'"):
                footing.read(file.name).table("motion")["force"]

    @unittest.skipIf(zstandard is None, "python3-zstandard is not installed")
    def test_chunks_in_zstd_give_the_same(self):
        self.assertEqual(list(self.read(recording(MOTION, compression="zstd"))[2]["buttons"])[-1], 4)

    @unittest.skipIf(zstandard is None, "python3-zstandard is not installed")
    def test_a_chunk_in_zstd_that_is_damaged_names_the_repair(self):
        data = bytearray(recording(MOTION, compression="zstd"))
        at = data.index(b"\x28\xb5\x2f\xfd")
        data[at + 12:at + 20] = bytes(8)
        with self.assertRaisesRegex(footing.DamagedRecording, "footing-log repair"):
            self.read(bytes(data))

    @unittest.skipIf(zstandard is not None, "python3-zstandard is installed")
    def test_chunks_in_zstd_name_the_module_that_is_missing(self):
        with self.assertRaisesRegex(footing.FootingError, "python3-zstandard"):
            self.read(recording(MOTION, compression="zstd"))

    @unittest.skipIf(np is None, "python3-numpy is not installed")
    def test_a_frame_has_words_for_enums(self):
        try:
            import pandas  # noqa: F401
        except ImportError:
            self.skipTest("python3-pandas is not installed")
        state = device_pb2.DeviceStatusList(devices=[device_pb2.DeviceStatus(device=1, kind="DEVICE_KIND_BALANCE_BOARD")])
        frame = footing.Table.of_messages("status", [(0, 0, state)], 0).frame()
        self.assertEqual(frame["kind"][0], "balance_board")
        self.assertEqual(frame["role"][0], "")


class Devices(unittest.TestCase):
    def test_a_wiimotes_calibration_has_its_checksum_twice(self):
        memory = devices._wiimote_memory()[0]
        for at in (0x16, 0x20):
            block = memory[at:at + 10]
            self.assertEqual(block[9], (sum(block[:9]) + 0x55) & 0xFF)
            self.assertEqual(block[0] << 2 | block[3] >> 4 & 3, devices._ZERO)

    def test_a_cell_counts_from_its_calibration(self):
        for kg in (0, 17, 60):
            counts = int.from_bytes(devices._cell(kg), "big")
            self.assertAlmostEqual((counts - devices._CELL_EMPTY) / devices._CELL_COUNTS_PER_KG * devices._HOST_FACTOR, kg, 2)

    def test_a_kind_or_role_that_there_is_not_is_named(self):
        with self.assertRaisesRegex(footing.FootingError, "wiimote, balance_board"):
            footing.device("trampoline")


class Connections(unittest.TestCase):
    def test_without_a_server_the_error_says_what_to_start(self):
        with self.assertRaisesRegex(footing.NotRunning, "no footingd at unix:/nowhere.*start footingd"):
            footing.connect("unix:/nowhere")
        with self.assertRaisesRegex(footing.FootingError, "is not an address"):
            footing.connect("localhost:80")
        with self.assertRaisesRegex(footing.FootingError, "view, log, control or admin"):
            footing.connect("unix:/nowhere", role="boss")


class Files(unittest.TestCase):
    def test_the_generated_code_is_that_of_the_messages(self):
        version = re.search(r"\d+\.\d+", subprocess.run(["protoc", "--version"], capture_output=True, text=True).stdout)
        if not version or version[0] != "3.21":
            self.skipTest(f"protoc {version and version[0]} is not the 3.21 that makes the package's code")
        with tempfile.TemporaryDirectory() as folder:
            protos = sorted((ROOT / "proto/footing/v1").glob("*.proto"))
            subprocess.run(["protoc", "-I", ROOT / "proto", f"--python_out={folder}", f"--pyi_out={folder}", *protos], check=True)
            for made in sorted(pathlib.Path(folder).rglob("*_pb2.*")):
                kept = ROOT / "clients/python/footing/v1" / made.name
                self.assertTrue(kept.exists() and kept.read_bytes() == made.read_bytes(),
                                f"{kept.name} is not of the .proto files: ninja -C build/release python_messages")

    def test_the_versions_agree(self):
        project = re.search(r'^version = "(.*)"', (ROOT / "clients/python/pyproject.toml").read_text(), re.M)[1]
        build = re.search(r"project\(footing VERSION (\S+)", (ROOT / "CMakeLists.txt").read_text())[1]
        self.assertEqual({project, build}, {footing.__version__})


if __name__ == "__main__":
    for module, name in ((np, "python3-numpy"), (zstandard, "python3-zstandard")):
        if module is None:
            print(f"skipped: {name} is not installed", flush=True)
    unittest.main(verbosity=2)
