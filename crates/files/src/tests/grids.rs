//! Grids of Esri and Surfer, GeoJSON, RMS wells, tables of several objects: the cases, and as other programs write them.

use super::cases::{case, plane_of_cases, survey_of_cases, well as read, worst};
use super::*;
use crate::well::{WellOptions, WellReport, parse_tops};
use glam::{DVec2, DVec3};

fn up() -> ImportOptions {
    ImportOptions { z_positive: Some(ZPositive::Up), ..ImportOptions::default() }
}

/// The plane row by row from the north, `(x, y)` of each node.
fn rows_from_north(node: impl Fn(f64, f64) -> String) -> String {
    let row = |j: usize| {
        (0..31).map(|i| node(456_000.0 + 100.0 * i as f64, 5_999_000.0 + 100.0 * j as f64)).collect::<Vec<_>>()
    };
    (0..31).rev().map(|j| row(j).join(" ") + "\n").collect()
}

fn z(x: f64, y: f64) -> f64 {
    plane_of_cases(DVec2::new(x, y))
}

#[test]
fn grids_of_esri_and_surfer_are_the_plane_of_the_cases() {
    for (name, options, holes) in [
        ("14-esri-ascii/corner.asc", up(), None),
        ("14-esri-ascii/center.asc", up(), None),
        ("15-surfer/z.grd", ImportOptions::default(), Some(())),
        ("15-surfer/z6.grd", ImportOptions::default(), Some(())),
        ("15-surfer/z7.grd", ImportOptions::default(), Some(())),
    ] {
        let Some(path) = case(name) else { return };
        let (horizon, report) = read_horizons(&path, &survey_of_cases(), &options).unwrap().remove(0);
        let (worst, count) = worst(&horizon, plane_of_cases);
        assert!(
            worst < 0.01 && count > 900 && (count == 961) == (report.nulls == 0),
            "{name}: {worst}, {count}\n{report}"
        );
        assert!(holes.is_none() || report.nulls > 0, "{name}: {report}");
    }
    let Some(path) = case("15-surfer/real-gio-surfer-6-ascii-tiny.grd") else { return };
    let found = describe(&path, &ImportOptions::default()).unwrap();
    assert_eq!((found.surfaces[0].values, found.surfaces[0].range), (100, Some([25.0, 97.19])));
}

#[test]
fn esri_grids_as_other_programs_write_them_are_read() {
    let rows = rows_from_north(|x, y| format!("{:.2}", z(x, y)));
    let holed = rows.replacen("1600.00", "-9999", 1);
    let comma = rows.replace('.', ",");
    for (text, nodes) in [
        (format!("NCOLS 31\nNROWS 31\nXLLCENTER 456000\nYLLCENTER 5999000\nCELLSIZE 100\n{rows}"), 961),
        (
            format!(
                "ncols 31\r\nnrows 31\r\nxllcorner 455950\r\nyllcorner 5998950\r\ndx 100\r\ndy 100\r\n{}",
                rows.replace('\n', "\r\n")
            ),
            961,
        ),
        (
            format!(
                "nrows 31\nncols 31\nyllcenter 5999000\nxllcenter 456000\ncellsize 100\nnodata_value -9999\n{holed}"
            ),
            960,
        ),
        (format!("ncols 31\nnrows 31\nxllcorner 455950,0\nyllcorner 5998950,0\ncellsize 100,0\n{comma}"), 961),
        (
            format!(
                "ncols 31\nnrows 31\nxllcenter 456000\nyllcenter 5999000\ncellsize 100\nNODATA_value nan\n{}",
                holed.replace("-9999", "nan")
            ),
            960,
        ),
        (
            format!(
                "ncols 31\nnrows 31\nxllcenter 456000\nyllcenter 5999000\ncellsize 100\n{}",
                rows.replace(' ', "\n")
            ),
            961,
        ),
    ] {
        let (horizon, report) = horizon(&text, &survey_of_cases(), &ImportOptions::default());
        let (worst, count) = worst(&horizon, plane_of_cases);
        assert!(
            worst < 0.01 && count == nodes && report.format.value == Format::Esri,
            "{}: {worst}, {count}",
            &text[..60]
        );
    }
    let (_folder, path) = file("a.asc", "ncols 31\nnrows 31\nxllcenter 1\nyllcenter 2\ncellsize 100\n1 2 3\n");
    assert!(describe(&path, &ImportOptions::default()).unwrap_err().to_string().contains("961"));
}

#[test]
fn surfer_grids_as_other_programs_write_them_are_read() {
    let south: Vec<f64> =
        (0..961).map(|n| z(456_000.0 + 100.0 * f64::from(n % 31), 5_999_000.0 + 100.0 * f64::from(n / 31))).collect();
    let lines: String =
        south.chunks(10).map(|c| c.iter().map(|v| format!("{v} ")).collect::<String>() + "\n").collect();
    let ranges = "456000 459000\n5999000 6002000\n1000 1900\n";
    let blank = lines.replacen("1000 ", "1.70141E+38 ", 1);
    let mut six = b"DSBB".to_vec();
    six.extend([31_i16, 31].iter().flat_map(|n| n.to_le_bytes()));
    six.extend(
        [456_000.0, 459_000.0, 5_999_000.0, 6_002_000.0, 1000.0, 1900.0_f64].iter().flat_map(|v| v.to_le_bytes()),
    );
    six.extend(south.iter().flat_map(|v| (*v as f32).to_le_bytes()));
    let mut seven = b"DSRB\x04\0\0\0\x02\0\0\0GRID\x48\0\0\0".to_vec();
    seven.extend([31_i32, 31].iter().flat_map(|n| n.to_le_bytes()));
    seven.extend(
        [456_000.0, 5_999_000.0, 100.0, 100.0, 1000.0, 1900.0, 0.0, 1.70141e38_f64]
            .iter()
            .flat_map(|v| v.to_le_bytes()),
    );
    seven.extend([b"DATA".as_slice(), &(961_u32 * 8).to_le_bytes()].concat());
    seven.extend(south.iter().enumerate().flat_map(|(n, v)| if n == 7 { 1.70141e38 } else { *v }.to_le_bytes()));
    for (content, nodes) in [
        (format!("DSAA\n31 31\n{ranges}{lines}").into_bytes(), 961),
        (format!("DSAA\r\n31 31\r\n{}{}", ranges.replace('\n', "\r\n"), blank).into_bytes(), 960),
        (format!("DSAA 31 31\n{ranges}{lines}").replace("DSAA 31", "DSAA\n31").into_bytes(), 961),
        (six.clone(), 961),
        (seven.clone(), 960),
    ] {
        let (_folder, path) = bytes("a.grd", &content);
        let (horizon, report) = read_horizons(&path, &survey_of_cases(), &ImportOptions::default()).unwrap().remove(0);
        let (worst, count) = worst(&horizon, plane_of_cases);
        assert!(worst < 0.01 && count == nodes && report.format.value == Format::Surfer, "{worst}, {count}\n{report}");
    }
    for cut in [&six[..30], &six[..400], &seven[..40], &seven[..500]] {
        let (_folder, path) = bytes("a.grd", cut);
        assert!(describe(&path, &ImportOptions::default()).is_err());
    }
}

#[test]
fn traces_of_faults_with_a_dip_are_surfaces() {
    let survey = survey_of_cases();
    let Some(path) = case("20-geojson-faults/faults.geojson") else { return };
    let faults = read_fault(&path, &survey, &ImportOptions::default()).unwrap();
    assert_eq!(faults.iter().map(|(fault, _)| fault.name.as_str()).collect::<Vec<_>>(), ["F0", "F1", "F2"]);
    // At 1000 m of depth it lies 1000 / tan 65 degrees to the east of its trace.
    let out = 1000.0 / 65_f64.to_radians().tan();
    let mesh = &faults[0].0.mesh;
    let [top, bottom] = [mesh.vertices[0], mesh.vertices[1]];
    let at = top.lerp(bottom, 1000.0 / (bottom.z - top.z));
    assert!((at - DVec3::new(456_500.0 + out, 5_999_200.0, 1000.0)).length() < 1e-6, "{at}");
    let one = ImportOptions { name: Some("F1".into()), ..ImportOptions::default() };
    assert_eq!(read_fault(&path, &survey, &one).unwrap().len(), 1);
}

#[test]
fn geojson_as_other_programs_write_it_is_read() {
    let survey = survey_of_cases();
    let read_text = |text: &str| {
        let (_folder, path) = file("a.geojson", text);
        read_fault(&path, &survey, &ImportOptions::default())
    };
    let feature = |properties: &str, geometry: &str| {
        format!(
            "{{\"type\":\"FeatureCollection\",\"features\":[{{\"type\":\"Feature\",\"properties\":{properties},\"geometry\":{geometry}}}]}}"
        )
    };
    let line = "{\"type\":\"LineString\",\"coordinates\":[[456500,5999200],[456600,6000500]]}";
    let sticks = "{\"type\":\"MultiLineString\",\"coordinates\":[[[456500,5999200,500],[456600,5999200,900]],[[456500,6000200,500],[456600,6000200,900]]]}";
    for (properties, geometry, sentence) in [
        ("{\"NAME\":\"A\",\"DIP\":60,\"Dip_Dir\":90}", line, "dips by 60"),
        ("{\"id\":7,\"dip\":60,\"strike\":0}", line, "towards 90"),
        ("{\"name\":\"A\"}", line, "vertical"),
        ("null", line, "vertical"),
        ("{\"fault\":\"A\"}", sticks, ""),
    ] {
        let (fault, report) =
            read_text(&feature(properties, geometry)).unwrap_or_else(|e| panic!("{properties}: {e}")).remove(0);
        assert!(
            report.notes.join(" ").contains(sentence) && !fault.mesh.triangles.is_empty(),
            "{properties}: {report}"
        );
    }
    let degrees = line.replace("456500,5999200", "3.1,54.2").replace("456600,6000500", "3.2,54.3");
    assert!(read_text(&feature("{}", &degrees)).unwrap_err().to_string().contains("degrees"));
    for broken in [
        "{\"type\":\"FeatureCollection\",\"features\":[",
        "{\"type\":\"FeatureCollection\",\"features\":[]}",
        "{\"type\":\"Feature\",\"geometry\":null}",
    ] {
        assert!(read_text(broken).is_err(), "{broken}");
    }
}

#[test]
fn wells_of_rms_have_places_logs_and_zones() {
    let Some(path) = case("12-rms-well/Tor_9.rmswell") else { return };
    let (well, report) = read(&path, &WellOptions::default());
    assert_eq!((well.name.as_str(), well.path.datum_m(), well.logs[0].curves.len()), ("Tor_9", 25.0, 2), "{report:?}");
    let end = well.path.position_at_md(2600.0).unwrap();
    assert!(end.distance(DVec3::new(458_051.10, 6_000_606.85, 2105.14)) < 0.02, "{end}");
    assert_eq!(well.tops.iter().map(|top| top.name.as_str()).collect::<Vec<_>>(), ["A", "B"]);
    let text = std::fs::read_to_string(&path).unwrap();
    let told = well::describe(&path, &text).unwrap().unwrap();
    assert_eq!((told.columns.len(), told.facts[0].as_str()), (2, "well: Tor_9"));
    let Some(path) = case("03-name-then-rows/p1h.txt") else { return };
    let told = well::describe(&path, &std::fs::read_to_string(&path).unwrap()).unwrap().unwrap();
    assert!(told.evidence.contains("name stands alone") && told.columns.len() == 4, "{told:?}");
    let (_folder, path) = file(
        "a.w",
        "1.0\nUNDEFINED\nA 1 457000 6000000\n2\nMDepth UNK lin\nPoro CONT\n457000 6000000 -25 0 0.2\n457000 6000000 75 100 -999\n",
    );
    let (well, _) = read(&path, &WellOptions::default());
    assert_eq!((well.name.as_str(), well.path.datum_m()), ("A 1", 25.0));
    assert!(well.logs[0].curves[0].values[1].is_nan());
}

#[test]
fn each_formation_of_a_table_is_a_horizon_of_its_own() {
    let survey = survey_of_cases();
    for (name, names) in [
        ("44-formations-in-one-table/formation.csv", ["Chalk", "Marl", "Basement"]),
        ("44-formations-in-one-table/surface_points.csv", ["Chalk", "Marl", "Basement"]),
        ("44-formations-in-one-table/loop.csv", ["strat 0", "strat -300", "strat -800"]),
    ] {
        let Some(path) = case(name) else { return };
        let found = read_horizons(&path, &survey, &ImportOptions::default()).unwrap();
        let mut given: Vec<&str> = found.iter().map(|(horizon, _)| horizon.name.as_str()).collect();
        let mut names = names;
        given.sort_unstable();
        names.sort_unstable();
        assert_eq!(given, names, "{name}");
        assert!(found.iter().all(|(_, report)| report.values == 81), "{name}");
    }
    let Some(path) = case("44-formations-in-one-table/orientations.csv") else { return };
    let any = ImportOptions { shape: Some(HorizonShape::Any), select: Some("Chalk".into()), ..up() };
    let turned = ImportOptions { z_positive: None, ..any };
    let found = read_horizons(&path, &survey, &turned);
    assert!(found.is_ok(), "{:?}", found.err().map(|e| e.to_string()));
}

#[test]
fn objects_of_a_table_as_other_programs_name_them() {
    let survey = survey_of_cases();
    let table = |head: &str, row: &dyn Fn(usize, f64, f64, f64) -> String| {
        let mut text = head.to_owned();
        for k in 0..2 {
            for n in 0..49 {
                let (x, y) = (456_200.0 + 400.0 * f64::from(n % 7), 5_999_200.0 + 400.0 * f64::from(n / 7));
                text += &(row(k, x, y, z(x, y) + 300.0 * k as f64) + "\n");
            }
        }
        text
    };
    for (text, names) in [
        (table("X,Y,Z,Horizon\n", &|k, x, y, z| format!("{x},{y},{z},H{k}")), ["H0", "H1"]),
        (table("X Y Z Strati\n", &|k, x, y, z| format!("{x} {y} {z} {k}")), ["0", "1"]),
        (table("X;Y;Z;surface_id\n", &|k, x, y, z| format!("{x};{y};{z};{}", 7 + k)), ["7", "8"]),
        (table("X,Y,Z,feature_name,val\n", &|k, x, y, z| format!("{x},{y},{z},f,{}", 100 * k)), ["f 0", "f 100"]),
        (table("X,Y,Z,formation,val\n", &|k, x, y, z| format!("{x},{y},{z},f{k},{k}")), ["f0", "f1"]),
        (
            table("GOCAD VSet 1\nHEADER {\nname:A\n}\nPROPERTIES Strati\n", &|k, x, y, z| {
                format!("PVRTX 1 {x} {y} {z} {k}")
            }),
            ["A 0", "A 1"],
        ),
    ] {
        let (_folder, path) = file("t.csv", &text);
        let found =
            read_horizons(&path, &survey, &ImportOptions::default()).unwrap_or_else(|e| panic!("{}: {e}", &text[..30]));
        assert_eq!(found.iter().map(|(h, _)| h.name.as_str()).collect::<Vec<_>>(), names, "{}", &text[..40]);
    }
    // Words under any name that may be a surface's, and numbers under it.
    for head in ["id", "layer", "Strat_unit", "marker", "surf_name", "lithology", "Fm", "Schichtname", "event_label"] {
        let text = table(&format!("X,Y,Z,{head}\n"), &|k, x, y, z| format!("{x},{y},{z},{}", ["Chalk", "Marl"][k]));
        let (_folder, path) = file("t.csv", &text);
        let found = read_horizons(&path, &survey, &ImportOptions::default()).unwrap();
        assert_eq!(found.iter().map(|(h, _)| h.name.as_str()).collect::<Vec<_>>(), ["Chalk", "Marl"], "{head}");
        assert!(found[0].1.notes.iter().any(|note| note.contains("tells its surfaces apart")), "{head}");
    }
    let (_folder, path) = file("t.csv", &table("X Y Z layer_no\n", &|k, x, y, z| format!("{x} {y} {z} {k}")));
    assert_eq!(read_horizons(&path, &survey, &ImportOptions::default()).unwrap().len(), 2);
    // Under another name they are told, and read where the columns are stated.
    let by = table("X,Y,Z,picked_by\n", &|k, x, y, z| format!("{x},{y},{},{}", z - 300.0 * k as f64, ["Ann", "Bo"][k]));
    let (_folder, path) = file("t.csv", &by);
    let found = read_horizons(&path, &survey, &ImportOptions::default()).unwrap();
    assert_eq!(found.len(), 1);
    let told = found[0].1.notes.iter().find(|note| note.contains("'picked_by' (Ann, Bo) are not read"));
    assert!(told.is_some_and(|note| note.contains("x,y,z,name")), "{:?}", found[0].1.notes);
    // A number for each point is no name; one for all is none either.
    for head in ["X,Y,Z,id\n", "X,Y,Z,Strati\n"] {
        let count = std::cell::Cell::new(0);
        let text = table(head, &|k, x, y, z| {
            count.set(count.get() + 1);
            let id = if head.contains("Strati") { 3 } else { count.get() };
            format!("{x},{y},{},{id}", z - 300.0 * k as f64)
        });
        let (_folder, path) = file("t.csv", &text);
        assert_eq!(read_horizons(&path, &survey, &ImportOptions::default()).unwrap().len(), 1, "{head}");
    }
}

#[test]
fn one_bad_value_is_one_bad_value() {
    let survey = survey_of_cases();
    let mut rows = String::from("X,Y,Z\n");
    for (n, bad) in ["********", "", "1.#QNAN", "-nan", "#N/A", "NULL"].iter().cycle().take(961).enumerate() {
        let (x, y) = (456_000.0 + 100.0 * (n % 31) as f64, 5_999_000.0 + 100.0 * (n / 31) as f64);
        rows += &if n % 100 == 50 { format!("{x},{y},{bad}\n") } else { format!("{x},{y},{}\n", z(x, y)) };
    }
    let (horizon, report) = horizon(&rows, &survey, &ImportOptions::default());
    assert_eq!((report.nulls, worst(&horizon, plane_of_cases).1), (10, 951), "{report}");
    // A place that is missing is one row less.
    let (_, report) =
        super::horizon(&rows.replacen("456000,5999000,", "********,5999000,", 1), &survey, &ImportOptions::default());
    assert!(report.notes.iter().any(|note| note.contains("1 rows have no place")), "{report}");
    let las = "~V\nVERS. 2.0 :\nWRAP. NO :\n~W\nNULL. -999.25 :\n~C\nDEPT.M :\nGR.GAPI :\n~A\n1 ********\n2 1.#QNAN\n3 -nan\n4 40\n5 -999.25\n";
    let found = well::parse_las(Path::new("a.las"), las).unwrap();
    assert_eq!((found.missing, found.data[1].iter().filter(|v| v.is_nan()).count(), found.data[1][3]), (3, 4, 40.0));
    let path =
        survey::well::WellPath::through(0.0, &[(Some(0.0), DVec3::ZERO), (Some(900.0), DVec3::Z * 900.0)]).unwrap();
    let mut said = WellReport::default();
    let tops =
        parse_tops(Path::new("t"), "surface,md_m\nA,100\nB,#N/A\n", &path, &WellOptions::default(), &mut said).unwrap();
    assert!(tops.len() == 1 && said.warnings[0].fact.contains("1 have no depth"), "{said:?}");
}

#[test]
fn surfaces_without_a_name_are_selected_by_their_number() {
    let survey = survey_of_cases();
    let set = |by: f64| {
        let rows: String = (0..49)
            .map(|n| (456_200.0 + 400.0 * f64::from(n % 7), 5_999_200.0 + 400.0 * f64::from(n / 7)))
            .map(|(x, y)| format!("VRTX 1 {x} {y} {}\n", z(x, y) + by))
            .collect();
        format!("GOCAD VSet 1\nHEADER {{\n}}\n{rows}END\n")
    };
    let (_folder, path) = file("a.vs", &(set(0.0) + &set(300.0)));
    let select = |word: &str| ImportOptions { select: Some(word.into()), ..ImportOptions::default() };
    let (horizon, _) = read_horizons(&path, &survey, &select("2")).unwrap().remove(0);
    assert!(worst(&horizon, |xy| plane_of_cases(xy) + 300.0).0 < 0.01);
    let error = read_horizons(&path, &survey, &select("7")).unwrap_err().to_string();
    assert!(error.contains("it has: 1, 2"), "{error}");
    // One without a name among others; a name that is a number is a name.
    let named = |name: &str, by: f64| set(by).replace("HEADER {\n", &format!("HEADER {{\nname:{name}\n"));
    let (_folder, path) = file("b.vs", &(named("1", 0.0) + &set(300.0) + &named("B", 600.0)));
    for (word, by) in [("1", 0.0), ("2", 300.0), ("B", 600.0)] {
        let (horizon, _) = read_horizons(&path, &survey, &select(word)).unwrap().remove(0);
        assert!(worst(&horizon, |xy| plane_of_cases(xy) + by).0 < 0.01, "{word}");
    }
    let error = read_horizons(&path, &survey, &select("3")).unwrap_err().to_string();
    assert!(error.contains("it has: 1, 2, B"), "{error}");
}
