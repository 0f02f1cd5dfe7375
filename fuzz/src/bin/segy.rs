//! A whole SEG-Y file, as it is.

#![no_main]

use survey::segy::SegyOptions;

libfuzzer_sys::fuzz_target!(|data: &[u8]| fuzz::read_segy(data.to_vec(), &SegyOptions::default()));
