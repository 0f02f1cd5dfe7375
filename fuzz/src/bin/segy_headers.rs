//! A SEG-Y file without its textual header, which is blank: 12 bytes of options, the binary header, traces. Shorter
//! inputs are tried faster, and what they are made of is what matters.

#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| {
    let Some((options, rest)) = data.split_first_chunk::<12>() else { return };
    let mut file = vec![b' '; 3200];
    file.extend(rest);
    fuzz::read_segy(file, &fuzz::segy_options(options));
});
