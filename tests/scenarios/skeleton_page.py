"""The page of footing-web for a webcam: the model's files and refusals over HTTP; packets that reach footing-skeleton;
the bones that it draws, where there is node; and, where there are a browser and the npm package @mediapipe/pose, in
headless Chromium: joints that the page makes of a synthetic person reach footingd; the pose model loads from this host
and runs on the frames of a generated video, in which it finds nobody, and of a photograph, whose person's joints reach
footingd.

Usage: skeleton_page.py BINARY_FOLDER (http|figure|synthetic|model|person) [PICTURE_FOLDER]
"""
import json
import math
import os
import pathlib
import shutil
import signal
import struct
import subprocess
import sys
import time

import browser
import harness
import web_page
from ports import free_port

PACKAGE = pathlib.Path(os.environ.get("XDG_DATA_HOME") or pathlib.Path.home() / ".local/share") / "footing/mediapipe-pose"
PICTURE = pathlib.Path(__file__).parent / "pictures/astronaut.jpg"
PAGES = pathlib.Path(__file__).parents[2] / "clients/web/page"


def start_skeleton(stage, udp, *words):
    stage.start("footing-skeleton", "--listen", f"127.0.0.1:{udp}", "--camera-m", "2.5,0,1", "--json", *words,
                name="skeleton")
    stage.wait_for(lambda: "listening" in (stage.folder / "skeleton.log").read_text(), "footing-skeleton")


def start_line(stage):
    """footingd, footing-skeleton and footing-web; the page's address."""
    stage.start("footingd", "--listen", stage.sensor, "--source", f"stream:{stage.devices}")
    stage.wait_for_socket(stage.sensor)
    stage.wait_for_socket(stage.devices)
    udp = free_port()
    start_skeleton(stage, udp, "--to", stage.devices)
    return web_page.serve(stage, "--skeleton-port", udp, "--pose-package", PACKAGE)[1]["webcam"]


def statistics(stage):
    """Ends footing-skeleton; what it counted."""
    stage.processes["skeleton"].send_signal(signal.SIGINT)
    assert stage.processes["skeleton"].wait(20) == 0
    return json.loads((stage.folder / "skeleton.log").read_text().splitlines()[-1])


def camera(video=None):
    """Chromium with a webcam that shows a video."""
    words = [f"--use-file-for-fake-video-capture={video}"] if video else []
    return browser.Browser("--use-fake-ui-for-media-stream", "--use-fake-device-for-media-stream", *words)


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


def osc_text(text):
    return text.encode() + b"\0" * (4 - len(text) % 4)


def skeleton_packet(sequence):
    """Footing's dialect without a time: a left hand."""
    elements = [osc_text("/footing/skeleton") + osc_text(",hi") + struct.pack(">qi", sequence, 1),
                osc_text("/footing/joint") + osc_text(",sffff") + osc_text("l_hand") + struct.pack(">4f", -0.64, 0.48, 2, 1)]
    return osc_text("#bundle") + struct.pack(">q", 1) + b"".join(struct.pack(">i", len(one)) + one for one in elements)


def check_http(stage):
    package = stage.folder / "package"
    package.mkdir()
    (package / "pose.js").write_text("// a model\n")
    (stage.folder / "secret").write_text("no page\n")
    udp = free_port()
    port, printed = web_page.serve(stage, "--skeleton-port", udp, "--pose-package", package)
    assert printed["webcam"] == f"http://127.0.0.1:{port}/webcam", printed
    status, text, headers = web_page.ask(port, "/webcam?source=synthetic")
    assert status == 200 and "webcam.js" in text, (status, text)
    assert "http" not in headers["Content-Security-Policy"], "nothing from another host"
    assert "'unsafe-eval'" in headers["Content-Security-Policy"] and headers["Permissions-Policy"] == "camera=(self)"
    assert "unsafe" not in web_page.ask(port, "/")[2]["Content-Security-Policy"]
    for name in ("webcam.html", "webcam.js", "figure.js", "landmarks.js"):
        status, text, _ = web_page.ask(port, "/" + name)
        assert status == 200 and "https://" not in text, name
    assert web_page.ask(port, "/pose/pose.js")[1] == "// a model\n"
    for target in ("/pose/../secret", "/pose/%2e%2e/secret", "/pose/", "/pose/.hidden", "/secret"):
        assert web_page.ask(port, target)[0] == 404, target
    assert "fetch-pose-model" in web_page.ask(port, "/pose/none.js")[1]
    assert web_page.WebSocket(port, "/skeleton", "http://attacker.example").status == 403
    check_forwarding(stage, port, udp)


def check_forwarding(stage, port, udp):
    page = web_page.WebSocket(port, "/skeleton")
    assert page.status == 101
    for sequence in range(2):
        page.send(skeleton_packet(sequence))
    assert f"UDP port {udp}" in page.receive().decode(), "nobody listens there"
    start_skeleton(stage, udp, "--no-publish")
    deadline, sequence = time.monotonic() + 10, 2
    page.stream.settimeout(0.1)
    said = None
    while said != b"" and time.monotonic() < deadline:
        page.send(skeleton_packet(sequence))
        sequence += 1
        try:
            said = page.receive()
        except TimeoutError:
            pass
    assert said == b"", "it has come"
    report = statistics(stage)
    assert report["people"][0]["dialect"] == "footing" and report["skeletons"] >= 5, report
    done = stage.run("footing-skeleton", "--web", "127.0.0.1:7180")
    assert done.returncode == 2 and "footing-web --listen tcp:127.0.0.1:7180" in done.stderr, done


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
    for name in ("figure.js", "landmarks.js"):
        shutil.copy(PAGES / name, stage.folder)
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


def check_synthetic(stage, pictures):
    address = start_line(stage)
    with browser.Browser() as chromium:
        page = chromium.open(address + "?source=synthetic", 820, 1180)
        page.wait_for("window.footing().sent > 20")
        samples = [sample for tick in harness.read_ticks(stage.sensor, 10, ("hands",))
                   for sample in tick.get("hands", {}).get("samples", [])]
        page.show_each_size(pictures, "webcam")
        page.evaluate("document.getElementById('stop').click()")
        page.wait_for("!document.getElementById('camera').hidden && document.activeElement.id === 'camera'")
        report = statistics(stage)
        page.evaluate("document.getElementById('synthetic').click()")
        page.wait_for("document.getElementById('status').textContent.includes('start it')")
        assert not page.errors, page.errors
    person = report["people"][0]
    assert person["dialect"] == "footing" and person["advice"] == "", person
    assert person["skeletons"] > 20, report
    # The camera is 1 m up and looks along -x: shoulders are 1.41 m up, 36 cm apart, above W's origin.
    places = {number: [one["position_m"] for one in samples if one.get("joint") == number] for number in (3, 4)}
    left, right = places[3][-1], places[4][-1]
    assert abs(left["y"] - 0.18) < 0.02 and abs(right["y"] + 0.18) < 0.02, (left, right)
    assert abs(left["z"] - 1.41) < 0.02 and abs(left["x"]) < 0.05, left


def open_camera(chromium, address):
    """The page, once the model has run on the webcam."""
    page = chromium.open(address + "?source=camera")
    state = page.wait_for("/model runs|Stopped/.test(window.footing().state) && window.footing().state", 250)
    assert "model runs" in state, state
    return page


def check_model(stage):
    video = stage.folder / "figure.y4m"
    write_video(video)
    with camera(video) as chromium:
        counts = open_camera(chromium, start_line(stage)).evaluate("window.footing()")
    assert counts["frames"] >= 1, counts


def check_person(stage):
    """A photograph as a webcam: the model finds who is in it, and where the joints are to each other."""
    video = stage.folder / "person.mjpeg"
    video.write_bytes(10 * PICTURE.read_bytes())
    address = start_line(stage)
    with camera(video) as chromium:
        page = open_camera(chromium, address)
        samples = [sample for tick in harness.read_ticks(stage.sensor, 15, ("hands",))
                   for sample in tick.get("hands", {}).get("samples", [])]
        counts = page.evaluate("window.footing()")
    report = statistics(stage)
    assert counts["found"] >= 3 and counts["found"] >= 0.9 * counts["frames"], counts
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
        web_page.skip("node is missing")
    if part not in ("http", "figure") and not shutil.which("chromium"):
        web_page.skip("chromium is missing; scripts/dependencies-web.txt lists what this test needs")
    if part in ("model", "person") and not (PACKAGE / "pose.js").is_file():
        web_page.skip("@mediapipe/pose is missing; run scripts/fetch-pose-model")
    pictures = sys.argv[3] if len(sys.argv) > 3 else None
    checks = {"http": check_http, "figure": check_figure, "synthetic": lambda stage: check_synthetic(stage, pictures),
              "model": check_model, "person": check_person}
    with harness.Stage(sys.argv[1]) as stage:
        checks[part](stage)


if __name__ == "__main__":
    main()
