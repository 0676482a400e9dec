import { writeFile } from 'node:fs/promises';
import { Browser } from './browser.mjs';
import { serve } from './serve.mjs';
const [out, width, height, hash = '', script = ''] = process.argv.slice(2);
const server = await serve(new URL('../dist', import.meta.url).pathname, 0);
const browser = await Browser.start('chromium', (process.env.FLAGS ?? '').split(' ').filter(Boolean));
const tab = await browser.open(`http://localhost:${server.address().port}/#${hash}`, Number(width), Number(height));
try {
  console.time('ready');
  await tab.until("document.getElementById('stage')?.dataset.frames > 0 || document.getElementById('sorry')?.hidden === false", 180);
  console.timeEnd('ready');
  if (script) console.log(await tab.evaluate(`(async () => { const wait = (ms) => new Promise(r => setTimeout(r, ms)); ${script} })()`));
} catch (e) { console.log(String(e)); }
await writeFile(out, await tab.screenshot());
console.log(tab.complaints);
await browser.close(); server.close();
