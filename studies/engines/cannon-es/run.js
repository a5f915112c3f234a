// Runs a free body in cannon-es and prints a trajectory as CSV.
//
//     node run.js case.json --rate 60 --for 2 > cannon.csv
//
// case.json is what `exact --scene torque-free-spin --case` prints. --defaults keeps the engine's damping.
import { readFileSync } from "node:fs";
import { parseArgs } from "node:util";
import { Body, Vec3, World } from "cannon-es";

const { values: flags, positionals } = parseArgs({
  allowPositionals: true,
  options: {
    rate: { type: "string", default: "60" },
    for: { type: "string", default: "2" },
    defaults: { type: "boolean", default: false },
  },
});
const fail = (message) => {
  console.error(`run.js: ${message}`);
  process.exit(2);
};
if (positionals.length !== 1) fail("give one file: node run.js case.json");
const rate = Number(flags.rate);
const length = Number(flags.for);
if (!(rate > 0 && length > 0)) fail("--rate and --for are numbers > 0");

const { parameters, scene, start } = JSON.parse(readFileSync(positionals[0], "utf8"));
const inertia = parameters.find((parameter) => parameter.name === "inertia")?.value;
if (!inertia || !["torque-free-spin", "tennis-racket"].includes(scene.split("/")[0])) {
  fail(`scene ${scene}: give a free body: torque-free-spin or tennis-racket`);
}

const world = new World({ gravity: new Vec3(0, 0, 0) });
const body = new Body({ mass: 1 });
body.inertia.set(...inertia);
body.invInertia.set(...inertia.map((moment) => 1 / moment));
body.quaternion.set(start.qx, start.qy, start.qz, start.qw);
body.angularVelocity.set(start.omega_world_x_rad_s, start.omega_world_y_rad_s, start.omega_world_z_rad_s);
body.updateInertiaWorld(true);
if (!flags.defaults) {
  body.linearDamping = 0;
  body.angularDamping = 0;
}
world.addBody(body);

const rows = ["t,qw,qx,qy,qz,wx_world,wy_world,wz_world"];
for (let i = 0; i <= Math.round(length * rate); i += 1) {
  const { quaternion: q, angularVelocity: w } = body;
  rows.push([i / rate, q.w, q.x, q.y, q.z, w.x, w.y, w.z].join(","));
  world.step(1 / rate);
}
console.log(rows.join("\n"));
