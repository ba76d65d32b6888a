"""Fails when a file includes what its own CMakeLists.txt does not name.

Usage: check_includes.py SOURCE_ROOT MODULE_TABLE

The table is written by common/cmake/module.cmake. Checked, in every .h and .cc under a module's
folder, however deep: a module of ours (with quotes or angle brackets) is named in DEPS (or, from a
.cc file, PRIVATE_DEPS); a library from outside is named the same way; pure code uses no thread,
lock, socket, file, log, protobuf or clock; ours are included from the root, with quotes; a .cc
file begins with the header of its name, which is thereby compiled alone. Headers that the build
generates lie in the folder `generated` beside the table, under the path by which they are included,
and are checked too.
"""
import itertools
import pathlib
import re
import sys

INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]', re.M)
COMMENT = re.compile(r"//[^\n]*|/\*.*?\*/", re.S)
EXTERNAL = [
    (re.compile(r"^Eigen/"), {"eigen"}),
    (re.compile(r"^boost/asio/ssl"), {"openssl"}),
    (re.compile(r"^boost/asio"), {"asio"}),
    (re.compile(r"^boost/math/"), {"boost_math"}),
    (re.compile(r"^boost/"), {"asio", "boost_headers"}),
    (re.compile(r"^google/protobuf/"), {"protobuf", "footing_proto"}),
    (re.compile(r"^nlohmann/"), {"json"}),
    (re.compile(r"^spdlog/"), {"spdlog"}),
    (re.compile(r"^hidapi"), {"hidapi"}),
    (re.compile(r"^mujoco/"), {"mujoco"}),
    (re.compile(r"^zlib\.h$"), {"zlib"}),
    (re.compile(r"^openssl/evp"), {"crypto", "openssl"}),
    (re.compile(r"^openssl/"), {"openssl"}),
    (re.compile(r"^qrencode\.h$"), {"qrencode"}),
    (re.compile(r"^CLI/"), {"cli11"}),
    (re.compile(r"^(GL|EGL|KHR)/"), {"opengl"}),
    (re.compile(r"^imgui"), {"imgui"}),
    (re.compile(r"^stb"), {"imgui"}),
    (re.compile(r"^GLFW/"), {"glfw"}),
    (re.compile(r"^benchmark/"), {"benchmark"}),
]
IMPURE = re.compile(
    r"^(thread|mutex|shared_mutex|atomic|condition_variable|future|semaphore|stop_token|fstream"
    r"|iostream|filesystem|cstdio|stdio\.h|ctime|time\.h|boost/asio.*|hidapi.*|spdlog/.*|sys/.*"
    r"|netinet/.*|arpa/.*|poll\.h|fcntl\.h|unistd\.h|pthread\.h|signal\.h|csignal|google/protobuf/.*"
    r"|.*\.pb\.h)$")
CLOCK = re.compile(r"_clock::now\s*\(|\bclock_gettime\s*\(|\bgettimeofday\s*\(|\bstd::time\s*\(")
LOCKS = re.compile(r"\bstd::(atomic|mutex|shared_mutex|condition_variable)\b")


def read_table(table):
    modules = {}
    for line in pathlib.Path(table).read_text().splitlines():
        name, folder, pure, public, private = line.split("|")
        module = modules.setdefault(
            folder, {"names": set(), "pure": True, "public": set(), "private": set()})
        module["names"].add(name)
        module["pure"] = module["pure"] and pure == "TRUE"
        module["public"] |= set(public.split())
        module["private"] |= set(private.split())
    return modules


def owner_of(path, modules):
    """The module whose folder holds this path (relative to the root), the deepest if several."""
    for parent in pathlib.PurePosixPath(path).parents:
        if str(parent) in modules:
            return str(parent)
    return None


def check(root, table):
    roots = [pathlib.Path(root), pathlib.Path(table).parent / "generated"]
    modules = read_table(table)
    tops = ("common", "daemon", "clients", "proto")
    errors = []
    for base, top in itertools.product(roots, tops):
        for path in sorted((base / top).rglob("*")):
            if path.suffix not in (".h", ".cc", ".cpp", ".hpp", ".c"):
                continue
            relative = path.relative_to(base).as_posix()
            folder = owner_of(relative, modules)
            if folder is None:
                errors.append(f"{relative}: belongs to no module; name its folder in add_module")
                continue
            errors += check_file(path, roots, relative, folder, modules, tops)
    return errors


def check_file(path, roots, relative, folder, modules, tops):
    module = modules[folder]
    allowed = module["names"] | module["public"]
    if not relative.endswith(".h"):
        allowed = allowed | module["private"]
    # A program's folder may hold a module of the same folder: its names are allowed to each other.
    text = COMMENT.sub("", path.read_text())
    errors = []
    own = relative.removesuffix(".cc") + ".h"
    includes = INCLUDE.findall(text)
    if relative.endswith(".cc") and path.with_suffix(".h").exists() and [i for _, i in includes[:1]] != [own]:
        errors.append(f"{relative}: include {own} first, so that it is compiled alone")
    for quote, included in includes:
        ours = included.split("/")[0] in tops and "/" in included
        if quote == "<" and ours:
            errors.append(f"{relative}: include our own <{included}> with quotes")
        if quote == '"' and not ours and not included.endswith(".pb.h"):
            errors.append(f"{relative}: include \"{included}\" from the root of the project")
        if included.endswith(".pb.h") and "google" not in included:
            if "footing_proto" not in allowed:
                errors.append(f"{relative}: includes {included} without naming footing_proto")
        elif ours:
            target = owner_of(included, modules)
            if target is None or not any((base / included).exists() for base in roots):
                errors.append(f"{relative}: includes {included}, which is in no module")
            elif not (modules[target]["names"] & allowed):
                errors.append(f"{relative}: includes {included} without naming its module in DEPS")
        for pattern, names in EXTERNAL:
            if pattern.match(included) and not (names & allowed):
                errors.append(f"{relative}: includes {included} without naming "
                              f"{' or '.join(sorted(names))}")
                break
            if pattern.match(included):
                break
        if module["pure"] and IMPURE.match(included):
            errors.append(f"{relative}: pure code includes {included}")
    if module["pure"] and CLOCK.search(text):
        errors.append(f"{relative}: pure code reads a clock; take the time as an argument")
    if relative != "common/runtime/exchange.h" and LOCKS.search(text):
        errors.append(f"{relative}: atomics and locks live in common/runtime/exchange.h only")
    if "catch (...)" in text:
        errors.append(f"{relative}: catches everything; name what the library throws")
    return errors


if __name__ == "__main__":
    found = check(sys.argv[1], sys.argv[2])
    print("\n".join(found) or "layering holds")
    sys.exit(1 if found else 0)
