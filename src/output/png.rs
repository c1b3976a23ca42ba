//! Writes a film as PNG of 8 or 16 bits a channel, sRGB-encoded. Small pictures are encoded by the crate; of large ones,
//! bands of rows are filtered and compressed on all threads, and their streams put one behind the other.

use std::io::{self, Write};
use std::ops::Range;

use flate2::{Compress, Compression, FlushCompress, Status};
use png::EncodingError;
use png::chunk::IDAT;
use rayon::prelude::*;
use simd_adler32::Adler32;

use super::bands::write_bands;
use super::display::Prepared;
use super::png_filter::Filters;
use super::quantise::{srgb8, srgb16};
use super::record::{KEY, SOFTWARE};
use super::{WriteOptions, png_color};
use crate::core::film::Film;

/// Larger pictures are encoded in bands: twice the work of the crate's fast encoder, but shared by all threads.
const MOST_AT_ONCE: usize = 1 << 20;
/// Pixels of a small picture that a thread quantises at once.
const PIXELS_AT_ONCE: usize = 1 << 14;
/// The first bytes of a stream of zlib: deflate with a window of 32 KiB, at the fastest level.
const ZLIB_HEAD: [u8; 2] = [0x78, 0x01];

/// How the integers of a picture are made.
struct Samples {
    display: Prepared,
    /// Bits of an integer: 8 or 16.
    bits: u8,
}

pub(super) fn write(film: &Film, options: &WriteOptions, to: &mut dyn Write) -> Result<(), EncodingError> {
    let samples = Samples { display: options.display.prepare(), bits: options.png_bits };
    let bits = samples.bits;
    let mut encoder = png::Encoder::new(to, film.width, film.height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(if bits == 16 { png::BitDepth::Sixteen } else { png::BitDepth::Eight });
    // Fast deflate takes half the time of the default level at 512² for a few per cent of size.
    encoder.set_compression(png::Compression::Fast);
    encoder.set_filter(png::Filter::Adaptive);
    png_color::describe(options.display.gamut, &mut encoder);
    if let Some(record) = options.record {
        encoder.add_text_chunk("Software".into(), SOFTWARE.into())?;
        encoder.add_text_chunk(KEY.into(), record.into())?;
    }
    let mut writer = encoder.write_header()?;
    png_color::write_chunks(options.display.gamut, &mut writer)?;
    if film.pixels.len() <= MOST_AT_ONCE {
        let mut rows = vec![0; film.pixels.len() * pixel_bytes(bits)];
        rows.par_chunks_mut(PIXELS_AT_ONCE * pixel_bytes(bits))
            .zip(film.pixels.par_chunks(PIXELS_AT_ONCE))
            .for_each(|(rows, pixels)| samples.quantise(pixels, rows));
        writer.write_image_data(&rows)?;
    } else {
        write_large(film, &samples, &mut writer)?;
    }
    writer.finish()
}

fn pixel_bytes(bits: u8) -> usize {
    3 * usize::from(bits) / 8
}

impl Samples {
    /// Writes the integers of some pixels, big-endian as PNG stores them.
    fn quantise(&self, pixels: &[[f32; 3]], to: &mut [u8]) {
        let colors = self.display.colors(pixels);
        let values = colors.as_flattened().iter();
        if self.bits == 16 {
            to.chunks_exact_mut(2)
                .zip(values)
                .for_each(|(to, v)| to.copy_from_slice(&srgb16(*v).to_be_bytes()));
        } else {
            to.iter_mut().zip(values).for_each(|(to, v)| *to = srgb8(*v));
        }
    }
}

/// A band of rows: its integers behind those of the row above it, and what becomes of them.
struct Band {
    rows: Vec<u8>,
    filters: Filters,
    filtered: Vec<u8>,
    deflate: Compress,
    compressed: Vec<u8>,
    is_complete: bool,
}

impl Band {
    fn new() -> Band {
        let [rows, filtered, compressed] = [const { Vec::new() }; 3];
        let deflate = Compress::new(Compression::fast(), false);
        Band { rows, filters: Filters::default(), filtered, deflate, compressed, is_complete: false }
    }

    /// Quantises, filters and compresses some rows. The compressed bytes end at a whole byte, so that those of other
    /// bands can follow.
    fn encode(&mut self, film: &Film, samples: &Samples, rows: Range<usize>) {
        let width = film.width as usize;
        let row_bytes = width * pixel_bytes(samples.bits);
        self.rows.resize(row_bytes * (rows.len() + 1), 0);
        let (above, own) = self.rows.split_at_mut(row_bytes);
        match rows.start.checked_sub(1) {
            Some(row) => samples.quantise(&film.pixels[row * width..][..width], above),
            None => above.fill(0),
        }
        samples.quantise(&film.pixels[rows.start * width..rows.end * width], own);
        self.filtered.clear();
        for (above, row) in
            self.rows.chunks_exact(row_bytes).zip(self.rows[row_bytes..].chunks_exact(row_bytes))
        {
            self.filters.append_best(above, row, pixel_bytes(samples.bits), &mut self.filtered);
        }
        let is_last = rows.end == film.height as usize;
        self.is_complete = deflate(&mut self.deflate, &self.filtered, is_last, &mut self.compressed);
    }
}

/// Compresses some bytes, in place of what was in `to`. They end at a whole byte, and end the stream if they are the last
/// ones. Returns true if all of them are there.
fn deflate(compress: &mut Compress, bytes: &[u8], is_last: bool, to: &mut Vec<u8>) -> bool {
    compress.reset();
    to.clear();
    // Room for all: after a call that fills its buffer where a block ends, the next ones hold back what follows.
    to.reserve(bytes.len() + bytes.len() / 10 + 1024);
    let flush = if is_last { FlushCompress::Finish } else { FlushCompress::Sync };
    let status = compress.compress_vec(bytes, to, flush);
    let wanted = if is_last { Status::StreamEnd } else { Status::Ok };
    status.is_ok_and(|status| status == wanted)
        && compress.total_in() == bytes.len() as u64
        && to.len() < to.capacity()
}

/// Writes the pixels as one chunk a band; the first one begins with the head of the stream, one more ends it.
fn write_large<W: Write>(
    film: &Film,
    samples: &Samples,
    writer: &mut png::Writer<W>,
) -> Result<(), EncodingError> {
    let row_bytes = film.width as usize * pixel_bytes(samples.bits);
    let mut checksum = Adler32::new();
    writer.write_chunk(IDAT, &ZLIB_HEAD)?;
    write_bands(
        film.height as usize,
        row_bytes,
        Band::new,
        |rows, band| band.encode(film, samples, rows),
        |band| {
            if !band.is_complete {
                return Err(io::Error::other("some rows cannot be compressed").into());
            }
            checksum.write(&band.filtered);
            writer.write_chunk(IDAT, &band.compressed)
        },
    )?;
    writer.write_chunk(IDAT, &checksum.finish().to_be_bytes())
}

#[cfg(test)]
mod tests {
    use std::io::Cursor;

    use super::*;

    /// A film of noise, ramps and flat parts, so that each filter is the best one somewhere.
    fn film(width: u32, height: u32) -> Film {
        let mut film = Film::new(width, height, 1);
        let mut rng = fastrand::Rng::with_seed(3);
        for (i, pixel) in film.pixels.iter_mut().enumerate() {
            let (x, y) = (i as f32 / width as f32, (i % width as usize) as f32 / width as f32);
            *pixel = match i / 70_000 % 4 {
                0 => [rng.f32(), rng.f32(), rng.f32()],
                1 => [x % 1.0, y, 0.5],
                2 => [y, (x * 0.001 + y) % 1.0, 0.1 * rng.f32()],
                _ => [0.25; 3],
            };
        }
        film
    }

    /// With a smaller buffer, the ends of bands of some of these lengths were lost.
    #[test]
    fn bands_are_compressed_to_their_last_byte_wherever_blocks_end() {
        let mut rng = fastrand::Rng::with_seed(5);
        let (mut compress, mut compressed) = (Compress::new(Compression::fast(), false), Vec::new());
        for colors in [1, 2, 20, 0] {
            for length in (1..200).chain((57_000..63_000).step_by(100)).chain([250_000]) {
                for is_last in [false, true] {
                    let noise =
                        |rng: &mut fastrand::Rng| if colors == 0 { rng.u8(..) } else { rng.u8(..colors) };
                    let bytes: Vec<u8> = (0..length).map(|_| noise(&mut rng)).collect();
                    assert!(deflate(&mut compress, &bytes, is_last, &mut compressed), "{length}");
                    let mut read = Vec::with_capacity(length + 1);
                    let mut inflate = flate2::Decompress::new(false);
                    let mut ended = false;
                    // A decoder, too, may want to be asked twice.
                    for _ in 0..2 {
                        let rest = &compressed[inflate.total_in() as usize..];
                        let status = inflate.decompress_vec(rest, &mut read, flate2::FlushDecompress::None);
                        ended = matches!(status, Ok(Status::StreamEnd));
                    }
                    assert!(read == bytes, "{} of {length} bytes", read.len());
                    assert_eq!((ended, inflate.total_in()), (is_last, compressed.len() as u64), "{length}");
                }
            }
        }
    }

    #[test]
    fn pictures_are_read_as_they_were_quantised_however_they_are_compressed() {
        for [width, height] in [[64, 50], [1100, 1001], [1 << 20, 2], [3, 400_000]] {
            for bits in [8, 16] {
                let film = film(width, height);
                let mut file = Vec::new();
                let options = WriteOptions { png_bits: bits, ..WriteOptions::default() };
                write(&film, &options, &mut file).unwrap();
                let mut reader = png::Decoder::new(Cursor::new(file)).read_info().unwrap();
                let mut read = vec![0; reader.output_buffer_size().unwrap()];
                reader.next_frame(&mut read).unwrap();
                reader.finish().unwrap();
                let mut expected = vec![0; read.len()];
                let samples = Samples { display: options.display.prepare(), bits };
                samples.quantise(&film.pixels, &mut expected);
                assert!(read == expected, "{width}×{height}, {bits} bits");
            }
        }
    }
}
