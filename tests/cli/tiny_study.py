"""Shared by tests of studies: a study that takes a second, and its tables."""
import csv
import json

from program import ProgramTest, dssbench

STUDY = {
    "experiment": "tiny",
    "title": "A tiny study",
    "cells": [{
        "scene": "plate_paper", "set": {"n": [10]}, "variants": ["reference", "scalar"],
        "threads": [1]
    }],
    "base": ["reference"],
    "twin": "scalar",
    "paper": {"source": "nobody", "rows": [{"label": "published", "wall_s": 12.5}]},
    "scales": {
        "smoke": {
            "steps": 40, "oracle_steps": 20, "repetitions": [2, 2], "retries": 0, "budget_s": 60,
            "time_limit_s": 20
        }
    },
}


# A speed-up has an interval, and is shown, from six repetitions on.
SIX = {**STUDY["scales"]["smoke"], "repetitions": [6, 6]}


class TinyStudyTest(ProgramTest):
    def study(self, **changes):
        return self.write("tiny.json", json.dumps({**STUDY, **changes}))

    def experiment(self, *arguments, **options):
        return dssbench("experiment", self.path("tiny.json"), "--scale", "smoke", "--out",
                        self.path("out"), *arguments, **options)

    def rows(self, name):
        with open(self.path(f"out/{name}/tiny.csv"), encoding="utf-8") as file:
            return list(csv.DictReader(file))
