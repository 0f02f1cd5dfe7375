//! SVG tiles from anyone: what a drawing may hold, so that it opens no file and its cost is bounded.
//!
//! A drawing is refused before it is converted if it holds an element that reads files or multiplies work
//! ([`REFUSED_ELEMENTS`]), declares entities, nests deeper than [`MAX_DEPTH`], or becomes larger than
//! [`MAX_ELEMENTS`] or [`MAX_EXPANDED_BYTES`] where every `use` stands for a copy of what it refers to. Clip paths
//! count for each element that they may clip. After conversion, filter functions, long paths and dense dashes are
//! refused. What is left is drawn in a time that is proportional to [`MAX_ELEMENTS`] full tiles, in one layer of a
//! tile for each level of nesting.

use std::collections::{HashMap, HashSet};

use resvg::usvg::roxmltree::{Document, Node, NodeId, ParsingOptions};
use resvg::usvg::{self, ImageHrefResolver};

use crate::TtfError;

/// Largest SVG file accepted as a tile, in bytes.
pub(crate) const MAX_SVG_BYTES: u64 = 4 << 20;

/// Deepest nesting of elements, with what `use` refers to in its place.
const MAX_DEPTH: usize = 64;

/// Most elements drawn, clip paths counted for each element that they may clip.
const MAX_ELEMENTS: u64 = 10_000;

/// Most bytes of attributes, with what `use` refers to in its place. An element counts [`ELEMENT_BYTES`] more.
const MAX_EXPANDED_BYTES: u64 = 8 << 20;

/// What an element without attributes costs, in bytes.
const ELEMENT_BYTES: u64 = 64;

/// Most attributes of an element, and most namespaces of a file: both are compared with one another.
const MAX_ATTRIBUTES: usize = 1000;

/// Most bytes of style sheets times elements: every rule is compared with every element.
const MAX_STYLE_WORK: u64 = 50_000_000;

/// Most lines and curves of one path.
const MAX_SEGMENTS: usize = 100_000;

/// Most dashes of one path.
const MAX_DASHES: f32 = 20_000.0;

/// How far a path may reach beyond the tile, in tiles.
pub const MOST_REACH: f32 = 4.0;

/// Elements that read other files, or whose cost multiplies from one to the next.
const REFUSED_ELEMENTS: [&str; 6] = ["image", "feImage", "filter", "marker", "mask", "pattern"];

/// Parses a drawing that may come from anyone. Nothing it names outside of itself is opened.
///
/// # Errors
/// [`TtfError::BadSvg`] if it is not an SVG, [`TtfError::RefusedSvg`] if a tile may not hold what it holds.
pub(crate) fn parse(name: &str, svg: &[u8]) -> Result<usvg::Tree, TtfError> {
    let refused = |fact: String| TtfError::RefusedSvg { name: name.to_owned(), fact };
    let bad = |source| TtfError::BadSvg { name: name.to_owned(), source };
    let text = std::str::from_utf8(svg).map_err(|_| bad(usvg::Error::NotAnUtf8Str))?;
    check_text(text).map_err(refused)?;
    let options = ParsingOptions { allow_dtd: true, nodes_limit: 500_000, ..ParsingOptions::default() };
    let document = Document::parse_with_options(text, options).map_err(|error| bad(error.into()))?;
    check_elements(&document).map_err(refused)?;
    let nothing = ImageHrefResolver { resolve_data: Box::new(|_, _, _| None), resolve_string: Box::new(|_, _| None) };
    let options = usvg::Options { image_href_resolver: nothing, ..usvg::Options::default() };
    let tree = usvg::Tree::from_xmltree(&document, &options).map_err(bad)?;
    let size = [tree.size().width(), tree.size().height()];
    check_group(tree.root(), size).map_err(refused)?;
    Ok(tree)
}

/// What must be known before the text is parsed: the parser's own work grows with the square of these.
fn check_text(text: &str) -> Result<(), String> {
    if text.len() as u64 > MAX_SVG_BYTES {
        return Err(format!("it has {} bytes, more than the limit of {MAX_SVG_BYTES}", text.len()));
    }
    if text.contains("<!ENTITY") {
        return Err("it declares entities".to_owned());
    }
    // No value holds a `<`, so an element's attributes lie between one and the next.
    if text.split('<').any(|tag| tag.matches('=').count() > MAX_ATTRIBUTES) {
        return Err(format!("an element has more than {MAX_ATTRIBUTES} attributes"));
    }
    if text.matches("xmlns").count() > MAX_ATTRIBUTES {
        return Err(format!("it declares more than {MAX_ATTRIBUTES} namespaces"));
    }
    Ok(())
}

/// What an element costs, with all that is in it.
#[derive(Debug, Clone, Copy)]
struct Cost {
    elements: u64,
    bytes: u64,
    depth: usize,
}

/// Costs of the elements of one drawing.
struct Costs<'a, 'input> {
    by_id: HashMap<&'a str, Node<'a, 'input>>,
    known: HashMap<NodeId, Cost>,
}

impl<'a, 'input> Costs<'a, 'input> {
    /// The cost of an element that `above` others hold.
    fn of(&mut self, node: Node<'a, 'input>, above: usize) -> Result<Cost, String> {
        let too_deep = || format!("its elements nest deeper than {MAX_DEPTH}");
        if above > MAX_DEPTH {
            return Err(too_deep());
        }
        if let Some(known) = self.known.get(&node.id()) {
            return if above + known.depth > MAX_DEPTH { Err(too_deep()) } else { Ok(*known) };
        }
        let bytes: usize = node.attributes().map(|attribute| attribute.value().len()).sum();
        let mut cost = Cost { elements: 1, bytes: ELEMENT_BYTES + bytes as u64, depth: 0 };
        let target = if node.tag_name().name() == "use" { self.target(node)? } else { None };
        for inside in node.children().filter(Node::is_element).chain(target) {
            let inner = self.of(inside, above + 1)?;
            cost.elements = cost.elements.saturating_add(inner.elements);
            cost.bytes = cost.bytes.saturating_add(inner.bytes);
            cost.depth = cost.depth.max(1 + inner.depth);
        }
        self.known.insert(node.id(), cost);
        Ok(cost)
    }

    /// The element that a `use` stands for.
    fn target(&self, node: Node<'a, 'input>) -> Result<Option<Node<'a, 'input>>, String> {
        let Some(reference) = node.attributes().find(|attribute| attribute.name() == "href") else {
            return Ok(None);
        };
        // Both of `href` and `xlink:href` may be there; whichever is followed, the other is no file.
        let links = node.attributes().filter(|attribute| attribute.name() == "href").count();
        match reference.value().trim().strip_prefix('#') {
            Some(id) if links == 1 => Ok(self.by_id.get(id).copied()),
            Some(_) => Err("a `use` has two references".to_owned()),
            None => Err("a `use` refers to another file".to_owned()),
        }
    }
}

fn check_elements(document: &Document) -> Result<(), String> {
    let mut costs = Costs { by_id: HashMap::new(), known: HashMap::new() };
    let mut style_text = String::new();
    for node in document.descendants().filter(Node::is_element) {
        let tag = node.tag_name().name();
        if REFUSED_ELEMENTS.contains(&tag) {
            return Err(format!("it holds an element `{tag}`"));
        }
        if tag == "style" {
            node.descendants().filter_map(|inside| inside.text()).for_each(|text| style_text.push_str(text));
        }
        if let Some(id) = node.attribute("id") {
            costs.by_id.entry(id).or_insert(node);
        }
    }
    let drawn = costs.of(document.root_element(), 1)?;
    let clip_share = clip_share(document, &mut costs, style_text.contains("clip-path"))?;
    let styled = drawn.elements.saturating_mul(style_text.len() as u64);
    let (elements, bytes) = (drawn.elements.saturating_mul(clip_share), drawn.bytes.saturating_mul(clip_share));
    if elements > MAX_ELEMENTS {
        return Err(format!("it draws {elements} elements, more than the limit of {MAX_ELEMENTS}"));
    }
    if bytes > MAX_EXPANDED_BYTES {
        return Err(format!("what it draws has {bytes} bytes, more than the limit of {MAX_EXPANDED_BYTES}"));
    }
    if styled > MAX_STYLE_WORK {
        return Err("its style sheets are too long for so many elements".to_owned());
    }
    Ok(())
}

/// How many elements may be drawn for one: itself, and those of the clip path that costs most. Where style sheets
/// clip, any clip path may be clipped by any other, so that their costs multiply.
fn clip_share<'a, 'input>(
    document: &'a Document<'input>,
    costs: &mut Costs<'a, 'input>,
    by_style: bool,
) -> Result<u64, String> {
    let mut share = 1u64;
    let is_clipped = |node: Node| {
        let attribute = node.attribute("clip-path").is_some_and(|value| value.trim() != "none");
        attribute || node.attribute("style").is_some_and(|style| style.contains("clip-path"))
    };
    for clip in document.descendants().filter(|node| node.tag_name().name() == "clipPath") {
        let cost = costs.of(clip, 1)?.elements;
        share = if by_style { share.saturating_mul(cost) } else { share.max(cost) };
        let mut open = vec![clip];
        let mut seen = HashSet::new();
        while let Some(node) = open.pop() {
            if !seen.insert(node.id()) {
                continue;
            }
            if is_clipped(node) {
                return Err("a clip path is itself clipped".to_owned());
            }
            let target = if node.tag_name().name() == "use" { costs.target(node)? } else { None };
            open.extend(node.children().filter(Node::is_element).chain(target));
        }
    }
    Ok(share)
}

/// What only the converted drawing tells: styles are resolved, and paths are in their final form.
fn check_group(group: &usvg::Group, size: [f32; 2]) -> Result<(), String> {
    if !group.filters().is_empty() {
        return Err("it uses a filter".to_owned());
    }
    let clip = group.clip_path().map(usvg::ClipPath::root);
    clip.map_or(Ok(()), |clip| check_group(clip, size))?;
    for node in group.children() {
        match node {
            usvg::Node::Group(inner) => check_group(inner, size)?,
            usvg::Node::Path(path) => check_path(path, size)?,
            usvg::Node::Image(_) => return Err("it holds an image".to_owned()),
            usvg::Node::Text(_) => {}
        }
    }
    Ok(())
}

fn check_path(path: &usvg::Path, size: [f32; 2]) -> Result<(), String> {
    let data = path.data();
    if data.len() > MAX_SEGMENTS {
        return Err(format!("a path has {} lines and curves, more than the limit of {MAX_SEGMENTS}", data.len()));
    }
    let Some(dashes) = path.stroke().and_then(usvg::Stroke::dasharray) else { return check_reach(path, size) };
    let period: f32 = dashes.iter().sum();
    let length: f32 = data.points().windows(2).map(|pair| pair[0].distance(pair[1])).sum();
    let count = length / period * dashes.len() as f32;
    // A count that is not a number stands for a length that is none.
    if count <= MAX_DASHES { check_reach(path, size) } else { Err(format!("a path has more than {MAX_DASHES} dashes")) }
}

/// Refuses what reaches far beyond the tile: the rasteriser's work, and the copies of a pattern, grow with it.
fn check_reach(path: &usvg::Path, size: [f32; 2]) -> Result<(), String> {
    let transform = path.abs_transform();
    let width = path.stroke().map_or(0.0, |stroke| stroke.width().get());
    let scale =
        [transform.sx, transform.kx, transform.ky, transform.sy].iter().fold(0.0, |most: f32, v| most.max(v.abs()));
    let mut places = path.data().points().to_vec();
    transform.map_points(&mut places);
    let reach = |p: &resvg::tiny_skia::Point| {
        let around = |at: f32, side: f32| ((at / side - 0.5).abs() + width * scale / side) - 0.5;
        around(p.x, size[0]).max(around(p.y, size[1]))
    };
    match places.iter().map(reach).find(|reach| !(..=MOST_REACH).contains(reach)) {
        Some(far) => Err(format!("a path reaches {far:.0} tiles beyond the tile, more than the limit of {MOST_REACH}")),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::raster::rasterize;

    fn drawing(inside: &str) -> String {
        format!(
            r#"<svg xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink" viewBox="0 0 10 10">{inside}</svg>"#
        )
    }

    fn refusal(svg: &str) -> String {
        match parse("tile", svg.as_bytes()) {
            Err(TtfError::RefusedSvg { fact, .. }) => fact,
            other => panic!("{other:?} for {}", &svg[..svg.len().min(300)]),
        }
    }

    #[test]
    fn what_drawing_programs_write_for_shapes_is_drawn() {
        for inside in [
            r##"<defs><linearGradient id="g"><stop offset="0" stop-color="red"/></linearGradient></defs><rect width="9" height="9" fill="url(#g)"/>"##,
            r##"<defs><path id="p" d="M0 0h5v5z"/></defs><use href="#p"/><use xlink:href="#p" x="2"/>"##,
            r##"<clipPath id="c"><rect width="5" height="5"/></clipPath><g clip-path="url(#c)"><path d="M0 0h9v9z"/></g>"##,
            r##"<style>.a{fill:#123456;clip-path:url(#c)}</style><clipPath id="c"><rect width="5" height="5"/></clipPath><rect class="a" width="9" height="9"/>"##,
            r##"<path d="M0 0L9 9" stroke="red" stroke-dasharray="1 0.5" style="filter:none"/>"##,
        ] {
            rasterize("tile", drawing(inside).as_bytes()).unwrap();
        }
        let doctype = r#"<?xml version="1.0"?><!DOCTYPE svg PUBLIC "-//W3C//DTD SVG 1.1//EN" "http://www.w3.org/Graphics/SVG/1.1/DTD/svg11.dtd">"#;
        rasterize("tile", format!("{doctype}{}", drawing("<rect width=\"1\" height=\"1\"/>")).as_bytes()).unwrap();
    }

    #[test]
    fn what_reads_files_or_has_no_bound_is_refused_and_named() {
        for (inside, word) in [
            (r#"<image href="/dev/zero" width="1" height="1"/>"#, "`image`"),
            (r#"<image href="data:image/svg+xml;base64,PHN2Zy8+"/>"#, "`image`"),
            (r##"<filter id="f"><feFlood/></filter>"##, "`filter`"),
            (r#"<rect width="5" height="5" filter="blur(1000)"/>"#, "filter"),
            (r#"<rect width="5" height="5" style="filter:blur(1000)"/>"#, "filter"),
            (r#"<style>rect{filter:blur(9)}</style><rect width="5" height="5"/>"#, "filter"),
            (r#"<pattern id="p" width="1" height="1"/>"#, "`pattern`"),
            (r#"<use href="other.svg#a"/>"#, "another file"),
            (r##"<g id="a"><use href="#a"/></g>"##, "deeper"),
            (r##"<clipPath id="a" clip-path="url(#b)"><rect width="1" height="1"/></clipPath>"##, "clipped"),
            (r#"<path d="M0 0L40 0" stroke="red" stroke-dasharray="0.001"/>"#, "dashes"),
            (r#"<path d="M-1e5 -1e5 L 1e5 1e5 L 1e5 0 Z"/>"#, "beyond the tile"),
            (r#"<path d="M-1e9 -1e9 L 1e9 1e9 L 1e9 0 Z"/>"#, "beyond the tile"),
            (r#"<path d="M-1e38 -1e38 L 1e38 1e38 L 1e38 0 Z"/>"#, "beyond the tile"),
            (r#"<g transform="scale(1e6)"><path d="M0 0 L 5 5 L 5 0 Z"/></g>"#, "beyond the tile"),
            (r#"<path d="M0 0L9 9" stroke="red" stroke-width="1e6"/>"#, "beyond the tile"),
            (
                r##"<clipPath id="c"><rect x="-1e7" width="2e7" height="5"/></clipPath><g clip-path="url(#c)"><path d="M0 0h9v9z"/></g>"##,
                "beyond the tile",
            ),
        ] {
            let fact = refusal(&drawing(inside));
            assert!(fact.contains(word), "{fact} for {inside}");
        }
        let entity = format!(r#"<!DOCTYPE svg [<!ENTITY a "b">]>{}"#, drawing("&a;"));
        assert!(refusal(&entity).contains("entities"));
    }

    #[test]
    fn work_that_multiplies_is_counted_before_it_is_done() {
        let mut doubling = String::from(r#"<g id="a0"><rect width="1" height="1"/></g>"#);
        for level in 1..40 {
            let below = level - 1;
            doubling += &format!(r##"<g id="a{level}"><use href="#a{below}"/><use href="#a{below}"/></g>"##);
        }
        assert!(refusal(&drawing(&doubling)).contains("elements"));
        let nested = format!("{}{}", "<g>".repeat(100_000), "</g>".repeat(100_000));
        assert!(refusal(&drawing(&nested)).contains("deeper"));
        let long =
            format!(r##"<path id="p" d="M0 0{}"/>{}"##, "h1".repeat(50_000), r##"<use href="#p"/>"##.repeat(200));
        assert!(refusal(&drawing(&long)).contains("bytes"));
        let path = format!(r#"<path d="M0 0{}"/>"#, "h1".repeat(MAX_SEGMENTS + 1));
        assert!(refusal(&drawing(&path)).contains("lines and curves"));
        let clips = format!(
            r##"<clipPath id="c">{}</clipPath>{}"##,
            r#"<rect width="1" height="1"/>"#.repeat(200),
            r##"<rect width="1" height="1" clip-path="url(#c)"/>"##.repeat(200)
        );
        assert!(refusal(&drawing(&clips)).contains("elements"));
        let rules = format!("<style>{}</style>{}", "g a{fill:red}".repeat(2000), "<g/>".repeat(5000));
        assert!(refusal(&drawing(&rules)).contains("style sheets"));
        let attributes: String = (0..2000).map(|n| format!(" a{n}=\"\"")).collect();
        assert!(refusal(&drawing(&format!("<g{attributes}/>"))).contains("attributes"));
    }

    #[test]
    fn the_deepest_drawing_fits_a_small_stack() {
        let depth = MAX_DEPTH - 3;
        let (open, close) = ("<g opacity=\"0.5\">".repeat(depth), "</g>".repeat(depth));
        let svg = drawing(&format!("{open}<rect width=\"9\" height=\"9\"/>{close}"));
        let small = std::thread::Builder::new().stack_size(2 << 20);
        let drawn = small.spawn(move || rasterize("tile", svg.as_bytes()).map(|_| ())).unwrap();
        drawn.join().unwrap().unwrap();
    }
}
