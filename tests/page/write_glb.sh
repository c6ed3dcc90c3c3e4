# usage: write_glb.sh UNDERSTUDY SCENARIOS FOLDER: rehearsals in FOLDER, each with a .glb beside it. A no-go is as good to look at as a go.
set -e
understudy=$1 scenarios=$2 folder=$3
rm -rf "$folder"
mkdir -p "$folder"
rehearse() {
  name=$1
  shift
  "$understudy" rehearse "$@" --as-built nominal --gap-control off --engine quasistatic --out "$folder/$name" > /dev/null || [ $? -eq 1 ]
  "$understudy" export glb "$folder/$name" -o "$folder/$name.glb" --slices 40
}
rehearse hexapod "$scenarios/song-bottle.gcode" --fixture bottle
rehearse five-axis "$scenarios/five-axis-tilted.gcode" --machine five-axis --fixture bottle
rehearse arm "$scenarios/arm-square.gcode" --machine arm
