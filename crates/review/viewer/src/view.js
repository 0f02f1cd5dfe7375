// The camera, fitted to a block and a window as Petroglyph's own renderer fits it (crates/render/src/camera.rs), so that a
// scene looks here as it does in a drawn picture.

import { Matrix4, OrthographicCamera, PerspectiveCamera, Vector3 } from "three";

const radians = (degrees) => (degrees * Math.PI) / 180;

/** From voxels to metres of the display: X east, Y north, Z up, exaggerated, from the middle of the block. */
export function displayFromVoxel(geometry, low, high, exaggeration) {
  const m = geometry.metric;
  const matrix = new Matrix4().set(
    m[0], m[3], m[6], 0,
    m[1], m[4], m[7], 0,
    -exaggeration * m[2], -exaggeration * m[5], -exaggeration * m[8], 0,
    0, 0, 0, 1,
  );
  const centre = new Vector3().addVectors(new Vector3(...low), new Vector3(...high)).multiplyScalar(-0.5);
  return matrix.multiply(new Matrix4().makeTranslation(centre.x, centre.y, centre.z));
}

/** A fitted camera for a window of so many pixels. `pose` is a scene's camera with its box and exaggeration. */
export class View {
  constructor(geometry, pose, width, height) {
    this.width = width;
    this.height = height;
    this.matrix = displayFromVoxel(geometry, pose.low, pose.high, pose.exaggeration);
    const [sinA, cosA] = [Math.sin(radians(pose.azimuth)), Math.cos(radians(pose.azimuth))];
    const [sinH, cosH] = [Math.sin(radians(pose.elevation)), Math.cos(radians(pose.elevation))];
    this.forward = new Vector3(sinA * cosH, cosA * cosH, -sinH);
    this.right = new Vector3(cosA, -sinA, 0);
    this.up = new Vector3().crossVectors(this.right, this.forward);
    const corners = [];
    for (let n = 0; n < 8; n++) {
      const pick = (axis) => ((n >> axis) & 1 ? pose.high : pose.low)[axis];
      corners.push(new Vector3(pick(0), pick(1), pick(2)).applyMatrix4(this.matrix));
    }
    this.radius = Math.max(...corners.map((corner) => corner.length()));
    this.isPerspective = pose.fov !== null;
    this.distance = this.isPerspective
      ? (this.radius / Math.sin(radians(pose.fov) / 2)) * 1.0001
      : this.radius * 1.01;
    const flat = corners.map((corner) => this.flatten(corner));
    const low = [Math.min(...flat.map((p) => p[0])), Math.min(...flat.map((p) => p[1]))];
    const high = [Math.max(...flat.map((p) => p[0])), Math.max(...flat.map((p) => p[1]))];
    const border = 2 * pose.margin * Math.min(width, height);
    const fit = (side, axis) => (side - border) / Math.max(high[axis] - low[axis], 1e-12);
    this.scale = Math.min(fit(width, 0), fit(height, 1)) * pose.zoom;
    this.centre = pose.target
      ? this.flatten(new Vector3(...pose.target).applyMatrix4(this.matrix))
      : [(low[0] + high[0]) / 2, (low[1] + high[1]) / 2];
    this.centrePx = [width * (0.5 + pose.pan[0]), height * (0.5 + pose.pan[1])];
    this.camera = this.build();
  }

  /** Right and up of a place of the display, metres or tangents. */
  flatten(place) {
    const flat = [place.dot(this.right), place.dot(this.up)];
    if (!this.isPerspective) return flat;
    const depth = Math.max(place.dot(this.forward) + this.distance, 1e-9);
    return [flat[0] / depth, flat[1] / depth];
  }

  build() {
    const left = this.centre[0] - this.centrePx[0] / this.scale;
    const right = this.centre[0] + (this.width - this.centrePx[0]) / this.scale;
    const top = this.centre[1] + this.centrePx[1] / this.scale;
    const bottom = this.centre[1] - (this.height - this.centrePx[1]) / this.scale;
    const reach = this.radius * 1.2;
    const camera = this.isPerspective ? new PerspectiveCamera() : new OrthographicCamera();
    camera.near = this.isPerspective ? Math.max(this.distance - reach, this.distance * 0.02) : this.distance - reach;
    camera.far = this.distance + reach;
    const ends = [camera.near, camera.far];
    if (this.isPerspective) {
      const sides = [left, right, top, bottom].map((side) => side * camera.near);
      camera.projectionMatrix.makePerspective(...sides, ...ends);
    } else {
      camera.projectionMatrix.makeOrthographic(left, right, top, bottom, ...ends);
    }
    camera.projectionMatrixInverse.copy(camera.projectionMatrix).invert();
    const back = this.forward.clone().negate();
    camera.matrixAutoUpdate = false;
    camera.matrix.makeBasis(this.right, this.up, back).setPosition(back.multiplyScalar(this.distance));
    camera.updateMatrixWorld(true);
    return camera;
  }

  /** Pixels of a place in voxels. */
  project(voxel) {
    const flat = this.flatten(new Vector3(...voxel).applyMatrix4(this.matrix));
    return [
      this.centrePx[0] + (flat[0] - this.centre[0]) * this.scale,
      this.centrePx[1] - (flat[1] - this.centre[1]) * this.scale,
    ];
  }
}

/** A pose of a scene: its camera, box and exaggeration in one. */
export function poseOf(scene) {
  return { ...scene.camera, pan: [...scene.camera.pan], low: scene.low, high: scene.high, exaggeration: scene.exaggeration };
}

/** A pose between two, the short way around. */
export function between(from, to, share) {
  const mix = (a, b) => a + (b - a) * share;
  const turn = ((((to.azimuth - from.azimuth) % 360) + 540) % 360) - 180;
  const target = from.target && to.target ? from.target.map((a, n) => mix(a, to.target[n])) : to.target;
  return {
    ...to,
    azimuth: from.azimuth + turn * share,
    elevation: mix(from.elevation, to.elevation),
    zoom: Math.exp(mix(Math.log(from.zoom), Math.log(to.zoom))),
    pan: [mix(from.pan[0], to.pan[0]), mix(from.pan[1], to.pan[1])],
    margin: mix(from.margin, to.margin),
    exaggeration: mix(from.exaggeration, to.exaggeration),
    low: from.low.map((a, n) => mix(a, to.low[n])),
    high: from.high.map((a, n) => mix(a, to.high[n])),
    fov: share < 0.5 ? from.fov : to.fov,
    target,
  };
}
