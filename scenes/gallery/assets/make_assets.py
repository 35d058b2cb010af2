#!/usr/bin/env python3
"""Makes every generated file of this folder: meshes (PLY), images (EXR, PNG) and the parts of scenes that are lists.

    ./make_assets.py

needs Python 3 alone and writes the same bytes each time. The files are in the repository, so only who changes this
script has to run it.
"""

import math
import os
import random
import struct
import zlib

FOLDER = os.path.dirname(os.path.abspath(__file__))


def write(name, data):
    with open(os.path.join(FOLDER, name), "wb") as file:
        file.write(data)


# ---- vectors --------------------------------------------------------------------------------------------------------

def add(a, b):
    return [x + y for x, y in zip(a, b)]


def scaled(a, s):
    return [x * s for x in a]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def unit(a):
    return scaled(a, 1 / math.sqrt(dot(a, a)))


# ---- meshes ---------------------------------------------------------------------------------------------------------

def ply(vertices, quads):
    """A binary PLY of (position, normal, uv) vertices and quadrilaterals."""
    names = "x y z nx ny nz u v".split()
    head = ["ply", "format binary_little_endian 1.0", "element vertex %d" % len(vertices)]
    head += ["property float " + name for name in names]
    head += ["element face %d" % len(quads), "property list uchar int vertex_indices", "end_header", ""]
    body = b"".join(struct.pack("<8f", *p, *n, *uv) for p, n, uv in vertices)
    return "\n".join(head).encode() + body + b"".join(struct.pack("<B4i", 4, *quad) for quad in quads)


def grid_quads(columns, rows, wrap_columns, wrap_rows):
    """Quadrilaterals between vertices numbered row * columns + column."""
    quads = []
    for r in range(rows if wrap_rows else rows - 1):
        for c in range(columns if wrap_columns else columns - 1):
            c1, r1 = (c + 1) % columns, (r + 1) % rows
            quads.append((r * columns + c, r * columns + c1, r1 * columns + c1, r1 * columns + c))
    return quads


def knot(p=2, q=3, around=220, section=18, radius=0.27):
    """A tube round the (p, q) torus knot, about 2.7 wide and standing on z = 0."""
    def centre(t):
        r = 0.66 * (1.5 + 0.55 * math.cos(q * t))
        return [r * math.cos(p * t), r * math.sin(p * t), 0.62 * math.sin(q * t)]

    vertices = []
    for i in range(around):
        t, h = 2 * math.pi * i / around, 1e-4
        c = centre(t)
        along = unit(add(centre(t + h), scaled(centre(t - h), -1)))
        # The torus' own radius spans the section with the tangent: a frame that closes without a twist.
        middle = [0.99 * math.cos(p * t), 0.99 * math.sin(p * t), 0]
        out = add(c, scaled(middle, -1))
        x = unit(add(out, scaled(along, -dot(out, along))))
        y = cross(along, x)
        for j in range(section):
            a = 2 * math.pi * j / section
            n = add(scaled(x, math.cos(a)), scaled(y, math.sin(a)))
            vertices.append((add(c, scaled(n, radius)), n, (i / around, j / section)))
    lowest = min(v[0][2] for v in vertices)
    vertices = [([v[0][0], v[0][1], v[0][2] - lowest], v[1], v[2]) for v in vertices]
    return ply(vertices, grid_quads(section, around, True, True))


def power(x, exponent):
    return math.copysign(abs(x) ** exponent, x)


def superquadric(exponent=0.42, columns=64, rows=33):
    """A rounded cube between -1 and 1 (Barr 1981), with the normals of its equation."""
    vertices = []
    for r in range(rows):
        v = math.pi * (r / (rows - 1) - 0.5)
        for c in range(columns):
            u = 2 * math.pi * c / columns
            cu, su, cv, sv = math.cos(u), math.sin(u), math.cos(v), math.sin(v)
            at = [power(cv, exponent) * power(cu, exponent), power(cv, exponent) * power(su, exponent), power(sv, exponent)]
            k = 2 - exponent
            n = unit([power(cv, k) * power(cu, k), power(cv, k) * power(su, k), power(sv, k)])
            vertices.append((at, n, (c / columns, r / (rows - 1))))
    return ply(vertices, grid_quads(columns, rows, True, False))


def sweep(width=30.0, front=-12.0, back=3.5, radius=3.0, height=12.0, steps=16):
    """A photographer's backdrop: floor, quarter of a cylinder, wall."""
    profile = [(front, 0.0, (0, 0, 1))]
    for i in range(steps + 1):
        a = 0.5 * math.pi * i / steps
        profile.append((back + radius * math.sin(a), radius - radius * math.cos(a), (0, -math.sin(a), math.cos(a))))
    profile.append((back + radius, height, (0, -1, 0)))
    vertices = []
    for i, (y, z, n) in enumerate(profile):
        for side in (0, 1):
            vertices.append(([width * (side - 0.5), y, z], list(n), (side, i / (len(profile) - 1))))
    return ply(vertices, grid_quads(2, len(profile), False, False))


# ---- images ---------------------------------------------------------------------------------------------------------

def exr(size, pixel):
    """A colour EXR of size x size in half floats; blocks of 16 rows, each zlib-compressed after the format's predictor."""
    def attribute(name, kind, value):
        return name.encode() + b"\0" + kind.encode() + b"\0" + struct.pack("<i", len(value)) + value

    def block(first):
        rows = [[pixel(x, y) for x in range(size)] for y in range(first, min(first + 16, size))]
        plain = b"".join(struct.pack("<%de" % size, *(rgb[c] for rgb in row)) for row in rows for c in (2, 1, 0))
        split = plain[0::2] + plain[1::2]
        steps = bytes([split[0]] + [(split[i] - split[i - 1] + 128) & 255 for i in range(1, len(split))])
        packed = zlib.compress(steps, 9)
        return struct.pack("<2i", first, min(len(packed), len(plain))) + min(packed, plain, key=len)

    window = struct.pack("<4i", 0, 0, size - 1, size - 1)
    channels = b"".join(name + b"\0" + struct.pack("<iB3x2i", 1, 0, 1, 1) for name in (b"B", b"G", b"R")) + b"\0"
    header = b"\x76\x2f\x31\x01\x02\0\0\0"
    header += attribute("channels", "chlist", channels) + attribute("compression", "compression", b"\x03")
    header += attribute("dataWindow", "box2i", window) + attribute("displayWindow", "box2i", window)
    header += attribute("lineOrder", "lineOrder", b"\0") + attribute("pixelAspectRatio", "float", struct.pack("<f", 1))
    header += attribute("screenWindowCenter", "v2f", struct.pack("<2f", 0, 0))
    header += attribute("screenWindowWidth", "float", struct.pack("<f", 1)) + b"\0"
    blocks = [block(first) for first in range(0, size, 16)]
    place, offsets = len(header) + 8 * len(blocks), []
    for data in blocks:
        offsets.append(place)
        place += len(data)
    return header + struct.pack("<%dQ" % len(offsets), *offsets) + b"".join(blocks)


def equal_area_direction(s, t):
    """The direction of a place in the equal-area octahedral map (Clarberg 2008), t downwards."""
    u, v = 2 * s - 1, 2 * t - 1
    side = 1 - abs(u) - abs(v)
    r = 1 - abs(side)
    phi = 0.25 * math.pi * (1 + ((abs(v) - abs(u)) / r if r > 0 else 0))
    rho = r * math.sqrt(max(0.0, 2 - r * r))
    return [math.copysign(rho * math.cos(phi), u), math.copysign(rho * math.sin(phi), v),
            math.copysign(1 - r * r, side)]


def environment(size, radiance, samples=4):
    """An environment image; a pixel is the mean over samples x samples directions in it."""
    def pixel(x, y):
        total = [0.0, 0.0, 0.0]
        for j in range(samples):
            for i in range(samples):
                place = (x + (i + 0.5) / samples) / size, (y + (j + 0.5) / samples) / size
                total = add(total, radiance(equal_area_direction(*place)))
        return scaled(total, 1 / samples**2)
    return exr(size, pixel)


def mix(a, b, t):
    t = min(max(t, 0.0), 1.0)
    return [x + (y - x) * t for x, y in zip(a, b)]


def evening_sky(d):
    """A clear evening: the sun low at the left, a warm horizon under a blue zenith, haze below that turns into dark ground."""
    sun = unit([-0.80, 0.45, 0.30])
    towards = dot(d, sun)
    horizon, zenith, ground = [0.86, 0.56, 0.40], [0.09, 0.20, 0.48], [0.07, 0.06, 0.06]
    sky = mix(horizon, zenith, (1.35 * max(d[2], 0.0)) ** 0.7)
    sky = mix(sky, ground, -4 * d[2])
    sky = add(sky, scaled([1.0, 0.52, 0.22], 0.7 * max(0.0, towards) ** 6))
    if towards > math.cos(math.radians(3.0)):
        sky = add(sky, [420.0, 260.0, 120.0])
    return sky


def studio(d):
    """A dark room with a large warm soft box at the left, a cool one at the right and a faint one behind the camera."""
    room = mix([0.05, 0.05, 0.055], [0.20, 0.21, 0.24], 0.5 + 0.5 * d[2])

    def box(direction, half_angle, colour, soft=0.04):
        edge = dot(d, unit(direction)) - math.cos(math.radians(half_angle))
        return scaled(colour, min(max(edge / soft + 0.5, 0.0), 1.0))
    room = add(room, box([-0.9, -0.5, 0.7], 24, [3.6, 3.2, 2.7]))
    room = add(room, box([1.0, -0.3, 0.5], 16, [1.7, 2.2, 3.1]))
    return add(room, box([0.1, -1.0, 0.3], 12, [0.7, 0.7, 0.7]))


def lantern(d):
    """A pierced lantern: three rings of holes round the axis z, in a shell that lets a little light through."""
    turn, glow = math.atan2(d[1], d[0]) / (2 * math.pi), 0.06
    for height, holes, shift in [(0.62, 8, 0.0), (0.15, 12, 0.5), (-0.32, 12, 0.0), (-0.75, 8, 0.5)]:
        across = (turn * holes + shift) % 1 - 0.5
        around = 2 * math.pi / holes * math.sqrt(1 - height * height)
        if math.hypot(across * around, d[2] - height) < 0.16:
            glow = 1.0
    return [glow, glow, glow]


def png(width, height, pixel):
    """An 8-bit RGB or RGBA PNG; pixel(x, y) gives bytes."""
    raw = b"".join(b"\0" + bytes(v for x in range(width) for v in pixel(x, y)) for y in range(height))

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    header = struct.pack(">2I5B", width, height, 8, {3: 2, 4: 6}[len(pixel(0, 0))], 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(raw, 9)) + chunk(b"IEND", b"")


def truchet(cells=8, cell=32):
    """Truchet's tiles: quarter circles that meet across tiles, in a random turn each; repeats in both directions."""
    rng = random.Random(7)
    turned = [[rng.random() < 0.5 for _ in range(cells)] for _ in range(cells)]
    ground, line, rim = (238, 226, 201), (28, 74, 110), (214, 120, 60)

    def shade(fx, fy):
        cx, cy = int(fx) % cells, int(fy) % cells
        x, y = fx - math.floor(fx), fy - math.floor(fy)
        if turned[cy][cx]:
            x = 1 - x
        distance = min(abs(math.hypot(x, y) - 0.5), abs(math.hypot(1 - x, 1 - y) - 0.5))
        return line if distance < 0.13 else rim if distance < 0.19 else ground

    def pixel(px, py):
        total = [0, 0, 0]
        for j in range(3):
            for i in range(3):
                total = add(total, shade((px + (i + 0.5) / 3) / cell, (py + (j + 0.5) / 3) / cell))
        return [round(v / 9) for v in total]
    return png(cells * cell, cells * cell, pixel)


def bumps(size=128):
    """Grey blobs for roughness: a sum of cosines that repeats."""
    waves = [(3, 1, 0.3), (-2, 4, 1.7), (5, -3, 4.0), (1, -6, 2.2), (7, 5, 5.1)]

    def pixel(x, y):
        v = sum(math.cos(2 * math.pi * (a * x + b * y) / size + c) for a, b, c in waves) / len(waves)
        grey = round(255 * min(max(0.5 + 1.1 * v, 0.0), 1.0))
        return [grey, grey, grey]
    return png(size, size, pixel)


def studs(size=64, rim=0.8, radius=1.1):
    """A normal map: the cap of a ball on a flat ground; repeats."""
    def pixel(px, py):
        x, y = 2 * (px + 0.5) / size - 1, 1 - 2 * (py + 0.5) / size
        n = (0.0, 0.0, 1.0)
        if math.hypot(x, y) < rim:
            n = (x / radius, y / radius, math.sqrt(1 - (x * x + y * y) / (radius * radius)))
        return [round(255 * (0.5 + 0.5 * v)) for v in n]
    return png(size, size, pixel)


def leaf(size=96):
    """A leaf upon nothing: colour, and in alpha its outline; the stalk is at the bottom, the tip at the top."""
    def inside(u, v):  # across, in [-1, 1]; along, 0 at the stalk
        if v < 0.12:
            return abs(u) < 0.03
        t = (v - 0.12) / 0.88
        teeth = 0.02 * abs((14 * t) % 1 - 0.5)
        return abs(u) < 1.55 * t ** 0.75 * (1 - t) * (1 - 0.2 * t) + teeth * (t < 0.97)

    def pixel(px, py):
        covered = 0
        for j in range(4):
            for i in range(4):
                covered += inside(2 * (px + (i + 0.5) / 4) / size - 1, 1 - (py + (j + 0.5) / 4) / size)
        u, v = abs(2 * (px + 0.5) / size - 1), 1 - (py + 0.5) / size
        vein = u < 0.025 or abs((v - 0.9 * u) * 9 % 1 - 0.5) < 0.06
        return (112, 142, 56, 255 * covered // 16) if vein else (62, 110, 36, 255 * covered // 16)
    return png(size, size, pixel)


# ---- parts of scenes ------------------------------------------------------------------------------------------------

HEADER = "# Made by make_assets.py.\n"


def flower(count=700):
    """Instances on Vogel's spiral (Vogel 1979), smaller and steeper towards the middle, under two object names."""
    golden = 180 * (3 - math.sqrt(5))
    lines = []
    for i in range(count):
        r, turn = 0.19 * math.sqrt(i + 0.5), i * golden
        size = 0.10 + 0.021 * r
        height = 1.25 * math.exp(-((r / 2.2) ** 2))
        name = "seed" if i < 190 else "petal"
        lines.append('AttributeBegin Rotate %.4f 0 0 1 Translate %.4f 0 %.4f Rotate %.2f 0 1 0 Scale %.4f %.4f %.4f '
                     'ObjectInstance "%s" AttributeEnd'
                     % (turn % 360, r, height, 55 - 16 * r, size, size, size, name))
    return (HEADER + "\n".join(lines) + "\n").encode()


def lock(strands=48, points=10):
    """A lock of hair that hangs from the origin: strands about a common line that winds down."""
    chance = random.Random(7)
    lines = []
    for _ in range(strands):
        angle, r = chance.uniform(0, 2 * math.pi), math.sqrt(chance.random())
        length, lag, stray = chance.uniform(0.9, 1.04), chance.gauss(0, 0.25), chance.gauss(0, 0.03)
        numbers = []
        for k in range(points):
            along = (k - 1) / (points - 3)     # a B-spline begins near its second point
            s = max(along, 0)
            turn, wave = 2 * math.pi * 1.75 * s + lag, 0.075 * s ** 0.8
            near = 0.15 * r * (1 - 0.45 * s)   # to the line
            numbers.append("%.3f %.3f %.3f" % (
                near * math.cos(angle) + wave * math.cos(turn) + stray * s * math.cos(3 * angle),
                near * math.sin(angle) + wave * math.sin(turn) + stray * s * math.sin(5 * angle),
                -1.95 * length * along))
        lines.append('Shape "curve" "string basis" "bspline" "float width0" 0.016 "float width1" 0.006\n'
                     '    "point3 P" [ %s ]' % "  ".join(numbers))
    return (HEADER + "\n".join(lines) + "\n").encode()


def mesh(points, triangles, indent="    "):
    numbers = "  ".join("%.5g %.5g %.5g" % tuple(p) for p in points)
    corners = "  ".join("%d %d %d" % t for t in triangles)
    return 'Shape "trianglemesh"\n%s"point3 P" [ %s ]\n%s"integer indices" [ %s ]\n' % (indent, numbers, indent, corners)


def star(wedges=48):
    """Siemens' star as every other one of 2 x wedges triangles, radius 1."""
    points, triangles = [[0, 0, 0]], []
    for i in range(wedges):
        for end in (2 * i, 2 * i + 1):
            a = math.pi * end / wedges
            points.append([math.cos(a), math.sin(a), 0])
        triangles.append((0, 2 * i + 1, 2 * i + 2))
    return (HEADER + mesh(points, triangles)).encode()


def box(low, high):
    points = [[(low, high)[i >> axis & 1][axis] for axis in range(3)] for i in range(8)]
    faces = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    triangles = [t for a, b, c, d in faces for t in ((a, b, c), (a, c, d))]
    return mesh(points, triangles)


def tribar(n=6):
    """Cubes along three edges of a cube: seen along its diagonal, the ends seem to meet (Reutersvaerd 1934)."""
    cubes = [(i, 0, 0) for i in range(1, n)] + [(n, i, 0) for i in range(n)] + [(n, n, i) for i in range(n + 1)]
    gap = 0.04
    text = "".join(box([v + gap for v in c], [v + 1 - gap for v in c]) for c in cubes)
    return (HEADER + text).encode()


# ---- measured materials ---------------------------------------------------------------------------------------------

def tensor_file(fields):
    """The container of measured materials: (name, shape, numbers) of each field, all floats."""
    heads, body = [], b""
    start = 18 + sum(13 + len(name) + 8 * len(shape) for name, shape, _ in fields)
    for name, shape, numbers in fields:
        heads.append(struct.pack("<H%dsHBQ%dQ" % (len(name), len(shape)), len(name), name.encode(), len(shape), 10,
                                 start + len(body), *shape))
        body += struct.pack("<%df" % len(numbers), *numbers)
    return b"tensor_file\0" + struct.pack("<BBI", 1, 0, len(fields)) + b"".join(heads) + body


def inverted(values, u):
    """Where the integral of the polygon through these values, at 0, 1, 2, ..., is u of the whole."""
    parts = [0.5 * (a + b) for a, b in zip(values, values[1:])]
    left = u * sum(parts)
    for i, part in enumerate(parts):
        if left <= part or i == len(parts) - 1:
            a, b = values[i], values[i + 1]
            root = a + math.sqrt(max(a * a + 2 * left * (b - a), 0))
            return i + min(2 * left / max(root, 1e-30), 1)
        left -= part


def pearl(alpha=0.32, nodes=14, thetas=7, film=760.0):
    """What a gonio-photometer would find of rough metal under a film as thick as light's waves are long: two waves,
    reflected above and below it, that add or cancel by wavelength and angle."""
    wavelengths = [390.0 + 30 * i for i in range(12)]
    at = [i / (nodes - 1) for i in range(nodes)]
    grid = [(x, y) for y in at for x in at]

    def direction(theta, phi):
        return [math.sin(theta) * math.cos(phi), math.sin(theta) * math.sin(phi), math.cos(theta)]

    def facet(place):
        return direction(place[0] ** 2 * math.pi / 2, (2 * place[1] - 1) * math.pi)

    def density(m):
        q = (m[0] * m[0] + m[1] * m[1]) / alpha ** 2 + m[2] * m[2]
        return 1 / (math.pi * alpha ** 2 * q * q)

    def area(w):
        return 0.5 * (w[2] + math.sqrt(alpha ** 2 * (w[0] ** 2 + w[1] ** 2) + w[2] ** 2))

    def reflectance(cosine, nm):
        path = 2 * film * math.sqrt(1.6 ** 2 - 1 + cosine * cosine)
        return 0.52 + 0.4 * math.cos(2 * math.pi * path / nm)

    views = [1.5 * i / (thetas - 1) for i in range(thetas)]
    visible, luminance, spectra = [], [], []
    for theta in views:
        wo = direction(theta, 0)
        seen = [max(dot(wo, facet(p)), 1e-3) * density(facet(p)) * p[0] * math.sin(p[0] ** 2 * math.pi / 2) + 1e-6
                for p in grid]
        visible += seen
        rows = [seen[y * nodes:(y + 1) * nodes] for y in range(nodes)]
        sums = [sum(0.5 * (a + b) for a, b in zip(row, row[1:])) for row in rows]
        found = []
        for x, y in grid:
            place = inverted(sums, y)
            below = min(int(place), nodes - 2)
            line = mix(rows[below], rows[below + 1], place - below)
            found.append(facet((inverted(line, x) / (nodes - 1), place / (nodes - 1))))
        shown = []
        for m in found:
            c = max(dot(wo, m), 0)
            wi = add(scaled(m, 2 * c), scaled(wo, -1))
            masks = 0
            if wi[2] > 0:
                lo, li = area(wo) / wo[2] - 1, area(wi) / wi[2] - 1
                masks = (1 + lo) / (1 + lo + li)
            shown.append((c, masks))
        luminance += [0.5 * masks + 0.02 for _, masks in shown]
        for nm in wavelengths:
            spectra += [reflectance(c, nm) * masks for c, masks in shown]

    count = len(wavelengths)
    return tensor_file([
        ("phi_i", [1], [0.0]), ("theta_i", [thetas], views), ("wavelengths", [count], wavelengths),
        ("ndf", [nodes, nodes], [density(facet(p)) for p in grid]),
        ("sigma", [nodes, nodes], [area(facet(p)) for p in grid]),
        ("vndf", [1, thetas, nodes, nodes], visible), ("luminance", [1, thetas, nodes, nodes], luminance),
        ("spectra", [1, thetas, count, nodes, nodes], spectra)])


def main():
    write("knot.ply", knot())
    write("superquadric.ply", superquadric())
    write("sweep.ply", sweep())
    write("evening.exr", environment(256, evening_sky))
    write("studio.exr", environment(128, studio))
    write("lantern.exr", environment(256, lantern))
    write("truchet.png", truchet())
    write("bumps.png", bumps())
    write("studs.png", studs())
    write("leaf.png", leaf())
    write("flower.pbrt", flower())
    write("lock.pbrt", lock())
    write("star.pbrt", star())
    write("tribar.pbrt", tribar())
    write("pearl.bsdf", pearl())


if __name__ == "__main__":
    main()
