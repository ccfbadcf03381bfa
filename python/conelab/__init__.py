"""conelab: a research workbench for voxel cone tracing.

    import conelab

    with conelab.Lab() as lab:
        exp = lab.open("rays", scene="cornell", size=(640, 360))
        shot = exp.render()
        shot.save("cornell.png")
        print(exp.score(exp.reference(256))["flip"])

`Lab` opens a device, `Lab.open` an experiment, `Experiment.render` makes pictures as NumPy arrays,
`Experiment.reference` path-traces what the experiment sees, and `Experiment.score` measures the error by every metric.
`Lab.sweep`, `bench`, `fit` and `stability` return data frames. Messages go to the logger "conelab".
"""

from ._conelab import version as _version
from .campaign import Bench, Fit, Stability, points
from .errors import (
    CampaignError,
    DeviceError,
    DeviceLost,
    Error,
    FileError,
    InputError,
    MetricError,
    RequestError,
    SceneError,
    ShaderError,
    Stopped,
    ThreadError,
    ValidationError,
)
from .experiment import Experiment, Source, table_frame
from .lab import Lab, devices
from .params import Param, Params
from .reference import Picture, Reference
from .render import Graph, Render
from .ron import Camera
from .score import Comparison, Score, compare, heat, metrics

__version__ = _version()

__all__ = [
    "Bench",
    "Camera",
    "CampaignError",
    "Comparison",
    "DeviceError",
    "DeviceLost",
    "Error",
    "Experiment",
    "FileError",
    "Fit",
    "Graph",
    "InputError",
    "Lab",
    "MetricError",
    "Param",
    "Params",
    "Picture",
    "Reference",
    "Render",
    "RequestError",
    "SceneError",
    "Score",
    "ShaderError",
    "Source",
    "Stability",
    "Stopped",
    "ThreadError",
    "ValidationError",
    "compare",
    "devices",
    "heat",
    "metrics",
    "points",
    "table_frame",
]
