"""Campaigns as data frames."""

from __future__ import annotations

import io
import json
import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from . import _conelab
from .errors import CampaignError, RequestError, spelling
from .progress import Callback, bar
from .ron import ron, setting

if TYPE_CHECKING:
    import pandas as pd

    from .experiment import Experiment
    from .lab import Lab

#: Column of tables with the record of a row, from which `Lab.open` opens what was measured: a JSON file, and after `#`
#: the number of a configuration in it.
RECORD = "record"


def _frame(text: str) -> pd.DataFrame:
    """A table of the program as a data frame."""
    import pandas as pd

    return pd.read_csv(io.StringIO(text), keep_default_na=False, na_values=[""])


def _which(lab: Lab, experiments: Any) -> list[Any]:
    """Experiments as the native module takes them."""
    from .experiment import Experiment

    if isinstance(experiments, (str, os.PathLike, Experiment)):
        experiments = [experiments]
    return [e._native if isinstance(e, Experiment) else os.fspath(lab._file(e, "configs")) for e in experiments]


def _axes(lab: Lab, axes: Mapping[str, Sequence[Any]] | None) -> list[tuple[str, list[str]]]:
    def values(name: str, given: Any) -> list[str]:
        if isinstance(given, str):
            raise RequestError(f"axis '{name}' must be a list of values, not the text {given!r}")
        return [setting(name, lab._scene(v) if name == "scene" else v)[1] for v in given]

    return [(name, values(name, given)) for name, given in (axes or {}).items()]


def _name(experiments: Any) -> str:
    from .experiment import Experiment

    first = experiments if isinstance(experiments, (str, os.PathLike, Experiment)) else next(iter(experiments))
    return first.name if isinstance(first, Experiment) else Path(first).stem


def points(folder: str | os.PathLike[str]) -> pd.DataFrame:
    """The table of a sweep's folder, as `Lab.sweep` returns it."""
    path = Path(folder)
    table = _frame((path / "sweep.csv").read_text())
    records = [str((path / "points" / f"{name}.json").absolute()) for name in table["id"]]
    return table.copy().assign(**{RECORD: records})


def recorded(row: Any) -> tuple[Path, str]:
    """File and text of the experiment of a table's row."""
    try:
        file, _, number = str(row[RECORD]).partition("#")
    except (KeyError, TypeError, IndexError):
        message = f"an experiment is a name, a path, or a row with the column '{RECORD}', not {type(row).__name__}"
        raise RequestError(message) from None
    path = Path(file)
    try:
        record = json.loads(path.read_text())
        text = record["configurations"][int(number)]["text"] if number else record["experiment"]
    except (OSError, ValueError, LookupError) as why:
        raise RequestError(f"the record of the row cannot be read: {why}") from None
    if not text:
        raise RequestError("the point of this row was not measured: its scene was not on the machine")
    return (path.parent if number else path.parent.parent) / "experiment.ron", text


def sweep(
    lab: Lab,
    experiments: Any,
    axes: Mapping[str, Sequence[Any]] | None,
    reference: int | str | None,
    frames: int | None,
    warmup: int | None,
    folder: str | os.PathLike[str] | None,
    again: bool,
    progress: bool | Callback,
    settings: Mapping[str, Any],
) -> pd.DataFrame:
    """See `Lab.sweep`."""
    file = None
    if isinstance(experiments, (str, os.PathLike)) and not axes and not settings:
        file = _sweep_file(lab, experiments)
    target = Path(folder) if folder is not None else lab.captures / "sweeps" / _name(file or experiments)
    with spelling(settings, type(lab).sweep), bar(progress) as callback:
        done, failed = _conelab.run_sweep(
            lab._native,
            None if file is None else os.fspath(file),
            [] if file is not None else _which(lab, experiments),
            lab._settings(settings),
            _axes(lab, axes),
            frames,
            warmup,
            None if reference is None else str(reference),
            os.fspath(target),
            again,
            callback,
        )
    table = points(target)
    if failed:
        raise CampaignError(f"{failed} of {done + failed} points failed: see the column 'error' of `result`", table)
    return table


def _sweep_file(lab: Lab, name: str | os.PathLike[str]) -> Path | None:
    """The file of a sweep, if that is what is named."""
    path = Path(name)
    for found in (path, lab.home / path, lab.home / "configs" / "sweeps" / f"{path}.ron"):
        if found.suffix == ".ron" and found.is_file():
            return None if "experiments:" not in found.read_text() else found
    return None


class Bench:
    """Times of configurations.

    Attributes:
        table: a row for each configuration and pass, stage or total, as `bench.csv` (docs/tables.md). `lab.open(row)`
            opens a configuration.
        json: as `bench.json`.
        folder: with both files.
    """

    def __init__(self, folder: Path):
        self.folder = folder
        self.json: dict[str, Any] = json.loads((folder / "bench.json").read_text())
        self.table = _frame((folder / "bench.csv").read_text())
        file = (folder / "bench.json").absolute()
        numbers = [
            number
            for number, c in enumerate(self.json["configurations"])
            for _ in range(
                1 if c["times"] is None else len(c["times"]["stats"]["passes"]) + len(c["times"]["stages"]) + 1
            )
        ]
        self.table = self.table.assign(**{RECORD: [f"{file}#{number}" for number in numbers]})

    def __repr__(self) -> str:
        return f"<Bench on {self.json['device']['name']}\n{self.table.to_string()}>"

    def _repr_html_(self) -> str:
        return self.table.to_html()


def bench(
    lab: Lab,
    experiments: Any,
    axes: Mapping[str, Sequence[Any]] | None,
    rounds: int,
    frames: int,
    warmup: int | None,
    folder: str | os.PathLike[str] | None,
    progress: bool | Callback,
    settings: Mapping[str, Any],
) -> Bench:
    """See `Lab.bench`."""
    target = Path(folder) if folder is not None else lab.captures / "bench" / _name(experiments)
    with spelling(settings, type(lab).bench), bar(progress) as callback:
        _conelab.run_bench(
            lab._native,
            _which(lab, experiments),
            lab._settings(settings),
            _axes(lab, axes),
            rounds,
            frames,
            warmup,
            os.fspath(target),
            callback,
        )
    result = Bench(target)
    failed = [c for c in result.json["configurations"] if c["error"] is not None]
    if failed:
        raise CampaignError(f"{len(failed)} configurations failed; the first: {failed[0]['error']}", result)
    return result


class Fit:
    """The setting that a search found.

    Attributes:
        ms: its time of a frame, ms.
        error: its error.
        within: whether it keeps the bound.
        why: why the search ended.
        path: its experiment.
        trials: all settings that were measured, as `Lab.sweep` returns them.
    """

    def __init__(self, lab: Lab, path: Path, ms: float, error: float, why: str, within: bool, trials: pd.DataFrame):
        self._lab = lab
        self.path, self.ms, self.error, self.why, self.within, self.trials = path, ms, error, why, within, trials

    def open(self, **settings: Any) -> Experiment:
        """Opens the setting."""
        return self._lab.open(self.path, **settings)

    def __getstate__(self) -> dict[str, Any]:
        return {**self.__dict__, "_lab": None}

    def __repr__(self) -> str:
        bound = "within the bound" if self.within else "not within the bound"
        return f"<Fit: {self.ms:.3f} ms, error {self.error:.4g}, {bound}; {len(self.trials)} trials: {self.why}>"


def fit(
    lab: Lab,
    experiment: Any,
    axes: Mapping[str, Sequence[Any]] | None,
    max_error: float | None,
    max_ms: float | None,
    metric: str,
    part: str,
    evaluations: int,
    frames: int,
    warmup: int,
    spp: int,
    bounces: int | None,
    output: str | os.PathLike[str] | None,
    progress: bool | Callback,
    settings: Mapping[str, Any],
) -> Fit:
    """See `Lab.fit`."""
    path = Path(output) if output is not None else lab.captures / "fit" / f"{_name(experiment)}.ron"
    if path.suffix != ".ron":
        raise RequestError(f"'{path}': give it a name that ends in .ron")
    with spelling(settings, type(lab).fit), bar(progress) as callback:
        ms, error, _, why, within = _conelab.run_fit(
            lab._native,
            _which(lab, experiment)[0],
            lab._settings(settings),
            _axes(lab, axes),
            max_error,
            max_ms,
            part,
            metric,
            evaluations,
            frames,
            warmup,
            bounces,
            spp,
            os.fspath(path),
            callback,
        )
    return Fit(lab, path, ms, error, why, within, points(path.with_suffix("")))


class Stability:
    """Temporal stability of methods.

    Attributes:
        cases: a row for each method in a case, as `stability.csv` (docs/tables.md). `lab.open(row)` opens the method
            where the case's motion starts.
        frames: a row for each frame, as `frames.csv`.
        folder: with `index.html`, a page of charts and pictures.
    """

    def __init__(self, folder: Path):
        self.folder = folder
        report = json.loads((folder / "stability.json").read_text())
        records = [str((folder / "results" / f"{r['id']}.json").absolute()) for r in report["results"]]
        self.cases = _frame((folder / "stability.csv").read_text()).copy().assign(**{RECORD: records})
        self.frames = _frame((folder / "frames.csv").read_text())

    def __repr__(self) -> str:
        return f"<Stability: {len(self.cases)} rows, {self.folder / 'index.html'}>"

    def _repr_html_(self) -> str:
        return self.cases.to_html()


def stability(
    lab: Lab,
    suite: str | os.PathLike[str],
    only: Sequence[str],
    methods: Sequence[str],
    size: tuple[int, int] | None,
    frames: int | None,
    spp: int | None,
    references: bool,
    folder: str | os.PathLike[str] | None,
    progress: bool | Callback,
    settings: Mapping[str, Any],
) -> Stability:
    """See `Lab.stability`."""
    file = lab._file(suite, "configs/stability")
    target = Path(folder) if folder is not None else lab.captures / "stability" / file.stem
    given = [f"{name}={ron(value)}" for name, value in settings.items()]
    with bar(progress) as callback:
        done, failed = _conelab.run_stability(
            lab._native,
            os.fspath(file),
            given,
            size,
            frames,
            spp,
            references,
            list(only),
            list(methods),
            os.fspath(target),
            callback,
        )
    result = Stability(target)
    if failed:
        raise CampaignError(f"{failed} of {done + failed} failed: see the column 'error' of `result.cases`", result)
    return result
