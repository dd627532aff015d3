// A host in Node: serialport (npm). DEVICE HEX COUNT in, the hex of COUNT answers out, each up to and with its 00.
import { npm } from "./npm.mjs";

const { SerialPort, DelimiterParser } = npm("serialport");
const [device, hex, count] = process.argv.slice(2);
const port = new SerialPort({ path: device, baudRate: 115200, hupcl: false });
const answers = port.pipe(new DelimiterParser({ delimiter: Buffer.from([0]), includeDelimiter: true }));
let left = Number(count);
port.on("open", () => port.write(Buffer.from(hex, "hex")));
port.on("error", (why) => {
  console.error(String(why));
  process.exit(1);
});
answers.on("data", (answer) => {
  console.log(answer.toString("hex"));
  if (--left === 0) port.close();
  else port.write(Buffer.from(hex, "hex"));
});
