#!/usr/bin/env python3
"""Renders docs/gallery/SCENE.jpg for every built-in scene with rays.ron, and writes the pictures of docs/gallery.md.

    scripts/gallery.py [SCENE...]

Needs the Python module with matplotlib (`make python`) and the program (CONELAB, or target/release/conelab). CONELAB_DEVICE chooses the device. Named scenes alone are
rendered again; the page is always written. The table of errors is written by `CONELAB_BLESS=1 cargo test --test results`.
"""

import json
import os
import subprocess
import sys
from pathlib import Path

from PIL import Image

import conelab

ROOT = Path(__file__).resolve().parent.parent
PAGE = ROOT / "docs/gallery.md"
SIZE = (480, 270)
COLUMNS = 3


def rendered(lab: conelab.Lab, scene: str, path: Path) -> None:
    experiment = lab.open("rays", scene=scene, size=SIZE)
    picture = experiment.render().picture
    Image.fromarray(picture[..., :3]).save(path, quality=88, optimize=True, progressive=True)
    experiment.close()


def triangles(scene: str) -> int:
    program = os.environ.get("CONELAB", ROOT / "target/release/conelab")
    text = subprocess.run([program, "scene", scene, "--json", "-"], check=True, capture_output=True, text=True).stdout
    return int(json.loads(text)["triangles"])


def main() -> None:
    chosen = sys.argv[1:]
    folder = ROOT / "docs/gallery"
    folder.mkdir(exist_ok=True)
    with conelab.Lab(home=ROOT) as lab:
        scenes = {name: about for name, about in lab.scenes().items() if not name.endswith(".ron")}
        for scene in chosen or scenes:
            rendered(lab, scene, folder / f"{scene}.jpg")
            print(scene, flush=True)
    names = list(scenes)
    rows = []
    for first in range(0, len(names), COLUMNS):
        some = names[first : first + COLUMNS]
        cells = [
            f"![{name}](gallery/{name}.jpg)<br>`{name}`, {triangles(name):,} triangles: {scenes[name]}" for name in some
        ]
        rows.append("| " + " | ".join(cells + [""] * (COLUMNS - len(cells))) + " |")
    table = "\n".join(["|" + " |" * COLUMNS, "|" + "---|" * COLUMNS, *rows])
    text = PAGE.read_text()
    start, end = "<!-- pictures: scripts/gallery.py -->", "<!-- end -->"
    head, rest = text.split(start, 1)
    PAGE.write_text(f"{head}{start}\n\n{table}\n\n{end}{rest.split(end, 1)[1]}")


if __name__ == "__main__":
    main()
