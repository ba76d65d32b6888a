"""Writes a manual page out of what a program and its subcommands print with --help.

Usage: man_page.py PROGRAM VERSION FOLDER

The page goes to FOLDER/man8 for servers, to FOLDER/man1 for other programs, compressed.
"""
import gzip
import pathlib
import re
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
        raise SystemExit(f"error: {program} {' '.join(words)} --help: exit code {done.returncode}")
    return done.stdout.strip("\n").split("\n")


def subcommands(lines):
    """Those that a help text lists: two spaces, the name, what it does."""
    if "Subcommands:" not in lines:
        return []
    rows = lines[lines.index("Subcommands:") + 1:]
    rows = rows[:rows.index("")] if "" in rows else rows
    return [match[1] for match in (re.match(r"  (\S+)", row) for row in rows) if match]


def verbatim(lines):
    return [".nf", *map(escape, lines), ".fi"]


def sections(program, words, lines):
    """A section for each subcommand, and for each of its own."""
    for name in subcommands(lines):
        below = help_of(program, *words, name)
        title = " ".join((*words, name))
        yield [f'.SH "{escape(title).upper()}"', *verbatim(below)]
        yield from sections(program, (*words, name), below)


def page(program, section, version):
    name, lines = pathlib.Path(program).name, help_of(program)
    text = [f'.TH {name.upper().replace("-", "_")} {section} "" "Footing {version}" "Footing"', ".SH NAME",
            f"{escape(name)} \\- {escape(lines[0].rstrip('.'))}", ".SH DESCRIPTION", *verbatim(lines[1:])]
    for part in sections(program, (), lines):
        text += part
    return "\n".join([*text, ".SH SEE ALSO", "The documentation of Footing.", ""])


def main(program, version, folder):
    name = pathlib.Path(program).name
    section = 8 if name in SERVERS else 1
    target = pathlib.Path(folder) / f"man{section}" / f"{name}.{section}.gz"
    target.parent.mkdir(parents=True, exist_ok=True)
    # Without a time and a name inside, so that the same text gives the same bytes.
    target.write_bytes(gzip.compress(page(program, section, version).encode(), mtime=0))
    target.chmod(0o644)
    print(f"-- Installing: {target}")


if __name__ == "__main__":
    main(*sys.argv[1:])
