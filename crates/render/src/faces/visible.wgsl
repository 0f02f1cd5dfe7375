// The first stretch of rock on a ray: the twin of `visible::Solid::next_span`.

const TOUCH: f32 = 1e-3;
const PARALLEL: f32 = 1e-12;
const LOWEST: f32 = -3.0e38;
const HIGHEST: f32 = 3.0e38;

// The interval of t over which a ray is inside a box, and the axes of the planes at its ends.
struct BoxCrossing {
    enter: f32,
    exit: f32,
    enter_axis: u32,
    exit_axis: u32,
}

struct SolidSpan {
    point: vec3<f32>,
    t: f32,
    end: f32,
    axis: u32,
    found: bool,
}

fn cross_box(origin: vec3<f32>, direction: vec3<f32>, low: vec3<f32>, high: vec3<f32>) -> BoxCrossing {
    var crossing = BoxCrossing(LOWEST, HIGHEST, 0u, 0u);
    for (var axis = 0u; axis < 3u; axis += 1u) {
        let d = select(direction[axis], PARALLEL, abs(direction[axis]) < PARALLEL);
        let a = (low[axis] - origin[axis]) / d;
        let b = (high[axis] - origin[axis]) / d;
        if min(a, b) > crossing.enter {
            crossing.enter = min(a, b);
            crossing.enter_axis = axis;
        }
        if max(a, b) < crossing.exit {
            crossing.exit = max(a, b);
            crossing.exit_axis = axis;
        }
    }
    return crossing;
}

fn next_span(origin: vec3<f32>, direction: vec3<f32>, start: f32) -> SolidSpan {
    let outer = cross_box(origin, direction, params.box_low.xyz, params.box_high.xyz);
    var span: SolidSpan;
    span.t = max(outer.enter, start);
    span.axis = outer.enter_axis;
    var low = params.box_low.xyz;
    var high = params.box_high.xyz;
    var entering = true;
    for (var round = 0u; round <= params.cut_count; round += 1u) {
        var moved = false;
        for (var cut = 0u; cut < params.cut_count; cut += 1u) {
            let cut_low = params.cut_outs[2u * cut].xyz;
            let cut_high = params.cut_outs[2u * cut + 1u].xyz;
            let crossing = cross_box(origin, direction, cut_low, cut_high);
            if crossing.enter <= span.t + TOUCH && span.t + TOUCH < crossing.exit {
                span.t = crossing.exit;
                span.axis = crossing.exit_axis;
                low = cut_low;
                high = cut_high;
                entering = false;
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
    for (var cut = 0u; cut < params.cut_count; cut += 1u) {
        let crossing = cross_box(origin, direction, params.cut_outs[2u * cut].xyz, params.cut_outs[2u * cut + 1u].xyz);
        if crossing.enter > span.t + TOUCH && crossing.enter < crossing.exit {
            span.end = min(span.end, crossing.enter);
        }
    }
    span.point = origin + direction * span.t;
    if span.t != start {
        let forwards = direction[span.axis] >= 0.0;
        span.point[span.axis] = select(high[span.axis], low[span.axis], forwards == entering);
    }
    return span;
}
