"""A wheel's tag follows from what readelf says of its library: no compiler is needed."""
import pathlib
import platform
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[3] / ".packaging"))
import python_backend


def told(machine, *versions):
    head = f"ELF Header:\n  Class:                             ELF64\n  Machine: {machine}\n"
    return head + "".join(f"  0x0010:   Name: {v}  Flags: none  Version: 9\n" for v in versions)


def test_the_newest_version_counts_as_a_number():
    text = told("AArch64", "GLIBC_2.17", "GLIBC_2.28", "GLIBC_2.4", "GLIBCXX_3.4.30")
    assert python_backend.tag(text) == "py3-none-manylinux_2_28_aarch64"
    text = told("Advanced Micro Devices X86-64", "GLIBC_2.2.5", "GLIBC_2.9", "GLIBC_2.17")
    assert python_backend.tag(text) == "py3-none-manylinux_2_17_x86_64"


def test_a_processor_without_a_cross_compiler_is_this_one():
    text = told("RISC-V", "GLIBC_2.27")
    assert python_backend.tag(text) == f"py3-none-manylinux_2_27_{platform.machine()}"


for name, test in list(globals().items()):
    if name.startswith("test_"):
        test()
        print("ok   ", name)
