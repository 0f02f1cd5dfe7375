// Filtered texture sampling: the twin of `ttf::Texture::sample`, whose module documentation states the rule.

struct TextureInfo {
    // Mean of all texels, premultiplied.
    mean: vec4<f32>,
    // First texel of level 0 in `texels`.
    offset: u32,
    // Texels a side at level 0.
    side: u32,
    levels: u32,
    padding: u32,
}

@group(1) @binding(0) var<storage, read> texture_infos: array<TextureInfo>;
// RGBA8, premultiplied, red in the lowest byte; levels follow one another, largest first.
@group(1) @binding(1) var<storage, read> texels: array<u32>;

const MAX_TAPS: f32 = 8.0;

fn bilinear_texel(info: TextureInfo, uv: vec2<f32>, level: u32) -> vec4<f32> {
    let side = info.side >> level;
    // Number of texels of the levels before: the sum of a geometric series.
    let start = info.offset + (info.side * info.side - side * side) / 3u * 4u;
    let place = fract(uv) * f32(side) - 0.5;
    let low = floor(place);
    let f = place - low;
    // Sides are powers of two, so wrapping is a mask, also for −1.
    let wrap = side - 1u;
    let x0 = u32(i32(low.x)) & wrap;
    let y0 = u32(i32(low.y)) & wrap;
    let x1 = (x0 + 1u) & wrap;
    let y1 = (y0 + 1u) & wrap;
    let c00 = unpack4x8unorm(texels[start + y0 * side + x0]);
    let c10 = unpack4x8unorm(texels[start + y0 * side + x1]);
    let c01 = unpack4x8unorm(texels[start + y1 * side + x0]);
    let c11 = unpack4x8unorm(texels[start + y1 * side + x1]);
    let bottom = c00 + (c10 - c00) * f.x;
    let top = c01 + (c11 - c01) * f.x;
    return bottom + (top - bottom) * f.y;
}

fn trilinear_texel(info: TextureInfo, uv: vec2<f32>, lod: f32) -> vec4<f32> {
    let lower = floor(lod);
    let near = bilinear_texel(info, uv, u32(lower));
    let far = bilinear_texel(info, uv, min(u32(lower) + 1u, info.levels - 1u));
    return near + (far - near) * (lod - lower);
}

fn sample_texture(slot: u32, uv: vec2<f32>, duv_dx: vec2<f32>, duv_dy: vec2<f32>) -> vec4<f32> {
    let info = texture_infos[slot];
    let side = f32(info.side);
    let a = duv_dx * side;
    let b = duv_dy * side;
    let p = a.x * a.x + b.x * b.x;
    let q = a.x * a.y + b.x * b.y;
    let r = a.y * a.y + b.y * b.y;
    let half_sum = (p + r) * 0.5;
    let half_difference = (p - r) * 0.5;
    let root = sqrt(half_difference * half_difference + q * q);
    let major_sq = half_sum + root;
    let major = sqrt(major_sq);
    let minor = sqrt(max(half_sum - root, 0.0));
    let width = max(max(minor, major / MAX_TAPS), 1.0);
    let taps = clamp(ceil(major / width - 0.01), 1.0, MAX_TAPS);
    let first = vec2(major_sq - r, q);
    let second = vec2(q, major_sq - p);
    let longer = select(second, first, dot(first, first) >= dot(second, second));
    let length_sq = dot(longer, longer);
    let axis = select(vec2(1.0, 0.0), longer * inverseSqrt(max(length_sq, 1e-37)), length_sq > 0.0) * (major / side);
    let lod = min(log2(width), f32(info.levels - 1u));
    var sum = vec4(0.0);
    var tap = 0.0;
    loop {
        sum += trilinear_texel(info, uv + axis * ((tap + 0.5) / taps - 0.5), lod);
        continuing {
            tap += 1.0;
            break if tap >= taps;
        }
    }
    return sum / taps;
}
