"""Three parts of about 20 to 40 mm, as lists of triangles [mm]: a cube, a bracket with a hole, and a boat with a flared hull, a
cabin whose windows and roof are bridged, and a chimney."""
import math
import struct


def loft(sections):
    """A closed body between convex outlines of equally many corners, counterclockwise, each with its height, from below upwards."""
    triangles = []
    corners = len(sections[0][0])
    for (below, z_below), (above, z_above) in zip(sections, sections[1:]):
        for i in range(corners):
            j = (i + 1) % corners
            p, q, r, s = (*below[i], z_below), (*below[j], z_below), (*above[j], z_above), (*above[i], z_above)
            triangles += [(p, q, r), (p, r, s)]
    (low, z_low), (high, z_high) = sections[0], sections[-1]
    for i in range(1, corners - 1):
        triangles.append(((*low[0], z_low), (*low[i + 1], z_low), (*low[i], z_low)))
        triangles.append(((*high[0], z_high), (*high[i], z_high), (*high[i + 1], z_high)))
    return triangles


def box(x0, y0, z0, x1, y1, z1):
    outline = [(x0, y0), (x1, y0), (x1, y1), (x0, y1)]
    return loft([(outline, z0), (outline, z1)])


def plate_with_hole(outer, inner, z0, z1):
    """Outlines of equally many corners."""
    triangles = []
    for i in range(len(outer)):
        j = (i + 1) % len(outer)
        for outline, turned in ((outer, False), (inner, True)):
            p, q, r, s = (*outline[i], z0), (*outline[j], z0), (*outline[j], z1), (*outline[i], z1)
            triangles += [(p, r, q), (p, s, r)] if turned else [(p, q, r), (p, r, s)]
        for z, turned in ((z1, False), (z0, True)):
            p, q, r, s = (*outer[i], z), (*outer[j], z), (*inner[j], z), (*inner[i], z)
            triangles += [(p, r, q), (p, s, r)] if turned else [(p, q, r), (p, r, s)]
    return triangles


def directions(corners):
    return [(math.cos(angle), math.sin(angle)) for angle in (2 * math.pi * (i + 0.5) / corners for i in range(corners))]


def circle(x, y, radius, corners=48):
    return [(x + radius * c, y + radius * s) for c, s in directions(corners)]


def square(half, corners=48):
    return [(half * c / max(abs(c), abs(s)), half * s / max(abs(c), abs(s))) for c, s in directions(corners)]


def hull(length, width, corners=24):
    """A round bow and a flat stern."""
    bow = [math.pi * (i / corners - 0.5) for i in range(corners + 1)]
    return [(length / 2 * math.cos(angle), width / 2 * math.sin(angle)) for angle in bow] + [(-length / 2, width / 2), (-length / 2, -width / 2)]


def boat():
    posts = [box(x, y, 8, x + 4, y + 2, 18) for x in (-12, -2) for y in (-6, 4)]
    walls = [box(-12, -6, 8, -10, 6, 18), box(0, -6, 8, 2, 6, 18)]
    roof, chimney = box(-12, -6, 17.9, 2, 6, 20), plate_with_hole(circle(-5, 0, 2.5), circle(-5, 0, 1.2), 19.9, 26)
    return loft([(hull(30, 10), 0), (hull(34, 14), 4), (hull(38, 18), 8)]) + sum(posts + walls, []) + roof + chimney


PARTS = {
    "cube": box(-10, -10, 0, 10, 10, 20),
    "bracket": plate_with_hole(square(12), circle(0, 0, 3), 0, 4) + box(-12, 8, 0, 12, 12, 20),
    "boat": boat(),
}


def stl(triangles):
    """Binary; normals are found by the order of corners."""
    data = b" " * 80 + struct.pack("<I", len(triangles))
    for triangle in triangles:
        data += struct.pack("<3f", 0, 0, 0) + b"".join(struct.pack("<3f", *corner) for corner in triangle) + b"\0\0"
    return data
