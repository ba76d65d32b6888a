// Prints the messages of Foxglove's topics in a recording, as @mcap/core reads them, and writes the .proto files that
// Foxglove's own package has for their schemas. Usage: node foxglove.mjs FILE PROTO_FOLDER. Runs from a copy beside
// node_modules.
import {mkdir, readFile, writeFile} from "node:fs/promises";
import schemasOfFoxglove from "@foxglove/schemas/internal.js";
import {McapStreamReader} from "@mcap/core";
import {decompress} from "fzstd";

const {foxgloveEnumSchemas, foxgloveMessageSchemas, generateProto} = schemasOfFoxglove;
const [path, folder] = process.argv.slice(2);
await mkdir(`${folder}/foxglove`, {recursive: true});
for (const schema of Object.values(foxgloveMessageSchemas)) {
  const enums = Object.values(foxgloveEnumSchemas).filter(one => one.parentSchemaName === schema.name);
  await writeFile(`${folder}/foxglove/${schema.name}.proto`, generateProto(schema, enums));
}

const decompressHandlers = {zstd: (bytes, size) => decompress(bytes, new Uint8Array(Number(size)))};
const reader = new McapStreamReader({validateCrcs: true, decompressHandlers});
reader.append(await readFile(path));
const schemas = new Map();
const topics = {};
const channels = new Map();
for (let record; (record = reader.nextRecord());) {
  if (record.type === "Schema") schemas.set(record.id, record);
  if (record.type === "Channel" && !channels.has(record.id)) {
    const schema = schemas.get(record.schemaId);
    channels.set(record.id, {schema: schema.name, encoding: schema.encoding,
                             descriptors: Buffer.from(schema.data).toString("base64"), messages: []});
    topics[record.topic] = channels.get(record.id);
  }
  if (record.type === "Message") {
    channels.get(record.channelId).messages.push([record.logTime.toString(), Buffer.from(record.data).toString("base64")]);
  }
}
console.log(JSON.stringify(Object.fromEntries(Object.entries(topics).filter(([name]) => name.startsWith("/foxglove/")))));
