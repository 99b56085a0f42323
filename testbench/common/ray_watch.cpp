#include "testbench/common/ray_watch.hpp"

#include <ostream>
#include <sstream>

#include "cells/cell.hpp"
#include "testbench/common/options.hpp"

namespace raycell {
namespace {

constexpr const char* side_names[] = {"east", "south", "west", "north"};
constexpr const char* answer_names[] = {"intensity", "lit", "blocked", "postponed"};

std::string text_of_cell(int x, int y) { return "(" + std::to_string(x) + ", " + std::to_string(y) + ")"; }

std::string padded(std::string text, std::size_t width) {
    text.resize(std::max(width, text.size()), ' ');
    return text;
}

std::string times(std::uint64_t count, const std::string& what) {
    return std::to_string(count) + " " + what + (count == 1 ? "" : "s");
}

std::string outcome(Visit::Event event, RayKind kind) {
    switch (event) {
        case Visit::Event::hit:
            return is_shadow(kind) ? "blocked" : "hit";
        case Visit::Event::forward:
            return "forward";
        case Visit::Event::leaves_cube:
            return "leaves the cube through its front or back";
        case Visit::Event::reaches_source:
            return "reaches its source";
    }
    return "";
}

}  // namespace

bool parse_ray(const std::string& word, std::uint64_t& id) {
    const auto slash = word.find('/');
    const auto dot = std::min(word.find('.'), slash);
    std::uint32_t pixel = 0;
    std::uint32_t sample = 0;
    std::uint32_t part = 0;
    if (slash == std::string::npos || !parse_number(word.substr(0, dot), pixel) ||
        !parse_number(word.substr(slash + 1), part) ||
        (dot < slash && !parse_number(word.substr(dot + 1, slash - dot - 1), sample))) {
        return false;
    }
    if (pixel >= most_pixels || sample >= unsigned(most_samples)) return false;
    id = ray_id(pixel, part, sample);
    return true;
}

void RayWatch::launched(const Cell& cell, Cycle now, const Ray& ray, const Ray* parent) {
    if (lives_.again(ray.id)) return;
    const auto root = roots_.find(ray.id);
    const bool by_pixel = ray.kind != RayKind::precast && pixels_.count(pixel_of(ray.id)) > 0;
    const bool by_parent = parent && lives_.find(parent->id);
    if (root != roots_.end()) root->second = true;
    if (root != roots_.end() || by_pixel || by_parent) lives_.add(cell, now, ray, parent);
}

std::string RayWatch::what_happened(const Cell& cell, CellEvent event, std::uint32_t detail,
                                    RayLife& life) const {
    const std::string slot = "slot " + std::to_string(detail);
    switch (event) {
        case CellEvent::launch:
            return life.postponed > 0 ? "launched again, postponed " + times(life.postponed, "time")
                                      : std::string("launched: ") + ray_kind_names[int(life.kind)] +
                                            ", generation " + std::to_string(life.generation);
        case CellEvent::test:
            return "test begins: " + outcome(Visit::Event(detail), life.kind);
        case CellEvent::send: {
            const auto side = Side(detail >> 8);
            const int x = cell.x() + step_x(side);
            const int y = cell.y() + step_y(side);
            const bool leaves = x < 0 || x >= width_ || y < 0 || y >= height_;
            return std::string(life.answering ? "answer hops " : "hops ") + side_names[int(side)] +
                   ", class " + class_name(networks_, int(detail & 0xff)) +
                   (leaves ? ", to the exterior" : "");
        }
        case CellEvent::accept:
            return "accepted into " + slot;
        case CellEvent::direct:
            return "into the shading unit, waits for no answer";
        case CellEvent::shade:
            return slot +
                   (cell.ray_store()[detail].state == Slot::State::to_answer ? " is shaded" : " is set up");
        case CellEvent::answer:
            if (Answer::Kind(detail) == Answer::Kind::postponed)
                return "no slot: destroyed, notice to parent";
            return std::string("ends, answered: ") + answer_names[detail];
        case CellEvent::deliver:
            if (Answer::Kind(detail) == Answer::Kind::postponed) return "notice is home: postponed";
            return std::string("answer is home: ") + answer_names[detail];
        case CellEvent::silent:
            return "reaches its source, ends without an answer";
        case CellEvent::load:
        case CellEvent::postpone:  // reported as the notice, an answer
            break;
    }
    return "";
}

void RayWatch::cell_event(const Cell& cell, Cycle now, CellEvent event, std::uint64_t ray,
                          std::uint32_t detail) {
    RayLife* life = lives_.find(ray);
    if (!life || event == CellEvent::load) return;
    RayLives::note(*life, cell, now, event, detail);
    const std::string what = what_happened(cell, event, detail, *life);
    if (!what.empty()) tell(index(cell.x(), cell.y()), cell.x(), cell.y(), now, *life, what);
}

void RayWatch::stalled(const Cell& cell, Cycle now, std::uint64_t ray, Stall cause, Cycle cycles) {
    RayLife* life = lives_.find(ray);
    if (!life) return;
    life->waited[std::size_t(cause)] += cycles;
    const std::string what =
        "waited " + times(cycles, "cycle") + " (" + stall_names[std::size_t(cause)] + ")";
    const std::size_t at = index(cell.x(), cell.y());
    if (!lines_.empty() && cycle_ == now && lines_.back().cell == at && lines_.back().ray == ray) {
        lines_.back().text += "; " + what;  // the event that ended the waiting
    } else {
        tell(at, cell.x(), cell.y(), now, *life, what);
    }
}

void RayWatch::exterior_answered(int x, int y, Cycle now, const Answer& answer) {
    RayLife* life = lives_.find(answer.id);
    if (!life) return;
    RayLives::from_exterior(*life);
    const std::size_t after_all_cells = std::size_t(width_) * std::size_t(height_);
    tell(after_all_cells, x, y, now, *life,
         std::string("answer from the exterior hops in: ") + answer_names[int(answer.kind)]);
}

void RayWatch::tell(std::size_t cell, int x, int y, Cycle now, const RayLife& life, const std::string& what) {
    if (now != cycle_) flush();
    cycle_ = now;
    std::string cycle = std::to_string(now);
    cycle.insert(0, cycle.size() < 9 ? 9 - cycle.size() : 0, ' ');
    lines_.push_back({cell, life.id,
                      cycle + "  " + padded(text_of_cell(x, y), 12) +
                          std::string(std::size_t(2 * life.depth), ' ') + ray_name(life.id) + "  " + what});
}

void RayWatch::flush() {
    std::stable_sort(lines_.begin(), lines_.end(),
                     [](const Line& a, const Line& b) { return a.cell < b.cell; });
    for (const Line& line : lines_) out_ << line.text << '\n';
    lines_.clear();
}

void RayWatch::summarise(const RayLife& life, Cycle now) {
    const bool ended = life.ended != never;
    const Cycle end = ended ? life.ended : now;
    std::string causes;
    for (std::size_t cause = 1; cause <= stall_causes; ++cause) {
        if (life.waited[cause] == 0) continue;
        causes += (causes.empty() ? " (" : ", ") + std::string(stall_names[cause]) + " " +
                  std::to_string(life.waited[cause]);
    }
    out_ << "ray " << ray_name(life.id) << ": " << ray_kind_names[int(life.kind)] << ", generation "
         << life.generation << ", from cell " << text_of_cell(life.x, life.y) << ", cycles " << life.launched
         << " to " << end << (ended ? "" : " (not home)") << ", " << end - life.launched << " cycles, hops "
         << life.ray_hops << " + " << life.answer_hops << " of answers, waited " << life.waited_in_all()
         << causes << (causes.empty() ? "" : ")");
    if (life.postponed > 0) out_ << ", postponed " << times(life.postponed, "time");
    out_ << '\n';
}

void RayWatch::finish(Cycle now) {
    flush();
    std::uint64_t hops = 0;
    for (const std::size_t index : lives_.in_order()) {
        const RayLife& life = lives_.all()[index];
        summarise(life, now);
        hops += life.ray_hops + life.answer_hops;
    }
    for (const auto& [id, came] : roots_) {
        if (!came) out_ << "ray " << ray_name(id) << " was never launched\n";
    }
    out_ << "watched: " << times(lives_.all().size(), "ray") << ", " << times(hops, "hop") << '\n';
}

std::unique_ptr<RayWatch> watch_of(const RenderOptions& options, std::ostream& out) {
    if (options.watch_rays.empty() && options.watch_pixels.empty()) return nullptr;
    const char* name = options.watch_rays.empty() ? "--watch-pixel" : "--watch-ray";
    const PictureSettings& picture = options.picture;
    if (options.engine != Engine::timed) {
        throw UsageError(std::string(name) + ": only the timed engine has cycles; expected --engine timed");
    }
    if (picture.stage != RunStage::trace) {
        throw UsageError(std::string(name) + ": no ray is traced; expected --stage trace");
    }
    const Frame frame = array_frame(picture);
    const int wide = frame.picture_width();
    const int high = frame.picture_height();
    const auto pixels = std::uint64_t(wide) * std::uint64_t(high);
    auto watch = std::make_unique<RayWatch>(out, options.machine.networks, picture.width, picture.height);
    for (const std::uint64_t id : options.watch_rays) {
        if (pixel_of(id) >= pixels) {
            throw UsageError("--watch-ray: there is no pixel " + std::to_string(pixel_of(id)) +
                             "; expected PIXEL from 0 to " + std::to_string(pixels - 1));
        }
        if (int(sample_of_id(id)) >= picture.samples) {
            throw UsageError("--watch-ray: there is no sample " + std::to_string(sample_of_id(id)) +
                             "; expected SAMPLE from 0 to " + std::to_string(picture.samples - 1));
        }
        watch->watch_ray(id);
    }
    for (const CellRange& range : options.watch_pixels) {
        if (range.x1 >= wide || range.y1 >= high) {
            throw UsageError("--watch-pixel: there is no pixel (" + std::to_string(range.x1) + ", " +
                             std::to_string(range.y1) + "); expected X below " + std::to_string(wide) +
                             " and Y below " + std::to_string(high));
        }
        for (int y = range.y0; y <= range.y1; ++y) {
            for (int x = range.x0; x <= range.x1; ++x)
                watch->watch_pixel(std::uint64_t(y) * std::uint64_t(wide) + std::uint64_t(x));
        }
    }
    return watch;
}

}  // namespace raycell
