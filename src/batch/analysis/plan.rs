use super::MapRequest;
use super::rois::RoiRequest;
use crate::batch::{BatchError, Labels, ScaleSource};
use crate::compare::{References, VerdictOptions};
use crate::report::{FigureFormat, MetricGroup, MetricSelection, PowerScale, Summary, SummaryKind};
use crate::sample::Sampler;
use crate::stats::{FunctionOptions, MeasureOptions, SpectrumOptions};
use serde_json::{Value, json};

/// Everything that is computed of a mosaic and written about it, wherever its points come from.
#[derive(Clone)]
pub struct Plan {
    /// Options of the measures.
    pub measure: MeasureOptions,
    /// Samplers they are compared with; may be empty.
    pub samplers: Vec<&'static dyn Sampler>,
    /// Simulations of each sampler at every mosaic's own n and window; `None`: distances only.
    pub verdict: Option<VerdictOptions>,
    /// Seed of everything random.
    pub seed: u64,
    /// Distances at which G, F, J, K, L and g are written, with a table of the points.
    pub functions: Option<FunctionOptions>,
    /// Power spectra, and how they are drawn.
    pub spectrum: Option<(SpectrumOptions, PowerScale)>,
    /// Maps, and the landmarks read off them.
    pub maps: Option<MapRequest>,
    /// Regions measured as mosaics of their own.
    pub rois: Option<RoiRequest>,
    /// Source of the scales.
    pub scales: ScaleSource,
    /// Facts about the files from a manifest, and which of them belong together.
    pub labels: Labels,
    /// Columns of `summary.csv`.
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
    /// Returns the names of the samplers compared with.
    pub fn sampler_names(&self) -> Vec<String> {
        self.samplers.iter().map(|s| s.name().to_owned()).collect()
    }

    /// Returns the columns of `summary.csv` for images or for coordinate files.
    pub fn summary(&self, kind: SummaryKind) -> Summary {
        Summary::new(kind, &self.metrics, &self.sampler_names(), self.labels.columns())
    }

    /// Refuses options that are out of range or do not fit together, before any work is done.
    ///
    /// # Errors
    /// The first such option, with its range.
    pub fn validate(&self) -> Result<(), BatchError> {
        self.verdict.iter().try_for_each(VerdictOptions::validate)?;
        self.labels.validate()?;
        self.maps.iter().try_for_each(MapRequest::validate)?;
        self.rois.iter().try_for_each(RoiRequest::validate)
    }

    /// Prepares the mean curves of the samplers.
    pub(in crate::batch) fn references(&self) -> References {
        References::new(self.samplers.clone(), self.measure.pcf, self.seed)
    }

    /// Tells whether the spacing by the spectrum of an image is wanted by any output.
    pub(in crate::batch) fn wants_fourier(&self) -> bool {
        self.maps.is_some() || self.metrics.has_any_of(MetricGroup::Fourier, SummaryKind::Images)
    }

    /// Returns what tells plans apart whose results differ: all but where scales and labels are from.
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
