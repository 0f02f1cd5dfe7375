//! Rendering of illustrated and raw seismic blocks with wgpu and a CPU reference.
