"""The page of footing-skeleton --web: its files and refusals over HTTP; the bones that it draws, where there is
node; and, where there are a browser and the npm package @mediapipe/pose, in headless Chromium: joints that the page
makes of a synthetic person reach footingd; the pose model loads from this host and runs on the frames of a generated
video, in which it finds nobody, and of a photograph, whose person's joints reach footingd.

Usage: skeleton_page.py BINARY_FOLDER (http|figure|synthetic|model|person)
"""
import http.client
import json
import math
import os
import pathlib
import shutil
import signal
import socket
import subprocess
import sys
import tempfile

import harness
from ports import free_port

PACKAGE = pathlib.Path(os.environ.get("XDG_DATA_HOME") or pathlib.Path.home() / ".local/share") / "footing/mediapipe-pose"
PICTURE = pathlib.Path(__file__).parent / "pictures/astronaut.jpg"
PROFILE = tempfile.TemporaryDirectory(prefix="footing-chromium.", ignore_cleanup_errors=True)


def skip(why):
    print(f"skipped: {why}")
    sys.exit(77)


def serve(stage, seconds, *words):
    """footing-skeleton with a page, and the page's port."""
    port = free_port()
    stage.start("footing-skeleton", "--listen", "127.0.0.1:0", "--web", f"127.0.0.1:{port}", "--camera-m", "2.5,0,1",
                "--seconds", seconds, "--json", *words, name="skeleton")
    stage.wait_for(lambda: "page for a webcam" in (stage.folder / "skeleton.log").read_text(), "the page")
    return port


def statistics(stage, timeout_s):
    assert stage.processes["skeleton"].wait(timeout_s) == 0
    return json.loads((stage.folder / "skeleton.log").read_text().splitlines()[-1])


def browse(stage, port, source, *words):
    """Chromium on the page; nothing that it asks any other host for is answered."""
    stage.processes["chromium"] = subprocess.Popen(
        ["chromium", "--headless=new", "--no-sandbox", "--use-angle=swiftshader",
         "--enable-unsafe-swiftshader", "--no-first-run", "--mute-audio",
         "--host-resolver-rules=MAP * ~NOTFOUND , EXCLUDE 127.0.0.1", f"--user-data-dir={PROFILE.name}",
         "--use-fake-ui-for-media-stream", "--use-fake-device-for-media-stream", *words,
         f"http://127.0.0.1:{port}/?source={source}"],
        stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


def write_video(path, frames=30, width=320, height=240):
    """A stick figure that waves, YUV4MPEG2."""
    with open(path, "wb") as video:
        video.write(f"YUV4MPEG2 W{width} H{height} F30:1 Ip A1:1 C420\n".encode())
        for i in range(frames):
            luma = bytearray(b"\x50" * (width * height))
            angle = math.sin(2 * math.pi * i / frames)
            limbs = [((160, 60), (160, 140)), ((160, 140), (140, 220)), ((160, 140), (180, 220)),
                     ((160, 80), (110, 110)), ((160, 80), (215, round(80 - 40 * angle)))]
            for (x0, y0), (x1, y1) in limbs:
                for k in range(101):
                    x, y = x0 + (x1 - x0) * k // 100, y0 + (y1 - y0) * k // 100
                    for dy in range(-4, 5):
                        start = (y + dy) * width + x - 4
                        luma[start:start + 9] = b"\xd0" * 9
            video.write(b"FRAME\n" + bytes(luma) + b"\x80" * (width * height // 2))


def get(port, target, host=None):
    connection = http.client.HTTPConnection("127.0.0.1", port, timeout=10)
    connection.putrequest("GET", target, skip_host=True)
    connection.putheader("Host", host or f"127.0.0.1:{port}")
    connection.endheaders()
    answer = connection.getresponse()
    return answer.status, answer.read().decode(errors="replace"), answer.headers


def upgrade(port, origin):
    """The first line of the answer to a WebSocket's handshake."""
    with socket.create_connection(("127.0.0.1", port), timeout=10) as stream:
        stream.sendall((f"GET /skeleton HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nOrigin: {origin}\r\nUpgrade: websocket\r\n"
                        "Connection: Upgrade\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n"
                        "Sec-WebSocket-Version: 13\r\n\r\n").encode())
        return stream.recv(4096).decode().splitlines()[0]


def check_http(stage):
    package = stage.folder / "package"
    package.mkdir()
    (package / "pose.js").write_text("// a model\n")
    (stage.folder / "secret").write_text("no page\n")
    port = serve(stage, 0, "--no-publish", "--pose-package", package)
    status, text, headers = get(port, "/?source=synthetic")
    assert status == 200 and "page.js" in text and headers["Content-Type"].startswith("text/html"), (status, text)
    assert "http" not in headers["Content-Security-Policy"], "nothing from another host"
    for name in ("page.js", "figure.js", "landmarks.js", "page.css"):
        assert get(port, "/" + name)[0] == 200, name
    for name in ("index.html", "page.js", "figure.js", "landmarks.js", "page.css"):
        assert "https:" not in get(port, "/" + name)[1], f"{name} names another host"
    assert get(port, "/pose/pose.js")[1] == "// a model\n"
    for target in ("/pose/../secret", "/pose/%2e%2e/secret", "/pose/", "/pose/.hidden", "/secret", "/pose/none.js"):
        assert get(port, target)[0] == 404, target
    assert get(port, "/", host="attacker.example")[0] == 403
    assert " 101 " in upgrade(port, f"http://127.0.0.1:{port}")
    assert " 403 " in upgrade(port, "http://attacker.example")
    stage.processes["skeleton"].send_signal(signal.SIGINT)
    web = statistics(stage, 20)["web"]
    assert web["pages"] == 1 and web["refused"] == 8, web


# The bones drawn of the synthetic person: landmarks of both ends, width and opacity of the line.
DRAW = """
import { drawFigure } from './figure.js';
import { syntheticLandmarks } from './landmarks.js';
const image = syntheticLandmarks(0, 640, 480, 60).image;
const at = (x, y) => image.findIndex(one => one.visibility > 0 && one.x * 640 === x && one.y * 480 === y);
function bones() {
  const lines = [];
  let from;
  drawFigure({ beginPath() {}, arc() {}, fill() {}, stroke() {}, moveTo(x, y) { from = at(x, y); },
               lineTo(x, y) { lines.push([from, at(x, y), this.lineWidth, this.globalAlpha]); } }, image, 640, 480);
  return lines;
}
const whole = bones();
image[13].visibility = 0.5;
image[26].visibility = 0.1;
console.log(JSON.stringify([whole, bones()]));
"""


def check_figure(stage):
    """A line a bone; the left elbow inferred: both its bones are thinner and paler; the right knee lost: none."""
    port = serve(stage, 0, "--no-publish")
    for name in ("figure.js", "landmarks.js"):
        (stage.folder / name).write_text(get(port, "/" + name)[1])
    (stage.folder / "package.json").write_text('{"type": "module"}')
    (stage.folder / "draw.js").write_text(DRAW)
    done = subprocess.run(["node", stage.folder / "draw.js"], capture_output=True, text=True, timeout=60, check=False)
    assert done.returncode == 0, done
    whole, part = ({frozenset(line[:2]): line[2:] for line in lines} for lines in json.loads(done.stdout))
    trunk = [(11, 12), (11, 23), (12, 24), (23, 24)]
    left = [(11, 13), (13, 15), (15, 17), (15, 19), (17, 19), (23, 25), (25, 27)]
    right = [(a + 1, b + 1) for a, b in left]
    assert set(whole) == set(map(frozenset, trunk + left + right)), whole
    assert len(set(map(tuple, whole.values()))) == 1, whole
    inferred = {frozenset((11, 13)), frozenset((13, 15))}
    assert set(whole) - set(part) == {frozenset((24, 26)), frozenset((26, 28))}, part
    for bone, (width, opacity) in part.items():
        full_width, full_opacity = whole[bone]
        paler = width < full_width and opacity < full_opacity
        assert paler if bone in inferred else [width, opacity] == whole[bone], (bone, part)
    stage.processes["skeleton"].send_signal(signal.SIGINT)
    statistics(stage, 20)


def check_missing_package(stage):
    port = serve(stage, 0, "--no-publish", "--pose-package", stage.folder / "nothing")
    log = stage.folder / "skeleton.log"
    stage.wait_for(lambda: "run scripts/fetch-pose-model" in log.read_text(), "what is missing")
    assert "fetch-pose-model" in get(port, "/pose/pose.js")[1]
    stage.processes["skeleton"].send_signal(signal.SIGINT)
    assert statistics(stage, 20)["web"]["refused"] == 1


def check_synthetic(stage):
    stage.start("footingd", "--listen", stage.sensor, "--source", f"stream:{stage.devices}")
    stage.wait_for_socket(stage.sensor)
    stage.wait_for_socket(stage.devices)
    port = serve(stage, 30, "--to", stage.devices)
    browse(stage, port, "synthetic")
    samples = [sample for tick in harness.read_ticks(stage.sensor, 25, ("hands",))
               for sample in tick.get("hands", {}).get("samples", [])]
    report = statistics(stage, 60)
    person = report["people"][0]
    assert person["dialect"] == "footing" and person["advice"] == "", person
    assert report["web"]["packets"] > 20 and person["skeletons"] > 20, report
    # The camera is 1 m up and looks along -x: shoulders are 1.41 m up, 36 cm apart, above W's origin.
    places = {number: [one["position_m"] for one in samples if one.get("joint") == number] for number in (3, 4)}
    left, right = places[3][-1], places[4][-1]
    assert abs(left["y"] - 0.18) < 0.02 and abs(right["y"] + 0.18) < 0.02, (left, right)
    assert abs(left["z"] - 1.41) < 0.02 and abs(left["x"]) < 0.05, left


def check_model(stage):
    video = stage.folder / "figure.y4m"
    write_video(video)
    port = serve(stage, 0, "--no-publish")
    browse(stage, port, "camera", f"--use-file-for-fake-video-capture={video}")
    log = stage.folder / "skeleton.log"
    stage.wait_for(lambda: "page: the model runs" in log.read_text() or "page: stopped" in log.read_text(),
                   "the model", timeout_s=250)
    assert "page: stopped" not in log.read_text(), log.read_text()
    stage.processes["skeleton"].send_signal(signal.SIGINT)
    web = statistics(stage, 20)["web"]
    assert web["frames"] >= 1, web


def check_person(stage):
    """A photograph as a webcam: the model finds who is in it, and where the joints are to each other."""
    stage.start("footingd", "--listen", stage.sensor, "--source", f"stream:{stage.devices}")
    stage.wait_for_socket(stage.sensor)
    stage.wait_for_socket(stage.devices)
    video = stage.folder / "person.mjpeg"
    video.write_bytes(10 * PICTURE.read_bytes())
    port = serve(stage, 0, "--to", stage.devices)
    browse(stage, port, "camera", f"--use-file-for-fake-video-capture={video}")
    log = stage.folder / "skeleton.log"
    stage.wait_for(lambda: "page: the model runs" in log.read_text() or "page: stopped" in log.read_text(),
                   "the model", timeout_s=250)
    assert "page: stopped" not in log.read_text(), log.read_text()
    samples = [sample for tick in harness.read_ticks(stage.sensor, 15, ("hands",))
               for sample in tick.get("hands", {}).get("samples", [])]
    stage.processes["skeleton"].send_signal(signal.SIGINT)
    report = statistics(stage, 20)
    assert report["web"]["found"] >= 3 and report["web"]["found"] >= 0.9 * report["web"]["frames"], report
    assert report["people"][0]["skeletons"] >= 3 and report["people"][0]["joints"] >= 20, report
    assert report["published"] >= 3, report
    # Head, left and right shoulder. She faces the camera, which looks along -x: her left is at y > 0.
    head, left, right = ([one["position_m"] for one in samples if one.get("joint") == number and one["confidence"] > 0]
                         for number in (1, 3, 4))
    assert head and left and right, len(samples)
    assert 0.2 < left[-1]["y"] - right[-1]["y"] < 0.6, (left[-1], right[-1])
    assert head[-1]["z"] > max(left[-1]["z"], right[-1]["z"]) + 0.1, (head[-1], left[-1], right[-1])


def main():
    part = sys.argv[2]
    if part == "figure" and not shutil.which("node"):
        skip("node is missing")
    if part not in ("http", "figure") and not shutil.which("chromium"):
        skip("chromium is missing; scripts/dependencies-web.txt lists what this test needs")
    if part in ("model", "person") and not (PACKAGE / "pose.js").is_file():
        skip("@mediapipe/pose is missing; run scripts/fetch-pose-model")
    checks = {"http": (check_http, check_missing_package), "figure": (check_figure,),
              "synthetic": (check_synthetic,), "model": (check_model,), "person": (check_person,)}
    for check in checks[part]:
        with harness.Stage(sys.argv[1]) as stage:
            check(stage)


if __name__ == "__main__":
    main()
