#!/usr/bin/env python3
"""Renders a pbrt-v4 scene spectrally with a renderer that knows three colours.

Penumbra carries three numbers along a path and never mixes them, so they may as well be three wavelengths. A copy of the
scene has every colour replaced by its spectrum at three wavelengths, the one pbrt makes of it (spectra.py); ten such copies
give thirty wavelengths, whose sum through the curves of the eye is what a spectral renderer shows. Geometry, sampling,
materials and filters are the renderer's own, so the sum against pbrt tests those, and against the plain picture it shows what
RGB transport does to the colours.

Known are what colours stand in: rgb, blackbody, spectrum of lights, materials, textures and media; images of textures and of
environments; pigments of hair. Whatever else would be coloured (images that are scaled or that area lights show, dispersion,
colours in imported files) is an error, not a guess. Textures are filtered after they become spectra, in pbrt before.
"""
import argparse
import os
import re
import subprocess
import sys
from dataclasses import dataclass, field

import numpy as np

import spectra

COPIES = 10  # of the scene, three wavelengths each
COLORS = ("rgb", "spectrum", "blackbody")
PARAMETER = re.compile(r"(float|integer|string|bool|rgb|spectrum|blackbody|texture|point[23]?|vector[23]?|normal3?)\s+(\S+)")
LIGHTS = ("LightSource", "AreaLightSource")
MAGNITUDES = ("eta", "k", "conductor.eta", "conductor.k", "sigma_a", "sigma_s", "mfp")
EUMELANIN, PHEOMELANIN = np.array([0.419, 0.697, 1.37]), np.array([0.187, 0.4, 1.05])


class Unknown(Exception):
    """The scene has a colour that this script does not know how to replace."""


@dataclass
class Parameter:
    type: str
    name: str
    values: list
    span: list  # of the text, from the declaration to the end of the values


@dataclass
class Directive:
    word: str
    span: list  # of the text, the word and its strings
    strings: list = field(default_factory=list)
    parameters: list = field(default_factory=list)

    def get(self, name):
        return next((p for p in self.parameters if p.name == name), None)

    def kind(self):
        """The class of a material, light, texture or shape."""
        named = self.get("type")
        return named.values[0] if named else self.strings[-1] if self.strings else ""


def directives_of(text):
    """What a scene file says, in order; values that are no colours stay text."""
    result, target = [], None
    for token in re.finditer(r'#[^\n]*|"(?:[^"\\]|\\.)*"|[\[\]]|[^\s\[\]"#]+', text):
        word = token.group()
        if word[0] == "#":
            continue
        if word == "[":
            open_ = True
        elif word == "]":
            open_, target = False, None
            if result and result[-1].parameters:
                result[-1].parameters[-1].span[1] = token.end()
        elif word[0] == '"' and target is None and (declared := PARAMETER.fullmatch(word[1:-1].strip())):
            target, open_ = Parameter(*declared.groups(), [], [token.start(), token.end()]), False
            result[-1].parameters.append(target)
        elif target is not None:
            target.values.append(word.strip('"'))
            target.span[1] = token.end()
            if not open_:
                target = None
        elif word[0] == '"':
            result[-1].strings.append(word[1:-1])
            result[-1].span[1] = token.end()
        elif word[0].isalpha() and word not in ("true", "false"):
            result.append(Directive(word, [token.start(), token.end()]))
    return result


def curve_of(parameter, folder):
    """What a spectrum or blackbody stands for, every nanometre."""
    first = parameter.values[0]
    if parameter.type == "blackbody":
        return spectra.blackbody(float(first))
    if re.match(r"[-+.\d]", first):
        return spectra.piecewise([float(v) for v in parameter.values])
    if (curve := spectra.builtin(first)) is not None:
        return curve
    return spectra.piecewise(np.loadtxt(os.path.join(folder, first)).ravel())


def triple(directive, parameter, folder, wavelengths):
    """A colour's numbers at three wavelengths."""
    light = directive.word in LIGHTS
    if parameter.type == "rgb":
        rgb = [[float(v) for v in parameter.values]]
        if len(rgb[0]) != 3:
            raise Unknown(f"{directive.word}: '{parameter.name}' is a list of colours")
        large = light or (parameter.name in MAGNITUDES and directive.word != "Texture")
        return (spectra.magnitudes if large else spectra.reflectances)(rgb, wavelengths)[0]
    curve = curve_of(parameter, folder)
    return np.interp(wavelengths, spectra.WAVELENGTHS, spectra.relative_light(curve) if light else curve)


class Images:
    """Images as spectra at some wavelengths. Each distinct colour is converted once; all are read once."""

    def __init__(self):
        self.read = {}

    def colors(self, path):
        """Distinct colours, for each pixel which, and the shape."""
        if path not in self.read:
            import OpenImageIO as oiio
            source = oiio.ImageInput.open(path)
            if source is None:
                raise Unknown(f"{path}: {oiio.geterror()}")
            spec = source.spec()
            pixels = np.asarray(source.read_image(oiio.FLOAT), float).reshape(spec.height * spec.width, spec.nchannels)
            pixels = pixels[:, :3] if spec.nchannels >= 3 else np.repeat(pixels[:, :1], 3, 1)
            if str(spec.format) == "uint8":
                pixels = np.where(pixels <= 0.04045, pixels / 12.92, ((pixels + 0.055) / 1.055) ** 2.4)
            colors, where = np.unique(pixels, axis=0, return_inverse=True)
            self.read[path] = np.maximum(colors, 0), where.ravel(), (spec.height, spec.width)
        return self.read[path]

    def convert(self, path, light, wavelengths, target):
        """Writes the image of three wavelengths; False if all of it is grey, which is its own spectrum."""
        colors, where, (height, width) = self.colors(path)
        if np.ptp(colors, axis=1).max() == 0:
            return False
        values = spectra.magnitudes(colors, wavelengths) if light else spectra.reflectances(np.minimum(colors, 1), wavelengths)
        write_exr(target, values[where].reshape(height, width, 3))
        return True


def write_exr(path, rgb):
    import OpenImageIO as oiio
    output = oiio.ImageOutput.create(path)
    output.open(path, oiio.ImageSpec(rgb.shape[1], rgb.shape[0], 3, oiio.FLOAT))
    output.write_image(np.ascontiguousarray(rgb, np.float32))
    output.close()


UNALTERED = {("Texture", "imagemap"): ("scale", "invert", "encoding"), ("LightSource", "infinite"): ("illuminance",)}


def image_of(directive):
    """The parameter that names an image whose colours count, if any."""
    filename, kind = directive.get("filename"), directive.kind()
    if not filename or directive.word in ("Film", "Shape") or directive.strings[1:2] == ["float"]:
        return None
    if (directive.word, kind) not in UNALTERED:
        raise Unknown(f"{directive.word} \"{kind}\" of a file")
    for name in UNALTERED[directive.word, kind]:
        if directive.get(name):
            raise Unknown(f"{directive.word}: an image with '{name}'")
    return filename


def check(directive):
    """Colours that would silently stay three colours."""
    kind, given = directive.kind(), {p.name for p in directive.parameters}
    material = directive.word in ("Material", "MakeNamedMaterial")
    if directive.word in ("ColorSpace", "Attribute"):
        raise Unknown(directive.word)
    if material and kind in ("conductor", "coatedconductor"):
        prefix = "conductor." if kind == "coatedconductor" else ""
        if "reflectance" not in given and not {prefix + "eta", prefix + "k"} <= given:
            raise Unknown(f"{kind} without eta and k: copper")
    if material and kind == "hair" and not given & {"sigma_a", "reflectance", "color", "eumelanin", "pheomelanin"}:
        raise Unknown("hair without a colour")
    if material and kind not in ("conductor", "coatedconductor") and (eta := directive.get("eta")) and eta.type in COLORS:
        raise Unknown(f"{kind}: dispersion")
    if directive.word == "Texture" and kind == "marble" or directive.get("preset"):
        raise Unknown(f"{directive.word} \"{kind}\"")


def colored_file(directive, folder):
    """The text of an included file with colours in it."""
    if directive.word not in ("Include", "Import"):
        return None
    with open(os.path.join(folder, directive.strings[0])) as file:
        text = file.read()
    if not any(p.type in COLORS for d in directives_of(text) for p in d.parameters):
        return None
    if directive.word == "Import" or os.path.dirname(directive.strings[0]):
        raise Unknown(f"{directive.strings[0]}: colours in a file that is imported or lies in another folder")
    return text


def spectral_text(text, folder, wavelengths, images, out):
    """The scene with colours replaced by their spectra at three wavelengths; new images go to `out`."""
    replaced = []

    def replace(parameter, type_name, values):
        replaced.append((parameter.span, f'"{type_name}" [ {" ".join(f"{v:.9g}" for v in values)} ]'))

    for directive in directives_of(text):
        check(directive)
        if (included := colored_file(directive, folder)) is not None:
            replaced.append((directive.span, spectral_text(included, folder, wavelengths, images, out)))
        for p in directive.parameters:
            if p.type in COLORS:
                replace(p, "rgb " + p.name, triple(directive, p, folder, wavelengths))
        if directive.kind() == "hair":
            pigments = [directive.get("eumelanin"), directive.get("pheomelanin")]
            rgb = sum(float(p.values[0]) * c for p, c in zip(pigments, (EUMELANIN, PHEOMELANIN)) if p)
            for i, p in enumerate(p for p in pigments if p):
                replaced.append((p.span, "")) if i else replace(p, "rgb sigma_a", spectra.magnitudes([rgb], wavelengths)[0])
        if p := image_of(directive):
            target = os.path.join(out, f"image{p.span[0]}.exr")
            if images.convert(os.path.join(folder, p.values[0]), directive.word in LIGHTS, wavelengths, target):
                replaced.append((p.span, f'"string filename" [ "{os.path.basename(target)}" ]'))
    for span, new in sorted(replaced, reverse=True):
        text = text[:span[0]] + new + text[span[1]:]
    return text


def render(source, out, picture_of):
    """The scene `source` in linear sRGB. `picture_of(file, i)` renders the copy i, written below `out`, to an array."""
    nodes, weights = spectra.quadrature(3 * COPIES)
    folder, images, total = os.path.dirname(os.path.abspath(source)), Images(), 0
    os.makedirs(out, exist_ok=True)
    for entry in os.scandir(folder):
        if not entry.name.endswith(".pbrt") and not os.path.lexists(os.path.join(out, entry.name)):
            os.symlink(entry.path, os.path.join(out, entry.name))
    with open(source) as file:
        text = file.read()
    for i in range(COPIES):
        copy = os.path.join(out, os.path.basename(source))
        with open(copy, "w") as file:
            file.write(spectral_text(text, folder, nodes[i::COPIES], images, out))
        total = total + picture_of(copy, i) @ weights[:, i::COPIES].T
    return total


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scene", help="the .pbrt file")
    parser.add_argument("--penumbra", required=True, help="the program")
    parser.add_argument("-o", "--output", required=True, help="EXR to write; a folder of that name with -scene is made beside it")
    parser.add_argument("--spp", type=int, default=16, help=f"samples per pixel of each of the {COPIES} copies (default 16)")
    parser.add_argument("--extra", default="", help="further options of penumbra render, in one string")
    args = parser.parse_args()
    work = os.path.splitext(args.output)[0] + "-scene"

    def picture_of(file, i):
        from compare_references import read_rgb
        path = os.path.join(work, "part.exr")
        subprocess.run([args.penumbra, "render", file, "-o", path, "--spp", str(args.spp), "--seed", str(i + 1), "--quiet",
                        *args.extra.split()], check=True)
        return read_rgb(path)

    try:
        write_exr(args.output, render(args.scene, work, picture_of))
    except Unknown as reason:
        sys.exit(f"{args.scene}: {reason}")


if __name__ == "__main__":
    main()
