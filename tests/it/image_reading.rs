//! Reading of images: every kind of PNG and TIFF gives the same grey plane, and any other file an
//! error.

use conemosaic::image::{
    BitDepth, ImageError, Plane, decode, is_image_path, read, write_grey, write_png, write_tiff,
};
use proptest::prelude::*;
use std::io::Cursor;
use std::path::Path;
use tiff::encoder::{Compression, TiffEncoder, colortype};

/// Width of the test images, in px.
const WIDTH: usize = 5;
/// Height of the test images, in px.
const HEIGHT: usize = 3;

/// Returns a plane of 15 different grey values, in which a swapped row, column or byte would show.
fn greys() -> Vec<u8> {
    (0..WIDTH * HEIGHT).map(|i| (i * 17) as u8).collect()
}

fn expected() -> Plane {
    Plane::from_shape_vec((HEIGHT, WIDTH), greys().iter().map(|&v| f32::from(v) / 255.).collect()).unwrap()
}

fn assert_close(found: &Plane, wanted: &Plane, what: &str) {
    assert_eq!(found.dim(), wanted.dim(), "{what}");
    for (a, b) in found.iter().zip(wanted) {
        assert!((a - b).abs() < 1e-6, "{what}: {found} is not {wanted}");
    }
}

/// PNG files written by hand, with stored (uncompressed) blocks, of any colour type and depth.
mod png {
    fn crc(bytes: &[u8]) -> u32 {
        !bytes.iter().fold(!0u32, |crc, &b| {
            (0..8).fold(crc ^ u32::from(b), |c, _| if c & 1 == 1 { 0xedb8_8320 ^ (c >> 1) } else { c >> 1 })
        })
    }

    fn adler(bytes: &[u8]) -> u32 {
        let (a, b) = bytes.iter().fold((1u32, 0u32), |(a, b), &v| {
            let a = (a + u32::from(v)) % 65521;
            (a, (b + a) % 65521)
        });
        b << 16 | a
    }

    fn chunk(file: &mut Vec<u8>, kind: &[u8; 4], data: &[u8]) {
        file.extend((data.len() as u32).to_be_bytes());
        let start = file.len();
        file.extend(kind);
        file.extend(data);
        file.extend(crc(&file[start..]).to_be_bytes());
    }

    pub fn file(
        size: [u32; 2],
        depth: u8,
        colour: u8,
        extra: &[(&[u8; 4], Vec<u8>)],
        rows: &[Vec<u8>],
    ) -> Vec<u8> {
        let mut file = b"\x89PNG\r\n\x1a\n".to_vec();
        let mut header = Vec::new();
        header.extend(size[0].to_be_bytes());
        header.extend(size[1].to_be_bytes());
        header.extend([depth, colour, 0, 0, 0]);
        chunk(&mut file, b"IHDR", &header);
        for (kind, data) in extra {
            chunk(&mut file, kind, data);
        }
        let raw: Vec<u8> =
            rows.iter().flat_map(|row| std::iter::once(0).chain(row.iter().copied())).collect();
        let length = raw.len() as u16;
        let mut stored = vec![0x78, 0x01, 0x01];
        stored.extend(length.to_le_bytes());
        stored.extend((!length).to_le_bytes());
        stored.extend(&raw);
        stored.extend(adler(&raw).to_be_bytes());
        chunk(&mut file, b"IDAT", &stored);
        chunk(&mut file, b"IEND", &[]);
        file
    }
}

fn png_of(depth: u8, colour: u8, pixel: impl Fn(u8) -> Vec<u8>) -> Vec<u8> {
    let rows: Vec<Vec<u8>> =
        greys().chunks(WIDTH).map(|row| row.iter().flat_map(|&v| pixel(v)).collect()).collect();
    png::file([WIDTH as u32, HEIGHT as u32], depth, colour, &[], &rows)
}

/// A TIFF file written by hand, with one directory and one strip or tile per plane.
struct TiffFile {
    big_endian: bool,
    big_tiff: bool,
    /// Tags and their values. Values above 65535 and offsets are written as LONG, the rest as
    /// SHORT.
    tags: Vec<(u16, Vec<u64>)>,
    chunks: Vec<Vec<u8>>,
    tile: Option<[u64; 2]>,
}

impl TiffFile {
    fn new(bits: &[u64], photometric: u64, chunk: Vec<u8>) -> Self {
        let tags = vec![
            (256, vec![WIDTH as u64]),
            (257, vec![HEIGHT as u64]),
            (258, bits.to_vec()),
            (259, vec![1]),
            (262, vec![photometric]),
            (277, vec![bits.len() as u64]),
        ];
        Self { big_endian: false, big_tiff: false, tags, chunks: vec![chunk], tile: None }
    }

    fn with(mut self, tag: u16, values: &[u64]) -> Self {
        self.tags.retain(|t| t.0 != tag);
        self.tags.push((tag, values.to_vec()));
        self
    }

    fn number(&self, value: u64, bytes: usize) -> Vec<u8> {
        let mut number = value.to_le_bytes()[..bytes].to_vec();
        if self.big_endian {
            number.reverse();
        }
        number
    }

    fn bytes(mut self) -> Vec<u8> {
        let word = if self.big_tiff { 8 } else { 4 };
        let mut file = if self.big_endian { b"MM".to_vec() } else { b"II".to_vec() };
        file.extend(self.number(if self.big_tiff { 43 } else { 42 }, 2));
        if self.big_tiff {
            file.extend(self.number(8, 2));
            file.extend(self.number(0, 2));
        }
        let directory_at = file.len();
        file.extend(vec![0; word]);
        let mut offsets = Vec::new();
        for chunk in &self.chunks {
            offsets.push(file.len() as u64);
            file.extend(chunk);
        }
        let lengths: Vec<u64> = self.chunks.iter().map(|c| c.len() as u64).collect();
        let (offset_tag, length_tag) = if self.tile.is_some() { (324, 325) } else { (273, 279) };
        self.tags.push((offset_tag, offsets));
        self.tags.push((length_tag, lengths));
        if let Some([width, height]) = self.tile {
            self.tags.push((322, vec![width]));
            self.tags.push((323, vec![height]));
        }
        self.tags.sort();
        let mut entries = Vec::new();
        for (tag, values) in &self.tags {
            let long = matches!(tag, 273 | 279 | 324 | 325 | 254);
            let size = if long { 4 } else { 2 };
            let mut data: Vec<u8> = values.iter().flat_map(|&v| self.number(v, size)).collect();
            entries.extend(self.number(u64::from(*tag), 2));
            entries.extend(self.number(if long { 4 } else { 3 }, 2));
            entries.extend(self.number(values.len() as u64, word));
            if data.len() > word {
                let at = file.len() as u64;
                file.extend(&data);
                data = self.number(at, word);
            }
            data.resize(word, 0);
            entries.extend(data);
        }
        let at = self.number(file.len() as u64, word);
        file[directory_at..directory_at + word].copy_from_slice(&at);
        file.extend(self.number(self.tags.len() as u64, if self.big_tiff { 8 } else { 2 }));
        file.extend(entries);
        file.extend(vec![0; word]);
        file
    }
}

fn tiff_written(write: impl FnOnce(&mut TiffEncoder<&mut Cursor<Vec<u8>>>)) -> Vec<u8> {
    let mut file = Cursor::new(Vec::new());
    write(&mut TiffEncoder::new(&mut file).unwrap());
    file.into_inner()
}

#[test]
fn every_kind_of_png_is_read_as_the_same_plane() {
    let wanted = expected();
    let kinds = [
        ("8 bit grey", png_of(8, 0, |v| vec![v])),
        ("8 bit grey with alpha", png_of(8, 4, |v| vec![v, 255])),
        ("8 bit RGB", png_of(8, 2, |v| vec![v, v, v])),
        ("8 bit RGBA", png_of(8, 6, |v| vec![v, v, v, 255])),
        ("16 bit grey", png_of(16, 0, |v| vec![v, v])),
        ("16 bit grey with alpha", png_of(16, 4, |v| vec![v, v, 255, 255])),
        ("16 bit RGB", png_of(16, 2, |v| vec![v; 6])),
        ("16 bit RGBA", png_of(16, 6, |v| [vec![v; 6], vec![255; 2]].concat())),
    ];
    for (what, bytes) in kinds {
        assert_close(&decode(&bytes, what).unwrap(), &wanted, what);
    }
    let palette: Vec<u8> = (0..=255u8).flat_map(|i| [255 - i; 3]).collect();
    let rows: Vec<Vec<u8>> = greys().chunks(WIDTH).map(|r| r.iter().map(|v| 255 - v).collect()).collect();
    let bytes = png::file([WIDTH as u32, HEIGHT as u32], 8, 3, &[(b"PLTE", palette)], &rows);
    assert_close(&decode(&bytes, "palette").unwrap(), &wanted, "palette");
}

#[test]
fn one_bit_png_is_black_and_white() {
    let bytes = png::file([3, 2], 1, 0, &[], &[vec![0b1010_0000], vec![0b0110_0000]]);
    let wanted = Plane::from_shape_vec((2, 3), vec![1., 0., 1., 0., 1., 1.]).unwrap();
    assert_close(&decode(&bytes, "1 bit").unwrap(), &wanted, "1 bit");
}

#[test]
fn colour_becomes_rec_601_luma_and_transparency_becomes_black() {
    let one = |colour, pixel: Vec<u8>| {
        decode(&png::file([1, 1], 8, colour, &[], &[pixel]), "pixel").unwrap()[[0, 0]]
    };
    let luma = (0.299 * 200. + 0.587 * 100. + 0.114 * 50.) / 255.;
    assert!((one(2, vec![200, 100, 50]) - luma).abs() < 1e-6);
    assert!((one(6, vec![200, 100, 50, 51]) - luma / 5.).abs() < 1e-6);
    assert_eq!(one(4, vec![255, 0]), 0.);
}

#[test]
fn every_kind_of_tiff_is_read_as_the_same_plane() {
    let wanted = expected();
    let (w, h) = (WIDTH as u32, HEIGHT as u32);
    let g = greys();
    let each = |channels: &dyn Fn(u8) -> Vec<u8>| g.iter().flat_map(|&v| channels(v)).collect::<Vec<u8>>();
    let wide: Vec<u16> = g.iter().map(|&v| u16::from(v) * 257).collect();
    let float: Vec<f32> = wanted.iter().copied().collect();
    let tiled = |side: usize| {
        let mut tile = vec![0; side * side];
        g.chunks(WIDTH)
            .enumerate()
            .for_each(|(y, row)| tile[y * side..y * side + WIDTH].copy_from_slice(row));
        TiffFile { tile: Some([side as u64; 2]), ..TiffFile::new(&[8], 1, tile) }
    };
    let big_endian_16: Vec<u8> = wide.iter().flat_map(|v| v.to_be_bytes()).collect();
    let planes = [g.clone(), g.clone(), g.clone()];
    let kinds = [
        ("8 bit grey", TiffFile::new(&[8], 1, g.clone()).bytes()),
        ("white is zero", TiffFile::new(&[8], 0, each(&|v| vec![255 - v])).bytes()),
        ("grey with alpha", TiffFile::new(&[8, 8], 1, each(&|v| vec![v, 255])).with(338, &[2]).bytes()),
        (
            "grey with premultiplied alpha",
            TiffFile::new(&[8, 8], 1, each(&|v| vec![v, 9])).with(338, &[1]).bytes(),
        ),
        ("RGBA", TiffFile::new(&[8; 4], 2, each(&|v| vec![v, v, v, 255])).with(338, &[2]).bytes()),
        (
            "planar RGB",
            TiffFile { chunks: planes.to_vec(), ..TiffFile::new(&[8; 3], 2, vec![]) }.with(284, &[2]).bytes(),
        ),
        ("tile", tiled(16).bytes()),
        ("big-endian", TiffFile { big_endian: true, ..TiffFile::new(&[16], 1, big_endian_16) }.bytes()),
        ("BigTIFF", TiffFile { big_tiff: true, ..TiffFile::new(&[8], 1, g.clone()) }.bytes()),
        ("16 bit grey", tiff_written(|t| t.write_image::<colortype::Gray16>(w, h, &wide).unwrap())),
        ("RGB", tiff_written(|t| t.write_image::<colortype::RGB8>(w, h, &each(&|v| vec![v; 3])).unwrap())),
        ("32 bit grey", {
            let values: Vec<u32> = g.iter().map(|&v| u32::from(v) * 0x0101_0101).collect();
            tiff_written(|t| t.write_image::<colortype::Gray32>(w, h, &values).unwrap())
        }),
        ("float", tiff_written(|t| t.write_image::<colortype::Gray32Float>(w, h, &float).unwrap())),
        ("double", {
            let values: Vec<f64> = float.iter().map(|&v| f64::from(v)).collect();
            tiff_written(|t| t.write_image::<colortype::Gray64Float>(w, h, &values).unwrap())
        }),
    ];
    for (what, bytes) in kinds {
        assert_close(&decode(&bytes, what).unwrap(), &wanted, what);
    }
    for (what, compression) in [
        ("LZW in strips", Compression::Lzw),
        ("Deflate in strips", Compression::Deflate(Default::default())),
        ("PackBits in strips", Compression::Packbits),
    ] {
        let mut file = Cursor::new(Vec::new());
        let mut encoder = TiffEncoder::new(&mut file).unwrap().with_compression(compression);
        let mut image = encoder.new_image::<colortype::Gray8>(w, h).unwrap();
        image.rows_per_strip(2).unwrap();
        image.write_data(&g).unwrap();
        assert_close(&decode(file.get_ref(), what).unwrap(), &wanted, what);
    }
}

#[test]
fn palette_tiff_is_looked_up_in_either_byte_order_and_at_any_depth() {
    // ImageJ writes such files; index i stands for grey 255 − 17 i, with 16 bits per entry of the
    // colour map
    let map: Vec<u64> = (0..256).map(|i| (255 - (i * 17) % 256) * 257).collect();
    let wanted = expected().mapv(|v| 1. - v);
    let indexes: Vec<u8> = (0..15).collect();
    for (big_endian, big_tiff) in [(false, false), (true, false), (false, true)] {
        let file = TiffFile { big_endian, big_tiff, ..TiffFile::new(&[8], 3, indexes.clone()) };
        let bytes = file.with(320, &map.repeat(3)).bytes();
        assert_close(&decode(&bytes, "palette").unwrap(), &wanted, "palette");
    }
    let nibbles: Vec<u8> = indexes
        .chunks(WIDTH)
        .flat_map(|row| row.chunks(2).map(|p| p[0] << 4 | p.get(1).copied().unwrap_or(0)).collect::<Vec<_>>())
        .collect();
    let bytes = TiffFile::new(&[4], 3, nibbles.clone()).with(320, &map[..16].repeat(3)).bytes();
    assert_close(&decode(&bytes, "4 bit palette").unwrap(), &wanted, "4 bit palette");
    let bytes = TiffFile::new(&[4], 1, nibbles).bytes();
    assert_close(&decode(&bytes, "4 bit").unwrap(), &expected(), "4 bit");
    let bytes = TiffFile::new(&[8], 3, indexes).with(320, &map).bytes();
    assert!(matches!(decode(&bytes, "short map"), Err(ImageError::Damaged { .. })));
}

#[test]
fn one_bit_tiff_is_black_and_white() {
    let rows = vec![0b1000_1000, 0b0100_0000, 0b0000_1000];
    let wanted = [1., 0., 0., 0., 1., 0., 1., 0., 0., 0., 0., 0., 0., 0., 1.];
    let wanted = Plane::from_shape_vec((HEIGHT, WIDTH), wanted.to_vec()).unwrap();
    assert_close(&decode(&TiffFile::new(&[1], 1, rows).bytes(), "1 bit").unwrap(), &wanted, "1 bit");
}

#[test]
fn float_tiff_keeps_its_values_and_refuses_what_is_not_a_number() {
    let written =
        |values: &[f32]| tiff_written(|t| t.write_image::<colortype::Gray32Float>(2, 2, values).unwrap());
    let plane = decode(&written(&[-3.5, 0., 1e6, 7.]), "float").unwrap();
    assert_eq!(plane.as_slice().unwrap(), [-3.5, 0., 1e6, 7.]);
    for bad in [f32::NAN, f32::INFINITY] {
        let error = decode(&written(&[0., 1., bad, 3.]), "a.tif").unwrap_err();
        assert!(matches!(error, ImageError::NotFinite { x: 0, y: 1, .. }), "{error}");
    }
}

#[test]
fn several_pages_are_an_error_that_counts_them_but_a_thumbnail_is_not_a_page() {
    let g = greys();
    let three = tiff_written(|t| {
        for _ in 0..3 {
            t.write_image::<colortype::Gray8>(WIDTH as u32, HEIGHT as u32, &g).unwrap();
        }
    });
    let message = decode(&three, "stack.tif").unwrap_err().to_string();
    assert!(message.starts_with("stack.tif: holds 3 pages"), "{message}");
    let thumbnail = tiff_written(|t| {
        t.write_image::<colortype::Gray8>(WIDTH as u32, HEIGHT as u32, &g).unwrap();
        let mut small = t.new_image::<colortype::Gray8>(1, 1).unwrap();
        small.encoder().write_tag(tiff::tags::Tag::NewSubfileType, 1u32).unwrap();
        small.write_data(&[7]).unwrap();
    });
    assert_close(&decode(&thumbnail, "thumbnail").unwrap(), &expected(), "thumbnail");
}

#[test]
fn what_is_no_image_is_an_error_of_one_line_that_names_the_file() {
    let jpeg = b"\xff\xd8\xff\xe0 not really";
    let zero_png = png::file([0, 0], 8, 0, &[], &[]);
    let zero_tiff = TiffFile::new(&[8], 1, vec![0]).with(256, &[0]).bytes();
    let huge_png = png::file([100_000, 100_000], 8, 0, &[], &[vec![0]]);
    let huge_tiff = TiffFile::new(&[8], 1, vec![0]).with(256, &[60_000]).with(257, &[60_000]).bytes();
    let twelve_bits = TiffFile::new(&[12], 1, vec![0; 24]).bytes();
    let cmyk = TiffFile::new(&[8; 4], 5, vec![0; 60]).bytes();
    let channels = TiffFile::new(&[8; 5], 1, vec![0; 75]).bytes();
    let cases: [(&[u8], &str); 10] = [
        (b"", "the file is empty"),
        (b"x,y\n1,2\n", "found text"),
        (jpeg, "found a JPEG image"),
        (&zero_png, "0 × 0 px has no pixels"),
        (&zero_tiff, "0 × 3 px has no pixels"),
        (&huge_png, "100000 × 100000 px is too large, since at most 134217728 pixels"),
        (&huge_tiff, "60000 × 60000 px is too large, since at most 134217728 pixels"),
        (&twelve_bits, "12"),
        (&cmyk, "photometric interpretation 5"),
        (&channels, "5 channels"),
    ];
    for (bytes, says) in cases {
        let message = decode(bytes, "folder/a.png").unwrap_err().to_string();
        assert!(message.starts_with("folder/a.png: ") && message.contains(says), "{message}");
        assert!(!message.contains('\n'), "{message}");
    }
    let missing = read(Path::new("no such folder/a.png")).unwrap_err().to_string();
    assert!(missing.starts_with("no such folder/a.png: cannot be read"), "{missing}");
}

#[test]
fn a_file_cut_short_anywhere_is_an_error() {
    let lzw =
        tiff_written(|t| t.write_image::<colortype::Gray8>(WIDTH as u32, HEIGHT as u32, &greys()).unwrap());
    for whole in [png_of(8, 0, |v| vec![v]), lzw] {
        // the last chunk of a PNG and the offset of a TIFF's next page are not needed for the
        // picture, so a file that lacks them may be read
        for length in 0..whole.len() - 20 {
            assert!(decode(&whole[..length], "cut").is_err(), "{length} of {} bytes", whole.len());
        }
    }
}

#[test]
fn names_of_images_are_known_whatever_the_case_of_their_letters() {
    for name in ["a.png", "b.PNG", "c.0.08_x.Tif", "d.TIFF"] {
        assert!(is_image_path(Path::new(name)), "{name}");
    }
    for name in ["png", "a.jpg", "a.png.csv", ".tif"] {
        assert!(!is_image_path(Path::new(name)), "{name}");
    }
}

#[test]
fn grey_planes_survive_writing_and_reading() {
    let folder = tempfile::tempdir().unwrap();
    let plane = Plane::from_shape_fn((7, 11), |(y, x)| (y * 11 + x) as f32 / 76.);
    for (name, depth, step) in [
        ("a.png", BitDepth::Eight, 255.),
        ("b.PNG", BitDepth::Sixteen, 65535.),
        ("c.tif", BitDepth::Eight, 255.),
        ("d.TIFF", BitDepth::Sixteen, 65535.),
    ] {
        let path = folder.path().join(name);
        write_grey(&path, &plane, depth).unwrap();
        let back = read(&path).unwrap();
        let worst = back.iter().zip(&plane).map(|(a, b)| (a - b).abs()).fold(0., f32::max);
        assert!(worst <= 0.5001 / step && worst > 0.1 / step, "{name}: {worst}");
        write_grey(&path, &back, depth).unwrap();
        assert_eq!(read(&path).unwrap(), back, "{name}: a second time changes nothing");
    }
    let left: Vec<_> = std::fs::read_dir(folder.path()).unwrap().collect();
    assert_eq!(left.len(), 4, "nothing is left beside the files");
}

#[test]
fn values_outside_the_range_are_cut_and_those_that_are_no_numbers_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.png");
    write_png(&path, &Plane::from_shape_vec((1, 2), vec![-4., 9.]).unwrap(), BitDepth::Eight).unwrap();
    assert_eq!(read(&path).unwrap().as_slice().unwrap(), [0., 1.]);
    let bad = Plane::from_elem((1, 1), f32::NAN);
    assert!(matches!(write_tiff(&path, &bad, BitDepth::Sixteen), Err(ImageError::NotFinite { .. })));
    assert!(matches!(
        write_png(&path, &Plane::zeros((0, 4)), BitDepth::Eight),
        Err(ImageError::NoPixels { .. })
    ));
    assert!(matches!(
        write_grey(&folder.path().join("a.jpg"), &expected(), BitDepth::Eight),
        Err(ImageError::UnknownExtension { .. })
    ));
    assert_eq!(read(&path).unwrap().as_slice().unwrap(), [0., 1.], "a refused picture leaves the old file");
}

#[test]
fn writing_into_a_folder_that_is_not_there_is_an_error_and_leaves_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("none/a.png");
    let message = write_png(&path, &expected(), BitDepth::Eight).unwrap_err().to_string();
    assert!(message.contains("cannot be written"), "{message}");
    // a folder has the path of the file, so renaming fails after the bytes are written
    let taken = folder.path().join("taken.png");
    std::fs::create_dir_all(taken.join("full")).unwrap();
    assert!(write_png(&taken, &expected(), BitDepth::Eight).is_err());
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
}

#[test]
fn real_images_are_read_as_another_decoder_reads_them() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/data/aoslo");
    if !folder.is_dir() {
        println!("SKIPPED reading of real images: ../shared is not here");
        return;
    }
    let files = walkdir::WalkDir::new(folder).into_iter().filter_map(Result::ok);
    let mut images = 0;
    for file in files.filter(|f| is_image_path(f.path())) {
        let plane = read(file.path()).unwrap();
        let wanted = image::open(file.path()).unwrap().into_luma8();
        assert_eq!(plane.dim(), (wanted.height() as usize, wanted.width() as usize));
        assert!(plane.iter().zip(wanted.as_raw()).all(|(v, &w)| (v * 255. - f32::from(w)).abs() < 1e-4));
        images += 1;
    }
    assert!(images > 300, "{images}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    #[test]
    fn any_bytes_are_an_image_or_an_error(
        start in 0..6usize,
        tail in proptest::collection::vec(any::<u8>(), 0..400),
    ) {
        let signature: &[u8] = [b"".as_slice(), b"\x89PNG\r\n\x1a\n", b"II*\0\x08\0\0\0", b"MM\0*\0\0\0\x08", b"II+\0\x08\0\0\0", b"\xff\xd8\xff"][start];
        let bytes = [signature, &tail].concat();
        let _ = decode(&bytes, "random");
    }

    #[test]
    fn a_sound_file_with_changed_bytes_is_an_image_or_an_error(
        kind in 0..5usize,
        changes in proptest::collection::vec((any::<proptest::sample::Index>(), any::<u8>()), 1..6),
    ) {
        let map: Vec<u64> = (0..768).collect();
        let mut bytes = match kind {
            0 => png_of(8, 2, |v| vec![v, v, v]),
            1 => TiffFile::new(&[8], 3, greys()).with(320, &map).bytes(),
            2 => TiffFile { big_tiff: true, ..TiffFile::new(&[1], 1, vec![3, 4, 5]) }.bytes(),
            3 => TiffFile::new(&[8; 4], 2, vec![0; 60]).with(338, &[2]).bytes(),
            _ => tiff_written(|t| t.write_image::<colortype::Gray16>(5, 3, &[9; 15]).unwrap()),
        };
        for (place, value) in changes {
            let at = place.index(bytes.len());
            bytes[at] = value;
        }
        let _ = decode(&bytes, "changed");
    }
}
