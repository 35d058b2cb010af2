#!/usr/bin/env python3
"""Measures the public scenes one by one, and prints a table in Markdown: samples per second beside those of another
renderer, how full the lanes are, what Embree alone would allow, and memory.

SCENES holds FOLDER/FILE-small.pbrt and pbrt-ref/README.md, whose table has a row a scene: folder, scene, resolution, samples,
and the seconds that pbrt-v4 takes for one sample of every pixel. (Those were measured on some other day: the ratio says
which order of magnitude it is, not more.) The machine should be idle; docs/BENCHMARKS.md says how to measure well.
"""
import argparse
import json
import os
import subprocess
import sys


def rows_of(readme):
    """(folder, scene, width, height, seconds for a sample of every pixel)."""
    with open(readme) as file:
        for line in file:
            cells = [c.strip() for c in line.strip().strip("|").split("|")]
            if len(cells) >= 5 and "x" in cells[2] and cells[3].isdigit():
                width, height = (int(x) for x in cells[2].split("x"))
                yield cells[0], cells[1], width, height, float(cells[4])


def measured(program, scene, args):
    command = [os.path.join(args.build, program), scene, "--spp", str(args.spp), "--json"]
    done = subprocess.run(command + (["-t", str(args.threads)] if args.threads else []) + args.extra.split(),
                          stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    if done.returncode != 0:
        sys.exit(f"{' '.join(command)}: exit status {done.returncode}\n{done.stderr[-2000:]}")
    return json.loads(done.stdout)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scenes", help="folder of the public scenes")
    parser.add_argument("--build", required=True, help="folder of render_bench and ray_roof")
    parser.add_argument("--only", default="", help="comma-separated folders of scenes")
    parser.add_argument("--spp", type=int, default=16, help="samples per pixel (default 16)")
    parser.add_argument("--no-roof", action="store_true", help="leave ray_roof out")
    parser.add_argument("-t", "--threads", type=int, help="threads of the renderer")
    parser.add_argument("--extra", default="", help="further arguments for both programs, in one string")
    args = parser.parse_args()
    only = [n for n in args.only.split(",") if n]
    print("| scene | Msamples/s | x pbrt-v4 | rays a sample | live lanes of 8 | of the roof | peak MB |")
    print("| --- | --- | --- | --- | --- | --- | --- |")
    for folder, name, width, height, seconds in rows_of(os.path.join(args.scenes, "pbrt-ref", "README.md")):
        if only and folder not in only:
            continue
        scene = os.path.join(args.scenes, folder, name + "-small.pbrt")
        bench = measured("render_bench", scene, args)
        roof = "" if args.no_roof else f"{measured('ray_roof', scene, args)['fraction_of_roof']['median']:.2f}"
        rate = bench["samples_per_second"]["median"]
        rays = bench["nearest_rays_per_sample"] + bench["shadow_rays_per_sample"]
        print(f"| {folder}/{name} | {rate / 1e6:.2f} | {rate * seconds / (width * height):.1f} | {rays:.1f} "
              f"| {bench['mean_live_lanes']:.1f} | {roof} | {bench['peak_rss_bytes'] / 1e6:.0f} |", flush=True)


if __name__ == "__main__":
    main()
