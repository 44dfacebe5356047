#!/usr/bin/python3
# SPDX-License-Identifier: GPL-2.0-only
# SPDX-FileCopyrightText: 2026 the osgGeoFX authors
"""Derives lines.geojson from landcover.tif: the middles of the cells of roads, freeways, railroads and streams.

    lines.py landcover.tif lines.geojson [ground.tif]

With ground.tif, it also writes the land cover without these cells: each gets the class beside it. A terrain of it has its roads and
streams as lines alone, as wide as they are, and not as rows of cells. Then short lines are kept, too.

Needs Debian's python3-gdal and python3-numpy. Thinning is Zhang and Suen's (1984)."""
import json
import math
import sys

import numpy
from osgeo import gdal

# Class of the land cover, style of a line, the least length in cells.
KINDS = [(3, "river", 25), (21, "rail", 20), (19, "secondary", 25), (20, "motorway", 12)]
CANALS = [(4, "canal", 2)]
AROUND = [(-1, 0), (-1, 1), (0, 1), (1, 1), (1, 0), (1, -1), (0, -1), (-1, -1)]


def shifted(cells, row, column):
    padded = numpy.pad(cells, 1)
    return padded[1 + row:1 + row + cells.shape[0], 1 + column:1 + column + cells.shape[1]]


def thin(cells):
    cells = cells.copy()
    changed = True
    while changed:
        changed = False
        for half in (0, 1):
            n = [shifted(cells, *way) for way in AROUND]
            count = sum(each.astype(int) for each in n)
            turns = sum((~n[i] & n[(i + 1) % 8]).astype(int) for i in range(8))
            if half == 0:
                sides = ~(n[0] & n[2] & n[4]) & ~(n[2] & n[4] & n[6])
            else:
                sides = ~(n[0] & n[2] & n[6]) & ~(n[0] & n[4] & n[6])
            gone = cells & (count >= 2) & (count <= 6) & (turns == 1) & sides
            if gone.any():
                cells &= ~gone
                changed = True
    return cells


def trace(cells):
    """Lines between ends and crossings, as lists of cells."""
    left = {tuple(each) for each in numpy.argwhere(cells)}

    def neighbors(cell):
        near = [(cell[0] + r, cell[1] + c) for r, c in AROUND]
        found = [each for each in near if each in left]
        # A diagonal step beside a straight one is no branch.
        straight = [each for each in found if each[0] == cell[0] or each[1] == cell[1]]
        return straight + [each for each in found if each not in straight and
                           not any(abs(each[0] - s[0]) + abs(each[1] - s[1]) == 1 for s in straight)]

    nodes = sorted(cell for cell in left if len(neighbors(cell)) != 2)
    steps, lines = set(), []

    def walk(first, second):
        line = [first, second]
        steps.update({(first, second), (second, first)})
        while len(neighbors(line[-1])) == 2:
            onward = [each for each in neighbors(line[-1]) if each != line[-2]]
            if len(onward) != 1 or (line[-1], onward[0]) in steps:
                break
            steps.update({(line[-1], onward[0]), (onward[0], line[-1])})
            line.append(onward[0])
        lines.append(line)

    for node in nodes:
        for other in neighbors(node):
            if (node, other) not in steps:
                walk(node, other)
    for cell in sorted(left):
        for other in neighbors(cell):
            if len(neighbors(cell)) == 2 and (cell, other) not in steps:
                walk(cell, other)
    return lines


def smooth(points, passes=4):
    points = numpy.array(points, float)
    for _ in range(passes):
        points[1:-1] = 0.25 * points[:-2] + 0.5 * points[1:-1] + 0.25 * points[2:]
    return points


def simplify(points, tolerance):
    if len(points) < 3:
        return points
    way = points[-1] - points[0]
    length = max(numpy.hypot(*way), 1e-9)
    away = numpy.abs(way[0] * (points[:, 1] - points[0, 1]) - way[1] * (points[:, 0] - points[0, 0])) / length
    if numpy.hypot(*way) < 1e-6:
        away = numpy.hypot(*(points - points[0]).T)
    at = int(away.argmax())
    if away[at] <= tolerance:
        return points[[0, -1]]
    return numpy.vstack([simplify(points[:at + 1], tolerance)[:-1], simplify(points[at:], tolerance)])


def closed(cells):
    """With the gaps between lanes, ramps and pieces, up to two cells wide."""
    around = [(0, 0)] + AROUND
    wide = numpy.any([shifted(cells, *way) for way in around], axis=0)
    return numpy.all([shifted(wide, *way) for way in around], axis=0)


def without_stubs(lines, least):
    """Leaves out what is shorter than `least` cells and leads from another line to nowhere: corners of wide crossings."""
    ends = {}
    for line in lines:
        for end in (line[0], line[-1]):
            ends[end] = ends.get(end, 0) + 1
    return [line for line in lines
            if len(line) >= least or min(ends[line[0]], ends[line[-1]]) > 1 or max(ends[line[0]], ends[line[-1]]) < 3]


def ashore(points, sea):
    """A line of water without what is within a cell and a half of the sea, so that its round end is not in it."""
    def near(point):
        r, c = int(round(point[0])), int(round(point[1]))
        return sea[max(r - 1, 0):r + 2, max(c - 1, 0):c + 2].any()

    points = [tuple(each) for each in points]
    for _ in (0, 1):
        while len(points) > 1 and near(points[-1]):
            (r, c), (r0, c0) = points[-1], points[-2]
            length = math.hypot(r - r0, c - c0)
            if length <= 0.5:
                points.pop()
            else:
                points[-1] = (r - 0.5 * (r - r0) / length, c - 0.5 * (c - c0) / length)
        points.reverse()
    return numpy.array(points)


def without_lines(classes):
    """The land cover with the class beside them in the cells of lines, ring by ring from their borders."""
    ground = classes.copy()
    missing = numpy.isin(ground, [kind[0] for kind in KINDS + CANALS])
    while missing.any() and not missing.all():
        former, unknown = ground.copy(), missing.copy()
        for way in AROUND[1::2] + AROUND[0::2]:  # those that share a side come last, and count
            known = unknown & ~shifted(unknown, *way) & (shifted(former, *way) != 0)
            ground[known] = shifted(former, *way)[known]
            missing &= ~known
    return ground


def joined(lines, gap, least):
    """Canals go on below roads: joins ends, in degrees, that are nearer than `gap` cells and look at each other, nearest ones first,
    and leaves out what is still shorter than `least` cells."""
    lines = [list(line) for line in lines]

    def way(a, b):
        return (b[0] - a[0]) * 3600 * 0.93, (b[1] - a[1]) * 3600

    def cosine(v, w):
        return (v[0] * w[0] + v[1] * w[1]) / max(math.hypot(*v) * math.hypot(*w), 1e-9)

    while True:
        best = None
        for i, one in enumerate(lines):
            for j in range(i + 1, len(lines)):
                for first in (one, one[::-1]):
                    for second in (lines[j], lines[j][::-1]):
                        across = way(first[-1], second[0])
                        away = math.hypot(*across)
                        if away > gap or (best and away >= best[0]):
                            continue
                        ahead, onward = way(first[-2], first[-1]), way(second[0], second[1])
                        if cosine(ahead, onward) > 0.3 and (away == 0 or min(cosine(ahead, across),
                                                                             cosine(across, onward)) > 0.3):
                            best = away, i, j, first + second[1 if away == 0 else 0:]
        if not best:
            break
        _, i, j, line = best
        lines = lines[:i] + [line] + lines[i + 1:j] + lines[j + 1:]
    return [line for line in lines
            if sum(math.hypot(*way(a, b)) for a, b in zip(line, line[1:])) >= least]


def main(source, target, ground=None):
    sys.setrecursionlimit(100000)
    data = gdal.Open(source)
    classes = data.ReadAsArray()
    left, wide, _, top, _, high = data.GetGeoTransform()
    features = []
    for value, style, least in KINDS + (CANALS if ground else []):
        cells = classes == value
        # Streams flow below roads, and roads end at crossings with larger ones.
        cells = thin(closed(cells) if ground and style == "motorway" else cells)
        lines = []
        traced = trace(cells)
        for line in without_stubs(traced, 5) if ground and style in ("motorway", "secondary") else traced:
            if len(line) < (2 if ground else least):
                continue
            points = simplify(smooth(line), 0.4)
            if ground and style in ("river", "canal"):
                points = ashore(points, classes == 1)
                if len(points) < 2:
                    continue
            lines.append([[round(left + wide * (c + 0.5), 5), round(top + high * (r + 0.5), 5)] for r, c in points])
        if (value, style, least) in CANALS:
            lines = joined(lines, 4.5, 4)
        # Many short lines take less as one.
        kinds = [("MultiLineString", lines)] if ground else [("LineString", line) for line in lines]
        features += [{"type": "Feature", "properties": {"style": style}, "geometry": {"type": kind, "coordinates": each}}
                     for kind, each in kinds]
    with open(target, "w") as file:
        file.write('{"type": "FeatureCollection", "features": [\n')
        file.write(",\n".join(json.dumps(each, separators=(",", ":")) for each in features))
        file.write("\n]}\n")
    if ground:
        copy = gdal.GetDriverByName("GTiff").CreateCopy(ground, data, options=["COMPRESS=DEFLATE", "TILED=YES"])
        copy.GetRasterBand(1).WriteArray(without_lines(classes))
        copy = None
    print(len(features), "features")


main(*sys.argv[1:])
