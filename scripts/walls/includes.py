"""The core includes no ROS, data headers include no workers, folders keep their order, files include what they use."""
from walls import layers
from walls.names import missing_includes
from walls.tree import Result


def core_problem(path, include):
    if not layers.is_core(path) or include.path:
        return None
    if not layers.CORE_LIBRARIES.match(include.name):
        return (f"the core includes {include.name}, which is neither its own nor in CORE_LIBRARIES "
                "(scripts/walls/layers.py); move what needs ROS to src/ros")
    if path.startswith("include/") and layers.PRIVATE_LIBRARIES.match(include.name):
        return f"a public header includes {include.name}; keep it in src/"
    return None


def robot_problem(path, include):
    if path.startswith("src/ros/") and layers.WORKSHOP_LIBRARIES.match(include.name):
        return (f"what a robot loads includes {include.name}, which only the workshop has; move what needs it to "
                "src/tools or src/apps")
    return None


def data_problem(path, include):
    if not layers.is_data(path) or not include.path or layers.is_data(include.path):
        return None
    if layers.folder_of(include.path) in layers.DATA_FLOORS:
        return None
    return f"a data header includes the worker {include.name}; include a data header, or move the function to the worker"


def floor_problem(path, include):
    folder, other = layers.folder_of(path), layers.folder_of(include.path)
    if folder == other:
        return None
    if folder.startswith("ros/") and other.startswith("tools/"):
        return f"{folder} includes {include.name} of the workshop, which no robot loads"
    floor, other_floor = layers.floor_of(folder), layers.floor_of(other)
    if floor is None or other_floor is None:
        return f"the folder {folder if floor is None else other} has no floor; give it one in scripts/walls/layers.py"
    if other_floor < floor:
        return None
    if other_floor > floor:
        return f"{folder} includes {include.name} of {other}, a floor above; see FLOORS in scripts/walls/layers.py"
    if layers.is_data(include.path) or (path, include.name) in layers.EXCEPTIONS:
        return None
    return (f"{folder} includes the worker {include.name} of its neighbour {other}; take the data from frames/ or "
            "X_parameters.h, and let pipeline/ bring them together")


def circles(tree):
    """Circles among the folders, which data headers of neighbours could make."""
    visits = {}
    for path in tree.files(("include", "src")):
        for include in tree.includes[path]:
            if include.path and layers.folder_of(include.path) != layers.folder_of(path):
                visits.setdefault(layers.folder_of(path), {})[layers.folder_of(include.path)] = f"{path}:{include.line}"
    done = set()

    def visit(folder, way):
        if folder in way:
            circle = way[way.index(folder):] + [folder]
            where = ", ".join(visits[a][b] for a, b in zip(circle, circle[1:]))
            yield f"{where}: folders include one another in a circle: {' -> '.join(circle)}"
        elif folder not in done:
            for other in visits.get(folder, {}):
                yield from visit(other, way + [folder])
            done.add(folder)

    for folder in sorted(visits):
        yield from visit(folder, [])


def check(tree, _):
    problems = []
    paths = tree.files(("include", "src"))
    for path in paths:
        for include in tree.includes[path]:
            for find in (core_problem, robot_problem, data_problem, floor_problem if include.path else None):
                problem = find and find(path, include)
                if problem:
                    problems.append(f"{path}:{include.line}: {problem}")
    problems += circles(tree)
    problems += missing_includes(tree, paths)
    stale = [f"scripts/walls/layers.py: the exception for {path} is used no more; take it out"
             for path, name in layers.EXCEPTIONS
             if path in tree.texts and name not in [include.name for include in tree.includes[path]]]
    return Result(problems + stale, f"{len(paths)} files")
