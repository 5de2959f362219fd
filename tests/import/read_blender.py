"""Reads a run's exports with Blender and compares them with the run's NumPy arrays and poses. Blender turns y up into z up."""
import os
import sys

import bpy
import numpy as np

from run_folder import dumped, own_bounds, places

words = sys.argv[sys.argv.index("--") + 1:]
snow, field = words[:2]
pictures = words[2] if len(words) > 2 else None


def fresh():
    bpy.ops.wm.read_factory_settings(use_empty=True)


def vertices(objects):
    points = []
    for thing in objects:
        flat = np.empty(len(thing.data.vertices) * 3, np.float32)
        thing.data.vertices.foreach_get("co", flat)
        matrix = np.array(thing.matrix_world)
        points.append(flat.reshape(-1, 3) @ matrix[:3, :3].T + matrix[:3, 3])
    return np.concatenate(points)


def imported(operator, file):
    before = set(bpy.data.objects)
    assert operator(filepath=file) == {"FINISHED"}, file
    bpy.context.view_layer.update()
    return [thing for thing in bpy.data.objects if thing not in before]


def y_up(points):
    return np.stack([points[:, 0], points[:, 2], -points[:, 1]], 1)


def bounds(points):
    return points.min(0), points.max(0)


rows = np.load(os.path.join(snow, "particles_0003.npy"))[:, :3]

fresh()
points = vertices(imported(bpy.ops.import_mesh.ply, os.path.join(snow, "particles_0003.ply")))
assert points.shape == rows.shape and np.abs(points - rows).max() < 1e-6
print(f"Blender: particles as PLY: {len(points)} vertices, largest difference {np.abs(points - rows).max():.1e} m")

surface = imported(bpy.ops.import_mesh.ply, os.path.join(snow, "surface_0003.ply"))
faces = len(surface[0].data.polygons)
low, high = bounds(vertices(surface))
assert np.all(np.abs(low - rows.min(0)) < 0.06) and np.all(np.abs(high - rows.max(0)) < 0.06), (low, high, bounds(rows))
print(f"Blender: surface as PLY: {faces} faces, {low} to {high}")

objects = imported(bpy.ops.wm.obj_import, os.path.join(snow, "surface_0003.obj"))
turned = y_up(vertices(objects))
assert len(objects[0].data.polygons) == faces
assert np.abs(bounds(turned)[0] - low).max() < 1e-5 and np.abs(bounds(turned)[1] - high).max() < 1e-5
print(f"Blender: surface as OBJ: {len(objects[0].data.polygons)} faces, y up became z up")

bodies = imported(bpy.ops.wm.obj_import, os.path.join(snow, "bodies_0003.obj"))
assert [thing.name for thing in bodies] == ["ground"], bodies
bodies = imported(bpy.ops.wm.obj_import, os.path.join(field, "bodies_0019.obj"))
((name, place),) = places(field, 19).items()
assert [thing.name for thing in bodies] == [name.replace(" ", "_")], (bodies, name)
expected = np.array(own_bounds(field, 0)) + place
found = np.array(bounds(y_up(vertices(bodies))))
assert np.abs(found - expected).max() < 0.01 * (expected[1] - expected[0]).max(), (found, expected)
print(f"Blender: bodies as OBJ: {name}, {found[0]} to {found[1]}")

heights = dumped(field, "ground") + dumped(field, "depth")
mesh = imported(bpy.ops.import_mesh.ply, os.path.join(field, "heightfield_0019.ply"))
points = vertices(mesh)
assert points.shape[0] == heights.size and np.abs(points[:, 1] - heights).max() < 1e-6
turned = y_up(vertices(imported(bpy.ops.wm.obj_import, os.path.join(field, "heightfield_0019.obj"))))
assert np.abs(turned - points).max() < 1e-5
print(f"Blender: height field as PLY and OBJ: {len(points)} vertices, {len(mesh[0].data.polygons)} faces, heights as dumped")

volume = imported(bpy.ops.object.volume_import, os.path.join(snow, "grid_0003.vdb"))
grids = volume[0].data.grids
assert grids.load(), grids.error_message
names = {grid.name: grid.data_type for grid in grids}
assert names == {"density": "FLOAT", "velocity": "VECTOR_FLOAT"}, names
box = np.array(volume[0].bound_box)
assert np.all(box.min(0) <= rows.min(0)) and np.all(box.max(0) >= rows.max(0)), (box, bounds(rows))
assert np.all(box.min(0) > rows.min(0) - 1) and np.all(box.max(0) < rows.max(0) + 1), (box, bounds(rows))
matrix = np.array(grids["density"].matrix_object)
print(f"Blender: grid as VDB: {names}, cell {matrix[0, 0]:.4g} m, box {box.min(0)} to {box.max(0)}")

if pictures:
    fresh()
    scene = bpy.context.scene
    surface = imported(bpy.ops.wm.obj_import, os.path.join(field, "heightfield_0019.obj"))
    material = bpy.data.materials.new("snow")
    material.use_nodes = True
    material.node_tree.nodes["Principled BSDF"].inputs["Base Color"].default_value = (0.9, 0.93, 1, 1)
    surface[0].data.materials.append(material)
    light = bpy.data.objects.new("sun", bpy.data.lights.new("sun", "SUN"))
    light.data.energy, light.rotation_euler = 4, (1.0, 0.2, 0.8)
    scene.collection.objects.link(light)
    scene.world = bpy.data.worlds.new("sky")
    scene.world.use_nodes = True
    scene.world.node_tree.nodes["Background"].inputs[0].default_value = (0.35, 0.5, 0.75, 1)
    scene.world.node_tree.nodes["Background"].inputs[1].default_value = 0.4
    camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    low, high = bounds(vertices(surface))
    middle, span = 0.5 * (low + high), (high - low).max()
    import mathutils
    rim = vertices(surface)  # where the snow is pushed up highest
    middle = rim[np.argmax(rim[:, 2])]
    camera.location = middle + 0.25 * span * np.array([0.5, -1.1, 0.7])
    camera.rotation_euler = (mathutils.Vector(middle) - camera.location).to_track_quat("-Z", "Y").to_euler()
    scene.collection.objects.link(camera)
    scene.camera = camera
    scene.render.engine = "CYCLES"
    scene.cycles.samples, scene.cycles.use_denoising = 24, False
    scene.render.resolution_x, scene.render.resolution_y = 640, 360
    scene.render.filepath = os.path.join(pictures, "blender_heightfield.png")
    bpy.ops.render.render(write_still=True)
print("Blender: all of it reads back")
