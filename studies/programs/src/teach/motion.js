// The motion itself, at the pace of the clock on the wall: springs, rods, orbits, balls and boxes. It stands still where the
// reader's system asks for less motion, and can be paused and dragged.
const player = { t: 0, playing: false, last: 0, seen: true };
const still = matchMedia("(prefers-reduced-motion: reduce)");

// The rows of a run before and after the time t, and how far between the two it lies.
function between(rows, t) {
  let low = 0, high = rows.length - 1;
  while (high - low > 1) { const k = (low + high) >> 1; if (rows[k][1] <= t) low = k; else high = k; }
  const [a, b] = [rows[low], rows[high]], span = b[1] - a[1];
  return [a, b, span > 0 ? Math.max(0, Math.min(1, (t - a[1]) / span)) : 0];
}
// The columns of a quantity at the time t; of a failed run those of its last row.
function at(rows, q, t) {
  const [a, b, k] = between(rows, t), x = columns(a, q), y = columns(b, q);
  // The nearer of the two quaternions of one attitude.
  const sense = q.width === 4 && x.reduce((sum, c, i) => sum + c * y[i], 0) < 0 ? -1 : 1, mean = Array.from(x, (c, i) => c + k * (sense * y[i] - c));
  return q.width === 4 ? mean.map((c) => c / norm(mean)) : mean;
}

const MOVERS = { spring: springs, rod: rods, orbit: paths, circle: paths, height: balls, box: boxes };
function moverOf() {
  if (scene.picture === "sphere") return "box";
  if (scene.picture === "phase") return scene.quantities[0].id === "attitude" ? "rod" : "spring";
  return scene.picture;
}

// The exact motion first, then what was chosen.
const moving = () => [{ title: "exact", css: "truth", rows: exact().rows }, ...view.entries.map((m) => ({ title: m.name ?? m.title, css: color(m), rows: view.runs[m.id].rows }))];

function drawMotion() {
  const from = performance.now(), all = moving(), t = Math.min(player.t, scene.end);
  $("motion").innerHTML = MOVERS[moverOf()](all, t);
  $("t").value = Math.round((t / scene.end) * $("t").max);
  $("t-value").textContent = `${t.toFixed(1)} of ${scene.end} s`;
  if (window.teach) window.teach.motion = performance.now() - from;
}
// For a reader who does not see it: where everything is now.
function tellMotion() {
  // Before the first run there is nothing to tell.
  if (!view.entries) return;
  const q = scene.quantities[0], t = player.t, place = (m) => `${m.title} ${at(m.rows, q, t).map((x) => short(x)).join(", ")}`;
  $("motion").setAttribute("aria-label", `${QUANTITY[q.id]} at ${t.toFixed(1)} seconds, ${q.width === 4 ? "as a quaternion" : `in ${q.unit}`}: ${moving().map(place).join("; ")}`);
  $("t").setAttribute("aria-valuetext", `${t.toFixed(1)} seconds`);
}

function play(on) {
  if (on && !player.playing) { player.last = performance.now(); requestAnimationFrame(tick); }
  player.playing = on;
  $("play").textContent = on ? "Pause" : "Play";
  tellMotion();
}
function tick(now) {
  if (!player.playing) return;
  const past = Math.min(100, now - player.last) / 1000;
  player.last = now;
  player.t = player.t + past > scene.end ? 0 : player.t + past;
  if (player.seen && view.entries) drawMotion();
  requestAnimationFrame(tick);
}
function listenMotion() {
  $("play").addEventListener("click", () => play(!player.playing));
  $("t").addEventListener("input", () => { play(false); player.t = (scene.end * $("t").value) / $("t").max; drawMotion(); tellMotion(); });
  still.addEventListener("change", () => { if (still.matches) play(false); });
  new IntersectionObserver(([entry]) => { player.seen = entry.isIntersecting; }).observe($("motion"));
}

const words = (x, y, text, anchor = "start") => `<text x="${x.toFixed(1)}" y="${y.toFixed(1)}" text-anchor="${anchor}">${escaped(text)}</text>`;
// A name that fits into so many letters.
const cut = (text, most) => (text.length > most ? `${text.slice(0, most - 1)}…` : text);

function springs(all, t) {
  const q = scene.quantities[0], most = 1.7 * largest(exact().rows.map((r) => Math.abs(r[q.from]))) || 1, lane = (H - 16) / all.length;
  const wall = 24, zero = 232, scale = 150 / most;
  return all.map(({ title, css, rows }, i) => {
    const [x] = at(rows, q, t), y = 20 + lane * (i + 0.55), size = Math.min(26, lane * 0.5), px = zero + Math.max(-185, Math.min(160, x * scale));
    const coils = Array.from({ length: 13 }, (_, k) => `${(wall + ((px - size / 2 - wall) * (k + 0.5)) / 13).toFixed(1)} ${(y + (k % 2 ? 5 : -5)).toFixed(1)}`);
    const off = Math.abs(x) > most * 1.06 || !Number.isFinite(x) ? words(W - 8, y - size / 2 - 5, "off the sheet", "end") : "";
    return `<path class="border" d="M${wall} ${(y - size / 2 - 4).toFixed(1)}V${(y + size / 2 + 4).toFixed(1)}"/><path class="grid" d="M${zero} ${(y - size / 2 - 2).toFixed(1)}V${(y + size / 2 + 2).toFixed(1)}"/>
      <path class="line thin ${css}" d="M${wall} ${y.toFixed(1)}L${coils.join("L")}L${(px - size / 2).toFixed(1)} ${y.toFixed(1)}"/>
      <rect class="dot ${css}" x="${(px - size / 2).toFixed(1)}" y="${(y - size / 2).toFixed(1)}" width="${size.toFixed(1)}" height="${size.toFixed(1)}" rx="3"/>${words(wall, y - size / 2 - 6, title)}${off}`;
  }).join("");
}

function rods(all, t) {
  const q = scene.quantities[0], cx = W / 2, cy = 150, R = 112;
  const rod = ({ css, rows }, i) => {
    const [angle] = at(rows, q, t), px = cx + R * Math.sin(angle), py = cy + R * Math.cos(angle);
    return Number.isFinite(px) ? `<path class="line ${css}" d="M${cx} ${cy}L${px.toFixed(1)} ${py.toFixed(1)}"/>${dot(px, py, i ? 9 : 13, css)}` : "";
  };
  return `<circle class="grid" cx="${cx}" cy="${cy}" r="${R}"/>${all.map(rod).join("")}<circle class="border" cx="${cx}" cy="${cy}" r="3"/>`;
}

function paths(all, t) {
  const see = pictured(scene, values()), truth = exact().points, x = { ...extent(truth.map((p) => p[0]), [], 0.15) }, y = { ...extent(truth.map((p) => p[1]), [], 0.15) };
  const [xs, ys] = squared(x, y), ax = axis(xs, LEFT, W - RIGHT), ay = axis(ys, H - BOTTOM, TOP);
  const sun = scene.picture === "orbit" ? `<circle class="sun" cx="${ax.at(0).toFixed(1)}" cy="${ay.at(0).toFixed(1)}" r="8"/>` : "";
  const body = ({ css, rows }, i) => {
    const [a, b, k] = between(rows, t), p = see(a), r = see(b), n = rows.indexOf(a);
    const now = [p[0] + k * (r[0] - p[0]), p[1] + k * (r[1] - p[1])], tail = [...rows.slice(Math.max(0, n - 24), n + 1).map(see), now];
    const line = i ? `<path class="line ${css}" d="${path(tail, ax, ay)}"/>` : "";
    return line + dot(ax.at(now[0]), ay.at(now[1]), i ? 6 : 8, css);
  };
  return `<path class="line wire" d="${path(truth, ax, ay)}"/>${sun}${all.map(body).join("")}`;
}

function balls(all, t) {
  const q = scene.quantities[0], most = 1.25 * largest(exact().rows.map((r) => r[q.from])), floor = H - 46, scale = (floor - 30) / most, lane = (W - 20) / all.length;
  return `<path class="border" d="M10 ${floor + 10}H${W - 10}"/>${all.map(({ title, css, rows }, i) => {
    const [height] = at(rows, q, t), px = 10 + lane * (i + 0.5);
    return dot(px, Math.max(14, floor - scale * height), 10, css) + words(px, floor + 28, cut(title, Math.floor(lane / 6.4)), "middle");
  }).join("")}`;
}

// Half edges of a box with these principal moments of inertia, in parts of the longest.
function edges([a, b, c]) {
  const squares = [b + c - a, a + c - b, a + b - c].map((x) => Math.sqrt(Math.max(x, 0.02))), most = Math.max(...squares);
  return squares.map((x) => x / most);
}
function boxes(all, t) {
  const q = scene.quantities.find((one) => one.id === "attitude"), half = edges(values().inertia), across = Math.min(all.length, all.length > 6 ? 4 : all.length === 4 ? 2 : 3);
  const down = Math.ceil(all.length / across), [wide, high] = [W / across, H / down], size = Math.min(wide * 0.38, (high - 30) * 0.42);
  // Seen from the front, a little from above and from the right: x to the right, z up.
  const out = [0.36, -0.84, 0.4], right = [0.92, 0.394, 0], up = [-0.158, 0.368, 0.916], along = (v, e) => v[0] * e[0] + v[1] * e[1] + v[2] * e[2];
  return all.map(({ title, css, rows }, i) => {
    const cx = wide * ((i % across) + 0.5), cy = high * (Math.floor(i / across) + 0.5) - 8, attitude = at(rows, q, t), axes = [0, 1, 2].map((k) => bodyAxis(attitude, k));
    const place = (v) => `${(cx + size * along(v, right)).toFixed(1)} ${(cy - size * along(v, up)).toFixed(1)}`;
    let faces = "";
    for (const k of [0, 1, 2]) for (const side of [1, -1]) {
      const depth = side * along(axes[k], out);
      if (!(depth > 0)) continue;
      const [u, v] = [(k + 1) % 3, (k + 2) % 3], corner = (a, b) => [0, 1, 2].map((c) => side * half[k] * axes[k][c] + a * half[u] * axes[u][c] + b * half[v] * axes[v][c]);
      const d = [[1, 1], [1, -1], [-1, -1], [-1, 1]].map(([a, b]) => place(corner(a, b))).join("L");
      faces += `<path class="face ${css}" style="fill-opacity:${(0.15 + 0.55 * depth).toFixed(2)}" d="M${d}Z"/>`;
      // One face is marked: a box looks the same after half a turn.
      if (side > 0) faces += `<path class="line thin ${css}" d="M${place(corner(0.5, 0))}L${place(corner(-0.5, 0))}"/>`;
    }
    return faces + words(cx, high * (Math.floor(i / across) + 1) - 6, cut(title, Math.floor(wide / 6.4)), "middle");
  }).join("");
}
