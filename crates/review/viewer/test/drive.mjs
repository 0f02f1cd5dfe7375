// Drives reviews as a reader would, in Chromium with software WebGL: mouse, finger, keyboard, phone, projector, paper, no
// script, no WebGL. Compares the block with the pictures of `petroglyph render`, and has the Khronos validator look at the
// model. Arguments: the program, a project with the scenes of the demonstration, a folder for pages and pictures.

import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { cpSync, mkdirSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { join, resolve } from "node:path";
import validator from "gltf-validator";
import { chromium } from "playwright-core";
import { PNG } from "pngjs";
import { likeness } from "./likeness.mjs";

const [program, given, out] = process.argv.slice(2).map((path) => resolve(path));
// The given project with a note, in a copy.
const project = join(out, "noted.petro");
const CHROMIUM = process.env.CHROMIUM ?? "/usr/bin/chromium";
const GL = ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"];
const HOSTILE = `</script><img src=x onerror=window.hit=1>"'&\u2028 🏔️ ${"long ".repeat(50)}`.trim();
const facts = {};

const petroglyph = (...words) => execFileSync(program, words, { encoding: "utf8", stdio: ["ignore", "pipe", "inherit"] });

/** A page with a reader's window; what must not happen is collected. */
async function open(browser, file, options = {}) {
  const context = await browser.newContext({ viewport: { width: 1280, height: 860 }, ...options });
  const page = await context.newPage();
  page.faults = [];
  page.on("console", (message) => ["error", "warning"].includes(message.type()) && page.faults.push(message.text()));
  page.on("pageerror", (error) => page.faults.push(error.message));
  page.on("request", (request) => {
    const url = request.url();
    if (!/^(data|blob):/.test(url) && url !== `file://${encodeURI(file)}`) page.faults.push(`request ${url.slice(0, 80)}`);
  });
  await page.goto(`file://${encodeURI(file)}`);
  if (options.javaScriptEnabled !== false && !options.isStill) {
    await page.waitForFunction(() => window.petroglyph?.stage.frames > 1, null, { timeout: 120000 });
  }
  return page;
}

const pose = (page) => page.evaluate(() => ({ ...petroglyph.stage.pose }));
const settle = (page) => page.waitForTimeout(400);
const shot = (page, name) => page.screenshot({ path: join(out, `${name}.png`) });
const button = (page, name) => page.getByRole("button", { name, exact: true });

async function mouse(page) {
  const before = await pose(page);
  await page.mouse.move(500, 400);
  await page.mouse.down();
  await page.mouse.move(620, 360, { steps: 6 });
  await page.mouse.up();
  await settle(page);
  const after = await pose(page);
  assert.ok(Math.abs(after.azimuth - before.azimuth) > 20 && after.elevation !== before.elevation, "a drag turns the block");
  await page.mouse.wheel(0, -300);
  await settle(page);
  assert.ok((await pose(page)).zoom > before.zoom * 1.2, "the wheel zooms");
  await page.mouse.dblclick(500, 400);
  await page.waitForTimeout(1800);
  assert.ok(Math.abs((await pose(page)).azimuth - before.azimuth) < 0.01, "a double click leads back");
}

async function comparing(page) {
  const slider = page.getByRole("slider", { name: "Illustration to raw data" });
  await slider.fill("0.5");
  await settle(page);
  assert.equal(await page.evaluate(() => petroglyph.stage.shared.blend.value), 0.5);
  await shot(page, "blend");
  await button(page, "Wipe").click();
  const handle = await page.locator(".wipe").boundingBox();
  await page.mouse.move(handle.x + handle.width / 2, handle.y + handle.height / 2);
  await page.mouse.down();
  await page.mouse.move(handle.x - 150, handle.y + handle.height / 2, { steps: 5 });
  await page.mouse.up();
  await settle(page);
  assert.ok((await page.evaluate(() => petroglyph.stage.wipe)) < 0.4, "the wipe follows the hand");
  await shot(page, "wipe");
  await button(page, "Side by side").click();
  await settle(page);
  await shot(page, "side-by-side");
  facts.callsSideBySide = await page.evaluate(() => petroglyph.stage.renderer.info.render.calls);
  await button(page, "Blend").click();
  await slider.fill("0");
}

async function reading(page) {
  await page.mouse.move(200, 560);
  await page.mouse.move(203, 562);
  await settle(page);
  const words = await page.locator(".readout").innerText();
  for (const word of ["layer", "rock", "inline", "crossline", "depth", "seismic"]) assert.ok(words.includes(word), words);
  facts.readout = words.replaceAll("\n", " ");
  await shot(page, "hover");
  const layer = page.locator(".layer").nth(2);
  await layer.click();
  assert.equal(await layer.getAttribute("aria-pressed"), "true");
  await page.mouse.move(5, 5);
  await settle(page);
  await shot(page, "legend");
  await layer.click();
}

async function showing(page) {
  const has = (name) => page.evaluate((name) => petroglyph.stage.group.children.some((object) => object.name.startsWith(name)), name);
  assert.ok(await has("wall of a cut-out"));
  await page.getByLabel("Cut-out", { exact: true }).uncheck();
  await settle(page);
  assert.ok(!(await has("wall of a cut-out")), "the block without its cut-out has no walls");
  await shot(page, "whole");
  await page.getByLabel("Cut-out", { exact: true }).check();
  await settle(page);
  const plain = await page.locator("#window").screenshot();
  await page.getByLabel(/^Hatch what/).check();
  await settle(page);
  assert.ok(!plain.equals(await shot(page, "hatched")), "what was not picked is hatched");
  await page.getByRole("slider", { name: "Block" }).fill("0.15");
  for (const name of ["Unconformity", "Delta", "Normal fault", "Reverse fault"]) await page.getByLabel(name, { exact: true }).check();
  await page.getByLabel(/Charlie/).check();
  await settle(page);
  await shot(page, "surfaces");
  facts.callsWithSurfaces = await page.evaluate(() => petroglyph.stage.renderer.info.render.calls);
  const box = (name) => page.getByRole("checkbox", { name, exact: true });
  for (const box of await page.getByRole("checkbox").all()) if (await box.isChecked()) await box.uncheck();
  for (const name of ["Block", "Cut-out", "Lines", "Notes"]) await box(name).check();
  await page.getByRole("slider", { name: "Block" }).fill("1");
  await box("Inline").check();
  assert.ok(!(await box("Block").isChecked()), "the block makes room for a section");
  await page.getByRole("slider", { name: "Place of the inline" }).fill("1");
  await settle(page);
  await shot(page, "section");
  for (const name of ["Crossline", "Slice"]) await box(name).check();
  await settle(page);
  assert.equal(await page.evaluate(() => petroglyph.stage.shown.size), 3);
  await shot(page, "sections");
  for (const name of ["Crossline", "Slice"]) await box(name).uncheck();
  await button(page, "Look straight at it").click();
  await settle(page);
  await shot(page, "section-straight");
  await box("Inline").uncheck();
  assert.ok(await box("Block").isChecked(), "and comes back");
  await page.keyboard.press("Home");
  await page.waitForTimeout(1500);
}

async function scenes(page) {
  await page.getByRole("tab", { name: "raw" }).click();
  await page.waitForTimeout(500);
  await page.waitForTimeout(1700);
  const blend = await page.evaluate(() => [petroglyph.stage.index, petroglyph.stage.shared.blend.value]);
  assert.deepEqual(blend, [1, 1], "a tab leads to its scene");
  await page.keyboard.press("ArrowLeft");
  await page.waitForTimeout(1800);
  assert.equal(await page.evaluate(() => petroglyph.stage.index), 0, "arrow keys change tabs");
}

async function keyboard(page) {
  await page.evaluate(() => document.activeElement.blur());
  const reached = new Set();
  for (let n = 0; n < 60; n++) {
    await page.keyboard.press("Tab");
    reached.add(await page.evaluate(() => {
      const now = document.activeElement;
      return now.id === "window" ? "window" : (now.getAttribute("role") ?? now.type ?? now.tagName.toLowerCase());
    }));
  }
  for (const kind of ["window", "tab", "button", "checkbox", "range", "summary"]) assert.ok(reached.has(kind), `${kind} by Tab`);
  await page.locator("#window").focus();
  const before = await pose(page);
  for (const key of ["ArrowLeft", "ArrowUp", "+"]) await page.keyboard.press(key);
  await settle(page);
  const after = await pose(page);
  assert.ok(after.azimuth !== before.azimuth && after.elevation > before.elevation && after.zoom > before.zoom);
  await page.keyboard.press("r");
  assert.match(await page.locator(".window .for-readers").innerText(), /layer .*inline/);
  await page.keyboard.press("Home");
  await page.waitForTimeout(1500);
}

async function presenting(page) {
  await page.keyboard.press("p");
  await settle(page);
  assert.ok(await page.locator(".scene-name").isVisible());
  assert.ok(!(await page.locator(".panel").isVisible()));
  await page.keyboard.press("ArrowRight");
  await page.waitForTimeout(1800);
  assert.equal(await page.evaluate(() => petroglyph.stage.index), 1);
  await shot(page, "present");
  await page.keyboard.press("ArrowLeft");
  await page.waitForTimeout(1800);
  await page.keyboard.press("Escape");
  await settle(page);
  assert.ok(await page.locator(".panel").isVisible());
}

async function speed(page) {
  const times = [];
  for (let n = 0; n < 12; n++) {
    await page.evaluate(() => petroglyph.stage.ask());
    await page.keyboard.press("ArrowLeft");
    await page.waitForTimeout(120);
    times.push(await page.evaluate(() => {
      const started = performance.now();
      const { stage } = petroglyph;
      stage.draw();
      // Reading a pixel waits for the frame.
      const gl = stage.renderer.getContext();
      gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4));
      return performance.now() - started;
    }));
  }
  times.sort((a, b) => a - b);
  const info = await page.evaluate(() => ({ ...petroglyph.stage.renderer.info.render }));
  facts.frame = { ms: Number(times[6].toFixed(1)), calls: info.calls, triangles: info.triangles };
  assert.ok(info.calls <= 50, `${info.calls} draw calls`);
}

/** The block in the page against drawn pictures of the same size. */
async function alike(page) {
  await page.evaluate(() => {
    for (const element of document.querySelectorAll(".labels, .arrows, .compass, .scale, .readout")) element.style.display = "none";
    petroglyph.stage.setScene(0, true);
  });
  await settle(page);
  const size = await page.evaluate(() => [petroglyph.stage.width, petroglyph.stage.height]);
  const names = await page.evaluate(([width, height]) => {
    const found = [];
    for (let y = 0; y < height; y += 4) for (let x = 0; x < width; x += 4) found.push(petroglyph.stage.pick(x, y)?.name ?? "");
    return found;
  }, size);
  const across = Math.ceil(size[0] / 4);
  const nameAt = (x, y) => names[Math.floor(y / 4) * across + Math.floor(x / 4)];
  facts.likeness = {};
  for (const blend of [0, 0.5, 1]) {
    const drawn = join(out, `render-${blend}.png`);
    petroglyph("render", project, drawn, "--scene", "illustrative", "--blend", String(blend), "--size", size.join("x"));
    await page.evaluate((share) => petroglyph.stage.setBlend(share), blend);
    await settle(page);
    const shown = PNG.sync.read(await page.locator("#window").screenshot({ path: join(out, `page-${blend}.png`) }));
    const wanted = PNG.sync.read(readFileSync(drawn));
    const faces = likeness(shown, wanted, (x, y) => !["", "ground", "bare fault"].includes(nameAt(x, y)));
    const all = likeness(shown, wanted, (x, y) => nameAt(x, y) !== "");
    facts.likeness[blend] = { faces: Number(faces.value.toFixed(4)), all: Number(all.value.toFixed(4)) };
  }
}

async function phone(browser, file) {
  const page = await open(browser, file, { viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true, deviceScaleFactor: 2 });
  const client = await page.context().newCDPSession(page);
  const touch = (type, points) => client.send("Input.dispatchTouchEvent", { type, touchPoints: points.map(([x, y], id) => ({ x, y, id })) });
  const before = await pose(page);
  await touch("touchStart", [[150, 300], [240, 300]]);
  for (let n = 1; n <= 6; n++) await touch("touchMove", [[150 - 8 * n, 300], [240 + 8 * n, 300]]);
  await touch("touchEnd", []);
  await settle(page);
  assert.ok((await pose(page)).zoom > before.zoom * 1.4, "a pinch zooms");
  await page.evaluate(() => petroglyph.stage.setScene(0, true));
  await page.touchscreen.tap(120, 380);
  await settle(page);
  assert.ok(await page.locator(".readout").isVisible(), "a tap reads");
  await shot(page, "phone");
  const wide = await page.evaluate(() => document.documentElement.scrollWidth);
  assert.ok(wide <= 390, `nothing is wider than the phone: ${wide}`);
  assert.deepEqual(page.faults, []);
  await page.context().close();
}

async function still(browser, file) {
  for (const [name, options] of [["no-script", { javaScriptEnabled: false }], ["paper", {}]]) {
    const page = await open(browser, file, options);
    if (name === "paper") await page.emulateMedia({ media: "print" });
    assert.ok(await page.locator("#still img").first().isVisible(), name);
    await shot(page, name);
    await page.context().close();
  }
  const bare = await chromium.launch({ executablePath: CHROMIUM, args: ["--no-sandbox", "--disable-3d-apis"] });
  const page = await open(bare, file, { isStill: true });
  assert.ok(await page.locator("#still img").first().isVisible(), "without WebGL the pictures stay");
  await bare.close();
}

async function hostile(browser) {
  const copy = join(out, "<img src=x onerror=window.hit=1>.petro");
  rmSync(copy, { recursive: true, force: true });
  cpSync(project, copy, { recursive: true });
  const [layer] = JSON.parse(petroglyph("layer", "list", copy, "--json")).layers;
  petroglyph("layer", "set", copy, layer.name ?? layer.layer ?? layer, "--name", "<b onclick=window.hit=1>&lt;'\" 🏔️");
  petroglyph("scene", "add", copy, "</script><script>window.hit=1</script>");
  petroglyph("note", "add", copy, HOSTILE.replace("\u2028", " "), "--at", "200,600,400");
  const file = join(out, "hostile.html");
  petroglyph("review", copy, file, "--sections", "0", "--density", "300");
  const page = await open(browser, file);
  assert.equal(await page.locator(".note").last().textContent(), HOSTILE.replace("\u2028", " "));
  assert.equal(await page.locator("h1").last().textContent(), "<img src=x onerror=window.hit=1>");
  assert.ok(await page.getByRole("tab", { name: "</script><script>window.hit=1</script>" }).isVisible());
  await page.locator(".layer").first().click();
  await settle(page);
  assert.equal(await page.evaluate(() => window.hit), undefined, "nothing ran");
  assert.equal(await page.locator("script").count(), 2);
  await shot(page, "hostile");
  assert.deepEqual(page.faults, []);
  await page.context().close();
}

/** A block that nobody interpreted says so on its face, and its legend names no rock. */
async function uninterpreted(browser) {
  const folder = join(out, "uninterpreted");
  rmSync(folder, { recursive: true, force: true });
  mkdirSync(folder);
  petroglyph("synth", join(folder, "s"), "--size", "64x64x64", "--seed", "1");
  const copy = join(folder, "u.petro");
  petroglyph("illustrate", join(folder, "s/survey.sgy"), join(folder, "u.svg"), "--layers", "4", "--project", copy);
  const file = join(folder, "u.html");
  petroglyph("review", copy, file, "--sections", "0", "--density", "300");
  const page = await open(browser, file);
  assert.match(await page.locator(".stamp").innerText(), /Uninterpreted/);
  assert.ok((await page.locator(".layer b").count()) > 1);
  assert.equal(await page.locator(".layer small").count(), 0, "no rock is named");
  await shot(page, "uninterpreted");
  assert.deepEqual(page.faults, []);
  await page.context().close();
}

async function policy(page) {
  const text = await page.locator("meta[http-equiv]").getAttribute("content");
  assert.match(text, /default-src 'none'/);
  assert.doesNotMatch(text, /unsafe|https?:|\*/);
  const refused = await page.evaluate(() => {
    const script = document.createElement("script");
    script.textContent = "window.hit = 1";
    document.body.append(script);
    return window.hit === undefined && fetch("https://example.org/").then(() => false, () => true);
  });
  assert.ok(refused, "the policy forbids other scripts and the network");
  page.faults.length = 0;
}

async function model() {
  const file = join(out, "block.glb");
  petroglyph("export", project, file, "--model");
  const report = await validator.validateBytes(new Uint8Array(readFileSync(file)));
  facts.glb = { errors: report.issues.numErrors, warnings: report.issues.numWarnings, triangles: report.info.totalTriangleCount };
  assert.equal(report.issues.numErrors + report.issues.numWarnings, 0, JSON.stringify(report.issues.messages));
  assert.ok(report.info.totalTriangleCount <= 100000);
}

mkdirSync(out, { recursive: true });
rmSync(project, { recursive: true, force: true });
cpSync(given, project, { recursive: true });
petroglyph("note", "add", project, "The reverse fault repeats the limestone here", "--at", "174,640,700");
const file = join(out, "review.html");
petroglyph("review", project, file);
facts.bytes = readFileSync(file).length;
const browser = await chromium.launch({ executablePath: CHROMIUM, args: GL });
const page = await open(browser, file);
await shot(page, "first");
const steps = [mouse, comparing, reading, showing, scenes, keyboard, presenting, speed, alike];
for (const step of steps.filter((step) => !process.env.ONLY || step.name === process.env.ONLY)) {
  await step(page);
  assert.deepEqual(page.faults, [], step.name);
  console.log(`${step.name}: right`);
}
if (process.env.ONLY) {
  console.log(JSON.stringify(facts, null, 2));
  process.exit(0);
}
await policy(page);
const wall = await open(browser, file, { viewport: { width: 1920, height: 1080 }, reducedMotion: "reduce" });
await wall.keyboard.press("]");
await wall.waitForTimeout(700);
assert.equal(await wall.evaluate(() => petroglyph.stage.flight), null, "reduced motion: no flight");
await shot(wall, "projector");
for (const [name, step] of [["phone", () => phone(browser, file)], ["still", () => still(browser, file)], ["hostile", () => hostile(browser)], ["uninterpreted", () => uninterpreted(browser)], ["model", model]]) {
  await step();
  console.log(`${name}: right`);
}
await browser.close();
writeFileSync(join(out, "facts.json"), JSON.stringify(facts, null, 2));
console.log(JSON.stringify(facts, null, 2));
assert.ok(Object.values(facts.likeness).every(({ faces, all }) => faces >= 0.97 && all >= 0.97), "all is alike to 0.97");
