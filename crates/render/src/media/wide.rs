//! Short loops over many numbers, compiled for wide registers too.
//!
//! The compiler turns such loops into instructions on four numbers at a time, which every target processor
//! has, or on eight (AVX2), which most have. The results are the same to the last bit, since no products are
//! fused. Measured on 256³ samples: the wide form saves 10–15 % of the time of rays.

/// Work that consists of such loops.
pub trait Loops {
    /// The result.
    type Output;

    /// Does the work. Implementations are `#[inline(always)]`, since the work is compiled once for each kind
    /// of processor.
    fn run(self) -> Self::Output;
}

/// Does the work in the widest form that this processor supports.
pub fn widest<W: Loops>(work: W) -> W::Output {
    #[cfg(target_arch = "x86_64")]
    if is_x86_feature_detected!("avx2") {
        #[expect(unsafe_code, reason = "the processor supports AVX2, as the condition has just confirmed")]
        return unsafe { by_eight(work) };
    }
    work.run()
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn by_eight<W: Loops>(work: W) -> W::Output {
    work.run()
}
