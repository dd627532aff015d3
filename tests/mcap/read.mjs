// Reads an MCAP file by @mcap/core, sequentially and by its indexes, and prints what is in it as one JSON line.
import { readFile } from "node:fs/promises";
import { createRequire } from "node:module";
import path from "node:path";

const npm = process.env.OMNIHIL_MCAP_NPM;
let core;
try {
  core = createRequire(path.join(npm, "package.json"))("@mcap/core");
} catch {
  console.log("needs @mcap/core, which npm brings at build");
  process.exit(77);
}
const bytes = new Uint8Array(await readFile(process.argv[2]));
const topics = {}, schemas = {};
let values = 0, last = 0n, ordered = true;

const streamed = new core.McapStreamReader();
streamed.append(bytes);
const channels = new Map();
for (let record; (record = streamed.nextRecord()); ) {
  if (record.type === "Schema") schemas[record.name] = JSON.parse(new TextDecoder().decode(record.data)).type;
  if (record.type === "Channel") channels.set(record.id, record.topic);
  if (record.type !== "Message") continue;
  const topic = channels.get(record.channelId);
  topics[topic] = (topics[topic] ?? 0) + 1;
  const json = JSON.parse(new TextDecoder().decode(record.data));
  values += topic.startsWith("/robot") ? Object.keys(json).length : Object.keys(json.fields).length;
  ordered &&= record.logTime >= last;
  last = record.logTime;
}
if (!streamed.done()) throw new Error("the file does not end with its footer and magic");

const indexed = await core.McapIndexedReader.Initialize({
  readable: {
    size: async () => BigInt(bytes.length),
    read: async (offset, length) => bytes.slice(Number(offset), Number(offset + length)),
  },
});
const again = {};
for await (const message of indexed.readMessages()) {
  const topic = indexed.channelsById.get(message.channelId).topic;
  again[topic] = (again[topic] ?? 0) + 1;
}
console.log(JSON.stringify({
  topics, again, schemas, values, ordered,
  statistics: Number(indexed.statistics.messageCount),
  start: indexed.statistics.messageStartTime.toString(), end: indexed.statistics.messageEndTime.toString(),
}));
