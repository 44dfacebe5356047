# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 the osgGeoFX authors
"""What the tests of web pages in a browser need: a page, a server, a browser, and what they ask of each page that they open."""
import atexit
import base64
import functools
import http.server
import json
import os
import shutil
import subprocess
import sys
import tempfile
import threading
import time
import unittest
from pathlib import Path

SKIPPED = 77
CHROMIUM, DRIVER = "/usr/bin/chromium", "/usr/bin/chromedriver"
WIDE, NARROW = (1280, 800), (360, 740)
# Where the invented terrain lies, degrees.
WEST, SOUTH, SIDE = 173.8, -39.6, 0.6


def skip(reason):
    # As gtest says it, so that tests/run lists it.
    print(f"{sys.argv[0]}: Skipped\n{reason}")
    sys.exit(SKIPPED)


try:
    from selenium import webdriver
    from selenium.webdriver.chrome.options import Options
    from selenium.webdriver.chrome.service import Service
    from selenium.webdriver.common.action_chains import ActionChains
    from selenium.webdriver.common.by import By
    from selenium.webdriver.common.keys import Keys
    from selenium.webdriver.support.ui import WebDriverWait
except ImportError:
    skip("there is no selenium for Python; on Debian install python3-selenium.")
for program in (CHROMIUM, DRIVER):
    if not os.access(program, os.X_OK):
        skip(f"there is no {program}; on Debian install chromium and chromium-driver.")

PANORAMA, INVENT = (os.path.abspath(each) for each in sys.argv[1:3])
SCREENSHOTS = Path(sys.argv[3]) if len(sys.argv) > 3 else None


def feature(name, style, importance, x, y, height=None):
    """A name at a place, 0…1 over the terrain."""
    properties = {"name": name, "style": style, "importance": importance}
    if height is not None:
        properties["ele"] = height
    return {"type": "Feature", "properties": properties,
            "geometry": {"type": "Point", "coordinates": [WEST + SIDE * x, SOUTH + SIDE * y]}}


def make_page(folder):
    """A page of the invented volcano. The name of its summit has what people do not type: a macron and an ʻokina."""
    def run(*arguments):
        done = subprocess.run([str(each) for each in arguments], cwd=folder, capture_output=True, text=True)
        if done.returncode != 0:
            raise RuntimeError(f"{arguments}: {done.stdout}{done.stderr}")
        return done.stdout

    run(INVENT, "volcano", "volcano.tif", "301")
    names = [feature("Pūʻoko", "peak", 100, 0.53, 0.56, 2718)]
    names += [feature(f"Hut {i}", "hut", 50 - i, 0.3 + 0.05 * (i % 8), 0.62 + 0.05 * (i // 8)) for i in range(40)]
    names.append({"type": "Feature", "properties": {"name": "Long Plain", "style": "plain", "importance": 60},
                  "geometry": {"type": "LineString", "coordinates": [[WEST + SIDE * x, SOUTH + SIDE * 0.75] for x in (0.2, 0.4, 0.6, 0.8)]}})
    (folder / "names.geojson").write_text(json.dumps({"type": "FeatureCollection", "features": names}))
    (folder / "style.json").write_text('{"names": {"hut": {"manner": "beside", "dot": 2, "size": 12}}}')
    run(PANORAMA, "volcano.tif", "-o", "map.png", "--size", "800x450", "--samples", "0", "--quiet", "--labels", "names.geojson",
        "--style", "style.json", "--work", "work", "--web", "page", "--title", "A volcano", "--attribution", "Invented")
    return folder / "page"


class Server:
    """A plain server of files."""

    def __init__(self, folder):
        class Quiet(http.server.SimpleHTTPRequestHandler):
            def log_message(self, *_):
                pass
        handler = functools.partial(Quiet, directory=str(folder))
        self.server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), handler)
        threading.Thread(target=self.server.serve_forever, daemon=True).start()
        self.url = f"http://127.0.0.1:{self.server.server_port}/"


def start_browser():
    options = Options()
    options.binary_location = CHROMIUM
    for argument in ("--headless=new", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage", "--lang=en-US",
                     f"--user-data-dir={WORK / 'profile'}"):
        options.add_argument(argument)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
    return webdriver.Chrome(service=Service(DRIVER), options=options)


WORK = Path(tempfile.mkdtemp(prefix="geofx-web-"))
atexit.register(shutil.rmtree, WORK, ignore_errors=True)
PAGE = make_page(WORK)
SERVER = Server(PAGE)
BROWSER = start_browser()
atexit.register(BROWSER.quit)


class OpenPage(unittest.TestCase):
    """Each test opens the page anew; afterwards nothing may have gone wrong, and nobody else may have been asked."""

    def open(self, url=None, size=WIDE, touch=False, scale=1, still=False, hash=""):
        self.url = url or SERVER.url
        self.mine = (self.url,)
        BROWSER.get("about:blank")
        command = BROWSER.execute_cdp_cmd
        command("Emulation.setDeviceMetricsOverride", {"width": size[0], "height": size[1], "deviceScaleFactor": scale, "mobile": touch})
        command("Emulation.setTouchEmulationEnabled", {"enabled": touch})
        command("Emulation.setEmulatedMedia", {"features": [{"name": "prefers-reduced-motion", "value": "reduce" if still else "no-preference"},
                                                            {"name": "hover", "value": "none" if touch else "hover"}]})
        BROWSER.get_log("browser"), BROWSER.get_log("performance")
        BROWSER.get(self.url + ("index.html" if self.url.startswith("file:") else "") + hash)
        self.wait(lambda: self.js("return document.documentElement.dataset.ready"))

    def tearDown(self):
        faults = [entry for entry in BROWSER.get_log("browser") if entry["level"] in ("SEVERE", "WARNING")]
        self.assertEqual(faults, [])
        asked = 0
        for entry in BROWSER.get_log("performance"):
            message = json.loads(entry["message"])["message"]
            if message["method"] != "Network.requestWillBeSent":
                continue
            address = message["params"]["request"]["url"]
            if not address.startswith(("data:", "about:")):
                self.assertTrue(address.startswith(self.mine), f"{address} is not below {self.mine}")
                asked += 1
        self.assertGreater(asked, 8, "the log of requests must have the page's own")

    def js(self, script, *arguments):
        return BROWSER.execute_script(script, *arguments)

    def wait(self, condition, seconds=20):
        return WebDriverWait(BROWSER, seconds, poll_frequency=0.05).until(lambda _: condition())

    def find(self, selector):
        return BROWSER.find_element(By.CSS_SELECTOR, selector)

    def active(self):
        return BROWSER.switch_to.active_element

    def press(self, *keys):
        for key in keys:
            self.active().send_keys(key)

    def settle(self):
        """Waits until the map stands still."""
        def place():
            return self.js("const m = geofx.map, c = m.getCenter(); return [m.getZoom(), c.lat, c.lng, m._animatingZoom || false]")
        last = None
        end = time.monotonic() + 20
        while time.monotonic() < end:
            now = place()
            if now == last and not now[3]:
                return now
            last = now
            time.sleep(0.12)
        self.fail("the map does not stand still")

    def names(self):
        return [each.text for each in BROWSER.find_elements(By.CSS_SELECTOR, ".name .text, .name text")]

    def data_of(self, text):
        return self.js("return geofx.data.names.names.find((name) => name.text === arguments[0])", text)

    def shoot(self, name):
        if SCREENSHOTS:
            SCREENSHOTS.mkdir(parents=True, exist_ok=True)
            picture = BROWSER.execute_cdp_cmd("Page.captureScreenshot", {"format": "png"})
            (SCREENSHOTS / f"{name}.png").write_bytes(base64.b64decode(picture["data"]))

    def tap(self, x, y):
        for kind, points in (("touchStart", [{"x": x, "y": y}]), ("touchEnd", [])):
            BROWSER.execute_cdp_cmd("Input.dispatchTouchEvent", {"type": kind, "touchPoints": points})

    def assert_tells_summit(self):
        """The popup of the summit: as the names' file says."""
        popup = self.wait(lambda: self.find(".leaflet-popup .about"))
        self.wait(lambda: popup.find_element(By.TAG_NAME, "h2").text)  # it fades in
        self.assertEqual(popup.find_element(By.TAG_NAME, "h2").text, "Pūʻoko")
        self.assertEqual(popup.find_element(By.CSS_SELECTOR, ".up").text.replace("\u00a0", " "), "2,718 m")
        latitude, longitude = self.numbers(popup.find_element(By.CSS_SELECTOR, ".coordinates").text)
        # A name is put on the summit that it means, up to 250 m away.
        self.assertAlmostEqual(longitude, WEST + SIDE * 0.53, delta=0.003)
        self.assertAlmostEqual(latitude, SOUTH + SIDE * 0.56, delta=0.003)
        return popup

    def numbers(self, text):
        """Latitude and longitude of a text such as 39.2640° S, 174.1180° E."""
        parts = text.replace("\u00a0", " ").split("·")[0].split(",")
        value = [float(part.split("°")[0]) * (-1 if part.strip()[-1] in "SW" else 1) for part in parts]
        self.assertEqual(len(value), 2, text)
        return value


def decode(data):
    """The samples of data/places.js: None for the sky, or steps of degrees and metres."""
    alphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_"
    values, text, at, last = [], data["samples"], 0, [0, 0, 0]

    def number():
        nonlocal at
        value = shift = 0
        while True:
            digit = alphabet.index(text[at])
            at += 1
            value |= (digit & 31) << shift
            shift += 5
            if digit < 32:
                return value

    columns = data["columns"]
    while len(values) < columns * data["rows"]:
        if text[at] == ".":
            at += 1
            values += [None] * number()
            continue
        i = len(values)
        left = values[i - 1] if i % columns else None
        upper = values[i - columns] if i >= columns else None
        corner = values[i - columns - 1] if i % columns and i >= columns else None
        for k in range(3):
            coded = number()
            expected = left[k] + upper[k] - corner[k] if left and upper and corner else left[k] if left else upper[k] if upper else last[k]
            last[k] = expected + (-(coded >> 1) - 1 if coded & 1 else coded >> 1)
        values.append(list(last))
    return values
