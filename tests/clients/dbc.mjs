// A main board in Node that knows the bus by its DBC file alone: serialport opens the USB-CAN stick, candied reads the file.
// DEVICE DBC in; drives node 2 to 4 rev/s and says what it saw, as a line of JSON.
import { readFileSync } from "node:fs";
import { npm } from "./npm.mjs";

const { SerialPort, ReadlineParser } = npm("serialport");
const { Can, Dbc } = npm("candied");
const [device, file] = process.argv.slice(2);
const can = new Can();
const database = new Dbc().load(readFileSync(file, "utf8"));
can.database = database;
const messages = database.messages;

// candied places the bits; it takes a float's bits for an integer.
const asFloat = (raw) => new Float32Array(Int32Array.of(raw).buffer)[0];
const asBits = (value) => new Uint32Array(Float32Array.of(value).buffer)[0];
function decode(id, payload) {
  const bound = can.decode(can.createFrame(id, payload));
  if (bound === undefined) return undefined;
  const values = {};
  for (const [name, signal] of bound.boundSignals) {
    const kind = bound.boundData.message.signals.get(name).dataType;
    values[name] = kind === "float" ? asFloat(signal.rawValue) : signal.physValue;
  }
  return { name: bound.name, values };
}

function line(name, values) {
  const message = messages.get(name);
  const data = Buffer.alloc(message.dlc);
  for (const [signal, value] of Object.entries(values)) {
    const { startBit, length, dataType } = message.signals.get(signal);
    if (startBit % 8 !== 0 || length !== 32) throw new Error(`${signal}: not four whole bytes`);
    data.writeUInt32LE(dataType === "float" ? asBits(value) : value, startBit / 8);
  }
  return `t${message.id.toString(16).padStart(3, "0")}${message.dlc}${data.toString("hex")}\r`;
}

const port = new SerialPort({ path: device, baudRate: 115200, hupcl: false });
const lines = port.pipe(new ReadlineParser({ delimiter: "\r" }));
const seen = { states: [], unknown: 0, frames: 0 };
port.on("open", () => {
  port.write("S8\rO\r");
  port.write(line("ODrive2_Set_Controller_Mode", { Control_Mode: 2, Input_Mode: 1 }));
  port.write(line("ODrive2_Set_Axis_State", { Axis_Requested_State: 8 }));
});
lines.on("data", (text) => {
  const found = /t([0-9A-F]{3})([0-8])([0-9A-F]*)$/.exec(text);
  if (found === null) return;
  ++seen.frames;
  const decoded = decode(parseInt(found[1], 16), [...Buffer.from(found[3], "hex")]);
  if (decoded === undefined) {
    ++seen.unknown;
  } else if (decoded.name === "ODrive2_Heartbeat") {
    const state = decoded.values.Axis_State;
    if (seen.states.at(-1) !== state) seen.states.push(state);
  } else if (decoded.name === "ODrive2_Get_Encoder_Estimates") {
    port.write(line("ODrive2_Set_Input_Vel", { Input_Vel: 4, Input_Torque_FF: 0 }));
    if (Math.abs(decoded.values.Vel_Estimate - 4) > 0.08 || seen.states.at(-1) !== "CLOSED_LOOP_CONTROL") return;
    seen.speed_rev_s = decoded.values.Vel_Estimate;
    lines.removeAllListeners();
    port.close(() => console.log(JSON.stringify(seen)));
  }
});
