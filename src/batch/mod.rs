//! Folders of images: walking, pairing, isolating failures.
