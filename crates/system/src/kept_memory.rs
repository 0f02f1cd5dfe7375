//! Freed memory that is kept for what comes next, within a stated amount.
//!
//! Work in bricks takes arrays of tens of megabytes and frees them, again and again. The system's allocator gives such
//! blocks back at once, and when they are taken anew the kernel clears them page by page: at 512³ samples that was a
//! seventh of the processor time of an extraction in bricks. A program whose global allocator is [`ProgramMemory`] keeps them instead, while
//! [`keep_freed`] says so: what is in use and what is kept are together no more than was stated, and when more is needed
//! what is kept goes first.

use crate::huge_pages::advise_at;
use std::alloc::{GlobalAlloc, Layout, System};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};

/// Blocks from this size are kept: those that the allocator of Linux takes from the system one by one.
pub(crate) const LARGE: usize = 4 << 20;

/// Blocks that are kept at most.
const MOST: usize = 64;

/// A kept block serves what is at least this share of it: a quarter.
const SHARE: usize = 4;

/// Alignment that the system's allocator gives to every block.
const ALIGNED: usize = 16;

/// The system's allocator, which keeps large blocks while [`keep_freed`] says so.
pub struct ProgramMemory;

/// Bytes that may be in use or kept in large blocks; 0 while nothing is kept.
static WITHIN: AtomicUsize = AtomicUsize::new(0);

/// Bytes in use in large blocks.
static IN_USE: AtomicUsize = AtomicUsize::new(0);

static KEPT: Mutex<FreedBlocks> = Mutex::new(FreedBlocks { blocks: [(0, 0); MOST], count: 0, bytes: 0 });

/// Keeps freed blocks until it is dropped.
#[derive(Debug)]
#[must_use]
pub struct Keeping(());

/// Keeps freed blocks so that with what is in use they are at most `bytes`. Without effect in a program that has another
/// global allocator, and on systems other than Linux.
pub fn keep_freed(bytes: u64) -> Keeping {
    if cfg!(all(target_os = "linux", target_env = "gnu")) {
        WITHIN.store(usize::try_from(bytes).unwrap_or(usize::MAX), Ordering::Relaxed);
    }
    Keeping(())
}

impl Drop for Keeping {
    fn drop(&mut self) {
        WITHIN.store(0, Ordering::Relaxed);
        give_all_back();
    }
}

/// Gives everything that is kept back to the system; whether there was anything.
fn give_all_back() -> bool {
    let mut kept = KEPT.lock().unwrap_or_else(PoisonError::into_inner);
    let had_any = kept.count > 0;
    while let Some(block) = kept.take_largest() {
        give_back(block);
    }
    had_any
}

/// An address and the bytes that are there.
type FreedBlock = (usize, usize);

/// Freed blocks.
struct FreedBlocks {
    blocks: [FreedBlock; MOST],
    count: usize,
    bytes: usize,
}

impl FreedBlocks {
    /// Takes the smallest block that serves a request.
    fn take(&mut self, size: usize) -> Option<FreedBlock> {
        let fits = |&(_, (_, bytes)): &(usize, &FreedBlock)| (size..=size.saturating_mul(SHARE)).contains(bytes);
        let (place, _) = self.blocks[..self.count].iter().enumerate().filter(fits).min_by_key(|(_, (_, b))| *b)?;
        Some(self.take_at(place))
    }

    fn take_largest(&mut self) -> Option<FreedBlock> {
        let (place, _) = self.blocks[..self.count].iter().enumerate().max_by_key(|(_, (_, bytes))| *bytes)?;
        Some(self.take_at(place))
    }

    fn take_at(&mut self, place: usize) -> FreedBlock {
        let block = self.blocks[place];
        self.count -= 1;
        self.blocks[place] = self.blocks[self.count];
        self.bytes -= block.1;
        block
    }

    /// Keeps a block if there is a place for it and `room` bytes may be kept.
    fn put(&mut self, block: FreedBlock, room: usize) -> bool {
        if self.count == MOST || self.bytes + block.1 > room {
            return false;
        }
        self.blocks[self.count] = block;
        self.count += 1;
        self.bytes += block.1;
        true
    }
}

/// Bytes that a block has, which may be more than were asked for.
#[cfg(all(target_os = "linux", target_env = "gnu"))]
fn bytes_at(address: usize) -> usize {
    #[expect(unsafe_code, reason = "only the system's allocator knows")]
    // SAFETY: the caller owns a block of the system's allocator at this address.
    unsafe {
        libc::malloc_usable_size(address as *mut libc::c_void)
    }
}

/// Not asked elsewhere, where nothing is kept.
#[cfg(not(all(target_os = "linux", target_env = "gnu")))]
fn bytes_at(_address: usize) -> usize {
    0
}

/// Gives a kept block back to the system.
fn give_back((address, bytes): FreedBlock) {
    #[expect(unsafe_code, reason = "an allocator can be written in no other way")]
    // SAFETY: the block came from the system's allocator with this alignment, and nothing else owns it; its size is not
    // used there.
    unsafe {
        System.dealloc(address as *mut u8, Layout::from_size_align_unchecked(bytes, ALIGNED));
    }
}

/// Counts `more` bytes in use in place of `less`, as far as blocks are large.
fn count(more: usize, less: usize) {
    if more >= LARGE {
        IN_USE.fetch_add(more, Ordering::Relaxed);
    }
    if less >= LARGE {
        IN_USE.fetch_sub(less, Ordering::Relaxed);
    }
}

/// Memory for a request, and whether it was kept; `take` asks the system for it, once more without what is kept where it
/// has none. While blocks are kept, large ones from the system are made of huge pages, which cost fewer page faults.
fn block_for(layout: Layout, take: impl Fn() -> *mut u8) -> (*mut u8, bool) {
    count(layout.size(), 0);
    let found = kept_or_new(layout, &take);
    if found.0.is_null() {
        if give_all_back() {
            let memory = take();
            if !memory.is_null() {
                return (memory, false);
            }
        }
        count(0, layout.size());
    }
    found
}

fn kept_or_new(layout: Layout, take: impl Fn() -> *mut u8) -> (*mut u8, bool) {
    let within = WITHIN.load(Ordering::Relaxed);
    if within == 0 || layout.size() < LARGE || layout.align() > ALIGNED {
        return (take(), false);
    }
    let mut kept = KEPT.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some((address, _)) = kept.take(layout.size()) {
        return (address as *mut u8, true);
    }
    // What is in use has been counted with the request.
    while IN_USE.load(Ordering::Relaxed).saturating_add(kept.bytes) > within
        && let Some(block) = kept.take_largest()
    {
        give_back(block);
    }
    drop(kept);
    let memory = take();
    if !memory.is_null() {
        advise_at(memory as usize, layout.size());
    }
    (memory, false)
}

/// Whether a freed block is kept.
fn is_kept(memory: *mut u8, layout: Layout) -> bool {
    let within = WITHIN.load(Ordering::Relaxed);
    if within == 0 || layout.size() < LARGE || layout.align() > ALIGNED {
        return false;
    }
    let block = (memory as usize, bytes_at(memory as usize));
    let room = within.saturating_sub(IN_USE.load(Ordering::Relaxed));
    KEPT.lock().unwrap_or_else(PoisonError::into_inner).put(block, room)
}

#[expect(unsafe_code, reason = "an allocator can be written in no other way")]
// SAFETY: every block is one of the system's allocator with at least the size and the alignment of the request: new, or kept
// since it was freed, when nothing else owned it.
unsafe impl GlobalAlloc for ProgramMemory {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        // SAFETY: the caller's promise is passed on.
        block_for(layout, || unsafe { System.alloc(layout) }).0
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        // SAFETY: the caller's promise is passed on.
        let (memory, was_kept) = block_for(layout, || unsafe { System.alloc_zeroed(layout) });
        if was_kept {
            // SAFETY: the block has at least this size, and is the request's alone.
            unsafe { memory.write_bytes(0, layout.size()) };
        }
        memory
    }

    unsafe fn realloc(&self, memory: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        // SAFETY: the caller's promise is passed on. A kept block has at least the size of the layout that it was given out
        // for, and the system's allocator knows what it has.
        let grown = unsafe { System.realloc(memory, layout, size) };
        if !grown.is_null() {
            count(size, layout.size());
        }
        grown
    }

    unsafe fn dealloc(&self, memory: *mut u8, layout: Layout) {
        count(0, layout.size());
        if !is_kept(memory, layout) {
            // SAFETY: the caller's promise is passed on.
            unsafe { System.dealloc(memory, layout) }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_smallest_block_that_serves_is_taken_and_no_more_is_kept_than_was_said() {
        let mut kept = FreedBlocks { blocks: [(0, 0); MOST], count: 0, bytes: 0 };
        assert!(kept.put((1, 300), 1000) && kept.put((2, 200), 1000) && kept.put((3, 500), 1000));
        assert!(!kept.put((4, 1), 1000));
        assert_eq!(kept.take(180), Some((2, 200)));
        // 300 is more than four times 70, and nothing has 600.
        assert_eq!((kept.take(70), kept.take(600)), (None, None));
        assert_eq!((kept.take(250), kept.bytes), (Some((1, 300)), 500));
        assert_eq!((kept.take_largest(), kept.take_largest(), kept.bytes), (Some((3, 500)), None, 0));
        assert!((0..MOST).all(|n| kept.put((n, 1), 1000)) && !kept.put((0, 1), 1000));
    }

    #[test]
    #[cfg(all(target_os = "linux", target_env = "gnu"))]
    fn freed_blocks_are_served_again_zeroed_where_that_is_asked_for() {
        let layout = |size| Layout::from_size_align(size, 8).unwrap();
        let count = || KEPT.lock().unwrap().count;
        let (large, larger) = (layout(6 << 20), layout(8 << 20));
        #[expect(unsafe_code, reason = "the interface of an allocator is not safe")]
        // SAFETY: every block is freed once, with its own layout, and written within it.
        unsafe {
            let memory = ProgramMemory.alloc(larger);
            memory.write_bytes(7, larger.size());
            ProgramMemory.dealloc(memory, larger);
            assert_eq!(count(), 0);
            let keeping = keep_freed(18 << 20);
            let memory = ProgramMemory.alloc(larger);
            memory.write_bytes(7, larger.size());
            ProgramMemory.dealloc(memory, larger);
            assert_eq!(count(), 1);
            let again = ProgramMemory.alloc_zeroed(large);
            assert_eq!((again, count()), (memory, 0));
            assert!((0..large.size()).all(|at| again.add(at).read() == 0));
            let grown = ProgramMemory.realloc(again, large, 10 << 20);
            ProgramMemory.dealloc(grown, layout(10 << 20));
            assert_eq!(count(), 1);
            // 10 MB are kept; 16 more would be too much.
            let other = ProgramMemory.alloc(layout(16 << 20));
            assert_eq!(count(), 0);
            ProgramMemory.dealloc(other, layout(16 << 20));
            // What the system does not have is not counted, and nothing is kept from who asks for it.
            ProgramMemory.dealloc(ProgramMemory.alloc(larger), larger);
            assert_eq!(count(), 1);
            assert!(ProgramMemory.alloc(layout(isize::MAX as usize - 7)).is_null());
            assert_eq!((count(), IN_USE.load(Ordering::Relaxed)), (0, 0));
            drop(keeping);
            assert_eq!((count(), IN_USE.load(Ordering::Relaxed)), (0, 0));
        }
    }
}
