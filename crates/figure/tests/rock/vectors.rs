//! A page of paths beside the same page of pictures.

use crate::fold::Fold;
use image::{GrayImage, RgbaImage};
use page::list::{GroupKind, Item};
use page::{DisplayList, raster};
use render::{Camera, Ground, Scene, VoxelBox};

fn scene(ground: Option<Ground>) -> Scene {
    let whole = VoxelBox::of_size([61, 41, 51]);
    Scene {
        size_px: [640, 450],
        samples: 2,
        exaggeration: 1.0,
        camera: Camera { azimuth_deg: Some(35.0), ..Camera::default() },
        cut_outs: vec![whole.corner_cut(render::Corner::MinMin, [0.4, 0.4])],
        ground,
        ..Scene::default()
    }
}

/// Grey values, each the mean of five by five pixels on white.
fn blurred(image: &RgbaImage) -> GrayImage {
    let grey = |x: i64, y: i64| {
        let [x, y] = [x.clamp(0, i64::from(image.width()) - 1), y.clamp(0, i64::from(image.height()) - 1)];
        let [r, g, b, a] = image.get_pixel(x as u32, y as u32).0.map(f64::from);
        let on_white = 255.0 - a;
        (0.299 * r + 0.587 * g + 0.114 * b) * a / 255.0 + on_white
    };
    GrayImage::from_fn(image.width(), image.height(), |x, y| {
        let around = (-2..=2).flat_map(|dx| (-2..=2).map(move |dy| (dx, dy)));
        let sum: f64 = around.map(|(dx, dy)| grey(i64::from(x) + dx, i64::from(y) + dy)).sum();
        image::Luma([(sum / 25.0).round() as u8])
    })
}

/// Mean structural similarity of windows of eight by eight pixels that are not paper in both.
fn similarity(a: &RgbaImage, b: &RgbaImage) -> f64 {
    let (a, b) = (blurred(a), blurred(b));
    let mut found = Vec::new();
    for x in (0..a.width() - 8).step_by(4) {
        for y in (0..a.height() - 8).step_by(4) {
            let of = |image: &GrayImage| -> Vec<f64> {
                (0..64).map(|n| f64::from(image.get_pixel(x + n % 8, y + n / 8).0[0])).collect()
            };
            let (p, q) = (of(&a), of(&b));
            if p.iter().chain(&q).all(|value| *value >= 254.0) {
                continue;
            }
            let mean = |values: &[f64]| values.iter().sum::<f64>() / 64.0;
            let (mp, mq) = (mean(&p), mean(&q));
            let with = |u: &[f64], mu: f64, v: &[f64], mv: f64| {
                u.iter().zip(v).map(|(u, v)| (u - mu) * (v - mv)).sum::<f64>() / 63.0
            };
            let (c1, c2) = ((0.01f64 * 255.0).powi(2), (0.03f64 * 255.0).powi(2));
            let cross = with(&p, mp, &q, mq);
            let (vp, vq) = (with(&p, mp, &p, mp), with(&q, mq, &q, mq));
            found.push((2.0 * mp * mq + c1) * (2.0 * cross + c2) / ((mp * mp + mq * mq + c1) * (vp + vq + c2)));
        }
    }
    assert!(found.len() > 2000);
    found.iter().sum::<f64>() / found.len() as f64
}

#[test]
fn paths_look_like_the_picture() {
    let fold = Fold::new();
    for ground in [None, Some(Ground::default())] {
        let scene = scene(ground);
        let [paths, pictures] = [true, false].map(|has_vectors| fold.page(&scene, has_vectors));
        let [paths, pictures] = [paths, pictures].map(|page| raster(&page, 200.0).unwrap());
        let alike = similarity(&paths, &pictures);
        assert!(alike > 0.93, "{alike} with {ground:?}");
        // The measure tells a shift of the patterns.
        let other = Scene { global_frequency: 1.1, ..scene };
        let other = raster(&fold.page(&other, true), 200.0).unwrap();
        assert!(similarity(&other, &pictures) < alike - 0.05);
    }
}

#[test]
fn each_layer_horizon_and_fault_has_one_group_of_its_name() {
    let fold = Fold::new();
    for ground in [None, Some(Ground::default())] {
        let has_ground = ground.is_some();
        groups_of(&fold, &fold.page(&scene(ground), true), has_ground);
    }
}

fn groups_of(fold: &Fold, page: &DisplayList, has_ground: bool) {
    let mut names: Vec<(GroupKind, String)> = Vec::new();
    fn gather(items: &[Item], names: &mut Vec<(GroupKind, String)>) {
        for item in items {
            if let Item::Group(group) = item {
                if group.kind != GroupKind::Part {
                    names.push((group.kind, group.name.clone()));
                }
                gather(&group.items, names);
            }
        }
    }
    gather(&page.items, &mut names);
    let of = |kind: GroupKind| {
        let names = names.iter().filter(|(found, _)| *found == kind);
        names.map(|(_, name)| name.as_str()).collect::<Vec<_>>()
    };
    let mut layers = of(GroupKind::Layer);
    layers.sort_unstable();
    let mut expected: Vec<&str> = fold.layers.iter().map(|style| style.layer.as_str()).collect();
    // Above the first horizon there is air over a ground.
    expected.retain(|name| !(has_ground && *name == "above H1"));
    expected.sort_unstable();
    assert_eq!(layers, expected);
    assert_eq!(of(GroupKind::Horizon)[..3], ["H1", "H2", "H3"]);
    assert_eq!(of(GroupKind::Fault), ["F1"]);
    // No pixels at all but those of a ground.
    assert_eq!(page.leaves().iter().any(|item| matches!(item, Item::Picture(_))), has_ground);
}
