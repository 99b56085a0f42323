#include "testbench/raycell/size_frame_report.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "testbench/common/report_json.hpp"
#include "testbench/common/svg.hpp"
#include "testbench/raycell/size_report.hpp"

namespace raycell {
namespace {

using Json = nlohmann::ordered_json;

std::string decibels(const FrameTrial& t) {
    char text[32];
    std::snprintf(text, sizeof text, "%.2f", t.accuracy.psnr_db);
    return text;
}

Json settings_of(const std::vector<FrameAxis>& axes, const FrameTrial& t) {
    Json json;
    for (std::size_t i = 0; i < axes.size(); ++i) json[axes[i].option] = axes[i].values[t.point[i]];
    return json;
}

Json json_of(const std::vector<FrameAxis>& axes, const FrameTrial& t, bool front) {
    Json json = settings_of(axes, t);
    json["timed"] = !t.verdict.empty();
    json["verdict"] = t.verdict;
    json["psnr_db"] = t.accuracy.psnr_db;
    json["wrong_hit_percent"] = t.accuracy.wrong_hit_percent;
    json["voxel_bits"] = t.voxel_bits;
    json["bits_per_cell"] = t.bits;
    json["load_cycles"] = t.load;
    json["trace_cycles"] = t.trace;
    json["frame_cycles"] = t.cycles();
    json["meets"] = t.meets;
    json["front"] = front;
    return json;
}

/// A scale of a chart, linear or logarithmic, that holds all values.
struct Scale {
    double low = 0;
    double high = 1;
    bool logarithmic = false;
    double begin = 0;  ///< pixels
    double end = 1;

    double at(double value) const {
        const auto f = [&](double v) { return logarithmic ? std::log10(v) : v; };
        return begin + (end - begin) * (f(value) - f(low)) / (f(high) - f(low));
    }
};

Scale scale_of(std::vector<double> values, bool logarithmic, double begin, double end) {
    if (values.empty()) values = {1, 10};
    const auto [low, high] = std::minmax_element(values.begin(), values.end());
    const double room = logarithmic ? 1.1 : 0.05 * std::max(*high - *low, 1.0);
    Scale scale{*low - room, *high + room, logarithmic, begin, end};
    if (logarithmic) scale.low = std::max(*low, 1.0) / room, scale.high = std::max(*high, 1.0) * room;
    return scale;
}

constexpr double width = 420, height = 280, left = 80, top = 40;

struct Panel {
    std::string title;
    Scale x, y;
};

/// Ticks at 1, 2 and 5 times powers of ten, or at fifths of a linear scale.
std::vector<double> ticks_of(const Scale& s) {
    std::vector<double> ticks;
    if (!s.logarithmic) {
        for (int i = 0; i <= 5; ++i) ticks.push_back(s.low + (s.high - s.low) * i / 5);
        return ticks;
    }
    for (double power = 1; power <= s.high; power *= 10) {
        for (const double factor : {1.0, 2.0, 5.0}) {
            if (factor * power >= s.low && factor * power <= s.high) ticks.push_back(factor * power);
        }
    }
    return ticks;
}

std::string number(double value) {
    std::ostringstream text;
    if (value >= 1e4) {
        text << value / 1000 << 'k';
    } else {
        text.precision(4);
        text << value;
    }
    return text.str();
}

void draw_frame(std::ostream& svg, const Panel& p) {
    svg << "<rect x='" << p.x.begin << "' y='" << top << "' width='" << width << "' height='" << height
        << "' class='frame'/>\n";
    put_text(svg, p.x.begin + width / 2, top - 14, p.title, "middle");
    put_text(svg, p.x.begin + width / 2, top + height + 36, "cycles of a frame", "middle");
    for (const double tick : ticks_of(p.x)) {
        svg << "<line class='grid' x1='" << p.x.at(tick) << "' x2='" << p.x.at(tick) << "' y1='" << top
            << "' y2='" << top + height << "'/>\n";
        put_text(svg, p.x.at(tick), top + height + 18, number(tick), "middle");
    }
    for (const double tick : ticks_of(p.y)) {
        svg << "<line class='grid' x1='" << p.x.begin << "' x2='" << p.x.begin + width << "' y1='"
            << p.y.at(tick) << "' y2='" << p.y.at(tick) << "'/>\n";
        put_text(svg, p.x.begin - 6, p.y.at(tick) + 4, number(tick), "end");
    }
}

void draw_goal(std::ostream& svg, double x1, double y1, double x2, double y2) {
    svg << "<line class='goal' x1='" << x1 << "' y1='" << y1 << "' x2='" << x2 << "' y2='" << y2 << "'/>\n";
}

}  // namespace

FrameReport::FrameReport(const std::vector<FrameAxis>& axes, const std::vector<FrameTrial>& trials,
                         const FrameGoal& goal)
    : axes_(axes), trials_(trials), goal_(goal), front_(pareto_front(trials)) {}

std::string FrameReport::csv() const {
    std::string text;
    for (std::size_t i = 0; i < trials_.size(); ++i) {
        const Json json = json_of(axes_, trials_[i], front_[i]);
        std::string names;
        std::string line;
        for (const auto& [key, value] : json.items()) {
            const char* comma = names.empty() ? "" : ",";
            names += comma + key;
            line += comma + (value.is_string() ? value.get<std::string>() : value.dump());
        }
        if (i == 0) text += names + "\n";
        text += line + "\n";
    }
    return text;
}

std::string FrameReport::json(const std::optional<FrameTrial>& found, const FrameTrial& nearest) const {
    Json json;
    json["goal"] = {{"psnr_db", goal_.accuracy.psnr_db},
                    {"wrong_hit_percent", goal_.accuracy.wrong_hit_percent},
                    {"frame_cycles", goal_.cycles}};
    json["reached"] = found.has_value();
    const FrameTrial& best = found ? *found : nearest;
    json[found ? "found" : "nearest"] = json_of(axes_, best, false);
    json["tried"] = Json::array();
    for (std::size_t i = 0; i < trials_.size(); ++i) {
        json["tried"].push_back(json_of(axes_, trials_[i], front_[i]));
        if (trials_[i].run == best.run && found) json["found"]["front"] = bool(front_[i]);
    }
    return to_text(json);
}

std::string FrameReport::chart(const std::optional<FrameTrial>& found) const {
    std::vector<double> cycles, bits, psnr;
    for (const FrameTrial& t : trials_) {
        if (!t.ended()) continue;
        cycles.push_back(double(t.cycles()));
        bits.push_back(double(t.bits));
        psnr.push_back(t.accuracy.psnr_db);
    }
    cycles.push_back(double(goal_.cycles));
    const double second = left + width + left + 20;
    const Panel panels[] = {{"bits of a cell", scale_of(cycles, true, left, left + width),
                             scale_of(bits, true, top + height, top)},
                            {"dB against the scene", scale_of(cycles, true, second, second + width),
                             scale_of(psnr, false, top + height, top)}};
    std::ostringstream svg;
    begin_svg(svg, second + width + 20, top + height + 60,
              ".frame{fill:none;stroke:#444}.grid{stroke:#ddd}.goal{stroke:#d62728;stroke-dasharray:5 3}"
              "circle{stroke:#1f77b4}text{font:12px sans-serif}");
    for (const Panel& p : panels) {
        draw_frame(svg, p);
        draw_goal(svg, p.x.at(double(goal_.cycles)), top, p.x.at(double(goal_.cycles)), top + height);
    }
    const double wanted = goal_.accuracy.psnr_db;
    if (wanted > panels[1].y.low && wanted < panels[1].y.high)
        draw_goal(svg, second, panels[1].y.at(wanted), second + width, panels[1].y.at(wanted));
    for (std::size_t i = 0; i < trials_.size(); ++i) {
        const FrameTrial& t = trials_[i];
        if (!t.ended()) continue;
        const bool chosen = found && found->run == t.run;
        for (const Panel& p : panels) {
            const double y = &p == panels ? double(t.bits) : t.accuracy.psnr_db;
            svg << "<circle cx='" << p.x.at(double(t.cycles())) << "' cy='" << p.y.at(y) << "' r='"
                << (chosen ? 7 : 4) << "' fill='"
                << (chosen      ? "#d62728"
                    : front_[i] ? "#1f77b4"
                                : "none")
                << "'><title>" << escaped(words_for(t)) << "</title></circle>\n";
        }
    }
    svg << "</svg>\n";
    return svg.str();
}

std::string FrameReport::front_table() const {
    std::vector<const FrameTrial*> front;
    for (std::size_t i = 0; i < trials_.size(); ++i) {
        if (front_[i]) front.push_back(&trials_[i]);
    }
    std::sort(front.begin(), front.end(),
              [](const FrameTrial* a, const FrameTrial* b) { return a->cycles() < b->cycles(); });
    std::vector<std::vector<std::string>> rows(1);
    for (const FrameAxis& axis : axes_) rows[0].push_back(axis.option);
    for (const char* name : {"bits a cell", "load", "trace", "frame", "dB", "meets"}) rows[0].push_back(name);
    for (const FrameTrial* t : front) {
        rows.emplace_back();
        for (std::size_t i = 0; i < axes_.size(); ++i) rows.back().push_back(axes_[i].values[t->point[i]]);
        for (const std::uint64_t value : {t->bits, t->load, t->trace, t->cycles()})
            rows.back().push_back(std::to_string(value));
        rows.back().push_back(decibels(*t));
        rows.back().push_back(t->meets ? "yes" : "no");
    }
    return aligned(rows, 0);
}

std::string FrameReport::words_for(const FrameTrial& t) const {
    std::string words;
    for (std::size_t i = 0; i < axes_.size(); ++i)
        words += axes_[i].option + " " + axes_[i].values[t.point[i]] + ", ";
    words += decibels(t) + " dB";
    if (t.verdict.empty()) return words + ", not timed";
    return words + ", " + std::to_string(t.bits) + " bits a cell, " + std::to_string(t.load) + " + " +
           std::to_string(t.trace) + " cycles" + (t.ended() ? "" : " until " + t.verdict);
}

}  // namespace raycell
