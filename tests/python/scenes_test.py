"""Scenes that are made in Python."""
import pathlib
import tempfile
import unittest

import numpy as np

import dssbench

STEEL = {"law": "solid", "E": 2.1e11, "nu": 0.3, "rho": 7850}


def bar(voxels=None):
    """A bar of 12 x 3 x 3 elements of 10 mm, clamped at one end and pulled at the other."""
    scene = dssbench.Scene.of_voxels(np.ones((12, 3, 3)) if voxels is None else voxels, 0.01, STEEL)
    scene["clamps"] = [{"select": {"face": "-x"}}]
    scene["loads"] = [{"select": {"face": "+x"}, "force": [1000, 0, 0], "share": "total"}]
    return scene


class Scenes(unittest.TestCase):
    def test_an_array_is_a_body(self):
        voxels = np.ones((12, 3, 3))
        voxels[4:8, 1, 1] = 0
        scene = bar(voxels)
        scene.set_run(duration=1e-4)
        self.assertEqual(dssbench.Simulation(scene, variant="scalar").elements, 108 - 4)

    def test_indices_are_x_y_z(self):
        voxels = np.zeros((5, 4, 3))
        voxels[:, 0, 0] = 1  # a row along x
        voxels[0, :, 0] = 1
        scene = dssbench.Scene.of_voxels(voxels, 0.01, STEEL)
        scene.set_run(duration=1e-6)
        places = dssbench.Simulation(scene, variant="scalar").places()
        self.assertAlmostEqual(places[:, 0].max(), 0.045)
        self.assertAlmostEqual(places[:, 1].max(), 0.035)
        self.assertAlmostEqual(places[:, 2].max(), 0.005)

    def test_steps_are_a_share_of_the_limit_and_end_on_time(self):
        scene = bar()
        scene.set_run(duration=1e-4, share=0.25)
        simulation = dssbench.Simulation(scene, variant="scalar")
        self.assertLessEqual(simulation.dt, 0.25 * simulation.stability_limit)
        simulation.advance()
        self.assertAlmostEqual(simulation.time, 1e-4)

    def test_a_pulled_bar_is_as_long_as_its_statics_say(self):
        scene = bar()
        scene["stabilization"] = {"k": 0, "d": 20, "k_rot": 0, "d_rot": 0}
        scene.set_run(duration=4e-3)
        simulation = dssbench.Simulation(scene, variant="scalar")
        simulation.advance()
        end = simulation.displacement[simulation.places()[:, 0] > 0.11, 0].mean()
        # F L / E A between the centres of the first and the last layer; nu is held at the clamp
        exact = 1000 * 0.11 / (2.1e11 * 0.03**2)
        self.assertLess(abs(end / exact - 1), 0.05)

    def test_the_saved_file_is_a_scene_of_the_program(self):
        scene = bar()
        scene.set_run(duration=1e-5)
        with tempfile.TemporaryDirectory() as folder:
            path = scene.save(pathlib.Path(folder) / "bar.json")
            self.assertEqual(sorted(file.name for file in path.parent.iterdir()),
                             ["bar.json", "bar_0.npy"])
            record = dssbench.run(path, variant="scalar")
        self.assertEqual(record["elements"], 108)

    def test_mistakes_are_refused(self):
        for wrong in (np.ones((3, 3)), np.full((2, 2, 2), 0.5), np.full((2, 2, 2), -1)):
            with self.assertRaisesRegex(dssbench.InputError, "voxels"):
                dssbench.Simulation(bar(wrong))
        scene = bar()
        scene.set_run(duration=1e-5)
        scene["clamp"] = []
        with self.assertRaisesRegex(dssbench.InputError, "clamp"):
            dssbench.Simulation(scene)
        with self.assertRaisesRegex(dssbench.InputError, 'lacks the key "run"'):
            dssbench.Simulation(bar())


if __name__ == "__main__":
    unittest.main()
