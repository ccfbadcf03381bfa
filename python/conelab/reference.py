"""Pictures, and references that pictures are scored against."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from . import _conelab
from .errors import RequestError

#: What the values of a picture mean.
KINDS = ("direct", "radiance", "openness", "displayed")


class Picture:
    """A picture in linear RGB.

    Attributes:
        array: [height, width, 3], float32. `numpy.asarray(picture)` is the same array.
        kind: radiance; direct (radiance from lights); openness (0 to 1); displayed (0 to 1, from a PNG).
    """

    def __init__(self, array: Any, kind: str = "radiance"):
        array = np.asarray(array)
        if array.ndim == 2:
            array = np.repeat(array[..., None], 3, axis=2)
        if array.ndim != 3 or array.shape[2] not in (3, 4):
            raise RequestError(f"a picture has the shape [height, width, 3], not {list(array.shape)}")
        if kind not in KINDS:
            raise RequestError(f"no kind of picture '{kind}': there are {', '.join(KINDS)}")
        if array.dtype.kind in "ui":
            message = (
                "whole numbers are not linear radiance: divide, and undo the display's curve; or give a PNG's path"
            )
            raise RequestError(message)
        self.array: np.ndarray = np.asarray(array[..., :3], dtype=np.float32)
        self.kind = kind

    @staticmethod
    def read(path: str | os.PathLike[str]) -> Picture:
        """Reads an .exr or .hdr file (radiance) or a .png file (sRGB, decoded to linear)."""
        kind, memory = _conelab.read_picture(os.fspath(path))
        return Picture(np.asarray(memory), kind)

    def write(self, path: str | os.PathLike[str]) -> Path:
        """Writes an .exr file of 32-bit floats."""
        _conelab.write_picture(os.fspath(path), self._given())
        return Path(path)

    @property
    def size(self) -> tuple[int, int]:
        """Width and height, pixels."""
        height, width = self.array.shape[:2]
        return width, height

    def displayed(self, exposure: float = 0.0) -> np.ndarray:
        """The picture for a display: [height, width, 3], uint8, sRGB.

        Radiance goes through c / (1 + c), the program's default.

        Args:
            exposure: stops.
        """
        shown = np.frombuffer(_conelab.displayed(self._given(), exposure), np.uint8)
        return shown.reshape(self.array.shape).copy()

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> np.ndarray:
        array: np.ndarray[Any, Any] = np.array(self.array, dtype=dtype) if copy else np.asarray(self.array, dtype=dtype)
        return array

    def __repr__(self) -> str:
        width, height = self.size
        return f"<Picture {width}x{height}, {self.kind}, mean {float(self.array.mean()):.4g}>"

    def _repr_png_(self) -> bytes:
        return png(self.displayed())

    def _given(self) -> tuple[str, int, int, bytes]:
        return (self.kind, *self.size, np.ascontiguousarray(self.array).tobytes())


def png(rgb: np.ndarray) -> bytes:
    """A PNG file of [height, width, 3 or 4], uint8."""
    height, width = rgb.shape[:2]
    rgba = np.empty((height, width, 4), np.uint8)
    rgba[..., :3] = rgb[..., :3]
    rgba[..., 3] = 255
    return _conelab.png(width, height, rgba.tobytes())


class Reference:
    """What pictures are scored against: pictures of parts of the light, with their noise.

    Attributes:
        name: for tables.
        parts: pictures by name; "total" is the whole light.
        noise: of each part, if known: `relmse` between the halves of the samples, `flip` and `structure` of the mean.
        samples: per pixel; None of another program's.
        folder: where it is kept; None of another program's.
    """

    def __init__(
        self,
        parts: Mapping[str, Any] | Any,
        *,
        name: str = "reference",
        noise: Mapping[str, Mapping[str, float]] | None = None,
    ):
        """A reference of one's own.

        Args:
            parts: pictures by the names of parts; or one, of the total: an array, a `Picture`, or the path of a file.
            name: for tables.
            noise: of parts.
        """
        if not isinstance(parts, Mapping):
            parts = {"total": parts}
        self.name = name
        self.parts: dict[str, Picture] = {part: picture(p) for part, p in parts.items()}
        self.noise: dict[str, dict[str, float]] = {part: dict(n) for part, n in (noise or {}).items()}
        self.samples: int | None = None
        self.folder: Path | None = None

    @classmethod
    def traced(cls, native: _conelab.Reference) -> Reference:
        """A reference that conelab traced. Its pictures share the program's memory and cannot be written to."""
        kinds = native.parts()
        made = cls({part: Picture(np.asarray(native.mean(part)), kind) for part, kind in kinds})
        made.name = f"path traced, {native.samples} samples a pixel"
        made.noise = {part: native.noise(part) for part, _ in kinds}
        made.samples = native.samples
        made.folder = Path(native.folder)
        return made

    @property
    def total(self) -> Picture:
        """The whole light."""
        return self.parts["total"]

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> np.ndarray:
        return self.total.__array__(dtype, copy)

    def __repr__(self) -> str:
        width, height = next(iter(self.parts.values())).size
        return f"<Reference {width}x{height}: {self.name}; parts {', '.join(self.parts)}>"

    def _repr_png_(self) -> bytes:
        return self.total._repr_png_()


def picture(of: Any) -> Picture:
    """A picture from a picture, an array, or the path of a file."""
    if isinstance(of, Picture):
        return of
    if isinstance(of, (str, os.PathLike)):
        return Picture.read(of)
    return Picture(of)


def reference(of: Any) -> Reference:
    """A reference from a reference, a picture of the total, or pictures by part."""
    return of if isinstance(of, Reference) else Reference(of)
