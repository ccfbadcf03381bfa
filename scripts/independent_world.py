"""Geometry, materials and textures of a glTF file on the device, and rays through them, for independent.py."""

import mitsuba as mi
import numpy as np

mi.set_variant("llvm_ad_rgb")
import drjit as dr  # noqa: E402  (wants the variant)
from independent_gltf import srgb_to_linear  # noqa: E402
from independent_sky import LUMINANCE  # noqa: E402


class World:
    """The scene on the device."""

    def __init__(self, gltf, sky, by_chance=False):
        soup = gltf.soup
        corners = len(soup["position"])
        mesh = mi.Mesh("scene", corners, corners // 3)
        params = mi.traverse(mesh)
        params["vertex_positions"] = mi.Float(soup["position"].ravel().astype(np.float32))
        params["faces"] = mi.UInt32(np.arange(corners, dtype=np.uint32))
        params.update()
        self.scene = mi.load_dict({"type": "scene", "mesh": mesh})
        store = lambda a, kind=mi.Float: kind(np.ascontiguousarray(a).ravel())
        self.data = {k: store(soup[k].astype(np.float32)) for k in ("position", "normal", "uv")}
        self.material_of = store(soup["material"].astype(np.uint32), mi.UInt32)
        self.sky = sky
        self.lights = gltf.lights
        self.texels, self.places = [np.ones((1, 4))], {}
        constants = np.array([self.constant(m) for m in gltf.json["materials"]], np.float32)
        self.masks = bool((constants[:, 9] > 0).any())
        self.constants = store(constants)
        self.images = store(np.array([self.textures(gltf, m) for m in gltf.json["materials"]], np.int32), mi.Int32)
        self.atlas = store(np.concatenate(self.texels).astype(np.float32))
        # Triangles are drawn by their area times the luminance of their emission, were its texture white.
        a, b, c = (soup["position"][i::3] for i in range(3))
        area = np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2
        bright = (constants[:, 4:7].astype(float) @ LUMINANCE)[soup["material"]] * (not by_chance)
        power = bright * area
        self.emitter_choice = mi.DiscreteDistribution(store(power.astype(np.float32))) if power.any() else None
        self.emitter_density = store((bright / max(power.sum(), 1e-30)).astype(np.float32))

    @staticmethod
    def constant(m):
        """Numbers of a material: 0 base colour, 4 emission, 7 roughness, 8 metallic, 9 alpha cutoff, 10 scale of the
        normal map, negative without one."""
        pbr = m.get("pbrMetallicRoughness", {})
        strength = m.get("extensions", {}).get("KHR_materials_emissive_strength", {}).get("emissiveStrength", 1.0)
        row = list(pbr.get("baseColorFactor", [1] * 4)) + [c * strength for c in m.get("emissiveFactor", [0] * 3)]
        row += [pbr.get("roughnessFactor", 1), pbr.get("metallicFactor", 1)]
        row += [m.get("alphaCutoff", 0.5) if m.get("alphaMode") == "MASK" else 0]
        return row + [m["normalTexture"].get("scale", 1) if "normalTexture" in m else -1]

    def textures(self, gltf, m):
        """First texel, width and height of base colour, emission, roughness with metallic, and normal; without a
        texture, those of one white texel."""
        pbr, row = m.get("pbrMetallicRoughness", {}), []
        for texture, srgb in (
            (pbr.get("baseColorTexture"), True),
            (m.get("emissiveTexture"), True),
            (pbr.get("metallicRoughnessTexture"), False),
            (m.get("normalTexture"), False),
        ):
            row += [0, 1, 1] if texture is None else self.place(gltf, texture["index"], srgb)
        return row

    def place(self, gltf, texture, srgb):
        if (texture, srgb) not in self.places:
            image = gltf.image(texture) / 255.0
            if srgb:
                image[..., :3] = srgb_to_linear(image[..., :3])
            self.places[texture, srgb] = [sum(map(len, self.texels)), image.shape[1], image.shape[0]]
            self.texels.append(image.reshape(-1, 4))
        return self.places[texture, srgb]

    def texture(self, material, number, uv):
        """Bilinear, repeated, of the full resolution."""
        first, w, h = (dr.gather(mi.Int32, self.images, 12 * material + 3 * number + i) for i in range(3))
        uv = uv - dr.floor(uv)
        x, y = uv.x * w - 0.5, uv.y * h - 0.5
        i, j = mi.Int32(dr.floor(x)), mi.Int32(dr.floor(y))
        fx, fy = x - i, y - j
        wrap = lambda a, n: dr.select(a < 0, a + n, dr.select(a >= n, a - n, a))
        at = lambda i, j: dr.gather(mi.Vector4f, self.atlas, mi.UInt32(first + wrap(j, h) * w + wrap(i, w)))
        return dr.lerp(dr.lerp(at(i, j), at(i + 1, j), fx), dr.lerp(at(i, j + 1), at(i + 1, j + 1), fx), fy)

    def numbers(self, material, column, kind=mi.Float):
        at = lambda i: dr.gather(mi.Float, self.constants, 11 * material + column + i)
        return at(0) if kind is mi.Float else kind(at(0), at(1), at(2))

    def mix(self, key, kind, triangle, b):
        """An attribute at weights b of the second and third corner."""
        at = lambda i: dr.gather(kind, self.data[key], 3 * triangle + i)
        return at(0) * (1 - b.x - b.y) + at(1) * b.x + at(2) * b.y

    def picture_axes(self, triangle, ab, ac):
        """World directions of a picture's right and down on a triangle with these edges, of any length. They come from
        positions and texture coordinates: TANGENT in the file is not read, so that a wrong one shows."""
        a, b, c = (dr.gather(mi.Point2f, self.data["uv"], 3 * triangle + i) for i in range(3))
        p, q = b - a, c - a
        turned = dr.sign(p.x * q.y - p.y * q.x)
        return (ab * q.y - ac * p.y) * turned, (ac * p.x - ab * q.x) * turned

    def draw_emitter(self, random):
        """(triangle, weights of its second and third corner, density by area) of a place on the emitting triangles."""
        triangle = self.emitter_choice.sample(random.next_float32())
        weights = mi.warp.square_to_uniform_triangle(mi.Point2f(random.next_float32(), random.next_float32()))
        return triangle, weights, dr.gather(mi.Float, self.emitter_density, triangle)

    def cut_out(self, triangle, b):
        material = dr.gather(mi.UInt32, self.material_of, triangle)
        alpha = self.numbers(material, 3) * self.texture(material, 0, self.mix("uv", mi.Point2f, triangle, b)).w
        return alpha < self.numbers(material, 9)

    @dr.syntax
    def trace(self, origin, direction, end, active):
        """(valid, triangle, weights) of the first surface that no mask cuts out, nearer than `end`."""
        o, left, walking = mi.Point3f(origin), mi.Float(end), mi.Bool(active)
        valid, triangle, weights = mi.Bool(False), mi.UInt32(0), mi.Point2f(0)
        while walking:
            ray = mi.Ray3f(o, direction)
            ray.maxt = left
            hit = self.scene.ray_intersect_preliminary(ray, coherent=False, active=walking)
            found = walking & hit.is_valid()
            of = dr.select(found, hit.prim_index, 0)
            again = found & self.cut_out(of, hit.prim_uv) if dr.hint(self.masks, mode="scalar") else mi.Bool(False)
            found &= ~again
            valid |= found
            triangle = dr.select(found, of, triangle)
            weights = dr.select(found, hit.prim_uv, weights)
            step = hit.t + epsilon(o + direction * hit.t)
            o = dr.select(again, o + direction * step, o)
            left = dr.select(again, left - step, left)
            walking = again & (left > 0)
        return valid, triangle, weights


def epsilon(p):
    return 2e-5 * (1 + dr.max(dr.abs(p)))
