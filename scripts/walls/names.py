"""Every file includes what it uses of the standard library and of others, though precompiled headers would hide it."""
import re

# What a use looks like, and the headers of which one must be included, directly or by a header of ours.
USES = [
    (r"std::string\b", ("string",)),
    (r"std::vector\b", ("vector",)),
    (r"std::array\b", ("array",)),
    (r"std::map\b", ("map",)),
    (r"std::set\b", ("set",)),
    (r"std::deque\b", ("deque",)),
    (r"std::unordered_map\b", ("unordered_map",)),
    (r"std::unordered_set\b", ("unordered_set",)),
    (r"std::tuple\b", ("tuple",)),
    (r"std::variant\b", ("variant",)),
    (r"std::(optional|nullopt)\b", ("optional",)),
    (r"std::function\b", ("functional",)),
    (r"std::(unique_ptr|shared_ptr|weak_ptr|make_unique|make_shared)\b", ("memory",)),
    (r"std::(mutex|lock_guard|unique_lock|scoped_lock)\b", ("mutex",)),
    (r"std::condition_variable\b", ("condition_variable",)),
    (r"std::thread\b", ("thread",)),
    (r"std::atomic\b", ("atomic",)),
    (r"std::(future|async|promise)\b", ("future",)),
    (r"std::chrono\b", ("chrono",)),
    (r"std::filesystem\b", ("filesystem",)),
    (r"std::[io]?stringstream\b", ("sstream",)),
    (r"std::[io]?fstream\b", ("fstream",)),
    (r"std::(cout|cerr)\b", ("iostream",)),
    (r"std::regex\w*\b", ("regex",)),
    (r"std::numeric_limits\b", ("limits",)),
    (r"std::(sort|min|max|clamp|min_element|max_element|find_if|any_of|all_of|nth_element|copy|fill)\b", ("algorithm",)),
    (r"std::(accumulate|iota)\b", ("numeric",)),
    (r"std::(sqrt|exp|log|log2|pow|sin|cos|tan|atan2|acos|asin|floor|ceil|round|lround|hypot|isfinite|isnan)\b", ("cmath",)),
    (r"\b(std::)?u?int(8|16|32|64)_t\b", ("cstdint",)),
    (r"\bEigen::", ("Eigen/",)),
    (r"\bcv::", ("opencv2/",)),
    (r"\bcl::", ("CL/",)),
    (r"\bYAML::", ("yaml-cpp/",)),
]
USES = [(re.compile(pattern), headers) for pattern, headers in USES]
COMMENT_OR_TEXT = re.compile(r'//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"', re.S)


def code_of(text):
    """The text without its comments, texts and include lines, with the same lines."""
    text = re.sub(r"^[ \t]*#[ \t]*include[^\n]*", "", text, flags=re.M)
    return COMMENT_OR_TEXT.sub(lambda found: "\n" * found.group().count("\n"), text)


def missing_includes(tree, paths):
    for path in paths:
        included = {include.name for part in tree.closure(path) for include in tree.includes[part] if not include.path}
        code = code_of(tree.texts[path])
        for use, headers in USES:
            found = use.search(code)
            if found and not any(name == header or (header.endswith("/") and name.startswith(header))
                                 for header in headers for name in included):
                line = code.count("\n", 0, found.start()) + 1
                wanted = headers[0] + ("..." if headers[0].endswith("/") else "")
                yield f"{path}:{line}: {found.group()} is used, and <{wanted}> not included; include it"
