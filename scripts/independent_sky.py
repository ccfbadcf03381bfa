"""What is behind everything: one radiance, or a picture of all directions, for independent.py."""

import math

import mitsuba as mi
import numpy as np

mi.set_variant("llvm_ad_rgb")
import drjit as dr  # noqa: E402  (wants the variant)

LUMINANCE = [0.2126, 0.7152, 0.0722]


class Sky:
    """Equirectangular: a direction is at u = 1/2 + atan2(x, -z) / 2 pi, v = acos(y) / pi, and has the radiance of the
    texel there, without interpolation. Texels are drawn by luminance times solid angle, places in them evenly by solid
    angle."""

    def __init__(self, text, sun, by_chance):
        self.choice = None
        try:
            texels = np.array([float(c) for c in text.split(",")]).reshape(1, 1, 3)
        except ValueError:
            bitmap = mi.Bitmap(text).convert(mi.Bitmap.PixelFormat.RGB, mi.Struct.Type.Float32, False)
            texels = np.array(bitmap).astype(float)
        self.height, self.width = texels.shape[:2]
        edges = np.cos(np.arange(self.height + 1) / self.height * math.pi)
        size = ((edges[:-1] - edges[1:]) * 2 * math.pi / self.width)[:, None]
        bright = texels @ LUMINANCE
        self.texels = mi.Float(np.ascontiguousarray(texels, np.float32).ravel())
        power = bright * size
        drawn = texels.size > 3 and not by_chance and power.any()
        self.sun = mi.Bool(((bright > sun) & drawn).ravel())  # met by chance it is a part of the sky
        density = bright / power.sum() if drawn else 0 * bright
        self.densities = mi.Float(density.ravel().astype(np.float32))
        if drawn:
            self.choice = mi.DiscreteDistribution2D(power.astype(np.float32))
            self.edges = mi.Float(edges.astype(np.float32))

    def texel(self, d):
        u = 0.5 + dr.atan2(d.x, -d.z) / (2 * dr.pi)
        v = dr.acos(dr.clip(d.y, -1, 1)) / dr.pi
        x = dr.clip(mi.Int32(dr.floor(u * self.width)), 0, self.width - 1)
        y = dr.clip(mi.Int32(dr.floor(v * self.height)), 0, self.height - 1)
        return mi.UInt32(y * self.width + x)

    def eval(self, d, with_sun=True):
        texel = self.texel(d)
        radiance = dr.gather(mi.Color3f, self.texels, texel)
        return radiance if with_sun else dr.select(dr.gather(mi.Bool, self.sun, texel), 0, radiance)

    def density(self, d):
        """Of a direction among those of `draw`."""
        return dr.gather(mi.Float, self.densities, self.texel(d))

    def draw(self, random):
        """(direction, radiance, density, whether it is the sun's) of a direction of the picture."""
        place, _, within = self.choice.sample(mi.Point2f(random.next_float32(), random.next_float32()))
        texel = mi.UInt32(place.y * self.width + place.x)
        top, bottom = dr.gather(mi.Float, self.edges, place.y), dr.gather(mi.Float, self.edges, place.y + 1)
        y = dr.lerp(top, bottom, within.y)
        azimuth = ((place.x + within.x) / self.width - 0.5) * 2 * dr.pi
        r = dr.sqrt(dr.maximum(1 - y * y, 0))
        d = mi.Vector3f(r * dr.sin(azimuth), y, -r * dr.cos(azimuth))
        at = lambda kind, data: dr.gather(kind, data, texel)
        return d, at(mi.Color3f, self.texels), at(mi.Float, self.densities), at(mi.Bool, self.sun)
