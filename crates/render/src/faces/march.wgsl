// The march of a ray through the media, with empty-space skipping: the twin of `media::march` and `media::bricks`.
//
// A single loop over samples: a loop over bricks as on the CPU would leave lanes idle.

fn brick_at(p: vec3<f32>) -> vec3<i32> {
    return clamp(vec3<i32>(p / BRICK), vec3(0), vec3<i32>(media.bricks.xyz) - 1);
}

fn brick_word(brick: vec3<i32>) -> u32 {
    let at = vec3<u32>(brick);
    return relief_map[media.bricks.w + (at.x * media.bricks.y + at.y) * media.bricks.z + at.z];
}

// λ + E at a voxel position.
fn light_at(p: vec3<f32>) -> vec3<f32> {
    var q = media.cells_x.xyz * p.x + media.cells_y.xyz * p.y + media.cells_z.xyz * p.z + media.cells_shift.xyz;
    if media.cells_shift.w == 1.0 {
        let depth = max(q.z * media.cells_low.w + media.cells_low.z, 1e-9);
        q = vec3(q.xy / depth - media.cells_low.xy, q.z);
    }
    let size = vec3<f32>(media.cells.xyz) + vec3(0.0, 0.0, 1.0);
    let at = (clamp(q, vec3(0.0), size - 1.0) + 0.5) / size;
    let value = textureSampleLevel(light_volume, filtering, at, 0.0);
    return value.xyz + vec3(value.w);
}

struct Gathered {
    colour: vec3<f32>,
    transmittance: f32,
}

// Marches through a stretch of the ray that lies in one zone.
fn through(
    origin: vec3<f32>,
    direction: vec3<f32>,
    t_from: f32,
    t_to: f32,
    zone: u32,
    towards: vec3<f32>,
    units: f32,
    before: Gathered,
) -> Gathered {
    var gathered = before;
    let length = (t_to - t_from) * units;
    let steps = max(ceil(length * media.scales.x), 1.0);
    let step_t = (t_to - t_from) / steps;
    let step = length / steps;
    let shift = 8u * zone;
    let inverse = 1.0 / select(direction, vec3(1e-6), abs(direction) < vec3(1e-6));
    var n = 0.0;
    loop {
        let p = origin + direction * (t_from + (n + 0.5) * step_t);
        let brick = brick_at(p);
        let content = brick_word(brick);
        let distance = content >> shift & 255u;
        if distance == 0u {
            let matter = matter_at(p, zone, content, towards);
            if matter.extinction > 0.0 {
                let alpha = 1.0 - exp(-matter.extinction * step);
                var colour = matter.colour;
                if shading == OCCLUSION {
                    colour *= light_at(p);
                }
                gathered.colour += (colour + matter.emission) * (alpha * gathered.transmittance);
                gathered.transmittance *= 1.0 - alpha;
            }
            n += 1.0;
        } else {
            let around = i32(distance) - 1;
            let border = select(vec3<f32>(brick - around), vec3<f32>(brick + 1 + around), direction > vec3(0.0)) * BRICK;
            let out = (border - origin) * inverse;
            let reached = select(out, vec3(HIGHEST), abs(direction) < vec3(1e-6));
            let exit = min(reached.x, min(reached.y, reached.z));
            n = max(n + 1.0, ceil((exit - t_from) / step_t + 0.5) );
        }
        continuing {
            break if n >= steps || gathered.transmittance <= SPENT;
        }
    }
    return gathered;
}

// Integrates the media along a ray in the roaming box between two distances.
fn gather(origin: vec3<f32>, direction: vec3<f32>, start: f32, stop: f32) -> Gathered {
    var gathered: Gathered;
    gathered.transmittance = 1.0;
    let outer = cross_body(origin, direction, 0u);
    if outer.exit <= outer.enter {
        return gathered;
    }
    let along = to_display(direction);
    let metres = length(along);
    let towards = -along / metres;
    let units = metres / media.scales.y;
    let last = min(outer.exit, stop);
    if params.cut_count == 0u {
        let first = max(outer.enter, start);
        if last > first + TOUCH && faces_shown != FACES_ALL {
            gathered = through(origin, direction, first, last, SURROUNDINGS, towards, units, gathered);
        }
        return gathered;
    }
    // A round handles either a stretch in a cut-out or the rock behind it, so there are two rounds per
    // stretch of rock.
    var t = max(outer.enter, start);
    for (var round = 0u; round < 2u * (params.cut_count + 1u); round += 1u) {
        if t + TOUCH >= last || gathered.transmittance <= SPENT {
            break;
        }
        let span = next_span(origin, direction, t);
        var to = last;
        var zone = CUT_OUT;
        if span.found {
            if span.t <= t + TOUCH {
                zone = SURROUNDINGS;
                to = min(span.end, last);
            } else {
                to = min(span.t, last);
            }
        }
        if to > t + TOUCH && (zone == CUT_OUT || faces_shown != FACES_ALL) {
            gathered = through(origin, direction, t, to, zone, towards, units, gathered);
        }
        t = max(to, t + 0.5 * TOUCH);
    }
    return gathered;
}
