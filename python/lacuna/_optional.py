# SPDX-License-Identifier: Apache-2.0
"""Libraries that only some functions need."""

from __future__ import annotations

import importlib
from types import ModuleType

_DEBIAN = {
    "pandas": "python3-pandas",
    "geopandas": "python3-geopandas",
    "shapely.geometry": "python3-shapely",
    "open3d": "python3-open3d",
    "matplotlib.pyplot": "python3-matplotlib",
}


def require(module: str, user: str) -> ModuleType:
    """Imports a library, or says what to install for it."""
    try:
        return importlib.import_module(module)
    except ImportError as error:
        package = module.split(".")[0]
        debian = f", or the package {_DEBIAN[module]} of Debian" if module in _DEBIAN else ""
        raise ImportError(f"{user} needs {package}: pip install {package}{debian}") from error
