// A review of a block: reads the model that lies in the page and puts the viewer in the place of the still pictures.

import { choice, make, slider } from "./dom.js";
import { Orbit } from "./orbit.js";
import { Overlay } from "./overlay.js";
import { panel } from "./panel.js";
import { Readout } from "./readout.js";
import { Stage } from "./stage.js";

const percent = (share) => `${Math.round(100 * share)} %`;

function hasWebGl() {
  try {
    return Boolean(document.createElement("canvas").getContext("webgl2"));
  } catch {
    return false;
  }
}

/** Tabs of the scenes. */
function tabs(model, go) {
  const buttons = model.scenes.map((scene, index) =>
    make("button", { type: "button", role: "tab", id: `tab-${index}`, "aria-controls": "window", onclick: () => go(index) }, scene.name),
  );
  const element = make("div", { class: "tabs", role: "tablist", "aria-label": "Scenes" }, ...buttons);
  element.addEventListener("keydown", (event) => {
    const step = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
    if (!step) return;
    event.preventDefault();
    event.stopPropagation();
    const now = buttons.indexOf(document.activeElement);
    const next = (now + step + buttons.length) % buttons.length;
    buttons[next].focus();
    go(next);
  });
  const mark = (index) => {
    buttons.forEach((button, n) => {
      button.setAttribute("aria-selected", String(n === index));
      button.tabIndex = n === index ? 0 : -1;
    });
    const button = buttons[index];
    element.scrollTo({ left: button.offsetLeft - (element.clientWidth - button.offsetWidth) / 2 });
  };
  return { element, mark };
}

/** The bar below the block: how the illustration and the raw data are compared. */
function compareBar(model, stage) {
  const hasBoth = model.raw && model.layers.length;
  if (!hasBoth) return { element: null, set: () => {}, toggle: () => {} };
  const mix = slider(
    "Illustration to raw data",
    { min: 0, max: 1, step: 0.01, value: 0, words: percent },
    (value) => {
      if (stage.compare === "wipe") stage.wipe = value;
      else stage.setBlend(value);
      stage.ask();
    },
  );
  const handle = make("div", { class: "wipe", hidden: true });
  const ends = make("div", { class: "ends", hidden: true }, make("span", {}, "illustration"), make("span", {}, "raw data"));
  const place = () => (handle.style.left = `${100 * stage.wipe}%`);
  const kind = choice("Compare", [["blend", "Blend"], ["wipe", "Wipe"], ["pair", "Side by side"]], "blend", (next) => {
    stage.compare = next;
    handle.hidden = next !== "wipe";
    ends.hidden = next === "blend";
    mix.element.classList.toggle("off", next === "pair");
    mix.input.disabled = next === "pair";
    mix.set(next === "wipe" ? stage.wipe : stage.shared.blend.value);
    mix.input.setAttribute("aria-label", next === "wipe" ? "Place of the wipe" : "Illustration to raw data");
    stage.ask();
  });
  let isHeld = false;
  handle.addEventListener("pointerdown", (event) => {
    handle.setPointerCapture(event.pointerId);
    isHeld = true;
    event.stopPropagation();
  });
  handle.addEventListener("pointermove", (event) => {
    if (!isHeld) return;
    const bounds = handle.parentElement.getBoundingClientRect();
    stage.wipe = Math.min(Math.max((event.clientX - bounds.left) / bounds.width, 0), 1);
    mix.set(stage.wipe);
    stage.ask();
  });
  for (const name of ["pointerup", "pointercancel"]) handle.addEventListener(name, () => (isHeld = false));
  stage.onFrame(() => {
    place();
    if (stage.compare === "blend" && document.activeElement !== mix.input) mix.set(stage.shared.blend.value);
  });
  const element = make(
    "div", { class: "compare" }, kind.element,
    make("div", { class: "mix" }, make("span", { "aria-hidden": "true" }, "illustration"), mix.element, make("span", { "aria-hidden": "true" }, "raw data")),
  );
  const toggle = () => {
    const next = stage.shared.blend.value < 0.5 ? 1 : 0;
    stage.setBlend(next);
    mix.set(next);
  };
  return { element, handle, ends, toggle };
}

/** Full screen for a projector: nothing but the block, the scene's name and large type. */
function presenter(app, stage, go) {
  const set = (isOn) => {
    app.classList.toggle("present", isOn);
    stage.resize();
  };
  const is = () => app.classList.contains("present");
  document.addEventListener("fullscreenchange", () => set(document.fullscreenElement === app));
  const start = () => {
    set(true);
    // A page in a frame may not fill the screen; it presents in its window then.
    app.requestFullscreen?.().catch(() => {});
  };
  const stop = () => {
    if (document.fullscreenElement) document.exitFullscreen().catch(() => {});
    set(false);
  };
  const step = (by) => {
    const next = Math.min(Math.max(stage.index + by, 0), stage.model.scenes.length - 1);
    if (next !== stage.index) go(next);
  };
  return { is, start, stop, step, toggle: () => (is() ? stop() : start()) };
}

async function start() {
  const model = JSON.parse(document.getElementById("model").textContent);
  const app = document.getElementById("app");
  const canvas = make("canvas", { "aria-hidden": "true" });
  const surface = make(
    "div",
    {
      class: "window", id: "window", role: "application", tabindex: 0,
      "aria-label": `Block of ${model.title}. Arrow keys turn it, plus and minus zoom, R reads what is in the middle.`,
    },
    canvas,
  );
  const stage = new Stage(model, canvas);
  const orbit = new Orbit(stage, surface);
  const readout = new Readout(model, surface);
  const side = panel(model, stage);
  const overlay = new Overlay(model, stage, surface);
  const said = make("p", { class: "for-readers", role: "status" });
  const name = make("p", { class: "scene-name", "aria-hidden": "true" });
  const go = async (index) => {
    bar.mark(index);
    name.textContent = model.scenes[index].name;
    said.textContent = `Scene ${model.scenes[index].name}`;
    await stage.setScene(index);
  };
  const bar = tabs(model, go);
  const compare = compareBar(model, stage);
  const show = presenter(app, stage, go);
  const present = make("button", { type: "button", class: "plain", onclick: () => show.toggle() }, "Present");
  if (model.warning) surface.append(make("p", { class: "stamp" }, model.warning));
  surface.append(name, ...[compare.handle, compare.ends].filter(Boolean));
  const header = make("header", {}, make("h1", {}, model.title), bar.element, present);
  app.append(header, surface, side.element, said, ...[compare.element].filter(Boolean));
  hover(surface, stage, orbit, readout, side.legend);
  keys(app, stage, orbit, readout, compare, show);
  app.hidden = false;
  document.getElementById("still").hidden = true;
  try {
    await stage.start(0);
  } catch (error) {
    app.hidden = true;
    document.getElementById("still").hidden = false;
    throw error;
  }
  bar.mark(0);
  name.textContent = model.scenes[0].name;
  // For whoever measures: triangles, calls and times of frames.
  window.petroglyph = { stage, overlay };
}

/** Reads what is under the pointer; a tap keeps it. */
function hover(surface, stage, orbit, readout, legend) {
  let waiting = null;
  const read = (event) => {
    const bounds = surface.getBoundingClientRect();
    const picked = stage.pick(event.clientX - bounds.left, event.clientY - bounds.top);
    readout.show(picked);
    legend.mark(picked?.layer ?? 0);
  };
  surface.addEventListener("pointermove", (event) => {
    if (event.buttons || waiting || event.pointerType === "touch") return;
    waiting = requestAnimationFrame(() => {
      waiting = null;
      read(event);
    });
  });
  surface.addEventListener("pointerup", (event) => {
    if (!orbit.isDrag) read(event);
  });
  surface.addEventListener("pointerleave", (event) => {
    if (event.pointerType === "touch") return;
    readout.show(null);
    legend.mark(0);
  });
}

/** Keys of the whole page; those of fields stay with the fields. */
function keys(app, stage, orbit, readout, compare, show) {
  document.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const isField = event.target instanceof HTMLInputElement;
    const isBody = event.target === document.body || event.target.id === "window";
    const key = event.key.length === 1 ? event.key.toLowerCase() : event.key;
    let isDone = true;
    if (show.is() && ["ArrowRight", "PageDown", " "].includes(event.key)) show.step(1);
    else if (show.is() && ["ArrowLeft", "PageUp"].includes(event.key)) show.step(-1);
    else if (show.is() && event.key === "Escape") show.stop();
    else if (isField) isDone = false;
    else if (key === "p") show.toggle();
    else if (key === "b") compare.toggle();
    else if (key === "[") show.step(-1);
    else if (key === "]") show.step(1);
    else if (key === "r") readout.show(stage.pick(stage.lastView.width / 2, stage.height / 2), true);
    else if (isBody) isDone = orbit.key(event);
    else isDone = false;
    if (isDone) event.preventDefault();
  });
}

if (hasWebGl()) {
  start();
}
