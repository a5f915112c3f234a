"use strict";
// The module and its questions; the page and its worker share this.
const bytesOf = (base64) => Uint8Array.from(atob(base64), (c) => c.charCodeAt(0));

async function start(base64) {
  const packed = new Blob([bytesOf(base64)]).stream().pipeThrough(new DecompressionStream("gzip"));
  const bytes = await new Response(packed).arrayBuffer();
  const { instance } = await WebAssembly.instantiate(bytes, {});
  const module = instance.exports, encoder = new TextEncoder(), decoder = new TextDecoder();
  const text = () => decoder.decode(new Uint8Array(module.memory.buffer, module.message(), module.message_length()));
  // A question is a command and an object of keys; an array repeats its key. Throws what the module says is wrong.
  return (command, keys) => {
    let question = command;
    for (const [key, value] of Object.entries(keys)) for (const v of [value].flat()) question += `\n${key} ${v}`;
    const bytes = encoder.encode(question);
    const place = module.input(bytes.length);
    new Uint8Array(module.memory.buffer, place, bytes.length).set(bytes);
    const count = module.ask();
    if (count < 0) throw new Error(text());
    // The memory may have moved while the answer grew.
    return { numbers: new Float64Array(module.memory.buffer, module.numbers(), count).slice(), text };
  };
}

const OUTCOMES = ["finished", "diverged", "not-converged"];

// Head and rows of an answer.
function table({ numbers }) {
  const [outcome, failedStep, evaluations, width] = numbers;
  const rows = [];
  for (let i = 4; width > 0 && i + width <= numbers.length; i += width) rows.push(numbers.subarray(i, i + width));
  return { outcome: OUTCOMES[outcome], failedStep, evaluations, rows };
}
