//! Petroglyph.
