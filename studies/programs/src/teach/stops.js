// The guided path: ten questions. Each sets the page and says what to see; every number in it follows what the page is set to.
const code = (text) => `<span class="num">${escaped(text)}</span>`;
const times = (x) => code(`${short(x)}×`);
const DIGITS = { "f32": "seven digits", "f64": "sixteen digits", "double-double": "thirty-one digits" };
const ratioOf = (run) => run.energy.map(([, r]) => r);
const STOPS = [
  {
    title: "Explicit Euler", question: "Why does explicit Euler gain energy?",
    set: { scene: "oscillator", methods: ["explicit-euler", "semi-implicit-euler"], h: 0.05 },
    story(v) {
      const run = v.runs["explicit-euler"], gain = 1 + v.homega ** 2;
      return `It goes straight on along the tangent, and a tangent leaves a circle outwards. One step multiplies the energy by
        1 + (ωh)² = ${code(gain.toPrecision(8))}. ${code(v.steps)} steps make that ${times(gain ** v.steps)}; the run ended with
        ${times(run.lastRatio)} the energy it began with. Make the step smaller: it gains more slowly, but it always gains.`;
    },
  },
  {
    title: "A band", question: "Why does semi-implicit Euler only oscillate?",
    set: { scene: "oscillator", methods: ["semi-implicit-euler"], h: 0.25 },
    story(v) {
      const r = ratioOf(v.runs["semi-implicit-euler"]), seen = Math.max(...r) / Math.min(...r), x = v.homega;
      return `It uses the new velocity to move, and so it conserves something after all: not the energy, but
        v² + ω²x² − hω²xv, an ellipse leaning a little. Going round it, the energy swings and comes back. Largest over smallest:
        ${code(seen.toPrecision(4))}; the ellipse says at most (2 + ωh)/(2 − ωh) = ${code(((2 + x) / (2 - x)).toPrecision(4))}. Drag the step, the band
        widens; wait as long as you like, it never drifts.`;
    },
  },
  {
    title: "Order", question: "What does order mean?",
    set: { scene: "pendulum", methods: ["explicit-euler", "velocity-verlet", "rk4"], h: 0.0125 },
    story(v) {
      const part = (m) => `${escaped(m.title)} ${code(short(v.error(m)))} → ${code(short(v.error(m, 2)))}, ${times(v.error(m) / v.error(m, 2))} less`;
      return `Halve the step and look at the error after ${code(v.scene.horizon_s)} s: ${v.entries.map(part).join("; ")}. A method of order p gains
        2<sup>p</sup>: twice, four times, sixteen times. On the convergence chart that is the slope of the line, and your step is the mark that
        slides along it.`;
    },
  },
  {
    title: "Too small", question: "Why is smaller not always better?",
    set: { scene: "oscillator", methods: ["velocity-verlet", "rk4"], h: 0.012, precision: "f32" },
    story(v) {
      const m = METHODS.find((m) => m.id === "rk4"), best = v.best(m), used = v.precision(), other = used === "f32" ? "f64" : "f32";
      // Where the finest step of the line is the best, the line has no bottom to show.
      const floor = v.finest(m) < best.h;
      const bottom = floor
        ? `but by ${code(short(best.error))} at h = ${code(short(best.h))} s: beyond that, each smaller step only adds one more rounding`
        : `and by ${code(short(best.error))} at h = ${code(short(best.h))} s, the smallest of the line: its floor lies lower still`;
      return `This run is in ${used}, ${DIGITS[used]}. RK4 errs by ${code(short(v.error(m)))} at this step, ${bottom}. The same step in ${other}
        errs by ${code(short(v.error(m, 1, other)))}. ${used === "f32" ? "Slide up and down past the bottom of the line, then choose f64 and see the floor drop away."
          : "Choose f32 to see the floor come up."}`;
    },
  },
  {
    title: "The cliff", question: "What happens at ωh = 2?",
    set: { scene: "oscillator", methods: ["semi-implicit-euler", "velocity-verlet", "rk4"], h: 0.982 },
    story(v) {
      const r = v.radius("semi-implicit-euler"), x = v.homega, run = v.runs["semi-implicit-euler"];
      if (!run) return "Choose semi-implicit Euler again: it is the one that falls here.";
      const grows = r > 1 + 1e-9;
      return `Now ωh = ${code(x.toPrecision(4))}. One step of semi-implicit Euler stretches the worst direction by
        ${code(r.toPrecision(6))}${grows ? `, and ${code(v.steps)} of them by ${times(r ** v.steps)}: it is over the cliff.` : ": nothing grows."}
        ${grows ? "" : `The energy warns all the same: its largest value over its smallest is ${times(Math.max(...ratioOf(run)) / Math.min(...ratioOf(run)))} here,
        at most ((2 + ωh)/(2 − ωh)) = ${times((2 + x) / (2 - x))}, a band that has no upper end as ωh nears 2.`}
        Press → on the slider, once or twice. The factor of a step stays exactly 1 up to 2 and tells nothing; the band of the energy does. The
        stiffest spring of a scene decides the step for all of it.`;
    },
  },
  {
    title: "Quietly wrong", question: "Can everything be conserved and still be wrong?",
    set: { scene: "torque-free-spin", methods: ["semi-implicit-euler", "no-gyroscopic-term"], h: 0.02 },
    story(v) {
      const m = v.entries.find((m) => m.id === "no-gyroscopic-term"), ok = v.entries.find((m) => m.id === "semi-implicit-euler");
      if (!m || !ok) return "Choose both methods again to compare them.";
      const run = v.runs[m.id];
      return `Many engines leave out the gyroscopic term. Without it this box keeps its energy to ${code(short(run.energyChange))} and |L| to
        ${code(short(run.fourthLargest))}, and after ${code(v.scene.horizon_s)} s it points ${code(short(v.error(m)))} rad wrong. With half the step:
        ${code(short(v.error(m, 2)))} rad. No step is small enough; the axis spins where it should wander. With the term, half the step makes
        ${code(short(v.error(ok)))} rad into ${code(short(v.error(ok, 2)))} rad, though its energy shows an error. Conservation is not accuracy.`;
    },
  },
  {
    title: "A bounce", question: "Why does a bouncing ball spoil every order?",
    set: { scene: "bouncing-ball", methods: ["explicit-euler", "velocity-verlet", "rk4"], h: 0.03 },
    story(v) {
      const m = METHODS.find((m) => m.id === "rk4");
      const list = [1, 2, 3, 5].map((k) => code(short(v.error(m, k)))).join(", ");
      return `In flight Verlet and RK4 are exact. But the floor is noticed only at the end of a step, up to h too late, and nothing inside the method
        knows. RK4 with this step, a half, a third, a fifth of it errs by ${list} m: it jumps about under a line of slope 1. Its energy has
        changed by ${code(short(v.runs.rk4 ? v.runs.rk4.energyChange : NaN))}; explicit Euler's, at every step, by m g²h²/2.`;
    },
  },
  {
    title: "Your scene", question: "What step does a scene need?",
    set: { scene: "kepler/eccentric", methods: ["semi-implicit-euler", "velocity-verlet", "rk4"], h: 0.02 },
    story(v) {
      const one = (m) => {
        const need = v.needs(m, 0.01), step = need && `h = ${code(short(need.h))} s and ${code(need.evaluations)} evaluations`;
        return `${escaped(m.title)} ${step ?? "a smaller step than any of its line"}`;
      };
      const source = v.ofReport() ? "the report answers" : v.changed() ? "runs with your parameters answer, made in this browser"
        : "runs in this browser answer, as this report has no rows of the scene";
      const p = v.values(), round = 2 * Math.PI, n = Math.sqrt(p.mu / p.semi_major) / p.semi_major;
      const first = (round - (((p.anomaly % round) + round) % round)) / n;
      const change = (m) => `${code(inParts(v.runs[m.id].energyChange))} (${escaped(m.title)})`;
      return `Ask for an error of 1 % of the distance after ${code(v.scene.horizon_s)} s, and ${source}: ${v.entries.map(one).join("; ")}. But the
        planet passes its sun after ${code(short(first))} s, and passing takes only ${code(short(v.scene.time_scale_s))} s: your step is
        ${code(short(v.h / v.scene.time_scale_s))} of that. Over ${code(v.scene.end)} s the energy changes by up to ${v.entries.map(change).join(", ")} of itself, and the
        energy chart shows when: at each passing. Ask for the shortest time of your scene, and for what must not drift; then drag.`;
    },
  },
  {
    title: "The loop", question: "What do substeps and a loop that stutters do?",
    set: { scene: "oscillator", methods: ["semi-implicit-euler", "rk4"], h: 0.7, jitter: 0.25 },
    story(v) {
      const m = v.entries.find((one) => one.id === "semi-implicit-euler");
      if (!m) return "Choose semi-implicit Euler again: it shows what the loop does.";
      const top = (run) => Math.max(...ratioOf(run)), vary = v.jitter();
      const loop = vary > 0
        ? `The steps vary by up to ${code(Math.round(100 * vary))} % either way, as frames do, and the energy rises to ${times(top(v.runs[m.id]))} its start; with even
          steps of the same mean length to ${times(top(v.even(m)))}. The ellipse that each step keeps leans as its step says, so that steps of many lengths
          keep none: errors grow though no step is over the limit.`
        : `All steps are alike now, and the energy stays below ${times(top(v.runs[m.id]))} its start. Let the steps vary to see what a loop that stutters does.`;
      return `A frame of ${code(short(v.h * v.substeps()))} s, in ${code(counted(v.substeps(), "step"))} of ωh = ${code(v.homega.toPrecision(3))}. ${loop}
        Choose more substeps: each halves the error of a method of order 1, and costs twice the evaluations. Or keep the step fixed and let the picture wait.`;
    },
  },
  {
    title: "Half a kick", question: "Which method is half a kick away?",
    set: { scene: "pendulum", methods: ["semi-implicit-euler", "half-kick", "velocity-verlet"], h: 0.1 },
    story(v) {
      const of = (id) => v.entries.find((one) => one.id === id), [plain, half, verlet] = ["semi-implicit-euler", "half-kick", "velocity-verlet"].map(of);
      if (!plain || !half || !verlet) return "Choose all three again to compare them.";
      const [a, b] = [half, verlet].map((m) => v.runs[m.id].points);
      const apart = largest(a.map((p, i) => Math.hypot(p[0] - b[i][0], p[1] - b[i][1])));
      const part = (m) => `${escaped(m.title)} ${code(short(v.error(m)))} → ${code(short(v.error(m, 2)))}`;
      return `Take half a kick from the velocity, run semi-implicit Euler, and read each velocity half a kick later, in the middle between two steps:
        q and v are then those of velocity Verlet, here to ${code(short(apart))} over ${code(v.steps)} steps. Not a step has changed, but the error
        after ${code(v.scene.horizon_s)} s with this step and with half of it is: ${[plain, half, verlet].map(part).join("; ")} rad. An order gained for one
        kick: the first-order error of semi-implicit Euler was in where its velocity is read.`;
    },
  },
];
