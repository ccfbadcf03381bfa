"""Progress bars, and messages through `logging`."""

from __future__ import annotations

import logging
import re
from collections.abc import Callable, Iterator
from contextlib import contextmanager

log = logging.getLogger("conelab")

#: Called with what is done now, how much is done, of how much, and a message or None.
Callback = Callable[[str, int, int, "str | None"], None]


@contextmanager
def bar(wanted: bool | Callback) -> Iterator[Callback | None]:
    """A callback that draws a bar (True), the caller's own, or none (False)."""
    if callable(wanted):
        yield wanted
        return
    if not wanted:
        yield lambda text, done, of, note: log.warning(note) if note else None
        return
    from tqdm.auto import tqdm

    shown = None

    def step(text: str, done: int, of: int, note: str | None) -> None:
        nonlocal shown
        if note:
            log.warning(note)
        if of < 2:
            return
        if shown is None or shown.total != of:
            if shown is not None:
                shown.close()
            shown = tqdm(total=of, leave=False, delay=0.5)
        # Titles of points begin with their identifier.
        shown.set_description(re.sub("^[0-9a-f]{32} ", "", text)[:40], refresh=False)
        shown.update(done - shown.n)

    try:
        yield step
    finally:
        if shown is not None:
            shown.close()
