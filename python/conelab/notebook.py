"""Controls in notebooks."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from .errors import Error, RequestError
from .params import Param

if TYPE_CHECKING:
    from .experiment import Experiment


def _control(widgets: Any, p: Param) -> Any:
    """The widget of a parameter; nothing for vectors."""
    shared = {"description": p.name, "tooltip": p.help, "style": {"description_width": "10em"}}
    slider = {**shared, "continuous_update": False}
    if p.kind == "bool":
        return widgets.Checkbox(value=p.value, **shared)
    if p.kind == "choice":
        return widgets.Dropdown(options=p.options, value=p.value, **shared)
    if p.kind == "int" and p.range:
        least, most = (int(v) for v in p.range)
        return widgets.IntSlider(value=p.value, min=least, max=most, step=int(p.step or 1), **slider)
    if p.kind == "float" and p.range:
        low, high = p.range
        return widgets.FloatSlider(value=p.value, min=low, max=high, step=p.step or (high - low) / 100, **slider)
    return None


def interact(experiment: Experiment, names: Sequence[str], camera: bool, width: int) -> Any:
    """See `Experiment.interact`."""
    try:
        import ipywidgets as widgets
    except ImportError:
        raise RequestError("interact needs ipywidgets: pip install 'conelab[notebook]'") from None
    known = {name: experiment.params.info(name) for name in experiment.params}
    chosen = list(names) or [name for name, p in known.items() if not p.compiled]
    for name in chosen:
        if name not in known:
            experiment.params.info(name)
    controls = {name: _control(widgets, known[name]) for name in chosen}
    if names and any(c is None for c in controls.values()):
        raise RequestError("only numbers with a range, choices and switches have controls")
    controls = {name: c for name, c in controls.items() if c is not None}
    picture = widgets.Image(format="png", width=width)
    status = widgets.Label()
    start = experiment.camera

    def show() -> None:
        shot = experiment.render(incremental=True, progress=False)
        picture.value = shot._repr_png_()
        status.value = f"{shot.gpu_ms:.3f} ms on {shot.stats['device']['name']}"

    def change(name: str, value: Any) -> None:
        try:
            experiment.set(progress=False, **{name: value})
            show()
        except Error as why:
            status.value = str(why)

    for name, control in controls.items():
        control.observe(lambda event, name=name: change(name, event["new"]), names="value")
    turns = []
    if camera:
        style = {"description_width": "10em"}
        slider = {"continuous_update": False, "style": style}
        yaw = widgets.FloatSlider(0.0, min=-180.0, max=180.0, step=1.0, description="yaw, degrees", **slider)
        pitch = widgets.FloatSlider(0.0, min=-89.0, max=89.0, step=1.0, description="pitch, degrees", **slider)
        distance = widgets.FloatLogSlider(1.0, min=-1.0, max=1.0, step=0.02, description="distance", **slider)
        turns = [yaw, pitch, distance]

        def turn(_: Any) -> None:
            try:
                experiment.set_camera(start.turned(yaw.value, pitch.value, distance.value))
                show()
            except Error as why:
                status.value = str(why)

        for control in turns:
            control.observe(turn, names="value")
    show()
    return widgets.HBox([widgets.VBox([picture, status]), widgets.VBox([*turns, *controls.values()])])
