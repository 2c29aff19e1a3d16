// SPDX-License-Identifier: MIT
// The patch panel in Chromium: diagrams patched, mended and undone by hand, with the mouse, by touch and by keys.
import assert from "node:assert/strict";
import {mkdtempSync, readFileSync, rmSync} from "node:fs";
import {createRequire} from "node:module";
import {tmpdir} from "node:os";
import {join} from "node:path";
import {pathToFileURL} from "node:url";
import test, {after, before} from "node:test";
import {deflateRawSync} from "node:zlib";

const built = process.env.OBLIQUE_ENGINE;
const require = createRequire(join(built, "npm/package.json"));
const puppeteer = require("puppeteer-core");
const shots = process.env.OBLIQUE_SCREENSHOTS;

let browser;
const profile = mkdtempSync(join(tmpdir(), "oblique-panel-"));
before(async () => {
  browser = await puppeteer.launch({executablePath: process.env.OBLIQUE_CHROMIUM ?? "/usr/bin/chromium", headless: true, userDataDir: profile,
    args: ["--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage"], protocolTimeout: 300000});
});
after(async () => {
  await browser.close();
  rmSync(profile, {recursive: true, force: true});
});

async function opened({width = 1280, height = 1000, scheme = "light", touch = false, fragment = ""} = {}) {
  const page = await browser.newPage();
  await page.setViewport({width, height, hasTouch: touch});
  await page.emulateMediaFeatures([{name: "prefers-color-scheme", value: scheme}]);
  const troubles = [];
  page.on("pageerror", (error) => troubles.push(error.message));
  page.on("console", (said) => said.type() === "error" && troubles.push(said.text()));
  await page.goto(pathToFileURL(join(built, "studio.html")).href + fragment);
  await page.waitForSelector(".schematic svg", {timeout: 60000});
  return {page, troubles};
}

const shot = async (page, name) => shots && page.screenshot({path: join(shots, `panel-${name}.png`), fullPage: true});
const file = (page) => page.$eval("textarea", (area) => area.value);
const wait = (milliseconds) => new Promise((done) => setTimeout(done, milliseconds));
const pause = async (page) => {
  await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
};
const button = (page, name) => page.evaluate((wanted) => {
  [...document.querySelectorAll("button")].find((one) => one.textContent === wanted).click();
}, name);
const timeOf = (page) => page.$eval(".time", (one) => Number(one.textContent.match(/t = (\S+) s/)[1]));
const findings = (page) => page.$$eval(".text .findings li", (all) => all.map((one) => one.textContent));

/// Waits until what is written says so.
const says = (page, what) => page.waitForFunction((wanted) => document.querySelector("textarea").value.includes(wanted), {timeout: 20000}, what);

async function write(page, written) {
  await page.$eval("textarea", (area, value) => {
    area.value = value;
    area.dispatchEvent(new Event("input", {bubbles: true}));
  }, written);
}

/// The middle of a part of the panel, scrolled into view.
async function middle(page, selector) {
  await page.waitForSelector(selector, {timeout: 20000});
  await page.$eval(selector, (one) => one.scrollIntoView({block: "center", inline: "center"}));
  await pause(page);
  return page.$eval(selector, (one) => {
    const box = one.getBoundingClientRect();
    return [box.left + box.width / 2, box.top + box.height / 2];
  });
}
const focus = (page, selector) => page.waitForSelector(selector).then(() => page.$eval(selector, (one) => one.focus()));
const output = (signal) => `.overlay [data-output="${signal}"]`;
const input = (pin) => `.overlay [data-input="${pin}"]`;
const body = (name) => `.overlay [data-block="${name}"]`;

async function drag(page, from, to) {
  const [x, y] = await middle(page, from);
  const end = typeof to === "string" ? await page.$eval(to, (one) => {
    const box = one.getBoundingClientRect();
    return [box.left + box.width / 2, box.top + box.height / 2];
  }) : [x + to[0], y + to[1]];
  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.mouse.move((x + end[0]) / 2, (y + end[1]) / 2, {steps: 3});
  await page.mouse.move(...end, {steps: 3});
  await page.mouse.up();
}

/// Sets a line of the form.
async function set(page, label, value) {
  const line = `.form input[aria-label="${label}"]`;
  await page.waitForSelector(line);
  await page.$eval(line, (one, written) => {
    one.value = written;
    one.dispatchEvent(new Event("change", {bubbles: true}));
  }, value);
}

/// Adds an element from the palette, drops it at a place of the panel, and gives it a name and parameters.
async function add(page, kind, name, [x, y], settings = {}) {
  const search = await page.$(".palette input");
  await search.click({count: 3});
  await search.type(kind);
  await page.waitForSelector(`.palette [data-kind="${kind}"]`);
  await page.$eval(".panel", (one) => { one.scrollTo(0, 0); one.scrollIntoView({block: "end"}); });
  await pause(page);
  const begin = await page.$eval(`.palette [data-kind="${kind}"]`, (one) => {
    const box = one.getBoundingClientRect();
    return [box.left + 30, box.top + 12];
  });
  const [left, top] = await page.$eval(".panel", (one) => [one.getBoundingClientRect().left, one.getBoundingClientRect().top]);
  await page.mouse.move(...begin);
  await page.mouse.down();
  await page.mouse.move(left + x / 2, top + y / 2, {steps: 3});
  await page.mouse.move(left + x, top + y, {steps: 3});
  await page.mouse.up();
  await page.waitForFunction(() => document.querySelector(".form")?.getAttribute("aria-label")?.startsWith("Element "), {timeout: 20000});
  const made = kind.replaceAll("-", "_");
  await page.waitForFunction((stem) => document.querySelector(".form").getAttribute("aria-label").startsWith(`Element ${stem}`), {timeout: 20000}, made);
  await set(page, "name", name);
  await page.waitForSelector(`.form[aria-label="Element ${name}"]`, {timeout: 20000});
  for (const [key, value] of Object.entries(settings)) {
    await set(page, key, value);
    await says(page, value);
  }
}

async function wired(page, from, to, block, text) {
  await drag(page, output(from), to);
  await page.waitForFunction((name, wanted) => new RegExp(`^${name} .*${wanted}`, "m").test(document.querySelector("textarea").value), {timeout: 20000},
    block, text.replace(/[*[\]]/g, "\\$&"));
}

const lag = `# a comment
format = "oblique-diagram/1"
title = "A lag"
[run]
until = 4
[blocks]   # two of them
a = { type = "constant", value = 0.5 }   # what it goes to
x = { type = "integrator", in = ["4*a", "-4*x"], initial = 0 }
[outputs]
x = "x"
`;

test("a triangle is patched by hand from an empty page, run, its pot turned, its scope read", async () => {
  const {page, troubles} = await opened({width: 1600, height: 1100});
  await button(page, "New");
  await page.waitForSelector(".palette [data-kind]", {timeout: 20000});
  await shot(page, "empty");
  await add(page, "constant", "one", [60, 60], {value: "1.0"});
  await add(page, "integrator", "phi", [160, 60]);
  await add(page, "cosine", "cosp", [270, 60]);
  await add(page, "constant", "a", [60, 150], {value: "0.30"});
  await add(page, "constant", "b", [60, 240], {value: "0.40"});
  await add(page, "multiplier", "a2", [170, 330]);
  await add(page, "multiplier", "b2", [170, 420]);
  await add(page, "multiplier", "ab", [170, 190]);
  await add(page, "multiplier", "abc", [300, 190]);
  await add(page, "servo-amplifier", "c", [420, 260], {gain: "1e5"});
  await button(page, "all 10 parameters");
  await set(page, "limit", "1");  // as that of a machine
  await says(page, "limit = 1");
  await add(page, "multiplier", "c2", [420, 420]);
  await shot(page, "elements");

  await wired(page, "one", input("phi.in"), "phi", '"one"');
  await wired(page, "phi", input("cosp.in"), "cosp", '"phi"');
  for (const side of ["a", "b"]) {
    await wired(page, side, input(`${side}2.x`), `${side}2`, `x = "${side}"`);
    await wired(page, side, input(`${side}2.y`), `${side}2`, `y = "${side}"`);
  }
  await wired(page, "a", input("ab.x"), "ab", 'x = "a"');
  await wired(page, "b", input("ab.y"), "ab", 'y = "b"');
  await wired(page, "ab", input("abc.x"), "abc", 'x = "ab"');
  await wired(page, "cosp", input("abc.y"), "abc", 'y = "cosp"');
  await wired(page, "c", input("c2.x"), "c2", 'x = "c"');
  await wired(page, "c", input("c2.y"), "c2", 'y = "c"');
  await wired(page, "c2", input("c.in"), "c", '"c2"');
  for (const more of ["a2", "b2", "abc"]) await wired(page, more, body("c"), "c", `"${more}"`);
  // the signs of a² and b², and the weight of a b cos φ
  await page.mouse.click(...await middle(page, body("c")));
  for (const side of ["a2", "b2"]) {
    await page.click(`.form button[aria-label="Sign of ${side}"]`);
    await says(page, `"-${side}"`);
  }
  await set(page, "Weight of abc", "2");
  await says(page, '"2*abc"');
  await page.waitForFunction(() => !document.querySelector(".text .findings"), {timeout: 20000});
  await set(page, "output of c", "side");
  await says(page, 'side = "c"');
  for (const [name, label] of [["phi", "φ"], ["cosp", "cos φ"], ["a2", "a²"], ["b2", "b²"], ["c2", "c²"], ["abc", "a b cos φ"]]) {
    await page.mouse.click(...await middle(page, body(name)));
    await page.waitForSelector(`.form[aria-label="Element ${name}"]`);
    await set(page, "label", label);
    await says(page, `label = "${label}"`);
  }
  await page.mouse.click(...await middle(page, ".overlay"));
  await set(page, "title", "By hand");
  await set(page, "runs until", "2*pi");
  await says(page, 'until = "2*pi"');
  await shot(page, "triangle");

  const written = await file(page);
  assert.match(written, /^c += \{ type = "servo-amplifier", gain = 1e5, limit = 1, in = \["c2", "-a2", "-b2", "2\*abc"\] \}$/m);
  await page.waitForFunction(() => document.querySelector(".channels")?.textContent.includes("side"), {timeout: 20000});
  await page.select('select[aria-label="What the voltmeter shows"]', "side");
  await button(page, "OP");
  await page.waitForFunction(() => Number(document.querySelector(".time").textContent.match(/t = (\S+) s/)[1]) > 1, {timeout: 60000});
  await button(page, "HOLD");
  await wait(500);
  const side = async (a, b) => {
    // The static error is c/gain over the slope 2c of the residual, 5e-6; the bandwidth of 10 Hz with this gain leaves no lag
    // that shows. 2e-5 with the six digits that are shown.
    const phi = await page.evaluate(() => oblique.read("phi"));
    const shown = await page.evaluate(() => oblique.read("side"));
    const exact = Math.sqrt(a * a + b * b - 2 * a * b * Math.cos(phi));
    assert.ok(Math.abs(shown - exact) < 2e-5, `${shown} for ${exact} at φ = ${phi}`);
    assert.ok(phi > 0.9);
  };
  await side(0.3, 0.4);
  await page.$eval("#pot-a\\.value", (one) => {
    one.value = "0.25";
    one.dispatchEvent(new Event("change", {bubbles: true}));
  });
  await button(page, "OP");
  const turned = await timeOf(page);
  await page.waitForFunction((from) => Number(document.querySelector(".time").textContent.match(/t = (\S+) s/)[1]) > from + 0.5, {timeout: 60000}, turned);
  await button(page, "HOLD");
  await wait(500);
  await side(0.25, 0.4);
  // the traces of the scope: c of the last row is what the voltmeter shows
  const meter = parseFloat(await page.$eval(".meter output", (one) => one.textContent));
  assert.ok(Math.abs(meter - await page.evaluate(() => oblique.read("side"))) < 1e-5);
  await shot(page, "triangle-run");

  // fifty steps back and forth while it runs: the time never goes back, and the text comes back
  await button(page, "OP");
  const begin = await timeOf(page);
  let time = begin, steps = 0;
  const texts = [written];
  for (; steps < 50; ++steps) {
    await page.keyboard.down("Control");
    await page.keyboard.press("z");
    await page.keyboard.up("Control");
    const before = texts.at(-1);
    await page.waitForFunction((old) => document.querySelector("textarea").value !== old, {timeout: 20000}, before);
    texts.push(await file(page));
    const now = await timeOf(page);
    assert.ok(now >= time, `the time went back from ${time} to ${now} at step ${steps}`);
    time = now;
  }
  assert.ok(time > begin);
  for (let k = 49; k >= 0; --k) {
    await page.keyboard.down("Control");
    await page.keyboard.press("y");
    await page.keyboard.up("Control");
    await page.waitForFunction((text) => document.querySelector("textarea").value === text, {timeout: 20000}, texts[k]);
    const now = await timeOf(page);
    assert.ok(now >= time, `the time went back from ${time} to ${now} at redo ${k}`);
    time = now;
  }
  assert.equal(await file(page), written);
  await page.waitForFunction((from) => Number(document.querySelector(".time").textContent.match(/t = (\S+) s/)[1]) > from, {timeout: 20000}, time);
  // With a sign the other way round the loop ran to its limit, as that of a real machine does; it begins again. The pot is as
  // the file says: the fifty steps went back to where it said nothing of it.
  await button(page, "IC");
  await page.waitForFunction(() => document.querySelector(".time").textContent === "t = 0 s", {timeout: 20000});
  await button(page, "OP");
  await page.waitForFunction(() => Number(document.querySelector(".time").textContent.match(/t = (\S+) s/)[1]) > 1, {timeout: 60000});
  await button(page, "HOLD");
  await wait(500);
  await side(0.3, 0.4);
  assert.deepEqual(troubles, []);
  await page.close();
});

test("an edit while it runs carries the machine over; rename, undo and redo too", async () => {
  const {page, troubles} = await opened();
  await page.evaluate((text) => oblique.open(text, "lag.toml"), lag);
  await page.waitForSelector(body("x"));
  await page.evaluate(() => oblique.advance(0.3));
  // x = a (1 − e^(−4t)), to the run's tolerance of 1e-8
  const x = 0.5 * (1 - Math.exp(-1.2));
  assert.ok(Math.abs(await page.evaluate(() => oblique.read("x")) - x) < 1e-7);
  await page.evaluate(() => oblique.turn("x.rate", 0.5));
  await page.mouse.click(...await middle(page, body("x")));
  await set(page, "name", "speed");
  await says(page, "speed = { type");
  assert.equal(await file(page), lag.replace("x = { type", "speed = { type").replace("-4*x", "-4*speed").replace('x = "x"', 'x = "speed"'));
  await page.waitForFunction(() => oblique.read("speed").then(() => true, () => false), {timeout: 20000});
  assert.ok(Math.abs(await page.evaluate(() => oblique.read("speed")) - x) < 1e-7);
  assert.equal(await page.evaluate(() => oblique.read("speed.rate")), 0.5);
  // what is typed is a step, and carries the machine over as well
  const typed = (await file(page)).replace("value = 0.5", "value = 0.25");
  await write(page, typed);
  await page.waitForFunction(() => oblique.read("a").then((value) => value === 0.25), {timeout: 20000});
  assert.ok(Math.abs(await page.evaluate(() => oblique.read("speed")) - x) < 1e-7);
  assert.equal(await timeOf(page), 0.3);
  await page.evaluate(() => oblique.advance(0.2));
  // with half the rate: x − a falls by e^(−2t)
  const later = 0.25 + (x - 0.25) * Math.exp(-0.4);
  assert.ok(Math.abs(await page.evaluate(() => oblique.read("speed")) - later) < 1e-6);
  await button(page, "Undo");
  await says(page, "value = 0.5");
  await button(page, "Undo");
  await page.waitForFunction((text) => document.querySelector("textarea").value === text, {timeout: 20000}, lag);
  await page.waitForFunction(() => oblique.read("x.rate").then(() => true, () => false), {timeout: 20000});
  assert.ok(Math.abs(await page.evaluate(() => oblique.read("x")) - later) < 1e-6);
  assert.equal(await timeOf(page), 0.5);
  await button(page, "Redo");
  await button(page, "Redo");
  await page.waitForFunction((text) => document.querySelector("textarea").value === text, {timeout: 20000}, typed);
  assert.deepEqual(troubles, []);
  await page.close();
});

test("what is renamed while the file is wrong is still known when it is right again", async () => {
  const {page, troubles} = await opened();
  await page.evaluate((text) => oblique.open(text, "lag.toml"), lag);
  await page.evaluate(() => oblique.advance(0.3));
  await write(page, lag.replace('"4*a"', '"4*nobody"'));
  await page.waitForSelector(".text .findings", {timeout: 20000});
  await page.mouse.click(...await middle(page, body("x")));
  await set(page, "name", "speed");
  await says(page, "speed = { type");
  await write(page, (await file(page)).replace("nobody", "a"));
  await page.waitForFunction(() => oblique.read("speed").then(() => true, () => false), {timeout: 20000});
  assert.ok(Math.abs(await page.evaluate(() => oblique.read("speed")) - 0.5 * (1 - Math.exp(-1.2))) < 1e-7);
  // and once more: it is not taken for renamed twice
  await write(page, (await file(page)).replace("A lag", "The lag"));
  await page.waitForFunction(() => document.querySelector("h1").textContent.includes("The lag"), {timeout: 20000});
  assert.ok(Math.abs(await page.evaluate(() => oblique.read("speed")) - 0.5 * (1 - Math.exp(-1.2))) < 1e-7);
  assert.deepEqual(troubles, []);
  await page.close();
});

test("by keys: an output is picked, an input is picked, a wire is taken off, an element is moved and deleted", async () => {
  const {page, troubles} = await opened();
  await page.evaluate((text) => oblique.open(text, "lag.toml"), lag + '\n[layout]\nx = [10, 4]\na = [3, 4]\n');
  await page.waitForSelector(body("a"));
  await focus(page, output("a"));
  await page.keyboard.press("Enter");
  await page.waitForSelector(".overlay .picked");
  await focus(page, body("x"));
  await page.keyboard.press("Enter");
  await says(page, 'in = ["4*a", "-4*x", "a"]');
  await focus(page, input("x.in.2"));
  await page.keyboard.press("Delete");
  await says(page, 'in = ["4*a", "-4*x"]');
  await focus(page, body("x"));
  await page.keyboard.press("ArrowRight");
  await says(page, "x = [11, 4]");
  await focus(page, body("x"));
  await page.keyboard.press("Delete");
  await page.waitForFunction(() => !document.querySelector("textarea").value.includes("x ="), {timeout: 20000});
  await page.click("textarea");
  await page.keyboard.down("Control");
  await page.keyboard.press("z");
  await page.keyboard.up("Control");
  await says(page, 'x = "x"');
  assert.deepEqual(troubles, []);
  await page.close();
});

test("by touch a wire is pulled; two elements are never on one place", async () => {
  const {page, troubles} = await opened({touch: true});
  await page.evaluate((text) => oblique.open(text, "lag.toml"), lag.replace('"4*a", "-4*x"', '"-4*x"') + '\n[layout]\nx = [12, 4]\na = [3, 4]\n');
  const [x, y] = await middle(page, output("a"));
  const [left, top] = await page.$eval(body("x"), (one) => {
    const box = one.getBoundingClientRect();
    return [box.left + 8, box.top + box.height / 2];
  });
  await page.touchscreen.touchStart(x, y);
  await page.touchscreen.touchMove((x + left) / 2, (y + top) / 2);
  await page.touchscreen.touchMove(left, top);
  await page.touchscreen.touchEnd();
  await says(page, 'in = ["-4*x", "a"]');
  await drag(page, body("a"), body("x"));
  await page.waitForFunction(() => !document.querySelector("textarea").value.includes("a = [3, 4]"), {timeout: 20000});
  const [a, b] = await page.$$eval(".overlay .body", (all) => all.map((one) => one.getBoundingClientRect()).map(({left, right, top, bottom}) => ({left, right, top, bottom})));
  assert.ok(a.right < b.left || b.right < a.left || a.bottom < b.top || b.bottom < a.top);
  assert.deepEqual(await findings(page), []);
  assert.deepEqual(troubles, []);
  await page.close();
});

test("a file that is wrong is opened and mended in the panel, and its errors stand at their lines", async () => {
  const {page, troubles} = await opened();
  const wrong = lag.replace('"4*a", "-4*x"', '"4*b", "-4*x"').replace('"constant"', '"konstant"');
  await page.evaluate((text) => oblique.open(text, "wrong.toml").catch(() => undefined), wrong);
  await page.waitForSelector(body("a"));
  const told = await findings(page);
  assert.ok(told.some((one) => /^line 7 .*konstant/.test(one)), told.join("\n"));
  assert.ok(told.some((one) => /^line 8 .*'b'/.test(one)), told.join("\n"));
  await shot(page, "wrong");
  await page.mouse.click(...await middle(page, body("a")));
  await set(page, "type", "constant");
  await says(page, '"constant"');
  await page.mouse.click(...await middle(page, body("x")));
  await page.waitForSelector('.form button[aria-label="Take off 4*b"]');
  await page.click('.form button[aria-label="Take off 4*b"]');
  await page.waitForFunction(() => !document.querySelector("textarea").value.includes("4*b"), {timeout: 20000});
  await drag(page, output("a"), body("x"));
  await says(page, '"a"]');
  await page.waitForFunction(() => !document.querySelector(".text .findings"), {timeout: 20000});
  await page.waitForFunction(() => document.querySelector("h1").textContent.includes("A lag"), {timeout: 20000});
  assert.equal(await file(page), lag.replace('"4*a", "-4*x"', '"-4*x", "a"'));
  // what is no TOML any more: the panel keeps what it last could read, and says so
  await write(page, lag.replace("[outputs]", "[outputs"));
  await page.waitForSelector(".panel.old");
  await page.waitForSelector(".text .findings", {timeout: 20000});
  assert.match((await findings(page))[0], /^line 9 broken TOML/);
  await button(page, "Undo");
  await page.waitForFunction(() => !document.querySelector(".panel.old"), {timeout: 20000});
  assert.deepEqual(troubles, []);
  await page.close();
});

test("keys with dots and in quotes are edited by hand as any others", async () => {
  const {page, troubles} = await opened();
  const text = `format = "oblique-diagram/1"
[run]
until = 4
[blocks]
a.type  = "constant"
a.value = 0.5   # of x
x.type  = "integrator"
x.in    = ["4*a", "-4*x"]
"y" = { type = "inverter", 'in' = "x" }
[outputs]
x.signal = "x"
`;
  await page.evaluate((given) => oblique.open(given, "dots.toml"), text);
  await page.mouse.click(...await middle(page, body("x")));
  await set(page, "label", "speed");
  await says(page, 'x.label = "speed"');
  await set(page, "name", "v");
  await says(page, "v.type");
  await page.mouse.click(...await middle(page, body("y")));
  await button(page, "Delete y");
  await page.waitForFunction(() => !document.querySelector("textarea").value.includes("inverter"), {timeout: 20000});
  assert.equal(await file(page), text.replace("x.type ", "v.type ").replace("x.in    = [\"4*a\", \"-4*x\"]\n", "v.in    = [\"4*a\", \"-4*v\"]\nv.label = \"speed\"\n")
    .replace(/"y" = .*\n/, "").replace('signal = "x"', 'signal = "v"'));
  assert.equal(await page.$(".machine .findings"), null);
  for (let k = 0; k < 3; ++k) await button(page, "Undo");
  await page.waitForFunction((before) => document.querySelector("textarea").value === before, {timeout: 20000}, text);
  assert.deepEqual(troubles, []);
  await page.close();
});

test("a composite opens and closes; what cannot be done is said", async () => {
  const {page, troubles} = await opened();
  const text = lag.replace("[outputs]", 'q = { type = "divider", numerator = "x", denominator = "a" }\n[outputs]');
  await page.evaluate((given) => oblique.open(given, "composite.toml"), text);
  await page.mouse.click(...await middle(page, body("q")), {count: 2});
  await page.waitForSelector(".inside svg");
  assert.ok(await page.$(".inside #block-product"));
  await shot(page, "inside");
  await button(page, "Back to the diagram");
  await page.mouse.click(...await middle(page, body("q")));
  await set(page, "name", "x");
  await page.waitForSelector(".machine .findings");
  assert.match(await page.$eval(".machine .findings", (one) => one.textContent), /there is a block 'x' already; expected another name/);
  assert.equal(await file(page), text);
  assert.deepEqual(troubles, []);
  await page.close();
});

test("blocks of one's own come with the file", async () => {
  const trigger = {name: "schmitt-trigger", text: readFileSync("diagrams/own-blocks/blocks/schmitt-trigger.toml", "utf8")};
  const shared = {name: "triangle-wave.toml", text: readFileSync("diagrams/own-blocks/triangle-wave.toml", "utf8"), blocks: [trigger]};
  const {page, troubles} = await opened({fragment: "#" + deflateRawSync(JSON.stringify(shared)).toString("base64url")});
  await page.waitForFunction(() => document.querySelector("h1").textContent.length > "Oblique ".length, {timeout: 20000});
  await button(page, "Add an element");
  await page.waitForSelector('.palette [data-kind="schmitt-trigger"]', {timeout: 20000});
  const name = /^(\w+) *= \{ type = "schmitt-trigger"/m.exec(shared.text)[1];
  await page.mouse.click(...await middle(page, body(name)));
  await page.waitForSelector('.form input[aria-label="upper"]', {timeout: 20000});
  assert.deepEqual(await findings(page), []);
  assert.deepEqual(troubles, []);
  await page.close();
});

test("the patch of a mechanism is to be seen, and becomes a diagram of one's own", async () => {
  const {page, troubles} = await opened();
  await page.evaluate(() => {
    const four = [...document.querySelectorAll("select[aria-label=Examples] option")].find((one) => one.value === "mechanisms/four-bar.toml");
    four.parentElement.value = four.value;
    four.parentElement.dispatchEvent(new Event("change", {bubbles: true}));
  });
  await page.waitForFunction(() => document.querySelector("h1").textContent.includes("Four-bar"), {timeout: 20000});
  assert.equal(await page.$(".overlay"), null);
  await button(page, "Edit the patch");
  await page.waitForSelector(".overlay .body", {timeout: 20000});
  assert.match(await file(page), /^format = "oblique-diagram\/1"$/m);
  await shot(page, "patch");
  assert.deepEqual(troubles, []);
  await page.close();
});

for (const [width, scheme] of [[1280, "dark"], [390, "light"], [390, "dark"]]) {
  test(`the panel is no wider than ${width} px, ${scheme}`, async () => {
    const {page} = await opened({width, scheme});
    await page.evaluate((text) => oblique.open(text, "lag.toml"), lag);
    await page.mouse.click(...await middle(page, body("x")));
    await button(page, "Add an element");
    await pause(page);
    assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth));
    await shot(page, `${width}-${scheme}`);
    await page.close();
  });
}
