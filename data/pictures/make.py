"""Writes the pictures of this folder with programs that share no code with moire: tifffile with imagecodecs,
Pillow (libtiff, libwebp) and, for Basis Universal, basisu 1.16. Not needed to build or to test. Sample c of texel (x, y) is code(x, y, c, bits);
floats are whole 64ths of -32 to 32. tests/suite/pictures.rs knows the same formula and what each file is."""
import gzip
import io
import struct
import subprocess

import numpy as np
import tifffile
from PIL import Image

W, H = 21, 18


def codes(samples, bits, w=W, h=H):
    y, x, c = np.meshgrid(np.arange(h), np.arange(w), np.arange(samples), indexing="ij")
    mixed = (x * 73856093 ^ y * 19349663 ^ c * 83492791).astype(np.uint64)
    return ((mixed * 2654435761) % 2**32) >> np.uint64(32 - bits)


def numbers(samples, kind):
    bits = 8 * np.dtype(kind).itemsize
    if np.dtype(kind).kind == "f":
        return ((codes(samples, 12).astype(np.int64) - 2048) / 64).astype(kind)
    return codes(samples, bits).astype(f"u{bits // 8}").view(kind)


def tiff(name, a, **options):
    options.setdefault("metadata", None)
    options.setdefault("software", False)
    options.setdefault("photometric", "rgb" if a.ndim == 3 and a.shape[-1] > 2 else "minisblack")
    if options.get("planarconfig") == "separate":
        a = np.moveaxis(a, -1, 0)
    tifffile.imwrite(f"{name}.tif", a, **options)


def set_tag(data, tag, value):
    page = tifffile.TiffFile(io.BytesIO(data)).pages[0]
    data[page.tags[tag].valueoffset : page.tags[tag].valueoffset + 2] = struct.pack("<H", value)


def reversed_bits(name):
    """FillOrder 2 in place of the tag ResolutionUnit."""
    data = bytearray(open(f"{name}.tif", "rb").read())
    page = tifffile.TiffFile(io.BytesIO(data)).pages[0]
    for start, count in zip(page.dataoffsets, page.databytecounts):
        chunk = np.frombuffer(bytes(data[start : start + count]), np.uint8)
        data[start : start + count] = np.packbits(np.unpackbits(chunk).reshape(-1, 8)[:, ::-1]).tobytes()
    at = page.tags[296].offset
    data[at : at + 2] = struct.pack("<H", 266)
    set_tag(data, 266, 2)
    open(f"{name}.tif", "wb").write(data)


tiff("grey8-packbits", numbers(1, "u1")[..., 0], compression="packbits")
tiff("grey-alpha8-lzw2", numbers(2, "u1"), extrasamples=["unassalpha"], compression="lzw", predictor=2)
tiff("grey16-white", numbers(1, "u2")[..., 0], photometric="miniswhite", compression="lzw")
tiff("grey32-deflate2-be", numbers(1, "u4")[..., 0], compression="zlib", predictor=2, byteorder=">")
tiff("grey-int16-lzw2", numbers(1, "i2")[..., 0], compression="lzw", predictor=2)
tiff("grey-half-deflate3", numbers(1, "f2")[..., 0], compression="zlib", predictor=3)
tiff("grey-float-lzw3-be", numbers(1, "f4")[..., 0], compression="lzw", predictor=3, byteorder=">")
tiff("grey-double-tiled", numbers(1, "f8")[..., 0], compression="zlib", predictor=3, tile=(16, 16))
for bits in [1, 2, 4, 6, 10, 12, 14]:
    kind = "u1" if bits < 8 else "u2"
    tiff(f"grey{bits}", codes(1, bits)[..., 0].astype(kind), bitspersample=bits, rowsperstrip=5)
tiff("grey1-fill2", codes(1, 1)[..., 0].astype("u1"), bitspersample=1)
reversed_bits("grey1-fill2")
tiff("rgb12", codes(3, 12).astype("u2"), bitspersample=12)
tiff("rgb8-x-lzw2", numbers(4, "u1"), extrasamples=["unspecified"], compression="lzw", predictor=2)
tiff("rgb8-xxx-planar", numbers(6, "u1"), extrasamples=["unspecified"] * 3, planarconfig="separate", compression="zlib")
tiff("rgb16-xa-tiled", numbers(5, "u2"), extrasamples=["unspecified", "unassalpha"], tile=(16, 16), compression="zlib", predictor=2)
tiff("rgba8-associated", np.minimum(numbers(4, "u1"), numbers(4, "u1")[..., 3:]), extrasamples=["assocalpha"])
tiff("rgb8-planar-tiled", numbers(3, "u1"), planarconfig="separate", tile=(16, 16), compression="lzw")
tiff("rgb16-planar-strips-be", numbers(3, "u2"), planarconfig="separate", rowsperstrip=7, byteorder=">", compression="lzw", predictor=2)
tiff("rgb-float-big-tiled", numbers(3, "f4"), bigtiff=True, tile=(16, 16), compression="zlib", predictor=3)
tiff("rgb8-fill2-lzw2", numbers(3, "u1"), compression="lzw", predictor=2)
reversed_bits("rgb8-fill2-lzw2")
tiff("cmyk8-x-deflate2", numbers(5, "u1"), photometric="separated", extrasamples=["unspecified"], compression="zlib", predictor=2)
tiff("cmyk16-planar", numbers(4, "u2"), photometric="separated", planarconfig="separate", compression="lzw", predictor=2)
tiff("palette8", codes(1, 6)[..., 0].astype("u1"), photometric="palette", colormap=(codes(3, 16, 256, 1)[0].T).astype("u2"))
y, x = np.mgrid[:H, :W]
gradient = np.stack([10 * x, 12 * y, 5 * (x + y)], -1).astype("u1")
Image.fromarray(gradient).save("rgb8-jpeg.tif", compression="jpeg", quality=95)
Image.fromarray(codes(1, 1)[..., 0].astype(bool)).save("grey1-group4.tif", compression="group4")
with tifffile.TiffWriter("two-pages.tif") as file:
    for a in [numbers(1, "u1")[..., 0], np.zeros((4, 4), np.uint8)]:
        file.write(a, metadata=None, software=False, photometric="minisblack", compression="zlib")

noise = numbers(3, "u1")
Image.fromarray(noise).save("progressive.jpg", progressive=True, quality=80)
Image.fromarray(noise).save("subsampled.jpg", quality=80, subsampling=2)
Image.fromarray(noise).save("rgb.png")
Image.fromarray(codes(1, 4)[..., 0].astype("u1")).convert("P").save("palette.png")
Image.fromarray(noise // 64).save("runs.tga", compression="tga_rle")
rgbe = np.concatenate([noise | 128, noise[..., :1] // 8 + 120], -1)
runs = b"".join(
    b"\2\2" + struct.pack(">H", W) + b"".join(bytes([W]) + line[:, c].tobytes() for c in range(4)) for line in rgbe
)
open("runs.hdr", "wb").write(b"#?RADIANCE\nEXPOSURE=1\nFORMAT=32-bit_rle_rgbe\n\n-Y %d +X %d\n" % (H, W) + runs)
head = b"NRRD0004\ntype: short\ndimension: 4\nsizes: 2 %d %d 1\nencoding: %s\nendian: big\n\n"
volume = numbers(2, "i2").astype(">i2").tobytes()
open("raw.nrrd", "wb").write(head % (W, H, b"raw") + volume)
open("gzip.nrrd", "wb").write(head % (W, H, b"gzip") + gzip.compress(volume, mtime=0))

# WebP and Basis Universal have pictures of their own: tests/suite/containers knows these.
drawn = np.array([[[10 + 50 * x, 20 + 60 * y, (x + y) % 2 * 255, 255 - 40 * x] for x in range(5)] for y in range(3)], "u1")
exif = Image.Exif()
exif[274] = 6
Image.fromarray(drawn).save("lossless.webp", lossless=True, exact=True)
Image.fromarray(drawn).save("turned.webp", lossless=True, exact=True, exif=exif)
Image.fromarray(np.array([[[16 * x, 20 * y, 128] for x in range(16)] for y in range(12)], "u1")).save("lossy.webp", quality=90)
quadrants = [(200, 40, 40, 255), (40, 200, 40, 128), (40, 40, 200, 64), (200, 200, 200, 0)]
four = np.array([[quadrants[(x >= 4) + 2 * (y >= 4)] for x in range(8)] for y in range(8)], "u1")
Image.fromarray(four).save("lossy-alpha.webp", quality=90, exact=True)
frames = [Image.new("RGB", (4, 4), color) for color in ("red", "blue")]
frames[0].save("animated.webp", save_all=True, append_images=frames[1:])
Image.fromarray(four).save("/tmp/four.png")
Image.fromarray(four[..., :3]).save("/tmp/opaque.png")
for name, options in [
    ("etc1s", ["-mipmap", "/tmp/opaque.png"]),
    ("etc1s-alpha", ["/tmp/four.png"]),
    ("uastc", ["-uastc", "-ktx2_no_zstandard", "-linear", "/tmp/four.png"]),
    ("uastc-zstd", ["-uastc", "-mipmap", "/tmp/four.png"]),
]:
    subprocess.run(["basisu", "-ktx2", *options, "-output_file", f"{name}.ktx2"], check=True)
