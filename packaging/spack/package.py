# SPDX-License-Identifier: Apache-2.0
"""A package of Spack. Never built; `git` and `url` wait for a public place."""

from spack.package import *


class Lacuna(CMakePackage):
    """Finds holes in scanned surfaces, also in scans larger than memory."""

    license("Apache-2.0")
    version("main", branch="main")

    variant("python", default=True, description="Build the Python package")

    depends_on("cxx", type="build")
    depends_on("cmake@3.25:", type="build")
    for library in ("openvdb", "intel-oneapi-tbb", "eigen@3.4:", "nanoflann", "spdlog", "tomlplusplus", "cli11"):
        depends_on(library)
    for library in ("nlohmann-json", "highway", "xxhash", "pugixml", "libpng", "gdal"):
        depends_on(library)
    with when("+python"):
        extends("python")
        depends_on("py-pybind11", type="build")
        depends_on("py-numpy", type=("build", "run"))

    def cmake_args(self):
        return [self.define_from_variant("LACUNA_PYTHON", "python"), self.define("LACUNA_TESTS", False)]
