# usage: write_pages.sh UNDERSTUDY SOURCE FOLDER: one small page of each kind that commands write, in FOLDER.
set -e
understudy=$1 source=$2 folder=$3
rm -rf "$folder"
mkdir -p "$folder"
cd "$folder"  # so that no page names where it was made
cat > line.gcode << 'END'
M104 S230
G1 X0 Y0 Z60 F3000
G1 X4 Y0 Z60 E0.3 F600
END
cat > line.yaml << 'END'
name: line
description: A short line in air
source: a test
machine: hexapod
program: line.gcode
as_built: sampled
seed: 1
gap_control: off
engine: quasistatic
expect:
  - {metric: verdict, equals: go, source: a test}
END
printf 'name: lines\nscenarios: [line.yaml]\nseeds: 1-4\n' > lines.yaml
# Answers that are "no" are as good to look at.
run() { "$understudy" "$@" --quiet > /dev/null || [ $? -eq 1 ]; }
run calibrate "$source/scenarios/calibration/hexapod-24-poses.csv" -o calibrated.yaml --report calibration
run benchmark calibration --trials 2 --poses 12 --disturbances none --estimators robust --out benchmark
run benchmark gap --part bottle --machines 1 --out gap
run scenario run line.yaml --out scenarios
run campaign lines.yaml --workers 1 --out campaign
run sweep line.yaml --samples 8 --budget --out budget
