"""Writes docs/measured/accuracy.md: all its tables are made from the rows of accuracy.csv."""
from studies.accuracy.design import (OPERATOR_SCENES, OWN_SCENES, RUNGS, SHADOWS, SIZES_AT_20_BITS, Configuration,
                                   operator_variants)
from studies.accuracy.rows import fewest_bits, name_of, pareto
from studies.tables import NOTHING, count, table

PAPER_VOXEL_BITS = 40 * 8
PAPER_CELL_BITS = 5 * 1024 * 8


def decibel(row):
    return f"{row.psnr_total_db:.1f}" if row else NOTHING


def fewest_table(results):
    head = ["scene"] + [f"`{hit}`, {least} dB" for hit in ["edge", "mask"] for least in [40, 35, 30]]
    lines = []
    for scene in results.word_scenes:
        line = [scene]
        for hit in ["edge", "mask"]:
            rows = results.word_lengths(scene, results.full_cells, hit)
            for least in [40, 35, 30]:
                fewest = fewest_bits(rows, least)
                best = max((row.psnr_total_db for row in rows), default=0)
                line.append(fewest or (f"none (at most {best:.1f})" if rows else NOTHING))
        lines.append(line)
    return table(head, lines)


def lengths_run(results):
    lengths = sorted({c.word_bits for c in results.rows if c.cells == results.full_cells and c.hit == "mask"
                      and c.arithmetic == "fixed"})
    whole = lengths == list(range(8, 33))
    return "every one from 8 to 32" if whole else ", ".join(str(bits) for bits in lengths)


def words_table(results, hit):
    lines = [[bits] + [decibel(results.at(s, results.full_cells, hit, word_bits=bits)) for s in results.word_scenes]
             for bits in range(8, 33)]
    lines.append(["`exact`"] + [decibel(results.at(s, results.full_cells, hit, arithmetic="exact"))
                                for s in results.word_scenes])
    return table(["word bits", *results.word_scenes], lines)


def split_table(results):
    lines = []
    for hit in RUNGS:
        for bits in [12, 16, 20, 32]:
            line = [f"`{hit}`, {bits} bits"]
            for scene in results.scenes:
                row = results.at(scene, results.full_cells, hit, word_bits=bits)
                line.append(f"{row.psnr_discretisation_db:.1f}, {row.psnr_arithmetic_db:.1f}, {row.psnr_total_db:.1f}"
                            if row else NOTHING)
            lines.append(line)
    return table(["discretisation, arithmetic, total", *results.scenes], lines)


def front_table(results):
    lines = []
    for scene in results.scenes:
        for row in pareto(results.front_points(scene)):
            lines.append([scene, name_of(row.configuration), count(row.picture_cycles), f"{row.psnr_total_db:.1f}",
                          f"{row.wrong_hit_percent:.2f}", f"{row.bits_per_voxel:.0f}", count(row.fullest_cell_bits),
                          f"{row.ray_bits:.0f}"])
    return table(["scene", "hit/word bits/shadows", "cycles", "dB", "wrong first hits, %", "bits per voxel",
                  "bits of the fullest cell", "bits of a ray"], lines)


def machine_table(results, cells):
    """Cycles and dB of hit tests and shadow modes at the default word length, for one array size."""
    lines = []
    for hit in RUNGS:
        for shadows in SHADOWS:
            line = [f"`{hit}`, `{shadows}`"]
            for scene in results.scenes:
                row = results.at(scene, cells, hit, shadows=shadows)
                line.append(f"{count(row.picture_cycles)}; {decibel(row)}" if row and row.timed else NOTHING)
            if set(line[1:]) != {NOTHING}:
                lines.append(line)
    return table([f"cycles; dB, {cells}x{cells}", *results.scenes], lines)


def load_table(results):
    """Load cycles of all timed runs of a word length and size; a range where they depend on other factors."""
    timed = [row for row in results.rows.values() if row.timed]
    lines = []
    for cells in results.sizes:
        for bits in sorted({row.configuration.word_bits for row in timed if row.configuration.cells == cells}):
            line = [f"{cells}x{cells}, {bits} bits"]
            for scene in results.scenes:
                loads = {row.load_cycles for row in timed if row.configuration.scene == scene
                         and row.configuration.cells == cells and row.configuration.word_bits == bits}
                line.append(" to ".join(count(value) for value in sorted({min(loads), max(loads)}))
                            if loads else NOTHING)
            lines.append(line)
    return table(["load cycles", *results.scenes], lines)


def normals_table(results):
    lines = []
    for hit in RUNGS:
        for normals in ["linear", "voxel"]:
            line = [f"`{hit}`, `{normals}`"]
            for scene in results.scenes:
                rows = [results.at(scene, results.front_cells, hit, normals, shadows) for shadows in SHADOWS]
                line.append(" / ".join(decibel(row) for row in rows) if any(rows) else NOTHING)
            lines.append(line)
    return table([f"dB at {' / '.join(SHADOWS)}", *results.scenes], lines)


def variant_name(variant):
    """What differs from the default; operators come with the size of their tables."""
    changed = [name for name, _ in variant.operators()]
    if not changed:
        return "default: reciprocal `newton` (64), root `newton` (64), power `tables` (32)"
    operator = changed[0].removesuffix("_table")
    if operator == "rounding":
        return f"rounding `{variant.rounding}`"
    method = getattr(variant, operator)
    entries = getattr(variant, operator + "_table") or SIZES_AT_20_BITS[operator]
    size = f" ({entries})" if method in ("newton", "table", "tables") else ""
    return f"{operator} `{method}`{size}"


def operators_table(results):
    lines = []
    scenes = [scene for scene in results.scenes if scene in (*OPERATOR_SCENES, *OWN_SCENES)]
    for variant in dict.fromkeys(operator_variants("", results.front_cells)):
        line = [variant_name(variant)]
        for scene in scenes:
            base = results.at(scene, results.front_cells)
            row = results.rows.get(Configuration(scene, results.front_cells, **dict(variant.operators())))
            if not row or not row.timed or not base:
                line.append(NOTHING)
            elif row is base:
                line.append(f"{decibel(row)}; {count(row.picture_cycles)}")
            else:
                change = 100 * (row.picture_cycles / base.picture_cycles - 1)
                line.append(f"{decibel(row)}; {change:+.1f} %")
        lines.append(line)
    return table(["dB; cycles", *scenes], lines) if len(lines) > 1 else ""


def depth_table(results):
    levels = sorted({c.depth for c in results.rows})
    lines = []
    for hit in RUNGS:
        for depth in levels:
            line = [f"`{hit}`, {depth}"]
            for scene in results.scenes:
                row = results.at(scene, results.front_cells, hit, depth=depth)
                line.append(f"{decibel(row)}; {count(row.fullest_cell_bits)}" if row else NOTHING)
            lines.append(line)
    return table(["dB; bits of the fullest cell", *results.scenes], lines) if len(levels) > 1 else ""


def size_table(results):
    lines = []
    for hit in RUNGS:
        for cells in results.sizes:
            line = [f"`{hit}`, {cells}x{cells}"]
            for scene in results.scenes:
                row = results.at(scene, cells, hit)
                cycles = f"; {count(row.picture_cycles)}" if row and row.timed else ""
                line.append(decibel(row) + cycles)
            lines.append(line)
    return table(["dB; cycles where timed", *results.scenes], lines) if len(results.sizes) > 1 else ""


def storage_table(results):
    lines = []
    for hit in RUNGS:
        line = [f"`{hit}`"]
        for scene in results.scenes:
            row = results.at(scene, results.full_cells, hit)
            line.append(f"{row.bits_per_voxel:.0f}; {count(row.fullest_cell_bits)} in {row.fullest_cell_voxels:.0f}"
                        if row else NOTHING)
        lines.append(line)
    return table(["bits per voxel; bits of the fullest cell in voxels", *results.scenes], lines)


def sections(results):
    front, full = (f"{n}x{n} cells" for n in (results.front_cells, results.full_cells))
    return [
        ("The fewest bits that suffice",
         f"The shortest word from which on every longer one stays at or above so many dB; {full}. Word lengths run: "
         f"{lengths_run(results)}.", fewest_table(results)),
        ("dB by word bits, rung `edge`", f"{full}.", words_table(results, "edge")),
        ("dB by word bits, rung `mask`", f"{full}.", words_table(results, "mask")),
        ("Where the error comes from", f"{full}. Arithmetic is the picture in words against that of the same machine in "
         "exact arithmetic.", split_table(results)),
        ("Pareto front", f"{front}. Of hit test, word bits, shadow mode and normals, what no other run beats in both "
         "cycles and dB.", front_table(results)),
        ("Hit tests and shadow modes", "Word of 20 bits.", machine_table(results, results.front_cells)),
        ("The same in the larger array", "",
         machine_table(results, results.full_cells) if results.full_cells != results.front_cells else ""),
        ("Loading", "Not in the other tables' cycles. A range where hit test, normals, shadow mode, operators or depth "
         "levels make a difference.", load_table(results)),
        ("Hit tests, normals and shadow modes", f"dB, {front}, 20 bits.", normals_table(results)),
        ("Operators and rounding", f"{front}, rung `edge`, 20 bits; one thing changed at a time, its cycles against the "
         "default's. In brackets the entries of the table.", operators_table(results)),
        ("Depth levels", f"{front}, 20 bits.", depth_table(results)),
        ("Array size", "20 bits. The truth is rendered at the same size, so this is not the error of fewer pixels.",
         size_table(results)),
        ("Storage", f"{full}, 20 bits. The paper reckons with {PAPER_VOXEL_BITS} bits (40 bytes) a voxel and "
         f"{PAPER_CELL_BITS:,} bits (5 Kbyte) a cell.", storage_table(results)),
    ]


def document(results, command, seconds):
    timed = sum(row.timed for row in results.rows.values())
    unfinished = [row for row in results.rows.values() if row.verdict != "completed"]
    verdicts = "all with verdict `completed`" if not unfinished else \
        f"**{len(unfinished)} with another verdict than `completed`**"
    minutes = f" One after the other, they took {seconds / 60:.0f} minutes." if seconds is not None else ""
    text = f"""# Accuracy, bits and cycles

{len(results.rows)} runs, {timed} of them timed, {verdicts}; each is a row of `accuracy.csv`, from which everything here
and the charts are made.{minutes} Command: `{command}`.

- **dB** is PSNR; 200 means equal. *Total*: the machine's picture against the scene, what its polygons cost included.
  *Discretisation*: the same machine in exact arithmetic against the truth of the polygons. *Arithmetic*: the machine in words against the one in exact arithmetic.
- **Cycles** are those from the loaded array to the finished picture: precast (0 but for `--shadows precast`) and trace.
  They and the dB beside them are of the same run. Untimed runs have no cycles; their pictures are the timed ones', bit
  for bit.
- What is not named is the default: `edge`, `linear`, `per-hit`, words of 20 bits, 1024 depth levels, links of 20 bits.
"""
    for title, words, content in sections(results):
        if content:
            text += f"\n## {title}\n\n" + (f"{words}\n\n" if words else "") + content + "\n"
    return text
