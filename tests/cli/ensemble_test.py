"""`run --ensemble`: members side by side, each as a run of its own."""
import csv
import json
import os
import unittest

import jsonschema

from program import dssbench, why_no_variant
from runs import RunTest, members_of

ROOT = os.path.join(os.path.dirname(__file__), "..", "..")
BRACKETS = os.path.join(ROOT, "examples", "ensemble", "brackets.json")
SHORT = ["--steps", 40, "--model", "spatial"]


def on_ranks(ranks):
    return ["--ranks", ranks, "--warmup", 5, "--warmup-time", 0.02]


class Ensemble(RunTest):
    def single_digest(self, scene, values, *arguments):
        sets = [word for key, value in values.items()
                for word in ("--set", f"{key}={json.dumps(value)}")]
        return self.run_json(scene, *sets, *arguments)["state_digest"]

    def test_members_are_runs_of_their_own_to_the_last_bit(self):
        with open(BRACKETS, encoding="utf-8") as file:
            listed = json.load(file)["members"]
        variants = [v for v in ("scalar", "avx2", "avx512") if why_no_variant(v) is None]
        for variant in variants:
            for precision, method in (("f64", "rk4"), ("f32", "velocity_verlet")):
                options = [*SHORT, "--variant", variant, "--precision", precision,
                           "--integrator", method]
                whole = self.run_json("l_bracket", "--ensemble", BRACKETS, *options)
                self.assertEqual(whole["elements"], 152 * len(listed))
                for member, own in zip(listed, members_of(whole), strict=True):
                    self.assertEqual((own["name"], own["status"]), (member["name"], "ok"))
                    single = self.single_digest("l_bracket", member.get("set", {}), *options)
                    self.assertEqual(own["state_digest"], single, (variant, member["name"]))

    def test_a_whole_has_the_same_digest_in_every_variant_and_on_threads(self):
        variants = [v for v in ("scalar", "avx2", "avx512", "opencl") if why_no_variant(v) is None]
        runs = [("--variant", v) for v in variants if v != "scalar"]
        runs += [(*run, "--threads", 2) for run in runs]
        digests = {self.run_json("two_bodies", "--ensemble", 11, *SHORT, *run)["state_digest"]
                   for run in runs}
        self.assertLessEqual(len(digests), 1)

    def test_a_member_that_fails_ends_alone_and_is_named(self):
        members = self.members({}, {"run.dt": 2.5e-6}, {})
        options = ["--ensemble", members, "--model", "spatial", "--steps", 3000, "--force"]
        whole = self.run_json("l_bracket", *options, code=3)
        states = [member["status"] for member in members_of(whole)]
        self.assertEqual(states, ["ok", "unstable", "ok"])
        first, _, last = (member["state_digest"] for member in members_of(whole))
        self.assertEqual(first, last)
        single = dssbench("run", "l_bracket", "--set", "run.dt=2.5e-6", *options[2:])
        words = dssbench("run", "l_bracket", *options).stderr
        self.assertIn("member 2: the state is not finite after step", words)
        step = members_of(whole)[1]["steps"]
        self.assertIn(f"after step {step} ", single.stderr)
        self.assertIn(f"after step {step} ", words)

    def test_every_member_writes_its_files(self):
        members = self.write("m.csv", "name,k\nsoft,900\nhard,1100\n")
        result = dssbench("run", "two_elements", "--ensemble", members, "--steps", 50,
                          "--output", self.path("o.vtu"), "--state", self.path("s.csv"),
                          "--frames", 2, "--json", self.path("r.json"))
        self.assertEqual(result.returncode, 0, result.stderr)
        for name in ("soft", "hard"):
            for file in (f"o-{name}_0000.vtu", f"o-{name}_0002.vtu", f"o-{name}.pvd"):
                self.assertTrue(os.path.exists(self.path(file)), os.listdir(self.directory))
            with open(self.path(f"s-{name}.csv"), encoding="utf-8") as file:
                self.assertEqual(len(list(csv.DictReader(file))), 2)
        record = json.loads(self.read("r.json"))
        soft, hard = members_of(record)
        self.assertEqual((soft["set"], hard["set"]), ({"k": "900"}, {"k": "1100"}))
        self.assertNotEqual(soft["energy_j"], hard["energy_j"])
        self.assertIsNotNone(soft["energy_error"])
        self.assertIn("soft", result.stdout)

    def test_a_member_that_fails_leaves_no_files(self):
        members = self.write("m.json", json.dumps({"members": [
            {"name": "a"}, {"name": "b", "set": {"run.dt": 0.2}}, {"name": "c"}]}))
        result = dssbench("run", "two_elements", "--ensemble", members, "--steps", 41, "--force",
                          "--model", "spatial", "--frames", 3, "--output", self.path("o.vtu"),
                          "--state", self.path("s.csv"), "--json", self.path("r.json"))
        self.assertEqual(result.returncode, 3)
        self.assertIn("1 of 3 members failed; member b: ", result.stderr)
        self.assertEqual(result.stderr.count("\n"), 1)
        states = [own["status"] for own in members_of(json.loads(self.read("r.json")))]
        self.assertEqual(states, ["ok", "unstable", "ok"])
        files = os.listdir(self.directory)
        self.assertTrue({"s-a.csv", "s-c.csv", "o-a.pvd", "o-c.pvd"} <= set(files), files)
        self.assertEqual([file for file in files if "-b" in file], [])

    def test_members_are_judged_as_runs_of_their_own(self):
        # At its stability limit a run gains energy: the balance of every step shows it.
        limit = self.run_json("two_elements", "--model", "spatial")["stability_limit_s"]
        options = ["two_elements", "--model", "spatial", "--force", "--dt", limit, "--steps", 20]
        single = self.run_json(*options, code=1)
        member = members_of(self.run_json(*options, "--ensemble", 2, code=1))[1]
        self.assertEqual((single["status"], member["status"]), ("wrong", "wrong"))
        self.assertEqual(single["energy_error"], member["energy_error"])

    def test_the_rate_counts_the_steps_that_members_take(self):
        members = self.members({"run.steps": 10}, {"run.steps": 2000})
        whole = self.run_json("two_elements", "--ensemble", members, "--model", "spatial")
        self.assertAlmostEqual(whole["element_steps_per_s"] * whole["wall_s"], 2 * 2010, places=3)
        self.assertIsNone(whole["end_s"])

    def test_models_are_those_of_single_runs_that_need_no_watch(self):
        for scene in ("two_elements", "chain", "two_bodies"):
            whole = self.run_json(scene, "--ensemble", 2, "--steps", 20)
            single = self.run_json(scene, "--steps", 20)
            if not single["model_choice"]["is_bounded"]:
                self.assertEqual(members_of(whole)[1]["state_digest"], single["state_digest"])

    def test_ranks_take_whole_members(self):
        if why_no_variant("mpi") is not None:
            self.skipTest("no mpi")
        # Members of both ranks fail, at different steps.
        sets = [{"run.dt": 1e-3 * (1 + 0.01 * m)} for m in range(21)]
        sets[2], sets[14] = {"run.dt": 0.2}, {"run.dt": 0.3}
        options = ["two_elements", "--ensemble", self.members(*sets), "--model", "spatial",
                   "--steps", 300, "--force"]
        for variant, precision in (("scalar", "f64"), ("avx2", "f32"), ("avx512", "f64")):
            if why_no_variant(variant) is not None:
                continue
            kind = ["--variant", variant, "--precision", precision]
            one = self.run_json(*options, *kind, code=3)
            self.assertEqual([m["status"] for m in members_of(one)].count("unstable"), 2)
            for ranks in (2, 3):
                several = self.run_json(*options, *kind, *on_ranks(ranks), code=3)
                lanes = one["ensemble"]["lanes"]
                self.assertEqual(several["ensemble"]["lanes"], ranks * lanes)
                self.assertIn(f"{ranks} ranks, {lanes} member", several["schedule"])
                self.assertEqual(several["messages_per_step"], 0)
                for key in ("status", "reason", "steps", "state_digest", "energy_error"):
                    self.assertEqual([m[key] for m in members_of(several)],
                                     [m[key] for m in members_of(one)], (variant, ranks, key))

    def test_ranks_write_the_files_of_their_members(self):
        if why_no_variant("mpi") is not None:
            self.skipTest("no mpi")
        # Extra links, threads in each rank, batches with empty lanes, members of unequal steps.
        sets = [{"run.steps": 20 + 10 * (m % 2)} for m in range(11)]
        found = []
        for number, options in enumerate(([], [*on_ranks(2), "--threads", 2], on_ranks(3))):
            state = self.path(f"s{number}.csv")
            whole = self.run_json("two_bodies", "--ensemble", self.members(*sets), "--model",
                                  "spatial", "--state", state, "--samples", 2, "--check-tail", 5,
                                  *options)
            files = [self.read(f"s{number}-{m['name']}.csv") for m in members_of(whole)]
            digests = [(m["state_digest"], m["steps"], m["check_tail_error"])
                       for m in members_of(whole)]
            found.append((files, digests))
            if options:
                self.assertIn("members each", whole["schedule"])
        self.assertEqual(found[1:], found[:1] * 2)

    def test_ranks_and_hybrids_divide_members_if_they_must(self):
        if why_no_variant("mpi") is not None:
            self.skipTest("no mpi")
        single = self.run_json("l_bracket", *SHORT)["state_digest"]
        # Members with a halo strategy or with a decomposition; a hybrid.
        for members, schedule, options in (
                (2, "halo deep", [*on_ranks(2), "--halo", "deep"]),
                (2, "3 ranks, blocks", [*on_ranks(3), "--decomposition", "blocks"]),
                (2, "members", ["--variant", "hybrid"])):
            whole = self.run_json("l_bracket", "--ensemble", members, *SHORT, *options)
            self.assertIn(schedule, whole["schedule"])
            self.assertEqual(whole["messages_per_step"] > 0, "--ranks" in options)
            self.assertEqual([own["state_digest"] for own in members_of(whole)],
                             [single] * members)
            # One trial of halo strategies is for all members.
            for key in ("halo", "halo_reason", "network"):
                self.assertEqual(members_of(whole)[0][key], members_of(whole)[1][key], key)
            self.assertEqual("tried" in members_of(whole)[0]["halo_reason"], "blocks" in schedule)
        self.assert_refused(2, ["member 2", "kk"], "run", "two_elements", "--ranks", 2,
                            "--ensemble", self.members({}, {"kk": 1}))

    def test_samples_repeat_the_bits(self):
        record = self.run_json("two_elements", "--ensemble", 5, "--steps", 20, "--samples", 3,
                               "--repeat-for", 0.002)
        self.assertEqual((record["samples"], record["status"]), (3, "ok"))
        self.assertGreater(record["element_steps_per_s"], 0)

    def test_bad_members_are_refused_before_anything_runs(self):
        def refused(words, file, *options):
            self.assert_refused(2, words, "run", "two_elements", "--ensemble", file, *options,
                                "--json", self.path("none.json"))
            self.assertFalse(os.path.exists(self.path("none.json")))

        refused(["has no members"], self.write("a.json", '{"members": []}'))
        refused(["has no members"], self.write("a.csv", "name,k\n"))
        refused(["member 1", "no parameter", "kk"], self.members({"kk": 1}))
        refused(["/members/0", "sets", "set"],
                self.write("b.json", '{"members": [{"sets": {"k": 1}}]}'))
        refused(["member 1", "nan"], self.write("n.csv", "k\nnan\n"))
        refused(["member 1", "inf"], self.write("i.csv", "k\ninf\n"))
        refused(["null", "/members/0/set/k"], self.members({"k": None}))
        refused(["two members", "twin"], self.write("t.csv", "name,k\ntwin,1\ntwin,2\n"))
        refused(["../up", "file names"], self.write("u.csv", "name,k\n../up,1\n"))
        refused(["member 2", "3 elements, not 2", "same elements"],
                self.members({}, {"bodies/0/geometry/box/0": 3}))
        refused(["--rtol"], self.members({}), "--integrator", "dopri5", "--rtol", 1e-6)
        refused(["--check-state"], self.members({}, {"k": 5}), "--check-state", "state")
        refused(["row 2 is empty"], self.write("e.csv", "k,d\n1,2\n,\n"))
        refused(["two columns", "k"], self.write("d.csv", "k,k\n1,2\n"))
        refused(["member 1", "energy at the start"],
                self.members({"initial/0/displacement/0": 1e200}))
        refused(["give a file"], "")
        self.assert_refused(2, ["cannot write"], "run", "two_elements", "--ensemble", 2,
                            "--state", self.path("s.csv"), "--json", "/nonexist/r.json")
        self.assertFalse(os.path.exists(self.path("s-1.csv")))
        refused([".json or .csv"], "members.txt")
        refused(["give 1 to"], "0")
        refused(["GB", "give fewer"], "1000000", "--set", "bodies/0/geometry/box/0=4000000")
        refused(["--analysis"], "2", "--analysis", "static")

    def test_the_schema_describes_the_examples(self):
        folder = os.path.join(ROOT, "experiments", "run", "ensemble")
        with open(os.path.join(folder, "members.schema.json"), encoding="utf-8") as file:
            schema = json.load(file)
        with open(BRACKETS, encoding="utf-8") as file:
            jsonschema.validate(json.load(file), schema)
        for bad in ({"members": []}, {"members": [{"sets": {}}]}, {"members": [{"name": "a/b"}]}):
            with self.assertRaises(jsonschema.ValidationError):
                jsonschema.validate(bad, schema)


if __name__ == "__main__":
    unittest.main()
