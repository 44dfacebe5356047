// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Longitude, latitude and height of the picture's pixels, from data/places.js (osgGeoFX/web/detail/PlaceGrid.h tells its form).
'use strict';

geofx.places = (() => {
  const alphabet = 'ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_';
  const digits = new Uint8Array(128);
  for (let i = 0; i < 64; ++i) digits[alphabet.charCodeAt(i)] = i;
  const dot = '.'.charCodeAt(0);
  let grid = null;

  function decode(data) {
    const {columns, rows, samples: text} = data;
    const count = columns * rows;
    const values = [new Int32Array(count), new Int32Array(count), new Int32Array(count)];
    const ground = new Uint8Array(count);
    let at = 0;
    const number = () => {
      let value = 0, factor = 1, digit = 0;
      do {
        digit = digits[text.charCodeAt(at++)];
        value += (digit & 31) * factor;
        factor *= 32;
      } while (digit & 32);
      return value;
    };
    const last = [0, 0, 0];
    for (let i = 0; i < count;) {
      if (text.charCodeAt(at) === dot) {
        ++at;
        i += number();
        continue;
      }
      const column = i % columns;
      const left = column > 0 && ground[i - 1];
      const upper = i >= columns && ground[i - columns];
      const corner = column > 0 && i >= columns && ground[i - columns - 1];
      for (let k = 0; k < 3; ++k) {
        const value = values[k];
        const coded = number();
        const difference = coded % 2 ? -(coded - 1) / 2 - 1 : coded / 2;
        const expected = left && upper && corner ? value[i - 1] + value[i - columns] - value[i - columns - 1]
                       : left ? value[i - 1] : upper ? value[i - columns] : last[k];
        last[k] = value[i] = expected + difference;
      }
      ground[i++] = 1;
    }
    return {...data, longitudes: values[0], latitudes: values[1], heights: values[2], ground};
  }

  const isEven = (column, row) => {
    const bit = row * (grid.columns - 1) + column;
    return (digits[grid.squares.charCodeAt(Math.floor(bit / 6))] >> bit % 6) & 1;
  };

  /** The place of a pixel of the picture: 'sky', or longitude and latitude in degrees and height in metres. Null: nothing is known of it. */
  function at(x, y) {
    const {width, height} = geofx.data.picture;
    if (!geofx.data.places || !geofx.data.places.columns || !(x >= 0 && y >= 0 && x <= width && y <= height)) return null;
    if (!grid) grid = decode(geofx.data.places);
    const within = (value, count) => Math.min(Math.max(value, 0), count - 1);
    const u = within((x * grid.width / width - 0.5 - grid.first) / grid.step, grid.columns);
    const v = within((y * grid.height / height - 0.5 - grid.first) / grid.step, grid.rows);
    const column = Math.min(Math.floor(u), grid.columns - 2), row = Math.min(Math.floor(v), grid.rows - 2);
    const place = (longitude, latitude, up) => {
      const east = longitude * grid.unit;
      return {longitude: east - 360 * Math.round(east / 360), latitude: latitude * grid.unit, height: up};
    };
    if (column < 0 || row < 0 || !isEven(column, row)) {
      // Across the edge of a ridge, or a shore of the sky: the nearest sample.
      const i = Math.round(v) * grid.columns + Math.round(u);
      return grid.ground[i] ? place(grid.longitudes[i], grid.latitudes[i], grid.heights[i]) : 'sky';
    }
    const i = row * grid.columns + column;
    const s = u - column, t = v - row;
    const full = 360 / grid.unit;
    const mean = (value, turn) => {
      const from = value[i];
      const [right, lower, corner] = [i + 1, i + grid.columns, i + grid.columns + 1].map((k) => {
        const way = value[k] - from;
        return turn ? way - full * Math.round(way / full) : way;
      });
      return from + s * (1 - t) * right + (1 - s) * t * lower + s * t * corner;
    };
    return place(mean(grid.longitudes, true), mean(grid.latitudes), mean(grid.heights));
  }

  /** The same as a text for people. */
  function describe(x, y) {
    const place = at(x, y);
    if (place === 'sky') return 'Sky';
    if (!place) return '';
    return `${geofx.coordinates(place.longitude, place.latitude)} · ${geofx.metres(place.height)}`;
  }

  return {at, describe};
})();
