"""What the tests share: a lab on the software device, small settings, and the program to compare with."""

import os
import subprocess
from pathlib import Path

import pytest

import conelab

ROOT = Path(__file__).parents[2]

#: So small that a software device renders in a second.
SMALL = {"scene": "cornell", "size": (48, 32), "voxel_dim": 16, "shadow_dim": 256}


@pytest.fixture(scope="session")
def device():
    """The software device, unless CONELAB_TEST_DEVICE names another."""
    return os.environ.get("CONELAB_TEST_DEVICE", "llvmpipe")


@pytest.fixture(scope="session")
def captures(tmp_path_factory):
    return tmp_path_factory.mktemp("captures")


@pytest.fixture(scope="session")
def lab(device, captures):
    with conelab.Lab(device, home=ROOT, captures=captures, validate=True) as lab:
        yield lab


@pytest.fixture
def rays(lab):
    return lab.open("rays", progress=False, **SMALL)


@pytest.fixture(scope="session")
def program(device, tmp_path_factory):
    """The command line, in a home of its own, with the same device."""
    home = tmp_path_factory.mktemp("home")
    for name in ("passes", "shaders", "configs"):
        (home / name).symlink_to(ROOT / name)
    target = Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target"))
    binary = Path(os.environ.get("CONELAB_PROGRAM", target / "release" / "conelab"))
    assert binary.is_file(), f"{binary} is not built: cargo build --release, or name it in CONELAB_PROGRAM"

    def run(*arguments, ok=True):
        environment = {**os.environ, "CONELAB_HOME": str(home), "CONELAB_DEVICE": device, "CONELAB_VALIDATION": "true"}
        done = subprocess.run([binary, *map(str, arguments)], env=environment, cwd=home, capture_output=True, text=True)
        assert (done.returncode == 0) == ok, done.stdout + done.stderr
        return done.stdout

    run.home = home
    return run


@pytest.fixture
def small_arguments():
    """`SMALL` for the command line."""
    return ["--scene", "cornell", "--size", "48x32", "--set", "voxel_dim=16", "--set", "shadow_dim=256"]
