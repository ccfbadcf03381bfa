"""Parameters of an experiment as attributes."""

from __future__ import annotations

import html
import json
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from .errors import RequestError

if TYPE_CHECKING:
    from .experiment import Experiment
    from .settings import Attributes
else:

    class Attributes:
        """Types for editors."""


@dataclass(frozen=True)
class Param:
    """A parameter of a graph.

    Attributes:
        name: its name.
        kind: bool, int, float, vec2, vec3, vec4, colour (linear RGB) or choice.
        value: the present value.
        default: the graph's default.
        range: least and greatest value (of each component), or None.
        step: distance of neighbouring settings, or None.
        unit: of the value.
        group: where the window shows it.
        help: what it does.
        options: of a choice.
        option_help: a line for each option.
        compiled: whether another value needs other shaders or pipelines.
    """

    name: str
    kind: str
    value: Any
    default: Any
    range: tuple[float, float] | None
    step: float | None
    unit: str
    group: str
    help: str
    options: tuple[str, ...]
    option_help: tuple[str, ...]
    compiled: bool


def read(text: str) -> dict[str, Param]:
    """Parameters by name, from the native module's JSON."""

    def frozen(value: Any) -> Any:
        return tuple(value) if isinstance(value, list) else value

    return {p["name"]: Param(**{name: frozen(value) for name, value in p.items()}) for p in json.loads(text)}


class Params(Attributes, Mapping[str, Any]):
    """The parameters of an experiment: `params.aperture` and `params["aperture"]` get and set values.

    A wrong name, kind or value raises `InputError`, names the nearest name or the range, and changes nothing.
    `params.info("aperture")` is the declaration.
    """

    _experiment: Experiment

    def __init__(self, experiment: Experiment):
        object.__setattr__(self, "_experiment", experiment)

    def _all(self) -> dict[str, Param]:
        return read(self._experiment._native.params())

    def info(self, name: str) -> Param:
        """The declaration of a parameter, with its present value."""
        params = self._all()
        if name not in params:
            raise RequestError(f"graph '{self._experiment.graph_name}' has no parameter '{name}'")
        return params[name]

    def __getitem__(self, name: str) -> Any:
        params = self._all()
        if name not in params:
            raise KeyError(name)
        return params[name].value

    def __setitem__(self, name: str, value: Any) -> None:
        self._experiment.set(**{name: value})

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_"):
            raise AttributeError(name)
        try:
            return self[name]
        except KeyError:
            graph = self._experiment.graph_name
            raise AttributeError(f"graph '{graph}' has no parameter '{name}'") from None

    def __setattr__(self, name: str, value: Any) -> None:
        self[name] = value

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *self._all()]

    def __iter__(self) -> Iterator[str]:
        return iter(self._all())

    def __len__(self) -> int:
        return len(self._all())

    def changed(self) -> dict[str, Any]:
        """Values that differ from the graph's defaults, by name."""
        return {name: p.value for name, p in self._all().items() if p.value != p.default}

    def __repr__(self) -> str:
        return f"<Params {dict(self)}>"

    def _repr_html_(self) -> str:
        def row(p: Param) -> str:
            limits = f"{p.range[0]:g} to {p.range[1]:g}" if p.range else ", ".join(p.options)
            value = f"<b>{p.value}</b>" if p.value != p.default else f"{p.value}"
            return (
                f"<tr><td>{p.name}</td><td>{value}</td><td>{html.escape(limits)} {html.escape(p.unit)}</td>"
                f"<td style='text-align:left'>{html.escape(p.help)}</td></tr>"
            )

        head = "<tr><th>parameter</th><th>value</th><th>range</th><th>help</th></tr>"
        return "<table>" + head + "".join(row(p) for p in self._all().values()) + "</table>"
