#!/usr/bin/env python3
"""Path traces a scene of `conelab scene SCENE --export FILE.gltf` with Mitsuba's own integrator, lamps and materials:
`diffuse` for surfaces without a lobe, `roughconductor` for metals. Nothing here comes from conelab, not even a formula.

    pip install mitsuba numpy openexr    # tried: 3.9.1 with LLVM 19, DRJIT_LIBLLVM_PATH=/path/to/libLLVM.so.19.1
    conelab scene tests/common/own/scene.ron --export own.gltf
    conelab reference configs/rays.ron --scene tests/common/own/scene.ron --size 48x36 --spp 4096 \\
        --set pixel=box --set shading_model=single_scattering -o own.exr
    python3 scripts/independent_own.py own.gltf --size 48x36 --spp 4096 --against own.exr

Only what both have is alike: metals are white, since Mitsuba's reflectance has no Fresnel term then, and one scattering
is compared. Mitsuba masks light and view apart where conelab correlates them by height, which differs by less than a
percent below roughness 0.5.
"""

import argparse
import math
import os
import tempfile

import mitsuba as mi
import numpy as np

mi.set_variant("llvm_ad_rgb")
from independent_gltf import Gltf  # noqa: E402  (wants the variant)


def material(m):
    """Mitsuba's material and lamp for one of the file."""
    pbr = m.get("pbrMetallicRoughness", {})
    color = {"type": "rgb", "value": pbr.get("baseColorFactor", [1] * 4)[:3]}
    if pbr.get("metallicFactor", 1) == 1:
        alpha = pbr.get("roughnessFactor", 1) ** 2
        bsdf = {"type": "roughconductor", "material": "none", "distribution": "ggx", "alpha": alpha, "specular_reflectance": color}
    else:
        bsdf = {"type": "diffuse", "reflectance": color}
    shape = {"bsdf": {"type": "twosided", "inner": bsdf}}
    strength = m.get("extensions", {}).get("KHR_materials_emissive_strength", {}).get("emissiveStrength", 1.0)
    emission = [c * strength for c in m.get("emissiveFactor", [0] * 3)]
    if any(emission):
        shape["emitter"] = {"type": "area", "radiance": {"type": "rgb", "value": emission}}
    return shape


def shapes(gltf, folder):
    """A mesh for each material."""
    out = {}
    corners = np.repeat(gltf.soup["material"], 3)
    for number, m in enumerate(gltf.json["materials"]):
        mine = corners == number
        if not mine.any():
            continue
        count = int(mine.sum())
        mesh = mi.Mesh(f"m{number}", count, count // 3, has_vertex_normals=True)
        params = mi.traverse(mesh)
        params["vertex_positions"] = mi.Float(gltf.soup["position"][mine].ravel().astype(np.float32))
        params["vertex_normals"] = mi.Float(gltf.soup["normal"][mine].ravel().astype(np.float32))
        params["faces"] = mi.UInt32(np.arange(count, dtype=np.uint32))
        params.update()
        path = os.path.join(folder, f"m{number}.ply")
        mesh.write_ply(path)
        out[f"m{number}"] = {"type": "ply", "filename": path} | material(m)
    return out


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scene", help=".gltf with the files beside it")
    parser.add_argument("--camera", default="default")
    parser.add_argument("--size", type=lambda s: tuple(map(int, s.split("x"))), default=(48, 36), metavar="WxH")
    parser.add_argument("--spp", type=int, default=1024)
    parser.add_argument("--against", metavar="EXR", help="picture of `conelab reference -o`")
    args = parser.parse_args()
    gltf = Gltf(args.scene)
    world, lens = gltf.cameras[args.camera]
    to_world = world @ np.diag([-1.0, 1.0, -1.0, 1.0])  # Mitsuba looks along +z with +x to the left
    sensor = {
        "type": "perspective",
        "fov": math.degrees(lens["yfov"]),
        "fov_axis": "y",
        "near_clip": 1e-3,
        "to_world": mi.ScalarTransform4f(to_world),
        "film": {"type": "hdrfilm", "width": args.size[0], "height": args.size[1], "rfilter": {"type": "box"}},
        "sampler": {"type": "independent"},
    }
    with tempfile.TemporaryDirectory() as folder:
        scene = mi.load_dict({"type": "scene", "sensor": sensor, "integrator": {"type": "path", "max_depth": -1, "rr_depth": 64}} | shapes(gltf, folder))
    halves = [np.array(mi.render(scene, spp=args.spp // 2, seed=seed))[..., :3].astype(float) for seed in (1, 2)]
    picture = (halves[0] + halves[1]) / 2
    noise = abs(halves[0].mean() - halves[1].mean()) / 2
    print(f"Mitsuba {mi.__version__}: mean {picture.mean():.6f} +- {noise:.6f}")
    if args.against:
        other = np.array(mi.Bitmap(args.against).convert(mi.Bitmap.PixelFormat.RGB, mi.Struct.Type.Float32)).astype(float)
        error = ((picture - other) ** 2).mean() / (picture**2).mean()
        floor = ((halves[0] - halves[1]) ** 2).mean() / 4 / (picture**2).mean()
        print(f"conelab: mean {other.mean():.6f}, ratio {other.mean() / picture.mean():.4f}, relative squared error {error:.2e}, of Mitsuba's noise {floor:.2e}")


if __name__ == "__main__":
    main()
