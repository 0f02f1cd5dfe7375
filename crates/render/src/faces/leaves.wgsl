// Colours of leaves and what faces show of horizon candidates: the twin of `leaves`.

// What faces show: 0 rock, 1 leaves, 2 distances.
override face_data: u32 = 0u;
const FACES_LEAVES: u32 = 1u;
const FACES_DISTANCE: u32 = 2u;

const HALF_WIDTH: f32 = 0.8;
const FADE: f32 = 0.5;
const BLACK_AT: f32 = 10.0;
const BORDER: f32 = 0.75;
const BORDER_REACH: f32 = 2.0;
const BORDER_TONE: f32 = 0.35;

fn leaf_colour(id: u32) -> vec3<f32> {
    let hash = id * 0x9e3779b9u;
    let hue = f32(hash >> 8u) / 16777216.0 * 6.0;
    let saturation = 0.5 + 0.15 * f32(hash % 3u);
    let value = 0.98 - 0.12 * f32(hash / 3u % 3u);
    let k = (vec3(5.0, 3.0, 1.0) + hue) % 6.0;
    return value - value * saturation * clamp(min(k, 4.0 - k), vec3(0.0), vec3(1.0));
}

// The number that a leaf is coloured by; 0 = not shown.
fn leaf_group(leaf: u32) -> u32 {
    if media.leaves.w == NONE {
        return leaf;
    }
    if leaf >= media.groups {
        return 0u;
    }
    return relief_map[media.leaves.w + leaf];
}

// The group of the nearest sample, 0 where that is far from its surface.
fn group_near(p: vec3<f32>) -> u32 {
    let at = min(vec3<u32>(max(p + 0.5, vec3(0.0))), media.candidates.xyz - 1u);
    if textureLoad(distances, at.zyx, 0).r * 255.0 * media.scales.w > BORDER_REACH {
        return 0u;
    }
    return leaf_group(textureLoad(leaf_ids, at.zyx, 0).r);
}

fn differ(a: u32, b: u32) -> bool {
    return a != b && a != 0u && b != 0u;
}

fn is_border(p: vec3<f32>) -> bool {
    let x = vec3(BORDER, 0.0, 0.0);
    let y = vec3(0.0, BORDER, 0.0);
    return differ(group_near(p + x), group_near(p - x)) || differ(group_near(p + y), group_near(p - y));
}

// The colour of a face with the candidates it is to show.
fn with_candidates(p: vec3<f32>, rock: vec3<f32>) -> vec3<f32> {
    if face_data == FACES_DISTANCE {
        return vec3(clamp(1.0 - distance_at(p) / BLACK_AT, 0.0, 1.0));
    }
    if face_data == FACES_LEAVES {
        let group = leaf_group(leaf_at(p));
        if group != 0u {
            return mix(rock, leaf_colour(group), clamp((HALF_WIDTH - distance_at(p)) / FADE + 0.5, 0.0, 1.0));
        }
    }
    return rock;
}
