//! The inputs that fuzzing starts from, most of them by our own writers.

use std::fs;
use std::path::Path;

use files::segy::{ByteOrder, WriteFormat, WriteOptions};
use files::{Format, write_fault, write_horizon};
use survey::{Progress, Volume};

type Done = Result<(), Box<dyn std::error::Error>>;

/// Makes a folder for each target in the folder that the environment names (`FUZZ_SEEDS`), if it names one.
///
/// # Panics
/// When they cannot be written.
pub fn write_if_asked() {
    let Some(corpus) = std::env::var_os("FUZZ_SEEDS") else { return };
    let corpus = Path::new(&corpus);
    let written = segy_seeds(corpus).and_then(|()| surface_seeds(corpus)).and_then(|()| well_seeds(corpus));
    if let Err(error) = written {
        panic!("{}: {error}", corpus.display());
    }
}

fn well_seeds(corpus: &Path) -> Done {
    for (n, (kind, text)) in crate::WELL_FILES.iter().enumerate() {
        let folder = corpus.join(format!("well-{kind}"));
        fs::create_dir_all(&folder)?;
        fs::write(folder.join(format!("hand-written-{n}")), text)?;
    }
    Ok(())
}

fn segy_seeds(corpus: &Path) -> Done {
    let (whole, headers) = (corpus.join("segy"), corpus.join("segy-headers"));
    fs::create_dir_all(&whole)?;
    fs::create_dir_all(&headers)?;
    let mut geometry = crate::survey();
    geometry.inlines.count = 3;
    geometry.crosslines.count = 4;
    geometry.vertical.count = 3;
    let mut volume = Volume::filled([3, 4, 3], 1.5_f32);
    volume.samples_mut().iter_mut().enumerate().for_each(|(k, sample)| *sample = k as f32 * 0.5 - 4.0);
    for (name, format, byte_order) in [
        ("ieee", WriteFormat::Ieee32, ByteOrder::Big),
        ("ibm", WriteFormat::Ibm32, ByteOrder::Big),
        ("int16-little", WriteFormat::Int16, ByteOrder::Little),
        ("int8", WriteFormat::Int8, ByteOrder::Big),
    ] {
        let path = whole.join(name);
        let options = WriteOptions { format, byte_order, ..WriteOptions::default() };
        files::segy::write(&path, &geometry, &volume, &options, &Progress::silent())?;
        let bytes = fs::read(&path)?;
        fs::write(headers.join(name), [&[0; 12], &bytes[3200..]].concat())?;
        // Without line numbers, and with a missing trace: what the place of traces alone has to tell.
        let mut numberless = bytes.clone();
        let stride = 240 + 3 * format.sample_format().bytes();
        for trace in numberless[3600..].chunks_exact_mut(stride) {
            trace[20..24].fill(0);
            trace[188..196].fill(0);
        }
        numberless.truncate(bytes.len() - stride);
        fs::write(headers.join(format!("{name}-numberless")), [&[0; 12], &numberless[3200..]].concat())?;
    }
    Ok(())
}

fn surface_seeds(corpus: &Path) -> Done {
    let geometry = crate::survey();
    let (horizon, fault) = crate::interpretation(&geometry);
    let detected = corpus.join("surface-detected");
    fs::create_dir_all(&detected)?;
    for format in Format::all() {
        let folder = corpus.join(format!("surface-{}", format.name()));
        fs::create_dir_all(&folder)?;
        // A format that is only read starts from the plain table of another.
        let own = [
            write_horizon(&folder.join("horizon"), &horizon, &geometry, format).is_ok(),
            write_fault(&folder.join("fault"), &fault, &geometry, format).is_ok(),
        ];
        let texts = crate::HAND_WRITTEN.iter().map(|(name, text)| (*name, text.as_bytes().to_vec()));
        let all = texts.chain(crate::inputs::binary_files()).filter(|(name, _)| *name == format.name());
        for (n, (name, content)) in all.enumerate() {
            fs::write(folder.join(format!("hand-written-{n}")), &content)?;
            fs::write(detected.join(format!("{name}-{n}")), &content)?;
        }
        for (name, is_written) in ["horizon", "fault"].into_iter().zip(own) {
            if is_written {
                fs::copy(folder.join(name), detected.join(format!("{}-{name}", format.name())))?;
            }
        }
    }
    Ok(())
}
