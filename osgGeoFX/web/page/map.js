// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// The map: the picture in tiles, what keys and buttons do, and what the page tells about places.
'use strict';

(() => {
  const {picture} = geofx.data;
  const container = document.getElementById('map'), readout = document.getElementById('place');
  const snap = 1 / geofx.data.names.stepsOfZoom;
  const touches = matchMedia('(hover: none)').matches;

  const map = L.map(container, {
    crs: L.CRS.Simple, zoomControl: false, attributionControl: false, keyboard: false,
    zoomSnap: snap, wheelPxPerZoomLevel: 100, maxZoom: picture.zoom + 1, maxBoundsViscosity: 0.9,
    zoomAnimation: !geofx.still(), fadeAnimation: !geofx.still(), inertia: !geofx.still(), markerZoomAnimation: !geofx.still(),
  });
  geofx.map = map;
  const size = () => L.point(picture.width, picture.height);
  /** From pixels of the picture to Leaflet's coordinates, and back. */
  geofx.latLng = ([x, y]) => map.unproject([x, y], picture.zoom);
  geofx.pixel = (latLng) => map.project(latLng, picture.zoom);
  const bounds = L.latLngBounds(geofx.latLng([0, 0]), geofx.latLng([picture.width, picture.height]));

  // Screens with fine pixels take the tiles of the next level, half as large.
  const finer = devicePixelRatio > 1.25 ? 1 : 0;
  const side = picture.tile >> finer;
  const Tiles = L.GridLayer.extend({
    createTile({x, y, z}, done) {
      const level = z + finer;
      const levelSize = size().divideBy(Math.pow(2, picture.zoom - level));
      // A tile has the first pixels of those beside it; at the right and the lower border it is smaller.
      const share = (number, all) => `${100 * Math.min(picture.tile + 1, Math.ceil(all) - number * picture.tile) / picture.tile}%`;
      const tile = document.createElement('div'), image = document.createElement('img');
      image.alt = '';
      image.draggable = false;
      image.style.width = share(x, levelSize.x);
      image.style.height = share(y, levelSize.y);
      image.onload = () => done(null, tile);
      image.onerror = () => done(new Error(`The tile ${image.src} is missing.`), tile);
      image.src = `tiles/${level}/${x}/${y}.jpg`;
      tile.append(image);
      return tile;
    },
    // Between two levels the finer one, unless the coarser one is nearly as large.
    _setView(center, zoom, ...rest) {
      this._exact = zoom;
      L.GridLayer.prototype._setView.call(this, center, zoom, ...rest);
    },
    _clampZoom() {
      return L.GridLayer.prototype._clampZoom.call(this, Math.ceil(this._exact - 0.3));
    },
  });
  const tiles = new Tiles({
    tileSize: side, bounds, noWrap: true, keepBuffer: 1, className: 'tiles',
    minNativeZoom: Math.min(0, picture.zoom - finer), maxNativeZoom: picture.zoom - finer, maxZoom: picture.zoom + 1,
  });

  const zoomOf = (scale) => picture.zoom + Math.log2(scale);
  /** The zoom that shows all of the picture. */
  const least = () => {
    const view = map.getSize().unscaleBy(size());
    return Math.floor(zoomOf(Math.min(view.x, view.y)) / snap) * snap;
  };
  /** The zoom that leaves no border, as far as the picture has the pixels for it. */
  const filling = () => {
    const view = map.getSize().unscaleBy(size());
    return Math.max(least(), Math.ceil(zoomOf(Math.min(Math.max(view.x, view.y), 1)) / snap) * snap);
  };
  const showAll = () => map.setView(bounds.getCenter(), least(), {animate: !geofx.still()});

  // A border of the screen's pixels around the picture, so that the page's controls hide nothing of it for good: above, to the side, below.
  const border = () => {
    const narrow = map.getSize().x < 600;
    return {top: narrow ? document.querySelector('.card').getBoundingClientRect().bottom + 8 : 28, side: narrow ? 0 : 28, bottom: narrow ? 64 : 28};
  };
  function limit() {
    map.setMinZoom(Math.max(Math.min(least(), picture.zoom), 0));
    const {top, side, bottom} = border(), pixel = Math.pow(2, picture.zoom - map.getZoom());
    map.setMaxBounds(L.latLngBounds(geofx.latLng([-side * pixel, -top * pixel]),
      geofx.latLng([picture.width + side * pixel, picture.height + bottom * pixel])));
  }

  /** The nearest center for which no more than the border lies beyond the picture. */
  function centerAt(at, zoom) {
    const {top, side, bottom} = border(), pixel = Math.pow(2, picture.zoom - zoom), half = map.getSize().multiplyBy(0.5 * pixel);
    const within = (value, room, low, high) => 2 * room >= high - low ? (low + high) / 2 : Math.min(Math.max(value, low + room), high - room);
    return geofx.latLng([within(at[0], half.x, -side * pixel, picture.width + side * pixel),
      within(at[1], half.y, -top * pixel, picture.height + bottom * pixel)]);
  }

  // ---- The place under the pointer ----

  const hint = !picture.places ? ''
             : touches ? 'Tap the picture for a place’s coordinates' : 'Point at the picture for a place’s coordinates';
  let mark = null;
  function tell(latLng, live) {
    const pixel = geofx.pixel(latLng);
    const text = geofx.places.describe(pixel.x, pixel.y);
    readout.setAttribute('aria-live', live ? 'polite' : 'off');
    readout.textContent = text || hint;
    readout.classList.toggle('hint', !text);
    return text;
  }
  const forget = () => {
    if (mark) mark.remove();
    mark = null;
  };
  readout.textContent = hint;
  readout.classList.add('hint');
  map.on('mousemove', (event) => tell(event.latlng, false));
  let hadPopup = false;
  map.on('preclick', () => { hadPopup = Boolean(map._popup && map.hasLayer(map._popup)); });
  map.on('click', (event) => {
    forget();
    if (hadPopup || !tell(event.latlng, true)) return;
    const icon = L.divIcon({className: 'mark', html: geofx.element('i'), iconSize: [0, 0]});
    mark = L.marker(event.latlng, {icon, keyboard: false, interactive: false}).addTo(map);
  });

  // ---- A name's popup ----

  function contentOf(name) {
    const root = geofx.element('div', {class: 'about', tabindex: '-1', role: 'group', 'aria-label': name.text},
      geofx.element('h2', {dir: 'auto'}, name.text));
    const list = geofx.element('dl');
    if (name.height !== undefined)
      list.append(geofx.element('dt', {}, 'Height'), geofx.element('dd', {class: 'up'}, geofx.metres(name.height)));
    if (name.place) {
      const [longitude, latitude] = name.place;
      list.append(geofx.element('dt', {}, 'Place'),
        geofx.element('dd', {class: 'coordinates'}, geofx.coordinates(longitude, latitude)));
      const numbers = `${latitude.toFixed(6)}, ${longitude.toFixed(6)}`;
      const copy = geofx.element('button', {type: 'button', class: 'copy'}, 'Copy coordinates');
      copy.addEventListener('click', () => copyText(numbers, copy));
      const actions = geofx.element('p', {class: 'actions'}, copy);
      // Telephones have a program for such addresses.
      if (touches) actions.append(geofx.element('a', {href: `geo:${latitude.toFixed(6)},${longitude.toFixed(6)}`}, 'Open in maps'));
      root.append(list, actions);
    } else if (list.children.length) {
      root.append(list);
    }
    return root;
  }

  async function copyText(text, button) {
    let done = true;
    try {
      await navigator.clipboard.writeText(text);
    } catch (error) {
      // Pages that were opened by a double click, or without https, may have no clipboard.
      const field = geofx.element('textarea', {readonly: '', class: 'unseen'});
      field.value = text;
      document.body.append(field);
      field.select();
      done = document.execCommand('copy');
      field.remove();
      button.focus();
    }
    button.textContent = done ? 'Copied' : text;
    setTimeout(() => { button.textContent = 'Copy coordinates'; }, 2000);
  }

  let opener = null; // what gets the focus back
  function showPopup(name, focus) {
    address(name);
    const dot = name.curve ? 0 : geofx.data.names.styles[name.style].dot;
    const content = contentOf(name), {top} = border();
    const popup = L.popup({className: 'paper', offset: [0, -Math.max(dot, 2)], minWidth: 236, maxWidth: 300, autoPan: false})
      .setLatLng(geofx.latLng(name.at)).setContent(content).openOn(map);
    // Summits stand high in the picture: where there is no room above, the popup hangs below.
    const container = popup.getElement(), height = container.offsetHeight;
    if (map.latLngToContainerPoint(popup.getLatLng()).y - height - 16 < top) {
      container.classList.add('below');
      popup.options.offset = [0, height + 16];
      popup.update();
    }
    const {x, y} = map.latLngToContainerPoint(popup.getLatLng()), size = map.getSize();
    const half = container.offsetWidth / 2 + 10, below = container.classList.contains('below');
    const beyond = [Math.min(x - half, 0) + Math.max(x + half - size.x, 0), below ? Math.max(y + height + 70 - size.y, 0) : 0];
    if (beyond[0] || beyond[1]) map.panBy(beyond, {animate: !geofx.still()});
    const close = document.querySelector('.leaflet-popup-close-button');
    close.setAttribute('aria-label', 'Close');
    close.setAttribute('role', 'button');
    if (focus) content.focus({preventScroll: true});
  }

  /** The page's address leads to a name, for people to send it to others. */
  function address(name) {
    try {
      history.replaceState(null, '', name ? `#${encodeURIComponent(name.text)}` : location.pathname + location.search);
    } catch (error) {
      // Some browsers allow it on servers only.
    }
  }

  const step = (name) => (name.shown.length ? name.shown[0][0] * snap : picture.zoom);

  /** Goes to a name and tells about it. */
  function goTo(name, jump) {
    forget();
    map.closePopup();
    opener = document.getElementById('search');
    const zoom = Math.min(Math.max(map.getZoom(), step(name), picture.zoom - 1), map.getMaxZoom());
    const center = centerAt(name.at, zoom);
    const arrived = () => showPopup(name, true);
    if (jump || geofx.still()) {
      map.setView(center, zoom, {animate: false});
      arrived();
    } else {
      map.once('moveend', arrived);
      map.flyTo(center, zoom, {duration: 0.9});
    }
  }

  map.on('popupclose', () => {
    address(null);
    const inside = document.activeElement && document.activeElement.closest('.leaflet-popup');
    if (inside || document.activeElement === document.body) container.focus({preventScroll: true});
  });

  // ---- Keys and buttons ----

  const pan = {ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1]};
  document.addEventListener('keydown', (event) => {
    const search = document.getElementById('search');
    if (event.altKey || event.ctrlKey || event.metaKey || event.target === search) return;
    if (event.key === '/' && geofx.data.names.names.length) {
      event.preventDefault();
      search.focus();
      return;
    }
    if (event.key === 'Escape') {
      forget();
      map.closePopup();
      if (opener) opener.focus();
      opener = null;
      return;
    }
    // Elsewhere the keys are the page's own.
    const focused = document.activeElement;
    if (focused !== container && focused !== document.body && !focused.closest('.leaflet-popup')) return;
    if (pan[event.key]) {
      const far = (event.shiftKey ? 0.5 : 0.15) * Math.min(map.getSize().x, map.getSize().y);
      map.panBy(L.point(pan[event.key]).multiplyBy(far), {animate: !geofx.still(), duration: 0.2});
    } else if (event.key === '+' || event.key === '=') map.zoomIn(event.shiftKey && event.key === '+' ? 1 : 0.5);
    else if (event.key === '-' || event.key === '_') map.zoomOut(0.5);
    else if (event.key === '0' || event.key === 'Home') showAll();
    else return;
    event.preventDefault();
    map.once('moveend', () => tell(map.getCenter(), true));
  });

  const buttons = {nearer: () => map.zoomIn(1), farther: () => map.zoomOut(1), whole: showAll};
  for (const [id, action] of Object.entries(buttons)) document.getElementById(id).addEventListener('click', action);
  const dim = (id, off) => document.getElementById(id).setAttribute('aria-disabled', String(off));
  map.on('zoomend zoomlevelschange', () => {
    dim('nearer', map.getZoom() >= map.getMaxZoom());
    dim('farther', map.getZoom() <= map.getMinZoom());
  });

  // ---- The first view ----

  tiles.once('load', () => {
    performance.mark('first view');
    document.documentElement.dataset.ready = Math.round(performance.now());
  });
  map.setView(bounds.getCenter(), filling(), {animate: false});
  limit();
  map.on('resize zoomend', limit);
  tiles.addTo(map);
  new geofx.NamesLayer((name) => showPopup(name, false)).addTo(map);
  geofx.search((name) => goTo(name, false));
  document.querySelector('.search').hidden = !geofx.data.names.names.length;

  function follow() {
    let wanted = '';
    try {
      wanted = decodeURIComponent(location.hash.slice(1));
    } catch (error) {
      // Percent signs that somebody has broken lead nowhere.
    }
    const name = wanted && geofx.data.names.names.find((each) => each.text === wanted);
    if (name) goTo(name, true);
  }
  addEventListener('hashchange', follow);
  follow();
})();
