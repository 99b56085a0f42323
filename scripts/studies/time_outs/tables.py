"""Writes docs/measured/time_outs.md from the rows of time_outs.csv."""
import textwrap

from studies.time_outs.design import LOAD_WORDS, TIME_OUTS, name_of
from studies.tables import NOTHING, count, table


def percent(share):
    return f"{100 * share:.1f} %"


def cycles_or_none(cycles):
    return count(cycles) if cycles else "none"


def delay(group):
    if not group.alarming:
        return NOTHING
    least, median, most = group.first_waits()
    return f"T {median:+,.0f} ({least:+,.0f} to {most:+,.0f})"


def machine_table(results):
    lines = []
    for load in results.loads:
        for machine in results.machines:
            group = results.groups.get((load, machine))
            if not group:
                continue
            line = [f"{load}: `{name_of(machine)}`", f"{len(group.locked)} of {len(group.rows)}",
                    cycles_or_none(group.silent_from("false")), cycles_or_none(group.silent_from("false", "early"))]
            if group.locked:
                line += [count(group.sum("knots")), count(group.sum("missed_knots")), count(group.sum("knot_cells")),
                         percent(group.missed_cells()), delay(group),
                         count(group.stood_still())]
            else:
                line += [NOTHING] * 6
            lines.append(line)
    return table(["load: machine", "runs that lock", "no false alarm from T =", "nor an early one from T =", "knots",
                  "knots missed", "cells of knots", "cells missed", "delay, median (range)",
                  "stands still after, median"], lines)


def alarm_table(results):
    """Of all machines: share of the runs with a false alarm, false and early alarms per million cell cycles."""
    lines = []
    for cycles in TIME_OUTS:
        line = [count(cycles)]
        for load in results.loads:
            group = results.of_load(load)
            if any(row.alarms(kind, cycles) for row in group.rows for kind in ("false", "early")):
                line.append(f"{100 * group.share_with('false', cycles):.0f} %; {group.rate('false', cycles):.3g}; "
                            f"{group.rate('early', cycles):.3g}")
            else:
                line.append(NOTHING)
        lines.append(line)
    return table(["T", *results.loads], lines)


def summary(results):
    everything, completed = results.all, results.completed
    longest = max(row.trace_cycles for row in results.rows)
    text = (f"No false alarm in any of the {len(everything.rows)} runs from T = "
            f"{cycles_or_none(everything.silent_from('false'))} on, and no early one from T = "
            f"{cycles_or_none(everything.silent_from('false', 'early'))} on")
    if completed.rows:
        text += (f"; in the {len(completed.rows)} that completed none from T = "
                 f"{cycles_or_none(completed.silent_from('false'))} on")
    text += f". (The longest run traced for {count(longest)} cycles: a longer T can't be tried there.)"
    if everything.alarming:
        least, median, most = everything.first_waits()
        missed = everything.sum("missed_knots")
        text += (f" Of {count(everything.sum('knots'))} knots in {len(everything.locked)} locked runs "
                 f"{count(missed) if missed else 'none'} is missed, whatever T is; of their "
                 f"{count(everything.sum('knot_cells'))} cells {percent(everything.missed_cells())} never give alarm. "
                 f"The first lasting alarm comes T {median:+,.0f} cycles after the first knot has formed (median; "
                 f"{least:+,.0f} to {most:+,.0f}).")
    return "\n".join(textwrap.wrap(text, 118))


def document(results, command, seconds):
    minutes = f"One after the other, they took {seconds / 60:.1f} minutes of wall time. " if seconds is not None else ""
    cut_off = f"{results.cut_off} more were cut off and are left out. " if results.cut_off else ""
    loads = "; ".join(f"`{load}`: {LOAD_WORDS[load]}" for load in results.loads)
    return f"""# Time-outs against the proof

A counter in each cell runs while a message in it can't move on and nothing else of the cell moves; at T it gives alarm
(`cells/units/time_out.hpp`). Beside it the proof: the knots of the wait-for graph. {len(results.rows)} runs of
{results.cells}x{results.cells} cells, each a row of `time_outs.csv`, from which everything here and the chart are made.
{cut_off}{minutes}Command: `{command}`.

{summary(results)}

- **False alarm**: in a cell that moved again and of which nothing is locked at the end. **Early alarm**: in a cell that
  moved again and holds something of a knot, or that waits for one, at the end; when it was given the knot may have
  stood already. Both per million cell cycles: of tracing, over all cells and runs.
- **Missed**: no alarm that lasts. A locked run ends when nothing can move any more. What waits then waits for ever, so
  its alarm counts for every T, however soon the run was over: misses depend neither on T nor on when the run ends, and
  no cycle is simulated to wait for the alarm. What is missed are cells in which only slots wait: the counter watches
  messages.
- **Delay**: from the cycle in which the first knot stood to the first lasting alarm in a cell of any knot. Below T
  where that cell had stopped before its knot closed, above T where other traffic went on through the knot's cells and
  started their counters anew. **Stands still after**: from the knot's forming to the end of the run.
- Loads: {loads}.
- Three waiting generations, slots `reserved`, buffers of 1.

## Loads and machines

{machine_table(results)}

## Alarms by T

All machines of a load: runs with a false alarm; false alarms; early alarms, both per million cell cycles.

{alarm_table(results)}
"""
