# To and fro over 12 x 8 mm in the middle of the slanted top of models/parts/slanted_box.stl: a curve x_mm,y_mm,z_mm.
# usage: make_rows.py > rows.csv
import math

LENGTH, WIDTH, PITCH = 12.0, 8.0, 0.42
SLANT = math.radians(15)
count = round((WIDTH - PITCH) / PITCH) + 1
print("x_mm,y_mm,z_mm")
for row in range(count):
    y = (row - (count - 1) / 2) * PITCH
    along = LENGTH / 2 if row % 2 == 0 else -LENGTH / 2
    for s in (-along, along):
        print(f"{s * math.cos(SLANT):.4f},{y:.4f},{18 - s * math.sin(SLANT):.4f}")
