// Wells as chains of capsules: the twin of `wells`. Display space relative to voxel 0, m.

// 1 if there are wells.
override with_wells: u32 = 0u;

const RIM_LIGHT: f32 = 0.35;
const CAPSULE_WORDS: u32 = 10u;

// The first well on a ray before `stop`: its colour, and its distance (w, voxels; HIGHEST: none).
fn well_hit(voxel_origin: vec3<f32>, voxel_direction: vec3<f32>, stop: f32) -> vec4<f32> {
    let along = to_display(voxel_direction);
    let metres = length(along);
    let direction = along / metres;
    let origin = to_display(voxel_origin);
    var found = vec4(0.0, 0.0, 0.0, HIGHEST);
    var last = HIGHEST;
    if stop < HIGHEST {
        last = stop * metres;
    }
    for (var n = 0u; n < media.capsules; n += 1u) {
        let at = media.wells + CAPSULE_WORDS * n;
        let a = vec3(word(at), word(at + 1u), word(at + 2u));
        let radius = word(at + 3u);
        let b = vec3(word(at + 4u), word(at + 5u), word(at + 6u));
        let axis = b - a;
        let length_sq = max(dot(axis, axis), 1e-12);
        let shift = dot(0.5 * (a + b) - origin, direction);
        let start = origin + direction * shift - a;
        let da = dot(direction, axis) / length_sq;
        let fa = dot(start, axis) / length_sq;
        let across = direction - axis * da;
        let off = start - axis * fa;
        let qa = dot(across, across);
        let qb = dot(across, off);
        let root = qb * qb - qa * (dot(off, off) - radius * radius);
        var best = HIGHEST;
        var normal = vec3(0.0);
        if qa > 1e-9 && root >= 0.0 {
            let s = (-qb - sqrt(root)) / qa;
            let u = fa + s * da;
            if u >= 0.0 && u <= 1.0 {
                best = s;
                normal = start + direction * s - axis * u;
            }
        }
        for (var end = 0u; end < 2u; end += 1u) {
            let to = start - axis * f32(end);
            let hb = dot(to, direction);
            let under = hb * hb - (dot(to, to) - radius * radius);
            if under >= 0.0 {
                let s = -hb - sqrt(under);
                if s < best {
                    best = s;
                    normal = to + direction * s;
                }
            }
        }
        if best < HIGHEST && best + shift < last {
            last = best + shift;
            let facing = clamp(-dot(normal, direction) / radius, 0.0, 1.0);
            let light = RIM_LIGHT + (1.0 - RIM_LIGHT) * facing;
            found = vec4(vec3(word(at + 7u), word(at + 8u), word(at + 9u)) * light, last / metres);
        }
    }
    return found;
}
