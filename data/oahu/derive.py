#!/usr/bin/python3
"""Derive elevation and land cover of Oahu from FlightGear's base scenery.

The base scenery of FlightGear 2020.3 holds the Hawaiian islands as "BTG"
files: gzipped triangle meshes in geocentric (WGS 84) coordinates with the
name of a material for each group of triangles.  This script reads those of
Oahu and writes two rasters on one grid of 1 arc-second:

  elevation.tif   metres, Float32, interpolated inside the triangles
  landcover.tif   one byte, the classes of landcover.csv

To obtain the scenery on Debian 12 without installing 1.8 GB:

  apt-get download flightgear-data-base
  dpkg --fsys-tarfile flightgear-data-base_*.deb \\
      | tar x --wildcards '*/Scenery/Terrain/w160n20/*'
  ./derive.py usr/share/games/flightgear/Scenery/Terrain

It needs Debian's packages python3-gdal and python3-numpy.  The same scenery
yields the same bytes in every run with the same version of GDAL.

The script is under the MIT license, as the rest of osgGeoFX is; what it
derives is under the scenery's license, GPL-2+ (see README.md and COPYING).
"""

import argparse
import csv
import gzip
import math
import os
import struct
import sys
import zlib
from pathlib import Path

import numpy as np
from osgeo import gdal, osr

gdal.UseExceptions()
osr.UseExceptions()

# The grid: whole arc-seconds, so that the tiles of the scenery (1/8 degree)
# begin and end on borders of cells.
WEST, NORTH = -158.4, 21.85
CELLS_PER_DEGREE = 3600
COLUMNS, ROWS = 3240, 2700
NODATA = -32768.0
HEIGHT_STEP = 1 / 8  # metres; finer digits would be noise that packs badly

# Land cover is sampled SUBCELLS x SUBCELLS times in every cell: roads and
# streams are narrower than a cell, and samples at the centers alone would
# leave dotted lines.  Odd, so that the cell's center is one of the samples.
SUBCELLS = 5

SEA = 'sea'
LAKE = 'lake'
# A line wins its cell when it covers so many of the 25 samples; fewer suffice
# for what is drawn narrower.
LINES = {'freeway': 5, 'road': 5, 'railroad': 2, 'canal': 5, 'river': 4}

MATERIALS = {
    'Airport': 'airfield_grass',
    'Asphalt': 'paved',
    'Canal': 'canal',
    'Cemetery': 'cemetery',
    'Dirt': 'bare_ground',
    'Freeway': 'freeway',
    'GolfCourse': 'golf_course',
    'Grass': 'airfield_grass',
    'Grassland': 'grassland',
    'Gravel': 'bare_ground',
    'Industrial': 'industrial',
    'Lake': LAKE,
    'Lava': 'lava',
    'Marsh': 'marsh',
    'MixedCrop': 'crops',
    'MixedForest': 'mixed_forest',
    'Ocean': SEA,
    'Railroad': 'railroad',
    'Road': 'road',
    'Sand': 'sand',
    'Scrub': 'scrub',
    'Stream': 'river',
    'Town': 'town',
    'Urban': 'urban',
}
# Airports name each piece of pavement after its texture: "pa_" asphalt and
# "pc_" concrete, then the marking ("rest", "threshold", "2l" ...).
PAVEMENT = ('pa_', 'pc_')
BESIDE_RUNWAYS = ('tiedown', 'heli', 'shoulder', 'shoulder_f')
# Painted lines lie upon the pavement, which is complete without them.
MARKINGS = 'lf_'

# The scenery drapes the tunnels of the freeway H-3 over their own, low
# heights and so cuts a trench of up to 320 m into the Ko'olau ridge.  The
# ridge is restored across this line: (lon, lat), (lon, lat), half width in
# cells, class above.
TUNNELS = (((-157.8490, 21.4048), (-157.8345, 21.4038), 4.5, 'scrub'),)

SPHERE, VERTICES = 0, 1
TRIANGLES, STRIP, FAN = 10, 11, 12
MATERIAL, INDEX_TYPES, VERTEX_ATTRIBUTES = 0, 1, 2


class SceneryError(Exception):
    """Scenery that is absent, damaged or unknown to this script."""


class Reader:
    """A cursor over the bytes of a BTG file that never reads past them."""

    def __init__(self, data, path):
        self.data, self.path, self.offset = data, path, 0

    def take(self, size):
        """The next size bytes."""
        end = self.offset + size
        if end > len(self.data):
            raise SceneryError(f'{self.path} ends in the middle of an object;'
                               ' extract the package again.')
        piece = self.data[self.offset:end]
        self.offset = end
        return piece

    def unpack(self, layout):
        """The next values in a little-endian layout of the struct module."""
        layout = '<' + layout
        return struct.unpack(layout, self.take(struct.calcsize(layout)))

    def chunk(self):
        """The next block of bytes, which its length precedes."""
        return self.take(self.unpack('I')[0])


def triangles_of(kind, strip):
    """Vertex numbers of an element, three for each triangle."""
    if kind == TRIANGLES:
        return strip.reshape(-1, 3)
    if kind == FAN:
        first = np.full(len(strip) - 2, strip[0])
        return np.stack([first, strip[1:-1], strip[2:]], 1)
    return np.stack([strip[:-2], strip[1:-1], strip[2:]], 1)


def read_btg(path):
    """Read a BTG file.

    Returns the vertices (n x 3: geocentric, metres) and a dictionary that
    gives for each material its triangles (m x 3: numbers of vertices).
    """
    try:
        with gzip.open(path) as file:
            reader = Reader(file.read(), path)
    except FileNotFoundError as error:
        raise SceneryError(f'{path}, which the scenery lists, is not there;'
                           ' extract the whole folder.') from error
    except (OSError, EOFError, zlib.error) as error:
        raise SceneryError(f'{path} cannot be unpacked ({error}); extract'
                           ' the package again.') from error

    version, magic, _ = reader.unpack('HHI')
    if magic != 0x5347:
        raise SceneryError(f'{path} does not begin like a BTG file.')
    if not 6 <= version <= 10:
        raise SceneryError(f'{path} is of BTG version {version}; this script'
                           ' reads 6 to 10.')
    # Version 10 widened the counts and the indices from 16 to 32 bits.
    count = 'I' if version >= 10 else 'H'
    index_type = np.dtype('<u4' if version >= 10 else '<u2')

    center, points, elements = None, [], []
    for _ in range(reader.unpack(count)[0]):
        kind, properties, pieces = reader.unpack('B' + 2 * count)
        material, indices, attributes = '', 0x09, 0
        for _ in range(properties):
            what = reader.unpack('B')[0]
            value = reader.chunk()
            if what == MATERIAL:
                material = value.split(b'\0')[0].decode('latin-1')
            elif what == INDEX_TYPES and len(value) == 1:
                indices = value[0]
            elif what == VERTEX_ATTRIBUTES and len(value) == 4:
                attributes = struct.unpack('<I', value)[0]
        stride = bin(indices).count('1') + bin(attributes).count('1')
        for _ in range(pieces):
            value = reader.chunk()
            if kind == SPHERE:
                if len(value) != 28:
                    raise SceneryError(f'{path} has a bounding sphere of'
                                       f' {len(value)} bytes, not of 28.')
                center = np.array(struct.unpack('<3d', value[:24]))
            elif kind == VERTICES:
                if len(value) % 12:
                    raise SceneryError(f'{path} has a broken vertex.')
                points.append(np.frombuffer(value, '<f4').reshape(-1, 3))
            elif kind in (TRIANGLES, STRIP, FAN):
                # The number of the vertex is the first of each tuple; those
                # of normals and texture coordinates follow it.
                if not indices & 1 or len(value) % (stride
                                                    * index_type.itemsize):
                    raise SceneryError(f'{path} has a broken list of'
                                       f' "{material}" triangles.')
                strip = np.frombuffer(value, index_type)[::stride]
                if len(strip) < 3 or kind == TRIANGLES and len(strip) % 3:
                    raise SceneryError(f'{path} has half a "{material}"'
                                       ' triangle.')
                elements.append((material, kind, strip.astype(np.int64)))

    if center is None or not points:
        raise SceneryError(f'{path} has no vertices.')
    points = np.concatenate(points).astype(np.float64) + center
    if not np.isfinite(points).all():
        raise SceneryError(f'{path} has a vertex that is not a number.')
    groups = {}
    for material, kind, strip in elements:
        if strip.max() >= len(points):
            raise SceneryError(f'{path} has a "{material}" triangle with a'
                               ' vertex that is not there.')
        groups.setdefault(material, []).append(triangles_of(kind, strip))
    return points, {name: np.concatenate(parts)
                    for name, parts in groups.items()}


def geodetic_from_geocentric():
    """The transformation to longitude and latitude (degrees) and height."""
    systems = []
    for code in (4978, 4979):
        system = osr.SpatialReference()
        system.ImportFromEPSG(code)
        system.SetAxisMappingStrategy(osr.OAMS_TRADITIONAL_GIS_ORDER)
        systems.append(system)
    return osr.CoordinateTransformation(*systems)


def folder_name(lon, lat):
    """The scenery's folder for a degree, such as w160n20/w158n21."""
    def name(x, y):
        return (f'{"w" if x < 0 else "e"}{abs(x):03d}'
                f'{"s" if y < 0 else "n"}{abs(y):02d}')
    return os.path.join(name(lon // 10 * 10, lat // 10 * 10), name(lon, lat))


def list_btgs(terrain):
    """The BTG files of the grid's degrees: those of tiles, of airports.

    The folders also hold files that no .stg file mentions any more, so the
    .stg files decide.
    """
    tiles, airports = [], []
    east = WEST + COLUMNS / CELLS_PER_DEGREE
    south = NORTH - ROWS / CELLS_PER_DEGREE
    for lat in range(math.floor(south), math.ceil(NORTH)):
        for lon in range(math.floor(WEST), math.ceil(east)):
            folder = Path(terrain) / folder_name(lon, lat)
            if not folder.is_dir():
                raise SceneryError(
                    f'{folder} is not there; give the folder'
                    ' Scenery/Terrain of the package flightgear-data-base'
                    ' (--help says how to get it).')
            for stg in sorted(folder.glob('*.stg')):
                for line in stg.read_text('latin-1').splitlines():
                    words = line.split()
                    if len(words) < 2 or not words[1].endswith('.btg'):
                        continue
                    btg = folder / (words[1] + '.gz')
                    if words[0] == 'OBJECT_BASE':
                        tiles.append(btg)
                    elif words[0] == 'OBJECT':
                        airports.append(btg)
    if not tiles:
        raise SceneryError(f'{terrain} lists no tile of Oahu.')
    return tiles, airports


def class_of(material, path):
    """The land cover class of a material, or None for painted lines."""
    if material.startswith(MARKINGS):
        return None
    if material.startswith(PAVEMENT):
        rest = material.split('_', 1)[1]
        return 'apron' if rest in BESIDE_RUNWAYS else 'runway'
    if material not in MATERIALS:
        raise SceneryError(f'{path} has the material "{material}", for which'
                           ' this script knows no class; add it to'
                           ' MATERIALS.')
    return MATERIALS[material]


def samples_inside(corners, columns, rows):
    """The samples of a grid that lie inside triangles.

    corners (n x 3 x 3) holds column, row, height of three corners, where
    samples stand at whole columns and rows.  Returns row, column and height
    of each sample.  A sample on an edge goes to one side alone: both
    triangles compute where the edge meets the row from the same numbers,
    and one takes what is left of it, the other what is not.
    """
    order = np.argsort(corners[:, :, 1], axis=1, kind='stable')
    corners = np.take_along_axis(corners, order[:, :, None], axis=1)
    first = np.clip(np.ceil(corners[:, 0, 1]), 0, rows).astype(np.int64)
    last = np.clip(np.ceil(corners[:, 2, 1]), 0, rows).astype(np.int64)
    triangle, row = expand(first, last)
    corners = corners[triangle]

    def crossing(upper, lower):
        """Column and height at which an edge meets the row."""
        fall = lower[:, 1] - upper[:, 1]
        part = (row - upper[:, 1]) / np.where(fall > 0, fall, 1)
        part = np.clip(part, 0, 1)[:, None]
        return (upper + part * (lower - upper))[:, ::2]

    top, middle, bottom = corners[:, 0], corners[:, 1], corners[:, 2]
    one = crossing(top, bottom)
    above = (row < np.ceil(middle[:, 1]))[:, None]
    two = np.where(above, crossing(top, middle), crossing(middle, bottom))
    swap = (one[:, 0] > two[:, 0])[:, None]
    left, right = np.where(swap, two, one), np.where(swap, one, two)

    first = np.clip(np.ceil(left[:, 0]), 0, columns).astype(np.int64)
    last = np.clip(np.ceil(right[:, 0]), 0, columns).astype(np.int64)
    span, column = expand(first, last)
    left, right, row = left[span], right[span], row[span]
    width = right[:, 0] - left[:, 0]
    part = (column - left[:, 0]) / np.where(width > 0, width, 1)
    height = left[:, 1] + part * (right[:, 1] - left[:, 1])
    return row, column, height


def expand(first, last):
    """For ranges first..last-1: the range and the value of every member."""
    length = np.maximum(last - first, 0)
    which = np.repeat(np.arange(len(length)), length)
    start = np.repeat(np.cumsum(length) - length, length)
    return which, first[which] + np.arange(len(which)) - start


def grid_positions(places, cells_per_degree):
    """Column, row and height; samples stand in the middle of cells."""
    return np.stack([(places[:, 0] - WEST) * cells_per_degree - 0.5,
                     (NORTH - places[:, 1]) * cells_per_degree - 0.5,
                     places[:, 2]], 1)


def draw(places, groups, values, path, elevation, samples):
    """Draw the triangles of a BTG file into both rasters."""
    for material in sorted(groups):
        name = class_of(material, path)
        if name is None:
            continue
        triangles = groups[material]
        corners = grid_positions(places, CELLS_PER_DEGREE)[triangles]
        row, column, height = samples_inside(corners, COLUMNS, ROWS)
        elevation[row, column] = height
        fine = grid_positions(places, CELLS_PER_DEGREE * SUBCELLS)
        # In pieces, which bounds the memory.
        for piece in range(0, len(triangles), 20000):
            corners = fine[triangles[piece:piece + 20000]]
            row, column, _ = samples_inside(corners, COLUMNS * SUBCELLS,
                                            ROWS * SUBCELLS)
            samples[row, column] = values[name]


def read_scenery(terrain, values):
    """Draw all of the scenery: heights of cells, classes of samples."""
    tiles, airports = list_btgs(terrain)
    transform = geodetic_from_geocentric()
    # The scenery has no tiles of open sea.
    elevation = np.zeros((ROWS, COLUMNS))
    samples = np.full((ROWS * SUBCELLS, COLUMNS * SUBCELLS), values[SEA],
                      np.uint8)
    # Airports fill holes in the tiles, so they come second.
    for path in tiles + airports:
        points, groups = read_btg(path)
        places = np.array(transform.TransformPoints(points))[:, :3]
        if np.abs(places[:, 2]).max() > 9000:
            raise SceneryError(f'{path} has a vertex more than 9 km above or'
                               ' below the sea.')
        box = grid_positions(places, CELLS_PER_DEGREE)[:, :2] + 0.5
        lower, upper = box.min(0), box.max(0)
        if (upper <= 0).any() or (lower >= (COLUMNS, ROWS)).any():
            continue
        if path in tiles:
            # Inside a tile whatever no triangle fills is a hole.
            lower = np.clip(np.rint(lower), 0, (COLUMNS, ROWS)).astype(int)
            upper = np.clip(np.rint(upper), 0, (COLUMNS, ROWS)).astype(int)
            elevation[lower[1]:upper[1], lower[0]:upper[0]] = np.nan
            lower, upper = lower * SUBCELLS, upper * SUBCELLS
            samples[lower[1]:upper[1], lower[0]:upper[0]] = 0
        draw(places, groups, values, path, elevation, samples)
        print(f'{path.name}: {sum(map(len, groups.values()))} triangles')
    holes = np.isnan(elevation)
    if holes.any():
        row, column = np.argwhere(holes)[0]
        raise SceneryError(
            f'the scenery leaves {holes.sum()} cells without a triangle, the'
            f' first at {NORTH - row / CELLS_PER_DEGREE:.4f} N'
            f' {-WEST - column / CELLS_PER_DEGREE:.4f} W.')
    return elevation, samples


def close_tunnels(elevation, samples, values):
    """Restore the ground above tunnels; return the corrected heights."""
    rows, columns = np.mgrid[0:ROWS, 0:COLUMNS]
    tunnels = np.zeros(elevation.shape, bool)
    for start, end, reach, above in TUNNELS:
        ends = np.array([start + (0,), end + (0,)])
        (x0, y0, _), (x1, y1, _) = grid_positions(ends, CELLS_PER_DEGREE)
        length = math.hypot(x1 - x0, y1 - y0)
        x, y = (x1 - x0) / length, (y1 - y0) / length
        along = (columns - x0) * x + (rows - y0) * y
        across = (columns - x0) * y - (rows - y0) * x
        inside = (along >= 0) & (along <= length) & (abs(across) <= reach)
        fine = inside.repeat(SUBCELLS, 0).repeat(SUBCELLS, 1)
        samples[fine & (samples == values['freeway'])] = values[above]
        tunnels |= inside

    memory = gdal.GetDriverByName('MEM')
    heights = memory.Create('', COLUMNS, ROWS, 1, gdal.GDT_Float64)
    heights.GetRasterBand(1).WriteArray(elevation)
    known = memory.Create('', COLUMNS, ROWS, 1, gdal.GDT_Byte)
    known.GetRasterBand(1).WriteArray((~tunnels).astype(np.uint8))
    gdal.FillNodata(heights.GetRasterBand(1), known.GetRasterBand(1),
                    20, 2)
    return np.where(tunnels, heights.ReadAsArray(), elevation)


def choose_classes(samples, values):
    """One class for each cell out of its samples."""
    blocks = samples.reshape(ROWS, SUBCELLS, COLUMNS, SUBCELLS)
    landcover = blocks[:, SUBCELLS // 2, :, SUBCELLS // 2].copy()
    mixed = np.argwhere(blocks.max((1, 3)) != blocks.min((1, 3)))
    inside = blocks[mixed[:, 0], :, mixed[:, 1], :]
    inside = inside.reshape(len(mixed), -1)
    count = np.zeros((len(mixed), max(values.values()) + 1), np.int16)
    for value in values.values():
        count[:, value] = (inside == value).sum(1)

    sea = values[SEA]
    lines = [values[name] for name in LINES]
    # The line that stands out most (at a tie, the first).
    weight = count[:, lines] / np.array(list(LINES.values()))
    line = np.array(lines)[weight.argmax(1)]
    # Otherwise sea or land, whichever is more, and then of land what covers
    # most, so that many kinds of land in a cell do not let the sea win.
    land = count.copy()
    land[:, [0, sea] + lines] = 0
    # A cell may hold no land but a piece of a line.
    area = np.where(land.max(1) > 0, land.argmax(1), line)
    wet = 2 * count[:, sea] > count.sum(1)
    chosen = np.where(wet, sea, area)
    chosen = np.where(weight.max(1) >= 1, line, chosen)
    landcover[mixed[:, 0], mixed[:, 1]] = chosen
    return landcover


def level_lakes(elevation, lake):
    """Give each lake (cells that touch) the median of its heights."""
    rows, columns = np.nonzero(lake)
    names = np.zeros((ROWS + 2, COLUMNS + 2), np.int64)
    here = rows + 1, columns + 1
    nameless = len(rows) + 1
    names[here] = np.arange(1, nameless)
    # Every cell takes the least name around it until none changes.
    while True:
        around = np.stack([names[rows + i, columns + j]
                           for i in range(3) for j in range(3)])
        least = np.where(around > 0, around, nameless).min(0)
        if (least == names[here]).all():
            break
        names[here] = least
    heights = elevation[lake]
    for name in np.unique(least):
        heights[least == name] = np.median(heights[least == name])
    elevation[lake] = heights


def read_classes(path):
    """Values and colors of the classes, as landcover.csv has them."""
    values, colors = {}, {}
    with open(path, newline='', encoding='utf-8') as file:
        for row in csv.DictReader(file):
            value = int(row['value'])
            values[row['class']] = value
            colors[value] = tuple(int(row[c])
                                  for c in ('red', 'green', 'blue'))
    return values, colors


def write_raster(path, cells, kind, nodata, predictor, description,
                 colors=None):
    """Write a GeoTIFF under another name, then move it to its own."""
    system = osr.SpatialReference()
    system.ImportFromEPSG(4326)
    temporary = path.with_name(path.name + '.part')
    raster = gdal.GetDriverByName('GTiff').Create(
        str(temporary), COLUMNS, ROWS, 1, kind,
        ['TILED=YES', 'BLOCKXSIZE=256', 'BLOCKYSIZE=256', 'COMPRESS=DEFLATE',
         'ZLEVEL=9', f'PREDICTOR={predictor}'])
    raster.SetProjection(system.ExportToWkt())
    raster.SetGeoTransform((WEST, 1 / CELLS_PER_DEGREE, 0,
                            NORTH, 0, -1 / CELLS_PER_DEGREE))
    raster.SetMetadata({
        'TIFFTAG_IMAGEDESCRIPTION': description,
        'TIFFTAG_COPYRIGHT': 'FlightGear project; GNU GPL, version 2 or'
                             ' later'})
    band = raster.GetRasterBand(1)
    band.SetNoDataValue(nodata)
    if colors:
        table = gdal.ColorTable()
        for value, color in sorted(colors.items()):
            table.SetColorEntry(value, color + (255,))
        band.SetColorTable(table)
    else:
        band.SetUnitType('m')
    band.WriteArray(cells)
    del band, raster
    os.replace(temporary, path)
    print(f'{path}: {path.stat().st_size} bytes')


def main():
    """Read the command line and derive both rasters."""
    here = Path(__file__).resolve().parent
    parser = argparse.ArgumentParser(
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('terrain', help='the folder Scenery/Terrain of the'
                                        ' package flightgear-data-base')
    parser.add_argument('--output', type=Path, default=here,
                        help='where the rasters go (default: beside this'
                             ' script)')
    arguments = parser.parse_args()

    values, colors = read_classes(here / 'landcover.csv')
    try:
        elevation, samples = read_scenery(arguments.terrain, values)
    except SceneryError as error:
        sys.exit(f'derive.py: {error}')
    elevation = close_tunnels(elevation, samples, values)
    landcover = choose_classes(samples, values)
    # The few heights below the sea are noise beside quays and beaches.
    elevation = np.maximum(elevation, 0)
    level_lakes(elevation, landcover == values[LAKE])
    elevation[landcover == values[SEA]] = 0
    # Adding 0 makes positive zeros of negative ones.
    elevation = np.round(elevation / HEIGHT_STEP) * HEIGHT_STEP + 0.0

    arguments.output.mkdir(parents=True, exist_ok=True)
    write_raster(arguments.output / 'elevation.tif',
                 elevation.astype(np.float32), gdal.GDT_Float32, NODATA, 3,
                 'Oahu: metres above the sea, from the base scenery of'
                 ' FlightGear')
    write_raster(arguments.output / 'landcover.tif', landcover,
                 gdal.GDT_Byte, 0, 2,
                 'Oahu: land cover, from the base scenery of FlightGear;'
                 ' classes in landcover.csv', colors)


if __name__ == '__main__':
    main()
