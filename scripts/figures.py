#!/usr/bin/env python3
"""Renders pictures of the documents that need no times: the README's strip, the gallery, failures, the tutorials.

    scripts/figures.py [strip] [failures] [motion] [tutorials] [pages] [gallery[=SCENE,...]]      all when none is named

Needs the Python module (`make python`) with Pillow, and the program (CONELAB, or target/release/conelab).
CONELAB_DEVICE chooses the device. A software device has coarser voxels and references. `CONELAB_BLESS=1 cargo test --release --test results` writes the numbers next to the pictures.
"""

import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw, ImageFont

import conelab

ROOT = Path(__file__).resolve().parent.parent
DOCS = ROOT / "docs"
#: Size of the strip's pictures: as large as the README shows them.
SIZE = (240, 135)
#: The gallery's voxels on a software device, so that all scenes take minutes.
COARSE = {"voxel_dim": 64, "shadow_dim": 1024}
#: What each family does worst: name of the picture, graph, scene, and the left upper corner of the crop.
FAILURES = [
    ("lamp", "rays", "lampshade", (115, 95)),
    ("mirror", "rays", "gloss", (215, 65)),
    ("edge", "rays", "door-ajar", (320, 180)),
    ("thesis", "thesis", "sky-window", (300, 60)),
    ("ddgi", "ddgi", "corridor", (270, 175)),
    ("ssgi", "ssgi", "small-quad", (150, 115)),
    ("ssgi-rays", "ssgi_rays", "door-ajar", (345, 95)),
    ("rsm", "rsm", "configs/scenes/sponza.ron", (50, 165)),
    ("lpv", "lpv", "corridor", (180, 90)),
]
#: Size of the pictures that crops are cut from, and of a crop, which is shown at twice its size.
WHOLE, CROP = (480, 270), (120, 80)
#: Methods in motion.
MOVING = ("rays", "cones", "thesis", "ddgi")
#: Where the scale of changes ends, as a fraction of the mean radiance.
FULL_CHANGE = 0.2


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


def is_software(lab: conelab.Lab) -> bool:
    return "llvmpipe" in lab.device["name"]


def samples(lab: conelab.Lab) -> int:
    """Samples per pixel of references."""
    return 64 if is_software(lab) else 4096


def strip(lab: conelab.Lab) -> None:
    """The scene is `STRIP` of tests/results.rs, which writes the numbers."""
    where = {"scene": "sky-window", "size": SIZE}
    pictures = [rendered(lab, name, **where) for name in ("thesis", "cones", "rays")]
    reference = lab.open("rays", **where).reference(samples(lab))
    save(row([*pictures, reference.parts["total"].displayed()]), DOCS / "strip.jpg")


def failures(lab: conelab.Lab) -> None:
    """Crops of what each family does worst, each beside its reference."""
    for name, graph, scene, (left, top) in FAILURES:
        opened = lab.open(graph, scene=scene, size=WHOLE)
        method = opened.render().picture
        reference = opened.reference(samples(lab)).parts["total"].displayed()
        opened.close()
        area = np.s_[top : top + CROP[1], left : left + CROP[0], :3]
        pair = row([method[area], reference[area]], 3)
        save(pair.repeat(2, axis=0).repeat(2, axis=1), DOCS / f"failures/{name}.jpg")


    save(late(lab), DOCS / "failures/late.jpg")


def late(lab: conelab.Lab, frames: tuple[int, ...] = (1, 4, 16, 32)) -> np.ndarray:
    """Frames after the sun was switched on that lights a corridor around two corners, and the converged picture."""
    opened = lab.open("rays", scene="corridor", size=(160, 120))
    opened.set(lights={opened.lights[0]: {"color": (0, 0, 0)}})
    opened.render()
    opened.set(lights={})
    pictures = [opened.render(1, restart=False).picture for _ in range(max(frames))]
    shown = [pictures[frame - 1][..., :3] for frame in frames]
    converged = np.array(opened.render().picture[..., :3])
    opened.close()
    return row([*shown, converged])


def changes(lab: conelab.Lab, graph: str, case: str, frames: int = 16) -> tuple[np.ndarray, np.ndarray]:
    """Radiance of the last two frames in which something moves in `moving-box`; of two references if `graph` is that."""
    traced = graph == "reference"
    step, turn = (0.033 if case == "box" else 0.0), (0.7 if case == "turn" else 0.0)
    opened = lab.open("rays" if traced else graph, scene="moving-box", size=(240, 180), time=1.5)
    camera = opened.camera
    if not traced:
        if case == "switch":
            opened.set(lights={opened.lights[0]: {"color": (0, 0, 0)}})
        opened.render(1, warmup=200)
        opened.set(lights={})
    pictures = []
    for frame in range(1, frames + 1):
        if turn:
            opened.set_camera(camera.turned(turn * frame))
        if not traced:
            pictures.append(np.asarray(opened.render(1, warmup=0, step=step, restart=False).linear))
        elif frame > frames - 2:
            opened.set(time=1.5 + step * frame)
            pictures.append(np.asarray(opened.reference(samples(lab)).parts["total"]))
    opened.close()
    return pictures[-2], pictures[-1]


def motion(lab: conelab.Lab) -> None:
    """By how much the change from frame to frame differs from that of the reference: cases by methods, on one scale."""
    cases = {"turn": "the camera turns", "box": "a box moves", "switch": "a lamp was switched on"}
    label = ImageFont.load_default(13)
    lines = []
    for case, title in cases.items():
        before, after = changes(lab, "reference", case)
        mean = float(after.mean())
        cells = [conelab.Picture(after).displayed()[..., :3]]
        for graph in MOVING:
            old, new = changes(lab, graph, case)
            error = np.abs((new - old) - (after - before)).mean(axis=-1) / mean
            print(case, graph, f"mean {error.mean():.4f}", flush=True)
            cells.append(conelab.heat(error / FULL_CHANGE))
        line = Image.fromarray(row(cells))
        for x, text in enumerate((title, *MOVING)):
            ImageDraw.Draw(line).text((6 + 246 * x, 4), text, "white", label, stroke_width=2, stroke_fill="black")
        lines.append(np.asarray(line))
    bar = Image.fromarray(conelab.heat(np.tile(np.linspace(0, 1, lines[0].shape[1]), (22, 1))))
    least, most = "0", f"{100 * FULL_CHANGE:.0f} % of the mean radiance"
    ImageDraw.Draw(bar).text((6, 3), least, "white", label)
    ImageDraw.Draw(bar).text((bar.width - 6, 3), most, "black", label, anchor="ra")
    save(np.concatenate([*lines, np.asarray(bar)]), DOCS / "motion.jpg")


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
    reference = lab.open("rays", **where).reference(samples(lab))
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
        coarse = COARSE if is_software(lab) else {}
        save(rendered(lab, "rays", scene=scene, size=(320, 180), **coarse), DOCS / f"gallery/{scene}.jpg")
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
    parts = {f.__name__: f for f in (strip, failures, motion, tutorials, pages)}
    wanted = sys.argv[1:] or [*parts, "gallery"]
    with conelab.Lab(home=ROOT) as lab:
        for name, _, scenes in (word.partition("=") for word in wanted):
            if name == "gallery":
                gallery(lab, scenes.split(",") if scenes else [])
            else:
                parts[name](lab)


if __name__ == "__main__":
    main()
