//! Figures: what each page shows, what is refused, and that window and command line make the same page.

use crate::program::{project, run_in};
use image::RgbImage;
use std::fs;
use std::path::Path;
use std::process::Command;

const SMALL: &str = "--size-cm 12x9 --dpi 60 --samples 1 --device cpu";

fn picture(at: &Path, options: &str) -> RgbImage {
    run_in(at, &format!("render p.petro a.png {options} {SMALL}")).done();
    image::open(at.join("a.png")).unwrap().to_rgb8()
}

/// Pixels that are neither grey nor nearly so.
fn coloured(image: &RgbImage) -> usize {
    let spread = |p: &image::Rgb<u8>| p.0.iter().max().unwrap() - p.0.iter().min().unwrap();
    image.pixels().filter(|p| spread(p) > 40).count()
}

#[test]
fn every_figure_is_a_page_of_its_own_in_its_printed_size() {
    let folder = project();
    let at = folder.path();
    let asked = [
        "--inline 120",
        "--inline 120 --section-blend 0",
        "--inline 120 --section-blend 0.5",
        "--fence 105,505 120,530 140,535 --section-blend 0",
        "--crossline 520 --legend",
        "--slice 200 --scale-bar",
        "--map Bravo --scale-bar",
        "--map Alpha --thickness-to Bravo",
        "--technique map",
        "--interpretation --inline 120",
        "--block --map Bravo --legend",
        "--compare 0,1 --wipe 0.4",
        "--compare 0,1",
        "--scale-bar",
    ];
    let mut pages: Vec<RgbImage> = Vec::new();
    for options in asked {
        let page = picture(at, options);
        assert_eq!(page.dimensions(), (283, 213), "{options}");
        assert!(coloured(&page) > 1500, "{options}: {}", coloured(&page));
        assert!(pages.iter().all(|other| *other != page), "{options} is as one before");
        pages.push(page);
    }
    let fence =
        run_in(at, &format!("render p.petro a.png {SMALL} --fence 105,505 120,530 140,535 --json")).done().json();
    assert_eq!((fence["size_px"][0].as_u64(), fence["parts"].as_u64()), (Some(283), Some(1)));
}

#[test]
fn the_distortion_that_is_shown_is_measured_on_every_page() {
    let folder = project();
    let at = folder.path();
    let measured = |file: &str, size: &str| {
        let said =
            run_in(at, &format!("render p.petro {file} --show distortion --samples 1 --device cpu {size} --json"));
        let said = said.done().json();
        assert_eq!(said["distortion"].as_array().map(Vec::len), Some(5), "{file}");
        said["distortion_share"].as_f64().unwrap()
    };
    let [picture, page, vectors] =
        [("a.png", "--size 283x213"), ("b.png", "--size-cm 12x9 --dpi 60"), ("c.svg", "--size-cm 12x9 --dpi 60")]
            .map(|(file, size)| measured(file, size));
    assert!(
        (0.0..1.0).contains(&picture) && (page - picture).abs() < 0.02 && vectors == page,
        "{picture} {page} {vectors}"
    );
}

#[test]
fn a_figure_from_a_file_is_the_one_that_is_typed() {
    let folder = project();
    let at = folder.path();
    let typed = picture(at, "--inline 120 --scale-bar");
    let text = "size = { cm = [12.0, 9.0] }\ndpi = 60.0\nscale_bar = true\n[[parts]]\nsection = { kind = 'inline', at = 120.0 }\n";
    fs::write(at.join("figure.toml"), text).unwrap();
    run_in(at, "render p.petro b.png --figure figure.toml --device cpu").done();
    assert!(image::open(at.join("b.png")).unwrap().to_rgb8() == typed);
}

#[test]
fn what_is_not_there_is_said_with_what_helps() {
    let folder = project();
    let at = folder.path();
    let refused = |options: &str, words: &[&str]| {
        run_in(at, &format!("render p.petro a.png {options}")).failed(words);
        assert!(!at.join("a.png").exists(), "{options}");
    };
    refused("--inline 4711", &["inline 4711", "outside the survey", "101 to 148"]);
    refused("--slice -5", &["outside the survey"]);
    refused("--map Omega", &["no map of horizon Omega"]);
    refused("--map Bravo --thickness-to Alpha", &["no map of the thickness from Bravo down to Alpha"]);
    refused("--fence 105,505 105,505", &["two corners"]);
    refused("--inline 120 --size-cm 0.5x0.5 --dpi 60", &["no room"]);
    refused("--inline 120 --size-cm 500x500 --dpi 1200", &["pixels"]);
    let usage = run_in(at, "render p.petro a.png --fence 105,505 5");
    assert_eq!(usage.code, 2, "{}", usage.stderr);
    assert_eq!(run_in(at, "render p.petro a.png --compare 0,1 --wipe 2").code, 2);
}

#[test]
fn water_fills_the_block_above_the_ground_up_to_its_level_in_every_format() {
    let folder = project();
    let at = folder.path();
    let blue = |image: &RgbImage| image.pixels().filter(|p| i16::from(p.0[2]) > i16::from(p.0[0]) + 25).count();
    let air = picture(at, "--block --ground on");
    let water = picture(at, "--block --water 0");
    assert!(blue(&water) > blue(&air) + 1000, "{} {}", blue(&water), blue(&air));
    // A picture of the block alone has it too.
    run_in(at, "render p.petro b.png --water 0 --size 160x120 --samples 1 --device cpu").done();
    assert!(blue(&image::open(at.join("b.png")).unwrap().to_rgb8()) > 300);
    run_in(at, &format!("render p.petro a.svg --water 20 --legend {SMALL}")).done();
    let svg = fs::read_to_string(at.join("a.svg")).unwrap();
    assert_eq!(svg.matches("inkscape:label=\"Water\"").count(), 2, "the body and its entry in the legend");
    // Scenes keep it, and it can be switched off.
    run_in(at, "scene add p.petro sea --water 0").done();
    assert!(run_in(at, "scene show p.petro sea").done().stdout.contains("[water]"));
    assert!(blue(&picture(at, "--block --scene sea --water off")) < blue(&water) / 2);
    run_in(at, "render p.petro a.png --water 90000").failed(&["roaming box"]);
    assert_eq!(run_in(at, "render p.petro a.png --water high").code, 2);
}

/// A block alone, and one on a page: every ending that holds pixels has the same ones, those of the animation and of the
/// figures of a project too.
#[test]
fn every_ending_of_pixels_has_the_same_pixels() {
    let folder = project();
    let at = folder.path();
    for (n, options) in [
        "--cut nearest,0.4,0.4",
        "--background transparent",
        "--ground on --water 0",
        "--blend 0.5",
        "--scale-bar --legend",
    ]
    .into_iter()
    .enumerate()
    {
        let mut endings = Vec::new();
        for format in page::FileFormat::pages().filter(|format| format.has_pixels()) {
            let out = format!("{n}.{}", format.ending());
            run_in(at, &format!("render p.petro {out} {options} --size 160x120 --dpi 150 --samples 2 --device cpu"))
                .done();
            endings.push(format.ending());
        }
        assert_eq!(endings, ["png", "tif"]);
        // A TIFF file is the pixels and their resolution, so that those of the PNG file make the same bytes.
        let known = image::open(at.join(format!("{n}.png"))).unwrap().to_rgba8();
        assert!(fs::read(at.join(format!("{n}.tif"))).unwrap() == page::tiff(&known, 150.0).unwrap(), "{options}");
    }
}

/// Names that files must escape, letters that the face lacks, and a page without room.
#[test]
fn odd_names_and_tiny_pages_make_sensible_figures() {
    let folder = project();
    let at = folder.path();
    let state = at.join("p.petro/project.toml");
    let plain = fs::read_to_string(&state).unwrap();
    let patternless = plain.replace("layers = []", "layers = [{ layer = 'Alpha - Bravo', colour = '#c0b090' }]");
    assert_ne!(patternless, plain);
    fs::write(&state, patternless).unwrap();
    for file in ["a.svg", "a.pdf", "a.png"] {
        let told = run_in(at, &format!("render p.petro {file} --title '<&> Grès' --annotate all {SMALL}")).done();
        assert!(!told.stderr.contains("boxes"), "{}", told.stderr);
        let told = run_in(at, &format!("render p.petro {file} --title 石灰岩 --caption حجر --legend {SMALL}")).done();
        assert!(told.stderr.contains("boxes") && told.stderr.contains("Latin"), "{}", told.stderr);
        let told = run_in(at, &format!("render p.petro {file} --annotate all --title T --size-cm 1x1 --dpi 60")).done();
        assert!(told.stderr.contains("lacks: the legend"), "{}", told.stderr);
    }
    let fonts = concat!(env!("CARGO_MANIFEST_DIR"), "/crates/ttf/tests/fonts");
    let given = format!("--font {fonts}/arabic.ttf --font {fonts}/han.otf");
    for file in ["a.svg", "a.pdf", "a.png"] {
        let told = run_in(at, &format!("render p.petro {file} --title 石灰岩 --caption حجر {given} {SMALL}")).done();
        assert!(!told.stderr.contains("boxes"), "{}", told.stderr);
    }
    run_in(at, &format!("render p.petro a.svg --title 石 --font p.petro/project.toml {SMALL}")).failed(&["TrueType"]);
    run_in(at, &format!("render p.petro a.svg --title '<&>' --inline 120 {SMALL}")).done();
    assert!(fs::read_to_string(at.join("a.svg")).unwrap().contains("&lt;&amp;&gt;"));
    // A block alone needs no room for words.
    run_in(at, "render p.petro a.pdf --size-cm 1x1 --dpi 60 --device cpu").done();
}

/// A name from right to left along a folded layer, and in the legend: letters follow the layer, and readers find the word.
/// Only where pdftotext is installed (`poppler-utils`).
#[test]
fn names_from_right_to_left_are_read_as_words() {
    let folder = project();
    let at = folder.path();
    let font = concat!(env!("CARGO_MANIFEST_DIR"), "/crates/ttf/tests/fonts/arabic.ttf");
    let name = "حجر جيري";
    run_in(at, &format!("layer set p.petro 'below Delta' --name '{name}' --pattern limestone")).done();
    for file in ["a.svg", "a.pdf"] {
        let page = "--annotate layers --legend --size-cm 16x11 --ground off --device cpu";
        run_in(at, &format!("render p.petro {file} --font {font} {page}")).done();
    }
    let bent = format!("aria-label=\"{name}\"");
    assert_eq!(fs::read_to_string(at.join("a.svg")).unwrap().matches(&bent).count(), 1, "one is bent");
    let Ok(read) = Command::new("pdftotext").args(["a.pdf", "-"]).current_dir(at).output() else {
        eprintln!("skipped: no pdftotext here (apt-get install poppler-utils)");
        return;
    };
    // Without the marks of direction that it adds.
    let read: String = String::from_utf8(read.stdout).unwrap().replace(['\u{202a}', '\u{202b}', '\u{202c}'], "");
    assert_eq!(read.lines().filter(|line| line.contains(name)).count(), 2, "{read}");
}

/// A thousand beds in a layer, faces that are seen edge on, one pixel, and more horizons than a machine word has bits.
#[test]
fn very_many_layers_and_very_small_faces_make_valid_files() {
    let folder = project();
    let at = folder.path();
    let beds = (0..1000).map(|bed| {
        let pattern = ["shale", "limestone", "marl"][bed % 3];
        format!("--interval {},{},{pattern}", bed as f64 / 1000.0, (bed + 1) as f64 / 1000.0)
    });
    let beds = beds.collect::<Vec<_>>().join(" ");
    run_in(at, &format!("layer set p.petro 'Alpha - Bravo' {beds}")).done();
    for (file, begins, ends) in [("a.svg", "<?xml", "</svg>\n"), ("a.pdf", "%PDF", "%%EOF")] {
        for look in ["--ground off", "--elevation 0.02 --ground off", "--size 1x1", "--box 101,102,501,502,400,404"] {
            let size = if look.contains("--size") { "" } else { "--size 80x60 --samples 1" };
            run_in(at, &format!("render p.petro {file} {look} {size} --device cpu")).done();
            let bytes = fs::read(at.join(file)).unwrap();
            let is_whole =
                bytes.starts_with(begins.as_bytes()) && bytes.trim_ascii_end().ends_with(ends.trim_end().as_bytes());
            assert!(is_whole, "{file} {look}");
        }
    }
    fs::write(at.join("h.csv"), "x,y,z\n0,0,1\n").unwrap();
    run_in(at, "create many.petro --bounds 0,100,0,100,0,1000 --size 5x5x101").done();
    for horizon in 0..66 {
        let z = 10 + 10 * horizon;
        let points: String = (0..25).map(|n| format!("{},{},{z}\n", 25 * (n % 5), 25 * (n / 5))).collect();
        fs::write(at.join("h.csv"), format!("x,y,z\n{points}")).unwrap();
        run_in(at, &format!("horizon add many.petro h.csv --name H{horizon}")).done();
    }
    let said = run_in(at, "render many.petro a.svg --size-cm 12x9 --dpi 60 --annotate all --device cpu").done();
    let told = said.stdout;
    assert!(told.contains("patterns chosen by default: above H0, ") && told.contains(" and 55 more"), "{told}");
    let svg = fs::read_to_string(at.join("a.svg")).unwrap();
    assert!(svg.contains("inkscape:label=\"below H65\"") && svg.contains(" more</text>"));
}

#[cfg(feature = "window")]
mod window {
    use super::*;
    use ::app::state::{Compare, ExportForm, Layout, Look, Panel, SectionFill, Session, Shown, Snapshot};
    use ::app::views::overlay::Overlay;
    use ::app::views::print::Page;
    use ::app::views::sections::Sections;
    use ::app::work::Rocks;
    use ::figure::map::Mapped;
    use ::project::pictures::load::{Request, load};
    use render::Scene;
    use std::sync::Arc;
    use survey::Progress;

    /// What the window exports of a project looked at in some way.
    fn exported(at: &Path, look: impl Fn(&mut Session)) -> RgbImage {
        filled(at, SectionFill::Measured, look)
    }

    /// The same, with something else on sections.
    fn filled(at: &Path, section_fill: SectionFill, look: impl Fn(&mut Session)) -> RgbImage {
        written(at, shown(at), section_fill, look)
    }

    /// What the window shows.
    fn shown(at: &Path) -> Rocks {
        let opened = ::project::Project::open(&at.join("p.petro")).unwrap();
        Arc::new(load(opened.facts(), &Request::new(&Scene::default()), &Progress::silent()).unwrap())
    }

    /// The same while the window shows something.
    fn written(at: &Path, rocks: Rocks, section_fill: SectionFill, look: impl Fn(&mut Session)) -> RgbImage {
        let opened = ::project::Project::open(&at.join("p.petro")).unwrap();
        let (root, document) = (opened.root().to_owned(), opened.document().clone());
        let mut session = Session::new(Snapshot { root, document, history: Vec::new() }, None);
        look(&mut session);
        let path = at.join("window.png").display().to_string();
        let form = ExportForm {
            size_cm: [12.0, 9.0],
            dpi: 60.0,
            legend: Shown::Yes,
            scale_bar: Shown::Yes,
            section_fill,
            ..ExportForm::new(path)
        };
        let mapped = Mapped::Structure(1);
        let page = Page::of(&session, &Overlay::default(), &Sections::default(), mapped, &form).unwrap();
        page.write(&Progress::silent()).unwrap();
        drop(rocks);
        image::open(at.join("window.png")).unwrap().to_rgb8()
    }

    fn typed(at: &Path, options: &str) -> RgbImage {
        let line = format!(
            "render p.petro a.png --size-cm 12x9 --dpi 60 --legend --scale-bar --annotate axes,layers,faults {options}"
        );
        run_in(at, &line).done();
        image::open(at.join("a.png")).unwrap().to_rgb8()
    }

    /// The model on the screen saves an export its time; one of an earlier state is made anew.
    #[test]
    fn a_model_of_another_state_shapes_no_export() {
        let folder = project();
        let at = folder.path();
        let before = shown(at);
        run_in(at, "horizon remove p.petro Charlie").done();
        assert!(written(at, before, SectionFill::Measured, |_| {}) == typed(at, ""));
    }

    #[test]
    fn the_window_exports_the_pixels_that_the_command_line_renders() {
        let folder = project();
        let at = folder.path();
        let block = exported(at, |_| {});
        assert!(block == typed(at, ""), "block");
        let show = |session: &mut Session| {
            session.view.layout = Layout::Sections;
            session.view.slices = [19.0, 11.0, 25.0];
        };
        let sections = exported(at, show);
        let lines = {
            let opened = ::project::Project::open(&at.join("p.petro")).unwrap();
            let geometry = opened.document().geometry.clone().unwrap();
            [0, 1, 2].map(|axis| ::figure::cut::value_at(&geometry, axis, [19.0, 11.0, 25.0][axis]))
        };
        let [inline, crossline, z] = lines;
        let same = format!("--block --inline {inline} --crossline {crossline} --slice {z}");
        assert!(sections == typed(at, &same), "sections");
        // The comparison fails on another picture: the neighbouring inline.
        let other = format!("--block --inline {} --crossline {crossline} --slice {z}", inline + 1.0);
        assert!(sections != typed(at, &other), "another inline is another picture");
        let half = filled(at, SectionFill::Half, show);
        assert!(half == typed(at, &format!("{same} --section-blend 0.5")), "half rock, half measured");
        let rock = filled(at, SectionFill::Rock, show);
        assert!(rock == typed(at, &format!("{same} --section-blend 0")), "rock");
        assert!(rock != half && half != sections, "three pictures");
        let map = exported(at, |session| session.view.layout = Layout::Map);
        assert!(map == typed(at, "--block --map Bravo"), "map");
        let compared = exported(at, |session| {
            session.view.compare = Compare::Wipe;
            session.view.wipe = 0.25;
        });
        assert!(compared == typed(at, "--compare 0,1 --wipe 0.25"), "comparison");
        let interpreted = exported(at, |session| {
            session.view.panel = Panel::Interpret;
            session.view.picking.look = Look::Faces;
        });
        assert!(interpreted == typed(at, "--interpretation"), "interpretation");
    }
}

/// A colour that a fault was given holds on the block, in its legend, and on sections of rock; others are as they were.
#[test]
fn a_fault_has_its_colour_on_every_figure() {
    let folder = project();
    let at = folder.path();
    for (name, inline) in [("Border", 112), ("Plain", 132)] {
        let sticks: Vec<String> =
            [501, 540].map(|line| format!("--stick {inline},{line},0 {},{line},550", inline + 4)).to_vec();
        run_in(at, &format!("fault pick p.petro --name {name} {}", sticks.join(" "))).done();
    }
    let block = "render p.petro a.svg --size-cm 12x9 --legend --ground off --device cpu";
    let rock = "render p.petro a.svg --crossline 520 --section-blend 0 --size-cm 12x9 --legend --device cpu";
    for page in [block, rock] {
        let drawn = |with: &str| {
            run_in(at, &format!("{page} {with}")).done();
            fs::read_to_string(at.join("a.svg")).unwrap()
        };
        let before = drawn("");
        assert!(before.contains(">Fault</text>") && !before.contains("#c0182c"), "{page}");
        run_in(at, "fault colour p.petro Border #c0182c").done();
        let after = drawn("");
        // The line itself, and the entry of the legend that explains it.
        assert!(after.matches("#c0182c").count() >= 2, "{page}: {}", after.matches("#c0182c").count());
        let (_, legend) = after.split_once("inkscape:label=\"legend\"").unwrap();
        for entry in [">Border</text>", ">Fault</text>", "#c0182c"] {
            assert!(legend.contains(entry), "{page}: no {entry}");
        }
        assert!(!drawn("--preset black-and-white").contains("#c0182c"), "{page} in black and white");
        run_in(at, "undo p.petro").done();
    }
}

#[test]
fn a_figure_is_written_as_paths_and_text() {
    let folder = project();
    let at = folder.path();
    let options = "--size-cm 12x9 --legend --scale-bar --ground off --device cpu";
    for out in ["a.svg", "b.svg"] {
        run_in(at, &format!("render p.petro {out} {options}")).done();
    }
    let svg = fs::read_to_string(at.join("a.svg")).unwrap();
    assert_eq!(svg, fs::read_to_string(at.join("b.svg")).unwrap(), "the same project gives the same bytes");
    assert!(svg.starts_with("<?xml") && svg.trim_end().ends_with("</svg>"));
    for name in ["inkscape:label=\"Alpha\"", "inkscape:label=\"above Alpha\"", "id=\"horizon-alpha\"", "</text>"] {
        assert!(svg.contains(name), "no {name}");
    }
    // Rock is paths, not pixels, in the legend, too.
    let (block, legend) = svg.split_once("inkscape:label=\"legend\"").unwrap();
    assert!(!svg.contains("<use") && block.matches("<path").count() > 20 && legend.matches("<path").count() > 6);
    for out in ["a.pdf", "b.pdf"] {
        run_in(at, &format!("render p.petro {out} {options}")).done();
    }
    let pdf = fs::read(at.join("a.pdf")).unwrap();
    assert_eq!(pdf, fs::read(at.join("b.pdf")).unwrap(), "the same project gives the same bytes");
    for name in ["%PDF-1.7", "/Name (Alpha)", "/Name (above Alpha)", "/Title (p)"] {
        assert!(pdf.windows(name.len()).any(|bytes| bytes == name.as_bytes()), "no {name}");
    }
    // With relief the ground is a picture, and the sides are still paths.
    run_in(at, "render p.petro ground.svg --size-cm 6x5 --device cpu").done();
    let ground = fs::read_to_string(at.join("ground.svg")).unwrap();
    assert_eq!(ground.matches("<use").count(), 1);
    // Sections, too.
    run_in(at, "render p.petro section.svg --inline 120 --size-cm 12x8 --scale-bar").done();
    assert!(fs::read_to_string(at.join("section.svg")).unwrap().contains(">Inline 120</text>"));
    // Of the rock they are paths, a group for each layer.
    run_in(at, "render p.petro rock.svg --inline 120 --section-blend 0 --size-cm 12x8 --annotate all").done();
    let rock = fs::read_to_string(at.join("rock.svg")).unwrap();
    assert!(
        !rock.contains("<image") && rock.contains("inkscape:label=\"above Alpha\"") && rock.contains(">Contact</text>")
    );
    // Words of the page are found in it.
    run_in(at, "render p.petro words.svg --size-cm 12x9 --north-arrow --title Basin --caption folded").done();
    let words = fs::read_to_string(at.join("words.svg")).unwrap();
    for name in [">Basin</text>", ">folded</text>", ">N</text>", "inkscape:label=\"north arrow\""] {
        assert!(words.contains(name), "no {name}");
    }
    // Labels are text that can be found, bent names as whole words.
    run_in(at, "render p.petro all.svg --size-cm 16x11 --annotate all --credit TNO --blend 0.5 --device cpu").done();
    let all = fs::read_to_string(at.join("all.svg")).unwrap();
    for name in [">Inline</text>", ">Crossline</text>", ">Depth (m)</text>", "data: TNO</text>", "label=\"colour bar\""]
    {
        assert!(all.contains(name), "no {name}");
    }
    run_in(at, "render p.petro named.svg --size-cm 16x11 --annotate layers --ground off --device cpu").done();
    let named = fs::read_to_string(at.join("named.svg")).unwrap();
    assert!(named.contains("rotate=\"") && named.contains(">above Alpha</text>"));
    let wrong = run_in(at, "render p.petro a.svg --annotate scales");
    assert!(wrong.code == 2 && wrong.stderr.contains("provenance"));
    assert_eq!(run_in(at, "render p.petro a.gif").code, 2);
    run_in(at, "render p.petro p.petro/inside.svg").failed(&["project"]);
    assert!(!at.join("p.petro/inside.svg").exists());
}
