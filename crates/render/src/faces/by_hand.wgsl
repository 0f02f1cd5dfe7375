// Trilinear interpolation in the shader, for devices that cannot filter 32-bit floats.

fn filtered_volume(slot: u32, index: vec3<f32>, size: vec3<u32>) -> f32 {
    let low = min(floor(index), max(vec3<f32>(size) - 2.0, vec3(0.0)));
    let f = index - low;
    var sum = 0.0;
    for (var corner = 0u; corner < 8u; corner += 1u) {
        let side = vec3<u32>(corner & 1u, corner >> 1u & 1u, corner >> 2u);
        let w = select(vec3(1.0) - f, f, side == vec3(1u));
        sum += w.x * w.y * w.z * load_volume(slot, min(vec3<u32>(low) + side, size - 1u));
    }
    return sum;
}
