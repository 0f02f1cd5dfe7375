// The panel beside the block: legend, what is shown, sections, and where the data come from.

import { make, slider, tick } from "./dom.js";

const AXES = ["Inline", "Crossline", "Slice"];

function part(title, ...children) {
  return make("section", {}, make("h2", {}, title), ...children);
}

/** The legend; a layer that is pressed, or under the pointer, stands out. */
export class Legend {
  constructor(model, stage) {
    this.stage = stage;
    this.pressed = 0;
    this.rows = new Map();
    const rows = [];
    model.layers.forEach((layer, index) => {
      if (!layer.seen) return;
      const number = index + 1;
      const about = [layer.rock, layer.age].filter(Boolean).join(" · ");
      const row = make(
        "button",
        {
          type: "button", class: "layer", "aria-pressed": "false",
          onclick: () => this.press(number), onpointerenter: () => this.hint(number), onpointerleave: () => this.hint(0),
        },
        make("img", { src: layer.swatch, alt: "", width: 48, height: 26 }),
        make("span", {}, make("b", {}, layer.name), about ? make("small", {}, about) : null),
      );
      this.rows.set(number, row);
      rows.unshift(make("li", {}, row));
    });
    const unpicked = model.unpicked && tick("Hatch what was filled or extrapolated, not picked", false, (isOn) => {
      stage.shared.hatch.value = isOn ? 1 : 0;
      stage.ask();
    }, make("i", { class: "hatch" }));
    this.element = rows.length ? part("Layers", make("ul", { class: "legend" }, ...rows), unpicked || null) : null;
  }

  press(number) {
    this.pressed = this.pressed === number ? 0 : number;
    for (const [own, row] of this.rows) row.setAttribute("aria-pressed", String(own === this.pressed));
    this.hint(0);
  }

  hint(number) {
    this.stage.shared.highlight.value = this.pressed || number;
    this.stage.ask();
  }

  /** Marks the layer under the pointer in the list. */
  mark(number) {
    for (const [own, row] of this.rows) row.classList.toggle("under", own === number);
  }
}

function shown(model, stage) {
  const ticks = [];
  const add = (name, isOn, change, swatch) => ticks.push(tick(name, isOn, change, swatch));
  const flag = (name) => (isOn) => {
    stage.show[name] = isOn;
    stage.ask();
  };
  const block = tick("Block", true, flag("block"));
  ticks.push(block);
  const cuts = make("div", { class: "ticks" });
  let cutsOf = null;
  stage.onScene(() => {
    if (cutsOf === stage.index) return;
    cutsOf = stage.index;
    const isOn = (n) => Boolean((stage.cuts[stage.index] >> n) & 1);
    cuts.replaceChildren(...stage.scene.cuts.map((name, n) => tick(name, isOn(n), (on) => stage.setCut(n, on))));
  });
  ticks.push(cuts);
  add("Lines", true, flag("lines"));
  if (model.wells.length) add("Wells", true, flag("wells"));
  if (model.notes.length) add("Notes", true, flag("notes"));
  const opacity = slider(
    "Block", { min: 0, max: 1, step: 0.05, value: 1, words: (v) => `${Math.round(100 * v)} %` },
    (value) => {
      stage.blockOpacity = value;
      stage.ask();
    },
  );
  const isDoubtful = model.horizons.some((surface) => surface.picked < 0.995);
  const hint = isDoubtful
    ? make("p", { class: "hint" }, "Lines of horizons are pale where they were filled or extrapolated.")
    : null;
  const setBlock = (isOn) => {
    const box = block.querySelector("input");
    if (box.checked !== isOn) box.click();
  };
  return { element: part("Show", make("div", { class: "ticks" }, ...ticks), opacity.element, hint), setBlock };
}

function surfaces(model, stage) {
  if (!stage.surfaces.length) return null;
  const isDoubtful = (surface) => surface.picked < 0.995;
  const ticks = stage.surfaces.map((object) => {
    const { surface } = object.userData;
    const swatch = make("i", { class: "line" });
    swatch.style.background = surface.colour;
    const name = isDoubtful(surface) ? `${surface.name} (${Math.round(100 * surface.picked)} % picked)` : surface.name;
    return tick(name, false, (isOn) => {
      object.visible = isOn;
      stage.ask();
    }, swatch);
  });
  const opacity = slider(
    "Surfaces", { min: 0.1, max: 1, step: 0.05, value: 1, words: (v) => `${Math.round(100 * v)} %` },
    (value) => {
      stage.surfaceOpacity = value;
      stage.ask();
    },
  );
  const hint = make("p", { class: "hint" }, "They lie within the block: make it clear above to see them whole.");
  return part("Horizons and faults", make("div", { class: "ticks" }, ...ticks), opacity.element, hint);
}

/** Steps through the sections of the volume: each kind is switched by itself, alone, with others, or within the block. */
export class Scrubber {
  constructor(model, stage, setBlock) {
    Object.assign(this, { model, stage, setBlock });
    this.element = null;
    if (!model.sections.length) return;
    this.rows = model.sections.map((stack, n) => this.row(stack, n));
    this.last = 0;
    this.straight = make("button", { type: "button", class: "plain", hidden: true, onclick: () => this.look() }, "Look straight at it");
    const rows = this.rows.map(({ element }) => element);
    this.element = part("Step through the volume", make("div", { class: "ticks" }, ...rows), this.straight);
  }

  row(stack, n) {
    const name = AXES[stack.axis];
    const last = stack.places.length - 1;
    const at = Math.floor(last / 2);
    const words = (index) => this.word(stack, index);
    const place = slider(`Place of the ${name.toLowerCase()}`, { min: 0, max: last, step: 1, value: at, words }, () => this.show(n));
    place.element.querySelector("label").className = "for-readers";
    place.element.hidden = true;
    const box = tick(name, false, (isOn) => {
      place.element.hidden = !isOn;
      this.show(n, isOn);
    });
    return { element: make("div", {}, box, place.element), box: box.querySelector("input"), place: place.input };
  }

  /** Shows or hides the section of a row; the block makes room for the first, and comes back after the last. */
  show(n, isOn = true) {
    const { rows, stage } = this;
    const others = rows.some(({ box }, m) => m !== n && box.checked);
    if (!others && stage.blockOpacity === 1 && isOn !== Boolean(stage.shown.has(n))) this.setBlock(!isOn);
    this.last = n;
    stage.setSection(n, isOn ? this.model.sections[n].places[Number(rows[n].place.value)] : null);
    this.straight.hidden = !rows.some(({ box }) => box.checked);
  }

  word({ axis, places }, n) {
    const { at } = places[n];
    const { inlines, crosslines, vertical } = this.model.geometry;
    if (axis === 2) return `${Math.round(vertical.first + vertical.interval * at)} ${vertical.unit}`;
    const line = axis === 0 ? inlines : crosslines;
    return `${Math.round(line.first + line.step * at)}`;
  }

  /** Turns the camera square to the section that was moved last, on the side it looks from now. */
  look() {
    const shown = this.rows[this.last].box.checked ? this.last : this.rows.findIndex(({ box }) => box.checked);
    const { axis } = this.model.sections[shown];
    const { pose } = this.stage;
    this.stage.flight = null;
    if (axis === 2) {
      this.stage.pose = { ...pose, elevation: 90 };
    } else {
      const { metric } = this.model.geometry;
      // The normal of inlines is square to the crossline direction, and the other way round.
      const along = axis === 0 ? [metric[3], metric[4]] : [metric[0], metric[1]];
      const bearing = (Math.atan2(along[1], -along[0]) * 180) / Math.PI;
      const off = (a, b) => Math.abs(((a - b + 540) % 360) - 180);
      const azimuth = [bearing, bearing + 180].sort((a, b) => off(a, pose.azimuth) - off(b, pose.azimuth))[0];
      this.stage.pose = { ...pose, azimuth, elevation: 0 };
    }
    this.stage.ask();
  }
}

function about(model) {
  const lines = model.provenance.map((line) => make("li", {}, line));
  const keys = [
    ["drag, arrow keys", "turn"], ["wheel, pinch, + −", "zoom"], ["right button, two fingers, Shift + arrows", "move"],
    ["double click, Home", "back to the scene"], ["R", "read what is in the middle"], ["B", "blend to and fro"],
    ["P", "present"], ["[ ]", "scene before, next"],
  ];
  const rows = keys.flatMap(([key, does]) => [make("dt", {}, key), make("dd", {}, does)]);
  return make(
    "details", {}, make("summary", {}, "About, and keys"), make("ul", { class: "about" }, ...lines),
    make("dl", { class: "keys" }, ...rows),
  );
}

/** The whole panel. */
export function panel(model, stage) {
  const legend = new Legend(model, stage);
  const show = shown(model, stage);
  const scrubber = new Scrubber(model, stage, show.setBlock);
  const parts = [legend.element, scrubber.element, show.element, surfaces(model, stage), about(model)];
  const element = make("aside", { class: "panel", "aria-label": "Legend and what is shown" }, ...parts);
  return { element, legend, scrubber };
}
