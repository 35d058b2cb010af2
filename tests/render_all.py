#!/usr/bin/env python3
"""Renders every scene of some folders small and says what became of each: a table, and a sheet of the pictures to look at.

A scene is a .pbrt file with a WorldBegin. Each is read (penumbra info), then rendered (penumbra render) with few samples at
its own aspect ratio. Writes to OUT: sheet.png and sheet-2.png, ... (pictures in the order of the table, numbered as in it),
table.txt and report.json. Exit status 0 if every program ended with an exit code of its own (65 and 66, for files that are
wrong or missing, are good answers), 1 where one crashed, hung or alarmed.
"""
import argparse
import json
import os
import re
import subprocess
import sys
import time

try:
    import numpy as np
    import OpenImageIO as oiio
except ImportError:
    sys.exit("render_all.py needs numpy and OpenImageIO (Debian: python3-numpy, python3-openimageio)")

GOOD_ANSWERS = (0, 65, 66)
COLUMNS, ROWS = 8, 6


def scenes_of(folders):
    found = []
    for folder in folders:
        for path, _, files in sorted(os.walk(folder)):
            for file in sorted(files):
                if file.endswith(".pbrt"):
                    with open(os.path.join(path, file), errors="replace") as text:
                        if re.search(r"^\s*WorldBegin", text.read(), re.M):
                            found.append(os.path.join(path, file))
    return found


def run(command, timeout):
    """Exit code (negative: a signal; None: killed for taking too long), standard output, standard error, seconds."""
    start = time.monotonic()
    try:
        done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, timeout=timeout)
        return done.returncode, done.stdout.decode(errors="replace"), done.stderr.decode(errors="replace"), time.monotonic() - start
    except subprocess.TimeoutExpired:
        return None, "", "", time.monotonic() - start


def picture(path, size):
    """The picture, in the middle of a grey square."""
    tile = np.full((size, size, 3), 0.25)
    image = oiio.ImageInput.open(path) if path else None
    if image is None:
        return tile
    spec = image.spec()
    pixels = np.asarray(image.read_image(oiio.FLOAT)).reshape(spec.height, spec.width, spec.nchannels)[:size, :size, :3]
    if pixels.shape[2] == 1:
        pixels = np.repeat(pixels, 3, 2)
    y, x = (size - pixels.shape[0]) // 2, (size - pixels.shape[1]) // 2
    tile[y:y + pixels.shape[0], x:x + pixels.shape[1]] = pixels
    return tile


def write_sheets(tiles, size, out):
    names = []
    for first in range(0, len(tiles), COLUMNS * ROWS):
        page = tiles[first:first + COLUMNS * ROWS]
        page += [np.full((size, size, 3), 1.0)] * (-len(page) % COLUMNS)
        rows = [np.concatenate([np.pad(t, ((1, 1), (1, 1), (0, 0))) for t in page[i:i + COLUMNS]], 1)
                for i in range(0, len(page), COLUMNS)]
        sheet = np.ascontiguousarray(np.concatenate(rows, 0), np.float32)
        names.append(os.path.join(out, f"sheet-{len(names) + 1}.png"))
        file = oiio.ImageOutput.create(names[-1])
        file.open(names[-1], oiio.ImageSpec(sheet.shape[1], sheet.shape[0], 3, "uint8"))
        file.write_image(sheet)
        file.close()
    return names


def render(scene, number, args):
    entry = dict(number=number, scene=scene)
    code, text, errors, seconds = run([args.penumbra, "info", "--json", scene], args.timeout)
    entry.update(code=code, load_seconds=round(seconds, 2), seconds=None, warnings=[], error="", picture="")
    if code != 0:
        entry["error"] = errors.strip().splitlines()[-1] if errors.strip() else ""
        return entry
    about = json.loads(text)
    entry["warnings"] = about["warnings"]
    width, height = about["film"]["resolution"]
    scale = args.size / max(width, height)
    path = os.path.join(args.out, f"{number:03}.png")
    command = [args.penumbra, "render", scene, "-o", path, "--quiet", "--spp", str(args.spp), "--resolution",
               f"{max(1, int(width * scale))}x{max(1, int(height * scale))}"]
    code, _, errors, seconds = run(command + (["-t", str(args.threads)] if args.threads else []), args.timeout)
    entry.update(code=code, seconds=round(seconds, 2))
    if code == 0:
        entry["picture"] = path
    else:
        entry["error"] = errors.strip().splitlines()[-1] if errors.strip() else ""
    return entry


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folders", nargs="+", help="folders, searched to the bottom")
    parser.add_argument("--penumbra", required=True, help="the program")
    parser.add_argument("--out", required=True, help="folder for pictures and report, made if need be")
    parser.add_argument("--size", type=int, default=160, help="the longer side of a picture, in pixels (default 160)")
    parser.add_argument("--spp", type=int, default=16, help="samples per pixel (default 16)")
    parser.add_argument("--timeout", type=float, default=120, help="seconds for each program (default 120)")
    parser.add_argument("-t", "--threads", type=int, help="threads of the renderer")
    args = parser.parse_args()
    os.makedirs(args.out, exist_ok=True)
    entries, tiles, lines = [], [], []
    for number, scene in enumerate(scenes_of(args.folders), 1):
        e = render(scene, number, args)
        entries.append(e)
        tiles.append(picture(e["picture"], args.size))
        end = "hang" if e["code"] is None else str(e["code"])
        said = e["error"] or "; ".join(e["warnings"])
        lines.append(f"{number:4} {end:>4} {e['load_seconds']:7.2f} {e['seconds'] or 0:7.2f}  {scene}  {said}")
        print(lines[-1], flush=True)
    with open(os.path.join(args.out, "table.txt"), "w") as file:
        file.write("\n".join(lines) + "\n")
    with open(os.path.join(args.out, "report.json"), "w") as file:
        json.dump(entries, file, indent=1)
    print("sheets:", *write_sheets(tiles, args.size, args.out))
    bad = [e for e in entries if e["code"] not in GOOD_ANSWERS]
    print(f"{len(entries)} scenes, {sum(e['code'] == 0 for e in entries)} rendered, {len(bad)} crashed, hung or alarmed")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
