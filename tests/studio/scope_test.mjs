// SPDX-License-Identifier: MIT
// The oscilloscope of the page, held against closed forms: what it saves is read as a person reads it.
import assert from "node:assert/strict";
import {join} from "node:path";
import test from "node:test";

import {button, check, choose, circle, enter, lag, opened, savedBy, shots, text, timeOf, wait} from "./browser.mjs";

const open = (page, written) => page.evaluate((one) => oblique.open(one).then(() => undefined), written);
const status = (page) => page.$eval(".screen", (screen) => screen.dataset.status);
const says = (page) => page.$eval(".screen canvas", (canvas) => canvas.getAttribute("aria-label"));
const until = (page, words) => page.waitForFunction((wanted) => new RegExp(wanted).test(document.querySelector(".screen").dataset.status), {timeout: 30000}, words);
async function trigger(page, source, {level = 0, slope = "rising", mode = "normal", base = 0} = {}) {
  await choose(page, "Time base", String(base));
  await choose(page, "Trigger", source);
  await page.waitForSelector('select[aria-label="Slope"]');
  await enter(page, "Level", String(level));
  await choose(page, "Slope", slope);
  await choose(page, "Trigger mode", mode);
}
async function table(page) {
  const {name, text} = await savedBy(page, "CSV");
  assert.equal(name, "traces.csv");
  const [head, ...lines] = text.trimEnd().split("\n");
  return {head: head.split(","), rows: lines.map((line) => line.split(",").map(Number))};
}
// 1e-9 of a run over some hundred seconds, and the six digits of a sweep's beginning are not in it: rows are the solver's.
const near = 1e-5;

test("sweeps begin where the signal passes the level, however fast the machine runs", async () => {
  const {page, troubles} = await opened();
  await open(page, circle);
  await check(page, "persistence");
  await button(page, "OP");
  for (const [slope, phase, speed] of [["rising", Math.PI / 6, "1"], ["falling", 5 * Math.PI / 6, "10"], ["rising", Math.PI / 6, "Infinity"]]) {
    await page.select(".modes select", speed);
    await trigger(page, "twice", {level: 0.8, slope, base: 0.1});
    await page.waitForFunction(() => Number(document.querySelector(".screen").dataset.sweeps) >= 3, {timeout: 30000});
    const {head, rows} = await table(page);
    assert.deepEqual(head, ["sweep", "t", "twice", "y"]);
    assert.ok(rows.at(-1)[0] >= 3);
    for (const [, t, twice, y] of rows) {
      assert.ok(t >= 0 && t <= 1 + 1e-9, `${t}`);
      assert.ok(Math.abs(twice - 1.6 * Math.sin(phase + 3 * t)) < near, `${slope} at ${speed}: ${t} ${twice}`);
      assert.ok(Math.abs(y - 0.8 * Math.cos(phase + 3 * t)) < near, `${slope} at ${speed}: ${t} ${y}`);
    }
    for (let sweep = 1; sweep < rows.at(-1)[0]; ++sweep) assert.equal(rows.filter(([of]) => of === sweep).length, 601);
  }
  assert.deepEqual(troubles, []);
  await page.close();
});

test("normal waits, auto runs free, and a single sweep stands until it is armed again", async () => {
  const {page, troubles} = await opened();
  await open(page, circle);
  await trigger(page, "twice", {level: 5});
  await button(page, "OP");
  await wait(1500);
  assert.equal(await status(page), "waits for the trigger");
  assert.equal(await page.$eval(".screen", (screen) => screen.dataset.sweeps), "0");
  await choose(page, "Trigger mode", "auto");
  await until(page, "^auto: no trigger$");
  assert.equal(await page.$eval(".screen", (screen) => screen.dataset.sweeps), "1");

  await trigger(page, "twice", {level: 1, mode: "single", base: 0.05});
  await until(page, "^single: done");
  const first = Number((await status(page)).match(/t = (\S+) s/)[1]);
  await wait(2500);  // more than a turn
  assert.equal(Number((await status(page)).match(/t = (\S+) s/)[1]), first);
  await button(page, "Arm");
  await until(page, "^single: done");
  const second = Number((await status(page)).match(/t = (\S+) s/)[1]);
  const turns = (second - first) * 3 / (2 * Math.PI);
  assert.ok(turns > 0.9 && Math.abs(turns - Math.round(turns)) < 1e-4, `${first} ${second}`);  // six digits are shown
  // What begins again is armed again.
  await button(page, "IC");
  await page.waitForFunction(() => document.querySelector(".time").textContent === "t = 0 s");
  assert.equal(await status(page), "waits for the trigger");
  await button(page, "OP");
  await until(page, "^single: done, at t = 225\\.\\d+ ms");  // 1.6 sin 3t = 1
  assert.ok(Math.abs(Number((await status(page)).match(/t = (\S+) ms/)[1]) / 1e3 - Math.asin(1 / 1.6) / 3) < 1e-5);
  assert.deepEqual(troubles, []);
  await page.close();
});

// Without persistence the beam goes over what it left of the sweep before: the screen is never empty behind it.
test("the beam leaves the rest of the sweep before until it comes there", async () => {
  const {page, troubles} = await opened();
  await open(page, circle);
  await trigger(page, "twice", {level: 0.8, base: 0.1});
  await button(page, "OP");
  await page.waitForFunction(() => {
    const [, begin, unit] = document.querySelector(".screen").dataset.status.match(/triggered at t = (\S+) (m?s)/) ?? [];
    const zero = Number(begin) * (unit === "ms" ? 1e-3 : 1);
    const into = Number(document.querySelector(".time").textContent.match(/t = (\S+) s/)[1]) - zero;
    return zero > 2 && into > 0.2 && into < 0.7;
  }, {timeout: 30000});
  await button(page, "HOLD");
  await wait(300);
  const {rows} = await table(page);
  assert.ok(rows.every(([sweep]) => sweep === 1));
  assert.ok(rows.length > 595 && rows[0][1] === 0 && rows.at(-1)[1] > 0.999, `${rows.length} ${rows.at(-1)}`);
  rows.forEach(([, t, twice], k) => {
    assert.ok(k === 0 || t > rows[k - 1][1], String(t));
    assert.ok(Math.abs(twice - 1.6 * Math.sin(Math.PI / 6 + 3 * t)) < near, `${t} ${twice}`);
  });
  assert.deepEqual(troubles, []);
  await page.close();
});

test("a trigger that another machine has not is taken off", async () => {
  const {page, troubles} = await opened();
  await open(page, circle);
  await trigger(page, "twice", {level: 0.5});
  await open(page, lag());
  assert.equal(await page.$eval('select[aria-label="Trigger"]', (one) => one.value), "");
  await button(page, "OP");
  await wait(600);
  assert.ok((await table(page)).rows.length > 10);
  assert.deepEqual(troubles, []);
  await page.close();
});

test("each run of the repetitive operation is a sweep", async () => {
  const {page, troubles} = await opened();
  await open(page, lag().replace("until = 4", "until = 0.5"));
  await check(page, "persistence");
  await page.select('select[aria-label="Trigger"]', await page.evaluate(() =>
    [...document.querySelectorAll('select[aria-label="Trigger"] option')].find((one) => one.textContent.includes("each run")).value));
  await button(page, "REP");
  await page.waitForFunction(() => Number(document.querySelector(".screen").dataset.sweeps) >= 4, {timeout: 30000});
  await button(page, "HOLD");
  await wait(300);
  // From 0 on it rises, in each run of 0.5 s alike; 1e-6 is a hundred tolerances.
  const {rows} = await table(page);
  assert.ok(rows.at(-1)[0] >= 1);
  await button(page, "REP");
  let again = await table(page);
  for (let k = 0; k < 60 && !(again.rows.at(-1)?.[0] >= 3); ++k) {
    await wait(500);
    again = await table(page);
  }
  assert.ok(again.rows.at(-1)[0] >= 3, String(again.rows.at(-1)));
  for (const [, t, x] of again.rows) {
    assert.ok(t >= 0 && t <= 0.5 + 1e-9, String(t));
    assert.ok(Math.abs(x - 0.5 * (1 - Math.exp(-4 * t))) < 1e-6, `${t} ${x}`);
  }
  assert.deepEqual(troubles, []);
  await page.close();
});

// The handle of a cursor: where it is and what it says.
const cursor = (page, name) => page.$eval(`[data-cursor=${name}]`, (handle) => {
  const box = handle.getBoundingClientRect();
  return {x: box.x + box.width / 2, y: box.y + box.height / 2, now: Number(handle.getAttribute("aria-valuenow")), least: Number(handle.getAttribute("aria-valuemin")),
    most: Number(handle.getAttribute("aria-valuemax")), text: handle.getAttribute("aria-valuetext")};
});

test("two cursors measure Δt, 1/Δt and ΔV, by keys, mouse and finger", async () => {
  const {page, troubles} = await opened();
  await open(page, circle);
  await trigger(page, "twice", {level: 0.8, mode: "single", base: 0.1});
  await button(page, "OP");
  await until(page, "^single: done");
  await button(page, "HOLD");
  await check(page, "cursors");
  await page.waitForSelector("[data-cursor=B]");

  await page.focus("[data-cursor=A]");
  await page.keyboard.press("Home");
  for (let k = 0; k < 25; ++k) await page.keyboard.press("ArrowRight");  // 25 of 500 parts of 1 s
  await page.focus("[data-cursor=B]");
  await page.keyboard.press("Home");
  for (let k = 0; k < 5; ++k) await page.keyboard.press("PageUp");
  await page.keyboard.down("Shift");
  await page.keyboard.press("ArrowLeft");
  await page.keyboard.up("Shift");
  await page.waitForFunction(() => /430 ms/.test(document.querySelector(".apart")?.textContent ?? ""));  // 0.5 − 0.02 − 0.05
  assert.equal(await text(page, ".apart"), "430 ms");
  assert.equal(await text(page, ".often"), "2.32558 Hz");
  const twice = (t) => 1.6 * Math.sin(Math.PI / 6 + 3 * t), y = (t) => 0.8 * Math.cos(Math.PI / 6 + 3 * t);
  const apart = async (name) => Number(await text(page, `[data-apart="${name}"]`));
  // Between two rows of a sweep, 1/600 s apart, a straight line misses by (3/600)²/8 of the size.
  assert.ok(Math.abs(await apart("twice") - (twice(0.48) - twice(0.05))) < 1e-5, String(await apart("twice")));
  assert.ok(Math.abs(await apart("y") - (y(0.48) - y(0.05))) < 1e-5);
  assert.match((await cursor(page, "A")).text, /^50 ms: twice = 0\.998\d* m, y = 0\.625\d* machine unit$/);
  assert.match(await says(page), /^Oscilloscope: twice, y over the time from the trigger\. twice from -0\.5964\d* to 1\.6 m; y from -0\.7999\d* to 0\.69282 machine unit\. time from 0 s to 1 s\..*Δt = 430 ms, 1\/Δt = 2\.32558 Hz\.$/);
  await page.keyboard.press("End");
  assert.equal((await cursor(page, "B")).now, 1);
  await page.keyboard.press("ArrowRight");
  assert.equal((await cursor(page, "B")).now, 1);

  // The mouse puts A where it is let go, to a pixel: between the two ends the screen is even.
  await page.focus("[data-cursor=A]");
  await page.keyboard.press("Home");
  const [from, to] = [await cursor(page, "A"), await cursor(page, "B")];
  const middle = from.x + 0.3 * (to.x - from.x), pixel = 1 / (to.x - from.x);
  await page.mouse.move(from.x, from.y);
  await page.mouse.down();
  await page.mouse.move(from.x + 20, from.y, {steps: 4});
  await page.mouse.move(middle, from.y + 40, {steps: 4});
  await page.mouse.up();
  await page.mouse.move(to.x - 30, from.y);  // let go: it stays
  assert.ok(Math.abs((await cursor(page, "A")).now - 0.3) < 1.5 * pixel, String((await cursor(page, "A")).now));
  const finger = await page.touchscreen.touchStart(to.x, to.y);
  await finger.move(to.x - 10, to.y);
  await finger.move(from.x + 0.8 * (to.x - from.x), to.y - 30);
  await finger.end();
  assert.ok(Math.abs((await cursor(page, "B")).now - 0.8) < 1.5 * pixel, String((await cursor(page, "B")).now));
  if (shots) await page.screenshot({path: join(shots, "scope-cursors.png")});

  // Over another signal a cursor is a point of the way.
  await choose(page, "What the traces are drawn against", "y");
  await page.waitForFunction(() => document.querySelector(".screen canvas").getAttribute("aria-label").includes("over y"));
  const at = await cursor(page, "A");
  await page.mouse.move(at.x, at.y);
  await page.mouse.down();
  const other = await cursor(page, "B");
  await page.mouse.move(other.x, other.y, {steps: 5});
  await page.mouse.up();
  assert.ok(Math.abs((await cursor(page, "A")).now - (await cursor(page, "B")).now) < 0.01);
  assert.deepEqual(troubles, []);
  await page.close();
});

// A picture read as a person does: by the numbers at its axes.
function reading(svg) {
  const labels = [...svg.matchAll(/<text[^>]* x="([^"]*)" y="([^"]*)"[^>]*text-anchor="(\w+)"[^>]*>([^<]*)<\/text>/g)]
    .map(([, x, y, anchor, words]) => ({x: Number(x), y: Number(y), anchor, words, number: Number(words.replace("−", "-"))}));
  const numbers = labels.filter(({words, number}) => words !== "" && Number.isFinite(number));
  const lowest = Math.max(...numbers.filter(({anchor}) => anchor === "middle").map(({y}) => y));
  const across = numbers.filter(({anchor, y}) => anchor === "middle" && y === lowest), up = numbers.filter(({anchor}) => anchor === "end");
  const scale = (marks, place) => {
    const [a, b] = [marks[0], marks.at(-1)];
    return (pixel) => a.number + (pixel - place(a)) / (place(b) - place(a)) * (b.number - a.number);
  };
  const toX = scale(across, ({x}) => x), toY = scale(up, ({y}) => y - 4);  // the middle of a number is 4 above its line
  const traces = [...svg.matchAll(/<path d="([^"]+)" stroke="(#\w+)" stroke-width="(1\.7|1\.2)"(?: stroke-opacity="([^"]*)")?/g)].map(([, d, colour, , opacity]) => ({
    colour, opacity: Number(opacity ?? 1),
    points: [...d.matchAll(/[ML](\S+) ([^ML]+)/g)].map(([, x, y]) => [toX(Number(x)), toY(Number(y))]),
    pixels: [...d.matchAll(/[ML](\S+) ([^ML]+)/g)].map(([, x, y]) => [Number(x), Number(y)]),
  }));
  return {labels: labels.map(({words}) => words), across, up, traces};
}

test("the screen is saved as SVG and PNG, with axes and units", async () => {
  const {page, troubles, requests} = await opened({scheme: "dark"});
  await open(page, circle);
  await check(page, "persistence");
  await trigger(page, "twice", {level: 0.8, base: 0.1});
  await choose(page, "Vertical scale", "0.5");
  await button(page, "OP");
  await page.waitForFunction(() => Number(document.querySelector(".screen").dataset.sweeps) >= 3, {timeout: 30000});
  await button(page, "HOLD");
  await wait(300);
  const {name, type, text: svg} = await savedBy(page, "SVG");
  assert.equal(name, "scope.svg");
  assert.equal(type, "image/svg+xml");
  assert.equal(await page.evaluate((one) => new DOMParser().parseFromString(one, "image/svg+xml").querySelector("parsererror")?.textContent ?? "", svg), "");
  assert.doesNotMatch(svg.replace('xmlns="http://www.w3.org/2000/svg"', ""), /http|href|<script|<image/);
  assert.match(svg, /<title>A circle – Oscilloscope: twice, y over the time from the trigger<\/title>/);
  assert.match(svg, /<desc>twice from .* m; y from .* machine unit\. time from 0 s to 1 s\./);
  const {labels, across, up, traces} = reading(svg);
  for (const one of ["twice [m]", "y [machine unit]", "t from the trigger [s]"]) assert.ok(labels.includes(one), `${one}: ${labels}`);
  assert.deepEqual(across.map(({words}) => words), ["0", "0.1", "0.2", "0.3", "0.4", "0.5", "0.6", "0.7", "0.8", "0.9", "1"]);
  assert.deepEqual(up.map(({words}) => words), ["−2", "−1.5", "−1", "−0.5", "0", "0.5", "1", "1.5", "2"]);
  const twice = traces.filter(({colour}) => colour === "#0072b2"), ys = traces.filter(({colour}) => colour === "#d55e00");
  assert.ok(twice.length >= 3 && ys.length === twice.length);
  // The older, the fainter; the newest is not.
  assert.equal(twice.at(-1).opacity, 1);
  twice.forEach(({opacity}, k) => assert.ok(k === 0 || opacity > twice[k - 1].opacity || opacity === 0.1, String(twice.map((one) => one.opacity))));
  for (const {points} of twice) for (const [t, value] of points) assert.ok(Math.abs(value - 1.6 * Math.sin(Math.PI / 6 + 3 * t)) < 0.01, `${t} ${value}`);
  for (const {points} of ys) for (const [t, value] of points) assert.ok(Math.abs(value - 0.8 * Math.cos(Math.PI / 6 + 3 * t)) < 0.01, `${t} ${value}`);
  assert.ok(twice[0].points.length > 200);

  await button(page, "PNG");
  await page.waitForFunction(() => globalThis.savedFiles.at(-1).name === "scope.png");
  const png = await page.evaluate(async (pixels) => {
    const {blob} = globalThis.savedFiles.at(-1);
    const bitmap = await createImageBitmap(blob), canvas = document.createElement("canvas");
    [canvas.width, canvas.height] = [bitmap.width, bitmap.height];
    const pen = canvas.getContext("2d");
    pen.drawImage(bitmap, 0, 0);
    const {data} = pen.getImageData(0, 0, bitmap.width, bitmap.height);
    // how blue it is there: the trace on white or grey
    const blue = ([x, y]) => {
      const at = 4 * (Math.round(2 * y) * bitmap.width + Math.round(2 * x));
      return data[at + 2] - data[at];
    };
    const bytes = new Uint8Array(await blob.arrayBuffer());
    return {type: blob.type, width: bitmap.width, height: bitmap.height, corner: [...data.slice(0, 4)], blue: pixels.filter((one) => blue(one) > 30).length, base64: btoa(bytes.reduce((all, byte) => all + String.fromCharCode(byte), ""))};
  }, twice[0].pixels);
  assert.deepEqual([png.type, png.width, png.height], ["image/png", 1800, 960]);
  assert.deepEqual(png.corner, [255, 255, 255, 255]);  // on paper, also of a dark page
  assert.ok(png.blue > 0.95 * twice[0].pixels.length, `${png.blue} of ${twice[0].pixels.length}`);  // the orange trace crosses it
  if (shots) {
    const {writeFileSync} = await import("node:fs");
    writeFileSync(join(shots, "scope-saved.png"), Buffer.from(png.base64, "base64"));
    writeFileSync(join(shots, "scope-saved.svg"), svg);
    await page.screenshot({path: join(shots, "scope-dark.png")});
  }
  assert.deepEqual(requests.filter((url) => url.startsWith("http")), []);
  assert.deepEqual(troubles, []);
  await page.close();
});

// What a person does with the numbers at the axis, which are those of `twice`, and with the divisions for the other trace.
test("each trace has a scale and a position of its own, on the screen and in what is saved", async () => {
  const {page, troubles} = await opened();
  await open(page, circle);
  await trigger(page, "twice", {level: 0.8, mode: "single", base: 0.1});
  await button(page, "OP");
  await until(page, "^single: done");
  await button(page, "HOLD");
  await page.$eval(".own summary", (summary) => summary.click());
  await choose(page, "Vertical scale of twice", "0.5");
  await enter(page, "Position of twice, divisions above the middle", "0.5");
  await choose(page, "Vertical scale of y", "0.5");
  await enter(page, "Position of y, divisions above the middle", "-1.5");
  await page.waitForFunction(() => document.querySelector(".screen canvas").getAttribute("aria-label").includes("1.5 divisions below"));
  assert.match(await says(page), /twice 0\.5 m a division, its zero 0\.5 divisions above the middle\. y 0\.5 machine unit a division, its zero 1\.5 divisions below the middle\./);
  assert.doesNotMatch(await says(page), /screen from/);
  const exact = {twice: (t) => 1.6 * Math.sin(Math.PI / 6 + 3 * t), y: (t) => 0.8 * Math.cos(Math.PI / 6 + 3 * t)};

  const {text: svg} = await savedBy(page, "SVG");
  const {labels, up, traces} = reading(svg);
  for (const one of ["twice [m], 0.5 a division", "y [machine unit], 0.5 a division", "twice [m]"]) assert.ok(labels.includes(one), `${one}: ${labels}`);
  assert.deepEqual(up.map(({words}) => words), ["−2.25", "−1.75", "−1.25", "−0.75", "−0.25", "0.25", "0.75", "1.25", "1.75"]);
  assert.equal(labels.filter((one) => one === "▸").length, 2);
  const [twice, y] = ["#0072b2", "#d55e00"].map((colour) => traces.find((one) => one.colour === colour));
  // written to 0.01 px, of some 50 a division
  for (const [t, value] of twice.points) assert.ok(Math.abs(value - exact.twice(t)) < 0.001, `${t} ${value}`);
  // divisions above the middle by the axis of `twice`, whose zero is 0.5 above it
  for (const [t, at] of y.points) assert.ok(Math.abs((at / 0.5 + 0.5 + 1.5) * 0.5 - exact.y(t)) < 0.001, `${t} ${at}`);
  assert.ok(twice.points.length > 200 && y.points.length === twice.points.length);

  await button(page, "PNG");
  await page.waitForFunction(() => globalThis.savedFiles.at(-1).name === "scope.png");
  const coloured = await page.evaluate(async (pixels) => {
    const bitmap = await createImageBitmap(globalThis.savedFiles.at(-1).blob), pen = Object.assign(document.createElement("canvas"), {width: bitmap.width, height: bitmap.height}).getContext("2d");
    pen.drawImage(bitmap, 0, 0);
    const {data} = pen.getImageData(0, 0, bitmap.width, bitmap.height);
    return pixels.map((of) => of.filter(([x, y]) => {
      const at = 4 * (Math.round(2 * y) * bitmap.width + Math.round(2 * x));
      return Math.abs(data[at + 2] - data[at]) > 30;  // blue or orange, on white and grey
    }).length);
  }, [twice.pixels, y.pixels]);
  assert.ok(coloured[0] > 0.95 * twice.pixels.length && coloured[1] > 0.95 * y.pixels.length, String(coloured));

  // Numbers are numbers, whatever the scale.
  const {head, rows} = await table(page);
  assert.deepEqual(head, ["sweep", "t", "twice", "y"]);
  for (const [, t, a, b] of rows) assert.ok(Math.abs(a - exact.twice(t)) < near && Math.abs(b - exact.y(t)) < near, `${t} ${a} ${b}`);

  // By keys and by the mouse.
  const ground = (name) => page.$eval(`[data-ground="${name}"]`, (mark) => {
    const box = mark.getBoundingClientRect();
    return {role: mark.getAttribute("role"), label: mark.getAttribute("aria-label"), now: Number(mark.getAttribute("aria-valuenow")), says: mark.getAttribute("aria-valuetext"), x: box.x + box.width / 2, y: box.y + box.height / 2};
  });
  const before = await ground("y");
  assert.deepEqual([before.role, before.label, before.now, before.says], ["slider", "Position of y on the screen", -1.5, "zero 1.5 divisions below the middle, 0.5 machine unit a division"]);
  await page.focus('[data-ground="y"]');
  for (const key of ["ArrowUp", "ArrowUp", "PageUp", "ArrowDown"]) await page.keyboard.press(key);
  assert.equal((await ground("y")).now, -0.4);
  await page.keyboard.press("Home");
  assert.equal((await ground("y")).says, "zero in the middle, 0.5 machine unit a division");
  await page.keyboard.press("+");
  assert.equal((await ground("y")).says, "zero in the middle, 0.2 machine unit a division");
  await page.keyboard.press("-");
  await page.keyboard.press("-");
  assert.equal(await page.$eval('select[aria-label="Vertical scale of y"]', (one) => one.value), "1");
  const from = await ground("y"), division = (from.y - (await ground("twice")).y) / 0.5;  // where the zero of `twice` is
  await page.mouse.move(from.x, from.y);
  await page.mouse.down();
  await page.mouse.move(from.x, from.y - division, {steps: 4});
  await page.mouse.up();
  await page.mouse.move(from.x, from.y);  // let go: it stays
  assert.ok(Math.abs((await ground("y")).now - 1) < 1.5 / division, `${(await ground("y")).now}, ${division} px a division`);

  // The numbers at the left are of what is drawn alike; what is fitted is all on the screen.
  await choose(page, "Vertical scale of twice", "");
  await choose(page, "Vertical scale of y", "fit");
  await wait(300);
  const mixed = reading((await savedBy(page, "SVG")).text);
  for (const [t, value] of mixed.traces.find(({colour}) => colour === "#0072b2").points) assert.ok(Math.abs(value - exact.twice(t)) < 0.002, `${t} ${value}`);
  assert.match(await says(page), /screen from -1\.5 to 2\.5 m\. y 0\.5 machine unit a division/);
  assert.ok(mixed.traces.find(({colour}) => colour === "#d55e00").points.every(([, at]) => at > -1.5 && at < 2.5));
  assert.deepEqual(troubles, []);
  await page.close();
});

test("signals over another one, and the free beam with what was before", async () => {
  const {page, troubles} = await opened();
  await open(page, circle);
  await check(page, "persistence");
  await choose(page, "What the traces are drawn against", "y");
  await button(page, "OP");
  await page.waitForFunction(() => Number(document.querySelector(".time").textContent.match(/t = (\S+) s/)[1]) > 2.2, {timeout: 20000});
  await button(page, "HOLD");
  await wait(300);
  const over = reading((await savedBy(page, "SVG")).text);
  assert.ok(over.labels.includes("y [machine unit]") && over.labels.includes("twice [m]"));
  const [{points}] = over.traces;
  for (const [y, twice] of points) assert.ok(Math.abs((twice / 1.6) ** 2 + (y / 0.8) ** 2 - 1) < 0.02, `${y} ${twice}`);
  // A whole turn: the way goes all round.
  for (const [x, y] of [[1, 1], [1, -1], [-1, 1], [-1, -1]]) assert.ok(points.some((point) => point[0] * x > 0.4 && point[1] * y > 0.8));

  await choose(page, "What the traces are drawn against", "");
  await button(page, "IC");
  await button(page, "OP");
  await page.waitForFunction(() => document.querySelector(".screen").dataset.sweeps === "2", {timeout: 20000});
  await wait(500);
  await button(page, "HOLD");
  await wait(300);
  const {traces} = reading((await savedBy(page, "SVG")).text);
  const blue = traces.filter(({colour}) => colour === "#0072b2");
  assert.deepEqual(blue.map(({opacity}) => opacity), [0.6, 1]);
  for (const {points} of blue) for (const [t, value] of points) assert.ok(Math.abs(value - 1.6 * Math.sin(3 * t)) < 0.02, `${t} ${value}`);

  // A time base shows the last ten divisions alone; without persistence the machine before is gone.
  await check(page, "persistence");
  await button(page, "IC");
  await choose(page, "Time base", "0.05");
  await button(page, "OP");
  await page.waitForFunction(() => Number(document.querySelector(".time").textContent.match(/t = (\S+) s/)[1]) > 1.5, {timeout: 20000});
  await button(page, "HOLD");
  await wait(300);
  const time = await timeOf(page), {rows} = await table(page);  // shown to 1e-4
  assert.ok(rows.at(-1)[0] > time - 1e-4 && rows[0][0] < time - 0.5 + 1e-4 && rows[0][0] > time - 0.56, `${rows[0][0]} … ${rows.at(-1)[0]} at ${time}`);
  assert.deepEqual(troubles, []);
  await page.close();
});

test("the speed goes from frozen to as fast as it goes", async () => {
  const {page, troubles} = await opened();
  await open(page, circle);
  await page.select(".modes select", "0");
  assert.equal(await page.$eval(".modes select", (one) => one.selectedOptions[0].textContent), "frozen");
  await button(page, "OP");
  await wait(700);
  assert.equal(await timeOf(page), 0);
  await page.select(".modes select", "Infinity");
  await wait(1500);
  const time = await timeOf(page);
  console.log(`as fast as it goes: ${(time / 1.5).toFixed(0)} s a second`);
  assert.ok(time > 10, String(time));  // of a page under load too
  await page.select(".modes select", "0");
  await wait(300);
  const frozen = await timeOf(page);
  await wait(300);
  assert.equal(await timeOf(page), frozen);
  // The free beam goes on by a screen a frame at the most, of 500 rows: what is wider than a row is seen.
  await choose(page, "Time base", "0.05");
  await button(page, "IC");
  await page.select(".modes select", "Infinity");
  await button(page, "OP");
  await page.waitForFunction(() => Number(document.querySelector(".time").textContent.match(/t = (\S+) s/)[1]) > 2, {timeout: 20000});
  await button(page, "HOLD");
  await wait(300);
  const {rows} = await table(page);
  assert.ok(rows.length >= 500, String(rows.length));
  for (let k = 1; k < rows.length; ++k) assert.ok(rows[k][0] - rows[k - 1][0] < 0.00101, `${rows[k - 1][0]} ${rows[k][0]}`);
  assert.deepEqual(troubles, []);
  await page.close();
});

test("how many frames a second the scope has", async () => {
  const {page, troubles} = await opened();
  await choose(page, "What the traces are drawn against", "");
  await check(page, "persistence");
  await check(page, "cursors");
  await button(page, "OP");
  await wait(1500);
  const measured = await page.evaluate(() => new Promise((done) => {
    const screen = document.querySelector(".screen"), begin = performance.now(), drawing = [];
    let frames = 0, news = 0, before = "";
    const step = () => {
      if (performance.now() - begin > 3000) {
        drawing.sort((a, b) => a - b);
        done({frames: frames / 3, news: news / 3, median: drawing[drawing.length >> 1], worst: drawing.at(-1)});
        return;
      }
      ++frames;
      const time = document.querySelector(".time").textContent;
      if (time !== before) {
        ++news;
        drawing.push(Number(screen.dataset.took));
      }
      before = time;
      requestAnimationFrame(step);
    };
    requestAnimationFrame(step);
  }));
  console.log(`class III with wires coloured: ${measured.frames.toFixed(0)} frames a second, ${measured.news.toFixed(0)} of them with something new; ` +
    `the beam is drawn in ${measured.median} ms (${measured.worst} at the most; a frame of a sixtieth of a second has 16)`);
  assert.ok(measured.news > 0);  // how fast it is, a benchmark tells: the time of a busy machine is others'
  assert.deepEqual(troubles, []);
  await page.close();
});

for (const [width, scheme] of [[1280, "light"], [1280, "dark"], [390, "light"], [390, "dark"]]) {
  test(`the scope is whole at ${width} px, ${scheme}`, async () => {
    const {page} = await opened({width, height: 1100, scheme});
    await open(page, circle);
    await check(page, "persistence");
    await trigger(page, "twice", {level: 0.8, base: 0.2});
    await check(page, "cursors");
    await button(page, "OP");
    await page.waitForFunction(() => Number(document.querySelector(".screen").dataset.sweeps) >= 2, {timeout: 20000});
    assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth));
    if (shots) await page.screenshot({path: join(shots, `scope-${width}-${scheme}.png`)});
    await page.close();
  });
}
