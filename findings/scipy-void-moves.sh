#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# SciPy 1.10: maximum_filter, minimum_filter and grey_closing of heights with a void.
# Guess: cells of NaN grow by the window, or are ignored and shrink. Either way, it is the same on all sides.
# Seen: the void moves. After a window of 5 it has its size, two cells farther down and to the right, and after
# grey_closing four. Void cells have heights, measured ones are void, and no mask of the result fits the scan.
# What helps: -inf in place of NaN. By maximum_filter the void shrinks evenly, and after grey_closing it is as before.
set -euo pipefail
shopt -s nullglob
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

# The package and what it needs, unpacked here; nothing is installed. If it is installed, that one is used.
apt-get install --simulate --no-install-recommends python3-scipy=1.10.1-2 |
  sed -nE 's/^Inst ([^ ]+).* \(([^ ]+) .*/\1=\2/p' | xargs -r apt-get download -qq -o APT::Sandbox::User=root
for package in *.deb; do dpkg-deb -x "$package" root; done
lib=$work/root/usr/lib
export LD_LIBRARY_PATH=$lib/x86_64-linux-gnu:$lib/x86_64-linux-gnu/blas:$lib/x86_64-linux-gnu/lapack
export PYTHONPATH=$lib/python3/dist-packages

cat >filter.py <<'END'
import numpy as np
import scipy
from scipy import ndimage

# Random heights, with a void of 10 x 10 cells.
heights = np.random.default_rng(1).normal(size=(60, 60))
heights[20:30, 20:30] = np.nan
filled = np.where(np.isnan(heights), -np.inf, heights)
print("SciPy", scipy.__version__)
for name, result in (("before", heights), ("maximum_filter", ndimage.maximum_filter(heights, 5)),
                     ("minimum_filter", ndimage.minimum_filter(heights, 5)),
                     ("grey_closing", ndimage.grey_closing(heights, 5)),
                     ("maximum_filter with -inf", ndimage.maximum_filter(filled, 5)),
                     ("grey_closing with -inf", ndimage.grey_closing(filled, 5))):
    rows, columns = np.nonzero(~np.isfinite(result))
    print(f"{name}: {len(rows)} cells void, rows {rows.min()} to {rows.max()}, "
          f"columns {columns.min()} to {columns.max()}; "
          f"{np.isfinite(result[20:30, 20:30]).sum()} cells of the void have heights")
END
/usr/bin/python3 filter.py | tee seen.txt

diff - seen.txt <<'END'
SciPy 1.10.1
before: 100 cells void, rows 20 to 29, columns 20 to 29; 0 cells of the void have heights
maximum_filter: 100 cells void, rows 22 to 31, columns 22 to 31; 36 cells of the void have heights
minimum_filter: 100 cells void, rows 22 to 31, columns 22 to 31; 36 cells of the void have heights
grey_closing: 100 cells void, rows 24 to 33, columns 24 to 33; 64 cells of the void have heights
maximum_filter with -inf: 36 cells void, rows 22 to 27, columns 22 to 27; 64 cells of the void have heights
grey_closing with -inf: 100 cells void, rows 20 to 29, columns 20 to 29; 0 cells of the void have heights
END
echo "as before"
