use super::ReportError;
use krilla::Document;
use krilla::geom::Size;
use krilla::metadata::Metadata;
use krilla::page::PageSettings;
use krilla_svg::{SurfaceExt, SvgSettings};
use png::{BitDepth, ColorType, PixelDimensions, Unit};
use resvg::tiny_skia::{Color, Pixmap, Transform};
use resvg::usvg::fontdb::Database;
use resvg::usvg::{Options, Tree};
use std::fmt;
use std::str::FromStr;
use std::sync::{Arc, LazyLock};

/// Fonts in which figures are set, regular and bold.
///
/// Arimo has the character widths of Helvetica and Arial, which SVG figures ask for. Texts
/// therefore take as much room in a PDF or PNG as in the SVG.
const FONTS: [&[u8]; 2] = [include_bytes!("fonts/Arimo-Regular.ttf"), include_bytes!("fonts/Arimo-Bold.ttf")];
/// Name of the font family of [`FONTS`].
const FAMILY: &str = "Arimo";

/// Resolution of figures written as PNG, in pixels per inch: what journals ask for.
const DPI: f32 = 300.;
/// Millimetres per inch, to convert [`DPI`] to the pixels per metre that PNG files state.
const MM_PER_INCH: f32 = 25.4;
/// Units per inch in which an SVG states lengths, as CSS defines its px.
const SVG_UNITS_PER_INCH: f32 = 96.;
/// Points per inch, the unit of lengths in a PDF.
const POINTS_PER_INCH: f32 = 72.;

/// A kind of file that a figure can be written as.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum FigureFormat {
    /// Vector graphics as they are drawn; text stays text, in the fonts of the reader.
    Svg,
    /// Vector graphics for manuscripts; text stays text, in a font that the file contains.
    Pdf,
    /// Pixels for slides, at 300 dpi.
    Png,
}

impl FigureFormat {
    /// The list of all formats.
    pub const ALL: [Self; 3] = [Self::Svg, Self::Pdf, Self::Png];

    /// Returns the name of the format in options, which is also the extension of its files.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Svg => "svg",
            Self::Pdf => "pdf",
            Self::Png => "png",
        }
    }
}

impl fmt::Display for FigureFormat {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for FigureFormat {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let asked = text.trim().to_lowercase();
        Self::ALL
            .into_iter()
            .find(|format| format.name() == asked)
            .ok_or_else(|| format!("“{text}” is not a format of figures: expected svg, pdf or png"))
    }
}

/// Converts a figure of this crate to the bytes of a file in `format`.
///
/// Equal figures make equal bytes on every machine, because texts are set in a font that is part of
/// the crate. The font has Latin, Greek and basic Cyrillic letters. Only other characters are
/// looked for in the fonts of the machine.
///
/// # Errors
/// Fails if `svg` is not valid SVG, has no size, or is too large for the format.
pub fn convert(svg: &str, format: FigureFormat) -> Result<Vec<u8>, ReportError> {
    match format {
        FigureFormat::Svg => Ok(svg.as_bytes().to_vec()),
        FigureFormat::Pdf => pdf(&tree(svg, format)?),
        FigureFormat::Png => png(&tree(svg, format)?),
    }
}

fn failed(format: FigureFormat, reason: impl fmt::Display) -> ReportError {
    ReportError::Convert { format, reason: reason.to_string() }
}

/// Parses an SVG for drawing, with the fonts that its characters need.
fn tree(svg: &str, format: FigureFormat) -> Result<Tree, ReportError> {
    static OWN_FONTS: LazyLock<Arc<Database>> = LazyLock::new(|| Arc::new(own_fonts()));
    let fontdb = if svg.chars().all(is_covered) {
        Arc::clone(&OWN_FONTS)
    } else {
        let mut fonts = own_fonts();
        fonts.load_system_fonts();
        Arc::new(fonts)
    };
    let options =
        Options { fontdb, font_family: FAMILY.into(), dpi: SVG_UNITS_PER_INCH, ..Options::default() };
    Tree::from_str(svg, &options).map_err(|e| failed(format, e))
}

/// Returns a font database with the fonts of the crate only.
fn own_fonts() -> Database {
    let mut fonts = Database::new();
    for font in FONTS {
        fonts.load_font_data(font.to_vec());
    }
    fonts.set_sans_serif_family(FAMILY);
    fonts
}

/// Returns whether the crate's own font has the character.
///
/// The font was reduced to the blocks of characters listed here.
const fn is_covered(c: char) -> bool {
    matches!(
        c,
        '\0'..='\u{24f}' | '\u{370}'..='\u{45f}' | '\u{1e00}'..='\u{1eff}' | '\u{2010}'..='\u{2265}' | '\u{fffd}'
    )
}

fn pdf(tree: &Tree) -> Result<Vec<u8>, ReportError> {
    let failed = |reason: &str| failed(FigureFormat::Pdf, reason);
    let side = |units: f32| units / SVG_UNITS_PER_INCH * POINTS_PER_INCH;
    let size = Size::from_wh(side(tree.size().width()), side(tree.size().height()))
        .ok_or_else(|| failed("the figure has no size"))?;
    let mut document = Document::new();
    document.set_metadata(Metadata::new().producer(concat!("conemosaic ", env!("CARGO_PKG_VERSION")).into()));
    let mut page = document.start_page_with(PageSettings::new(size));
    let mut surface = page.surface();
    surface
        .draw_svg(tree, size, SvgSettings::default())
        .ok_or_else(|| failed("the figure cannot be drawn"))?;
    surface.finish();
    page.finish();
    document.finish().map_err(|e| failed(&format!("{e:?}")))
}

fn png(tree: &Tree) -> Result<Vec<u8>, ReportError> {
    let scale = DPI / SVG_UNITS_PER_INCH;
    let side = |units: f32| (units * scale).round().max(1.) as u32;
    let (width, height) = (side(tree.size().width()), side(tree.size().height()));
    let mut pixels = Pixmap::new(width, height).ok_or_else(|| {
        failed(FigureFormat::Png, format!("the figure is too large, {width} × {height} px"))
    })?;
    // The page covers the last row and column only in part; without a white ground they would turn
    // dark.
    pixels.fill(Color::WHITE);
    resvg::render(tree, Transform::from_scale(scale, scale), &mut pixels.as_mut());
    let rgb: Vec<u8> = pixels.data().chunks_exact(4).flat_map(|p| [p[0], p[1], p[2]]).collect();
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width, height);
    encoder.set_color(ColorType::Rgb);
    encoder.set_depth(BitDepth::Eight);
    let per_metre = (DPI / MM_PER_INCH * 1000.).round() as u32;
    encoder.set_pixel_dims(Some(PixelDimensions { xppu: per_metre, yppu: per_metre, unit: Unit::Meter }));
    let refused = |e: png::EncodingError| failed(FigureFormat::Png, e);
    let mut writer = encoder.write_header().map_err(refused)?;
    writer.write_image_data(&rgb).map_err(refused)?;
    writer.finish().map_err(refused)?;
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns a page of 180 × 45 mm with a text, as figures write it.
    fn figure(text: &str) -> String {
        format!(
            r##"<svg xmlns="http://www.w3.org/2000/svg" width="180mm" height="45mm" viewBox="0 0 720 180" font-family="Helvetica, Arial, 'Liberation Sans', sans-serif" fill="#000000"><rect width="720" height="180" fill="#ffffff"/><text x="20" y="90" font-size="40">{text}</text></svg>"##
        )
    }

    fn shades(svg: &str) -> image::GrayImage {
        image::load_from_memory(&convert(svg, FigureFormat::Png).unwrap()).unwrap().to_luma8()
    }

    fn dark(svg: &str) -> usize {
        let picture = shades(svg);
        assert_eq!((picture.width(), picture.height()), (2126, 531));
        picture.pixels().filter(|p| p.0[0] < 128).count()
    }

    #[test]
    fn text_shows_in_pixels_whatever_fonts_the_machine_has() {
        assert!(shades(&figure("")).pixels().all(|p| p.0[0] == 255), "the edges are white, too");
        for text in ["g", "ℓ∞", "√", "µm²", "−1", "Ł", "ρ"] {
            assert!(dark(&figure(text)) > 200, "{text}");
        }
    }

    #[test]
    fn a_png_says_that_it_has_300_pixels_per_inch() {
        let bytes = convert(&figure("g"), FigureFormat::Png).unwrap();
        let reader = png::Decoder::new(std::io::Cursor::new(bytes)).read_info().unwrap();
        let pixels = reader.info().pixel_dims.unwrap();
        assert_eq!((pixels.xppu, pixels.yppu, pixels.unit), (11811, 11811, Unit::Meter));
    }

    #[test]
    fn a_pdf_has_one_page_of_the_figure_s_size_and_its_font() {
        let bytes = convert(&figure("ℓ∞ to bnot"), FigureFormat::Pdf).unwrap();
        assert!(bytes.starts_with(b"%PDF-"));
        let text = String::from_utf8_lossy(&bytes);
        assert_eq!(text.matches("/Type/Page/").count() + text.matches("/Type /Page\n").count(), 1);
        let sides = text.split("/MediaBox").nth(1).unwrap();
        let sides: Vec<f64> = sides[..sides.find(']').unwrap()]
            .split([' ', '[', '\n'])
            .filter_map(|v| v.parse().ok())
            .collect();
        assert!((sides[2] - 510.236).abs() < 0.01 && (sides[3] - 127.559).abs() < 0.01, "{sides:?}");
        assert!(text.contains("Arimo"));
    }

    #[test]
    fn equal_figures_make_equal_bytes() {
        for format in FigureFormat::ALL {
            let bytes = || convert(&figure("n = 300"), format).unwrap();
            assert_eq!(bytes(), bytes(), "{format}");
        }
    }

    #[test]
    fn formats_are_read_by_name_and_what_is_no_figure_is_refused() {
        assert_eq!("PDF".parse(), Ok(FigureFormat::Pdf));
        assert!("eps".parse::<FigureFormat>().unwrap_err().contains("svg, pdf or png"));
        for format in [FigureFormat::Pdf, FigureFormat::Png] {
            assert!(convert("no figure", format).unwrap_err().to_string().contains(format.name()));
        }
    }
}
