#!/usr/bin/env python3
"""Renders pictures of the documents that need no times of a GPU: the README's strip, the gallery, the tutorials.

    scripts/figures.py [strip] [tutorials] [gallery[=SCENE,...]]      all when none is named

Needs the Python module with matplotlib (`make python`) and the program (CONELAB, or target/release/conelab).
CONELAB_DEVICE chooses the device. `CONELAB_BLESS=1 cargo test --release --test results` writes the numbers next to the pictures.
"""

import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
from PIL import Image

import conelab

ROOT = Path(__file__).resolve().parent.parent
DOCS = ROOT / "docs"
#: Size of the pictures in docs/recorded/scenes.csv.
SIZE = (480, 270)
#: Samples per pixel of references. A page shows the strip's at half its size, which averages four pixels.
SAMPLES = 64


def save(array: np.ndarray, path: Path) -> None:
    path.parent.mkdir(exist_ok=True)
    Image.fromarray(np.ascontiguousarray(array[..., :3])).save(path, quality=88, optimize=True, progressive=True)
    print(path.relative_to(ROOT), flush=True)


def rendered(lab: conelab.Lab, experiment: str, **settings) -> np.ndarray:
    opened = lab.open(experiment, **settings)
    try:
        return np.array(opened.render().picture[..., :3])
    finally:
        opened.close()


def row(pictures: list[np.ndarray], gap: int = 6) -> np.ndarray:
    """Pictures side by side on white."""
    space = np.full((pictures[0].shape[0], gap, 3), 255, np.uint8)
    parts = [part for picture in pictures for part in (picture, space)]
    return np.concatenate(parts[:-1], axis=1)


def strip(lab: conelab.Lab) -> None:
    """The scene is `STRIP` of tests/results.rs, which writes the numbers."""
    where = {"scene": "sky-window", "size": SIZE}
    pictures = [rendered(lab, name, **where) for name in ("thesis", "cones", "rays")]
    reference = lab.open("rays", **where).reference(SAMPLES)
    save(row([*pictures, reference.parts["total"].displayed()]), DOCS / "strip.jpg")


def tutorials(lab: conelab.Lab) -> None:
    tour = {"scene": "atrium", "size": (320, 180)}
    first = DOCS / "first-steps"
    save(rendered(lab, "tour", **tour), first / "atrium.jpg")
    save(rendered(lab, "tour", view="voxels", voxel_view="color", **tour), first / "voxels.jpg")
    tinted = lab.open("tour", **tour)
    with tinted.edit("display/display.comp") as source:
        shown = "toneMap(c * exp2(params.exposure))"
        source.text = source.text.replace(shown, f"{shown} * vec3(1.0, 0.7, 0.4)")
    save(tinted.render().picture, first / "tinted.jpg")
    tinted.close()
    where = {"scene": "street", "size": (240, 135)}
    reference = lab.open("rays", **where).reference(SAMPLES)
    maps = []
    for name in ("rays", "thesis"):
        opened = lab.open(name, **where)
        maps.append(conelab.heat(opened.score(reference, parts=["total"]).maps()["flip"]))
        opened.close()
    save(row(maps), DOCS / "compare-methods/flip.jpg")


def triangles(scene: str) -> int:
    program = os.environ.get("CONELAB", ROOT / "target/release/conelab")
    text = subprocess.run([program, "scene", scene, "--json", "-"], check=True, capture_output=True, text=True).stdout
    return int(json.loads(text)["triangles"])


def gallery(lab: conelab.Lab, chosen: list[str], columns: int = 3) -> None:
    scenes = {name: about for name, about in lab.scenes().items() if not name.endswith(".ron")}
    for scene in chosen or scenes:
        save(rendered(lab, "rays", scene=scene, size=(320, 180)), DOCS / f"gallery/{scene}.jpg")
    cells = [
        f"![{name}](gallery/{name}.jpg)<br>`{name}`, {triangles(name):,} triangles: {about}"
        for name, about in scenes.items()
    ]
    cells += [""] * (-len(cells) % columns)
    rows = ["| " + " | ".join(cells[i : i + columns]) + " |" for i in range(0, len(cells), columns)]
    table = "\n".join(["|" + " |" * columns, "|" + "---|" * columns, *rows])
    page = DOCS / "gallery.md"
    start, end = "<!-- pictures: scripts/figures.py -->", "<!-- end -->"
    head, rest = page.read_text().split(start, 1)
    page.write_text(f"{head}{start}\n\n{table}\n\n{end}{rest.split(end, 1)[1]}")


def main() -> None:
    wanted = sys.argv[1:] or ["strip", "tutorials", "gallery"]
    with conelab.Lab(home=ROOT) as lab:
        for name, _, scenes in (word.partition("=") for word in wanted):
            if name == "gallery":
                gallery(lab, scenes.split(",") if scenes else [])
            else:
                {"strip": strip, "tutorials": tutorials}[name](lab)


if __name__ == "__main__":
    main()
