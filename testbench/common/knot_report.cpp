#include "testbench/common/knot_report.hpp"

#include <algorithm>
#include <array>
#include <sstream>

#include "testbench/common/svg.hpp"

namespace raycell {
namespace {

using Json = nlohmann::ordered_json;
using Index = WaitGraph::Index;
using Node = WaitGraph::Node;

Json node_json(const Node& node, Cycle now) {
    Json json = {{"x", node.x},        {"y", node.y},         {"kind", name_of(node.kind)},
                 {"what", node.what},  {"holds", node.holds}, {"wants", node.wants},
                 {"since", node.since}};
    json["age"] = now - std::min<Cycle>(now, node.since);
    if (node.side >= 0) json["side"] = name_of(Side(node.side));
    return json;
}

}  // namespace

Json knot_json(const RunResult& result) {
    const WaitGraph& graph = result.waits;
    Json json;
    json["formed"] = result.knot_formed;
    json["knots"] = graph.knots().size();
    json["tails"] = graph.tails();
    json["cells"] = Json::array();
    for (const auto& [x, y] : result.knot_cells) json["cells"].push_back({x, y});
    json["nodes"] = Json::array();
    json["edges"] = Json::array();
    std::vector<Index> place(graph.nodes().size(), 0);
    std::size_t number = 0;
    for (const auto& knot : graph.knots()) {
        for (const Index i : knot) {
            place[i] = Index(json["nodes"].size());
            Json node = node_json(graph.nodes()[i], result.ended);
            node["knot"] = number;
            json["nodes"].push_back(std::move(node));
        }
        ++number;
    }
    for (const auto& knot : graph.knots()) {
        for (const Index i : knot) {
            for (const Index other : graph.nodes()[i].waits_for) {
                if (graph.nodes()[other].state != WaitGraph::State::knot) continue;
                json["edges"].push_back({place[i], place[other]});
            }
        }
    }
    return json;
}

Json waits_json(const RunResult& result) {
    Json json;
    json["cycle"] = result.ended;
    json["nodes"] = Json::array();
    for (const Node& node : result.waits.nodes()) {
        Json one = node_json(node, result.ended);
        one["moves"] = node.moves;
        one["all"] = node.all;
        one["state"] = name_of(node.state);
        one["waits_for"] = node.waits_for;
        json["nodes"].push_back(std::move(one));
    }
    json["knots"] = result.waits.knots();
    return json;
}

// ---- picture

namespace {

struct Point {
    double x;
    double y;
};

/// A rectangle of cells drawn at a scale.
struct Panel {
    Point origin;
    double scale;  ///< pixels per cell
    int x0;
    int y0;
    int x1;
    int y1;

    Point corner(int x, int y) const { return {origin.x + (x - x0) * scale, origin.y + (y - y0) * scale}; }
    /// A buffer is drawn where its link comes in, everything else in the middle of its cell.
    Point place(const Node& node) const {
        const Point at = corner(node.x, node.y);
        Point middle{at.x + 0.5 * scale, at.y + 0.5 * scale};
        if (node.side >= 0) {
            middle.x += 0.33 * scale * step_x(Side(node.side));
            middle.y += 0.33 * scale * step_y(Side(node.side));
        }
        return middle;
    }
    bool shows(const Node& node) const {
        return node.x >= x0 && node.x <= x1 && node.y >= y0 && node.y <= y1;
    }
};

void draw_lines(std::ostringstream& svg, const Panel& panel) {
    const Point low = panel.corner(panel.x0, panel.y0);
    const Point high = panel.corner(panel.x1 + 1, panel.y1 + 1);
    const bool wide_enough = panel.scale >= 6;
    const auto line = [&](Point from, Point to) {
        svg << "<line x1='" << from.x << "' y1='" << from.y << "' x2='" << to.x << "' y2='" << to.y
            << "' class='grid'/>\n";
    };
    for (int x = panel.x0 + 1; wide_enough && x <= panel.x1; ++x) {
        const double at = panel.corner(x, panel.y0).x;
        line({at, low.y}, {at, high.y});
    }
    for (int y = panel.y0 + 1; wide_enough && y <= panel.y1; ++y) {
        const double at = panel.corner(panel.x0, y).y;
        line({low.x, at}, {high.x, at});
    }
    svg << "<rect x='" << low.x << "' y='" << low.y << "' width='" << high.x - low.x << "' height='"
        << high.y - low.y << "' class='array'/>\n";
}

/// Draws the cells that hold something dead, those of a knot over those of a tail.
void draw_cells(std::ostringstream& svg, const Panel& panel, const WaitGraph& graph) {
    for (const WaitGraph::State state : {WaitGraph::State::tail, WaitGraph::State::knot}) {
        for (const Node& node : graph.nodes()) {
            if (node.state != state || !panel.shows(node)) continue;
            const Point at = panel.corner(node.x, node.y);
            svg << "<rect x='" << at.x << "' y='" << at.y << "' width='" << panel.scale << "' height='"
                << panel.scale << "' class='" << name_of(state) << "'/>\n";
        }
    }
}

void draw_edges(std::ostringstream& svg, const Panel& panel, const WaitGraph& graph,
                const std::vector<Index>& knot) {
    const double dot = std::max(1.5, 0.06 * panel.scale);
    for (const Index i : knot) {
        const Node& node = graph.nodes()[i];
        if (!panel.shows(node)) continue;
        const Point from = panel.place(node);
        svg << "<circle cx='" << from.x << "' cy='" << from.y << "' r='" << dot << "'><title>"
            << escaped(node.what + ": " + node.holds + ", waits for " + node.wants) << "</title></circle>\n";
        for (const Index other : node.waits_for) {
            const Node& target = graph.nodes()[other];
            if (target.state != WaitGraph::State::knot || !panel.shows(target)) continue;
            const Point to = panel.place(target);
            svg << "<line x1='" << from.x << "' y1='" << from.y << "' x2='" << to.x << "' y2='" << to.y
                << "' class='wait' marker-end='url(#arrow)'/>\n";
        }
    }
}

/// The oldest knot's cells and a margin of one cell, at most `most` cells in each direction.
Panel close_up(const RunResult& result, int width, int height, Point origin, double side) {
    constexpr int most = 16;
    const std::vector<Index>& knot = result.waits.knots().front();
    Panel panel{origin, 0, width, height, 0, 0};
    for (const Index i : knot) {
        const Node& node = result.waits.nodes()[i];
        panel.x0 = std::min(panel.x0, node.x);
        panel.y0 = std::min(panel.y0, node.y);
        panel.x1 = std::max(panel.x1, node.x);
        panel.y1 = std::max(panel.y1, node.y);
    }
    panel.x0 = std::max(panel.x0 - 1, 0);
    panel.y0 = std::max(panel.y0 - 1, 0);
    panel.x1 = std::min({panel.x1 + 1, width - 1, panel.x0 + most - 1});
    panel.y1 = std::min({panel.y1 + 1, height - 1, panel.y0 + most - 1});
    panel.scale = side / std::max(panel.x1 - panel.x0 + 1, panel.y1 - panel.y0 + 1);
    return panel;
}

}  // namespace

std::string knot_svg(const RunResult& result, int width, int height) {
    constexpr double side = 480;
    constexpr double margin = 20;
    constexpr double top = 40;
    const WaitGraph& graph = result.waits;
    const Panel all{{margin, top}, side / std::max(width, height), 0, 0, width - 1, height - 1};
    const Panel near = close_up(result, width, height, {2 * margin + side, top}, side);
    constexpr std::size_t listed = 12;
    const std::vector<Index>& knot = graph.knots().front();
    const std::size_t lines = std::min(knot.size(), listed);
    const double bottom = top + side + margin;
    std::ostringstream svg;
    begin_svg(svg, 2 * side + 3 * margin, bottom + 16 * double(lines + 2),
              ".array{fill:none;stroke:#444}.grid{stroke:#ddd}.tail{fill:#fdd08a}.knot{fill:#e4572e;"
              "fill-opacity:.55}.wait{stroke:#111;stroke-width:1.5}");
    svg << "<defs><marker id='arrow' viewBox='0 0 8 8' refX='7' refY='4' markerWidth='7' markerHeight='7' "
           "orient='auto'><path d='M0 0L8 4L0 8z'/></marker></defs>\n";
    put_text(svg, margin, 16,
             "Deadlock, formed in cycle " + std::to_string(result.knot_formed) +
                 ". Knots: " + std::to_string(graph.knots().size()) +
                 " (red); places that only wait for one: " + std::to_string(graph.tails()) + " (orange).");
    for (const Panel& panel : {all, near}) {
        draw_cells(svg, panel, graph);
        draw_lines(svg, panel);
        for (const auto& each : graph.knots()) draw_edges(svg, panel, graph, each);
    }
    put_text(svg, all.origin.x, 34,
             "The array, " + std::to_string(width) + "x" + std::to_string(height) +
                 " cells: x to the right, y down");
    put_text(svg, near.origin.x, 34,
             "Cells " + std::to_string(near.x0) + ".." + std::to_string(near.x1) + ", " +
                 std::to_string(near.y0) + ".." + std::to_string(near.y1) +
                 ": the oldest knot; a dot holds a message, an arrow leads to what it waits for");
    for (std::size_t i = 0; i < lines; ++i) {
        const Node& node = graph.nodes()[knot[i]];
        put_text(svg, margin, bottom + 16 * double(i + 1),
                 "(" + std::to_string(node.x) + ", " + std::to_string(node.y) + ") " + node.what +
                     " since cycle " + std::to_string(node.since) + ": " + node.holds + ", waits for " +
                     node.wants);
    }
    if (knot.size() > listed) {
        put_text(svg, margin, bottom + 16 * double(lines + 1),
                 "... " + std::to_string(knot.size()) + " in all");
    }
    svg << "</svg>\n";
    return svg.str();
}

}  // namespace raycell
