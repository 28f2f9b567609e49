//! A mosaic against samplers; detections against reference marks.
