// SPDX-License-Identifier: MIT
// The schematic alive: what colour the wires have, whether people tell them apart, and what the voltmeter reads at them.
import assert from "node:assert/strict";
import {join} from "node:path";
import test from "node:test";

import {button, check, choose, circle, opened, shots, text, wait} from "./browser.mjs";

const open = (page, written) => page.evaluate((one) => oblique.open(one).then(() => undefined), written);

// Summers that give known voltages.
const voltages = [-1, -0.5, 0, 0.5, 1, 1.5];
const known = `format = "oblique-diagram/1"
title = "Known voltages"
[blocks]
one = { type = "constant", value = 1 }
${voltages.map((value, k) => `s${k} = { type = "summer", in = ["${value || 0.0}*one"] }`).join("\n")}
all = { type = "summer", in = [${voltages.map((_, k) => `"0.1*s${k}"`).join(", ")}] }
`;

const rgb = (colour) => {
  const parts = colour.match(/^rgb\((\d+), (\d+), (\d+)\)$/);
  assert.ok(parts, colour);
  return parts.slice(1).map(Number);
};
const linear = (part) => (part / 255 <= 0.04045 ? part / 255 / 12.92 : ((part / 255 + 0.055) / 1.055) ** 2.4);
const luminance = ([r, g, b]) => 0.2126 * linear(r) + 0.7152 * linear(g) + 0.0722 * linear(b);
const contrast = (a, b) => {
  const [low, high] = [luminance(a), luminance(b)].sort((one, other) => one - other);
  return (high + 0.05) / (low + 0.05);
};

// How people see colours who lack one kind of cones, in linear RGB: F. Viénot, H. Brettel, J. D. Mollon, "Digital video
// colourmaps for checking the legibility of displays by dichromats", 1999.
const seenBy = {
  protanopes: [[0.11238, 0.88762, 0], [0.11238, 0.88762, 0], [0.00401, -0.00401, 1]],
  deuteranopes: [[0.29275, 0.70725, 0], [0.29275, 0.70725, 0], [-0.02234, 0.02234, 1]],
  trichromats: [[1, 0, 0], [0, 1, 0], [0, 0, 1]],
};
// CIELAB of linear RGB, white D65: distances below 2 are hardly seen, above 10 at a glance.
function lab(rgb) {
  const [x, y, z] = [[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]]
    .map((row, k) => row.reduce((sum, one, c) => sum + one * rgb[c], 0) / [0.9505, 1, 1.089][k])
    .map((one) => (one > 0.008856 ? Math.cbrt(one) : 7.787 * one + 16 / 116));
  return [116 * y - 16, 500 * (x - y), 200 * (y - z)];
}
const seen = (colour, eyes) => lab(seenBy[eyes].map((row) => row.reduce((sum, one, c) => sum + one * linear(colour[c]), 0)));
const distance = (a, b) => Math.hypot(...a.map((one, k) => one - b[k]));

for (const scheme of ["light", "dark"]) {
  test(`wires have the colours of the legend, which all people tell apart, ${scheme}`, async () => {
    const {page, troubles} = await opened({scheme});
    await open(page, known);
    await page.waitForFunction(() => document.querySelector("#net-s4\\.out")?.classList.contains("live"));
    const wires = await page.evaluate((count) => Array.from({length: count}, (_, k) => {
      const style = getComputedStyle(document.querySelector(`[id="net-s${k}.out"]`));
      return {stroke: style.stroke, dash: style.strokeDasharray, width: parseFloat(style.strokeWidth)};
    }), voltages.length);
    const legend = await page.$$eval(".scale rect", (all) => all.map((one) => getComputedStyle(one).fill));
    const paper = rgb(await page.$eval(".schematic svg > rect", (one) => getComputedStyle(one).fill));
    const at = (value) => legend[(value + 1) / 2 * (legend.length - 1)];
    voltages.slice(0, 5).forEach((value, k) => assert.equal(wires[k].stroke, at(value), String(value)));
    // Beyond the machine unit the colour is the last one, and the wire thick and dashed.
    assert.equal(wires[5].stroke, at(1));
    assert.notEqual(wires[5].dash, "none");
    assert.equal(wires[4].dash, "none");
    assert.ok(wires[5].width > 1.5 * wires[4].width);

    const colours = legend.map(rgb), middle = (colours.length - 1) / 2;
    for (const colour of colours) assert.ok(contrast(colour, paper) >= 3, `${colour} on ${paper}`);  // WCAG 2.1, 1.4.11: graphical objects
    for (let k = 0; k < middle; ++k) {  // farther from the paper the larger the voltage, on either side
      assert.ok(contrast(colours[k], paper) > contrast(colours[k + 1], paper), String(k));
      assert.ok(contrast(colours.at(-1 - k), paper) > contrast(colours.at(-2 - k), paper), String(k));
    }
    for (const eyes of Object.keys(seenBy)) {
      const five = [-1, -0.5, 0, 0.5, 1].map((value) => seen(rgb(at(value)), eyes));
      for (let a = 0; a < 5; ++a) for (let b = 0; b < a; ++b) assert.ok(distance(five[a], five[b]) > 10, `${eyes}: ${a} ${b} ${distance(five[a], five[b])}`);
    }
    if (shots) await page.screenshot({path: join(shots, `voltages-${scheme}.png`)});

    // All that carries a signal has its colour: leads, junctions, arrows.
    const uncoloured = await page.$$eval(".schematic [data-signal]:not([data-element]):not(.hit)", (all) => all.filter((one) => !one.style.stroke && !one.style.fill).length);
    assert.equal(uncoloured, 0);
    await check(page, "voltages");
    await page.waitForFunction(() => !document.querySelector("#net-s4\\.out").classList.contains("live"));
    assert.equal(await page.$$eval(".schematic [data-signal]", (all) => all.filter((one) => one.style.stroke || one.style.fill || one.classList.contains("over")).length), 0);
    assert.deepEqual(troubles, []);
    await page.close();
  });
}

test("colours follow the machine while it runs", async () => {
  const {page, troubles} = await opened();
  await open(page, circle);
  await page.waitForSelector('[id="net-y.out"].live');
  const legend = await page.$$eval(".scale rect", (all) => all.map((one) => getComputedStyle(one).fill));
  await button(page, "OP");
  const found = new Set();
  for (let k = 0; k < 60; ++k) {
    found.add(await page.$eval('[id="net-y.out"]', (one) => getComputedStyle(one).stroke));
    await wait(40);
  }
  // y goes from 0.8 to −0.8 and back: both halves of the scale are met, neither end is.
  assert.ok(found.size > 10, String(found.size));
  assert.ok(!found.has(legend[0]) && !found.has(legend.at(-1)));
  const isBlue = (colour) => rgb(colour)[2] > rgb(colour)[0] + 30, isOrange = (colour) => rgb(colour)[0] > rgb(colour)[2] + 30;
  assert.ok([...found].some(isBlue) && [...found].some(isOrange), String([...found]));
  assert.deepEqual(troubles, []);
  await page.close();
});

// What is read where somebody points, as soon as it is of this form.
async function pointed(page, form = "machine unit$") {
  const found = await page.waitForFunction((wanted) => document.querySelector(".pointed").textContent.match(new RegExp(wanted)), {timeout: 20000}, form);
  return found.jsonValue();
}
// A point of a wire on the screen.
const onWire = (page, id) => page.$eval(`[id="${id}"]`, (path) => {
  const at = path.getPointAtLength(path.getTotalLength() / 3), matrix = path.getScreenCTM();
  return {x: at.x * matrix.a + matrix.e, y: at.y * matrix.d + matrix.f};
});

test("the voltmeter reads what the mouse, a finger or the keys point at", async () => {
  const {page, troubles} = await opened();
  await open(page, `format = "oblique-diagram/1"
[blocks]
k = { type = "constant", value = 0.25 }
a = { type = "constant", value = 0.5, label = "a" }
r = { type = "resolver", length = "a", angle = "phi" }
phi = { type = "integrator", in = ["k"], initial = 1 }
q = { type = "divider", numerator = "r.x", denominator = "a" }
[outputs]
ratio = "q"
`);
  const near = await onWire(page, "net-phi.out");
  await page.mouse.move(near.x, near.y + 3);  // beside it will do
  await page.waitForFunction(() => document.querySelector(".pointed").textContent === "phi = 1 machine unit");
  await page.waitForFunction(() => document.querySelector(".meter output").textContent === "phi = 1 machine unit");
  await page.mouse.move(5, 5);
  await page.waitForFunction(() => document.querySelector(".pointed").textContent === "");

  // A body has all that the element gives: r e^(iφ), as the closed form has it; a composite what its inner block gives.
  const body = await page.$('[id="block-r"]');
  await body.hover();
  const [, x, y] = (await pointed(page, "^r\\.x = (\\S+), r\\.y = (\\S+) machine unit$")).map(Number);
  assert.ok(Math.abs(x - 0.5 * Math.cos(1)) < 1e-5 && Math.abs(y - 0.5 * Math.sin(1)) < 1e-5, `${x} ${y}`);
  const quotient = await page.$('[id="block-q"]');
  await quotient.hover();
  const ratio = Number((await pointed(page, "^q\\.quotient = (\\S+) machine unit$"))[1]);
  assert.ok(Math.abs(ratio - Math.cos(1)) < 1e-4, String(ratio));  // the divider's gain is 1e6
  // What is drawn on a body does not hide it, the sign in the middle, nor does what it is taken hold of by.
  const divider = await quotient.boundingBox();
  assert.equal(await page.evaluate((x, y) => document.elementsFromPoint(x, y).find((one) => one.hasAttribute("data-signal")).id, divider.x + divider.width / 2, divider.y + divider.height / 2), "block-q");
  // A click leaves the voltmeter there.
  await quotient.click();
  await page.mouse.move(5, 5);
  await page.waitForFunction(() => /^0\.5403\d* machine unit$/.test(document.querySelector(".meter output").textContent));

  const wire = await onWire(page, "net-phi.out");
  await page.touchscreen.tap(wire.x, wire.y);
  await page.waitForFunction(() => document.querySelector(".pointed").textContent === "phi = 1 machine unit");
  await page.touchscreen.tap(600, 850);
  await page.focus("h1, .schematic [tabindex='0']");
  await page.$eval(".schematic [tabindex='0']", (one) => one.focus());
  const met = new Set();
  await page.keyboard.press("Home");
  for (let k = 0; k < 12; ++k) {
    await wait(60);
    for (const one of (await text(page, ".pointed")).replace(" machine unit", "").split(", ")) met.add(one.split(" = ")[0]);
    await page.keyboard.press(k % 2 ? "ArrowRight" : "ArrowDown");
  }
  assert.deepEqual([...met].sort(), ["a", "k", "phi", "q.quotient", "r.x", "r.y"]);
  await page.keyboard.press("Home");
  await wait(60);
  const [, first] = await pointed(page, "^(\\S+) = ");
  assert.equal(await page.evaluate(() => document.activeElement.getAttribute("aria-label")), `${await page.evaluate(() => document.activeElement.getAttribute("data-element") ?? "constant")}: ${await text(page, ".pointed")}`);
  await page.keyboard.press("Enter");
  await page.waitForFunction((name) => document.querySelector('select[aria-label="What the voltmeter shows"]').value === name, {}, first);
  assert.equal(await page.$$eval(".schematic svg:not(.overlay) [tabindex='0']", (all) => all.length), 1);  // one stop of the tab key

  // It follows the machine, also while it stands and a pot is turned.
  await page.$eval('[id="block-phi"]', (one) => one.focus());
  await button(page, "OP");
  await wait(600);
  await button(page, "HOLD");
  await wait(300);
  const [time, phi] = [Number((await text(page, ".time")).match(/t = (\S+) s/)[1]), Number((await pointed(page, "^phi = (\\S+) "))[1])];
  assert.ok(time > 0.1 && Math.abs(phi - 1 - 0.25 * time) < 2e-5, `${time} ${phi}`);  // six digits of both
  await page.$eval('[id="block-r"]', (one) => one.focus());
  await page.evaluate(() => oblique.turn("a.value", 0));
  await page.waitForFunction(() => document.querySelector(".pointed").textContent.startsWith("r.x = 0, r.y = 0"));
  assert.deepEqual(troubles, []);
  await page.close();
});

test("an output of the same name does not change what a wire reads", async () => {
  const {page} = await opened();
  await open(page, circle.replace("twice =", "x ="));
  await button(page, "OP");
  await wait(600);
  await button(page, "HOLD");
  await wait(300);
  const body = await page.$('[id="block-x"]');
  await body.hover();
  const x = Number((await pointed(page, "^x = (\\S+) "))[1]);
  await choose(page, "What the voltmeter shows", "x");
  await page.mouse.move(5, 5);
  await page.waitForFunction(() => / m$/.test(document.querySelector(".meter output").textContent));
  assert.ok(Math.abs(parseFloat(await text(page, ".meter output")) - 2 * x) < 1e-5);
  await page.close();
});

for (const [width, scheme] of [[1280, "dark"], [390, "light"]]) {
  test(`class III is coloured, ${width} px, ${scheme}`, async () => {
    const {page, troubles} = await opened({width, scheme});
    await button(page, "OP");
    await wait(1200);
    assert.ok(await page.$$eval(".schematic .live", (all) => all.length) > 20);
    // What is read moves nothing, or the pointer would be elsewhere.
    const place = async () => Object.values(await page.$eval(".schematic", (one) => one.getBoundingClientRect().toJSON()));
    const body = await page.$('[id="block-B"]');
    await body.evaluate((one) => one.scrollIntoView());
    const before = await place();
    await body.hover();
    await pointed(page, "^B\\.\\w+ = ");
    await wait(400);
    await pointed(page, "^B\\.\\w+ = ");
    assert.deepEqual(await place(), before);
    assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth));
    await page.$eval(".voltages", (one) => one.scrollIntoView());
    if (shots) await page.screenshot({path: join(shots, `voltages-class-iii-${width}-${scheme}.png`)});
    assert.deepEqual(troubles, []);
    await page.close();
  });
}
