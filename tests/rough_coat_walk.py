#!/usr/bin/env python3
"""Why pictures of rough coats differ from those of pbrt-v4: a walk between a rough dielectric coat and a Lambertian base, in
three estimators of what leaves in a given direction (no part of the renderer, and nothing in common with it).

  exit     every event at the base looks for the way out by a direction sampled backwards from outside
  both     that, and the base's own direction, weighed by the power heuristic with both densities of directions inside
  pbrt     the same with pbrt-v4's second density: it takes that of leaving in the outer direction, given the inner one, in
           the place of the inner direction's given the outer one, so that the weights do not add up to one

Prints f of the part that has met the base, for some pairs of directions. The first two have to agree.
"""
import argparse

import numpy as np

ETA, THICKNESS, REFLECTANCE, BASE_EVENTS = 1.5, 0.01, 0.5, 5


def normalized(v):
    return v / np.linalg.norm(v, axis=-1, keepdims=True)


class Coat:
    """A rough dielectric (GGX), index ETA below, 1 above; directions point away from it."""

    def __init__(self, alpha, random):
        self.alpha, self.random = alpha, random

    def shadowing(self, w):
        c2 = w[:, 2] ** 2
        return (np.sqrt(1 + self.alpha ** 2 * (1 - c2) / np.maximum(c2, 1e-20)) - 1) / 2

    def facets(self, m):
        c2 = m[:, 2] ** 2
        return 1 / (np.pi * self.alpha ** 2 * (c2 + (1 - c2) / self.alpha ** 2) ** 2)

    def visible(self, w, m):
        return self.facets(m) * np.abs((w * m).sum(1)) / (np.abs(w[:, 2]) * (1 + self.shadowing(w)))

    def sample_facet(self, w):
        """A visible normal, on the upper side (Heitz, JCGT 2018)."""
        n = len(w)
        w = np.where(w[:, 2:] < 0, -w, w)
        v = normalized(w * [self.alpha, self.alpha, 1])
        t1 = normalized(np.stack([-v[:, 1], v[:, 0], np.zeros(n)], 1) + [1e-12, 0, 0])
        t2 = np.cross(v, t1)
        r, phi = np.sqrt(self.random.random(n)), 2 * np.pi * self.random.random(n)
        x, y, s = r * np.cos(phi), r * np.sin(phi), (1 + v[:, 2]) / 2
        y = (1 - s) * np.sqrt(1 - x * x) + s * y
        h = x[:, None] * t1 + y[:, None] * t2 + np.sqrt(np.maximum(0, 1 - x * x - y * y))[:, None] * v
        return normalized(np.stack([self.alpha * h[:, 0], self.alpha * h[:, 1], np.maximum(h[:, 2], 1e-6)], 1))

    @staticmethod
    def fresnel(cosine, eta):
        sin2 = (1 - cosine * cosine) / eta ** 2
        refracted = np.sqrt(np.maximum(1 - sin2, 0))
        a, b = (eta * cosine - refracted) / (eta * cosine + refracted), (cosine - eta * refracted) / (cosine + eta * refracted)
        return np.where(sin2 >= 1, 1, (a * a + b * b) / 2)

    def transmission(self, wo, wi, radiance):
        """f of light from wi to wo, and the density of wi given wo (Walter et al., EGSR 2007)."""
        eta = np.where(wo[:, 2] > 0, ETA, 1 / ETA)
        m = normalized(wi * eta[:, None] + wo)
        m = np.where(m[:, 2:] < 0, -m, m)
        i, o = (m * wi).sum(1), (m * wo).sum(1)
        ok = (wo[:, 2] * wi[:, 2] < 0) & (i * wi[:, 2] > 0) & (o * wo[:, 2] > 0)
        stretch = np.abs(i) / (i + o / eta) ** 2
        f = self.facets(m) * (1 - self.fresnel(np.abs(o), eta)) * stretch * np.abs(o / (wi[:, 2] * wo[:, 2]))
        f /= 1 + self.shadowing(wo) + self.shadowing(wi)
        return np.where(ok, f / eta ** 2 if radiance else f, 0), np.where(ok, self.visible(wo, m) * stretch, 0)

    def sample_transmission(self, wo, radiance):
        eta, m = np.where(wo[:, 2] > 0, ETA, 1 / ETA), self.sample_facet(wo)
        m = np.where(wo[:, 2:] > 0, m, -m)
        c = (wo * m).sum(1)
        sin2 = (1 - c * c) / eta ** 2
        wi = -wo / eta[:, None] + (c / eta - np.sqrt(np.maximum(1 - sin2, 0)))[:, None] * m
        f, pdf = self.transmission(wo, wi, radiance)
        return wi, f, pdf, (sin2 < 1) & (pdf > 0)

    def reflect(self, w):
        """From below: a direction, and weight f cos / density."""
        m = -self.sample_facet(w)
        c = (w * m).sum(1)
        wi = 2 * c[:, None] * m - w
        weight = self.fresnel(c, 1 / ETA) * (1 + self.shadowing(w)) / (1 + self.shadowing(w) + self.shadowing(wi))
        return wi, np.where(wi[:, 2] < 0, weight, 0)


def walk(coat, wo, wi, count, estimator):
    wo, wi = np.tile(wo, (count, 1)), np.tile(wi, (count, 1))

    def through(w):
        return np.exp(-THICKNESS / np.abs(w[:, 2]))

    w, f, pdf, entered = coat.sample_transmission(wo, True)
    beta = np.where(entered, f * np.abs(w[:, 2]) / np.maximum(pdf, 1e-30), 0)
    out, f_out, pdf_out, found = coat.sample_transmission(wi, False)
    total = np.zeros(count)
    for _ in range(BASE_EVENTS):
        beta = beta * through(w)
        cosine = np.abs(out[:, 2])
        weight = 1 if estimator == "exit" else pdf_out ** 2 / (pdf_out ** 2 + (cosine / np.pi) ** 2)
        direct = REFLECTANCE / np.pi * cosine * through(out) * f_out / np.maximum(pdf_out, 1e-30)
        total += np.where(found, beta * weight * direct, 0)
        r, phi = np.sqrt(coat.random.random(count)), 2 * np.pi * coat.random.random(count)
        up = np.stack([r * np.cos(phi), r * np.sin(phi), np.sqrt(1 - r * r)], 1)
        beta = beta * REFLECTANCE * through(up)
        if estimator != "exit":
            f, p = coat.transmission(-up, wi, True)
            if estimator == "both":
                p = coat.transmission(wi, -up, False)[1]
            own = up[:, 2] / np.pi
            total += beta * f * own ** 2 / (own ** 2 + p ** 2)
        w, weight = coat.reflect(-up)
        beta = beta * weight
    parts = total.reshape(20, -1).mean(1)
    return parts.mean(), parts.std() / np.sqrt(len(parts) - 1)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--alpha", type=float, default=np.sqrt(0.15), help="roughness of the coat (default sqrt 0.15)")
    parser.add_argument("--count", type=int, default=400000, help="walks for each number, a multiple of 20")
    args = parser.parse_args()
    print("directions (degrees)   exit              both              pbrt              pbrt / exit")
    for out, into in ((20, 30), (45, 60), (60, 20)):
        a, b = np.radians(out), np.radians(into)
        wo, wi = np.array([np.sin(a), 0, np.cos(a)]), np.array([-np.sin(b), 0, np.cos(b)])
        results = [walk(Coat(args.alpha, np.random.default_rng(1)), wo, wi, args.count, e) for e in ("exit", "both", "pbrt")]
        print(f"{out:3} {into:3}               ", *(f"{m:.5f} +- {s:.5f}" for m, s in results), f"{results[2][0] / results[0][0]:.3f}")


if __name__ == "__main__":
    main()
