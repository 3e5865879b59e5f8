"""Runs and simulations from Python give what the program gives."""
import math
import pathlib
import tempfile
import threading
import unittest

import numpy as np

import dssbench

SMALL = {"set": {"n": 12}, "variant": "scalar"}


class Runs(unittest.TestCase):
    def test_record_has_what_the_program_reports(self):
        record = dssbench.run("plate_paper", steps=20, **SMALL)
        self.assertEqual(record["elements"], 144)
        self.assertEqual(record["steps"], 20)
        self.assertEqual(record["status"], "ok")
        self.assertGreater(record["wall_s"], 0)

    def test_options_of_all_kinds_reach_the_program(self):
        with tempfile.TemporaryDirectory() as folder:
            state = pathlib.Path(folder) / "end.csv"
            record = dssbench.run("plate_paper", steps=20, state=state, precision="f32",
                                  json=pathlib.Path(folder) / "record.json", **SMALL)
            table = dssbench.read_state(state)
        self.assertEqual(record["precision"], "f32")
        self.assertEqual(len(table), 144)
        self.assertEqual(table.attrs["units"]["stress_vm"], "Pa")

    def test_mistakes_are_exceptions_with_the_programs_words(self):
        with self.assertRaisesRegex(dssbench.InputError, "did you mean \"plate_paper\""):
            dssbench.run("plate_papr")
        with self.assertRaisesRegex(dssbench.UnstableError, "above the stability limit"):
            dssbench.run("plate_paper", dt=1.0, **SMALL)
        with self.assertRaises(ValueError):
            dssbench.run("plate_paper", no_such_option=1)


class Simulations(unittest.TestCase):
    def simulation(self, **options):
        return dssbench.Simulation("plate_paper", **(SMALL | options))

    def test_state_has_the_bits_of_the_program(self):
        for integrator in ("rk4", "velocity_verlet"):
            record = dssbench.run("plate_paper", steps=20, model="spatial", integrator=integrator,
                                  **SMALL)
            simulation = self.simulation(integrator=integrator)
            for _ in range(4):
                simulation.advance(5)
            self.assertEqual(simulation.digest, record["state_digest"])
            self.assertEqual(simulation.step, 20)

    def test_state_is_the_simulations_own_memory(self):
        simulation = self.simulation()
        state = simulation.state
        self.assertEqual(state.shape, (144, len(dssbench.field_names)))
        self.assertEqual(state.ctypes.data, simulation.displacement.ctypes.data)
        with self.assertRaises(ValueError):
            state[0, 0] = 1
        simulation.advance(10)
        self.assertEqual(state.ctypes.data, simulation.state.ctypes.data)
        del simulation
        self.assertTrue(np.isfinite(state).all())  # the array keeps its memory alive

    def test_a_state_that_is_set_goes_on_as_the_first_did(self):
        first = self.simulation()
        first.advance(10)
        kept = first.state.copy()
        first.advance(10)
        second = self.simulation()
        second.advance(10)
        second.state = kept
        second.advance(10)
        self.assertEqual(first.digest, second.digest)

    def test_callback_sees_every_nth_step_and_may_end(self):
        simulation, seen = self.simulation(), []
        simulation.advance(20, every=8, callback=lambda s: seen.append(s.step))
        self.assertEqual(seen, [8, 16, 20])
        simulation.advance(20, every=5, callback=lambda s: s.step < 25)
        self.assertEqual(simulation.step, 25)

    def test_energy_of_an_undamped_scene_stays(self):
        undamped = {"bodies/0/constants/damping_ratio": 0}
        simulation = dssbench.Simulation("tumbling_box", set=undamped, variant="scalar")
        before = simulation.energy
        simulation.advance(20)
        self.assertLess(abs(simulation.energy / before - 1), 1e-6)

    def test_stress_and_places_have_a_row_for_each_element(self):
        simulation = self.simulation()
        simulation.advance(20)
        self.assertEqual(simulation.stress().shape, (144, 6))
        self.assertEqual(simulation.places().shape, (144, 3))
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "end.csv"
            dssbench.run("plate_paper", steps=20, model="spatial", state=file, **SMALL)
            table = dssbench.read_state(file)
        np.testing.assert_allclose(simulation.von_mises(), table["stress_vm"], rtol=1e-12)
        np.testing.assert_allclose(simulation.places(), table[["x", "y", "z"]], rtol=1e-12)

    def test_picture_is_svg(self):
        simulation = self.simulation()
        self.assertIn("<svg", simulation.picture()._repr_svg_())

    def test_a_step_that_fails_says_so_now_and_later(self):
        simulation = self.simulation(dt=1e-3, force=True)
        for _ in range(2):
            with self.assertRaisesRegex(dssbench.UnstableError, "not finite after step"):
                simulation.advance(5000)
        simulation.state = np.zeros((144, 13))
        simulation.advance(1)

    def test_mistakes_are_refused(self):
        simulation = self.simulation()
        for wrong in (np.zeros((3, 13)), np.full((144, 13), math.nan), np.zeros((13, 144)),
                      np.zeros(144 * 13)):
            with self.assertRaises(dssbench.InputError):
                simulation.state = wrong
        with self.assertRaises(dssbench.InputError):
            simulation.advance(-1)
        with self.assertRaises(dssbench.InputError):
            simulation.advance(10, callback=print)
        with self.assertRaises(TypeError):
            self.simulation(thread=2)
        with self.assertRaisesRegex(dssbench.InputError, "ends in .svg"):
            simulation.picture("plate.png")
        with self.assertRaisesRegex(dssbench.InputError, "use dssbench.run"):
            self.simulation(variant="mpi")


class Threads(unittest.TestCase):
    def test_a_simulation_that_advances_is_not_read(self):
        simulation = dssbench.Simulation("plate_paper", set={"n": 60}, variant="scalar")
        other = threading.Thread(target=simulation.advance, args=(400,))
        other.start()
        refused = 0
        while other.is_alive():
            try:
                simulation.state  # pylint: disable=pointless-statement
            except dssbench.InputError:
                refused += 1
        other.join()
        self.assertGreater(refused, 0)
        alone = dssbench.Simulation("plate_paper", set={"n": 60}, variant="scalar")
        alone.advance(400)
        self.assertEqual(simulation.digest, alone.digest)


class Lists(unittest.TestCase):
    def test_scenes_and_variants_are_those_of_the_program(self):
        self.assertIn("plate_paper", [scene["name"] for scene in dssbench.scenes()])
        usable = [variant["name"] for variant in dssbench.variants() if not variant["unusable"]]
        self.assertIn("scalar", usable)


if __name__ == "__main__":
    unittest.main()
