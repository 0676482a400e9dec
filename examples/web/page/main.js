// The page: opens the module, draws when something has changed, and says what it came to.

import init, { Page } from './shadows_web.js';
import { Controls } from './controls.js';
import { ErrorMeter } from './error.js';
import { listen, showBar, showLamp } from './pointer.js';
import { showErrors, showFrameTime, showStatistics } from './statistics.js';

const [stage, canvas, overlay] = ['stage', 'picture', 'error'].map((id) => document.getElementById(id));

/** Radians in a second. */
const TURNING = 0.5;

/** Says why there is no picture. */
function sorry(why) {
  document.getElementById('why').textContent = why;
  document.getElementById('sorry').hidden = false;
  document.body.classList.add('sorry');
}

function problem(text) {
  const place = document.getElementById('problem');
  place.hidden = !text;
  place.textContent = text ?? '';
}

/** Why there can be no picture, and the graphics processor if there can. */
async function findAdapter() {
  const no = (why) => ({ why });
  if (!window.isSecureContext) {
    return no('Browsers offer WebGPU only to pages that come over HTTPS or from this computer (localhost).');
  }
  if (!navigator.gpu) return no('This page draws with WebGPU, which this browser does not offer.');
  const adapter = await navigator.gpu.requestAdapter().catch(() => null);
  if (!adapter) return no('This browser has WebGPU, but no graphics processor or driver that it would use.');
  const { vendor, architecture, device, description } = adapter.info;
  return { name: [...new Set([vendor, architecture, device, description])].filter(Boolean).join(' ') };
}

/** Pixels of the canvas for its place on the page. */
function sizeCanvas() {
  const scale = Math.min(window.devicePixelRatio, 2);
  const size = [stage.clientWidth, stage.clientHeight].map((side) => Math.max(1, Math.round(side * scale)));
  [canvas.width, canvas.height] = size;
  return size;
}

const nextFrame = () => new Promise(requestAnimationFrame);

/** Says what takes long before it is begun. */
async function busy(text) {
  stage.dataset.state = 'loading';
  document.getElementById('busy').textContent = text;
  await nextFrame();
  await nextFrame();
}

class View {
  bar = 0.5;
  #asked = false;
  #last = 0;
  #frames = 0;

  constructor(page, controls, meter) {
    Object.assign(this, { page, controls, meter });
  }

  dragsLight() { return this.controls.values.drag === 'light'; }
  turn(x, y) { this.page.turn_camera(x, y); this.#moved(); }
  advance(steps) { this.page.advance_camera(steps); this.#moved(); }
  light(x, y) { this.page.drag_light(x, y); this.#moved(); }

  #moved() { this.meter.restart(); }

  /** Draws soon. */
  changed() {
    if (this.#asked) return;
    this.#asked = true;
    requestAnimationFrame((now) => this.#frame(now));
  }

  #frame(now) {
    this.#asked = false;
    const passed = now - this.#last;
    this.#last = now;
    const turning = this.controls.values.turn !== '';
    if (turning) {
      this.page.turn_light(TURNING * Math.min(passed, 100) / 1000);
      this.#moved();
    }
    try {
      this.page.draw(this.bar);
      problem(this.page.refused());
    } catch (error) {
      problem(String(error.message ?? error));
    }
    showLamp(this.page.lamp());
    showStatistics([this.page.statistics(0), this.page.statistics(1)]);
    showFrameTime(passed < 500 ? passed : 0);
    this.meter.draw(this.bar);
    this.#frames += 1;
    stage.dataset.frames = this.#frames;
    if (turning) this.changed();
  }
}

/** Tells Rust what has changed in the controls. */
async function apply(view, names) {
  const { page, controls, meter } = view;
  const { values } = controls;
  if (names.some((name) => name === 'scene' || name === 'light')) await busy(`Building the ${values.scene}…`);
  try {
    for (const name of names) {
      if (name === 'show') showKind(page, values.show);
      else if (name !== 'drag' && name !== 'turn') page.set(name, values[name]);
    }
  } catch (error) {
    problem(String(error.message ?? error));
  }
  showNames(controls);
  if (names.some((name) => !['show', 'drag', 'turn'].includes(name))) meter.restart();
  view.changed();
  await nextFrame();
  await nextFrame();
  if (stage.dataset.state === 'loading') stage.dataset.state = 'ready';
}

/** The error lies over the visibility. */
function showKind(page, kind) {
  overlay.hidden = kind !== 'error';
  document.getElementById('legend').hidden = overlay.hidden;
  page.set('show', kind === 'picture' ? 'picture' : 'visibility');
}

function showNames(controls) {
  const [left, right] = controls.names();
  document.getElementById('left-name').textContent = left;
  document.getElementById('right-name').textContent = right;
  const lamp = controls.values.light === 'sun' ? '' : ', the lamp';
  document.getElementById('hint').textContent = `Drag the picture${lamp} and the bar`;
}

async function start() {
  const { why, name } = await findAdapter();
  if (why) {
    sorry(why);
    return;
  }
  const module = await WebAssembly.compileStreaming(fetch(new URL('./shadows_web_bg.wasm', import.meta.url)));
  await init({ module_or_path: module });
  const [normal, constant] = Page.default_bias();
  let view;
  const controls = new Controls(
    document.getElementById('panel'),
    { normal, constant },
    (names) => view && apply(view, names),
  );
  await busy(`Building the ${controls.values.scene}…`);
  sizeCanvas();
  const choices = Object.entries(controls.values)
    .filter(([name]) => !['show', 'drag', 'turn'].includes(name));
  const page = await Page.open(canvas, choices.flat());
  const meter = new ErrorMeter(
    module,
    overlay,
    (width, height) => page.measure(width, height),
    () => controls.values,
    problem,
  );
  view = new View(page, controls, meter);
  document.getElementById('adapter').textContent = name;
  showBar(view.bar);
  showNames(controls);
  showKind(page, controls.values.show);
  showErrors(null, '', 0);
  listen(view);
  new ResizeObserver(() => {
    page.resize(...sizeCanvas());
    meter.restart();
    view.changed();
  }).observe(stage);
  stage.dataset.state = 'ready';
  // For the console, and for tests.
  window.shadows = view;
}

start().catch((error) => {
  console.error(error);
  sorry(`It could not be started: ${error.message ?? error}`);
});
