// Runs in a worker: every row of the report once more, in this browser, and compared bit for bit.
onmessage = ({ data }) => recomputed(data).catch((error) => postMessage({ failed: error.message }));

async function recomputed({ module, data, rows: all, set }) {
  const ask = await start(module);
  const same = (a, b) => Object.is(a, b === null ? NaN : b);
  const groups = new Map();
  for (const row of all) {
    const key = row.slice(0, 4).join();
    if (!groups.has(key)) groups.set(key, []);
    groups.get(key).push(row);
  }
  // The cheap ones first: a reader sees the count grow at once.
  const cost = (r) => r[3] * (data.methods[r[1]].implicit ? 20 : data.methods[r[1]].order) * (r[2] === 2 ? 20 : 1);
  const order = [...groups.values()].sort((a, b) => cost(a[0]) - cost(b[0]));
  let done = 0, wrong = [], told = performance.now();
  for (const rows of order) {
    const [scene, method, precision, steps] = rows[0];
    const keys = { scene: data.scenes[scene].id, method: data.methods[method].id, precision: data.precisions[precision], steps, checkpoints: true, set: set[data.scenes[scene].id] };
    const run = table(ask("errors", keys));
    for (const row of rows) {
      // The quantities of a scene stand in one order in the report and in the answer.
      const errors = run.rows[rows.indexOf(row)];
      const [outcome, evaluations, end, max] = row.slice(5);
      const pairs = [[run.evaluations, evaluations], [errors[0], end], [errors[1], max]];
      for (const [mine, theirs] of pairs) {
        if (same(mine, theirs) && run.outcome === data.outcomes[outcome]) done++;
        else wrong.push(`${keys.scene} ${keys.method} ${keys.precision} ${steps}: ${mine}, report ${theirs}`);
      }
    }
    if (performance.now() - told > 50) { postMessage({ done, wrong, finished: false }); told = performance.now(); }
  }
  postMessage({ done, wrong, finished: true });
}
