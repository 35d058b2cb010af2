#!/usr/bin/env python3
"""Renders the reference scenes with Penumbra and compares every picture with its reference.

Two folders of data are expected, neither of them part of the project:
  BENCH    bench scenes (cornell-grey.pbrt, ...) with gen_bumpy.py beside them and ref/NAME-128.exr, the mean of the
           two independent renders ref/NAME-128-<spp>spp-seed1.exr and -seed2.exr
  SCENES   public scenes, FOLDER/FILE-small.pbrt, with pbrt-ref/FOLDER--FILE-seed{1,2}.exr and, for cornell-box,
           cornell-box/TungstenRender.exr

How noise is known. Ours and the reference are each rendered with independent seeds. A pixel's variance is taken from
its spread over the seeds; a block's is the sum over its pixels, times one factor a picture: the mean over the blocks of
(observed spread of the block's mean / that sum). The factor is 1 where pixels err independently, less where a sampler
spreads errors evenly over neighbours. So hundreds of numbers stand behind each block's error, not two.

What is asked:
  grey      (nothing coloured, so spectral and RGB transport agree) channel means within 0.1 %; z-scores of blocks
            (luminance): none beyond 4.5, standard deviation 0.9-1.1 (a deviation outside that chance explains, within two
            of its own standard errors, is reported and forgiven)
  spectral  (coloured, rendered for thirty wavelengths by spectral_scene.py, as pbrt renders) every block and channel within
            5 standard deviations plus 1 % of the block's strongest channel
  coloured  (the same scenes with --rgb, rendered as Penumbra does: a colour is three numbers) as before, but a fraction that
            depends on how saturated the scene is; what is beyond it here, and not in spectral, is a matter of colour alone
  tungsten  channel means within 0.5 % of an RGB renderer's picture

Writes to OUT: NAME.png (ours | reference | difference over
tiles of 4 pixels: red where ours is brighter, blue where darker, full at 10 %),
the renders, and report.json. Exit status 0 if everything holds, 1 if not, 2 if a render or a file failed.
"""
import argparse
import glob
import json
import os
import shutil
import struct
import subprocess
import sys
import zlib
from dataclasses import dataclass, replace

try:
    import numpy as np
except ImportError:
    sys.exit("compare_references.py needs numpy (Debian: python3-numpy)")

import spectral_scene

LUMINANCE = np.array([0.2126, 0.7152, 0.0722])


@dataclass
class Scene:
    name: str
    kind: str               # grey, coloured (which becomes spectral without --rgb), tungsten
    spp: int                # of ours, each seed
    allowance: float = 0.0  # coloured, with --rgb: fraction of the block's strongest channel
    group: str = "bench"    # bench: in BENCH; public: in SCENES
    block: int = 16         # pixels

    @property
    def file(self):
        return self.name.replace("/", "--")


# Allowances of RGB transport: white, grey and pastel surfaces in white light differ by a few tenths of a per cent;
# saturated ones by a few per cent a bounce in the strong channel (two bounces on the green wall of a Cornell box: 5.6 %).
SCENES = [
    Scene("cornell-grey", "grey", 4096),
    Scene("cornell-glossy-grey", "grey", 4096),
    Scene("bumpy", "grey", 1024),
    Scene("dofmotion", "grey", 4096),
    Scene("cornell", "coloured", 1024, 0.06),
    Scene("cornell-glossy", "coloured", 1024, 0.06),
    Scene("cornell-box/scene-v4", "tungsten", 512, group="public"),
    Scene("cornell-box/scene-v4", "coloured", 512, 0.06, group="public"),
    Scene("veach-mis/scene-v4", "coloured", 512, 0.02, group="public"),
    Scene("coffee/scene-v4", "coloured", 512, 0.06, group="public"),
    Scene("classroom/scene-v4", "coloured", 256, 0.03, group="public"),
    Scene("material-testball/scene-v4", "coloured", 512, 0.03, group="public"),
    Scene("staircase2/scene-v4", "coloured", 256, 0.06, group="public"),
    Scene("cornell-variants/cornell-box-silver", "coloured", 512, 0.06, group="public"),
    Scene("cornell-variants/cornell-box-specular", "coloured", 512, 0.06, group="public"),
    Scene("cornell-variants/smallpt", "coloured", 512, 0.06, group="public"),
    Scene("hair-curl/scene-v4", "coloured", 512, 0.06, group="public"),
    Scene("killeroos/killeroo-simple", "coloured", 256, 0.03, group="public"),
    Scene("killeroos/killeroo-moving", "coloured", 256, 0.03, group="public"),
    Scene("killeroos/killeroo-gold", "coloured", 256, 0.03, group="public"),
    Scene("killeroos/killeroo-coated-gold", "coloured", 256, 0.03, group="public"),
    Scene("veach-mis-colorized/veach-mis-colorized", "coloured", 512, 0.06, group="public"),
]

SPECTRAL_ALLOWANCE = 0.01  # coloured, rendered spectrally
SPECTRAL_SAVING = 8        # a spectral picture is the sum of many copies, each with that many times fewer samples

WIDTH = max(len(s.name) for s in SCENES)


class Failure(Exception):
    """A file is missing or a render went wrong: nothing can be said about the scene."""


# ---- pictures ---------------------------------------------------------------------------------------------------------
def read_rgb(path):
    """The R, G, B channels of an EXR file, float64, height x width x 3."""
    if not os.path.exists(path):
        raise Failure(f"{path}: no such file")
    try:
        import OpenImageIO as oiio
    except ImportError:
        return read_rgb_openexr(path)
    image = oiio.ImageInput.open(path)
    if image is None:
        raise Failure(f"{path}: {oiio.geterror()}")
    spec = image.spec()
    pixels = np.asarray(image.read_image(oiio.FLOAT), np.float64).reshape(spec.height, spec.width, spec.nchannels)
    return pixels[..., [spec.channelnames.index(c) for c in "RGB"]]


def read_rgb_openexr(path):
    try:
        import OpenEXR
    except ImportError:
        sys.exit("compare_references.py needs OpenImageIO (Debian: python3-openimageio) or OpenEXR for Python")
    with OpenEXR.File(path, separate_channels=True) as file:
        return np.stack([np.asarray(file.channels()[c].pixels, np.float64) for c in "RGB"], -1)


def write_png(path, rgb):
    """8-bit RGB, from values already encoded for display, 0 to 1."""
    pixels = (np.clip(rgb, 0, 1) * 255 + 0.5).astype(np.uint8)
    height, width = pixels.shape[:2]

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    rows = b"".join(b"\0" + pixels[y].tobytes() for y in range(height))
    with open(path, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">2I5B", width, height, 8, 2, 0, 0, 0))
                   + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))


def side_by_side(ours, reference):
    white = max(np.percentile(reference, 98), 1e-6)

    def display(x):
        x = np.clip(x / white, 0, 1)
        return np.where(x <= 0.0031308, 12.92 * x, 1.055 * x ** (1 / 2.4) - 0.055)

    y, r = (tiled(x @ LUMINANCE, 4) for x in (ours, reference))
    difference = np.clip((y - r) / (0.1 * (np.abs(r) + 0.01 * np.abs(r).mean() + 1e-12)), -1, 1)
    red, blue = np.maximum(difference, 0), np.maximum(-difference, 0)
    heat = np.stack([1 - blue, 1 - red - blue, 1 - red], -1)
    gap = np.ones((ours.shape[0], 4, 3))
    return np.concatenate([display(ours), gap, display(reference), gap, heat], 1)


def tiled(image, side):
    """Every pixel becomes the mean of its tile, so that differences show through the noise."""
    height, width = image.shape
    padded = np.pad(image, ((0, -height % side), (0, -width % side)), mode="edge")
    means = block_means(padded[..., None], side)[..., 0]
    return means.repeat(side, 0).repeat(side, 1)[:height, :width]


def shrunk(image, height, width):
    """The means of whole groups of pixels; a picture of that size already is itself."""
    fy, fx = image.shape[0] // height, image.shape[1] // width
    if (fy * height, fx * width) != image.shape[:2]:
        raise Failure(f"{image.shape[1]}x{image.shape[0]} is not a multiple of {width}x{height}")
    return image.reshape(height, fy, width, fx, -1).mean((1, 3))


# ---- statistics -------------------------------------------------------------------------------------------------------
def block_means(image, block):
    """Means of block x block pixels; a remainder at the right and the bottom joins no block."""
    rows, columns = image.shape[0] // block, image.shape[1] // block
    whole = image[:rows * block, :columns * block]
    return whole.reshape(rows, block, columns, block, -1).mean((1, 3))


def block_variance(pictures, block):
    """Variance of each block of the mean of independent pictures (the text at the top says how)."""
    k = len(pictures)
    mean = np.mean(pictures, 0)
    pixels = sum((p - mean) ** 2 for p in pictures) / (k * (k - 1))
    independent = block_means(pixels, block) / block ** 2
    blocks = [block_means(p, block) for p in pictures]
    centre = np.mean(blocks, 0)
    observed = sum((b - centre) ** 2 for b in blocks) / (k * (k - 1))
    noisy = independent > 0
    factor = np.mean(observed[noisy] / independent[noisy]) if noisy.any() else 1.0
    return independent * factor, factor


def z_scores(ours, references, block):
    """Per block and channel: difference, its standard deviation, and the factors of both sides."""
    difference = block_means(np.mean(ours, 0) - np.mean(references, 0), block)
    v_ours, f_ours = block_variance(ours, block)
    v_reference, f_reference = block_variance(references, block)
    return difference, np.sqrt(v_ours + v_reference), f_ours, f_reference


def ratio(difference, deviation):
    """Difference in standard deviations; where neither side has noise, equality up to float counts as none."""
    quiet = deviation == 0
    z = difference / np.where(quiet, 1, deviation)
    return np.where(quiet, np.where(np.abs(difference) < 1e-6, 0, np.inf), z)


def judge_grey(scene, ours, references):
    mean, target = np.mean(ours, (0, 1, 2)), np.mean(references, (0, 1, 2))
    off = mean / target - 1
    luminance = [[p[..., None, :] @ LUMINANCE for p in side] for side in (ours, references)]
    result = dict(mean_error=[float(x) for x in off])
    problems = [f"mean of {c} off by {100 * e:+.3f} %" for c, e in zip("RGB", off) if not abs(e) <= 1e-3]
    notes = []
    for block in (scene.block, scene.block // 2):
        difference, deviation, f_ours, f_reference = z_scores(*luminance, block)
        z = ratio(difference, deviation)
        spread, worst = float(np.sqrt(np.mean(z ** 2))), float(np.abs(z).max())
        # of a root mean square of n normal numbers, the factors' own errors included
        chance = spread * np.sqrt((1 + 0.5) / (2 * z.size))
        result[f"z{block}"] = dict(rms=spread, worst=worst, factor_ours=float(f_ours), factor_reference=float(f_reference),
                                   noise=float(np.mean(deviation) / np.mean(references @ LUMINANCE)))
        if not worst <= 4.5:
            problems.append(f"a block of {block} pixels is {worst:.1f} sd off")
        if not 0.9 <= spread <= 1.1:
            beyond = max(0.9 - spread, spread - 1.1)
            text = f"sd of z over blocks of {block} is {spread:.3f} +- {chance:.3f}"
            (problems if not beyond <= 2 * chance else notes).append(text)
    return result, problems, notes


def judge_coloured(scene, ours, references):
    difference, deviation, _, _ = z_scores(ours, references, scene.block)
    strongest = block_means(np.mean(references, 0), scene.block).max(-1, keepdims=True)
    beyond = np.abs(difference) - scene.allowance * np.abs(strongest)
    z = ratio(np.maximum(beyond, 0), deviation)
    row, column, channel = np.unravel_index(np.argmax(np.nan_to_num(z, nan=np.inf)), z.shape)
    relative = np.abs(difference) / np.maximum(strongest, 1e-12)
    mean, target = np.mean(ours, (0, 1, 2)), np.mean(references, (0, 1, 2))
    result = dict(mean_error=[float(x) for x in mean / target - 1], worst=float(z.max()),
                  median_block=float(np.median(relative)), largest_block=float(relative.max()),
                  noise=float(np.mean(deviation / np.maximum(strongest, 1e-12))))
    bad = int(np.count_nonzero(~(z <= 5)))
    problems = [f"{bad} of {z.size} block values beyond 5 sd and {100 * scene.allowance:g} %; the worst, "
                f"{'RGB'[channel]} of block x {column}, y {row}: {difference[row, column, channel]:+.4g} "
                f"of {strongest[row, column, 0]:.4g}"] if bad else []
    return result, problems, []


def judge_tungsten(scene, ours, references):
    off = np.mean(ours, (0, 1, 2)) / np.mean(references, (0, 1, 2)) - 1
    problems = [f"mean of {c} off by {100 * e:+.2f} %" for c, e in zip("RGB", off) if not abs(e) <= 5e-3]
    return dict(mean_error=[float(x) for x in off]), problems, []


JUDGES = dict(grey=judge_grey, coloured=judge_coloured, spectral=judge_coloured, tungsten=judge_tungsten)


# ---- renders ----------------------------------------------------------------------------------------------------------
def writable_bench(bench, out):
    """A copy of the bench scenes with the mesh that bumpy.pbrt refers to, made once."""
    copy = os.path.join(out, "bench")
    mesh = os.path.join(copy, "geometry", "bumpy.ply")
    os.makedirs(os.path.dirname(mesh), exist_ok=True)
    for pattern in ("*.pbrt", "*.inc", "gen_bumpy.py"):
        for file in glob.glob(os.path.join(bench, pattern)):
            shutil.copyfile(file, os.path.join(copy, os.path.basename(file)))
    if not os.path.exists(mesh):
        run([sys.executable, os.path.join(copy, "gen_bumpy.py"), mesh + ".part"])
        os.replace(mesh + ".part", mesh)
    return copy


def run(command):
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    if done.returncode != 0:
        raise Failure(f"{' '.join(command)}: exit status {done.returncode}\n{done.stderr[-2000:]}")


def references_of(scene, args):
    if scene.group == "bench":
        files = [glob.glob(os.path.join(args.bench, "ref", f"{scene.name}-128-*spp-seed{i}.exr")) for i in (1, 2)]
        if not all(files):
            raise Failure(f"{args.bench}/ref: no {scene.name}-128-*spp-seed1.exr and seed2.exr")
        return np.stack([read_rgb(f[0]) for f in files])
    if scene.kind == "tungsten":
        return read_rgb(os.path.join(args.scenes, os.path.dirname(scene.name), "TungstenRender.exr"))[None]
    return np.stack([read_rgb(os.path.join(args.scenes, "pbrt-ref", f"{scene.file}-seed{i}.exr")) for i in (1, 2)])


def render(scene, args, bench, width, height):
    """Our picture, once a seed; one that is there already, of the same scene and sample count, is taken as it is."""
    folder, suffix = (bench, ".pbrt") if scene.group == "bench" else (args.scenes, "-small.pbrt")
    source = os.path.join(folder, scene.name + suffix)
    spectral = scene.kind == "spectral"
    spp = max(1, int(scene.spp * args.quality) // (SPECTRAL_SAVING if spectral else 1))

    def picture_of(source, seed, path):
        if not (args.keep and os.path.exists(path)):
            command = [args.penumbra, "render", source, "-o", path, "--spp", str(spp), "--seed", str(seed), "--quiet",
                       "--resolution", f"{width}x{height}"]
            run(command + (["-t", str(args.threads)] if args.threads else []) + args.extra.split())
        picture = read_rgb(path)
        if not np.isfinite(picture).all():
            raise Failure(f"{path}: {np.count_nonzero(~np.isfinite(picture))} values are not finite")
        return picture

    def spectral_picture_of(seed):
        return spectral_scene.render(source, os.path.join(args.out, scene.file + "-scene"), lambda copy, i: picture_of(
            copy, seed * spectral_scene.COPIES + i, os.path.join(args.out, f"{scene.file}-{spp}spp-seed{seed}-copy{i}.exr")))

    seeds = range(args.seed, args.seed + args.seeds)
    if spectral:
        return np.stack([spectral_picture_of(seed) for seed in seeds])
    return np.stack([picture_of(source, seed, os.path.join(args.out, f"{scene.file}-{spp}spp-seed{seed}.exr")) for seed in seeds])


def compare(scene, args, bench):
    references = references_of(scene, args)
    height, width = references.shape[1:3]
    if scene.kind == "tungsten":
        height, width = 256, 256
        references = shrunk(references[0], height, width)[None]
    ours = render(scene, args, bench, width, height)
    if ours.shape[1:] != references.shape[1:]:
        raise Failure(f"{scene.name}: ours is {ours.shape[2]}x{ours.shape[1]}, the reference {width}x{height}")
    suffix = "-tungsten" if scene.kind == "tungsten" else ""
    write_png(os.path.join(args.out, scene.file + suffix + ".png"), side_by_side(np.mean(ours, 0), np.mean(references, 0)))
    return JUDGES[scene.kind](scene, ours, references)


def line(scene, result):
    means = " ".join(f"{100 * e:+8.3f}" for e in result["mean_error"])
    if scene.kind == "grey":
        more = "  ".join(f"z{b}: sd {z['rms']:.3f} max {z['worst']:.2f} noise {100 * z['noise']:.2f} %"
                         for b, z in ((b, result[f"z{b}"]) for b in (scene.block, scene.block // 2)))
    elif scene.kind in ("coloured", "spectral"):
        more = (f"blocks: median {100 * result['median_block']:.2f} %, largest {100 * result['largest_block']:.2f} %, "
                f"noise {100 * result['noise']:.2f} %; beyond {100 * scene.allowance:g} %: {result['worst']:.1f} sd")
    else:
        more = "TungstenRender"
    return f"{scene.name:<{WIDTH}} {scene.kind:<9} {means}  {more}"


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--penumbra", required=True, help="the program")
    parser.add_argument("--bench", help="folder of the bench scenes; without it they are left out")
    parser.add_argument("--scenes", help="folder of the public scenes; without it they are left out")
    parser.add_argument("--out", required=True, help="folder for pictures and report, made if need be")
    parser.add_argument("--only", default="", help="comma-separated names of scenes, or of their folders")
    parser.add_argument("--seed", type=int, default=1, help="first seed (default 1)")
    parser.add_argument("--seeds", type=int, default=2, help="how many seeds, at least 2 (default 2)")
    parser.add_argument("--quality", type=float, default=1.0, help="factor on all sample counts (default 1)")
    parser.add_argument("-t", "--threads", type=int, help="threads of the renderer")
    parser.add_argument("--keep", action="store_true", help="take renders that are in OUT already")
    parser.add_argument("--rgb", action="store_true", help="render coloured scenes in RGB, not spectrally")
    parser.add_argument("--extra", default="", help="further arguments for every render, in one string")
    args = parser.parse_args()
    if args.seeds < 2:
        parser.error("--seeds must be at least 2: the noise is taken from them")
    known = {name for s in SCENES for name in (s.name, os.path.dirname(s.name)) if name}
    args.only = [n for n in args.only.split(",") if n]
    for name in args.only:
        if name not in known:
            parser.error(f"unknown scene '{name}'; known: {', '.join(sorted(known))}")
    if not args.bench and not args.scenes:
        parser.error("give --bench, --scenes or both")
    return args


def main():
    args = arguments()
    os.makedirs(args.out, exist_ok=True)
    scenes = SCENES if args.rgb else [replace(s, kind="spectral", allowance=SPECTRAL_ALLOWANCE) if s.kind == "coloured" else s
                                      for s in SCENES]
    wanted = [s for s in scenes if (args.bench if s.group == "bench" else args.scenes)
              and (not args.only or {s.name, os.path.dirname(s.name)} & set(args.only))]
    report, failed, broken = [], False, False
    print(f"{'scene':<{WIDTH}} {'kind':<9} {'R %':>8} {'G %':>8} {'B %':>8}")
    bench = None
    for scene in wanted:
        entry = dict(scene=scene.name, kind=scene.kind)
        try:
            if scene.group == "bench" and bench is None:
                bench = writable_bench(args.bench, args.out)
            result, problems, notes = compare(scene, args, bench)
            print(line(scene, result))
            entry.update(result, problems=problems, notes=notes)
            failed |= bool(problems)
        except (Failure, spectral_scene.Unknown) as failure:
            problems, notes, broken = [str(failure)], [], True
            print(f"{scene.name:<{WIDTH}} {scene.kind:<9}")
            entry.update(problems=problems)
        for text in problems:
            print(f"    FAILED: {text}")
        for text in notes:
            print(f"    note: {text}, which chance explains")
        sys.stdout.flush()
        report.append(entry)
    with open(os.path.join(args.out, "report.json"), "w") as file:
        json.dump(report, file, indent=1)
    print("all hold" if not (failed or broken) else "NOT all hold")
    return 2 if broken else 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
