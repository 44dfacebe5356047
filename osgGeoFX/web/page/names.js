// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// The names over the picture, as text. Which of them are shown at which zoom, and where, was laid out when the page was written.
'use strict';

/** The layer of names. `choose(name)` is called for a name that people click. */
geofx.NamesLayer = L.Layer.extend({
  initialize(choose) {
    this._choose = choose;
    this._shown = new Map(); // from names to what is drawn of them
    this._canvas = document.createElement('canvas').getContext('2d');
  },

  onAdd(map) {
    this._map = map;
    map.on('zoomend moveend resize', this.update, this);
    this.update();
  },

  onRemove(map) {
    map.off('zoomend moveend resize', this.update, this);
    for (const drawn of this._shown.values()) drawn.marker.remove();
    this._shown.clear();
  },

  /** Shows the names of the zoom that lie in the window or near it. */
  update() {
    const map = this._map, {names, stepsOfZoom} = geofx.data.names;
    const last = stepsOfZoom * (geofx.data.picture.zoom + 1);
    const step = Math.min(Math.max(Math.floor(stepsOfZoom * map.getZoom() + 0.001), 0), last);
    const scale = Math.pow(2, map.getZoom() - geofx.data.picture.zoom);
    const view = map.getPixelBounds(), room = view.getSize().multiplyBy(0.3);
    const window = L.bounds(view.min.subtract(room), view.max.add(room));
    for (const name of names) {
      const place = name.shown.find((each) => each[0] <= step && step <= each[1]);
      const point = L.point(name.at[0] * scale, name.at[1] * scale);
      const known = this._shown.get(name);
      if (!place || !window.contains(point)) {
        if (known) known.marker.remove();
        this._shown.delete(name);
        continue;
      }
      const key = name.curve ? map.getZoom() : place.join();
      if (known && known.key === key) continue;
      const html = name.curve ? this._curved(name, scale) : this._straight(name, place);
      const icon = L.divIcon({className: 'name', html, iconSize: [0, 0]});
      if (known) {
        known.marker.setIcon(icon);
        known.key = key;
        continue;
      }
      const marker = L.marker(geofx.latLng(name.at), {icon, keyboard: false, interactive: false});
      this._shown.set(name, {marker: marker.addTo(map), key});
    }
  },

  _straight(name, [, , left, top]) {
    const style = this._style(name);
    const [width, height] = name.size;
    const root = document.createElement('div');
    root.style.setProperty('--ink', style.color);
    root.style.setProperty('--halo', style.halo);
    if (style.leader) {
      const line = geofx.element('i', {class: 'leader'});
      line.style.width = `${style.line}px`;
      line.style.left = `${-style.line / 2}px`;
      line.style.height = `${Math.max(-(top + height), 0)}px`;
      root.append(line);
    }
    if (style.dot > 0) {
      const dot = geofx.element('i', {class: 'dot'});
      dot.style.width = dot.style.height = `${2 * style.dot}px`;
      dot.style.left = dot.style.top = `${-style.dot}px`;
      root.append(dot);
    }
    const text = geofx.element('button', {type: 'button', tabindex: '-1', class: 'text', dir: 'auto'}, name.text);
    Object.assign(text.style, {left: `${left}px`, top: `${top}px`, width: `${width}px`, height: `${height}px`});
    text.style.lineHeight = `${height}px`;
    // Fonts differ. Narrower text stays at the side of its place.
    text.style.textAlign = left >= 0 ? 'left' : left + width <= 0 ? 'right' : 'center';
    this._font(text.style, style, this._size(name, style));
    if (style.haloWidth > 0) text.classList.add('halo');
    this._listen(text, name);
    root.append(text);
    return root;
  },

  /** Text along the name's curve. */
  _curved(name, scale) {
    const style = this._style(name);
    const points = name.curve.map((point) => [(point[0] - name.at[0]) * scale, (point[1] - name.at[1]) * scale]);
    // Beyond its ends the curve goes on, for a browser's font may be wider than the one that it was made for.
    const beyond = (end, inner) => {
      const length = Math.hypot(end[0] - inner[0], end[1] - inner[1]) || 1;
      return [end[0] + (end[0] - inner[0]) / length * 60, end[1] + (end[1] - inner[1]) / length * 60];
    };
    points.unshift(beyond(points[0], points[1]));
    points.push(beyond(points[points.length - 1], points[points.length - 2]));
    const svg = (tag, attributes) => {
      const element = document.createElementNS('http://www.w3.org/2000/svg', tag);
      for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
      return element;
    };
    const id = `curve${geofx.data.names.names.indexOf(name)}`;
    const root = svg('svg', {width: 1, height: 1});
    root.append(svg('path', {id, fill: 'none', d: 'M' + points.map((point) => point.map((x) => x.toFixed(1)).join(' ')).join('L')}));
    const size = style.size;
    const text = svg('text', {dy: (0.34 * size).toFixed(1), 'text-anchor': 'middle', fill: style.color, class: 'curved',
                              stroke: style.haloWidth > 0 ? style.halo : 'none', 'stroke-width': (1.5 * size * style.haloWidth).toFixed(2)});
    this._font(text.style, style, size);
    const path = svg('textPath', {href: `#${id}`, startOffset: '50%'});
    path.textContent = name.text;
    text.append(path);
    this._listen(text, name);
    root.append(text);
    return root;
  },

  _listen(text, name) {
    text.addEventListener('click', (event) => {
      L.DomEvent.stop(event);
      // The end of a drag is no click.
      if (!this._map.dragging.moved()) this._choose(name);
    });
    L.DomEvent.on(text, 'dblclick', L.DomEvent.stop);
  },

  _style: (name) => geofx.data.names.styles[name.style],

  _family: (style) => style.font.split(',').map((family) => {
    const plain = family.trim().replace(/["\\]/g, '');
    return plain === 'sans-serif' ? 'system-ui, sans-serif' : /^(serif|monospace|cursive|fantasy)$/.test(plain) ? plain : `"${plain}"`;
  }).join(', '),

  _font(css, style, size) {
    css.fontFamily = this._family(style);
    css.fontSize = `${size}px`;
    css.fontWeight = style.bold ? '700' : '400';
    css.fontStyle = style.italic ? 'italic' : 'normal';
    css.letterSpacing = `${style.spacing}em`;
  },

  /** The font's size: smaller, where the browser's font would need more room than the name has. */
  _size(name, style) {
    this._canvas.font = `${style.italic ? 'italic ' : ''}${style.bold ? '700 ' : ''}${style.size}px ${this._family(style)}`;
    const width = this._canvas.measureText(name.text).width + style.spacing * style.size * [...name.text].length;
    return Math.min(style.size, style.size * name.size[0] / Math.max(width, 1));
  },
});
