// What is drawn over the block: notes with arrows, names of wells and tops, the compass and the scale bar.

import { draw, make } from "./dom.js";

/** How far from the place that it points at a note stands, pixels. */
const OFFSET = [56, -74];

/** Height of the name of a top, pixels. */
const NAME_PX = 15;

export class Overlay {
  constructor(model, stage, parent) {
    this.model = model;
    this.stage = stage;
    const head = draw("path", { d: "M0,0 L9,4.5 L0,9 z", class: "arrow-head" });
    const marker = draw(
      "marker",
      { id: "arrow", markerWidth: 9, markerHeight: 9, refX: 8, refY: 4.5, orient: "auto", markerUnits: "userSpaceOnUse" },
      head,
    );
    this.arrows = draw("svg", { class: "arrows", "aria-hidden": "true" }, draw("defs", {}, marker));
    this.labels = make("div", { class: "labels" });
    this.notes = model.notes.map((note, index) => {
      const label = make("p", { class: "note", role: "note", "aria-label": `Note ${index + 1}` }, note.text);
      const arrow = draw("line", { class: "arrow", "marker-end": "url(#arrow)" });
      this.labels.append(label);
      this.arrows.append(arrow);
      return { note, label, arrow };
    });
    this.names = [];
    for (const well of model.wells) {
      for (const [name, at, kind] of [[well.name, null, "well"], ...well.tops.map((top) => [top.name, top.at, "top"])]) {
        const label = make("span", { class: `name ${kind}` }, name);
        this.labels.append(label);
        this.names.push({ well, at, label, isSeen: true });
      }
    }
    this.needle = draw("path", { d: "M0,-15 L5,11 L0,6 L-5,11 z", class: "needle" });
    this.north = draw("text", { class: "north", "text-anchor": "middle" }, "N");
    this.compass = draw("svg", { class: "compass", viewBox: "-24 -24 48 48", role: "img" }, this.needle, this.north);
    this.bar = make("div", { class: "bar" });
    this.scale = make("div", { class: "scale" }, this.bar, (this.length = make("span")));
    parent.append(this.arrows, this.labels, this.compass, this.scale);
    stage.onFrame(() => this.update());
  }

  /** First place of a well's path, voxels. */
  head(well) {
    well.first ??= (() => {
      const letters = atob(well.path.slice(0, 16));
      const view = new DataView(new ArrayBuffer(12));
      for (let n = 0; n < 12; n++) view.setUint8(n, letters.charCodeAt(n));
      return [0, 4, 8].map((n) => view.getFloat32(n, true));
    })();
    return well.first;
  }

  update() {
    const view = this.stage.lastView;
    const isPair = this.stage.compare === "pair";
    this.updateNotes(view, isPair);
    this.updateNames(view, isPair);
    this.updateCompass(view);
    this.updateScale(view);
  }

  updateNotes(view, isPair) {
    const taken = [];
    for (const { note, label, arrow } of this.notes) {
      const isShown =
        this.stage.show.notes && !isPair && (note.scene === null || note.scene === this.stage.scene.name) && !this.stage.flight;
      label.hidden = !isShown;
      arrow.style.display = isShown ? "" : "none";
      if (!isShown) continue;
      const [x, y] = view.project(note.at);
      const { offsetWidth: width, offsetHeight: height } = label;
      const clamp = (value, most) => Math.min(Math.max(value, 8), Math.max(most, 8));
      const isLeft = x > view.width * 0.62;
      let left = clamp(isLeft ? x - OFFSET[0] - width : x + OFFSET[0], view.width - width - 8);
      let top = clamp(y + OFFSET[1] - height / 2, view.height - height - 8);
      for (let tries = 0; tries < 8; tries++) {
        const hit = taken.find((t) => left < t.right && left + width > t.left && top < t.bottom && top + height > t.top);
        if (!hit) break;
        top = clamp(hit.bottom + 8, view.height - height - 8);
      }
      taken.push({ left, top, right: left + width, bottom: top + height });
      label.style.transform = `translate(${left}px, ${top}px)`;
      const from = [x < left ? left : x > left + width ? left + width : x, top + height / 2];
      arrow.setAttribute("x1", from[0]);
      arrow.setAttribute("y1", from[1]);
      arrow.setAttribute("x2", x);
      arrow.setAttribute("y2", y);
    }
  }

  updateNames(view, isPair) {
    clearTimeout(this.later);
    this.later = setTimeout(() => this.updateHidden(), 140);
    const shown = [];
    for (const name of this.names) {
      const isShown = this.stage.show.wells && !isPair && name.isSeen;
      name.label.hidden = !isShown;
      if (!isShown) continue;
      const [x, y] = view.project(name.at ?? this.head(name.well));
      shown.push({ label: name.label, x: x + 7, y: y - (name.at ? 8 : 20) });
    }
    // Tops that lie close together stand below one another.
    const put = [];
    for (const name of shown.sort((a, b) => a.y - b.y)) {
      const width = name.label.offsetWidth;
      const hits = (other) => name.x < other.x + other.width && other.x < name.x + width && name.y < other.y + NAME_PX;
      for (const other of put) if (hits(other)) name.y = Math.max(name.y, other.y + NAME_PX);
      put.push({ ...name, width });
      name.label.style.transform = `translate(${name.x}px, ${name.y}px)`;
    }
  }

  updateHidden() {
    let isChanged = false;
    for (const name of this.names) {
      const isSeen = this.stage.isSeen(name.at ?? this.head(name.well));
      isChanged ||= isSeen !== name.isSeen;
      name.isSeen = isSeen;
    }
    if (isChanged) this.stage.ask();
  }

  updateCompass(view) {
    const north = [view.right.y, -view.up.y];
    const size = Math.hypot(...north);
    this.compass.style.visibility = size < 0.12 ? "hidden" : "";
    const turn = (Math.atan2(north[0], -north[1]) * 180) / Math.PI;
    this.needle.setAttribute("transform", `rotate(${turn})`);
    const at = (turn * Math.PI) / 180;
    this.north.setAttribute("x", 20 * Math.sin(at));
    this.north.setAttribute("y", -20 * Math.cos(at) + 3.5);
    this.compass.setAttribute("aria-label", `North arrow; the view looks to ${Math.round(this.stage.pose.azimuth)} degrees`);
  }

  updateScale(view) {
    if (view.isPerspective) {
      this.scale.hidden = true;
      return;
    }
    this.scale.hidden = false;
    const most = 120 / view.scale;
    const decade = 10 ** Math.floor(Math.log10(most));
    const metres = [5, 2, 1].map((n) => n * decade).find((n) => n <= most);
    this.bar.style.width = `${metres * view.scale}px`;
    const text = metres >= 1000 ? `${metres / 1000} km` : `${metres} m`;
    const exaggeration = this.stage.pose.exaggeration;
    const height = Math.abs(exaggeration - 1) < 0.005 ? "true to scale" : `height × ${Number(exaggeration.toFixed(2))}`;
    this.length.textContent = `${text} · ${height}`;
  }
}
