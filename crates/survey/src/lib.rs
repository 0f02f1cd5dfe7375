//! Nouns and files of a seismic survey and its interpretation.
