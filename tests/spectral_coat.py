"""What RGB transport gets wrong under a clear coat, in numbers; compare_references.py takes it into account.

Light that has entered a coat is reflected by the base and, from inside, by the coat's surface, again and again. The colour
that leaves is a geometric series in the base's reflectance, whose terms are powers of a spectrum; in RGB they are powers of
three numbers, and where one of them is near 1 the series grows far beyond what any spectrum of that colour gives. So the
same scene has a different colour in a spectral renderer (pbrt-v4), for reasons of colour alone.

equivalent(rgb) is the reflectance with which RGB transport reflects white light from such a coat as spectral transport does
with rgb: for a smooth coat, one reflection from the object. Spectra are those that pbrt makes of a colour (Jakob and Hanika,
"A Low-Dimensional Function Space for Efficient Spectral Upsampling", Eurographics 2019), under D65.
"""
import os
import re

import numpy as np

DATA = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "core", "color", "data", "observer.inc")
WAVELENGTHS = np.arange(360.0, 831.0)
XYZ_TO_SRGB = np.array([[3.240444, -1.537134, -0.498530], [-0.969267, 1.876012, 0.041556], [0.055644, -0.204026, 1.057227]])


def tables(name):
    """The curves of observer.inc, every nanometre."""
    with open(DATA) as file:
        text = file.read()
    body = re.search(name + r"\[3\] = \{(.*?)\};", text, re.S).group(1)
    knots = [[float(x) for x in curve.split(",") if x.strip()] for curve in re.findall(r"\{([^{}]*)\}", body)]
    return [np.interp(WAVELENGTHS, np.arange(360.0, 831.0, 5), curve) for curve in knots]


def daylight(kelvin):
    """CIE 015, from 4000 to 7000 K."""
    x = ((-4.607e9 / kelvin + 2.9678e6) / kelvin + 0.09911e3) / kelvin + 0.244063
    y = (-3 * x + 2.870) * x - 0.275
    m = 0.0241 + 0.2562 * x - 0.7341 * y
    s0, s1, s2 = tables("kDaylight")
    return s0 + (-1.3515 - 1.7703 * x + 5.9114 * y) / m * s1 + (0.03 - 31.4424 * x + 30.0717 * y) / m * s2


def sensor():
    """3 x wavelengths: linear sRGB of a reflectance under D65."""
    observer, white = np.stack(tables("kObserver")), daylight(6504.0)
    return XYZ_TO_SRGB @ observer * white / np.sum(observer[1] * white)


SENSOR = sensor()
XYZ_WHITE = np.linalg.inv(XYZ_TO_SRGB) @ SENSOR.sum(1)


def lab(rgb):
    x = np.maximum(np.linalg.inv(XYZ_TO_SRGB) @ rgb / XYZ_WHITE, 1e-9)
    f = np.where(x > 0.008856, np.cbrt(x), 7.787 * x + 16 / 116)
    return np.array([116 * f[1] - 16, 500 * (f[0] - f[1]), 200 * (f[1] - f[2])])


def spectrum(rgb):
    """A reflectance spectrum of that colour: the sigmoid of a quadratic of the wavelength, fitted in CIE Lab by Gauss and
    Newton, from a dark colour of that hue, whose fit is easy, to the colour itself."""
    t = (WAVELENGTHS - 360) / 470
    basis = np.stack([t * t, t, np.ones_like(t)])

    def curve(c):
        x = c @ basis
        return 0.5 + x / (2 * np.sqrt(1 + x * x))

    c, step = np.zeros(3), 1e-4
    for scale in np.linspace(0.15, 1, 25):
        target = lab(scale * np.asarray(rgb, float))
        for _ in range(30):
            jacobian = np.stack([(lab(SENSOR @ curve(c + d)) - lab(SENSOR @ curve(c - d))) / (2 * step)
                                 for d in step * np.eye(3)], 1)
            change = np.linalg.lstsq(jacobian, target - lab(SENSOR @ curve(c)), rcond=None)[0]
            c = np.clip(c + change * min(1, 20 / max(np.linalg.norm(change), 1e-30)), -200, 200)
            if np.linalg.norm(change) < 1e-6:
                break
    return curve(c)


def hemispherical(eta, count=20000):
    """Mean Fresnel reflectance of diffuse light that comes from outside."""
    cosine = (np.arange(count) + 0.5) / count
    inside = np.sqrt(1 - (1 - cosine ** 2) / eta ** 2)
    parallel = (eta * cosine - inside) / (eta * cosine + inside)
    perpendicular = (cosine - eta * inside) / (cosine + eta * inside)
    return np.mean((parallel ** 2 + perpendicular ** 2) * cosine)


def equivalent(rgb, eta=1.5):
    outside = hemispherical(eta)
    inside = 1 - (1 - outside) / eta ** 2
    through = (1 - outside) * (1 - inside)
    colour = SENSOR @ (through * (s := spectrum(rgb)) / (1 - inside * s))
    colour = np.maximum(colour, 0)
    return colour / (through + inside * colour)
