"""Errors are clear, and nothing is lost."""

import _thread
import logging
import os
import pickle
import signal
import subprocess
import sys
import threading

import numpy as np
import pytest
from conftest import ROOT, SMALL

import conelab


def python(code, **environment):
    """Standard output and error of another Python."""
    environment = {k: v for k, v in {**os.environ, **environment}.items() if v is not None}
    done = subprocess.run([sys.executable, "-c", code], env=environment, cwd=ROOT, capture_output=True, text=True)
    return done.returncode, done.stdout, done.stderr


def test_parameters_complete_and_say_what_is_wrong(rays):
    assert "exposure" in dir(rays.params) and rays.params.exposure == 0.0
    info = rays.params.info("exposure")
    assert info.kind == "float" and info.range == (-10.0, 10.0) and info.unit == "stops" and info.help
    rays.params.exposure = np.float32(1.5)
    assert rays.params["exposure"] == 1.5 and rays.params.changed()["exposure"] == 1.5
    with pytest.raises(conelab.InputError, match="no parameter 'exposre'.*exposure"):
        rays.params.exposre = 1.0
    with pytest.raises(conelab.InputError, match="(?s)no parameter 'scen'.*did you mean 'scene'"):
        rays.lab.open("rays", scen="nowhere.obj", progress=False)
    with pytest.raises(conelab.InputError, match="exposure.*-10.*10"):
        rays.params.exposure = 11.0
    with pytest.raises(conelab.InputError, match="tone_map"):
        rays.set(exposure=2.0, tone_map="film", progress=False)
    assert rays.params.exposure == 1.5, "all or none"
    with pytest.raises(AttributeError, match="has no parameter 'exposre'"):
        rays.params.exposre  # noqa: B018
    assert "<table>" in rays.params._repr_html_()


def test_unknown_names_are_told(lab):
    with pytest.raises(conelab.RequestError, match="did you mean 'rays'"):
        lab.open("ray")
    with pytest.raises(conelab.SceneError, match="cornel"):
        lab.open("rays", scene="cornel", progress=False)
    with pytest.raises(conelab.RequestError, match="no camera 'front'"):
        lab.open("rays", progress=False, **{**SMALL, "camera": "front"})
    with pytest.raises(conelab.RequestError, match="no texture 'radianc'"):
        lab.open("rays", keep=["radianc"], progress=False, **SMALL)


def test_a_wrong_edit_names_the_line_and_changes_nothing(rays):
    before = rays.render(progress=False).picture.copy()
    file = "modules/tone_map/reinhard.glsl"
    text = rays.source(file)
    with pytest.raises(conelab.ShaderError) as caught, rays.edit(file) as source:
        source.text = "int wrong = ;\n" + text
    assert caught.value.file.endswith(file) and caught.value.line == 1 and "int wrong" in caught.value.source
    assert rays.source(file) == text
    assert np.array_equal(rays.render(progress=False).picture, before)
    again = pickle.loads(pickle.dumps(caught.value))
    assert again.line == 1 and str(again) == str(caught.value)


def test_an_edit_is_of_this_experiment_alone(lab, rays):
    file = "modules/tone_map/reinhard.glsl"
    original = (ROOT / "shaders" / file).read_text()
    before = rays.render(progress=False).picture.copy()
    with rays.edit(file) as source:
        assert "return" in source.text
        source.text = source.text.replace("return ", "return 0.5 * ", 1)
    after = rays.render(progress=False).picture.copy()
    assert after.mean() < before.mean()
    assert (ROOT / "shaders" / file).read_text() == original
    with rays.edit(file) as source:
        source.text = source.text.replace("return 0.5 * ", "return 0.1 * ", 1)
    assert rays.render(progress=False).picture.mean() < after.mean(), "a second edit counts too"
    other = lab.open("rays", progress=False, **SMALL)
    assert np.array_equal(other.render(progress=False).picture, before)
    with pytest.raises(conelab.RequestError, match="edited sources"):
        lab.sweep(rays, {"exposure": [0.0]}, progress=False)
    rays.revert()
    assert np.array_equal(rays.render(progress=False).picture, before)
    with pytest.raises(conelab.RequestError, match="no graph or shader"):
        rays.source("../Cargo.toml")


def test_other_threads_are_refused_and_may_have_a_lab_of_their_own(lab, rays, device, captures):
    caught, pictures = [], []

    def work():
        try:
            rays.render(progress=False)
        except conelab.ThreadError as why:
            caught.append(str(why))
        with conelab.Lab(device, home=ROOT, captures=captures) as own:
            pictures.append(own.open("rays", progress=False, **SMALL).render(progress=False).picture)

    thread = threading.Thread(target=work)
    thread.start()
    thread.join()
    assert len(caught) == 1 and "belongs to the thread" in caught[0]
    assert np.array_equal(pictures[0], rays.render(progress=False).picture)


def test_other_threads_run_while_one_renders(rays):
    counted, rendering = [0], threading.Event()

    def count():
        while not rendering.is_set():
            counted[0] += 1

    thread = threading.Thread(target=count)
    thread.start()
    rays.render(progress=False)
    rendering.set()
    thread.join()
    assert counted[0] > 1000


def test_a_closed_lab_says_so_and_its_pictures_stay(device, captures):
    lab = conelab.Lab(device, home=ROOT, captures=captures)
    exp = lab.open("rays", progress=False, **SMALL)
    shot = exp.render(progress=False)
    lab.close()
    assert shot.picture.shape == (32, 48, 3) and "closed" in repr(lab)
    with pytest.raises(conelab.RequestError, match="closed"):
        exp.render(progress=False)
    lab.close()


def test_a_lost_device_is_opened_again(device, captures):
    with conelab.Lab(device, home=ROOT, captures=captures) as lab:
        exp = lab.open("rays", progress=False, **SMALL)
        before = exp.render(progress=False).picture.copy()
        lab._native.lose_device()
        with pytest.raises(conelab.DeviceLost):
            exp.render(progress=False)
        assert np.array_equal(exp.render(progress=False).picture, before)


def test_ctrl_c_ends_between_frames_and_a_callback_may_too(rays):
    def stop(text, done, of, note):
        if done >= 2:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        rays.render(progress=stop)
    # Programs that a shell starts in the background ignore the signal.
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    threading.Timer(0.3, _thread.interrupt_main).start()
    with pytest.raises(KeyboardInterrupt):
        rays.render(frames=20_000, progress=False)
    signal.signal(signal.SIGINT, before)
    seen = []
    rays.render(frames=3, progress=lambda *step: seen.append(step))
    assert seen[-1] == ("frames", 3, 3, None)
    inside = []

    def call(*_):
        try:
            rays.frame()
        except conelab.ThreadError as why:
            inside.append(str(why))

    rays.render(frames=1, progress=call)
    assert "must not call it" in inside[0]


def test_without_vulkan_the_module_imports_and_a_lab_says_what_lacks():
    code = "import conelab, sys\ntry: conelab.Lab()\nexcept conelab.DeviceError as why: print(why); sys.exit(3)"
    status, out, err = python(code, VK_DRIVER_FILES="/dev/null", VK_ICD_FILENAMES="/dev/null", CONELAB_DEVICE=None)
    assert status == 3, out + err
    assert "Vulkan" in out


def test_without_the_parts_for_notebooks_the_rest_works(device):
    block = "import sys\nfor name in ('matplotlib', 'ipywidgets', 'IPython'): sys.modules[name] = None\n"
    code = f"""{block}
import conelab
with conelab.Lab({device!r}, home={str(ROOT)!r}) as lab:
    exp = lab.open("rays", progress=False, **{SMALL!r})
    print(len(exp.render(progress=False)._repr_html_()))
    try: exp.interact()
    except conelab.RequestError as why: print(why)
"""
    status, out, err = python(code)
    assert status == 0, err
    assert "pip install" in out and int(out.split()[0]) > 1000


def test_two_labs_in_one_process_do_not_share_anything(lab, device, tmp_path):
    with conelab.Lab(device, home=ROOT, captures=tmp_path) as other:
        a = lab.open("rays", progress=False, **SMALL)
        b = other.open("rays", progress=False, **{**SMALL, "exposure": 1.0})
        assert a.render(progress=False).picture.mean() < b.render(progress=False).picture.mean()
        b.reference(32, progress=False)
        assert len(list((tmp_path / "reference").iterdir())) == 1


def test_messages_go_to_the_logger(lab, tmp_path, caplog):
    model = tmp_path / "a.obj"
    model.write_text("mtllib gone.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    with caplog.at_level(logging.WARNING, logger="conelab"):
        lab.open("rays", progress=False, **{**SMALL, "scene": model})
    assert "material libraries cannot be read" in caplog.text


def test_results_are_pickled(rays):
    shot = rays.render(progress=False)
    shot.linear  # noqa: B018
    reference = rays.reference(32, progress=False)
    score = rays.score(reference, progress=False)
    again = pickle.loads(pickle.dumps((shot, reference, score)))
    assert np.array_equal(again[0].picture, shot.picture) and again[0].gpu_ms == shot.gpu_ms
    assert np.array_equal(again[0].linear.array, shot.linear.array) and not again[0].is_current
    assert again[1].samples == 32 and np.array_equal(again[1].total.array, reference.total.array)
    assert again[2]["flip"] == score["flip"]
