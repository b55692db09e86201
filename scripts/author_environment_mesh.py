#!/usr/bin/env python3
"""Writes the mesh and the sky of scenes/environment-mesh.xml: scripts/author_environment_mesh.py [FOLDER]

environment-mesh.ply  a trefoil knot's tube, 96 x 16 vertices with normals, binary little-endian
environment-mesh.exr  the CIE standard general sky (ISO 15469:2004) of type 12, "CIE standard clear sky", with the sun
                      40 degrees high, in Mitsuba's latitude-longitude format, 128 x 64 pixels of half-floats: the
                      zenith has luminance 1, and the sun, spread evenly over the pixels within 3 degrees of its middle,
                      gives 100/15 of the sky's illuminance

Needs nothing but Python; what it writes is in the repository, so that every machine has the same bits.
"""

import math
import struct
import sys

ALONG, AROUND = 96, 16
TUBE = 0.32

WIDTH, HEIGHT = 128, 64
SUN_ELEVATION, SUN_AZIMUTH = math.radians(40), math.radians(-60)
SUN_RADIUS = math.radians(3)
SKY_TINT, SUN_TINT, GROUND = (0.55, 0.8, 1.35), (1.12, 1.0, 0.8), (0.25, 0.22, 0.18)


def add(a, b, scale=1.0):
    return tuple(x + scale * y for x, y in zip(a, b))


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def unit(a):
    return tuple(x / math.sqrt(dot(a, a)) for x in a)


def knot(t):
    """The trefoil knot about the y axis, and its derivative."""
    r, dr = 1 + 0.45 * math.cos(1.5 * t), -0.675 * math.sin(1.5 * t)
    here = (r * math.cos(t), 0.45 * math.sin(1.5 * t), r * math.sin(t))
    there = (dr * math.cos(t) - r * math.sin(t), 0.675 * math.cos(1.5 * t), dr * math.sin(t) + r * math.cos(t))
    return here, there


def write_mesh(path):
    vertices, triangles = [], []
    for i in range(ALONG):
        t = 4 * math.pi * i / ALONG
        here, there = knot(t)
        forward = unit(there)
        # Across the tube: the way out of the torus that the knot winds about, which goes round once with it.
        outward = add(here, (math.cos(t), 0, math.sin(t)), -1)
        across = unit(add(outward, forward, -dot(outward, forward)))
        aside = cross(forward, across)
        for j in range(AROUND):
            angle = 2 * math.pi * j / AROUND
            normal = add(tuple(math.cos(angle) * x for x in across), aside, math.sin(angle))
            vertices.append(add(here, normal, TUBE) + normal)
            a, b = i * AROUND + j, i * AROUND + (j + 1) % AROUND
            c, d = (a + AROUND) % (ALONG * AROUND), (b + AROUND) % (ALONG * AROUND)
            triangles += [(a, c, d), (a, d, b)]
    header = (
        "ply\nformat binary_little_endian 1.0\ncomment a trefoil knot\n"
        f"element vertex {len(vertices)}\n"
        + "".join(f"property float {name}\n" for name in ("x", "y", "z", "nx", "ny", "nz"))
        + f"element face {len(triangles)}\nproperty list uchar int vertex_indices\nend_header\n"
    )
    with open(path, "wb") as file:
        file.write(header.encode())
        for vertex in vertices:
            file.write(struct.pack("<6f", *vertex))
        for triangle in triangles:
            file.write(struct.pack("<B3i", 3, *triangle))


def clear_sky(cos_zenith, cos_sun, cos_sun_zenith):
    """Luminance over the zenith's: ISO 15469:2004, type 12."""
    a, b, c, d, e = -1.0, -0.32, 10.0, -3.0, 0.45

    def gradation(cosine):
        return 1 + a * math.exp(b / max(cosine, 1e-3))

    def indicatrix(cosine):
        angle = math.acos(max(-1.0, min(1.0, cosine)))
        return 1 + c * (math.exp(d * angle) - math.exp(d * math.pi / 2)) + e * cosine * cosine

    return gradation(cos_zenith) * indicatrix(cos_sun) / (gradation(1) * indicatrix(cos_sun_zenith))


def direction(row, column):
    """Where a pixel stands, y up, as Mitsuba's envmap has it: the first row is the zenith, the last the nadir."""
    theta, phi = math.pi * row / (HEIGHT - 1), 2 * math.pi * (column + 0.5) / WIDTH
    return (math.sin(phi) * math.sin(theta), math.cos(theta), -math.cos(phi) * math.sin(theta))


def sky():
    sun = (
        math.cos(SUN_ELEVATION) * math.sin(SUN_AZIMUTH),
        math.sin(SUN_ELEVATION),
        math.cos(SUN_ELEVATION) * math.cos(SUN_AZIMUTH),
    )
    pixels, illuminance, of_sun = [], 0.0, 0.0
    for row in range(HEIGHT):
        for column in range(WIDTH):
            d = direction(row, column)
            solid_angle = 2 * math.pi**2 / (WIDTH * (HEIGHT - 1)) * math.sin(math.pi * row / (HEIGHT - 1))
            if d[1] <= 0:
                pixels.append((GROUND, False))
                continue
            luminance = clear_sky(d[1], dot(d, sun), sun[1])
            illuminance += luminance * d[1] * solid_angle
            in_sun = dot(d, sun) >= math.cos(SUN_RADIUS)
            if in_sun:
                of_sun += d[1] * solid_angle
            pixels.append((tuple(luminance * tint for tint in SKY_TINT), in_sun))
    sun_luminance = illuminance * 100 / 15 / of_sun
    return [add(rgb, SUN_TINT, sun_luminance if in_sun else 0) for rgb, in_sun in pixels]


def write_exr(path, pixels):
    def attribute(name, kind, value):
        return name.encode() + b"\0" + kind.encode() + b"\0" + struct.pack("<i", len(value)) + value

    half = 1
    channels = b"".join(n + b"\0" + struct.pack("<iBxxxii", half, 0, 1, 1) for n in (b"B", b"G", b"R")) + b"\0"
    window = struct.pack("<4i", 0, 0, WIDTH - 1, HEIGHT - 1)
    header = struct.pack("<ii", 20000630, 2)
    header += attribute("channels", "chlist", channels) + attribute("compression", "compression", b"\0")
    header += attribute("dataWindow", "box2i", window) + attribute("displayWindow", "box2i", window)
    header += attribute("lineOrder", "lineOrder", b"\0") + attribute("pixelAspectRatio", "float", struct.pack("<f", 1))
    header += attribute("screenWindowCenter", "v2f", struct.pack("<2f", 0, 0))
    header += attribute("screenWindowWidth", "float", struct.pack("<f", 1)) + b"\0"
    line_bytes = 6 * WIDTH
    first = len(header) + 8 * HEIGHT
    with open(path, "wb") as file:
        file.write(header)
        for row in range(HEIGHT):
            file.write(struct.pack("<q", first + row * (8 + line_bytes)))
        for row in range(HEIGHT):
            file.write(struct.pack("<ii", row, line_bytes))
            for channel in (2, 1, 0):
                line = [pixels[row * WIDTH + column][channel] for column in range(WIDTH)]
                file.write(struct.pack(f"<{WIDTH}e", *line))


def main():
    folder = sys.argv[1] if len(sys.argv) > 1 else "scenes"
    write_mesh(f"{folder}/environment-mesh.ply")
    write_exr(f"{folder}/environment-mesh.exr", sky())


if __name__ == "__main__":
    main()
