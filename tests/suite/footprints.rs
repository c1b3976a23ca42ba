//! Lookups over footprints: the device against the oracle for every filter, mip mode, kind of
//! texture and address mode; the level that is read; and the footprints themselves against exact
//! ones of pixels.

mod alpha;
pub mod bench;
mod chance;
mod exact;
mod extremes;
mod levels;
mod lookups;
mod seams;
