"""What the sweeps' tables share: Markdown."""

NOTHING = "–"


def table(head, lines):
    """A Markdown table, without the lines that have only their first cell."""
    kept = [line for line in lines if any(cell != NOTHING for cell in line[1:])]
    if not kept:
        return ""
    rows = [head, ["---"] * len(head), *kept]
    return "\n".join("| " + " | ".join(str(cell) for cell in row) + " |" for row in rows)


def count(value):
    return NOTHING if value is None else f"{value:,.0f}"
