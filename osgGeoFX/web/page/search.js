// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// The box that finds names: by any part, without accents; with arrows, Enter and Escape.
'use strict';

/** Sets the search up. `choose(name)` is called for the name that people take. */
geofx.search = (choose) => {
  const input = document.getElementById('search'), list = document.getElementById('results');
  const found = document.getElementById('found'), clear = document.getElementById('clear');
  const most = 50;
  const letters = {ß: 'ss', æ: 'ae', œ: 'oe', ø: 'o', ł: 'l', đ: 'd', ð: 'd', þ: 'th', ı: 'i', ŋ: 'n'};

  /** Text as people type it: without accents, apostrophes and ʻokinas, in small letters. */
  const plain = (text) => text.toLowerCase().normalize('NFD').replace(/[\p{M}\u2018\u2019\u02bb\u02bc\u02be\u02bf\u2032`'´]/gu, '')
    .replace(/[ßæœøłđðþıŋ]/g, (letter) => letters[letter]).replace(/[\s\p{P}]+/gu, ' ').trim();

  const names = geofx.data.names.names.map((name) => ({name, plain: plain(name.text)}));
  let shown = [], active = -1;

  function matches(text) {
    const wanted = plain(text);
    if (!wanted) return names.slice(0, most);
    // Names that begin so, then those with such a word, then others; each by importance.
    const rank = ({plain: each}) =>
      each.startsWith(wanted) ? 0 : ` ${each}`.includes(` ${wanted}`) ? 1 : each.includes(wanted) ? 2 : 3;
    return [0, 1, 2].flatMap((kind) => names.filter((each) => rank(each) === kind)).slice(0, most);
  }

  function activate(index) {
    active = index;
    [...list.children].forEach((item, i) => item.setAttribute('aria-selected', String(i === active)));
    const item = list.children[active];
    if (item) {
      input.setAttribute('aria-activedescendant', item.id);
      item.scrollIntoView({block: 'nearest'});
    } else {
      input.removeAttribute('aria-activedescendant');
    }
  }

  function close() {
    list.hidden = true;
    input.setAttribute('aria-expanded', 'false');
    activate(-1);
  }

  function take(name) {
    input.value = name.text;
    clear.hidden = false;
    close();
    choose(name);
  }

  function open() {
    shown = matches(input.value);
    list.replaceChildren(...shown.map(({name}, i) => {
      const item = geofx.element('li', {role: 'option', id: `result${i}`, 'aria-selected': 'false'},
        geofx.element('span', {class: 'what', dir: 'auto'}, name.text));
      if (name.height !== undefined) item.append(geofx.element('span', {class: 'height'}, geofx.metres(name.height)));
      // The pointer's button going down would take the focus away.
      item.addEventListener('mousedown', (event) => event.preventDefault());
      item.addEventListener('click', () => take(name));
      return item;
    }));
    if (!shown.length) list.replaceChildren(geofx.element('li', {class: 'none', role: 'presentation'}, 'No such name on this map'));
    found.textContent = shown.length === 1 ? 'One place' : `${shown.length || 'No'} places`;
    list.hidden = false;
    input.setAttribute('aria-expanded', 'true');
    activate(input.value.trim() && shown.length ? 0 : -1);
  }

  input.addEventListener('input', () => {
    clear.hidden = !input.value;
    open();
  });
  input.addEventListener('focus', () => input.select());
  input.addEventListener('click', () => list.hidden && open());
  input.addEventListener('blur', close);
  input.addEventListener('keydown', (event) => {
    if (event.isComposing) return;
    const count = shown.length;
    if (event.key === 'ArrowDown' || event.key === 'ArrowUp') {
      event.preventDefault();
      if (list.hidden) {
        open();
        if (active < 0 && shown.length) activate(event.key === 'ArrowDown' ? 0 : shown.length - 1);
      } else if (count) {
        activate(event.key === 'ArrowDown' ? (active + 1) % count : (active <= 0 ? count : active) - 1);
      }
    } else if (event.key === 'Enter') {
      event.preventDefault();
      if (list.hidden) open();
      if (shown[active]) take(shown[active].name);
    } else if (event.key === 'Escape') {
      event.stopPropagation();
      if (!list.hidden) close();
      else if (input.value) {
        input.value = '';
        clear.hidden = true;
      } else document.getElementById('map').focus();
    }
  });
  clear.addEventListener('click', () => {
    input.value = '';
    clear.hidden = true;
    input.focus();
  });
};
