"""Fails when a relative link or a picture of the top folder, docs/ or systemd/ leads nowhere.

Usage: check_links.py SOURCE_ROOT

Read are Markdown links and pictures. A link to a heading (#...) must name one of the page's headings.
A page that README.md does not reach by any way of links is an error, too.
"""
import pathlib
import re
import sys

LINK = re.compile(r"\]\(([^)\s]+)\)")
FENCE = re.compile(r"^```.*?^```", re.M | re.S)


def anchor(heading):
    plain = re.sub(r"[`*]|\[([^\]]*)\]\([^)]*\)", lambda m: m.group(1) or "", heading).strip().lower()
    return re.sub(r"[^\w\- ]", "", plain).replace(" ", "-")


def anchors(path):
    text = FENCE.sub("", path.read_text())
    return {anchor(line.lstrip("#")) for line in text.split("\n") if line.startswith("#")}


def links_of(page):
    return [link for link in LINK.findall(FENCE.sub("", page.read_text()))
            if not re.match(r"[a-z]+:", link)]


def check(root):
    pages = [*sorted(root.glob("*.md")), *sorted((root / "docs").rglob("*.md")), root / "systemd/README.md"]
    pages = [page for page in pages if page.exists()]
    errors, links = [], {}
    for page in pages:
        for link in links_of(page):
            name, _, place = link.partition("#")
            target = (page.parent / name).resolve() if name else page
            links.setdefault(page, set()).add(target)
            if not target.exists():
                errors.append(f"{page.relative_to(root)}: {link} does not exist")
            elif place and target.suffix == ".md" and place not in anchors(target):
                errors.append(f"{page.relative_to(root)}: {link}: there is no such heading")
    reached, waiting = set(), [root / "README.md"]
    while waiting:
        page = waiting.pop()
        if page in reached:
            continue
        reached.add(page)
        waiting += links.get(page, ())
    return errors + [f"{page.relative_to(root)}: no link from README.md leads here"
                     for page in pages if page not in reached]


if __name__ == "__main__":
    found = check(pathlib.Path(sys.argv[1]).resolve())
    print("\n".join(found) or "every link leads somewhere")
    sys.exit(1 if found else 0)
