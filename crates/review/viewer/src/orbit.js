// Turning, moving and zooming by mouse, finger and keyboard.

const TURN_DEG_PER_PX = 0.35;
const STEP_DEG = 5;
const ELEVATIONS = [0, 90];
const ZOOMS = [0.5, 40];

const clamp = (value, [low, high]) => Math.min(Math.max(value, low), high);

export class Orbit {
  constructor(stage, surface) {
    this.stage = stage;
    this.surface = surface;
    this.pointers = new Map();
    this.moved = 0;
    const on = (name, handler, options) => surface.addEventListener(name, handler, options);
    on("pointerdown", (event) => this.down(event));
    on("pointermove", (event) => this.move(event));
    for (const name of ["pointerup", "pointercancel"]) on(name, (event) => this.up(event));
    on("wheel", (event) => this.wheel(event), { passive: false });
    on("dblclick", () => this.reset());
    on("contextmenu", (event) => event.preventDefault());
  }

  reset() {
    this.stage.setScene(this.stage.index);
  }

  down(event) {
    this.surface.setPointerCapture(event.pointerId);
    this.pointers.set(event.pointerId, { x: event.clientX, y: event.clientY });
    this.moved = 0;
  }

  up(event) {
    this.pointers.delete(event.pointerId);
  }

  /** Whether the pointer that just went up had turned the block. */
  get isDrag() {
    return this.moved > 6;
  }

  move(event) {
    const pointer = this.pointers.get(event.pointerId);
    if (!pointer) return;
    const [dx, dy] = [event.clientX - pointer.x, event.clientY - pointer.y];
    this.moved += Math.abs(dx) + Math.abs(dy);
    if (this.pointers.size === 2) {
      const [other] = [...this.pointers.entries()].filter(([id]) => id !== event.pointerId).map(([, p]) => p);
      const length = (p) => Math.hypot(p.x - other.x, p.y - other.y);
      const before = length(pointer);
      const after = length({ x: event.clientX, y: event.clientY });
      if (before > 0 && after > 0) {
        this.zoom(after / before, (event.clientX + other.x) / 2, (event.clientY + other.y) / 2);
      }
      this.pan(dx / 2, dy / 2);
    } else if (event.shiftKey || event.buttons === 2 || event.buttons === 4) {
      this.pan(dx, dy);
    } else {
      this.turn(dx * TURN_DEG_PER_PX, dy * TURN_DEG_PER_PX);
    }
    pointer.x = event.clientX;
    pointer.y = event.clientY;
  }

  wheel(event) {
    event.preventDefault();
    const lines = event.deltaMode === 1 ? event.deltaY * 30 : event.deltaY;
    this.zoom(Math.exp(-clamp(lines, [-240, 240]) * 0.0016), event.clientX, event.clientY);
  }

  /** Turns by degrees: to the right and up on the window. */
  turn(right, up) {
    const { stage } = this;
    stage.flight = null;
    const pose = stage.pose;
    const lowest = Math.min(0, stage.scene.camera.elevation);
    stage.pose = {
      ...pose,
      azimuth: (((pose.azimuth + right) % 360) + 360) % 360,
      elevation: clamp(pose.elevation + up, [lowest, ELEVATIONS[1]]),
    };
    stage.ask();
  }

  pan(dx, dy) {
    const { stage } = this;
    stage.flight = null;
    const width = stage.compare === "pair" ? stage.width / 2 : stage.width;
    const pan = [stage.pose.pan[0] + dx / width, stage.pose.pan[1] + dy / stage.height];
    stage.pose = { ...stage.pose, pan: pan.map((part) => clamp(part, [-4, 4])) };
    stage.ask();
  }

  /** Zooms about a place of the page. */
  zoom(factor, x = null, y = null) {
    const { stage } = this;
    stage.flight = null;
    const pose = stage.pose;
    const next = clamp(pose.zoom * factor, ZOOMS);
    const change = next / pose.zoom;
    const pan = [...pose.pan];
    if (x !== null) {
      const bounds = this.surface.getBoundingClientRect();
      const width = stage.compare === "pair" ? stage.width / 2 : stage.width;
      const at = [((x - bounds.left) % width) / width - 0.5, (y - bounds.top) / stage.height - 0.5];
      at.forEach((part, n) => (pan[n] = part + (pan[n] - part) * change));
    }
    stage.pose = { ...pose, zoom: next, pan };
    stage.ask();
  }

  /** What a key does; whether it does anything. */
  key(event) {
    const steps = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };
    if (steps[event.key]) {
      const [right, up] = steps[event.key];
      if (event.shiftKey) this.pan(-right * 40, up * 40);
      else this.turn(-right * STEP_DEG, up * STEP_DEG);
    } else if (event.key === "+" || event.key === "=") this.zoom(1.15);
    else if (event.key === "-" || event.key === "_") this.zoom(1 / 1.15);
    else if (event.key === "Home" || event.key === "0") this.reset();
    else return false;
    return true;
  }
}
