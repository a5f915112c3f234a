// The charts, the table and the story, from what `look` found.
const inParts = (x) => (x === Infinity ? "without bound" : short(x));

function draw() {
  const runs = view.entries.map((m) => [m, view.runs[m.id]]);
  drawPicture(runs);
  drawTrack(runs);
  drawEnergy(runs);
  drawConvergence(runs);
  drawFourth(runs);
  drawTable(runs);
  const frame = state.substeps > 1 ? `${short(state.h)} s in ${state.substeps} substeps: ` : "";
  $("h-value").textContent = `${frame}h = ${short(view.h)} s${Number.isFinite(view.homega) ? `, ωh = ${view.homega.toPrecision(3)}` : ""}, ${counted(view.steps, "step")}`;
  $("h").setAttribute("aria-valuetext", `${short(view.h)} seconds`);
  const stop = STOPS[state.stop], own = stop.set.scene === state.scene && stop.set.methods.every((id) => state.methods.includes(id));
  $("story").innerHTML = `<p>${own ? stop.story(view) : "You have left the path, and everything stays live: choose, drag, compare. “Start over” takes you back."}</p>`;
}

// From the smallest to the largest, with some room; not further than `most` beyond what the exact motion needs.
function extent(exactValues, all, room = 0.08, most = 1.2) {
  const [a, b] = [Math.min(...exactValues), Math.max(...exactValues)], w = b - a || 1;
  const finite = all.filter(Number.isFinite);
  const low = Math.max(a - most * w, Math.min(a, ...finite)), high = Math.min(b + most * w, Math.max(b, ...finite));
  return { from: low - room * (high - low || 1), to: high + room * (high - low || 1) };
}

function drawPicture(runs) {
  const [title, note] = PICTURE[scene.picture], truth = exact().points, svg = $("picture");
  $("picture-title").textContent = title;
  $("picture-note").textContent = `${note}; grey: exact`;
  const far = runs.map(([m, r]) => `${m.title} ${r.outcome === "finished" ? "ends" : "fails"}`).join(", ");
  const name = `${title} of ${scene.title}: exact motion and ${far}; step ${short(view.h)} seconds`;
  const series = [{ points: truth, css: "exact" }, ...runs.map(([m, r]) => ({ points: r.points, css: color(m), dots: view.steps <= 60 && scene.picture !== "sphere" }))];
  const marks = runs.filter(([, r]) => r.outcome === "finished").map(([m, r]) => ({ at: r.points.at(-1), css: color(m) }));
  if (scene.picture === "sphere") return sphere(svg, { series, marks, name, seen: truth });
  const [q, v] = scene.quantities, part = (i) => extent(truth.map((p) => p[i]), runs.flatMap(([, r]) => r.points.map((p) => p[i])));
  const labels = {
    phase: [`${QUANTITY[q.id]} (${q.unit})`, `${QUANTITY[v.id]} (${v.unit})`],
    orbit: ["x (m)", "y (m)"], circle: ["across the field (m)", "across the field (m)"], height: ["time (s)", "height (m)"],
  }[scene.picture];
  const x = { ...part(0), label: labels[0] }, y = { ...part(1), label: labels[1] };
  if (scene.picture === "height") Object.assign(x, { from: 0, to: scene.end });
  chart(svg, { x, y, series, marks, square: scene.picture === "orbit" || scene.picture === "circle", name });
}

function drawTrack(runs) {
  const { title, note, label } = followedOf(scene, values()), truth = exact().track, svg = $("track");
  $("track-title").textContent = title;
  $("track-note").textContent = note;
  const y = { ...extent(truth.map((p) => p[1]), runs.flatMap(([, r]) => r.track.map((p) => p[1]))), label };
  const series = [{ points: truth, css: "exact" }, ...runs.map(([m, r]) => ({ points: r.track, css: color(m), dots: view.steps <= 60 }))];
  const ends = runs.map(([m, r]) => `${m.title} ${r.outcome === "finished" ? short(r.track.at(-1)[1]) : r.outcome}`).join(", ");
  chart(svg, { x: { from: 0, to: scene.end, label: "time (s)" }, y, series, name: `${title} against time: at the end exact ${short(truth.at(-1)[1])}, ${ends}` });
}

function drawEnergy(runs) {
  const truth = exact().energy, all = runs.flatMap(([, r]) => r.energy.map((p) => p[1])), top = largest(all.filter(Number.isFinite));
  const log = top > 4;
  let y;
  if (log) {
    const low = Math.max(1e-6, Math.min(1, ...all.filter((e) => e > 0), ...truth.map((p) => p[1])));
    y = { from: 10 ** Math.floor(Math.log10(low) - 0.01), to: Math.min(1e12, 10 ** Math.ceil(Math.log10(top))), log };
  } else {
    y = extent(truth.map((p) => p[1]), all.filter((e) => e > -4));
    // Rounding is not worth a picture of its own.
    if (y.to - y.from < 1e-3) { const c = (y.from + y.to) / 2; y = { from: c - 5e-4, to: c + 5e-4 }; }
  }
  const name = `Energy in parts of its start over ${scene.end} seconds: ${runs.map(([m, r]) => `${m.title} changes by ${inParts(r.energyChange)}`).join(", ")}`;
  const series = [{ points: truth, css: "exact" }, ...runs.map(([m, r]) => ({ points: r.energy, css: color(m) }))];
  const marks = runs.filter(([, r]) => r.outcome === "finished").map(([m, r]) => ({ at: r.energy.at(-1), css: color(m) }));
  chart($("energy"), { x: { from: 0, to: scene.end, label: "time (s)" }, y: { ...y, label: "E / E₀" }, series, marks, name });
}

function drawConvergence(runs) {
  const lines = runs.map(([m]) => [m, line(m)]), q = scene.quantities[0];
  const good = (p) => p.error !== null && p.error > 0 && Number.isFinite(p.error);
  const errors = lines.flatMap(([, l]) => l.points.filter(good).map((p) => p.error)), steps = lines.flatMap(([, l]) => l.points.map((p) => p.h));
  const here = runs.map(([m]) => [m, errorOf(m, stepsTo(scene.horizon_s, view.h))]);
  const reported = lines.filter(([, l]) => l.reported).length;
  const source = reported === 0 ? "computed here" : reported === lines.length ? "the report's rows" : "the report's, or computed here";
  $("line-note").textContent = `${QUANTITY[q.id]} error after ${scene.horizon_s} s; ${source}`;
  const low = 10 ** Math.floor(Math.log10(Math.min(...errors, 1e-2)) - 0.01), high = 10 ** Math.ceil(Math.log10(Math.min(1e3, largest(errors) || 1)));
  const x = { from: Math.min(...steps, view.h) / 1.3, to: Math.max(...steps, view.h) * 1.3, log: true, label: "step (s)" };
  const name = `Error against step: ${here.map(([m, e]) => `${m.title} ${short(e.error)} ${q.unit}`).join(", ")} at ${short(view.h)} seconds`;
  chart($("convergence"), {
    x, y: { from: low, to: high, log: true, label: `error (${q.unit})` }, name,
    series: lines.map(([m, l]) => ({ points: l.points.filter(good).map((p) => [p.h, p.error]), css: color(m), dots: true })),
    lines: [{ from: [view.h, low], to: [view.h, high], css: "cursor" }],
    marks: here.filter(([, e]) => good(e)).map(([m, e]) => ({ at: [e.h, e.error], css: color(m) })),
  });
}

function drawFourth(runs) {
  const title = $("fourth-title"), note = $("fourth-note"), svg = $("fourth");
  const time = { from: 0, to: scene.end, label: "time (s)" };
  if (Number.isFinite(view.omega)) {
    title.textContent = "Stability";
    note.textContent = `of ${scene.spring}, in one step`;
    const at = runs.map(([m]) => [m, radiusAt(m)]);
    return chart(svg, {
      x: { from: 0, to: 3.2, label: "ωh" }, y: { from: 0.3, to: 10, log: true, label: "largest factor in a step" }, shade: [1, 10],
      series: runs.map(([m]) => ({ points: amplification(m), css: color(m) })), marks: at.map(([m, r]) => ({ at: [view.homega, r], css: color(m) })),
      lines: [{ from: [view.homega, 0.3], to: [view.homega, 10], css: "cursor" }],
      name: `Stability: at omega h = ${view.homega.toPrecision(3)} one step stretches by ${at.map(([m, r]) => `${m.title} ${r.toPrecision(4)}`).join(", ")}; above one it grows`,
    });
  }
  const spin = scene.balance("angular-momentum"), conserved = spin && spin.conserved;
  title.textContent = conserved ? "Angular momentum" : "Distance from the exact motion";
  note.textContent = conserved ? "its length, in parts of the start" : "over the run";
  const series = runs.map(([m, r]) => ({ points: r.fourth.map(([t, x]) => [t, Math.max(x, 1e-17)]), css: color(m) }));
  const all = series.flatMap(({ points }) => points.map((p) => p[1])).filter(Number.isFinite);
  const from = 10 ** Math.floor(Math.log10(Math.min(1e-2, ...all)) - 0.01), top = Math.max(1, Math.min(1e3, largest(all)));
  const y = { from, to: 10 ** Math.ceil(Math.log10(top)), log: true, label: conserved ? "|L| / |L₀| − 1" : "error (m)" };
  const named = runs.map(([m, r]) => `${m.title} ${inParts(r.fourthLargest)}`).join(", ");
  chart(svg, { x: time, y, series, name: `${title.textContent}: largest ${named}` });
}

function drawTable(runs) {
  const q = scene.quantities[0], most = largest(runs.map(([, r]) => r.evaluations)) || 1;
  const heads = [`evaluations in ${scene.end}&nbsp;s`, "largest change of energy", `error after ${scene.horizon_s}&nbsp;s (${q.unit})`, `error with half the step&nbsp;(${q.unit})`];
  const head = (text) => `<th scope="col" class="right">${text}</th>`;
  $("cost-head").innerHTML = `<tr><th scope="col">Method</th>${heads.map(head).join("")}<th scope="col">run</th></tr>`;
  const bar = (m, r) => r.evaluations === 0 ? "–" : `<i class="bar ${color(m)}" style="width:${((r.evaluations / most) * 5).toFixed(2)}rem"></i>${r.evaluations}`;
  const line = ([m, r]) => `<tr><th scope="row"><i class="swatch ${color(m)}"></i>${escaped(m.title)}</th>
    ${[bar(m, r), inParts(r.energyChange), short(view.error(m)), short(view.error(m, 2))].map((cell) => `<td class="right">${cell}</td>`).join("")}
    <td>${r.outcome === "finished" ? "finished" : `${r.outcome} at step ${r.failedStep}`}</td></tr>`;
  $("cost").innerHTML = runs.map(line).join("");
}
