#!/usr/bin/python3
# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 the osgGeoFX authors
"""The page of --web in a real browser: Debian's chromium, without a screen, by its driver.

    browser.py OSGGEOFX_PANORAMA GEOFX_INVENT [SCREENSHOTS]

It invents a volcano, has a page made of it, and opens the page from a file and from a server of its own. With a third argument it keeps pictures of
the screen in that folder. Exit code 77, with the reason, where there is no browser.
"""
import os
import shutil
import statistics
import sys
import unittest

from harness import BROWSER, PAGE, SIDE, SOUTH, WEST, WORK, ActionChains, By, Keys, NARROW, OpenPage, WIDE, decode

# Seconds from localhost: 2 as was asked for, and more where other tests run beside it.
FIRST_VIEW = 2.0 if os.environ.get("GEOFX_TEST_FULL") else 10.0


class PageTest(OpenPage):
    # ---- Opening ----

    def test_opens_by_a_double_click(self):
        self.open(f"file://{PAGE}/")
        self.assertEqual(BROWSER.title, "A volcano")
        self.assertGreater(self.js("return [...document.querySelectorAll('.tiles img')].filter((image) => image.naturalWidth).length"), 3)
        self.wait(lambda: "Pūʻoko" in self.names())
        # What the pointer shows is loaded by itself, last.
        self.wait(lambda: self.js("return Boolean(geofx.data.places)"))
        self.press("/", "puoko", Keys.ENTER)
        self.assert_tells_summit()

    def test_first_view_within_two_seconds(self):
        times = []
        for _ in range(5):
            self.open()
            times.append(self.js("return performance.getEntriesByName('first view')[0].startTime") / 1000)
            self.assertTrue(self.js("return [...document.querySelectorAll('.tiles img')].every((image) => image.complete && image.naturalWidth)"))
            # It fades in.
            self.wait(lambda: "Pūʻoko" in self.names())
        print(f"First view from localhost: median {statistics.median(times):.2f} s of {', '.join(f'{each:.2f}' for each in times)}")
        self.assertLess(statistics.median(times), FIRST_VIEW)

    def test_refuses_what_is_not_its_own(self):
        """The policy of the page stops scripts that someone might put into it, and requests to elsewhere."""
        self.open()
        blocked = BROWSER.execute_async_script("""
            const done = arguments[0], seen = [];
            document.addEventListener('securitypolicyviolation', (event) => {
              seen.push(event.effectiveDirective);
              if (seen.length === 2) done(seen);
            });
            const script = document.createElement('script');
            script.textContent = 'window.stranger = true';
            document.head.append(script);
            new Image().src = 'http://127.0.0.1:9/elsewhere.png';""")
        self.assertEqual(sorted(each.split("-")[0] for each in blocked), ["img", "script"])
        self.assertIsNone(self.js("return window.stranger || null"))
        BROWSER.get_log("browser")  # they are told there
        self.mine += ("http://127.0.0.1:9/elsewhere.png",)  # chromium lists it, although it was stopped

    def test_does_without_names_and_without_places(self):
        """Pictures of scenes without a georeference, or without --labels."""
        plain = WORK / "plain"
        shutil.copytree(PAGE, plain, dirs_exist_ok=True)
        (plain / "data/names.js").write_text('geofx.data.names = {"stepsOfZoom": 4, "styles": {}, "names": []};')
        (plain / "data/places.js").write_text("geofx.data.places = null;")
        picture = (plain / "data/picture.js").read_text()
        self.assertIn('"places":true', picture)
        (plain / "data/picture.js").write_text(picture.replace('"places":true', '"places":false'))
        self.open(f"file://{plain}/")
        self.assertFalse(self.find("#search").is_displayed())
        self.assertFalse(self.find("#place").is_displayed())
        ActionChains(BROWSER).move_to_element(self.find("#map")).click().perform()
        self.press("/", "+")
        self.settle()
        self.assertEqual(self.find("#place").text, "")
        self.assertEqual(BROWSER.find_elements(By.CSS_SELECTOR, ".mark, .name, .leaflet-popup"), [])

    # ---- Zooming ----

    def test_zooms_and_shows_more_names(self):
        self.open(size=(420, 300))
        whole = self.find("#whole")
        whole.click()
        self.settle()
        before, few = self.js("return geofx.map.getZoom()"), len(self.names())
        self.find("#nearer").click()
        self.settle()
        self.assertAlmostEqual(self.js("return geofx.map.getZoom()"), before + 1, places=6)
        self.assertGreater(len(self.names()), few)
        # Each level's tiles are asked for where they are shown at about their own size.
        shown = self.js("return [...document.querySelectorAll('.tiles .leaflet-tile-container img')].map((image) => image.getBoundingClientRect().width / image.naturalWidth)")
        self.assertLess(max(shown), 1.25)
        self.find("#farther").click()
        self.settle()
        self.assertEqual(len(self.names()), few)
        for _ in range(5):
            self.find("#farther").click()
            self.settle()
        self.assertEqual(self.find("#farther").get_attribute("aria-disabled"), "true")
        fits = self.js("const s = geofx.map.getSize(), k = 2 ** (geofx.map.getZoom() - geofx.data.picture.zoom);"
                       "return geofx.data.picture.width * k <= s.x + 1 && geofx.data.picture.height * k <= s.y + 1")
        self.assertTrue(fits, "the least zoom shows the whole picture")

    def test_names_do_not_overlap_and_lie_on_their_places(self):
        for size in (WIDE, NARROW):
            self.open(size=size)
            for _ in range(3):
                overlaps = self.js("""
                    const boxes = [...document.querySelectorAll('.name .text')].map((text) => {
                      const range = document.createRange();
                      range.selectNodeContents(text);
                      return [text.textContent, range.getBoundingClientRect()];
                    });
                    return boxes.flatMap(([a, p], i) => boxes.slice(i + 1).filter(([, q]) =>
                      p.left < q.right - 1 && q.left < p.right - 1 && p.top < q.bottom - 1 && q.top < p.bottom - 1).map(([b]) => `${a}, ${b}`));""")
                self.assertEqual(overlaps, [])
                # The dot of a hut is where the picture has it.
                off = self.js("""
                    const map = geofx.map, scale = 2 ** (map.getZoom() - geofx.data.picture.zoom), origin = map.getPixelBounds().min;
                    return Math.max(...[...document.querySelectorAll('.name .dot')].map((dot) => {
                      const name = geofx.data.names.names.find((each) => each.text === dot.parentNode.textContent), box = dot.getBoundingClientRect();
                      return Math.hypot((box.left + box.right) / 2 - (name.at[0] * scale - origin.x), (box.top + box.bottom) / 2 - (name.at[1] * scale - origin.y));
                    }))""")
                self.assertLess(off, 1.5)
                self.find("#nearer").click()
                self.settle()

    # ---- Finding ----

    def test_finds_a_summit_without_its_accents(self):
        self.open()
        field = self.find("#search")
        field.click()
        field.send_keys("PUOKO")
        self.assertEqual(field.get_attribute("aria-expanded"), "true")
        options = BROWSER.find_elements(By.CSS_SELECTOR, "#results [role=option]")
        self.assertEqual([each.text.replace("\u00a0", " ").split("\n") for each in options], [["Pūʻoko", "2,718 m"]])
        self.shoot("search")
        field.send_keys(Keys.ENTER)
        popup = self.assert_tells_summit()
        self.settle()
        self.shoot("popup")
        self.assertEqual(self.find("#search").get_attribute("aria-expanded"), "false")
        # It is in sight, within the window, clear of the other controls.
        box, card = popup.rect, self.find(".card").rect
        self.assertGreaterEqual(box["x"], 0)
        self.assertGreaterEqual(box["y"], 0)
        self.assertFalse(box["x"] < card["x"] + card["width"] and box["y"] < card["y"] + card["height"], (box, card))
        self.assertLess(box["y"] + box["height"], WIDE[1])

    def test_says_that_there_is_no_such_name(self):
        self.open()
        self.press("/", "nowhere at all")
        self.assertEqual(self.find("#results").text, "No such name on this map")
        self.assertEqual(self.find("#found").get_attribute("textContent"), "No places")
        self.press(Keys.ENTER)
        self.assertEqual(BROWSER.find_elements(By.CSS_SELECTOR, ".leaflet-popup"), [])

    def test_a_click_on_a_name_tells_about_it(self):
        self.open()
        name = next(each for each in BROWSER.find_elements(By.CSS_SELECTOR, ".name .text") if each.text == "Pūʻoko")
        name.click()
        self.assert_tells_summit()
        self.press(Keys.ESCAPE)
        self.wait(lambda: not BROWSER.find_elements(By.CSS_SELECTOR, ".leaflet-popup"))
        curved = self.find(".name text")
        self.assertEqual(curved.text, "Long Plain")
        ActionChains(BROWSER).move_to_element(curved).click().perform()
        self.wait(lambda: self.find(".leaflet-popup .about h2").text == "Long Plain")

    def test_an_address_leads_to_a_name(self):
        self.open()
        self.press("/", Keys.ENTER)
        self.assertEqual(BROWSER.find_elements(By.CSS_SELECTOR, ".leaflet-popup"), [], "nothing was asked for")
        self.press("puoko", Keys.ENTER)
        self.assert_tells_summit()
        address = BROWSER.current_url
        self.assertTrue(address.endswith("#P%C5%AB%CA%BBoko"), address)
        self.press(Keys.ESCAPE)
        self.wait(lambda: "#" not in BROWSER.current_url)
        for hash in (address[address.index("#"):], "#nobody", "#%"):
            self.open(hash=hash)
            if hash == address[address.index("#"):]:
                self.assert_tells_summit()
            else:
                self.assertEqual(BROWSER.find_elements(By.CSS_SELECTOR, ".leaflet-popup"), [])

    # ---- The place under the pointer ----

    def test_the_pointer_tells_places(self):
        self.open()
        self.wait(lambda: self.js("return Boolean(geofx.data.places)"))
        name = self.data_of("Pūʻoko")
        body = self.find("#map")

        def readout_at(x, y):
            size = body.size
            ActionChains(BROWSER).move_to_element_with_offset(body, int(x - size["width"] / 2), int(y - size["height"] / 2)).perform()
            return self.find("#place").text.replace("\u00a0", " ")

        to_screen = "const p = geofx.map.latLngToContainerPoint(geofx.latLng(arguments[0])); return [p.x, p.y]"
        x, y = self.js(to_screen, name["at"])
        text = readout_at(x, y + 4)
        latitude, longitude = self.numbers(text)
        # A pixel of the picture is some 60 m wide there, and much more along the line of sight.
        self.assertAlmostEqual(longitude, name["place"][0], delta=0.012)
        self.assertAlmostEqual(latitude, name["place"][1], delta=0.012)
        self.assertTrue(text.endswith(" m"), text)
        height = float(text.split("·")[1].replace(",", "").replace("m", ""))
        self.assertGreater(height, 1500)
        # Huts stand on slopes that are seen from above, where neighbors belong together.
        hits = 0
        for hut in self.js("return geofx.data.names.names.filter((name) => name.text.startsWith('Hut'))"):
            x, y = self.js(to_screen, hut["at"])
            if not (10 < x < WIDE[0] - 60 and 110 < y < WIDE[1] - 60):
                continue
            text = readout_at(x, y)
            latitude, longitude = self.numbers(text)
            self.assertAlmostEqual(longitude, hut["place"][0], delta=0.005, msg=f"{hut['text']}: {text}")
            self.assertAlmostEqual(latitude, hut["place"][1], delta=0.005, msg=f"{hut['text']}: {text}")
            hits += 1
        self.assertGreater(hits, 8)
        # The sky, and what lies beyond the picture.
        x, y = self.js(to_screen, [400, 6])
        self.assertEqual(readout_at(x, y), "Sky")
        x, y = self.js(to_screen, [400, -6])
        self.assertNotRegex(readout_at(x, y), "°|Sky")

    def test_places_in_a_browser_are_those_of_the_text(self):
        """The page's own decoder against another one: each sample, in its middle."""
        self.open()
        self.wait(lambda: self.js("return Boolean(geofx.data.places)"))
        data = self.js("return geofx.data.places")
        values = decode(data)
        picture = self.js("return geofx.data.picture")
        samples = [(column, row) for row in range(5, data["rows"], 37) for column in range(3, data["columns"], 41)]
        pixels = [((data["first"] + column * data["step"] + 0.5) * picture["width"] / data["width"],
                   (data["first"] + row * data["step"] + 0.5) * picture["height"] / data["height"]) for column, row in samples]
        seen = self.js("return arguments[0].map(([x, y]) => geofx.places.at(x, y))", pixels)
        ground = 0
        for (column, row), place in zip(samples, seen):
            value = values[row * data["columns"] + column]
            if value is None:
                self.assertEqual(place, "sky")
                continue
            ground += 1
            self.assertAlmostEqual(place["longitude"], value[0] * data["unit"], places=6)
            self.assertAlmostEqual(place["latitude"], value[1] * data["unit"], places=6)
            self.assertAlmostEqual(place["height"], value[2], places=6)
        self.assertGreater(ground, 20)
        self.assertLess(ground, len(samples))

    # ---- By keys alone ----

    def test_works_by_keyboard(self):
        self.open()
        self.press(Keys.TAB)
        self.assertEqual(self.active().get_attribute("id"), "search")
        self.press(Keys.TAB)
        self.assertEqual(self.active().get_attribute("id"), "map")
        self.assertEqual(self.js("return getComputedStyle(document.querySelector('.cross')).display"), "block", "the focus is to be seen")
        self.press("+", "+")
        start = self.settle()
        self.press(Keys.ARROW_RIGHT)
        moved = self.settle()
        self.assertGreater(moved[2], start[2])
        self.press(Keys.ARROW_LEFT, Keys.ARROW_DOWN)
        self.assertLess(self.settle()[1], moved[1])
        self.wait(lambda: "°" in self.find("#place").text or self.find("#place").text == "Sky")
        self.press("-")
        self.assertLess(self.settle()[0], start[0])
        self.press("0")
        self.assertLess(self.settle()[0], start[0])
        # The list, by arrows: "hut" has many, the first one is marked, arrows go on and around.
        self.press("/")
        self.assertEqual(self.active().get_attribute("id"), "search")
        self.press("hut")
        field = self.find("#search")
        marked = lambda: self.find(f"#{field.get_attribute('aria-activedescendant')}").text.split("\n")[0]
        first = marked()
        self.press(Keys.ARROW_DOWN)
        second = marked()
        self.assertNotEqual(first, second)
        self.press(Keys.ARROW_UP)
        self.assertEqual(marked(), first)
        self.press(Keys.ARROW_UP)
        self.assertNotIn(marked(), (first, second))
        self.press(Keys.ARROW_DOWN, Keys.ARROW_DOWN, Keys.ENTER)
        self.wait(lambda: self.find(".leaflet-popup .about h2").text == second)
        self.wait(lambda: self.active().get_attribute("class") == "about")
        self.press(Keys.TAB)
        self.assertEqual(self.active().text, "Copy coordinates")
        self.press(Keys.ENTER)
        self.wait(lambda: self.active().text != "Copy coordinates")
        self.press(Keys.ESCAPE)
        self.wait(lambda: not BROWSER.find_elements(By.CSS_SELECTOR, ".leaflet-popup"))
        self.assertEqual(self.active().get_attribute("id"), "search", "the focus goes back to where it came from")
        self.press(Keys.ESCAPE)
        self.assertEqual(self.find("#search").get_attribute("value"), "")
        self.press(Keys.ESCAPE)
        self.assertEqual(self.active().get_attribute("id"), "map")
        # All buttons can be reached, and tell what they do.
        self.press(Keys.TAB)
        self.assertEqual(self.active().get_attribute("aria-label"), "Zoom in")

    def test_moves_little_where_people_want_it(self):
        self.open(still=True)
        self.press("/", "puoko", Keys.ENTER)
        self.assert_tells_summit()  # at once
        self.assertFalse(self.js("return geofx.map.options.zoomAnimation"))

    # ---- On a telephone ----

    def test_fits_a_telephone(self):
        self.open(size=NARROW, touch=True, scale=2)
        self.assertEqual(self.js("return [document.scrollingElement.scrollWidth, document.scrollingElement.scrollHeight]"), list(NARROW))
        boxes = self.js("""
            return [...document.querySelectorAll('.card, .zoom, .place, .attribution')].map((element) => {
              const box = element.getBoundingClientRect();
              return [element.className, box.left, box.top, box.right, box.bottom];
            })""")
        self.assertEqual(len(boxes), 4)
        for i, (name, left, top, right, bottom) in enumerate(boxes):
            self.assertGreaterEqual(min(left, top), 0, name)
            self.assertLessEqual(right, NARROW[0], name)
            self.assertLessEqual(bottom, NARROW[1], name)
            for other, *box in boxes[:i]:
                self.assertFalse(left < box[2] and box[0] < right and top < box[3] and box[1] < bottom, f"{name} lies over {other}")
        small = self.js("""
            return [...document.querySelectorAll('.zoom button, #search')].map((each) => each.getBoundingClientRect())
              .filter((box) => box.width < 40 || box.height < 40).length""")
        self.assertEqual(small, 0, "fingers need room")
        self.wait(lambda: self.js("return Boolean(geofx.data.places)"))
        # A tap tells a place, and marks it.
        free = self.js("""
            const isFree = ([x, y]) => document.elementFromPoint(x, y).id === 'map' && geofx.places.describe(...Object.values(geofx.pixel(
              geofx.map.containerPointToLatLng([x, y])))).includes('°');
            return [300, 340, 380, 420, 460, 500].flatMap((y) => [60, 120, 180, 240].map((x) => [x, y])).find(isFree);""")
        self.tap(*free)
        self.wait(lambda: "°" in self.find("#place").text)
        self.wait(lambda: len(BROWSER.find_elements(By.CSS_SELECTOR, ".mark")) == 1)
        self.shoot("telephone")
        self.find("#search").click()
        self.find("#search").send_keys("puoko", Keys.ENTER)
        popup = self.assert_tells_summit()
        self.settle()
        box, card = popup.rect, self.find(".card").rect
        self.assertGreaterEqual(box["x"], 0)
        self.assertLessEqual(box["x"] + box["width"], NARROW[0])
        self.assertGreaterEqual(box["y"], card["y"] + card["height"])
        link = popup.find_element(By.CSS_SELECTOR, "a[href^='geo:']").get_attribute("href")
        latitude, longitude = [float(each) for each in link[4:].split(",")]
        self.assertAlmostEqual(longitude, WEST + SIDE * 0.53, delta=0.003)
        self.assertAlmostEqual(latitude, SOUTH + SIDE * 0.56, delta=0.003)
        self.shoot("telephone-popup")

    def test_fine_screens_get_fine_tiles(self):
        for scale in (1, 2):
            self.open(size=NARROW, touch=True, scale=scale)
            self.find("#whole").click()
            self.settle()
            self.wait(lambda: self.js("return [...document.querySelectorAll('.tiles img')].every((image) => image.complete)"))
            # Pixels of the screen for each one of a tile: about one, and never many fewer.
            shown = self.js("return [...document.querySelectorAll('.tiles .leaflet-tile-container:last-child img')]"
                            ".map((image) => image.getBoundingClientRect().width * devicePixelRatio / image.naturalWidth)")
            self.assertGreater(min(shown), 0.55, scale)
            self.assertLess(max(shown), 1.25, scale)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
