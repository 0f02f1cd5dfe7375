// Trilinear interpolation by the hardware, for devices that can filter 32-bit floats.

fn filtered_volume(slot: u32, index: vec3<f32>, size: vec3<u32>) -> f32 {
    let at = ((index + 0.5) / vec3<f32>(size)).zyx;
    if volume_count <= 1u {
        return textureSampleLevel(volume_0, filtering, at, 0.0).r;
    }
    switch slot {
        case 0u: { return textureSampleLevel(volume_0, filtering, at, 0.0).r; }
        case 1u: { return textureSampleLevel(volume_1, filtering, at, 0.0).r; }
        case 2u: { return textureSampleLevel(volume_2, filtering, at, 0.0).r; }
        case 3u: { return textureSampleLevel(volume_3, filtering, at, 0.0).r; }
        case 4u: { return textureSampleLevel(volume_4, filtering, at, 0.0).r; }
        case 5u: { return textureSampleLevel(volume_5, filtering, at, 0.0).r; }
        default: { return NO_DATA; }
    }
}
