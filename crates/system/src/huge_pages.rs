//! Memory for a whole volume, in huge pages where the system has them.
//!
//! The first write to each page of fresh memory causes a page fault. A cube of 512³ floats has 131 072 pages
//! of 4 KiB, or 256 pages of 2 MiB. With pages of 4 KiB, decoding a sample costs less than its share of the
//! page faults.

/// `count` zeros. The threads that write to the memory touch it first, which decides where the system places
/// it.
pub fn zeroed<T: Clone + Default>(count: usize) -> Vec<T> {
    let samples = vec![T::default(); count];
    advise(&samples);
    samples
}

/// Asks the system for huge pages. Where it refuses, the program works as before.
#[cfg(target_os = "linux")]
fn advise<T>(samples: &[T]) {
    /// The advice must begin at a page boundary; no system has smaller pages than this.
    const PAGE: usize = 4096;
    let (start, bytes) = (samples.as_ptr() as usize, size_of_val(samples));
    let first = start.next_multiple_of(PAGE);
    let end = (start + bytes) / PAGE * PAGE;
    if end <= first {
        return;
    }
    #[expect(unsafe_code, reason = "the standard library has no such advice; measured above")]
    // SAFETY: the range lies within the caller's own memory, and the advice changes no content.
    unsafe {
        libc::madvise(first as *mut libc::c_void, end - first, libc::MADV_HUGEPAGE);
    }
}

#[cfg(not(target_os = "linux"))]
fn advise<T>(_samples: &[T]) {}

#[cfg(test)]
mod tests {
    #[test]
    fn any_count_is_zeros() {
        for count in [0, 1, 1023, 1024, 5000, 3_000_000] {
            let samples = super::zeroed::<f32>(count);
            assert!(samples.len() == count && samples.iter().all(|&v| v == 0.0));
        }
    }
}
