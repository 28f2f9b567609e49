use super::{FourierEstimate, FourierSpacing, Polar, RingFit, Sector, profiles, starts};
use crate::detect::spacing::SpacingMap;
use crate::detect::{DetectError, MIN_SIDE, check};
use crate::geometry::Point;
use crate::image::{EmptyPixels, Plane};
use std::f64::consts::TAU;

/// Number of tiles that begin within the side of one tile: tiles overlap by three quarters.
const PER_SIDE: usize = 4;
/// Largest factor by which the spacing of a tile may differ from that of the entire image; rings
/// beyond are ignored.
const LOCAL: f64 = 2.;

/// Options of a map of the modal spacing, see [`fourier_map`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FourierMapOptions {
    /// Side of a tile, in spacings of the entire image: 6–60, default 12.
    ///
    /// A tile of 12 spacings contains some 160 cones. The Hann window reduces their total weight in
    /// the spectrum to that of a seventh of them.
    pub side: f64,
    /// Directions of the waves from which the spacing is measured.
    pub sector: Sector,
}

impl Default for FourierMapOptions {
    fn default() -> Self {
        Self { side: 12., sector: Sector::All }
    }
}

impl FourierMapOptions {
    /// Checks that `side` is between 6 and 60 spacings.
    ///
    /// # Errors
    /// Fails if `side` is outside 6–60.
    pub fn validate(&self) -> Result<(), DetectError> {
        if (6. ..=60.).contains(&self.side) { Ok(()) } else { Err(DetectError::TileSide(self.side)) }
    }
}

/// Map of the modal spacing of an image, as [`fourier_map`] finds it.
#[derive(Clone, Debug, PartialEq)]
pub struct FourierMap {
    /// Side of the tiles in px.
    pub side: usize,
    /// Positions x of the middles of the tiles in px, in rising order.
    pub x: Vec<f64>,
    /// Positions y of the middles of the tiles in px, in rising order.
    pub y: Vec<f64>,
    /// Spacing that each tile shows by itself, row by row, or `None` if a tile has no ring or too
    /// little of it was imaged.
    pub tiles: Vec<Option<FourierSpacing>>,
    /// Hexagonal spacing in px as a function of position: the distance between neighbouring cones
    /// in a triangular lattice.
    ///
    /// At the middle of a tile, the logarithm of the spacing is the mean over the tiles around. A
    /// tile is weighted by the square of its confidence and by a Hann window that falls to 0 at a
    /// distance of one tile side along x and along y.
    pub spacing: SpacingMap,
    /// Mean confidence, 0–1, of the tiles around the middle of each tile, row by row.
    ///
    /// The tiles are weighted by a Hann window that falls to 0 at a distance of one tile side along
    /// x and along y. Tiles without a ring count as 0.
    pub confidence: Vec<f64>,
}

/// Maps the modal spacing of an image, from tiles that overlap by three quarters.
///
/// A tile has a side of twelve spacings ([`FourierMapOptions::side`]), but at least 24 px and at
/// most the shorter side of the image. `whole` is the result of
/// [`fourier_spacing`](super::fourier_spacing) for the image. Only spacings within a factor of two
/// of the modal spacing in `whole` are found. Where cones are much farther apart than on average, a
/// tile contains too few of them: beyond a factor of two, the map is not to be trusted.
///
/// At a spacing of 9 px, 1024 × 1024 px take .75 s on two cores, 4096 × 4096 px 17 s.
///
/// # Errors
/// Fails if `options` are out of range, if the image is too small, if its pixels are all the same
/// or one is not a finite number, or if the entire image has no ring.
pub fn fourier_map(
    image: &Plane,
    whole: &FourierEstimate,
    options: &FourierMapOptions,
) -> Result<FourierMap, DetectError> {
    options.validate()?;
    check(image)?;
    let (height, width) = image.dim();
    let empty = EmptyPixels::of(image);
    let filled = empty.as_ref().map(|e| e.filled(image));
    let image = filled.as_ref().unwrap_or(image);
    let whole = match options.sector {
        Sector::All => whole.all,
        Sector::Row => whole.row,
        Sector::Cell => whole.cell,
    };
    let typical = whole.ok_or(DetectError::NoRing)?.spacing;
    let side = ((options.side * typical).round() as usize).max(MIN_SIDE).min(height).min(width);
    let (columns, rows) = (starts(width, side, PER_SIDE), starts(height, side, PER_SIDE));
    let polar = Polar::new(side);
    let fit = RingFit::new(side, polar.size);
    let (near, sector) = (typical / LOCAL..=typical * LOCAL, options.sector);
    let tiles: Vec<Option<FourierSpacing>> = profiles(image, &polar, empty.as_ref(), &columns, &rows)
        .iter()
        .map(|p| p.as_ref().and_then(|p| fit.ring(&p[sector as usize], sector.part(), near.clone())))
        .collect();

    let middles = |starts: &[usize]| -> Vec<f64> {
        starts.iter().map(|s| *s as f64 + 0.5 * side as f64 - 0.5).collect()
    };
    let (x, y) = (middles(&columns), middles(&rows));
    // weight of a tile whose middle is `d` px away along one axis
    let hann =
        |d: f64| if d.abs() < side as f64 { 0.5 + 0.5 * (TAU / 2. * d / side as f64).cos() } else { 0. };
    // indices and weights of the tiles whose middles are less than a tile side from `at`
    let near_ones = |nodes: &[f64], at: f64| -> Vec<(usize, f64)> {
        let weights = nodes.iter().map(|v| hann(v - at)).enumerate();
        weights.filter(|(_, w)| *w > 0.).collect()
    };
    let mut spacing = Vec::with_capacity(tiles.len());
    let mut confidence = Vec::with_capacity(tiles.len());
    for &v in &y {
        let down = near_ones(&y, v);
        for &u in &x {
            // weighted sums: of the logarithms of spacings, of squared confidences, of confidences,
            // and of the weights alone
            let (mut logs, mut trusted, mut sure, mut total) = (0., 0., 0., 0.);
            for (i, across) in near_ones(&x, u) {
                for &(j, weight) in &down {
                    let weight = weight * across;
                    total += weight;
                    if let Some(ring) = &tiles[j * x.len() + i] {
                        let squared = weight * ring.confidence * ring.confidence;
                        logs += squared * ring.spacing.ln();
                        trusted += squared;
                        sure += weight * ring.confidence;
                    }
                }
            }
            spacing.push((trusted > 0.).then(|| (logs / trusted).exp()));
            confidence.push(sure / total);
        }
    }
    let spacing = SpacingMap::on_grid(x.clone(), y.clone(), &spacing, typical);
    Ok(FourierMap { side, x, y, tiles, spacing, confidence })
}

impl FourierMap {
    /// Returns the confidence, 0–1, at the middle of the nearest tile.
    pub fn confidence_at(&self, p: Point) -> f64 {
        let nearest = |nodes: &[f64], v: f64| {
            let after = nodes.partition_point(|n| *n < v).min(nodes.len().saturating_sub(1));
            let before = after.saturating_sub(1);
            let off = |k: usize| nodes.get(k).map_or(f64::INFINITY, |n| (n - v).abs());
            if off(before) <= off(after) { before } else { after }
        };
        let (i, j) = (nearest(&self.x, p.x), nearest(&self.y, p.y));
        self.confidence.get(j * self.x.len() + i).copied().unwrap_or(0.)
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::picture;
    use super::*;
    use crate::detect::fourier_spacing;
    use crate::render::MosaicOptions;

    fn mapped(image: &Plane, options: &FourierMapOptions) -> Result<FourierMap, DetectError> {
        fourier_map(image, &fourier_spacing(image)?, options)
    }

    #[test]
    fn a_gradient_of_spacing_is_followed() {
        // density 4:1 from left to right: the spacing doubles
        let mosaic = MosaicOptions { spacing: 8., gradient: 4., ..MosaicOptions::default() };
        let map = mapped(&picture(&mosaic, 500, 300), &FourierMapOptions::default()).unwrap();
        let at = |x: f64| map.spacing.at(Point::new(x, 150.));
        println!("{} {:?}", map.side, [50., 150., 250., 350., 450.].map(at));
        let (left, right) = (at(60.), at(440.));
        // between the middles of the outermost tiles, 380 of 500 px apart, 2^.76 = 1.69
        assert!((right / left / 1.69 - 1.).abs() < 0.15, "{left} {right}");
        assert!(map.confidence_at(Point::new(250., 150.)) > 0.3);
    }

    #[test]
    fn an_even_mosaic_has_an_even_map() {
        let map = mapped(&picture(&MosaicOptions::default(), 300, 200), &FourierMapOptions::default());
        let map = map.unwrap();
        let (low, high) = map.spacing.range();
        println!("{} {low} {high}", map.side);
        assert!(high / low < 1.12, "{low} {high}");
        assert_eq!(map.tiles.len(), map.x.len() * map.y.len());
        assert_eq!(map.confidence.len(), map.tiles.len());
        assert!(map.confidence.iter().all(|c| (0. ..=1.).contains(c)));
    }

    #[test]
    fn where_nothing_was_imaged_there_is_no_tile() {
        let image = picture(&MosaicOptions::default(), 150, 150).mapv(|v| v.max(0.01));
        let mut framed = Plane::zeros((200, 420));
        image.indexed_iter().for_each(|((y, x), v)| framed[[y + 20, x + 20]] = *v);
        let map = mapped(&framed, &FourierMapOptions::default()).unwrap();
        assert!(map.tiles[map.x.len() - 1].is_none() && map.tiles.iter().any(Option::is_some));
        assert!(map.confidence_at(Point::new(410., 100.)) < map.confidence_at(Point::new(90., 90.)));
        let bad = FourierMapOptions { side: f64::NAN, ..FourierMapOptions::default() };
        assert!(matches!(mapped(&framed, &bad), Err(DetectError::TileSide(_))));
        assert!(matches!(
            mapped(&Plane::zeros((50, 50)), &FourierMapOptions::default()),
            Err(DetectError::Constant { .. })
        ));
    }

    #[test]
    fn threads_make_no_difference() {
        let image = picture(&MosaicOptions::default(), 180, 150);
        let on = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| mapped(&image, &FourierMapOptions::default()).unwrap())
        };
        assert_eq!(on(1), on(3));
    }
}
