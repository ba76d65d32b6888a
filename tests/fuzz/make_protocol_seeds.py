"""Seeds of the fuzz targets of the protocol and of config files; make_seeds.py writes them."""
import pathlib
import random
import re
import struct

PROTOCOL = pathlib.Path(__file__).parents[2] / "docs" / "protocol.md"
RAW, GREET, SUBSCRIBE, PUBLISH, RUN, LOOK, ANSWER_ONE, TELL = 0, 3, 4, 5, 6, 7, 8, 9
REFILL_TAG = b"\x5a"  # Field 11 of Envelope.
WELCOME, ANSWER, COMMAND = 3, 4, 6


def string(data: bytes) -> bytes:
    return bytes([len(data)]) + data


def examples() -> list[tuple[str, bytes]]:
    """Name and bytes of every frame in the protocol's page."""
    found = []
    for text in re.findall(r"```frame\n(.*?)\n```", PROTOCOL.read_text(), re.S):
        lines = text.splitlines()
        data = bytes.fromhex("".join(line.split("#")[0] for line in lines))
        found.append((lines[1].split("#")[1].split(",")[0].strip(), data))
    return found


def raw(data: bytes) -> bytes:
    return b"".join(bytes([RAW]) + string(data[i:i + 255]) for i in range(0, len(data), 255))


def refill(first: int, last: int) -> bytes:
    varint = lambda n: bytes([n & 0x7F | 0x80, n >> 7])
    body = b"\x08" + varint(first) + b"\x10" + varint(last)
    body = REFILL_TAG + bytes([len(body)]) + body
    return struct.pack("<I", len(body)) + body


def sessions() -> dict[str, bytes]:
    begun = bytes([GREET, 4, SUBSCRIBE, 2])
    seeds = {f"session/{name}": b"\x02" + begun + raw(data) + bytes([PUBLISH, 5, 7, LOOK])
             for name, data in examples()}
    hello = dict(examples())["hello"]
    seeds["session/quiet"] = b"\x00" + raw(hello) + bytes([RUN, 150, LOOK])
    seeds["session/never_hello"] = b"\x00" + bytes([RUN, 50, LOOK])
    seeds["session/token"] = b"\x15" + bytes([GREET, 64 + 128 + 3, SUBSCRIBE, 2, LOOK])
    seeds["session/wrong_token"] = b"\x15" + bytes([GREET, 64 + 3, LOOK])
    seeds["session/no_token"] = b"\x11" + bytes([GREET, 3, LOOK])
    wish = lambda how: bytes([SUBSCRIBE, how])
    command = dict(examples())["command"]
    seeds["session/refused_at_once"] = b"\xe0" + bytes([LOOK])
    seeds["session/not_protobuf"] = b"\x00" + raw(struct.pack("<I", 3) + b"\xff\xff\xff") + bytes([LOOK])
    seeds["session/no_hello"] = b"\x00" + raw(command) + bytes([LOOK])
    seeds["session/unknown"] = b"\x02" + begun + raw(struct.pack("<I", 3) + b"\xfa\x7f\x00") + bytes([LOOK])
    seeds["session/command_twice"] = b"\x02" + begun + raw(command * 2) + bytes([LOOK, ANSWER_ONE, 1]) + raw(
        command) + bytes([LOOK])
    seeds["session/command_of_viewer"] = b"\x02" + bytes([GREET, 1]) + raw(command) + bytes([LOOK])
    seeds["session/latest"] = b"\x02" + bytes([GREET, 1]) + wish(1) + bytes([PUBLISH, 31, 255]) * 10 + bytes([LOOK])
    seeds["session/drop_oldest"] = b"\x02" + bytes([GREET, 1]) + wish(2) + bytes([PUBLISH, 31, 255]) * 40 + bytes([LOOK] * 9)
    seeds["session/passed"] = b"\x02" + bytes([GREET, 1]) + bytes([PUBLISH, 31, 7]) * 8 + wish(34) + bytes([1, 0]) + bytes(
        [RUN, 20, LOOK]) + wish(2) + raw(refill(1, 250)) + bytes([RUN, 20, LOOK])
    seeds["session/refills"] = b"\x02" + begun + bytes([PUBLISH, 31, 6]) + b"".join(
        raw(refill(i, i + 3)) for i in range(1, 40)) + bytes([RUN, 20, LOOK])
    seeds["session/drained"] = b"\x02" + begun + bytes([PUBLISH, 31, 7, TELL, 1, RUN, 20, LOOK])
    seeds["session/resume"] = b"\x02" + bytes([GREET, 1, PUBLISH, 31, 6, SUBSCRIBE, 34, 3, 0, PUBLISH, 31, 6,
                                              LOOK, RUN, 20, LOOK])
    seeds["session/other_epoch"] = b"\x02" + bytes([GREET, 1, PUBLISH, 9, 7, SUBSCRIBE, 35, 3, 1, LOOK])
    seeds["session/slow_reliable"] = b"\x02" + bytes([GREET, 1, SUBSCRIBE, 3]) + bytes([PUBLISH, 31, 255]) * 40
    return seeds


def admissions() -> dict[str, bytes]:
    """Settings, then steps: below 40 a wait, below 80 an end, else a caller and a Hello."""
    ask, leave, wait = 255, 79, 39
    own, member, tcp, tls, certificate = 0, 20, 1, 2, 3
    no_token, right, wrong = 0, 24, 8
    view, log, control, admin = 2, 3, 4, 5
    def asks(caller: int, how: int, guess: bytes = b"") -> bytes:
        return bytes([ask, caller, how]) + (string(guess) if how & wrong and not how & 16 else b"")
    token_and_certificates = 1 | 4 | 16 | 192
    everybody = b"".join(asks(caller, how | role, b"guess") for caller in (own, member, 4, tcp, tls, certificate)
                         for how in (no_token, right, wrong) for role in (view, log, control, admin))
    seeds = {f"admission/everybody_{how}": bytes([how]) + everybody + bytes([leave, leave, leave]) * 9 + everybody
             for how in (0, 1 | 4 | 16, 2, 3 | 4 | 16, token_and_certificates, 4 | 64)}
    guesses = asks(tls, wrong | view, b"0123456789abcdeX")
    seeds["admission/guesses"] = b"\x01" + guesses * 7 + asks(tls, right | view) + bytes([wait]) + guesses * 3 + asks(
        tls, right | view)
    seeds["admission/version"] = b"\x01" + asks(own, 128 | view) + bytes([ask, own, 64 | view]) + string(b"a\x1b\n")
    seeds["admission/no_such_role"] = b"\x01" + asks(own, 0) + asks(own, 6) + asks(own, 1)
    return seeds


def clients() -> dict[str, bytes]:
    begun = bytes([WELCOME, 3, ANSWER, ANSWER])
    seeds = {f"client/{name}": b"\x00" + begun + raw(data) + bytes([COMMAND, 5, RUN - 1, 20])
             for name, data in examples()}
    seeds["client/stale"] = b"\x02" + begun + bytes([5, 40, 5, 100, 5, 20]) + begun
    seeds["client/resumes"] = b"\x00" + begun + raw(dict(examples())["tick"]) + bytes([5, 1, 8]) + begun + bytes([5, 1, 7, 1, 2])
    seeds["client/stops"] = b"\x00" + bytes([9, 1]) + begun
    seeds["client/stops_at_tick"] = b"\x00" + begun + bytes([9, 2]) + raw(dict(examples())["tick"]) + bytes([5, 1])
    seeds["client/reconnects"] = b"\x00" + begun + bytes([COMMAND, 9, 8]) + begun + bytes([8]) + begun
    return seeds


def messages() -> dict[str, bytes]:
    """Any bytes make fields; how these come to be is what counts."""
    source = random.Random(16)
    return {f"wire/{kind:02}": bytes([kind, 0]) + source.randbytes(700) for kind in range(39)}


def field(number: int, kind: int, value: bytes) -> bytes:
    return bytes([number << 3 | kind]) + value


def fields(count: int, *filled: bytes) -> bytes:
    """A message as message.h fills it: how many fields, then each by its index."""
    return bytes([count]) + b"".join(filled)


def filled_messages() -> dict[str, bytes]:
    """Messages with others inside, which random bytes hardly make; kinds as in the table of wire.cc."""
    numbers = bytes([0, 200]) * 30
    pair = fields(5, *(bytes([i]) + bytes([0, 7]) for i in range(5)))
    stats = fields(12, *(bytes([i % 15]) + bytes([0, 3]) for i in range(12)))
    digest = string(bytes(range(32)))
    data = fields(2, bytes([0]) + string(b"a"), bytes([1]) + digest)
    short = fields(2, bytes([0]) + string(b"a"), bytes([1]) + string(b"ab"))
    tensor = lambda shape, values, name=b"w": fields(3, bytes([0]) + string(name), bytes([1, len(shape) - 1]) + b"".join(
        bytes([0, n]) for n in shape), bytes([2, values - 1]) + bytes([0, 200]) * values)
    def model(training: bytes, *tensors: bytes, kind: bytes = b"k") -> bytes:
        source = fields(5, bytes([0]) + string(b"1"), bytes([1]) + string(b"c"), bytes([2, 0, 7]), bytes([3, 0]) + training,
                        bytes([4, 0]) + string(b"s"))
        return fields(3, bytes([0]) + string(kind), bytes([2]) + source, bytes([3, len(tensors) - 1]) + b"".join(tensors))
    of_kind = {
        "pairs": (3, fields(1, bytes([2, 1]) + pair * 2)),
        "server": (17, fields(2, bytes([9, 1]) + stats * 2, bytes([10, 1]) + stats * 2)),
        "model": (37, model(data, tensor([2, 3], 6), tensor([4], 4, b"v"))),
        "model_digest": (37, model(short, tensor([2], 2))),
        "model_shape": (37, model(data, tensor([2, 3], 5))),
    }
    return {f"wire/{name}": bytes([kind, 0]) + message + numbers for name, (kind, message) in of_kind.items()} | {
        "wire/not_ascii": bytes([0, 1]) + field(2, 2, string("\u00e4\u20ac\U0001f600\u07ff".encode())),
        "wire/model_version": bytes([38, 0]) + b"\x10\x63",
        "wire/no_model": bytes([38, 0]) + b"\xff\xff",
        "wire/model_bytes": bytes([38, 0]) + field(1, 2, string(b"k")) + b"\x7a\x20" + bytes(32),
    }


def configs() -> dict[str, bytes]:
    text = ('// comment\n{"number": 1.5, "integer": 7, "flag": true, "text": "t", "list": ["a", "b"],\n'
            ' "map": {"k": "v"}}\n').encode()
    fingerprint = "sha256:" + "0123456789abcdef" * 4
    clients_file = f"# wall\n{fingerprint}  view  Ada at the wall screen\n{fingerprint[:-1]}1 log x\n"
    seeds = {
        "config/file": b"\x00\x00" + text,
        "config/settings": b"\x00" + string(string(b"text=x") + string(b"integer=3") + string(b"flag=maybe")
                                            + string(b"nothing") + string(b"no=1")) + text,
        "config/null": b"\x00\x00" + b'{"text": null, "number": null}',
        "config/deep": b"\x00\x00" + b'{"list": [["a"], null, 1.5, true], "map": {"k": {"l": 1}}}',
        "config/setting": b"\x00\x00text=x",
        "config/wrong": b"\x00\x00" + b'{"integer": 7.5}',
        "config/too_large": b"\x00\x00" + b'{"integer": 1e999}',
        "config/not_utf8": b"\x00" + string(string(b"integer=\xf3") + string(b"text=\xf3")) + b"{}",
        "config/unknown": b"\x00\x00" + b'{"integr": 7}',
        "config/not_json": b"\x00\x00" + b'{"integer": 7',
        "config/clients": b"\x02" + clients_file.encode(),
    }
    addresses = ["unix:/run/x.sock", "tcp:127.0.0.1:7450", "tls:[::1]:7450", "fd:sensor", "tcp:x", "udp:1:2", "unix:/" + 120 * "x", "unix:", "tcp:127.0.0.1:0x",
                 "tcp:127.0.0.1:99999", "fd:", ""]
    return seeds | {f"config/address_{i}": b"\x01" + a.encode() for i, a in enumerate(addresses)}


def devices() -> dict[str, bytes]:
    """Steps of tests/fuzz/device.cc: 0 plug, 1 pull, 2 pull the MotionPlus, 3 refuse, 4 lose, 9 wait, 10 go on."""
    on = bytes([10, 250])
    nunchuk, classic, motion_plus, unknown = (bytes([0, kind]) for kind in (1, 2, 3, 4))
    return {
        "device/plain": b"\x00" + on * 3 + bytes([7]) + on + bytes([8]) + on,
        "device/nunchuk": b"\x00" + on + nunchuk + on + bytes([1]) + on + unknown + on,
        "device/classic": b"\x04" + classic + on + bytes([1]) + on,
        "device/motion_plus": b"\x00" + motion_plus + on * 2 + nunchuk + on * 2 + bytes([1]) + on + classic + on
                              + bytes([2]) + on,
        "device/inside": b"\x02" + on * 2 + nunchuk + on * 2 + bytes([1]) + on * 2,
        "device/camera": b"\x09" + on + bytes([6, 0]) + on + bytes([22, 0]) + on,
        "device/refuses": b"\x01" + bytes([3, 7]) + on + nunchuk + bytes([3, 3]) + on * 2,
        "device/loses": b"\x00" + bytes([4, 3]) * 6 + on + nunchuk + bytes([4, 2]) * 6 + on + bytes([9, 200]) + on,
    }


def attachments() -> dict[str, bytes]:
    """Steps of tests/fuzz/attach.cc, of the first program; from 128 on of the second one."""
    attach, report, leave, run, answer = 3, 4, 5, 6, 7
    begun = bytes([attach, 0, report, 0]) + string(bytes([0x31, 0, 0, 0x80, 0x80, 0x80]))
    looked = bytes([answer, 2])
    seeds = {f"attach/{name}": begun + raw(data) + looked for name, data in examples()}
    return seeds | {
        "attach/many": b"".join(bytes([attach, slot, 128 + attach, slot]) for slot in range(20)) + looked,
        "attach/taken": bytes([attach, 200, report, 0]) + string(b"x") + bytes([attach, 0]) + looked,
        "attach/again": begun + bytes([leave, 0, attach, 0, leave, 32, attach, 0, attach, 0]) + looked,
        "attach/no_device": bytes([report, 3]) + string(b"x") + looked,
        "attach/silent": begun + bytes([run, 120, run, 120]) + looked,
        "attach/outputs": begun + bytes([answer, 4, answer, 5, answer, 7, answer, 4]) + looked,
        "attach/ends": begun + bytes([leave, 255, 128 + attach, 1]) + looked,
        "attach/not_protobuf": raw(struct.pack("<I", 3) + b"\xff\xff\xff") + looked,
        "attach/too_long": raw(struct.pack("<I", 2049)) + looked,
    }


def broker_streams() -> dict[str, bytes]:
    """What nats-server sends."""
    info = b'INFO {"server_id":"N","version":"2.9.10","max_payload":1048576,"auth_required":true}\r\n'
    header = b"NATS/1.0 503\r\n\r\n"
    texts = {
        "greeting": info + b"PING\r\nPONG\r\n+OK\r\n",
        "messages": b"MSG footing.a 1 3\r\nabc\r\nMSG footing.a 1 reply.x 0\r\n\r\n",
        "no_responders": b"HMSG a.b 7 %d %d\r\n" % (len(header), len(header)) + header + b"\r\n",
        "header": b"HMSG a 7 r 12 15\r\nNATS/1.0\r\n\r\nabc\r\n",
        "error": b"-ERR 'Authorization Violation'\r\n",
        "too_long": b"MSG a 1 513\r\n",
        "number": b"MSG a 1 -3\r\nMSG a x 3\r\n",
        "no_line": b"X" * 600,
        "bad_info": b"INFO {\r\n",
        "wrong_end": b"MSG a 1 3\r\nabcde",
    }
    return {f"nats/{name}": string(bytes([0, 3, 200])) + text for name, text in texts.items()}


def lsl_streams() -> dict[str, bytes]:
    """What other programs of the Lab Streaming Layer send: in front the stream's format and what comes."""
    query, datagram, request, info, feed, samples = range(6)
    elements = {"name": "B &amp; S", "type": "EEG", "channel_count": "8", "channel_format": "float32", "source_id": "",
                "nominal_srate": "100", "version": "1.1", "created_at": "5.5", "uid": "1", "session_id": "default",
                "hostname": "eeg", "v4address": "", "v4data_port": "16574", "v4service_port": "16575", "desc": "<desc>x</desc>"}
    stamp, texts = b"\x02" + struct.pack("<d", 1.5), b"\x01\x02ab\x01\x02\x01\x00c\x01\x04\x01\x00\x00\x00d\x01\x08\x01" + bytes(7) + b"e"
    found = {
        "query": (query, b"name='x' and (starts-with(type,\"E\") or not(contains(uid,'1'))) or channel_count >= 2.5"),
        "query_wrong": (query, b"desc/x = f('y') and (v4address != 'a' or uid < 1)"),
        "shortinfo": (datagram, b"LSL:shortinfo\r\ntype='EEG'\r\n16600 4711\r\n"),
        "timedata": (datagram, b"LSL:timedata\r\n7 10.5\r\n"),
        "time_answer": (datagram, b" 7 10.5 11 12"),
        "feed_request": (request, b"LSL:streamfeed/110 uid\r\nValue-Size: 8\r\nHas-IEEE754-Floats: 1\r\nData-Protocol-Version: 110\r\n\r\n"),
        "fullinfo": (request, b"LSL:fullinfo\r\n"),
        "shortinfo_tcp": (request, b"LSL:shortinfo\r\nname='name'\r\n"),
        "old": (request, b"LSL:streamfeed\r\n0 0\r\n"),
        "info": (info, ("<?xml version=\"1.0\"?>\n<info>" + "".join(
            f"<{k}>{v}</{k}>" if v else f"<{k} />" for k, v in elements.items()) + "</info>").encode()),
        "header": (feed, b"LSL/110 200 OK\r\nUID: uid\r\nByte-Order: 1234\r\nData-Protocol-Version: 110\r\n\r\n\x02"),
        "refusal": (feed, b"LSL/110 404 Not found\r\n"),
    }
    streams = {f"lsl/{name}": bytes([1, kind]) + data for name, (kind, data) in found.items()}
    for form, size in enumerate((4, 8, 0, 4, 2, 1, 8)):
        values = bytes(size)
        streams[f"lsl/samples_{form}"] = bytes([form, samples + 12]) + stamp + (values + b"\x01" + values if size else texts)
    return streams


def seeds() -> dict[str, bytes]:
    frames = b"".join(data for _, data in examples()[:1]) + struct.pack("<I", 301)
    return {
        "frames/pieces": string(bytes([1, 4, 9, 0])) + frames,
        "frames/tls": string(b"") + bytes([22, 3, 1, 0, 200, 1, 0, 0, 196]) + bytes(20),
        **devices(), **attachments(), **broker_streams(),
        **lsl_streams(), **admissions(), **sessions(), **clients(), **messages(), **filled_messages(), **configs(),
    }
