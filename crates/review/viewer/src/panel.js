// The panel beside the block: legend, what is shown, sections, and where the data come from.

import { choice, make, slider, tick } from "./dom.js";

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
    this.element = rows.length ? part("Layers", make("ul", { class: "legend" }, ...rows)) : null;
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
  if (model.scenes.some((scene) => scene.whole !== null)) add("Cut-outs", true, (isOn) => stage.setCut(isOn));
  add("Lines", true, flag("lines"));
  if (model.wells.length) add("Wells", true, flag("wells"));
  if (model.notes.length) add("Notes", true, flag("notes"));
  if (model.layers.length) {
    add("Hatch what was not picked", false, (isOn) => {
      stage.shared.hatch.value = isOn ? 1 : 0;
      stage.ask();
    });
  }
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
  return part("Show", make("div", { class: "ticks" }, ...ticks), opacity.element, hint);
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

/** Steps through the sections of the volume. */
export class Scrubber {
  constructor(model, stage) {
    this.stage = stage;
    this.stacks = model.sections;
    this.model = model;
    this.element = null;
    if (!model.sections.length) return;
    this.stack = null;
    const entries = [[-1, "Block"], ...model.sections.map((stack, n) => [n, AXES[stack.axis]])];
    this.kind = choice("Sections", entries, -1, (n) => this.choose(n));
    this.slider = slider("Place", { min: 0, max: 0, step: 1, value: 0, words: (n) => this.word(n) }, (n) => this.go(n));
    this.slider.element.hidden = true;
    this.straight = make("button", { type: "button", class: "plain", hidden: true, onclick: () => this.look() }, "Look straight at it");
    this.element = part("Step through the volume", this.kind.element, this.slider.element, this.straight);
  }

  word(n) {
    const stack = this.stacks[this.stack];
    if (!stack) return "";
    const { at } = stack.places[n];
    const { inlines, crosslines, vertical } = this.model.geometry;
    if (stack.axis === 2) return `${Math.round(vertical.first + vertical.interval * at)} ${vertical.unit}`;
    const axis = stack.axis === 0 ? inlines : crosslines;
    return `${AXES[stack.axis].toLowerCase()} ${Math.round(axis.first + axis.step * at)}`;
  }

  choose(n) {
    this.stack = n < 0 ? null : n;
    this.slider.element.hidden = this.straight.hidden = n < 0;
    if (n < 0) {
      this.stage.setSection(null);
      return;
    }
    const last = this.stacks[n].places.length - 1;
    this.slider.input.max = last;
    this.slider.set(Math.floor(last / 2));
    this.go(Math.floor(last / 2));
  }

  go(n) {
    this.stage.setSection(this.stacks[this.stack].places[n]);
  }

  /** Turns the camera square to the section, on the side it looks from now. */
  look() {
    const { axis } = this.stacks[this.stack];
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
  const scrubber = new Scrubber(model, stage);
  const parts = [legend.element, scrubber.element, shown(model, stage), surfaces(model, stage), about(model)];
  const element = make("aside", { class: "panel", "aria-label": "Legend and what is shown" }, ...parts);
  return { element, legend, scrubber };
}
