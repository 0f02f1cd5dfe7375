//! Rock on pages: paths beside pictures, what the written SVG measures, and rock on sections.

mod fold;
mod maps;
mod measures;
mod sections;
mod vectors;
