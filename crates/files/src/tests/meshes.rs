//! Surfaces of triangles from OBJ and STL files, as programs for 3D models write them.

use super::cases::{plane_of_cases, survey_of_cases, worst};
use super::*;
use glam::{DVec2, DVec3};

/// A place on the plane of the cases, every third trace.
fn place(i: usize, j: usize) -> DVec3 {
    let xy = DVec2::new(456_000.0 + 300.0 * i as f64, 5_999_000.0 + 300.0 * j as f64);
    xy.extend(plane_of_cases(xy))
}

const N: usize = 11;

fn places() -> String {
    (0..N * N).map(|n| place(n / N, n % N)).map(|p| format!("v {} {} {}\n", p.x, p.y, p.z)).collect()
}

/// Corners of the two triangles of each cell, as indices from 0.
fn triangles() -> Vec<[usize; 3]> {
    let cell = |n: usize| (n / (N - 1)) * N + n % (N - 1);
    (0..(N - 1) * (N - 1)).map(cell).flat_map(|a| [[a, a + N, a + N + 1], [a, a + N + 1, a + 1]]).collect()
}

fn faces(word: impl Fn(usize) -> String) -> String {
    triangles().iter().map(|[a, b, c]| format!("f {} {} {}\n", word(*a), word(*b), word(*c))).collect()
}

fn is_plane(what: &str, content: &[u8], name: &str) -> Vec<(Horizon, ImportReport)> {
    let (_folder, path) = bytes(name, content);
    let found = read_horizons(&path, &survey_of_cases(), &ImportOptions::default());
    let found = found.unwrap_or_else(|error| panic!("{what}: {error}"));
    let (worst, count) = worst(&found[0].0, plane_of_cases);
    assert!(worst < 0.3 && count == 961, "{what}: {worst} m off at {count} nodes");
    found
}

fn refused(name: &str, content: &[u8]) -> String {
    let (_folder, path) = bytes(name, content);
    let _ =
        (describe(&path, &ImportOptions::default()), read_fault(&path, &survey_of_cases(), &ImportOptions::default()));
    read_horizons(&path, &survey_of_cases(), &ImportOptions::default()).unwrap_err().to_string()
}

#[test]
fn obj_meshes_as_other_programs_write_them_are_horizons_and_faults() {
    let plain = |n: usize| format!("{}", n + 1);
    let quads: String = (0..(N - 1) * (N - 1))
        .map(|n| (n / (N - 1)) * N + n % (N - 1) + 1)
        .map(|a| format!("f {} {} {} {}\n", a, a + N, a + N + 1, a + 1))
        .collect();
    for (what, text) in [
        ("plain", places() + &faces(plain)),
        (
            "Blender",
            format!(
                "# Blender 4.2\nmtllib a.mtl\no Chalk\n{}vn 0 0 1\ns 0\nusemtl None\n{}",
                places(),
                faces(|n| format!("{}//1", n + 1))
            ),
        ),
        (
            "MeshLab, with colours",
            places().replace('\n', " 0.5 0.5 0.5\n") + "vt 0 0\nvn 0 0 1\n" + &faces(|n| format!("{}/1/1", n + 1)),
        ),
        ("Leapfrog", format!("# Leapfrog\r\ng Chalk\r\n{}", (places() + &faces(plain)).replace('\n', "\r\n"))),
        ("counted from the last", places() + &faces(|n| format!("{}", n as i64 - (N * N) as i64))),
        ("faces of four corners", places() + &quads),
        ("a line that goes on", places() + &faces(plain).replacen("f 1 12", "f \\\n 1 12", 1)),
    ] {
        let found = is_plane(what, text.as_bytes(), "a.obj");
        assert_eq!(found[0].1.format.value, Format::Obj, "{what}");
        let (_folder, path) = file("a.obj", &text);
        let fault = read_fault(&path, &survey_of_cases(), &ImportOptions::default()).unwrap().remove(0).0;
        assert_eq!((fault.mesh.vertices.len(), fault.mesh.triangles.len()), (N * N, 2 * (N - 1) * (N - 1)), "{what}");
    }
    let below: String =
        (0..N * N).map(|n| place(n / N, n % N)).map(|p| format!("v {} {} {}\n", p.x, p.y, p.z + 100.0)).collect();
    let second = faces(|n| format!("{}", n + 1 + N * N));
    for keyword in ["o", "g"] {
        let text = format!("{keyword} Top Chalk\n{}{}{keyword} Base Chalk\n{below}{second}", places(), faces(plain));
        let found = is_plane("two", text.as_bytes(), "a.obj");
        assert_eq!(
            found.iter().map(|(horizon, _)| horizon.name.as_str()).collect::<Vec<_>>(),
            ["Top Chalk", "Base Chalk"]
        );
    }
    // Groups within objects are parts of them.
    let parts = format!("o A\n{}g one\n{}g two\nf 1 12 13\n", places(), faces(plain));
    assert_eq!(is_plane("parts", parts.as_bytes(), "a.obj").len(), 1);
    // Polylines are sticks, places alone are points.
    let sticks =
        "o F\nv 456500 5999200 500\nv 456600 5999200 900\nv 456500 6000200 500\nv 456600 6000200 900\nl 1 2\nl 3 4\n";
    let (_folder, path) = file("a.obj", sticks);
    assert_eq!(read_fault(&path, &survey_of_cases(), &ImportOptions::default()).unwrap()[0].0.mesh.triangles.len(), 2);
    let (_folder, path) = file("a.obj", &places());
    let (cloud, _) = read_horizons(&path, &survey_of_cases(), &ImportOptions::default()).unwrap().remove(0);
    assert!(worst(&cloud, plane_of_cases).0 < 0.01);
}

#[test]
fn obj_files_that_are_broken_or_turned_are_refused_with_the_sentence_that_helps() {
    for (text, words) in [
        ("v 1 2 3\nv 1 2 4\nv 2 2 2\nf 1 2 4\n", "line 4: expected numbers of places from 1 to 3"),
        ("v 1 2 3\nv 1 2 4\nv 2 2 2\nf 1 2 -4\n", "line 4"),
        ("v 1 2 3\nv 1 2 4\nv 2 2 2\nf 1 2 0\n", "line 4"),
        ("v 1 2 3\nv 1 2\n", "line 2: expected v x y z"),
        ("v nan 2 3\n", "expected v x y z"),
        ("v 1 2 3\nf 1 1\n", "three corners"),
        ("v 1 2 3\nf 1 x 1\n", "numbers of places"),
    ] {
        let error = refused("a.obj", text.as_bytes());
        assert!(error.contains(words), "{words}: {error}");
    }
    // Blender exports Y up unless it is told otherwise.
    let turned: String =
        (0..N * N).map(|n| place(n / N, n % N)).map(|p| format!("v {} {} {}\n", p.x, p.z, -p.y)).collect();
    let error = refused("a.obj", (turned + &faces(|n| format!("{}", n + 1))).as_bytes());
    assert!(error.contains("Up Axis Z"), "{error}");
    // A corner without a height costs its triangles.
    let holed = places().replacen(" 1000\n", " nan\n", 1) + &faces(|n| format!("{}", n + 1));
    let (_folder, path) = file("a.obj", &holed);
    let (_, report) = read_horizons(&path, &survey_of_cases(), &ImportOptions::default()).unwrap().remove(0);
    assert!(report.notes.iter().any(|note| note.starts_with("2 triangles")), "{report}");
}

fn solid(name: &str, down: f64) -> String {
    let vertex = |n: &usize| {
        let p = place(n / N, n % N);
        format!("      vertex {:e} {:e} {:e}\n", p.x, p.y, p.z + down)
    };
    let facet = |corners: &[usize; 3]| {
        let inside: String = corners.iter().map(vertex).collect();
        format!("  facet normal 0 0 1\n    outer loop\n{inside}    endloop\n  endfacet\n")
    };
    format!("solid {name}\n{}endsolid {name}\n", triangles().iter().map(facet).collect::<String>())
}

fn binary_stl(header: &str) -> Vec<u8> {
    let mut out = header.as_bytes().to_vec();
    out.resize(80, b' ');
    out.extend((triangles().len() as u32).to_le_bytes());
    for corners in triangles() {
        let numbers = [DVec3::Z].into_iter().chain(corners.map(|n| place(n / N, n % N)));
        out.extend(numbers.flat_map(|p| p.to_array()).flat_map(|v| (v as f32).to_le_bytes()));
        out.extend([0, 0]);
    }
    out
}

#[test]
fn stl_meshes_as_text_and_in_bytes_are_horizons_and_faults() {
    for (what, content) in [
        ("text", solid("Chalk", 0.0).into_bytes()),
        ("capitals", solid("Chalk", 0.0).to_uppercase().replace('\n', "\r\n").into_bytes()),
        ("no name", solid("", 0.0).into_bytes()),
        ("binary", binary_stl("Exported from Blender")),
        ("binary that begins as text", binary_stl("solid made by SolidWorks")),
    ] {
        let found = is_plane(what, &content, "a.stl");
        assert_eq!(found[0].1.format.value, Format::Stl, "{what}");
        let (_folder, path) = bytes("a.dat", &content);
        let (fault, report) = read_fault(&path, &survey_of_cases(), &ImportOptions::default()).unwrap().remove(0);
        assert_eq!((fault.mesh.vertices.len(), fault.mesh.triangles.len()), (N * N, 2 * (N - 1) * (N - 1)), "{what}");
        let is_coarse = report.notes.iter().any(|note| note.contains("floats of 4 bytes"));
        assert_eq!(is_coarse, what.starts_with("binary"), "{report}");
    }
    let two = solid("Top", 0.0) + &solid("Base", 100.0);
    let found = is_plane("two", two.as_bytes(), "a.stl");
    assert_eq!(found.iter().map(|(horizon, _)| horizon.name.as_str()).collect::<Vec<_>>(), ["Top", "Base"]);
}

#[test]
fn stl_files_that_are_broken_are_refused() {
    let text = solid("Chalk", 0.0);
    let binary = binary_stl("x");
    assert!(refused("a.stl", &binary[..binary.len() - 60]).contains("triangles: expected 200, found 198"));
    assert!(refused("a.stl", &text.as_bytes()[..text.len() - 300]).contains("cut off"));
    assert!(
        refused("a.stl", b"solid a\nfacet normal 0 0 1\nouter loop\nvertex 1 2\n")
            .contains("line 4: expected vertex x y z")
    );
    assert!(
        refused("a.stl", b"solid a\nfacet normal 0 0 1\nouter loop\nvertex 1 2 3\nendloop\n")
            .contains("three vertices")
    );
    assert!(refused("a.stl", b"solid a\nfacet\nendsolid\n").contains("no triangle"));
    let mut lying = binary.clone();
    lying[80..84].copy_from_slice(&u32::MAX.to_le_bytes());
    assert!(refused("a.stl", &lying).contains("expected 4294967295, found 200"));
    let mut nan = binary;
    nan[84 + 12..84 + 24].fill(0xff);
    let (_folder, path) = bytes("a.stl", &nan);
    assert!(read_fault(&path, &survey_of_cases(), &ImportOptions::default()).unwrap()[0].0.mesh.triangles.len() == 199);
}
