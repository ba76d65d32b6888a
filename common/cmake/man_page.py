"""Writes a manual page out of what a program says with --help.

Usage: man_page.py PROGRAM VERSION FOLDER

The page goes to FOLDER/man8 for servers, to FOLDER/man1 for other programs.
"""
import pathlib
import subprocess
import sys

SERVERS = ("footingd", "footing-sim")


def escape(text):
    """A line of roff that shows the text as it is."""
    text = text.replace("\\", "\\e").replace("-", "\\-")
    return "\\&" + text if text.startswith((".", "'")) else text


def help_of(program, *words):
    done = subprocess.run([program, *words, "--help"], capture_output=True, text=True, timeout=20, check=False,
                          stdin=subprocess.DEVNULL)
    if done.returncode != 0 or not done.stdout.strip():
        raise SystemExit(f"error: {program} --help: exit code {done.returncode}")
    return done.stdout.strip("\n").split("\n")


def page(name, section, version, lines):
    head = [f'.TH {name.upper().replace("-", "_")} {section} "" "Footing {version}" "Footing"', ".SH NAME",
            f"{escape(name)} \\- {escape(lines[0])}", ".SH DESCRIPTION", ".nf"]
    return "\n".join([*head, *map(escape, lines[1:]), ".fi", ".SH SEE ALSO", "The documentation of Footing.", ""])


def main(program, version, folder):
    name = pathlib.Path(program).name
    section = 8 if name in SERVERS else 1
    target = pathlib.Path(folder) / f"man{section}" / f"{name}.{section}"
    target.parent.mkdir(parents=True, exist_ok=True)
    target.write_text(page(name, section, version, help_of(program)))
    print(f"-- Installing: {target}")


if __name__ == "__main__":
    main(*sys.argv[1:])
