"""Types of settings, for completion in editors: `python -m conelab.stubs` writes `settings.py` for the package's graphs.

For graphs of one's own: `python -m conelab.stubs --home FOLDER > settings.py`.
"""

from __future__ import annotations

import sys
from pathlib import Path

from . import _conelab
from .params import Param, read

_TYPES = {"bool": "bool", "int": "int", "float": "float", "vec2": "Vector2", "vec3": "Vector3", "vec4": "Vector4"}

_HEAD = '''"""Settings with their types, made by `python -m conelab.stubs`: parameters of all graphs."""

from __future__ import annotations

from typing import Any, Literal, TypedDict

from .ron import Camera

Vector2 = tuple[float, float]
Vector3 = tuple[float, float, float]
Vector4 = tuple[float, float, float, float]
'''

_FIELDS = '''
class Settings(Parameters, total=False):
    """Settings of an experiment: fields, and parameters of its graph."""

    graph: str
    """File of the graph."""
    scene: Any
    """A built-in scene's name, or a file."""
    camera: str | Camera
    """A camera of the scene, or one in numbers."""
    size: tuple[int, int]
    """Width and height, pixels."""
    time: float
    """Time of the animation, s."""
    sky: Vector3
    """Radiance of the sky."""
    environment: dict[str, Any]
    """Changes of the sky's picture: file, rotation (degrees), intensity."""
    lights: dict[str, dict[str, Any]]
    """Changes of the scene's lights, by name."""
    off: list[str]
    """Passes that are left out."""
'''


def _type(p: Param, options: list[str]) -> str:
    if p.kind == "choice":
        return "Literal[" + ", ".join(f'"{option}"' for option in options) + "]"
    return "Vector3" if p.kind == "colour" else _TYPES[p.kind]


def _text(p: Param) -> str:
    limits = f", {p.range[0]:g} to {p.range[1]:g}" if p.range else ""
    unit = f" {p.unit}" if p.unit else ""
    return f"{p.help.rstrip('.')} ({p.default}{unit}{limits})."


def settings(home: Path) -> str:
    """The text of `settings.py` for the graphs of a home."""
    known: dict[str, tuple[Param, list[str]]] = {}
    for file in sorted((home / "passes").glob("*.ron")):
        for name, p in read(_conelab.graph_params(str(home), file.name)).items():
            _, options = known.setdefault(name, (p, []))
            options.extend(option for option in p.options if option not in options)
    out = [_HEAD]
    types = {name: _type(p, options) for name, (p, options) in sorted(known.items())}
    out.append('\nclass Parameters(TypedDict, total=False):\n    """Parameters by name, as keywords."""\n')
    out.extend(f"    {name}: {kind}" for name, kind in types.items())
    out.append(_FIELDS)
    out.append(
        '\nclass Attributes:\n    """Parameters as attributes of `Experiment.params`, with their defaults and ranges."""\n'
    )
    for name, kind in types.items():
        text = _text(known[name][0]).replace("\\", "\\\\").replace('"', "'")
        out.append(f'    {name}: {kind}\n    """{text}"""')
    return "\n".join([*out, ""])


def main() -> None:
    """Writes the package's file, or prints that of another home."""
    if "--home" in sys.argv:
        print(settings(Path(sys.argv[sys.argv.index("--home") + 1])), end="")
        return
    package = Path(__file__).parent
    (package / "settings.py").write_text(settings(package / "home"))


if __name__ == "__main__":
    main()
