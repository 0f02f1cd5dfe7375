// What lies under the finger, in words.

import { make } from "./dom.js";

const number = (value, digits) => value.toFixed(digits);

/** Lines of name and value for what was picked. */
export function words(model, picked) {
  const { geometry, raw, layers } = model;
  const [x, y, z] = picked.voxel;
  const line = (axis, index) => number(axis.first + axis.step * index, 0);
  const { vertical, origin, metric } = geometry;
  const depth = vertical.first + vertical.interval * z;
  const rows = [];
  if (picked.surface) {
    rows.push(["surface", picked.surface.name]);
    const share = picked.surface.picked;
    if (share < 0.995) rows.push(["picked", `${Math.round(100 * share)} % of it; the rest is filled or extrapolated`]);
  } else if (picked.layer) {
    const layer = layers[picked.layer - 1];
    if (layer) {
      rows.push(["layer", layer.name]);
      if (layer.rock) rows.push(["rock", layer.rock]);
      if (layer.age) rows.push(["age", layer.age]);
    }
    if (picked.unsure) rows.push(["boundary", "filled or extrapolated here"]);
  }
  if (vertical.unit === "ms") {
    rows.push(["time", `${number(depth, 0)} ms`], ["about", `${number(depth * vertical.metres, 0)} m`]);
  } else {
    rows.push(["depth", `${number(depth, 0)} m`]);
  }
  rows.push(["inline", line(geometry.inlines, x)], ["crossline", line(geometry.crosslines, y)]);
  const world = [0, 1].map((n) => origin[n] + metric[n] * x + metric[3 + n] * y);
  rows.push(["X, Y", `${number(world[0], 0)}, ${number(world[1], 0)} m`]);
  if (raw && picked.value) {
    const [low, high] = raw.domain;
    const value = low + ((high - low) * (picked.value - 1)) / 254;
    const digits = Math.max(0, 2 - Math.floor(Math.log10(Math.max(Math.abs(low), Math.abs(high), 1e-9))));
    const isEnd = picked.value === 1 || picked.value === 255;
    const sign = picked.value === 1 ? "≤ " : isEnd ? "≥ " : "";
    rows.push([raw.volume, sign + number(value, Math.min(digits, 6))]);
  }
  return rows;
}

/** The panel in a corner of the window. */
export class Readout {
  constructor(model, parent) {
    this.model = model;
    this.list = make("dl");
    this.element = make("div", { class: "readout", "aria-live": "off", hidden: true }, this.list);
    this.said = make("p", { class: "for-readers", role: "status" });
    parent.append(this.element, this.said);
  }

  show(picked, isSaid = false) {
    this.element.hidden = !picked;
    if (!picked) return;
    const rows = words(this.model, picked);
    this.list.replaceChildren(...rows.flatMap(([name, value]) => [make("dt", {}, name), make("dd", {}, value)]));
    if (isSaid) this.said.textContent = rows.map((row) => row.join(" ")).join(", ");
  }
}
