"""Checks the knots of a wait-for graph that a run dumped (PREFIX.waits.json), by a plain search that shares nothing
with the simulator. Usage: check_knots FILE.waits.json ..."""
import json
import sys


def dead_nodes(nodes):
    """The largest set of nodes of which none could go on even if all nodes outside it did."""
    dead = set(range(len(nodes)))
    changed = True
    while changed:
        changed = False
        for i, node in enumerate(nodes):
            if i not in dead:
                continue
            freed = [other not in dead for other in node["waits_for"]]
            if node["moves"] or (freed and (all(freed) if node["all"] else any(freed))):
                dead.remove(i)
                changed = True
    return dead


def reachable(nodes, dead, start):
    """The dead nodes that `start` waits for, directly or not."""
    reached, front = set(), [start]
    while front:
        for other in nodes[front.pop()]["waits_for"]:
            if other in dead and other not in reached:
                reached.add(other)
                front.append(other)
    return reached


def objection(graph):
    """Why the graph's knots are wrong, or None. All nodes of a knot must be dead, and each must wait for the whole knot
    and for no other dead node."""
    nodes, knots = graph["nodes"], graph["knots"]
    dead = dead_nodes(nodes)
    if bool(dead) != bool(knots):
        return f"{len(dead)} dead nodes, {len(knots)} knots"
    for knot in map(set, knots):
        for node in knot:
            if node not in dead:
                return f"node {node} of a knot could go on"
            if reachable(nodes, dead, node) != knot:
                return f"node {node} does not wait for just its knot"
    return None


def main():
    wrong = 0
    for path in sys.argv[1:]:
        try:
            with open(path, encoding="utf-8") as file:
                graph = json.load(file)
            found = objection(graph)
        except (OSError, ValueError, KeyError, TypeError, IndexError) as error:
            sys.exit(f"check_knots: {path}: {error!r}; expected the wait-for graph of a run, PREFIX.waits.json")
        wrong += found is not None
        knots = len(graph["knots"])
        print(f"{path}: {found or f'{knots} knots, accepted'}")
    sys.exit(2 if wrong else 0)


if __name__ == "__main__":
    main()
