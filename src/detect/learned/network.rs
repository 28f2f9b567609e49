//! A U-Net (Ronneberger et al. 2015, <https://doi.org/10.1007/978-3-319-24574-4_28>) that finds
//! cones.
//!
//! 1. The plane is cut into pieces, each of which also gets the surrounding pixels that can affect
//!    its result.
//! 2. Each piece goes through the network. There the resolution is halved twice and then restored.
//!    If the file of weights asks for it, mirror images of the piece go through the network as
//!    well, and the results are averaged.
//! 3. The logits of the pieces are joined without a seam.

use super::convolution::Kernel;
use super::maps::{Maps, for_all};
use super::weights::{Weights, WeightsError};
use crate::image::{Plane, mirror};

/// Longest side, in px, of a piece that goes through the network in one go.
///
/// Larger planes are cut into pieces so that all cores work and memory is bounded.
const PIECE: usize = 256;

/// A network that takes a normalised plane in which cones are 8 px apart, and gives, for every
/// pixel, the logit of being a cone's centre.
#[derive(Debug)]
pub(super) struct Network {
    unet: Unet,
    views: Views,
}

/// A U-Net that halves the resolution twice and then restores it.
///
/// - `first` and `top` work at full resolution, `down` and `middle` at half of it, `deep` and
///   `bottom` at a quarter.
/// - `rise` and `join` lead back to half the resolution, `lift` and `merge` to full resolution.
/// - `last` gives the logit.
///
/// The numbers of channels are those of the tensors in the file of weights.
#[derive(Debug)]
struct Unet {
    first: Kernel,
    top: Kernel,
    down: Kernel,
    middle: Kernel,
    deep: Kernel,
    bottom: Kernel,
    rise: Kernel,
    join: Kernel,
    lift: Kernel,
    merge: Kernel,
    last: Kernel,
}

/// Views of an image (the image itself and its mirror images) whose logits are averaged.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Views {
    /// A single view: the image as it is.
    One,
    /// Four views: the image, and its mirror images along x, along y and along both.
    ///
    /// The two views mirrored along x are multiplied by `sign`. For split-detector images `sign` is
    /// −1, because mirroring such an image along x swaps the dark and the bright side of its cones.
    /// Otherwise it is 1.
    Mirrored { sign: f32 },
}

/// Unit, in px, of which the sides of a piece are multiples, because they are halved twice.
const UNIT: usize = 4;
/// Distance, in px, up to which a pixel of the input can affect the output, rounded up to a
/// multiple of [`UNIT`].
const REACH: usize = 24;

impl Network {
    /// Builds the network from a file of weights.
    ///
    /// # Errors
    /// Fails if the architecture is unknown, or if a tensor is missing or of another shape.
    pub(super) fn new(weights: &Weights) -> Result<Self, WeightsError> {
        match weights.word("architecture")? {
            "unet" => {}
            other => return Err(WeightsError::Architecture(other.to_owned())),
        }
        let views = match weights.word("flips")? {
            "none" => Views::One,
            "even" => Views::Mirrored { sign: 1. },
            "odd" => Views::Mirrored { sign: -1. },
            _ => return Err(WeightsError::Metadata("flips".to_owned())),
        };
        Ok(Self { unet: Unet::new(weights)?, views })
    }

    /// Returns the logit at every pixel of `seen`.
    pub(super) fn logits(&self, seen: &Plane) -> Plane {
        self.logits_by_pieces(seen, PIECE)
    }

    /// Returns the logits, computed in pieces whose sides are at most about `piece` px.
    ///
    /// Beyond the right and lower border, the plane continues as its mirror image to a multiple of
    /// [`UNIT`].
    fn logits_by_pieces(&self, seen: &Plane, piece: usize) -> Plane {
        let (h, w) = seen.dim();
        let (height, width) = (h.next_multiple_of(UNIT), w.next_multiple_of(UNIT));
        let columns: Vec<usize> = (0..width).map(|x| mirror(x as isize, w)).collect();
        let rows = pieces(height, piece, REACH);
        let across = pieces(width, piece, REACH);
        let corners: Vec<_> = rows.iter().flat_map(|r| across.iter().map(move |c| (r, c))).collect();
        let parts = for_all(&corners, |(r, c)| {
            let mut maps = Maps::zeros(1, r.to - r.from, c.to - c.from);
            for y in r.from..r.to {
                let source = seen.row(mirror(y as isize, h));
                let row = maps.row_mut(0, y - r.from);
                row.iter_mut().zip(&columns[c.from..c.to]).for_each(|(v, &x)| *v = source[x]);
            }
            self.viewed(maps)
        });
        let mut out = Plane::zeros((h, w));
        for ((r, c), part) in corners.iter().zip(&parts) {
            for y in r.first..r.end.min(h) {
                let row = &part.row(0, y - r.from)[c.first - c.from..];
                for (x, v) in (c.first..c.end.min(w)).zip(row) {
                    out[[y, x]] = *v;
                }
            }
        }
        out
    }

    /// Returns the mean of the logits over the views of a piece.
    fn viewed(&self, seen: Maps) -> Maps {
        let Views::Mirrored { sign } = self.views else { return self.unet.apply(&seen) };
        let mut sum = self.unet.apply(&seen);
        let mut view = seen;
        // mirroring along y, x and y in turn gives every view once, the piece itself first; the sum
        // of the logits is mirrored with the view each time, and once more along x at the end,
        // which brings it back
        for (along_x, factor) in [(false, 1.), (true, sign), (false, 1.)] {
            view = mirrored(&view, along_x, factor, None);
            sum = mirrored(&sum, along_x, 1., Some(&self.unet.apply(&view)));
        }
        mirrored(&sum, true, 0.25, None)
    }
}

impl Unet {
    fn new(weights: &Weights) -> Result<Self, WeightsError> {
        let [full, half, quarter] =
            [weights.outputs("first")?, weights.outputs("down")?, weights.outputs("deep")?];
        let kernel = |name, outputs, inputs, side| weights.kernel(name, outputs, inputs, side);
        Ok(Self {
            first: kernel("first", full, 1, 5)?,
            top: kernel("top", full, full, 3)?,
            down: kernel("down", half, full, 3)?,
            middle: kernel("middle", half, half, 3)?,
            deep: kernel("deep", quarter, half, 3)?,
            bottom: kernel("bottom", quarter, quarter, 3)?,
            rise: kernel("rise", half, quarter, 1)?,
            join: kernel("join", half, half, 3)?,
            lift: kernel("lift", full, half, 1)?,
            merge: kernel("merge", full, full, 3)?,
            last: kernel("last", 1, full, 1)?,
        })
    }

    /// Returns the logits of one view of a piece.
    fn apply(&self, seen: &Maps) -> Maps {
        let layer = Maps::layer;
        let top = layer(&layer(seen, &self.first), &self.top);
        let middle = layer(&layer(&top.halved(), &self.down), &self.middle);
        let bottom = layer(&layer(&middle.halved(), &self.deep), &self.bottom);
        let risen = bottom.convolved(&self.rise).doubled_onto(&middle);
        let joined = layer(&risen, &self.join);
        let lifted = joined.convolved(&self.lift).doubled_onto(&top);
        layer(&lifted, &self.merge).convolved(&self.last)
    }
}

/// Returns a single map, mirrored along x if `along_x` and otherwise along y, multiplied by
/// `factor`, with `others` added.
fn mirrored(maps: &Maps, along_x: bool, factor: f32, others: Option<&Maps>) -> Maps {
    let mut out = Maps::framed(1, maps.height, maps.width);
    for y in 0..maps.height {
        let source = maps.row(0, if along_x { y } else { maps.height - 1 - y });
        let row = out.row_mut(0, y);
        row.copy_from_slice(source);
        if along_x {
            row.reverse();
        }
        row.iter_mut().for_each(|v| *v *= factor);
        if let Some(others) = others {
            row.iter_mut().zip(others.row(0, y)).for_each(|(v, o)| *v += o);
        }
    }
    out
}

/// A stretch `first..end` of a side whose logits are used, and the wider stretch `from..to` that
/// goes through the network.
struct Piece {
    first: usize,
    end: usize,
    from: usize,
    to: usize,
}

/// Cuts a side of `length` px into equal pieces of at most about `longest` px, with all cuts at
/// multiples of [`UNIT`].
///
/// The stretch that goes through the network extends up to `reach` px beyond either end of a piece.
fn pieces(length: usize, longest: usize, reach: usize) -> Vec<Piece> {
    let count = length.div_ceil(longest).max(1);
    let step = length.div_ceil(count).next_multiple_of(4);
    (0..length)
        .step_by(step.max(1))
        .map(|first| {
            let end = (first + step).min(length);
            Piece { first, end, from: first.saturating_sub(reach), to: (end + reach).min(length) }
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::detect::spec::SPECS;

    #[test]
    fn pieces_make_no_seams() {
        let seen = Plane::from_shape_fn((93, 121), |(y, x)| {
            (0.7 * x as f32).sin() * (0.6 * y as f32).cos() + ((x * 31 + y * 17) % 13) as f32 / 13.
        });
        for file in SPECS.iter().map(|spec| spec.network.weights()) {
            let network = Network::new(&Weights::read(file).unwrap()).unwrap();
            let whole = network.logits_by_pieces(&seen, 200);
            let cut = network.logits_by_pieces(&seen, 40);
            let difference = whole.iter().zip(&cut).map(|(a, b)| (a - b).abs()).fold(0., f32::max);
            assert!(difference < 1e-4, "{difference}");
        }
    }
}
