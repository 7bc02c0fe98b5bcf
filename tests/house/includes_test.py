#!/usr/bin/python3
"""Checks that a source includes the standard header for each name that it uses, directly or through headers of this
tree: one version of the standard library includes it in another header, the next one does not."""

import functools
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]

# Headers that versions of the library, or of other libraries' headers, may or may not include, with names that need
# them.
NAMES = {
    "algorithm": "all_of any_of binary_search clamp copy_if count_if equal_range fill_n find_if lower_bound max max_element min"
                 " min_element minmax minmax_element none_of nth_element partition remove_if replace reverse rotate sort"
                 " stable_sort transform unique upper_bound ranges::all_of ranges::any_of ranges::copy ranges::count"
                 " ranges::count_if ranges::equal ranges::fill ranges::find ranges::find_if ranges::is_sorted"
                 " ranges::lower_bound ranges::max ranges::max_element ranges::min ranges::min_element ranges::none_of"
                 " ranges::reverse ranges::sort ranges::transform ranges::upper_bound",
    "array": "array",
    "atomic": "atomic",
    "charconv": "from_chars to_chars",
    "chrono": "chrono",
    "cmath": "abs cos exp hypot isfinite isnan log pow sin sqrt",
    "complex": "complex",
    "cstdlib": "getenv strtod strtol",
    "cstring": "memcmp memcpy memset strchr strerror strlen",
    "functional": "function greater invoke less",
    "iterator": "back_inserter make_move_iterator next prev ssize",
    "limits": "numeric_limits",
    "memory": "make_shared make_unique shared_ptr unique_ptr",
    "mutex": "call_once lock_guard mutex once_flag scoped_lock unique_lock",
    "numbers": "numbers",
    "numeric": "accumulate inner_product iota lcm gcd reduce transform_reduce",
    "optional": "make_optional nullopt optional",
    "random": "mt19937 mt19937_64 normal_distribution uniform_int_distribution uniform_real_distribution",
    "sstream": "istringstream ostringstream stringstream",
    "stdexcept": "domain_error invalid_argument logic_error out_of_range runtime_error",
    "thread": "jthread this_thread thread",
    "tuple": "make_tuple tie tuple",
    "variant": "get_if holds_alternative monostate variant visit",
}
USES = {header: re.compile(r"\bstd::(?:%s)\b" % "|".join(names.split())) for header, names in NAMES.items()}


def sources():
    listed = subprocess.run(["git", "-C", ROOT, "ls-files", "*.h", "*.cpp"], capture_output=True, text=True, check=True).stdout
    return [name for name in listed.split() if (ROOT / name).exists()]


@functools.cache
def text_of(name):
    return (ROOT / name).read_text()


@functools.cache
def reached(name):
    """The external headers that a source of this tree includes, directly or through others."""
    own = re.findall(r'^#include "([^"]+)"', text_of(name), re.M)
    through = [reached(header) for header in own if (ROOT / header).exists()]
    return frozenset(re.findall(r"^#include <([^>]+)>", text_of(name), re.M)).union(*through)


def missing(text, headers):
    code = re.sub(r"//.*", "", text)
    return {header: use.group() for header, uses in USES.items() if header not in headers and (use := uses.search(code))}


def main():
    if missing("double x = std::clamp(y, 0.0, 1.0);", {"cmath"}) != {"algorithm": "std::clamp"}:
        sys.exit("the search finds nothing")
    faults = ["%s uses %s without <%s>" % (name, use, header)
              for name in sources() for header, use in missing(text_of(name), reached(name)).items()]
    print("\n".join(faults) or "every source includes what it uses")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
