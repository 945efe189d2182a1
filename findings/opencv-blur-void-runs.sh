#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# OpenCV 4.6: cv2.blur() of heights with a void.
# Guess: a cell of NaN makes the cells of its window NaN, as cv2.GaussianBlur() does.
# Seen: all cells below the void are NaN, to the last row, and from a window of 7 also those at the right.
# The filter keeps running sums, which NaN never leaves. One cell without a height seems to be a large void.
# What helps: cv2.GaussianBlur(), or zeros in the void and a division by the blurred mask of measured cells.
set -euo pipefail
shopt -s nullglob
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

# The package and what it needs, unpacked here; nothing is installed. If it is installed, that one is used.
apt-get install --simulate --no-install-recommends python3-opencv=4.6.0+dfsg-12 |
  sed -nE 's/^Inst ([^ ]+).* \(([^ ]+) .*/\1=\2/p' | xargs -r apt-get download -qq -o APT::Sandbox::User=root
for package in *.deb; do dpkg-deb -x "$package" root; done
lib=$work/root/usr/lib
export LD_LIBRARY_PATH=$lib/x86_64-linux-gnu:$lib/x86_64-linux-gnu/blas:$lib/x86_64-linux-gnu/lapack
export PYTHONPATH=$lib/python3/dist-packages

cat >blur.py <<'END'
import cv2
import numpy as np

# A slope of 60 x 60 cells, with one void in row 20, column 30.
heights = np.add.outer(np.arange(60), 0.1 * np.arange(60)).astype(np.float32)
heights[20, 30] = np.nan
print("OpenCV", cv2.__version__)
measured = np.isfinite(heights).astype(np.float32)
for size in (5, 7):
    window = (size, size)
    for name, result in (("GaussianBlur", cv2.GaussianBlur(heights, window, 0)), ("blur", cv2.blur(heights, window))):
        rows, columns = np.nonzero(np.isnan(result))
        print(f"{name}, window of {size}: {len(rows)} cells void, rows {rows.min()} to {rows.max()}, "
              f"columns {columns.min()} to {columns.max()}")
    with_mask = cv2.blur(np.where(measured > 0, heights, 0), window) / cv2.blur(measured, window)
    print(f"blur by mask, window of {size}: {np.isnan(with_mask).sum()} cells void")
END
/usr/bin/python3 blur.py | tee seen.txt

diff - seen.txt <<'END'
OpenCV 4.6.0
GaussianBlur, window of 5: 25 cells void, rows 18 to 22, columns 28 to 32
blur, window of 5: 210 cells void, rows 18 to 59, columns 28 to 32
blur by mask, window of 5: 0 cells void
GaussianBlur, window of 7: 49 cells void, rows 17 to 23, columns 27 to 33
blur, window of 7: 1419 cells void, rows 17 to 59, columns 27 to 59
blur by mask, window of 7: 0 cells void
END
echo "as before"
