// The reference, in a worker: rays for a few rows at a time, given up as soon as another job comes.

import init, { Reference } from './shadows_web.js';

/** Rows between two looks for another job. */
const ROWS = 8;

let ready;
let job;
let reference;
let referenceOf;

self.onmessage = async ({ data }) => {
  if (data.module) {
    ready = init({ module_or_path: data.module });
    return;
  }
  job = data;
  if (!data.numbers) return; // nothing is wanted any more
  try {
    await ready;
    await run(data);
  } catch (error) {
    postMessage({ id: data.id, problem: String(error.message ?? error) });
  }
};

/** Lets messages that have arrived be read. */
const breathe = () => new Promise((resolve) => setTimeout(resolve));

async function run(mine) {
  const { id, scene, light, numbers, width, height, visibility } = mine;
  const of = `${scene} ${light}`;
  if (referenceOf !== of) {
    reference?.free();
    [reference, referenceOf] = [undefined, undefined];
    reference = new Reference(scene, light);
    referenceOf = of;
  }
  for (let first = 0; first < height; first += ROWS) {
    await breathe();
    if (job !== mine) return;
    const end = Math.min(first + ROWS, height);
    const colors = reference.rows(numbers, width, height, first, end, visibility);
    const counts = [reference.counts(0), reference.counts(1)];
    postMessage({ id, first, end, colors, counts, done: end === height }, [colors.buffer]);
  }
}
