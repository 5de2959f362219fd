#!/usr/bin/python3
"""The pages of `firn profile` and `firn compare` in headless Chromium: what is there, and what a click does.

pages.py FIRN [FOLDER]: FIRN is the built program; pictures of the pages stay in FOLDER where that is given.
Needs Debian's chromium, chromium-driver and python3-selenium.
"""

import pathlib
import subprocess
import sys
import tempfile
import unittest

from selenium import webdriver
from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.by import By

FIRN, FOLDER = None, None
PASSES = 14  # of a step of mpm_snow

SCENE = """firn: 1
name: small
seed: 3
time: {dt: 2.0e-4, fps: 1000, end: 0.01}
domain: {min: [0, 0, 0], max: [0.8, 0.9, 1.0], cell: 0.05}
materials: {ball: {preset: packed, young: 1.0e5}}
snow: [{sphere: {center: [0.4, 0.45, 0.5], radius: 0.12}, material: ball, velocity: [0, -3, 0], per_cell: 4}]
bodies: [{plane: {point: [0, 0.3, 0], normal: [0, 1, 0]}, friction: 0.5}]
camera: {from: [1.4, 0.9, 1.8], to: [0.4, 0.4, 0.5], fov: 40}
"""


def firn(*words):
    subprocess.run([FIRN, "-q", *words], check=True, stdout=subprocess.DEVNULL)


class Pages(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        scene = FOLDER / "scene.yaml"
        scene.write_text(SCENE)
        firn("profile", "mpm_snow", "--scene", scene, "--steps", "40", "--cost", "--format", "html", "--out", FOLDER / "profile.html")
        firn("compare", "mpm_thesis", "mpm_snow", "--scene", scene, "--steps", "10", "--image", "480x270", "--out", FOLDER / "compare")
        options = webdriver.ChromeOptions()
        options.binary_location = "/usr/bin/chromium"
        for word in ("--headless=new", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage", "--hide-scrollbars", "--window-size=1280,1700"):
            options.add_argument(word)
        options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
        cls.browser = webdriver.Chrome(options=options, service=webdriver.chrome.service.Service("/usr/bin/chromedriver"))

    @classmethod
    def tearDownClass(cls):
        cls.browser.quit()

    def open(self, page):
        self.browser.get(page.as_uri())

    def all(self, selector):
        return self.browser.find_elements(By.CSS_SELECTOR, selector)

    def one(self, selector):
        return self.browser.find_element(By.CSS_SELECTOR, selector)

    def keep(self, name):
        self.browser.save_screenshot(str(FOLDER / name))

    def tearDown(self):
        told = [entry for entry in self.browser.get_log("browser") if entry["level"] == "SEVERE"]
        self.assertEqual(told, [], "the page's script failed")

    def column(self, number):
        return [row.find_elements(By.TAG_NAME, "td")[number].text for row in self.all("#passes tbody tr")]

    def test_profile_shows_steps_and_passes(self):
        self.open(FOLDER / "profile.html")
        self.assertEqual(self.one("h1").text, "mpm_snow on small")
        self.assertEqual(len(self.all("#passes tbody tr")), PASSES)
        self.assertGreaterEqual(len(self.all("#steps .bar")), 40 * PASSES)
        self.assertEqual(len(self.all("#step .bar")), PASSES)
        # Nothing is wider than the page.
        self.assertLessEqual(self.browser.execute_script("return document.documentElement.scrollWidth"), 1280)
        self.keep("profile.png")

    def test_a_click_on_a_pass_tells_about_it(self):
        self.open(FOLDER / "profile.html")
        row = next(row for row in self.all("#passes tbody tr") if "advect" in row.text)
        row.click()
        self.assertIn("mpm.advect", self.one("#details h3").text)
        self.assertIn("position", self.one("#details table").text)
        self.assertEqual(len(self.all("#history rect")), 40)
        self.assertEqual([row.text.split()[0] for row in self.all("#passes tr.chosen")], ["mpm.advect"])
        self.browser.execute_script("document.getElementById('details').scrollIntoView()")
        self.keep("profile_pass.png")

    def test_columns_sort(self):
        self.open(FOLDER / "profile.html")
        names = self.column(0)
        share = next(head for head in self.all("#passes th") if head.text == "share")
        share.click()
        falling = [float(text.split()[0]) for text in self.column(5)]
        self.assertEqual(falling, sorted(falling, reverse=True))
        next(head for head in self.all("#passes th") if head.text.startswith("share")).click()
        self.assertEqual([float(text.split()[0]) for text in self.column(5)], sorted(falling))
        self.assertEqual(sorted(self.column(0)), sorted(names))

    def test_a_bar_tells_its_pass_and_its_step_opens(self):
        self.open(FOLDER / "profile.html")
        # The largest part of step 30.
        bar = max(self.all("#steps .bar")[30 * PASSES:31 * PASSES], key=lambda bar: float(bar.get_attribute("height")))
        ActionChains(self.browser).move_to_element(bar).perform()
        self.assertIn("in step 30", self.one("#tip").text)
        self.assertGreater(len(self.all("#steps .dim")), 0)
        self.keep("profile_hover.png")
        bar.click()
        self.assertTrue(self.one("#step-title").text.startswith("Step 30 over time"))

    def test_compare_shows_times_pictures_and_differences(self):
        self.open(FOLDER / "compare" / "index.html")
        self.assertEqual(len(self.all("h1 span")), 2)
        for picture in self.all("img"):
            self.assertEqual(self.browser.execute_script("return arguments[0].naturalWidth", picture), 480)
        # A picture of the difference where there is any.
        same = "The two pictures are the same." in self.one("body").text
        self.assertEqual(len(self.all("img")), 2 if same else 3)
        self.assertEqual(len(self.all("table")), 2)
        self.assertIn("position", self.all("table")[1].text)
        self.assertLessEqual(self.browser.execute_script("return document.documentElement.scrollWidth"), 1280)
        self.keep("compare.png")
        self.browser.execute_script("document.querySelector('table').scrollIntoView()")
        self.keep("compare_table.png")


if __name__ == "__main__":
    FIRN = str(pathlib.Path(sys.argv[1]).resolve())
    with tempfile.TemporaryDirectory() as folder:
        FOLDER = pathlib.Path(sys.argv[2] if len(sys.argv) > 2 else folder).resolve()
        FOLDER.mkdir(parents=True, exist_ok=True)
        unittest.main(argv=sys.argv[:1], verbosity=2)
