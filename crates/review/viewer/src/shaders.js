// What faces and surfaces look like. Colours are mixed as they are encoded (sRGB), as in Petroglyph's own pictures.

/** Diagonal lines over what was not picked. */
const HATCH = `
uniform float hatch;
uniform float pixel;
vec3 hatched(vec3 colour, float unsure) {
  if (hatch < 0.5 || unsure < 0.5) return colour;
  float place = mod((gl_FragCoord.x + gl_FragCoord.y) / pixel, 8.0);
  float line = smoothstep(0.0, 0.8, place) * (1.0 - smoothstep(1.4, 2.2, place));
  return mix(mix(colour, vec3(1.0), 0.22), vec3(0.14, 0.12, 0.11), line * 0.6);
}`;

export const faceVertex = `
uniform vec3 origin, uAxis, vAxis;
varying vec2 place;
void main() {
  vec3 off = position - origin;
  place = vec2(dot(off, uAxis), dot(off, vAxis));
  gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
}`;

export const faceFragment = `
uniform sampler2D illustrated, raw, layers, map;
uniform vec2 nodes;
uniform float blend, wipe, highlight, opacity, hasIllustration, hasRaw;
uniform vec4 noData;
varying vec2 place;
${HATCH}
void main() {
  vec2 at = clamp(place, 0.0, 1.0);
  // Values lie on nodes from corner to corner, pictures on texels.
  vec2 node = (at * (nodes - 1.0) + 0.5) / nodes;
  vec3 colour = texture2D(illustrated, at, -0.7).rgb;
  float share = wipe < 0.0 ? blend : step(wipe, gl_FragCoord.x);
  if (hasIllustration < 0.5) share = 1.0;
  if (hasRaw > 0.5 && share > 0.0) {
    vec2 value = texture2D(raw, node).rg;
    // Red is the value times green, green is 1 where there is one.
    vec3 known = texture2D(map, vec2((value.r / max(value.g, 0.004) * 255.0 + 0.5) / 256.0, 0.5)).rgb;
    bool missing = value.g < 0.5;
    vec3 shown = missing ? noData.rgb : known;
    colour = mix(colour, shown, missing && hasIllustration > 0.5 ? share * noData.a : share);
  }
  vec2 rock = texture2D(layers, node).rg;
  colour = hatched(colour, rock.g);
  float layer = floor(rock.r * 255.0 + 0.5);
  if (highlight > 0.5 && abs(layer - highlight) > 0.5) colour = mix(colour, vec3(0.975, 0.97, 0.96), 0.8);
  gl_FragColor = vec4(colour, opacity);
}`;

export const surfaceVertex = `
attribute float unsure;
varying vec3 voxel;
varying vec3 seen;
varying float doubt;
void main() {
  voxel = position;
  doubt = unsure;
  vec4 eye = modelViewMatrix * vec4(position, 1.0);
  seen = eye.xyz;
  gl_Position = projectionMatrix * eye;
}`;

export const surfaceFragment = `
uniform vec3 colour, low, high;
uniform float opacity;
varying vec3 voxel;
varying vec3 seen;
varying float doubt;
${HATCH}
void main() {
  if (any(lessThan(voxel, low - 0.01)) || any(greaterThan(voxel, high + 0.01))) discard;
  vec3 normal = normalize(cross(dFdx(seen), dFdy(seen)));
  float light = abs(dot(normal, normalize(vec3(-0.45, 0.7, 0.55))));
  vec3 shown = mix(colour * 0.62, mix(colour, vec3(1.0), 0.28), light);
  gl_FragColor = vec4(hatched(shown, doubt), opacity);
}`;
