"""Fails when two files of one module declare the same name in their unnamed namespaces of one namespace.

The files of a module are compiled in batches (CMAKE_UNITY_BUILD), where unnamed namespaces of several
files are one. A name that means the same belongs in a header of the module; one that means something
else wants a name that says so.

Usage: check_batches.py SOURCE_ROOT
"""
import pathlib
import re
import sys

TOPS = ("common", "daemon", "clients")
COMMENT = re.compile(r'//[^\n]*|/\*.*?\*/|R"(\w*)\(.*?\)\1"|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])+\'', re.S)
OUTER = re.compile(r"^namespace ([\w:]+) \{", re.M)
OPEN = re.compile(r"^(?:inline )?namespace \{", re.M)
NAMED = re.compile(r"^(?:template <[^>]*> ?)?(?:struct|class|enum class|enum|using|concept) (\w+)\b(?! ?::)")
CONSTANT = re.compile(r"^(?:inline |static )?(?:constexpr|const|constinit|thread_local)\b(.*)$", re.S)
FUNCTION = re.compile(r"(?:^|[\s*&>])(~?\w+)\s*\(([^{;]*)", re.S)
NO_NAMES = {"if", "for", "while", "switch", "return", "static_assert", "alignas", "decltype", "operator"}


def statements(text):
    """The top-level statements of an unnamed namespace's body: what stands before each `;` or body."""
    depth = 0
    start = 0
    for i, c in enumerate(text):
        if c == "{":
            if depth == 0:
                yield text[start:i]
            depth += 1
        elif c == "}":
            depth -= 1
            if depth == 0:
                start = i + 1
            if depth < 0:
                return
        elif c == ";" and depth == 0:
            yield text[start:i]
            start = i + 1


def bodies(text):
    """(enclosing namespace, body) of each unnamed namespace."""
    for found in OPEN.finditer(text):
        yield (OUTER.findall(text[:found.start()]) or [""])[-1], text[found.end():]


def names_of(statement):
    statement = " ".join(statement.split())
    if not statement:
        return []
    named = NAMED.match(statement)
    if named:
        if statement.startswith("using") and " = " not in statement:
            return []  # A using declaration may stand twice.
        return [named.group(1)]
    if CONSTANT.match(statement) and "(" not in statement.split("=")[0]:
        head = re.split(r"=(?!=)", statement)
        names = [re.sub(r"\[.*", "", head[0]).split()[-1]]
        return names + re.findall(r"\b(k[A-Z]\w*) *$", " ".join(head[1:-1])) if len(head) > 1 else names
    function = FUNCTION.search(statement)
    if function and function.group(1) not in NO_NAMES:
        parameters = re.sub(r"\b\w+(?= ?(?:,|$|\)|=))", "", function.group(2).split(")")[0])
        return [f"{function.group(1)}({''.join(parameters.split())})"]
    return []


def check(root):
    root = pathlib.Path(root)
    errors = []
    for top in TOPS:
        for folder in sorted({path.parent for path in (root / top).rglob("*.cc")}):
            seen, bases = {}, {}
            for path in sorted(folder.glob("*.cc")):
                text = COMMENT.sub(lambda m: '""' if m.group(0)[0] in "R\"'" else "", path.read_text())
                text = re.sub(r"^\s*#.*$", "", text, flags=re.M)
                for outer, body in bodies(text):
                    for statement in statements(body):
                        for name in names_of(statement):
                            plain = name.split("(")[0]
                            kind = "function" if "(" in name else "other"
                            first = seen.setdefault((outer, name), path)
                            other, file = bases.setdefault((outer, plain), (kind, path))
                            if other != kind and file != path:
                                first = file  # A type beside a function of its name.
                            if first != path:
                                errors.append(f"{path.relative_to(root)}: {name} is also in the unnamed namespace "
                                              f"of {first.name}; share it in a header, or name it for what it is")
    return errors


if __name__ == "__main__":
    found = check(sys.argv[1])
    print("\n".join(found) or "no name stands twice in a module's unnamed namespaces")
    sys.exit(1 if found else 0)
