# SPDX-License-Identifier: Apache-2.0
"""Builds the Python package by CMake. pyproject.toml says all else."""

import os
import re
import subprocess
import sys
from pathlib import Path

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

ROOT = Path(__file__).resolve().parent


class CMakeBuild(build_ext):
    """Builds target lacuna_python, and copies what it has put together."""

    def build_extension(self, extension: Extension) -> None:
        build = Path(self.build_temp).resolve()
        build.mkdir(parents=True, exist_ok=True)
        options = ["-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release", "-DLACUNA_TESTS=OFF", f"-DPython3_EXECUTABLE={sys.executable}"]
        subprocess.run(["cmake", "-S", str(ROOT), "-B", str(build), *options], check=True)
        jobs = os.environ.get("CMAKE_BUILD_PARALLEL_LEVEL", str(os.cpu_count() or 1))
        subprocess.run(["cmake", "--build", str(build), "--parallel", jobs, "--target", "lacuna_python"], check=True)
        to = Path(self.get_ext_fullpath(extension.name)).resolve().parent
        to.mkdir(parents=True, exist_ok=True)
        for library in (build / "python" / "lacuna").glob("*.so"):
            self.copy_file(str(library), str(to / library.name))


setup(
    version=re.search(r"project\(lacuna VERSION ([0-9.]+)", (ROOT / "CMakeLists.txt").read_text()).group(1),
    ext_modules=[Extension("lacuna._core", [])],
    cmdclass={"build_ext": CMakeBuild},
    package_data={"lacuna": ["py.typed", "*.pyi"]},
)
