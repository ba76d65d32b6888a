// Follows a server as Foxglove's own client for its WebSocket protocol does, until each of the named topics has sent a
// message. Usage: node follow_foxglove.mjs ADDRESS TOPIC... Prints the messages as {topic: {schema, count, bytes}}. Runs
// from a copy beside node_modules.
import protocol from "@foxglove/ws-protocol";
import {WebSocket} from "ws";

const {FoxgloveClient} = protocol;
const [address, ...topics] = process.argv.slice(2);
const followed = {};
const byId = new Map();
const client = new FoxgloveClient({ws: new WebSocket(address, [FoxgloveClient.SUPPORTED_SUBPROTOCOL])});
client.on("error", error => { console.error(`${error}`); process.exit(1); });
client.on("close", () => { console.error("closed"); process.exit(1); });
client.on("advertise", channels => {
  for (const channel of channels) {
    followed[channel.topic] = {schema: channel.schemaName, described: Buffer.from(channel.schema, "base64").length,
                               count: 0, bytes: 0};
    byId.set(client.subscribe(channel.id), followed[channel.topic]);
  }
});
client.on("message", ({subscriptionId, data}) => {
  const topic = byId.get(subscriptionId);
  topic.count += 1;
  topic.bytes += data.byteLength;
  if (topics.every(name => followed[name]?.count > 0)) {
    console.log(JSON.stringify(followed));
    process.exit(0);
  }
});
