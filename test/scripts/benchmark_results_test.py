#!/usr/bin/env python3
"""scripts/compare_benchmarks and the table of scripts/plot_benchmarks, on files made here."""
import json
import os
import subprocess
import sys
import tempfile
import unittest

SCRIPTS = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "scripts")


def repetitions(name, times_us, **counters):
    common = {"run_name": name + "/iterations:20/manual_time", "run_type": "iteration", "time_unit": "us"}
    return [dict(common, real_time=time_us, **counters) for time_us in times_us]


class BenchmarkResults(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()

    def tearDown(self):
        self.folder.cleanup()

    def path(self, name):
        return os.path.join(self.folder.name, name)

    def write(self, name, entries):
        with open(self.path(name), "w", encoding="utf-8") as file:
            json.dump({"benchmarks": entries}, file)
        return self.path(name)

    def run_script(self, script, *arguments):
        command = [sys.executable, os.path.join(SCRIPTS, script), *arguments]
        return subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, check=False)

    def test_marks_what_lies_outside_the_spread(self):
        a = self.write("a.json", repetitions("kernel/k", [100, 101, 102]) + repetitions("stage/s", [100, 150, 200])
                       + repetitions("stage/gone", [1, 1]))
        b = self.write("b.json", repetitions("kernel/k", [200, 202, 204]) + repetitions("stage/s", [120, 160, 190]))
        result = self.run_script("compare_benchmarks", a, b)
        self.assertEqual(result.returncode, 0, result.stderr)
        rows = {line.split()[0]: line for line in result.stdout.splitlines()[1:]}
        self.assertIn(" 2.000 ", rows["kernel/k"])
        self.assertTrue(rows["kernel/k"].endswith("slower"))
        self.assertIn(" 1.067 ", rows["stage/s"])
        self.assertNotRegex(rows["stage/s"], "slower|faster")
        self.assertIn(f"only in {a}: stage/gone", result.stdout)
        self.assertIn("faster", self.run_script("compare_benchmarks", b, a).stdout)

    def test_compares_the_stages_of_a_pipeline(self):
        frames = [dict(entry, **{"ms:frame": 30.0}) for entry in repetitions("pipeline/room", [30000, 31000])]
        a = self.write("a.json", frames)
        self.assertIn("pipeline/room ms:frame", self.run_script("compare_benchmarks", a, a).stdout)

    def expect_error(self, message, *arguments):
        result = self.run_script("compare_benchmarks", *arguments)
        self.assertEqual(result.returncode, 1)
        self.assertRegex(result.stderr, "^error: .*" + message + ".*\n$")

    def test_says_what_is_wrong(self):
        good = self.write("good.json", repetitions("k", [1, 2]))
        with open(self.path("text.json"), "w", encoding="utf-8") as file:
            file.write("no json")
        self.expect_error("cannot be read: No such file", good, self.path("missing.json"))
        self.expect_error("no result of google-benchmark", self.path("text.json"), good)
        self.expect_error("holds no figures", self.write("empty.json", []), good)
        self.expect_error("no repetitions", self.write("once.json", repetitions("k", [1])), good)
        self.expect_error("no benchmark in common", self.write("other.json", repetitions("l", [1, 2])), good)
        self.expect_error("no regular expression", good, good, "--filter", "(")

    def test_finds_the_limit_that_binds(self):
        limits = (repetitions("limit/copy", [1, 1], bytes_per_second=10e9)
                  + repetitions("limit/multiply_add", [1, 1], flops=100e9)
                  + repetitions("limit/gather_512KiB", [1, 1], gathers=1e9))
        # 1 MB at 10 GB/s: 0.1 ms; 4 M operations at 100 G/s: 0.04 ms; 0.25 M gathers at 1 G/s: 0.25 ms
        kernel = repetitions("kernel/model_view/k/room", [1000, 1000], bytes_per_second=1e9, flops=4e9, gathers=0.25e9)
        path = self.write("a.json", limits + kernel)
        table = self.run_script("plot_benchmarks", path, "--input", "room", "--output", self.folder.name).stdout
        row = "| model_view/k | 1.000 ms | 1.00 MB | 0.100 ms | 0.040 ms | 0.250 ms | gathers | 4.0 |"
        self.assertIn(row, table)
        result = self.run_script("plot_benchmarks", self.write("b.json", kernel), "--input", "room")
        self.assertIn("error: the limits are not measured", result.stderr)


if __name__ == "__main__":
    unittest.main()
