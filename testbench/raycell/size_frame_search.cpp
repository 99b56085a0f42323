#include "testbench/raycell/size_frame_search.hpp"

#include <algorithm>
#include <stdexcept>

namespace raycell {
namespace {

/// Accurate pictures that are tried in the fastest machine, and of those in time the ones that are reduced.
constexpr std::size_t most_timed = 8;
constexpr std::size_t most_reduced = 2;

bool smaller(const FrameTrial& a, const FrameTrial& b) {
    return a.bits != b.bits ? a.bits < b.bits : a.cycles() < b.cycles();
}

}  // namespace

FrameSearch::FrameSearch(const FrameModel& model, const FrameGoal& goal, std::vector<FrameAxis> axes,
                         FramePoint start)
    : model_(model), goal_(goal), axes_(std::move(axes)), start_(std::move(start)) {}

std::size_t FrameSearch::axis(const std::string& option) const {
    for (std::size_t i = 0; i < axes_.size(); ++i) {
        if (axes_[i].option == option) return i;
    }
    throw std::logic_error("internal error: no axis " + option);
}

FramePoint FrameSearch::at(FramePoint point, const std::string& option, std::size_t value) const {
    point[axis(option)] = value;
    return point;
}

std::vector<FrameTrial> FrameSearch::run(const std::vector<FramePoint>& points, bool timed) {
    std::vector<FramePoint> fresh;
    for (const FramePoint& point : points) {
        if (index_.emplace(std::make_pair(point, timed), tried_.size() + fresh.size()).second)
            fresh.push_back(point);
    }
    for (FrameTrial& trial : model_.run(fresh, timed)) {
        trial.meets = goal_.met_by(trial);
        tried_.push_back(std::move(trial));
    }
    std::vector<FrameTrial> trials;
    for (const FramePoint& point : points) trials.push_back(tried_[index_.at({point, timed})]);
    return trials;
}

/// Hit tests, normals and shadows that are accurate enough, those with the fewest bits of voxels first.
std::vector<FrameTrial> FrameSearch::accurate_pictures() {
    const std::size_t chord = axis("tessellate-for");
    std::vector<std::size_t> chords = {start_[chord]};
    if (goal_.accurate()) {
        model_.step_begins("polygons of curved objects");
        std::vector<FramePoint> points;
        for (std::size_t i = 0; i < axes_[chord].values.size(); ++i)
            points.push_back(at(start_, "tessellate-for", i));
        const std::vector<FrameTrial> trials = run(points, false);
        const auto enough = std::find_if(trials.begin(), trials.end(), [&](const FrameTrial& t) {
            return goal_.accuracy.met_by(t.accuracy);
        });
        if (enough == trials.end()) return {};
        chords = {std::size_t(enough - trials.begin())};
        if (enough + 1 != trials.end()) chords.push_back(chords.front() + 1);
    }
    model_.step_begins("hit tests, normals and shadows");
    std::vector<FramePoint> points;
    for (const std::size_t c : chords) {
        for (std::size_t hit = 0; hit < axes_[axis("hit")].values.size(); ++hit) {
            for (std::size_t normals = 0; normals < axes_[axis("normals")].values.size(); ++normals) {
                for (std::size_t shadows = 0; shadows < axes_[axis("shadows")].values.size(); ++shadows) {
                    FramePoint point = at(at(start_, "tessellate-for", c), "hit", hit);
                    points.push_back(at(at(point, "normals", normals), "shadows", shadows));
                }
            }
        }
    }
    std::vector<FrameTrial> met;
    for (const FrameTrial& t : run(points, false)) {
        if (goal_.accuracy.met_by(t.accuracy)) met.push_back(t);
    }
    std::stable_sort(met.begin(), met.end(),
                     [](const FrameTrial& a, const FrameTrial& b) { return a.voxel_bits < b.voxel_bits; });
    return met;
}

/// Those of the pictures that the fastest machine renders in time, the smallest first.
std::vector<FrameTrial> FrameSearch::in_time(std::vector<FrameTrial> pictures) {
    const auto late = [&](const FrameTrial& t) {
        return model_.loading_floor(t.point, t.most_voxels) > goal_.cycles;
    };
    // One is run even if none can be in time, to tell how near it comes.
    const auto hopeless = std::stable_partition(pictures.begin(), pictures.end(),
                                                [&](const FrameTrial& t) { return !late(t); });
    pictures.erase(std::max(hopeless, pictures.begin() + !pictures.empty()), pictures.end());
    if (pictures.size() > most_timed) pictures.resize(most_timed);
    model_.step_begins("accurate pictures in the fastest machine");
    std::vector<FramePoint> points;
    for (const FrameTrial& t : pictures) {
        FramePoint point = t.point;
        for (std::size_t i = 0; i < axes_.size(); ++i) {
            if (!axes_[i].picture) point[i] = axes_[i].values.size() - 1;
        }
        points.push_back(point);
    }
    std::vector<FrameTrial> met;
    for (const FrameTrial& t : run(points, true)) {
        if (t.meets) met.push_back(t);
    }
    std::stable_sort(met.begin(), met.end(), smaller);
    return met;
}

/// Tries the next two smaller values of an option, then on from the best. True: one was better.
bool FrameSearch::lower(FrameTrial& best, std::size_t i) {
    bool any = false;
    while (best.point[i] > 0) {
        std::vector<FramePoint> points;
        for (std::size_t step = 1; step <= std::min<std::size_t>(2, best.point[i]); ++step) {
            points.push_back(best.point);
            points.back()[i] -= step;
        }
        bool better = false;
        for (const FrameTrial& t : run(points, true)) {
            if (!t.meets || !smaller(t, best)) continue;
            best = t;
            better = any = true;
        }
        if (!better) break;
    }
    return any;
}

FrameTrial FrameSearch::reduced(FrameTrial best) {
    // Hit test, normals and shadows are given; finer polygons were tried beside them.
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < axes_.size(); ++i) {
        const std::string& option = axes_[i].option;
        const bool given =
            option == "hit" || option == "normals" || option == "shadows" || option == "tessellate-for";
        if (!given) order.push_back(i);
    }
    // What saves most comes first: the ray store, buffers, units.
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return axes_[a].picture < axes_[b].picture; });
    for (bool again = true; again;) {
        again = false;
        for (const std::size_t i : order) again = lower(best, i) || again;
    }
    return best;
}

std::optional<FrameTrial> FrameSearch::find() {
    std::vector<FrameTrial> fast = in_time(accurate_pictures());
    if (fast.size() > most_reduced) fast.resize(most_reduced);
    std::optional<FrameTrial> best;
    for (const FrameTrial& t : fast) {
        model_.step_begins("smaller machines");
        const FrameTrial least = reduced(t);
        if (!best || smaller(least, *best)) best = least;
    }
    return best;
}

const FrameTrial& FrameSearch::nearest() const {
    const auto rank = [&](const FrameTrial& t) {
        const bool accurate = goal_.accuracy.met_by(t.accuracy);
        // Cycles count only among those that are accurate enough, dB only among the others.
        return std::make_tuple(accurate, accurate && t.ended(),
                               accurate ? -double(t.cycles()) : t.accuracy.psnr_db);
    };
    return *std::max_element(tried_.begin(), tried_.end(),
                             [&](const FrameTrial& a, const FrameTrial& b) { return rank(a) < rank(b); });
}

std::vector<bool> pareto_front(const std::vector<FrameTrial>& trials) {
    const auto beats = [](const FrameTrial& a, const FrameTrial& b) {
        const bool as_good =
            a.bits <= b.bits && a.cycles() <= b.cycles() && a.accuracy.psnr_db >= b.accuracy.psnr_db;
        return as_good &&
               (a.bits < b.bits || a.cycles() < b.cycles() || a.accuracy.psnr_db > b.accuracy.psnr_db);
    };
    std::vector<bool> front;
    for (const FrameTrial& t : trials) {
        front.push_back(t.ended() && std::none_of(trials.begin(), trials.end(), [&](const FrameTrial& other) {
                            return other.ended() && beats(other, t);
                        }));
    }
    return front;
}

}  // namespace raycell
