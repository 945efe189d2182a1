#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Draws the figures of docs/method.md, as SVG, into this folder. Each shows what the plain method of the tests finds in a
small synthetic scan, so that a figure cannot contradict the program. Needs build/tests/figure_data.
"""

from pathlib import Path

import criteria_figures
import level_figures
import surface_figures

for figures in (criteria_figures, surface_figures, level_figures):
    for name, draw in figures.FIGURES.items():
        draw(Path(__file__).resolve().parent / f"{name}.svg")
