"""The viewer's window as a person uses it: mouse, keys, and a recording that is dropped on it.

A display without a screen (Xvfb); events come from another client of it, by Xlib alone.

Usage: window_scenario.py SCENARIOS_FOLDER BINARY_FOLDER
"""
import ctypes
import ctypes.util
import json
import math
import os
import shutil
import subprocess
import sys
import threading
import time
import urllib.parse

sys.path.insert(0, sys.argv[1])
from harness import Stage, read_ticks  # noqa: E402

SKIPPED = 77
WIDTH, HEIGHT = 960, 540
KEY_PRESS, KEY_RELEASE, BUTTON_PRESS, BUTTON_RELEASE = 2, 3, 4, 5
SELECTION_REQUEST, SELECTION_NOTIFY, CLIENT_MESSAGE = 30, 31, 33
LEFT, RIGHT_BUTTON, WHEEL_UP = 1, 3, 4

Window = Atom = Time = ctypes.c_ulong


class XKeyOrButton(ctypes.Structure):
    """XKeyEvent, and XButtonEvent: the same fields up to the last one."""
    _fields_ = [("type", ctypes.c_int), ("serial", ctypes.c_ulong), ("send_event", ctypes.c_int),
                ("display", ctypes.c_void_p), ("window", Window), ("root", Window), ("subwindow", Window),
                ("time", Time), ("x", ctypes.c_int), ("y", ctypes.c_int), ("x_root", ctypes.c_int),
                ("y_root", ctypes.c_int), ("state", ctypes.c_uint), ("detail", ctypes.c_uint),
                ("same_screen", ctypes.c_int)]


class XClientMessage(ctypes.Structure):
    _fields_ = [("type", ctypes.c_int), ("serial", ctypes.c_ulong), ("send_event", ctypes.c_int),
                ("display", ctypes.c_void_p), ("window", Window), ("message_type", Atom), ("format", ctypes.c_int),
                ("data", ctypes.c_long * 5)]


class XSelectionRequest(ctypes.Structure):
    _fields_ = [("type", ctypes.c_int), ("serial", ctypes.c_ulong), ("send_event", ctypes.c_int),
                ("display", ctypes.c_void_p), ("owner", Window), ("requestor", Window), ("selection", Atom),
                ("target", Atom), ("property", Atom), ("time", Time)]


class XSelection(ctypes.Structure):
    _fields_ = [("type", ctypes.c_int), ("serial", ctypes.c_ulong), ("send_event", ctypes.c_int),
                ("display", ctypes.c_void_p), ("requestor", Window), ("selection", Atom), ("target", Atom),
                ("property", Atom), ("time", Time)]


class XEvent(ctypes.Union):
    _fields_ = [("type", ctypes.c_int), ("key", XKeyOrButton), ("client", XClientMessage),
                ("request", XSelectionRequest), ("selection", XSelection), ("pad", ctypes.c_long * 24)]


class Person:
    """A mouse, a keyboard and a file manager at a display."""

    def __init__(self, display_name):
        self.x = ctypes.CDLL(ctypes.util.find_library("X11"))
        for name, result in (("XOpenDisplay", ctypes.c_void_p), ("XDefaultRootWindow", Window), ("XInternAtom", Atom),
                             ("XCreateSimpleWindow", Window), ("XStringToKeysym", ctypes.c_ulong)):
            getattr(self.x, name).restype = result
        self.display = ctypes.c_void_p(self.x.XOpenDisplay(display_name.encode()))
        assert self.display, "no connection to the display"
        self.root = self.x.XDefaultRootWindow(self.display)
        self.window, self.at, self.clock_ms = None, (0, 0), 1000

    def _atom(self, name):
        return self.x.XInternAtom(self.display, name.encode(), 0)

    def find_window(self, title):
        """The child of the root with that title, once there is one."""
        root, parent, count = Window(), Window(), ctypes.c_uint()
        children = ctypes.POINTER(Window)()
        self.x.XQueryTree(self.display, Window(self.root), ctypes.byref(root), ctypes.byref(parent),
                          ctypes.byref(children), ctypes.byref(count))
        for i in range(count.value):
            name = ctypes.c_char_p()
            self.x.XFetchName(self.display, Window(children[i]), ctypes.byref(name))
            if name.value and name.value.decode().startswith(title):
                self.window = children[i]
                return name.value.decode()
        return None

    def _send(self, event, window):
        self.x.XSendEvent(self.display, Window(window), 1, ctypes.c_long(0), ctypes.byref(event))
        self.x.XSync(self.display, 0)

    def _input(self, kind, detail, state=0):
        self.clock_ms += 400  # Far apart: no two presses are a double click to the window's library.
        event = XEvent()
        event.key = XKeyOrButton(type=kind, display=self.display, window=self.window, root=self.root,
                                 time=self.clock_ms, x=self.at[0], y=self.at[1], x_root=self.at[0],
                                 y_root=self.at[1], state=state, detail=detail, same_screen=1)
        self._send(event, self.window)

    def move(self, x, y):
        self.at = (int(x), int(y))
        self.x.XWarpPointer(self.display, Window(0), Window(self.window), 0, 0, 0, 0, *self.at)
        self.x.XSync(self.display, 0)
        time.sleep(0.1)  # The window sees the pointer there before the press that follows.

    def press(self, button):
        self._input(BUTTON_PRESS, button)

    def release(self, button):
        self._input(BUTTON_RELEASE, button)
        time.sleep(0.1)

    def drag(self, button, start, end):
        self.move(*start)
        self.press(button)
        for share in (0.25, 0.5, 0.75, 1):
            self.move(*(a + share * (b - a) for a, b in zip(start, end)))
        self.release(button)

    def key(self, name):
        code = self.x.XKeysymToKeycode(self.display, ctypes.c_ulong(self.x.XStringToKeysym(name.encode())))
        assert code, name
        self._input(KEY_PRESS, code)
        self._input(KEY_RELEASE, code)
        time.sleep(0.1)

    def drop(self, paths):
        """The XDND protocol, version 5, from the side of a file manager."""
        source = self.x.XCreateSimpleWindow(self.display, Window(self.root), 0, 0, 1, 1, 0, Window(0), Window(0))
        selection, uri_list = self._atom("XdndSelection"), self._atom("text/uri-list")
        self.x.XSetSelectionOwner(self.display, Atom(selection), Window(source), Time(0))

        def tell(name, *data):
            event = XEvent()
            event.client = XClientMessage(type=CLIENT_MESSAGE, display=self.display, window=self.window,
                                          message_type=self._atom(name), format=32)
            for i, value in enumerate((source, *data)):
                event.client.data[i] = value
            self._send(event, self.window)

        tell("XdndEnter", 5 << 24, uri_list)
        tell("XdndPosition", 0, (self.at[0] << 16) | self.at[1], 0, self._atom("XdndActionCopy"))
        tell("XdndDrop", 0, 0)
        text = "".join(f"file://{urllib.parse.quote(str(path))}\r\n" for path in paths).encode()
        deadline = time.monotonic() + 20
        event = XEvent()
        while time.monotonic() < deadline:
            while self.x.XPending(self.display):
                self.x.XNextEvent(self.display, ctypes.byref(event))
                if event.type == SELECTION_REQUEST:
                    asked = event.request
                    self.x.XChangeProperty(self.display, Window(asked.requestor), Atom(asked.property),
                                           Atom(asked.target), 8, 0, text, len(text))
                    answer = XEvent()
                    answer.selection = XSelection(type=SELECTION_NOTIFY, display=self.display,
                                                  requestor=asked.requestor, selection=asked.selection,
                                                  target=asked.target, property=asked.property, time=asked.time)
                    return self._send(answer, asked.requestor)
            time.sleep(0.01)
        raise AssertionError("the window did not ask for what was dropped")


def start_display(stage):
    """A free display; its number."""
    read_end, write_end = os.pipe()
    stage.processes["Xvfb"] = subprocess.Popen(
        ["Xvfb", "-displayfd", str(write_end), "-screen", "0", "1280x800x24", "-nolisten", "tcp"],
        pass_fds=[write_end], stderr=subprocess.DEVNULL)
    os.close(write_end)
    with os.fdopen(read_end) as pipe:
        return f":{pipe.readline().strip()}"


def start_view(stage, display, *words):
    out = open(stage.folder / "view.json", "w")
    process = subprocess.Popen(
        [stage.binaries / "footing-view", "--connect", stage.simulation, "--width", str(WIDTH), "--height", str(HEIGHT),
         "--json", "--msaa", "0", *words], stdout=out, stderr=open(stage.folder / "view.log", "w"), stdin=subprocess.DEVNULL,
        env=dict(os.environ, DISPLAY=display, LIBGL_ALWAYS_SOFTWARE="1"))
    stage.processes["footing-view"] = process
    return process


def end_view(stage, person):
    """Ends the viewer by its key; returns its summary."""
    person.key("q")
    code = stage.processes.pop("footing-view").wait(30)
    assert code == 0, (code, (stage.folder / "view.log").read_text())
    return json.loads((stage.folder / "view.json").read_text())


def body_in_picture():
    """Where the biped is in the window: the chase camera's geometry (clients/view/scene/camera.cc) on flat ground."""
    eye, target = (-4.5, 1.5, 1.5), None
    past = [4.5 / math.hypot(4.5, 1.5), -1.5 / math.hypot(4.5, 1.5)]
    target = (1.2 * past[0], 1.2 * past[1], 0.18)
    ahead = [t - e for t, e in zip(target, eye)]
    size = math.sqrt(sum(a * a for a in ahead))
    ahead = [a / size for a in ahead]
    level = math.hypot(ahead[0], ahead[1])
    right = (ahead[1] / level, -ahead[0] / level, 0)
    up = (right[1] * ahead[2] - right[2] * ahead[1], right[2] * ahead[0] - right[0] * ahead[2],
          right[0] * ahead[1] - right[1] * ahead[0])
    to_body = [-e for e in eye]
    dot = [sum(a * b for a, b in zip(axis, to_body)) for axis in (right, up, ahead)]
    scale = HEIGHT / 2 / math.tan(0.4) / dot[2]
    return WIDTH / 2 + scale * dot[0], HEIGHT / 2 - scale * dot[1]


class Pushes(threading.Thread):
    """Pushes that the engine has applied: number and impulse, from a client of its own."""

    def __init__(self, stage):
        super().__init__(daemon=True)
        self.address, self.seen = stage.simulation, []

    def run(self):
        try:
            for tick in read_ticks(self.address, 600, ["inputs"]):
                for applied in tick.get("inputs", {}).get("inputs", []):
                    if applied.get("push_number", 0) > len(self.seen):
                        self.seen.append((applied.get("push_x_ns", 0.0), applied.get("push_y_ns", 0.0)))
        except (EOFError, ConnectionError):
            pass  # The scenario is over.


def push(stage, person, pushes):
    """A drag upwards on the biped pushes it ahead; one beside it, or with the other button, turns or shifts the view."""
    x, y = body_in_picture()

    def pushed():
        person.drag(LEFT, (x, y), (x, y - 60))
        time.sleep(0.3)
        return pushes.seen

    stage.wait_for(pushed, "a push")
    ahead_ns, left_ns = pushes.seen[0]
    # Along the ground away from the camera, which looks past the biped: by 1.5 m to the right over 4.5 m ahead.
    assert 1 < ahead_ns <= 80 and abs(left_ns / ahead_ns + 1.5 / 4.5) < 0.03, pushes.seen
    count = len(pushes.seen)
    person.drag(LEFT, (x + 250, y - 60), (x + 250, y - 160))
    person.drag(RIGHT_BUTTON, (x, y), (x + 30, y))
    person.key("z")
    time.sleep(0.5)
    assert len(pushes.seen) == count, pushes.seen


def main(binaries):
    if not shutil.which("Xvfb") or not ctypes.util.find_library("X11"):
        print("SKIPPED: Xvfb is not installed: the window is not tried (apt install xvfb)")
        return SKIPPED
    with Stage(binaries) as stage:
        stage.start("footing-sim", "--listen", stage.simulation, "--sensor", f"unix:{stage.folder}/none.sock")
        stage.wait_for_socket(stage.simulation)
        recording = stage.folder / "a walk.mcap"
        assert stage.run("footing-log", "record", "--connect", stage.simulation, "--out", recording, "--seconds",
                         3).returncode == 0
        display = start_display(stage)
        person = Person(display)
        start_view(stage, display)
        stage.wait_for(lambda: person.find_window("Footing"), "the window")
        pushes = Pushes(stage)
        pushes.start()
        push(stage, person, pushes)
        for name in ("F1", "Left", "Up", "plus", "F1", "F11", "F11"):
            person.key(name)

        # A file that is not a recording is refused, and the live view goes on.
        person.drop([stage.folder / "view.log"])
        person.drop([recording])
        stage.wait_for(lambda: person.find_window("Footing: a walk.mcap"), "the dropped recording")
        for name in ("space", "Home", "Right", "Right", "period"):
            person.key(name)
        played = end_view(stage, person)["playback"]
        # Two seconds and one frame from the beginning, and there it is paused.
        assert abs(played["position_s"] - 2.01) < 1e-6, played
        assert played["recording"] == str(recording) and not played["ended"], played

        # The participant's window takes neither a push nor a recording.
        start_view(stage, display, "--subject")
        stage.wait_for(lambda: person.find_window("Footing"), "the participant's window")
        time.sleep(2)
        x, y = body_in_picture()
        count = len(pushes.seen)
        person.drag(LEFT, (x, y), (x, y - 60))
        person.drop([recording])
        summary = end_view(stage, person)
        assert "playback" not in summary and summary["frames_per_second"] > 0, summary
        assert len(pushes.seen) == count, "a push from the participant's window"
        print("ok")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[2]))
