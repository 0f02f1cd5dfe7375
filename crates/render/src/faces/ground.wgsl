// The ground along a ray: the twin of `ground::Relief` (P-illus 5).

const SHORTEST_STEP: f32 = 0.25;
const BISECTIONS: u32 = 6u;
const MAX_STEPS: u32 = 4096u;

struct Place {
    layer: u32,
    block: u32,
    gap: f32,
    horizon: u32,
    fault_m: f32,
    fault: u32,
}

struct GroundHit {
    point: vec3<f32>,
    normal: vec3<f32>,
    place: Place,
    found: bool,
}

fn place_at(p: vec3<f32>) -> Place {
    var place: Place;
    place.fault_m = HIGHEST;
    var bits = vec2(0u);
    if has_faults == 1u {
        var f = 0u;
        loop {
            let side = fault_side(f, p);
            if side >= 0.0 {
                bits = with_bit(bits, f);
            }
            if abs(side) < place.fault_m {
                place.fault_m = abs(side);
                place.fault = f;
            }
            continuing {
                f += 1u;
                break if f >= model.faults;
            }
        }
    }
    place.block = block_of(bits);
    place.gap = HIGHEST;
    var below = vec2(0u);
    if has_horizons == 1u {
        var h = 0u;
        loop {
            let z = sheet_z(sheets[h * model.blocks + place.block], p.xy);
            if p.z >= z {
                below = with_bit(below, h);
            }
            if abs(z - p.z) < place.gap {
                place.gap = abs(z - p.z);
                place.horizon = h;
            }
            continuing {
                h += 1u;
                break if h >= model.horizons;
            }
        }
    }
    place.layer = layer_of(below);
    return place;
}

fn march(origin: vec3<f32>, direction: vec3<f32>, enter: f32, leave: f32) -> GroundHit {
    let air = model.layers - 1u;
    var hit: GroundHit;
    var start = enter;
    var end = leave;
    if abs(direction.z) < 1e-6 {
        if origin.z < params.relief.x {
            return hit;
        }
    } else {
        let a = (params.relief.x - origin.z) / direction.z;
        let b = (params.relief.y - origin.z) / direction.z;
        start = max(start, min(a, b));
        end = min(end, max(a, b));
        if start >= end {
            return hit;
        }
    }
    let fall = abs(direction.z) + params.relief.z * length(direction.xy);
    var air_t = enter;
    var air_block = place_at(origin + direction * enter).block;
    var t = start;
    var step = 0u;
    loop {
        let here = place_at(origin + direction * t);
        hit.found = here.layer != air;
        hit.place = here;
        let done = hit.found || t >= end;
        if !done {
            air_t = t;
            air_block = here.block;
            let to_fault = 0.8 * here.fault_m / params.relief.w;
            t = min(t + max(min(here.gap / fall, to_fault), SHORTEST_STEP), end);
        }
        continuing {
            step += 1u;
            break if done || step >= MAX_STEPS;
        }
    }
    if !hit.found {
        return hit;
    }
    var n = 0u;
    loop {
        let middle = 0.5 * (air_t + t);
        let here = place_at(origin + direction * middle);
        if here.layer == air {
            air_t = middle;
            air_block = here.block;
        } else {
            t = middle;
            hit.place = here;
        }
        continuing {
            n += 1u;
            break if n >= BISECTIONS;
        }
    }
    hit.point = origin + direction * t;
    if hit.place.block == air_block {
        let slope = sheet_sample(sheets[hit.place.horizon * model.blocks + hit.place.block], hit.point.xy).yz;
        hit.normal = vec3(slope, -1.0);
    } else {
        let normal = faults[hit.place.fault].w.xyz;
        hit.normal = select(normal, -normal, dot(normal, direction) > 0.0);
    }
    return hit;
}

fn ground_colour(hit: GroundHit) -> vec3<f32> {
    var layer = hit.place.layer;
    var k = 1.0;
    if lookup == LOOKUP_EXACT {
        k = flat_exact(hit.point, layer, hit.place.block).ijk.z;
    } else if lookup == LOOKUP_PACKED {
        let packed = flat_packed(hit.point);
        layer = packed.layer;
        k = packed.flat.ijk.z;
    }
    let display = params.display_normal_x.xyz * hit.normal.x
        + params.display_normal_y.xyz * hit.normal.y
        + params.display_normal_z.xyz * hit.normal.z;
    let lit = max(dot(unit_or_zero(display), params.light.xyz), 0.0) / params.light.z;
    let factor = 1.0 + params.light.w * min(lit - 1.0, 0.5);
    let colour = min(average_colour(layer, k) * factor, vec3(1.0));
    return blend_raw(colour, hit.point);
}
