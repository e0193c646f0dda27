"""Every source is formatted as .clang-format says."""
import re
import subprocess

from walls import commands
from walls.tree import Result

CHUNK = 60


def check(tree, _):
    version = commands.version_of("clang-format")
    if version != commands.CLANG_VERSION:
        installed = f"version {version}" if version else "none"
        return Result([], f"skipped, for the sources are formatted by clang-format {commands.CLANG_VERSION}, and installed is {installed}")
    paths = tree.files()
    problems = []
    for i in range(0, len(paths), CHUNK):
        command = ["clang-format", "--dry-run", "--ferror-limit=1", *paths[i:i + CHUNK]]
        output = subprocess.run(command, cwd=tree.root, capture_output=True, text=True, check=False).stderr
        first = {}
        for path, line in re.findall(r"^(\S+?):(\d+):\d+: \w+: code should be clang-formatted", output, re.M):
            first.setdefault(path, line)
        problems += [f"{path}:{line}: is not formatted; run clang-format -i {path}" for path, line in first.items()]
    return Result(problems, f"{len(paths)} files")
