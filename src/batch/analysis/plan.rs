use super::MapRequest;
use super::rois::RoiRequest;
use crate::batch::{BatchError, Labels, ScaleSource};
use crate::compare::{References, VerdictOptions};
use crate::report::{FigureFormat, MetricGroup, MetricSelection, PowerScale, Summary, SummaryKind};
use crate::sample::Sampler;
use crate::stats::{FunctionOptions, MeasureOptions, SpectrumOptions};
use serde_json::{Value, json};

/// The plan of a batch: what is computed and written for each mosaic, whether its points come from
/// an image or from a coordinate file.
#[derive(Clone)]
pub struct Plan {
    /// Options of the statistics.
    pub measure: MeasureOptions,
    /// Samplers with which the mosaics are compared; may be empty.
    pub samplers: Vec<&'static dyn Sampler>,
    /// Options of the test of every mosaic against each sampler, which simulates the sampler with
    /// the mosaic's own number of points and window. `None` if no test is made, only l-infinity
    /// distances are computed.
    pub verdict: Option<VerdictOptions>,
    /// Seed of all random numbers.
    pub seed: u64,
    /// Distances at which the functions G, F, J, K, L and g are written, together with a table of
    /// the points. `None` if neither is written.
    pub functions: Option<FunctionOptions>,
    /// Options of power spectra, and the scale on which they are drawn. `None` if there are to be
    /// no spectra.
    pub spectrum: Option<(SpectrumOptions, PowerScale)>,
    /// Options of maps and of the landmarks read off them. `None` if there are to be no maps.
    pub maps: Option<MapRequest>,
    /// Regions of interest, each of which is measured as a mosaic of its own. `None` if there are
    /// to be no regions.
    pub rois: Option<RoiRequest>,
    /// Source of the scales of the images or files.
    pub scales: ScaleSource,
    /// Facts about the files from a manifest, and the rule by which the files form groups.
    pub labels: Labels,
    /// Selection of the columns of `summary.csv`.
    pub metrics: MetricSelection,
    /// Formats of the figures besides SVG.
    pub figures: Vec<FigureFormat>,
}

impl Default for Plan {
    fn default() -> Self {
        Self {
            measure: MeasureOptions::default(),
            samplers: Vec::new(),
            verdict: None,
            seed: 1,
            functions: None,
            spectrum: None,
            maps: None,
            rois: None,
            scales: ScaleSource::Unknown,
            labels: Labels::default(),
            metrics: MetricSelection::default(),
            figures: Vec::new(),
        }
    }
}

impl Plan {
    /// Returns the names of the samplers with which mosaics are compared.
    pub fn sampler_names(&self) -> Vec<String> {
        self.samplers.iter().map(|s| s.name().to_owned()).collect()
    }

    /// Returns the description of `summary.csv`, with its columns, for images or for coordinate
    /// files.
    pub fn summary(&self, kind: SummaryKind) -> Summary {
        Summary::new(kind, &self.metrics, &self.sampler_names(), self.labels.columns())
    }

    /// Checks, before any work is done, that options are in their ranges and fit together.
    ///
    /// # Errors
    /// Fails if an option is not valid. The error names the first such option.
    pub fn validate(&self) -> Result<(), BatchError> {
        self.verdict.iter().try_for_each(VerdictOptions::validate)?;
        self.labels.validate()?;
        self.maps.iter().try_for_each(MapRequest::validate)?;
        self.rois.iter().try_for_each(RoiRequest::validate)
    }

    /// Prepares the reference curves of the samplers.
    pub(in crate::batch) fn references(&self) -> References {
        References::new(self.samplers.clone(), self.measure.pcf, self.seed)
    }

    /// Returns whether any output needs the cone spacing estimated from the spectrum of an image.
    pub(in crate::batch) fn wants_fourier(&self) -> bool {
        self.maps.is_some() || self.metrics.has_any_of(MetricGroup::Fourier, SummaryKind::Images)
    }

    /// Returns, as JSON, the part of the plan on which the results of an image depend. The hash of
    /// an image's options covers it.
    ///
    /// The sources of scales and labels are left out, since only the scale and the labels of each
    /// image matter.
    pub(in crate::batch) fn identity(&self) -> Value {
        let mut identity = self.describe();
        if let Some(identity) = identity.as_object_mut() {
            identity.remove("scale");
            identity.remove("manifest");
            identity
                .insert("regions".into(), json!(self.rois.as_ref().map(|request| format!("{request:?}"))));
        }
        identity
    }

    /// Returns the plan as JSON, for the record of a batch.
    pub(in crate::batch) fn describe(&self) -> Value {
        json!({
            "measure": self.measure,
            "samplers": self.sampler_names(),
            "verdict": self.verdict,
            "seed": self.seed,
            "functions": self.functions,
            "spectrum": self.spectrum.map(|(spectrum, _)| spectrum),
            "spectrum_scale": self.spectrum.map(|(_, scale)| format!("{scale:?}").to_lowercase()),
            "maps": self.maps,
            "rois": self.rois.as_ref().map(RoiRequest::describe),
            "figures": self.figures.iter().map(ToString::to_string).collect::<Vec<_>>(),
            "scale": self.scales.describe(),
            "manifest": self.labels.manifest.as_ref().map(|m| m.file()),
        })
    }
}
