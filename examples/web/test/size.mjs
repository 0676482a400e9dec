// What the page weighs: every file gzipped, as servers send it. Fails where that is over the limit.

import { readdir, readFile } from 'node:fs/promises';
import { join } from 'node:path';
import { gzipSync } from 'node:zlib';

const LIMIT = 3_000_000;

const [folder] = process.argv.slice(2);
let sum = 0;
for (const name of (await readdir(folder)).sort()) {
  const bytes = await readFile(join(folder, name));
  const packed = gzipSync(bytes, { level: 9 }).length;
  sum += packed;
  console.log(`${name.padEnd(24)} ${String(bytes.length).padStart(9)} ${String(packed).padStart(9)} gzipped`);
}
console.log(`${'all'.padEnd(24)} ${''.padStart(9)} ${String(sum).padStart(9)} of ${LIMIT}`);
if (sum > LIMIT) {
  console.error('it is too large');
  process.exit(1);
}
