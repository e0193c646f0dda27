"""How the build folder says that the sources are compiled, without the precompiled headers."""
import json
import shlex


class NotConfigured(Exception):
    """The build folder has no compile_commands.json."""


def read(build):
    """The entries of compile_commands.json with their arguments as a list."""
    path = build / "compile_commands.json"
    if not path.exists():
        raise NotConfigured(f"{path} is missing; configure the build, or let scripts/test do it")
    entries = json.loads(path.read_text())
    for entry in entries:
        entry["arguments"] = list(_without_precompiled(shlex.split(entry.pop("command"))))
    return entries


def _without_precompiled(arguments):
    rest = iter(arguments)
    for argument in rest:
        if argument == "-include":
            next(rest)
        elif argument != "-Winvalid-pch":
            yield argument


def shared_flags(entries):
    """The include paths and definitions of all the entries together, in their order."""
    flags = {}
    for entry in entries:
        rest = iter(entry["arguments"])
        for argument in rest:
            if argument == "-isystem":
                flags[(argument, next(rest))] = None
            elif argument.startswith(("-I", "-D")) and not argument.endswith("_EXPORTS"):
                flags[(argument,)] = None
    return [part for flag in flags for part in flag]
