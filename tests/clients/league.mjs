// A host of the league in Node: protobufjs reads the .proto files, dgram carries them. SOURCE ROBOT_PORT GROUP VISION_PORT in;
// drives robot 3 forward until vision has seen it move 300 mm, and says what it saw, as a line of JSON.
import dgram from "node:dgram";
import path from "node:path";
import { npm } from "./npm.mjs";

const protobuf = npm("protobufjs");
const [source, robotPort, group, visionPort] = process.argv.slice(2);
const root = new protobuf.Root();
root.resolvePath = (_, name) => (path.isAbsolute(name) ? name : path.join(source, name));
await root.load(["hil/league/messages/ssl_simulation.proto", "hil/league/messages/ssl_vision.proto"], { keepCase: true });
const type = (name) => root.lookupType(name);
const Control = type("RobotControl"), Answer = type("RobotControlResponse"), Wrapper = type("SSL_WrapperPacket");

const commands = dgram.createSocket("udp4"), vision = dgram.createSocket({ type: "udp4", reuseAddr: true });
const seen = { errors: 0, feedback: [], answers: 0 };
let start;
function drive() {
  const message = { robot_commands: [{ id: 3, move_command: { local_velocity: { forward: 0.8, left: 0, angular: 0 } } }] };
  const problem = Control.verify(message);
  if (problem) throw new Error(problem);
  commands.send(Control.encode(Control.create(message)).finish(), Number(robotPort), "127.0.0.1");
}
commands.on("message", (bytes) => {
  const answer = Answer.decode(bytes);
  ++seen.answers;
  seen.errors += answer.errors.length;
  seen.feedback = answer.feedback.map((f) => f.id);
});
vision.on("message", (bytes) => {
  const { detection, geometry } = Wrapper.decode(bytes);
  if (geometry) seen.field_mm = [geometry.field.field_length, geometry.field.field_width];
  const robot = detection?.robots_blue.find((r) => r.robot_id === 3);
  if (robot === undefined) return;
  start ??= robot.x;
  seen.moved_mm = robot.x - start;
  if (seen.moved_mm > 300 && seen.field_mm && seen.answers > 0) {
    console.log(JSON.stringify(seen));
    process.exit(0);
  }
  drive(); // at the rhythm of vision, as a host does
});
vision.bind(Number(visionPort), () => vision.addMembership(group, "127.0.0.1"));
