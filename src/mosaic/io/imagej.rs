//! ImageJ ROIs, in the binary format that ImageJ's class `ij.io.RoiDecoder` reads.

use super::error::{Located, ReadFault, clipped};
use super::{Dataset, Dialect, Origin, RawFile};
use crate::geometry::Point;
use crate::mosaic::LengthUnit;

/// Size of the header in bytes; the coordinates begin at this offset.
const HEADER: usize = 64;
/// Bit of the options at byte 50 that marks sub-pixel coordinates.
const SUB_PIXEL: u16 = 128;
/// First version of the format that can contain sub-pixel coordinates.
const FIRST_SUB_PIXEL: u16 = 222;
/// First version of the format whose point selections count from the centre of the first pixel.
///
/// ImageJ 1.52t (2020) introduced it; before, they counted from the corner of that pixel. The class
/// `ij.gui.Roi` says: "Line and Point Rois: Integer coordinates refer to the center of a pixel".
const FIRST_CENTRED: u16 = 228;
/// Value of the byte at offset 6 for a rectangle.
const RECTANGLE: u8 = 1;
/// Value of the byte at offset 6 for one or several points.
const POINT: u8 = 10;
/// Values of the byte at offset 6 for lists of corners: polygon, freehand outline, traced outline.
const OUTLINES: [u8; 3] = [0, 7, 8];

/// Content that is expected of a ROI.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Wanted {
    /// Points that mark cones.
    Points,
    /// Outline of a window.
    Outline,
}

/// Reads a single `.roi` file.
pub(super) fn read_roi(name: &str, bytes: &[u8], wanted: Wanted) -> Result<RawFile, Located> {
    Ok(file(vec![parse(name, bytes, wanted)?]))
}

/// Returns the contents of a file in pixels, with one dataset per ROI.
pub(super) fn file(datasets: Vec<Dataset>) -> RawFile {
    RawFile {
        dialect: Dialect::ImageJRoi,
        unit: Some(LengthUnit::Pixel),
        y_may_point_up: false,
        datasets,
        scores: None,
    }
}

/// Reads a point or multi-point ROI, or an outline.
///
/// After the big-endian header come all x and then all y as 16-bit offsets from the upper left
/// corner of the bounding box. If the ROI is sub-pixel, all x and all y follow as absolute 32-bit
/// floats. The name of the dataset is `name` without folder and extension.
pub(super) fn parse(name: &str, bytes: &[u8], wanted: Wanted) -> Result<Dataset, ReadFault> {
    let name = name.rsplit(['/', '\\']).next().unwrap_or(name);
    let name = name.strip_suffix(".roi").unwrap_or(name).to_owned();
    if bytes.len() < HEADER || !bytes.starts_with(b"Iout") {
        let start = clipped(&String::from_utf8_lossy(bytes.get(..4).unwrap_or(bytes)), 4);
        let found = format!("{} bytes that begin with “{start}”", bytes.len());
        return Err(ReadFault::BrokenRoi { expected: HEADER as u64, found });
    }
    let roi = Fields(bytes);
    let kind = bytes.get(6).copied().unwrap_or_default();
    let composite = roi.u32(36) > 0;
    match wanted {
        Wanted::Points if kind != POINT || composite => {
            return Err(ReadFault::NotAPointRoi { found: kind_name(kind, composite) });
        }
        Wanted::Outline if kind == RECTANGLE && !composite => {
            let [top, left, bottom, right] = [8, 10, 12, 14].map(|at| roi.i16(at));
            let corners = [(left, top), (right, top), (right, bottom), (left, bottom)];
            let points = corners.iter().map(|&(x, y)| Point::new(x, y)).collect();
            return Ok(Dataset { name, origin: Origin::Half, points });
        }
        Wanted::Outline if !OUTLINES.contains(&kind) || composite => {
            return Err(ReadFault::NotAnOutlineRoi { found: kind_name(kind, composite) });
        }
        Wanted::Points | Wanted::Outline => {}
    }
    let version = roi.u16(4);
    let sub_pixel = version >= FIRST_SUB_PIXEL && roi.u16(50) & SUB_PIXEL != 0;
    // A count beyond 65,535 does not fit the old 16-bit field and is in a 32-bit field instead.
    let n = match roi.u16(16) {
        0 => u64::from(roi.u32(18)),
        n => u64::from(n),
    };
    let expected = HEADER as u64 + n * if sub_pixel { 12 } else { 4 };
    if (bytes.len() as u64) < expected {
        let found = format!("{} bytes for {n} points", bytes.len());
        return Err(ReadFault::BrokenRoi { expected, found });
    }
    // The points fit in `bytes`, so their number fits in a usize.
    let n = n as usize;
    let point = |i: usize| {
        if sub_pixel {
            let x = HEADER + 4 * n + 4 * i;
            Point::new(roi.f32(x), roi.f32(x + 4 * n))
        } else {
            let x = HEADER + 2 * i;
            // ImageJ raises negative offsets to 0 too.
            Point::new(roi.i16(10) + roi.i16(x).max(0.), roi.i16(8) + roi.i16(x + 2 * n).max(0.))
        }
    };
    let points: Vec<Point> = (0..n).map(point).collect();
    if let Some(p) = points.iter().find(|p| !p.is_finite()) {
        return Err(ReadFault::NotFinite { column: "a point".into(), found: format!("({}, {})", p.x, p.y) });
    }
    // Outlines run along the edges of pixels, so their integer coordinates are corners of pixels.
    let from_corner = wanted == Wanted::Outline || (sub_pixel && version < FIRST_CENTRED);
    let origin = if from_corner { Origin::Half } else { Origin::Zero };
    Ok(Dataset { name, origin, points })
}

/// Bytes of a ROI, from which big-endian fields are read by their offset; fields past the end are
/// 0.
struct Fields<'a>(&'a [u8]);

impl Fields<'_> {
    fn bytes<const N: usize>(&self, at: usize) -> [u8; N] {
        self.0.get(at..).and_then(|rest| rest.first_chunk::<N>()).copied().unwrap_or([0; N])
    }
    fn u16(&self, at: usize) -> u16 {
        u16::from_be_bytes(self.bytes(at))
    }
    fn u32(&self, at: usize) -> u32 {
        u32::from_be_bytes(self.bytes(at))
    }
    fn f32(&self, at: usize) -> f64 {
        f64::from(f32::from_be_bytes(self.bytes(at)))
    }
    /// Returns a signed 16-bit field, except that values below −5000 are taken as unsigned.
    ///
    /// ImageJ does the same, for images wider or higher than 32,767 px.
    fn i16(&self, at: usize) -> f64 {
        let signed = i16::from_be_bytes(self.bytes(at));
        if signed < -5000 { f64::from(self.u16(at)) } else { f64::from(signed) }
    }
}

/// Describes the kind of a ROI for an error; `kind` is the byte at offset 6.
fn kind_name(kind: u8, composite: bool) -> String {
    const KINDS: [&str; 10] = [
        "a polygon",
        "a rectangle",
        "an oval",
        "a line",
        "a freehand line",
        "a segmented line",
        "none",
        "a freehand outline",
        "a traced outline",
        "an angle",
    ];
    match KINDS.get(usize::from(kind)) {
        _ if composite => "a composite ROI".into(),
        _ if kind == POINT => "points".into(),
        Some(&name) => name.into(),
        None => format!("an ROI of kind {kind}"),
    }
}
