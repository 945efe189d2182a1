#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# terra 1.7 (R): fillHoles() of a surface with an island in its hole.
# Guess: the result is all that the outline encloses, and the island is a part of it.
# Seen: the island stays as a second part on top of the filled hole. It counts twice in the area, and the polygon
# is not valid any more.
# What helps: aggregate() afterwards makes one part of both.
set -euo pipefail
shopt -s nullglob
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

# The package and what it needs, unpacked here; nothing is installed. If it is installed, that one is used.
apt-get install --simulate --no-install-recommends r-cran-terra=1.7-3-1 r-base-core=4.2.2.20221110-2 |
  sed -nE 's/^Inst ([^ ]+).* \(([^ ]+) .*/\1=\2/p' | xargs -r apt-get download -qq -o APT::Sandbox::User=root
for package in *.deb; do dpkg-deb -x "$package" root; done
lib=$work/root/usr/lib
if [[ -d $lib/R/bin ]]; then
  export R_HOME=$lib/R R_SHARE_DIR=$work/root/usr/share/R/share
  ln -sf Renviron.ucf "$R_HOME/etc/Renviron"  # as its installation does
else
  export R_HOME=/usr/lib/R R_SHARE_DIR=/usr/share/R/share
fi
export R_LIBS=$lib/R/site-library:$R_HOME/library:/usr/lib/R/site-library
export LD_LIBRARY_PATH=$R_HOME/lib:$lib/x86_64-linux-gnu:$lib/x86_64-linux-gnu/blas:$lib/x86_64-linux-gnu/lapack
[[ ! -d root/usr/share/proj ]] || export PROJ_DATA=$work/root/usr/share/proj
[[ ! -d root/usr/share/gdal ]] || export GDAL_DATA=$work/root/usr/share/gdal

cat >fill.R <<'END'
suppressMessages(library(terra))
cat("terra ", as.character(packageVersion("terra")), "\n", sep = "")
surface <- vect("MULTIPOLYGON (((0 100, 20 100, 20 120, 0 120, 0 100), (5 105, 15 105, 15 115, 5 115, 5 105)),
                 ((8 108, 12 108, 12 112, 8 112, 8 108)))", crs = "local")
describe <- function(name, v) {
  parts <- unique(geom(v)[, c("geom", "part")])
  cat(name, ": area ", expanse(v, transform = FALSE), ", parts ", nrow(parts), ", valid ", is.valid(v), "\n", sep = "")
}
describe("outline of 20 x 20, hole of 10 x 10, island of 4 x 4", surface)
describe("filled", fillHoles(surface))
describe("filled and aggregated", aggregate(fillHoles(surface)))
END
"$R_HOME/bin/exec/R" --vanilla --no-echo -f fill.R | tee seen.txt

diff - seen.txt <<'END'
terra 1.7.3
outline of 20 x 20, hole of 10 x 10, island of 4 x 4: area 316, parts 2, valid TRUE
filled: area 416, parts 2, valid FALSE
filled and aggregated: area 400, parts 1, valid TRUE
END
echo "as before"
