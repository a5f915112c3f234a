// The state of the page, what follows from it, and the redraw: once a frame, whatever happens in between.
const $ = (id) => document.getElementById(id);
const DATA = JSON.parse($("data").textContent);
const METHODS = DATA.methods.map((m) => ({ ...m, keys: { method: m.id } }));
const LOOKS = 360;
// So many steps over the picture in double-double, and no more.
const SLOW_STEPS = 400;
const state = { scene: "oscillator", methods: [], precision: "f64", storage: "world-omega", h: 0.05, set: {}, stop: 0, substeps: 1, jitter: 0 };
const scenes = {};
let ask, scene, wanted = false;
const cache = new Map();

// The value of a calculation that is asked for again and again with the same words.
function kept(key, calculate) {
  if (!cache.has(key)) { if (cache.size > 4000) cache.clear(); cache.set(key, calculate()); }
  return cache.get(key);
}
const values = () => Object.fromEntries(scene.parameters.map((p) => {
  const text = state.set[p.name] ?? p.value, list = text.split(",").map(Number);
  return [p.name, list.length > 1 ? list : list[0]];
}));
const settings = () => Object.entries({ ...scene.set, ...state.set }).map(([name, value]) => `${name}=${value}`);
const entries = () => (scene.rigid ? METHODS.map((m) => (state.storage === "world-omega" ? m : { ...m, keys: { ...m.keys, storage: state.storage } })).concat(RIGID) : scene.picture === "height" ? METHODS : METHODS.concat(FLAT));
const chosen = () => entries().filter((m) => state.methods.includes(m.id));
// Steps that vary: on springs, where a step needs nothing but the state before it.
const varied = (m) => (state.jitter > 0 && scene.springs && !m.keys.half_kick ? { jitter: state.jitter } : {});
const color = (m) => `m${[...METHODS, ...RIGID, ...FLAT].findIndex((x) => x.id === m.id)}`;
// A free body's exact attitude takes a millisecond a look.
const looks = () => (scene.rigid ? 180 : LOOKS);
const stepsTo = (end, h) => Math.max(1, Math.round(end / h));

// The exact motion over the run.
function exact() {
  return kept(["exact", state.scene, settings()].join(), () => {
    const { rows } = table(ask("exact", { scene: state.scene, set: settings(), end_s: scene.end, steps: looks() }));
    const energy = scene.balance("energy"), see = pictured(scene, values()), { of } = followedOf(scene, values());
    return { points: rows.map(see), track: rows.map((r) => [r[1], of(r)]), energy: rows.map((r) => [r[1], r[energy.from] / rows[0][energy.from]]), rows };
  });
}

// A run over the whole picture.
function run(m, steps, loop = varied(m)) {
  const end_s = steps * view.h, keys = { scene: state.scene, set: settings(), ...m.keys, ...loop, precision: state.precision, end_s, steps, stride: Math.ceil(steps / looks()) };
  const result = table(ask("run", keys)), { rows } = result, truth = exact();
  const energy = scene.balance("energy"), e0 = rows[0][energy.from], see = pictured(scene, values());
  const finite = rows.filter((r) => Number.isFinite(r[energy.from]));
  result.points = rows.map(see);
  const { of } = followedOf(scene, values());
  result.track = rows.map((r) => [r[1], of(r)]);
  result.energy = finite.map((r) => [r[1], r[energy.from] / e0]);
  result.lastRatio = result.outcome === "finished" ? result.energy.at(-1)[1] : Infinity;
  const against = energy.conserved ? () => 1 : (t) => truth.energy[Math.min(looks(), Math.round((t / scene.end) * looks()))][1];
  result.energyChange = result.outcome === "finished" ? largest(result.energy.map(([t, r]) => Math.abs(r - against(t)))) : Infinity;
  const spin = scene.balance("angular-momentum");
  if (spin && spin.conserved) {
    const size = (r) => norm(columns(r, spin)), l0 = size(rows[0]);
    result.fourth = rows.slice(1).map((r) => [r[1], Math.abs(size(r) / l0 - 1)]);
  } else if (!scene.omega) {
    // The exact motion at the times of the looks; the end may lie between two.
    const stride = Math.ceil(steps / looks()), whole = Math.floor(steps / stride), q = scene.quantities[0];
    view.there ??= table(ask("exact", { scene: state.scene, set: settings(), end_s: whole * stride * view.h, steps: whole })).rows;
    result.fourth = rows.slice(1, whole + 1).map((r, k) => [r[1], norm(columns(r, q).map((x, i) => x - columns(view.there[k + 1], q)[i]))]);
  } else result.fourth = [];
  result.fourthLargest = largest(result.fourth.map(([, x]) => x).filter((x) => !Number.isNaN(x)));
  return result;
}
const counted = (n, noun) => `${n} ${noun}${n === 1 ? "" : "s"}`;
const largest = (list) => list.reduce((a, b) => Math.max(a, b), 0);

// The error of the first quantity at the scene's horizon with a step near h, as the convergence study measures it.
function errorOf(m, steps, precision = state.precision) {
  const keys = { ...m.keys, ...varied(m) };
  return kept(["error", state.scene, settings(), JSON.stringify(keys), precision, steps].join(), () => {
    const { rows, evaluations } = table(ask("errors", { scene: state.scene, set: settings(), ...keys, precision, steps }));
    return { h: scene.horizon_s / steps, error: rows[0][0], evaluations };
  });
}

// The convergence line: the report's rows, or runs of this browser where the report has none.
function line(m) {
  const precision = state.precision, own = Object.keys(state.set).length === 0 && m.keys.method && !m.keys.storage && !m.keys.half_kick;
  return kept(["line", state.scene, settings(), JSON.stringify({ ...m.keys, ...varied(m) }), precision].join(), () => {
    const quantity = DATA.quantities.indexOf(scene.quantities[0].id), method = METHODS.findIndex((x) => x.id === m.id);
    const [s, p] = [DATA.scenes.findIndex((x) => x.id === state.scene), DATA.precisions.indexOf(precision)];
    const rows = own ? DATA.rows.filter((r) => r[0] === s && r[1] === method && r[2] === p && r[4] === quantity) : [];
    if (rows.length) return { reported: true, points: rows.map((r) => ({ h: scene.horizon_s / r[3], error: r[7], evaluations: r[6] })) };
    return { reported: false, points: Array.from({ length: 9 }, (_, k) => errorOf(m, 16 << k)) };
  });
}

// Size of the first quantity at the horizon, in the unit of its error: the report's where it has rows of these parameters.
function exactSize() {
  const { scale } = DATA.scenes.find((s) => s.id === state.scene);
  if (scale !== null && !view.changed()) return scale;
  return kept(["size", state.scene, settings()].join(), () => {
    const { rows } = table(ask("exact", { scene: state.scene, set: settings(), end_s: scene.horizon_s, steps: 1 }));
    return norm(columns(rows[1], scene.quantities[0]));
  });
}

// Spectral radius against omega h, for a spring of the same frequency.
function amplification(m) {
  const spring = state.scene.endsWith("oscillator") ? { scene: state.scene, set: settings() } : { scene: "oscillator", set: [`stiffness=${1.5 * view.omega ** 2}`] };
  return kept(["amplification", spring.scene, spring.set, m.id].join(), () => {
    const end_s = 3.2 / view.omega, { rows } = table(ask("amplification", { ...spring, ...m.keys, end_s, steps: 128 }));
    return rows.map((r) => [r[0] * view.omega, r[1]]);
  });
}
function radiusAt(m) {
  const points = amplification(m), k = Math.min(points.length - 1, Math.max(0, Math.round((view.homega / 3.2) * 128) - 1));
  const spring = state.scene.endsWith("oscillator") ? { scene: state.scene, set: settings() } : null;
  return spring ? table(ask("amplification", { ...spring, ...m.keys, end_s: view.h, steps: 1 })).rows[0][1] : points[k][1];
}

// What the charts, the table and the story look at.
const view = {
  error: (m, finer = 1, precision = state.precision) => errorOf(m, stepsTo(scene.horizon_s, view.h) * finer, precision).error,
  ofReport: () => view.entries.every((m) => line(m).reported),
  changed: () => Object.keys(state.set).length > 0,
  precision: () => state.precision,
  // The same run with even steps.
  even: (m) => run(m, view.steps, {}),
  substeps: () => state.substeps,
  jitter: () => (scene.springs ? state.jitter : 0),
  values: () => values(),
  best: (m) => line(m).points.filter((p) => p.error !== null).reduce((a, b) => (b.error < a.error ? b : a)),
  radius: (id) => radiusAt(METHODS.find((m) => m.id === id)),
  finest: (m) => Math.min(...line(m).points.map((p) => p.h)),
  needs(m, part) {
    const size = exactSize();
    const fine = line(m).points.filter((p) => Number.isFinite(p.error) && p.error !== null && p.error <= part * size);
    return fine.length ? fine.reduce((a, b) => (b.h > a.h ? b : a)) : null;
  },
};

function look() {
  view.scene = scene;
  view.there = null;
  view.h = state.h / state.substeps;
  // The run ends with a whole step, near the end of the picture.
  view.steps = stepsTo(scene.end, view.h);
  view.omega = scene.omega ? scene.omega(values()) : NaN;
  view.homega = view.omega * view.h;
  view.entries = chosen();
  view.runs = Object.fromEntries(view.entries.map((m) => [m.id, run(m, view.steps)]));
}

function want() {
  if (wanted) return;
  wanted = true;
  requestAnimationFrame(() => {
    wanted = false;
    const from = performance.now();
    look();
    draw();
    drawMotion();
    tellMotion();
    history.replaceState(null, "", written());
    const took = performance.now() - from;
    $("speed").textContent = `Computed and drawn in ${took.toFixed(1)} ms: ${counted(view.entries.length, "run")} of ${counted(view.steps, "step")}.`;
    window.teach = { ...window.teach, took, h: view.h, steps: view.steps };
  });
}
