// The error of both halves, measured in a worker as soon as nothing moves.

import { showErrors } from './statistics.js';

/** Milliseconds of rest before it is measured. */
const PAUSE = 400;
/** Most pixels that are looked at. */
const PIXELS = 90_000;

export class ErrorMeter {
  /** `measure(width, height)` draws both halves and gives `{ job, visibility }`. */
  constructor(module, canvas, measure, choices, problem) {
    Object.assign(this, { canvas, measure, choices, problem });
    this.worker = new Worker(new URL('./worker.js', import.meta.url), { type: 'module' });
    this.worker.onmessage = ({ data }) => this.#answer(data);
    this.worker.onerror = (event) => problem(`the reference stopped: ${event.message}`);
    this.worker.postMessage({ module });
    this.id = 0;
  }

  /** Something has changed: what was measured is of another picture. */
  restart() {
    this.id += 1;
    this.worker.postMessage({ id: this.id });
    this.halves = undefined;
    this.done = false;
    this.draw(0.5);
    showErrors(null, 'once nothing moves', 0);
    clearTimeout(this.timer);
    this.timer = setTimeout(() => this.#start(), PAUSE);
  }

  async #start() {
    const { id } = this;
    const { clientWidth, clientHeight } = this.canvas.parentElement;
    const scale = Math.min(1, Math.sqrt(PIXELS / (clientWidth * clientHeight)));
    const [width, height] = [clientWidth, clientHeight].map((side) => Math.max(1, Math.round(side * scale)));
    let measurement;
    try {
      measurement = this.measure(width, height);
      const { job: numbers } = measurement;
      this.numbers = numbers;
      const visibility = await measurement.visibility;
      if (id !== this.id) return;
      const half = () => new OffscreenCanvas(width, height);
      this.halves = [half(), half()];
      const { scene, light } = this.choices();
      showErrors(null, `${width} × ${height} points`, 0);
      this.worker.postMessage({ id, scene, light, numbers, width, height, visibility }, [visibility.buffer]);
    } catch (error) {
      this.problem(String(error.message ?? error));
    } finally {
      measurement?.free();
    }
  }

  #answer({ id, first, end, colors, counts, done, problem }) {
    if (id !== this.id) return;
    if (problem) {
      this.problem(problem);
      return;
    }
    const [{ width, height }] = this.halves;
    const bytes = 4 * width * (end - first);
    this.halves.forEach((half, side) => {
      const pixels = new Uint8ClampedArray(colors.buffer, colors.byteOffset + side * bytes, bytes);
      half.getContext('2d').putImageData(new ImageData(pixels, width), 0, first);
    });
    showErrors(counts, `${width} × ${height} points`, end / height);
    this.counts = counts;
    this.done = done;
    this.draw(this.bar);
  }

  /** Shows what is known of both halves over the picture; the bar in parts of the width. */
  draw(bar) {
    this.bar = bar;
    const { canvas, halves } = this;
    if (canvas.hidden) return;
    const context = canvas.getContext('2d');
    if (!halves) {
      context.clearRect(0, 0, canvas.width, canvas.height);
      return;
    }
    const [{ width, height }] = halves;
    Object.assign(canvas, { width, height });
    const split = Math.round(bar * width);
    if (split > 0) context.drawImage(halves[0], 0, 0, split, height, 0, 0, split, height);
    const rest = width - split;
    if (rest > 0) context.drawImage(halves[1], split, 0, rest, height, split, 0, rest, height);
  }
}
