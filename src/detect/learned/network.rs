use super::convolution::Kernel;
use super::maps::{MARGIN, Maps, for_all};
use super::weights::{Weights, WeightsError};
use crate::image::{Plane, mirror};

/// Longest side of a piece that is looked at in one go; larger planes are cut so that all cores work and memory is bounded.
const PIECE: usize = 256;

/// A convolutional network from an even plane, in which cones are 8 px apart, to the logit of a cone's centre at every pixel.
#[derive(Debug)]
pub(super) enum Network {
    /// 7×7, then four residual 3×3 of dilation 2, 4, 2, 1, ten channels (4,151 weights).
    Residual {
        /// 7×7, 1→10.
        first: Kernel,
        /// The residual layers.
        layers: Box<[Kernel; 4]>,
        /// 1×1, 10→1.
        last: Kernel,
    },
    /// Two halvings and back, widths 12, 24, 32 (33,257 weights).
    UNet(Box<UNet>),
}

/// The layers in the order in which they work.
#[derive(Debug)]
pub(super) struct UNet {
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

const DILATIONS: [usize; 4] = [2, 4, 2, 1];

impl Network {
    /// # Errors
    /// If the architecture is unknown or a tensor is missing or of another shape.
    pub(super) fn new(weights: &Weights) -> Result<Self, WeightsError> {
        match weights.word("architecture")? {
            "residual" => {
                let layer = |name| weights.kernel(name, 10, 10, 3);
                Ok(Self::Residual {
                    first: weights.kernel("first", 10, 1, 7)?,
                    layers: Box::new([layer("a")?, layer("b")?, layer("c")?, layer("d")?]),
                    last: weights.kernel("last", 1, 10, 1)?,
                })
            }
            "unet" => Ok(Self::UNet(Box::new(UNet {
                first: weights.kernel("first", 12, 1, 5)?,
                top: weights.kernel("top", 12, 12, 3)?,
                down: weights.kernel("down", 24, 12, 3)?,
                middle: weights.kernel("middle", 24, 24, 3)?,
                deep: weights.kernel("deep", 32, 24, 3)?,
                bottom: weights.kernel("bottom", 32, 32, 3)?,
                rise: weights.kernel("rise", 24, 32, 1)?,
                join: weights.kernel("join", 24, 24, 3)?,
                lift: weights.kernel("lift", 12, 24, 1)?,
                merge: weights.kernel("merge", 12, 12, 3)?,
                last: weights.kernel("last", 1, 12, 1)?,
            }))),
            other => Err(WeightsError::Architecture(other.to_owned())),
        }
    }

    /// Sides must be multiples of this.
    fn unit(&self) -> usize {
        match self {
            Self::Residual { .. } => 1,
            Self::UNet(_) => 4,
        }
    }

    /// How far, in px, an input can act; a multiple of the unit.
    fn reach(&self) -> usize {
        match self {
            Self::Residual { .. } => 12,
            Self::UNet(_) => 24,
        }
    }

    /// The logit at every pixel of `seen`.
    pub(super) fn logits(&self, seen: &Plane) -> Plane {
        self.logits_by_pieces(seen, PIECE)
    }

    fn logits_by_pieces(&self, seen: &Plane, piece: usize) -> Plane {
        let (h, w) = seen.dim();
        let (height, width) = (h.next_multiple_of(self.unit()), w.next_multiple_of(self.unit()));
        let columns: Vec<usize> = (0..width).map(|x| mirror(x as isize, w)).collect();
        let rows = pieces(height, piece, self.reach());
        let across = pieces(width, piece, self.reach());
        let corners: Vec<_> = rows.iter().flat_map(|r| across.iter().map(move |c| (r, c))).collect();
        let parts = for_all(&corners, |(r, c)| {
            let mut maps = Maps::zeros(1, r.to - r.from, c.to - c.from);
            for y in r.from..r.to {
                let source = seen.row(mirror(y as isize, h));
                let row = maps.row_mut(0, y - r.from);
                row.iter_mut().zip(&columns[c.from..c.to]).for_each(|(v, &x)| *v = source[x]);
            }
            self.apply(&maps)
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

    fn apply(&self, seen: &Maps) -> Maps {
        match self {
            Self::Residual { first, layers, last } => {
                let mut maps = seen.layer(first, 1);
                for (layer, dilation) in layers.iter().zip(DILATIONS) {
                    maps = maps.residual(layer, dilation);
                }
                maps.convolved(last, 1)
            }
            Self::UNet(net) => {
                let layer = |maps: &Maps, kernel: &Kernel| maps.layer(kernel, 1);
                let top = layer(&layer(seen, &net.first), &net.top);
                let middle = layer(&layer(&top.halved(), &net.down), &net.middle);
                let bottom = layer(&layer(&middle.halved(), &net.deep), &net.bottom);
                let risen = bottom.convolved(&net.rise, 1).doubled_onto(&middle);
                let joined = layer(&risen, &net.join);
                let lifted = joined.convolved(&net.lift, 1).doubled_onto(&top);
                layer(&lifted, &net.merge).convolved(&net.last, 1)
            }
        }
    }
}

// the widest kernel and the largest dilation stay inside the zeros
const _: () = assert!(MARGIN >= 7 / 2 && MARGIN >= DILATIONS[1]);

/// A stretch `first..end` of a side that is answered for, and the stretch `from..to` that has to be looked at.
struct Piece {
    first: usize,
    end: usize,
    from: usize,
    to: usize,
}

/// Cuts a side into equal pieces of at most `longest`, all cuts multiples of 4.
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
    use super::super::{CONFOCAL, SPLIT};
    use super::*;

    #[test]
    fn pieces_make_no_seams() {
        let seen = Plane::from_shape_fn((93, 121), |(y, x)| {
            (0.7 * x as f32).sin() * (0.6 * y as f32).cos() + ((x * 31 + y * 17) % 13) as f32 / 13.
        });
        for file in [CONFOCAL, SPLIT] {
            let network = Network::new(&Weights::read(file).unwrap()).unwrap();
            let whole = network.logits_by_pieces(&seen, 200);
            let cut = network.logits_by_pieces(&seen, 40);
            let difference = whole.iter().zip(&cut).map(|(a, b)| (a - b).abs()).fold(0., f32::max);
            assert!(difference < 1e-4, "{difference}");
        }
    }
}
