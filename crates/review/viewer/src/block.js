// The block as objects of three.js: faces with their pictures, lines, horizons and faults, wells.

import {
  BufferAttribute, BufferGeometry, DataTexture, DoubleSide, Group, LinearFilter, LinearMipmapLinearFilter, Mesh,
  NearestFilter, RGBAFormat, RGFormat, ShaderMaterial, Texture, UnsignedByteType, Vector2, Vector3, Vector4,
} from "three";
import { LineMaterial } from "three/examples/jsm/lines/LineMaterial.js";
import { LineSegments2 } from "three/examples/jsm/lines/LineSegments2.js";
import { LineSegmentsGeometry } from "three/examples/jsm/lines/LineSegmentsGeometry.js";
import { bytes, floats, mesh, picture, pixels, points } from "./data.js";
import { faceFragment, faceVertex, surfaceFragment, surfaceVertex } from "./shaders.js";

/** Uniforms that all faces and surfaces share. */
export function sharedUniforms(model) {
  const map = new DataTexture(model.raw ? bytes(model.raw.map) : new Uint8Array(1024), 256, 1, RGBAFormat);
  map.magFilter = map.minFilter = LinearFilter;
  map.needsUpdate = true;
  const noData = model.raw?.noData;
  return {
    blend: { value: 0 }, wipe: { value: -1 }, highlight: { value: 0 }, hatch: { value: 0 }, pixel: { value: 1 },
    opacity: { value: 1 }, map: { value: map },
    noData: { value: noData ? new Vector4(...noData, 1) : new Vector4(1, 1, 1, 0) },
  };
}

function dataTexture(array, width, height, filter) {
  const texture = new DataTexture(array, width, height, RGFormat, UnsignedByteType);
  texture.magFilter = texture.minFilter = filter;
  texture.needsUpdate = true;
  return texture;
}

/** The picture of a face: loaded when it is first shown. */
export class Cover {
  constructor(model, index, shared, anisotropy) {
    this.source = model.covers[index];
    const { origin, u, v } = this.source;
    this.uniforms = {
      ...shared,
      origin: { value: new Vector3(...origin) },
      uAxis: { value: new Vector3(...u) },
      vAxis: { value: new Vector3(...v) },
      illustrated: { value: null }, raw: { value: null }, layers: { value: null },
      nodes: { value: new Vector2(1, 1) },
      hasIllustration: { value: this.source.illustrated ? 1 : 0 },
      hasRaw: { value: model.raw ? 1 : 0 },
    };
    this.anisotropy = anisotropy;
    this.loading = null;
  }

  load() {
    this.loading ??= Promise.all([this.loadPicture(), this.loadData()]);
    return this.loading;
  }

  async loadPicture() {
    if (!this.source.illustrated) return;
    const texture = new Texture(await picture(this.source.illustrated));
    texture.flipY = false;
    texture.minFilter = LinearMipmapLinearFilter;
    texture.anisotropy = this.anisotropy;
    texture.needsUpdate = true;
    this.uniforms.illustrated.value = texture;
  }

  async loadData() {
    const { width, height, data } = await pixels(this.source.data);
    const [values, rocks] = [new Uint8Array(2 * width * height), new Uint8Array(2 * width * height)];
    for (let n = 0; n < width * height; n++) {
      values[2 * n] = data[4 * n];
      values[2 * n + 1] = data[4 * n] ? 255 : 0;
      rocks[2 * n] = data[4 * n + 1];
      rocks[2 * n + 1] = data[4 * n + 2];
    }
    this.nodes = { width, height, values, rocks };
    this.uniforms.raw.value = dataTexture(values, width, height, LinearFilter);
    this.uniforms.layers.value = dataTexture(rocks, width, height, NearestFilter);
    this.uniforms.nodes.value.set(width, height);
  }

  /** The raw byte (0 = none), layer (from 1, 0 = none) and doubt at a place in voxels. */
  at(voxel) {
    if (!this.nodes) return null;
    const { width, height, values, rocks } = this.nodes;
    const { origin, u, v } = this.source;
    const share = (axis) => axis.reduce((sum, part, n) => sum + part * (voxel[n] - origin[n]), 0);
    const node = (part, count) => Math.round(Math.min(Math.max(part, 0), 1) * (count - 1));
    const n = node(share(v), height) * width + node(share(u), width);
    return { value: values[2 * n], layer: rocks[2 * n], unsure: rocks[2 * n + 1] > 0 };
  }
}

function geometryOf({ corners, indices }) {
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(corners, 3));
  geometry.setIndex(new BufferAttribute(indices, 1));
  return geometry;
}

/** A part of the block with its picture. */
export function faceMesh(geometry, uniforms, cover, name) {
  const material = new ShaderMaterial({
    uniforms, vertexShader: faceVertex, fragmentShader: faceFragment, side: DoubleSide,
    // Lines lie in the faces: faces stand back a little.
    polygonOffset: true, polygonOffsetFactor: 2, polygonOffsetUnits: 4,
  });
  const object = new Mesh(geometry, material);
  Object.assign(object, { name, matrixAutoUpdate: false });
  object.userData.cover = cover;
  return object;
}

/** The rectangle of a section with its lines. */
export function sectionGroup(cover, place, scene) {
  const group = new Group();
  group.matrixAutoUpdate = false;
  group.add(sectionMesh(cover), ...strokes([place], scene));
  return group;
}

function sectionMesh(cover) {
  const { origin, s, t } = cover.source;
  const add = (...parts) => origin.map((part, n) => parts.reduce((sum, other) => sum + other[n], part));
  const corners = new Float32Array([origin, add(s), add(s, t), add(t)].flat());
  // A section stays opaque where the block is clear.
  const uniforms = { ...cover.uniforms, opacity: { value: 1 } };
  return faceMesh(geometryOf({ corners, indices: new Uint16Array([0, 1, 2, 0, 2, 3]) }), uniforms, cover, "section");
}

/** Straight pieces as lines of a width in pixels. */
export function lines(ends, { width, colour }) {
  if (ends.length < 6 || width <= 0) return null;
  const geometry = new LineSegmentsGeometry();
  geometry.setPositions(ends);
  // Voxels are mirrored in the display, lines are not: both sides are drawn.
  const material = new LineMaterial({ color: colour, linewidth: width, side: DoubleSide });
  const object = new LineSegments2(geometry, material);
  object.matrixAutoUpdate = false;
  object.userData.width = width;
  return object;
}

function joined(arrays) {
  const all = new Float32Array(arrays.reduce((sum, array) => sum + array.length, 0));
  let at = 0;
  for (const array of arrays) {
    all.set(array, at);
    at += array.length;
  }
  return all;
}

/** The lines of sources, those that were not picked marked as doubtful. */
function strokes(sources, scene) {
  const kinds = [
    ["horizons", scene.lines], ["unpicked", scene.lines], ["faults", scene.faults], ["edges", scene.edges],
  ];
  const objects = kinds.map(([kind, stroke]) => {
    const object = lines(joined(sources.map((source) => points(source[kind]))), stroke);
    if (object) {
      object.userData.isDoubtful = kind === "unpicked";
      object.renderOrder = 2;
    }
    return object;
  });
  return objects.filter(Boolean);
}

/** The faces and lines of a block, which is made of some sources. */
export async function blockGroup(sources, scene, covers) {
  const group = new Group();
  group.matrixAutoUpdate = false;
  const faces = sources.flatMap((source) => source.faces);
  for (const face of faces) group.add(faceMesh(geometryOf(mesh(face.mesh)), covers[face.cover].uniforms, covers[face.cover], face.name));
  const drawn = strokes(sources, scene);
  if (drawn.length) group.add(...drawn);
  await Promise.all(faces.map((face) => covers[face.cover].load()));
  return group;
}

/** A horizon or fault. */
export function surfaceMesh(surface, shared) {
  const source = mesh(surface.mesh);
  const geometry = geometryOf(source);
  const unsure = surface.unsure ? bytes(surface.unsure) : new Uint8Array(source.corners.length / 3);
  geometry.setAttribute("unsure", new BufferAttribute(unsure, 1, true));
  const colour = Number.parseInt(surface.colour.slice(1), 16);
  const material = new ShaderMaterial({
    uniforms: {
      hatch: shared.hatch, pixel: shared.pixel, opacity: { value: 1 },
      colour: { value: new Vector3((colour >> 16) / 255, ((colour >> 8) & 255) / 255, (colour & 255) / 255) },
      low: { value: new Vector3() }, high: { value: new Vector3() },
    },
    vertexShader: surfaceVertex, fragmentShader: surfaceFragment, side: DoubleSide,
    polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1,
  });
  const object = new Mesh(geometry, material);
  Object.assign(object, { name: surface.name, matrixAutoUpdate: false, visible: false });
  object.userData.surface = surface;
  return object;
}

/** The path of a well, as pieces. */
export function wellLine(well, style) {
  const path = floats(well.path);
  const pieces = [];
  for (let n = 3; n < path.length; n += 3) pieces.push(...path.slice(n - 3, n + 3));
  return lines(new Float32Array(pieces), { width: 4.5, colour: style.colour });
}
