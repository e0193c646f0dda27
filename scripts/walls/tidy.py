"""clang-tidy finds nothing in ROOMS. It is slow: a run looks at files that were never found clean, or changed since, as long as
it may, and remembers those that are clean."""
import concurrent.futures
import json
import os
import re
import subprocess
import time

from walls import commands, layers
from walls.tree import Green, Result

# Where all is clean; the others follow one by one (clang-tidy takes some ten seconds a file).
ROOMS = ("common", "geometry", "compute", "frames", "map", "registration", "preprocessing", "texture_odometry", "tsdf_fusion",
         "color_fusion", "model_view", "icp_tracking", "relocalisation", "surface_mesh", "recording", "acquisition",
         "store", "submaps", "pipeline")
PROBLEM = re.compile(r"^(\S+?:\d+):\d+: (?:warning|error): (.*)$", re.M)


def write_commands(entries, folder):
    """For clang, which cannot read the compiler's precompiled headers."""
    folder.mkdir(parents=True, exist_ok=True)
    # What is a warning, .clang-tidy says; clang's -Wconversion is another than the compiler's.
    for entry in entries:
        entry["arguments"] = [argument for argument in entry["arguments"] if not argument.startswith("-W")]
    (folder / "compile_commands.json").write_text(json.dumps(entries))


def tidy(tree, path, folder):
    command = ["clang-tidy", "--quiet", "-p", folder, tree.root / path]
    run = subprocess.run(command, cwd=tree.root, capture_output=True, text=True, check=False)
    found = PROBLEM.findall(run.stdout)
    if not found and run.returncode != 0:
        found = [(path, (run.stdout + run.stderr).strip())]
    return [f"{where.replace(f'{tree.root}/', '')}: {what}" for where, what in found]


def check(tree, arguments):
    version = commands.version_of("clang-tidy")
    if version != commands.CLANG_VERSION:
        return Result([], f"skipped, for {commands.CLANG_VERSION} is the version that it goes by, and installed is "
                          f"{version or 'none'}")
    try:
        entries = commands.read(arguments.build)
    except commands.NotConfigured as error:
        return Result([str(error)], "nothing was looked at")
    folder = arguments.build / "check"
    write_commands(entries, folder)
    compiled = {entry["file"] for entry in entries}
    paths = [path for path in tree.files(("src",), (".cpp",))
             if str(tree.root / path) in compiled and layers.folder_of(path) in ROOMS]
    rules = (tree.root / ".clang-tidy").read_text()
    digests = {path: tree.digest(path, rules) for path in paths}
    green = Green(folder / "tidy.json")
    # Those of the last hour first; in a fresh clone, where all are of one hour, in the order of their paths.
    waiting = sorted((path for path in paths if digests[path] not in green),
                     key=lambda path: (-((tree.root / path).stat().st_mtime // 3600), path))
    end = time.monotonic() + arguments.tidy_seconds

    def look(path):
        return tidy(tree, path, folder) if time.monotonic() < end else None

    problems, looked = {}, 0
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        for path, found in zip(waiting, pool.map(look, waiting)):
            looked += found is not None
            problems.update(dict.fromkeys(found or []))
            if found == []:
                green.keep(digests[path])
    return Result(list(problems), f"{len(paths)} files, {looked} of them looked at now, {len(waiting) - looked} left for later")
