"""What the shell offers at TAB is what the program's own help lists.

Usage: completion.py COMPLETION_FILE BINARY_FOLDER
"""
import pathlib
import re
import subprocess
import sys
import tempfile

# Words on the line, the last one to be completed; what is offered.
CASES = [
    (["footingd", "--list"], ["--listen"]),
    (["footing-ctl", "la"], ["layout"]),
    (["footing-ctl", "--con"], ["--connect"]),
    (["footing-eval", "gait", "--push-d"], ["--push-direction", "--push-directions"]),
    (["footing-eval", "gait", "--js"], ["--json"]),  # Of the program, behind its subcommand.
    (["footing-eval", "gait", "--gait", ""], ["step", "walk", "run", "jump"]),
    (["footing-sim", "--engine", ""], ["gait", "pose"]),
    (["footing-sim", "--lag-ms", "1"], ["100"]),
    (["footing-stream", "--link", "p"], ["poor"]),
    (["footing-view", "--msaa", ""], ["0", "2", "4", "8"]),
    (["footingd", "--config", ""], []),  # The shell offers files.
]
ASK = """
. "$1/$2"
COMP_WORDS=("${@:2}") COMP_CWORD=$(($# - 2))
_footing "$2" "${COMP_WORDS[COMP_CWORD]}" "${COMP_WORDS[COMP_CWORD - 1]}"
printf '%s\\n' "${COMPREPLY[@]}"
complete -p "$2" >&2
"""


def offered(folder, binaries, words):
    done = subprocess.run(["bash", "-c", ASK, "bash", folder, *words], capture_output=True, text=True, timeout=20,
                          check=False, env={"PATH": f"{binaries}:/usr/bin:/bin"})
    assert done.stderr == f"complete -o default -F _footing {words[0]}\n", done.stderr
    return done.stdout.split()


def main(file, binaries):
    with tempfile.TemporaryDirectory(prefix="footing-completion.") as folder:
        for program in binaries.glob("footing*"):
            (pathlib.Path(folder) / program.name).symlink_to(file)  # As installed: found by the program's name.
        for words, expected in CASES:
            found = offered(folder, binaries, words)
            assert found == expected, f"{words}: {found}, not {expected}"
        programs = sorted(program.name for program in binaries.glob("footing*"))
        for program in programs:
            text = subprocess.run([binaries / program, "--help"], capture_output=True, text=True, timeout=20,
                                  check=True).stdout
            listed = {name for names in re.findall(r"^  (-\S+)", text, re.M) for name in names.split(",")}
            assert set(offered(folder, binaries, [program, "-"])) == listed, program
    print(f"{len(programs)} programs")


if __name__ == "__main__":
    main(pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve())
