// Every .wgsl of a folder through Tint: node tint.mjs PACKAGE FOLDER, where PACKAGE is npm's `webgpu` (Dawn).
// Prints a line for each error and each warning, and how many modules there were. Needs no GPU and no driver.
import fs from 'node:fs';
import path from 'node:path';
import { pathToFileURL } from 'node:url';

const [packageFolder, folder] = process.argv.slice(2);
const { create } = await import(pathToFileURL(path.join(packageFolder, 'index.js')));
// Kept: once it is collected, Dawn crashes.
globalThis.gpu = create(['backend=null']);
const adapter = await gpu.requestAdapter();
const device = await adapter.requestDevice({ requiredFeatures: ["clip-distances"] });
const files = fs.readdirSync(folder).filter((file) => file.endsWith('.wgsl')).sort();
for (const file of files) {
    device.pushErrorScope('validation');
    const module = device.createShaderModule({ code: fs.readFileSync(path.join(folder, file), 'utf8') });
    const { messages } = await module.getCompilationInfo();
    await device.popErrorScope();
    for (const { type, lineNum, message } of messages) {
        if (type !== 'info') console.log(`${file}:${lineNum}: ${message}`);
    }
}
console.log(`${files.length} modules`);
process.exit(0); // Dawn would go on waiting for its device
