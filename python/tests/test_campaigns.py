"""Campaigns are data frames whose rows can be opened again."""

import numpy as np
import pytest
from conftest import ROOT, SMALL

import conelab


def test_a_row_of_a_sweep_opens_what_was_measured(lab, tmp_path):
    table = lab.sweep(
        ["cones", "rays"], {"scene": ["cornell", "door-ajar"], "exposure": (0.0, 1.0)},
        warmup=1, frames=1, reference=32, folder=tmp_path / "s", progress=False, size=(48, 32), shadow_dim=256, voxel_dim=16,
    )  # fmt: skip
    assert len(table) == 8 and set(table["outcome"]) == {"done"}
    assert table["total flip"].between(0, 1).all() and (table["total flip noise"] > 0).all()
    # Exposure is applied after the scored pictures: the second of each pair has the scores of the first.
    assert table["same scores as"].isna().sum() == 4
    pairs = table[table["exposure"] == 1.0]["same scores as"].tolist()
    assert pairs == table[table["exposure"] == 0.0]["id"].tolist()
    row = table[(table["experiment"] == "rays") & (table["scene"] == "door-ajar") & (table["exposure"] == 1.0)].iloc[0]
    exp = lab.open(row, progress=False)
    assert exp.graph_name == "rays.ron" and exp.scene == "door-ajar" and exp.size == (48, 32)
    assert exp.params.exposure == 1.0 and exp.params.shadow_dim == 256
    score = exp.score(exp.reference(32, progress=False), progress=False)
    assert score["flip"] == pytest.approx(row["total flip"], rel=1e-12)
    assert (conelab.points(tmp_path / "s")["total flip"] == table["total flip"]).all()


def test_failed_points_raise_and_leave_the_others(lab, device, captures, tmp_path):
    small = {**SMALL, "voxel_dim": 16}
    with conelab.Lab(device, home=ROOT, captures=captures, memory=0.05) as little:
        options = dict(warmup=1, frames=1, folder=tmp_path / "s", progress=False)
        with pytest.raises(conelab.CampaignError, match="1 of 2 points failed") as caught:
            little.sweep(
                "cones", {"voxel_dim": [16, 256]}, **options, **{k: v for k, v in small.items() if k != "voxel_dim"}
            )
    table = caught.value.result
    assert list(table["outcome"]) == ["done", "failed"] and "GiB" in table["error"].iloc[1]
    with pytest.raises(conelab.SceneError, match="nowhere"):
        lab.sweep("cones", {"scene": ["nowhere.obj"]}, folder=tmp_path / "t", progress=False)
    with pytest.raises(conelab.InputError, match="no parameter 'exposre'"):
        lab.sweep("cones", {"exposre": [1.0]}, folder=tmp_path / "t", progress=False, **SMALL)
    with pytest.raises(conelab.InputError, match="settings: error: no parameter 'referance'.*\n.*the argument 'reference'"):
        lab.sweep("cones", referance=32, folder=tmp_path / "t", progress=False, **SMALL)
    with pytest.raises(conelab.RequestError, match="must be a list"):
        lab.sweep("cones", {"scene": "cornell"}, folder=tmp_path / "t", progress=False)


def test_a_sweep_that_is_stopped_goes_on_where_it_was(lab, tmp_path):
    axes, options = {"exposure": [0.0, 1.0, 2.0]}, dict(warmup=1, frames=1, folder=tmp_path / "s", **SMALL)

    def stop(text, done, of, note):
        if done == 2:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        lab.sweep("cones", axes, progress=stop, **options)
    records = {path: path.stat().st_mtime_ns for path in (tmp_path / "s" / "points").iterdir()}
    assert len(records) == 2
    table = lab.sweep("cones", axes, progress=False, **options)
    assert len(table) == 3
    assert all(path.stat().st_mtime_ns == at for path, at in records.items())


def test_a_bench_has_stages_and_totals_and_opens_its_rows(lab, tmp_path):
    options = dict(rounds=2, frames=2, warmup=1, folder=tmp_path / "b", progress=False)
    result = lab.bench("cones", {"exposure": [0.0, 1.0]}, **options, **SMALL)
    assert len(result.json["configurations"]) == 2 and {"pass", "stage", "total"} == set(result.table["kind"])
    assert all(c["times"]["rounds"] for c in result.json["configurations"])
    totals = result.table[result.table["kind"] == "total"]
    assert [lab.open(row, progress=False).params.exposure for _, row in totals.iterrows()] == [0.0, 1.0]
    assert list(totals["exposure"]) == [0.0, 1.0]


def test_a_fit_finds_a_setting_within_the_bound_and_opens_it(lab, tmp_path):
    found = lab.fit(
        "cones", {"exposure": [0.0], "cone_count": [3, 5]}, max_error=0.9, evaluations=4, frames=1, warmup=1, spp=32,
        output=tmp_path / "best.ron", progress=False, **SMALL,
    )  # fmt: skip
    assert found.within and found.error < 0.9 and 1 <= len(found.trials) <= 4
    exp = found.open(progress=False)
    assert exp.params.cone_count in (3, 5) and exp.size == (48, 32)
    with pytest.raises(conelab.RequestError, match="max_error or max_ms"):
        lab.fit("cones", progress=False)


def test_stability_has_cases_and_frames(lab, tmp_path):
    suite = tmp_path / "turn.ron"
    suite.write_text(
        f'(experiment: "{ROOT}/configs/cones.ron", warmup: 1, frames: 3, samples: 32,'
        ' set: {"scene": "cornell", "size": (48, 32), "voxel_dim": 16, "shadow_dim": 256}, methods: {"cones": {}},'
        ' cases: {"turn": (motion: Camera(yaw: 2.0))})'
    )
    result = lab.stability(suite, folder=tmp_path / "out", progress=False)
    assert set(result.cases["method"]) == {"cones"} and len(result.frames) >= 3
    assert (result.folder / "index.html").is_file()
    exp = lab.open(result.cases.iloc[0], progress=False)
    assert exp.graph_name == "cones.ron" and exp.params.voxel_dim == 16
    assert np.isfinite(result.frames.select_dtypes("number")).any().any()
