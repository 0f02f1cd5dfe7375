// The media of a scene at any point: the twin of `media::field`. Voxel space; extinction per unit of length,
// linear colours.

struct MediumInfo {
    // Value of the first entry of its table, and entries per unit of value.
    low: f32,
    scale: f32,
    slot: u32,
    // First words of its table, and of its appearance by layer (r, g, b, factor on the opacity; NONE: layers
    // do not change it).
    table: u32,
    layers: u32,
    // 0 surroundings, 1 cut-outs.
    zone: u32,
    // 1 if layers colour it.
    coloured: u32,
    // First words and numbers of the parts of its layers by depth (NONE: no layer is divided).
    shades: u32,
}

struct MediaParams {
    // Columns of the maps from voxel to display space and from voxel to display covectors; w unused.
    display_x: vec4<f32>,
    display_y: vec4<f32>,
    display_z: vec4<f32>,
    covector_x: vec4<f32>,
    covector_y: vec4<f32>,
    covector_z: vec4<f32>,
    // Direction to the light in display space; w: shininess.
    light: vec4<f32>,
    // Ambient, diffuse, specular; w unused.
    phong: vec4<f32>,
    // Columns and shift of the map from voxels to cells and slices, see `light_grid::cells_from_voxel`;
    // shift.w = 1 in a perspective.
    cells_x: vec4<f32>,
    cells_y: vec4<f32>,
    cells_z: vec4<f32>,
    cells_shift: vec4<f32>,
    // Lower left corner in cells + ½; depth of the first slice, m; thickness of a slice, m.
    cells_low: vec4<f32>,
    // Voxel position of view coordinates (x, y) at depth d: back + d · forward + (x · right + y · up), the
    // last term times d in a perspective.
    back: vec4<f32>,
    right: vec4<f32>,
    up: vec4<f32>,
    forward: vec4<f32>,
    // Lower left corner and side of a cell in view coordinates; factor on the occlusion.
    grid: vec4<f32>,
    // Cells to the right and upwards, slices; first word of the isosurfaces.
    cells: vec4<u32>,
    // Bricks along x, y, z, and their first word.
    bricks: vec4<u32>,
    // Samples per unit of length, unit in m, distance that counts as near a horizon in voxels, voxels per
    // step of distance.
    scales: vec4<f32>,
    // Samples of the candidates along x, y, z; w: number of leaf ids that have a style.
    candidates: vec4<u32>,
    // First words of the styles by leaf and of the horizons; scope; first word of the groups by leaf (NONE:
    // each leaf is a group of its own).
    leaves: vec4<u32>,
    slice_units: f32,
    // Number of leaf ids that have a group; first word of the wells, and number of their capsules.
    groups: u32,
    wells: u32,
    capsules: u32,
    media: array<MediumInfo, 4>,
}

@group(2) @binding(7) var<uniform> media: MediaParams;
@group(2) @binding(8) var filtering: sampler;
// Texels are ordered as those of volumes: (x, y, z) is sample (z, y, x).
@group(2) @binding(9) var distances: texture_3d<f32>;
@group(2) @binding(10) var leaf_ids: texture_3d<u32>;
// Emission (xyz) and λ (w) of cells; z is the front of a slice.
@group(2) @binding(11) var light_volume: texture_3d<f32>;

// Whether there are media; their shading; which faces stop a ray; how many media; whether leaves and layers
// matter; how many isosurfaces.
override with_media: u32 = 0u;
override shading: u32 = 0u;
override faces_shown: u32 = 0u;
override media_count: u32 = 0u;
override with_leaves: u32 = 0u;
override with_layers: u32 = 0u;
override isosurfaces: u32 = 0u;

const PHONG: u32 = 1u;
const OCCLUSION: u32 = 2u;
const FACES_ALL: u32 = 0u;
const FACES_CUT_OUTS: u32 = 1u;
const SURROUNDINGS: u32 = 0u;
const CUT_OUT: u32 = 1u;
const SCOPE_NEAR: u32 = 1u;
const SCOPE_AWAY: u32 = 2u;
const BRICK: f32 = 8.0;
const MIXED: u32 = 255u;
const ENTRIES: u32 = 2048u;
const OPAQUE: f32 = 1e4;
const SPENT: f32 = 1e-3;
const SOFT: f32 = 0.25;
const NO_DATA_BELOW: f32 = -1e30;
const SHADE_WORDS: u32 = 5u;
const HORIZON_WORDS: u32 = 12u;
const ISOSURFACE_WORDS: u32 = 8u;

fn word(at: u32) -> f32 {
    return bitcast<f32>(relief_map[at]);
}

fn to_linear(c: vec3<f32>) -> vec3<f32> {
    return select(pow((c + 0.055) / 1.055, vec3(2.4)), c / 12.92, c <= vec3(0.04045));
}

fn to_encoded(linear: vec3<f32>) -> vec3<f32> {
    let c = clamp(linear, vec3(0.0), vec3(1.0));
    return select(1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055, c * 12.92, c <= vec3(0.0031308));
}

fn extinction_of(opacity: f32) -> f32 {
    if opacity >= 0.9999 {
        return OPAQUE;
    }
    return -log(1.0 - max(opacity, 0.0));
}

// Value interpolated trilinearly; below NO_DATA_BELOW if there is none.
fn medium_value(slot: u32, p: vec3<f32>) -> f32 {
    let info = volume_infos[slot];
    let index = p * info.scale.xyz + info.offset.xyz;
    let last = vec3<f32>(info.size.xyz) - 1.0;
    if any(index < vec3(-SLACK)) || any(index > last + SLACK) {
        return NO_DATA;
    }
    return filtered_volume(slot, clamp(index, vec3(0.0), last), info.size.xyz);
}

fn medium_gradient(slot: u32, p: vec3<f32>) -> vec3<f32> {
    let scale = volume_infos[slot].scale.xyz;
    var difference = vec3(0.0);
    for (var axis = 0u; axis < 3u; axis += 1u) {
        var step = vec3(0.0);
        step[axis] = 1.0 / scale[axis];
        let ahead = medium_value(slot, p + step);
        let behind = medium_value(slot, p - step);
        if ahead >= NO_DATA_BELOW && behind >= NO_DATA_BELOW {
            difference[axis] = ahead - behind;
        }
    }
    return difference * 0.5 * scale;
}

fn to_display(v: vec3<f32>) -> vec3<f32> {
    return media.display_x.xyz * v.x + media.display_y.xyz * v.y + media.display_z.xyz * v.z;
}

fn lit(gradient: vec3<f32>, colour: vec3<f32>, towards: vec3<f32>) -> vec3<f32> {
    let normal =
        unit_or_zero(media.covector_x.xyz * gradient.x + media.covector_y.xyz * gradient.y + media.covector_z.xyz * gradient.z);
    let half = unit_or_zero(media.light.xyz + towards);
    let diffuse = media.phong.y * abs(dot(normal, media.light.xyz));
    let specular = media.phong.z * pow(max(abs(dot(normal, half)), 1e-6), media.light.w);
    return colour * (media.phong.x + diffuse) + vec3(specular);
}

struct Matter {
    colour: vec3<f32>,
    extinction: f32,
    emission: vec3<f32>,
}

fn table_word(info: MediumInfo, value: f32) -> u32 {
    return info.table + 4u * u32(clamp((value - info.low) * info.scale + 0.5, 0.0, f32(ENTRIES - 1u)));
}

// The colour of the part of a divided layer at a point; that of the layer where there is none.
fn shade_of(record: u32, p: vec3<f32>, layer: u32, undivided: vec3<f32>) -> vec3<f32> {
    let count = relief_map[record + 1u];
    if count == 0u {
        return undivided;
    }
    let k = flat_exact(p, layer, block_at(p)).ijk.z;
    for (var n = 0u; n < count; n += 1u) {
        let shade = relief_map[record] + SHADE_WORDS * n;
        if k >= word(shade) && k < word(shade + 1u) {
            return vec3(word(shade + 2u), word(shade + 3u), word(shade + 4u));
        }
    }
    return undivided;
}

fn of_medium(n: u32, p: vec3<f32>, brick: u32, towards: vec3<f32>) -> Matter {
    var matter: Matter;
    let info = media.media[n];
    let value = medium_value(info.slot, p);
    if value < NO_DATA_BELOW {
        return matter;
    }
    let entry = table_word(info, value);
    matter.extinction = word(entry + 3u);
    if matter.extinction <= 0.0 {
        return matter;
    }
    matter.colour = vec3(word(entry), word(entry + 1u), word(entry + 2u));
    if with_layers == 1u && info.layers != NONE {
        var layer = brick >> 16u & 255u;
        if layer == MIXED {
            layer = layer_at(p, block_at(p));
        }
        let appearance = info.layers + 4u * layer;
        let opacity = word(appearance + 3u);
        if info.coloured == 1u {
            matter.colour = vec3(word(appearance), word(appearance + 1u), word(appearance + 2u));
            if info.shades != NONE && lookup == LOOKUP_EXACT {
                matter.colour = shade_of(info.shades + 2u * layer, p, layer, matter.colour);
            }
        }
        if opacity != 1.0 {
            matter.extinction = extinction_of((1.0 - exp(-matter.extinction)) * opacity);
            if opacity == 0.0 {
                matter.extinction = 0.0;
                return matter;
            }
        }
    }
    if shading == PHONG {
        matter.colour = lit(medium_gradient(info.slot, p), matter.colour, towards);
    }
    return matter;
}

struct HorizonAt {
    colour: vec3<f32>,
    cover: f32,
    distance: f32,
    extinction: f32,
    emission: f32,
}

fn leaf_at(p: vec3<f32>) -> u32 {
    let at = min(vec3<u32>(max(p + 0.5, vec3(0.0))), media.candidates.xyz - 1u);
    return textureLoad(leaf_ids, at.zyx, 0).r;
}

// Distance to the nearest candidate, voxels. Interpolated here, since the hardware filters bytes with weights
// of 8 bits.
fn distance_at(p: vec3<f32>) -> f32 {
    let last = vec3<f32>(media.candidates.xyz) - 1.0;
    let clamped = clamp(p, vec3(0.0), last);
    let low = min(floor(clamped), max(last - 1.0, vec3(0.0)));
    let f = clamped - low;
    var sum = 0.0;
    for (var corner = 0u; corner < 8u; corner += 1u) {
        let side = vec3<u32>(corner & 1u, corner >> 1u & 1u, corner >> 2u);
        let w = select(vec3(1.0) - f, f, side == vec3(1u));
        let at = min(vec3<u32>(low) + side, media.candidates.xyz - 1u);
        sum += w.x * w.y * w.z * textureLoad(distances, at.zyx, 0).r;
    }
    return sum * 255.0 * media.scales.w;
}

fn horizon_at(p: vec3<f32>) -> HorizonAt {
    var found: HorizonAt;
    found.distance = 1e9;
    let leaf = leaf_at(p);
    if leaf == 0u || leaf >= media.candidates.w {
        return found;
    }
    let style = relief_map[media.leaves.x + leaf];
    if style == 0u {
        return found;
    }
    let record = media.leaves.y + HORIZON_WORDS * (style - 1u);
    found.distance = distance_at(p);
    found.cover = clamp((word(record + 4u) - found.distance) / (2.0 * SOFT) + 0.5, 0.0, 1.0);
    found.colour = vec3(word(record), word(record + 1u), word(record + 2u));
    found.extinction = word(record + 3u);
    found.emission = word(record + 5u);
    if relief_map[record + 10u] == 1u {
        let group = leaf_group(leaf);
        if group == 0u {
            var nothing: HorizonAt;
            nothing.distance = 1e9;
            return nothing;
        }
        var tone = 1.0;
        if found.cover > 0.0 && is_border(p) {
            tone = BORDER_TONE;
        }
        found.colour = to_linear(leaf_colour(group) * tone);
    }
    let slot = relief_map[record + 6u];
    if slot != NONE && found.cover > 0.0 {
        let value = medium_value(slot, p);
        if value > NO_DATA_BELOW {
            var paint: MediumInfo;
            paint.table = relief_map[record + 7u];
            paint.low = word(record + 8u);
            paint.scale = word(record + 9u);
            let entry = table_word(paint, value);
            found.colour = vec3(word(entry), word(entry + 1u), word(entry + 2u));
        }
    }
    return found;
}

// The fraction of a point that an isosurface covers (w), and the gradient there.
fn isosurface_at(record: u32, p: vec3<f32>) -> vec4<f32> {
    var value = 0.0;
    var gradient = vec3(0.0);
    let slot = relief_map[record + 6u];
    if slot != NONE {
        value = medium_value(slot, p);
        if value < NO_DATA_BELOW {
            return vec4(0.0);
        }
        gradient = medium_gradient(slot, p);
    } else if lookup == LOOKUP_EXACT {
        let block = block_at(p);
        let layer = layer_at(p, block);
        let flat = flat_exact(p, layer, block);
        value = f32(layer) + flat.ijk.z;
        gradient = flat.dk;
    }
    let distance = abs(value - word(record + 5u)) / max(length(gradient), 1e-12);
    return vec4(gradient, clamp((word(record + 4u) - distance) / (2.0 * SOFT) + 0.5, 0.0, 1.0));
}

// A single medium takes the same path as several: a path of its own, with early returns, crashes the software
// driver of Mesa 22.3 if faces of rock stop rays.
fn matter_at(p: vec3<f32>, zone: u32, brick: u32, towards: vec3<f32>) -> Matter {
    var horizon: HorizonAt;
    horizon.distance = 1e9;
    if with_leaves == 1u {
        horizon = horizon_at(p);
    }
    var sum: Matter;
    var rest = 1.0 - horizon.cover;
    let scope = media.leaves.z;
    let in_scope = !(scope == SCOPE_NEAR && horizon.distance > media.scales.z)
        && !(scope == SCOPE_AWAY && horizon.distance <= media.scales.z);
    for (var n = 0u; n < isosurfaces; n += 1u) {
        let record = media.cells.w + ISOSURFACE_WORDS * n;
        let surface = isosurface_at(record, p);
        if surface.w > 0.0 {
            var colour = vec3(word(record), word(record + 1u), word(record + 2u));
            if shading == PHONG {
                colour = lit(surface.xyz, colour, towards);
            }
            let kappa = word(record + 3u) * surface.w;
            sum.extinction += kappa;
            sum.colour += colour * kappa;
            rest *= 1.0 - surface.w;
        }
    }
    if rest > 0.0 && in_scope {
        for (var n = 0u; n < media_count; n += 1u) {
            if media.media[n].zone == zone {
                let one = of_medium(n, p, brick, towards);
                sum.extinction += one.extinction * rest;
                sum.colour += one.colour * (one.extinction * rest);
            }
        }
    }
    if horizon.cover > 0.0 {
        let kappa = horizon.extinction * horizon.cover;
        sum.extinction += kappa;
        sum.colour += horizon.colour * kappa;
        sum.emission = horizon.colour * (horizon.emission * kappa);
    }
    if sum.extinction > 0.0 {
        sum.colour /= sum.extinction;
        sum.emission /= sum.extinction;
    }
    return sum;
}
