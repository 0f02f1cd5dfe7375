// The ground, intersected by a ray: the twin of `ground::Relief` (P-illus 5).

const SHORTEST_STEP: f32 = 0.5;
const BISECTIONS: u32 = 7u;
const MAX_STEPS: u32 = 4096u;
const CELL: f32 = 4.0;
const INTO_CELL: f32 = 0.01;
const INTO_ROCK: f32 = 0.05;

// First the horizons that form the ground, then the tops of the cells as the bits of floats, [x][y].
@group(0) @binding(2) var<storage, read> relief_map: array<u32>;

struct Probe {
    is_rock: bool,
    block: u32,
    gap: f32,
    horizon: u32,
    below: vec2<u32>,
    fault_m: f32,
    fault: u32,
}

struct GroundHit {
    point: vec3<f32>,
    normal: vec3<f32>,
    layer: u32,
    block: u32,
    found: bool,
}

fn probe_at(p: vec3<f32>) -> Probe {
    var probe: Probe;
    probe.fault_m = HIGHEST;
    var bits = vec2(0u);
    if has_faults == 1u {
        var f = 0u;
        loop {
            let side = fault_side(f, p);
            if side >= 0.0 {
                bits = with_bit(bits, f);
            }
            if abs(side) < probe.fault_m {
                probe.fault_m = abs(side);
                probe.fault = f;
            }
            continuing {
                f += 1u;
                break if f >= model.faults;
            }
        }
    }
    probe.block = block_of(bits);
    probe.gap = HIGHEST;
    var below = vec2(0u);
    if has_horizons == 1u {
        var n = 0u;
        loop {
            let h = relief_map[n];
            let offset = ground_offset(sheets[h * model.blocks + probe.block], p);
            if offset >= 0.0 {
                below = with_bit(below, h);
            }
            if abs(offset) < probe.gap {
                probe.gap = abs(offset);
                probe.horizon = h;
            }
            continuing {
                n += 1u;
                break if n >= params.ground_horizons;
            }
        }
    }
    probe.below = below;
    probe.is_rock = layer_of(below) != model.layers - 1u;
    return probe;
}

// How far a voxel position lies below a horizon, vertically, or inside a surface of any shape, in longest voxel edges.
fn ground_offset(info: SheetInfo, p: vec3<f32>) -> f32 {
    if has_levels == 1u && info.level != NONE {
        return level_distance(info, p).w / params.relief.w;
    }
    return p.z - sheet_z(info, p.xy);
}

// The first distance at or after t at which the coarse map does not exclude rock.
fn skip_air(origin: vec3<f32>, direction: vec3<f32>, start: f32, end: f32) -> f32 {
    var t = start;
    let last = vec2<f32>(params.map_cells) - 1.0;
    for (var n = 0u; n < MAX_STEPS; n += 1u) {
        let p = origin + direction * t;
        let cell = clamp(floor((p.xy - params.map_low) / CELL), vec2(0.0), last);
        let index = params.ground_horizons + u32(cell.x) * params.map_cells.y + u32(cell.y);
        let top = bitcast<f32>(relief_map[index]);
        if p.z >= top || t >= end {
            break;
        }
        var step = HIGHEST;
        for (var axis = 0u; axis < 2u; axis += 1u) {
            let d = direction[axis];
            if abs(d) > 1e-6 {
                let border = params.map_low[axis] + (cell[axis] + select(0.0, 1.0, d > 0.0)) * CELL;
                step = min(step, max((border - p[axis]) / d, 0.0) + INTO_CELL);
            }
        }
        if direction.z > 1e-6 {
            step = min(step, (top - p.z) / direction.z + 1e-4);
        }
        t = min(t + step, end);
    }
    return t;
}

// Refines a step from air at `air_at` to rock at `rock_at`. The block of `before` is NONE if the air was skipped.
fn refine(
    origin: vec3<f32>,
    direction: vec3<f32>,
    air_at: f32,
    before: Probe,
    rock_at: f32,
    behind: Probe,
) -> GroundHit {
    var air_t = air_at;
    var air = before;
    var t = rock_at;
    var inside = behind;
    var hit: GroundHit;
    hit.found = true;
    let alone = with_bit(vec2(0u), inside.horizon);
    if air.block == inside.block && air.horizon == inside.horizon && all((air.below ^ inside.below) == alone) {
        t = air_t + (t - air_t) * air.gap / max(air.gap + inside.gap, 1e-12);
    } else {
        if air.block == NONE {
            air.block = probe_at(origin + direction * air_t).block;
        }
        var n = 0u;
        loop {
            let middle = 0.5 * (air_t + t);
            let here = probe_at(origin + direction * middle);
            if here.is_rock {
                t = middle;
                inside = here;
            } else {
                air_t = middle;
                air.block = here.block;
            }
            continuing {
                n += 1u;
                break if n >= BISECTIONS;
            }
        }
    }
    hit.point = origin + direction * t;
    hit.block = inside.block;
    // Below the underside of a body there is air.
    var inwards = vec3(0.0, 0.0, 1.0);
    if air.block == inside.block {
        let info = sheets[inside.horizon * model.blocks + inside.block];
        if has_levels == 1u && info.level != NONE {
            let slope = level_distance(info, hit.point).xyz;
            inwards = select(inwards, unit_or_zero(slope), dot(slope, slope) > 0.0);
            hit.normal = -slope;
        } else {
            hit.normal = vec3(sheet_sample(info, hit.point.xy).yz, -1.0);
        }
    } else {
        let normal = faults[inside.fault].w.xyz;
        hit.normal = select(normal, -normal, dot(normal, direction) > 0.0);
    }
    hit.layer = layer_at(hit.point + inwards * INTO_ROCK, hit.block);
    if hit.layer == model.layers - 1u {
        hit.layer = layer_at(origin + direction * (t + 2.0 * INTO_ROCK), hit.block);
    }
    return hit;
}

// The first hit of the ground along a ray between distances `enter` (in the air) and `leave`.
fn march(origin: vec3<f32>, direction: vec3<f32>, enter: f32, leave: f32) -> GroundHit {
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
    var fall = abs(direction.z) + params.relief.z * length(direction.xy);
    if has_levels == 1u {
        // A surface of any shape may lie in any direction.
        fall = max(fall, 1.0);
    }
    var air_t = enter;
    var air: Probe;
    air.block = NONE;
    var inside: Probe;
    var t = start;
    var step = 0u;
    loop {
        let skipped = skip_air(origin, direction, t, end);
        if skipped > t {
            air_t = max(skipped - 2.0 * INTO_CELL, air_t);
            air.block = NONE;
        }
        t = skipped;
        inside = probe_at(origin + direction * t);
        let done = inside.is_rock || t >= end;
        if !done {
            air_t = t;
            air = inside;
            let to_fault = 0.8 * inside.fault_m / params.relief.w;
            t = min(t + max(min(inside.gap / fall, to_fault), SHORTEST_STEP), end);
        }
        continuing {
            step += 1u;
            break if done || step >= MAX_STEPS;
        }
    }
    if inside.is_rock {
        hit = refine(origin, direction, air_t, air, t, inside);
    }
    return hit;
}

fn ground_colour(hit: GroundHit) -> vec3<f32> {
    var layer = hit.layer;
    var k = 1.0;
    if lookup == LOOKUP_EXACT {
        k = flat_exact(hit.point, layer, hit.block).ijk.z;
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
