// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// What the page's scripts share. The data are scripts, too, since a page that was opened by a double click may read nothing else.
'use strict';

const geofx = {data: {}};

/** Degrees with the side of the sky: "21.5069° N". */
geofx.degrees = (value, sides) =>
  `${Math.abs(value).toFixed(4)}°\u00a0${sides[value < 0 ? 1 : 0]}`;

geofx.coordinates = (longitude, latitude) =>
  `${geofx.degrees(latitude, 'NS')}, ${geofx.degrees(longitude, 'EW')}`;

/** Metres with a comma between thousands. */
geofx.metres = (height) => `${Math.round(height).toLocaleString('en-US').replace('-', '−')}\u00a0m`;

/** Whether people want little to move. */
geofx.still = () => matchMedia('(prefers-reduced-motion: reduce)').matches;

/** An element with attributes and children. */
geofx.element = (tag, attributes, ...children) => {
  const element = document.createElement(tag);
  for (const [key, value] of Object.entries(attributes || {})) element.setAttribute(key, value);
  element.append(...children);
  return element;
};
