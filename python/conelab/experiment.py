"""An experiment that runs."""

from __future__ import annotations

import json
import os
import shutil
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from . import _conelab
from .errors import RequestError
from .params import Params
from .progress import Callback, bar, log
from .reference import Picture, Reference
from .render import Graph, Render
from .ron import Camera, ron
from .score import Score

if TYPE_CHECKING:
    import pandas as pd
    from typing_extensions import Unpack

    from .lab import Lab
    from .settings import Settings


class Source:
    """The text of a graph or shader while it is edited.

    Attributes:
        text: assign to it to change the file.
    """

    def __init__(self, text: str):
        self.text = text


class Experiment:
    """A graph in a scene, seen by a camera, on a lab's device. `Lab.open` makes it.

    Attributes:
        params: the graph's parameters.
    """

    def __init__(self, lab: Lab, native: _conelab.Experiment):
        self._lab = lab
        self._native = native
        self._frames = 0
        self._last: Render | None = None
        self._copy: tempfile.TemporaryDirectory[str] | None = None
        self.params = Params(self)

    @property
    def lab(self) -> Lab:
        """The lab that it runs on."""
        return self._lab

    @property
    def name(self) -> str:
        """Name of its file, without the ending."""
        return self._native.about()[0]

    @property
    def graph_name(self) -> str:
        """File of its graph."""
        return self._native.about()[1]

    @property
    def scene(self) -> str:
        """Name or file of its scene."""
        return self._native.about()[2]

    @property
    def size(self) -> tuple[int, int]:
        """Width and height of the picture, pixels."""
        return self._native.about()[3]

    @property
    def time(self) -> float:
        """Time of the animation, s."""
        return self._native.about()[4]

    @property
    def camera(self) -> Camera:
        """The camera in numbers, also where it was given by its name."""
        eye, target, up, fov_y = self._native.camera()
        return Camera(eye, target, fov_y, up)

    @property
    def cameras(self) -> list[str]:
        """Names of the scene's cameras."""
        return self._native.scene()[0]

    @property
    def lights(self) -> list[str]:
        """Names of the scene's lights."""
        return self._native.scene()[1]

    @property
    def bounds(self) -> tuple[np.ndarray, np.ndarray]:
        """Least and greatest corner of the scene's bounds, m."""
        least, most = self._native.scene()[2:]
        return np.array(least), np.array(most)

    def __repr__(self) -> str:
        width, height = self.size
        return f"<Experiment {self.name}: {self.graph_name} in {Path(self.scene).name}, {width}x{height}>"

    def _repr_html_(self) -> str:
        shown = self._last if self._last is not None and self._last.is_current else self.render(progress=False)
        return shown._repr_html_()

    def close(self) -> None:
        """Leaves the device's memory. The next `render` takes it again."""
        self._native.close()
        self._frames += 1

    def set(self, *, progress: bool | Callback = True, **settings: Unpack[Settings]) -> Experiment:
        """Changes fields and parameters, all or none, as in `Lab.open`.

        Numbers that shaders read cost nothing; other parameters may compile shaders or make textures.
        `lights` is a mapping from names of the scene's lights to fields that change, for example
        `{"sun": {"color": (4.0, 3.6, 3.0)}}`, and replaces earlier changes.

        Returns:
            The experiment.
        """
        lights = settings.pop("lights", None)
        if settings:
            with bar(progress) as callback:
                self._native.set(self._lab._settings(settings), callback)
        if lights is not None:
            entries = (f"{ron(name)}: {ron(fields)}" for name, fields in lights.items())
            self._native.set_lights("{" + ", ".join(entries) + "}")
        self._frames += 1
        return self

    def set_camera(self, camera: str | Camera) -> Experiment:
        """Looks through another camera, by its name in the scene or in numbers."""
        return self.set(camera=camera)

    def render(
        self,
        frames: int | None = None,
        *,
        warmup: int | None = None,
        step: float = 0.0,
        restart: bool = True,
        incremental: bool = False,
        progress: bool | Callback = True,
    ) -> Render:
        """Renders. Ctrl-C ends it between two frames.

        Without arguments the picture is that of `conelab render`: as many frames from a fresh start as the graph needs
        to converge, of which the last is timed.

        Args:
            frames: timed frames; 1 when absent.
            warmup: frames before them; when absent, those that the graph needs to converge, or none if `frames` or
                `step` is given.
            step: time between frames, s.
            restart: begin anew; else go on from the last frame, as with a moving camera.
            incremental: run only passes whose inputs changed. The picture is the same to the bit, and comes sooner;
                times are those of the passes that ran.
            progress: show a bar if it takes long; or a callback.

        Returns:
            The last frame's picture, times and memory.
        """
        with bar(progress) as callback:
            stats = self._native.render(frames, warmup, step, restart, incremental, callback)
        self._frames += 1
        self._last = Render(self, json.loads(stats), self._frames)
        return self._last

    def frame(self, step: float = 0.0) -> None:
        """Records and submits one frame after the last, and waits for nothing: the cost of the engine alone."""
        self._native.frame(step)
        self._frames += 1

    def texture(
        self,
        name: str,
        mip: int = 0,
        layer: int = 0,
        *,
        slice: tuple[str | int, int] | None = None,
        progress: bool | Callback = True,
    ) -> np.ndarray:
        """A texture of the last frame, shared with NumPy, not copied.

        A texture that frames do not keep is rendered again from a fresh start; name it in `keep` of `Lab.open` where
        that would be another frame, as after a moving camera.

        Args:
            name: one of `graph.textures`.
            mip: level of detail, from 0.
            layer: of an array, from 0.
            slice: (axis, number): of a volume the texels at that number along "x", "y" or "z".

        Returns:
            [height, width], [height, width, channels], of volumes [depth, height, width, channels]. Halves are float16,
            normalised channels whole numbers as stored; formats that NumPy lacks (r11g11b10f, rgb10a2) float32.
            `numpy.from_dlpack` and `torch.from_dlpack` take it as it is.
        """
        cut = None
        if slice is not None:
            axis, number = slice
            cut = ("xyz".index(axis) if isinstance(axis, str) else int(axis), int(number))
        with bar(progress) as callback:
            memory, _ = self._native.texture(name, mip, layer, cut, callback)
        return np.asarray(memory)

    def buffer(self, name: str, dtype: Any = np.uint32) -> np.ndarray:
        """A buffer of the last frame as numbers of one type, shared with NumPy; see `graph.buffers`."""
        return np.asarray(self._native.buffer(name)).view(dtype)

    @property
    def tables(self) -> list[str]:
        """Names of the graph's tables."""
        return self._native.tables()

    def table(self, name: str) -> np.ndarray:
        """A table of the last frame: a structured array with a field for each column, shared with its buffer.

        `pandas.DataFrame` takes it; columns of vectors have one row of numbers for each row.
        """
        memory, start, stride, rows, columns = self._native.table(name)
        dtype = np.dtype(
            {
                "names": [c[0] for c in columns],
                "formats": [c[2] for c in columns],
                "offsets": [c[1] for c in columns],
                "titles": [f"{c[0]} ({c[3]})" if c[3] else None for c in columns],
                "itemsize": stride,
            }
        )
        return np.asarray(memory)[start : start + rows * stride].view(dtype)

    def parts(self, *, progress: bool | Callback = True) -> dict[str, Picture]:
        """Parts of the last picture's light by name (total, direct, diffuse, ...), radiance; see `conelab compare`."""
        with bar(progress) as callback:
            parts = self._native.parts(callback)
        return {name: Picture(np.asarray(memory), kind) for name, kind, memory in parts}

    def reference(
        self,
        spp: int | None = None,
        *,
        until: str | None = None,
        bounces: int | None = None,
        progress: bool | Callback = True,
    ) -> Reference:
        """The path-traced reference of what the experiment sees. It is kept in `lab.captures` and gathered on from there.

        Args:
            spp: samples per pixel, at least, in steps of 32; 256 when absent, with `until` the most.
            until: bound on its noise, for example "flip=0.01" or "relmse=1e-4".
            bounces: after the first hit; 64 when absent.
            progress: show a bar; Ctrl-C keeps what was gathered.
        """
        with bar(progress) as callback:
            return Reference.traced(self._native.reference(spp, until, bounces, callback))

    def score(
        self,
        reference: Any,
        *,
        masks: Mapping[str, np.ndarray] | None = None,
        parts: Sequence[str] = (),
        progress: bool | Callback = True,
    ) -> Score:
        """Scores the parts of the picture against a reference by every metric; FLIP takes a second per megapixel.

        The parts are those of the last frame; an experiment that has not rendered, or did not keep
        its parts (`keep` of `Lab.open`), renders first, as `render()` does.

        Args:
            reference: a `Reference`; or a picture of the total: an array [height, width, 3] of linear radiance, or the
                path of an .exr or .hdr file, as of another renderer.
            masks: boolean arrays [height, width] by name, whose pixels are scored on their own too.
            parts: of the light; all that both have when absent.
        """
        return Score.of(self.name, self.parts(progress=progress), reference, masks, parts)

    @property
    def graph(self) -> Graph:
        """The graph as it runs: passes, textures, buffers, barriers."""
        return Graph(*self._native.graph())

    def save(self, path: str | os.PathLike[str], *, overwrite: bool = False) -> Path:
        """Writes the experiment as a .ron file for `Lab.open` and the program: what differs from the graph's defaults."""
        self._native.save(os.fspath(path), overwrite)
        return Path(path)

    def export_scene(self, path: str | os.PathLike[str]) -> Path:
        """Writes the scene, with the experiment's light, for another renderer: .obj, .gltf or .glb.

        The logger says what the format cannot hold, as lamps in an .obj file.
        """
        for message in self._native.export_scene(os.fspath(path)):
            log.warning("%s", message)
        return Path(path)

    def sources(self) -> list[str]:
        """Names of the graphs and shaders that `edit` takes."""
        root = Path(self._native.root)
        folders = (root / "passes", root / "shaders")
        return sorted(str(p.relative_to(f)) for f in folders for p in f.rglob("*") if p.is_file())

    def source(self, file: str) -> str:
        """The text of a graph or shader, as it is now for this experiment."""
        return self._path(Path(self._native.root), file).read_text()

    @contextmanager
    def edit(self, file: str, text: str | None = None) -> Iterator[Source]:
        """Edits a graph or shader for this experiment alone; the files in `home` stay as they are.

        The edit is a transaction: at the end of the block the shaders are compiled, and if they cannot be, the
        exception names file, line and source, and the experiment runs on as before.

            with exp.edit("cones/cone.glsl") as source:
                source.text = source.text.replace("0.5", "0.6")

        Args:
            file: as in `sources()`, for example "cones/cone.glsl" or "rays.ron".
            text: the whole new text; the block may change it further.

        Raises:
            ShaderError, InputError: mistakes, when the block ends.
        """
        source = Source(self.source(file) if text is None else text)
        yield source
        self.replace(file, source.text)

    def replace(self, file: str, text: str) -> None:
        """Takes this text for a graph or shader, for this experiment alone; see `edit`."""
        if self._copy is None:
            copy = tempfile.TemporaryDirectory(prefix="conelab-")
            for folder in ("passes", "shaders"):
                shutil.copytree(Path(self._native.root) / folder, Path(copy.name) / folder)
            self._copy = copy
        path = self._path(Path(self._copy.name), file)
        before = path.read_text()
        path.write_text(text)
        try:
            self._native.rebase(self._copy.name)
        except BaseException:
            path.write_text(before)
            raise
        self._frames += 1

    def revert(self) -> None:
        """Forgets all edits."""
        self._native.rebase(None)
        self._copy = None
        self._frames += 1

    def save_sources(self, folder: str | os.PathLike[str]) -> Path:
        """Writes graphs and shaders, with the edits, and the lab's experiments to a folder for `Lab(home=...)`."""
        target = Path(folder)
        for name in ("passes", "shaders"):
            shutil.copytree(Path(self._native.root) / name, target / name)
        shutil.copytree(self._lab.home / "configs", target / "configs")
        return target

    def _path(self, root: Path, file: str) -> Path:
        """A graph or shader of a folder."""
        for folder in (root / "shaders", root / "passes"):
            path = (folder / file).resolve()
            if path.is_file() and path.is_relative_to(folder.resolve()):
                return path
        raise RequestError(f"no graph or shader '{file}': sources() lists them")

    def interact(self, *params: str, camera: bool = True, width: int = 640) -> Any:
        """Sliders for parameters and a camera that turns about its target, in a notebook.

        Args:
            params: names; all numbers and choices that only shaders read when absent.
            camera: whether to show yaw, pitch and distance.
            width: of the shown picture, pixels of the page.

        Raises:
            RequestError: ipywidgets is not installed.
        """
        from .notebook import interact

        return interact(self, params, camera, width)


def table_frame(table: np.ndarray) -> pd.DataFrame:
    """A structured array as a data frame; vectors become one column for each component, `name.x` and so on."""
    import pandas as pd

    columns: dict[str, np.ndarray] = {}
    for name in table.dtype.names or ():
        values = table[name]
        if values.ndim == 1:
            columns[name] = values
        else:
            for i in range(values.shape[1]):
                columns[f"{name}.{'xyzw'[i]}"] = values[:, i]
    return pd.DataFrame(columns)
