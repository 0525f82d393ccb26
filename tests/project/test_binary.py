"""The installed extension: its instructions and symbols."""

import platform
import re
import shutil
import subprocess

import pytest
from oracles.margins import told
from rolling_ellipse import _core

# Functions whose results depend on the version of the C library, and one that older systems lack
# (GCC below 11, macOS below 13.3).
UNWANTED = ("hypot", "hypotf", "cbrt", "lgamma", "tgamma", "_ZSt8to_charsPcS_d")


def disassembled(*options: str) -> str:
    objdump = shutil.which("objdump")
    if objdump is None:
        pytest.skip("there is no objdump on this machine")
    done = subprocess.run(
        [objdump, *options, str(_core.__file__)], capture_output=True, text=True, timeout=300
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_only_exact_products_in_vector_lanes_are_fused() -> None:
    """two_product in src/numerics/lanes.hpp computes x y - round(x y) with packed instructions.

    A compiler that fuses products and sums on its own would also emit vfmadd and scalar
    instructions. std::fma is compiled to a function call.
    """
    if platform.machine() != "x86_64":
        pytest.skip(f"the instructions are those of x86-64, not of {platform.machine()}")
    flags = _core.build()["flags"]
    if re.search(r"-march=|-mfma", flags):
        pytest.skip(f"it was compiled for processors that have std::fma: {flags}")
    fused = re.findall(r"\bvfn?m(?:add|sub)\w+", disassembled("-d", "--no-show-raw-insn"))
    told(len(fused), sorted(set(fused)))
    assert all(re.fullmatch(r"vfmsub(?:132|213|231)pd", each) for each in fused), set(fused)
    assert fused or "sse2" not in _core.flow_levels()  # a broken search would find none


def test_the_extension_calls_no_function_that_differs_between_systems() -> None:
    symbols = re.findall(r"\*UND\*.*?(\w+)$", disassembled("-T"), re.MULTILINE)
    assert {"sin", "atan2", "PyErr_SetString"} <= set(symbols)  # a broken search would find none
    assert not set(symbols) & set(UNWANTED)
