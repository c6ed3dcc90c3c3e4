#!/bin/sh
# The bottle's line on built machines, each off in all that its tolerances name (--as-built manufactured), after the
# calibrations that a lab would make of it and, last, with the part found first (+registration). One line a machine: verdict
# and gap of each gap control.
#   bench/print/built_machines.sh UNDERSTUDY [FIRST-SEED [LAST-SEED]]
set -eu
understudy=$(realpath "$1")
first=${2:-1} last=${3:-20}
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
"$understudy" plan surface bottle --tilt -20 20 -o line.gcode >plan.txt
for seed in $(seq "$first" "$last"); do
  built="--as-built manufactured --seed $seed"
  "$understudy" sample-poses --count 24 $built -o poses.csv >poses.txt
  "$understudy" calibrate poses.csv -o calibrated.yaml >calibrate.txt
  "$understudy" sample-gaps $built -o gaps >gaps.txt
  "$understudy" calibrate gap-sensor gaps/table.csv --machine calibrated.yaml -o ready.yaml >sensor.txt
  for machine in hexapod calibrated.yaml ready.yaml ready.yaml+registration; do
    case $machine in *+registration) register=--register ;; *) register= ;; esac
    for control in off start continuous; do
      "$understudy" rehearse line.gcode --machine "${machine%+registration}" $register --fixture bottle $built --engine quasistatic --no-pictures \
        --gap-control $control --out out >rehearse.txt || [ $? -eq 1 ]
      printf '%s %s %s: ' "$seed" "$(echo "$machine" | sed 's/\.yaml//')" "$control"
      sed -n '1p; s/^  gap at the start/gap at the start/p; s/^  error *gap/gap/p; s/^    surface found/surface found/p' rehearse.txt | cut -c1-150 | paste -sd' ' -
      rm -rf out
    done
  done
  rm -rf gaps
done
