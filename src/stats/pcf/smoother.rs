//! Kernel smoothing of pair distances, in time linear in the number of pairs.
//!
//! 1. With the Gaussian, spread each distance over the four nearest nodes of a fine grid by cubic
//!    interpolation.
//! 2. Convolve the grid with the kernel, evaluated at the left edges of the bins only.
//!
//! The box and triangle kernels are narrower. With them, each distance is added directly to all
//! bins that the kernel covers.

use super::PcfOptions;
use crate::choice::UnknownChoice;
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;
use strum::{Display, EnumString, VariantArray, VariantNames};

/// Shape of the kernel that smooths pair distances.
///
/// All kernels have integral 1 and the same standard deviation, the bandwidth.
#[derive(
    Clone,
    Copy,
    Debug,
    Default,
    PartialEq,
    Eq,
    Serialize,
    Deserialize,
    Display,
    EnumString,
    VariantArray,
    VariantNames,
)]
#[serde(rename_all = "snake_case")]
#[strum(
    serialize_all = "kebab-case",
    parse_err_ty = UnknownChoice,
    parse_err_fn = UnknownChoice::among::<Kernel>
)]
pub enum Kernel {
    /// Gaussian exp(−t²/2σ²), cut off at 6.5 σ, where it has fallen to 7 · 10⁻¹⁰ of its peak. The
    /// numbers of Lanaro et al. (2020) were made with a Gaussian.
    #[default]
    Gaussian,
    /// Constant within √3 σ, 0 beyond.
    Box,
    /// Linear decrease from the middle to 0 at √6 σ.
    Triangle,
}

impl Kernel {
    /// Returns the half-width of the kernel in bandwidths; beyond it the kernel is 0.
    pub(in crate::stats) fn reach(self) -> f64 {
        match self {
            Self::Gaussian => 6.5,
            Self::Box => 3f64.sqrt(),
            Self::Triangle => 6f64.sqrt(),
        }
    }

    /// Returns the kernel at `t` bandwidths from its middle, for bandwidth 1.
    fn at(self, t: f64) -> f64 {
        let reach = self.reach();
        if t.abs() > reach {
            return 0.;
        }
        match self {
            Self::Gaussian => (-0.5 * t * t).exp() / TAU.sqrt(),
            Self::Box => 0.5 / reach,
            Self::Triangle => (reach - t.abs()) / (reach * reach),
        }
    }
}

/// Running sums of weight · k(r − d) over pairs at distances d, where k is the kernel: one sum per
/// bin with left edge r.
///
/// Lengths are in the unit of the coordinates.
pub(in crate::stats) struct Smoother {
    /// Kernel with which distances are smoothed.
    kernel: Kernel,
    /// Number of bins with a sum.
    bins: usize,
    /// Left edge of the first bin.
    first: f64,
    /// Distance between the left edges of bins.
    bin_width: f64,
    /// Standard deviation of the kernel.
    bandwidth: f64,
    /// Weights of the pairs, spread over the nodes of a fine grid (Gaussian), or the sums per bin
    /// (other kernels).
    ///
    /// With the Gaussian there are `per_bin` nodes per bin, and node 0 is `lead` nodes before the
    /// first bin.
    nodes: Vec<f64>,
    /// Number of nodes of the fine grid per bin; 1 for kernels other than the Gaussian.
    per_bin: usize,
    /// Number of nodes of the fine grid before the first bin; 0 for kernels other than the
    /// Gaussian.
    lead: usize,
}

impl Smoother {
    /// Prepares empty sums for the bins of `options`; `spacing` is the hexagonal spacing, in units
    /// of the coordinates.
    pub(in crate::stats) fn new(options: &PcfOptions, spacing: f64) -> Self {
        let bin_width = options.bin_width() * spacing;
        let bandwidth = options.bandwidth * spacing;
        let mut smoother = Self {
            kernel: options.kernel,
            bins: options.bins,
            first: options.r_min * spacing,
            bin_width,
            bandwidth,
            nodes: Vec::new(),
            per_bin: 1,
            lead: 0,
        };
        if options.kernel == Kernel::Gaussian {
            // The error of cubic interpolation is .07 (node distance/σ)⁴ times the kernel's peak:
            // 2·10⁻⁷ at a node distance of σ/24, less in a sum over pairs.
            smoother.per_bin = (24. * bin_width / bandwidth).ceil().max(1.) as usize;
            // Interpolation needs two more nodes at either end.
            smoother.lead = smoother.half_width() + 2;
            smoother.nodes = vec![0.; (options.bins - 1) * smoother.per_bin + 2 * smoother.lead + 1];
        } else {
            smoother.nodes = vec![0.; options.bins];
        }
        smoother
    }

    /// Returns the number of nodes that the Gaussian around a bin covers on either side.
    fn half_width(&self) -> usize {
        (self.kernel.reach() * self.bandwidth * self.per_bin as f64 / self.bin_width).ceil() as usize
    }

    /// Adds a pair at distance `d` with the weight `weight`.
    #[inline]
    pub(in crate::stats) fn add(&mut self, d: f64, weight: f64) {
        match self.kernel {
            Kernel::Gaussian => {
                let at = (d - self.first) * (self.per_bin as f64 / self.bin_width) + self.lead as f64;
                if at < 1. {
                    return;
                }
                let node = at as usize;
                let t = at - node as f64;
                if let Some([a, b, c, e]) = self.nodes.get_mut(node - 1..node + 3) {
                    // Lagrange's weights of cubic interpolation, for nodes at −1, 0, 1 and 2 and a
                    // distance at `t`.
                    *a += weight * (t * (t - 1.) * (2. - t) / 6.);
                    *b += weight * ((t + 1.) * (t - 1.) * (t - 2.) / 2.);
                    *c += weight * ((t + 1.) * t * (2. - t) / 2.);
                    *e += weight * ((t + 1.) * t * (t - 1.) / 6.);
                }
            }
            Kernel::Box | Kernel::Triangle => {
                let reach = self.kernel.reach() * self.bandwidth;
                let low = ((d - reach - self.first) / self.bin_width).ceil().max(0.) as usize;
                let high = ((d + reach - self.first) / self.bin_width).floor();
                if high < 0. {
                    return;
                }
                let high = (high as usize).min(self.bins - 1);
                for bin in low..=high {
                    let t = (self.first + bin as f64 * self.bin_width - d) / self.bandwidth;
                    self.nodes[bin] += weight * self.kernel.at(t) / self.bandwidth;
                }
            }
        }
    }

    /// Returns the sums, smoothed with the kernel, one per bin.
    pub(in crate::stats) fn sums(self) -> Vec<f64> {
        if self.kernel != Kernel::Gaussian {
            return self.nodes;
        }
        let half = self.half_width();
        let step = self.bin_width / self.per_bin as f64 / self.bandwidth;
        let kernel: Vec<f64> = (0..=2 * half)
            .map(|i| self.kernel.at((i as f64 - half as f64) * step) / self.bandwidth)
            .collect();
        (0..self.bins)
            .map(|bin| {
                let first = self.lead + bin * self.per_bin - half;
                dot(&self.nodes[first..first + kernel.len()], &kernel)
            })
            .collect()
    }
}

/// Computes an inner product as four independent sums, whose additions the processor can overlap.
fn dot(a: &[f64], b: &[f64]) -> f64 {
    let mut sums = [0.; 4];
    let (a4, b4) = (a.chunks_exact(4), b.chunks_exact(4));
    let rest: f64 = a4.remainder().iter().zip(b4.remainder()).map(|(x, y)| x * y).sum();
    for (x, y) in a4.zip(b4) {
        for lane in 0..4 {
            sums[lane] += x[lane] * y[lane];
        }
    }
    sums.iter().sum::<f64>() + rest
}
