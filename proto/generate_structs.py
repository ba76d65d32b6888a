"""Writes the plain structs of messages, the names of their enums and the conversions.

Usage: generate_structs.py structs|conversions OUT TABLE PROTOC PROTO...

`structs` writes OUT/common/stream/HEADER.h for each header of the table (structs.toml, which says what
the options mean) and OUT/common/stream/messages.cc with the names of enums. `conversions` writes
OUT/common/wire/messages.h and messages.cc. A file that would not change is not written. Comments come
from the .proto files.
"""
import collections
import pathlib
import re
import subprocess
import sys
import textwrap
import tomllib

from google.protobuf import descriptor_pb2

COLUMNS = 100
MAKER = "// Written by proto/generate_structs.py from proto/footing/v1 and proto/structs.toml; do not edit.\n"
F = descriptor_pb2.FieldDescriptorProto
NUMBERS = {
    F.TYPE_DOUBLE: ("double", "0"), F.TYPE_FLOAT: ("float", "0"), F.TYPE_BOOL: ("bool", "false"),
    F.TYPE_INT32: ("int", "0"), F.TYPE_SINT32: ("int", "0"), F.TYPE_UINT32: ("std::uint32_t", "0"),
    F.TYPE_INT64: ("std::int64_t", "0"), F.TYPE_UINT64: ("std::uint64_t", "0"),
}
REALS = (F.TYPE_DOUBLE, F.TYPE_FLOAT)
EIGEN = {".footing.v1.Vector3": ("Eigen::Vector3d", "Eigen::Vector3d::Zero()"),
         ".footing.v1.Quaternion": ("Eigen::Quaterniond", "Eigen::Quaterniond::Identity()")}
OF = {2: ("Eigen::Vector2d", "Eigen::Vector2d::Zero()", "xy"),
      3: ("Eigen::Vector3d", "Eigen::Vector3d::Zero()", "xyz"),
      4: ("Eigen::Quaterniond", "Eigen::Quaterniond::Identity()", "wxyz")}
ENUM_OPTIONS = {"proto", "flags", "unspecified", "names", "spaces", "all", "named", "list"}
FIELD_OPTIONS = {"default", "member", "of", "optional", "flag", "omit_zero", "as_is", "static_text", "computed", "most", "array"}
STANDARD = {"std::array": "array", "std::int64_t": "cstdint", "std::uint": "cstdint", "std::optional": "optional",
            "std::string": "string", "std::vector": "vector"}

Field = collections.namedtuple("Field", "name type type_name repeated comment")
# A member of a struct with the fields that it is made of; `type` is of one element.
Member = collections.namedtuple("Member", "path type initial comment fields options")


class Unclear(Exception):
    """The table does not fit the messages."""


def camel(name):
    return "".join(part.capitalize() for part in name.lower().split("_"))


class Messages:
    """What the .proto files define, by the names of structs.toml."""

    def __init__(self, files, table):
        self.kinds, self.comments, self.origin = {}, {}, {}
        for file in files:
            for location in file.source_code_info.location:
                text = location.leading_comments + location.trailing_comments
                self.comments[file.name, tuple(location.path)] = " ".join(text.split())
            for i, enum in enumerate(file.enum_type):
                self.add(file, enum, (5, i), enum.name)
            for i, message in enumerate(file.message_type):
                self.add(file, message, (4, i), message.name)
                for j, enum in enumerate(message.enum_type):
                    self.add(file, enum, (4, i, 4, j), f"{message.name}.{enum.name}")
        self.structs = {}  # Name in .proto to name of the struct.
        for names in table["headers"].values():
            for name in names:
                proto = table.get(name, {}).get("proto", name)
                if proto not in self.kinds:
                    raise Unclear(f"there is no message or enum {proto}")
                self.structs[proto] = name
        for name in table:
            if name != "headers" and name not in self.structs.values():
                raise Unclear(f"{name} is in no header")

    def add(self, file, kind, path, name):
        self.kinds[name] = kind
        self.origin[name] = (file.name, path)

    def comment(self, name, *path):
        file, start = self.origin[name]
        return self.comments.get((file, start + path), "")

    def fields(self, name):
        return [Field(field.name, field.type, field.type_name, field.label == F.LABEL_REPEATED,
                      self.comment(name, 2, i)) for i, field in enumerate(self.kinds[name].field)]

    def struct_of(self, type_name):
        proto = type_name.removeprefix(".footing.v1.")
        if proto not in self.structs:
            raise Unclear(f"{proto} has no struct: name it in [headers]")
        return self.structs[proto]


def element_type(field, messages):
    if field.type in NUMBERS:
        return NUMBERS[field.type]
    if field.type == F.TYPE_STRING:
        return "std::string", ""
    if field.type == F.TYPE_BYTES:
        return "std::vector<std::uint8_t>", ""
    if field.type == F.TYPE_ENUM:
        name = messages.struct_of(field.type_name)
        return name, f"{name}::kUnspecified"
    if field.type_name in EIGEN:
        return EIGEN[field.type_name]
    return messages.struct_of(field.type_name), ""


def member_of(field, options, messages):
    kind, initial = element_type(field, messages)
    if options.get("static_text"):
        kind, initial = "const char*", '""'
    return Member(options.get("member", field.name), kind, options.get("default", initial), field.comment,
                  [field], options)


def members_of(name, messages, table):
    """The members of a message's struct, in the order of its fields."""
    options = {key: value for key, value in table.get(name, {}).items() if key not in ("parts", "extra", "proto")}
    for key, value in options.items():
        if unknown := set(value) - FIELD_OPTIONS:
            raise Unclear(f"{name}.{key}: unknown option {', '.join(sorted(unknown))}")
    groups = {first: key for key, value in options.items() if "of" in value for first in value["of"]}
    members, seen = [], set()
    fields = messages.fields(name)
    for field in fields:
        key = groups.get(field.name, field.name)
        if key in seen:
            continue
        seen.add(key)
        own = options.get(key, {})
        if "of" not in own:
            members.append(member_of(field, own, messages))
            continue
        kind, initial, _ = OF[len(own["of"])]
        parts = [one for wanted in own["of"] for one in fields if one.name == wanted]
        comment = " ".join(one.comment for one in parts if one.comment)
        members.append(Member(own.get("member", key), kind, initial, comment, parts, own))
    if unknown := set(options) - seen:
        raise Unclear(f"{name} has no field {', '.join(sorted(unknown))}")
    return members


# Structs.


def documented(text, comment, indent=""):
    """A declaration with its comment: behind it where the line has space, otherwise above."""
    line = f"{indent}{text}"
    if not comment:
        return line + "\n"
    if len(line) + 7 + len(comment) <= COLUMNS:
        return f"{line}  ///< {comment}\n"
    return above(comment, indent) + line + "\n"


def above(comment, indent=""):
    return "".join(f"{indent}/// {line}\n" for line in textwrap.wrap(comment, COLUMNS - len(indent) - 4))


def declaration(member):
    name = member.path.split(".")[-1]
    own = member.options
    if "array" in own:
        return f"std::array<{member.type}, {own['array']}> {name} = {{}};"
    if member.fields[0].repeated:
        return f"std::vector<{member.type}> {name};"
    if own.get("optional"):
        return f"std::optional<{member.type}> {name} = std::nullopt;"
    return f"{member.type} {name}{f' = {member.initial}' if member.initial else ''};"


def struct(name, comment, lines):
    equal = f"\n  friend bool operator==(const {name}&, const {name}&) = default;\n"
    return f"{above(comment)}struct {name} {{\n{''.join(lines)}{equal}}};\n"


def struct_of(name, messages, table):
    parts = table.get(name, {}).get("parts", {})
    lines, of_part = [], {part: [] for part in parts}
    for member in members_of(name, messages, table):
        if "computed" in member.options:
            continue
        into = lines
        if "." in member.path:
            part = member.path.split(".")[0]
            into = of_part[part]
            if not into:
                lines.append(f"  {parts[part][0]} {part} = {{}};\n")
        if "flag" in member.options:
            into.append(f"  bool {member.options['flag']} = false;\n")
        into.append(documented(declaration(member), member.comment, "  "))
    for part, extra in table.get(name, {}).get("extra", {}).items():
        of_part[part] += [f"  {line}\n" for line in extra]
    text = "".join(struct(parts[part][0], parts[part][1], of_part[part]) + "\n" for part in parts)
    return text + struct(name, messages.comment(name), lines)


def values_of(proto, messages):
    """Name without its prefix, number and comment of an enum's values."""
    values = messages.kinds[proto].value
    prefix = values[0].name.removesuffix("UNSPECIFIED")
    for i, value in enumerate(values):
        if not value.name.startswith(prefix):
            raise Unclear(f"{value.name} does not begin with {prefix}")
        yield value.name.removeprefix(prefix), value.number, messages.comment(proto, 2, i)


def enum_of(name, messages, table):
    own = table.get(name, {})
    if unknown := set(own) - ENUM_OPTIONS:
        raise Unclear(f"{name}: unknown option {', '.join(sorted(unknown))}")
    proto = own.get("proto", name)
    values = list(values_of(proto, messages))
    text = above(messages.comment(proto))
    if "flags" in own:
        lines = [documented(f"{own['flags']}{camel(value)} = {number:#x},", comment, "  ")
                 for value, number, comment in values[1:]]
        return f"{text}enum {name} : std::uint32_t {{\n{''.join(lines)}}};\n"
    lines = [documented(f"k{camel(value)} = {number},", comment, "  ") for value, number, comment in values]
    text += f"enum class {name} {{\n{''.join(lines)}}};\n"
    if "all" in own:
        joined = ", ".join(f"{name}::k{camel(value)}" for value, _, _ in values[1:])
        text += wrapped(f"inline constexpr std::array {own['all']}{{{joined}}};\n")
    names = names_of(name, messages, table)
    shown = '"' + '", "'.join(names[1:4]) + ('", ...' if len(names) > 4 else '"')
    text += f"/// {shown}; of kUnspecified \"{names[0]}\".\nconst char* Name({name} value);\n"
    if "named" in own:
        text += f"/// The value of that name; kUnspecified when there is none.\n{name} {own['named']}(const std::string& name);\n"
    if "list" in own:
        text += f"/// All names, separated by commas: for errors.\nstd::string {own['list']}();\n"
    return text


def names_of(name, messages, table):
    own = table.get(name, {})
    names = []
    for value, number, _ in values_of(own.get("proto", name), messages):
        if number < len(names):
            raise Unclear(f"{name}: its numbers do not rise from 0")
        text = own.get("unspecified", "unknown")
        names += [text] * (number - len(names))  # Numbers that no value has.
        if number > 0:
            text = own.get("names", {}).get(value.lower(), value.lower())
        names.append(text.replace("_", " ") if own.get("spaces") else text)
    return names


def wrapped(line):
    first, *rest = textwrap.wrap(line.strip(), COLUMNS - 4, break_long_words=False)
    return "\n".join([first] + ["    " + one for one in rest]) + "\n"


def is_enum(name, messages, table):
    return isinstance(messages.kinds[table.get(name, {}).get("proto", name)], descriptor_pb2.EnumDescriptorProto)


def header(topic, messages, table):
    body = []
    for name in table["headers"][topic]:
        body.append((enum_of if is_enum(name, messages, table) else struct_of)(name, messages, table))
    text = "\n".join(body)
    standard = {include for word, include in STANDARD.items() if word in text}
    eigen = {"Geometry" if "Quaternion" in text else "Core"} if "Eigen::" in text else set()
    ours = []
    for other, names in table["headers"].items():
        if other == topic:
            break
        if any(re.search(rf"\b{name}\b", re.sub("//.*", "", text)) for name in names):
            ours.append(f'#include "common/stream/{other}.h"\n')
    first = [f"#include <Eigen/{one}>\n" for one in sorted(eigen)] + [f"#include <{one}>\n" for one in sorted(standard)]
    includes = "".join(first) + ("\n" if first and ours else "") + "".join(ours)
    return (f"{MAKER}#pragma once\n\n{includes}\nnamespace footing::stream {{\n\n{text}\n}}  // namespace footing::stream\n")


NAMES_CC = """{maker}#include <array>
#include <cstddef>
#include <string>

{includes}
namespace footing::stream {{
namespace {{

{arrays}
template <std::size_t N, typename Enum>
const char* At(const std::array<const char*, N>& names, Enum value) {{
  const auto index = static_cast<std::size_t>(value);
  return index < N ? names[index] : names[0];
}}

template <typename Enum, std::size_t N>
Enum Named(const std::array<const char*, N>& names, const std::string& name) {{
  for (std::size_t i = 1; i < N; ++i) {{
    if (name == names[i]) return static_cast<Enum>(i);
  }}
  return Enum::kUnspecified;
}}

template <std::size_t N>
std::string Joined(const std::array<const char*, N>& names) {{
  std::string joined;
  for (std::size_t i = 1; i < N; ++i) joined += (i == 1 ? "" : ", ") + std::string(names[i]);
  return joined;
}}

}}  // namespace

{functions}
}}  // namespace footing::stream
"""


def names_source(messages, table):
    arrays, functions, includes = "", "", ""
    for topic, names in table["headers"].items():
        enums = [name for name in names if is_enum(name, messages, table) and "flags" not in table.get(name, {})]
        includes += f'#include "common/stream/{topic}.h"\n' if enums else ""
        for name in enums:
            own = table.get(name, {})
            joined = ", ".join(f'"{one}"' for one in names_of(name, messages, table))
            arrays += wrapped(f"constexpr std::array k{name}Names = {{{joined}}};\n")
            functions += f"const char* Name({name} value) {{ return At(k{name}Names, value); }}\n"
            if "named" in own:
                functions += (f"{name} {own['named']}(const std::string& name) {{\n"
                              f"  return Named<{name}>(k{name}Names, name);\n}}\n")
            if "list" in own:
                functions += f"std::string {own['list']}() {{ return Joined(k{name}Names); }}\n"
    return NAMES_CC.format(maker=MAKER, includes=includes, arrays=arrays, functions=functions)


# Conversions. `value` is the struct, `message` the Protobuf message.


def cpp_enum(field):
    return field.type_name.removeprefix(".footing.v1.").replace(".", "_")


def sent(field, value):
    """The expression that is set for a scalar field."""
    if field.type in REALS:
        return f"Finite({value})"
    if field.type == F.TYPE_STRING:
        return f"Utf8({value})"
    if field.type == F.TYPE_ENUM:
        return f"static_cast<v1::{cpp_enum(field)}>({value})"
    return value


def received(field, kind, value, as_is):
    if field.type in REALS and not as_is:
        return f"Finite({value})"
    if field.type == F.TYPE_ENUM:
        return f"Known<stream::{kind}>({value}, &v1::{cpp_enum(field)}_IsValid)"
    if field.type == F.TYPE_MESSAGE:
        return f"{'AsIs' if as_is else 'FromProto'}({value})"
    return value


def write_lines(member):
    own, field, value = member.options, member.fields[0], f"value.{member.path}"
    if "of" in own:
        axes = OF[len(own["of"])][2]
        return [f"message.set_{one.name}(Finite({value}.{axis}()));" for one, axis in zip(member.fields, axes)]
    name = field.name
    if "computed" in own:
        return [f"message.set_{name}({own['computed']});"]
    if "static_text" in own:
        return [f"message.set_{name}({value});"]
    if field.type == F.TYPE_BYTES and not field.repeated:
        return [f"message.set_{name}({value}.data(), {value}.size());"]
    if field.type != F.TYPE_MESSAGE:
        if field.repeated:
            return [f"for (const auto& one : {value}) message.add_{name}({sent(field, 'one')});"]
        return [f"message.set_{name}({sent(field, value)});"]
    if field.repeated:
        return [f"for (const auto& one : {value}) Write(one, *message.add_{name}());"]
    if own.get("optional"):
        return [f"if ({value}) Write(*{value}, *message.mutable_{name}());"]
    condition = ""
    if "flag" in own:
        condition = f"if (value.{own['flag']}) "
    elif own.get("omit_zero"):
        condition = f"if (!{value}.isZero(0)) "
    return [f"{condition}Write({value}, *message.mutable_{name}());"]


def read_lines(member, as_is):
    own, field, value = member.options, member.fields[0], f"value.{member.path}"
    as_is = as_is or own.get("as_is", False)
    name = f"message.{field.name}()"
    if "computed" in own or "static_text" in own:
        return []
    if "of" in own:
        numbers = ", ".join(received(one, "", f"message.{one.name}()", as_is) for one in member.fields)
        return [f"{value} = {{{numbers}}};"]
    if field.type == F.TYPE_BYTES and not field.repeated:
        return [f"{value}.assign({name}.begin(), {name}.end());"]
    if "array" in own or "most" in own:
        one = received(field, member.type, f"message.{field.name}(i)", as_is)
        most = own.get("array", own.get("most"))
        taken = f"{value}[static_cast<std::size_t>(i)] = {one}" if "array" in own else f"{value}.push_back({one})"
        return [f"for (int i = 0; i < std::min(message.{field.name}_size(), {most}); ++i) {{", f"  {taken};", "}"]
    if field.repeated:
        if field.type in (F.TYPE_MESSAGE, F.TYPE_ENUM, *REALS):
            one = received(field, member.type, "one", as_is)
            return [f"{value}.reserve(static_cast<std::size_t>(message.{field.name}_size()));",
                    f"for (const auto& one : {name}) {value}.push_back({one});"]
        return [f"{value}.assign({name}.begin(), {name}.end());"]
    lines = []
    if "flag" in own:
        lines.append(f"value.{own['flag']} = message.has_{field.name}();")
    condition = f"if (message.has_{field.name}()) " if own.get("optional") else ""
    return lines + [f"{condition}{value} = {received(field, member.type, name, as_is)};"]


def as_is_structs(messages, table):
    """Structs that come in as they are somewhere: as fields with `as_is`."""
    found = set()
    for name in struct_names(messages, table):
        for member in members_of(name, messages, table):
            if member.options.get("as_is") and member.fields[0].type == F.TYPE_MESSAGE:
                found.add(member.type)
    return found


def struct_names(messages, table):
    return [name for names in table["headers"].values() for name in names if not is_enum(name, messages, table)]


def indented(lines):
    return "".join(f"  {line}\n" for line in lines)


def conversions_of(name, messages, table, as_is_too):
    members = members_of(name, messages, table)
    text = (f"void Write(const stream::{name}& value, v1::{name}& message) {{\n"
            + indented(line for member in members for line in write_lines(member)) + "}\n\n"
            f"v1::{name} ToProto(const stream::{name}& value) {{\n  v1::{name} message;\n"
            "  Write(value, message);\n  return message;\n}\n\n")
    for function, as_is in (("FromProto", False), ("AsIs", True)):
        if as_is and not as_is_too:
            continue
        text += (f"stream::{name} {function}(const v1::{name}& message) {{\n  stream::{name} value;\n"
                 + indented(line for member in members for line in read_lines(member, as_is))
                 + "  return value;\n}\n\n")
    return text


CONVERSIONS_H = """{maker}#pragma once

#include <tuple>

{includes}
namespace footing::wire {{

{declarations}
/// Every message that has a struct, for tests.
using Messages = std::tuple<
{messages}>;

}}  // namespace footing::wire
"""
CONVERSIONS_CC = """{maker}#include "common/wire/messages.h"

#include <algorithm>
#include <cstddef>

#include "common/wire/scalar.h"
#include "common/wire/wire.h"

namespace footing::wire {{
namespace {{

template <typename Enum>
Enum Known(int number, bool (*is_valid)(int)) {{
  return is_valid(number) ? static_cast<Enum>(number) : Enum::kUnspecified;
}}

}}  // namespace

{functions}}}  // namespace footing::wire
"""


def conversion_files(messages, table):
    names = struct_names(messages, table)
    as_is = as_is_structs(messages, table)
    declarations = ""
    for name in names:
        declarations += (f"void Write(const stream::{name}& value, v1::{name}& message);\n"
                         f"v1::{name} ToProto(const stream::{name}& value);\n"
                         f"stream::{name} FromProto(const v1::{name}& message);\n")
        if name in as_is:
            declarations += f"stream::{name} AsIs(const v1::{name}& message);\n"
    includes = "".join(f'#include "common/stream/{topic}.h"\n' for topic in sorted(table["headers"]))
    files = sorted({messages.origin[name][0] for name in names})
    includes += "".join(f'#include "{file.removesuffix(".proto")}.pb.h"\n' for file in files)
    listed = ",\n".join(f"    v1::{name}" for name in names)
    functions = "".join(conversions_of(name, messages, table, name in as_is) for name in names)
    return {
        "common/wire/messages.h": CONVERSIONS_H.format(maker=MAKER, includes=includes, declarations=declarations,
                                                       messages=listed),
        "common/wire/messages.cc": CONVERSIONS_CC.format(maker=MAKER, functions=functions),
    }


def struct_files(messages, table):
    files = {f"common/stream/{topic}.h": header(topic, messages, table) for topic in table["headers"]}
    files["common/stream/messages.cc"] = names_source(messages, table)
    return files


def read_protos(protoc, protos):
    root = protos[0].parents[2]
    result = subprocess.run([protoc, "-I", root, "--include_source_info", "--descriptor_set_out=/dev/stdout", *protos],
                            stdout=subprocess.PIPE, check=True)
    return descriptor_pb2.FileDescriptorSet.FromString(result.stdout).file


def main(which, out, table, protoc, *protos):
    table = tomllib.loads(pathlib.Path(table).read_text())
    messages = Messages(read_protos(protoc, [pathlib.Path(one) for one in protos]), table)
    for name, text in (struct_files if which == "structs" else conversion_files)(messages, table).items():
        path = pathlib.Path(out) / name
        path.parent.mkdir(parents=True, exist_ok=True)
        if not path.exists() or path.read_text() != text:
            path.write_text(text)


if __name__ == "__main__":
    try:
        main(*sys.argv[1:])
    except (Unclear, subprocess.CalledProcessError) as error:
        sys.exit(f"generate_structs.py: {error}")
