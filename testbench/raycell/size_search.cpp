#include "testbench/raycell/size_search.hpp"

#include <algorithm>
#include <array>

#include "model/truth/rows.hpp"

namespace raycell {
namespace {

constexpr int threads = 2;

/// Short words have wide tolerances (Arithmetic::hair), so a cell may hold more voxels with them than with
/// longer words. Above this many bits (tolerance 0.002 cells) the longer word stores more.
constexpr int most_rough_words = 13;

SizeSetting with_words(SizeSetting setting, int word_bits) {
    setting.word_bits = word_bits;
    return setting;
}

SizeSetting with_levels(SizeSetting setting, int depth_levels) {
    setting.depth_levels = depth_levels;
    return setting;
}

/// Whether each number of depth levels has to be compared. Below `plane` a voxel is a box of depth levels:
/// fewer levels make it larger, and the picture better or worse.
bool compares_levels(HitTest hit) { return hit == HitTest::depth || hit == HitTest::interval; }

}  // namespace

SizeSearch::SizeSearch(const SizeModel& model, const SizeGoal& goal, std::vector<int> levels)
    : model_(model), goal_(goal), levels_(std::move(levels)) {}

void SizeSearch::run_all(const std::vector<SizeSetting>& settings) {
    std::vector<SizeSetting> fresh;
    for (const SizeSetting& setting : settings) {
        if (index_.count(setting)) continue;
        index_[setting] = tried_.size() + fresh.size();
        fresh.push_back(setting);
    }
    std::vector<SizeTrial> trials(fresh.size());
    for_each_row(int(fresh.size()), threads, {},
                 [&](int i) { trials[std::size_t(i)] = model_.run(fresh[std::size_t(i)]); });
    for (SizeTrial& trial : trials) {
        trial.meets = goal_.met_by(trial.accuracy);
        if (trial.meets && (!best_ || cost_of(trial.storage) < cost_of(tried_[*best_].storage))) {
            best_ = tried_.size();
        }
        tried_.push_back(std::move(trial));
    }
}

std::size_t SizeSearch::untried(const std::vector<SizeSetting>& settings) const {
    return std::size_t(std::count_if(settings.begin(), settings.end(),
                                     [this](const SizeSetting& s) { return index_.count(s) == 0; }));
}

const SizeTrial& SizeSearch::trial(const SizeSetting& setting) {
    run_all({setting});
    return tried_[index_.at(setting)];
}

/// The hit tests that come near the goal with the longest words, linear normals and a shadow ray per hit.
std::vector<SizeSearch::Combination> SizeSearch::reachable_rungs() {
    std::vector<SizeSetting> longest;
    for (const HitTest hit :
         {HitTest::depth, HitTest::interval, HitTest::plane, HitTest::mask, HitTest::edge}) {
        for (const int levels : levels_) {
            longest.push_back({hit, Normals::linear, Shadows::per_hit, levels, most_word_bits});
            if (!compares_levels(hit)) break;
        }
    }
    model_.step_begins({1, "hit tests", 0, longest.size()});
    run_all(longest);
    std::vector<Combination> rungs;
    for (const SizeSetting& setting : longest) {
        const SizeTrial& run = trial(setting);
        if (!goal_.nearly_met_by(run.accuracy)) continue;
        const bool known = !rungs.empty() && rungs.back().setting.hit == setting.hit;
        if (!known) rungs.push_back({setting, {}});
        Combination& rung = rungs.back();
        rung.levels.push_back(setting.depth_levels);
        if (run.accuracy.psnr_db > trial(rung.setting).accuracy.psnr_db) rung.setting = setting;
        if (!compares_levels(setting.hit)) rung.levels = levels_;
    }
    return rungs;
}

/// The combinations that come near the goal with the longest words, cheapest first. `memo` is left out: it
/// gives the picture of `precast` and keeps a bit more per source.
std::vector<SizeSearch::Combination> SizeSearch::reachable_combinations() {
    std::vector<Combination> all;
    for (const Combination& rung : reachable_rungs()) {
        for (const Normals normals : {Normals::voxel, Normals::linear}) {
            for (const Shadows shadows : {Shadows::per_hit, Shadows::precast}) {
                Combination combination = rung;
                combination.setting.normals = normals;
                combination.setting.shadows = shadows;
                all.push_back(combination);
            }
        }
    }
    std::vector<SizeSetting> longest;
    for (const Combination& combination : all) longest.push_back(combination.setting);
    model_.step_begins({2, "normals and shadows", 0, untried(longest)});
    run_all(longest);
    const auto beyond = [this](const Combination& c) {
        return !goal_.nearly_met_by(trial(c.setting).accuracy);
    };
    all.erase(std::remove_if(all.begin(), all.end(), beyond), all.end());
    std::map<SizeSetting, SizeCost> costs;
    for (const Combination& c : all)
        costs[c.setting] = cost_of(model_.storage(with_words(c.setting, most_rough_words)));
    std::stable_sort(all.begin(), all.end(), [&](const Combination& a, const Combination& b) {
        return costs.at(a.setting) < costs.at(b.setting);
    });
    return all;
}

/// Word lengths from `least` on, shortest first, with which the setting is smaller than the smallest machine
/// found.
std::vector<int> SizeSearch::affordable_words(const SizeSetting& setting, int least) const {
    std::vector<int> words;
    if (!best_) {
        for (int w = least; w <= most_word_bits; ++w) words.push_back(w);
        return words;
    }
    const SizeCost limit = cost_of(tried_[*best_].storage);
    const auto affordable = [&](int w) { return cost_of(model_.storage(with_words(setting, w))) < limit; };
    std::array<bool, most_word_bits + 1> rough{};
    for_each_row(std::max(0, most_rough_words + 1 - least), threads, {},
                 [&](int i) { rough[std::size_t(least + i)] = affordable(least + i); });
    for (int w = least; w <= most_rough_words; ++w) {
        if (rough[std::size_t(w)]) words.push_back(w);
    }
    for (int w = std::max(least, most_rough_words + 1); w <= most_word_bits && affordable(w); ++w) {
        words.push_back(w);
    }
    return words;
}

/// Finds the shortest of these words that meets the goal and, where shorter words store more, the cheapest.
void SizeSearch::search_words(const SizeSetting& setting, const std::vector<int>& words) {
    if (words.empty()) return;
    const auto at = [&](int i) { return with_words(setting, words[std::size_t(i)]); };
    int enough = int(words.size());
    run_all({at(enough - 1), at((enough - 1) / 2)});
    if (meets(at(enough - 1))) {
        --enough;
        int missing = -1;
        while (missing + 1 < enough) {
            const int third = std::max(1, (enough - missing) / 3);
            const int low = missing + third;
            const int high = std::min(low + third, enough - 1);
            run_all({at(low), at(high)});
            if (meets(at(low))) {
                enough = low;
            } else if (meets(at(high))) {
                missing = low;
                enough = high;
            } else {
                missing = high;
            }
        }
    }
    for (int i = enough - 1; i >= 0; --i) {
        if (!goal_.nearly_met_by(trial(at(i)).accuracy)) break;
    }
    for (int i = enough + 1; i < int(words.size()) && words[std::size_t(i)] <= most_rough_words; ++i) {
        if (cost_of(model_.storage(at(i))) < cost_of(tried_[*best_].storage)) run_all({at(i)});
    }
}

/// One bit more than the longest word that was tried with this setting and clearly missed the goal.
int SizeSearch::least_hopeful_words(const SizeSetting& setting) const {
    for (int words = most_word_bits; words >= least_word_bits; --words) {
        const auto found = index_.find(with_words(setting, words));
        if (found != index_.end() && !goal_.nearly_met_by(tried_[found->second].accuracy)) return words + 1;
    }
    return least_word_bits;
}

/// Searches the word bits for one number of depth levels; `combination` tells what more levels showed.
void SizeSearch::search_level(Combination& combination, int levels) {
    const SizeSetting setting = with_levels(combination.setting, levels);
    search_words(setting, affordable_words(setting, combination.least_words));
    if (compares_levels(setting.hit)) return;
    combination.least_words = std::max(combination.least_words, least_hopeful_words(setting));
}

/// Settings that are one step smaller in one respect.
std::vector<SizeSetting> SizeSearch::steps_down(const SizeSetting& setting) const {
    std::vector<SizeSetting> steps;
    if (setting.word_bits > least_word_bits) steps.push_back(with_words(setting, setting.word_bits - 1));
    const auto next = std::find_if(levels_.begin(), levels_.end(),
                                   [&](int levels) { return levels < setting.depth_levels; });
    if (next != levels_.end()) steps.push_back(with_levels(setting, *next));
    SizeSetting step = setting;
    step.normals = Normals::voxel;
    steps.push_back(step);
    step = setting;
    step.shadows = Shadows::per_hit;
    steps.push_back(step);
    step = setting;
    if (setting.hit != HitTest::depth) step.hit = HitTest(int(setting.hit) - 1);
    steps.push_back(step);
    return steps;
}

/// Goes on to a setting one step smaller while one meets the goal, so that in the end none does, even where
/// the assumptions of the search fail.
void SizeSearch::step_down() {
    std::optional<std::size_t> before;
    while (before != best_) {
        before = best_;
        const SizeCost limit = cost_of(tried_[*best_].storage);
        std::vector<SizeSetting> smaller;
        for (const SizeSetting& step : steps_down(tried_[*best_].setting)) {
            if (cost_of(model_.storage(step)) < limit) smaller.push_back(step);
        }
        run_all(smaller);
    }
}

std::optional<SizeTrial> SizeSearch::find() {
    std::vector<Combination> combinations = reachable_combinations();
    std::size_t parts = combinations.size();
    for (const Combination& c : combinations) {
        for (const int levels : c.levels) parts += levels != c.setting.depth_levels;
    }
    std::size_t part = 0;
    const auto search = [&](Combination& c, int levels) {
        model_.step_begins({3, "word lengths", ++part, parts});
        search_level(c, levels);
    };
    for (Combination& c : combinations) search(c, c.setting.depth_levels);
    for (Combination& c : combinations) {
        for (const int levels : c.levels) {
            if (levels != c.setting.depth_levels) search(c, levels);
        }
    }
    model_.step_begins({4, best_ ? "one step smaller" : "the nearest, with shorter words", 0, 0});
    if (!best_) try_all_words();
    if (!best_) return std::nullopt;
    step_down();
    return tried_[*best_];
}

/// The last attempt of a search in vain: shorter words may be lucky where the longest came nearest.
void SizeSearch::try_all_words() {
    std::vector<SizeSetting> settings;
    for (int words = most_word_bits - 1; words >= least_word_bits; --words)
        settings.push_back(with_words(nearest().setting, words));
    run_all(settings);
}

const SizeTrial& SizeSearch::nearest() const {
    // Compares the number of goals reached (one that was not set counts as reached), then the distance.
    const auto rank = [this](const SizeTrial& t) {
        const double psnr = t.accuracy.psnr_db;
        const double hits = -t.accuracy.wrong_hit_percent;
        const int reached = (psnr >= goal_.psnr_db) + (-hits <= goal_.wrong_hit_percent);
        return goal_.psnr_db > 0 ? std::make_tuple(reached, psnr, hits)
                                 : std::make_tuple(reached, hits, psnr);
    };
    const SizeTrial* nearest = nullptr;
    for (const SizeTrial& t : tried_) {
        if (!nearest || rank(t) > rank(*nearest)) nearest = &t;
    }
    return *nearest;
}

}  // namespace raycell
