#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Draws the figures of docs/method.md, as SVG, into this folder. Each shows what the plain method of the tests finds in a
small synthetic scan, so that a figure cannot contradict the program. Needs build/tests/figure_data.

    docs/figures/make.py                # all
    docs/figures/make.py star wedges    # these
"""

import sys
from pathlib import Path

import criteria_figures
import level_figures
import surface_figures

FIGURES = criteria_figures.FIGURES | surface_figures.FIGURES | level_figures.FIGURES


def main():
    names = sys.argv[1:] or list(FIGURES)
    for name in names:
        if name not in FIGURES:
            raise SystemExit(f"make.py: no figure {name!r}; there are {', '.join(FIGURES)}")
        FIGURES[name](Path(__file__).resolve().parent / f"{name}.svg")


if __name__ == "__main__":
    main()
