"""Writes blender.fbx, and blender.glb with the same scene. Made with Blender 5.0.1: python -m pip install bpy; python blender.py"""

import os
import bpy

folder = os.path.dirname(os.path.abspath(__file__))
bpy.ops.wm.read_factory_settings(use_empty=True)
scene = bpy.context.scene


def material(name, color, roughness, metallic, emission=0.0):
    made = bpy.data.materials.new(name)
    made.use_nodes = True
    inputs = made.node_tree.nodes["Principled BSDF"].inputs
    inputs["Base Color"].default_value = color + (1,)
    inputs["Roughness"].default_value = roughness
    inputs["Metallic"].default_value = metallic
    inputs["Emission Color"].default_value = color + (1,)
    inputs["Emission Strength"].default_value = emission
    return made


def named(name, *materials):
    made = bpy.context.object
    made.name = name
    for one in materials:
        made.data.materials.append(one)
    return made


red = material("red", (1.0, 0.0, 0.0), 0.3, 0.0)
gold = material("gold", (1.0, 0.7, 0.2), 0.5, 1.0)
glow = material("glow", (1.0, 1.0, 0.5), 0.5, 0.0, 2.0)
painted = material("painted", (1.0, 1.0, 1.0), 0.7, 0.0)
image = bpy.data.images.new("checker", 8, 8)
image.pixels = [v for y in range(8) for x in range(8) for v in (x / 7, y / 7, 0.2, 1)]
image.filepath_raw = os.path.join(folder, "checker.png")
image.file_format = "PNG"
image.save()
node = painted.node_tree.nodes.new("ShaderNodeTexImage")
node.image = image
painted.node_tree.links.new(node.outputs["Color"], painted.node_tree.nodes["Principled BSDF"].inputs["Base Color"])

bpy.ops.mesh.primitive_cube_add(size=2, location=(1, 2, 3), rotation=(0.1, 0.2, 0.3), scale=(1, 2, 0.5))
cube = named("cube", red, gold)
for i, face in enumerate(cube.data.polygons):
    face.material_index = i % 2
bpy.ops.mesh.primitive_uv_sphere_add(segments=8, ring_count=5, location=(-2, 0, 1))
ball = named("ball", painted)
bpy.ops.object.shade_smooth()
ball.parent = cube
bpy.ops.mesh.primitive_circle_add(vertices=7, radius=2, fill_type="NGON", location=(0, 0, -1))
named("heptagon", glow)
bpy.ops.mesh.primitive_cone_add(vertices=5, location=(4, 0, 0))
cone = named("cone", gold)
cone.scale = (-1, 1, 1)
bpy.ops.object.light_add(type="POINT", location=(0, 0, 5))
bulb = named("bulb")
bulb.data.energy, bulb.data.color = 100, (1, 0.5, 0.25)
bpy.ops.object.light_add(type="SUN", location=(0, 0, 5), rotation=(0.5, 0, 0))
named("sun").data.energy = 3
bpy.ops.object.light_add(type="SPOT", location=(3, 1, 5), rotation=(0.5, 0.2, 0))
spot = named("spot")
spot.data.energy, spot.data.spot_size, spot.data.spot_blend = 50, 1.0, 0.2
bpy.ops.object.camera_add(location=(6, -6, 4), rotation=(1.1, 0, 0.8))
scene.camera = named("view")
scene.camera.data.clip_start = 0.2
for light in bpy.data.lights:
    light.name = {"POINT": "bulb", "SUN": "sun", "SPOT": "spot"}[light.type]

for frame, height, turn in [(1, 0, 0), (25, 3, 1.5)]:
    cone.location, cone.rotation_euler = (4, 0, height), (0, 0, turn)
    cone.keyframe_insert("location", frame=frame)
    cone.keyframe_insert("rotation_euler", frame=frame)
scene.frame_start, scene.frame_end = 1, 25
scene.frame_set(1)

path = os.path.join(folder, "blender")
bpy.ops.export_scene.fbx(
    filepath=path + ".fbx", path_mode="COPY", embed_textures=True, bake_anim_use_all_actions=False, bake_anim_use_nla_strips=False
)
bpy.ops.export_scene.gltf(filepath=path + ".glb", export_lights=True, export_cameras=True)
os.remove(image.filepath_raw)
