// What is said where there is no WebGPU.

import assert from 'node:assert/strict';

/** Ways to have none, as scripts that run before the page's, and a word of what is then said. */
export const WITHOUT = [
  ['no WebGPU', `Object.defineProperty(Navigator.prototype, 'gpu', { get: () => undefined });`, 'does not offer'],
  ['no adapter', `GPU.prototype.requestAdapter = async () => null;`, 'no graphics processor'],
];

/** Fails if the words are not there, or the picture is. */
export async function sorry(tab, word) {
  await tab.until(`document.getElementById('sorry')?.hidden === false`);
  const text = await tab.evaluate(`document.getElementById('sorry').innerText`);
  assert.ok(text.includes(word), text);
  assert.ok(text.includes('Chrome') && text.includes('Firefox') && text.includes('Safari'), text);
  const shown = await tab.evaluate(`['stage', 'panel'].map((id) => document.getElementById(id).offsetParent !== null)`);
  assert.deepEqual(shown, [false, false]);
  return text.split('\n').filter(Boolean)[1];
}
