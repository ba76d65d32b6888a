"""A study's screens in footing-web. Without a browser: the survey needs a code, and each answer is in the journal before
the next question. In headless Chromium, where there is one, on a tablet: the participant reads what comes next, answers
with keys and taps while footing-study and footing-web are killed, and the experimenter sees where the study stands.

Usage: web_scenario.py SCENARIOS_FOLDER BINARY_FOLDER [browser [PICTURE_FOLDER]]
"""
import json
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).parent))
sys.path.insert(0, sys.argv[1])
import browser  # noqa: E402
import web_page  # noqa: E402
from attended_scenario import Experimenter  # noqa: E402
from harness import Stage  # noqa: E402

PROTOCOL = {
    "version": 1, "name": "Two ways to walk", "participants": ["P01"], "interfaces": ["wrist"], "seed": 2, "practice_s": 90,
    "straight_trials": 0, "test_tracks": [],
    "survey": {"ratings": ["ease of use"], "questions": ["What was good?"], "exertion": True},
    "final_survey": {"ratings": [], "questions": [], "overall": ["preferred interface"]},
    "devices": {"allow_simulated": True}, "disk_mb": 1,
}


def answers(stage):
    lines = (stage.folder / "s.study/P01/journal.jsonl").read_text().splitlines()
    return [one.get("value", one.get("text")) for one in map(json.loads, lines)
            if one["event"] in ("rating", "exertion", "answer")]


class Study:
    """A session with an experimenter who uses the terminal, and footing-web."""

    def __init__(self, stage):
        self.stage = stage
        self.address = f"unix:{stage.folder}/survey.sock"
        (stage.folder / "s.json").write_text(json.dumps(PROTOCOL))
        stage.start_servers()
        stage.start_user("demo")
        self.port, self.printed = web_page.serve(stage, "--survey", self.address)

    def start(self):
        return Experimenter(self.stage, "run", self.stage.folder / "s.json", "--participant", "P01", "--sensor", self.stage.sensor,
                            "--simulation", self.stage.simulation, "--survey", self.address)


def check_socket(stage):
    study = Study(stage)
    experimenter = study.start()
    experimenter.answer("Type yes to confirm", "yes")
    experimenter.answer("show all commands", "")
    experimenter.read("Press Enter to end it early")
    experimenter.type("\n")
    experimenter.read("ease of use: on the participant's screen")
    assert web_page.WebSocket(study.port, "/survey").status == 403, "on this host, too, answers need a code"
    own = {"Origin": f"http://127.0.0.1:{study.port}"}
    code = study.printed["participant"].split("#")[1].encode()
    cookie = web_page.ask(study.port, "/enter", "POST", code, **own)[2]["Set-Cookie"].split(";")[0]
    about = json.loads(web_page.ask(study.port, "/about.json", Cookie=cookie)[1])
    assert about["may_answer"] and not about["may_attach"], about
    page = web_page.WebSocket(study.port, "/survey", cookie=cookie)
    shown = json.loads(page.receive())
    assert (shown["item"], shown["least"], shown["greatest"], shown["count"]) == ("ease of use", 1, 5, 3), shown
    for text in ("6", "4"):  # The first one is none.
        page.send(json.dumps({"number": shown["number"], "text": text}).encode())
    assert json.loads(page.receive())["item"] == "exertion"
    assert answers(stage) == [4], "on the disk before the next question"
    experimenter.process.kill()
    assert isinstance(page.receive(), tuple), "the page hears that footing-study is gone"
    page = web_page.WebSocket(study.port, "/survey", cookie=cookie)
    assert "refused" in page.receive()[1], "and why it cannot come back yet"


def choose(page, value):
    """A tap on a choice, and the key Enter on the button."""
    page.evaluate(f"document.querySelector('#choices input[value=\"{value}\"]').click()", gesture=True)
    press(page)


def press(page):
    page.evaluate("document.getElementById('next').focus()")
    for kind in ("keyDown", "keyUp"):
        page.send("Input.dispatchKeyEvent", type=kind, key="Enter", code="Enter", windowsVirtualKeyCode=13, text="\r")


def wait_for_item(page, item):
    page.wait_for(f"window.footing().shown?.item === '{item}' && !window.footing().sent && !document.getElementById('survey').hidden")


def take_pictures(page, pictures, name, ready="true"):
    page.show_each_size(pictures, name, ready)
    page.show(820, 1180)


def check_browser(stage, pictures):
    study = Study(stage)
    with browser.Browser() as chromium:
        page = chromium.open(study.printed["participant"], 820, 1180)
        page.wait_for("document.getElementById('headline').textContent === 'Please wait'")
        experimenter = study.start()
        experimenter.answer("Type yes to confirm", "yes")
        page.wait_for("document.getElementById('headline').textContent === 'Demonstration of the interface wrist'")
        watching = chromium.open(f"http://127.0.0.1:{study.port}/", 1280, 720)
        experimenter.answer("show all commands", "")
        page.wait_for("/^1:[0-2]/.test(document.getElementById('count').textContent)")
        watching.wait_for("document.getElementById('study-doing').textContent.startsWith('Practice')")
        assert watching.evaluate("document.getElementById('study-list').innerText").count("wrist.survey") == 1
        take_pictures(watching, pictures, "study-experimenter", "window.footing().drawn > 0")
        take_pictures(page, pictures, "study-practice")
        experimenter.type("\n")
        wait_for_item(page, "ease of use")
        assert page.evaluate("document.activeElement.type") == "radio"
        take_pictures(page, pictures, "study-rating")
        press(page)
        assert page.evaluate("!document.getElementById('survey').checkValidity() && !window.footing().sent"), "nothing is chosen"
        choose(page, 4)
        wait_for_item(page, "exertion")
        assert answers(stage) == [4], answers(stage)
        take_pictures(page, pictures, "study-exertion")
        experimenter.process.kill()
        experimenter.process.wait()
        page.wait_for("document.getElementById('survey').hidden")
        experimenter = study.start()
        wait_for_item(page, "exertion")
        choose(page, 10)
        wait_for_item(page, "What was good?")
        page.evaluate("document.getElementById('text').value = 'it\\nwalks'")
        check_restart(stage, study, page)
        press(page)
        wait_for_item(page, "preferred interface")
        take_pictures(page, pictures, "study-choice")
        choose(page, "wrist")
        assert experimenter.process.wait(60) == 0
        assert answers(stage) == [4, 10, "it walks", "wrist"], answers(stage)
        page.wait_for("document.getElementById('headline').textContent === 'Please wait'")
        watching.wait_for("document.getElementById('study-panel').hidden")
        assert not page.errors + watching.errors, page.errors + watching.errors


def check_restart(stage, study, page):
    """footing-web starts again: the page says that it needs a new code, and with one it keeps what was written."""
    stage.stop("web")
    stage.start("footing-web", "--listen", f"tcp:127.0.0.1:{study.port}", "--connect", stage.simulation, "--survey", study.address,
                "--json", name="web")
    log = stage.folder / "web.log"
    stage.wait_for(lambda: log.read_text().startswith("{"), "footing-web")
    page.wait_for("document.getElementById('status').textContent.includes('needs a new code')")
    code = json.loads(log.read_text().splitlines()[0])["participant"].split("#")[1]
    page.evaluate(f"fetch('/enter', {{ method: 'POST', body: '{code}' }}).then(answer => answer.status)")
    page.wait_for("document.getElementById('status').textContent === '' && !document.getElementById('next').disabled")
    assert page.evaluate("document.getElementById('text').value") == "it\nwalks"


def main():
    in_browser = len(sys.argv) > 3
    if in_browser and not browser.is_there():
        web_page.skip("chromium is missing; scripts/dependencies-web.txt lists what this test needs")
    with Stage(sys.argv[2]) as stage:
        if in_browser:
            check_browser(stage, sys.argv[4] if len(sys.argv) > 4 else None)
        else:
            check_socket(stage)


if __name__ == "__main__":
    main()
