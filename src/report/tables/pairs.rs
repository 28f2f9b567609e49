use super::{Row, Table, column};

/// Two images of the same field by two channels.
#[derive(Clone, Debug)]
pub struct ChannelPair {
    /// Name of the pair.
    pub name: String,
    /// Names of the two images; the second is the split-detector one if one is.
    pub images: [String; 2],
    /// Names of the modalities of the two images.
    pub modalities: [String; 2],
    /// Shift in px, to the right and down, that brings the first image onto the second.
    pub shift: [f64; 2],
    /// Greatest distance in px of the two cones of a pair.
    pub limit_px: f64,
    /// Number of cones in both images.
    pub both: usize,
    /// Numbers of cones in the first and in the second image alone.
    pub alone: [usize; 2],
    /// Shares, between 0 and 1, of the first and the second image's cones that the other has too.
    pub shares: [f64; 2],
    /// Harmonic mean of the two shares.
    pub f1: f64,
    /// Warnings that a reader of these numbers needs.
    pub warnings: Vec<String>,
}

impl Row for ChannelPair {
    type Of<'a> = &'a Self;
}

/// The table of pairs of images of the same field.
pub static PAIRS: Table<ChannelPair> = Table {
    file: "pairs.csv",
    commands: "run --pair",
    about: "One row per pair: the same field by two channels (Cooper et al. 2024). Cones nearer to the \
            edge than one median nearest-neighbour distance of image_2 are not counted.",
    columns: &[
        column("name", "text", "Name of the pair.").of(|p| p.name.as_str().into()),
        column("image_1", "text", "Name of the first image.").of(|p| p.images[0].as_str().into()),
        column("image_2", "text", "Name of the second image, the split-detector one if one is.")
            .of(|p| p.images[1].as_str().into()),
        column("modality_1", "text", "Modality of image_1.").of(|p| p.modalities[0].as_str().into()),
        column("modality_2", "text", "Modality of image_2.").of(|p| p.modalities[1].as_str().into()),
        column("shift_x_px", "px", "Shift that brings image_1 onto image_2, to the right (at most ±8).")
            .of(|p| p.shift[0].into()),
        column("shift_y_px", "px", "Shift that brings image_1 onto image_2, down (at most ±8).")
            .of(|p| p.shift[1].into()),
        column(
            "limit_px",
            "px",
            "Greatest distance of the two cones of a pair: 0.4 of the median nearest-neighbour distance in \
             image_2.",
        )
        .of(|p| p.limit_px.into()),
        column("both", "count", "Number of cones that both images have.").of(|p| p.both.into()),
        column("alone_1", "count", "Number of cones in image_1 alone.").of(|p| p.alone[0].into()),
        column("alone_2", "count", "Number of cones in image_2 alone.").of(|p| p.alone[1].into()),
        column(
            "share_1",
            "0–1",
            "Share of image_1's cones that image_2 has too. Rods taken for cones lower it.",
        )
        .of(|p| p.shares[0].into()),
        column("share_2", "0–1", "Share of image_2's cones that image_1 has too.").of(|p| p.shares[1].into()),
        column("f1", "0–1", "Agreement: harmonic mean of share_1 and share_2.").of(|p| p.f1.into()),
        column("warnings", "text", "What must be known about these numbers.")
            .of(|p| p.warnings.join("; ").as_str().into()),
    ],
};

/// Cone of a pair of images.
#[derive(Clone, Debug)]
pub struct PairedCone {
    /// Column of the centre in image 2, px.
    pub x: f64,
    /// Row of the centre in image 2, px.
    pub y: f64,
    /// The word “both”, or the modality of the only image that has the cone.
    pub seen_in: String,
    /// `true` if the cone lies far enough from the edge to be counted.
    pub counted: bool,
}

impl Row for PairedCone {
    type Of<'a> = &'a Self;
}

/// The table of the cones of a pair of images.
pub static PAIRED_CONES: Table<PairedCone> = Table {
    file: "NAME.csv",
    commands: "run --pair (pairs/NAME.csv)",
    about: "One row per cone of a pair of images.",
    columns: &[
        column("x_px", "px", "Position in image_2, to the right; cones of image_1 alone are shifted there.")
            .of(|c| c.x.into()),
        column("y_px", "px", "Position in image_2, down.").of(|c| c.y.into()),
        column("seen_in", "text", "both, or the modality of the only image that has the cone.")
            .of(|c| c.seen_in.as_str().into()),
        column("counted", "0/1", "1 if the cone is counted in pairs.csv, 0 near the edge.")
            .of(|c| usize::from(c.counted).into()),
    ],
};
