// The chart of a sweep, as SVG.
#include <algorithm>
#include <array>
#include <map>
#include <sstream>

#include "testbench/common/svg.hpp"
#include "testbench/sweep/results.hpp"

namespace raycell {
namespace {

constexpr double panel_width = 420;
constexpr double panel_height = 260;
constexpr double left = 70;  // room for an axis
constexpr double top = 40;
constexpr std::array<const char*, 10> colours = {"#1f77b4", "#d62728", "#2ca02c", "#9467bd", "#ff7f0e",
                                                 "#17becf", "#8c564b", "#e377c2", "#7f7f7f", "#bcbd22"};

/// A line of the chart: its name, and the machines at some of the values along x.
struct Series {
    std::string name;
    std::vector<const SweepMachine*> at;  ///< null: not run
};

/// The axis along x: M if it varies, else the one of most values.
std::size_t axis_along(const SweepDesign& design, const std::vector<std::size_t>& axes) {
    std::size_t best = axes.front();
    for (const std::size_t axis : axes) {
        if (design.axes[axis].option == "ray-store") return axis;
        if (design.axes[axis].values.size() > design.axes[best].values.size()) best = axis;
    }
    return best;
}

std::vector<Series> series_of(const SweepDesign& design, const std::vector<SweepMachine>& machines,
                              const std::vector<std::size_t>& axes, std::size_t along) {
    const std::vector<std::string>& values = design.axes[along].values;
    std::vector<Series> all;
    std::map<std::string, std::size_t> places;
    for (const SweepMachine& machine : machines) {
        const SweepPoint& point = machine.runs.front()->point;
        std::string name;
        for (const std::size_t axis : axes) {
            if (axis != along)
                name += (name.empty() ? "" : ", ") + design.axes[axis].option + " " + point.values[axis];
        }
        const auto [place, added] = places.emplace(name, all.size());
        if (added) all.push_back({name, std::vector<const SweepMachine*>(values.size(), nullptr)});
        const auto at = std::find(values.begin(), values.end(), point.values[along]) - values.begin();
        all[place->second].at[std::size_t(at)] = &machine;
    }
    return all;
}

/// A panel's frame, its values along x, and its scale along y from 0 to `most`.
struct Panel {
    double x0;
    double most;
    const std::vector<std::string>& values;
    double x(std::size_t value, std::size_t series, std::size_t count) const {
        // Lines of equal height stand side by side, not one over the other.
        const double step = panel_width / double(values.size());
        const double dodge = count > 1 ? (double(series) / double(count - 1) - 0.5) * 0.5 * step : 0;
        return x0 + step * (double(value) + 0.5) + dodge;
    }
    double y(double value) const { return top + panel_height * (1 - value / most); }
};

void draw_frame(std::ostringstream& svg, const Panel& panel, const std::string& title,
                const std::string& unit, const std::string& along) {
    svg << "<rect x='" << panel.x0 << "' y='" << top << "' width='" << panel_width << "' height='"
        << panel_height << "' class='frame'/>\n";
    put_text(svg, panel.x0 + panel_width / 2, top - 14, title, "middle");
    put_text(svg, panel.x0 + panel_width / 2, top + panel_height + 36, along, "middle");
    constexpr int ticks = 4;
    for (int i = 0; i <= ticks; ++i) {
        const double value = panel.most * i / ticks;
        std::ostringstream label;
        label << value;
        svg << "<line x1='" << panel.x0 << "' x2='" << panel.x0 + panel_width << "' y1='" << panel.y(value)
            << "' y2='" << panel.y(value) << "' class='grid'/>\n";
        put_text(svg, panel.x0 - 6, panel.y(value) + 4, label.str() + unit, "end");
    }
    for (std::size_t i = 0; i < panel.values.size(); ++i)
        put_text(svg, panel.x(i, 0, 1), top + panel_height + 18, panel.values[i], "middle");
}

/// Beyond the colours, lines are dashed.
const char* dashes(std::size_t series) {
    return series / colours.size() == 0   ? ""
           : series / colours.size() == 1 ? " stroke-dasharray='6 3'"
                                          : " stroke-dasharray='2 3'";
}

template <typename Value>
void draw_series(std::ostringstream& svg, const Panel& panel, const std::vector<Series>& all,
                 const Value& value) {
    for (std::size_t s = 0; s < all.size(); ++s) {
        const char* colour = colours[s % colours.size()];
        std::ostringstream dots;
        std::ostringstream line;
        for (std::size_t i = 0; i < all[s].at.size(); ++i) {
            double y = 0;
            if (!all[s].at[i] || !value(*all[s].at[i], y)) continue;
            line << panel.x(i, s, all.size()) << ',' << panel.y(y) << ' ';
            dots << "<circle cx='" << panel.x(i, s, all.size()) << "' cy='" << panel.y(y) << "' r='4' fill='"
                 << colour << "'><title>" << escaped(all[s].name + ": " + panel.values[i] + ": ") << y
                 << "</title></circle>\n";
        }
        if (line.str().empty()) continue;
        svg << "<polyline class='line' stroke='" << colour << "'" << dashes(s) << " points='" << line.str()
            << "'/>\n"
            << dots.str();
    }
}

bool share_completed(const SweepMachine& machine, double& percent) {
    const auto ended = std::count_if(machine.runs.begin(), machine.runs.end(),
                                     [](const SweepRow* run) { return run->verdict == "completed"; });
    percent = 100.0 * double(ended) / double(machine.runs.size());
    return true;
}

bool cycles_of_safe(const SweepMachine& machine, double& cycles) {
    if (machine.safe()) cycles = double(*machine.cycles());
    return machine.safe();
}

/// The next number of the form 1, 2 or 5 times a power of ten.
double round_up(double value) {
    double power = 1;
    while (power * 10 <= value) power *= 10;
    for (const double factor : {1.0, 2.0, 5.0}) {
        if (factor * power >= value) return factor * power;
    }
    return 10 * power;
}

}  // namespace

std::string sweep_chart(const SweepDesign& design, const std::vector<SweepRow>& rows) {
    std::vector<std::size_t> axes;
    for (const std::size_t axis : design.varying()) {
        if (design.axes[axis].option != "seed") axes.push_back(axis);
    }
    if (axes.empty()) return "";
    const std::size_t along = axis_along(design, axes);
    const std::vector<SweepMachine> machines = machines_of(design, rows);
    const std::vector<Series> all = series_of(design, machines, axes, along);
    double most = 1;
    for (const SweepMachine& machine : machines) {
        double cycles = 0;
        if (cycles_of_safe(machine, cycles)) most = std::max(most, cycles);
    }
    const SweepAxis& axis = design.axes[along];
    const Panel shares{left, 100, axis.values};
    const Panel cycles{2 * left + panel_width + 30, round_up(most), axis.values};
    const bool named = all.size() > 1;
    const double height = top + panel_height + 56 + (named ? 18 * double(all.size()) : 0);
    std::ostringstream svg;
    begin_svg(svg, cycles.x0 + panel_width + 20, height,
              ".frame{fill:none;stroke:#444}.grid{stroke:#ddd}.line{fill:none;stroke-width:1.5}");
    const std::string name = "--" + axis.option + (axis.option == "ray-store" ? " (M)" : "");
    draw_frame(svg, shares, "runs that completed, %", "", name);
    draw_frame(svg, cycles, "cycles of precast and trace, median, where all runs completed", "", name);
    draw_series(svg, shares, all, share_completed);
    draw_series(svg, cycles, all, cycles_of_safe);
    for (std::size_t s = 0; named && s < all.size(); ++s) {
        const double y = top + panel_height + 60 + 18 * double(s);
        svg << "<line x1='" << left - 10 << "' x2='" << left + 14 << "' y1='" << y - 4 << "' y2='" << y - 4
            << "' stroke='" << colours[s % colours.size()] << "' stroke-width='3'" << dashes(s) << "/>\n";
        put_text(svg, left + 20, y, all[s].name, "start");
    }
    svg << "</svg>\n";
    return svg.str();
}

}  // namespace raycell
