// The paper's packed volume with extrapolated corners: the twin of `param::PackedVolume` (P-illus 3.3, 3.4).

struct PackedInfo {
    // Scale from voxel positions to sample indices; w unused.
    scale: vec4<f32>,
    // Counts of samples; w unused.
    size: vec4<u32>,
    i_range: vec2<f32>,
    j_range: vec2<f32>,
    layers: u32,
    blocks: u32,
    padding_0: u32,
    padding_1: u32,
}

@group(3) @binding(6) var<uniform> packed: PackedInfo;
// Texel (x, y, z) is sample (z, y, x): (i', j', k').
@group(3) @binding(7) var packed_volume: texture_3d<f32>;

struct PackedSample {
    flat: FlatSample,
    layer: u32,
}

fn packed_at(at: vec3<i32>) -> vec3<f32> {
    let inside = clamp(at, vec3(0), vec3<i32>(packed.size.xyz) - 1);
    return textureLoad(packed_volume, inside.zyx, 0).xyz;
}

fn packed_id(value: f32, count: u32) -> u32 {
    return min(u32(max(floor(value * f32(count)), 0.0)), count - 1u);
}

// Layer and block of a packed value.
fn packed_region(value: vec3<f32>) -> vec2<u32> {
    return vec2(packed_id(value.z, packed.layers), packed_id(value.y, packed.blocks));
}

fn packed_contains(at: vec3<i32>) -> bool {
    return all(at >= vec3(0)) && all(at < vec3<i32>(packed.size.xyz));
}

// Neighbours in the order +x, −x, +y, −y, +z, −z.
fn packed_direction(n: u32) -> vec3<i32> {
    var direction = vec3(0);
    direction[n >> 1u] = select(1, -1, (n & 1u) == 1u);
    return direction;
}

fn valid_corner(at: vec3<i32>, region: vec2<u32>) -> vec3<f32> {
    let own = packed_at(at);
    if all(packed_region(own) == region) {
        return own;
    }
    for (var n = 0u; n < 6u; n += 1u) {
        let direction = packed_direction(n);
        if packed_contains(at + 2 * direction) {
            let near = packed_at(at + direction);
            let far = packed_at(at + 2 * direction);
            if all(packed_region(near) == region) && all(packed_region(far) == region) {
                return 2.0 * near - far;
            }
        }
    }
    return own;
}

fn flat_packed(p: vec3<f32>) -> PackedSample {
    let last = vec3<f32>(packed.size.xyz) - 1.0;
    let at = clamp(p * packed.scale.xyz, vec3(0.0), last);
    let cell = max(min(vec3<i32>(floor(at)), vec3<i32>(packed.size.xyz) - 2), vec3(0));
    let f = at - vec3<f32>(cell);
    let region = packed_region(packed_at(cell + select(vec3(0), vec3(1), f >= vec3(0.5))));
    let c000 = valid_corner(cell, region);
    let c100 = valid_corner(cell + vec3(1, 0, 0), region);
    let c010 = valid_corner(cell + vec3(0, 1, 0), region);
    let c110 = valid_corner(cell + vec3(1, 1, 0), region);
    let c001 = valid_corner(cell + vec3(0, 0, 1), region);
    let c101 = valid_corner(cell + vec3(1, 0, 1), region);
    let c011 = valid_corner(cell + vec3(0, 1, 1), region);
    let c111 = valid_corner(cell + vec3(1, 1, 1), region);
    let x00 = c000 + (c100 - c000) * f.x;
    let x10 = c010 + (c110 - c010) * f.x;
    let x01 = c001 + (c101 - c001) * f.x;
    let x11 = c011 + (c111 - c011) * f.x;
    let y0 = x00 + (x10 - x00) * f.y;
    let y1 = x01 + (x11 - x01) * f.y;
    let value = y0 + (y1 - y0) * f.z;
    let r0 = (c100 - c000) + ((c110 - c010) - (c100 - c000)) * f.y;
    let r1 = (c101 - c001) + ((c111 - c011) - (c101 - c001)) * f.y;
    let along_x = (r0 + (r1 - r0) * f.z) * packed.scale.x;
    let along_y = ((x10 - x00) + ((x11 - x01) - (x10 - x00)) * f.z) * packed.scale.y;
    let along_z = (y1 - y0) * packed.scale.z;
    let spread = vec3(packed.i_range.y - packed.i_range.x, packed.j_range.y - packed.j_range.x, 1.0);
    let unpacked = spread * vec3(1.0, f32(packed.blocks), f32(packed.layers));
    let shift = vec3(packed.i_range.x, packed.j_range.x - f32(region.y) * spread.y, -f32(region.x));
    var sample: PackedSample;
    sample.layer = region.x;
    sample.flat.ijk = value * unpacked + shift;
    sample.flat.di = vec3(along_x.x, along_y.x, along_z.x) * unpacked.x;
    sample.flat.dj = vec3(along_x.y, along_y.y, along_z.y) * unpacked.y;
    sample.flat.dk = vec3(along_x.z, along_y.z, along_z.z) * unpacked.z;
    return sample;
}
