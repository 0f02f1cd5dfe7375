//! Paints items of a figure's page on the screen: egui paints the same display list that is printed.
//!
//! A point of the page is [`SCALE`] points of the screen, so that a page's 7-point numbers are as large as
//! the window's own. Images are painted as the texture that the view keeps of them, small ones pixel by
//! pixel.

use eframe::egui::{
    Align2, Color32, FontId, Mesh, Painter, Pos2, Rect, Shape, Stroke as Line, TextureId, Vec2, Visuals,
    epaint::{TextShape, Vertex},
    pos2, vec2,
};
use glam::DVec2;
use page::list::{Across, Cap, Group, Ink, Item, Path, PathItem, Picture, Segment, Stroke, Text, Upright};
use std::f32::consts::PI;
use ttf::Colour;

/// Points of the screen to a point of the page.
pub(crate) const SCALE: f64 = 1.64;
/// Line segments that approximate a curve.
const PIECES: usize = 8;
/// Images of up to this many pixels are painted pixel by pixel where there is no texture of them.
const SMALL_PX: u32 = 512;
/// Copies of a text that form its halo.
const RIM: usize = 8;

/// Converts a point of the screen to a point of the page.
pub(crate) fn page(at: Pos2) -> DVec2 {
    DVec2::new(f64::from(at.x), f64::from(at.y)) / SCALE
}

/// Converts a point of the page to a point of the screen.
pub(crate) fn screen(at: DVec2) -> Pos2 {
    let at = at * SCALE;
    pos2(at.x as f32, at.y as f32)
}

/// Converts a rectangle of the screen to one of the page.
pub(crate) fn page_rect(rect: Rect) -> page::Rect {
    page::Rect::new(page(rect.min), page(rect.max))
}

/// Paints a group; `texture` stands for its images.
pub(crate) fn paint(painter: &Painter, group: &Group, texture: Option<TextureId>) {
    let clipped = group.clip.as_ref().and_then(Path::bounds).map(|bounds| {
        let clip = Rect::from_min_max(screen(bounds.min), screen(bounds.max));
        painter.with_clip_rect(clip.intersect(painter.clip_rect()))
    });
    let painter = clipped.as_ref().unwrap_or(painter);
    for item in &group.items {
        match item {
            Item::Group(group) => paint(painter, group, texture),
            Item::Path(path) => paint_path(painter, path),
            Item::Text(text) => text.straight().iter().for_each(|line| paint_text(painter, line)),
            Item::Picture(picture) => paint_picture(painter, picture, texture),
        }
    }
}

/// The same group with letters and lines in the ink of the window's own words: what stands on the window and not on
/// paper, whatever the theme.
#[must_use]
pub(crate) fn on_window(mut group: Group, visuals: &Visuals) -> Group {
    let [r, g, b, _] = visuals.text_color().to_array();
    let ink = Ink::glass(Colour::new(r, g, b), 0.8);
    for item in &mut group.items {
        match item {
            Item::Text(text) => text.ink = ink,
            Item::Path(path) => path.stroke.iter_mut().for_each(|stroke| stroke.ink = ink),
            _ => {}
        }
    }
    group
}

fn colour(ink: Ink) -> Color32 {
    let [r, g, b] = ink.colour.rgb;
    Color32::from_rgba_unmultiplied(r, g, b, (ink.opacity.clamp(0.0, 1.0) * 255.0).round() as u8)
}

/// The segments of a path as straight lines on the screen.
fn pieces(path: &Path) -> Vec<Vec<Pos2>> {
    let mut pieces: Vec<Vec<DVec2>> = Vec::new();
    for segment in &path.segments {
        match *segment {
            Segment::Move(at) => pieces.push(vec![at]),
            Segment::Line(at) => pieces.last_mut().into_iter().for_each(|piece| piece.push(at)),
            Segment::Cubic(b, c, d) => {
                let Some(piece) = pieces.last_mut() else { continue };
                let a = piece.last().copied().unwrap_or(b);
                for n in 1..=PIECES {
                    let t = n as f64 / PIECES as f64;
                    let u = 1.0 - t;
                    piece.push(u * u * u * a + 3.0 * u * u * t * b + 3.0 * u * t * t * c + t * t * t * d);
                }
            }
            Segment::Close => {
                let Some(piece) = pieces.last_mut() else { continue };
                piece.extend(piece.first().copied());
            }
        }
    }
    pieces.into_iter().map(|piece| piece.into_iter().map(screen).collect()).collect()
}

fn paint_path(painter: &Painter, item: &PathItem) {
    let pieces = pieces(&item.path);
    if let Some(ink) = item.fill {
        for piece in &pieces {
            painter.add(Shape::convex_polygon(piece.clone(), colour(ink), Line::NONE));
        }
    }
    if let Some(stroke) = &item.stroke {
        pieces.iter().for_each(|piece| paint_line(painter, piece, stroke));
    }
}

fn paint_line(painter: &Painter, places: &[Pos2], stroke: &Stroke) {
    let line = Line::new((stroke.width * SCALE) as f32, colour(stroke.ink));
    let lengths: Vec<f32> = stroke.dashes.iter().map(|length| (length * SCALE) as f32).collect();
    match (lengths.as_slice(), stroke.cap) {
        ([dash, pitch], Cap::Round) if *dash <= 0.0 => {
            painter.extend(Shape::dotted_line(places, line.color, *pitch, 0.5 * line.width));
        }
        ([dash, gap], _) => painter.extend(Shape::dashed_line(places, line, *dash, *gap)),
        _ => drop(painter.add(Shape::line(places.to_vec(), line))),
    }
}

fn paint_text(painter: &Painter, text: &Text) {
    let font = FontId::proportional((text.size * SCALE) as f32);
    let ink = colour(text.ink);
    let galley = painter.layout_no_wrap(text.text.clone(), font, ink);
    let across = match text.anchor.across {
        Across::Start => 0.0,
        Across::Middle => 0.5,
        Across::End => 1.0,
    };
    // In this typeface the baseline lies at four fifths of the line height, and capitals reach up to one fifth.
    let upright = match text.anchor.upright {
        Upright::Baseline => 0.8,
        Upright::Middle => 0.5,
        Upright::Top => 0.2,
    };
    let turn = text.turn_deg.to_radians() as f32;
    let off =
        Vec2::angled(turn) * (-across * galley.size().x) + Vec2::angled(turn + 0.5 * PI) * (-upright * galley.size().y);
    let at = screen(text.at) + off;
    let shape = |off: Vec2, colour: Color32| {
        let shape = TextShape::new(at + off, galley.clone(), colour).with_override_text_color(colour);
        shape.with_angle_and_anchor(turn, Align2::LEFT_TOP)
    };
    if let Some(halo) = text.halo {
        for n in 0..RIM {
            let around = Vec2::angled(n as f32 * 2.0 * PI / RIM as f32) * (halo.width * SCALE) as f32;
            painter.add(shape(around, colour(halo.ink)));
        }
    }
    painter.add(shape(Vec2::ZERO, ink));
}

fn paint_picture(painter: &Painter, picture: &Picture, texture: Option<TextureId>) {
    let (width, height) = picture.pixels.dimensions();
    if width * height <= SMALL_PX {
        let step = [picture.right / f64::from(width), picture.down / f64::from(height)];
        let mut mesh = Mesh::default();
        for (x, y, pixel) in picture.pixels.enumerate_pixels() {
            let corner = picture.corner + step[0] * f64::from(x) + step[1] * f64::from(y);
            let rect = Rect::from_two_pos(screen(corner), screen(corner + step[0] + step[1]));
            let [r, g, b, a] = pixel.0;
            mesh.add_colored_rect(rect, Color32::from_rgba_unmultiplied(r, g, b, a));
        }
        painter.add(Shape::mesh(mesh));
        return;
    }
    let Some(texture) = texture else { return };
    let mut mesh = Mesh::with_texture(texture);
    let uvs = [vec2(0.0, 0.0), vec2(1.0, 0.0), vec2(1.0, 1.0), vec2(0.0, 1.0)];
    for (corner, uv) in picture.corners().into_iter().zip(uvs) {
        mesh.vertices.push(Vertex { pos: screen(corner), uv: uv.to_pos2(), color: Color32::WHITE });
    }
    mesh.indices = vec![0, 1, 2, 0, 2, 3];
    painter.add(Shape::mesh(mesh));
}

#[cfg(test)]
mod tests {
    use super::*;
    use page::list::GroupKind;

    #[test]
    fn places_go_to_the_page_and_back() {
        let at = pos2(123.0, 45.5);
        assert!((screen(page(at)) - at).length() < 1e-4);
    }

    #[test]
    fn what_stands_on_the_window_has_the_ink_of_its_words() {
        let dark = Ink::solid(Colour::BLACK);
        let mark = PathItem::stroked(Path::line(&[DVec2::ZERO, DVec2::ONE]), Stroke::new(1.0, dark));
        let axes = Group::new(GroupKind::Annotation, "axes").with([Text::new(DVec2::ZERO, "12").into(), mark.into()]);
        let group = on_window(axes, &Visuals::dark());
        let inks = group.items.iter().filter_map(|item| match item {
            Item::Text(text) => Some(text.ink),
            Item::Path(path) => path.stroke.as_ref().map(|stroke| stroke.ink),
            _ => None,
        });
        let [r, g, b, _] = Visuals::dark().text_color().to_array();
        let inks: Vec<Ink> = inks.collect();
        assert_eq!(inks.len(), 2);
        assert!(inks.iter().all(|ink| ink.colour == Colour::new(r, g, b)), "{inks:?}");
    }

    #[test]
    fn closed_paths_end_where_they_began_and_curves_keep_their_ends() {
        let circle = pieces(&Path::circle(DVec2::new(10.0, 10.0), 4.0));
        assert_eq!((circle.len(), circle[0].first()), (1, circle[0].last()));
        assert!(circle[0].len() > 4 * PIECES);
    }
}
