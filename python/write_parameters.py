# SPDX-License-Identifier: Apache-2.0
"""Writes _parameters.py of the package: the parameters of each function and their types, for editors. The build calls it.

    write_parameters.py PACKAGE
"""

import sys
from pathlib import Path

package = Path(sys.argv[1])
sys.path.insert(0, str(package))
import _core  # noqa: E402

HEAD = """# SPDX-License-Identifier: Apache-2.0
# Made by python/write_parameters.py.
from __future__ import annotations

import os
from collections.abc import Sequence
from typing import TypedDict, Union

Text = Union[str, float, "os.PathLike[str]", Sequence[str]]
"""
FILES = """
# `find_holes` has an argument of this name, which are the normals themselves.
class FileParameters(RunParameters, total=False):
    normals: Text
"""


def typed(name, command, own):
    """A TypedDict of the parameters of a command, without those that its function has as arguments of its own."""
    types = {"t": "bool", "f": "bool", "[": "Sequence[float]", '"': "Text"}
    lines = ["", f'{name} = TypedDict("{name}", {{']
    for parameter in _core.parameters(command):
        default = parameter["default"]
        if parameter["key"] not in own:
            lines.append(f'    "{parameter["key"]}": {types.get(default[0], "float" if "." in default else "int")},')
    return "\n".join([*lines, "}, total=False)", ""])


(package / "_parameters.py").write_text(
    HEAD + typed("RunParameters", "run", {"points", "normals"}) + FILES + typed("CheckParameters", "check", {"area"})
    + typed("InfoParameters", "info", {}), encoding="utf-8")
