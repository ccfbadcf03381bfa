"""Every column of every table is in docs/tables.md, and no two have one name."""

import csv
import json
import re

from conftest import ROOT, SMALL

import conelab

#: What a word of the page in capitals stands for.
WILD = {
    "PART": r"(total|direct|diffuse|specular|occlusion|total, \d+ bounces)",
    "METRIC": "(" + "|".join(conelab.metrics().index) + ")",
    "N": r"\d+",
    "TITLE": "(" + "|".join(re.escape(title) for title in conelab.metrics()["title"]) + ")",
}


def documented(heading):
    """Patterns of the columns in a section of the page."""
    page = (ROOT / "docs" / "tables.md").read_text()
    section = page.split(f"\n## {heading}\n")[1].split("\n## ")[0]
    return re.findall(r"^\| `([^`]+)` \|", section, re.MULTILINE)


def check(path, heading, settings=(), passes=()):
    """Titles of a file are documented in a section, and differ."""
    with open(path, newline="") as file:
        titles = next(csv.reader(file))
    assert len(set(titles)) == len(titles), titles
    wild = {**WILD, "SETTING": "|".join(settings) or "$^", "PASS": "|".join(map(re.escape, passes)) or "$^"}
    patterns = documented(heading)
    assert len(patterns) > 4

    def pattern(column):
        words = (wild.get(word, re.escape(word)) for word in column.split(" "))
        return " ".join(f"({word})" for word in words)

    known = [pattern(column) for column in patterns]
    unknown = [title for title in titles if not any(re.fullmatch(p, title) for p in known)]
    assert not unknown, f"{heading}: docs/tables.md does not have {unknown}"
    always = [column for column in patterns if not set(column.split(" ")) & {*wild}]
    missing = [column for column in always if column not in titles]
    assert not missing, f"{heading}: {path} does not have {missing}"


def check_json(path, heading):
    """Fields of a file are those of a section."""
    assert sorted(json.loads(path.read_text())) == sorted(documented(heading))


def test_columns_of_sweeps_and_reports_are_documented(lab, program, tmp_path):
    options = dict(warmup=1, frames=1, reference=32, folder=tmp_path / "s", progress=False, size=(48, 32))
    axes = {"scene": ["cornell", "pocket"], "exposure": [0.0, 1.0]}
    table = lab.sweep(["cones", "rays"], axes, shadow_dim=256, voxel_dim=16, **options)
    passes = {c.removesuffix(" ms") for c in table.columns if c.endswith(" ms")}
    check(tmp_path / "s" / "sweep.csv", "`sweep.csv`, `points.csv`", ["exposure"], passes)
    check_json(tmp_path / "s" / "sweep.json", "`sweep.json`")
    check_json(next((tmp_path / "s" / "points").iterdir()), "`points/ID.json`")
    program("report", tmp_path / "s", "-o", tmp_path / "r")
    check(tmp_path / "r" / "points.csv", "`sweep.csv`, `points.csv`", ["exposure"], passes)
    check(tmp_path / "r" / "scenes.csv", "`scenes.csv`")
    check(tmp_path / "r" / "fronts.csv", "`fronts.csv`")


def test_columns_of_benchmarks_suites_and_comparisons_are_documented(program, small_arguments, tmp_path):
    small = ["--set", "voxel_dim=16", "--set", "shadow_dim=256"]
    program(
        "bench", "configs/cones.ron", "--scene", "cornell", "--sizes", "48x32", "--axis", "exposure=0,1", *small,
        "--rounds", 1, "--frames", 1, "--warmup", 0, "-o", tmp_path / "b",
    )  # fmt: skip
    check(tmp_path / "b" / "bench.csv", "`bench.csv`", ["exposure", "voxel_dim", "shadow_dim"])
    check_json(tmp_path / "b" / "bench.json", "`bench.json`")
    program(
        "stability", "configs/stability/families.ron", "--size", "48x32", "--frames", 3, "--spp", 32, "--only", "switch",
        "--methods", "cones", *small, "-o", tmp_path / "t",
    )  # fmt: skip
    check(tmp_path / "t" / "stability.csv", "`stability.csv`")
    check_json(tmp_path / "t" / "stability.json", "`stability.json`, `results/ID.json`")
    program("graph", "configs/rays.ron", "--json", tmp_path / "g.json")
    check_json(tmp_path / "g.json", "`conelab graph --json`")
    check(tmp_path / "t" / "frames.csv", "`frames.csv` of a suite")
    program("reference", "configs/rays.ron", *small_arguments, "--spp", 32)
    program("compare", "configs/rays.ron", *small_arguments, "--frames", 2, "--by-frame", tmp_path / "f")
    check(tmp_path / "f" / "frames.csv", "`frames.csv` of a comparison")


def test_settings_of_the_module_are_in_the_table(lab):
    table = lab.sweep(
        "cones", {"exposure": [0.0]}, warmup=1, frames=1, folder=lab.captures / "one", progress=False, **SMALL
    )
    assert len(set(table.columns)) == len(table.columns) and conelab.campaign.RECORD in table.columns
