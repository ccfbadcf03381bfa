"""The types of settings are those of the graphs."""

import os

from conftest import ROOT

import conelab
from conelab import stubs


def test_settings_have_the_parameters_of_all_graphs(rays):
    path = ROOT / "python" / "conelab" / "settings.py"
    expected = stubs.settings(ROOT)
    if os.environ.get("CONELAB_BLESS"):
        path.write_text(expected)
    assert path.read_text() == expected, "CONELAB_BLESS=1 pytest python/tests/test_types.py writes it anew"
    for name in rays.params:
        assert f"    {name}: " in expected


def test_public_names_have_docs():
    for name in conelab.__all__:
        thing = getattr(conelab, name)
        assert thing.__doc__, name
        for member, value in vars(thing).items() if isinstance(thing, type) else ():
            if callable(value) and not member.startswith("_"):
                assert value.__doc__, f"{name}.{member}"
