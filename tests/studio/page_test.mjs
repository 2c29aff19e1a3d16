// SPDX-License-Identifier: MIT
// The page in Chromium, from file://: files, lessons, scripts, what is wrong, what takes too long, links, the telephone.
import assert from "node:assert/strict";
import {mkdtempSync, rmSync, writeFileSync} from "node:fs";
import {tmpdir} from "node:os";
import {join} from "node:path";
import test from "node:test";

import {button, choose, lag, opened, shots, studio, text, timeOf, wait, write} from "./browser.mjs";
import {runProgram} from "./support.mjs";

test("a diagram is typed, run, its pot turned, its meter read", async () => {
  const {page, troubles} = await opened();
  await write(page, lag());
  await page.waitForFunction(() => document.querySelector("h1").textContent.includes("A lag"));
  await choose(page, "What the voltmeter shows", "x");
  await button(page, "OP");
  // x goes to a as e^(−4t): after 5 s by 2e-9
  await page.waitForFunction(() => Number(document.querySelector(".time").textContent.match(/t = (\S+) s/)[1]) > 5, {timeout: 20000});
  await wait(500);
  assert.ok(Math.abs(parseFloat(await text(page, ".meter output")) - 0.5) < 1e-5, await text(page, ".meter output"));
  await page.$eval("#pot-a\\.value", (input) => {
    input.value = "0.25";
    input.dispatchEvent(new Event("change", {bubbles: true}));
  });
  const turned = await timeOf(page);
  await page.waitForFunction((from) => Number(document.querySelector(".time").textContent.match(/t = (\S+) s/)[1]) > from + 5, {timeout: 20000}, turned);
  await wait(500);
  assert.ok(Math.abs(parseFloat(await text(page, ".meter output")) - 0.25) < 1e-5, await text(page, ".meter output"));
  await page.keyboard.press("Escape");
  await page.evaluate(() => document.activeElement?.blur());
  await page.keyboard.press("i");
  await page.waitForFunction(() => document.querySelector(".time").textContent === "t = 0 s");
  await page.keyboard.press("Space");
  await wait(400);
  assert.ok(await timeOf(page) > 0);
  await button(page, "REP");
  await wait(600);
  assert.equal(await page.$(".findings"), null);
  assert.deepEqual(troubles, []);
  await page.close();
});

test("scripts hold the machine by globalThis.oblique", async () => {
  const {page, troubles} = await opened();
  const opened_ = await page.evaluate((written) => oblique.open(written), lag("By a script"));
  assert.equal(opened_.title, "By a script");
  assert.deepEqual(opened_.outputs, ["x"]);
  const ran = await page.evaluate((written) => oblique.run(written, {samples: 5}), lag());
  assert.deepEqual(ran.columns.map(({name}) => name), ["t", "x"]);
  assert.equal(ran.rows.length, 5);
  // the solver's tolerance is 1e-8; a hundredfold for its global error
  for (const [t, x] of ran.rows) assert.ok(Math.abs(x - 0.5 * (1 - Math.exp(-4 * t))) < 1e-6, `${t} ${x}`);
  const values = await page.evaluate(async () => {
    await oblique.turn("a.value", -0.25);
    const time = await oblique.advance(1);
    return [time, await oblique.read("x"), await oblique.read("a.value")];
  });
  assert.ok(Math.abs(values[0] - 1) < 1e-12 && values[2] === -0.25, String(values));
  assert.ok(Math.abs(values[1] + 0.25 * (1 - Math.exp(-4))) < 1e-6, String(values));
  const refused = await page.evaluate(() => oblique.open("format = 3").then(() => "taken", (error) => error.message));
  assert.match(refused, /script\.toml:1.*format/s);
  assert.match(await page.evaluate(() => oblique.read("nobody").then(() => "read", (error) => error.message)), /nobody/);
  assert.equal(await text(page, "h1 .quiet"), "By a script");
  assert.deepEqual(troubles, []);
  await page.close();
});

test("the program puts a file inside, with the blocks and recordings that it needs", async () => {
  const folder = mkdtempSync(join(tmpdir(), "oblique-studio-"));
  writeFileSync(join(folder, "wind.csv"), "t,v\n0,0\n2,4\n");
  writeFileSync(join(folder, "ball.toml"), `format = "oblique-diagram/1"
title = "A ball </script><script>alert(1)</script> in the wind"
[run]
until = 2
[blocks]
ball = { type = "bouncing-ball", drop = 0.8 }
wind = { type = "recording", data = { file = "wind.csv", x = "t", y = "v" } }
[outputs]
height = "ball.height"
wind = "wind"
`);
  const said = runProgram(["--blocks", "diagrams/own-blocks/blocks", "studio", join(folder, "ball.toml"), "--stay", "-o", join(folder, "page.html")],
    "", {...process.env, OBLIQUE_STUDIO: studio});
  assert.equal(said.status, 0, said.err);
  const {page, troubles} = await opened({file: join(folder, "page.html")});
  assert.match(await text(page, "h1"), /A ball <\/script>.* in the wind/);
  const {rows} = await page.evaluate(() => oblique.run());
  const [t, height, wind] = rows.at(-1);
  // the first flight after a bounce is 0.9² of the drop high
  assert.ok(t === 2 && Math.abs(wind - 4) < 1e-9 && height >= 0);
  assert.ok(Math.abs(Math.max(...rows.filter(([time]) => time > 0.4).map((row) => row[1])) - 0.648) < 2e-3);  // between two rows
  assert.deepEqual(troubles, []);
  await page.close();
  rmSync(folder, {recursive: true});
});

test("a lesson is followed a step at a time, and checked", async () => {
  const {page, troubles} = await opened();
  const taught = `${lag("A lesson")}
[lesson]
title = "Where a lag comes to rest"
text = """
A paragraph.

Another <b>one</b>."""

[[lesson.step]]
do = "Halve a."
guess = "How high will x be?"
set = { "a.value" = 0.25 }
see = "x comes to rest half as high."
expect = { "x at 4" = { value = 0.25, within = 1e-4 } }

[lesson.question]
ask = "Where must a stand for x to come to rest at 0.75?"
answer = "a.value"
hint = "At rest both inputs are the same."
expect = { "x at 4" = { value = 0.75, within = 1e-3 } }
`;
  await write(page, taught);
  await page.waitForSelector(".lesson");
  assert.match(await text(page, ".lesson"), /Where a lag comes to rest.*A paragraph\..*Another <b>one<\/b>\./s);
  await button(page, "Next");
  assert.match(await text(page, ".lesson"), /step 1 of 1.*Halve a\..*Guess first: How high will x be\?.*half as high/s);
  assert.equal(await page.$(".lesson details[open]"), null);  // what is seen is not told before it was guessed
  await button(page, "Check");  // nothing was turned yet
  await page.waitForSelector(".lesson .missed");
  assert.match(await text(page, ".verdict"), /not yet.*0\.5 where 0\.25 ± 0\.0001 should be/s);
  await page.$eval("#pot-a\\.value", (input) => {
    input.value = "0.25";
    input.dispatchEvent(new Event("change", {bubbles: true}));
  });
  await button(page, "Check");
  await page.waitForSelector(".lesson .met");
  await page.$eval("#pot-a\\.value", (input) => {
    input.value = "0.9";
    input.dispatchEvent(new Event("change", {bubbles: true}));
  });
  await button(page, "Set it for me");
  await page.waitForFunction(() => document.querySelector("#pot-a\\.value").value === "0.25");
  await button(page, "Next");
  const answer = async (given) => {
    await page.$eval(".lesson form input", (input, value) => {
      input.value = value;
      input.dispatchEvent(new Event("input", {bubbles: true}));
    }, given);
    await wait(50);
    await button(page, "Answer");
  };
  await answer("0.5");
  await page.waitForSelector(".lesson .missed");
  assert.match(await text(page, ".lesson form"), /wrong.*both inputs are the same/s);
  await answer("3/4");
  await page.waitForSelector(".lesson p.met");
  // another lesson begins at its beginning, and an empty diagram has none and no findings
  for (const lesson of ["1-open-amplifier", "2-loop"]) {
    await choose(page, "Examples", `course/${lesson}.toml`);
    await page.waitForFunction(() => document.querySelector(".lesson output")?.textContent === "to begin with", {timeout: 20000});
    await button(page, "Next");
    await page.waitForFunction(() => /^step 1 of/.test(document.querySelector(".lesson output").textContent));
  }
  await button(page, "New");
  await page.waitForFunction(() => !document.querySelector(".lesson") && document.querySelector("textarea").value.includes("New diagram"));
  await wait(500);
  assert.equal(await page.$(".findings"), null);
  assert.deepEqual(troubles, []);
  await page.close();
});

test("a wrong file is told by its line, and the machine before stays", async () => {
  const {page, troubles} = await opened();
  await write(page, lag());
  await page.waitForFunction(() => document.querySelector("h1").textContent.includes("A lag"));
  await write(page, lag().replace('"integrator"', '"integrater"'));
  await page.waitForSelector(".findings");
  assert.match(await text(page, ".findings"), /line 7.*integrater.*integrator/s);
  await page.click(".findings .link");
  const [begin, end] = await page.$eval("textarea", (area) => [area.selectionStart, area.selectionEnd]);
  const chosen = (await page.$eval("textarea", (area) => area.value)).slice(begin, end);
  assert.match(chosen, /integrater/);
  await button(page, "OP");
  await wait(500);
  assert.ok(await timeOf(page) > 0);
  await write(page, lag());
  await page.waitForFunction(() => !document.querySelector(".findings"));
  assert.deepEqual(troubles, []);
  await page.close();
});

// A diagram with a signal of its own, by which the machine that is held is told from others.
const own = (name) => lag(`File ${name}`).replaceAll("x =", `only_${name} =`).replaceAll("-4*x", `-4*only_${name}`).replace('"x"', `"only_${name}"`);
// The file whose machine stands on the page, in its title and its text, and in the engine, now and when it begins again.
async function assertHolds(page, name) {
  assert.equal(await text(page, "h1 .quiet"), `File ${name}`);
  for (const again of [false, true]) {
    if (again) await page.evaluate(() => oblique.mode("initial"));
    assert.equal(await page.evaluate((signal) => oblique.read(signal).catch((error) => error.message), `only_${name}`), 0);
  }
  assert.match(await page.$eval('select[aria-label="What the voltmeter shows"]', (one) => one.textContent), new RegExp(`only_${name}`));
}

test("a file that is read slowly does not come after one that was chosen later", async () => {
  const {page, troubles} = await opened();
  await page.evaluate((files) => {
    const read = Blob.prototype.text;
    Blob.prototype.text = async function () {
      if (this.name === "slow.toml") await new Promise((done) => setTimeout(done, 700));
      return read.call(this);
    };
    const input = document.querySelector("header input[type=file]");
    for (const [name, written] of files) {
      const chosen = new DataTransfer();
      chosen.items.add(new File([written], name));
      input.files = chosen.files;
      input.dispatchEvent(new Event("change", {bubbles: true}));
    }
  }, [["slow.toml", own("a")], ["quick.toml", own("b")]]);
  await page.waitForFunction(() => document.querySelector("h1").textContent.includes("File b"), {timeout: 20000});
  await wait(1500);
  await assertHolds(page, "b");
  assert.equal(await page.$eval("textarea", (area) => area.value), own("b"));
  assert.deepEqual(troubles, []);
  await page.close();
});

// The second one comes at each question that the first one asks of the engine.
test("of files that are opened at once the last one wins, and no two are mixed", async () => {
  const {page, troubles} = await opened();
  let tried = 0;
  for (const verb of ["open", "console.open", "console.read", "console.setMode", "console.overloads"]) {
    for (const second of [own("c"), own("c").replace('"integrator"', '"integrater"')]) {
      await page.evaluate((one) => oblique.open(one).then(() => undefined), own("a"));
      const came = await page.evaluate(async (first, second, verb) => {
        const post = Worker.prototype.postMessage;
        let other;
        Worker.prototype.postMessage = function (message, ...more) {
          post.call(this, message, ...more);
          if (message.verb === verb) other ??= oblique.open(second).then(() => "taken", (error) => error.message);
        };
        const taken = await oblique.open(first).then(() => "taken", () => "not taken");
        Worker.prototype.postMessage = post;
        return [taken, await other];
      }, own("b"), second, verb);
      const isRight = second === own("c");
      if (isRight) assert.equal(came[1], "taken");
      else assert.match(came[1], /integrater/);
      await assertHolds(page, isRight ? "c" : came[0] === "taken" ? "b" : "a");
      assert.equal(await page.$eval("textarea", (area) => area.value), second);
      ++tried;
    }
  }
  assert.equal(tried, 10);
  assert.deepEqual(troubles, []);
  await page.close();
});

test("markup in a file is text", async () => {
  const {page, troubles, requests} = await opened();
  const evil = "<img src=https://example.org/x onerror=alert(1)></script><script>alert(2)</script>";
  await write(page, lag(evil).replace("[outputs]", `[outputs]\n${JSON.stringify("<b onclick=alert(3)>y")} = "x"`)
    .replace("value = 0.5", `value = 0.5, label = ${JSON.stringify(evil)}`));
  await page.waitForFunction(() => document.querySelector("h1").textContent.includes("<img"));
  await button(page, "OP");
  await wait(500);
  assert.equal(await page.$$eval("img, h1 script, svg script, b", (found) => found.length), 0);
  assert.deepEqual(requests.filter((url) => url.startsWith("http")), []);
  assert.deepEqual(troubles, []);
  await page.close();
});

test("what computes too long is stopped, and the machine comes back", async () => {
  const {page} = await opened();
  await write(page, `format = "oblique-diagram/1"
title = "Fast"
[run]
until = 1
max_steps = 1000000000
[blocks]
s = { type = "sine-source", amplitude = 1, frequency = 1e8 }
x = { type = "integrator", in = ["s", "-1*x"] }
[outputs]
x = "x"
`);
  await page.waitForFunction(() => document.querySelector("h1").textContent.includes("Fast"));
  await page.$eval("#pot-s\\.amplitude", (input) => {
    input.value = "0.75";
    input.dispatchEvent(new Event("change", {bubbles: true}));
  });
  await wait(300);
  await button(page, "OP");
  await page.waitForFunction(() => !document.querySelector(".stop").disabled, {timeout: 15000});
  const begin = Date.now();
  await page.click(".stop");
  await page.waitForFunction(() => document.querySelector(".remark")?.textContent.includes("stopped"), {timeout: 15000});
  assert.ok(Date.now() - begin < 8000);
  await page.waitForFunction(() => document.querySelector(".stop").disabled);
  assert.equal(await page.$eval("#pot-s\\.amplitude", (one) => one.value), "0.75");
  await write(page, lag("After"));
  await page.waitForFunction(() => document.querySelector("h1").textContent.includes("After"));
  await button(page, "OP");
  await wait(500);
  assert.ok(await timeOf(page) > 0);
  await page.close();
});

// Rockers in a row, each driven by the one before: their patch is judged for ten seconds.
const rockers = (count) => {
  const all = Array.from({length: count}, (_, k) => k + 1);
  return `format = "oblique-mechanism/1"
title = "Rockers in a row"
[frame]
A = [0, 1]
${all.map((k) => `F${k} = [${k}, 0]`).join("\n")}
[bodies]
AP = { points = ["A", "P0"], length = 0.2 }
${all.map((k) => `C${k} = { points = ["P${k - 1}", "P${k}"], length = 1 }\nR${k} = { points = ["F${k}", "P${k}"], length = 1 }`).join("\n")}
[sketch]
P0 = [0.2, 1]
${all.map((k) => `P${k} = [${k + 0.19}, 0.98]`).join("\n")}
[drives]
crank = { turns = "AP", about = "A", speed = 1 }
`;
};

test("a patch that takes too long is stopped, and the machine before stands where it stood", async () => {
  const {page, troubles} = await opened();
  await page.evaluate(() => oblique.advance(0.5));
  const before = await text(page, "h1 .quiet");
  await write(page, rockers(300));
  await page.waitForFunction(() => !document.querySelector(".stop").disabled, {timeout: 60000});
  await page.click(".stop");
  await page.waitForFunction(() => [...document.querySelectorAll(".remark")].some((one) => one.textContent.includes("stopped")), {timeout: 30000});
  assert.equal(await text(page, "h1 .quiet"), before);
  assert.equal(await page.$eval("textarea", (area) => area.value), rockers(300));  // what was written stays
  assert.equal(await timeOf(page), 0.5);
  await button(page, "OP");
  await page.waitForFunction(() => Number(document.querySelector(".time").textContent.match(/t = (\S+) s/)[1]) > 0.6, {timeout: 20000});
  await write(page, rockers(3));  // and may be made one that is quicker to patch
  await page.waitForFunction(() => document.querySelector("h1").textContent.includes("Rockers"), {timeout: 30000});
  assert.deepEqual(troubles, []);
  await page.close();
});

test("a browser that is too old is told so", async () => {
  for (const prepare of [() => delete globalThis.DecompressionStream, () => delete WebAssembly.compileStreaming]) {
    const {page, troubles} = await opened({prepare});
    await page.waitForSelector(".failed", {timeout: 20000});
    assert.match(await text(page, ".failed"), /cannot run the engine.*Firefox 113, Chrome 103, Safari 16\.4, or later/);
    assert.deepEqual(troubles, []);
    await page.close();
  }
});

test("a diagram with a timeline runs through its phases", async () => {
  const {page, troubles} = await opened();
  await choose(page, "Examples", "lessons/repetitive-operation.toml");
  await page.waitForFunction(() => !document.querySelector("h1").textContent.includes("Class III"));
  await button(page, "OP");
  await wait(800);
  assert.ok(await timeOf(page) > 0.1);
  assert.equal(await page.$(".findings"), null);
  assert.deepEqual(troubles, []);
  await page.close();
});

test("a link holds the file", async () => {
  const {page} = await opened();
  await write(page, lag("Shared — über Fragment"));
  await page.waitForFunction(() => document.querySelector("h1").textContent.includes("Shared"));
  await button(page, "Link");
  await page.waitForFunction(() => location.hash.length > 10);
  const fragment = await page.evaluate(() => location.hash);
  await page.close();
  const again = await opened({fragment});
  assert.match(await text(again.page, "h1"), /Shared — über Fragment/);
  assert.equal(await again.page.$eval("textarea", (area) => area.value), lag("Shared — über Fragment"));
  await again.page.close();
  const broken = await opened({fragment: "#nothing"});
  assert.match(await text(broken.page, "h1"), /Class III/);
  await broken.page.close();
});

// What lies on something else of the page, or leaves it; pictures, and lists that are scrolled, have their own order.
const collisions = (page) => page.evaluate(() => {
  const all = [...document.querySelectorAll("button, select, input, output, summary, h1, h2, p, td, textarea, .knob label, .unit, .picture, .screen")]
    .filter((one) => one.checkVisibility() && !one.closest(".picture *, .screen *, .palette ul, .pointed, .button"));
  const found = [];
  all.forEach((one, k) => {
    const a = one.getBoundingClientRect(), says = `${one.tagName} ${one.className} ${one.textContent.slice(0, 20)}`;
    if (a.left < 0 || a.right > innerWidth) found.push(`${says} from ${a.left} to ${a.right}`);
    for (const other of all.slice(k + 1)) {
      const b = other.getBoundingClientRect(), wide = Math.min(a.right, b.right) - Math.max(a.left, b.left), high = Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top);
      if (wide > 1 && high > 1 && !one.contains(other)) found.push(`${says} / ${other.tagName} ${other.className} ${other.textContent.slice(0, 20)}`);
    }
  });
  return found;
});

test("on a telephone nothing lies on anything else, and the lesson stands first", async () => {
  const {page, troubles} = await opened({width: 390, height: 844});
  await page.evaluate(() => document.querySelectorAll("details").forEach((one) => { one.open = true; }));
  await page.waitForSelector(".mode svg", {timeout: 60000});
  await button(page, "OP");
  await wait(700);
  await button(page, "HOLD");
  assert.deepEqual(await collisions(page), []);
  if (shots) await page.screenshot({path: join(shots, "telephone-mechanism.png"), fullPage: true});
  await choose(page, "Examples", "course/1-open-amplifier.toml");
  await page.waitForSelector(".lesson");
  await button(page, "Next");
  await button(page, "Check");
  await page.waitForSelector(".lesson .verdict");
  await button(page, "Add an element");
  await page.evaluate(() => { document.querySelector(".own").open = true; });
  for (const name of await page.$$eval(".own select", (all) => all.map((one) => one.getAttribute("aria-label")))) await choose(page, name, "0.5");
  await wait(300);
  assert.deepEqual(await collisions(page), []);
  const tops = await page.evaluate(() => [".lesson", ".desk", ".machine", ".text"].map((one) => document.querySelector(one).getBoundingClientRect().top));
  assert.deepEqual(tops, [...tops].sort((a, b) => a - b));
  if (shots) await page.screenshot({path: join(shots, "telephone-lesson.png"), fullPage: true});
  assert.deepEqual(troubles, []);
  await page.close();
});

for (const [width, scheme] of [[1280, "light"], [1280, "dark"], [390, "light"], [390, "dark"]]) {
  test(`nothing is wider than ${width} px, ${scheme}`, async () => {
    const {page} = await opened({width, scheme});
    await button(page, "OP");
    await wait(700);
    assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth));
    if (shots) await page.screenshot({path: join(shots, `studio-${width}-${scheme}.png`)});
    await page.close();
  });
}
