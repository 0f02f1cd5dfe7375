// The colour of a point on a cut face: the twin of `ttf::shade` (P-illus 4, figure 7) and of `ttf::FaceFrame`
// for the planes of the block.

struct TtfGlobals {
    no_data: vec4<f32>,
    raw_domain: vec2<f32>,
    blend: f32,
    global_frequency: f32,
    aspect_j: f32,
    raw_volume: u32,
    scalar_count: u32,
    stop_count: u32,
    finer_share: f32,
    extent_i_m: f32,
    padding_0: u32,
    padding_1: u32,
}

// How much denser the finer of two patterns is that are dissolved into one another: `ttf::FINER`.
const FINER: f32 = 1.1892071;

struct LayerEntry {
    colour: vec4<f32>,
    frequency: vec2<f32>,
    first_interval: u32,
    interval_count: u32,
    // Metres that k in [0, 1] stands for.
    thickness_m: f32,
    is_sized: u32,
    padding_0: u32,
    padding_1: u32,
}

struct IntervalEntry {
    colour: vec4<f32>,
    ink: vec4<f32>,
    k: vec2<f32>,
    frequency: vec2<f32>,
    texture: u32,
    // Three numbers, since a vec3 would be aligned to 16 bytes.
    is_sized: u32,
    padding_0: u32,
    padding_1: u32,
}

struct ScalarEntry {
    colour: vec4<f32>,
    ink: vec4<f32>,
    range: vec2<f32>,
    factor: vec2<f32>,
    texture: u32,
    volume: u32,
    opacity: f32,
    padding: u32,
}

struct StopEntry {
    colour: vec4<f32>,
    at: f32,
    padding_0: f32,
    padding_1: f32,
    padding_2: f32,
}

@group(1) @binding(2) var<uniform> ttf: TtfGlobals;
@group(1) @binding(3) var<storage, read> layers: array<LayerEntry>;
@group(1) @binding(4) var<storage, read> intervals: array<IntervalEntry>;
@group(1) @binding(5) var<storage, read> scalar_entries: array<ScalarEntry>;
@group(1) @binding(6) var<storage, read> stops: array<StopEntry>;

// 1 if raw data are blended in; 1 if there are scalar textures.
override with_raw: u32 = 1u;
override with_scalars: u32 = 1u;

const NONE: u32 = 0xffffffffu;
const MAP_ONLY_CALMNESS_SQ: f32 = 0.25;
const NO_MAP_CALMNESS_SQ: f32 = 0.36;
const MAP_RATHER_SQ: f32 = 0.8;
const ACROSS_ONLY_SHARE: f32 = 0.35;
const ALONG_ONLY_SHARE: f32 = 0.65;

// A point of a face in flat space, and how flat space changes there.
struct ShadePoint {
    ijk: vec3<f32>,
    // Change of (i, j, k) per sample step to the right and down the image.
    dx: vec3<f32>,
    dy: vec3<f32>,
    // The same for a metre along two perpendicular directions of the face.
    metre_p: vec3<f32>,
    metre_q: vec3<f32>,
    // Gradient of k in metric space.
    grad_k: vec3<f32>,
    layer: u32,
    // 1 if (i, j, k) are defined.
    defined: u32,
}

// The mappings of a face (along, across, map) with their weights.
struct Mappings {
    weights: vec3<f32>,
    // Horizontal direction t in the face, and what is added to u along it.
    along: vec2<f32>,
    shift: f32,
}

fn unit_or_zero(v: vec3<f32>) -> vec3<f32> {
    let length_sq = dot(v, v);
    if length_sq > 0.0 && length_sq < 3e38 {
        return v * (1.0 / sqrt(length_sq));
    }
    return vec3(0.0);
}

// How calm a mapping is, from the derivatives of u (xy) and v (zw) over the face, in nominal metres for a metre: the twin of
// `ttf::Stretch::calmness`.
fn calmness(change: vec4<f32>) -> f32 {
    let sum = 0.5 * length(vec2(change.x + change.w, change.z - change.y));
    let difference = 0.5 * length(vec2(change.x - change.w, change.z + change.y));
    let densest = sum + difference;
    let sparsest = abs(sum - difference);
    let area = densest * sparsest;
    if densest > 0.0 && area > 0.0 && area < 3e38 {
        return min(min(sparsest / densest, area), 1.0 / area);
    }
    return 0.0;
}

fn face_mappings(plane: u32, point: ShadePoint, thickness_m: f32) -> Mappings {
    let info = params.planes[plane];
    var mappings: Mappings;
    mappings.along = info.along;
    mappings.shift = info.shift;
    let n = info.metric_normal.xyz;
    let g = unit_or_zero(point.grad_k);
    if all(g == vec3(0.0)) {
        mappings.weights = vec3(1.0, 0.0, 0.0);
        return mappings;
    }
    let s = cross(n, g);
    let along_t = s.x * mappings.along.x + s.y * mappings.along.y;
    let across_t = s.y * mappings.along.x - s.x * mappings.along.y;
    let horizontal_sq = along_t * along_t + across_t * across_t;
    var share = 1.0;
    if horizontal_sq > 1e-12 {
        share = along_t * along_t / horizontal_sq;
    }
    share = smoothstep(ACROSS_ONLY_SHARE, ALONG_ONLY_SHARE, share);
    let rate = thickness_m * vec2(point.metre_p.z, point.metre_q.z);
    var over_k = dot(rate, rate);
    if !(over_k <= 1.0) {
        over_k = max(dot(s, s), 1.0 / over_k);
    }
    let p = ttf.extent_i_m * map_flat(mappings, 2u, point.metre_p);
    let q = ttf.extent_i_m * map_flat(mappings, 2u, point.metre_q);
    let on_map = calmness(vec4(p.x, q.x, p.y, q.y));
    let map_sq = on_map * on_map;
    let sparse = 1.0 - smoothstep(MAP_ONLY_CALMNESS_SQ, NO_MAP_CALMNESS_SQ, over_k);
    var map = 0.0;
    if map_sq > 0.0 {
        map = sparse * (1.0 - smoothstep(MAP_RATHER_SQ, 1.0, over_k / map_sq));
    }
    let along = (1.0 - map) * share;
    mappings.weights = vec3(along, max(1.0 - map - along, 0.0), map);
    return mappings;
}

// Texture coordinates of a flat vector, without the shift, under mapping 0 (along), 1 (across) or 2 (map), before frequencies.
fn map_flat(mappings: Mappings, mapping: u32, flat: vec3<f32>) -> vec2<f32> {
    let i = flat.x;
    let j = flat.y * ttf.aspect_j;
    let t = mappings.along;
    let along = t.x * i + t.y * j;
    let across = -t.y * i + t.x * j;
    if mapping == 0u {
        return vec2(along, flat.z);
    }
    if mapping == 1u {
        return vec2(across, flat.z);
    }
    return vec2(along, across);
}

// A texture at a frequency, dissolved into the finer one.
fn sample_mapped(texture: u32, frequency: vec2<f32>, point: ShadePoint, mappings: Mappings) -> vec4<f32> {
    let scale = frequency * ttf.global_frequency;
    let coarse = sample_scaled(texture, scale, point, mappings);
    if ttf.finer_share <= 0.0 {
        return coarse;
    }
    let fine = sample_scaled(texture, scale * FINER, point, mappings);
    return coarse + ttf.finer_share * (fine - coarse);
}

fn sample_scaled(texture: u32, scale: vec2<f32>, point: ShadePoint, mappings: Mappings) -> vec4<f32> {
    var sum = vec4(0.0);
    // One round per mapping with a weight: usually one.
    var left = mappings.weights;
    loop {
        let mapping = select(select(2u, 1u, left.y > 0.0), 0u, left.x > 0.0);
        let weight = left[mapping];
        left[mapping] = 0.0;
        let factor = select(scale, scale.xx, mapping == 2u);
        sum += weight * sample_texture(
            texture,
            (map_flat(mappings, mapping, point.ijk) + vec2(select(mappings.shift, 0.0, mapping == 1u), 0.0)) * factor,
            map_flat(mappings, mapping, point.dx) * factor,
            map_flat(mappings, mapping, point.dy) * factor,
        );
        continuing {
            break if all(left <= vec3(0.0));
        }
    }
    return sum;
}

fn inked(texel: vec4<f32>, ink: vec4<f32>) -> vec4<f32> {
    return vec4(texel.rgb + (ink.rgb * texel.a - texel.rgb) * ink.a, texel.a);
}

fn on_background(texel: vec4<f32>, background: vec4<f32>) -> vec4<f32> {
    let rest = (1.0 - texel.a) * background.a;
    return vec4(texel.rgb + background.rgb * rest, texel.a + rest);
}

fn over(bottom: vec3<f32>, top: vec4<f32>, opacity: f32) -> vec3<f32> {
    return top.rgb * opacity + bottom * (1.0 - top.a * opacity);
}

// The entry of the interval table that covers k in a layer, or NONE.
fn interval_at(layer: LayerEntry, k: f32) -> u32 {
    for (var n = layer.first_interval; n < layer.first_interval + layer.interval_count; n += 1u) {
        if k >= intervals[n].k.x && k < intervals[n].k.y {
            return n;
        }
    }
    return NONE;
}

fn raw_colour(value: f32) -> vec4<f32> {
    let t = clamp((value - ttf.raw_domain.x) / (ttf.raw_domain.y - ttf.raw_domain.x), 0.0, 1.0);
    var colour = stops[0].colour;
    for (var n = 0u; n + 1u < ttf.stop_count; n += 1u) {
        if t >= stops[n].at {
            let span = stops[n + 1u].at - stops[n].at;
            var fraction = 1.0;
            if span > 0.0 {
                fraction = min((t - stops[n].at) / span, 1.0);
            }
            colour = stops[n].colour + (stops[n + 1u].colour - stops[n].colour) * fraction;
        }
    }
    return colour;
}

// Blends an illustrated colour with the raw colour at a voxel position.
fn blend_raw(colour: vec3<f32>, p: vec3<f32>) -> vec3<f32> {
    if with_raw == 0u {
        return colour;
    }
    let value = sample_volume(ttf.raw_volume, p);
    if is_no_data(value) {
        return colour + (ttf.no_data.rgb - colour) * (ttf.no_data.a * ttf.blend);
    }
    return colour + (raw_colour(value).rgb - colour) * ttf.blend;
}

// The colour of a point of a face of constant x, y or z at voxel position p.
fn shade(point: ShadePoint, plane: u32, p: vec3<f32>) -> vec3<f32> {
    let layer = layers[point.layer];
    var colour = layer.colour.rgb;
    var frequency = layer.frequency;
    if point.defined == 1u {
        let mappings = face_mappings(plane, point, layer.thickness_m);
        let covering = interval_at(layer, point.ijk.z);
        if covering != NONE {
            let interval = intervals[covering];
            frequency = interval.frequency;
            let ink = inked(sample_mapped(interval.texture, frequency, point, mappings), interval.ink);
            colour = over(interval.colour.rgb, ink, interval.colour.a);
        }
        if with_scalars == 1u {
            var n = 0u;
            loop {
                let entry = scalar_entries[n];
                let value = sample_volume(entry.volume, p);
                if !is_no_data(value) && value >= entry.range.x && value < entry.range.y {
                    let ink = inked(sample_mapped(entry.texture, frequency * entry.factor, point, mappings), entry.ink);
                    colour = over(colour, on_background(ink, entry.colour), entry.opacity);
                }
                continuing {
                    n += 1u;
                    break if n >= ttf.scalar_count;
                }
            }
        }
    }
    return blend_raw(colour, p);
}

// The opaque average colour of a layer at k: the colour of the ground above it (P-illus 5).
fn average_colour(layer_index: u32, k: f32) -> vec3<f32> {
    let layer = layers[layer_index];
    let covering = interval_at(layer, k);
    if covering == NONE {
        return layer.colour.rgb;
    }
    let interval = intervals[covering];
    let mean = texture_infos[interval.texture].mean;
    return over(interval.colour.rgb, inked(mean, interval.ink), interval.colour.a);
}
