// The search for the smallest machine that is accurate enough. It works on any model that gives the storage
// and the accuracy of a setting.
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

/// The setting of one candidate machine.
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

/// The accuracy that is wanted.
struct SizeGoal {
    double psnr_db = 0;              ///< at least
    double wrong_hit_percent = 100;  ///< at most

    bool met_by(const Accuracy& a) const {
        return a.psnr_db >= psnr_db && a.wrong_hit_percent <= wrong_hit_percent;
    }
    /// Met, or missed by so little (1 dB, a fifth of the wrong hits) that a smaller machine may meet it by
    /// luck.
    bool nearly_met_by(const Accuracy& a) const {
        return a.psnr_db + 1 >= psnr_db && 0.8 * a.wrong_hit_percent <= wrong_hit_percent;
    }
};

/// The result of running a setting.
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

/// How far a search is.
struct SizeStep {
    static constexpr int count = 4;
    int number;         ///< from 1 to `count`
    const char* what;   ///< what it tries
    std::size_t part;   ///< step 3: from 1 to `parts`, settings whose words are searched
    std::size_t parts;  ///< steps 1 and 2: runs
};

/// storage() and run() are called from two threads at once.
class SizeModel {
  public:
    virtual ~SizeModel() = default;
    /// What the setting stores. Cheap: nothing is traced.
    virtual StorageCounts storage(const SizeSetting& setting) const = 0;
    virtual SizeTrial run(const SizeSetting& setting) const = 0;
    /// The search begins a step, or a part of it; for showing how far it is.
    virtual void step_begins(const SizeStep& /*step*/) const {}
};

/// Searches from coarse to fine: hit tests, then normals and shadows with the longest words, then word bits,
/// then depth levels. Runs only what could be smaller than the smallest machine found so far. Relies on two
/// assumptions that are nearly true (SizeGoal::nearly_met_by): more word bits are not worse, and at rungs
/// with a plane more depth levels are not worse. Even where they fail, the machine found is the smallest of
/// all that were run and met the goal, and nothing one step smaller meets it. The settings tried, and their
/// order, depend on the model alone.
class SizeSearch {
  public:
    /// `levels`: numbers of depth levels to try, most first, not empty.
    SizeSearch(const SizeModel& model, const SizeGoal& goal, std::vector<int> levels);

    /// The smallest setting that meets the goal, if any does. Call once.
    std::optional<SizeTrial> find();

    /// Every run, in order.
    const std::vector<SizeTrial>& tried() const { return tried_; }
    /// The run nearest to the goal.
    const SizeTrial& nearest() const;

  private:
    /// A hit test with its normals and shadows that, as far as is known, may meet the goal.
    struct Combination {
        SizeSetting setting;      ///< with the longest words and the depth levels that are best with them
        std::vector<int> levels;  ///< depth levels worth trying beside those, most first
        int least_words = least_word_bits;  ///< with more levels, shorter words clearly missed the goal
    };

    void run_all(const std::vector<SizeSetting>& settings);
    std::size_t untried(const std::vector<SizeSetting>& settings) const;
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
