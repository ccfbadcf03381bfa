"""Python values as RON, the format of graphs and experiments."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from dataclasses import dataclass
from numbers import Integral, Real
from typing import Any

from .errors import RequestError

Vector = tuple[float, float, float]


@dataclass(frozen=True)
class Camera:
    """A camera.

    Attributes:
        eye: where it is, m.
        target: a point that it looks at, m.
        fov_y: vertical field of view, degrees.
        up: a direction that is up in the picture.
    """

    eye: Vector
    target: Vector
    fov_y: float = 60.0
    up: Vector = (0.0, 1.0, 0.0)

    def turned(self, yaw: float = 0.0, pitch: float = 0.0, distance: float = 1.0) -> Camera:
        """The camera moved about its target.

        Args:
            yaw: turn about the y axis, degrees.
            pitch: turn upwards, degrees; the camera stays below the zenith and above the nadir.
            distance: factor of the distance to the target.
        """
        x, y, z = (e - t for e, t in zip(self.eye, self.target))
        radius = math.sqrt(x * x + y * y + z * z)
        longitude = math.atan2(x, z) + math.radians(yaw)
        latitude = math.asin(max(-1.0, min(1.0, y / radius))) + math.radians(pitch)
        latitude = max(math.radians(-89.0), min(math.radians(89.0), latitude))
        radius *= distance
        offset = (
            radius * math.cos(latitude) * math.sin(longitude),
            radius * math.sin(latitude),
            radius * math.cos(latitude) * math.cos(longitude),
        )
        eye = tuple(t + o for t, o in zip(self.target, offset))
        return Camera(eye, self.target, self.fov_y, self.up)  # type: ignore[arg-type]


def ron(value: Any) -> str:
    """A value as RON: mappings become structures, tuples and lists tuples, strings are quoted."""
    if value is None:
        raise RequestError("None is no value of a setting; leave the setting out")
    if isinstance(value, bool) or type(value).__name__ == "bool_":
        return "true" if value else "false"
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False)
    if isinstance(value, Camera):
        return ron({"eye": value.eye, "target": value.target, "up": value.up, "fov_y": float(value.fov_y)})
    if isinstance(value, Integral):
        return str(int(value))
    if isinstance(value, Real):
        number = float(value)
        if not math.isfinite(number):
            raise RequestError(f"{number} is no finite number")
        return repr(number)
    if isinstance(value, Mapping):
        return "(" + ", ".join(f"{name}: {ron(v)}" for name, v in value.items()) + ")"
    try:
        items = [ron(v) for v in value]
    except TypeError:
        raise RequestError(f"a setting cannot be {type(value).__name__}: {value!r}") from None
    return "(" + ", ".join(items) + ("," if len(items) == 1 else "") + ")"


def setting(name: str, value: Any) -> tuple[str, str]:
    """A setting of an experiment with its value as RON. Numbers of cameras are floats there."""
    if name == "off":
        return name, "[" + ", ".join(ron(v) for v in value) + "]"
    if name == "camera" and isinstance(value, Camera):
        floats = Camera(_floats(value.eye), _floats(value.target), float(value.fov_y), _floats(value.up))
        return name, ron(floats)
    return name, ron(value)


def _floats(vector: Any) -> Vector:
    x, y, z = (float(v) for v in vector)
    return x, y, z
