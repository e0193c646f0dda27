"""Reads the JSON files that `scripts/run benchmark` writes."""
import json
import re
import sys

UNITS_S = {"ns": 1e-9, "us": 1e-6, "ms": 1e-3, "s": 1.0}


class ResultsError(Exception):
    """Says in one line which file is wrong, and what to do."""


def fail(message):
    print(f"error: {message}", file=sys.stderr)
    sys.exit(1)


def short_name(name):
    """Without what google-benchmark appends."""
    return re.sub(r"/(real_time|manual_time|iterations:\d+|repeats:\d+)(?=/|$)", "", name)


def read_repetitions(path):
    """The repetitions of each benchmark, by its name: what google-benchmark writes of each, with `seconds` added."""
    try:
        with open(path, encoding="utf-8") as file:
            entries = json.load(file)["benchmarks"]
    except OSError as error:
        raise ResultsError(f"{path} cannot be read: {error.strerror}") from error
    except (ValueError, KeyError, TypeError) as error:
        raise ResultsError(f"{path} is no result of google-benchmark; write one with scripts/run benchmark") from error
    repetitions = {}
    for entry in entries:
        if entry.get("run_type") != "iteration" or entry.get("error_occurred"):
            continue
        entry["seconds"] = entry["real_time"] * UNITS_S[entry["time_unit"]]
        repetitions.setdefault(short_name(entry["run_name"]), []).append(entry)
    if not repetitions:
        raise ResultsError(f"{path} holds no figures; was the benchmark interrupted?")
    return repetitions
