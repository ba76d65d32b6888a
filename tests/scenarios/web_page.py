"""The pages of footing-web. Without a browser: files and refusals, roles and tokens, servers that come back, a page that
does not read, many pages at once. In headless Chromium, where there is one: the live page at three sizes, and two phones
whose motion makes the character walk.

Usage: web_page.py BINARY_FOLDER (http|crowd|live|phones) [PICTURE_FOLDER]
       web_page.py BINARY_FOLDER foxglove NODE_FOLDER
"""
import concurrent.futures
import gzip
import http.client
import json
import math
import os
import pathlib
import re
import shutil
import socket
import ssl
import struct
import subprocess
import sys
import time

import browser
import decode_stream
import harness
import outside_readers
from decode_stream import bytes_field, number_field
from ports import free_port

VIEW, CONTROL = 1, 3
LATEST = 1


def skip(why):
    print(f"skipped: {why}")
    sys.exit(77)


class WebSocket:
    """A page's side of a WebSocket (RFC 6455), without a library."""

    def __init__(self, port, path, origin=None, cookie=None, host=None, trusting=None, protocol=None):
        self.stream = socket.create_connection(("127.0.0.1", port), timeout=20)
        host, scheme = host or f"127.0.0.1:{port}", "http://"
        if trusting:
            self.stream, scheme = trusting.wrap_socket(self.stream), "https://"
        lines = [f"GET {path} HTTP/1.1", f"Host: {host}", f"Origin: {origin or scheme + host}", "Upgrade: websocket",
                 "Connection: Upgrade", "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==", "Sec-WebSocket-Version: 13"]
        lines += [f"Cookie: {cookie}"] if cookie else []
        lines += [f"Sec-WebSocket-Protocol: {protocol}"] if protocol else []
        self.stream.sendall(("\r\n".join(lines) + "\r\n\r\n").encode())
        self.bytes = b""
        while b"\r\n\r\n" not in self.bytes:
            got = self.stream.recv(4096)
            assert got, "closed in the middle of the handshake"
            self.bytes += got
        head, self.bytes = self.bytes.split(b"\r\n\r\n", 1)
        self.status = int(head.split()[1])
        self.head = head.decode()

    def close(self):
        self.stream.close()

    def send(self, payload, opcode=2):
        size = len(payload)
        length = bytes([0x80 | size]) if size < 126 else bytes([0x80 | 126]) + struct.pack(">H", size)
        self.stream.sendall(bytes([0x80 | opcode]) + length + b"\0\0\0\0" + payload)

    def _exactly(self, size):
        while len(self.bytes) < size:
            got = self.stream.recv(1 << 16)
            if not got:
                return None
            self.bytes += got
        part, self.bytes = self.bytes[:size], self.bytes[size:]
        return part

    def receive(self):
        """A message's bytes, perhaps of several frames; ("closed", reason) at the end."""
        parts = b""
        while True:
            head = self._exactly(2)
            if head is None:
                return ("closed", "")
            size = head[1] & 0x7f
            if size == 126:
                size = struct.unpack(">H", self._exactly(2))[0]
            elif size == 127:
                size = struct.unpack(">Q", self._exactly(8))[0]
            payload = self._exactly(size)
            opcode = head[0] & 0x0f
            if opcode == 8:
                return ("closed", payload[2:].decode())
            if opcode == 9:
                self.send(payload, 10)
            elif opcode in (0, 1, 2):
                parts += payload
                if head[0] & 0x80:
                    return parts

    def message(self):
        """The next message, decoded; pings are answered."""
        while True:
            payload = self.receive()
            if isinstance(payload, tuple):
                return {"closed": payload[1]}
            message = decode_stream.decode("envelope", payload)
            if "ping" not in message:
                return message
            now = time.monotonic_ns()
            values = (message["ping"].get("id", 0), message["ping"].get("t0_ns", 0), now, now)
            self.say(7, b"".join(number_field(i + 1, value) for i, value in enumerate(values)))

    def until(self, *names):
        while True:
            message = self.message()
            if "closed" in message or any(name in message for name in names):
                return message

    def say(self, number, message):
        self.send(bytes_field(number, message))

    def hello(self, role=VIEW, token=""):
        self.say(1, number_field(1, 1) + number_field(3, role) + (bytes_field(4, token.encode()) if token else b""))

    def subscribe(self, *channels, max_hz=0.0):
        wish = b"".join(bytes_field(1, name.encode()) for name in channels)
        self.say(4, wish + b"\x11" + struct.pack("<d", max_hz) + number_field(3, LATEST))


def serve(stage, *words, listen="tcp:127.0.0.1", name="web"):
    """footing-web on a free port; the port, and what it printed."""
    port = free_port()
    stage.start("footing-web", "--listen", f"{listen}:{port}", "--connect", stage.simulation, "--connect", stage.sensor,
                "--devices", stage.devices, "--json", *words, name=name)
    log = stage.folder / f"{name}.log"
    printed = stage.wait_for(lambda: [line for line in log.read_text().splitlines(True) if line.startswith("{") and line.endswith("\n")],
                             "footing-web")
    return port, json.loads(printed[0])


def ask(port, target, method="GET", body=None, **headers):
    connection = http.client.HTTPConnection("127.0.0.1", port, timeout=10)
    connection.putrequest(method, target, skip_host=True, skip_accept_encoding=True)
    for key, value in {"Host": f"127.0.0.1:{port}", **headers}.items():
        connection.putheader(key.replace("_", "-"), value)
    if body is not None:
        connection.putheader("Content-Length", str(len(body)))
    connection.endheaders(body)
    answer = connection.getresponse()
    content = answer.read()
    if answer.headers.get("Content-Encoding") == "gzip":
        content = gzip.decompress(content)
    return answer.status, content.decode(errors="replace"), answer.headers


def check_files(stage):
    stage.start("footingd", "--listen", stage.sensor, "--source", f"stream:{stage.devices}")
    stage.wait_for_socket(stage.devices)
    port, printed = serve(stage)
    status, text, headers = ask(port, "/")
    assert status == 200 and "live.js" in text and headers["Content-Type"].startswith("text/html"), (status, text)
    assert "http:" not in headers["Content-Security-Policy"], "nothing from another host"
    assert ask(port, "/", If_None_Match=headers["ETag"])[0] == 304
    sizes = {}
    for name, page in (("live.js", "/"), ("phone.js", "/phone")):
        todo, seen = [name, "style.css", "icon.svg"], set()
        sizes[page] = int(ask(port, page)[2]["Content-Length"])
        while todo:
            file = todo.pop()
            if file in seen:
                continue
            seen.add(file)
            status, text, headers = ask(port, "/" + file)
            assert status == 200, file
            assert set(re.findall(r"https?://[^/\"' ]+", text)) <= {"http://www.w3.org"}, f"{file} names another host"
            sizes[page] += int(headers["Content-Length"])
            todo += [line.split("'./")[1].split("'")[0] for line in text.splitlines() if " from './" in line]
    print(f"first load, compressed bytes: {sizes}")
    assert sizes["/"] <= 200_000 and sizes["/phone"] <= 20_000, sizes
    for target in ("/../secret", "/%2e%2e/secret", "/none.js", "/page_files.cc", "/session/0"):
        assert ask(port, target)[0] == 404, target
    assert ask(port, "/", Host="attacker.example")[0] == 403
    assert ask(port, "/", Host=f"localhost:{port}")[0] == 200
    assert ask(port, "/", method="DELETE")[0] == 405
    about = json.loads(ask(port, "/about.json")[1])
    assert about["servers"] == 2 and about["may_view"] and not about["may_attach"], about
    check_codes(port, printed["phone"].split("#")[1])


def check_codes(port, code):
    own = {"Origin": f"http://127.0.0.1:{port}"}
    assert ask(port, "/enter", "POST", code.encode(), Origin="http://attacker.example")[0] == 403
    assert ask(port, "/enter", "POST", b"wrong", **own)[0] == 403
    assert ask(port, "/enter", "POST", b"x" * 100_000, **own)[0] == 400, "longer than any code"
    assert WebSocket(port, "/devices").status == 403
    status, _, headers = ask(port, "/enter", "POST", code.encode(), **own)
    assert status == 204 and "HttpOnly" in headers["Set-Cookie"] and "SameSite=Strict" in headers["Set-Cookie"], status
    cookie = headers["Set-Cookie"].split(";")[0]
    assert ask(port, "/enter", "POST", code.encode(), **own)[0] == 403, "a code is for one browser"
    assert json.loads(ask(port, "/about.json", Cookie=cookie)[1])["may_attach"]
    page = WebSocket(port, "/devices", cookie=cookie)
    assert page.status == 101
    # A Wiimote: what a page may attach is an inertial sensor.
    page.send(bytes_field(1, number_field(3, 0x057e) + number_field(4, 0x0306) + bytes_field(6, b"1")))
    assert "inertial sensor only" in page.receive()[1]
    check_requests(port, cookie, own)
    for origin, path, expected in ((None, "/session/0", 101), ("http://attacker.example", "/session/0", 403),
                                   (None, "/session/9", 404)):
        assert WebSocket(port, path, origin=origin).status == expected, (origin, path)
    assert WebSocket(port, "/session/0", host="attacker.example").status == 403


def check_requests(port, cookie, own):
    """Without a WebSocket: a connection that is new attaches first, so the page of one that is gone does it again."""
    def post(message):
        return ask(port, "/devices", "POST", struct.pack("<I", len(message)) + message, Cookie=cookie, **own)[:2]

    status, text = post(bytes_field(2, number_field(1, 0)))
    assert status == 400 and "attach the sensor again" in text, (status, text)
    attach = number_field(3, 0xf007) + number_field(4, 1) + bytes_field(6, b"phone-1")
    assert post(bytes_field(1, attach))[0] == 200
    assert post(bytes_field(5, b""))[0] == 200


def check_tls(stage):
    """Beyond this host: TLS, and nothing is shown without a code."""
    done = stage.run("footing-web", "--listen", "tcp:0.0.0.0:0")
    assert done.returncode == 2 and "tls:" in done.stderr, done
    port, printed = serve(stage, "--identity-file", stage.folder / "identity.pem", listen="tls:127.0.0.1")
    assert printed["page"].startswith(f"https://127.0.0.1:{port}/#"), printed
    status, text, _ = ask(port, "/")
    assert status == 400 and "https" in text, "in clear"
    trusting = ssl.create_default_context()
    trusting.check_hostname, trusting.verify_mode = False, ssl.CERT_NONE
    own = {"Host": f"127.0.0.1:{port}", "Origin": f"https://127.0.0.1:{port}"}
    connection = http.client.HTTPSConnection("127.0.0.1", port, timeout=10, context=trusting)

    def over_tls(method, target, body=None, **headers):
        connection.request(method, target, body, {**own, **headers})
        answer = connection.getresponse()
        return answer.status, answer.read(), answer.headers

    assert over_tls("GET", "/")[0] == 200
    assert not json.loads(over_tls("GET", "/about.json")[1])["may_view"]
    status, _, headers = over_tls("POST", "/enter", printed["page"].split("#")[1])
    assert status == 204 and "Secure" in headers["Set-Cookie"], status
    cookie = headers["Set-Cookie"].split(";")[0]
    assert WebSocket(port, "/session/0", trusting=trusting).status == 403
    page = WebSocket(port, "/session/0", cookie=cookie, trusting=trusting)
    assert page.status == 101
    page.hello()
    assert "no such file" in page.until("welcome")["closed"]
    about = json.loads(over_tls("GET", "/about.json", Cookie=cookie)[1])
    assert about["may_view"] and not about["may_attach"], about
    about = json.loads(over_tls("GET", "/about.json", Cookie="footing_pass=of-an-earlier-start")[1])
    assert "needs a new code" in about["needs_code"] and not about["may_view"], about
    assert over_tls("GET", "/footing.crt")[1].startswith(b"-----BEGIN CERTIFICATE-----"), "for devices that shall trust it"
    assert "the certificate" not in (stage.folder / "web.log").read_text(), "its own one is known by its fingerprint"
    stage.stop("web")
    kept = stage.folder / "web_passes"
    assert kept.stat().st_mode & 0o777 == 0o600 and cookie.split("=")[1] not in kept.read_text(), kept.read_text()
    port, _ = serve(stage, "--identity-file", stage.folder / "identity.pem", listen="tls:127.0.0.1")
    page = WebSocket(port, "/session/0", cookie=cookie, trusting=trusting)
    assert page.status == 101, "its pass outlives a restart"
    page.close()
    stage.stop("web")
    kept.chmod(0o644)
    port, _ = serve(stage, "--identity-file", stage.folder / "identity.pem", listen="tls:127.0.0.1")
    assert WebSocket(port, "/session/0", cookie=cookie, trusting=trusting).status == 403
    assert "chmod 600" in (stage.folder / "web.log").read_text()
    kept.unlink()
    check_every_address(stage)
    check_certificate(stage)


def check_every_address(stage):
    """No browser can open 0.0.0.0: what is printed has an address of this host, or the name that was given."""
    port, printed = serve(stage, "--identity-file", stage.folder / "identity.pem", listen="tls:0.0.0.0", name="every")
    host = re.fullmatch(rf"https://([0-9.]+):{port}/phone#\w+", printed["phone"]).group(1)
    said = (stage.folder / "every.log").read_text()
    if host == "0.0.0.0":
        assert "this one is in no network; name its address with --host-name" in said, said
    else:
        assert f"name {host}; --host-name names another address" in said, said
        socket.create_connection((host, port), timeout=5).close()
    stage.stop("every")
    port, printed = serve(stage, "--identity-file", stage.folder / "identity.pem", "--host-name", "lab.example",
                          listen="tls:0.0.0.0", name="named")
    assert printed["phone"].startswith(f"https://lab.example:{port}/phone#"), printed
    stage.stop("named")


def check_certificate(stage):
    """A certificate that is not for this host is a sentence in the log; one that is for it is none."""
    if not shutil.which("openssl"):
        return
    for address, warns in (("192.0.2.5", True), ("127.0.0.1", False)):
        key, certificate, both = (stage.folder / f"{address}.{name}" for name in ("key", "crt", "pem"))
        subprocess.run(["openssl", "req", "-x509", "-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:P-256", "-nodes", "-days", "800",
                        "-subj", "/CN=Footing", "-addext", f"subjectAltName=IP:{address}", "-keyout", key, "-out", certificate],
                       check=True, stderr=subprocess.DEVNULL)
        both.touch(0o600)
        both.write_bytes(key.read_bytes() + certificate.read_bytes())
        serve(stage, "--identity-file", both, listen="tls:127.0.0.1", name=address)
        said = "the certificate is not for 127.0.0.1" in (stage.folder / f"{address}.log").read_text()
        assert said == warns, (stage.folder / f"{address}.log").read_text()


def check_roles(stage):
    token = stage.folder / "token"
    token.write_text("0123456789abcdef0123\n")
    token.chmod(0o600)
    port, _ = serve(stage, "--token-file", token)
    page = WebSocket(port, "/session/0")
    page.hello(CONTROL)
    assert "no such file" in page.until("welcome")["closed"], "no server yet"
    stage.start_servers()
    page = WebSocket(port, "/session/0")
    page.hello(CONTROL)
    assert page.until("welcome")["welcome"]["granted_role"] == VIEW, "read only without the token"
    began = time.monotonic()
    for _ in range(6):
        page = WebSocket(port, "/session/0")
        page.hello(CONTROL, "not the token of the file")
        assert "token is wrong" in page.until("welcome")["closed"]
    assert time.monotonic() - began > 1.9, "whoever guesses waits"
    page = WebSocket(port, "/session/0")
    page.hello(CONTROL, "0123456789abcdef0123")
    assert page.until("welcome")["welcome"]["granted_role"] == CONTROL
    page = WebSocket(port, "/session/0")
    page.send(b"no message")
    assert "Hello" in page.until("welcome")["closed"]
    check_restart(stage, port)


def check_restart(stage, port):
    """A page that reads hears of the server's end, and one that does not read holds nobody up."""
    stuck = WebSocket(port, "/session/0")
    stuck.hello()
    stuck.subscribe("characters")
    page = WebSocket(port, "/session/0")
    page.hello()
    page.subscribe("characters", "skeletons")
    ticks = [page.until("tick")["tick"] for _ in range(200)]
    assert sum("characters" in tick for tick in ticks) > 150, "ticks arrive while another page does not read"
    assert stage.stop("footing-sim") == 0
    closed = page.until("goodbye")
    assert "stopped" in closed.get("goodbye", {}).get("reason", "") or "closed" in closed, closed
    stage.start("footing-sim", "--sensor", stage.sensor, "--listen", stage.simulation)
    stage.wait_for_socket(stage.simulation)
    page = WebSocket(port, "/session/0")
    page.hello()
    page.subscribe("characters")
    assert "tick" in page.until("tick")


def check_foxglove(stage):
    """Programs of this host that know Foxglove's protocol get the scene; pages of others only by name."""
    names = "other, foxglove.websocket.v1"
    stage.start_servers()
    port, _ = serve(stage)
    assert WebSocket(port, "/", protocol=names).status == 403, "off by default"
    port, _ = serve(stage, "--foxglove", "--origin", "https://app.foxglove.dev", name="foxglove")
    assert WebSocket(port, "/", "https://elsewhere.example", protocol=names).status == 403
    assert "--origin https://elsewhere.example" in (stage.folder / "foxglove.log").read_text()
    assert WebSocket(port, "/", "https://app.foxglove.dev").status == 403, "that origin has no other right"
    page = WebSocket(port, "/", "https://app.foxglove.dev", protocol=names)
    assert page.status == 101 and "Sec-WebSocket-Protocol: foxglove.websocket.v1" in page.head, page.head
    assert json.loads(page.receive())["op"] == "serverInfo"
    topics = {}
    while "/foxglove/footing-sim/body" not in topics:
        said = json.loads(page.receive())
        topics |= {channel["topic"]: channel["id"] for channel in said["channels"]}
    wish = [{"id": 7, "channelId": topics["/foxglove/footing-sim/transforms"]}]
    page.send(json.dumps({"op": "subscribe", "subscriptions": wish}).encode(), 1)
    times = []
    while len(times) < 30:
        data = page.receive()
        if data[:1] == b"{":
            continue
        kind, subscription, time_ns = struct.unpack_from("<BIQ", data)
        assert (kind, subscription) == (1, 7), data[:5]
        times.append(time_ns)
    assert all(b > a for a, b in zip(times, times[1:])), "times rise"
    page.send(b"no JSON", 1)
    while not isinstance(page.receive(), tuple):
        pass
    check_foxglove_client(port)


def check_foxglove_client(port):
    """Foxglove's own client, where npm can be had."""
    try:
        folder = outside_readers.node_folder(sys.argv[3])
    except outside_readers.NoNode as why:
        print(f"note: without Foxglove's own client: {why}")
        return
    topics = [f"/foxglove/footing-sim/{name}" for name in ("transforms", "body", "track", "forces", "joints")]
    followed = outside_readers.run_node(folder, "follow_foxglove.mjs", f"ws://127.0.0.1:{port}", *topics)
    assert followed[topics[0]]["schema"] == "foxglove.FrameTransforms", followed


def cpu_s(process):
    fields = pathlib.Path(f"/proc/{process.pid}/stat").read_text().rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def check_crowd(stage, pages=50, seconds=5):
    stage.start_servers()
    stage.start_user("walk")
    port, _ = serve(stage)

    def watch(number):
        page = WebSocket(port, f"/session/{number % 2}")
        page.hello()
        page.subscribe(max_hz=30.0)
        assert "welcome" in page.until("welcome")
        deadline, ticks = time.monotonic() + seconds, 0
        while time.monotonic() < deadline:
            ticks += "tick" in page.message()
        page.close()
        return ticks

    began, cpu_began = time.monotonic(), cpu_s(stage.processes["web"])
    with concurrent.futures.ThreadPoolExecutor(2 * pages) as pool:
        # A page has a session with each server.
        counts = list(pool.map(watch, range(2 * pages)))
    spent = (cpu_s(stage.processes["web"]) - cpu_began) / (time.monotonic() - began)
    print(f"{pages} pages at 30 Hz: {spent:.3f} of a core, {sum(counts)} ticks, {min(counts)} to {max(counts)} each in {seconds} s")
    assert min(counts) > 0, counts
    # Connections that never say anything do not keep a page out.
    idle = [socket.create_connection(("127.0.0.1", port)) for _ in range(200)]
    assert ask(port, "/about.json")[0] == 200
    for one in idle:
        one.close()


def check_live(stage, pictures):
    port, _ = serve(stage)
    with browser.Browser() as chromium:
        page = chromium.open(f"http://127.0.0.1:{port}/?hz=30", 1280, 720)
        page.wait_for("document.getElementById('status').textContent.startsWith('No server')")
        stage.start_servers()
        stage.start_user("demo")
        began = time.monotonic()
        page.wait_for("window.footing().drawn > 0 && window.footing().frames > 0")
        print(f"first picture {time.monotonic() - began:.1f} s after the servers were started")
        page.wait_for("window.footing().devices === 2 && document.getElementById('devices').innerText.includes('left hand')")
        page.wait_for("/step|walk|run|jump/.test(document.getElementById('gait').textContent)")
        page.wait_for("!document.getElementById('simulated').hidden")
        check_picture(page)
        if pictures:
            page.wait_for("/walk|run/.test(document.getElementById('gait').textContent)")
        page.show_each_size(pictures, "web")
        check_controls(page)
        drawn, began = page.evaluate("window.footing().drawn"), time.monotonic()
        time.sleep(3)
        rate = (page.evaluate("window.footing().drawn") - drawn) / (time.monotonic() - began)
        print(f"{rate:.1f} pictures a second; {page.evaluate('JSON.stringify(window.footing())')}")
        assert stage.stop("footing-sim") == 0
        page.wait_for("/footing-sim is gone|No server/.test(document.getElementById('status').textContent)")
        stage.start("footing-sim", "--sensor", stage.sensor, "--listen", stage.simulation)
        page.wait_for("!/gone|No server/.test(document.getElementById('status').textContent)")
        assert not page.errors, page.errors


def check_picture(page):
    """The bird is in the middle of the picture: pixels there differ from those of the sky."""
    page.evaluate("document.getElementById('picture').scrollIntoView()")
    colours = page.evaluate("""new Promise(done => requestAnimationFrame(() => {
        const canvas = document.getElementById('picture'), copy = document.createElement('canvas');
        Object.assign(copy, { width: 64, height: 64 });
        copy.getContext('2d').drawImage(canvas, 0, 0, 64, 64);
        const bytes = copy.getContext('2d').getImageData(0, 0, 64, 64).data, seen = new Set();
        for (let i = 0; i < bytes.length; i += 4) seen.add((bytes[i] >> 5) + ',' + (bytes[i + 1] >> 5) + ',' + (bytes[i + 2] >> 5));
        done(seen.size);
    }))""")
    assert colours >= 6, f"{colours} colours"


def check_controls(page):
    page.evaluate("document.getElementById('picture').focus()")
    for key in ("ArrowLeft", "+", "r"):
        page.send("Input.dispatchKeyEvent", type="keyDown", key=key)
        page.send("Input.dispatchKeyEvent", type="keyUp", key=key)
    page.evaluate("(() => { const past = document.getElementById('past'); past.value = -1; past.oninput({ target: past }); })()")
    assert page.evaluate("document.getElementById('past-text').textContent") == "1.0 s ago"
    page.wait_for("document.getElementById('status').textContent.startsWith('Not live')")
    page.evaluate("document.getElementById('live').click()")
    assert page.evaluate("document.getElementById('past-text').textContent") == "now"
    for name in ("status", "prompt"):
        assert page.evaluate(f"document.getElementById('{name}').getAttribute('aria-live')") == "polite"


class Phone:
    """A phone's page whose sensors a test moves. A hand swings the phone about its left-right axis."""

    def __init__(self, chromium, address, role, pictures=None):
        self.page = chromium.open(address, 390, 844)
        self.page.wait_for("document.getElementById('start').onclick !== null")
        self.page.show_each_size(pictures, "controller-start")
        self.page.show(390, 844)
        for kind in ("accelerometer", "linear-acceleration", "gyroscope", "relative-orientation"):
            self.page.send("Emulation.setSensorOverrideEnabled", enabled=True, type=kind,
                           metadata={"available": True, "minimumFrequency": 1, "maximumFrequency": 60})
        self.page.send("Emulation.setSensorOverrideReadings", type="relative-orientation",
                       reading={"quaternion": {"x": 0, "y": 0, "z": 0, "w": 1}})
        self.feel(0, 0)
        self.page.evaluate(f"document.querySelector('input[name=\"role\"][value=\"{role}\"]').click()", gesture=True)
        self.page.evaluate("document.getElementById('start').click()", gesture=True)

    def feel(self, ahead_mps2, rate_radps):
        for kind, x, y, z in (("accelerometer", 0, ahead_mps2, 9.8), ("linear-acceleration", 0, ahead_mps2, 0),
                              ("gyroscope", rate_radps, 0, 0)):
            self.page.send("Emulation.setSensorOverrideReadings", type=kind, reading={"xyz": {"x": x, "y": y, "z": z}})


def check_phones(stage, pictures):
    stage.start_servers()
    port, printed = serve(stage)
    second = serve(stage, "--identity-file", stage.folder / "identity.pem", listen="tls:127.0.0.1", name="web2")
    with browser.Browser("--ignore-certificate-errors") as chromium:
        # Each of the two has a browser's storage of its own, since another port is another origin. The second one is
        # served over TLS, as real phones are, and sends requests, as iOS may have to.
        left = Phone(chromium, printed["phone"].replace("/phone", "/phone?simulated"), 1, pictures)
        right = Phone(chromium, second[1]["phone"].replace("/phone", "/phone?simulated&post"), 2)
        began = time.monotonic()
        devices = stage.wait_for_devices()
        assert {one["role"] for one in devices} == {"left_hand", "right_hand"}, devices
        for phone in (left, right):
            phone.page.wait_for("window.footing().signKnown && !window.footing().inverted")
        walking = swing_until_walking(stage, left, right)
        print(f"walking {walking - began:.1f} s after two taps; samples lost: "
              f"{[phone.page.evaluate('window.footing().lost') for phone in (left, right)]}")
        right.page.show_each_size(pictures, "controller")
        left.page.evaluate("document.getElementById('stop').click()", gesture=True)
        stage.wait_for(lambda: "lost" in [one["state"] for one in devices_of(stage)], "a stop that detaches the phone")
        assert not left.page.errors + right.page.errors


def devices_of(stage):
    return json.loads(stage.run("footing-ctl", "--connect", stage.sensor, "devices", "--json").stdout)["devices"]


def swing_until_walking(stage, left, right, hz=1.1, timeout_s=60):
    """Hands that alternate until the character walks; returns when it does."""
    stream = decode_stream.Stream(stage.simulation, timeout_s)
    stream.send(1, number_field(1, 1) + number_field(3, 1))
    stream.send(4, bytes_field(1, b"characters") + number_field(3, LATEST))
    began = time.monotonic()
    while time.monotonic() < began + timeout_s:
        phase = 2 * math.pi * hz * (time.monotonic() - began)
        for phone, sign in ((left, 1), (right, -1)):
            phone.feel(sign * 6 * math.sin(phase), 0)
        message = stream.receive()
        while "tick" not in message:
            if "ping" in message:
                now = time.monotonic_ns()
                stream.send(7, b"".join(number_field(i + 1, value) for i, value in
                                        enumerate((message["ping"].get("id", 0), message["ping"].get("t0_ns", 0), now, now))))
            message = stream.receive()
        for character in message["tick"].get("characters", {}).get("characters", []):
            if character.get("gait", {}).get("gait") == 2:
                return time.monotonic()
    raise AssertionError(f"the character does not walk: {devices_of(stage)}")


def main():
    part, pictures = sys.argv[2], sys.argv[3] if len(sys.argv) > 3 else None
    if part in ("live", "phones") and not browser.is_there():
        skip("chromium is missing; scripts/dependencies-web.txt lists what this test needs")
    checks = {"http": (check_files, check_tls, check_roles), "foxglove": (check_foxglove,), "crowd": (check_crowd,), "live": (lambda stage: check_live(stage, pictures),),
              "phones": (lambda stage: check_phones(stage, pictures),)}
    for check in checks[part]:
        with harness.Stage(sys.argv[1]) as stage:
            check(stage)


if __name__ == "__main__":
    main()
