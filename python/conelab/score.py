"""Scores of pictures against a reference."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from . import _conelab
from .errors import RequestError
from .reference import Picture, Reference, picture
from .reference import reference as reference_of
from .render import image

if TYPE_CHECKING:
    import pandas as pd


def metrics() -> pd.DataFrame:
    """The metrics: title, definition, and the best value (0 or 1; NaN: not used to compare), by key."""
    import pandas as pd

    return pd.DataFrame(_conelab.metrics(), columns=["metric", "title", "help", "best"]).set_index("metric")


class Score:
    """Scores of the parts of a picture, in the whole frame and in regions.

    `score["flip"]` is a metric of the total in the frame, `score["flip", "diffuse"]` that of a part, and
    `score["flip", "total", "dark"]` that of a region. Definitions are in docs/metrics.md.

    Attributes:
        json: as `conelab compare --json` writes it.
        parts: the scored pictures, by part.
        table: a row for each part and region; columns are metrics, `share` of the frame, and the reference's noise.
    """

    def __init__(self, data: dict[str, Any], parts: dict[str, Picture], reference: Reference, number: int = 0):
        import pandas as pd

        self.json = data
        self.parts = parts
        self._reference = reference
        self._name = data["pictures"][number]
        rows = []
        for part in data["parts"]:
            noise = {
                "relmse noise": part["noise"],
                "flip noise": part["flip_noise"],
                "structure noise": part["structure_noise"],
            }
            for region in part["regions"]:
                scores = region["scores"][number]
                rows.append(
                    {
                        "part": part["part"],
                        "region": region["region"],
                        "share": region["share"],
                        **(scores or {}),
                        **{name: math.nan if value is None else value for name, value in noise.items()},
                        "relmse within noise": region["within_noise"][number],
                    }
                )
        self.table = pd.DataFrame(rows).set_index(["part", "region"])

    @staticmethod
    def of(
        name: str,
        parts: Mapping[str, Picture],
        reference: Any,
        masks: Mapping[str, np.ndarray] | None = None,
        wanted: Sequence[str] = (),
    ) -> Score:
        """Scores parts of a picture against a reference."""
        reference = reference_of(reference)
        return Score(_compared({name: parts}, reference, masks, wanted), dict(parts), reference)

    def __getitem__(self, key: str | tuple[str, ...]) -> float:
        given = (key,) if isinstance(key, str) else tuple(key)
        metric, part, region = given + ("", "total", "frame")[len(given) :]
        try:
            return float(self.table[metric][(part, region)])
        except KeyError:
            parts, regions = (", ".join(dict.fromkeys(self.table.index.get_level_values(i))) for i in (0, 1))
            message = f"no {metric} of '{part}' in '{region}'; parts: {parts}; regions: {regions}"
            raise RequestError(f"{message}; metrics: {', '.join(self.table.columns)}") from None

    def maps(self, part: str = "total") -> dict[str, np.ndarray]:
        """Maps of the error, [height, width], float32: flip, hdrFlip, luminanceDifference (of the picture less the
        reference, radiance), relativeSquaredError, structure."""
        given = _conelab.error_maps(self.parts[part]._given(), self._reference.parts[part]._given())
        return {name: np.asarray(memory) for name, memory in given}

    def __repr__(self) -> str:
        total = self.table.xs("frame", level="region")
        return f"<Score against {self.json['reference']}\n{total.to_string(float_format='%.4g')}>"

    def _repr_html_(self) -> str:
        part = "total" if "total" in self.parts and "total" in self._reference.parts else next(iter(self.parts))
        pictures = (
            (self.parts[part].displayed(), self._name),
            (self._reference.parts[part].displayed(), self.json["reference"]),
            (heat(self.maps(part)["flip"]), f"FLIP of the {part}, 0 (black) to 1 (white)"),
        )
        figures = "".join(
            f"<figure style='margin:0'>{image(rgb, 320)}<figcaption>{text}</figcaption></figure>"
            for rgb, text in pictures
        )
        table = self.table.xs("frame", level="region").to_html(float_format="{:.4g}".format)
        return f"<div style='display:flex;gap:1em;flex-wrap:wrap'>{figures}</div>{table}"


class Comparison:
    """Two pictures against one reference, or one against the other.

    Attributes:
        json: as `conelab compare --json` writes it.
        scores: of each picture, by name.
        table: both pictures' scores in the frame, by part; and which is better by each metric.
    """

    def __init__(self, data: dict[str, Any], sides: dict[str, dict[str, Picture]], reference: Reference):
        import pandas as pd

        self.json = data
        self.scores = {
            name: Score(data, parts, reference, number) for number, (name, parts) in enumerate(sides.items())
        }
        frames = {name: score.table.xs("frame", level="region") for name, score in self.scores.items()}
        self.table = pd.concat(frames, names=["picture"]).swaplevel().sort_index(kind="stable")
        self.better = pd.DataFrame({part["part"]: part["regions"][0]["better"] for part in data["parts"]})

    def __repr__(self) -> str:
        return f"<Comparison against {self.json['reference']}\n{self.table.to_string(float_format='%.4g')}>"

    def _repr_html_(self) -> str:
        shown = "".join(score._repr_html_() for score in self.scores.values())
        return shown + (self.better.to_html() if len(self.better.columns) else "")


def compare(
    a: Any,
    b: Any,
    reference: Any = None,
    *,
    masks: Mapping[str, np.ndarray] | None = None,
    parts: Sequence[str] = (),
) -> Score | Comparison:
    """Compares two pictures with a reference, or the first with the second.

    Args:
        a, b: experiments, which render what is not rendered; references; arrays of linear radiance; paths of pictures;
            or pictures by part.
        reference: likewise; "auto": the first experiment's reference of 256 samples or more. Without it, `b` is it.
        masks: boolean arrays [height, width] by name.
        parts: of the light; all that everyone has when absent.
    """
    from .experiment import Experiment

    if isinstance(reference, str) and reference == "auto":
        owner = next((side for side in (a, b) if isinstance(side, Experiment)), None)
        if owner is None:
            raise RequestError('reference="auto" needs an experiment')
        reference = owner.reference()
    first = _side(a)
    if reference is None:
        return Score.of(first[0], first[1], _against(b), masks, parts)
    second = _side(b)
    if second[0] == first[0]:
        first, second = (f"{first[0]} (A)", first[1]), (f"{second[0]} (B)", second[1])
    against = _against(reference)
    sides = dict((first, second))
    return Comparison(_compared(sides, against, masks, parts), sides, against)


def _side(of: Any) -> tuple[str, dict[str, Picture]]:
    from .experiment import Experiment
    from .render import Render

    if isinstance(of, Experiment):
        return of.name, of.parts()
    if isinstance(of, Render):
        return of.stats["experiment"], {"total": of.linear}
    if isinstance(of, Reference):
        return of.name, of.parts
    if isinstance(of, Mapping):
        return "picture", {name: picture(p) for name, p in of.items()}
    name = str(of) if isinstance(of, str) or hasattr(of, "__fspath__") else "picture"
    return name, {"total": picture(of)}


def _against(of: Any) -> Reference:
    """What others are compared with. An experiment renders once for it."""
    if isinstance(of, Reference):
        return of
    name, parts = _side(of)
    return Reference(parts, name=name)


def _compared(
    sides: Mapping[str, Mapping[str, Picture]],
    reference: Reference,
    masks: Mapping[str, np.ndarray] | None,
    wanted: Sequence[str],
) -> dict[str, Any]:
    """The native comparison."""
    nothing = {"relmse": math.nan, "flip": math.nan, "structure": math.nan}

    def given(name: str, parts: Mapping[str, Picture], noise: Mapping[str, Mapping[str, float]]) -> Any:
        numbers = {part: {**nothing, **n} for part, n in noise.items() if part in parts}
        known = {part: (n["relmse"], n["flip"], n["structure"]) for part, n in numbers.items()}
        return name, {part: p._given() for part, p in parts.items()}, known

    size = next(iter(reference.parts.values())).size
    flat = []
    for name, mask in (masks or {}).items():
        array = np.asarray(mask)
        if array.shape != (size[1], size[0]):
            raise RequestError(f"mask '{name}' has the shape {list(array.shape)}, the pictures {[size[1], size[0]]}")
        flat.append((name, array.astype(bool).astype(np.uint8).tobytes()))
    pictures = [given(name, parts, {}) for name, parts in sides.items()]
    against = given(reference.name, reference.parts, reference.noise)
    compared: dict[str, Any] = json.loads(_conelab.compare(pictures, against, list(wanted), flat))
    return compared


def heat(values: np.ndarray) -> np.ndarray:
    """A map from 0 to 1 in the colours of the program's error maps (magma): [height, width, 3], uint8."""
    array = np.ascontiguousarray(values, np.float32)
    return np.frombuffer(_conelab.magma(array.tobytes()), np.uint8).reshape(*array.shape, 3).copy()
