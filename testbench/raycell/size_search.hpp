// The search for the smallest machine that is accurate enough, apart from what a machine is: any model that
// tells the storage and the accuracy of a setting can be searched.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include "model/loading/voxel.hpp"
#include "model/picture/compare.hpp"
#include "model/settings/settings.hpp"

namespace raycell {

constexpr int least_word_bits = 8;
constexpr int most_word_bits = 32;

/// One machine in question.
struct SizeSetting {
    HitTest hit = HitTest::edge;
    Normals normals = Normals::linear;
    Shadows shadows = Shadows::per_hit;
    int depth_levels = 1024;
    int word_bits = 20;

    bool operator<(const SizeSetting& o) const {
        return std::tie(hit, normals, shadows, depth_levels, word_bits) <
               std::tie(o.hit, o.normals, o.shadows, o.depth_levels, o.word_bits);
    }
};

/// What is asked for.
struct SizeGoal {
    double psnr_db = 0;              ///< at least
    double wrong_hit_percent = 100;  ///< at most

    bool met_by(const Accuracy& a) const {
        return a.psnr_db >= psnr_db && a.wrong_hit_percent <= wrong_hit_percent;
    }
    /// Met, or missed by so little (1 dB, a fifth of the wrong hits) that a smaller machine may be lucky.
    bool nearly_met_by(const Accuracy& a) const {
        return a.psnr_db + 1 >= psnr_db && 0.8 * a.wrong_hit_percent <= wrong_hit_percent;
    }
};

/// What a run of a setting told.
struct SizeTrial {
    SizeSetting setting;
    StorageCounts storage;
    Accuracy accuracy;
    std::uint64_t image = 0;  ///< hash of its picture
    bool meets = false;       ///< the goal; set by the search
};

/// What is minimised: bits of the fullest cell, then of all cells.
using SizeCost = std::pair<std::uint64_t, std::uint64_t>;
inline SizeCost cost_of(const StorageCounts& storage) { return {storage.max_cell_bits, storage.bits}; }

/// Both functions are called from two threads at once.
class SizeModel {
  public:
    virtual ~SizeModel() = default;
    /// What the setting stores, cheaply: nothing is traced.
    virtual StorageCounts storage(const SizeSetting& setting) const = 0;
    virtual SizeTrial run(const SizeSetting& setting) const = 0;
};

/// Coarse to fine: hit tests, then normals and shadows with the longest words, then word bits, then depth
/// levels. Only what could be smaller than the smallest found so far is run. Rests on two things that are
/// nearly so (SizeGoal::nearly_met_by): more word bits are not worse; and at rungs with a plane more depth
/// levels are not worse. Whatever becomes of that, the machine found is the smallest of all that were run and
/// met the goal, and nothing one step smaller meets it. The settings tried, and their order, depend on the
/// model alone.
class SizeSearch {
  public:
    /// `levels`: what may be tried, most first, not empty.
    SizeSearch(const SizeModel& model, const SizeGoal& goal, std::vector<int> levels);

    /// The smallest setting that meets the goal, if any does. Call once.
    std::optional<SizeTrial> find();

    /// Every run, in order.
    const std::vector<SizeTrial>& tried() const { return tried_; }
    /// The run nearest to the goal.
    const SizeTrial& nearest() const;

  private:
    /// A hit test with its normals and shadows, which may meet the goal as far as is known.
    struct Combination {
        SizeSetting setting;      ///< with the longest words, and the depth levels that suit it best then
        std::vector<int> levels;  ///< worth trying beside those, most first
        int least_words = least_word_bits;  ///< shorter ones missed the goal clearly with more levels
    };

    void run_all(const std::vector<SizeSetting>& settings);
    const SizeTrial& trial(const SizeSetting& setting);
    bool meets(const SizeSetting& setting) { return trial(setting).meets; }
    std::vector<Combination> reachable_rungs();
    std::vector<Combination> reachable_combinations();
    std::vector<int> affordable_words(const SizeSetting& setting, int least) const;
    int least_hopeful_words(const SizeSetting& setting) const;
    void search_words(const SizeSetting& setting, const std::vector<int>& words);
    void search_level(Combination& combination, int levels);
    std::vector<SizeSetting> steps_down(const SizeSetting& setting) const;
    void step_down();
    void try_all_words();

    const SizeModel& model_;
    const SizeGoal goal_;
    const std::vector<int> levels_;
    std::vector<SizeTrial> tried_;
    std::map<SizeSetting, std::size_t> index_;  ///< into tried_
    std::optional<std::size_t> best_;           ///< index into tried_
};

}  // namespace raycell
