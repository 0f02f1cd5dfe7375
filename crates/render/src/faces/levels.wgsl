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

// About the distance of a voxel position from a level surface in m, positive on the older side or inside (w), and its
// derivatives per voxel (xyz): the twin of `LevelSurface::sample_m`.
fn level_distance(info: SheetInfo, p: vec3<f32>) -> vec4<f32> {
    return (level_sample(info.level, p) - vec4(0.0, 0.0, 0.0, info.at)) * info.scale_m;
}
