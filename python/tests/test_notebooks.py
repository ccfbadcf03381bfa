"""Every notebook runs, and what its cells show survives the conversion to a page."""

import os

import nbclient
import nbformat
import pytest
from conftest import ROOT, SMALL

import conelab

NOTEBOOKS = sorted((ROOT / "python" / "notebooks").glob("*.ipynb"))


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_notebook_runs(path, device, tmp_path, monkeypatch):
    monkeypatch.setenv("CONELAB_DEVICE", device)
    monkeypatch.setenv("CONELAB_VALIDATION", "true")
    monkeypatch.delenv("MPLBACKEND", raising=False)
    monkeypatch.delenv("CONELAB_HOME", raising=False)
    book = nbformat.read(path, as_version=4)
    assert all(not cell.get("outputs") for cell in book.cells), "notebooks are kept without outputs"
    # In a folder of its own the package's copies of graphs and shaders are used.
    client = nbclient.NotebookClient(book, timeout=600, resources={"metadata": {"path": str(tmp_path)}})
    client.execute()
    folder = os.environ.get("CONELAB_NOTEBOOK_OUTPUTS")
    if folder:
        os.makedirs(folder, exist_ok=True)
        nbformat.write(book, os.path.join(folder, path.name))
    outputs = [output for cell in book.cells for output in cell.get("outputs", [])]
    assert not [o for o in outputs if o.output_type == "stream" and o.name == "stderr" and "Error" in o.text]
    pictures = [
        o
        for o in outputs
        if "image/png" in o.get("data", {}) or "data:image/png" in o.get("data", {}).get("text/html", "")
    ]
    assert pictures, "no cell shows a picture"


def test_what_objects_show_is_whole_html(rays):
    reference = rays.reference(32, progress=False)
    shown = {
        "experiment": rays._repr_html_(),
        "render": rays.render(progress=False)._repr_html_(),
        "score": rays.score(reference, progress=False)._repr_html_(),
        "comparison": conelab.compare(rays, rays.lab.open("cones", progress=False, **SMALL), reference)._repr_html_(),
    }
    for name, html in shown.items():
        # Pictures are inside: a page needs no files and no kernel.
        assert "src='data:image/png;base64," in html and "<table" in html, name
        assert "<script" not in html and "http" not in html, name
    assert rays.score(reference, progress=False).maps()["flip"].shape == (32, 48)


def test_sliders_render_and_say_mistakes(rays):
    widgets = pytest.importorskip("ipywidgets")
    box = rays.interact("exposure", "tone_map")
    shown, controls = box.children
    picture, status = shown.children
    before = picture.value
    slider = next(c for c in controls.children if c.description == "exposure")
    assert (slider.min, slider.max, slider.value) == (-10.0, 10.0, 0.0)
    slider.value = 1.0
    assert picture.value != before and rays.params.exposure == 1.0 and " ms on " in status.value
    yaw = next(c for c in controls.children if c.description.startswith("yaw"))
    eye = rays.camera.eye
    yaw.value = 20.0
    assert rays.camera.eye != eye and rays.camera.target == pytest.approx(rays.camera.target)
    assert isinstance(box, widgets.HBox)
    with pytest.raises(conelab.RequestError, match="has no parameter 'nothing'"):
        rays.interact("nothing")
