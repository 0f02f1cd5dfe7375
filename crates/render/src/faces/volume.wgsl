// Scalar volumes on their own lattices and extents: the twin of `NamedVolume::sample`.

struct VolumePlacement {
    // Sample index = voxel position · scale + offset; w unused.
    scale: vec4<f32>,
    offset: vec4<f32>,
    // Counts along x, y, z; w unused.
    size: vec4<u32>,
}

@group(2) @binding(0) var<uniform> volume_infos: array<VolumePlacement, 6>;
// Texel (x, y, z) of a texture is sample (z, y, x) of the volume, so that z stays fastest in memory.
@group(2) @binding(1) var volume_0: texture_3d<f32>;
@group(2) @binding(2) var volume_1: texture_3d<f32>;
@group(2) @binding(3) var volume_2: texture_3d<f32>;
@group(2) @binding(4) var volume_3: texture_3d<f32>;
@group(2) @binding(5) var volume_4: texture_3d<f32>;
@group(2) @binding(6) var volume_5: texture_3d<f32>;

// Value of NaN and of dead traces, since WGSL does not guarantee NaN.
const NO_DATA: f32 = -3.0e38;
const NO_WEIGHT: f32 = 1e-5;
const SLACK: f32 = 1e-3;

fn is_no_data(value: f32) -> bool {
    return value < -1.0e38;
}

// Number of volumes in use; nothing is read from the others.
override volume_count: u32 = 6u;

fn load_volume(slot: u32, at: vec3<u32>) -> f32 {
    if volume_count <= 1u {
        return textureLoad(volume_0, at.zyx, 0).r;
    }
    if volume_count == 2u {
        if slot == 0u {
            return textureLoad(volume_0, at.zyx, 0).r;
        }
        return textureLoad(volume_1, at.zyx, 0).r;
    }
    switch slot {
        case 0u: { return textureLoad(volume_0, at.zyx, 0).r; }
        case 1u: { return textureLoad(volume_1, at.zyx, 0).r; }
        case 2u: { return textureLoad(volume_2, at.zyx, 0).r; }
        case 3u: { return textureLoad(volume_3, at.zyx, 0).r; }
        case 4u: { return textureLoad(volume_4, at.zyx, 0).r; }
        case 5u: { return textureLoad(volume_5, at.zyx, 0).r; }
        default: { return NO_DATA; }
    }
}

fn sample_volume(slot: u32, p: vec3<f32>) -> f32 {
    let info = volume_infos[slot];
    let index = p * info.scale.xyz + info.offset.xyz;
    let last = vec3<f32>(info.size.xyz) - 1.0;
    if any(index < vec3(-SLACK)) || any(index > last + SLACK) {
        return NO_DATA;
    }
    let clamped = clamp(index, vec3(0.0), last);
    let low = min(floor(clamped), max(last - 1.0, vec3(0.0)));
    let f = clamped - low;
    var sum = 0.0;
    for (var corner = 0u; corner < 8u; corner += 1u) {
        let side = vec3<u32>(corner & 1u, corner >> 1u & 1u, corner >> 2u);
        let w = select(vec3(1.0) - f, f, side == vec3(1u));
        let weight = w.x * w.y * w.z;
        if weight >= NO_WEIGHT {
            let value = load_volume(slot, min(vec3<u32>(low) + side, info.size.xyz - 1u));
            if is_no_data(value) {
                return NO_DATA;
            }
            sum += weight * value;
        }
    }
    return sum;
}
