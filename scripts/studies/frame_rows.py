"""Rows of frames for the study of stability: a viewer who walks round a scene."""
import json
import math
import pathlib
import tempfile

from studies import programs

SCENES = ("still_life", "cornell", "facing_mirrors")
CELLS = "32x32"
DEGREES = (-25, -15, -5, 5, 15, 25)


def view_of(scene):
    """`from` and `at` of an NFF file."""
    words = scene.read_text().split("\nv\n", 1)[1].split()
    def point(name):
        at = words.index(name) + 1
        return [float(word) for word in words[at:at + 3]]
    return point("from"), point("at")


def walk(scene):
    """The viewer, turned about the vertical through the point that is looked at: a line of the list for each step."""
    start, middle = view_of(scene)
    x, z = start[0] - middle[0], start[2] - middle[2]
    lines = []
    for degrees in DEGREES:
        c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
        lines.append(f"from {middle[0] + c * x + s * z:.6f} {start[1]} {middle[2] + c * z - s * x:.6f}")
    return lines


def row(program, scene, lines):
    """The report of a row of frames, whatever its verdict."""
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        (folder / "walk.frames").write_text("\n".join(lines) + "\n")
        programs.run(program, "render", scene, "--frames", folder / "walk.frames", "--cells", CELLS, "--truth", "--quiet",
                     "-o", folder / "row")
        return json.loads((folder / "row.json").read_text())["frames"]


def span(values, digits=0):
    low, high = min(values), max(values)
    return f"{low:,.{digits}f}" if low == high else f"{low:,.{digits}f} to {high:,.{digits}f}"


def line(program, scene):
    """A line of the table; how many frames are the same in the reversed row, and of how many."""
    frames = row(program, scene, walk(scene))
    back = row(program, scene, walk(scene)[::-1])
    each, schedule = frames["each"], frames["schedule"]
    same = sum(a["hash"] == b["hash"] for a, b in zip(each, back["each"][::-1]))
    cells = [scene.stem, ", ".join(sorted({f["verdict"] for f in each})),
             span([f["cycles"]["load"] for f in each]), span([f["cycles"]["precast"] + f["cycles"]["trace"] for f in each]),
             f"{schedule['cycles_per_frame']:,.0f}", schedule["binds"], f"{schedule['one_store']['cycles_per_frame']:,.0f}",
             span([f["accuracy"]["psnr_db"] for f in each], 1), span([f["voxels"]["max_bits_per_cell"] for f in each]),
             f"{same} of {len(each)}"]
    return "| " + " | ".join(cells) + " |", same, len(each)


def text(root, program):
    """The section of the document. Throws programs.Failed for a row that does not complete."""
    head = ["scene", "verdicts", "cycles, load", "cycles, trace", "cycles a frame in a row", "bound by", "with one store",
            "PSNR, dB", "bits of the fullest cell", "frames unchanged in the reversed row"]
    rows, same, count = zip(*(line(program, root / "scenes" / f"{scene}.nff") for scene in SCENES))
    return "\n".join([
        "", "## frames in a row", "",
        f"the viewer walks round the scene, {len(DEGREES)} frames from {DEGREES[0]} to {DEGREES[-1]} degrees, {CELLS} cells "
        "(`raycell render --frames`).",
        "", "| " + " | ".join(head) + " |", "|" + "---|" * len(head), *rows, "",
        f"Boundary: every frame completes; {sum(same)} of {sum(count)} have the same picture and schedule in the reversed row",
        "Treatment: documented: a frame is loaded into a store of its own, so none sees another; the store must fit the "
        "fullest cell of all frames", ""])
