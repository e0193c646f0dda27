"""Every header compiles alone. The build shows it of those that a source includes first, as its own; the rest are
compiled here. Other libraries' headers come precompiled, which makes it quick; that a header includes what it uses of them,
the wall `includes` checks by name."""
import collections
import concurrent.futures
import os
import subprocess

from walls import commands
from walls.tree import Green, Result

# Precompiled is what so many of ours include; the others' headers are read where they are included.
MANY = 20
# The package's own messages, which a build makes, and what reads macros of the header that includes it.
LEFT_OUT = ("depth_fusion/", "CL/")
COMPILER = ["c++", "-std=c++17", "-Wall", "-Wextra"]


def external_headers(tree, paths):
    """What many headers include of others."""
    users = collections.Counter(name for path in paths for name in {
        include.name for part in tree.closure(path) for include in tree.includes[part]
        if not include.path and not include.name.startswith(LEFT_OUT)})
    names = [name for name, count in users.items() if count >= MANY]
    return "".join(f"#if __has_include(<{name}>)\n#include <{name}>\n#endif\n" for name in sorted(names))


def precompile(text, flags, folder):
    folder.mkdir(parents=True, exist_ok=True)
    header, key = folder / "external.h", folder / "external.key"
    wanted = text + " ".join(flags)
    if not (folder / "external.h.gch").exists() or not key.exists() or key.read_text() != wanted:
        header.write_text(text)
        subprocess.run([*COMPILER, *flags, "-x", "c++-header", header, "-o", folder / "external.h.gch"], check=True)
        key.write_text(wanted)
    return header


def problem_of(tree, path, flags, precompiled):
    name = path.split("/", 1)[1]
    command = [*COMPILER, *flags, "-include", precompiled, "-fsyntax-only", "-x", "c++", "-"]
    run = subprocess.run(command, input=f'#include "{name}"\n', cwd=tree.root, capture_output=True, text=True, check=False)
    if run.returncode == 0:
        return None
    first = next((line for line in run.stderr.split("\n") if "error:" in line), run.stderr.strip())
    return f"{path}: does not compile alone; include what it uses: {first}"


def own_headers(tree):
    """The headers that some source includes before all else."""
    firsts = (tree.includes[path][:1] for path in tree.files(("src", "test"), (".cpp",)))
    return {include.path for first in firsts for include in first if include.path}


def check(tree, arguments):
    try:
        entries = commands.read(arguments.build)
    except commands.NotConfigured as error:
        return Result([str(error)], "nothing was looked at")
    built = own_headers(tree)
    paths = [path for path in tree.files(("include", "src", "test"), (".h",)) if path not in built]
    flags = commands.shared_flags(entries)
    external = external_headers(tree, paths)
    digests = {path: tree.digest(path, external, *flags) for path in paths}
    green = Green(arguments.build / "check" / "headers.json")
    waiting = [path for path in paths if digests[path] not in green]
    problems = []
    if waiting:
        precompiled = precompile(external, flags, arguments.build / "check")
        with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
            found = pool.map(lambda path: problem_of(tree, path, flags, precompiled), waiting)
            for path, problem in zip(waiting, found):
                if problem:
                    problems.append(problem)
                else:
                    green.keep(digests[path])
    return Result(problems, f"{len(paths)} headers, {len(waiting)} of them compiled now")
