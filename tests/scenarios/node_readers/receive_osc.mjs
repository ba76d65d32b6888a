// Receives OSC by npm's osc until nothing comes for a second, and prints what came, by address, as JSON: how many, the
// types of the last one, whether their first arguments rise, and the largest step between two.
// Usage: node receive_osc.mjs; prints its port first. Runs from a copy beside node_modules.
import osc from "osc";

const port = new osc.UDPPort({localAddress: "127.0.0.1", localPort: 0, metadata: true});
const seen = {};
const errors = [];
let last_ms = null;

function take(message) {
  last_ms = Date.now();
  const row = (seen[message.address] ??= {count: 0, rises: true, largest_step: 0, last: null});
  const first = message.args[0];
  row.rises &&= row.last === null || first?.type !== "f" || first.value > row.last;
  if (row.last !== null && first?.type === "f") row.largest_step = Math.max(row.largest_step, first.value - row.last);
  row.last = first?.value ?? null;
  row.types = message.args.map(one => one.type).join("");
  row.count += 1;
}

port.on("message", take);
port.on("error", error => errors.push(String(error)));
port.on("ready", () => console.log(port.socket.address().port));
port.open();
setInterval(() => {
  if (last_ms === null || Date.now() - last_ms < 1000) return;
  console.log(JSON.stringify({seen, errors}));
  process.exit(0);
}, 100);
