// Charts as SVG text: one string a chart, set at once. 420 x 300 units; colours come from the style sheet.
const W = 420, H = 300, LEFT = 58, RIGHT = 12, TOP = 12, BOTTOM = 42;
const escaped = (text) => String(text).replace(/[&<>"]/g, (c) => `&#${c.charCodeAt(0)};`);

// Four digits, and a power of ten where it needs one.
function short(x) {
  if (x === null || x === undefined || Number.isNaN(x)) return "–";
  if (x === 0) return "0";
  if (!Number.isFinite(x)) return x > 0 ? "∞" : "−∞";
  const size = Math.abs(x);
  if (size >= 1e-3 && size < 9999.5) return x.toPrecision(4).replace(/\.?0+$/, (z) => (x.toPrecision(4).includes(".") ? "" : z)).replace("-", "−");
  const [m, e] = x.toExponential(2).split("e");
  return `${m}·10${superscript(+e)}`.replace(/^-/, "−");
}
const superscript = (n) => String(n).replace(/[-0-9]/g, (c) => (c === "-" ? "⁻" : "⁰¹²³⁴⁵⁶⁷⁸⁹"[+c]));

// Round numbers between two ends, about five of them.
function ticks(low, high) {
  const raw = (high - low) / 5, ten = 10 ** Math.floor(Math.log10(raw));
  const step = [1, 2, 5, 10].find((k) => k * ten >= raw) * ten, list = [];
  for (let k = Math.ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; k++) list.push(k * step);
  return list.map((v) => [v, String(+v.toPrecision(6)).replace("-", "−")]);
}
function decades(low, high) {
  const every = Math.max(1, Math.ceil((high - low) / 6)), list = [];
  for (let k = Math.ceil(low - 1e-9); k <= high + 1e-9; k++) if (k % every === 0) list.push([k, k === 0 ? "1" : k === 1 ? "10" : `10${superscript(k)}`]);
  return list;
}

// An axis: from its two ends in data (logarithms where log) to pixels.
function axis({ from, to, log, label }, first, last) {
  const [a, b] = log ? [Math.log10(from), Math.log10(to)] : [from, to];
  const scale = (last - first) / (b - a);
  const at = (v) => first + ((log ? Math.log10(v) : v) - a) * scale;
  const marks = (log ? decades(a, b) : ticks(a, b)).map(([v, text]) => [first + (v - a) * scale, text]);
  return { at, marks, label };
}

// Points that are no place on the sheet break the line; far ones are kept near, so that no renderer chokes on them.
function path(points, x, y) {
  let d = "", up = true;
  for (const [a, b] of points) {
    const px = x.at(a), py = y.at(b);
    if (!Number.isFinite(px) || !Number.isFinite(py)) { up = true; continue; }
    d += `${up ? "M" : "L"}${Math.max(-900, Math.min(1300, px)).toFixed(1)} ${Math.max(-900, Math.min(1300, py)).toFixed(1)}`;
    up = false;
  }
  return d;
}

const frame = (id, inside) =>
  `<defs><clipPath id="clip-${id}"><rect x="${LEFT}" y="${TOP}" width="${W - LEFT - RIGHT}" height="${H - TOP - BOTTOM}"/></clipPath></defs>${inside}`;

// Lines that run together would hide each other: they share the way in dashes, and what lies below is the
// broader, where a line comes round over its own gaps. Attributes for each list of places [x, y]
// on the sheet; a line runs together with another that passes within a pixel and a half of three of four of its places,
// whenever it does: orbits coincide though one is late.
function shared(lists) {
  const passes = (line, [x, y]) => {
    for (let i = 1; i < line.length; i++) {
      const [a, b] = line[i - 1], u = line[i][0] - a, v = line[i][1] - b;
      const k = Math.max(0, Math.min(1, ((x - a) * u + (y - b) * v) / (u * u + v * v || 1)));
      if ((a + k * u - x) ** 2 + (b + k * v - y) ** 2 < 2.25) return true;
    }
    return false;
  };
  const together = (line, other) => {
    const places = other.filter((_, i) => i % Math.ceil(other.length / 24) === 0);
    let missed = 0;
    return places.length > 1 && places.every((p) => passes(line, p) || 4 * ++missed < places.length);
  };
  const groups = [];
  lists.forEach((list, i) => {
    const group = groups.find(([first]) => together(lists[first], list));
    if (group) group.push(i); else groups.push([i]);
  });
  const drawn = lists.map(() => "");
  for (const group of groups) {
    const n = group.length, grown = 2.4 / Math.max(1.5, n - 1);
    for (let k = 0; k < n && n > 1; k++) {
      // The first stays whole below the others.
      const dash = k ? ` stroke-dasharray="9 ${9 * (n - 1)}" stroke-dashoffset="${-9 * k}"` : "";
      drawn[group[k]] = `${dash} style="stroke-width:${(2 + grown * (n - 1 - k)).toFixed(1)}"`;
    }
  }
  return drawn;
}

// How far out a mark stands so that the marks after it at the same place leave a ring of it.
const rings = (places) => places.map((p, i) => 6 + 2.5 * Math.min(3, places.slice(i + 1).filter((q) => Math.hypot(p[0] - q[0], p[1] - q[1]) < 4).length));

// series: {points, css, dots}; marks: {at: [x, y], css}; lines: {from, to, css}; shade: [y0, y1]; square: the same scale on both axes.
function chart(svg, { x: xs, y: ys, series, marks = [], shade, lines = [], square, name }) {
  if (square) [xs, ys] = squared(xs, ys);
  const id = svg.id, x = axis(xs, LEFT, W - RIGHT), y = axis(ys, H - BOTTOM, TOP);
  let s = "";
  if (shade) s += `<rect class="shade" x="${LEFT}" width="${W - LEFT - RIGHT}" y="${y.at(shade[1]).toFixed(1)}" height="${(y.at(shade[0]) - y.at(shade[1])).toFixed(1)}"/>`;
  for (const [px] of x.marks) s += `<path class="grid" d="M${px.toFixed(1)} ${TOP}V${H - BOTTOM}"/>`;
  for (const [, py] of y.marks.map(([p, t]) => [t, p])) s += `<path class="grid" d="M${LEFT} ${py.toFixed(1)}H${W - RIGHT}"/>`;
  let inside = "";
  for (const { from, to, css } of lines) inside += `<path class="line ${css}" d="${path([from, to], x, y)}"/>`;
  const place = ([a, b]) => [x.at(a), y.at(b)];
  // The exact motion is broad and lies below: it hides nothing, and nothing hides it.
  const drawn = shared(series.map(({ points, css }) => (css === "exact" ? [] : points.map(place))));
  for (const [i, { points, css, dots }] of series.entries()) {
    inside += `<path class="line ${css}"${drawn[i]} d="${path(points, x, y)}"/>`;
    if (dots) for (const p of points) inside += dot(x.at(p[0]), y.at(p[1]), 2.2, css);
  }
  s += `<g clip-path="url(#clip-${id})">${inside}</g>`;
  const ends = marks.map(({ at }) => place(at)), sizes = rings(ends);
  // Over the edge of the sheet, not cut by it.
  for (const [i, { css }] of marks.entries()) s += mark(...ends[i], sizes[i], css);
  for (const [px, text] of x.marks) s += `<text x="${px.toFixed(1)}" y="${H - BOTTOM + 17}" text-anchor="middle">${text}</text>`;
  for (const [py, text] of y.marks) s += `<text x="${LEFT - 6}" y="${(py + 4).toFixed(1)}" text-anchor="end">${text}</text>`;
  s += `<path class="border" d="M${LEFT} ${TOP}V${H - BOTTOM}H${W - RIGHT}"/>`;
  s += `<text x="${(LEFT + W - RIGHT) / 2}" y="${H - 6}" text-anchor="middle">${escaped(x.label)}</text>`;
  s += `<text transform="translate(13 ${(TOP + H - BOTTOM) / 2}) rotate(-90)" text-anchor="middle">${escaped(y.label)}</text>`;
  show(svg, frame(id, s), name);
}

function dot(px, py, r, css) {
  return Number.isFinite(px) && Number.isFinite(py) ? `<circle class="dot ${css}" cx="${px.toFixed(1)}" cy="${py.toFixed(1)}" r="${r}"/>` : "";
}
// A mark that has left the sheet stays at its edge.
const mark = (px, py, r, css) => dot(Math.max(LEFT, Math.min(W - RIGHT, px)), Math.max(TOP, Math.min(H - BOTTOM, py)), r, `mark ${css}`);

function squared(xs, ys) {
  const wide = (xs.to - xs.from) / (W - LEFT - RIGHT), high = (ys.to - ys.from) / (H - TOP - BOTTOM), k = Math.max(wide, high);
  const grown = (s, pixels) => { const c = (s.from + s.to) / 2, r = (k * pixels) / 2; return { ...s, from: c - r, to: c + r }; };
  return [grown(xs, W - LEFT - RIGHT), grown(ys, H - TOP - BOTTOM)];
}

function show(svg, inside, name) {
  svg.innerHTML = inside;
  svg.setAttribute("aria-label", name);
}

// Where to look at the sphere from: from the side of most of the points `seen`, and a little from the front and above.
function eye(seen) {
  const unit = (v) => v.map((c) => c / Math.hypot(...v)), cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
  const mean = [0, 1, 2].map((i) => seen.reduce((sum, v) => sum + v[i], 0) / seen.length);
  const out = unit([mean[0] * 2 + 0.3, mean[1] * 2 - 0.5, mean[2] + 0.25]), right = unit(cross([0, 0, 1], out));
  return { out, right, up: cross(out, right) };
}

// The unit sphere: what lies behind is faint. series: {points: unit vectors, css}.
function sphere(svg, { series, marks = [], name, seen }) {
  const EYE = eye(seen);
  const R = 128, cx = W / 2, cy = H / 2 - 6, along = (v, e) => v[0] * e[0] + v[1] * e[1] + v[2] * e[2];
  const place = (v) => [cx + R * along(v, EYE.right), cy - R * along(v, EYE.up), along(v, EYE.out)];
  // The line in pieces, in front and behind.
  const pieces = (points) => {
    const d = ["", ""]; let before = -1;
    for (const v of points) {
      const [px, py, depth] = place(v), side = depth >= 0 ? 0 : 1, at = `${px.toFixed(1)} ${py.toFixed(1)}`;
      if (!Number.isFinite(px)) { before = -1; continue; }
      if (before >= 0 && side !== before) d[before] += `L${at}`;
      d[side] += `${side === before ? "L" : "M"}${at}`;
      before = side;
    }
    return d;
  };
  const circle = (f) => pieces(Array.from({ length: 73 }, (_, k) => f((k * Math.PI) / 36)));
  let back = "", front = "";
  const both = (d, css, how = "") => { back += `<path class="line behind ${css}"${how} d="${d[1]}"/>`; front += `<path class="line ${css}"${how} d="${d[0]}"/>`; };
  for (const z of [-0.5, 0, 0.5]) both(circle((a) => [Math.cos(a) * Math.sqrt(1 - z * z), Math.sin(a) * Math.sqrt(1 - z * z), z]), "wire");
  for (const m of [0, 1, 2]) both(circle((a) => [Math.sin(a) * Math.cos((m * Math.PI) / 3), Math.sin(a) * Math.sin((m * Math.PI) / 3), Math.cos(a)]), "wire");
  const drawn = shared(series.map(({ points, css }) => (css === "exact" ? [] : points.map(place))));
  for (const [i, { points, css }] of series.entries()) both(pieces(points), css, drawn[i]);
  const ends = marks.map(({ at }) => place(at)), sizes = rings(ends);
  for (const [i, { css }] of marks.entries()) {
    const [px, py, depth] = ends[i], text = dot(px, py, sizes[i], `mark ${css}${depth < 0 ? " behind" : ""}`);
    if (depth < 0) back += text; else front += text;
  }
  show(svg, `${back}<circle class="rim" cx="${cx}" cy="${cy}" r="${R}"/>${front}`, name);
}
