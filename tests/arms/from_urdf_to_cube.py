#!/usr/bin/env python3
"""From a URDF to a rehearsed cube, by the commands that a newcomer types. Prints them; status 1 where one fails, or
where they are more than six.

usage: from_urdf_to_cube.py UNDERSTUDY FILE.urdf [FOLDER]
"""
import os
import subprocess
import sys
import tempfile
from pathlib import Path

COMMANDS = """\
understudy new-machine {urdf} -o my-arm
understudy pose --machine ./my-arm X0 Y0 Z20
understudy plan planar cube.stl --machine ./my-arm --layer 0.2 -o cube.gcode
understudy rehearse cube.gcode --machine ./my-arm --engine quasistatic --no-pictures --out out
"""

FACES = [((0, 1, 2, 3), -1), ((4, 5, 6, 7), 1), ((0, 1, 5, 4), 1), ((2, 3, 7, 6), 1), ((1, 2, 6, 5), 1), ((3, 0, 4, 7), 1)]


def cube_stl(side):
    """10 mm and so on about x = y = 0, on the table."""
    h = side / 2
    corners = [(-h, -h, 0), (h, -h, 0), (h, h, 0), (-h, h, 0), (-h, -h, side), (h, -h, side), (h, h, side), (-h, h, side)]
    text = "solid cube\n"
    for loop, way in FACES:
        for triangle in ((0, 1, 2), (0, 2, 3)):
            text += "facet normal 0 0 0\nouter loop\n"
            for k in triangle[::way]:
                text += "vertex {} {} {}\n".format(*corners[loop[k]])
            text += "endloop\nendfacet\n"
    return text + "endsolid cube\n"


def main():
    program, urdf = (Path(word).resolve() for word in sys.argv[1:3])
    commands = COMMANDS.format(urdf=urdf).splitlines()
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(sys.argv[3]) if len(sys.argv) > 3 else Path(temporary)
        (folder / "cube.stl").write_text(cube_stl(5))
        environment = {**os.environ, "PATH": f"{program.parent}:{os.environ['PATH']}"}
        for command in commands:
            done = subprocess.run(command, shell=True, cwd=folder, env=environment, capture_output=True, text=True, check=False)
            print(f"$ {command}\n{done.stdout}{done.stderr}", end="")
            if done.returncode != 0:
                print(f"status {done.returncode}")
                return 1
    print(f"{len(commands)} commands")
    return 0 if len(commands) <= 6 else 1


if __name__ == "__main__":
    sys.exit(main())
