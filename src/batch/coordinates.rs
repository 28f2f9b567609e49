use super::failures::write_failures;
use super::measured::{distances, not_compared, pcf_table, record_of, warnings_of};
use super::outputs::OutputFolder;
use super::pairing::image_beside;
use super::work::for_each;
use super::{BatchError, Failure, Input, Progress, ScaleSource};
use crate::compare::References;
use crate::geometry::Window;
use crate::image;
use crate::mosaic::io::{ReadOptions, read_coordinates};
use crate::mosaic::{LengthUnit, Mosaic, Scale};
use crate::report::{CoordinatesRecord, counted};
use crate::sample::Sampler;
use crate::stats::{MeasureOptions, Measures, measure};
use std::fmt;
use std::path::Path;
use std::str::FromStr;
use std::sync::Arc;

/// Where the points of a coordinate file could have been seen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Region {
    /// The unit square.
    Unit,
    /// An image of this size: [−.5, W−.5] × [−.5, H−.5] px; in µm [0, W] × [0, H].
    Size(f64, f64),
    /// Left, upper, right and lower edge, in the unit of the coordinates.
    Edges([f64; 4]),
    /// The image of that name beside the file.
    Image,
}

impl FromStr for Region {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let numbers = |separator: char| -> Option<Vec<f64>> {
            text.split(separator)
                .map(|part| part.trim().parse().ok().filter(|v: &f64| v.is_finite()))
                .collect()
        };
        match (text, numbers('x').as_deref(), numbers(',').as_deref()) {
            ("unit", ..) => Ok(Self::Unit),
            ("image", ..) => Ok(Self::Image),
            (_, Some(&[w, h]), _) if w > 0. && h > 0. => Ok(Self::Size(w, h)),
            (_, _, Some(&[x0, y0, x1, y1])) if x0 < x1 && y0 < y1 => Ok(Self::Edges([x0, y0, x1, y1])),
            _ => Err(format!("“{text}” is no window: expected unit, image, WxH or X0,Y0,X1,Y1")),
        }
    }
}

impl fmt::Display for Region {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unit => f.write_str("unit"),
            Self::Size(w, h) => write!(f, "{w}x{h}"),
            Self::Edges([x0, y0, x1, y1]) => write!(f, "{x0},{y0},{x1},{y1}"),
            Self::Image => f.write_str("image"),
        }
    }
}

/// How coordinate files are read and measured.
#[derive(Clone)]
pub struct CoordinatesOptions {
    /// How the files are to be understood.
    pub read: ReadOptions,
    /// Where points could have been seen.
    pub region: Region,
    /// Opposite edges of the window are the same place.
    pub torus: bool,
    /// Where scales come from.
    pub scales: ScaleSource,
    /// How mosaics are measured.
    pub measure: MeasureOptions,
}

/// What came of measuring or comparing coordinate files.
#[derive(Clone, Debug)]
pub struct CoordinatesOutcome {
    /// One record a file, in the order of the inputs.
    pub records: Vec<CoordinatesRecord>,
    /// Files without results.
    pub failures: Vec<Failure>,
}

/// Writes `summary.csv` (one row a file) and `NAME.pcf.csv` (r in hexagonal spacings, g).
///
/// # Errors
/// If `out` cannot be written to. Files that fail are in the outcome and in `failures.csv`.
pub fn measure_files(
    inputs: &[Input],
    options: &CoordinatesOptions,
    out: &Path,
    progress: &dyn Progress,
) -> Result<CoordinatesOutcome, BatchError> {
    let out = OutputFolder::create(out)?;
    let (records, failures) = for_each(inputs, progress, |input| {
        let (mosaic, outside) = load(input, options)?;
        let measures = measure(&mosaic, &options.measure);
        let record = record(input, &mosaic, outside, &measures, Vec::new());
        let (header, rows) = pcf_table(measures.pcf.as_ref().ok(), &[]);
        out.write_table(&format!("{}.pcf.csv", input.name), &header, &rows)?;
        let line = line_about(&record);
        Ok((record, line))
    });
    let rows: Vec<_> = records.iter().map(CoordinatesRecord::row).collect();
    out.write_table("summary.csv", &CoordinatesRecord::header(), &rows)?;
    out.write("options.json", &options_json(options, serde_json::Value::Null)?)?;
    write_failures(&out, &failures)?;
    Ok(CoordinatesOutcome { records, failures })
}

/// Writes `l_infinity.csv`: one row a file, one column a sampler.
///
/// # Errors
/// If `out` cannot be written to. Files that fail are in the outcome and in `failures.csv`.
pub fn compare_files(
    inputs: &[Input],
    options: &CoordinatesOptions,
    samplers: &[&'static dyn Sampler],
    seed: u64,
    out: &Path,
    progress: &dyn Progress,
) -> Result<CoordinatesOutcome, BatchError> {
    let out = OutputFolder::create(out)?;
    let references = References::new(samplers.to_vec(), options.measure.pcf, seed);
    let (records, failures) = for_each(inputs, progress, |input| {
        let (mosaic, outside) = load(input, options)?;
        let measures = measure(&mosaic, &options.measure);
        let curves = match &measures.pcf {
            Ok(_) => references.curves(mosaic.len(), mosaic.window()).unwrap_or_default(),
            Err(_) => Arc::default(),
        };
        let mut record = record(input, &mosaic, outside, &measures, distances(&measures, &curves)?);
        record.warnings.extend(not_compared(&measures, samplers, &curves));
        let closest = record.mosaic.closest_sampler().unwrap_or("none");
        let line = format!("{}, closest to {closest}", line_about(&record));
        Ok((record, line))
    });
    let names: Vec<String> = samplers.iter().map(|s| s.name().to_owned()).collect();
    let rows: Vec<_> = records.iter().map(|r| r.distance_row(&names)).collect();
    out.write_table("l_infinity.csv", &CoordinatesRecord::distance_header(&names), &rows)?;
    let samplers = serde_json::json!({ "names": names, "seed": seed });
    out.write("options.json", &options_json(options, samplers)?)?;
    write_failures(&out, &failures)?;
    Ok(CoordinatesOutcome { records, failures })
}

/// How coordinates were read and measured, and what they were compared with.
fn options_json(options: &CoordinatesOptions, samplers: serde_json::Value) -> Result<Vec<u8>, BatchError> {
    let mut json = serde_json::to_vec_pretty(&serde_json::json!({
        "program": "conemosaic",
        "version": env!("CARGO_PKG_VERSION"),
        "read": options.read,
        "window": options.region.to_string(),
        "torus": options.torus,
        "scale": options.scales.describe(),
        "measure": options.measure,
        "samplers": samplers,
    }))?;
    json.push(b'\n');
    Ok(json)
}

fn line_about(record: &CoordinatesRecord) -> String {
    let ri = record.mosaic.nearest.ri.map(|ri| format!(", RI {ri:.2}")).unwrap_or_default();
    format!("{}{ri}", counted(record.mosaic.n, "point"))
}

fn record(
    input: &Input,
    mosaic: &Mosaic,
    outside: usize,
    measures: &Measures,
    l_infinity: Vec<crate::report::SamplerDistance>,
) -> CoordinatesRecord {
    let mosaic = record_of(mosaic, measures, l_infinity);
    let mut warnings = warnings_of(None, &mosaic, measures);
    if outside > 0 {
        warnings.push(format!("{outside} points outside the window are left out"));
    }
    CoordinatesRecord { file: input.path.display().to_string(), outside, mosaic, warnings }
}

/// The mosaic in a coordinate file, and how many of its points lie outside the window.
fn load(input: &Input, options: &CoordinatesOptions) -> Result<(Mosaic, usize), BatchError> {
    let file = read_coordinates(&input.path, &options.read)?;
    let unit = match options.region {
        Region::Unit => LengthUnit::Unit,
        _ => file.unit.unwrap_or(LengthUnit::Pixel),
    };
    let picture = match options.region {
        Region::Image => {
            Some(image_beside(&input.path).ok_or_else(|| BatchError::NoImage { file: input.path.clone() })?)
        }
        _ => None,
    };
    let (window, width) = match (options.region, picture) {
        (Region::Image, Some(path)) => {
            let (height, width) = image::read(&path)?.dim();
            (Window::of_image(width, height)?, width as f64)
        }
        (Region::Edges([x0, y0, x1, y1]), _) => (Window::rectangle(x0, y0, x1, y1)?, x1 - x0),
        (Region::Size(w, h), _) if unit == LengthUnit::Pixel => {
            (Window::rectangle(-0.5, -0.5, w - 0.5, h - 0.5)?, w)
        }
        (Region::Size(w, h), _) => (Window::rectangle(0., 0., w, h)?, w),
        (Region::Unit | Region::Image, _) => (Window::unit_square(), 1.),
    };
    let scale = match unit {
        LengthUnit::Unit => None,
        _ => options.scales.scale_of(&input.path, width.round().max(1.) as usize)?,
    };
    let window = match (options.region, unit) {
        (Region::Image, LengthUnit::Micrometre) => in_micrometres(input, &window, scale)?,
        _ => window,
    };
    let window = if options.torus { Window::Torus(window.bounds()) } else { window };
    Mosaic::new(file.points, window, unit, scale)
        .map_err(|source| BatchError::Mosaic { file: input.path.clone(), source })
}

fn in_micrometres(input: &Input, window: &Window, scale: Option<Scale>) -> Result<Window, BatchError> {
    let um = scale
        .ok_or_else(|| BatchError::NoScale { what: "the coordinate file", file: input.path.clone() })?
        .micrometres_per_pixel();
    let b = window.bounds();
    Ok(Window::rectangle(b.x0() * um, b.y0() * um, b.x1() * um, b.y1() * um)?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn windows_are_read_as_documented() {
        assert_eq!("150x100".parse(), Ok(Region::Size(150., 100.)));
        assert_eq!("unit".parse(), Ok(Region::Unit));
        assert_eq!("0,0,1.5,2".parse(), Ok(Region::Edges([0., 0., 1.5, 2.])));
        for bad in ["", "0x5", "1,1,1,2", "nan,0,1,1", "150", "1,2,3"] {
            assert!(bad.parse::<Region>().is_err(), "{bad}");
        }
    }
}
