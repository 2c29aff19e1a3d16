// SPDX-License-Identifier: MIT
// What the tests of the page share: Chromium, a page in it that is ready, and what a person does there.
import {mkdtempSync, rmSync} from "node:fs";
import {createRequire} from "node:module";
import {tmpdir} from "node:os";
import {join} from "node:path";
import {pathToFileURL} from "node:url";
import {after, before} from "node:test";

const built = process.env.OBLIQUE_ENGINE;
const puppeteer = createRequire(join(built, "npm/package.json"))("puppeteer-core");
export const studio = join(built, "studio.html");
export const shots = process.env.OBLIQUE_SCREENSHOTS;  // a folder to leave pictures in

let browser;
const profile = mkdtempSync(join(tmpdir(), "oblique-studio-"));
before(async () => {
  browser = await puppeteer.launch({executablePath: process.env.OBLIQUE_CHROMIUM ?? "/usr/bin/chromium", headless: true,
    userDataDir: profile, args: ["--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage"]});
});
after(async () => {
  await browser.close();
  rmSync(profile, {recursive: true, force: true});
});

// A page that is ready, what it asked for, and what went wrong in it. What it saves is kept in it, not on the disk.
// `prepare` comes before the page's own script.
export async function opened({fragment = "", width = 1280, height = 900, scheme = "light", file = studio, prepare} = {}) {
  const page = await browser.newPage();
  await page.setViewport({width, height});
  await page.emulateMediaFeatures([{name: "prefers-color-scheme", value: scheme}]);
  const requests = [], troubles = [];
  page.on("request", (request) => requests.push(request.url()));
  page.on("pageerror", (error) => troubles.push(error.message));
  page.on("console", (said) => said.type() === "error" && troubles.push(said.text()));
  page.on("dialog", (dialog) => {
    troubles.push(`a dialog: ${dialog.message()}`);
    void dialog.dismiss();
  });
  await page.evaluateOnNewDocument(() => {
    const make = URL.createObjectURL.bind(URL), click = HTMLAnchorElement.prototype.click;
    const blobs = new Map();
    globalThis.savedFiles = [];
    URL.createObjectURL = (blob) => {
      const url = make(blob);
      blobs.set(url, blob);
      return url;
    };
    HTMLAnchorElement.prototype.click = function () {
      if (this.download) globalThis.savedFiles.push({name: this.download, blob: blobs.get(this.href)});
      else click.call(this);
    };
  });
  if (prepare) await page.evaluateOnNewDocument(prepare);
  const begin = Date.now();
  await page.goto(pathToFileURL(file).href + fragment);
  if (prepare) return {page, troubles};
  await page.waitForSelector(".schematic svg", {timeout: 30000});
  await page.waitForFunction(() => document.querySelector("h1 .quiet").textContent !== "", {timeout: 30000});  // its machine is there
  return {page, requests, troubles, ready: Date.now() - begin};
}

export const button = (page, name) => page.evaluate((wanted) => {
  [...document.querySelectorAll("button")].find((one) => one.textContent === wanted).click();
}, name);
export const text = (page, selector) => page.$eval(selector, (element) => element.textContent);
export const timeOf = async (page) => Number((await text(page, ".time")).match(/t = (\S+) s/)[1]);
export const wait = (milliseconds) => new Promise((done) => setTimeout(done, milliseconds));

export async function write(page, written) {
  await page.$eval("textarea", (area, value) => {
    area.value = value;
    area.dispatchEvent(new Event("input", {bubbles: true}));
  }, written);
}
export async function choose(page, label, value) {
  await page.select(`select[aria-label="${label}"]`, value);
}
export async function check(page, words) {
  await page.evaluate((wanted) => {
    [...document.querySelectorAll("label")].find((one) => one.textContent.trim() === wanted).querySelector("input").click();
  }, words);
}
export async function enter(page, label, value) {
  await page.$eval(`input[aria-label="${label}"]`, (input, written) => {
    input.value = written;
    input.dispatchEvent(new Event("change", {bubbles: true}));
  }, value);
}
// The file that a button saves, as text.
export async function savedBy(page, name) {
  const before = await page.evaluate(() => globalThis.savedFiles.length);
  await button(page, name);
  await page.waitForFunction((count) => globalThis.savedFiles.length > count, {}, before);
  return page.evaluate(async () => {
    const {name, blob} = globalThis.savedFiles.at(-1);
    return {name, type: blob.type, text: await blob.text()};
  });
}

export const lag = (title = "A lag") => `format = "oblique-diagram/1"
title = ${JSON.stringify(title)}
[run]
until = 4
[blocks]
a = { type = "constant", value = 0.5 }
x = { type = "integrator", in = ["4*a", "-4*x"], initial = 0 }
[outputs]
x = "x"
`;

// x = 0.8 sin 3t, y = 0.8 cos 3t.
export const circle = `format = "oblique-diagram/1"
title = "A circle"
[run]
until = 20
tolerance = 1e-9
[blocks]
x = { type = "integrator", in = ["3*y"] }
y = { type = "integrator", in = ["-3*x"], initial = 0.8 }
[outputs]
twice = { signal = "x", scale = 2, unit = "m" }
y = "y"
`;
