// The controls, the drags, the bar and the error in the worker.

import assert from 'node:assert/strict';
import { differing, half } from './pictures.mjs';

/** Waits until what was asked for is drawn. */
export async function settled(tab) {
  await tab.evaluate(`new Promise((done) => setTimeout(done, 60))`);
  await tab.until(`document.getElementById('stage').dataset.state !== 'loading'`);
  const frames = await tab.evaluate(`Number(document.getElementById('stage').dataset.frames)`);
  await tab.evaluate('shadows.changed()');
  await tab.until(`Number(document.getElementById('stage').dataset.frames) > ${frames}`);
}

/** Clicks a radio button's label, or chooses in a list. */
export async function choose(tab, name, value) {
  await tab.evaluate(`(() => {
    const control = document.getElementById('panel').elements[${JSON.stringify(name)}];
    if (control instanceof RadioNodeList) {
      [...control].find((radio) => radio.value === ${JSON.stringify(value)}).closest('label').click();
    } else {
      control.value = ${JSON.stringify(value)};
      control.dispatchEvent(new Event('input', { bubbles: true }));
    }
  })()`);
  await settled(tab);
}

/** Middle of an element, in pixels of the window. */
const middle = (tab, id) => tab.evaluate(`(() => {
  const { x, y, width, height } = document.getElementById('${id}').getBoundingClientRect();
  return [x + width / 2, y + height / 2];
})()`);

/** Every choice changes the picture of its half, and the page's address. */
export async function controls(tab) {
  let [left, right] = [await half(tab, 0), await half(tab, 1)];
  // A map and an atlas of one size and kernel show the same, so that volumes come in between.
  const changes = [
    ['right', 'volumes', 1], ['right', 'atlas', 1], ['kernel', 'hard', 1], ['right', 'volumes', 1],
    ['right', 'map', 1], ['size', '1024', 1], ['normal', '3', 1], ['constant', '2', 1], ['left', 'none', 0], ['left', 'bevy', 0],
    ['light', 'spot', 1], ['light', 'sun', 0], ['scene', 'city', 1],
  ];
  const idle = [];
  for (const [name, value, side] of changes) {
    await choose(tab, name, value);
    const before = side === 0 ? left : right;
    [left, right] = [await half(tab, 0), await half(tab, 1)];
    const now = side === 0 ? left : right;
    const count = differing(before, now);
    if (count <= 20) idle.push(`${name}=${value} changes ${count} pixels`);
  }
  assert.deepEqual(idle, []);
  const address = await tab.evaluate('location.hash');
  for (const part of ['scene=city', 'light=sun', 'left=bevy', 'size=1024', 'kernel=hard']) {
    assert.ok(address.includes(part), `${address} does not say ${part}`);
  }
  const [, draws] = await tab.evaluate('shadows.page.statistics(1)');
  const shown = await tab.evaluate(`document.querySelectorAll('#statistics tbody tr')[1].lastElementChild.textContent`);
  assert.equal(shown, String(draws));
  return `${changes.length} choices`;
}

/** Dragging the picture moves the camera, the lamp the light, the wheel brings it nearer. */
export async function drags(tab, touch) {
  const [x, y] = await middle(tab, 'picture');
  const moved = async (what, action) => {
    const before = await half(tab, 1);
    await action();
    await settled(tab);
    assert.ok(differing(before, await half(tab, 1)) > 1000, `${what} moves nothing`);
  };
  const go = (from, to) => (touch ? tab.swipe(from, to) : tab.drag(from, to));
  // Beside the bar.
  await moved('a drag', () => go([x - 80, y + 30], [x - 110, y + 20]));
  const lamp = await middle(tab, 'lamp');
  await moved('a drag of the lamp', () => go(lamp, [lamp[0] + 40, lamp[1] - 10]));
  const put = await middle(tab, 'lamp');
  for (const axis of [0, 1]) {
    const wanted = lamp[axis] + [40, -10][axis];
    assert.ok(Math.abs(put[axis] - wanted) < 2, `the lamp is at ${put}, not 40 to the right and 10 above ${lamp}`);
  }
  await choose(tab, 'drag', 'light');
  await moved('a drag of the light', () => go([x - 80, y + 30], [x - 110, y + 30]));
  await choose(tab, 'drag', 'camera');
  if (touch) return 'by touch';
  await moved('the wheel', () => tab.send('Input.dispatchMouseEvent', {
    type: 'mouseWheel', x: x - 80, y, deltaX: 0, deltaY: -200,
  }));
  await moved('a key', async () => {
    await tab.evaluate(`document.getElementById('picture').focus()`);
    await tab.send('Input.dispatchKeyEvent', { type: 'keyDown', key: 'ArrowLeft' });
  });
  return 'by mouse, wheel and key';
}

/** How many pixels of the canvas are not those of the halves beside a bar at a part of the width. */
const wrongPixels = (tab, bar) => tab.evaluate(`(async () => {
  const { page } = shadows;
  const canvas = document.getElementById('picture');
  page.draw(shadows.bar);
  const { width, height } = canvas;
  const copy = new OffscreenCanvas(width, height).getContext('2d');
  copy.drawImage(canvas, 0, 0);
  const seen = copy.getImageData(0, 0, width, height).data;
  const halves = [await page.read(0), await page.read(1)];
  const split = Math.round(${bar} * width);
  let wrong = 0;
  for (let at = 0; at < seen.length; at += 4) {
    const half = halves[(at / 4) % width < split ? 0 : 1];
    if (seen[at] !== half[at] || seen[at + 1] !== half[at + 1] || seen[at + 2] !== half[at + 2]) wrong += 1;
  }
  return wrong;
})()`);

/** The canvas has the left half to the left of the bar and the right half to the right of it. */
export async function bar(tab) {
  const [x, y] = await middle(tab, 'bar');
  const width = await tab.evaluate(`document.getElementById('stage').clientWidth`);
  await tab.drag([x, y], [x - 0.2 * width, y]);
  await settled(tab);
  const at = await tab.evaluate('shadows.bar');
  assert.ok(Math.abs(at - 0.3) < 0.01, `the bar is at ${at}`);
  assert.equal(await wrongPixels(tab, at), 0);
  // The twin: a bar elsewhere.
  assert.ok(await wrongPixels(tab, 0.6) > 50);
  await tab.drag([x - 0.2 * width, y], [x, y]);
  await settled(tab);
  return `every pixel on its side`;
}

/** The reference answers, is given up when something moves, and answers again. */
export async function error(tab) {
  await tab.evaluate('shadows.meter.restart()');
  await tab.until('shadows.meter.halves !== undefined');
  const { id } = await tab.evaluate('({ id: shadows.meter.id })');
  await tab.evaluate('shadows.turn(0.02, 0); shadows.changed()');
  assert.equal(await tab.evaluate('shadows.meter.done'), false);
  await tab.until('shadows.meter.done', 300);
  assert.ok(await tab.evaluate('shadows.meter.id') > id);
  const counts = await tab.evaluate('shadows.meter.counts.map((side) => [...side])');
  const shown = await tab.evaluate(`document.querySelector('#errors tbody tr').lastElementChild.textContent`);
  const [counted, lit, shadow] = counts[1];
  assert.equal(shown, `${(100 * (lit + shadow) / counted).toFixed(3)} %`);
  await choose(tab, 'show', 'error');
  const colors = await tab.evaluate(`(() => {
    const canvas = document.getElementById('error');
    const { data } = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height);
    let wrong = 0;
    for (let at = 0; at < data.length; at += 4) {
      if (data[at] === 255 && data[at + 1] === 72 || data[at] === 64 && data[at + 1] === 148) wrong += 1;
    }
    return wrong;
  })()`);
  assert.ok(colors > 0, 'no wrong pixel is shown');
  await choose(tab, 'show', 'picture');
  return `left ${counts[0]}, right ${counts[1]}`;
}
