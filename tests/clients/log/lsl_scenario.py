"""Real programs offer their streams over the Lab Streaming Layer, and a strict inlet of this file, written from the
protocol alone, finds and reads them: descriptions, times and samples are those of our own protocol.

Usage: lsl_scenario.py SCENARIOS_FOLDER BINARY_FOLDER [SECONDS]
With SECONDS it measures, with eight devices.
"""
import csv
import multiprocessing
import re
import select
import socket
import statistics
import struct
import sys
import threading
import time
import xml.etree.ElementTree as xml

sys.path.insert(0, sys.argv[1])
from harness import Stage  # noqa: E402

FIELDS = ["name", "type", "channel_count", "channel_format", "source_id", "nominal_srate", "version", "created_at",
          "uid", "session_id", "hostname", "v4address", "v4data_port", "v4service_port", "v6address", "v6data_port",
          "v6service_port", "desc"]
PORTS = ("v4data_port", "v4service_port", "v6data_port", "v6service_port")


def check_info(text):
    root = xml.fromstring(text)
    assert root.tag == "info" and [child.tag for child in root] == FIELDS, text
    fields = {child.tag: child.text or "" for child in root}
    assert all(0 <= int(fields[port]) <= 65535 for port in PORTS) and float(fields["version"]) == 1.1, fields
    assert fields["channel_format"] in ("double64", "string") and int(fields["channel_count"]) > 0, fields
    assert re.fullmatch(r"[0-9a-f]{8}(-[0-9a-f]{4}){3}-[0-9a-f]{12}", fields["uid"]), fields["uid"]
    return fields, root.find("desc")


def resolve(query, wanted=1, within_s=2, group=None):
    """The streams that answer a query, by name, asked as liblsl asks: answers go to another port."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as answers, \
            socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as asks:
        answers.bind(("", 0))
        identity = str(abs(hash(query)))
        text = f"LSL:shortinfo\r\n{query}\r\n{answers.getsockname()[1]} {identity}\r\n".encode()
        if group:
            asks.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_IF, socket.inet_aton("127.0.0.1"))
            asks.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_TTL, 0)
        asks.sendto(text, (group or "127.0.0.1", 16571))
        found, deadline = {}, time.monotonic() + within_s
        while len(found) < wanted and select.select([answers], [], [], max(0, deadline - time.monotonic()))[0]:
            answer, sender = answers.recvfrom(65536)
            head, body = answer.decode().split("\r\n", 1)
            assert head == identity, head
            fields, description = check_info(body)
            assert len(description) == 0 and not description.text, "the short form has no description"
            assert fields["v4address"] == "127.0.0.1" == sender[0], (fields["v4address"], sender)
            found[fields["name"]] = fields
    return found


def ask(fields, request):
    with socket.create_connection(("127.0.0.1", int(fields["v4data_port"])), timeout=10) as connection:
        connection.sendall(request)
        answer = b""
        while True:
            part = connection.recv(65536)
            if not part:
                return answer
            answer += part


def time_correction(fields, probes=8):
    """What to add to the outlet's times for ours, and the round trip it was measured with."""
    best = None
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as asks:
        asks.settimeout(5)
        for wave in range(probes):
            t0 = time.monotonic()
            asks.sendto(f"LSL:timedata\r\n{wave} {t0:.16g}\r\n".encode(), ("127.0.0.1", int(fields["v4service_port"])))
            answer = asks.recv(4096).decode()
            t3 = time.monotonic()
            parts = answer.split(" ")
            assert parts[0] == "" and int(parts[1]) == wave and float(parts[2]) == t0 and len(parts) == 5, answer
            t1, t2 = float(parts[3]), float(parts[4])
            trip = (t3 - t0) - (t2 - t1)
            if best is None or trip < best[0]:
                best = trip, -((t1 - t0) + (t2 - t3)) / 2
    return best[1], best[0]


class Feed:
    """A stream's samples, read on a thread: when each came, its time, and its values or text."""

    def __init__(self, fields):
        self.fields, self.samples, self.error = fields, [], None
        self.socket = socket.create_connection(("127.0.0.1", int(fields["v4data_port"])), timeout=30)
        self.socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self.channels, self.text = int(fields["channel_count"]), fields["channel_format"] == "string"
        size = 32 if self.text else 8  # liblsl sends its own size of a string.
        self.socket.sendall((f"LSL:streamfeed/110 {fields['uid']}\r\nNative-Byte-Order: 1234\r\n"
                             "Endian-Performance: 1000000\r\nHas-IEEE754-Floats: 1\r\nSupports-Subnormals: 1\r\n"
                             f"Value-Size: {size}\r\nData-Protocol-Version: 110\r\nMax-Buffer-Length: 360\r\n"
                             "Max-Chunk-Length: 0\r\nHostname: here\r\nSource-Id: x\r\nSession-Id: default\r\n\r\n").encode())
        self.bytes, self.came_s = b"", 0
        self.check_start()
        self.ended = threading.Event()
        self.thread = threading.Thread(target=self.read)
        self.thread.start()

    def take(self, count):
        while len(self.bytes) < count:
            part = self.socket.recv(65536)
            self.came_s = time.monotonic()
            assert part, "the outlet closed the feed"
            self.bytes += part
        taken, self.bytes = self.bytes[:count], self.bytes[count:]
        return taken

    def check_start(self):
        head = b""
        while not head.endswith(b"\r\n\r\n"):
            head += self.take(1)
        lines = head.decode().split("\r\n")
        assert lines[0] == "LSL/110 200 OK" and lines[-2:] == ["", ""], lines
        headers = dict(line.split(": ") for line in lines[1:-2])
        assert headers == {"UID": self.fields["uid"], "Byte-Order": "1234", "Suppress-Subnormals": "0",
                           "Data-Protocol-Version": "110"}, headers
        for offset in (4, 2):
            stamp, values = self.sample()
            assert stamp == 123456.789, stamp
            signs = [1 if k % 2 == 0 else -1 for k in range(self.channels)]
            expected = [str((k + 10) * sign) for k, sign in enumerate(signs)] if self.text else \
                [(k + offset + 16777217) * sign for k, sign in enumerate(signs)]
            assert values == expected, (values, expected)

    def sample(self):
        tag = self.take(1)
        assert tag == b"\2", f"every sample has its time, not {tag}"
        stamp = struct.unpack("<d", self.take(8))[0]
        if not self.text:
            return stamp, list(struct.unpack(f"<{self.channels}d", self.take(8 * self.channels)))
        texts = []
        for _ in range(self.channels):
            size = self.take(1)[0]
            assert size in (1, 4, 8), size
            texts.append(self.take(int.from_bytes(self.take(size), "little")).decode())
        return stamp, texts

    def read(self):
        try:
            while not self.ended.is_set():
                stamp, values = self.sample()
                self.samples.append((self.came_s, stamp, values))
        except (AssertionError, OSError) as error:
            self.error = error if not self.ended.is_set() else None

    def end(self):
        self.ended.set()
        self.socket.shutdown(socket.SHUT_RDWR)
        self.thread.join()
        self.socket.close()
        assert self.error is None, (self.fields["name"], self.error)
        return self.samples


def labels(fields):
    full, description = check_info(ask(fields, b"LSL:fullinfo\r\n").decode())
    assert {k: full[k] for k in FIELDS[:-1]} == {k: fields[k] for k in FIELDS[:-1]}, (full, fields)
    channels = description.find("channels")
    assert len(channels) == int(fields["channel_count"]), fields["name"]
    assert all(channel.find("type").text == fields["type"] for channel in channels)
    return [channel.find("label").text for channel in channels], description


def check_description(found):
    names, about = labels(found["footingd/motion/left_hand"])
    assert names[:3] == [f"specific_force_mps2_{axis}" for axis in "xyz"], names
    assert about.find("channels")[0].find("unit").text == "m/s^2"
    serial = about.find("serial_number").text
    assert serial and found["footingd/motion/left_hand"]["source_id"].endswith(serial), serial
    assert about.find("role").text == "left_hand" and about.find("simulated").text == "true"
    assert "x left" in about.find("frame").text
    rate = float(found["footing-sim/characters/1/com"]["nominal_srate"])
    assert 50 <= rate <= 1000, rate
    return rate


def rows_of(stage, recording, table):
    folder = stage.folder / "csv"
    if not folder.exists():
        stage.run_json("footing-log", "export", recording, "--format", "csv", "--out", folder)
    with open(folder / table, encoding="utf-8", newline="") as rows:
        return list(csv.DictReader(rows))


def same_samples(name, samples, rows, time_column, names):
    """Every sample within the recording's time is a row of it, bit for bit, and the other way round."""
    times_ns = [int(row[time_column]) for row in rows]
    for i in range(1, len(times_ns)):
        # LSL passes on a time that repeats; the export puts it 1 us later.
        if time_column == "sampled_ns" and times_ns[i] - int(rows[i - 1][time_column]) == 1000:
            times_ns[i] = times_ns[i - 1]
    times = [time_ns * 1e-9 for time_ns in times_ns]
    first, last = max(samples[0][1], times[0]), min(samples[-1][1], times[-1])
    ours = {t: row for t, row in zip(times, rows) if first <= t <= last}
    theirs = {stamp: values for _, stamp, values in samples if first <= stamp <= last}
    assert len(ours) > 60 and sorted(ours) == sorted(theirs), (name, len(ours), len(theirs))
    for stamp, values in theirs.items():
        for column, value in zip(names, values):
            if column in ours[stamp] and value == value:
                assert float(ours[stamp][column]) == value, (name, stamp, column, ours[stamp][column], value)
    return len(theirs)


def check_refusals(fields):
    for request, says in ((b"LSL:streamfeed/110 00000000-0000-4000-8000-000000000000\r\n\r\n", b"LSL/110 404 Not found"),
                          (b"LSL:streamfeed\r\n0 0\r\n", b"LSL/110 505"),
                          (b"LSL:streamfeed/110 \r\nValue-Size: 4\r\n\r\n", b"LSL/110 415"),
                          (b"GET / HTTP/1.1\r\n\r\n", b"LSL/110 400"),
                          (b"\xff" * 100_000, b"LSL/110 413")):
        try:
            assert ask(fields, request).startswith(says), request[:40]
        except ConnectionResetError:
            assert len(request) > 16384, request[:40]  # It was cut off in the middle of it.
    assert ask(fields, b"LSL:shortinfo\r\ntype='Accelerometer'\r\n").startswith(b"<?xml")
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as asks:
        for port in (16571, int(fields["v4service_port"])):
            for garbage in (b"", b"\0" * 9000, b"LSL:shortinfo\r\n" + b"(" * 8000 + b"\r\n1 1\r\n", b"LSL:timedata\r\nx y\r\n"):
                asks.sendto(garbage, ("127.0.0.1", port))


class Foreign:
    """An outlet of another program, whose clock is AHEAD_S ahead: queries, descriptions, times and one feed."""
    AHEAD_S = 1000

    def __init__(self, name, kind, channels, form, rate, feed):
        self.name, self.uid, self.feed = name, f"uid of {name}", feed
        self.data = socket.create_server(("127.0.0.1", 0))
        self.queries, self.times = (socket.socket(socket.AF_INET, socket.SOCK_DGRAM) for _ in range(2))
        self.queries.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        self.queries.bind(("", 16571))
        self.queries.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP,
                                socket.inet_aton("239.255.172.215") + socket.inet_aton("127.0.0.1"))
        self.times.bind(("127.0.0.1", 0))
        values = dict(zip(FIELDS, (name, kind, channels, form, f"source of {name}", f"{rate:.12f}", "1.100000000000000",
                                   "1.0", self.uid, "default", "elsewhere", "", self.data.getsockname()[1],
                                   self.times.getsockname()[1], "", 0, 0)))
        self.text = '<?xml version="1.0"?>\n<info>\n' + "".join(
            f"\t<{k}>{v}</{k}>\n" if v != "" else f"\t<{k} />\n" for k, v in values.items())
        self.kind, self.ended = kind, threading.Event()
        self.threads = [threading.Thread(target=run) for run in (self.answer, self.serve)]
        for thread in self.threads:
            thread.start()

    def info(self, desc=""):
        return f"{self.text}\t<desc>{desc}</desc>\n</info>\n".encode()

    def answer(self):
        while not self.ended.is_set():
            for ready in select.select([self.queries, self.times], [], [], 0.1)[0]:
                datagram, sender = ready.recvfrom(65536)
                lines = datagram.decode().split("\r\n")
                if ready is self.times:
                    now = time.monotonic() + self.AHEAD_S
                    wave, t0 = lines[1].split()
                    ready.sendto(f" {wave} {t0} {now:.16g} {time.monotonic() + self.AHEAD_S:.16g}".encode(), sender)
                elif f"'{self.kind}'" in lines[1]:
                    port, identity = lines[2].split()
                    self.times.sendto(identity.encode() + b"\r\n" + self.info(), (sender[0], int(port)))

    def serve(self):
        self.data.settimeout(0.1)
        while not self.ended.is_set():
            try:
                connection, _ = self.data.accept()
            except TimeoutError:
                continue
            with connection:
                connection.settimeout(5)
                request = b""
                while b"\r\n" not in request:
                    request += connection.recv(4096)
                if request.startswith(b"LSL:fullinfo"):
                    connection.sendall(self.info("<channels><channel><label>Cz &amp; Oz</label></channel></channels>"))
                    continue
                while not request.endswith(b"\r\n\r\n"):
                    request += connection.recv(4096)
                assert request.startswith(f"LSL:streamfeed/110 {self.uid}\r\n".encode()), request
                connection.sendall((f"LSL/110 200 OK\r\nUID: {self.uid}\r\nByte-Order: 1234\r\nSuppress-Subnormals: 0\r\n"
                                    "Data-Protocol-Version: 110\r\n\r\n").encode())
                try:
                    self.feed(connection, self)
                except OSError:
                    pass  # The recorder has closed.

    def end(self):
        self.ended.set()
        for thread in self.threads:
            thread.join()
        for one in (self.data, self.queries, self.times):
            one.close()


def eeg(connection, outlet):
    """Three channels of float32 at 100 Hz; every other sample leaves its time to be deduced."""
    for offset in (4, 2):
        connection.sendall(struct.pack("<Bd3f", 2, 123456.789, *((k + offset) * (-1) ** k for k in range(3))))
    outlet.began = time.monotonic() + outlet.AHEAD_S
    for k in range(10_000):
        if outlet.ended.wait(max(0, outlet.began + k / 100 - time.monotonic() - outlet.AHEAD_S)):
            return
        head = struct.pack("<Bd", 2, outlet.began + k / 100) if k % 2 == 0 else b"\1"
        connection.sendall(head + struct.pack("<3f", k, -k, k / 2))


def words(connection, outlet):
    for _ in range(2):
        connection.sendall(struct.pack("<Bd", 2, 123456.789) + b"\1\x0210")
    connection.sendall(struct.pack("<Bd", 2, time.monotonic() + outlet.AHEAD_S) + b"\4" + struct.pack("<I", 300) + b"w" * 300)
    outlet.ended.wait(30)


def lie(connection, outlet):
    for _ in range(2):
        connection.sendall(struct.pack("<Bd", 2, 123456.789) + b"\1\x0210")
    connection.sendall(b"\1\x08" + b"\xff" * 8)  # A text of 2^64 - 1 bytes.
    outlet.ended.wait(30)


def varlen(data, at):
    size = data[at]
    assert size in (1, 4, 8), size
    return int.from_bytes(data[at + 1:at + 1 + size], "little"), at + 1 + size


def read_xdf(path):
    """Streams of other programs in an XDF file, by name: header, times and values of samples, offsets of the clock."""
    data, at, streams = path.read_bytes(), 4, {}
    assert data[:4] == b"XDF:"
    while at < len(data):
        length, at = varlen(data, at)
        tag, content, at = struct.unpack_from("<H", data, at)[0], data[at + 2:at + length], at + length
        if tag not in (2, 3, 4, 6):
            continue
        stream = streams.setdefault(struct.unpack_from("<I", content)[0], {"samples": [], "clock": []})
        if tag == 2:
            stream["header"] = xml.fromstring(content[4:])
        elif tag == 4:
            stream["clock"].append(struct.unpack_from("<dd", content, 4))
        elif tag == 6:
            assert int(xml.fromstring(content[4:]).find("sample_count").text) == len(stream["samples"])
        else:
            count, here = varlen(content, 4)
            channels = int(stream["header"].find("channel_count").text)
            for _ in range(count):
                assert content[here] == 8
                stamp, here = struct.unpack_from("<d", content, here + 1)[0], here + 9
                if stream["header"].find("channel_format").text == "string":
                    size, here = varlen(content, here)
                    stream["samples"].append((stamp, content[here:here + size].decode()))
                    here += size
                else:
                    stream["samples"].append((stamp, struct.unpack_from(f"<{channels}d", content, here)))
                    here += 8 * channels
            assert here == len(content)
    return {stream["header"].find("name").text: stream for number, stream in streams.items() if number > 1_000_000}


def check_inlet(stage):
    """Streams of other programs go into the recording with their clocks, and out again as XDF; liars do no harm."""
    outlets = [Foreign("Bio/Semi", "EEG", 3, "float32", 100, eeg), Foreign("said", "Words", 1, "string", 0, words),
               Foreign("liar", "Words", 1, "string", 0, lie), Foreign("giant", "EEG", 10**9, "float32", 100, lie)]
    recording = stage.folder / "foreign.mcap"
    try:
        done = stage.run_json("footing-log", "record", "--connect", stage.sensor, "--out", recording, "--seconds", 1.8,
                              "--lsl", "type='EEG'", "--lsl", "type='Words'", "--lsl", "name='footingd/motion/left_hand'")
    finally:
        for outlet in outlets:
            outlet.end()
    assert done["lsl_streams"] == 3 and done["lsl_samples"] > 150, done
    stage.run_json("footing-log", "export", recording, "--format", "xdf", "--out", stage.folder)
    streams = read_xdf(stage.folder / "foreign.xdf")
    assert "liar" not in streams or not streams["liar"]["samples"]
    brain, said, hand = streams["Bio/Semi"], streams["said"], streams["footingd/motion/left_hand"]
    assert brain["header"].find("desc/channels/channel/label").text == "Cz & Oz"
    assert float(brain["header"].find("nominal_srate").text) == 100
    began = outlets[0].began
    for k, (stamp, values) in enumerate(brain["samples"]):
        assert abs(stamp - began - k / 100) < 1e-9 and values == (k, -k, k / 2), (k, stamp - began, values)
    assert len(brain["samples"]) > 80
    assert all(abs(offset + Foreign.AHEAD_S) < 1e-3 and at > began - 2 for at, offset in brain["clock"]), brain["clock"]
    assert len(brain["clock"]) == 1 and [text for _, text in said["samples"]] == ["w" * 300], said["samples"]
    info = {topic["topic"] for topic in stage.run_json("footing-log", "info", recording)["topics"]}
    assert {"/lsl/Bio_Semi", "/lsl/Bio_Semi/clock", "/lsl/said", "/footingd/motion"} <= info, info
    folder = stage.folder / "both"
    stage.run_json("footing-log", "export", recording, "--format", "csv", "--out", folder)
    with open(folder / "lsl_Bio_Semi.csv", encoding="utf-8", newline="") as table:
        ours = [1e-9 * int(row["host_ns"]) - float(row["time_s"]) for row in csv.DictReader(table)]
    assert len(ours) == len(brain["samples"]) and all(abs(ahead + Foreign.AHEAD_S) < 1e-3 for ahead in ours), ours[:9]
    # Our own stream, which came by both ways.
    with open(folder / "footingd_motion.csv", encoding="utf-8", newline="") as table:
        rows = {int(row["sampled_ns"]) * 1e-9: float(row["specific_force_mps2_x"]) for row in csv.DictReader(table)
                if row["device_role"] == "left_hand"}
    assert len(hand["samples"]) > 80 and len(hand["clock"]) >= 1
    inside = [(stamp, values) for stamp, values in hand["samples"] if min(rows) <= stamp <= max(rows)]
    wrong = [(stamp, values[0], rows[stamp]) for stamp, values in inside if rows[stamp] != values[0]]
    assert not wrong and len(inside) > 80, (len(inside), wrong)
    bad = stage.run("footing-log", "record", "--out", stage.folder / "no.mcap", "--lsl", "desc/x = 1")
    assert bad.returncode == 2 and "such as: name=" in bad.stderr and not (stage.folder / "no.mcap").exists(), bad


def offer(stage, devices):
    """Starts the outlets; the streams once those of these devices, of the characters and of the events are there."""
    stage.start("footing-log", "lsl", "--connect", stage.sensor, "--connect", stage.simulation, name="lsl")
    wanted = {*devices, "footingd/cop/main", "footingd/features/main/left_hand-right_hand", "footingd/events",
              *(f"footing-sim/characters/1/{part}" for part in ("com", "pose", "gait", "contacts", "phase"))}
    found = {}

    def all_there():
        found.update(resolve("starts-with(name,'footing')", 99, 0.2))
        return wanted <= set(found)

    stage.wait_for(all_there, f"the streams {sorted(wanted)}")
    return found


def start_devices(stage):
    """Two hands and two boards, which are there within a second: no body has to be moved for them."""
    stage.start_user("walk")
    boards = []
    for side in ("left", "right"):
        table = stage.folder / f"{side}.csv"
        table.write_text("time_s,tl_kg,tr_kg,bl_kg,br_kg\n" + "".join(
            f"{0.02 * i:.2f},{8 + i % 50 / 10},{9 - i % 30 / 10},{7 + i % 20 / 10},{8}\n" for i in range(2000)))
        boards += [f"--{side}", table]
    stage.start("footing-stream", "corners", *boards, "--to", stage.devices, name="corners")


def start_body(stage):
    stage.start("footing-stream", "boards", "--motion", "demo", "--hands", "wiimote", "--to", stage.devices, "--seed", 1)


def main():
    with Stage(sys.argv[2]) as stage:
        stage.start_servers()
        start_devices(stage)
        stage.wait_for_devices(4)
        found = offer(stage, [f"footingd/motion/{side}_hand" for side in ("left", "right")] +
                      [f"footingd/boards/{side}_board" for side in ("left", "right")])
        by_type = resolve("session_id='default' and type='Force' and contains(name,'boards')", 2)
        assert sorted(by_type) == ["footingd/boards/left_board", "footingd/boards/right_board"], sorted(by_type)
        assert resolve("type='EEG'", 1, 0.2) == {} == resolve("desc/rig='main'", 1, 0.2)
        assert resolve("type='Markers'", 2, group="239.255.172.215"), "queries to a group are answered"
        check_description(found)
        correction_s, trip_s = time_correction(found["footingd/motion/left_hand"])
        assert abs(correction_s) <= trip_s / 2 + 1e-6, (correction_s, trip_s)
        assert stage.run("footing-log", "lsl", "--streams", "dance").returncode == 2

        hand, board, com = (found[name] for name in ("footingd/motion/left_hand", "footingd/boards/right_board",
                                                     "footing-sim/characters/1/com"))
        idle = socket.create_connection(("127.0.0.1", int(hand["v4data_port"])))
        idle.sendall(f"LSL:streamfeed/110 {hand['uid']}\r\n\r\n".encode())  # It never reads.
        feeds = [Feed(fields) for fields in (hand, hand, board, com, found["footingd/events"])]
        recording = stage.folder / "same.mcap"
        recorder = threading.Thread(target=lambda: stage.run_json(
            "footing-log", "record", "--connect", stage.sensor, "--connect", stage.simulation, "--out", recording,
            "--seconds", 1.2))
        recorder.start()
        check_refusals(hand)
        time.sleep(0.5)
        marked_ns = time.monotonic_ns()
        stage.run_json("footing-ctl", "--connect", stage.sensor, "mark", "stimulus", "--value", "3")
        recorder.join()
        first, second, of_board, of_com, events = (feed.end() for feed in feeds)
        both = {stamp for _, stamp, _ in first} & {stamp for _, stamp, _ in second}
        assert len(both) > 80, len(both)
        marks = [(stamp, texts) for _, stamp, texts in events if texts == ["stimulus 3"]]
        assert len(marks) == 1 and abs(marks[0][0] - 1e-9 * marked_ns) < 0.5, events

        def of(table, role):
            return [row for row in rows_of(stage, recording, table) if row["device_role"] == role]

        counts = [same_samples("hand", first, of("footingd_motion.csv", "left_hand"), "sampled_ns", labels(hand)[0]),
                  same_samples("second reader", second, of("footingd_motion.csv", "left_hand"), "sampled_ns", labels(hand)[0]),
                  same_samples("board", of_board, of("footingd_boards.csv", "right_board"), "sampled_ns", labels(board)[0]),
                  same_samples("com", of_com, rows_of(stage, recording, "footing-sim_characters.csv"), "log_time_ns",
                               labels(com)[0])]
        lags = sorted(came - stamp for came, stamp, _ in of_com)
        print(f"{len(found)} streams; equal samples {counts}; time correction {1e6 * correction_s:.0f} us; "
              f"lag p50 {1e3 * statistics.median(lags):.2f} ms")
        idle.close()
        check_inlet(stage)
        assert stage.stop("lsl") == 0


def read_for(found, seconds):
    feeds = [Feed(fields) for fields in found]
    time.sleep(seconds)
    return {feed.fields["name"]: feed.end() for feed in feeds}


def quantiles(values):
    values = sorted(values)
    return values[len(values) // 2], values[int(0.99 * len(values))], values[-1]


def measure(seconds):
    """A process of its own reads eight devices, so that this one is not in the way of the times it takes."""
    with Stage(sys.argv[2]) as stage:
        stage.start_servers()
        start_body(stage)
        stage.start("footing-stream", "user", "--interface", "leg", "--see", stage.simulation, "--to", stage.devices,
                    "--seed", 2, name="legs")
        stage.start("footing-stream", "builder", "--to", stage.devices, "--seed", 3, name="builder")
        devices = stage.wait_for_devices(8)
        streams = [f"footingd/{'boards' if 'board' in one['role'] else 'motion'}/{one['role']}" for one in devices]
        found = offer(stage, streams)
        recording = stage.folder / "same.mcap"
        corrections = []
        with multiprocessing.Pool(1) as pool:
            read = pool.apply_async(read_for, ([found[name] for name in streams], seconds + 3))
            com = Feed(found["footing-sim/characters/1/com"])
            recorder = threading.Thread(target=lambda: stage.run_json(
                "footing-log", "record", "--connect", stage.sensor, "--out", recording, "--seconds", seconds,
                timeout_s=seconds + 60))
            recorder.start()
            while recorder.is_alive():
                corrections.append(abs(time_correction(found[streams[0]])[0]))
                time.sleep(0.5)
            lags = [came - stamp for came, stamp, _ in com.end()]
            samples = read.get(seconds + 60)
        total = 0
        for name in streams:
            kind, role = name.split("/")[1:]
            rows = [row for row in rows_of(stage, recording, f"footingd_{kind}.csv") if row["device_role"] == role]
            total += same_samples(name, samples[name], rows, "sampled_ns", labels(found[name])[0])
        lag, lag99, _ = quantiles(lags)
        error, _, worst = quantiles(corrections)
        print(f"{len(streams)} devices, {seconds:.0f} s: {total} samples, none lost; {len(lags)} of the COM, from the tick p50 "
              f"{1e3 * lag:.2f} ms, p99 {1e3 * lag99:.2f} ms; {len(corrections)} time corrections, error p50 "
              f"{1e6 * error:.1f} us, most {1e6 * worst:.1f} us")
        assert stage.stop("lsl") == 0


if __name__ == "__main__":
    measure(float(sys.argv[3])) if len(sys.argv) > 3 else main()
