// What the page does with each scene: how long, which steps, which picture. Physics is the module's.
const norm = (v) => Math.hypot(...v);
const SCENES = {
  "oscillator": { title: "Mass on a spring", end: 25, h: [0.01, 1.3], picture: "phase", spring: "this spring", omega: (p) => Math.sqrt(p.stiffness / p.mass) },
  "damped-oscillator": { title: "Spring with a damper", end: 12, h: [0.01, 1.3], picture: "phase", spring: "this damped spring", omega: (p) => Math.sqrt(p.stiffness / p.mass) },
  "pendulum": { title: "Pendulum, wide swing", end: 20, h: [0.01, 1], picture: "phase", spring: "a spring as quick as its small swings", omega: (p) => Math.sqrt(p.gravity / p.length) },
  "kepler": { title: "Planet on an ellipse", end: 40, h: [0.02, 1], picture: "orbit" },
  "kepler/eccentric": { title: "Planet on a thin ellipse", end: 20, h: [0.005, 0.5], picture: "orbit" },
  "charged-particle/magnetic": { title: "Charge in a magnetic field", end: 20, h: [0.01, 1], picture: "circle" },
  "bouncing-ball": { title: "Bouncing ball", end: 8, h: [0.002, 0.2], picture: "height" },
  "torque-free-spin": { title: "Spinning box", end: 10, h: [0.005, 0.5], picture: "sphere", axis: 2 },
  "tennis-racket": { title: "Box about its middle axis", end: 12, h: [0.005, 0.4], picture: "sphere", axis: 1 },
};
const QUANTITY = { "position": "position", "velocity": "velocity", "attitude": "angle", "angular-velocity": "angular velocity" };
const STORED = { "world-omega": "angular velocity, world frame", "body-omega": "angular velocity, body frame", "world-momentum": "angular momentum" };
// Only for a rigid body: beside the six methods, two that are for it alone.
const RIGID = [
  { id: "no-gyroscopic-term", title: "Semi-implicit Euler, no gyroscopic term", name: "no gyroscopic term", keys: { method: "semi-implicit-euler", storage: "without-gyroscopic-term" } },
  { id: "free-splitting", title: "Splitting into axis rotations", name: "axis rotations", keys: { step: "free-splitting" } },
];

// Only on a flat scene without kinks: the velocity is moved by half a kick before the run, and read half a kick back.
const FLAT = [{ id: "half-kick", title: "Semi-implicit Euler, half a kick", name: "half a kick", keys: { method: "semi-implicit-euler", half_kick: true } }];

// The body axis in the world: column `axis` of the rotation of the unit quaternion (w, x, y, z).
function bodyAxis([w, x, y, z], axis) {
  return [
    [1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)],
    [2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)],
    [2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)],
  ][axis];
}

// Two directions across the field: a circle is seen as one.
function across(field) {
  const b = field.map((c) => c / norm(field)), helper = Math.abs(b[2]) < 0.9 ? [0, 0, 1] : [1, 0, 0];
  const cross = (p, q) => [p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]];
  const e = cross(helper, b), first = e.map((c) => c / norm(e));
  return [first, cross(b, first)];
}

// The lines in which the module describes a scene.
const said = (ask, scene, set) => ask("describe", { scene, set }).text().trim().split("\n").map((line) => line.split("\t"));
// Its horizon and its shortest time: they follow the parameters.
const durations = (lines) => Object.fromEntries(lines.filter(([kind]) => kind.endsWith("_s")).map(([kind, value]) => [kind, +value]));

// A scene as the module states it.
function described(ask, id) {
  const names = said(ask, id, []).filter(([kind]) => kind === "parameter").map(([, name]) => name);
  const set = Object.fromEntries(DATA.set.map((s) => [s.slice(0, s.indexOf("=")), s.slice(s.indexOf("=") + 1)]).filter(([name]) => names.includes(name)));
  const lines = said(ask, id, Object.entries(set).map((s) => s.join("=")));
  const scene = { id, set, ...SCENES[id], ...durations(lines), parameters: [], quantities: [], balances: [] };
  let column = 2;
  for (const [kind, ...rest] of lines) {
    if (kind === "parameter") scene.parameters.push({ name: rest[0], unit: rest[1], about: rest[2], value: rest[3], range: rest[4] });
    else if (kind === "quantity") { scene.quantities.push({ id: rest[0], unit: rest[1], from: column, width: +rest[2] }); column += +rest[2]; }
    else if (kind === "balance") { scene.balances.push({ id: rest[0], unit: rest[1], from: column, width: +rest[2], conserved: rest[3] === "conserved" }); column += +rest[2]; }
  }
  scene.rigid = scene.quantities.some((q) => q.id === "attitude" && q.width === 4);
  scene.springs = id.endsWith("oscillator");
  scene.balance = (id) => scene.balances.find((b) => b.id === id);
  return scene;
}

const columns = (row, { from, width }) => row.subarray(from, from + width);

// What the first chart shows of a row.
function pictured(scene, values) {
  const [q, v] = scene.quantities;
  if (scene.picture === "sphere") return (row) => bodyAxis(columns(row, scene.quantities.find((q) => q.id === "attitude")), scene.axis);
  if (scene.picture === "height") return (row) => [row[1], row[q.from]];
  if (scene.picture === "phase") return (row) => [row[q.from], row[v.from]];
  if (scene.picture === "orbit") return (row) => [row[q.from], row[q.from + 1]];
  const [a, b] = across(values.magnetic);
  const dot = (row, e) => e[0] * row[q.from] + e[1] * row[q.from + 1] + e[2] * row[q.from + 2];
  return (row) => [dot(row, a), dot(row, b)];
}

// What the chart over the time shows of a row, and what it is.
function followedOf(scene, values) {
  const [q, v] = scene.quantities, see = pictured(scene, values);
  if (scene.picture === "height") return { label: "velocity (m/s)", title: "Velocity", note: "against time; grey: exact", of: (row) => row[v.from] };
  if (scene.picture === "sphere") return { label: "upward part of the axis", title: "The body's axis", note: "its upward part, against time; grey: exact", of: (row) => see(row)[2] };
  const name = { phase: QUANTITY[q.id], orbit: "x", circle: "across the field" }[scene.picture];
  const title = scene.picture === "phase" ? name[0].toUpperCase() + name.slice(1) : "Position";
  return { label: `${name} (${q.unit})`, title, note: `${scene.picture === "phase" ? "" : `${name}, `}against time; grey: exact`, of: (row) => see(row)[0] };
}

const PICTURE = {
  phase: ["Phase portrait", "what moves, against its velocity"],
  orbit: ["Orbit", "seen from above"],
  circle: ["Path", "seen along the field"],
  height: ["Height", "over the floor, against time"],
  sphere: ["The body's axis", "on the sphere of directions"],
};
