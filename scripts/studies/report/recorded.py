"""What a run recorded for its page, the film and the rays, and the page's data for its script."""
import base64
import csv
import json
import zlib

from studies.report.maps import VIRIDIS

MOST_RAYS = 300_000  # some 12 MB of page
FILM_NAMES = {
    "loads": "load messages in buffers", "voxels": "voxels", "rays": "rays in buffers and registers",
    "answers": "answers in buffers", "slots": "ray store slots in use", "pixels_done": "pixels done"}
NUMBERS = ("generation", "home_x", "home_y", "end_x", "end_y", "launched", "hops", "answer_hops", "waited",
           "postponed")


def read_film(path, width, height):
    """The film of an array of this size. Raises ValueError for any other file."""
    film = json.loads(path.read_text())
    keys = ("cells_per_block", "columns", "rows", "cycles", "phases", "layers")
    if not isinstance(film, dict) or any(k not in film for k in keys):
        raise ValueError("expected the keys " + ", ".join(keys))
    n = film["cells_per_block"]
    if (film["columns"], film["rows"]) != (-(-width // n), -(-height // n)):
        raise ValueError(f"{film['columns']} x {film['rows']} blocks of {n} cells, not of {width} x {height} cells")
    return film


def read_rays(path, width, most=MOST_RAYS):
    """The rays of the pixels' trees as columns, parents as row numbers; and the number of pixels whose trees are
    in it if there are more than `most` rays, else None. Raises ValueError for any other file."""
    with open(path, newline="") as stream:
        rows = [r for r in csv.DictReader(stream) if r.get("kind") != "precast"]
    if rows and not {"ray", "parent", "kind", "end", "ended", *NUMBERS} <= rows[0].keys():
        raise ValueError("expected the columns ray, parent, kind, ...")
    pixels = [int(r["ray"].split("/")[0].split(".")[0]) for r in rows]  # pixel/branch or pixel.sample/branch
    limit = None
    if len(rows) > most:
        limit = sorted(pixels)[most]
        kept = [i for i, p in enumerate(pixels) if p < limit]
        rows, pixels = [rows[i] for i in kept], [pixels[i] for i in kept]
    row_of = {r["ray"]: i for i, r in enumerate(rows)}
    columns = {name: [int(r[name]) for r in rows] for name in NUMBERS}
    columns.update(ray=[r["ray"] for r in rows], kind=[r["kind"] for r in rows], end=[r["end"] for r in rows],
                   parent=[row_of.get(r["parent"], -1) for r in rows], pixel=pixels,
                   ended=[int(r["ended"] or -1) for r in rows])
    return columns, limit


FILM = """<section id="film" hidden><h2>Over time</h2><p>Where load messages, voxels, rays, answers and slots are{blocks};
a scale of square roots. The dashed line in the charts is the same moment.</p>
<div class="control"><button id="film-play">Play</button><input type="range" id="film-time" min="0" value="0"
aria-label="time"><output id="film-now"></output></div><div class="maps" id="film-maps" data-shape="{shape}"></div></section>"""
RAYS = """<section id="rays" hidden><h2>The rays of a pixel</h2><p>Click into the picture or a map. Each ray with the cell
that sent it and the one in which it ended, its cycles until its answer was home, its hops and those of the answer,
the cycles that both waited. Lines in the picture lead from the one cell to the other.{limit}</p>
<div class="control"><label>x <input type="number" id="ray-x" min="0" max="{x}"></label>
<label>y <input type="number" id="ray-y" min="0" max="{y}"></label></div><div class="scroll" id="ray-tree"></div></section>"""


def film_part(film, shape):
    if not film:
        return ""
    n = film["cells_per_block"]
    return FILM.format(blocks=f", in blocks of {n} × {n} cells" if n > 1 else "", shape=shape)


def rays_part(rays, limit, width, height):
    if not rays:
        return ""
    told = f" This page has the rays of the first {limit} pixels alone, row by row." if limit is not None else ""
    return RAYS.format(limit=told, x=width - 1, y=height - 1)


def embedded(data):
    """The data as the element that the page's script reads."""
    data = dict(data, film_names=FILM_NAMES, palette=["#" + c for c in VIRIDIS])
    packed = base64.b64encode(zlib.compress(json.dumps(data, separators=(",", ":")).encode(), 9)).decode()
    return f'<script type="text/plain" id="data">{packed}</script>'
