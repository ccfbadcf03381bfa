"""What a render returns."""

from __future__ import annotations

import base64
import html
import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from .errors import RequestError
from .reference import Picture, png

if TYPE_CHECKING:
    import pandas as pd

    from .experiment import Experiment


class Render:
    """The last frame of a render. Its times are of that render's timed frames.

    The picture is read at once, other textures when they are asked for, which must be before the experiment renders or
    changes again.

    Attributes:
        stats: measurements and settings, as `conelab render --json` writes them (docs/stats.md).
        picture: [height, width, 3], uint8, sRGB; None if the graph has no `output`.
    """

    def __init__(self, experiment: Experiment, stats: dict[str, Any], number: int):
        self._experiment: Experiment | None = experiment
        self._number = number
        self.stats = stats
        output, self._hdr = experiment._native.results()
        self.picture: np.ndarray | None = None
        if output is not None:
            # Alpha of a picture is not transparency.
            self.picture = experiment.texture(output, progress=False)[..., :3]
        self._linear: Picture | None = None

    def __getstate__(self) -> dict[str, Any]:
        return {**self.__dict__, "_experiment": None}

    @property
    def is_current(self) -> bool:
        """Whether the experiment has neither rendered nor changed since."""
        return self._experiment is not None and self._experiment._frames == self._number

    @property
    def linear(self) -> Picture:
        """The picture before exposure and tone map, radiance."""
        if self._linear is None:
            if self._hdr is None:
                raise RequestError(f"graph '{self.stats['graph']}' has no `hdr`: read a texture")
            if not self.is_current or self._experiment is None:
                raise RequestError("the experiment has rendered or changed since: ask for `linear` before that")
            self._linear = Picture(self._experiment.texture(self._hdr, progress=False))
        return self._linear

    @property
    def passes(self) -> pd.DataFrame:
        """Times of the passes on the GPU, ms: a row for each, by name, with stage, min, median, p95, frames, skipped."""
        import pandas as pd

        rows = [
            {"pass": p["name"], "stage": p["stage"], **p["gpu_ms"], "frames": p["frames"], "skipped": p["skipped"]}
            for p in self.stats["passes"]
        ]
        columns = ["pass", "stage", "min", "median", "p95", "frames", "skipped"]
        return pd.DataFrame(rows, columns=columns).set_index("pass")

    @property
    def stages(self) -> pd.Series:
        """Sum of the passes' median times by stage, ms, in order."""
        return self.passes.groupby("stage", sort=False)["median"].sum()

    @property
    def gpu_ms(self) -> float:
        """Median time of a frame on the GPU, from its first to its last command, ms."""
        return float(self.stats["total_gpu_ms"]["median"])

    @property
    def cpu_ms(self) -> float:
        """Median time of recording and submitting a frame, ms."""
        return float(self.stats["cpu_ms"]["median"])

    @property
    def memory(self) -> pd.Series:
        """Bytes of the graph's textures and buffers by name, the largest first."""
        import pandas as pd

        return pd.Series(self.stats["bytes"], dtype="int64", name="bytes").sort_values(ascending=False)

    @property
    def warnings(self) -> list[str]:
        """Checks of the graph that failed in the last frame."""
        return list(self.stats["warnings"])

    def save(self, path: str) -> Path:
        """Writes the displayed picture as a .png file, or the linear one as .exr."""
        target = Path(path)
        if target.suffix == ".exr":
            return self.linear.write(target)
        if target.suffix != ".png":
            raise RequestError(f"'{path}': give it a name that ends in .png or .exr")
        target.write_bytes(self._repr_png_())
        return target

    def __repr__(self) -> str:
        s = self.stats
        width, height = s["size"]
        return f"<Render {s['experiment']} in {s['scene']}, {width}x{height}: {self.gpu_ms:.3f} ms on {s['device']['name']}>"

    def _repr_png_(self) -> bytes:
        if self.picture is None:
            raise RequestError("the graph has no displayed picture")
        return png(self.picture)

    def _repr_html_(self) -> str:
        stages = "".join(
            f"<tr><td style='text-align:left'>{html.escape(str(name))}</td><td>{ms:.3f}</td></tr>"
            for name, ms in self.stages.items()
        )
        total = f"<tr><th style='text-align:left'>GPU, {html.escape(self.stats['device']['name'])}</th><th>{self.gpu_ms:.3f} ms</th></tr>"
        notes = "".join(f"<p>{html.escape(w)}</p>" for w in self.warnings)
        return (
            "<div style='display:flex;gap:1em;align-items:flex-start'>"
            f"<figure style='margin:0'>{image(self.picture)}<figcaption>{html.escape(self._caption())}</figcaption></figure>"
            f"<table>{total}{stages}</table></div>{notes}"
        )

    def _caption(self) -> str:
        s = self.stats
        return f"{s['experiment']} in {s['scene']}, {s['size'][0]}x{s['size'][1]}"


def image(rgb: np.ndarray | None, width: int = 480) -> str:
    """A picture inside of HTML."""
    if rgb is None:
        return ""
    data = base64.b64encode(png(rgb)).decode()
    return f"<img style='max-width:{width}px' src='data:image/png;base64,{data}'>"


class Graph:
    """A graph as it runs with the present parameters.

    Attributes:
        passes: name, stage, steps in a frame, reads, writes; in order.
        textures: name, extent [width, height, depth], format, mips, layers, transient, history, bytes.
        buffers: name, transient, history, bytes.
        left_out: passes that do not run, with the reason.
        text: all of it with every barrier, as `conelab graph --barriers`.
    """

    def __init__(self, outline: str, text: str):
        import pandas as pd

        data = json.loads(outline)
        self.name: str = data["graph"]
        self.passes = pd.DataFrame(data["passes"], columns=["name", "stage", "steps", "reads", "writes"]).set_index(
            "name"
        )
        self.textures = pd.DataFrame(data["textures"]).set_index("name") if data["textures"] else pd.DataFrame()
        self.buffers = pd.DataFrame(data["buffers"]).set_index("name") if data["buffers"] else pd.DataFrame()
        self.left_out: dict[str, str] = data["left_out"]
        self.text = text

    def __repr__(self) -> str:
        return f"<Graph {self.name}: {len(self.passes)} passes run>"

    def _repr_html_(self) -> str:
        return self.passes.to_html()
