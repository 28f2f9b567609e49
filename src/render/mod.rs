//! A mosaic becomes a simulated retinal image with known truth.
