//! Files of several programs, and what they lack.

use super::*;
use glam::{DVec2, DVec3};
use std::path::Path;
use survey::geometry::{SurveyGeometry, VerticalUnit};
use survey::well::{Checkshot, Survey, Top, Well, WellPath};

fn survey(md_m: f64, inclination_deg: f64, azimuth_deg: f64) -> Survey {
    Survey { md_m, inclination_deg, azimuth_deg }
}

fn options() -> WellOptions {
    WellOptions { head: Some([1000.0, 2000.0]), datum_m: Some(25.0), ..WellOptions::default() }
}

fn read(text: &str, options: &WellOptions) -> Deviation {
    parse_deviation(Path::new("well.csv"), text, options).unwrap_or_else(|e| panic!("{e}"))
}

/// Vertical to 500 m, then a quarter circle of radius 300 m towards azimuth 60°, surveyed at few depths.
fn quarter_circle() -> WellPath {
    let end = 500.0 + 300.0 * std::f64::consts::FRAC_PI_2;
    let bend = |share: f64| survey(500.0 + share * (end - 500.0), 90.0 * share, 60.0);
    let surveys = [survey(0.0, 0.0, 0.0), survey(500.0, 0.0, 60.0), bend(0.3), bend(0.45), bend(1.0)];
    WellPath::minimum_curvature(DVec2::new(1000.0, 2000.0), 25.0, &surveys).unwrap()
}

#[test]
fn the_same_well_in_angles_places_and_offsets() {
    let path = quarter_circle();
    let mds: Vec<f64> = path.mds_by_step(5.0);
    let rows = |header: &str, row: &dyn Fn(f64) -> String| {
        mds.iter().fold(header.to_string(), |text, md| text + "\n" + &row(*md))
    };
    let place = |md: f64| path.position_at_md(md).unwrap();
    let angles = |md: f64| {
        let d = path.direction_at_md(md).unwrap();
        (d.z.clamp(-1.0, 1.0).acos().to_degrees(), d.x.atan2(d.y).to_degrees().rem_euclid(360.0))
    };
    let files = [
        rows("md_m,inclination_deg,azimuth_deg", &|md| format!("{md},{},{}", angles(md).0, angles(md).1)),
        rows("MD (m);X;Y;TVDSS (m)", &|md| format!("{md};{};{};{}", place(md).x, place(md).y, place(md).z)),
        rows("MD X Y Z", &|md| format!("{md} {} {} {}", place(md).x, place(md).y, -place(md).z)),
        rows("MD\tDX\tDY\tTVD", &|md| {
            format!("{md}\t{}\t{}\t{}", place(md).x - 1000.0, place(md).y - 2000.0, place(md).z + 25.0)
        }),
        rows("x,y,tvdss_ft", &|md| format!("{},{},{}", place(md).x, place(md).y, place(md).z / 0.3048)),
        rows("md_ft,inc,azi", &|md| format!("{},{},{}", md / 0.3048, angles(md).0, angles(md).1)),
    ];
    for text in &files {
        let read = read(text, &options());
        let [_, end] = read.path.md_range_m();
        for n in 0..=50 {
            let share = f64::from(n) / 50.0;
            let found = read.path.position_at_md(share * end).unwrap();
            let wanted = place((share * end).min(path.md_range_m()[1]));
            assert!(found.distance(wanted) < 0.03, "{}: {found} {wanted}", &text[..20]);
        }
    }
}

#[test]
fn a_petrel_trace_says_head_and_datum_itself() {
    let text = "# WELL TRACE FROM PETREL\n# WELL NAME:              A 1\n# WELL HEAD X-COORDINATE: 460000.5 (m)\n\
                # WELL HEAD Y-COORDINATE: 5930000.25 (m)\n# WELL DATUM (KB, Kelly bushing, from MSL): 25.0 (m)\n\
                # MD AND TVD ARE REFERENCED (=0) AT WELL DATUM AND INCREASE DOWNWARDS\n#====\n\
                MD X Y Z TVD DX DY AZIM_TN INCL DLS AZIM_GN\n#====\n\
                0 460000.5 5930000.25 25 0 0 0 1.5 0 0 0\n1000 460000.5 5930000.25 -975 1000 0 0 1.5 0 0 0\n\
                1100 460000.5 5930017.3 -1073.5 1098.5 0 17.05 1.5 20 6 0\n";
    let read = read(text, &WellOptions::default());
    assert_eq!((read.name.as_deref(), read.path.datum_m()), (Some("A 1"), 25.0));
    assert_eq!(read.path.head(), DVec2::new(460_000.5, 5_930_000.25));
    assert!(read.path.position_at_md(500.0).unwrap().z - 475.0 < 1e-9);
    // 20° over 100 m northwards: the radius is 286.5 m.
    let radius = 100.0 / 20f64.to_radians();
    let td = read.path.position_at_md(1100.0).unwrap();
    // The place in the file, which the angles reach but for its rounding.
    assert!((td.y - 5_930_017.3).abs() < 1e-9);
    assert!((td.y - 5_930_000.25 - radius * (1.0 - 20f64.to_radians().cos())).abs() < 0.5);
    assert!(read.report.warnings.is_empty(), "{:?}", read.report.warnings);
    assert!(read.report.notes.iter().any(|n| n.fact.contains("own 3 places")), "{:?}", read.report.notes);
}

#[test]
fn what_is_missing_is_said() {
    let refused = |text: &str, options: &WellOptions| {
        let error = parse_deviation(Path::new("well.csv"), text, options).unwrap_err();
        format!("{error}; {}", error.remedy().unwrap_or_default())
    };
    let plain = WellOptions::default();
    assert!(refused("md,inc,azi\n0,0,0\n10,0,0\n", &plain).contains("X and Y of the head"));
    assert!(refused("a,b,c\n1,2,3\n", &options()).contains("columns md,inc,azi"));
    assert!(refused("md,inc,azi\n0,0,0\nten,0,0\n", &options()).contains("line 3"));
    assert!(refused("md,inc,azi\n0,0,0\n0,0,0\n", &options()).contains("increase"));
    assert!(refused("md,inc,azi\n0,0,0\n100,200,0\n", &options()).contains("inclination"));
    assert!(refused("md,inc,azi\n0,0,0\n100,170,0\n", &options()).contains("170 degrees"));
    assert!(refused("md,x,y,tvdss\n0,0,0,0\n100,0,0,328\n", &options()).contains("unit along the well"));
    assert!(refused("", &options()).contains("no rows"));
    let assumed = read("md,inc,azi\n0,0,0\n100,0,0\n", &WellOptions { datum_m: None, ..options() });
    assert!(assumed.report.warnings[0].to_string().contains("datum above sea level"), "{:?}", assumed.report.warnings);
    assert!(assumed.report.assumptions.iter().any(|n| n.to_string().contains("unit along the well")));
}

#[test]
fn tops_by_measured_and_vertical_depth() {
    let path = quarter_circle();
    let tops = |text: &str| {
        let mut notes = WellReport::default();
        parse_tops(Path::new("tops.csv"), text, &path, &options(), &mut notes).unwrap_or_else(|e| panic!("{e}"))
    };
    let by_md = tops("surface,md_m\nTop Chalk,400\n\"Base, Chalk\",700\n");
    assert_eq!((by_md[1].name.as_str(), by_md[1].md_m), ("Base, Chalk", Some(700.0)));
    let z = path.position_at_md(700.0).unwrap().z;
    for text in [
        format!("name,tvdss\nA,{z}\n"),
        format!("name,tvd\nA,{}\n", z + 25.0),
        format!("Well;Surface;Z\nB2;A;-1\nwell;A;{}\n", -z),
        "700 A\n".to_string(),
        format!(
            "# Petrel well tops\nVERSION 2\nBEGIN HEADER\nX\nY\nZ\nMD\nType\nSurface\nWell\nEND HEADER\
             \n1 2 {} 700 Horizon \"A\" \"well\"\n",
            -z
        ),
    ] {
        let told = WellOptions { name: Some("Well".into()), ..options() };
        let mut notes = WellReport::default();
        let found =
            parse_tops(Path::new("tops.csv"), &text, &path, &told, &mut notes).unwrap_or_else(|e| panic!("{e}"));
        assert_eq!(found.len(), 1, "{text}");
        assert!((found[0].md_m.unwrap() - 700.0).abs() < 1e-6, "{text}: {found:?}");
    }
    let several = "well,surface,md\nA1,T,10\nB2,T,20\n";
    let error =
        parse_tops(Path::new("t"), several, &path, &options(), &mut WellReport::default()).unwrap_err().to_string();
    assert!(error.contains("A1, B2"), "{error}");
}

#[test]
fn checkshots_in_seconds_one_way_and_negative_are_the_same() {
    let path = quarter_circle();
    let parse = |text: &str| {
        let mut notes = WellReport::default();
        let found = parse_checkshot(Path::new("c"), text, &path, &options(), &mut notes);
        (found.unwrap_or_else(|e| panic!("{text}: {e}")), notes)
    };
    for text in [
        "tvdss_m,twt_ms\n0,0\n500,500\n1500,1300\n",
        "0 0\n500 0.5\n1500 1.3\n",
        "TVDSS,OWT\n0,0\n500,250\n1500,650\n",
        "z,twt\n0,0\n-500,-500\n-1500,-1300\n",
        "tvd_m,twt_s\n25,0\n525,0.5\n1525,1.3\n",
    ] {
        let (checkshot, _) = parse(text);
        assert!((checkshot.twt_at_tvdss(1000.0) - 900.0).abs() < 1e-9, "{text}");
        assert!((checkshot.tvdss_at_twt(900.0) - 1000.0).abs() < 1e-9, "{text}");
        // Beyond the last shot the last interval goes on.
        assert!((checkshot.twt_at_tvdss(1600.0) - 1380.0).abs() < 1e-9, "{text}");
    }
    let mut notes = WellReport::default();
    let error = parse_checkshot(Path::new("c"), "tvdss,twt\n0,0\n1,500000\n", &path, &options(), &mut notes);
    assert!(error.unwrap_err().to_string().contains("ms or s"));
    assert!(Checkshot::new(vec![[0.0, 10.0], [100.0, 5.0]]).is_err());
}

const LAS: &str = "~VERSION INFORMATION\n VERS.   2.0 : CWLS LAS 2.0\n WRAP.    NO : one line a depth\n~WELL\n\
 STRT.FT  1640.4199 : start\n STOP.FT 1643.7008 : stop\n STEP.FT 1.64042 : step\n NULL. -999.25 :\n\
 WELL.  A-1 : WELL\n DATE. 13:45 01.02.2003 : LOG DATE\n~CURVE\n DEPT.FT : depth\n GR  .GAPI 45 310 01 : Gamma ray\n\
 DT.US/F : Sonic\n~PARAMETER\n EKB.FT 82.02 : kelly bushing\n~ASCII\n 1640.4199 30 -999.25\n 1642.0603 60 100\n 1643.7008 90 110\n";

fn read_las(text: &str) -> Result<(Well, WellReport), WellFileError> {
    let folder = tempfile::tempdir().unwrap();
    let (deviation, las) = (folder.path().join("d.csv"), folder.path().join("a.las"));
    std::fs::write(&deviation, "md_m,inc,azi\n0,0,0\n1000,0,0\n").unwrap();
    std::fs::write(&las, text).unwrap();
    let checkshot = folder.path().join("c.csv");
    std::fs::write(&checkshot, "tvdss_m,twt_ms\n0,0\n1000,1000\n").unwrap();
    let files = WellFiles { deviation, las: vec![las], checkshot: Some(checkshot), tops: None, ..WellFiles::default() };
    read_well(&files, &WellOptions { name: Some("A 1".into()), ..options() })
}

#[test]
fn las_curves_in_feet_lie_along_the_well() {
    let (well, report) = read_las(LAS).unwrap();
    let set = &well.logs[0];
    assert_eq!(set.curves.len(), 2);
    assert_eq!((set.curves[0].name.as_str(), set.curves[0].unit.as_str()), ("GR", "GAPI"));
    assert!((set.md_m[0] - 500.0).abs() < 1e-3 && (set.md_m[2] - 501.0).abs() < 1e-3);
    assert!((set.value_at_md(&set.curves[0], 500.25) - 45.0).abs() < 0.1);
    assert!(set.value_at_md(&set.curves[0], 499.0).is_nan());
    let geometry = SurveyGeometry::regular([201, 301, 1001], 10.0, 1.0, VerticalUnit::Metres);
    let along = well.log_in_voxels("dt", &geometry).unwrap();
    assert_eq!(along.len(), 2);
    assert!(along[0].0.distance(DVec3::new(100.0, 200.0, 475.5)) < 1e-3, "{}", along[0].0);
    assert!(report.warnings.is_empty(), "{:?}", report.warnings);
    let las = parse_las(Path::new("a"), LAS).unwrap();
    assert_eq!(las.well_item("DATE").unwrap().value, "13:45 01.02.2003");
    assert_eq!(las.number("EKB"), Some((82.02, "FT")));
}

#[test]
fn las_wrapped_falling_in_time_and_old() {
    let wrapped = LAS.replace("WRAP.    NO", "WRAP.    YES").replace(" 30 -999.25", "\n 30\n -999.25\n");
    // A hole is null in JSON, where it is equal to itself.
    let log = |text: &str| serde_json::to_string(&read_las(text).unwrap().0.logs[0]).unwrap();
    assert_eq!(log(&wrapped), log(LAS));
    let rows: Vec<&str> = LAS.lines().collect();
    let (head, data) = rows.split_at(rows.len() - 3);
    let falling = format!("{}\n{}\n{}\n{}\n", head.join("\n"), data[2], data[1], data[0])
        .replace("STRT.FT  1640.4199", "STRT.FT 1643.7008")
        .replace("STOP.FT 1643.7008", "STOP.FT 1640.4199");
    assert_eq!(log(&falling), log(LAS));
    let time = LAS
        .replace(" DEPT.FT", " TWT.MS")
        .replace(" 1640.4199 30", " 475 30")
        .replace(" 1642.0603 60", " 476 60")
        .replace(" 1643.7008 90", " 477 90");
    let (well, _) = read_las(&time).unwrap();
    assert!((well.logs[0].md_m[1] - 501.0).abs() < 1e-6, "{:?}", well.logs[0].md_m);
    let old = LAS.replace("VERS.   2.0", "VERS.   1.2").replace("WELL.  A-1 : WELL", "WELL. WELL : A-1");
    assert_eq!(parse_las(Path::new("a"), &old).unwrap().well_name(), Some("A-1"));
}

#[test]
fn las_3_with_its_own_sections_and_empty_cells_is_read() {
    let head = "~VERSION\nVERS. 3.0 :\nWRAP. NO :\nDLM. COMMA :\n~WELL\nNULL. -999.25 :\nWELL. A-1 :\n";
    for (curves, data) in [("~Log_Definition", "~Log_Data | Log_Definition"), ("~Curve", "~ASCII | Curve")] {
        let text = format!(
            "{head}~Tops_Definition\nTOPN. : name {{S}}\n~Tops_Data | Tops_Definition\nChalk,500\n{curves}\nDEPT.M : depth {{F}}\n\
             GR.GAPI : gamma {{F}}\nLITH. : rock {{S10}}\n{data}\n500,30,chalk\n501,,marl\n502,-999.25,\n"
        );
        let las = parse_las(Path::new("a"), &text).unwrap_or_else(|e| panic!("{curves}: {e}"));
        assert_eq!((las.data[0].len(), las.data[1][0], las.curves.len()), (3, 30.0, 3), "{curves}");
        assert!(las.data[1][1].is_nan() && las.data[1][2].is_nan(), "{curves}");
    }
}

#[test]
fn las_that_cannot_be_read_says_why() {
    let why = |text: &str| read_las(text).unwrap_err().to_string();
    assert!(why(&LAS.replace("VERS.   2.0", "VERS.   4.0")).contains("export it as LAS 2.0"));
    assert!(why("1 2 3\n").contains("~V"));
    assert!(why(&LAS.replace("60 100", "60")).contains("3 values"));
    assert!(why(&LAS.replace("60 100", "60 abc")).contains("line 19"));
    assert!(why(&LAS.replace(" DEPT.FT", " DEPT.XX")).contains("M, FT, MS or S"));
    assert!(why(LAS.split("~ASCII").next().unwrap()).contains("~A"));
    let other = LAS.replace("WELL.  A-1", "WELL.  B-2");
    assert!(read_las(&other).unwrap().1.warnings[0].fact.contains("B-2"));
}

#[test]
fn wells_survive_json() {
    let (mut well, _) = read_las(LAS).unwrap();
    well.tops.push(Top { name: "T".into(), md_m: 500.0 });
    let text = serde_json::to_string(&well).unwrap();
    let back: Well = serde_json::from_str(&text).unwrap();
    // NaN is not equal to itself; the text is.
    assert_eq!(serde_json::to_string(&back).unwrap(), text);
    assert!(back.logs[0].curves[1].values[0].is_nan());
    let broken = text.replace("\"md_m\":1000.0,\"position\"", "\"md_m\":-1.0,\"position\"");
    assert!(serde_json::from_str::<Well>(&broken).unwrap_err().to_string().contains("increase"));
}

/// A LAS 3.0 file with a log and the sections of its tops.
fn las_with(tops: &str, delimiter: &str, unit: &str) -> String {
    let cut = if delimiter == "COMMA" {
        ','
    } else if delimiter == "TAB" {
        '\t'
    } else {
        ' '
    };
    format!(
        "~Version\nVERS. 3.0 :\nWRAP. NO :\nDLM. {delimiter} :\n~Well\nSTRT.{unit} 100 :\nSTOP.{unit} 200 :\nSTEP.{unit} 100 :\nNULL. \
         -999.25 :\nWELL. A-1 :\n~Log_Definition\nDEPT.{unit} : Depth {{F}}\nGR.GAPI : Gamma {{F}}\n~Log_Data | Log_Definition\n\
         100{cut}45\n200{cut}47\n{tops}"
    )
}

#[test]
fn tops_of_las_3_are_read_under_many_names_and_units() {
    let path = WellPath::through(
        25.0,
        &[(Some(0.0), DVec3::new(0.0, 0.0, -25.0)), (Some(3000.0), DVec3::new(0.0, 0.0, 2975.0))],
    )
    .unwrap();
    let data = "~Tops_Data | Tops_Definition\n";
    for (what, las, wanted) in [
        (
            "the standard's own",
            las_with(
                &format!(
                    "~Tops_Parameter\nTOPS. Logs : Source\n~Tops_Definition\nTOPN. : Name {{S}}\nTOPT.M : Top {{F}}\nTOPB.M : Base {{F}}\n{data}Viking,1000,1010\n\"Colony, upper\",1010.5,1020.5\n"
                ),
                "COMMA",
                "M",
            ),
            [("Viking", 1000.0), ("Colony, upper", 1010.5)],
        ),
        (
            "in feet by their own unit",
            las_with(
                "~TOPS_DEFINITION\nTOPT.FT : Top {F}\nTOPN. : Name {S}\n~TOPS_DATA | TOPS_DEFINITION\n1000 \"Top A\"\n2000 B\n",
                "SPACE",
                "M",
            ),
            [("Top A", 304.8), ("B", 609.6)],
        ),
        (
            "in the feet of the log, tabs",
            las_with(
                &format!("~Tops_Definition\nTOPN. : Name {{S}}\nTOPT. : Top {{F}}\n{data}Top A\t1000\nB\t2000\n"),
                "TAB",
                "FT",
            ),
            [("Top A", 304.8), ("B", 609.6)],
        ),
        (
            "TOPT is the name",
            las_with(
                &format!(
                    "~Tops_Definition\nTOPT. : TOP NAME {{S}}\nTOPD.M : TOP DEPTH {{F}}\n{data}\"Top Sand A\",1500.4\nB,1600\n"
                ),
                "COMMA",
                "M",
            ),
            [("Top Sand A", 1500.4), ("B", 1600.0)],
        ),
        (
            "below sea level, negative",
            las_with(
                &format!(
                    "~Tops_Parameter\nTOPDR. Subsea : Tops Depth Reference {{S}}\n~Tops_Definition\nTOPT.M : {{F}}\nTOPB.M : {{F}}\nTOPN. : {{S}}\n{data}-1545.5,-1603,Viking\n-1603,-1614.8,Colony\n"
                ),
                "COMMA",
                "M",
            ),
            [("Viking", 1570.5), ("Colony", 1628.0)],
        ),
        (
            "many columns",
            las_with(
                "~Tops_Definition[1]\nKID. : {S}\nID. : {S}\nTOPT.F : {F}\nTOPB.F : {F}\nRANK. : {S}\nTOPN. : {S}\nFORM. : {S}\n~Tops_Data[1] | Tops_Definition[1]\n# KID ID\n\"-999.25\",\"11\",4338.0,0.0,\"FORMATION\",\"Topeka\",\"Topeka Limestone\"\n\"-999.25\",\"12\",4454.0,0.0,\"GROUP\",\"Oread\",\"\"\n",
                "COMMA",
                "F",
            ),
            [("Topeka", 4338.0 * 0.3048), ("Oread", 4454.0 * 0.3048)],
        ),
    ] {
        let mut report = WellReport::default();
        let rows = parse_tops(Path::new("a.las"), &las, &path, &WellOptions::default(), &mut report)
            .unwrap_or_else(|e| panic!("{what}: {e}\n{las}"));
        let found: Vec<(&str, f64)> =
            rows.iter().map(|row| (row.name.as_str(), row.md_m.unwrap_or(f64::NAN))).collect();
        let is_same = found.len() == 2 && found.iter().zip(wanted).all(|(a, b)| a.0 == b.0 && (a.1 - b.1).abs() < 1e-6);
        assert!(is_same, "{what}: {found:?}, {wanted:?}");
        let told = describe(Path::new("a.las"), &las).unwrap().unwrap();
        assert!(told.facts.iter().any(|fact| fact == "tops: 2"), "{what}: {:?}", told.facts);
        // The line of a row is that of the file.
        assert!(las.lines().nth(rows[1].line - 1).unwrap().contains(wanted[1].0), "{what}");
    }
    let none = las_with("", "COMMA", "M");
    assert!(parse_tops(Path::new("a.las"), &none, &path, &WellOptions::default(), &mut WellReport::default()).is_err());
    // A file of tops and no curves.
    let alone = format!(
        "~Version\nVERS. 3.0 :\nDLM. COMMA :\n~Tops_Definition\nTOPN. : {{S}}\nTOPT.M : {{F}}\n{data}Viking,1000\n"
    );
    assert_eq!(describe(Path::new("a.las"), &alone).unwrap().unwrap().kind, WellFileKind::Tops);
    for cut in 0..alone.len() {
        let _ = describe(Path::new("a.las"), &alone[..cut]);
        let _ =
            parse_tops(Path::new("a.las"), &alone[..cut], &path, &WellOptions::default(), &mut WellReport::default());
    }
}

#[test]
fn tops_of_a_log_are_the_wells_where_no_other_file_has_them() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| {
        let path = folder.path().join(name);
        std::fs::write(&path, text).unwrap();
        path
    };
    let deviation = write("a.dev", "# KB 25\nMD,INC,AZI,X,Y,TVD\n0,0,0,0,0,0\n3000,0,0,0,0,3000\n");
    let tops = "~Tops_Definition\nTOPN. : {S}\nTOPT.M : {F}\n~Tops_Data | Tops_Definition\nViking,150\nDeep,9000\n";
    let las = vec![write("a.las", &las_with(tops, "COMMA", "M"))];
    let files = WellFiles { deviation, las, ..WellFiles::default() };
    let (well, report) = read_well(&files, &WellOptions::default()).unwrap();
    assert_eq!(
        well.tops.iter().map(|top| (top.name.as_str(), top.md_m)).collect::<Vec<_>>(),
        [("Viking", 150.0)],
        "{report:?}"
    );
    assert!(report.warnings.iter().any(|warning| warning.to_string().contains("Deep")), "{report:?}");
    let told = WellFiles { tops: Some(write("tops.csv", "surface,md_m\nOther,200\n")), ..files };
    let (well, _) = read_well(&told, &WellOptions::default()).unwrap();
    assert_eq!(well.tops.iter().map(|top| top.name.as_str()).collect::<Vec<_>>(), ["Other"]);
}

#[test]
fn places_without_depths_are_the_head_and_checkshots_along_the_hole_are_described() {
    let text = "MD_ft,Inc_deg,Azi_deg,X,Y\n0,0,60,1000,2000\n1640.42,0,60,1000,2000\n3280.84,30,60,1100,2060\n";
    let found = read(text, &WellOptions { datum_m: Some(25.0), ..WellOptions::default() });
    assert_eq!(found.path.position_at_md(0.0).unwrap().truncate(), DVec2::new(1000.0, 2000.0));
    assert!((found.path.md_range_m()[1] - 1000.0).abs() < 1e-2);
    let up = "MD,X,Y,Z elevation (m)\n0,1000,2000,25\n500,1000,2000,-475\n";
    assert_eq!(read(up, &WellOptions::default()).path.datum_m(), 25.0);
    for head in ["MD (m),TWT (s)", "TVDSS;TWT", "depth_m,owt_ms"] {
        let text = format!("{head}\n{}", "0,0\n500,0.5\n".replace(',', if head.contains(';') { ";" } else { "," }));
        let found = describe(Path::new("cs.csv"), &text).unwrap();
        assert_eq!(found.map(|found| found.kind), Some(WellFileKind::Checkshot), "{head}");
    }
}
