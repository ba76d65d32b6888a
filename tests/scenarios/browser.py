"""Headless Chromium by its own protocol (Chrome DevTools Protocol) over a pipe, without any library.

Usage: `with Browser() as browser: page = browser.open(url, 390, 844); page.wait_for("document.title")`.
"""
import base64
import json
import os
import pathlib
import select
import shutil
import subprocess
import tempfile
import time

PATIENCE_S = 60
# Name, width, height, dark theme.
SIZES = (("desktop", 1280, 720, False), ("tablet", 820, 1180, False), ("phone", 390, 844, True))


def is_there():
    return shutil.which("chromium") is not None


class Page:
    def __init__(self, browser, session):
        self.browser = browser
        self.session = session
        self.errors = []

    def send(self, method, **parameters):
        return self.browser.send(method, parameters, self.session)

    def evaluate(self, expression, gesture=False):
        """The value of an expression; a promise is waited for."""
        result = self.send("Runtime.evaluate", expression=expression, returnByValue=True, awaitPromise=True, userGesture=gesture)
        assert "exceptionDetails" not in result, (expression, result["exceptionDetails"])
        return result["result"].get("value")

    def wait_for(self, expression, timeout_s=PATIENCE_S):
        deadline = time.monotonic() + timeout_s
        while time.monotonic() < deadline:
            # The page may not be there yet, and throw.
            value = self.evaluate(f"(() => {{ try {{ return {expression}; }} catch {{ return null; }} }})()")
            if value:
                return value
            time.sleep(0.1)
        raise AssertionError(f"waited {timeout_s} s for {expression}; the page says: {self.evaluate('document.body.innerText')}")

    def show(self, width, height, dark=False):
        """The size of the window, and the theme."""
        self.send("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=width < 700)
        self.send("Emulation.setEmulatedMedia", features=[{"name": "prefers-color-scheme", "value": "dark" if dark else "light"}])

    def show_each_size(self, pictures, name, ready="true"):
        """At each size the page fits into the window; its pictures, where they have a folder."""
        for size, width, height, dark in SIZES:
            self.show(width, height, dark)
            self.wait_for(f"window.innerWidth === {width} && {ready}")
            overflow = self.evaluate("document.documentElement.scrollWidth - window.innerWidth")
            assert overflow <= 0, f"{name}, {size}: {overflow} pixels beyond the right edge"
            if pictures:
                time.sleep(0.5)
                self.screenshot(pathlib.Path(pictures) / f"{name}-{size}.png")

    def screenshot(self, path):
        shot = self.send("Page.captureScreenshot", format="png")
        pathlib.Path(path).write_bytes(base64.b64decode(shot["data"]))


class Browser:
    def __init__(self, *words):
        self._profile = tempfile.TemporaryDirectory(prefix="footing-chromium.", ignore_cleanup_errors=True)
        to_browser, self._out = os.pipe()
        self._in, from_browser = os.pipe()

        def pipes():
            os.dup2(to_browser, 3)
            os.dup2(from_browser, 4)

        # Nothing that it asks any other host for is answered.
        self.process = subprocess.Popen(
            ["chromium", "--headless=new", "--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader",
             "--no-first-run", "--mute-audio", "--remote-debugging-pipe", f"--user-data-dir={self._profile.name}",
             "--host-resolver-rules=MAP * ~NOTFOUND , EXCLUDE 127.0.0.1 , EXCLUDE localhost", *words],
            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, pass_fds=(3, 4), preexec_fn=pipes)
        os.close(to_browser)
        os.close(from_browser)
        self._bytes = b""
        self._number = 0
        self._pages = {}

    def __enter__(self):
        return self

    def __exit__(self, kind, value, traceback):
        self.process.kill()
        self.process.wait()
        os.close(self._in)
        os.close(self._out)
        self._profile.cleanup()

    def send(self, method, parameters=None, session=None):
        self._number += 1
        message = {"id": self._number, "method": method, "params": parameters or {}}
        if session:
            message["sessionId"] = session
        os.write(self._out, json.dumps(message).encode() + b"\0")
        deadline = time.monotonic() + PATIENCE_S
        while True:
            answer = self._receive(deadline)
            if answer.get("id") == self._number:
                assert "error" not in answer, (method, answer["error"])
                return answer["result"]
            page = self._pages.get(answer.get("sessionId"))
            if page and answer["method"] == "Runtime.exceptionThrown":
                page.errors.append(answer["params"]["exceptionDetails"])

    def _receive(self, deadline):
        while b"\0" not in self._bytes:
            ready, _, _ = select.select([self._in], [], [], max(0, deadline - time.monotonic()))
            assert ready, "chromium does not answer"
            got = os.read(self._in, 1 << 16)
            assert got, "chromium has ended"
            self._bytes += got
        message, self._bytes = self._bytes.split(b"\0", 1)
        return json.loads(message)

    def open(self, url, width=1280, height=720, dark=False):
        # In a window of its own: a page behind another one is hidden, and feels no motion.
        target = self.send("Target.createTarget", {"url": "about:blank", "newWindow": True})["targetId"]
        session = self.send("Target.attachToTarget", {"targetId": target, "flatten": True})["sessionId"]
        page = self._pages[session] = Page(self, session)
        page.target = target
        page.send("Page.enable")
        page.send("Runtime.enable")
        page.show(width, height, dark)
        page.send("Page.navigate", url=url)
        return page

    def close(self, page):
        self.send("Target.closeTarget", {"targetId": page.target})
