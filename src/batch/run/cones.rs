//! Origin of the cones of an image: detected by this program, marked elsewhere, or detected and
//! then corrected by a person.

use super::done::{POINTS, earlier_cones};
use super::{GivenCones, IMAGES, Job};
use crate::batch::detect::{describe, detect_within, formatted};
use crate::batch::output::Standing;
use crate::batch::{BatchError, Input};
use crate::detect::{DetectOptions, Detections, weights};
use crate::geometry::{Point, Window};
use crate::image::Plane;
use crate::mosaic::io::{ReadOptions, format_points, read_from};
use crate::mosaic::{LengthUnit, Scale};
use crate::report::{ConesFrom, counted};
use sha2::{Digest, Sha256};
use std::borrow::Cow;
use std::fs;
use std::path::Path;

/// The source of the cones of a run.
#[derive(Clone, Debug)]
pub enum ConeSource {
    /// Cones are detected in the images by this program.
    Detector(DetectOptions),
    /// Cones were marked or detected before, and are read from files.
    Given(GivenCones),
}

/// The cones of one image.
pub(super) struct Cones {
    /// Centres of the cones within the window, in px.
    pub points: Vec<Point>,
    /// Number of cones in the file that lie outside the window; 0 if the cones were detected.
    pub outside: usize,
    /// Number of cones in the entire image, whether inside or outside the window.
    pub all: usize,
    /// Detections inside the window; `None` if the cones were read from a file.
    pub found: Option<Detections>,
    /// Origin of the cones, for the record.
    pub from: ConesFrom,
    /// The content of `points.csv`.
    pub csv: Vec<u8>,
}

impl Cones {
    /// Returns the line that is shown to the user about the cones of one image.
    pub fn line(&self) -> String {
        match &self.found {
            Some(found) => describe(found),
            None => format!("{}, {}", counted(self.points.len(), "cone"), self.from.name()),
        }
    }
}

/// Origin of an image's cones, with everything that is needed to read or detect them.
pub(super) enum Origin<'a> {
    /// The cones are to be detected with these options.
    Detector(Cow<'a, DetectOptions>),
    /// The cones are to be read from this file: its content and its path.
    Given(Vec<u8>, &'a Path),
    /// The cones are those of this `points.csv`, which a person has corrected: its content.
    Corrected(Vec<u8>),
}

impl Origin<'_> {
    /// Adds everything on which the cones depend to a hash: the options and weights of the
    /// detector, or the content of the file.
    pub fn identify(&self, digest: &mut Sha256) -> Result<(), BatchError> {
        match self {
            Self::Detector(options) => {
                digest.update(serde_json::to_vec(&**options)?);
                weights().iter().for_each(|file| digest.update(file));
            }
            Self::Given(bytes, _) => {
                digest.update("given");
                digest.update(bytes);
            }
            Self::Corrected(bytes) => {
                digest.update("corrected");
                digest.update(bytes);
            }
        }
        Ok(())
    }
}

impl Job<'_> {
    /// Decides whether the cones of an image are detected, read from a file of the user's, or read
    /// from a corrected `points.csv`.
    ///
    /// If a person has corrected the `points.csv` of an earlier run, its cones are used instead of
    /// the detector, unless corrections are to be replaced.
    ///
    /// # Errors
    /// Fails if a correction would be lost because the run starts anew or reads its cones from
    /// files, or if the file of cones is missing or cannot be read.
    pub(super) fn origin(
        &self,
        input: &Input,
        image: &Plane,
        window: &Window,
    ) -> Result<Origin<'_>, BatchError> {
        let corrected = match self.options.replace_corrections {
            true => None,
            false => self.correction(input, image, window)?,
        };
        if let Some(bytes) = corrected {
            return match self.options.cones {
                ConeSource::Detector(_) if !self.options.fresh => Ok(Origin::Corrected(bytes)),
                _ => Err(BatchError::Corrected { path: self.images.join(&input.name).join(POINTS) }),
            };
        }
        match &self.options.cones {
            ConeSource::Detector(options) => Ok(Origin::Detector(self.detector_for(input, options)?)),
            ConeSource::Given(given) => {
                let path = given.file_of(input)?;
                let bytes = fs::read(path)
                    .map_err(|source| BatchError::Unreadable { path: path.to_owned(), source })?;
                Ok(Origin::Given(bytes, path))
            }
        }
    }

    /// Returns the options with which the cones of an image are detected. The channel to which its
    /// name belongs overrules the modality; the manifest states it where it is to be decided.
    fn detector_for<'a>(
        &self,
        input: &Input,
        options: &'a DetectOptions,
    ) -> Result<Cow<'a, DetectOptions>, BatchError> {
        let channel = self.options.pairs.as_ref().and_then(|patterns| patterns.of(&input.path));
        let stated = match (channel, options.modality) {
            (Some((modality, _)), _) => Some(modality),
            (None, Some(_)) => None,
            (None, None) => self.options.plan.labels.modality_of(&input.path)?,
        };
        Ok(match stated {
            Some(modality) => Cow::Owned(DetectOptions { modality: Some(modality), ..options.clone() }),
            None => Cow::Borrowed(options),
        })
    }

    /// Returns whether a person has stated the modality of an image.
    pub(super) fn modality_given(&self, path: &Path) -> bool {
        let named = self.options.pairs.as_ref().is_some_and(|patterns| patterns.of(path).is_some());
        let for_all = matches!(&self.options.cones, ConeSource::Detector(o) if o.modality.is_some());
        named || for_all || matches!(self.options.plan.labels.modality_of(path), Ok(Some(_)))
    }

    /// Returns whether the `points.csv` of an image contains a person's corrections: it was changed
    /// after the program wrote it, or an earlier run already treated it as corrected.
    pub(super) fn is_corrected(&self, input: &Input) -> bool {
        let listed = format!("{IMAGES}/{}/{POINTS}", input.name);
        let before = || earlier_cones(&self.images.join(&input.name)) == Some(ConesFrom::Corrected);
        match self.out.standing(&listed) {
            Standing::Missing => false,
            Standing::Own => before(),
            Standing::Changed => self.out.knows(&listed),
        }
    }

    /// Returns the content of the `points.csv` of an image if a person has corrected it; `None`
    /// otherwise.
    fn correction(
        &self,
        input: &Input,
        image: &Plane,
        window: &Window,
    ) -> Result<Option<Vec<u8>>, BatchError> {
        if !self.is_corrected(input) {
            return Ok(None);
        }
        let path = self.images.join(&input.name).join(POINTS);
        let bytes = fs::read(&path).map_err(|source| BatchError::Unreadable { path, source })?;
        // A file that was cut off while the program wrote it ends within a row, and its bytes are
        // the beginning of what the program would write: that is no correction. A file that ends
        // with a complete row but without a line break was saved by an editor.
        if let (false, ConeSource::Detector(options)) = (bytes.ends_with(b"\n"), &self.options.cones) {
            let cut = self.windows.cut(image, window);
            let mut found = detect_within(input, image, cut.as_ref(), &*self.detector_for(input, options)?)?;
            found.cones.retain(|d| window.contains(d.centre));
            let scale = self.options.plan.scales.scale_of(&input.path, image.ncols())?;
            let written = formatted(&found.cones, scale);
            if written.strip_prefix(&*bytes).is_some_and(|rest| !rest.starts_with(b"\n")) {
                return Ok(None);
            }
        }
        Ok(Some(bytes))
    }
}

/// Detects or reads the cones of an image.
///
/// # Errors
/// Fails if detection fails, if a file of cones cannot be read, or if a file of cones is in µm and
/// no scale is known.
pub(super) fn cones_of(
    origin: &Origin,
    input: &Input,
    image: &Plane,
    window: &Window,
    scale: Option<Scale>,
    job: &Job,
) -> Result<Cones, BatchError> {
    match origin {
        Origin::Detector(options) => {
            let cut = job.windows.cut(image, window);
            let mut found = detect_within(input, image, cut.as_ref(), options)?;
            let all = found.cones.len();
            found.cones.retain(|d| window.contains(d.centre));
            let (points, csv) = (found.centres(), formatted(&found.cones, scale));
            Ok(Cones { points, outside: 0, all, found: Some(found), from: ConesFrom::Detected, csv })
        }
        Origin::Given(bytes, path) => {
            let read = match &job.options.cones {
                ConeSource::Given(given) => given.read.clone(),
                ConeSource::Detector(_) => ReadOptions::default(),
            };
            let (points, outside) = read_cones((path, bytes), &read, job, window, scale)?;
            let csv = format_points(&points, None, scale).into_bytes();
            let all = points.len() + outside;
            Ok(Cones { points, outside, all, found: None, from: ConesFrom::Given, csv })
        }
        Origin::Corrected(bytes) => {
            let path = job.images.join(&input.name).join(POINTS);
            let centres = without_scores(bytes);
            let (points, outside) =
                read_cones((&path, &centres), &ReadOptions::default(), job, window, scale)?;
            let all = points.len() + outside;
            Ok(Cones { points, outside, all, found: None, from: ConesFrom::Corrected, csv: bytes.clone() })
        }
    }
}

/// Returns only the first two columns of a file of detections, x and y in px. A person who adds a
/// row need not fill in the score or the position in µm. Any other file is returned unchanged.
pub(super) fn without_scores(bytes: &[u8]) -> Vec<u8> {
    match std::str::from_utf8(bytes) {
        Ok(text) if text.starts_with("x_px,y_px,") => {
            let centre = |line: &str| line.split(',').take(2).collect::<Vec<_>>().join(",") + "\n";
            text.lines().map(centre).collect::<String>().into_bytes()
        }
        _ => bytes.to_owned(),
    }
}

/// Reads a file of cones. Returns the cones inside the window, in px, and the number of cones
/// outside.
fn read_cones(
    (path, bytes): (&Path, &[u8]),
    read: &ReadOptions,
    job: &Job,
    window: &Window,
    scale: Option<Scale>,
) -> Result<(Vec<Point>, usize), BatchError> {
    let file = read_from(&path.display().to_string(), bytes, read)?;
    let factor = match file.unit.unwrap_or(LengthUnit::Pixel) {
        unit @ LengthUnit::Unit => return Err(BatchError::NotPixels { file: path.to_owned(), unit }),
        unit @ LengthUnit::Pixel => unit.factor_to(unit, scale),
        // the file is in µm on the slide, but the scale is in µm of living tissue
        unit @ LengthUnit::Micrometre => {
            let expansion = job.options.plan.scales.expansion();
            unit.factor_to(LengthUnit::Pixel, scale).map(|factor| factor * expansion)
        }
    };
    let factor =
        factor.ok_or_else(|| BatchError::NoScale { what: "the file of cones", file: path.to_owned() })?;
    let all = file.points.len();
    let scaled = file.points.into_iter().map(|p| Point::new(p.x * factor, p.y * factor));
    let inside: Vec<Point> = scaled.filter(|&p| window.contains(p)).collect();
    let outside = all - inside.len();
    Ok((inside, outside))
}
