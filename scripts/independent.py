#!/usr/bin/env python3
"""Path traces a scene of `conelab scene SCENE --export FILE.gltf` with Mitsuba 3 and compares what it finds with
`conelab reference`, bounce by bounce. Nothing here comes from conelab: the file is read by itself, rays are traced by
Embree through Mitsuba, directions are drawn by Mitsuba's own warps and visible-normal distribution, and the BRDF is
written from the papers.

    pip install mitsuba numpy openexr    # tried: 3.9.1 with LLVM 19 and 22, DRJIT_LIBLLVM_PATH=/path/to/libLLVM.so.19.1
    conelab scene cornell --export cornell.gltf
    for k in 1 2 3; do conelab reference configs/rays.ron --scene cornell --size 128x96 --set pixel=box \\
        --bounces $k --spp 2048; done           # each says the folder it keeps its samples in
    python3 scripts/independent.py cornell.gltf --size 128x96 --spp 2048 --against FOLDER1 FOLDER2 FOLDER3

The sky is not part of glTF: --sky 0.5,0.68,0.95 gives its radiance, --sky FILE.sky.exr the picture that the exporter
writes beside the scene, or another. With --sun L what is brighter in it is a sun: light, of which `conelab reference`
counts what a surface reflects with that surface's direct light, and not with what the next ray brings.

Places on emitting triangles and directions of a picture are drawn, and weighed against the rays that meet them; with
--by-chance rays alone find them.
"""

import argparse
import math
import sys

import mitsuba as mi
import numpy as np

mi.set_variant("llvm_ad_rgb")
import drjit as dr  # noqa: E402  (wants the variant)
from independent_compare import by_bounce, report  # noqa: E402
from independent_gltf import Gltf, placed  # noqa: E402
from independent_sky import Sky  # noqa: E402
from independent_world import World, epsilon  # noqa: E402

PATHS_AT_ONCE = 1 << 20


class Surface:
    """A hit with its BRDF: Lambert's albedo/pi plus Cook-Torrance microfacets (Cook and Torrance 1982) with the GGX
    distribution of Walter et al. 2007, alpha = roughness^2 (Burley 2012), Schlick's Fresnel term (1994) and Smith's G
    as Schlick fits it, k = (roughness + 1)^2 / 8 (Karis 2013). The diffuse part is not scaled by 1 - F."""

    def __init__(self, world, triangle, b, view):
        material = dr.gather(mi.UInt32, world.material_of, triangle)
        uv = world.mix("uv", mi.Point2f, triangle, b)
        p0, p1, p2 = (dr.gather(mi.Point3f, world.data["position"], 3 * triangle + i) for i in range(3))
        self.p, self.view = p0 + (p1 - p0) * b.x + (p2 - p0) * b.y, view
        face = dr.normalize(dr.cross(p1 - p0, p2 - p0))
        self.face = dr.select(dr.dot(face, view) < 0, -face, face)
        n = dr.normalize(world.mix("normal", mi.Vector3f, triangle, b))
        side = dr.select(dr.dot(n, self.face) < 0, -1.0, 1.0)  # back faces of two-sided surfaces
        right, down = world.picture_axes(triangle, p1 - p0, p2 - p0)
        x = right - n * dr.dot(n, right)
        scale = world.numbers(material, 10)
        texel = world.texture(material, 3, uv)
        mx, my = texel.x * 2 - 1, texel.y * 2 - 1
        mz = dr.sqrt(dr.maximum(1 - mx * mx - my * my, 0))
        mx, my = mx * scale, my * scale
        usable = (scale >= 0) & (dr.squared_norm(x) > 1e-12)
        x = dr.normalize(x)
        y = dr.cross(n, x)
        y = dr.select(dr.dot(y, down) > 0, -y, y)  # green points up in the picture (glTF 2.0)
        mapped = dr.normalize(x * mx + y * my + n * mz)
        self.n = dr.select(usable, mapped, n) * side
        base = world.numbers(material, 0, mi.Color3f) * mi.Color3f(world.texture(material, 0, uv).xyz)
        rough_metal = world.texture(material, 2, uv)
        self.roughness = dr.clip(world.numbers(material, 7) * rough_metal.y, 0.03, 1)
        metal = world.numbers(material, 8) * rough_metal.z
        self.albedo, self.f0 = base * (1 - metal), dr.lerp(mi.Color3f(0.04), base, metal)
        self.by_area = dr.gather(mi.Float, world.emitter_density, triangle)
        self.emission = world.numbers(material, 4, mi.Color3f) * mi.Color3f(world.texture(material, 1, uv).xyz)
        self.frame = mi.Frame3f(self.n)
        wi = self.frame.to_local(view)
        self.wi = dr.normalize(mi.Vector3f(wi.x, wi.y, dr.maximum(wi.z, 1e-4)))  # mapped normals may face away
        self.lobe = mi.MicrofacetDistribution(mi.MicrofacetType.GGX, dr.square(self.roughness), True)
        shine, matte = mi.luminance(self.f0), mi.luminance(self.albedo)
        self.chance = dr.clip(shine / dr.maximum(shine + matte, 1e-6), 0.1, 0.9)

    def start(self):
        return self.p + self.face * epsilon(self.p)

    def eval(self, l):
        """Diffuse and specular BRDF times the cosine."""
        h = dr.normalize(self.view + l)
        cosine = dr.dot(self.n, l)
        nl, nv = dr.maximum(cosine, 1e-4), dr.maximum(dr.dot(self.n, self.view), 1e-4)
        nh, vh = dr.maximum(dr.dot(self.n, h), 0), dr.maximum(dr.dot(self.view, h), 0)
        a2, k = dr.square(dr.square(self.roughness)), dr.square(self.roughness + 1) / 8
        d = a2 / (dr.pi * dr.square(nh * nh * (a2 - 1) + 1))
        g = nl / (nl * (1 - k) + k) * nv / (nv * (1 - k) + k)
        f = self.f0 + (1 - self.f0) * dr.power(1 - dr.minimum(vh, 1), 5)
        above = (cosine > 0) & (dr.dot(self.face, l) > 0)
        shiny = f * (d * g / (4 * nl * nv) * cosine)
        return dr.select(above, self.albedo * (dr.inv_pi * cosine), 0), dr.select(above, shiny, 0)

    def sample(self, choice, u):
        """A direction and its density: from the cosine or from the visible normals, whichever `choice` says."""
        m, _ = self.lobe.sample(self.wi, u)
        matte = mi.warp.square_to_cosine_hemisphere(u)
        l = dr.select(choice < self.chance, mi.reflect(self.wi, m), matte)
        density = self.density(l)
        return self.frame.to_world(l), dr.select((density > 0) & (l.z > 0), density, dr.inf)

    def density(self, l):
        """Of a direction in the surface's frame among those of `sample`."""
        h = dr.normalize(self.wi + l)
        shiny = self.lobe.pdf(self.wi, h) / (4 * dr.dot(self.wi, h))
        return self.chance * shiny + (1 - self.chance) * dr.maximum(l.z, 0) * dr.inv_pi

    def weighed(self, l, density):
        """Both BRDFs times the cosine, for light found by a draw of that density that shares it with the rays (balance
        heuristic, Veach and Guibas 1995)."""
        matte, shiny = self.eval(l)
        both = density + dr.maximum(self.density(self.frame.to_local(l)), 0)
        return matte / both, shiny / both

    def emitters(self, world, random, active):
        """Diffuse and specular light of one place on the emitting triangles."""
        if world.emitter_choice is None:
            return mi.Color3f(0), mi.Color3f(0)
        triangle, place, by_area = world.draw_emitter(random)
        emitter = Surface(world, triangle, place, mi.Vector3f(0, 0, 1))
        d = emitter.p - self.start()  # or the emitter would hide itself where it is seen at a low angle
        far = dr.norm(d)
        l = d / dr.maximum(far, 1e-20)
        cosine = dr.abs(dr.dot(emitter.face, l))
        matte, shiny = self.weighed(l, by_area * far * far / dr.maximum(cosine, 1e-6))
        asked = active & (cosine > 1e-6) & dr.any(matte + shiny > 0)
        if world.masks:
            asked &= ~world.cut_out(triangle, place)
        shadowed, _, _ = world.trace(self.start(), l, far - 2 * epsilon(emitter.p), asked)
        lit = asked & ~shadowed
        return dr.select(lit, matte * emitter.emission, 0), dr.select(lit, shiny * emitter.emission, 0)

    def picture(self, world, random, active):
        """Diffuse and specular light of one direction of the picture; that of its sun, which no ray shares."""
        if world.sky.choice is None:
            return mi.Color3f(0), mi.Color3f(0), mi.Color3f(0)
        l, radiance, density, sun = world.sky.draw(random)
        matte, shiny = self.weighed(l, density)
        alone = self.eval(l)
        asked = active & dr.any(alone[0] + alone[1] > 0)
        shadowed, _, _ = world.trace(self.start(), l, mi.Float(dr.inf), asked)
        lit = asked & ~shadowed
        of_sun = dr.select(lit & sun, (alone[0] + alone[1]) * radiance / density, 0)
        return dr.select(lit & ~sun, matte * radiance, 0), dr.select(lit & ~sun, shiny * radiance, 0), of_sun

    def direct(self, world, active):
        """Light of every light of KHR_lights_punctual, with a ray to each."""
        total = mi.Color3f(0)
        for light, position, forward in world.lights:
            color = mi.Color3f([c * light["intensity"] for c in light["color"]])
            if light["type"] == "directional":
                to_light, far = -mi.Vector3f(forward), mi.Float(1e30)
            else:
                d = mi.Point3f(position) - self.p
                far = dr.norm(d)
                to_light = d / far
                color /= far * far
                if "range" in light:
                    color *= dr.clip(1 - dr.power(far / light["range"], 4), 0, 1)
            if light["type"] == "spot":
                inner, outer = math.cos(light["spot"]["innerConeAngle"]), math.cos(light["spot"]["outerConeAngle"])
                color *= dr.square(
                    dr.clip((-dr.dot(to_light, mi.Vector3f(forward)) - outer) / max(inner - outer, 1e-4), 0, 1)
                )
            diffuse, specular = self.eval(to_light)
            lit = (diffuse + specular) * color
            asked = active & dr.any(lit > 0)
            shadowed, _, _ = world.trace(self.start(), to_light, far * 0.9999, asked)
            total += dr.select(asked & ~shadowed, lit, 0)
        return total


def camera_rays(camera, size, seed, samples):
    """Origins on the near plane and directions, `samples` for each pixel, spread evenly over it."""
    world, lens = camera
    count = size[0] * size[1] * samples
    # Scrambled: PCG streams of neighbouring numbers are correlated.
    random = mi.PCG32(1, *mi.sample_tea_32(dr.arange(mi.UInt32, count), seed))
    index = dr.arange(mi.UInt32, count) // samples
    half = math.tan(0.5 * lens["yfov"])
    x = (2 * (mi.Float(index % size[0]) + random.next_float32()) / size[0] - 1) * half * size[0] / size[1]
    y = (1 - 2 * (mi.Float(index // size[0]) + random.next_float32()) / size[1]) * half
    local = mi.Vector3f(x, y, -1)
    turned = mi.Matrix3f(world[:3, :3].astype(np.float32)) @ local
    d = dr.normalize(turned)
    origin = mi.Point3f(*map(float, world[:3, 3])) + turned * lens["znear"]
    return random, origin, d


def paths(world, camera, size, bounces, seed, samples):
    """One array of pixels a quantity: direct, occlusion, seen (emission and sky met by camera rays) and for each bounce
    the light that its ray brings, by the lobe of the first surface."""
    random, o, d = camera_rays(camera, size, seed, samples)
    active, triangle, b = world.trace(o, d, mi.Float(dr.inf), mi.Bool(True))
    met, s = mi.Bool(active), Surface(world, triangle, b, -d)
    out = {"seen": dr.select(active, s.emission, world.sky.eval(d))}
    out["direct"] = dr.select(active, s.direct(world, active), 0)
    out |= {f"{lobe} {bounce}": mi.Color3f(0) for lobe in ("diffuse", "specular") for bounce in range(1, bounces + 1)}
    diffuse, specular = mi.Color3f(1), mi.Color3f(1)  # weight of the path, by the first lobe

    def shine(bounce, light):
        """Light that leaves the surface at the end of this many rays."""
        if bounce == 0:
            out["direct"] += light
            return
        out[f"diffuse {bounce}"] += diffuse * light
        out[f"specular {bounce}"] += specular * light

    def reflect(bounce, matte, shiny):
        """Light that a ray of this number could have brought to where it starts, reflected there by either lobe."""
        if bounce == 1:
            out["diffuse 1"] += matte
            out["specular 1"] += shiny
        else:
            shine(bounce, matte + shiny)

    for bounce in range(1, bounces + 1):
        reflect(bounce, *s.emitters(world, random, active))
        matte, shiny, sun = s.picture(world, random, active)
        reflect(bounce, matte, shiny)
        shine(bounce - 1, sun)
        o = s.p
        d, density = s.sample(random.next_float32(), mi.Point2f(random.next_float32(), random.next_float32()))
        matte, shiny = s.eval(d)
        if bounce == 1:
            diffuse, specular = matte / density, shiny / density
            around = dr.maximum(dr.dot(s.n, d), 0) * dr.inv_pi / density
            around = dr.select(active & (dr.dot(s.face, d) > 0), around, 0)
        else:
            diffuse, specular = diffuse * (matte + shiny) / density, specular * (matte + shiny) / density
        alive = dr.any(diffuse + specular > 0) | ((around > 0) if bounce == 1 else False)
        active &= alive
        found, triangle, b = world.trace(s.start(), d, mi.Float(dr.inf), active)
        # One kernel a bounce, compiled once.
        dr.eval(found, triangle, b, active, diffuse, specular, o, d, density, around, random.state, out)
        if bounce == 1:
            out["occlusion"] = dr.select(met, dr.select(active & ~found, mi.Color3f(around), 0), 1)
        s = Surface(world, triangle, b, -d)
        drawn = s.by_area * dr.squared_norm(s.p - o) / dr.maximum(dr.abs(dr.dot(s.face, d)), 1e-6)
        emitted = s.emission * (density / (density + drawn))
        beyond = world.sky.eval(d, False) * (density / (density + world.sky.density(d)))
        light = dr.select(found, emitted + s.direct(world, found), beyond)
        shine(bounce, dr.select(active, light, 0))
        active &= found
        dr.eval(s.__dict__, active, out)
    shine(bounces, s.picture(world, random, active)[2])
    return {k: fold(v, samples) for k, v in out.items()}


def fold(color, samples):
    """Mean over the samples of a pixel, pixels x 3."""
    return np.stack([np.array(dr.block_sum(c, samples)) / samples for c in color], 1)


def render(world, camera, args):
    """Means over the even and the odd passes: quantity -> 2 x pixels x 3."""
    pixels = args.size[0] * args.size[1]
    samples = max(1, min(args.spp // 2, 1 << (PATHS_AT_ONCE // pixels).bit_length() - 1))
    passes = 2 * max(1, round(args.spp / samples / 2))
    sums = {}
    for number in range(passes):
        means = paths(world, camera, args.size, args.bounces, args.seed * 100003 + number, samples)
        for key, value in means.items():
            sums.setdefault(key, np.zeros((2, pixels, 3)))[number % 2] += value.astype(float) * 2 / passes
        print(f"\r{(number + 1) * samples} of {passes * samples} samples", end="", file=sys.stderr, flush=True)
    print(file=sys.stderr)
    for bounce in range(1, args.bounces + 1):
        sums[f"bounce {bounce}"] = sums[f"diffuse {bounce}"] + sums[f"specular {bounce}"]
    return sums


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scene", help=".gltf with the files beside it")
    parser.add_argument(
        "--camera", default="default", help="a name, or EX,EY,EZ,TX,TY,TZ,FOV: eye, target, degrees; near plane at 1 cm"
    )
    parser.add_argument("--size", type=lambda s: tuple(map(int, s.split("x"))), default=(128, 96), metavar="WxH")
    parser.add_argument("--spp", type=int, default=256)
    parser.add_argument("--bounces", type=int, default=3)
    parser.add_argument("--sky", default="0,0,0", metavar="R,G,B|FILE", help="one radiance, or a picture (EXR, HDR)")
    parser.add_argument("--sun", type=float, default=math.inf, metavar="L", help="luminance above which is the sun")
    parser.add_argument("--by-chance", action="store_true", help="rays alone find emission and the sky")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--against", nargs="*", default=[], metavar="FOLDER", help="references of 1, 2, ... bounces")
    args = parser.parse_args()
    gltf = Gltf(args.scene)
    camera = placed([float(n) for n in args.camera.split(",")]) if "," in args.camera else gltf.cameras[args.camera]
    found = render(World(gltf, Sky(args.sky, args.sun, args.by_chance), args.by_chance), camera, args)
    width, height = args.size
    print(f"Mitsuba {mi.__version__}, {args.scene}, camera {args.camera}, {width}x{height}, {args.spp} samples a pixel")
    report(found, by_bounce(args.against))


if __name__ == "__main__":
    main()
