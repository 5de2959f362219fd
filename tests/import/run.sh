#!/usr/bin/env bash
# Exported files in the programs they are for: ParaView and Blender, by their own Python (Debian: paraview, python3-paraview,
# blender, xvfb). Not a part of ./firn test. Usage: tests/import/run.sh [FIRN]; pictures are left in $PICTURES where that is set.
set -euo pipefail

here=$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")
firn=${1:-$here/../../firn}
export PYTHONPATH="$here${PYTHONPATH:+:$PYTHONPATH}" PYTHONDONTWRITEBYTECODE=1
out=$(mktemp -d)
trap 'rm -rf -- "$out"' EXIT

"$firn" -q run mpm_snow --image 64x36 --disable io.video --frames 4 --out "$out/snow" --export particles --export particles:ply \
  --export particles:npy --export grid:vdb --export grid:vti --export surface:ply --export surface:obj --export bodies:vtp \
  --export bodies:obj
"$firn" -q run heightfield_contour --scene ball_drag --image 64x36 --disable io.video --frames 20 --out "$out/field" --export heightfield:vti \
  --export heightfield:ply --export heightfield:obj --export bodies:vtp --export bodies:obj --export bodies:poses \
  --dump depth="$out/field/depth.npy" --dump ground="$out/field/ground.npy" --dump density="$out/field/density.npy"

# Debian's ParaView draws through X only.
xvfb-run -a -s '-screen 0 1280x800x24' pvpython "$here/read_paraview.py" "$out/snow/export" "$out/field/export" ${PICTURES:+"$PICTURES"}
blender --background --factory-startup --python-exit-code 1 --python "$here/read_blender.py" -- "$out/snow/export" \
  "$out/field/export" ${PICTURES:+"$PICTURES"}
