// Headless Chromium, driven over a pipe by its DevTools protocol.

import { spawn } from 'node:child_process';
import { mkdtemp, rm } from 'node:fs/promises';
import { tmpdir } from 'node:os';
import { join } from 'node:path';

/** A canvas shows what WebGPU draws only if all of the browser draws with Vulkan, here SwiftShader's. */
const FLAGS = [
  '--headless', '--enable-features=Vulkan', '--use-vulkan=swiftshader', '--use-angle=swiftshader',
  '--no-sandbox', '--disable-gpu-sandbox', '--enable-unsafe-webgpu',
  '--use-webgpu-adapter=swiftshader', '--force-color-profile=srgb', '--disable-background-networking',
  '--disable-component-update', '--disable-sync', '--no-first-run', '--remote-debugging-pipe',
];

export class Browser {
  #next = 1;
  #waiting = new Map();
  #listeners = [];

  /** Starts Chromium; `flags` are added to the usual. */
  static async start(chromium, flags = []) {
    const browser = new Browser();
    browser.folder = await mkdtemp(join(tmpdir(), 'chromium-'));
    browser.process = spawn(chromium, [...FLAGS, ...flags, `--user-data-dir=${browser.folder}`], {
      stdio: ['ignore', 'ignore', process.env.CHROMIUM_LOG ? 'inherit' : 'ignore', 'pipe', 'pipe'],
    });
    const [, , , to, from] = browser.process.stdio;
    browser.to = to;
    let rest = '';
    from.setEncoding('utf8');
    from.on('data', (text) => {
      const messages = (rest + text).split('\0');
      rest = messages.pop();
      for (const message of messages) browser.#receive(JSON.parse(message));
    });
    await new Promise((started, failed) => {
      browser.process.once('error', failed);
      browser.process.once('spawn', started);
    });
    return browser;
  }

  #receive({ id, method, params, result, error, sessionId }) {
    const waiting = this.#waiting.get(id);
    if (!waiting) {
      for (const listener of this.#listeners) listener(method, params, sessionId);
      return;
    }
    this.#waiting.delete(id);
    if (error) waiting.failed(new Error(error.message));
    else waiting.done(result);
  }

  /** Calls a method of the protocol. */
  send(method, params = {}, sessionId = undefined) {
    const id = this.#next;
    this.#next += 1;
    const answer = new Promise((done, failed) => { this.#waiting.set(id, { done, failed }); });
    this.to.write(`${JSON.stringify({ id, method, params, sessionId })}\0`);
    return answer;
  }

  /** Opens a page in a window of so many pixels. */
  async open(url, width, height, touch = false) {
    const { targetId } = await this.send('Target.createTarget', { url: 'about:blank' });
    const { sessionId } = await this.send('Target.attachToTarget', { targetId, flatten: true });
    const tab = new Tab(this, targetId, sessionId);
    this.#listeners.push((method, params, session) => {
      if (session === sessionId) tab.hear(method, params);
    });
    for (const domain of ['Page', 'Runtime', 'Log']) await tab.send(`${domain}.enable`);
    const metrics = { width, height, deviceScaleFactor: 1, mobile: touch };
    await tab.send('Emulation.setDeviceMetricsOverride', metrics);
    if (touch) await tab.send('Emulation.setTouchEmulationEnabled', { enabled: true });
    await tab.send('Page.navigate', { url });
    return tab;
  }

  async close() {
    const ended = new Promise((done) => { this.process.once('exit', done); });
    await this.send('Browser.close').catch(() => {});
    await ended;
    await rm(this.folder, { recursive: true, force: true, maxRetries: 5 });
  }
}

/** A page. */
export class Tab {
  /** What went wrong, as the console has it. */
  complaints = [];

  constructor(browser, targetId, sessionId) {
    Object.assign(this, { browser, targetId, sessionId });
  }

  send(method, params) {
    return this.browser.send(method, params, this.sessionId);
  }

  hear(method, params) {
    if (method === 'Runtime.exceptionThrown') {
      const { exception, text } = params.exceptionDetails;
      this.complaints.push(exception?.description ?? text);
    }
    if (method === 'Runtime.consoleAPICalled' && ['error', 'warning'].includes(params.type)) {
      this.complaints.push(params.args.map((arg) => arg.value ?? arg.description).join(' '));
    }
    if (method === 'Log.entryAdded' && ['error', 'warning'].includes(params.entry.level)) {
      this.complaints.push(params.entry.text);
    }
  }

  /** The value of an expression, or of what it promises. */
  async evaluate(expression) {
    const { result, exceptionDetails } = await this.send('Runtime.evaluate', {
      expression, awaitPromise: true, returnByValue: true,
    });
    if (exceptionDetails) {
      throw new Error(exceptionDetails.exception?.description ?? exceptionDetails.text);
    }
    return result.value;
  }

  /** Waits until an expression is true. */
  async until(expression, seconds = 120) {
    const end = Date.now() + 1000 * seconds;
    while (!(await this.evaluate(expression))) {
      if (Date.now() > end) throw new Error(`waited ${seconds} s in vain until ${expression}`);
      await new Promise((done) => { setTimeout(done, 50); });
    }
  }

  /** Drags from a place to another, in pixels of the window. */
  async drag([fromX, fromY], [toX, toY]) {
    const mouse = (type, x, y, buttons) => this.send('Input.dispatchMouseEvent', {
      type, x, y, buttons, button: 'left', clickCount: 1,
    });
    await mouse('mousePressed', fromX, fromY, 1);
    for (let step = 1; step <= 4; step += 1) {
      const at = (from, to) => from + (step / 4) * (to - from);
      await mouse('mouseMoved', at(fromX, toX), at(fromY, toY), 1);
    }
    await mouse('mouseReleased', toX, toY, 0);
  }

  /** The same with a finger. */
  async swipe([fromX, fromY], [toX, toY]) {
    const touch = (type, x, y) => this.send('Input.dispatchTouchEvent', {
      type, touchPoints: type === 'touchEnd' ? [] : [{ x, y }],
    });
    await touch('touchStart', fromX, fromY);
    for (let step = 1; step <= 4; step += 1) {
      const at = (from, to) => from + (step / 4) * (to - from);
      await touch('touchMove', at(fromX, toX), at(fromY, toY));
    }
    await touch('touchEnd');
  }

  /** A picture of the window, PNG. */
  async screenshot() {
    const { data } = await this.send('Page.captureScreenshot', { format: 'png' });
    return Buffer.from(data, 'base64');
  }

  close() {
    return this.browser.send('Target.closeTarget', { targetId: this.targetId });
  }
}
