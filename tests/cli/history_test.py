"""Probes and the history of a run: on all variants and ranks, over an interruption, at rest."""
import csv
import os
import unittest

from program import dssbench, why_no_variant
from runs import RunTest

BRACKET = ("l_bracket", "--steps", "300", "--model", "spatial")
CENTRE = "corner=bracket,0.005,0.005,0.005"  # of the first element
PROBES = ("--probe", "tip=bracket,0.1,0,0.02", "--probe", CENTRE)


class Histories(RunTest):
    def rows(self, name="history.csv"):
        """The rows of a file, as numbers."""
        with open(self.path(name), encoding="utf-8") as file:
            return [{key: float(value) for key, value in row.items()}
                    for row in csv.DictReader(file)]

    def run_here(self, *arguments):
        """Runs in the directory of the test. @returns what it prints"""
        result = dssbench("run", *arguments, cwd=self.directory)
        self.assertEqual(result.returncode, 0, result.stderr)
        return result.stdout

    def test_rows_are_of_the_asked_steps_and_the_end(self):
        printed = self.run_here(*BRACKET, *PROBES, "--every", "70", "--state", "s.csv")
        rows = self.rows()
        self.assertEqual([row["step"] for row in rows], [0, 70, 140, 210, 280, 300])
        for row in rows:
            self.assertAlmostEqual(row["t"], row["step"] * rows[-1]["t"] / 300, delta=1e-18)
        with open(self.path("s.csv"), encoding="utf-8") as file:
            first = next(csv.DictReader(file))
        for axis in "xyz":
            self.assertEqual(rows[-1][f"corner.u{axis}"], float(first[f"u{axis}"]))
            self.assertEqual(rows[-1][f"corner.v{axis}"], float(first[f"v{axis}"]))
        self.assertEqual(rows[-1]["corner.von_mises"], float(first["stress_vm"]))
        self.assertIn('probe tip: in element [9, 0, 1] of body "bracket"', printed)
        self.assertIn("wrote history.csv", printed)
        self.assertEqual(sorted(os.listdir(self.directory)), ["history.csv", "s.csv"])

    def test_energy_and_reactions_are_those_of_the_record(self):
        record = self.run_json(*BRACKET, "--history", "h.csv")
        last = self.rows("h.csv")[-1]
        self.assertEqual(len(self.rows("h.csv")), 301)
        self.assertEqual(last["energy"], record["energy_j"])
        for axis, name in enumerate("xyz"):
            self.assertEqual(last[f"reaction_f{name}"], record["reaction_force_n"][axis])
            self.assertEqual(last[f"reaction_m{name}"], record["reaction_moment_n_m"][axis])
        self.assertGreater(last["kinetic_energy"], 0)
        self.assertLess(last["kinetic_energy"], last["energy"])

    def test_threads_and_ranks_write_the_same_file(self):
        self.run_here(*BRACKET, *PROBES, "--variant", "avx2")
        whole = self.read("history.csv")
        places = [("--threads", "2"), ("--variant", "avx2", "--tile", "3")]
        if not why_no_variant("mpi"):
            places.append(("--ranks", "2"))
        for place in places:
            self.run_here(*BRACKET, *PROBES, *place)
            self.assertEqual(self.read("history.csv"), whole, place)

    def test_a_continued_run_goes_on_with_its_rows(self):
        of_run = (*BRACKET, *PROBES, "--every", "7")
        self.run_here(*of_run)
        whole = self.read("history.csv")
        saving = ("--checkpoint", "c.ckpt", "--checkpoint-every", "130")
        self.run_here(*of_run, *saving)
        self.assertEqual(self.read("history.csv"), whole)
        self.write("history.csv", "of another run\n")
        again = (*of_run, "--restart", "c.ckpt.previous")
        places = [("--threads", "2")] + ([] if why_no_variant("mpi") else [("--ranks", "2")])
        for place in places:
            self.run_here(*again, *place)
            self.assertEqual(self.read("history.csv"), whole, place)

    def test_other_columns_are_refused(self):
        self.run_here(*BRACKET, *PROBES, "--checkpoint", "c.ckpt", "--checkpoint-every", "130")
        whole = self.read("history.csv")
        longer = ("run", "l_bracket", "--steps", "390", "--model", "spatial", "--restart", "c.ckpt")
        self.assert_refused(2, ["other columns", "--probe"], *longer, "--probe", CENTRE,
                            cwd=self.directory)
        self.assertEqual(self.read("history.csv"), whole)
        self.run_here(*longer[1:])  # without a history
        self.run_here(*BRACKET, "--checkpoint", "c.ckpt")
        self.assert_refused(2, ["had no history"], *longer, *PROBES, cwd=self.directory)
        self.assertEqual(self.read("history.csv"), whole)

    def test_a_longer_run_goes_on_where_a_shorter_one_ended(self):
        longer = ("l_bracket", "--steps", "390", "--model", "spatial", *PROBES)
        for every in ("20", "7"):
            self.run_here(*longer, "--every", every)
            whole = self.read("history.csv")
            self.run_here(*BRACKET, *PROBES, "--every", every, "--checkpoint", "c.ckpt")
            self.run_here(*longer, "--every", every, "--restart", "c.ckpt")
            self.assertEqual(self.read("history.csv"), whole, every)
        self.run_here("l_bracket", "--steps", "900", "--model", "spatial", "--history", "h.csv",
                      "--checkpoint", "c.ckpt")  # each step has a row, later every second
        self.run_here("l_bracket", "--steps", "1500", "--model", "spatial", "--history", "h.csv",
                      "--restart", "c.ckpt")
        self.assertEqual([row["step"] for row in self.rows("h.csv")],
                         [*range(901), *range(902, 1501, 2)])

    def test_a_run_that_fails_leaves_an_earlier_file(self):
        self.run_here(*BRACKET, *PROBES)
        whole = self.read("history.csv")
        self.assert_refused(3, ["l_bracket"], "run", *BRACKET, *PROBES, "--dt", "1e-3", "--force",
                            "--checkpoint", "c.ckpt", "--checkpoint-every", "1",
                            cwd=self.directory)
        self.assertEqual(self.read("history.csv"), whole)

    def test_rows_are_not_lost_if_the_end_cannot_be_written(self):
        of_run = (*BRACKET, *PROBES, "--every", "7")
        self.run_here(*of_run)
        whole = self.read("history.csv")
        os.remove(self.path("history.csv"))
        self.assert_refused(2, ["/dev/full"], "run", *of_run, "--checkpoint", "c.ckpt",
                            "--checkpoint-every", "130", "--state", "/dev/full",
                            cwd=self.directory)
        self.assertNotIn("history.csv", os.listdir(self.directory))
        self.run_here(*of_run, "--restart", "c.ckpt.previous")
        self.assertEqual(self.read("history.csv"), whole)

    def test_adaptive_steps_end_at_rows(self):
        adaptive = (*BRACKET, *PROBES, "--integrator", "dopri5", "--rtol", "1e-6")
        self.run_here(*adaptive)
        rows = self.rows()
        self.assertEqual([row["step"] for row in rows], list(range(0, 301, 3)))
        self.run_here(*BRACKET, *PROBES, "--every", "3")
        for ours, fixed in zip(rows, self.rows()):
            self.assertAlmostEqual(ours["tip.uy"], fixed["tip.uy"], delta=1e-9)

    def test_members_have_files_of_their_own(self):
        members = ("--ensemble", self.members({}, {"loads.0.force.1": -5}))
        self.run_here(*BRACKET, *PROBES, "--every", "50", *members)
        self.assertEqual(len(self.rows("history-1.csv")), 7)
        alone = self.read("history-1.csv")
        self.assertNotEqual(self.read("history-2.csv"), alone)
        self.run_here(*BRACKET, *PROBES, "--every", "50")
        self.assertEqual(self.read("history.csv"), alone)
        for place in [()] + ([] if why_no_variant("mpi") else [("--ranks", "2")]):
            saved = (*BRACKET, *PROBES, "--every", "50", *members, *place)
            self.run_here(*saved, "--checkpoint", "c.ckpt", "--checkpoint-every", "128")
            self.run_here(*saved, "--restart", "c.ckpt.previous")
            self.assertEqual(self.read("history-1.csv"), alone, place)

    def test_a_state_of_rest_has_one_row(self):
        self.run_here("l_bracket", "--analysis", "static", *PROBES, "--state", "s.csv")
        (row,) = self.rows()
        self.assertEqual(row["kinetic_energy"], 0)
        with open(self.path("s.csv"), encoding="utf-8") as file:
            first = next(csv.DictReader(file))
        self.assertEqual(row["corner.von_mises"], float(first["stress_vm"]))

    def test_mistakes_write_nothing(self):
        body = "bracket,0,0,0"
        for words, options in (
                (["--probe", "no body", "bracket"], ("--probe", "a=braket,0,0,0")),
                (["three coordinates", "NAME=BODY,x,y,z"], ("--probe", "a=bracket,0,0")),
                (["nan", "no number"], ("--probe", "a=bracket,0,0,nan")),
                (["letters, digits"], ("--probe", f"a.b={body}")),
                (["another name"], ("--probe", f"a={body}", "--probe", f"a={body}")),
                (["--every 0"], ("--every", "0")),
                (["--every -3"], ("--every", "-3")),
                (["outside of the body"], ("--probe", "a=bracket,5,0,0")),
                (["--every 1", "give at least 3"], ("--steps", "2000001", "--every", "1")),
                (["--history", "empty"], ("--history", "")),
                (["no/where"], ("--history", "no/where.csv")),
                (["--history h.csv", "--state"], ("--history", "h.csv", "--state", "h.csv"))):
            self.assert_refused(2, words, "run", "l_bracket", *options, cwd=self.directory)
            self.assertEqual(os.listdir(self.directory), [])
        self.assert_refused(3, ["l_bracket"], "run", *BRACKET, *PROBES, "--dt", "1e-3", "--force",
                            cwd=self.directory)
        self.assertEqual(os.listdir(self.directory), [])


if __name__ == "__main__":
    unittest.main()
