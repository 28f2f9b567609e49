//! Equality, hashing and conversion of polygons.

use super::{Point, Polygon, PolygonError};
use std::hash::{Hash, Hasher};

impl Polygon {
    /// Returns the bit patterns of all rings: for each ring, the number of corners and then their
    /// coordinates.
    fn bits(&self) -> impl Iterator<Item = u64> {
        let rings = self.rings().iter();
        rings.flat_map(|r| {
            let corners = r.iter().flat_map(|p| [p.x.to_bits(), p.y.to_bits()]);
            std::iter::once(r.len() as u64).chain(corners)
        })
    }

    /// Returns bytes that are the same for two polygons only if the polygons are equal.
    pub(crate) fn bytes(&self) -> Vec<u8> {
        self.bits().flat_map(u64::to_le_bytes).collect()
    }
}

impl PartialEq for Polygon {
    fn eq(&self, other: &Self) -> bool {
        self.rings() == other.rings()
    }
}

/// Equality is reflexive, as all coordinates are finite.
impl Eq for Polygon {}

impl Hash for Polygon {
    fn hash<H: Hasher>(&self, state: &mut H) {
        self.bits().for_each(|bits| bits.hash(state));
    }
}

impl From<Polygon> for Vec<Vec<[f64; 2]>> {
    fn from(polygon: Polygon) -> Self {
        polygon.rings().iter().map(|ring| ring.iter().map(|p| p.coordinates()).collect()).collect()
    }
}

impl TryFrom<Vec<Vec<[f64; 2]>>> for Polygon {
    type Error = PolygonError;

    fn try_from(rings: Vec<Vec<[f64; 2]>>) -> Result<Self, PolygonError> {
        Self::new(rings.into_iter().map(|ring| ring.into_iter().map(Point::from).collect()).collect())
    }
}
