"""Numbers and pictures are those of the command line, to the bit."""

import json

import numpy as np
import pandas as pd
from conftest import SMALL

import conelab


def texels(path):
    return conelab.Picture.read(path).array


def test_a_render_is_the_commands(rays, program, small_arguments, tmp_path):
    program("render", "configs/rays.ron", *small_arguments, "-o", tmp_path / "a.exr")
    program("render", "configs/rays.ron", *small_arguments, "-o", tmp_path / "a.png", "--json", tmp_path / "a.json")
    shot = rays.render(progress=False)
    # With `hdr` halves are written as floats.
    assert np.array_equal(shot.linear.array, texels(tmp_path / "a.exr"))
    shot.save(tmp_path / "b.png")
    assert np.array_equal(texels(tmp_path / "b.png"), texels(tmp_path / "a.png"))
    expected = json.loads((tmp_path / "a.json").read_text())
    times = {"passes", "total_gpu_ms", "cpu_ms"}
    assert {k: v for k, v in shot.stats.items() if k not in times} == {
        k: v for k, v in expected.items() if k not in times
    }
    assert [p["name"] for p in shot.stats["passes"]] == [p["name"] for p in expected["passes"]]
    assert shot.warnings == []


def test_incremental_and_repeated_renders_have_the_same_bits(rays):
    first = rays.render(progress=False).linear.array.copy()
    assert np.array_equal(rays.render(progress=False).linear.array, first)
    assert np.array_equal(rays.render(incremental=True, progress=False).linear.array, first)


def test_a_changed_parameter_renders_as_one_that_was_given(lab, rays):
    rays.render(progress=False)
    # A number that shaders read; a constant of a pipeline; the size.
    changes = {"exposure": 1.0, "shadow_pcf" if "shadow_pcf" in rays.params else "bounces": None, "size": (40, 30)}
    changes = {name: value for name, value in changes.items() if value is not None} | {"bounces": "one"}
    rays.set(progress=False, **changes)
    fresh = lab.open("rays", progress=False, **{**SMALL, **changes})
    assert np.array_equal(rays.render(progress=False).picture, fresh.render(progress=False).picture)


def test_a_texture_is_the_one_that_the_command_writes(rays, program, small_arguments, tmp_path):
    name = "gbufferNormals"
    program("render", "configs/rays.ron", *small_arguments, "--resource", name, "-o", tmp_path / "a.exr")
    texture = rays.texture(name, progress=False)
    assert texture.dtype == np.float16 and texture.shape == (32, 48, 4)
    assert np.array_equal(texture[..., :3].astype(np.float32), texels(tmp_path / "a.exr"))


def test_references_and_scores_are_the_commands(rays, program, small_arguments, tmp_path):
    program("reference", "configs/rays.ron", *small_arguments, "--spp", 32, "-o", tmp_path / "r.exr")
    reference = rays.reference(32, progress=False)
    assert reference.samples == 32
    assert np.array_equal(reference.total.array, texels(tmp_path / "r.exr"))
    program("compare", "configs/rays.ron", *small_arguments, "--json", tmp_path / "c.json")
    expected = json.loads((tmp_path / "c.json").read_text())
    score = rays.score(reference, progress=False)
    assert score.json["parts"] == expected["parts"]
    total = next(p for p in expected["parts"] if p["part"] == "total")["regions"][0]["scores"][0]
    assert score["flip"] == total["flip"] and score["relmse", "total", "frame"] == total["relmse"]


def test_a_sweep_has_the_numbers_of_the_command(lab, program, tmp_path):
    sweep = tmp_path / "s.ron"
    config = program.home / "configs" / "cones.ron"
    sweep.write_text(
        f'(experiments: ["{config}"], warmup: 1, frames: 1,'
        ' set: {"scene": "cornell", "size": (48, 32), "voxel_dim": 16, "shadow_dim": 256},'
        ' axes: [List(name: "exposure", values: [0.8, 1.2])])'
    )
    program("sweep", sweep, "-o", tmp_path / "theirs", "--reference", 32)
    ours = lab.sweep(
        "cones",
        {"exposure": [0.8, 1.2]},
        warmup=1,
        frames=1,
        reference=32,
        folder=tmp_path / "ours",
        progress=False,
        **SMALL,
    )
    theirs = pd.read_csv(tmp_path / "theirs" / "sweep.csv")
    same = [c for c in theirs.columns if not c.endswith(" ms")]
    assert len(same) > 20 and not theirs["total flip"].isna().any()
    pd.testing.assert_frame_equal(ours[same], theirs[same], check_dtype=False)


def test_the_graph_is_what_ran(rays):
    graph, shot = rays.graph, rays.render(progress=False)
    assert list(graph.passes.index) == [p["name"] for p in shot.stats["passes"]]
    sizes = {**graph.buffers["bytes"][~graph.buffers["transient"]]}
    # Devices round sizes up.
    assert len(sizes) > 4 and all(0 <= shot.stats["bytes"][name] - size < 16 for name, size in sizes.items())
    assert "display" in graph.passes.loc["display", "writes"]
    assert "order" in graph.text and len(graph.left_out) > 0
