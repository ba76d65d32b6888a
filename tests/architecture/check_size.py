"""Fails when a function has over 60 lines: it fits on a screen. A file may be as long as its idea.

Usage: check_size.py SOURCE_ROOT

Checked are the .h and .cc files under common, daemon and clients. A function is found by its braces: a block that opens
behind ")" (with const, noexcept, override, a return type or a list of initialisers between them) outside of any other
function. Its length is counted from the line of its name to that of its closing brace. A table is data, not a function.
Exceptions are named with the length they may have and their reason; they never grow. One without need is printed.
"""
import pathlib
import re
import sys

MOST_LINES_FUNCTION = 60
TOPS = ("common", "daemon", "clients")

# path:function; the most lines it may have, and why.
EXCEPTIONS = {
    "common/body/body.cc:Bones": (69, "a table of bones"),
}

CODE = re.compile(r'//[^\n]*|/\*.*?\*/|R"(\w*)\(.*?\)\1"|"(?:\\.|[^"\\\n])*"|(?<![0-9a-fA-F])\'(?:\\.|[^\'\\\n])+\'', re.S)
NOT_FUNCTIONS = {"if", "for", "while", "switch", "catch", "constexpr", "requires", "decltype", "alignas"}
HEAD = re.compile(r"([\w~]+(?:::[\w~]+)*|operator\S+)\s*\(")


def blank(match):
    """Comments and texts out of the way, every line where it was."""
    return re.sub(r"[^\n]", " ", match.group(0))


def function_name(head):
    """Of the text before an opening brace; None when no function begins there."""
    head = re.sub(r"^\s*#.*$", "", head, flags=re.M)
    head = re.sub(r"\btemplate\s*<.*?>(?=\s)", "", head, flags=re.S)
    if re.search(r"\b(class|struct|union|enum|namespace)\b[^()]*$", head) or "=" in re.sub(r"operator\W+|\([^()]*\)", "", head):
        return None
    for match in HEAD.finditer(head):
        if match.group(1) not in NOT_FUNCTIONS:
            return match.group(1), match.start()
    return None


def functions(text):
    """Name, first line and last line of each function that stands in no other one."""
    text = CODE.sub(blank, text)
    found, depth, start, inside = [], 0, 0, None
    for at, char in enumerate(text):
        if char == "{":
            if inside is None:
                named = function_name(text[start:at])
                if named:
                    inside = (named[0], text.count("\n", 0, start + named[1]) + 1, depth)
            depth += 1
        elif char == "}":
            depth -= 1
            if inside and depth == inside[2] and not re.match(r"\s*[,{]", text[at + 1:at + 3]):
                found.append((inside[0], inside[1], text.count("\n", 0, at) + 1))
                inside = None
        if char in ";{}" and inside is None:
            start = at + 1
    return found


def check(root, exceptions=None):
    exceptions = EXCEPTIONS if exceptions is None else exceptions
    errors, used = [], set()

    def report(key, length, message):
        used.add(key)
        if length > exceptions.get(key, (0, ""))[0]:
            errors.append(message)

    for top in TOPS:
        for path in sorted((pathlib.Path(root) / top).rglob("*")):
            if path.suffix not in (".h", ".cc"):
                continue
            relative = path.relative_to(root).as_posix()
            text = path.read_text()
            for name, first, last in functions(text):
                length = last - first + 1
                if length > MOST_LINES_FUNCTION:
                    report(f"{relative}:{name}", length, f"{relative}:{first}: {name} has {length} lines, at most "
                           f"{MOST_LINES_FUNCTION}; give its parts names of their own")
    return errors, sorted(set(exceptions) - used)


if __name__ == "__main__":
    problems, unused = check(sys.argv[1])
    for exception in unused:
        print(f"{exception}: short enough now; take its exception out of check_size.py")
    print("\n".join(problems) or "every function is short enough")
    sys.exit(1 if problems else 0)
