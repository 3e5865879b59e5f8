"""`compare`: what became slower, and where it makes no claim."""
import unittest

from program import ProgramTest, dssbench


class Compare(ProgramTest):
    def test_compare_fails_where_cells_are_missing_and_refuses_where_all_are(self):
        columns = "experiment,scale,cell,repetition,wall_s,steps,check,status,twin\n"
        rows = {
            cell: "".join(f"t,host,{cell},{r},{1 + 0.001 * r},10,passed,ok,false\n"
                          for r in range(10))
            for cell in "abc"
        }
        old, new, other = (self.write(name, columns + text)
                           for name, text in (("o.csv", rows["a"] + rows["b"]),
                                              ("n.csv", rows["a"]), ("c.csv", rows["c"])))
        result = dssbench("compare", old, new)
        self.assertEqual((result.returncode, "only in OLD" in result.stdout), (1, True))
        self.assertEqual(dssbench("compare", new, old).returncode, 0)
        self.assert_refused(2, ["no cell in common"], "compare", old, other)

    def test_compare_finds_what_became_slower(self):
        columns = "experiment,scale,cell,repetition,wall_s,steps,check,status,twin\n"
        old = columns + "".join(f"t,host,a,{r},{1 + 0.001 * r},10,passed,ok,false\n"
                                for r in range(10))
        new = columns + "".join(f"t,host,a,{r},{1.5 + 0.001 * r},10,passed,ok,false\n"
                                for r in range(10))
        before, after = self.write("old.csv", old), self.write("new.csv", new)
        for first, second, exit_code, verdict in (
            (before, after, 1, "slower"),
            (after, before, 0, "faster"),
            (before, before, 0, "same"),
        ):
            result = dssbench("compare", first, second)
            self.assertEqual(result.returncode, exit_code, result.stdout)
            self.assertIn(verdict, result.stdout)

    def test_compare_makes_no_claim_of_wrong_states_and_fails_where_they_are_new(self):
        columns = "experiment,scale,cell,repetition,wall_s,steps,check,status,twin\n"
        right = self.write(
            "right.csv", columns +
            "".join(f"t,host,a,{r},{1 + 0.001 * r},10,passed,ok,false\n" for r in range(10)))
        wrong = self.write(
            "wrong.csv", columns +
            "".join(f"t,host,a,{r},{0.5 + 0.001 * r},10,failed,wrong,false\n" for r in range(10)))
        for first, second, exit_code in ((right, wrong, 1), (wrong, right, 0)):
            result = dssbench("compare", first, second)
            self.assertEqual(result.returncode, exit_code, result.stdout)
            self.assertIn("no claim: wrong", result.stdout)
            self.assertNotIn("faster", result.stdout)

    def test_compare_refuses_what_is_no_result(self):
        self.assert_refused(2, ["x.csv", '"cell"'], "compare", self.write("x.csv", "a,b\n1,2\n"),
                            self.path("x.csv"))


if __name__ == "__main__":
    unittest.main()
