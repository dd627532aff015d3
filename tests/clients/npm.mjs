// Packages of npm for the clients beside this file: package("serialport"); exit code 77 where npm brought none.
import { createRequire } from "node:module";
import path from "node:path";

export function npm(name) {
  try {
    return createRequire(path.join(process.env.OMNIHIL_CLIENTS_NPM, "package.json"))(name);
  } catch {
    console.log(`skipped: needs ${name}, which npm brings at build`);
    process.exit(77);
  }
}
