"""The sources, what they include, and what was found green."""
import dataclasses
import hashlib
import json
import re

FOLDERS = ("include", "src", "kernels", "test")
INCLUDE_FOLDERS = ("include", "src", "kernels", "test")
INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]')


@dataclasses.dataclass
class Result:
    """What is wrong, a line a problem, and what was looked at."""

    problems: list
    note: str

    def summary(self):
        return f"{len(self.problems)} problems; {self.note}" if self.problems else f"good; {self.note}"


@dataclasses.dataclass
class Include:
    line: int
    name: str  # as written
    path: str  # in the tree, or None if it is no file of ours


class Tree:
    def __init__(self, root):
        self.root = root
        self.texts = {}
        for folder in FOLDERS:
            for path in sorted((root / folder).rglob("*")):
                if path.suffix in (".h", ".cpp", ".cl"):
                    self.texts[path.relative_to(root).as_posix()] = path.read_text(encoding="utf-8")
        self.includes = {path: list(self._includes(text)) for path, text in self.texts.items()}
        self._closures = {}

    def files(self, folders=FOLDERS, suffixes=(".h", ".cpp", ".cl")):
        return [path for path in self.texts if path.startswith(tuple(f + "/" for f in folders))
                and path.endswith(suffixes)]

    def _includes(self, text):
        for number, line in enumerate(text.split("\n"), 1):
            found = INCLUDE.match(line)
            if found:
                name = found.group(2)
                paths = [f"{folder}/{name}" for folder in INCLUDE_FOLDERS if f"{folder}/{name}" in self.texts]
                yield Include(number, name, paths[0] if paths and found.group(1) == '"' else None)

    def closure(self, path):
        """The file and all files of ours that it includes, directly or not."""
        if path not in self._closures:
            seen, waiting = {path}, [path]
            while waiting:
                for include in self.includes[waiting.pop()]:
                    if include.path and include.path not in seen:
                        seen.add(include.path)
                        waiting.append(include.path)
            self._closures[path] = seen
        return self._closures[path]

    def digest(self, path, *more):
        """Changes with the file, with what it includes of ours and with `more`."""
        digest = hashlib.sha256("\0".join(more).encode())
        for part in sorted(self.closure(path)):
            digest.update(part.encode() + b"\0" + self.texts[part].encode())
        return digest.hexdigest()


class Green:
    """The digests of what was found good, in a file of the build folder."""

    def __init__(self, path):
        self.path = path
        self.digests = set(json.loads(path.read_text())) if path.exists() else set()

    def __contains__(self, digest):
        return digest in self.digests

    def keep(self, digest):
        self.path.parent.mkdir(parents=True, exist_ok=True)
        self.digests.add(digest)
        self.path.write_text(json.dumps(sorted(self.digests)))
