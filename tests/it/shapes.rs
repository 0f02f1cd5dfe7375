//! Horizons of any shape through the binary: an overturned outcrop of scattered points, salt with an overhang, and what
//! cannot be a body.

use crate::program::run_in;
use std::fs;
use std::path::Path;

/// The command of an outcrop's project, as `synth` states it, for this project's name.
fn create(folder: &Path, told: &str) {
    let line = told.lines().find_map(|line| line.strip_prefix("petroglyph create OUTCROP.petro ")).unwrap();
    run_in(folder, &format!("create o.petro {line}")).done();
}

#[test]
fn an_overturned_outcrop_is_taken_as_it_is() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let made = run_in(at, "synth o --overturned --size 40x36x32 --seed 3").done();
    create(at, &made.stdout);
    for fault in ["F1", "F2", "F3"] {
        run_in(at, &format!("fault add o.petro o/faults/{fault}.ts --name {fault}")).done();
    }
    // In any order: they find their places.
    for n in [5, 1, 9, 3, 7, 2, 8, 4, 6] {
        run_in(at, &format!("horizon add o.petro o/horizons/H{n}.csv --name H{n}")).done();
    }
    let listed = run_in(at, "horizon list o.petro --json").done().json();
    let names: Vec<&str> = listed["horizons"].as_array().unwrap().iter().filter_map(|h| h["name"].as_str()).collect();
    assert_eq!(names, ["H1", "H2", "H3", "H4", "H5", "H6", "H7", "H8", "H9"]);
    run_in(at, "parameterize o.petro").done();
    let drawn = run_in(at, "render o.petro o.png --size 240x180 --device cpu").done();
    assert!(fs::metadata(at.join("o.png")).unwrap().len() > 5000, "{}", drawn.stdout);
    // A horizon comes out as it went in.
    let shown = run_in(at, "horizon show o.petro H5").done();
    if shown.stdout.contains("any shape") {
        run_in(at, "export o.petro h5.csv --horizon H5 --format csv").done();
        let rows = |path: &str| fs::read_to_string(at.join(path)).unwrap().lines().count();
        assert_eq!(rows("h5.csv"), rows("o/horizons/H5.csv"));
        run_in(at, "export o.petro h5.irap --horizon H5 --format irap").failed(&["several depths", "tsurf"]);
    }
    run_in(at, "check o.petro").done();
}

#[test]
fn salt_with_an_overhang_cuts_what_is_there_and_an_open_one_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    run_in(at, "synth s --salt --size 48x48x48").done();
    run_in(at, "import s/survey.sgy s.petro").done();
    for (name, contact) in [("Alpha", "conformable"), ("Unconformity", "erosional"), ("Delta", "conformable")] {
        run_in(at, &format!("horizon add s.petro s/horizons/{name}.csv --name {name} --contact {contact}")).done();
    }
    let salt = fs::read_to_string(at.join("s/horizons/Salt.ts")).unwrap();
    // Without a third of its triangles it is open in the middle of the block.
    let count = salt.lines().filter(|line| line.starts_with("TRGL")).count();
    let mut left = count * 2 / 3;
    let kept = salt.lines().filter(|line| {
        let is_triangle = line.starts_with("TRGL");
        left = left.saturating_sub(usize::from(is_triangle));
        !is_triangle || left > 0
    });
    fs::write(at.join("open.ts"), kept.map(|line| format!("{line}\n")).collect::<String>()).unwrap();
    let open = "horizon add s.petro open.ts --name Salt --contact intrusive --shape any";
    run_in(at, open).failed(&["it is open inside the volume", "near inline"]);
    let listed = run_in(at, "horizon list s.petro --json").done().json();
    assert_eq!(listed["horizons"].as_array().unwrap().len(), 3, "nothing half done");
    let added = run_in(at, "horizon add s.petro s/horizons/Salt.ts --name Salt").done();
    assert!(added.stdout.contains("it is closed: a body"), "{}", added.stdout);
    let layers = run_in(at, "layer list s.petro").done();
    assert!(layers.stdout.contains("below Delta: ") && layers.stdout.contains("\nSalt: salt "), "{}", layers.stdout);
    run_in(at, "render s.petro s.png --size 240x180 --device cpu").done();
    // The same body given as a map loses its overhang: it is only taken so when that is asked for.
    run_in(at, "horizon remove s.petro Salt").done();
    let map = run_in(at, "horizon add s.petro s/horizons/Salt.ts --name Salt --shape map --contact intrusive").done();
    assert!(map.stdout.contains("sampled at the survey's traces"), "{}", map.stdout);
}

#[test]
fn points_with_normals_are_a_body_which_erosion_may_cut() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    run_in(at, "create b.petro --bounds 0,1000,0,800,0,800 --size 41x33x41").done();
    let flat = |depth: f64| {
        let corner = |x: f64, y: f64| format!("{x},{y},{depth}\n");
        format!("x,y,depth\n{}{}{}{}", corner(0.0, 0.0), corner(1000.0, 0.0), corner(0.0, 800.0), corner(1000.0, 800.0))
    };
    fs::write(at.join("worn.csv"), flat(300.0)).unwrap();
    fs::write(at.join("base.csv"), flat(600.0)).unwrap();
    // A ball whose upper part was worn down.
    let ball = |turned: u32| {
        let rows = (0..150u32).map(|n| {
            let down = 2.0 * (f64::from(n) + 0.5) / 150.0 - 1.0;
            let (turn, around) = (f64::from(n) * 2.399_963, (1.0 - down * down).sqrt());
            let normal = [turn.cos() * around, turn.sin() * around, down];
            let [x, y, z] = [0, 1, 2].map(|axis| [500.0, 400.0, 350.0][axis] + 200.0 * normal[axis]);
            let [nx, ny, nz] = if n % turned == 0 { normal.map(|c| -c) } else { normal };
            format!("{x},{y},{z},{nx},{ny},{nz}\n")
        });
        format!("x,y,depth,nx,ny,nz\n{}", rows.collect::<String>())
    };
    fs::write(at.join("stock.csv"), ball(1000)).unwrap();
    fs::write(at.join("turned.csv"), ball(3)).unwrap();
    run_in(at, "horizon add b.petro worn.csv --name Worn --contact erosional").done();
    run_in(at, "horizon add b.petro base.csv --name Base").done();
    run_in(at, "horizon add b.petro turned.csv --name Stock")
        .failed(&["normals point to the other side", "near inline"]);
    let added = run_in(at, "horizon add b.petro stock.csv --name Stock --contact truncated-intrusion").done();
    assert!(added.stdout.contains("a closed body through its points and normals"), "{}", added.stdout);
    let picture = |name: &str| {
        let view = "--elevation 90 --azimuth 0 --size 200x160 --device cpu --samples 1";
        run_in(at, &format!("render b.petro {name}.png {view} --exaggeration 1")).done();
        image::open(at.join(format!("{name}.png"))).unwrap().to_rgb8()
    };
    // Seen from above, the stock is a circle of 194 m in the ground: beyond it lies the layer below.
    let worn = picture("worn");
    run_in(at, "horizon contact b.petro Stock intrusive").done();
    assert!(worn != picture("whole"), "what stands out is shaded");
    run_in(at, "check b.petro").done();
}

/// A TSurf of corners (X, Y, depth) and triangles that count them from 0.
fn tsurf(corners: &[[f64; 3]], triangles: &[[usize; 3]]) -> String {
    let head = "GOCAD TSurf 1\nHEADER {\nname:x\n}\nGOCAD_ORIGINAL_COORDINATE_SYSTEM\nAXIS_NAME \"X\" \"Y\" \"Z\"\n\
                AXIS_UNIT \"m\" \"m\" \"m\"\nZPOSITIVE Depth\nEND_ORIGINAL_COORDINATE_SYSTEM\nTFACE\n";
    let corner = |(n, [x, y, z]): (usize, &[f64; 3])| format!("VRTX {} {x} {y} {z}\n", n + 1);
    let triangle = |[a, b, c]: &[usize; 3]| format!("TRGL {} {} {}\n", a + 1, b + 1, c + 1);
    let corners: String = corners.iter().enumerate().map(corner).collect();
    format!("{head}{corners}{}END\n", triangles.iter().map(triangle).collect::<String>())
}

/// Corners and triangles of a grid of places, from shares along rows and columns.
fn rolled(rows: usize, columns: usize, at: impl Fn(f64, f64) -> [f64; 3]) -> (Vec<[f64; 3]>, Vec<[usize; 3]>) {
    let nodes = |n: usize| (n / (columns + 1), n % (columns + 1));
    let corners = (0..(rows + 1) * (columns + 1)).map(nodes);
    let corners = corners.map(|(row, column)| at(row as f64 / rows as f64, column as f64 / columns as f64)).collect();
    let cells = (0..rows * columns).map(|n| n / columns * (columns + 1) + n % columns);
    (corners, cells.flat_map(|n| [[n, n + 1, n + columns + 1], [n + 1, n + columns + 2, n + columns + 1]]).collect())
}

#[test]
fn what_is_no_fault_or_no_horizon_is_said_when_it_is_added() {
    use std::f64::consts::{PI, TAU};
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    run_in(at, "create p.petro --bounds 0,1000,0,800,0,800 --size 41x33x41").done();
    let write = |name: &str, (corners, triangles): (Vec<[f64; 3]>, Vec<[usize; 3]>)| {
        fs::write(at.join(name), tsurf(&corners, &triangles)).unwrap();
    };
    // A ball from nearly one pole to the other: the hole at the upper one is small.
    let ball = |down: f64, turn: f64| {
        let (from_top, around) = (0.1 * PI + 0.9 * PI * down, TAU * turn);
        let ring = 150.0 * from_top.sin();
        [500.0 + ring * around.cos(), 400.0 + ring * around.sin(), 400.0 - 150.0 * from_top.cos()]
    };
    write("ball.ts", rolled(12, 16, ball));
    write("plane.ts", rolled(6, 6, |s, t| [300.0 + 200.0 * s, 800.0 * t, 800.0 * s]));
    let listed = || run_in(at, "fault list p.petro --json").done().json()["faults"].as_array().unwrap().len();
    // Closed nearly all around, it is cut into parts, each over a plane that sees it.
    let cut = run_in(at, "fault add p.petro ball.ts --name F").done();
    assert!(cut.stdout.contains("was cut: \"F\" goes on as \"F 2\""), "{}", cut.stdout);
    assert_eq!(listed(), 2);
    run_in(at, "check p.petro").done();
    run_in(at, "undo p.petro").done();
    assert_eq!(listed(), 0, "nothing half done");
    run_in(at, "fault add p.petro plane.ts --name F").done();
    let again = run_in(at, "fault add p.petro plane.ts --name G").done();
    assert!(again.stdout.contains("it is the same surface as fault \"F\""), "{}", again.stdout);
    run_in(at, "horizon add p.petro ball.ts --name Stock --shape any")
        .failed(&["but for a hole with an edge of 289 m", "it ends inside the volume"]);
    run_in(at, "horizon add p.petro ball.ts --name Stock --contact intrusive")
        .failed(&["it is open inside the volume"]);
    // An overturned fold, whose triangles have an edge as long as any sheet's.
    let fold = |s: f64, t: f64| {
        let along = 3.0 * s - 1.5;
        [500.0 + 208.0 * (along.powi(3) - 0.8 * along), 800.0 * t, 400.0 + 180.0 * along]
    };
    write("fold.ts", rolled(30, 8, fold));
    let sheet = run_in(at, "horizon add p.petro fold.ts --name Fold").done();
    assert!(!sheet.stderr.contains("hole"), "{}", sheet.stderr);
}

#[test]
fn a_horizon_of_scattered_points_alone_tells_whether_it_is_overturned() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    for seed in [3, 5, 8] {
        let made = run_in(at, &format!("synth s{seed} --overturned --size 40x36x32 --seed {seed}")).done();
        if seed == 3 {
            create(at, &made.stdout);
        }
        for n in 4..=6 {
            let points = fs::read_to_string(at.join(format!("s{seed}/horizons/H{n}.csv"))).unwrap().lines().count();
            let added = run_in(at, &format!("horizon add o.petro s{seed}/horizons/H{n}.csv --name H")).done();
            let told = "several limbs lie over one place on the map (if not: --shape map)";
            let is_told = added.stdout.contains(told) && added.stdout.contains("any shape");
            assert!(is_told, "seed {seed}, H{n}, {points} lines: {}", added.stdout);
            run_in(at, "undo o.petro").done();
        }
    }
    // As many points of a folded and faulted map, in the same block.
    let rows = (0..70).map(|n| {
        let (x, y) = ((f64::from(n) * 0.754_877).fract() * 390.0, (f64::from(n) * 0.569_84).fract() * 350.0);
        let z = 150.0 + 40.0 * (x / 60.0).sin() + if x > 150.0 + 0.3 * y { 50.0 } else { 0.0 };
        format!("{},{},{z}\n", 612_000.0 + x, 5_178_000.0 + y)
    });
    fs::write(at.join("map.csv"), format!("x,y,depth\n{}", rows.collect::<String>())).unwrap();
    let map = run_in(at, "horizon add o.petro map.csv --name Map").done();
    assert!(!map.stdout.contains("overturned") && !map.stdout.contains("any shape"), "{}", map.stdout);
}

#[test]
fn what_contradicts_itself_is_said_when_it_is_added_and_when_it_is_drawn() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    run_in(at, "create p.petro --bounds 0,1000,0,800,0,800 --size 41x33x41").done();
    let write = |name: &str, (corners, triangles): (Vec<[f64; 3]>, Vec<[usize; 3]>)| {
        fs::write(at.join(name), tsurf(&corners, &triangles)).unwrap();
    };
    // Two planes that cross in the middle of the block, and one that ends a little beyond the first.
    write("a.ts", rolled(6, 6, |s, t| [300.0 + 400.0 * s, 800.0 * t, 800.0 * s]));
    write("b.ts", rolled(6, 6, |s, t| [700.0 - 400.0 * s, 800.0 * t, 800.0 * s]));
    write("c.ts", rolled(6, 6, |s, t| [700.0 - 230.0 * s, 800.0 * t, 460.0 * s]));
    run_in(at, "fault add p.petro a.ts --name A").done();
    let short = run_in(at, "fault add p.petro c.ts --name C").done();
    assert!(!short.stdout.contains("cross near"), "{}", short.stdout);
    run_in(at, "fault remove p.petro C").done();
    let crossing = "faults \"A\" and \"B\" cross near inline";
    let added = run_in(at, "fault add p.petro b.ts --name B").done();
    assert!(added.stdout.contains(crossing) && added.stdout.contains("four blocks"), "{}", added.stdout);
    let flat = "x,y,depth\n0,0,300\n1000,0,300\n0,800,300\n1000,800,300\n";
    fs::write(at.join("flat.csv"), flat).unwrap();
    run_in(at, "horizon add p.petro flat.csv --name Flat").done();
    let drawn = |out: &str| run_in(at, &format!("render p.petro {out} --size 120x90 --device cpu --samples 1")).done();
    assert!(drawn("x.png").stderr.contains(crossing));
    run_in(at, "fault truncate p.petro B --by A").done();
    assert!(!drawn("y.png").stderr.contains("cross near"));
    // Two balls that share room, and one beside them.
    let ball = |x: f64| {
        move |down: f64, turn: f64| {
            let (from_top, around) = (std::f64::consts::PI * down, std::f64::consts::TAU * turn);
            let ring = 120.0 * from_top.sin();
            [x + ring * around.cos(), 400.0 + ring * around.sin(), 400.0 - 120.0 * from_top.cos()]
        }
    };
    for (name, x) in [("P", 300.0), ("Q", 420.0), ("R", 750.0)] {
        write(&format!("{name}.ts"), rolled(16, 20, ball(x)));
    }
    run_in(at, "horizon add p.petro P.ts --name P").done();
    let overlap = "bodies \"P\" and \"Q\" overlap near inline";
    let added = run_in(at, "horizon add p.petro Q.ts --name Q").done();
    assert!(added.stdout.contains(overlap), "{}", added.stdout);
    let beside = run_in(at, "horizon add p.petro R.ts --name R").done();
    assert!(!beside.stdout.contains("overlap"), "{}", beside.stdout);
    assert!(drawn("z.png").stderr.contains(overlap));
    assert!(run_in(at, "parameterize p.petro --size 20x16x20").done().stderr.contains(overlap));
    // A sheet that goes through itself is no surface, and leaves the project as it was.
    let looped = |s: f64, t: f64| {
        let along = 2.6 * s - 1.3;
        [500.0 + 300.0 * (along.powi(3) - along), 800.0 * t, 200.0 + 250.0 * along * along]
    };
    write("looped.ts", rolled(31, 6, looped));
    run_in(at, "horizon add p.petro looped.ts --name L --shape any")
        .failed(&["its triangles cross each other", "near"]);
    let listed = run_in(at, "horizon list p.petro --json").done().json();
    assert_eq!(listed["horizons"].as_array().unwrap().len(), 4, "nothing half done");
}

#[test]
fn points_off_a_map_are_mispicks_of_one_horizon_and_limbs_beside_another_of_scattered_points() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    run_in(at, "create p.petro --bounds 0,1000,0,800,0,800 --size 41x33x41").done();
    // Every twelfth point lies 250 m below the others.
    let points = |depth: f64, lower: f64| {
        let rows = (0..96).map(|n| {
            let (x, y) = ((f64::from(n) * 0.754_877).fract() * 1000.0, (f64::from(n) * 0.569_84).fract() * 800.0);
            let off = (f64::from(n) * 0.381).fract() + if n % 12 == 5 { lower } else { 0.0 };
            format!("{x},{y},{}\n", depth + off)
        });
        format!("x,y,depth\n{}", rows.collect::<String>())
    };
    fs::write(at.join("odd.csv"), points(300.0, 250.0)).unwrap();
    fs::write(at.join("even.csv"), points(150.0, 0.0)).unwrap();
    let alone = run_in(at, "horizon add p.petro odd.csv --name Odd").done();
    assert!(alone.stdout.contains("mis-picks?") && !alone.stdout.contains("any shape"), "{}", alone.stdout);
    run_in(at, "undo p.petro").done();
    run_in(at, "horizon add p.petro even.csv --name Even").done();
    let beside = run_in(at, "horizon add p.petro odd.csv --name Odd").done();
    let limbs = "9 of its points lie far off a map through their neighbours: they are taken as a surface of any shape";
    assert!(beside.stdout.contains(limbs) && !beside.stdout.contains("mis-picks?"), "{}", beside.stdout);
    run_in(at, "undo p.petro").done();
    let map = run_in(at, "horizon add p.petro odd.csv --name Odd --shape map").done();
    assert!(map.stdout.contains("mis-picks?") && !map.stdout.contains("limbs"), "{}", map.stdout);
}
