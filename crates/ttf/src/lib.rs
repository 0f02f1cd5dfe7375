//! Texture transfer functions, colour maps and the pattern library.
