// The page in headless Chromium: its pictures against native ones, its controls, its words where there is
// no WebGPU, wide and narrow windows. `node test.mjs [PART]` runs all, or what has PART in its name; pictures of the
// windows are left in `target/web-test`.

import { execFileSync } from 'node:child_process';
import { existsSync, realpathSync } from 'node:fs';
import { mkdir, writeFile } from 'node:fs/promises';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';
import * as behaviour from './behaviour.mjs';
import { Browser } from './browser.mjs';
import { layout } from './layout.mjs';
import { Native, PICTURES, comparePicture } from './pictures.mjs';
import { serve } from './serve.mjs';
import { WITHOUT, sorry } from './sorry.mjs';

const folder = join(dirname(fileURLToPath(import.meta.url)), '..');

/** Chromium by its usual names, or `undefined`. */
function chromium() {
  const names = [process.env.CHROMIUM, 'chromium', 'chromium-browser', 'google-chrome'].filter(Boolean);
  for (const name of names) {
    try {
      return execFileSync('sh', ['-c', 'command -v "$1"', 'sh', name]).toString().trim();
    } catch { /* the next one */ }
  }
  return undefined;
}

/** Chromium's own software driver, for native pictures. */
function driver() {
  const places = ['/usr/lib/chromium', '/usr/lib/chromium-browser', '/opt/google/chrome', dirname(realpathSync(program))];
  return places.map((place) => join(place, 'vk_swiftshader_icd.json')).find(existsSync);
}

const program = chromium();
if (!program) {
  console.error('no Chromium is installed here: the page in the browser was not tried');
  process.exit(0);
}
if (!existsSync(join(folder, 'dist/index.html'))) {
  console.error('the page is not built: scripts/web.sh debug');
  process.exit(1);
}

const results = join(folder, 'target/web-test');
await mkdir(results, { recursive: true });
const server = await serve(join(folder, 'dist'), 0);
const at = `http://localhost:${server.address().port}/`;
const [part = ''] = process.argv.slice(2);
let failed = 0;

/** Runs one test and says what came of it. */
async function test(name, work) {
  if (!name.includes(part)) return;
  const begun = Date.now();
  let said;
  try {
    said = await work();
    console.log(`ok    ${name}${said ? `: ${said}` : ''} (${((Date.now() - begun) / 1000).toFixed(1)} s)`);
  } catch (error) {
    failed += 1;
    console.log(`FAILED ${name}: ${error.stack}`);
  }
}

/** A page in a window of its own, once it has drawn. */
async function open(browser, choices, width, height, touch = false) {
  const tab = await browser.open(`${at}#${choices}`, width, height, touch);
  await tab.until(`document.getElementById('stage')?.dataset.frames > 0`);
  return tab;
}

/** Keeps a picture of the window, fails if anything was said on the console, closes the page. */
async function close(tab, name) {
  await writeFile(join(results, `${name}.png`), await tab.screenshot());
  const { complaints } = tab;
  await tab.close();
  if (complaints.length > 0) throw new Error(`on the console:\n${complaints.join('\n')}`);
}

const pictureName = (choices) => `picture ${choices || 'as it opens'}`;
const browser = await Browser.start(program);

const icd = driver();
if (!PICTURES.some((choices) => pictureName(choices).includes(part))) {
  // No native picture is wanted.
} else if (icd) {
  const native = new Native(folder, icd);
  for (const choices of PICTURES) {
    await test(pictureName(choices), async () => {
      const tab = await open(browser, choices, 390, 500);
      const said = await comparePicture(tab, native, choices);
      await close(tab, `picture-${choices.replaceAll(/[^a-z0-9]+/g, '-')}`);
      return said;
    });
  }
} else {
  console.error('Chromium brings no SwiftShader here: its pictures were not compared with native ones');
}

for (const [name, width, height, touch] of [['wide', 1280, 800, false], ['narrow', 390, 780, true]]) {
  await test(`${name}: layout`, async () => {
    const tab = await open(browser, '', width, height, touch);
    const said = await layout(tab, width, height);
    // For the picture that is left.
    if (!touch) await tab.until('shadows.meter.done', 300);
    await close(tab, `${name}-layout`);
    return said;
  });
  await test(`${name}: drags`, async () => {
    // A smaller one is drawn sooner.
    const tab = await open(browser, 'size=256&kernel=weighted_5', touch ? width : 820, touch ? 420 : 300, touch);
    const said = await behaviour.drags(tab, touch);
    await close(tab, `${name}-drags`);
    return said;
  });
}

for (const part of ['controls', 'bar', 'error']) {
  await test(part, async () => {
    const tab = await open(browser, 'size=256&kernel=weighted_5', 820, 300);
    const said = await behaviour[part](tab);
    await close(tab, part);
    return said;
  });
}

for (const [name, script, word] of WITHOUT) {
  await test(name, async () => {
    const tab = await browser.open('about:blank', 390, 780);
    await tab.send('Page.addScriptToEvaluateOnNewDocument', { source: script });
    await tab.send('Page.navigate', { url: at });
    await tab.until(`location.href !== 'about:blank' && document.readyState === 'complete'`);
    const said = await sorry(tab, word);
    await close(tab, name.replaceAll(' ', '-'));
    return said;
  });
}

await browser.close();
server.close();
console.log(failed === 0 ? 'all is well' : `${failed} failed`);
process.exit(failed === 0 ? 0 : 1);
