// The page's pixels against those that the same code draws without a browser, on the same driver.

import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';

/** Scenes, lights and methods that are compared; every scene, light and method occurs. */
export const PICTURES = [
  '',
  'right=volumes&left=three',
  'right=atlas&left=bevy&kernel=bilinear&size=512',
  'light=spot&kernel=weighted_7&left=bevy-gaussian',
  'light=sun&right=volumes&left=textbook-volumes',
  'scene=city&light=sun&right=atlas&size=512',
  'scene=city&kernel=vogel&left=none',
  'scene=valley&light=sun&kernel=contact',
];

/** Draws natively: halves, visibilities and counts. */
export class Native {
  constructor(folder, driver) {
    const build = ['build', '--quiet', '--locked', '--bin', 'native', '--message-format', 'json'];
    const built = execFileSync('cargo', build, { cwd: folder, maxBuffer: 2 ** 28 }).toString().trim().split('\n');
    this.program = built.map((line) => JSON.parse(line)).findLast((message) => message.executable).executable;
    this.environment = { ...process.env, VK_DRIVER_FILES: driver };
    this.folder = join(folder, 'target/web-test/native');
  }

  draw(choices, [width, height], [measuredWidth, measuredHeight]) {
    const folder = join(this.folder, encodeURIComponent(choices || 'default'));
    const pairs = [...new URLSearchParams(choices)].map(([name, value]) => `${name}=${value}`);
    execFileSync(this.program, [
      'swiftshader', folder, `${width}x${height}`, `${measuredWidth}x${measuredHeight}`, ...pairs,
    ], { env: this.environment });
    const file = (name) => readFileSync(join(folder, name));
    const job = file('job.bin');
    return {
      halves: [file('left.rgba'), file('right.rgba')],
      counts: JSON.parse(file('counts.json')),
      scene: file('scene.txt').toString().split('\n'),
      job: [...new Float32Array(job.buffer, job.byteOffset, job.length / 4)],
    };
  }
}

/** Pixels that differ in any channel. */
export function differing(a, b) {
  if (a.length !== b.length) throw new Error(`${a.length} bytes against ${b.length}`);
  let count = 0;
  for (let at = 0; at < a.length; at += 4) {
    if (a[at] !== b[at] || a[at + 1] !== b[at + 1] || a[at + 2] !== b[at + 2]) count += 1;
  }
  return count;
}

/** How two pictures differ: how far at most in each channel, and where first. */
function difference(a, b, width) {
  const most = [0, 0, 0];
  const places = [];
  for (let at = 0; at < a.length; at += 4) {
    const by = [0, 1, 2].map((channel) => a[at + channel] - b[at + channel]);
    if (by.every((channel) => channel === 0)) continue;
    by.forEach((channel, place) => { most[place] = Math.max(most[place], Math.abs(channel)); });
    const pixel = at / 4;
    if (places.length < 12) places.push(`${pixel % width},${Math.floor(pixel / width)}: ${by}`);
  }
  return places.length === 0 ? '' : `by ${most} at most; ${places.join('; ')}`;
}

/** The bytes of a half as the page has it. */
export async function half(tab, side) {
  const base64 = await tab.evaluate(`(async () => {
    const bytes = await shadows.page.read(${side});
    let text = '';
    for (let at = 0; at < bytes.length; at += 32768) text += String.fromCharCode(...bytes.subarray(at, at + 32768));
    return btoa(text);
  })()`);
  return Buffer.from(base64, 'base64');
}

/** The page's scene, its halves and the counts of its worker are the native ones. */
export async function comparePicture(tab, native, choices) {
  await tab.until('shadows.meter.done', 300);
  const [size, measured, counts] = await tab.evaluate(`[
    shadows.page.size(), shadows.meter.halves.map(({ width, height }) => [width, height])[0],
    shadows.meter.counts.map((side) => [...side]),
  ].map((list) => [...list])`);
  const drawn = native.draw(choices, size, measured);
  const pixels = size[0] * size[1];
  const halves = [await half(tab, 0), await half(tab, 1)];
  const differ = halves.map((bytes, side) => differing(bytes, drawn.halves[side]));
  const said = `${differ} of ${pixels} pixels differ; wrong: ${JSON.stringify(counts)}`;
  const [scene, job] = await tab.evaluate(`[shadows.page.digest(), [...shadows.meter.numbers]]`);
  const others = scene.filter((line, place) => line !== drawn.scene[place]);
  assert.deepEqual(others, [], `${others.length} of ${scene.length} parts of the scene are others than natively`);
  assert.deepEqual(job, drawn.job, 'another view or light than natively');
  const where = halves.map((bytes, side) => difference(bytes, drawn.halves[side], size[0]));
  assert.deepEqual(differ, [0, 0], `${said}; ${where}`);
  assert.deepEqual(counts, drawn.counts);
  // The twin: the other half is not this one.
  const crossed = differing(halves[0], drawn.halves[1]);
  assert.ok(crossed > 20, `only ${crossed} pixels tell the halves apart`);
  // And the light a thousandth of the picture aside makes another scene.
  const moved = await tab.evaluate(`(shadows.light(0.001, 0), shadows.page.digest())`);
  assert.equal(moved.filter((line, place) => line !== drawn.scene[place]).length, 1);
  return said;
}
