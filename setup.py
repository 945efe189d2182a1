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


def has_engine(build: Path, module: str) -> bool:
    """Whether a release of this clone was built in this folder, for the interpreter whose module has this name."""
    cache, rules = build / "CMakeCache.txt", build / "build.ninja"
    if not (cache.exists() and rules.exists() and f"python/lacuna/{module}" in rules.read_text()):
        return False
    values = dict(re.findall(r"^(\w+):\w+=(.*)$", cache.read_text(), re.MULTILINE))
    return (values["CMAKE_HOME_DIRECTORY"] == str(ROOT) and values["CMAKE_BUILD_TYPE"] in ("", "Release")
            and not values.get("LACUNA_SANITIZE"))


class CMakeBuild(build_ext):
    """Builds target lacuna_python, and copies what it has put together."""

    def build_extension(self, extension: Extension) -> None:
        to = Path(self.get_ext_fullpath(extension.name)).resolve()
        build = ROOT / os.environ.get("LACUNA_BUILD", "build")
        if has_engine(build, to.name):
            print(f"the engine in {build} is used", flush=True)
        else:
            without, build = build, Path(self.build_temp).resolve()
            print(f"the engine is built in {build}: minutes; {without} has none for this Python", flush=True)
            build.mkdir(parents=True, exist_ok=True)
            options = ["-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release", "-DLACUNA_TESTS=OFF", f"-DPython3_EXECUTABLE={sys.executable}"]
            subprocess.run(["cmake", "-S", str(ROOT), "-B", str(build), *options], check=True)
        jobs = os.environ.get("CMAKE_BUILD_PARALLEL_LEVEL", str(os.cpu_count() or 1))
        subprocess.run(["cmake", "--build", str(build), "--parallel", jobs, "--target", "lacuna_python"], check=True)
        to.parent.mkdir(parents=True, exist_ok=True)
        package = build / "python" / "lacuna"
        for made in (*package.glob("*.so"), package / "_parameters.py"):
            self.copy_file(str(made), str(to.parent / made.name))


setup(
    version=re.search(r"project\(lacuna VERSION ([0-9.]+)", (ROOT / "CMakeLists.txt").read_text()).group(1),
    ext_modules=[Extension("lacuna._core", [])],
    cmdclass={"build_ext": CMakeBuild},
    package_data={"lacuna": ["py.typed", "*.pyi"]},
)
