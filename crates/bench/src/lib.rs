//! Any method on any scene at any precision, judged.
