#!/bin/sh
# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#
# Compares the kit's terrain with osgEarth's:
#   apps/bench/osgearth.sh DIR [options of osggeofx_bench]
# DIR is where osgEarth 3 is installed (its library in DIR/lib). Mount Fuji is measured with --fuji FILE, an elevation raster
# of it; otherwise Oahu alone. BUILD is the kit's build folder, build/release if it is not set.
set -eu
root=$(cd "$(dirname "$0")/../.." && pwd)
if [ $# -eq 0 ]; then
    echo "osgearth.sh: name the folder where osgEarth is installed." >&2
    exit 2
fi
osgearth=$1
shift
only="--only oahu"
for argument in "$@"; do
    case $argument in --fuji | --only) only= ;; esac
done
# shellcheck disable=SC2086 # two words, or none
exec "${BUILD:-$root/build/release}/bin/osggeofx_bench" --suite osgearth --osgearth "$osgearth" $only "$@"
