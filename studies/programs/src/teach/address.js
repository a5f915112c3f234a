// What is set, in the address of the page: a link opens the page as it is. Only what differs from the stop's own settings is written.
const LOOP = { substeps: [1, 2, 4, 8, 16], jitter: [0, 0.5] };

function written() {
  const { set } = STOPS[state.stop], own = settled(set), parts = [`stop=${state.stop + 1}`, `h=${+state.h.toPrecision(6)}`];
  const add = (key, value) => parts.push(`${key}=${encodeURIComponent(value).replace(/%2C/g, ",").replace(/%2F/g, "/")}`);
  if (state.scene !== own.scene) add("scene", state.scene);
  if (state.methods.join() !== own.methods.join()) add("methods", state.methods.join());
  for (const key of ["precision", "storage", "substeps", "jitter"]) if (state[key] !== own[key]) add(key, state[key]);
  for (const [name, value] of Object.entries(state.set)) add("set", `${name}:${value}`);
  return `#${parts.join("&")}`;
}

// A stop's settings with the defaults that it leaves out.
const settled = (set) => ({ precision: "f64", storage: "world-omega", substeps: 1, jitter: 0, ...set });

// Sets the page as a link says; what it does not understand is told, and left as the stop has it.
function followed(hash) {
  const text = hash.replace(/^#/, "").replace(/^stop-/, "stop="), unknown = [];
  const pairs = text ? text.split("&").map((part) => [part.split("=")[0], decoded(part.slice(part.indexOf("=") + 1))]) : [];
  const all = (key) => pairs.filter(([k]) => k === key).map(([, value]) => value), one = (key) => all(key).at(-1);
  const wrong = (key) => unknown.push(`${key}=${one(key)}`);
  const stop = one("stop") === undefined ? 1 : +one("stop");
  go(Number.isInteger(stop) && stop >= 1 && stop <= STOPS.length ? stop - 1 : (wrong("stop"), 0));
  const known = ["stop", "h", "scene", "methods", "precision", "storage", "substeps", "jitter", "set"];
  for (const [key] of pairs) if (!known.includes(key)) wrong(key);
  const takes = (key, isGood, take) => { const value = one(key); if (value !== undefined) { if (isGood(value)) take(value); else wrong(key); } };
  takes("scene", (id) => Object.hasOwn(SCENES, id), choose);
  takes("precision", (p) => DATA.precisions.includes(p), (p) => (state.precision = p));
  takes("storage", (s) => scene.rigid && Object.hasOwn(STORED, s), (s) => (state.storage = s));
  takes("methods", (list) => list.split(",").every((id) => entries().some((m) => m.id === id)), (list) => (state.methods = list.split(",")));
  takes("substeps", (n) => LOOP.substeps.includes(+n), (n) => (state.substeps = +n));
  takes("jitter", (j) => +j >= LOOP.jitter[0] && +j <= LOOP.jitter[1], (j) => (state.jitter = +j));
  fill();
  for (const value of all("set")) {
    const name = value.split(":")[0], input = $("fields").querySelector(`[name="${CSS.escape(name)}"]`);
    if (!input) { unknown.push(`set=${value}`); continue; }
    input.value = value.slice(name.length + 1);
    parameter(input);
    if ($("refused").textContent) unknown.push(`set=${value}`);
  }
  takes("h", (h) => +h >= scene.h[0] * 0.999 && +h <= scene.h[1] * 1.001, (h) => setStep(+h));
  $("linked").hidden = !unknown.length;
  $("linked").textContent = unknown.length ? `The link asks for ${unknown.join(", ")}, which this page does not have; the rest of it is set.` : "";
  want();
}
function decoded(text) {
  try { return decodeURIComponent(text); } catch { return text; }
}

// The runs on the page as a table: the exact motion, then each method.
function csv() {
  const unit = (u) => u.replace(/\^/g, "").replace(/[ /]/g, "_"), part = (q, i) => (q.width === 1 ? "" : `_${(q.width === 4 ? "wxyz" : "xyz")[i]}`);
  const heads = [...scene.quantities, ...scene.balances].flatMap((q) =>
    Array.from({ length: q.width }, (_, i) => `${q.id.replace(/-/g, "_")}${part(q, i)}${q.width === 4 ? "" : `_${unit(q.unit)}`}`));
  const lines = (source, h, rows) => rows.map((r) => [source, h, r[0], ...r.subarray(1, 2 + heads.length)].join());
  const runs = view.entries.flatMap((m) => lines(m.id, view.h, view.runs[m.id].rows));
  return [["source", "h_s", "step", "t_s", ...heads].join(), ...lines("exact", "", exact().rows), ...runs].join("\n") + "\n";
}
function save() {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(new Blob([csv()], { type: "text/csv" }));
  link.download = `${state.scene.replace(/\//g, "-")}.csv`;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}
