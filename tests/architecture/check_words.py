"""Fails when text that a person reads uses a word that the project's English leaves out.

Usage: check_words.py SOURCE_ROOT [--list] [--count]

Six kinds of text are read. `text`: string literals of .h and .cc files, scripts, documentation
and the comments of .proto files. `comments`: comments of .h and .cc files. `names`: identifiers of
.h and .cc files. `pages`: prose of .md files, which must not use the words of PAGE_RULES either.
`sentences`: the same prose, in which a sentence has at most LONGEST_SENTENCE words.
`openings`: comments of .h, .cc and .proto files, those of the tests too, which must not begin with "Of" or "What".
RULES name the words and what to write in their place; words_exceptions.csv lists
the phrases that may stay, with the reason; words_allowed.csv says how many findings of a kind a
folder may still have (a folder that it does not list: none). That number only ever goes down.
--list prints every finding; --count prints the numbers that words_allowed.csv would need.
"""
import collections
import csv
import pathlib
import re
import sys

HERE = pathlib.Path(__file__).parent
RULES = [  # (words, what to write)
    (r"tell|tells|told|telling|tellings", "estimate, report, measure or say"),
    (r"anew", "again, or restart, reset"),
    (r"so long|so often", "a noun with its unit: 'Duration, s', 'Interval, s'"),
    (r"(?:is|are|was|were) no(?! (?:longer|more|less|fewer|farther|further|worse|better)\b)", "is not a ..."),
    (r"carried(?! out\b)", "built-in, bundled"),
    (r"made[ -](?:\w+ )?(?:users?|person|persons|people|signals?|motions?|movements?|walks?|devices?|boards?)",
     "synthetic, simulated"),
    (r"stand-ins?|stands? in for|standing in for", "simulated device, device simulator"),
    (r"rehears(?!e\b)\w*", "simulation run, replay"),  # footing-stream rehearse is the name of a command.
    (r"room|rooms", "space, workspace, buffer"),
    (r"shelf|shelves|book|books", "store, record"),
    (r"obey|obeys|obeyed|judge|judges|judged|judging", "follow, accept; reject, score, check"),
    (r"wishes|wished", "targets, requests"),
    (r"talk|talks|talked|talking|voice|voices", "message, text, prompt"),
]
PAGE_RULES = [
    (r"chose nothing", "was not used for tuning"),
    (r"(?:left|leave|leaves|leaving) out", "held out, omitted, excluded"),
    (r"nobody|somebody", "no person, a person; or name who"),
    (r"aims?|aimed|aiming", "target, purpose; intend"),
    (r"(?:that|those) of [^.|]{0,60}?(?:that|those) of", "the thing by its name"),
    (r"(?-i:p)(?! ?[<>=]|[- ]values?\b)", "p value"),
]
LONGEST_SENTENCE = 35
OPENING = re.compile(r"/[/*]+[!<]*\s*(?P<words>(?:Of|What)\b)?")
OPENING_ADVICE = "begin with the thing and its unit: 'Load of the left board, N.', 'Request of a client.'"
NAMES = re.compile(
    r"(?:(?<![a-z])(?:tell|told|telling|tellings|anew|carried|rehears(?!e(?![a-z]))\w*|room|shelf|shelves|book|talk|voice"
    r"|farewell|wishes|worn|obey|judge)(?![a-z])"
    r"|(?:Tell|Told|Telling|Tellings|Anew|Carried|Rehears(?!e(?![a-z]))[a-z]*|Room|Shelf|Book|Talk|Voice|Farewell"
    r"|Wishes|Worn|Made|StandIn|Obey|Judge|Words)(?![a-z]))")
STRING_OR_COMMENT = re.compile(
    r'(?P<raw>R"(?P<mark>[^(\s]*)\((?P<body>.*?)\)(?P=mark)")'
    r'|(?P<string>"(?:\\.|[^"\\\n])*")|(?P<char>(?<!\d)\'(?:\\.|[^\'\\\n])+\')'
    r"|(?P<line>//[^\n]*)|(?P<block>/\*.*?\*/)", re.S)
IDENTIFIER = re.compile(r"\b[A-Za-z_]\w*\b")
Finding = collections.namedtuple("Finding", "kind path line words advice excerpt")


def split_source(text):
    """Yields (kind, line, text): literals joined where they touch, comments, and the code left over."""
    code, literal, literal_line, literal_end = list(text), "", 0, -1
    for match in STRING_OR_COMMENT.finditer(text):
        line = text.count("\n", 0, match.start()) + 1
        for i in range(match.start(), match.end()):
            if text[i] != "\n":
                code[i] = " "
        if match["char"]:
            continue
        if match["line"] or match["block"]:
            yield "comments", line, match.group()
            continue
        if text.rfind("#include", text.rfind("\n", 0, match.start()) + 1, match.start()) >= 0:
            continue
        body = match["body"] if match["raw"] else match["string"][1:-1].replace("\\n", "\n")
        if literal_end >= 0 and not text[literal_end:match.start()].strip():
            literal += body
        else:
            if literal:
                yield "text", literal_line, literal
            literal, literal_line = body, line
        literal_end = match.end()
    if literal:
        yield "text", literal_line, literal
    yield "names", 1, "".join(code)


def join_comments(pieces):
    """Comments of lines that follow each other are one text, so that a phrase may cross the line."""
    held = None
    for kind, line, text in pieces:
        if kind == "comments":
            text = re.sub(r"(?m)^\s*/{2,}\s?", "", text)
            if held and line == held[1] + held[2].count("\n") + 1:
                held = (kind, held[1], held[2] + "\n" + text)
                continue
            if held:
                yield held
            held = (kind, line, text)
            continue
        yield kind, line, text
    if held:
        yield held


def openings(path, text):
    """Finds comments that begin with "Of" or "What": the first line of each, not a line that goes on with it."""
    above = None  # Line and column of the comment that may go on.
    for match in STRING_OR_COMMENT.finditer(text):
        if not match["line"] and not match["block"]:
            continue
        start = text.rfind("\n", 0, match.start()) + 1
        line, column = text.count("\n", 0, start) + 1, match.start() - start
        goes_on = above == (line - 1, column) and not text[start:match.start()].strip()
        opening = OPENING.match(match.group())
        if opening["words"] and not goes_on:
            yield Finding("openings", path, line, opening["words"], OPENING_ADVICE, match.group().split("\n")[0])
        is_empty = opening.end() == len(match.group())
        above = None if is_empty else (line, column)


def pieces_of(path, text):
    if path.suffix in (".h", ".cc"):
        yield from join_comments(split_source(text))
    elif path.suffix == ".proto":
        for number, line in enumerate(text.split("\n"), 1):
            if "//" in line:
                yield "text", number, line.split("//", 1)[1]
    else:
        yield "text", 1, text


def prose_of(text):
    """Yields (line, paragraph) of a page: without code, tables, headings, comments and marks."""
    def blank(match):
        return "\n" * match.group().count("\n")

    text = re.sub(r"(?ms)^```.*?^```", blank, text)
    text = re.sub(r"(?s)<!-- measurements: .*?<!-- end of measurements -->", blank, text)  # Drawn from tables.
    text = re.sub(r"(?s)<!--.*?-->", blank, text)
    text = re.sub(r"`[^`]*`", lambda match: "`code`" + blank(match), text)
    text = re.sub(r"!?\[([^\]]*)\]\([^)]*\)", lambda match: match.group(1), text)
    start, paragraph = 1, []
    for number, line in enumerate([*text.split("\n"), ""], 1):
        ends = not line.strip() or re.match(r"\s*(?:[|#>]|    )", line) or line.startswith("    ")
        item = re.match(r"\s*(?:[-*]|\d+\.)\s+", line)
        if (ends or item) and paragraph:
            yield start, "\n".join(paragraph)
            paragraph = []
        if ends:
            continue
        if not paragraph:
            start = number
        paragraph.append(line[item.end():] if item else line)


def long_sentences(path, text):
    for line, paragraph in prose_of(text):
        begin = 0
        for end in [match.end() for match in re.finditer(r"[.!?][*_)\"'»]*(?=\s+[^a-z\s]|\s*$)", paragraph)] + [len(paragraph)]:
            sentence = paragraph[begin:end]
            words = [word for word in sentence.split() if re.search(r"\w", word)]
            if len(words) > LONGEST_SENTENCE:
                at = line + paragraph.count("\n", 0, begin + len(sentence) - len(sentence.lstrip()))
                yield Finding("sentences", path, at, f"{len(words)} words", f"at most {LONGEST_SENTENCE}; one idea a sentence",
                              " ".join(words[:8]) + " ...")
            begin = end


def files_of(root):
    for top in ("common", "daemon", "clients"):
        yield from (p for p in sorted((root / top).rglob("*")) if p.suffix in (".h", ".cc", ".py"))
    yield from (p for p in sorted((root / "tests").rglob("*")) if p.suffix in (".h", ".cc"))  # For openings.
    yield from sorted((root / "proto").rglob("*.proto"))
    yield from (p for p in sorted((root / "scripts").iterdir()) if p.is_file())
    yield from sorted((root / "docs").rglob("*.md"))
    yield from sorted((root / "docs").rglob("*.py"))
    yield from (p for p in (*sorted(root.glob("*.md")), root / "systemd/README.md") if p.exists())


def read_exceptions(path):
    with open(path, newline="") as file:
        return [(row["path"], row["phrase"]) for row in csv.DictReader(file)]


def find_in(kind, path, line, text, exceptions):
    for place, phrase in exceptions:
        if path.startswith(place):
            text = text.replace(phrase, " " * len(phrase))
    if kind == "names":
        for match in IDENTIFIER.finditer(text):
            if NAMES.search(match.group()):
                yield Finding(kind, path, text.count("\n", 0, match.start()) + line, match.group(),
                              "a name of the field", match.group())
        return
    for words, advice in PAGE_RULES if kind == "pages" else RULES:
        pattern = r"(?<![\w/.-])(?:" + words.replace(" ", r"\s+") + r")(?![\w/-])"
        for match in re.finditer(pattern, text, re.I):
            before = text[max(0, match.start() - 12):match.start()]
            if re.match(r"(?:is|are|was|were)\s", match.group(), re.I) and \
                    re.search(r"\b(?:there|here)\s+$", before, re.I):
                continue
            excerpt = text[max(0, match.start() - 30):match.end() + 30].replace("\n", " ")
            yield Finding(kind, path, text.count("\n", 0, match.start()) + line,
                          " ".join(match.group().split()), advice, excerpt)


def check_file(root, path, exceptions):
    relative = path.relative_to(root).as_posix()
    found = []
    if path.suffix in (".h", ".cc", ".proto"):
        found += openings(relative, path.read_text())
        if relative.startswith("tests/"):
            return found
    for kind, line, text in pieces_of(path, path.read_text()):
        found += find_in(kind, relative, line, text, exceptions)
    if path.suffix == ".md":
        page = path.read_text()
        for line, paragraph in prose_of(page):
            found += find_in("pages", relative, line, paragraph, exceptions)
        found += long_sentences(relative, page)
    return found


def folder_of(path):
    """The folder that a text is counted for: two levels deep, so that a move within it costs nothing."""
    return "/".join(path.split("/")[:-1][:2]) or "."


def key_of(finding):
    """What words_allowed.csv counts. Comments and names move with the code, so they count once a top folder."""
    folder = folder_of(finding.path)
    return finding.kind, folder if finding.kind == "text" else folder.split("/")[0]


def count(findings):
    return collections.Counter(key_of(f) for f in findings)


def read_allowed(path):
    with open(path, newline="") as file:
        return {(row["kind"], row["folder"]): int(row["count"]) for row in csv.DictReader(file)}


def check(root, exceptions, allowed):
    findings = [f for path in files_of(root) for f in check_file(root, path, exceptions)]
    counts = count(findings)
    over = {key for key, number in counts.items() if number > allowed.get(key, 0)}
    return findings, counts, over


def show(finding):
    return (f"{finding.path}:{finding.line}: '{finding.words}' ({finding.kind}): {finding.advice}; "
            f"in '{finding.excerpt}'")


def main(arguments):
    root = pathlib.Path(arguments[0])
    findings, counts, over = check(root, read_exceptions(HERE / "words_exceptions.csv"),
                                   read_allowed(HERE / "words_allowed.csv"))
    if "--count" in arguments:
        print("kind,folder,count")
        print("\n".join(f"{kind},{folder},{number}" for (kind, folder), number in sorted(counts.items())))
        return 0
    listed = findings if "--list" in arguments else [f for f in findings if key_of(f) in over]
    print("\n".join(show(f) for f in listed) or "every word is plain")
    return 1 if over else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
