// The drawn part of the page: scenes, cameras, what is switched on, and what lies under a pixel.

import { Color, ColorManagement, LinearSRGBColorSpace, Raycaster, Scene, Vector2, Vector3, WebGLRenderer } from "three";
import { Cover, blockGroup, lines, sectionGroup, sharedUniforms, surfaceMesh, wellLine } from "./block.js";
import { View, between, poseOf } from "./view.js";

ColorManagement.enabled = false;

const STILL = matchMedia("(prefers-reduced-motion: reduce)");
const TURN_MS = 1100;
/** Smaller side of a window in which lines are as wide as stated. */
const NOMINAL_PX = 1000;

export class Stage {
  constructor(model, canvas) {
    this.model = model;
    this.canvas = canvas;
    this.renderer = new WebGLRenderer({ canvas, antialias: true, preserveDrawingBuffer: false });
    this.renderer.outputColorSpace = LinearSRGBColorSpace;
    this.renderer.autoClear = false;
    this.world = new Scene();
    this.shared = sharedUniforms(model);
    const anisotropy = Math.min(8, this.renderer.capabilities.getMaxAnisotropy());
    this.covers = model.covers.map((_, index) => new Cover(model, index, this.shared, anisotropy));
    this.blocks = new Map();
    this.sections = new Map();
    // Sections that are shown, by the index of their stack.
    this.shown = new Map();
    this.surfaces = [...model.horizons, ...model.faults].map((surface) => surfaceMesh(surface, this.shared));
    this.surfaces.forEach((object) => this.world.add(object));
    this.compare = "blend";
    this.wipe = 0.5;
    this.show = { block: true, lines: true, wells: true, notes: true };
    // For each scene the cut-outs that are taken out: bit n stands for the nth.
    this.cuts = model.scenes.map((scene) => (1 << scene.cuts.length) - 1);
    this.blockOpacity = 1;
    this.surfaceOpacity = 1;
    this.listeners = new Set();
    this.sceneListeners = new Set();
    this.isDirty = true;
    this.frames = 0;
    this.frameMs = 0;
    this.loop = this.loop.bind(this);
  }

  /** Calls back after each frame. */
  onFrame(listener) {
    this.listeners.add(listener);
  }

  /** Calls back after each change of the scene. */
  onScene(listener) {
    this.sceneListeners.add(listener);
  }

  async start(index) {
    await this.setScene(index, true);
    new ResizeObserver(() => this.resize()).observe(this.canvas.parentElement);
    this.resize();
    requestAnimationFrame(this.loop);
  }

  /** Shows a scene; the camera flies there unless the reader asked for less motion. */
  async setScene(index, isAtOnce = false) {
    const scene = this.model.scenes[index];
    const turn = (this.turn = (this.turn ?? 0) + 1);
    const group = await this.block(index);
    if (turn !== this.turn) return false;
    const to = poseOf(scene);
    const isStill = isAtOnce || STILL.matches || !this.pose;
    const from = this.pose;
    const blend = this.shared.blend.value;
    this.index = index;
    this.flight = isStill ? null : { from, to, blend, toBlend: scene.blend, started: performance.now(), group };
    if (isStill) {
      this.pose = to;
      this.shared.blend.value = scene.blend;
      this.swap(group);
    }
    this.wells?.forEach((well) => this.world.remove(well));
    this.wells = this.model.wells.map((well) => wellLine(well, scene.wells)).filter(Boolean);
    this.wells.forEach((well) => this.world.add(well));
    this.sceneListeners.forEach((listener) => listener());
    this.ask();
    return true;
  }

  get scene() {
    return this.model.scenes[this.index];
  }

  /** The objects of a scene's block without the cut-outs that are taken out. */
  async block(index) {
    const scene = this.model.scenes[index];
    const cuts = this.cuts[index];
    const ground = scene.ground.filter((part) => (part.cuts & cuts) === 0).map((part) => part.block);
    const parts = [scene.variants[cuts], ...ground];
    const key = parts.join(" ");
    if (!this.blocks.has(key)) {
      const sources = parts.map((part) => this.model.blocks[part]);
      this.blocks.set(key, await blockGroup(sources, scene, this.covers));
    }
    return this.blocks.get(key);
  }

  swap(group) {
    if (this.group && this.group !== group) this.world.remove(this.group);
    this.group = group;
    this.world.add(group);
    this.ask();
  }

  /** Takes a cut-out of the scene out, or leaves the rock in it. */
  async setCut(cut, isOn) {
    const { index } = this;
    this.cuts[index] = isOn ? this.cuts[index] | (1 << cut) : this.cuts[index] & ~(1 << cut);
    const asked = (this.askedCut = (this.askedCut ?? 0) + 1);
    const group = await this.block(index);
    if (asked === this.askedCut && index === this.index) this.swap(group);
  }

  /** Shows one section of a stack, or none of it. */
  async setSection(stack, place) {
    this.asked ??= new Map();
    const asked = (this.asked.get(stack) ?? 0) + 1;
    this.asked.set(stack, asked);
    let object = null;
    if (place !== null) {
      const cover = this.covers[place.cover];
      await cover.load();
      if (!this.sections.has(place)) this.sections.set(place, sectionGroup(cover, place, this.scene));
      object = this.sections.get(place);
    }
    if (asked !== this.asked.get(stack)) return;
    if (this.shown.has(stack)) this.world.remove(this.shown.get(stack));
    this.shown.delete(stack);
    if (object) {
      this.shown.set(stack, object);
      this.world.add(object);
    }
    this.frame ??= this.boxEdges();
    if (this.shown.size) this.world.add(this.frame);
    else this.world.remove(this.frame);
    this.ask();
  }

  boxEdges() {
    const { low, high, edges } = this.scene;
    const corner = (n) => [0, 1, 2].map((axis) => ((n >> axis) & 1 ? high : low)[axis]);
    const pieces = [];
    for (let n = 0; n < 8; n++) {
      for (let axis = 0; axis < 3; axis++) {
        if (!((n >> axis) & 1)) pieces.push(...corner(n), ...corner(n | (1 << axis)));
      }
    }
    return lines(new Float32Array(pieces), { width: 0.8, colour: edges.colour });
  }

  setBlend(share) {
    this.shared.blend.value = share;
    if (this.flight) this.flight.toBlend = share;
    this.ask();
  }

  /** Asks for a frame. */
  ask() {
    this.isDirty = true;
  }

  resize() {
    const { clientWidth, clientHeight } = this.canvas.parentElement;
    if (!clientWidth || !clientHeight) return;
    this.pixelRatio = Math.min(devicePixelRatio || 1, 2);
    this.renderer.setPixelRatio(this.pixelRatio);
    this.renderer.setSize(clientWidth, clientHeight, false);
    this.width = clientWidth;
    this.height = clientHeight;
    this.ask();
  }

  loop(now) {
    if (this.flight) this.fly(now);
    if (this.isDirty && this.width) {
      this.isDirty = false;
      const started = performance.now();
      this.draw();
      this.frameMs = performance.now() - started;
      this.frames++;
      this.listeners.forEach((listener) => listener());
    }
    requestAnimationFrame(this.loop);
  }

  fly(now) {
    const { from, to, blend, toBlend, started, group } = this.flight;
    const part = Math.min((now - started) / TURN_MS, 1);
    const share = part * part * (3 - 2 * part);
    this.pose = between(from, to, share);
    this.shared.blend.value = blend + (toBlend - blend) * share;
    if (part >= 0.5) this.swap(group);
    if (part >= 1) this.flight = null;
    this.ask();
  }

  /** The fitted camera of the window, or of one half of it. */
  view(width = this.width) {
    return new View(this.model.geometry, this.pose, width, this.height);
  }

  draw() {
    const { renderer, shared } = this;
    const isPair = this.compare === "pair";
    const width = isPair ? Math.floor(this.width / 2) : this.width;
    const view = (this.lastView = this.view(width));
    this.prepare(view, width);
    const [r, g, b, a] = this.scene.background;
    renderer.setClearColor(a < 0.5 ? new Color(1, 1, 1) : new Color(r, g, b), 1);
    renderer.info.autoReset = false;
    renderer.info.reset();
    renderer.setScissorTest(isPair);
    const blend = shared.blend.value;
    for (let half = 0; half < (isPair ? 2 : 1); half++) {
      if (isPair) {
        renderer.setScissor(half * width, 0, width, this.height);
        shared.blend.value = half;
      }
      renderer.setViewport(half * width, 0, width, this.height);
      renderer.clear();
      renderer.render(this.world, view.camera);
    }
    shared.blend.value = blend;
  }

  /** Sets matrices, widths and what is visible. */
  prepare(view, width) {
    const { shared, show } = this;
    shared.pixel.value = this.pixelRatio;
    shared.wipe.value = this.compare === "wipe" ? this.wipe * this.width * this.pixelRatio : -1;
    shared.opacity.value = this.blockOpacity;
    const scale = Math.min(width, this.height) / NOMINAL_PX;
    const place = (object) => {
      object.matrix.copy(view.matrix);
      object.matrixWorldNeedsUpdate = true;
      if (object.material?.isLineMaterial) {
        object.material.linewidth = Math.max(object.userData.width * scale, 0.75);
      }
    };
    this.group.visible = show.block;
    const isClear = this.blockOpacity < 1;
    for (const shown of [this.group, ...this.shown.values()]) {
      const fades = isClear && shown === this.group;
      shown.matrix.copy(view.matrix);
      shown.matrixWorldNeedsUpdate = true;
      for (const object of shown.children) {
        if (object.material.isLineMaterial) {
          place(object);
          object.matrix.identity();
          object.visible = show.lines || object.renderOrder === 0;
          object.material.opacity = (object.userData.isDoubtful ? 0.45 : 1) * (fades ? 0.5 : 1);
          object.material.transparent = object.material.opacity < 1;
        } else {
          object.material.transparent = fades;
          object.material.depthWrite = !fades;
          object.renderOrder = fades ? 3 : 0;
        }
      }
    }
    for (const object of this.surfaces) {
      place(object);
      const { below } = object.userData.surface;
      object.geometry.setDrawRange(0, this.scene.hasGround ? 3 * below : Infinity);
      const { uniforms } = object.material;
      uniforms.low.value.set(...this.scene.low);
      uniforms.high.value.set(...this.scene.high);
      uniforms.opacity.value = this.surfaceOpacity;
      object.material.transparent = this.surfaceOpacity < 1;
      object.material.depthWrite = this.surfaceOpacity >= 1;
    }
    for (const well of this.wells) {
      place(well);
      well.visible = show.wells;
    }
    if (this.shown.size) place(this.frame);
  }

  /** What lies under a place of the window, in pixels of the page. */
  pick(x, y) {
    if (!this.lastView) return null;
    const width = this.lastView.width;
    const inHalf = this.compare === "pair" && x >= width ? x - width : x;
    const ray = new Raycaster();
    ray.setFromCamera(new Vector2((2 * inHalf) / width - 1, 1 - (2 * y) / this.height), this.lastView.camera);
    const isBlock = this.group.visible && this.blockOpacity >= 0.5;
    const groups = [...(isBlock ? [this.group] : []), ...this.shown.values()];
    const faces = groups.flatMap((group) => group.children.filter((object) => object.userData.cover));
    const shown = this.surfaces.filter((object) => object.visible);
    const hits = ray.intersectObjects([...faces, ...shown], false);
    for (const hit of hits) {
      const voxel = hit.object.worldToLocal(hit.point.clone()).toArray();
      const { cover, surface } = hit.object.userData;
      if (surface) {
        const isOutside = voxel.some((part, n) => part < this.scene.low[n] - 0.01 || part > this.scene.high[n] + 0.01);
        if (!isOutside) return { voxel, surface };
      } else if (cover) {
        return { voxel, name: hit.object.name, ...cover.at(voxel) };
      }
    }
    return null;
  }

  /** Whether nothing of the block hides a place in voxels. */
  isSeen(voxel) {
    if (!this.group.visible || this.blockOpacity < 1) return true;
    const view = this.lastView;
    const place = new Vector3(...voxel).applyMatrix4(view.matrix);
    const ndc = place.clone().project(view.camera);
    const ray = new Raycaster();
    ray.setFromCamera(new Vector2(ndc.x, ndc.y), view.camera);
    const [hit] = ray.intersectObjects(this.group.children.filter((object) => object.userData.cover), false);
    return !hit || hit.distance > ray.ray.origin.distanceTo(place) - view.radius * 0.004;
  }
}
