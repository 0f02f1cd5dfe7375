// Propagates occlusion and emission from slice to slice: the twin of `media::light`. One invocation computes
// one cell of a slice.

struct Slice {
    index: u32,
    // Weight of each neighbour along an axis.
    side: f32,
    padding_0: u32,
    padding_1: u32,
}

@group(0) @binding(3) var<uniform> slice: Slice;
// Emission (xyz) and occlusion (w) of two slices, which alternate.
@group(0) @binding(4) var<storage, read_write> carried: array<vec4<f32>>;
@group(0) @binding(5) var light_out: texture_storage_3d<rgba16float, write>;

// What a slice adds: emitted light (xyz), occlusion (w), and its opacity.
struct Added {
    light: vec4<f32>,
    alpha: f32,
}

fn add_stretch(before: Added, origin: vec3<f32>, per_depth: vec3<f32>, depths: vec2<f32>, zone: u32) -> Added {
    var added = before;
    let p = origin + per_depth * (0.5 * (depths.x + depths.y));
    let content = brick_word(brick_at(p));
    if (content >> (8u * zone) & 255u) != 0u {
        return added;
    }
    let units = media.slice_units * (depths.y - depths.x) / media.cells_low.w;
    let matter = matter_at(p, zone, content, vec3(0.0, 0.0, 1.0));
    let alpha = 1.0 - exp(-matter.extinction * units);
    added.light += vec4(matter.emission * alpha, (1.0 - exp(-matter.extinction)) * units);
    added.alpha += alpha * (1.0 - added.alpha);
    return added;
}

fn slice_adds(cell: vec2<u32>) -> Added {
    var added: Added;
    let flat = media.grid.xy + (vec2<f32>(cell) + 0.5) * media.grid.z;
    let spread = media.right.xyz * flat.x + media.up.xyz * flat.y;
    var origin = media.back.xyz;
    var per_depth = media.forward.xyz;
    if media.cells_shift.w == 1.0 {
        per_depth += spread;
    } else {
        origin += spread;
    }
    let norm = length(per_depth);
    let direction = per_depth / norm;
    let near = media.cells_low.z + f32(slice.index) * media.cells_low.w;
    let far = near + media.cells_low.w;
    let outer = cross_body(origin, direction, 0u);
    if outer.exit <= outer.enter {
        return added;
    }
    if params.cut_count == 0u {
        let depths = vec2(max(outer.enter / norm, near), min(outer.exit / norm, far));
        if faces_shown != FACES_ALL && depths.y > depths.x {
            added = add_stretch(added, origin, per_depth, depths, SURROUNDINGS);
        }
        return added;
    }
    var t = outer.enter;
    for (var round = 0u; round < 2u * (params.cut_count + 1u); round += 1u) {
        if t + TOUCH >= outer.exit || t > far * norm {
            break;
        }
        let span = next_span(origin, direction, t);
        var to = outer.exit;
        var zone = CUT_OUT;
        if span.found {
            if span.t <= t + TOUCH {
                zone = SURROUNDINGS;
                to = min(span.end, outer.exit);
            } else {
                to = min(span.t, outer.exit);
            }
        }
        let depths = vec2(max(t / norm, near), min(to / norm, far));
        if (zone == CUT_OUT || faces_shown != FACES_ALL) && depths.y > depths.x {
            added = add_stretch(added, origin, per_depth, depths, zone);
        }
        t = max(to, t + 0.5 * TOUCH);
    }
    return added;
}

@compute @workgroup_size(8, 8)
fn carry(@builtin(global_invocation_id) id: vec3<u32>) {
    let size = vec2<i32>(media.cells.xy);
    let cell = vec2<i32>(id.xy);
    if any(cell >= size) {
        return;
    }
    let cells = media.cells.x * media.cells.y;
    let before = (slice.index & 1u) * cells;
    var blurred = vec4(0.0);
    if slice.index > 0u {
        let weights = vec3(slice.side, 1.0 - 2.0 * slice.side, slice.side);
        for (var y = -1; y <= 1; y += 1) {
            for (var x = -1; x <= 1; x += 1) {
                let neighbour = cell + vec2(x, y);
                if all(neighbour >= vec2(0)) && all(neighbour < size) {
                    blurred += carried[before + u32(neighbour.y) * media.cells.x + u32(neighbour.x)] * (weights[x + 1] * weights[y + 1]);
                }
            }
        }
    }
    textureStore(light_out, vec3(id.xy, slice.index), vec4(blurred.xyz, 1.0 / (1.0 + media.grid.w * blurred.w)));
    if slice.index < media.cells.z {
        let added = slice_adds(id.xy);
        let next = vec4(blurred.xyz * (1.0 - added.alpha), blurred.w) + added.light;
        carried[cells - before + id.y * media.cells.x + id.x] = next;
    }
}
