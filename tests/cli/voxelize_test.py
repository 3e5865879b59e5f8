"""Bodies from files: `voxelize`, scenes of surfaces and voxels, and pictures."""
import json
import pathlib
import struct
import unittest
import xml.etree.ElementTree

from program import ProgramTest, dssbench, why_no_variant

ROOT = pathlib.Path(__file__).resolve().parents[2]
ARM = ROOT / "experiments" / "scenes" / "arm"


def box_stl(low, high):
    """A binary STL file of a box."""
    corners = [[(low, high)[n >> a & 1][a] for a in range(3)] for n in range(8)]
    quads = [(0, 4, 6, 2), (1, 3, 7, 5), (0, 1, 5, 4), (2, 6, 7, 3), (0, 2, 3, 1), (4, 5, 7, 6)]
    facets = [[corners[q[0]], corners[q[n]], corners[q[n + 1]]] for q in quads for n in (1, 2)]
    records = [struct.pack("<12fH", 0, 0, 0, *sum(facet, []), 0) for facet in facets]
    return b" " * 80 + struct.pack("<I", len(records)) + b"".join(records)


SCENE = {
    "scene": "part", "title": "A part from a file",
    "bodies": [{"name": "part", "geometry": {"stl": {"file": "part.stl", "unit": "mm"}},
                "element": 0.002,
                "constants": {"law": "solid", "E": 1e9, "nu": 0.3, "rho": 1000}}],
    "clamps": [{"select": {"cad_face": {"near": [0, 0.004, 0.004]}}}],
    "loads": [{"select": {"plane": {"point": [0.03, 0, 0], "normal": [-1, 0, 0]}},
               "force": [0, 0, -1], "share": "total"}],
    "run": {"dt": 1e-7, "steps": 20},
}


class Files(ProgramTest):
    def write(self, name, content):
        path = pathlib.Path(self.path(name))
        if isinstance(content, bytes):
            path.write_bytes(content)
        else:
            path.write_text(content if isinstance(content, str) else json.dumps(content),
                            encoding="utf-8")
        return path

    def voxelize(self, *arguments):
        result = dssbench("voxelize", *arguments, "--json", "-")
        self.assertEqual(result.returncode, 0, result.stderr)
        return json.loads(result.stdout)

    def refused(self, *arguments):
        result = dssbench(*arguments)
        self.assertEqual(result.returncode, 2, result.stdout + result.stderr)
        self.assertEqual(result.stderr.count("\n"), 1, result.stderr)
        return result.stderr


class Voxelize(Files):
    def test_a_box_is_reported_exactly(self):
        part = self.write("part.stl", box_stl((0, 0, 0), (30, 8, 8)))
        report = self.voxelize(part, "--unit", "mm", "--cell", "2e-3")
        self.assertEqual(report["elements"], 15 * 4 * 4)
        self.assertEqual(report["pieces"], [240])
        self.assertAlmostEqual(report["volume_error"], 0, delta=1e-6)
        self.assertAlmostEqual(report["thinnest_wall"]["thickness_m"], 0.008, delta=1e-8)
        self.assertEqual(self.voxelize(part, "--unit", "mm", "--count", "15")["elements"], 240)
        report = self.voxelize(part, "--unit", "cm", "--cell", "0.02,0.04,0.08")
        self.assertEqual(report["cells"], [15, 2, 1])
        turned = self.voxelize(part, "--unit", "mm", "--cell", "2e-3", "--axes", "+y,+z,+x")
        self.assertEqual(turned["cells"], [4, 4, 15])

    def test_what_it_writes_is_read_by_scenes_as_the_same_body(self):
        part = self.write("part.stl", box_stl((5, 0, -3), (35, 8, 5)))
        arguments = (part, "--unit", "mm", "--cell", "2e-3", "--picture", self.path("p.svg"))
        for file in ("p.npy", "p.vti"):
            self.voxelize(*arguments, "--output", self.path(file))
        bodies = [{"stl": {"file": "part.stl", "unit": "mm"}}, {"voxels": {"file": "p.npy"}},
                  {"voxels": {"file": "p.vti", "unit": "m"}}]
        digests = set()
        for geometry in bodies:
            body = {**SCENE["bodies"][0], "geometry": geometry}
            if "file" in geometry.get("voxels", {}) and "unit" in geometry["voxels"]:
                del body["element"]
            if geometry == bodies[1]:
                body["origin"] = [0.005, 0, -0.003]
            scene = {**SCENE, "bodies": [body], "clamps": [{"select": {"face": "-x"}}],
                     "loads": [{"select": {"region": {"from": [0.03, -1, -1], "to": [1, 1, 1]}},
                                "force": [0, 0, -1]}]}
            result = dssbench("run", self.write("scene.json", scene), "--json", "-")
            self.assertEqual(result.returncode, 0, result.stderr)
            digests.add(json.loads(result.stdout)["state_digest"])
        self.assertEqual(len(digests), 1, digests)
        xml.etree.ElementTree.parse(self.path("p.svg"))

    def test_bad_input_is_one_line_and_leaves_nothing(self):
        part = self.write("part.stl", box_stl((0, 0, 0), (30, 8, 8)))
        good = ("voxelize", part, "--unit", "mm")
        cases = [
            ((*good, "--cell", "2e-3", "--count", "9"), "either --cell [m] or --count"),
            (good, "either --cell [m] or --count"),
            ((*good, "--cell", "0"), "a length is positive"),
            ((*good, "--cell", "1,2"), "one length, or three"),
            ((*good, "--count", "-3"), "take 1 to"),
            ((*good, "--cell", "0.01"), "larger than the part along y; it measures 0.03 x 0.008"),
            ((*good, "--cell", "1e-9"), "check the unit, or take larger cells"),
            (("voxelize", part, "--cell", "2e-3"), "--unit"),
            (("voxelize", part, "--unit", "ell", "--cell", "2e-3"), "not a unit of length"),
            ((*good, "--cell", "2e-3", "--axes", "+x,+x,+z"), "three different axes"),
            ((*good, "--cell", "2e-3", "--surface", "open"), "not a rule for surfaces"),
            ((*good, "--cell", "2e-3", "--output", self.path("o.png")), "ends in .npy or .vti"),
            ((*good, "--cell", "2e-3", "--output", part.with_suffix(".npy"), "--json",
              part.with_suffix(".npy")), "writes this file"),
            ((*good, "--cell", "2e-3", "--picture", "p.png"), "ends in .svg"),
            (("voxelize", self.path("none.stl"), "--unit", "mm", "--cell", "1"), "cannot be read"),
        ]
        for arguments, part_of_it in cases:
            self.assertIn(part_of_it, self.refused(*arguments), arguments)
        self.write("part.stl", box_stl((0, 0, 0), (30, 8, 8))[:-50])
        self.assertIn("a binary file of 12 triangles", self.refused(*good, "--cell", "2e-3",
                                                                    "--output", self.path("o.npy")))
        self.assertFalse(pathlib.Path(self.path("o.npy")).exists())


class Scenes(Files):
    def test_a_part_of_metres_that_should_be_millimetres_is_refused(self):
        self.write("part.stl", box_stl((0, 0, 0), (300, 80, 80)))
        body = {**SCENE["bodies"][0], "element": {"count": 10},
                "geometry": {"stl": {"file": "part.stl", "unit": "m"}}}
        why = self.refused("run", self.write("scene.json", {**SCENE, "bodies": [body]}))
        self.assertIn("/bodies/0/element", why)
        self.assertIn("it measures 300 x 80 x 80 m; check the unit", why)

    def test_an_output_may_not_replace_its_surface(self):
        self.write("part.stl", box_stl((0, 0, 0), (30, 8, 8)))
        why = self.refused("run", self.write("scene.json", SCENE), "--state", self.path("part.stl"))
        self.assertIn("reads this file", why)

    @unittest.skipIf(why_no_variant("avx2"), why_no_variant("avx2"))
    def test_several_materials_agree_over_variants_and_ranks(self):
        layers = [["##2", "1.2", "122"], ["##2", "332", "132"], ["..2", "112", "112"]]
        constants = {"law": "solid", "materials": {
            "1": {"E": 1e7, "nu": 0.3, "rho": 1000}, "2": {"E": 5e7, "nu": 0.2, "rho": 3000},
            "3": {"E": 2e6, "rho": 500, "damping_ratio": 0.1}}}
        body = {"name": "part", "geometry": {"voxels": {"layers": layers}}, "element": 0.01,
                "constants": constants}
        scene = {**SCENE, "bodies": [body], "run": {"dt": 5e-6, "steps": 60},
                 "clamps": [{"select": {"face": "-x"}}], "gravity": [0, 0, -9.81],
                 "loads": [{"select": {"material": 2}, "force": [0, 0.5, 0]}]}
        path = self.write("scene.json", scene)
        # Of devices, tests/equivalence has a body of several materials.
        here = [name for name in ("avx2", "avx512") if why_no_variant(name) is None]
        result = dssbench("verify", path, "--variant", ",".join(["reference", "scalar", *here]))
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        digests = set()
        for more in ((), ("--threads", "2"), ("--ranks", "2"), ("--variant", "avx2")):
            result = dssbench("run", path, "--json", "-", *more)
            self.assertEqual(result.returncode, 0, result.stderr)
            record = json.loads(result.stdout)
            self.assertLess(abs(record["energy_error"]), 1e-3)
            digests.add(record["state_digest"])
        self.assertEqual(len(digests), 1, digests)
        why = self.refused("run", path, "--model", "linear")
        self.assertIn("its elements differ in mass", why)
        found = []
        for more in (("--solver", "direct"), ("--solver", "cg"), ("--solver", "newton"),
                     ("--solver", "relaxation", "--masses", "scene")):
            result = dssbench("run", path, "--analysis", "static", *more, "--json", "-")
            self.assertEqual(result.returncode, 0, result.stderr)
            found.append(json.loads(result.stdout)["max_displacement_m"])
        self.assertAlmostEqual(found[1] / found[0], 1, delta=1e-7)  # linear equations
        self.assertAlmostEqual(found[3] / found[2], 1, delta=1e-7)  # finite rotations

    def test_dampers_of_extra_links_follow_the_masses_of_their_elements(self):
        def damping(layers, constants):
            body = {"name": "part", "geometry": {"voxels": {"layers": [layers]}}, "element": 0.01,
                    "constants": constants}
            link = {"from": {"elements": [[1, 0, 0]]}, "to": {"elements": [[1, 2, 0]]}, "axis": "y",
                    "constants": {"law": "material", "E": 1e7, "damping_ratio": 0.1}}
            scene = {**SCENE, "bodies": [body], "extra_links": [link], "loads": [], "clamps": []}
            result = dssbench("explain", self.write("scene.json", scene), "--json", "-")
            self.assertEqual(result.returncode, 0, result.stderr)
            return json.loads(result.stdout)["links_by_kind"][-1]["d_normal_n_s_per_m"]

        heavy = {"E": 1e7, "rho": 16000}
        alone = damping(["##", "#.", "##"], {"law": "solid", **heavy})
        both = damping(["12", "1.", "12"], {"law": "solid", "materials": {
            "1": {"E": 1e7, "rho": 1000}, "2": heavy}})
        self.assertAlmostEqual(both / alone, 1, delta=1e-12)

    def clamped(self, select, element=0.002):
        """How many elements a selection of the box has; or why it is refused."""
        self.write("part.stl", box_stl((0, 0, 0), (30, 8, 8)))
        body = {**SCENE["bodies"][0], "element": element}
        path = self.write("scene.json", {**SCENE, "bodies": [body],
                                         "clamps": [{"select": select}]})
        result = dssbench("explain", path, "--json", "-")
        if result.returncode != 0:
            self.assertEqual(result.stderr.count("\n"), 1, result.stderr)
            return result.stderr
        return json.loads(result.stdout)["clamped_elements"]

    def test_places_select_the_elements_there(self):
        bottom = {"near": [0.015, 0.004, 0]}
        self.assertEqual(self.clamped({"cad_face": bottom}), 15 * 4)
        flat = [0.002, 0.002, 0.0005]
        self.assertEqual(self.clamped({"cad_face": bottom}, flat), 15 * 4)  # still one layer
        self.assertEqual(self.clamped({"cad_face": {**bottom, "angle": 100}}), 15 * 16 - 13 * 4)
        region = {"from": [0, 0, 0], "to": [0.0101, 0.004, 0.004]}
        self.assertEqual(self.clamped({"region": region}), 5 * 2 * 2)
        cut = {"point": [0.01, 0, 0], "normal": [1, 0, 0]}
        self.assertEqual(self.clamped({"plane": cut}), 16)
        bar = {"from": [0, 0.004, 0.004], "to": [0.03, 0.004, 0.004], "radius": 0.0015}
        self.assertEqual(self.clamped({"cylinder": bar}), 15 * 4)

    def test_places_that_are_elsewhere_are_refused(self):
        far = self.clamped({"cad_face": {"near": [15, 4, 0]}})  # mm in place of m
        self.assertIn("m from the surface of body \"part\"", far)
        wide = self.clamped({"cad_face": {"near": [0, 0, 0], "angle": 200}})
        self.assertIn("200 is out of range; 0 < angle < 180", wide)
        beyond = self.clamped({"plane": {"point": [0.03, 0, 0], "normal": [1, 0, 0]}})
        self.assertIn("selects nothing", beyond)

    def test_the_arm_gives_a_picture_of_its_stress(self):
        for more in (("--analysis", "static", "--set", "roll=0"), ("--steps", "20")):
            result = dssbench("run", ARM / "arm.json", "--set", "layers=2", *more, "--picture",
                              self.path("arm.svg"))
            self.assertEqual(result.returncode, 0, result.stderr)
            root = xml.etree.ElementTree.parse(self.path("arm.svg")).getroot()
            texts = [node.text for node in root.iter() if node.tag.endswith("text")]
            self.assertTrue(any("von Mises stress" in text for text in texts), texts)
            self.assertIn("arm", texts[0])


if __name__ == "__main__":
    unittest.main()
