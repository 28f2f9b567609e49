//! File format of `curves.bin`: first [`MAGIC`], then a hash of the settings with which the curves
//! were made (the fingerprint), then one entry per curve, all entries compressed together by zlib.
//!
//! 1. An entry begins with the three fields of its [`Key`] and the number of patterns averaged, one
//!    byte each.
//! 2. The regularity index follows as an `f64`, which is NaN if the index is undefined.
//! 3. The values of g follow as second differences, in units of [`STEP`]. Each difference is
//!    zigzag-coded (0, −1, 1, −2, … become 0, 1, 2, 3, …) and split into groups of seven bits, the
//!    lowest first. The top bit of a byte is set if another byte follows.
//!
//! A smooth curve thus takes about one byte per value of g.

use flate2::{Compression, read::ZlibDecoder, write::ZlibEncoder};
use std::collections::HashMap;
use std::io::{Read, Write};

/// Rounding step of g, a hundredth of the noise that remains in the mean curves of Poisson disks
/// (see [`References`](super::References)).
pub(super) const STEP: f64 = 1e-4;
/// First bytes of the file: name and version of the format.
const MAGIC: &[u8] = b"curves 1";

/// Key of an entry in the table of shipped curves.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) struct Key {
    /// Class of the number of points, as an exponent of 1.2.
    pub(super) n: i8,
    /// Class of the aspect ratio, as an exponent of 1.2.
    pub(super) aspect: i8,
    /// Index of the sampler among the default samplers.
    pub(super) sampler: u8,
}

/// Curve in the table of shipped curves.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Entry {
    /// Number of patterns averaged.
    pub(super) realisations: u8,
    /// Mean regularity index of the patterns; `None` if it is undefined.
    pub(super) ri: Option<f64>,
    /// Values of g at the default distances.
    pub(super) g: Vec<f64>,
}

/// Returns the bytes of `curves.bin` for a table of `entries`.
pub(super) fn write(entries: &[(Key, Entry)], fingerprint: &[u8; 32]) -> Vec<u8> {
    let mut body = Vec::new();
    for (key, entry) in entries {
        body.extend([key.n.to_le_bytes()[0], key.aspect.to_le_bytes()[0], key.sampler, entry.realisations]);
        body.extend(entry.ri.unwrap_or(f64::NAN).to_le_bytes());
        let (mut value, mut slope) = (0i64, 0i64);
        for g in &entry.g {
            let next = (g / STEP).round() as i64;
            put(&mut body, next - value - slope);
            (value, slope) = (next, next - value);
        }
    }
    let head = [MAGIC, fingerprint].concat();
    let mut encoder = ZlibEncoder::new(head.clone(), Compression::best());
    // writing to memory cannot fail
    let packed = encoder.write_all(&body).and_then(|()| encoder.finish());
    packed.unwrap_or(head)
}

/// Reads a table in which every curve has `bins` values. Returns `None` if the bytes are damaged or
/// contain another fingerprint.
pub(super) fn read(bytes: &[u8], fingerprint: &[u8; 32], bins: usize) -> Option<HashMap<Key, Entry>> {
    let packed = bytes.strip_prefix(MAGIC)?.strip_prefix(fingerprint)?;
    let mut body = Vec::new();
    ZlibDecoder::new(packed).read_to_end(&mut body).ok()?;
    let mut rest = body.as_slice();
    let mut entries = HashMap::new();
    while !rest.is_empty() {
        let [n, aspect, sampler, realisations] = take(&mut rest)?;
        let ri = Some(f64::from_le_bytes(take(&mut rest)?)).filter(|ri| !ri.is_nan());
        let mut g = Vec::with_capacity(bins);
        let (mut value, mut slope) = (0i64, 0i64);
        for _ in 0..bins {
            slope = slope.checked_add(number(&mut rest)?)?;
            value = value.checked_add(slope)?;
            g.push(value as f64 * STEP);
        }
        let key = Key { n: i8::from_le_bytes([n]), aspect: i8::from_le_bytes([aspect]), sampler };
        entries.insert(key, Entry { realisations, ri, g });
    }
    Some(entries)
}

/// Takes the first `N` bytes off `rest`; `None` if `rest` is shorter.
fn take<const N: usize>(rest: &mut &[u8]) -> Option<[u8; N]> {
    let (first, after) = rest.split_first_chunk()?;
    *rest = after;
    Some(*first)
}

/// Appends a number in zigzag coding and groups of seven bits. Numbers from −64 to 63 take one
/// byte.
fn put(body: &mut Vec<u8>, number: i64) {
    let mut zigzag = ((number << 1) ^ (number >> 63)) as u64;
    while zigzag >= 0x80 {
        body.push(zigzag as u8 | 0x80);
        zigzag >>= 7;
    }
    body.push(zigzag as u8);
}

/// Takes a number that [`put`] wrote off `rest`. Returns `None` if the number is cut short or has
/// more than ten bytes.
fn number(rest: &mut &[u8]) -> Option<i64> {
    let mut zigzag = 0u64;
    for shift in (0..64).step_by(7) {
        let [byte] = take(rest)?;
        zigzag |= u64::from(byte & 0x7f) << shift;
        if byte < 0x80 {
            return Some((zigzag >> 1) as i64 ^ -((zigzag & 1) as i64));
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    fn entries() -> Vec<(Key, Entry)> {
        let g = |k: u8| (0..20).map(|i| f64::from(i * u32::from(k)) * 0.37).collect();
        let entry = |k: u8| Entry { realisations: k, ri: (k > 1).then_some(1.5), g: g(k) };
        [(-4, 1), (0, 7), (4, 200)].map(|(aspect, k)| (Key { n: 20, aspect, sampler: k }, entry(k))).to_vec()
    }

    #[test]
    fn entries_come_back_rounded() {
        let bytes = write(&entries(), &[3; 32]);
        let found = read(&bytes, &[3; 32], 20).unwrap();
        for (key, entry) in entries() {
            let back = &found[&key];
            assert_eq!((back.realisations, back.ri), (entry.realisations, entry.ri));
            assert!(back.g.iter().zip(&entry.g).all(|(a, b)| (a - b).abs() <= 0.5001 * STEP));
        }
        assert_eq!(found.len(), 3);
    }

    #[test]
    fn another_fingerprint_or_damage_is_no_table() {
        let bytes = write(&entries(), &[3; 32]);
        assert!(read(&bytes, &[4; 32], 20).is_none());
        assert!(read(&bytes[..bytes.len() - 9], &[3; 32], 20).is_none());
        assert!(read(&bytes, &[3; 32], 21).is_none());
        assert!(read(b"", &[3; 32], 20).is_none());
    }
}
