// Functions over a box of the voxel lattice whose level surfaces are horizons of any shape: the twin of `LevelField`.
//
// A field in the pool begins with nine words: origin and step along x, y, z, voxels, and the counts of nodes as the
// bits of whole numbers. Its values follow, [x][y][z].

// 1 if a horizon of the model is no height field.
override has_levels: u32 = 0u;

const LEVEL_HEADER: u32 = 9u;

// Value (w) and slopes per voxel (xyz).
fn level_sample(level: u32, p: vec3<f32>) -> vec4<f32> {
    let origin = vec3(pool(level), pool(level + 1u), pool(level + 2u));
    let step = vec3(pool(level + 3u), pool(level + 4u), pool(level + 5u));
    let size = bitcast<vec3<u32>>(vec3(pool(level + 6u), pool(level + 7u), pool(level + 8u)));
    let at = clamp((p - origin) / step, vec3(0.0), vec3<f32>(size - 1u));
    let cell = min(vec3<u32>(at), size - 2u);
    let f = at - vec3<f32>(cell);
    let node = level + LEVEL_HEADER + (cell.x * size.y + cell.y) * size.z + cell.z;
    let across_y = size.z;
    let across_x = size.y * size.z;
    // Along z at the four edges of the cell, x slower than y.
    let low = vec4(pool(node), pool(node + across_y), pool(node + across_x), pool(node + across_x + across_y));
    let next = node + 1u;
    let high = vec4(pool(next), pool(next + across_y), pool(next + across_x), pool(next + across_x + across_y));
    let rise = high - low;
    let along_z = low + rise * f.z;
    let rise_y = rise.xz + (rise.yw - rise.xz) * f.y;
    let slope_y = along_z.yw - along_z.xz;
    let along_y = along_z.xz + slope_y * f.y;
    let slope_x = along_y.y - along_y.x;
    let slopes = vec3(slope_x, slope_y.x + (slope_y.y - slope_y.x) * f.x, rise_y.x + (rise_y.y - rise_y.x) * f.x);
    return vec4(slopes / step, along_y.x + slope_x * f.x);
}

// `weights` of the nodes before, at the beginning, at the end and behind a cell, where nodes beyond the box continue the
// last two.
fn weights_at_border(weights: vec4<f32>, cell: u32, count: u32) -> vec4<f32> {
    var w = weights;
    if cell == 0u {
        w = vec4(0.0, w.y + 2.0 * w.x, w.z - w.x, w.w);
    }
    if cell + 2u == count {
        w = vec4(w.x, w.y - w.w, w.z + 2.0 * w.w, 0.0);
    }
    return w;
}

// Value (w) and slopes per voxel (xyz) of the Catmull-Rom tricubic: the twin of `tricubic::sample`.
fn level_cubic(level: u32, p: vec3<f32>) -> vec4<f32> {
    let origin = vec3(pool(level), pool(level + 1u), pool(level + 2u));
    let step = vec3(pool(level + 3u), pool(level + 4u), pool(level + 5u));
    let size = bitcast<vec3<u32>>(vec3(pool(level + 6u), pool(level + 7u), pool(level + 8u)));
    let at = clamp((p - origin) / step, vec3(0.0), vec3<f32>(size - 1u));
    let cell = min(vec3<u32>(at), size - 2u);
    let f = at - vec3<f32>(cell);
    let wx = weights_at_border(cubic_weights(f.x), cell.x, size.x);
    let sx = weights_at_border(cubic_slopes(f.x), cell.x, size.x);
    let wy = weights_at_border(cubic_weights(f.y), cell.y, size.y);
    let sy = weights_at_border(cubic_slopes(f.y), cell.y, size.y);
    let wz = weights_at_border(cubic_weights(f.z), cell.z, size.z);
    let sz = weights_at_border(cubic_slopes(f.z), cell.z, size.z);
    let along_z = clamp(vec4<i32>(-1, 0, 1, 2) + i32(cell.z), vec4(0), vec4(i32(size.z) - 1));
    var sum = vec4(0.0);
    for (var a = 0u; a < 4u; a++) {
        // Value, and derivatives along y and z, of a plane.
        var plane = vec3(0.0);
        let x = u32(clamp(i32(cell.x + a) - 1, 0, i32(size.x) - 1));
        for (var b = 0u; b < 4u; b++) {
            let y = u32(clamp(i32(cell.y + b) - 1, 0, i32(size.y) - 1));
            let row = level + LEVEL_HEADER + (x * size.y + y) * size.z;
            let n = vec4<u32>(along_z) + row;
            let node = vec4(pool(n.x), pool(n.y), pool(n.z), pool(n.w));
            let value = dot(wz, node);
            plane += vec3(wy[b] * value, sy[b] * value, wy[b] * dot(sz, node));
        }
        sum += vec4(sx[a] * plane.x, wx[a] * plane.y, wx[a] * plane.z, wx[a] * plane.x);
    }
    return vec4(sum.xyz / step, sum.w);
}

// About the distance of a voxel position from a level surface in m, positive on the older side or inside (w), and its
// derivatives per voxel (xyz): the twin of `LevelSurface::sample_m`.
fn level_distance(info: SheetInfo, p: vec3<f32>) -> vec4<f32> {
    return (level_sample(info.level, p) - vec4(0.0, 0.0, 0.0, info.at)) * info.scale_m;
}
