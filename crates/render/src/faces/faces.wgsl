// Draws faces of the block and of cut-outs, the ground, media and wells, by one ray per sample: the twin of
// `reference::render`.
//
// One invocation draws one pixel of a tile. Its samples are averaged as sRGB-encoded values weighted by
// alpha. Voxel space.

const BODIES: u32 = 97u;
const PLANES: u32 = 406u;

struct FaceParams {
    // The ray through `reference_px`, and its change per pixel to the right (dx) and down (dy); w unused.
    origin: vec4<f32>,
    origin_dx: vec4<f32>,
    origin_dy: vec4<f32>,
    direction: vec4<f32>,
    direction_dx: vec4<f32>,
    direction_dy: vec4<f32>,
    box_low: vec4<f32>,
    box_high: vec4<f32>,
    background: vec4<f32>,
    // Metres between voxels along x, y, z; w unused.
    voxel_m: vec4<f32>,
    // Direction to the light in display space; w: strength of the hill shading.
    light: vec4<f32>,
    // Columns of the map from voxel to display covectors; w unused.
    display_normal_x: vec4<f32>,
    display_normal_y: vec4<f32>,
    display_normal_z: vec4<f32>,
    // Range of the heights of the ground (xy), steepest slope of the sheets (z), longest voxel edge in m (w).
    relief: vec4<f32>,
    reference_px: vec2<f32>,
    samples: u32,
    cut_count: u32,
    // The coarse map of the ground: smallest x, y; cells along x and y; number of entries of `relief_map`
    // before it.
    map_low: vec2<f32>,
    map_cells: vec2<u32>,
    ground_horizons: u32,
    ground_opacity: f32,
    padding_0: u32,
    padding_1: u32,
    // Pixels of the tile: left, top, width, height.
    tile: vec4<u32>,
    // First plane and number of planes of the block (0) and of what is cut out; zw unused.
    bodies: array<vec4<u32>, BODIES>,
    planes: array<PlaneInfo, PLANES>,
}

@group(0) @binding(0) var<uniform> params: FaceParams;
// One RGBA8 word per pixel of the tile, row by row, red in the lowest byte.
@group(0) @binding(1) var<storage, read_write> pixels: array<u32>;

// How flat coordinates are looked up: 0 not at all (raw data alone), 1 exact, 2 in the packed volume.
override lookup: u32 = 1u;
const LOOKUP_RAW: u32 = 0u;
const LOOKUP_EXACT: u32 = 1u;
const LOOKUP_PACKED: u32 = 2u;

// 1 if the ground is shown, 2 if it is not opaque.
override with_ground: u32 = 0u;

// A ray with its change per sample step.
struct PixelRay {
    origin: vec3<f32>,
    direction: vec3<f32>,
    origin_dx: vec3<f32>,
    origin_dy: vec3<f32>,
    direction_dx: vec3<f32>,
    direction_dy: vec3<f32>,
}

fn pixel_ray(pixel: vec2<f32>) -> PixelRay {
    let offset = pixel - params.reference_px;
    let direction = params.direction.xyz + params.direction_dx.xyz * offset.x + params.direction_dy.xyz * offset.y;
    let norm = 1.0 / length(direction);
    let step = 1.0 / f32(params.samples);
    var ray: PixelRay;
    ray.origin = params.origin.xyz + params.origin_dx.xyz * offset.x + params.origin_dy.xyz * offset.y;
    ray.direction = direction * norm;
    ray.origin_dx = params.origin_dx.xyz * step;
    ray.origin_dy = params.origin_dy.xyz * step;
    ray.direction_dx = params.direction_dx.xyz * (norm * step);
    ray.direction_dy = params.direction_dy.xyz * (norm * step);
    return ray;
}

// The change of a hit on its plane for a step of the ray.
fn slide_on_plane(drift: vec3<f32>, direction: vec3<f32>, plane: u32) -> vec3<f32> {
    let normal = params.planes[plane].normal.xyz;
    return drift - direction * (dot(normal, drift) / dot(normal, direction));
}

fn face_colour(ray: PixelRay, t: f32, p: vec3<f32>, plane: u32) -> vec3<f32> {
    var point: ShadePoint;
    if lookup != LOOKUP_RAW {
        var flat: FlatSample;
        if lookup == LOOKUP_EXACT {
            let block = block_at(p);
            point.layer = layer_at(p, block);
            flat = flat_exact(p, point.layer, block);
        } else {
            let packed = flat_packed(p);
            point.layer = packed.layer;
            flat = packed.flat;
        }
        let dx = slide_on_plane(ray.origin_dx + ray.direction_dx * t, ray.direction, plane);
        let dy = slide_on_plane(ray.origin_dy + ray.direction_dy * t, ray.direction, plane);
        point.ijk = flat.ijk;
        point.dx = vec3(dot(flat.di, dx), dot(flat.dj, dx), dot(flat.dk, dx));
        point.dy = vec3(dot(flat.di, dy), dot(flat.dj, dy), dot(flat.dk, dy));
        let info = params.planes[plane];
        point.metre_p = vec3(dot(flat.di, info.metre_p.xyz), dot(flat.dj, info.metre_p.xyz), dot(flat.dk, info.metre_p.xyz));
        point.metre_q = vec3(dot(flat.di, info.metre_q.xyz), dot(flat.dj, info.metre_q.xyz), dot(flat.dk, info.metre_q.xyz));
        point.grad_k = flat.dk / params.voxel_m.xyz;
        point.defined = 1u;
    }
    return with_candidates(p, shade(point, plane, p)) * params.planes[plane].metric_normal.w;
}

// What stops a ray: the first rock at or after a distance, or the ground. With `faces_shown` =
// FACES_CUT_OUTS, rock that begins at the roaming box does not count.
struct Stop {
    span: SolidSpan,
    ground: GroundHit,
}

fn stopping_hit(ray: PixelRay, after: f32) -> Stop {
    var stop: Stop;
    if faces_shown == FACES_ALL && with_ground == 0u {
        stop.span = next_span(ray.origin, ray.direction, after);
        return stop;
    }
    if faces_shown != FACES_ALL && faces_shown != FACES_CUT_OUTS {
        return stop;
    }
    let outer = cross_body(ray.origin, ray.direction, 0u);
    var start = after;
    for (var round = 0u; round < params.cut_count + 2u; round += 1u) {
        stop.span = next_span(ray.origin, ray.direction, start);
        if !stop.span.found {
            break;
        }
        var is_rock = true;
        if with_ground != 0u {
            is_rock = probe_at(stop.span.point).is_rock;
        }
        if is_rock && (faces_shown == FACES_ALL || stop.span.t > outer.enter + TOUCH) {
            break;
        }
        stop.span.found = false;
        if with_ground != 0u && !is_rock {
            stop.ground = march(ray.origin, ray.direction, stop.span.t, stop.span.end);
            if stop.ground.found {
                break;
            }
        }
        start = stop.span.end;
    }
    return stop;
}

// The straight colour of a ray: what stops it, with the media between `start` and there. `stop` is the
// distance to the ground if the ground stopped it, else negative.
struct Seen {
    colour: vec4<f32>,
    stop: f32,
}

fn seen(ray: PixelRay, after: f32, start: f32) -> Seen {
    let hit = stopping_hit(ray, after);
    var behind = params.background;
    var stop = HIGHEST;
    var is_ground = false;
    if hit.span.found {
        behind = vec4(face_colour(ray, hit.span.t, hit.span.point, hit.span.plane), 1.0);
        stop = hit.span.t;
    } else if with_ground != 0u && hit.ground.found {
        behind = vec4(ground_colour(hit.ground), params.ground_opacity);
        stop = dot(hit.ground.point - ray.origin, ray.direction);
        is_ground = true;
    }
    if with_wells == 1u {
        let well = well_hit(ray.origin, ray.direction, stop);
        if well.w < stop && well.w > after {
            behind = vec4(well.xyz, 1.0);
            stop = well.w;
            is_ground = false;
        }
    }
    var result: Seen;
    result.colour = behind;
    result.stop = select(-1.0, stop, is_ground);
    if with_media == 0u {
        return result;
    }
    let gathered = gather(ray.origin, ray.direction, start, stop);
    var far = to_linear(behind.rgb);
    if shading == OCCLUSION && stop < HIGHEST {
        far *= light_at(ray.origin + ray.direction * stop);
    } else if gathered.transmittance == 1.0 {
        return result;
    }
    let sum = gathered.colour + far * (behind.a * gathered.transmittance);
    let alpha = 1.0 - gathered.transmittance * (1.0 - behind.a);
    result.colour = vec4(to_encoded(sum / max(alpha, 1e-6)), alpha);
    return result;
}

fn trace(ray: PixelRay) -> vec4<f32> {
    let front = seen(ray, LOWEST, LOWEST);
    if with_ground != 2u || front.stop < 0.0 || front.colour.a >= 1.0 {
        return front.colour;
    }
    let span = next_span(ray.origin, ray.direction, front.stop);
    let behind = seen(ray, select(HIGHEST, span.end, span.found), front.stop).colour;
    let rest = behind.a * (1.0 - front.colour.a);
    let alpha = front.colour.a + rest;
    let sum = to_linear(front.colour.rgb) * front.colour.a + to_linear(behind.rgb) * rest;
    return vec4(to_encoded(sum / max(alpha, 1e-6)), alpha);
}

@compute @workgroup_size(8, 8)
fn draw(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= params.tile.z || id.y >= params.tile.w {
        return;
    }
    let corner = vec2<f32>(id.xy + params.tile.xy);
    let n = f32(params.samples);
    var sum = vec4(0.0);
    var sample = 0u;
    loop {
        let sub = vec2(f32(sample % params.samples), f32(sample / params.samples));
        let colour = trace(pixel_ray(corner + (sub + 0.5) / n));
        sum += vec4(colour.rgb * colour.a, colour.a);
        continuing {
            sample += 1u;
            break if sample >= params.samples * params.samples;
        }
    }
    sum /= n * n;
    let straight = vec4(sum.rgb / max(sum.a, 1e-6), sum.a);
    let bytes = vec4<u32>(clamp(straight, vec4(0.0), vec4(1.0)) * 255.0 + 0.5);
    pixels[id.y * params.tile.z + id.x] = bytes.r | bytes.g << 8u | bytes.b << 16u | bytes.a << 24u;
}
