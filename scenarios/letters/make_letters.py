# U, S and C, 9 mm high, side by side on the slanted top of models/parts/slanted_box.stl: curves x_mm,y_mm,z_mm.
# usage: make_letters.py FOLDER
import math, sys
from pathlib import Path

HEIGHT, WIDTH, PITCH = 9.0, 5.0, 8.0
R = WIDTH / 2


def arc(cx, cy, rx, ry, begin, end, n=24):
    return [(cx + rx * math.cos(math.radians(begin + (end - begin) * i / n)),
             cy + ry * math.sin(math.radians(begin + (end - begin) * i / n))) for i in range(n + 1)]


LETTERS = {  # from the lower left corner
    "u": [(0, HEIGHT)] + arc(R, R, R, R, 180, 360) + [(WIDTH, HEIGHT)],
    "s": arc(R, 0.75 * HEIGHT, R, HEIGHT / 4, 30, 270) + arc(R, 0.25 * HEIGHT, R, HEIGHT / 4, 90, -150)[1:],
    "c": arc(R, HEIGHT / 2, R, HEIGHT / 2, 50, 310)}

for number, (name, points) in enumerate(LETTERS.items()):
    rows = ["x_mm,y_mm,z_mm"]
    for across, up in points:
        # Written along y, the letters' upper side uphill, towards -x.
        x, y = HEIGHT / 2 - up, (number - 1) * PITCH + across - WIDTH / 2
        rows.append(f"{x:.4f},{y:.4f},{18 - x * math.tan(math.radians(15)):.4f}")
    (Path(sys.argv[1]) / f"{name}.csv").write_text("\n".join(rows) + "\n")
