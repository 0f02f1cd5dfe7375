// The first stretch of rock on a ray: the twin of `visible::Solid::next_span` and of `body::Body`.

const TOUCH: f32 = 1e-3;
const PARALLEL: f32 = 1e-12;
const LOWEST: f32 = -3.0e38;
const HIGHEST: f32 = 3.0e38;

// A plane of the block (the first six) or of what is cut out.
struct PlaneInfo {
    // Unit normal out of its body, voxels; w: n·p of its points.
    normal: vec4<f32>,
    // Unit normal in metric space; w: factor on colours.
    metric_normal: vec4<f32>,
    // Horizontal direction in the face, and what is added to u along it.
    along: vec2<f32>,
    shift: f32,
    // Axis of a plane of constant x, y or z, else NONE.
    axis: u32,
    // Two directions in the face, voxels: perpendicular and a metre long in displayed space; w unused.
    metre_p: vec4<f32>,
    metre_q: vec4<f32>,
}

// The interval of t over which a ray is inside a body, and the planes at its ends.
struct Crossing {
    enter: f32,
    exit: f32,
    enter_plane: u32,
    exit_plane: u32,
}

struct SolidSpan {
    point: vec3<f32>,
    t: f32,
    end: f32,
    plane: u32,
    found: bool,
}

// Body 0 is the block.
fn cross_body(origin: vec3<f32>, direction: vec3<f32>, body: u32) -> Crossing {
    var crossing = Crossing(LOWEST, HIGHEST, 0u, 0u);
    let range = params.bodies[body];
    for (var n = range.x; n < range.x + range.y; n += 1u) {
        let plane = params.planes[n].normal;
        let outside = dot(plane.xyz, origin) - plane.w;
        let speed = dot(plane.xyz, direction);
        if abs(speed) < PARALLEL {
            if outside > 0.0 {
                return Crossing(HIGHEST, LOWEST, 0u, 0u);
            }
            continue;
        }
        let t = -outside / speed;
        if speed < 0.0 && t > crossing.enter {
            crossing.enter = t;
            crossing.enter_plane = n;
        }
        if speed > 0.0 && t < crossing.exit {
            crossing.exit = t;
            crossing.exit_plane = n;
        }
    }
    return crossing;
}

fn next_span(origin: vec3<f32>, direction: vec3<f32>, start: f32) -> SolidSpan {
    let outer = cross_body(origin, direction, 0u);
    var span: SolidSpan;
    span.t = max(outer.enter, start);
    span.plane = outer.enter_plane;
    for (var round = 0u; round <= params.cut_count; round += 1u) {
        var moved = false;
        for (var cut = 1u; cut <= params.cut_count; cut += 1u) {
            let crossing = cross_body(origin, direction, cut);
            if crossing.enter <= span.t + TOUCH && span.t + TOUCH < crossing.exit {
                span.t = crossing.exit;
                if crossing.exit < HIGHEST {
                    span.plane = crossing.exit_plane;
                }
                moved = true;
            }
        }
        if !moved {
            break;
        }
    }
    if span.t + TOUCH >= outer.exit {
        return span;
    }
    span.found = true;
    span.end = outer.exit;
    for (var cut = 1u; cut <= params.cut_count; cut += 1u) {
        let crossing = cross_body(origin, direction, cut);
        if crossing.enter > span.t + TOUCH && crossing.enter < crossing.exit {
            span.end = min(span.end, crossing.enter);
        }
    }
    span.point = origin + direction * span.t;
    if span.t != start {
        let plane = params.planes[span.plane];
        if plane.axis != NONE {
            span.point[plane.axis] = plane.normal.w * plane.normal[plane.axis];
        } else {
            span.point -= plane.normal.xyz * (dot(plane.normal.xyz, span.point) - plane.normal.w);
        }
    }
    return span;
}
