"""The lab: a device, and what runs on it."""

from __future__ import annotations

import difflib
import os
import weakref
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from . import _conelab
from .errors import RequestError, spelling
from .progress import Callback, bar, log
from .ron import setting

if TYPE_CHECKING:
    import pandas as pd
    from typing_extensions import Unpack

    from .campaign import Bench, Fit, Stability
    from .experiment import Experiment
    from .settings import Parameters, Settings

#: Fields of an experiment; every other setting is a parameter of its graph.
FIELDS = ("graph", "scene", "camera", "size", "time", "sky", "environment")


def devices() -> pd.DataFrame:
    """The Vulkan devices: name, kind, driver, api, and `refused`, why one cannot be used (None: it can)."""
    import pandas as pd

    return pd.DataFrame(_conelab.devices(), columns=["name", "kind", "driver", "api", "refused"])


class Lab:
    """A device with conelab's graphs, shaders and experiments. It belongs to the thread that makes it.

    Use it as a context manager, or call `close`: experiments leave the device then.

    Args:
        device: part of a device's name, or its number in `devices()`; the environment's CONELAB_DEVICE when absent, else
            the fastest kind of device.
        home: the folder with `passes`, `shaders` and `configs`. When absent: CONELAB_HOME, a checkout that the working
            folder is in, else the copies that came with the package.
        captures: folder of references and of whatever is made; `captures` in the checkout, or in the working folder if
            the package's copies are used.
        validate: enable the Vulkan validation layer; each message raises `ValidationError`.
        without: optional features that are not used even if the device has them.
        memory: GiB that a graph may use; the device's own when absent.
        hang_after: seconds that a frame may take before the device counts as hung (ten times as long on a software
            device).

    Raises:
        DeviceError: no Vulkan driver or no device that fits.
        RequestError: no folders.
    """

    def __init__(
        self,
        device: str | int | None = None,
        *,
        home: str | os.PathLike[str] | None = None,
        captures: str | os.PathLike[str] | None = None,
        validate: bool | None = None,
        without: Iterable[str] = (),
        memory: float | None = None,
        hang_after: float | None = None,
    ):
        if device is None:
            device = os.environ.get("CONELAB_DEVICE") or None
        if validate is None:
            validate = os.environ.get("CONELAB_VALIDATION", "").lower() in ("1", "true", "yes", "on")
        packaged = Path(__file__).parent / "home"
        self._native = _conelab.Lab(
            None if device is None else str(device),
            None if home is None else os.fspath(home),
            packaged if packaged.is_dir() else None,
            None if captures is None else os.fspath(captures),
            validate,
            list(without),
            memory,
            hang_after,
        )
        self._open: weakref.WeakSet[Experiment] = weakref.WeakSet()

    def __enter__(self) -> Lab:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """Leaves the device. Its experiments can no longer be used; pictures and results can."""
        for experiment in list(self._open):
            experiment.close()
        self._native.close()

    @property
    def device(self) -> dict[str, str]:
        """Name, kind (discrete, integrated, virtual, cpu, other), driver and api of the device."""
        return self._native.device()

    @property
    def home(self) -> Path:
        """The folder with graphs, shaders and experiments."""
        return Path(self._native.folders[0])

    @property
    def captures(self) -> Path:
        """The folder of references and of whatever is made."""
        return Path(self._native.folders[1])

    def experiments(self) -> list[str]:
        """Names of the experiments in `home`, for `open`."""
        return sorted(path.stem for path in (self.home / "configs").glob("*.ron"))

    def scenes(self) -> pd.Series[str]:
        """What every built-in scene shows, by name, and scene files of `home`, for the argument `scene`."""
        import pandas as pd

        files = sorted((self.home / "configs" / "scenes").glob("*.ron"))
        named = dict(_conelab.scenes()) | {str(f.relative_to(self.home)): "a scene file" for f in files}
        return pd.Series(named, name="scene")

    def __repr__(self) -> str:
        try:
            device = self.device
        except RequestError:
            return "<Lab, closed>"
        return f"<Lab on {device['name']} ({device['driver']}), home {self.home}>"

    def open(
        self,
        experiment: str | os.PathLike[str] | Mapping[str, Any] | pd.Series,
        *,
        keep: Sequence[str] = (),
        progress: bool | Callback = True,
        **settings: Unpack[Settings],
    ) -> Experiment:
        """Opens an experiment.

        Args:
            experiment: a name of `experiments()`, the path of a .ron file, or a row of a table that this package made,
                which opens exactly what was measured.
            keep: textures that frames keep for `texture`, besides the picture. Others are rendered again when they are
                asked for.
            progress: show a bar while the scene is read; or a callback.
            settings: fields (`scene`, `camera`, `size`, `time`, `sky`, `environment`, `lights`, `graph`) and parameters
                of the graph. A camera is a name in the scene, or a `Camera`.

        Raises:
            InputError: unknown names (with the nearest), wrong kinds, values out of range; mistakes in its files.
            ShaderError: mistakes in its shaders.
            SceneError: there is no such scene, or it cannot be read.
        """
        from .experiment import Experiment

        file, text = self._source(experiment)
        lights = settings.pop("lights", None)
        with spelling(settings, Lab.open), bar(progress) as callback:
            native = _conelab.Experiment.open(
                self._native, os.fspath(file), text, self._settings(settings), list(keep), callback
            )
        opened = Experiment(self, native)
        self._open.add(opened)
        if lights is not None:
            opened.set(lights=lights)
        scene, graph = native.warnings()
        for message in scene + [w["message"] for w in graph]:
            log.warning("%s: %s", opened.name, message)
        return opened

    def sweep(
        self,
        experiments: str | os.PathLike[str] | Experiment | Sequence[str | os.PathLike[str] | Experiment],
        axes: Mapping[str, Sequence[Any]] | None = None,
        *,
        reference: int | str | None = None,
        frames: int | None = None,
        warmup: int | None = None,
        folder: str | os.PathLike[str] | None = None,
        again: bool = False,
        progress: bool | Callback = True,
        **settings: Unpack[Settings],
    ) -> pd.DataFrame:
        """Measures every experiment with every combination of the axes' values: times, memory, scores of each part.

        Args:
            experiments: experiments, by name, path or open; or the path of one sweep file (docs/sweeps.md), without axes.
            axes: values by the names of fields (`scene`, `size`, ...) or parameters.
            reference: samples per pixel of references, which are traced first, or a bound on their noise, as
                "flip=0.01"; when absent, references that exist are used.
            frames: timed frames of each point; 20 when absent.
            warmup: least number of frames before them; 40 when absent. A graph that needs more to converge gets them.
            folder: for the points, in the working folder if relative; `captures/sweeps/NAME` when absent. Points in it are
                not measured again; `sweep.csv` there is replaced by each sweep.
            again: measure failed points again.
            settings: of every point.

        Returns:
            A row for each point; columns as in `sweep.csv` (docs/tables.md), numbers as numbers. `lab.open(row)` opens a
            row.

        Raises:
            CampaignError: points failed; `result` has the table with their errors.
        """
        from .campaign import sweep

        return sweep(self, experiments, axes, reference, frames, warmup, folder, again, progress, settings)

    def bench(
        self,
        experiments: str | os.PathLike[str] | Experiment | Sequence[str | os.PathLike[str] | Experiment],
        axes: Mapping[str, Sequence[Any]] | None = None,
        *,
        rounds: int = 5,
        frames: int = 40,
        warmup: int | None = None,
        folder: str | os.PathLike[str] | None = None,
        progress: bool | Callback = True,
        **settings: Unpack[Settings],
    ) -> Bench:
        """Times configurations round by round, so that clocks and heat touch all alike.

        Args:
            experiments: by name, path or open.
            axes: values by the names of fields or parameters.
            rounds: how often each is measured.
            frames: timed frames of a round.
            warmup: frames before them; 128 when absent, on software devices 10.
            folder: for `bench.json` and `bench.csv`; `captures/bench/NAME` when absent.
            settings: of every configuration.

        Returns:
            `Bench` with `table`, a row for each configuration and pass, stage or total (docs/tables.md), and `json`.
        """
        from .campaign import bench

        return bench(self, experiments, axes, rounds, frames, warmup, folder, progress, settings)

    def fit(
        self,
        experiment: str | os.PathLike[str] | Experiment,
        axes: Mapping[str, Sequence[Any]] | None = None,
        *,
        max_error: float | None = None,
        max_ms: float | None = None,
        metric: str = "flip",
        part: str = "total",
        evaluations: int = 200,
        frames: int = 20,
        warmup: int = 40,
        spp: int = 1024,
        reference_bounces: int | None = None,
        output: str | os.PathLike[str] | None = None,
        progress: bool | Callback = True,
        **settings: Unpack[Settings],
    ) -> Fit:
        """Searches the cheapest setting within an error, or the best within a time.

        Args:
            experiment: by name, path or open.
            axes: values by the names of parameters; those that the graph declares (`fit`) when absent.
            max_error: bound on the error; the time is minimised.
            max_ms: bound on the time of a frame, ms; the error is minimised.
            metric: a key of `metrics()`.
            part: part of the light.
            evaluations: settings to measure, at most.
            frames, warmup: of each setting.
            spp: samples per pixel of the reference, at least.
            reference_bounces: of the reference; 64 when absent.
            output: .ron file for the setting found; `captures/fit/NAME.ron` when absent. The trials are in the folder
                of that name.

        Returns:
            `Fit` with `ms`, `error`, `within`, `trials` (as `sweep`), and `open()`.
        """
        from .campaign import fit

        return fit(
            self, experiment, axes, max_error, max_ms, metric, part, evaluations, frames, warmup, spp, reference_bounces, output,
            progress, settings,
        )  # fmt: skip

    def stability(
        self,
        suite: str | os.PathLike[str],
        *,
        only: Sequence[str] = (),
        methods: Sequence[str] = (),
        size: tuple[int, int] | None = None,
        frames: int | None = None,
        spp: int | None = None,
        references: bool = True,
        folder: str | os.PathLike[str] | None = None,
        progress: bool | Callback = True,
        **settings: Unpack[Parameters],
    ) -> Stability:
        """Measures temporal stability against references while cameras, objects or lights move (docs/stability.md).

        Args:
            suite: a name of `configs/stability`, or the path of a suite.
            only: cases; all when absent.
            methods: methods besides the suite's first; all when absent.
            size: of the pictures.
            frames: of cases without a number of their own.
            spp: samples per pixel of each frame's reference.
            references: trace references; without, only cases that stand still are scored.
            folder: for the results; `captures/stability/NAME` when absent. Results in it are not measured again.
            settings: parameters of every method whose graph has them.

        Returns:
            `Stability` with `cases` and `frames` (as `stability.csv` and `frames.csv`), and the folder of its page.
        """
        from .campaign import stability

        return stability(self, suite, only, methods, size, frames, spp, references, folder, progress, settings)

    def _source(self, experiment: Any) -> tuple[Path, str | None]:
        """File and text of an experiment."""
        if isinstance(experiment, (str, os.PathLike)):
            return self._file(experiment, "configs"), None
        from .campaign import recorded

        return recorded(experiment)

    def _file(self, name: str | os.PathLike[str], folder: str) -> Path:
        """A file as it is named, or of that name in a folder of `home`."""
        path = Path(name)
        if path.suffix == ".ron":
            at_home = self.home / path
            return path if path.exists() or not at_home.exists() else at_home
        known = self.home / folder
        if not (known / f"{path}.ron").is_file():
            names = sorted(p.stem for p in known.glob("*.ron"))
            near = difflib.get_close_matches(str(name), names, n=1)
            hint = f"did you mean '{near[0]}'?" if near else f"there are {', '.join(names)}"
            raise RequestError(f"no file '{name}.ron' in {known} ({hint}); give a name, or the path of a .ron file")
        return known / f"{path}.ron"

    def _settings(self, settings: Mapping[str, Any]) -> list[tuple[str, str]]:
        """Settings as RON. Scene files may be named as in `home`."""
        return [setting(name, self._scene(value) if name == "scene" else value) for name, value in settings.items()]

    def _scene(self, name: Any) -> Any:
        if not isinstance(name, (str, os.PathLike)):
            return name
        path = Path(name)
        if "." in path.name or len(path.parts) > 1:
            found = path if path.exists() or not (self.home / path).exists() else self.home / path
            return str(found.absolute())
        return str(name)
