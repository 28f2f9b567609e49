use super::OutputFolder;
use crate::batch::BatchError;
use crate::report::{FigureFormat, convert};

/// Writes a figure as `NAME.svg`, which the pages show, and also in every other format of
/// `formats`.
pub(in crate::batch) fn write_figure(
    out: &OutputFolder,
    name: &str,
    svg: &str,
    formats: &[FigureFormat],
) -> Result<(), BatchError> {
    out.write(&format!("{name}.svg"), svg.as_bytes())?;
    let others = FigureFormat::ALL.into_iter().filter(|f| *f != FigureFormat::Svg && formats.contains(f));
    for format in others {
        out.write(&format!("{name}.{format}"), &convert(svg, format)?)?;
    }
    Ok(())
}
