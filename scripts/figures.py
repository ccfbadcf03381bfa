#!/usr/bin/env python3
"""Renders pictures of the documents that need no times of a GPU: the README's strip, the gallery, the tutorials.

    scripts/figures.py [strip] [tutorials] [pages] [gallery[=SCENE,...]]      all when none is named

Needs the Python module with matplotlib (`make python`) and the program (CONELAB, or target/release/conelab).
CONELAB_DEVICE chooses the device. `CONELAB_BLESS=1 cargo test --release --test results` writes the numbers next to the pictures.
"""

import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
from PIL import Image

import conelab

ROOT = Path(__file__).resolve().parent.parent
DOCS = ROOT / "docs"
#: Size of the strip's pictures: as large as the README shows them.
SIZE = (240, 135)
#: The gallery's voxels, so that a software device takes minutes for all scenes.
COARSE = {"voxel_dim": 64, "shadow_dim": 1024}
#: Samples per pixel of references.
SAMPLES = 64


def save(array: np.ndarray, path: Path) -> None:
    path.parent.mkdir(exist_ok=True)
    Image.fromarray(np.ascontiguousarray(array[..., :3])).save(path, quality=88, optimize=True, progressive=True)
    print(path.relative_to(ROOT), flush=True)


def rendered(lab: conelab.Lab, experiment: str, frames: int | None = None, **settings) -> np.ndarray:
    """A picture after some frames; when it has converged if none are given."""
    opened = lab.open(experiment, **settings)
    try:
        return np.array(opened.render(frames).picture[..., :3])
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


def render(*arguments: str) -> np.ndarray:
    """A picture of the command line."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "picture.png"
        subprocess.run([program(), "render", *arguments, "-o", path], check=True, capture_output=True, cwd=ROOT)
        return np.asarray(Image.open(path).convert("RGB"))


def pages(lab: conelab.Lab) -> None:
    """Pictures of the how-to and reference pages, as small as they are shown."""
    tour = {"size": (320, 180), "voxel_dim": 64, "shadow_dim": 1024}
    save(rendered(lab, "cones", scene="atrium", probe=(95, 160), **tour), DOCS / "how-to/probe.jpg")
    warps = {"scene": "atrium", "size": (320, 180), "shadow_dim": 1024, "frames": 2}
    cascades = rendered(lab, "warps", voxel_dim=48, density="surfaces", **warps)
    finest = rendered(lab, "warps", voxel_dim=48, view="voxels", voxel_view_cascade=0, **warps)
    curved = {"cascades": 1, "warp": "perspective", "warp_near": 2.0, "density": "surfaces"}
    save(row([cascades, finest, rendered(lab, "warps", voxel_dim=32, **curved, **warps)]), DOCS / "how-to/warps.jpg")
    with tempfile.TemporaryDirectory() as folder:
        box = lab.open("rays", scene="cornell").export_scene(Path(folder) / "box.glb")
        own = Path(folder) / "own.ron"
        bulb = 'Point(name: "bulb", color: (9, 8, 6), position: (1.2, 4.2, 1.2), shadow: true)'
        own.write_text(f'(models: [(file: "box.glb", lights: false)], lights: [{bulb}], sky: (0, 0, 0))')
        scenes = [rendered(lab, "rays", scene=str(scene), **tour) for scene in (box, own)]
    save(row(scenes), DOCS / "own-scene/box.jpg")
    save(rendered(lab, "rays", scene="configs/scenes/shapes.ron", **tour), DOCS / "scene-files/shapes.jpg")
    box = {"scene": "cornell", "size": (240, 180), "voxel_dim": 64, "shadow_dim": 1024}
    exact = lab.open("rays", **box)
    thesis = lab.open("thesis", **box)
    score = thesis.score(exact.parts()["total"], parts=["total"])
    maps = score.maps()
    relative = (np.log10(maps["relativeSquaredError"] + 1e-12) + 4.0) / 6.0
    errors = [conelab.heat(m) for m in (maps["flip"], relative, maps["structure"] / 0.5)]
    save(row([score.parts["total"].displayed(), *errors]), DOCS / "metrics/maps.jpg")
    small = lab.open("rays", scene="cornell", size=(96, 72))
    samples = [small.reference(n).parts["total"].displayed() for n in (32, 64, 256)]
    save(row([s.repeat(2, axis=0).repeat(2, axis=1) for s in samples]), DOCS / "reference/samples.jpg")
    path = (
        "--path",
        "configs/paths/atrium.ron",
        "--size",
        "240x135",
        "--set",
        "voxel_dim=64",
        "--set",
        "shadow_dim=1024",
    )
    times = [render("configs/rays.ron", "--time", t, *path) for t in ("0", "10", "20", "30")]
    save(row(times), DOCS / "experiments/path.jpg")
    save(render("configs/tour.ron", "--size", "640x360", "--timers", "stages"), DOCS / "stats/timers.jpg")
    rooms = ("furnace", "white-sky", "cornell")
    trials = [rendered(lab, "rays", scene=room, size=(240, 180), voxel_dim=64) for room in rooms]
    save(row(trials), DOCS / "trials/rooms.jpg")


def program() -> str:
    return os.environ.get("CONELAB", str(ROOT / "target/release/conelab"))


def triangles(scene: str) -> int:
    text = subprocess.run([program(), "scene", scene, "--json", "-"], check=True, capture_output=True, text=True).stdout
    return int(json.loads(text)["triangles"])


def gallery(lab: conelab.Lab, chosen: list[str], columns: int = 3) -> None:
    scenes = {name: about for name, about in lab.scenes().items() if not name.endswith(".ron")}
    for scene in chosen or scenes:
        save(rendered(lab, "rays", scene=scene, size=(320, 180), **COARSE), DOCS / f"gallery/{scene}.jpg")
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
    wanted = sys.argv[1:] or ["strip", "tutorials", "pages", "gallery"]
    with conelab.Lab(home=ROOT) as lab:
        for name, _, scenes in (word.partition("=") for word in wanted):
            if name == "gallery":
                gallery(lab, scenes.split(",") if scenes else [])
            else:
                {"strip": strip, "tutorials": tutorials, "pages": pages}[name](lab)


if __name__ == "__main__":
    main()
