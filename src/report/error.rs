use super::FigureFormat;
use thiserror::Error;

/// Error for a table or a figure that could not be made.
#[derive(Debug, Error)]
pub enum ReportError {
    /// A histogram whose edges and counts do not belong together.
    #[error("a histogram of {counts} counts needs {} finite edges in rising order, found {edges} edges: pass edges and counts of the same histogram", .counts + 1)]
    Histogram {
        /// Number of edges of the histogram.
        edges: usize,
        /// Number of counts of the histogram.
        counts: usize,
    },
    /// A curve with unequal numbers of abscissae and values.
    #[error("the curve of {name} has {r} distances and {g} values: it needs one value per distance")]
    Curve {
        /// Name of the curve: that of a sampler, or “the mosaic”.
        name: String,
        /// Number of distances of the curve.
        r: usize,
        /// Number of values of the curve.
        g: usize,
    },
    /// A PNG that could not be encoded.
    #[error("could not encode a picture of {width} × {height} px as PNG: {source}")]
    Png {
        /// Width of the picture, px.
        width: u32,
        /// Height of the picture, px.
        height: u32,
        /// Error reported by the encoder.
        source: ::image::ImageError,
    },
    /// A figure that could not be turned into another format.
    #[error("could not write a figure as {format}: {reason}")]
    Convert {
        /// Format that was asked for.
        format: FigureFormat,
        /// The reason why it failed.
        reason: String,
    },
    /// Rows that could not be written as CSV.
    #[error("could not write CSV: {0}")]
    Csv(#[from] ::csv::Error),
}
