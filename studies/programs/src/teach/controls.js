// The controls: what a reader sets, and how the page starts.
function slide(h) {
  const [low, high] = scene.h, n = +$("h").max;
  return Math.round((n * Math.log(Math.max(low, Math.min(high, h)) / low)) / Math.log(high / low));
}

function choose(id) {
  scene = scenes[id] ??= described(ask, id);
  Object.assign(state, { scene: id, set: {}, storage: "world-omega" });
  const known = entries().map((m) => m.id);
  state.methods = state.methods.filter((m) => known.includes(m));
  if (!state.methods.length) state.methods = ["semi-implicit-euler"];
}

function setStep(h) {
  limit();
  $("h").value = slide(h);
  // A step that was asked for is kept as it is; the slider stands at the nearest of its places.
  const [low, high] = scene.h, n = +$("h").max, first = low * (high / low) ** ($("h").min / n);
  state.h = Math.max(first, Math.min(high, h));
}

function slid() {
  const [low, high] = scene.h;
  state.h = low * (high / low) ** ($("h").value / $("h").max);
}

// Double-double takes a hundred times as long: the slider ends where a picture still follows the hand.
function limit() {
  const [low, high] = scene.h, slow = state.precision === "double-double", n = +$("h").max;
  $("h").min = slow ? Math.ceil((n * Math.log(Math.max(1, scene.end / SLOW_STEPS / low))) / Math.log(high / low)) : 0;
  $("limit").hidden = !slow;
  $("limit").textContent = slow ? `A step in double-double takes about a hundred times as long, so the slider begins at ${SLOW_STEPS} steps over the picture.` : "";
}

function fill() {
  $("scene").value = state.scene;
  $("precision").value = state.precision;
  $("storage").value = state.storage;
  $("substeps").value = state.substeps;
  $("jitter").value = Math.round(100 * state.jitter);
  $("varies").hidden = !scene.springs;
  told();
  $("stored").hidden = !scene.rigid;
  const chip = (m) => `<label class="chip"><input type="checkbox" value="${m.id}"${state.methods.includes(m.id) ? " checked" : ""}>
    <i class="swatch ${color(m)}"></i>${escaped(m.title)}</label>`;
  $("methods").innerHTML = `<legend>Methods</legend>${entries().map(chip).join("")}`;
  const field = (p) => `<label><span>${escaped(p.about.replace(/\.$/, ""))} <small>(${escaped(p.unit)})</small></span>
    <input name="${p.name}" value="${escaped(state.set[p.name] ?? p.value)}" autocomplete="off" spellcheck="false"></label>`;
  $("fields").innerHTML = scene.parameters.map(field).join("");
  $("refused").textContent = "";
}

const told = () => { $("jitter-value").textContent = `± ${Math.round(100 * state.jitter)} %`; };

function go(stop) {
  const { set, question } = STOPS[stop], { precision, substeps, jitter } = settled(set);
  state.stop = stop;
  choose(set.scene);
  Object.assign(state, { methods: set.methods, precision, substeps, jitter });
  fill();
  setStep(set.h);
  $("question").textContent = question;
  for (const [i, button] of [...$("stops").querySelectorAll("button")].entries()) button.toggleAttribute("aria-current", i === stop);
  $("previous").disabled = stop === 0;
  $("next").disabled = stop === STOPS.length - 1;
  want();
}

function parameter(input) {
  const before = state.set[input.name], text = input.value.replace(/\s/g, "");
  state.set[input.name] = text;
  if (text === scene.parameters.find((p) => p.name === input.name).value) delete state.set[input.name];
  try {
    scene = { ...scene, ...durations(said(ask, state.scene, settings())) };
    $("refused").textContent = "";
    input.removeAttribute("aria-invalid");
  } catch (error) {
    if (before === undefined) delete state.set[input.name]; else state.set[input.name] = before;
    $("refused").textContent = error.message;
    input.setAttribute("aria-invalid", "true");
  }
  want();
}

function listen() {
  $("h").addEventListener("input", () => { slid(); want(); });
  $("scene").addEventListener("change", () => { choose($("scene").value); fill(); setStep(Math.sqrt(scene.h[0] * scene.h[1])); want(); });
  $("precision").addEventListener("change", () => { state.precision = $("precision").value; setStep(state.h); want(); });
  $("substeps").addEventListener("change", () => { state.substeps = +$("substeps").value; want(); });
  $("jitter").addEventListener("input", () => { state.jitter = $("jitter").value / 100; told(); want(); });
  $("save").addEventListener("click", save);
  addEventListener("hashchange", () => followed(location.hash));
  listenMotion();
  $("storage").addEventListener("change", () => { state.storage = $("storage").value; want(); });
  $("methods").addEventListener("change", () => { state.methods = [...$("methods").querySelectorAll(":checked")].map((c) => c.value); want(); });
  $("fields").addEventListener("change", (event) => parameter(event.target));
  $("previous").addEventListener("click", () => go(state.stop - 1));
  $("next").addEventListener("click", () => go(state.stop + 1));
  $("again").addEventListener("click", () => go(state.stop));
  $("stops").addEventListener("click", (event) => { const button = event.target.closest("button"); if (button) go(+button.value); });
}

function themed() {
  const dark = () => (document.documentElement.dataset.theme ?? (matchMedia("(prefers-color-scheme: dark)").matches ? "dark" : "light")) === "dark";
  const tell = () => { $("theme").textContent = dark() ? "Light" : "Dark"; $("theme").setAttribute("aria-pressed", String(dark())); };
  $("theme").addEventListener("click", () => { document.documentElement.dataset.theme = dark() ? "light" : "dark"; tell(); });
  tell();
}

// The proof broke off: neither held nor refuted.
function unchecked(why) {
  $("badge-bar").hidden = true;
  $("badge-sign").textContent = "✗";
  $("badge").className = "broken";
  $("badge-text").textContent = `The report's numbers could not be recomputed in this browser: ${why || "its worker did not start"}`;
}

// What an old browser lacks.
function lacking() {
  const needed = { WebAssembly: globalThis.WebAssembly, DecompressionStream: globalThis.DecompressionStream };
  return Object.keys(needed).filter((name) => !needed[name]);
}

// The worker has its own module, so that the page stays as quick as it is while the numbers are recomputed.
function recompute(module) {
  // Double-double would take minutes; its rows are on the charts only.
  const rows = DATA.rows.filter((r) => DATA.precisions[r[2]] !== "double-double"), numbers = rows.length * 3, text = $("bridge").textContent + $("worker").textContent;
  $("badge-bar").max = numbers;
  if (!numbers) { $("badge-bar").hidden = true; $("badge-text").textContent = "This report has no row of a scene of this page to recompute."; return; }
  const worker = new Worker(URL.createObjectURL(new Blob([text], { type: "text/javascript" })));
  worker.onerror = ({ message }) => { worker.terminate(); unchecked(message); };
  worker.onmessage = ({ data: { done, wrong, finished, failed } }) => {
    if (failed) { worker.terminate(); return unchecked(failed); }
    $("badge-bar").value = done + wrong.length;
    $("badge-bar").hidden = finished;
    $("badge-sign").textContent = wrong.length ? "✗" : finished ? "✓" : "…";
    $("badge").className = wrong.length ? "broken" : finished ? "holds" : "";
    $("badge").title = wrong.slice(0, 5).join("\n");
    $("badge-text").textContent = `${done} of ${numbers} numbers in f32 and f64 on this page recomputed in this browser, bit for bit${wrong.length ? `; ${wrong.length} differ, the first: ${wrong[0]}` : ""}`;
    Object.assign($("badge").dataset, { done, wrong: wrong.length, all: numbers, finished });
    if (finished) worker.terminate();
  };
  const set = Object.fromEntries(DATA.scenes.map(({ id }) => [id, Object.entries((scenes[id] ??= described(ask, id)).set).map((s) => s.join("="))]));
  worker.postMessage({ module, data: DATA, rows, set });
}

async function main() {
  themed();
  const lacks = lacking();
  if (lacks.length) return failed(`the browser lacks ${lacks.join(" and ")}. A current version of any browser has it`);
  const module = $("module").textContent.trim(), option = (value, text) => `<option value="${value}">${escaped(text)}</option>`;
  $("stops").innerHTML = STOPS.map((s, i) => `<li><button type="button" value="${i}">${i + 1}. ${escaped(s.title)}</button></li>`).join("");
  $("scene").innerHTML = Object.entries(SCENES).map(([id, s]) => option(id, s.title)).join("");
  $("precision").innerHTML = DATA.precisions.map((p) => option(p, p)).join("");
  $("storage").innerHTML = Object.entries(STORED).map(([id, text]) => option(id, text)).join("");
  ask = await start(module);
  listen();
  $("substeps").innerHTML = LOOP.substeps.map((n) => option(n, n)).join("");
  followed(location.hash);
  play(!still.matches);
  // First the picture, then the proof.
  setTimeout(() => { try { recompute(module); } catch (error) { unchecked(error.message); } }, 300);
}
main().catch((error) => failed(error.message));
