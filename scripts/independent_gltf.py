"""glTF 2.0 as `conelab scene --export` writes it, read without anything of conelab, for independent.py."""

import base64
import json
import math
import os
import tempfile
import urllib.parse

import mitsuba as mi
import numpy as np

COMPONENTS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}
NUMBERS = {5121: np.uint8, 5123: np.uint16, 5125: np.uint32, 5126: np.float32}


class Gltf:
    """The parts of glTF 2.0 that the exporter writes, flattened: triangles in the world and one list of materials."""

    def __init__(self, path):
        self.folder = os.path.dirname(os.path.abspath(path))
        with open(path, encoding="utf-8") as file:
            self.json = json.load(file)
        self.buffers = [self.read(b["uri"]) for b in self.json.get("buffers", [])]
        self.soup = {k: [] for k in ("position", "normal", "uv", "material")}
        self.lights, self.cameras = [], {}
        for root in self.json["scenes"][self.json.get("scene", 0)]["nodes"]:
            self.visit(root, np.eye(4))
        self.soup = {k: np.concatenate(v) for k, v in self.soup.items()}

    def read(self, uri):
        if uri.startswith("data:"):
            return base64.b64decode(uri.partition(",")[2])
        with open(os.path.join(self.folder, urllib.parse.unquote(uri)), "rb") as file:
            return file.read()

    def view(self, index):
        v = self.json["bufferViews"][index]
        return self.buffers[v["buffer"]][v.get("byteOffset", 0) :][: v["byteLength"]], v.get("byteStride")

    def accessor(self, index):
        a = self.json["accessors"][index]
        data, stride = self.view(a["bufferView"])
        kind, n = np.dtype(NUMBERS[a["componentType"]]), COMPONENTS[a["type"]]
        return np.ndarray(
            (a["count"], n), kind, data, a.get("byteOffset", 0), (stride or n * kind.itemsize, kind.itemsize)
        ).copy()

    def visit(self, index, parent):
        node = self.json["nodes"][index]
        local = np.eye(4)
        if "matrix" in node:
            local = np.array(node["matrix"], float).reshape(4, 4).T
        else:
            x, y, z, w = node.get("rotation", [0, 0, 0, 1])
            local[:3, :3] = np.array(
                [
                    [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                    [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                    [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
                ]
            ) * node.get("scale", [1, 1, 1])
            local[:3, 3] = node.get("translation", [0, 0, 0])
        world = parent @ local
        if "mesh" in node:
            for primitive in self.json["meshes"][node["mesh"]]["primitives"]:
                self.triangles(primitive, world)
        if "camera" in node:
            lens = self.json["cameras"][node["camera"]]
            self.cameras[lens["name"]] = (world, lens["perspective"])
        light = node.get("extensions", {}).get("KHR_lights_punctual")
        if light:
            light = self.json["extensions"]["KHR_lights_punctual"]["lights"][light["light"]]
            self.lights.append((light, world[:3, 3], -world[:3, 2] / np.linalg.norm(world[:3, 2])))
        for child in node.get("children", []):
            self.visit(child, world)

    def triangles(self, primitive, world):
        index = self.accessor(primitive["indices"]).ravel()
        get = {
            k: self.accessor(primitive["attributes"][n])[index].astype(float)
            for k, n in (("position", "POSITION"), ("normal", "NORMAL"), ("uv", "TEXCOORD_0"))
        }
        turn = world[:3, :3]
        get["position"] = get["position"] @ turn.T + world[:3, 3]
        get["normal"] = get["normal"] @ np.linalg.inv(turn)
        get["material"] = np.full(len(index) // 3, primitive["material"])
        for key, values in get.items():
            self.soup[key].append(values)

    def image(self, texture):
        """Texels as H x W x 4 bytes."""
        image = self.json["images"][self.json["textures"][texture]["source"]]
        data = self.view(image["bufferView"])[0] if "bufferView" in image else self.read(image["uri"])
        with tempfile.NamedTemporaryFile(suffix=".png") as file:
            file.write(data)
            file.flush()
            bitmap = mi.Bitmap(file.name)
        return np.array(bitmap.convert(mi.Bitmap.PixelFormat.RGBA, mi.Struct.Type.UInt8, bitmap.srgb_gamma()))


def srgb_to_linear(c):
    return np.where(c <= 0.04045, c / 12.92, ((c + 0.055) / 1.055) ** 2.4)


def placed(numbers):
    """Eye, target and vertical field of view in degrees, as a camera of Gltf that stands upright."""
    eye, target, fov = np.array(numbers[:3]), np.array(numbers[3:6]), numbers[6]
    back = (eye - target) / np.linalg.norm(eye - target)
    right = np.cross([0, 1, 0], back) / np.linalg.norm(np.cross([0, 1, 0], back))
    world = np.eye(4)
    world[:3] = np.stack([right, np.cross(back, right), back, eye], 1)
    return world, {"yfov": math.radians(fov), "znear": 0.01}
