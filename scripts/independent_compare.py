"""Samples that `conelab reference` keeps beside those of independent.py."""

import json
import math
import os
import sys

import numpy as np
import OpenEXR


def kept(folder):
    """The samples that `conelab reference` keeps in a folder: part -> 2 x pixels x 3, means of its halves."""
    with open(os.path.join(folder, "reference.json"), encoding="utf-8") as file:
        record = json.load(file)
    layers = OpenEXR.File(os.path.join(folder, record["sums"]), separate_channels=True).parts
    layers = {layer.name(): {c: layer.channels[c].pixels.ravel().astype(float) for c in "RGBA"} for layer in layers}
    mean = lambda layer: np.stack([layer[c] / layer["A"] for c in "RGB"], 1)
    return record, {
        part: np.stack([mean(layers[f"{part}.{half}"]) for half in range(2)])
        for part in ("total", "direct", "diffuse", "specular", "occlusion")
    }


def by_bounce(folders):
    """What each bounce adds, from references of 1, 2, ... bounces."""
    out, before = {}, None
    for number, folder in enumerate(folders, 1):
        record, parts = kept(folder)
        if (record["params"].get("bounces"), record["params"].get("pixel")) != (str(number), "box"):
            sys.exit(f"{folder}: not a reference of {number} bounces with pixel=box")
        if before is None:
            out["direct"], out["occlusion"] = parts["direct"], parts["occlusion"]
            out["seen"] = parts["total"] - parts["direct"] - parts["diffuse"] - parts["specular"]
        for lobe in ("diffuse", "specular"):
            out[f"{lobe} {number}"] = parts[lobe] - (before[lobe] if before else 0)
        out[f"bounce {number}"] = out[f"diffuse {number}"] + out[f"specular {number}"]
        before = parts
    return out


def mean_and_error(halves):
    """Mean over the picture and its standard error, from the differences of the halves."""
    difference = (halves[0] - halves[1]).mean(1)
    return halves.mean(), math.sqrt((difference**2).sum()) / 2 / len(difference)


def report(found, expected):
    """A line a quantity. `floor`: the relMSE that the noise of both pictures alone would give, from their halves."""
    print(f"{'':12}{'mitsuba':>12}{'+-':>10}{'conelab':>12}{'+-':>10}{'ratio':>10}{'+-':>9}{'relMSE':>11}{'floor':>11}")
    for key in sorted(found, key=lambda k: (k[-1].isdigit(), k)):
        mean, error = mean_and_error(found[key])
        line = f"{key:12}{mean:12.6f}{error:10.2g}"
        if key in expected:
            other, spread = mean_and_error(expected[key])
            of = math.hypot(error / max(mean, 1e-9), spread / max(other, 1e-9))
            r, x = found[key].mean(0), expected[key].mean(0)
            noise = sum((halves[0] - halves[1]) ** 2 / 4 for halves in (found[key], expected[key]))
            relmse, floor = (((v / (r**2 + 1e-2)).mean()) for v in ((x - r) ** 2, noise))
            line += f"{other:12.6f}{spread:10.2g}{other / max(mean, 1e-9):10.5f}{of:9.5f}{relmse:11.3e}{floor:11.3e}"
        print(line)
