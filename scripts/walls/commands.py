"""How the build folder says that the sources are compiled, without the precompiled headers."""
import json
import pathlib
import re
import shlex
import shutil
import subprocess

# Other versions of clang-format and clang-tidy see some lines otherwise.
CLANG_VERSION = "14"


class NotConfigured(Exception):
    """The build folder has no compile_commands.json."""


def read(build):
    """The entries of compile_commands.json with their arguments as a list."""
    path = build / "compile_commands.json"
    if not path.exists():
        raise NotConfigured(f"{path} is missing; configure the build, or let scripts/test do it")
    entries = [part for entry in json.loads(path.read_text()) for part in _by_source(entry)]
    for entry in entries:
        entry["arguments"] = list(_without_precompiled(shlex.split(entry.pop("command"))))
    return entries


def _by_source(entry):
    """One entry for each of the sources that are compiled together."""
    if "/Unity/unity_" not in entry["file"]:
        return [entry]
    text = pathlib.Path(entry["file"]).read_text()
    return [{**entry, "file": source, "command": entry["command"].replace(entry["file"], source)}
            for source in re.findall(r'^#include "(.+)"$', text, re.M)]


def _without_precompiled(arguments):
    rest = iter(arguments)
    for argument in rest:
        if argument == "-include":
            next(rest)
        elif argument != "-Winvalid-pch" and not argument.startswith("--param="):
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


def version_of(program):
    """The major version of an installed LLVM program, or None."""
    if not shutil.which(program):
        return None
    text = subprocess.run([program, "--version"], capture_output=True, text=True, check=True).stdout
    found = re.search(r"version (\d+)", text)
    return found.group(1) if found else None
