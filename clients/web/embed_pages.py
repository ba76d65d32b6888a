"""Writes the files of the pages, compressed, as C++: page_files.cc.

Usage: embed_pages.py PAGE_FOLDER DESCRIPTOR_SET OUT.cc

Besides the files of the folder there is schema.js: the messages of the protocol as a table that page/protobuf.js reads,
out of protoc's descriptors. Scripts are sent without their lines of comment, which a phone would only load.
"""
import gzip
import hashlib
import json
import pathlib
import re
import sys

from google.protobuf import descriptor_pb2

TYPES = {".html": "text/html; charset=utf-8", ".js": "text/javascript; charset=utf-8", ".css": "text/css; charset=utf-8",
         ".svg": "image/svg+xml"}
ROOTS = ("Envelope", "DeviceEnvelope")
Field = descriptor_pb2.FieldDescriptorProto
# How a field is read, as page/protobuf.js knows it.
SCALARS = {Field.TYPE_DOUBLE: "d", Field.TYPE_FLOAT: "f", Field.TYPE_UINT64: "u", Field.TYPE_INT64: "l", Field.TYPE_UINT32: "w",
           Field.TYPE_INT32: "i", Field.TYPE_SINT32: "z", Field.TYPE_BOOL: "b", Field.TYPE_ENUM: "i", Field.TYPE_STRING: "s",
           Field.TYPE_BYTES: "y"}


def schema_of(descriptors):
    """The messages that the roots reach, and all enumerations, as the text of schema.js."""
    messages, enums = {}, {}

    def collect(prefix, entries, nested_enums):
        for enum in nested_enums:
            # Without what every name of the enumeration begins with: GAIT_WALK of Gait is WALK.
            names = [value.name for value in enum.value]
            common = names[0].removesuffix("UNSPECIFIED")
            enums[prefix + enum.name] = {value.number: value.name.removeprefix(common).lower() for value in enum.value
                                         if value.number}
        for message in entries:
            messages[prefix + message.name] = message
            collect(prefix + message.name + ".", message.nested_type, message.enum_type)

    for file in descriptors.file:
        collect("", file.message_type, file.enum_type)
    table, todo = {}, list(ROOTS)
    while todo:
        name = todo.pop()
        if name in table:
            continue
        table[name] = {}
        for field in messages[name].field:
            if field.type == Field.TYPE_MESSAGE:
                kind = field.type_name.removeprefix(".footing.v1.")
                todo.append(kind)
            else:
                kind = SCALARS[field.type]
                # Instants become numbers, in which a nanosecond of a day is exact; others need all their digits.
                kind = "n" if kind in "ul" and field.name.endswith("_ns") else kind
            entry = [field.name, kind]
            if field.label == Field.LABEL_REPEATED:
                entry.append(1)
            table[name][field.number] = entry
    compact = {"separators": (",", ":")}
    return ("// The messages of proto/footing/v1: number of a field to its name, its kind, and 1 if it is repeated.\n"
            f"export const MESSAGES = {json.dumps(dict(sorted(table.items())), **compact)};\n"
            f"export const ENUMS = {json.dumps(dict(sorted(enums.items())), **compact)};\n")


def literal(content):
    """Bytes as C++ string literals of a line each."""
    lines = [content[i:i + 32] for i in range(0, len(content), 32)]
    return "\n".join('    "' + "".join(f"\\{byte:03o}" for byte in line) + '"' for line in lines) or '    ""'


def main():
    folder, descriptor_set, out = map(pathlib.Path, sys.argv[1:])
    descriptors = descriptor_pb2.FileDescriptorSet.FromString(descriptor_set.read_bytes())
    files = {path.name: path.read_bytes() for path in folder.iterdir() if path.suffix in TYPES}
    files["schema.js"] = schema_of(descriptors).encode()
    files = {name: re.sub(rb"(?m)^\s*//.*\n", b"", content) if name.endswith(".js") else content for name, content in files.items()}
    entries = []
    for name, content in sorted(files.items()):
        packed = gzip.compress(content, 9, mtime=0)
        etag = hashlib.sha256(content).hexdigest()[:16]
        entries.append(f'      {{"{name}", "{TYPES[pathlib.Path(name).suffix]}", "\\"{etag}\\"",\n'
                       f"       std::string_view(\n{literal(packed)},\n       {len(packed)})}},\n")
    out.write_text('#include "clients/web/web_server.h"\n\nnamespace footing::web {\n\n'
                   "const std::vector<PageFile>& PageFiles() {\n  static const std::vector<PageFile> kFiles = {\n"
                   + "".join(entries) + "  };\n  return kFiles;\n}\n\n}  // namespace footing::web\n")


if __name__ == "__main__":
    main()
