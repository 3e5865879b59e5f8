"""VTK reads the files of `--output` as ParaView does. Skipped without VTK (pip install vtk)."""
import pathlib
import unittest

from program import dssbench
from runs import RunTest

ROOT = pathlib.Path(__file__).resolve().parents[2]

try:
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkFiltersGeneral import vtkWarpVector
    from vtkmodules.vtkFiltersVerdict import vtkCellSizeFilter
    from vtkmodules.vtkIOHDF import vtkHDFReader
    from vtkmodules.vtkIOXML import vtkXMLImageDataReader, vtkXMLUnstructuredGridReader
    WHY_NOT = None
except ImportError as missing:
    WHY_NOT = f"this python has no {missing.name}"


@unittest.skipIf(WHY_NOT, WHY_NOT)
class Readers(RunTest):
    def grid(self, name):
        """The grid of a file, with its reader, which must live as long."""
        reader = vtkXMLUnstructuredGridReader()
        reader.SetFileName(self.path(name))
        reader.Update()
        return reader.GetOutput(), reader

    def test_a_body_is_whole_and_has_all_arrays(self):
        self.run_json("two_bodies", "--steps", "40", "--output", "b.vtu", "--frames", "1")
        grid, _ = self.grid("b_0001.vtu")
        cells, points = grid.GetCellData(), grid.GetPointData()
        names = [cells.GetArrayName(n) for n in range(cells.GetNumberOfArrays())]
        self.assertEqual(names, ["displacement", "velocity", "rotation_vector", "stress",
                                 "von_mises", "principal_stress", "strain", "body"])
        names = [points.GetArrayName(n) for n in range(points.GetNumberOfArrays())]
        self.assertEqual(names, ["displacement", "stress", "von_mises"])
        self.assertLess(grid.GetNumberOfPoints(), 4 * grid.GetNumberOfCells())
        bodies = vtk_to_numpy(cells.GetArray("body"))
        self.assertEqual(sorted(set(bodies)), [0, 1])
        self.assertEqual(cells.GetArray("stress").GetComponentName(3), "XY")
        principal = vtk_to_numpy(cells.GetArray("principal_stress"))
        stress = vtk_to_numpy(cells.GetArray("stress"))
        largest = abs(stress).max()
        self.assertGreater(largest, 0)
        self.assertLessEqual(abs(principal.sum(axis=1) - stress[:, :3].sum(axis=1)).max(),
                             1e-12 * largest)

    def test_a_series_in_one_file_has_the_states_of_the_files(self):
        run = ("two_bodies", "--steps", "40", "--frames", "4")
        self.run_json(*run, "--output", "b.vtu")
        self.run_json(*run, "--output", "b.vtkhdf")
        reader = vtkHDFReader()
        reader.SetFileName(self.path("b.vtkhdf"))
        reader.UpdateInformation()
        self.assertEqual(reader.GetNumberOfSteps(), 5)
        for step in range(5):
            reader.SetStep(step)
            reader.Update()
            whole, (single, _) = reader.GetOutput(), self.grid(f"b_{step:04}.vtu")
            time = single.GetFieldData().GetArray("TimeValue").GetValue(0)
            self.assertEqual(reader.GetTimeValue(), time)
            points = [vtk_to_numpy(grid.GetPoints().GetData()) for grid in (whole, single)]
            self.assertTrue((points[0] == points[1]).all())
            self.assertEqual(whole.GetNumberOfCells(), single.GetNumberOfCells())
            for cell in (0, whole.GetNumberOfCells() - 1):
                self.assertEqual([whole.GetCell(cell).GetPointId(n) for n in range(8)],
                                 [single.GetCell(cell).GetPointId(n) for n in range(8)])
            for of in ("GetPointData", "GetCellData"):
                ours, theirs = getattr(whole, of)(), getattr(single, of)()
                for n in range(theirs.GetNumberOfArrays()):
                    name = theirs.GetArrayName(n)
                    values = [vtk_to_numpy(data.GetArray(name)) for data in (ours, theirs)]
                    self.assertTrue((values[0] == values[1]).all(), (step, name))

    def test_voxels_that_are_written_are_an_image(self):
        arm = ROOT / "experiments" / "scenes" / "arm" / "arm.stl"
        result = dssbench("voxelize", arm, "--unit", "mm", "--cell", "8e-3", "--surface", "winding",
                          "--output", self.path("arm.vti"))
        self.assertEqual(result.returncode, 0, result.stderr)
        reader = vtkXMLImageDataReader()
        reader.SetFileName(self.path("arm.vti"))
        reader.Update()
        image = reader.GetOutput()
        material = vtk_to_numpy(image.GetCellData().GetArray("material"))
        self.assertIn(f"{material.sum()} elements", result.stdout)
        self.assertEqual(image.GetSpacing(), (8e-3, 8e-3, 8e-3))

    def test_its_field_data_tell_scene_time_and_units(self):
        record = self.run_json("two_bodies", "--steps", "40", "--output", "b.vtu")
        grid, _ = self.grid("b.vtu")
        fields = grid.GetFieldData()
        self.assertEqual(fields.GetArray("TimeValue").GetValue(0), record["end_s"])
        self.assertEqual(fields.GetAbstractArray("scene").GetValue(0), "two_bodies")
        self.assertEqual(fields.GetAbstractArray("units").GetValue(0), "m, s, rad, Pa")
        self.assertEqual(fields.GetAbstractArray("bodies").GetNumberOfValues(), 2)

    def test_elements_have_their_volumes_and_warp_without_gaps(self):
        result = dssbench("run", "cantilever_beam", "--analysis", "static", "--output",
                          self.path("c.vtu"))
        self.assertEqual(result.returncode, 0, result.stderr)
        grid, _ = self.grid("c.vtu")
        self.assertEqual(grid.GetNumberOfPoints(), 4 * 21)
        warp = vtkWarpVector()
        warp.SetInputData(grid)
        warp.SetInputArrayToProcess(0, 0, 0, 0, "displacement")
        sizes = vtkCellSizeFilter()
        for source in (None, warp):
            if source:
                sizes.SetInputConnection(source.GetOutputPort())
            else:
                sizes.SetInputData(grid)
            sizes.Update()
            volumes = vtk_to_numpy(sizes.GetOutput().GetCellData().GetArray("Volume"))
            for volume in volumes:
                self.assertAlmostEqual(volume / (0.05 * 0.05 * 0.05), 1, delta=0.02)


if __name__ == "__main__":
    unittest.main()
