"""`compare`: what became slower, and where it makes no claim."""
import os
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

    def test_compare_says_whether_speedups_repeat_themselves(self):
        head = ("label,set,precision,status,speedup_vs_x,speedup_vs_x_low,speedup_vs_x_high,"
                "factor_y,factor_y_low,factor_y_high\n")

        def table(name, *speedups, more=""):
            rows = [f"cell,n=5,f{n},ok,{s},{0.9 * s},{1.1 * s},,,\n"
                    for n, s in enumerate(speedups)]
            # a base over itself, and a second row of a cell without a speed-up
            return self.write(name, head + "base,n=5,f0,ok,1,1,1,,,\n" + "".join(rows)
                              + "cell,n=5,f0,once,,,,,,\n" + more)

        first = table("first.csv", 2, 10, 30)
        result = dssbench("compare", first, table("same.csv", 2.1, 11.5, 30))
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("2 of 3 medians lie in each other's intervals, 3 of 3 intervals overlap",
                      result.stdout)
        self.assertIn("5.0 % (median), at most by 15.0 %: the result repeats itself",
                      result.stdout)
        result = dssbench("compare", first, table("other.csv", 2, 10, 40))
        self.assertEqual(result.returncode, 1)
        self.assertIn("2 of 3 intervals overlap", result.stdout)
        self.assertIn("does not repeat itself", result.stdout)
        self.assertIn("apart", result.stdout)
        # a factor counts, and so does what is missing
        chain = table("chain.csv", 2, 10, more="stage,,f64,ok,,,,3,2.9,3.1\n")
        self.assertEqual(dssbench("compare", chain, chain).returncode, 0)
        result = dssbench("compare", chain, table("failed.csv", 2, 10))
        self.assertEqual(result.returncode, 1)
        self.assertIn("only in OLD", result.stdout)
        self.assert_refused(2, ["no speed-up with an interval in common"], "compare", first,
                            self.write("empty.csv", head))
        self.assert_refused(2, ["two rows are"], "compare", first,
                            table("twice.csv", 2, more="cell,n=5,f0,ok,2,1.9,2.1,,,\n"))

    def test_results_are_compared_as_a_whole(self):
        columns = "label,speedup_vs_x,speedup_vs_x_low,speedup_vs_x_high\n"

        def result(name, *tables):
            os.makedirs(self.path(f"{name}/tables"))
            for number, apart in enumerate(tables):
                speedups = [4 if place < apart else 2 for place in range(20)]
                self.write(f"{name}/tables/t{number}.csv", columns + "".join(
                    f"cell {place},{s},{0.9 * s},{1.1 * s}\n" for place, s in enumerate(speedups)))
            self.write(f"{name}/tables/other.csv", "a,b\n1,2\n")  # without speed-ups
            return self.path(name)

        # one table alone would not repeat itself: 18 of 20
        first = result("first", 0, 0)
        whole = dssbench("compare", first, result("second", 2, 0))
        self.assertEqual(whole.returncode, 0, whole.stderr)
        self.assertIn("38 of 40 intervals overlap", whole.stdout)
        self.assertIn("18 of 20", whole.stdout)
        self.assertEqual(whole.stdout.count("apart"), 2)
        # a table that is missing in NEW did not repeat itself
        missing = dssbench("compare", first, result("third", 0))
        self.assertEqual(missing.returncode, 1, missing.stderr)
        self.assertIn("20 of 40 intervals overlap", missing.stdout)
        self.assertEqual(missing.stdout.count("only in OLD"), 1)
        more = dssbench("compare", result("less", 0), first)
        self.assertEqual(more.returncode, 0, more.stderr)
        self.assertIn("only in NEW", more.stdout)
        self.assert_refused(2, ["is a directory"], "compare", first, f"{first}/tables/t0.csv")
        os.mkdir(self.path("none"))
        self.assert_refused(2, ["tables/NAME.csv with speed-ups"], "compare", self.path("none"),
                            first)

    def test_compare_refuses_what_is_no_result(self):
        self.assert_refused(2, ["x.csv", '"cell"'], "compare", self.write("x.csv", "a,b\n1,2\n"),
                            self.path("x.csv"))


if __name__ == "__main__":
    unittest.main()
