// Reads a recording with @mcap/core, through its index and as a stream, and prints what both found.
// Usage: node read_mcap.mjs FILE. Runs from a copy beside node_modules.
import {open, readFile} from "node:fs/promises";
import {McapIndexedReader, McapStreamReader} from "@mcap/core";
import {decompress} from "fzstd";

const decompressHandlers = {zstd: (bytes, size) => decompress(bytes, new Uint8Array(Number(size)))};

async function readIndexed(path) {
  const file = await open(path);
  const readable = {
    size: async () => BigInt((await file.stat()).size),
    read: async (offset, size) => {
      const bytes = new Uint8Array(Number(size));
      await file.read(bytes, 0, bytes.length, Number(offset));
      return bytes;
    },
  };
  const reader = await McapIndexedReader.Initialize({readable, decompressHandlers});
  const counts = {};
  for await (const message of reader.readMessages()) {
    const topic = reader.channelsById.get(message.channelId).topic;
    counts[topic] = (counts[topic] ?? 0) + 1;
  }
  const attachments = [];
  for await (const attachment of reader.readAttachments()) attachments.push(attachment.name);
  const metadata = [];
  for await (const entry of reader.readMetadata()) metadata.push(entry.name);
  await file.close();
  return {counts, attachments, metadata, statistics: Number(reader.statistics.messageCount),
          schemas: [...reader.schemasById.values()].map(s => `${s.name} ${s.encoding}`)};
}

async function readStream(path) {
  const reader = new McapStreamReader({validateCrcs: true, decompressHandlers});
  const bytes = await readFile(path);
  const counts = {};
  const topics = new Map();
  for (let offset = 0; offset < bytes.length; offset += 1000) {
    reader.append(bytes.subarray(offset, offset + 1000));
    for (let record; (record = reader.nextRecord());) {
      if (record.type === "Channel") topics.set(record.id, record.topic);
      if (record.type !== "Message") continue;
      const topic = topics.get(record.channelId);
      counts[topic] = (counts[topic] ?? 0) + 1;
    }
  }
  return {counts, done: reader.done()};
}

const path = process.argv[2];
console.log(JSON.stringify({indexed: await readIndexed(path), stream: await readStream(path)}));
