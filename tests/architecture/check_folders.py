"""Fails when docs/architecture.md lists other modules than the source has, or marks other ones as pure.

Usage: check_folders.py SOURCE_ROOT

Read is the code block under the heading "Folders". A line without indentation begins with a folder; it and the
indented lines below it name the modules in that folder. "P" marks the module before it as pure. What stands in
brackets or behind "#" is for the reader.
"""
import pathlib
import re
import sys

PAGE = "docs/architecture.md"
TOPS = ("common", "daemon", "clients")
ADDED = re.compile(r"\badd_(?:module|program)\(([^)]*)\)")


def modules_of(root):
    """Folder to whether it is pure."""
    found = {}
    for path in sorted(path for top in TOPS for path in (root / top).rglob("CMakeLists.txt")):
        if added := ADDED.findall(path.read_text()):
            found[str(path.parent.relative_to(root))] = any("PURE" in words.split() for words in added)
    return found


def listed(text):
    """Folder to whether it is marked, from the page."""
    block = re.search(r"^## Folders\n.*?^```\n(.*?)^```", text, re.M | re.S)
    found, folder, last = {}, "", ""
    for line in re.sub(r"\([^)]*\)|#.*", "", block[1]).splitlines() if block else []:
        words = line.split()
        if words and not line.startswith(" "):
            folder = words.pop(0)
        for word in words:
            if word != "P":
                last = folder + word
            found[last] = word == "P"
    return found


def check(root):
    modules, named = modules_of(root), listed((root / PAGE).read_text())
    errors = [f"{PAGE}: the list of folders lacks {name}" for name in modules if name not in named]
    errors += [f"{PAGE}: there is no module {name}" for name in named if name not in modules]
    return errors + [f"{PAGE}: {name} is {'' if modules[name] else 'not '}pure, the list of folders says otherwise"
                     for name in modules if name in named and modules[name] != named[name]]


if __name__ == "__main__":
    found_errors = check(pathlib.Path(sys.argv[1]).resolve())
    print("\n".join(found_errors) or "the list of folders is complete")
    sys.exit(1 if found_errors else 0)
