//! What is written comes back: samples, lines, place, live traces.

use glam::DVec2;

use super::super::{ByteOrder, SegyOptions, WriteFormat, WriteOptions, read, write};
use survey::geometry::{LineAxis, SurveyGeometry, VerticalAxis, VerticalUnit};
use survey::progress::Progress;
use survey::remedy::Note;
use survey::volume::Volume;

struct Random(u64);

impl Random {
    fn below(&mut self, n: u64) -> u64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) % n
    }

    /// In [-1, 1).
    fn signed(&mut self) -> f64 {
        self.below(1 << 30) as f64 / f64::from(1 << 29) - 1.0
    }

    fn axis(&mut self) -> LineAxis {
        let step = [1, -1, 2, -3, 10][self.below(5) as usize];
        LineAxis { first: 500 + self.below(3000) as i32, step, count: 2 + self.below(9) as usize }
    }

    /// Lines that step or count down, rotated, mirrored, of unequal bins.
    fn geometry(&mut self) -> SurveyGeometry {
        let angle = self.signed() * std::f64::consts::PI;
        let inline_vector = DVec2::from_angle(angle) * (5.0 + 30.0 * self.signed().abs());
        let mirror = if self.below(2) == 0 { 1.0 } else { -1.0 };
        let unit = [VerticalUnit::Milliseconds, VerticalUnit::Metres][self.below(2) as usize];
        SurveyGeometry {
            inlines: self.axis(),
            crosslines: self.axis(),
            vertical: VerticalAxis {
                first: [0.0, 876.0, -24.0, 1166.5][self.below(4) as usize],
                interval: [4.0, 2.6, 0.5, 10.0][self.below(4) as usize],
                count: 1 + self.below(20) as usize,
                unit,
            },
            origin: DVec2::new(self.signed() * 8e5, self.signed() * 7e6),
            inline_vector,
            crossline_vector: inline_vector.normalize().perp() * mirror * (5.0 + 30.0 * self.signed().abs()),
            velocity_m_s: 2000.0,
        }
    }

    /// Integers that the format holds, or any floats.
    fn volume(&mut self, size: [usize; 3], format: WriteFormat) -> Volume<f32> {
        let mut volume = Volume::filled(size, 0.0);
        for value in volume.samples_mut() {
            *value = match format {
                WriteFormat::Ieee32 | WriteFormat::Ibm32 => (self.signed() * 3e4) as f32,
                WriteFormat::Uint16 => (self.signed().abs() * 65_535.0).round() as f32,
                WriteFormat::Uint8 => (self.signed().abs() * 255.0).round() as f32,
                _ => (self.signed() * 127.0).round() as f32,
            };
        }
        volume
    }
}

#[test]
fn every_format_and_order_on_random_surveys() {
    let mut random = Random(20_261_121);
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("volume.sgy");
    let formats = [
        WriteFormat::Ieee32,
        WriteFormat::Ibm32,
        WriteFormat::Int32,
        WriteFormat::Int16,
        WriteFormat::Int8,
        WriteFormat::Uint16,
        WriteFormat::Uint8,
    ];
    for round in 0..182 {
        let format = formats[round % formats.len()];
        let byte_order = [ByteOrder::Big, ByteOrder::Little][round / formats.len() % 2];
        let geometry = random.geometry();
        let size = geometry.size();
        let mut volume = random.volume(size, format);
        if round % 3 == 0 && size[0] * size[1] > 20 {
            let mut live = vec![true; size[0] * size[1]];
            // Inner traces, so that every line keeps one.
            for place in (0..live.len()).filter(|p| p / size[1] > 0 && p % size[1] > 0) {
                live[place] = random.below(6) > 0;
            }
            for place in (0..live.len()).filter(|&p| !live[p]) {
                volume.trace_mut(place / size[1], place % size[1]).fill(0.0);
            }
            if live.contains(&false) {
                volume.set_live(Some(live)).unwrap();
            }
        }
        let options = WriteOptions { format, byte_order, ..WriteOptions::default() };
        let report = write(&path, &geometry, &volume, &options, &Progress::silent()).unwrap();
        assert_eq!(report.bytes, std::fs::metadata(&path).unwrap().len());
        assert_eq!(report.clipped, 0);
        let found =
            read(&path, &SegyOptions::default(), &Progress::silent()).unwrap_or_else(|e| panic!("{round}: {e}"));
        assert_eq!(found.info.traces, report.traces);
        assert_eq!(found.info.warnings, Vec::<Note>::new(), "{round}");
        assert_eq!(found.info.assumptions, Vec::<Note>::new(), "{round}");
        assert_eq!(found.info.byte_order, byte_order);
        assert_eq!(found.geometry.inlines, geometry.inlines, "{round}");
        assert_eq!(found.geometry.crosslines, geometry.crosslines, "{round}");
        assert_eq!(found.geometry.vertical.unit, geometry.vertical.unit);
        assert_eq!(found.geometry.vertical.count, geometry.vertical.count);
        assert!((found.geometry.vertical.first - geometry.vertical.first).abs() < 1e-9);
        assert!((found.geometry.vertical.interval - geometry.vertical.interval).abs() < 1e-9);
        // Centimetres are stored.
        for [x, y] in [[0, 0], [size[0] - 1, 0], [0, size[1] - 1], [size[0] - 1, size[1] - 1]] {
            let at = glam::DVec3::new(x as f64, y as f64, 0.0);
            let off = found.geometry.world_from_voxel(at) - geometry.world_from_voxel(at);
            assert!(off.truncate().length() < 0.02, "{round}: {off}");
        }
        assert_eq!(found.volume.live(), volume.live(), "{round}");
        for (a, b) in found.volume.samples().iter().zip(volume.samples()) {
            let tolerance = if format == WriteFormat::Ibm32 { b.abs() * 2.0_f32.powi(-21) } else { 0.0 };
            assert!((a - b).abs() <= tolerance, "{round}: {a} {b}");
        }
    }
}

#[test]
fn integers_are_rounded_clipped_and_counted() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("volume.sgy");
    let geometry = SurveyGeometry::regular([2, 2, 2], 25.0, 4.0, VerticalUnit::Milliseconds);
    let samples = vec![0.004, -0.016, 12.7, 20.0, -20.0, f32::NAN, f32::INFINITY, 0.05];
    let volume = Volume::from_samples([2, 2, 2], samples).unwrap();
    let options = WriteOptions { format: WriteFormat::Int8, gain: 10.0, ..WriteOptions::default() };
    let report = write(&path, &geometry, &volume, &options, &Progress::silent()).unwrap();
    assert_eq!(report.clipped, 4);
    let found = read(&path, &SegyOptions::default(), &Progress::silent()).unwrap();
    assert_eq!(found.volume.samples(), &[0.0, 0.0, 127.0, 127.0, -128.0, 0.0, 127.0, 1.0]);
}

#[test]
fn the_text_header_is_ours_or_theirs() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("volume.sgy");
    let geometry = SurveyGeometry::regular([2, 2, 2], 25.0, 4.0, VerticalUnit::Metres);
    let volume = Volume::filled([2, 2, 2], 0.0);
    let text = vec!["MY SURVEY, DEPTH".to_owned(), "SECOND".to_owned()];
    let options = WriteOptions { text, ..WriteOptions::default() };
    write(&path, &geometry, &volume, &options, &Progress::silent()).unwrap();
    let info = read(&path, &SegyOptions::default(), &Progress::silent()).unwrap().info;
    assert_eq!(&info.text[..2], ["C 1 MY SURVEY, DEPTH", "C 2 SECOND"]);
    write(&path, &geometry, &volume, &WriteOptions::default(), &Progress::silent()).unwrap();
    let info = read(&path, &SegyOptions::default(), &Progress::silent()).unwrap().info;
    assert!(info.page().contains("CROSSLINES 1 TO 2 STEP 1 (2) AT BYTE 193"), "{}", info.page());
}

#[test]
fn the_same_bytes_and_figures_on_one_thread_and_three() {
    let folder = tempfile::tempdir().unwrap();
    let mut random = Random(5);
    let geometry = SurveyGeometry::regular([30, 40, 50], 25.0, 4.0, VerticalUnit::Milliseconds);
    let volume = random.volume([30, 40, 50], WriteFormat::Ibm32);
    let options = WriteOptions { format: WriteFormat::Ibm32, ..WriteOptions::default() };
    let outcomes: Vec<_> = [1, 3]
        .into_iter()
        .map(|threads| {
            let path = folder.path().join(format!("{threads}.sgy"));
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            let found = pool.install(|| {
                write(&path, &geometry, &volume, &options, &Progress::silent()).unwrap();
                read(&path, &SegyOptions::default(), &Progress::silent()).unwrap()
            });
            (std::fs::read(&path).unwrap(), found.volume, found.amplitudes)
        })
        .collect();
    assert!(outcomes[0] == outcomes[1]);
}
