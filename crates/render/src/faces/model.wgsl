// Which layer and fault block a voxel position lies in: the twin of `StructuralModel::region_at`.
//
// Sheets and fault surfaces are height fields, evaluated as `HeightField` does: Catmull–Rom bicubic
// interpolation through the nodes.
//
// Loops with an expensive body test at the end. The software driver executes both sides of every branch, and
// if the test comes first it executes the body once more than needed.

struct SheetInfo {
    // Voxel (or fault cell) position of node (0, 0).
    origin: vec2<i32>,
    size: vec2<u32>,
    // First node in the pool.
    offset: u32,
    // Where the pool holds the level field of a horizon that is no height field, else NONE. Its surface is where the
    // field has the value `at`; one unit of the field is about `scale_m` metres.
    level: u32,
    at: f32,
    scale_m: f32,
}

// A fault as w = g(u, v). Each row gives one of u, v (cells) and w (m) from (x, y, z, 1) relative to
// `model.centre`.
struct FaultInfo {
    u: vec4<f32>,
    v: vec4<f32>,
    w: vec4<f32>,
    surface: SheetInfo,
}

struct ModelInfo {
    // Voxel position that fault frames are relative to; w unused.
    centre: vec4<f32>,
    horizons: u32,
    blocks: u32,
    faults: u32,
    layers: u32,
    // 1 / (Nx − 1), 1 / (Ny − 1).
    unit_from_voxel: vec2<f32>,
    padding_0: f32,
    padding_1: f32,
}

@group(3) @binding(0) var<uniform> model: ModelInfo;
// Index horizon · blocks + block.
@group(3) @binding(1) var<storage, read> sheets: array<SheetInfo>;
@group(3) @binding(2) var<storage, read> faults: array<FaultInfo>;
// Blocks first: side bits (low, high) and care bits (low, high). Then horizons: contact in x.
@group(3) @binding(3) var<storage, read> rules: array<vec4<u32>>;
// One address space of floats over two buffers, because a binding may be limited to 128 MiB.
@group(3) @binding(4) var<storage, read> pool_0: array<f32>;
@group(3) @binding(5) var<storage, read> pool_1: array<f32>;

// Number of floats in the first buffer of the pool.
override pool_chunk: u32 = 0xffffffffu;
override pool_chunks: u32 = 1u;

// 1 if the model has any.
override has_faults: u32 = 1u;
override has_horizons: u32 = 1u;

const CONTACT_EROSIONAL: u32 = 1u;
const CONTACT_INTRUSIVE: u32 = 3u;
const CONTACT_TRUNCATED: u32 = 4u;

fn pool(index: u32) -> f32 {
    if pool_chunks == 1u || index < pool_chunk {
        return pool_0[index];
    }
    return pool_1[index - pool_chunk];
}

fn cubic_weights(t: f32) -> vec4<f32> {
    let t2 = t * t;
    let t3 = t2 * t;
    return 0.5 * vec4(-t3 + 2.0 * t2 - t, 3.0 * t3 - 5.0 * t2 + 2.0, -3.0 * t3 + 4.0 * t2 + t, t3 - t2);
}

fn cubic_slopes(t: f32) -> vec4<f32> {
    let t2 = t * t;
    return 0.5 * vec4(-3.0 * t2 + 4.0 * t - 1.0, 9.0 * t2 - 10.0 * t, -9.0 * t2 + 8.0 * t + 1.0, 3.0 * t2 - 2.0 * t);
}

// First node of the 4 × 4 patch around a position. Grids are padded on upload to cover the volume; the clamp
// only guards against positions outside it.
fn patch_start(info: SheetInfo, cell: vec2<f32>) -> u32 {
    let corner = clamp(vec2<i32>(cell) - 1 - info.origin, vec2(0), vec2<i32>(info.size) - 4);
    return info.offset + u32(corner.x) * info.size.y + u32(corner.y);
}

fn patch_row(start: u32) -> vec4<f32> {
    return vec4(pool(start), pool(start + 1u), pool(start + 2u), pool(start + 3u));
}

fn sheet_z(info: SheetInfo, at: vec2<f32>) -> f32 {
    let cell = floor(at);
    let f = at - cell;
    let start = patch_start(info, cell);
    let wx = cubic_weights(f.x);
    let wy = cubic_weights(f.y);
    var z = 0.0;
    for (var a = 0u; a < 4u; a += 1u) {
        z += dot(patch_row(start + a * info.size.y), wy) * wx[a];
    }
    return z;
}

// Height (x) and slopes along x and y (yz).
fn sheet_sample(info: SheetInfo, at: vec2<f32>) -> vec3<f32> {
    let cell = floor(at);
    let f = at - cell;
    let start = patch_start(info, cell);
    let wx = cubic_weights(f.x);
    let wy = cubic_weights(f.y);
    let sx = cubic_slopes(f.x);
    let sy = cubic_slopes(f.y);
    var result = vec3(0.0);
    for (var a = 0u; a < 4u; a += 1u) {
        let row = patch_row(start + a * info.size.y);
        let along = dot(row, wy);
        result += vec3(along * wx[a], along * sx[a], dot(row, sy) * wx[a]);
    }
    return result;
}

// Signed offset of a voxel position from an extended fault surface, m.
fn fault_side(fault: u32, p: vec3<f32>) -> f32 {
    let q = vec4(p - model.centre.xyz, 1.0);
    let info = faults[fault];
    return dot(info.w, q) - sheet_z(info.surface, vec2(dot(info.u, q), dot(info.v, q)));
}

fn block_of(bits: vec2<u32>) -> u32 {
    var best = 0u;
    var least = 0xffffffffu;
    for (var b = 0u; b < model.blocks; b += 1u) {
        let signature = rules[b];
        let different = countOneBits((signature.xy ^ bits) & signature.zw);
        let difference = different.x + different.y;
        if difference < least {
            least = difference;
            best = b;
        }
    }
    return best;
}

fn with_bit(bits: vec2<u32>, n: u32) -> vec2<u32> {
    if n < 32u {
        return bits | vec2(1u << n, 0u);
    }
    return bits | vec2(0u, 1u << (n - 32u));
}

fn has_bit(bits: vec2<u32>, n: u32) -> bool {
    return (select(bits.y >> (n & 31u), bits.x >> (n & 31u), n < 32u) & 1u) == 1u;
}

fn block_at(p: vec3<f32>) -> u32 {
    var bits = vec2(0u);
    if has_faults == 1u {
        var f = 0u;
        loop {
            if fault_side(f, p) >= 0.0 {
                bits = with_bit(bits, f);
            }
            continuing {
                f += 1u;
                break if f >= model.faults;
            }
        }
    }
    return block_of(bits);
}

// The layer of a point; bit h says that the point lies at or below the sheet of horizon h. The twin of
// `ContactRules::layer`.
fn layer_of(below: vec2<u32>) -> u32 {
    let n = model.horizons;
    var is_eroded = false;
    for (var h = 0u; h < n; h += 1u) {
        let contact = rules[model.blocks + h].x;
        if contact == CONTACT_EROSIONAL {
            is_eroded = is_eroded || !has_bit(below, h);
        } else if has_bit(below, h) && (contact == CONTACT_INTRUSIVE || contact == CONTACT_TRUNCATED && !is_eroded) {
            return n - 1u - h;
        }
    }
    var layer = n;
    for (var up = 0u; up < n; up += 1u) {
        let h = n - 1u - up;
        let contact = rules[model.blocks + h].x;
        if contact == CONTACT_INTRUSIVE || contact == CONTACT_TRUNCATED {
            continue;
        }
        if has_bit(below, h) {
            if layer == n {
                layer = n - 1u - h;
            }
        } else if contact == CONTACT_EROSIONAL {
            layer = n;
        }
    }
    return layer;
}

fn layer_at(p: vec3<f32>, block: u32) -> u32 {
    var below = vec2(0u);
    if has_horizons == 1u {
        var h = 0u;
        loop {
            if is_below(h * model.blocks + block, p) {
                below = with_bit(below, h);
            }
            continuing {
                h += 1u;
                break if h >= model.horizons;
            }
        }
    }
    return layer_of(below);
}

// Whether a voxel position lies at or below an unclipped horizon, on its older side, or in a body.
fn is_below(sheet: u32, p: vec3<f32>) -> bool {
    if has_levels == 1u {
        let info = sheets[sheet];
        if info.level != NONE {
            return level_sample(info.level, p).w >= info.at;
        }
    }
    return p.z >= sheet_z(sheets[sheet], p.xy);
}
