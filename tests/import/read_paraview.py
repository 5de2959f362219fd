"""Reads a run's exports with ParaView and compares them with the run's NumPy arrays, metrics and poses."""
import os
import sys

import numpy as np
from paraview import simple as pv
from vtkmodules.numpy_interface import dataset_adapter as dsa
import paraview.servermanager as servermanager

from run_folder import dumped, metrics, own_bounds, places

snow, field = sys.argv[1:3]
pictures = sys.argv[3] if len(sys.argv) > 3 else None


def opened(name, folder=snow):
    source = pv.OpenDataFile(os.path.join(folder, name))
    assert source is not None, name
    source.UpdatePipeline()
    return source


def data_at(source, time):
    source.UpdatePipeline(time)
    return dsa.WrapDataObject(servermanager.Fetch(source))


def same(what, found, expected, tolerance=1e-6):
    found, expected = np.asarray(found, float), np.asarray(expected, float)
    assert found.shape == expected.shape, (what, found.shape, expected.shape)
    worst = np.max(np.abs(found - expected) / np.maximum(1, np.abs(expected))) if found.size else 0
    assert worst <= tolerance, (what, worst)
    print(f"ParaView: {what}: {found.shape} values agree, largest difference {worst:.1e}")


def check_times(name, folder, source):
    times = list(source.TimestepValues)
    same(f"{name} times", times, metrics(folder)["time"])
    return times


for name in ("particles.vtp.series", "particles.pvd"):
    source = opened(name)
    times = check_times(name, snow, source)
    assert len(times) == 4 and times[0] == 0 and all(abs(t - i / 30) < 2e-4 for i, t in enumerate(times)), times
    for frame, time in enumerate(times):
        data = data_at(source, time)
        rows = np.load(os.path.join(snow, f"particles_{frame:04}.npy"))
        same(f"{name} frame {frame} position", data.Points, rows[:, :3])
        same(f"{name} frame {frame} velocity", data.PointData["velocity"], rows[:, 3:])
        for array in ("J_P", "stress_norm", "material"):
            same(f"{name} frame {frame} {array}", data.PointData[array],
                 np.load(os.path.join(snow, f"particles_{frame:04}_{array}.npy")))
        assert data.GetNumberOfCells() == len(rows)

grid = opened("grid.vti.series")
check_times("grid.vti.series", snow, grid)
rows = np.load(os.path.join(snow, "particles_0003.npy"))
data = data_at(grid, grid.TimestepValues[3])
cell = np.array(data.GetSpacing())
density = np.asarray(data.PointData["density"])
snowy = np.flatnonzero(density)
places_of_nodes = np.array([data.GetPoint(int(n)) for n in snowy])
low, high = places_of_nodes.min(0), places_of_nodes.max(0)
assert np.all(low <= rows[:, :3].min(0)) and np.all(low >= rows[:, :3].min(0) - 2 * cell), (low, rows[:, :3].min(0))
assert np.all(high >= rows[:, :3].max(0)) and np.all(high <= rows[:, :3].max(0) + 2 * cell), (high, rows[:, :3].max(0))
# Sums over the nodes are those over the particles, each of them weighed by its density.
of_node = density * cell.prod()
run = metrics(snow)
same("grid mass", of_node.sum(), run["mass"][3], 1e-5)
same("grid momentum", (of_node[:, None] * np.asarray(data.PointData["velocity"])).sum(0),
     [run[f"momentum_{axis}"][3] for axis in "xyz"], 1e-4)
same("grid centre of mass", (of_node[snowy, None] * places_of_nodes).sum(0) / of_node.sum(), rows[:, :3].astype(float).mean(0), 1e-5)
print(f"ParaView: grid: snow from {low} to {high}, {density.size} nodes, mass {of_node.sum():.6g} kg")

surface = opened("surface_0003.ply")
clean = pv.FeatureEdges(Input=surface, FeatureEdges=0, ManifoldEdges=0, BoundaryEdges=1, NonManifoldEdges=0)
clean.UpdatePipeline()
print(f"ParaView: surface: {surface.GetDataInformation().GetNumberOfCells()} faces, "
      f"{clean.GetDataInformation().GetNumberOfCells()} open edges")
assert clean.GetDataInformation().GetNumberOfCells() == 0
points = np.asarray(dsa.WrapDataObject(servermanager.Fetch(surface)).Points)
for found, expected in ((points.min(0), rows[:, :3].min(0)), (points.max(0), rows[:, :3].max(0))):
    assert np.all(np.abs(found - expected) < 1.5 * cell), (found, expected)  # grows and shrinks by less than two cells
again = opened("surface_0003.obj")
same("surface as OBJ and as PLY", np.asarray(dsa.WrapDataObject(servermanager.Fetch(again)).Points), points, 1e-6)

bodies = opened("bodies.vtp.series", field)
low, high = own_bounds(field, 0)
for frame, time in enumerate(check_times("bodies.vtp.series", field, bodies)):
    points = np.asarray(data_at(bodies, time).Points)
    (place,) = places(field, frame).values()
    same(f"body in frame {frame}", [points.min(0), points.max(0)], [place + low, place + high], 1e-2 * (high - low).max())

heights = opened("heightfield.vti.series", field)
times = check_times("heightfield.vti.series", field, heights)
assert len(times) == 20
run = metrics(field)
for frame, time in enumerate(times):
    data = data_at(heights, time)
    depth, density = np.asarray(data.PointData["depth"], float), np.asarray(data.PointData["density"], float)
    area = data.GetSpacing()[0] * data.GetSpacing()[2]
    same(f"field frame {frame}: mass, depth", [(depth * density).sum() * area, depth.max()],
         [run["snow_mass"][frame], run["max_depth"][frame]], 1e-5)
for array in ("depth", "ground", "density"):
    same(f"field {array} at last", data.PointData[array], dumped(field, array))
names = set(heights.PointData.keys())
assert {"surface", "depth", "ground", "density"} <= names, names
same("surface = ground + depth", data.PointData["surface"],
     np.asarray(data.PointData["ground"]) + np.asarray(data.PointData["depth"]))
mesh = opened("heightfield_0019.ply", field)
points = np.asarray(dsa.WrapDataObject(servermanager.Fetch(mesh)).Points)
same("the mesh's heights", points[:, 1], data.PointData["surface"])
nodes = np.array([data.GetPoint(n) for n in range(data.GetNumberOfPoints())])
same("the mesh's places", points[:, [0, 2]], nodes[:, [0, 2]])

if pictures:
    def shot(name, camera, target):
        view = pv.GetActiveViewOrCreate("RenderView")
        view.ViewSize = [960, 540]
        view.UseColorPaletteForBackground = 0
        view.Background = [0.2, 0.25, 0.32]
        view.OrientationAxesVisibility = 0
        view.CameraPosition, view.CameraFocalPoint, view.CameraViewUp = camera, target, [0, 1, 0]
        pv.Render(view)
        pv.SaveScreenshot(os.path.join(pictures, name), view)
        pv.HideAll(view)

    view = pv.GetActiveViewOrCreate("RenderView")
    particles = opened("particles.vtp.series")
    view.ViewTime = particles.TimestepValues[-1]
    display = pv.Show(particles, view)
    display.SetRepresentationType("Point Gaussian")
    display.GaussianRadius = 0.008
    pv.ColorBy(display, ("POINTS", "velocity", "Magnitude"))
    display.RescaleTransferFunctionToDataRange(True)
    display.SetScalarBarVisibility(view, True)
    low, high = np.array(particles.GetDataInformation().GetBounds()).reshape(3, 2).T
    middle = 0.5 * (low + high)
    shot("paraview_particles.png", list(middle + [0.35, 0.22, 0.7]), list(middle))

    view.ViewTime = heights.TimestepValues[-1]
    warp = pv.WarpByScalar(Input=heights, Scalars=["POINTS", "surface"], UseNormal=1, Normal=[0, 1, 0])
    display = pv.Show(warp, view)
    display.SetRepresentationType("Surface")
    pv.ColorBy(display, ("POINTS", "density"))
    display.RescaleTransferFunctionToDataRange(True)
    display.SetScalarBarVisibility(view, True)
    pv.Show(bodies, view)
    ball = opened("bodies_0019.vtp", field).GetDataInformation().GetBounds()
    middle = 0.5 * np.array([ball[0] + ball[1], ball[2] + ball[3], ball[4] + ball[5]])
    span = ball[1] - ball[0]
    shot("paraview_heightfield.png", list(middle + span * np.array([1.6, 1.6, 2.6])), list(middle))
print("ParaView: all of it reads back")
