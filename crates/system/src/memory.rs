//! How much memory there is, and whether what a file states fits into it.
//!
//! Counts come from files, and files may be damaged or made to do harm. Before memory is taken for a product
//! of counts, [`check`] multiplies them without overflow and compares them with what the machine has.

use sysinfo::{MemoryRefreshKind, RefreshKind, System};

/// Assumed where a system cannot be asked: enough for a section of any survey.
const UNKNOWN: u64 = 1 << 31;

/// Amounts below this are not compared with what is available, since asking takes time.
const ALWAYS_FITS: u64 = 64 << 20;

/// More than there is.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{what} would take {} of memory, more than the {} that are available; work on a part, or on a machine with more memory", size(*needed), size(Some(*available)))]
pub struct NotEnough {
    /// What it would be taken for.
    pub what: String,
    /// Bytes needed; `None` when they are beyond counting.
    pub needed: Option<u64>,
    /// Bytes available.
    pub available: u64,
}

/// A number of bytes for people.
pub(crate) fn size(bytes: Option<u64>) -> String {
    match bytes {
        None => "more than 18 million TB".to_owned(),
        Some(bytes) if bytes < 10 << 30 => format!("{} MB", bytes >> 20),
        Some(bytes) => format!("{} GB", bytes >> 30),
    }
}

/// Makes at most so many threads of the process keep freed memory for themselves, and them keep `bytes` of it for what comes
/// next: for work that is to stay within stated memory.
///
/// The allocator of Linux gives threads arenas of their own, and freed blocks stay in them: an extraction in bricks, whose
/// stages have threads of their own, held up to twice what it used. Large blocks it gives back at once instead, and when
/// they are taken anew the kernel clears them page by page: that was a seventh of the processor time of such an extraction.
/// So blocks up to a quarter of `bytes` come from what was freed, as far as the allocator allows that (32 MiB).
#[cfg(all(target_os = "linux", target_env = "gnu"))]
pub fn share_freed_memory(threads: usize, bytes: u64) {
    /// The least and the greatest size of a block that the allocator may be told to give back at once.
    const GIVEN_BACK: [u64; 2] = [4 << 20, 32 << 20];
    let given_back = (bytes / 4).clamp(GIVEN_BACK[0], GIVEN_BACK[1]) as libc::c_int;
    let kept = bytes.min(1 << 30) as libc::c_int;
    let arenas = threads.clamp(1, 1 << 10) as libc::c_int;
    #[expect(unsafe_code, reason = "the standard library cannot set up its allocator")]
    // SAFETY: the call changes where later blocks come from, not those that exist; it may be made from any thread.
    unsafe {
        libc::mallopt(libc::M_ARENA_MAX, arenas);
        libc::mallopt(libc::M_MMAP_THRESHOLD, given_back);
        libc::mallopt(libc::M_TRIM_THRESHOLD, kept);
    }
}

/// Nothing to set up elsewhere.
#[cfg(not(all(target_os = "linux", target_env = "gnu")))]
pub fn share_freed_memory(_threads: usize, _bytes: u64) {}

/// Memory that is available now, bytes: of the machine, of a control group's limit, and of a limit on the
/// process where one is set.
pub fn available() -> u64 {
    let memory = RefreshKind::nothing().with_memory(MemoryRefreshKind::nothing().with_ram());
    let Ok(system) = System::new_with_specifics(memory) else { return UNKNOWN };
    let group = system.cgroup_limits().map_or(u64::MAX, |limits| limits.free_memory);
    system.available_memory().min(group).min(address_space().unwrap_or(u64::MAX))
}

/// What `ulimit -v` leaves to this process, bytes; `None` without such a limit.
fn address_space() -> Option<u64> {
    let limits = std::fs::read_to_string("/proc/self/limits").ok()?;
    let line = limits.lines().find(|line| line.starts_with("Max address space"))?;
    let most: u64 = line.split_whitespace().nth(3)?.parse().ok()?;
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let used = status.lines().find_map(|line| line.strip_prefix("VmSize:"))?.split_whitespace().next()?;
    Some(most.saturating_sub(used.parse::<u64>().ok()? << 10))
}

/// Checks that elements of `bytes_each` in a lattice of `counts` fit into the memory that is available;
/// answers their bytes.
///
/// ```
/// assert_eq!(system::memory::check("a map", &[100, 50], 4), Ok(20_000));
/// assert!(system::memory::check("a volume", &[1 << 30, 1 << 30, 1 << 30], 4).is_err());
/// ```
///
/// # Errors
/// [`NotEnough`].
pub fn check(what: &str, counts: &[usize], bytes_each: usize) -> Result<u64, NotEnough> {
    let needed = counts.iter().chain([&bytes_each]).try_fold(1u64, |product, &count| product.checked_mul(count as u64));
    match needed {
        Some(bytes) if bytes <= ALWAYS_FITS => Ok(bytes),
        _ => {
            let available = available();
            match needed {
                Some(bytes) if bytes <= available => Ok(bytes),
                _ => Err(NotEnough { what: what.to_owned(), needed, available }),
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn more_than_the_machine_has_is_refused_and_said() {
        let error = check("the volume", &[200_000, 200_000, 2000], 4).unwrap_err();
        assert!(error.to_string().contains("298023 GB"), "{error}");
        let error = check("the volume", &[usize::MAX, 2, 2], 4).unwrap_err();
        assert_eq!(error.needed, None);
        assert!(available() > 0);
    }
}
