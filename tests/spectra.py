"""The spectra that pbrt-v4 makes of the colours in a scene file, and the way back from spectra to linear sRGB.

A colour becomes the sigmoid of a quadratic of the wavelength (Jakob and Hanika, "A Low-Dimensional Function Space for
Efficient Spectral Upsampling", Eurographics 2019). As in pbrt the coefficients come from a table over the colours, each entry
fitted in CIE Lab under D65, and are interpolated linearly. Greys are constants. Curves here are given every nanometre from
360 to 830.
"""
import functools
import os
import re

import numpy as np

DATA = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "core", "color", "data")
WAVELENGTHS = np.arange(360.0, 831.0)
KNOTS = np.arange(360.0, 831.0, 5)
XYZ_TO_SRGB = np.array([[3.240444, -1.537134, -0.498530], [-0.969267, 1.876012, 0.041556], [0.055644, -0.204026, 1.057227]])


# ---- tables -----------------------------------------------------------------------------------------------------------
def numbers_after(file, start):
    """The lists of numbers in braces that follow `start` in a table of core/color/data, up to the end of its entry."""
    with open(os.path.join(DATA, file)) as text:
        body = text.read().partition(start)[2].partition("}}" if start.startswith('"') else "};")[0]
    return [[float(x) for x in curve.split(",") if x.strip()] for curve in re.findall(r"\{([^{}]*)", body) if "," in curve]


@functools.cache
def builtin(name):
    """A spectrum that pbrt knows by name, None if there is none of it."""
    found = numbers_after("builtin_spectra.inc", f'"{name}",')
    return np.interp(WAVELENGTHS, KNOTS, found[0]) if found else None


def piecewise(values):
    """A spectrum given as wavelength, value, wavelength, value, ..."""
    return np.interp(WAVELENGTHS, values[0::2], values[1::2])


def blackbody(kelvin):
    metres = WAVELENGTHS * 1e-9
    return metres ** -5 / np.expm1(0.014387769 / (metres * kelvin))


# ---- spectra to RGB ---------------------------------------------------------------------------------------------------
OBSERVER = np.stack([np.interp(WAVELENGTHS, KNOTS, curve) for curve in numbers_after("observer.inc", "kObserver[3] =")])
D65 = builtin("stdillum-D65") / (OBSERVER[1] @ builtin("stdillum-D65"))
SENSOR = XYZ_TO_SRGB @ (OBSERVER * D65)  # linear sRGB = SENSOR @ (light / D65)


def relative_light(curve):
    """A light's curve as a multiple of D65, its luminance made 1, which is how pbrt takes the spectra of lights."""
    return curve / (OBSERVER[1] @ curve) / D65


def quadrature(count):
    """Wavelengths, and weights (3 x count) with which values there add up to linear sRGB. The values, taken as multiples of
    D65, are thought joined by a natural cubic spline, constant beyond the ends; the curves of the eye and of D65, which are
    not smooth, enter nanometre by nanometre."""
    nodes = np.linspace(385, 735, count)
    h = nodes[1] - nodes[0]
    system = np.diag(np.full(count, 4.0)) + np.diag(np.ones(count - 1), 1) + np.diag(np.ones(count - 1), -1)
    system[0, :2], system[-1, -2:] = (1, 0), (0, 1)
    second = np.zeros((count, count))  # of the splines that are 1 at one node, 0 at the others
    for i in range(1, count - 1):
        second[i, i - 1:i + 2] = np.array([1, -2, 1]) * 6 / h ** 2
    second = np.linalg.solve(system, second)
    x = np.clip(WAVELENGTHS, nodes[0], nodes[-1])
    i = np.minimum(((x - nodes[0]) / h).astype(int), count - 2)
    b = ((x - nodes[i]) / h)[:, None]
    a, one = 1 - b, np.eye(count)
    splines = a * one[i] + b * one[i + 1] + h ** 2 / 6 * ((a ** 3 - a) * second[i] + (b ** 3 - b) * second[i + 1])
    return nodes, SENSOR @ splines


# ---- RGB to spectra ---------------------------------------------------------------------------------------------------
XYZ_OF_RGB = np.linalg.inv(XYZ_TO_SRGB)
WHITE = XYZ_OF_RGB @ SENSOR.sum(1)
SIZE = 64
T = (KNOTS - 360) / 470
BASIS = np.stack([T * T, T, np.ones_like(T)])
COARSE_SENSOR = SENSOR @ np.stack([np.interp(WAVELENGTHS, KNOTS, e) for e in np.eye(KNOTS.size)], 1)


def sigmoid(x):
    return 0.5 + x / (2 * np.sqrt(1 + x * x))


def lab(rgb):
    """CIE Lab of rows of linear sRGB, and its derivatives (rows x 3 x 3)."""
    x = rgb @ XYZ_OF_RGB.T / WHITE
    bright = x > 0.008856
    f = np.where(bright, np.cbrt(x), 7.787 * x + 16 / 116)
    slope = np.where(bright, 1 / (3 * np.maximum(f, 0.1) ** 2), 7.787)
    mix = np.array([[0, 116, 0], [500, -500, 0], [0, 200, -200]])
    return f @ mix.T - [16, 0, 0], mix * slope[:, None, :] @ (XYZ_OF_RGB / WHITE[:, None])


def fit(rgb, start):
    """Coefficients whose spectra have these colours, by Gauss and Newton from a first guess."""
    c, target, live = start.copy(), lab(rgb)[0], np.arange(len(rgb))
    for _ in range(15):
        x = c[live] @ BASIS
        root = np.sqrt(1 + x * x)
        value, outer = lab((0.5 + x / (2 * root)) @ COARSE_SENSOR.T)
        inner = np.stack([(b / (2 * root ** 3)) @ COARSE_SENSOR.T for b in BASIS], 2)
        jacobian, residual = outer @ inner, value - target[live]
        square = np.swapaxes(jacobian, 1, 2) @ jacobian
        damping = 1e-9 * np.trace(square, axis1=1, axis2=2)[:, None, None] * np.eye(3)
        step = np.linalg.solve(square + damping, np.einsum("nij,ni->nj", jacobian, residual)[..., None])[..., 0]
        moved = c[live] - step
        largest = np.abs(moved).max(1, keepdims=True)
        c[live] = moved * np.minimum(1, 200 / np.maximum(largest, 1e-30))
        live = live[np.square(residual).sum(1) > 1e-12]
        if live.size == 0:
            break
    return c


@functools.cache
def table():
    """Nodes of the largest component, and coefficients [which is largest][largest][second next][next][3]."""
    def smooth(t):
        return t * t * (3 - 2 * t)

    nodes = smooth(smooth(np.arange(SIZE) / (SIZE - 1)))
    second, first = (g.ravel() for g in np.meshgrid(np.arange(SIZE) / (SIZE - 1), np.arange(SIZE) / (SIZE - 1), indexing="ij"))
    coefficients = np.zeros((SIZE, 3, SIZE * SIZE, 3))
    middle = SIZE // 5
    for march in (range(middle, SIZE), range(middle - 1, -1, -1)):
        c = coefficients[middle].reshape(-1, 3)
        for k in march:
            colors = np.stack([np.roll(np.stack([np.ones_like(first), first, second], 1), m, axis=1) for m in range(3)])
            c = fit(nodes[k] * colors.reshape(-1, 3), c)
            coefficients[k] = c.reshape(3, -1, 3)
    return nodes, coefficients.transpose(1, 0, 2, 3).reshape(3, SIZE, SIZE, SIZE, 3)


def reflectances(rgb, wavelengths):
    """Albedos at some wavelengths (rows x wavelengths) of rows of colours from 0 to 1."""
    rgb = np.asarray(rgb, float)
    grey = (rgb[:, 0] == rgb[:, 1]) & (rgb[:, 1] == rgb[:, 2])
    result = np.repeat(rgb[:, :1], len(wavelengths), axis=1)
    if grey.all():
        return result
    nodes, coefficients = table()
    largest = rgb.argmax(1)
    rows = np.arange(len(rgb))
    z = rgb[rows, largest]
    scale = (SIZE - 1) / np.where(grey, 1, z)
    x, y = rgb[rows, (largest + 1) % 3] * scale, rgb[rows, (largest + 2) % 3] * scale
    xi, yi = (np.clip(v.astype(int), 0, SIZE - 2) for v in (x, y))
    zi = np.clip(np.searchsorted(nodes, z) - 1, 0, SIZE - 2)
    fractions = (z - nodes[zi]) / (nodes[zi + 1] - nodes[zi]), y - yi, x - xi
    c = 0
    for corner in np.ndindex(2, 2, 2):
        weight = np.prod([f if bit else 1 - f for f, bit in zip(fractions, corner)], axis=0)
        c = c + weight[:, None] * coefficients[largest, zi + corner[0], yi + corner[1], xi + corner[2]]
    t = (np.asarray(wavelengths) - 360) / 470
    spectrum = sigmoid(c @ np.stack([t * t, t, np.ones_like(t)]))
    return np.where(grey[:, None], result, spectrum)


def magnitudes(rgb, wavelengths):
    """The same for colours of any size: lights (as multiples of D65), indices of refraction, coefficients of media."""
    rgb = np.asarray(rgb, float)
    scale = 2 * rgb.max(1, keepdims=True)
    return scale * reflectances(rgb / np.where(scale > 0, scale, 1), wavelengths)
