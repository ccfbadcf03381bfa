"""Arrays share the program's memory."""

import gc

import numpy as np
import pytest
from conftest import SMALL

import conelab
from conelab import _conelab


def test_arrays_have_the_addresses_of_the_programs_memory(rays):
    memory, format = rays._native.texture("radiance", 0, 0, None, None)
    array = np.asarray(memory)
    assert format == "rgba16f" and array.__array_interface__["data"] == (memory.address, False)
    assert array.base is memory or array.base.base is memory
    kept = array.copy()
    del memory
    gc.collect()
    assert np.array_equal(array, kept)
    array[0, 0] = 5.0
    assert array[0, 0, 0] == 5.0


def test_references_share_their_pictures_and_cannot_be_written_to(rays):
    reference = rays.reference(32, progress=False)
    array = reference.total.array
    assert array.dtype == np.float32 and array.shape == (32, 48, 3) and not array.flags.writeable
    assert isinstance(array.base, _conelab.Memory) or isinstance(array.base.base, _conelab.Memory)
    again = np.asarray(reference)
    assert again.__array_interface__["data"] == array.__array_interface__["data"]


def test_dlpack_takes_a_texture_without_a_copy(rays):
    texture = rays.texture("radiance", progress=False)
    other = np.from_dlpack(texture)
    assert np.shares_memory(texture, other)


def test_volumes_have_mips_and_slices(lab):
    rays = lab.open("cones", progress=False, **SMALL)
    textures = rays.graph.textures
    volumes = textures[[extent[2] > 1 for extent in textures["extent"]]]
    name = volumes.index[0]
    width, height, depth = volumes.loc[name, "extent"]
    whole = rays.texture(name, progress=False)
    assert whole.shape[:3] == (depth, height, width)
    assert np.array_equal(rays.texture(name, slice=("z", depth // 2), progress=False), whole[depth // 2])
    assert np.array_equal(rays.texture(name, slice=("x", 1), progress=False), whole[:, :, 1])
    assert np.array_equal(rays.texture(name, slice=("y", 2), progress=False), whole[:, 2])
    if volumes.loc[name, "mips"] > 1:
        assert rays.texture(name, mip=1, progress=False).shape[:3] == (depth // 2, height // 2, width // 2)


def test_a_texture_that_frames_do_not_keep_is_rendered_again(rays):
    textures = rays.graph.textures
    transient = textures.index[textures["transient"]]
    assert len(transient) > 0
    picture = rays.render(progress=False).picture.copy()
    assert rays.texture(transient[0], progress=False).size > 0
    assert np.array_equal(rays.render(progress=False).picture, picture)
    with pytest.raises(conelab.RequestError, match="no texture 'radiancf' .*radiance"):
        rays.texture("radiancf")


def test_buffers_and_tables_are_numbers(lab):
    exp = lab.open("rays", progress=False, **SMALL)
    exp.render(progress=False)
    buffers = exp.graph.buffers
    name = buffers.index[~buffers["transient"]][0]
    assert exp.buffer(name).dtype == np.uint32
    assert exp.buffer(name, np.uint8).nbytes == exp.buffer(name).nbytes
    for name in exp.tables:
        try:
            table = exp.table(name)
        except conelab.RequestError as why:
            assert "not made" in str(why)
            continue
        frame = conelab.table_frame(table)
        assert len(frame) == len(table) and len(frame.columns) >= len(table.dtype.names)


def test_displayed_pictures_and_maps_have_the_colours_of_the_program():
    # c / (1 + c), then sRGB (IEC 61966-2-1): 1 becomes 0.5, and that 188 of 255.
    grey = conelab.Picture(np.full((1, 2, 3), [1.0, 1.0, 0.0], np.float32))
    assert grey.displayed().tolist() == [[[188, 188, 0]] * 2]
    assert (grey.displayed(exposure=-100.0) == 0).all()
    odd = conelab.Picture(np.array([[[np.inf, np.nan, -1.0]]], np.float32))
    assert odd.displayed().tolist() == [[[255, 0, 0]]]
    assert conelab.Picture(np.ones((1, 1, 3)), "openness").displayed().tolist() == [[[255, 255, 255]]]
    # The ends of magma, as matplotlib has it.
    assert conelab.heat(np.array([[0.0, 1.0, np.nan]])).tolist() == [[[0, 0, 4], [252, 253, 191], [252, 253, 191]]]


def test_scenes_have_names_that_open(lab):
    scenes = lab.scenes()
    assert "cornell" in scenes.index and "Cornell box" in scenes["cornell"]
    assert "configs/scenes/shapes.ron" in scenes.index
    assert lab.open("rays", scene="configs/scenes/shapes.ron", size=(16, 16), progress=False).lights
