#!/usr/bin/env python3
"""scripts/check finds what breaks a wall: each test plants one fault in a small tree that is good otherwise."""
import json
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
GOOD = {
    ".clang-format": (ROOT / ".clang-format").read_text(),
    ".clang-tidy": (ROOT / ".clang-tidy").read_text(),
    "include/depth_fusion/common/counter.h": "#pragma once\n\nint count();\n",
    "include/depth_fusion/frames/frame.h": '#pragma once\n\n#include <string>\n\nstd::string nameOfFrame();\n',
    "include/depth_fusion/map/map.h": '#pragma once\n\n#include "depth_fusion/common/counter.h"\n',
    "include/depth_fusion/tsdf_fusion/tsdf_fusion.h": '#pragma once\n\n#include "depth_fusion/map/map.h"\n',
    "include/depth_fusion/tsdf_fusion/tsdf_fusion_parameters.h": "#pragma once\n\nstruct P {};\n",
    "include/depth_fusion/model_view/model_view.h": "#pragma once\n",
    "include/depth_fusion/model_view/model_view_parameters.h": "#pragma once\n",
    "src/common/counter.cpp": '#include "depth_fusion/common/counter.h"\n\nint count() { return 1; }\n',
    "src/ros/nodelets/nodelet.cpp": '#include <ros/ros.h>\n\n#include "depth_fusion/map/map.h"\n',
}


class Check(unittest.TestCase):
    def setUp(self):
        self.root = pathlib.Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.root)
        for path, text in GOOD.items():
            self.write(path, text)
        source = self.root / "src/common/counter.cpp"
        command = f"c++ -I{self.root}/include -I{self.root}/src -std=c++17 -c {source}"
        commands = [{"directory": str(self.root), "file": str(source), "command": command}]
        self.write("build/compile_commands.json", json.dumps(commands))

    def write(self, path, text):
        path = self.root / path
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)

    def plant(self, path, line):
        """Puts the line behind the first of a good file."""
        first, rest = GOOD[path].split("\n", 1)
        self.write(path, f"{first}\n\n{line}\n{rest}")

    def check(self, wall):
        command = [sys.executable, ROOT / "scripts/check", "--root", self.root, wall]
        return subprocess.run(command, capture_output=True, text=True, check=False)

    def expect_good(self, wall):
        run = self.check(wall)
        self.assertEqual(run.returncode, 0, run.stderr)

    def expect_problem(self, wall, *parts):
        run = self.check(wall)
        self.assertEqual(run.returncode, 1, run.stderr)
        for part in parts:
            self.assertIn(part, run.stderr)


class Includes(Check):
    def test_a_good_tree(self):
        self.expect_good("includes")

    def test_ros_in_the_core(self):
        for header in ("ros/ros.h", "sensor_msgs/Image.h", "pcl_ros/point_cloud.h", "tf2_ros/buffer.h", "nodelet/nodelet.h"):
            self.plant("src/common/counter.cpp", f"#include <{header}>")
            self.expect_problem("includes", "src/common/counter.cpp:3:", header, "src/ros")
        self.plant("src/common/counter.cpp", '#include "std_msgs/Header.h"')
        self.expect_problem("includes", "src/common/counter.cpp:3:", "std_msgs/Header.h")

    def test_opencl_in_a_public_header(self):
        self.plant("include/depth_fusion/map/map.h", "#include <CL/opencl.hpp>")
        self.expect_problem("includes", "map/map.h:3:", "public header")

    def test_a_worker_in_a_data_header(self):
        for data in ("frames/frame.h", "tsdf_fusion/tsdf_fusion_parameters.h"):
            self.plant(f"include/depth_fusion/{data}", '#include "depth_fusion/map/map.h"')
            self.expect_problem("includes", f"{data}:3:", "the worker")
            self.write(f"include/depth_fusion/{data}", GOOD[f"include/depth_fusion/{data}"])

    def test_a_worker_in_a_data_header_of_ros(self):
        for data in ("output/picture_parameters.h", "nodelets/mesh_nodelet_parameters.h", "in_process/frames.h"):
            path = f"src/ros/{data}"
            self.write(path, '#pragma once\n\n#include "depth_fusion/tsdf_fusion/tsdf_fusion_parameters.h"\n')
            self.expect_good("includes")
            self.write(path, '#pragma once\n\n#include "depth_fusion/map/map.h"\n')
            self.expect_problem("includes", f"{path}:3:", "the worker")
            (self.root / path).unlink()

    def test_a_library_of_the_workshop_in_a_nodelet(self):
        self.plant("src/ros/nodelets/nodelet.cpp", "#include <nlohmann/json.hpp>")
        self.expect_problem("includes", "src/ros/nodelets/nodelet.cpp:3:", "nlohmann/json.hpp", "the workshop")

    def test_a_floor_above(self):
        self.plant("include/depth_fusion/common/counter.h", '#include "depth_fusion/map/map.h"')
        self.expect_problem("includes", "common/counter.h:3:", "a floor above", "common -> map -> common")

    def test_a_neighbours_worker(self):
        self.plant("include/depth_fusion/model_view/model_view.h", '#include "depth_fusion/tsdf_fusion/tsdf_fusion.h"')
        self.expect_problem("includes", "model_view/model_view.h:3:", "neighbour tsdf_fusion")

    def test_a_circle_of_neighbours(self):
        parameters = "include/depth_fusion/{0}/{0}_parameters.h"
        self.plant(parameters.format("model_view"), '#include "depth_fusion/tsdf_fusion/tsdf_fusion_parameters.h"')
        self.expect_good("includes")
        self.plant(parameters.format("tsdf_fusion"), '#include "depth_fusion/model_view/model_view_parameters.h"')
        self.expect_problem("includes", "in a circle", "model_view -> tsdf_fusion -> model_view")

    def test_a_folder_without_floor(self):
        self.write("src/cellar/barrel.cpp", '#include "depth_fusion/common/counter.h"\n')
        self.expect_problem("includes", "src/cellar/barrel.cpp:1:", "has no floor")

    def test_a_use_that_precompiled_headers_hide(self):
        self.plant("src/common/counter.cpp", "std::vector<int> counts;")
        self.expect_problem("includes", "src/common/counter.cpp:3:", "<vector> not included")
        self.plant("src/common/counter.cpp", "// As a std::vector, or \"std::vector\".")
        self.expect_good("includes")


@unittest.skipUnless(shutil.which("clang-format"), "clang-format is not installed")
class Format(Check):
    def test_every_bad_file_is_named(self):
        run = self.check("format")
        self.assertEqual(run.returncode, 0, run.stderr)
        if "skipped" in run.stderr:
            self.skipTest("another version of clang-format")
        self.plant("src/common/counter.cpp", "int  wide ;")
        self.write("kernels/map/fill.cl", "kernel void  fill() {}\n")
        self.expect_problem("format", "src/common/counter.cpp:3:", "kernels/map/fill.cl:1:", "clang-format -i")


class Headers(Check):
    def test_a_header_that_needs_another_before_it(self):
        self.expect_good("headers")
        self.plant("include/depth_fusion/map/map.h", "Size size();")
        self.expect_problem("headers", "map/map.h: does not compile alone", "tsdf_fusion.h: does not", "Size")

    def test_what_is_green_is_not_compiled_again(self):
        # All but counter.h, which counter.cpp includes first.
        self.assertIn("6 of them compiled now", self.check("headers").stderr)
        self.assertIn("0 of them compiled now", self.check("headers").stderr)
        self.plant("include/depth_fusion/map/map.h", "int blocks();")
        self.assertIn("2 of them compiled now", self.check("headers").stderr)

    def test_without_a_build(self):
        shutil.rmtree(self.root / "build")
        self.expect_problem("headers", "compile_commands.json is missing")


@unittest.skipUnless(shutil.which("clang-tidy"), "clang-tidy is not installed")
class Tidy(Check):
    def test_a_fault(self):
        self.expect_good("tidy")
        self.plant("src/common/counter.cpp", "int half(int* p) { return p == 0 ? sizeof(p) / sizeof(int) : 0; }")
        self.expect_problem("tidy", "src/common/counter.cpp:3", "[")
        self.write("src/common/counter.cpp", GOOD["src/common/counter.cpp"])
        self.assertIn("0 of them looked at now", self.check("tidy").stderr)

    def test_sources_that_are_compiled_together_are_looked_at_one_by_one(self):
        together = self.root / "build/Unity/unity_0_cxx.cxx"
        source = self.root / "src/common/counter.cpp"
        self.write("build/Unity/unity_0_cxx.cxx", f'/* generated */\n\n#include "{source}"\n')
        commands = json.loads((self.root / "build/compile_commands.json").read_text().replace(str(source), str(together)))
        self.write("build/compile_commands.json", json.dumps(commands))
        self.assertIn("1 files, 1 of them looked at now", self.check("tidy").stderr)


if __name__ == "__main__":
    unittest.main()
