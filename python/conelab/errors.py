"""Exceptions of conelab. All are subclasses of `Error`."""

from __future__ import annotations

import difflib
import inspect
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from typing import Any


class Error(Exception):
    """Anything that conelab cannot do; the message says what, where and what to do."""


class InputError(Error, ValueError):
    """Mistakes in graphs, experiments, sweeps or settings.

    Attributes:
        findings: all of them, as dictionaries with file, line, column (from 1; 0: unknown), severity, message, help and
            source (the line).
    """

    def __init__(self, message: str, findings: list[dict[str, Any]] | None = None):
        super().__init__(message)
        self.findings = findings or []
        first = next((f for f in self.findings if f["severity"] == "error"), {})
        self.file: str | None = first.get("file")
        self.line: int | None = first.get("line")
        self.source: str | None = first.get("source")

    def __reduce__(self) -> Any:
        return type(self), (str(self), self.findings)


class ShaderError(InputError):
    """Mistakes in shaders. `file`, `line` and `source` are those of the first."""


class RequestError(Error, ValueError):
    """A request that cannot be fulfilled."""


class SceneError(Error):
    """A scene that cannot be opened."""


class FileError(Error):
    """A file that cannot be read or written."""


class MetricError(Error, ValueError):
    """Pictures that cannot be compared."""


class DeviceError(Error):
    """The device or its driver refuses."""


class DeviceLost(DeviceError):
    """The device was reset or hangs. The next call opens it again; what is on disk is kept."""


class ValidationError(DeviceError):
    """Messages of the Vulkan validation layer."""


class ThreadError(Error, RuntimeError):
    """A call from a thread that did not make the object."""


class Stopped(Error):
    """A callback stopped the work."""


class CampaignError(Error):
    """Points of a campaign failed.

    Attributes:
        result: what was measured, as the call would have returned it.
    """

    def __init__(self, message: str, result: Any = None):
        super().__init__(message)
        self.result = result

    def __reduce__(self) -> Any:
        return type(self), (str(self), self.result)


@contextmanager
def spelling(settings: Iterable[str], call: Callable[..., Any]) -> Iterator[None]:
    """Adds to errors about unknown settings which argument of the call may be meant."""
    names = list(settings)
    try:
        yield
    except InputError as error:
        for name in (name for name in names if f"no parameter '{name}'" in str(error)):
            for near in difflib.get_close_matches(name, inspect.signature(call).parameters, n=1, cutoff=0.8):
                message = f"{error}\n    = help: did you mean the argument '{near}'?"
                raise type(error)(message, error.findings) from None
        raise
