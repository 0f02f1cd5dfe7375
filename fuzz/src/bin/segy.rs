//! A whole SEG-Y file, as it is. This target also writes the seeds of all others.

#![no_main]

use files::segy::SegyOptions;

libfuzzer_sys::fuzz_target!(
    init: fuzz::seeds::write_if_asked(),
    |data: &[u8]| fuzz::read_segy(data.to_vec(), &SegyOptions::default())
);
