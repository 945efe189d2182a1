#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# terra 1.7 (R): a raster in local coordinates without a reference system.
# Guess: cells are squares in the unit of the scan, and so are areas and distances.
# Seen: a raster within 360 of 0 in x and 90 in y is taken for degrees. A void of 4 x 4 m has 194,000 square
# kilometres, and is up to 220 km from the surface. The same raster 100 m farther north is right.
# What helps: crs = "local", or any other plane one. The page of rast() names this rule.
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

cat >void.R <<'END'
suppressMessages(library(terra))
terraOptions(progress = 0)
cat("terra ", as.character(packageVersion("terra")), "\n", sep = "")
look <- function(name, ...) {
  heights <- rast(ncols = 20, nrows = 20, vals = 1, ...)
  heights[9:12, 9:12] <- NA
  void <- as.polygons(ifel(is.na(heights), 1, NA))
  cat(name, ": degrees ", is.lonlat(heights), ", area of the void ", sprintf("%.3g", expanse(void)),
      ", largest distance to the surface ", sprintf("%.3g", max(values(distance(heights)))), "\n", sep = "")
}
look("20 x 20 m at 0 0", xmin = 0, xmax = 20, ymin = 0, ymax = 20)
look("20 x 20 m at 0 100", xmin = 0, xmax = 20, ymin = 100, ymax = 120)
look("20 x 20 m at 0 0, crs local", xmin = 0, xmax = 20, ymin = 0, ymax = 20, crs = "local")
END
"$R_HOME/bin/exec/R" --vanilla --no-echo -f void.R | tee seen.txt

diff - seen.txt <<'END'
terra 1.7.3
20 x 20 m at 0 0: degrees TRUE, area of the void 1.94e+11, largest distance to the surface 2.2e+05
20 x 20 m at 0 100: degrees NA, area of the void 16, largest distance to the surface 2
20 x 20 m at 0 0, crs local: degrees FALSE, area of the void 16, largest distance to the surface 2
END
echo "as before"
