//! The contract: rays, hits, scenes, methods; the catalogue of surfaces.
