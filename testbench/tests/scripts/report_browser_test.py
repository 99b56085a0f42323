#!/usr/bin/python3
"""usage: report_browser_test.py REPORT_SCRIPT RAYCELL SCENES FOLDER

Opens pages of runs in a browser without a screen and does what a reader does: moves the slider, points at maps, clicks into
the picture. What the page says is compared with the run's files, read here; the browser's console must be empty.
"""
import csv
import json
import pathlib
import shutil
import subprocess
import sys

CELLS = 24
try:
    import matplotlib.image
    from selenium import webdriver
    from selenium.common.exceptions import WebDriverException
    from selenium.webdriver.chrome.service import Service
    from selenium.webdriver.common.action_chains import ActionChains
    from selenium.webdriver.common.by import By
    from selenium.webdriver.common.keys import Keys
    from selenium.webdriver.support.ui import WebDriverWait
except ImportError as error:
    sys.exit(f"skipped: missing software: {error}")


def browser():
    if not shutil.which("chromedriver") or not shutil.which("chromium"):
        sys.exit("skipped: missing software: chromium and chromium-driver")
    options = webdriver.ChromeOptions()
    # Containers run tests as root and have little shared memory.
    for word in ("--headless=new", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage", "--window-size=1250,1400"):
        options.add_argument(word)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
    try:
        driver = webdriver.Chrome(service=Service(shutil.which("chromedriver")), options=options)
    except WebDriverException as error:
        sys.exit(f"skipped: missing software: chromium does not start here: {str(error).splitlines()[0]}")
    driver.set_page_load_timeout(300)
    return driver


def expect(what, found, wanted):
    assert found == wanted, f"{what}: {found!r}; expected {wanted!r}"
    print(f"ok: {what}: {wanted!r}")


class Page:
    def __init__(self, driver, path, view=""):
        self.driver = driver
        driver.get("about:blank")
        driver.get(path.resolve().as_uri() + view)
        WebDriverWait(driver, 300).until(lambda d: d.execute_script("return document.body.dataset.ready") == "yes")

    def find(self, selector):
        return self.driver.find_element(By.CSS_SELECTOR, selector)

    def point(self, selector, column, row, columns=CELLS, rows=CELLS, click=False):
        """Moves the pointer to the middle of a block; returns the value beside it."""
        element = self.find(selector)
        self.driver.execute_script("arguments[0].scrollIntoView({block: 'center'})", element)
        width, height = element.size["width"], element.size["height"]
        actions = ActionChains(self.driver).move_to_element_with_offset(
            element, round((column + 0.5) / columns * width - width / 2),
            round((row + 0.5) / rows * height - height / 2))
        (actions.click() if click else actions).perform()
        return self.find("#tip").text

    def no_word_on_the_console(self):
        expect("the console", self.driver.get_log("browser"), [])


def layer_at(film, name, frame):
    """A film's map, added up from its changes."""
    values = [0] * (film["columns"] * film["rows"])
    for changes in film["layers"][name][:frame + 1]:
        for at, value in zip(changes[::2], changes[1::2]):
            values[at] = value
    return values


def check_film(page, film):
    slider = page.find("#film-time")
    page.driver.execute_script("arguments[0].focus()", slider)
    slider.send_keys(Keys.HOME)
    expect("the slider's beginning", page.find("#film-now").text, f"cycle {film['cycles'][0]}, load")
    for key, steps in ((Keys.ARROW_RIGHT, 12), (Keys.END, 1), (Keys.ARROW_LEFT, 5)):
        for _ in range(steps):
            slider.send_keys(key)
        frame = int(slider.get_attribute("value"))
        for name in ("voxels", "rays", "slots", "pixels_done"):
            values = layer_at(film, name, frame)
            expect(f"frame {frame}, {name} in all",
                   page.find(f"canvas[data-layer={name}] + p").text.replace("\u202f", ""), f"{sum(values)} in all")
            at = max(range(len(values)), key=values.__getitem__)
            place = at % film["columns"], at // film["columns"]
            expect(f"frame {frame}, {name} at its fullest", page.point(f"canvas[data-layer={name}]", *place),
                   f"({place[0]}, {place[1]}): {values[at]}")
        cursor = page.find("svg[data-start] .cursor")
        expect("the moment is in the charts", cursor.get_attribute("x1") is not None, True)
    drawn = "return arguments[0].toDataURL()"
    canvas = page.find("canvas[data-layer=voxels]")
    before = page.driver.execute_script(drawn, canvas)
    slider.send_keys(Keys.HOME)
    expect("the slider moves the map", page.driver.execute_script(drawn, canvas) != before, True)


def check_rays(page, rays, pixel):
    x, y = pixel
    mine = [r for r in rays if r["ray"].startswith(f"{y * CELLS + x}/")]
    page.point("#picture", x, y, click=True)
    lines = page.driver.find_elements(By.CSS_SELECTOR, "#ray-tree tbody tr")
    expect("rays of the pixel", sorted(l.get_attribute("title") for l in lines), sorted("ray " + r["ray"] for r in mine))
    by_name = {"ray " + r["ray"]: r for r in mine}
    for line in lines:
        row = by_name[line.get_attribute("title")]
        cells = [c.text.replace("\u202f", "") for c in line.find_elements(By.CSS_SELECTOR, "td")]
        expect(f"ray {row['ray']}", cells,
               [row["kind"], f"({row['home_x']}, {row['home_y']})", f"{row['end']} ({row['end_x']}, {row['end_y']})",
                f"{row['launched']} – {row['ended']}", str(int(row["ended"]) - int(row["launched"])), row["hops"],
                row["answer_hops"], row["waited"], row["postponed"]])
    indents = {line.get_attribute("title"): line.find_element(By.CSS_SELECTOR, ".kind").value_of_css_property("margin-left")
               for line in lines}
    child = next(r for r in mine if r["parent"] in {p["ray"] for p in mine})
    expect("a child is indented under its parent",
           float(indents["ray " + child["ray"]][:-2]) > float(indents["ray " + child["parent"]][:-2]), True)


def check_maps(page, cells):
    for column in ("voxels", "stall_cycles", "ray_store_peak"):
        values = [int(c[column]) for c in cells]
        at = max(range(len(values)), key=values.__getitem__)
        told = page.point(f"img[data-map={column}]", at % CELLS, at // CELLS).replace("\u202f", "")
        expect(f"{column} under the pointer", told, f"({at % CELLS}, {at // CELLS}): {values[at]}")


def check_pair(page, folder):
    a, b = (matplotlib.image.imread(folder / f"{name}.png") for name in ("a", "b"))
    differing = int((abs(a - b) > 1e-6).any(axis=2).sum())
    most = round(float(abs(a - b).max()) * 255)
    expect("the pictures' difference", page.find("#difference-words").text,
           f"{differing} of {CELLS * CELLS} pixels differ, by up to {most} of 255; shown four times as large")
    table = page.find("table").text
    expect("the option that differs", "--word-bits 20 12" in table, True)


def main(script, raycell, scenes, folder):
    folder = pathlib.Path(folder)
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    size = ["--cells", f"{CELLS}x{CELLS}", "--quiet"]
    scene = pathlib.Path(scenes) / "still_life.nff"
    subprocess.run([raycell, "render", scene, *size, "--film", "60", "--rays", "--truth", "-o", folder / "a"], check=True)
    subprocess.run([raycell, "render", scene, *size, "--word-bits", "12", "-o", folder / "b"], check=True)
    subprocess.run([script, "report", folder / "a.json"], check=True)
    subprocess.run([script, "report", folder / "a.json", folder / "b.json"], check=True)
    film = json.loads((folder / "a.film.json").read_text())
    with open(folder / "a.rays.csv", newline="") as stream:
        rays = list(csv.DictReader(stream))
    with open(folder / "a.cells.csv", newline="") as stream:
        cells = list(csv.DictReader(stream))
    reflected = next(r for r in rays if r["kind"] == "reflected" and int(r["hops"]) > 0)
    pixel = int(reflected["ray"].split("/")[0])
    place = pixel % CELLS, pixel // CELLS
    driver = browser()
    try:
        page = Page(driver, folder / "a.html")
        check_film(page, film)
        check_rays(page, rays, place)
        check_maps(page, cells)
        expect("the view is in the address", f"pixel={place[0]},{place[1]}" in driver.current_url, True)
        page.no_word_on_the_console()
        page = Page(driver, folder / "a.html", f"#frame=7&pixel={place[0]},{place[1]}")
        expect("an address opens its frame", page.find("#film-time").get_attribute("value"), "7")
        expect("an address opens its pixel", page.find("#ray-x").get_attribute("value"), str(place[0]))
        page.no_word_on_the_console()
        page = Page(driver, folder / "a.and.b.html")
        check_pair(page, folder)
        page.no_word_on_the_console()
    finally:
        driver.quit()


main(*sys.argv[1:])
