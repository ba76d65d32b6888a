"""Fails when a class has over 20 data members.

Usage: check_members.py SOURCE_ROOT

Checked are the .h and .cc files under common, daemon and clients. Counted are the data members that a class, struct or
union declares itself, neither static ones nor those of its bases and members. A table of values may have more: a message,
a configuration or a report, all of whose members mean something to the reader by themselves. It is a struct without a
function of its own, but for comparisons; this much is checked. A struct of state that a program advances is no table.
Tables are named with the members they may have; that number never grows. One without need is printed.
"""
import pathlib
import re
import sys

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).parent))
from check_size import CODE, TOPS, blank  # noqa: E402

MOST_MEMBERS = 20

# Path:class; the most members it may have, and what it is a table of.
TABLES = {
    "common/virtual/motion/markers.h:MarkerSet": (22, "a configuration: a row of the table of marker sets"),
    "daemon/simulation/gait/gains.h:HoppingGains": (24, "a configuration: a section of the files of gains"),
}

CLASS = re.compile(r"\b(class|struct|union)\s+(?:\[\[\w+\]\]\s*)?(\w+(?:::\w+)*)?(?:\s+final)?\s*(?::[^:;{}()][^;{}]*)?\{")
LABEL = re.compile(r"^\s*(?:public|protected|private)\s*:")
NOT_DATA = re.compile(r"^(?:using|typedef|friend|static|static_assert|template|enum|extern)\b")
COMPARISON = re.compile(r"\boperator\s*(?:==|!=|<=>|<|>|<=|>=)")


def closing(text, at):
    """Where the bracket that opens at `at` closes."""
    depth = 0
    for i in range(at, len(text)):
        depth += (text[i] in "({[") - (text[i] in ")}]")
        if depth == 0:
            return i
    return len(text) - 1


def without_nested(text):
    """Text without what stands in brackets, which stay; angle brackets of templates are such too."""
    out, depth, angles = [], 0, []
    for at, char in enumerate(text):
        if char in "({[" or (char == "<" and re.match(r"\w", text[at - 1:at])):
            angles.append(char)
            depth += 1
            if depth == 1:
                out.append(char)
            continue
        if angles and (char in ")}]" or (char == ">" and angles[-1] == "<" and text[at - 1] != "-")):
            angles.pop()
            depth -= 1
        if depth == 0:
            out.append(char)
    return "".join(out)


def statements(body):
    """Declarations of a class body, without the bodies of functions and nested classes."""
    start, at = 0, 0
    while at < len(body):
        char = body[at]
        if char == ";":
            yield body[start:at]
            start = at + 1
        elif char in "([":
            at = closing(body, at)
        elif char == "{":
            end = closing(body, at)
            declared = LABEL.sub("", body[start:at]).strip()
            if re.search(r"\)[^=]*$|\boperator\b", without_nested(declared)) and "=" not in re.sub(
                    r"operator\W+|\([^()]*\)", "", declared):
                if not re.match(r"\s*[,{]", body[end + 1:]):  # An initialiser of the constructor is not yet the end.
                    yield body[start:at]
                    start = end + 1
            at = end
        at += 1


def count(body):
    """Data members, and whether the class has a function that is no comparison."""
    members, functions = 0, False
    for statement in statements(body):
        declared = statement
        while LABEL.match(declared):
            declared = LABEL.sub("", declared, count=1)
        declared = without_nested(re.sub(r"^\s*#.*$|\[\[[^]]*\]\]|\balignas\([^()]*\)", "", declared, flags=re.M).strip())
        if not declared:
            continue
        if COMPARISON.search(declared):
            continue
        if declared.startswith("template"):
            functions = functions or "(" in declared
            continue
        if NOT_DATA.match(declared):
            functions = functions or (declared.startswith("static") and "(" in declared.split("=")[0]
                                      and not declared.startswith("static_assert"))
            continue
        nested = re.match(r"(class|struct|union)\b", declared)
        if nested:
            behind = declared[declared.rindex("}") + 1:] if "}" in declared else (
                "" if re.fullmatch(r"(class|struct|union)\s+\w+", declared) else declared)
            members += behind.count(",") + 1 if behind.strip() else 0
            continue
        head = re.split(r"[={]", declared)[0]
        pointer = re.match(r"[^(]*\(\s*(?:\w+::)*\*", statement)  # To a function: a member.
        if ("(" in head and not pointer) or re.search(r"\boperator\b", head):
            functions = True
            continue
        members += declared.count(",") + 1
    return members, functions


def classes(text):
    """Name, line, members and whether it has functions, of each class."""
    text = CODE.sub(blank, text)
    for match in CLASS.finditer(text):
        if re.search(r"\benum\s*$|[<,]\s*$", text[:match.start()]):
            continue
        opening = match.end() - 1
        yield match.group(2) or "(unnamed)", text.count("\n", 0, match.start()) + 1, *count(
            text[opening + 1:closing(text, opening)])


def check(root, tables=None):
    tables = TABLES if tables is None else tables
    errors, used = [], set()
    for top in TOPS:
        for path in sorted((pathlib.Path(root) / top).rglob("*")):
            if path.suffix not in (".h", ".cc"):
                continue
            relative = path.relative_to(root).as_posix()
            for name, line, members, functions in classes(path.read_text()):
                if members <= MOST_MEMBERS:
                    continue
                key = f"{relative}:{name}"
                used.add(key)
                if key in tables and functions:
                    errors.append(f"{relative}:{line}: {name} has functions, so it is no table of values")
                elif members > tables.get(key, (0, ""))[0]:
                    errors.append(f"{relative}:{line}: {name} has {members} data members, at most {MOST_MEMBERS}; group "
                                  "what belongs together in structs with names of their own")
    return errors, sorted(set(tables) - used)


if __name__ == "__main__":
    problems, unused = check(sys.argv[1])
    for table in unused:
        print(f"{table}: small enough now; take it out of the tables of check_members.py")
    print("\n".join(problems) or "no class has too many data members")
    sys.exit(1 if problems else 0)
