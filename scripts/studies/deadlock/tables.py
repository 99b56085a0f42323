"""Writes docs/measured/deadlock.md: all its tables are made from the rows of deadlock.csv."""
from studies.deadlock.design import MODES, SAFE_NETWORKS
from studies.deadlock.rows import smallest_safe
from studies.tables import NOTHING, count, table

NONE, POSTPONE = ("none", "reserved"), ("postpone", "reserved")


def name_of(mode):
    return f"`{mode[0]}`, `{mode[1]}`"


def runs_of(results, load, keep):
    """The load's runs at its main size and limit whose configuration `keep` accepts."""
    cells, limit = results.main[load]
    return [row for row in results.rows if row.configuration.load == load and row.configuration.cells == cells
            and row.configuration.max_cycles == limit and keep(row.configuration)]


def counted(rows, quality):
    """How many rows have the quality: 'all 45', or '43 of 45' and which have not."""
    against = [row for row in rows if not quality(row)]
    if not against:
        return f"all {len(rows)}"
    shown = []
    for row in against[:6]:
        c = row.configuration
        shown.append(f"`{c.networks}` M = {c.ray_store}, buffers of {c.buffer}, seed {c.seed}: "
                     f"{row.verdict.replace('_', ' ')}")
    more = f", and {len(against) - len(shown)} more" if len(against) > len(shown) else ""
    return f"{len(rows) - len(against)} of {len(rows)}; not: {'; '.join(shown)}{more}"


def verdict_on(rows, quality):
    if not rows:
        return "not run"
    agree = all(quality(row) for row in rows)
    return ("**confirmed**: " if agree else "**refuted**: ") + counted(rows, quality)


def locks_only_below(results, load, networks):
    """Text for each buffer depth: up to which M runs without recovery lock, and from which M on all end."""
    bounds = []
    for depth in results.depths(load):
        line = results.line(load, networks, depth, NONE)
        safe = smallest_safe(line)
        locking = [m for m, group in line if not group.safe]
        if not line:
            continue
        bounds.append(f"buffers of {depth}: " + (f"locks up to M = {max(locking)}" if locking else "never locks")
                      + (f", ends from M = {safe[0]} on" if safe else ", ends at no M of the sweep"))
    return "; ".join(bounds) or "not run"


def expectations(results):
    """The design's expectations, each with the evidence of the rows."""
    lines = []
    for load in results.loads:
        for networks in ["shared", "split"]:
            rows = runs_of(results, load, lambda c, n=networks: c.networks == n and c.buffer == 1 and c.mode == NONE)
            if rows:
                lines.append([load, f"`{networks}`, buffers of 1, no recovery: locks at every M",
                              verdict_on(rows, lambda row: row.locked)])
        for networks in SAFE_NETWORKS:
            if results.line(load, networks, 1, NONE):
                lines.append([load, f"`{networks}`, no recovery: locks only below a small M",
                              locks_only_below(results, load, networks)])
            rows = runs_of(results, load, lambda c, n=networks: c.networks == n and c.mode == POSTPONE
                           and c.ray_store >= c.bound)
            if rows:
                bound = rows[0].configuration.bound
                lines.append([load, f"`{networks}`, `postpone`, `reserved`: ends at every M from {bound} on",
                              verdict_on(rows, lambda row: row.completed)])
    return table(["load", "expected", "found"], lines)


def verdict_table(results, load, mode):
    lines, stores = [], sorted({c.ray_store for c in results.groups if c.load == load})
    for networks in results.networks(load):
        for depth in results.depths(load):
            groups = [results.at(load, networks, depth, m, mode) for m in stores]
            lines.append([f"`{networks}`, buffers of {depth}"] + [g.verdicts() if g else NOTHING for g in groups])
    return table([f"{load}, {name_of(mode)}; M =", *stores], lines)


def safe_table(results):
    lines = []
    for load in results.loads:
        for networks in results.networks(load):
            for depth in results.depths(load):
                line = [f"{load}, `{networks}`, buffers of {depth}"]
                for mode in MODES:
                    runs = results.line(load, networks, depth, mode)
                    safe = smallest_safe(runs)
                    line.append(safe[0] if safe else "none" if runs else NOTHING)
                lines.append(line)
    return table(["smallest safe M", *(name_of(mode) for mode in MODES)], lines)


def cost_of(line):
    """M, bits, median cycles and median destroyed rays of the smallest safe machine on the line; None without one."""
    safe = smallest_safe(line)
    if not safe:
        return None
    m, group = safe
    first = group.rows[0]
    return [m, count(first.buffer_bits), f"{count(first.ray_store_bits)} (M x {count(first.slot_bits)})",
            count(first.register_bits), count(first.cell_bits), count(group.median(lambda row: row.cycles)),
            count(group.median(lambda row: row.destroyed))]


def cost_table(results):
    lines = []
    for load in results.loads:
        for networks in results.networks(load):
            for depth in results.depths(load):
                for mode in MODES:
                    cost = cost_of(results.line(load, networks, depth, mode))
                    if cost:
                        lines.append([load, f"`{networks}`", depth, name_of(mode), *cost])
    return table(["load", "networks", "buffers of", "recovery, slots", "smallest safe M", "buffers, bits",
                  "ray store, bits", "registers, bits", "together, bits a cell", "cycles (median)", "destroyed (median)"], lines)


def slots_table(results):
    """Free and reserved slots compared: verdicts, and cycles as a multiple of those at the largest M."""
    lines = []
    stores = sorted({c.ray_store for c in results.groups if c.slots == "free"})
    for load in results.loads:
        for networks in SAFE_NETWORKS:
            if not results.line(load, networks, 1, ("postpone", "free")):
                continue
            largest = results.line(load, networks, 1, POSTPONE)[-1][1].median(lambda row: row.cycles)
            for mode in MODES:
                line = [f"{load}, `{networks}`, {name_of(mode)}"]
                for m in stores:
                    group = results.at(load, networks, 1, m, mode)
                    if group and group.safe:
                        line.append(f"ends, {group.median(lambda row: row.cycles) / largest:.1f}x")
                    else:
                        line.append(group.verdicts() if group else NOTHING)
                lines.append(line)
    return table(["buffers of 1; M =", *stores], lines)


def size_table(results):
    load = results.loads[0]
    cells, limit = results.main[load]
    sizes = sorted({c.cells for c in results.groups if c.load == load and c.max_cycles == limit})
    if len(sizes) < 2:
        return ""
    some = [c for c in results.groups if c.load == load and c.cells == sizes[0] and c.max_cycles == limit]
    stores, lines = sorted({c.ray_store for c in some}), []
    for networks in dict.fromkeys(c.networks for c in some):
        for mode in [NONE, POSTPONE]:
            for size in sizes:
                line = [f"`{networks}`, {name_of(mode)}, {size}x{size}"]
                for m in stores:
                    group = results.at(load, networks, 1, m, mode, (size, limit))
                    cycles = f"; {count(group.median(lambda row: row.cycles))}" if group and group.safe else ""
                    line.append(group.verdicts() + cycles if group else NOTHING)
                lines.append(line)
    return table(["buffers of 1; verdicts, median cycles; M =", *stores], lines)


def full_table(results):
    """Runs without a limit of cycles."""
    lines = []
    for c, group in results.groups.items():
        if c.max_cycles == 0:
            share = group.median(lambda row: row.completed_share)
            lines.append([f"`{c.networks}`, {c.cells}x{c.cells}", c.ray_store, group.verdicts(), f"{100 * share:.0f} %",
                          count(group.median(lambda row: row.cycles)),
                          count(group.median(lambda row: row.destroyed))])
    return table(["networks, cells", "M", "verdict", "pixels completed", "cycles", "destroyed"], lines)


def occupancy_table(results, load):
    lines = []
    for networks in results.networks(load):
        for mode in [NONE, POSTPONE]:
            for m, group in results.line(load, networks, 1, mode):
                rays = group.median(lambda row: row.buffer_use("ray")[1])
                answers = group.median(lambda row: row.buffer_use("answer")[1])
                lines.append([f"`{networks}`, {name_of(mode)}", m,
                              f"{100 * group.median(lambda row: row.completed_share):.0f} %",
                              count(group.median(lambda row: row.cycles)),
                              count(group.median(lambda row: row.destroyed)),
                              count(max(row.ray_store_peak for row in group.rows)),
                              f"{group.median(lambda row: row.ray_store_mean):.3f}", f"{rays:.4f}", f"{answers:.4f}"])
    return table([f"{load}, buffers of 1", "M", "pixels completed", "cycles", "destroyed", "ray store, peak",
                  "ray store, mean", "ray buffer, mean", "answer buffer, mean"], lines)


def knots(results):
    locked = [row for row in results.rows if row.verdict == "deadlock"]
    known = [row for row in results.rows if row.knot_cells is not None]
    if not known:
        return ""
    cells = sorted(row.knot_cells for row in known)
    proved = sum(row.knot_cells is not None for row in locked)
    return (f" {proved} of the {len(locked)} deadlocks, and {len(known) - proved} of the runs that were cut off, come "
            f"with a knot of {cells[0]:.0f} to {cells[-1]:.0f} cells (median {cells[len(cells) // 2]:.0f}), each accepted "
            f"by a search of its own over the dumped graph (`scripts/studies/deadlock/check_knots.py`).")


def pictures(results):
    """Whether all completed runs of a load, size and, for synthetic traffic, seed have one picture."""
    hashes = {}
    for row in results.rows:
        c = row.configuration
        if row.completed:
            hashes.setdefault((c.load, c.cells, c.seed if c.synthetic else 0), set()).add(row.image_hash)
    odd = [key for key, found in hashes.items() if len(found) > 1]
    if odd:
        return f"**Pictures differ** within (load, cells, seed) = {odd}."
    return f"The completed runs of a load, size and traffic have one picture, bit for bit ({len(hashes)} pictures)."


def sections(results):
    sizes = ", ".join(f"{load} {cells}x{cells} cells and {limit:,} cycles at most"
                      for load, (cells, limit) in results.main.items())
    parts = [("What was expected and what was found", f"{sizes}.", expectations(results)),
             ("Smallest safe M", "The smallest M from which on every run of every seed completes, at every larger M of "
              "the sweep too.", safe_table(results)),
             ("What the smallest safe machine costs", "A cell with four neighbours, bits by the layouts in "
              "`docs/reference/cell.md`; cycles from the loaded array to the finished picture.", cost_table(results))]
    for load in results.loads:
        parts += [(f"Verdicts: {load}, {'without' if mode == NONE else 'with'} recovery", "",
                   verdict_table(results, load, mode)) for mode in [NONE, POSTPONE]]
    parts += [("Reserved and free slots", "Cycles as a multiple of those at the largest M.", slots_table(results)),
              ("Array size", "Synthetic traffic.", size_table(results)),
              ("Without a limit of cycles", "Synthetic traffic with `postpone`, `reserved`, buffers of 1: waited for "
               "until the model gave its verdict. `livelock` is called after a window without any answer coming home, "
               "so its cycles are mostly that window.", full_table(results))]
    parts += [(f"Occupancy: {load}", "Medians over the seeds; peaks are the largest of any cell and seed.",
               occupancy_table(results, load)) for load in results.loads]
    return parts


def document(results, command, seconds):
    rows = results.rows
    verdicts = {word: sum(row.verdict == word for row in rows) for word in
                ["completed", "deadlock", "livelock", "cycle_limit", "capacity"]}
    counts = ", ".join(f"{number} `{word}`" for word, number in verdicts.items() if number)
    minutes = f" One after the other, they took {seconds / 60:.0f} minutes of wall time." if seconds is not None else ""
    text = f"""# Deadlock: M, buffer depth, networks, recovery

{len(rows)} runs, each a row of `deadlock.csv`, from which everything here and the charts are made: {counts}.{minutes}
Command: `{command}`. {pictures(results)}{knots(results)}

- **ends**: verdict `completed`. **locks**: verdict `deadlock`, or cut off with a knot in it. **limit**: cut off at
  its limit of cycles, so whether it would have ended in a livelock or at all is open. Where the seeds differ, how many
  of each.
- **Recovery, slots**: `--recovery` and `--slots`. With `none` a ray that finds no slot waits in its buffer.
- `synthetic` is `deadlock_tb`'s traffic: three waiting generations, a hit in a tenth of the cells entered, one child a
  hit, half of the children turning back; a seed draws another traffic and another jitter of the back-off. A scene's
  seed draws the jitter alone, so without recovery there is one run.
"""
    for title, words, content in sections(results):
        if content:
            text += f"\n## {title}\n\n" + (f"{words}\n\n" if words else "") + content + "\n"
    return text
