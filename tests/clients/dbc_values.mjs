// A DBC file read by candied: FILE in, on stdin lines of JSON {id, data: [bytes]}; out, line by line, the message's name and its
// signals' values.
import { readFileSync } from "node:fs";
import { npm } from "./npm.mjs";

const { Can, Dbc } = npm("candied");
const can = new Can();
const database = new Dbc().load(readFileSync(process.argv[2], "utf8"));
can.database = database;
// candied places the bits; it takes a float's bits for an integer.
const asFloat = (raw) => new Float32Array(Int32Array.of(raw).buffer)[0];
for (const line of readFileSync(0, "utf8").split("\n").filter((text) => text !== "")) {
  const { id, data } = JSON.parse(line);
  if (data.length === 0) {  // candied makes no frame of nothing
    const found = [...database.messages.values()].find((message) => message.id === id && message.dlc === 0);
    console.log(JSON.stringify({ name: found?.name ?? null, values: {} }));
    continue;
  }
  const bound = can.decode(can.createFrame(id, data));
  const values = {};
  for (const [name, signal] of bound?.boundSignals ?? []) {
    const rows = bound.boundData.message.signals.get(name);
    values[name] = rows.dataType === "float" ? asFloat(signal.rawValue) : signal.rawValue * rows.factor + rows.offset;
  }
  console.log(JSON.stringify({ name: bound?.name ?? null, values }));
}
