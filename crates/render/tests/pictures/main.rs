//! Pictures drawn by both renderers: closed forms on the CPU, and the GPU beside it.

mod block;
mod closed_form;
mod compare;
mod gpu;
mod gpu_media;
mod gpu_shapes;
mod ground;
mod kept;
mod media;
mod scene;
mod surfaces;
mod vector;
