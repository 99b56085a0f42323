// The state of a loaded machine apart from its voxels. A run that starts with a saved array goes on in the
// same cycles, with the same schedule and the same loading figures, as the run that saved it.
#include "pipeline/loaded_state.hpp"

#include <cmath>
#include <cstring>
#include <stdexcept>

namespace raycell {
namespace {

/// Visits the counts in a fixed order, to save or to restore them.
class Counts {
  public:
    Counts(std::vector<std::uint64_t>& counts, bool taking) : counts_(counts), taking_(taking) {}
    template <typename T>
    void visit(T& value) {
        if (!taking_) {
            counts_.push_back(std::uint64_t(value));
        } else {
            if (at_ == counts_.size()) throw std::runtime_error("a loaded array: counts are missing");
            value = T(counts_[at_++]);
        }
    }
    void visit_real(double& value) {
        std::uint64_t bits = 0;
        std::memcpy(&bits, &value, sizeof bits);
        visit(bits);
        std::memcpy(&value, &bits, sizeof value);
    }
    void finish() const {
        if (taking_ && at_ != counts_.size()) throw std::runtime_error("a loaded array: too many counts");
    }

  private:
    std::vector<std::uint64_t>& counts_;
    bool taking_;
    std::size_t at_ = 0;
};

void visit_stage(Counts& counts, StageStatistics& stage) {
    counts.visit(stage.items);
    counts.visit(stage.busy_cycles);
}

/// Checks counts that must agree in a machine of `cells` cells at the end of loading. Throws
/// std::runtime_error if they do not.
void check_loading(const Counters& c, Cycle now, std::size_t cells, const RunResult& result) {
    constexpr Cycle most = Cycle(1) << 62;  // far below the largest Cycle
    const double mean = result.buffers.front().mean;
    const bool times = now <= most && result.load_cycles <= now && c.last_progress <= now;
    const bool messages = c.loads_sent == c.loads_delivered && c.cells_loaded == cells;
    if (!times || !messages || !(mean >= 0) || !std::isfinite(mean))
        throw std::runtime_error("a loaded array: its cycles and messages contradict each other");
}

void visit_loading(MachineParts& parts, std::vector<std::uint64_t>& numbers, bool taking, RunResult& result) {
    Counts counts(numbers, taking);
    Cycle now = parts.scheduler.now();
    counts.visit(now);
    parts.scheduler.set_now(now);
    counts.visit(result.load_cycles);
    Binding& binding = result.load_binding;
    counts.visit(binding.unit);
    counts.visit(binding.x);
    counts.visit(binding.y);
    counts.visit(binding.side);
    counts.visit(binding.cycles);
    StageStatistics stages[] = {parts.geometry(), parts.precomputation(), parts.distribution.statistics()};
    for (StageStatistics& stage : stages) visit_stage(counts, stage);
    if (taking) {
        // Only the sums over lanes and rows matter. There is a lane: ranks, which may have none, load no
        // arrays.
        parts.lanes.front()->geometry.restore(stages[0]);
        parts.lanes.front()->precomputation.restore(stages[1]);
        parts.distribution.row(0).restore(stages[2]);
    }
    Counters& c = parts.environment.meters.counters;
    for (std::uint64_t* count : {&c.load_hops, &c.loads_sent, &c.loads_delivered, &c.cells_loaded,
                                 &c.most_kept, &c.most_load_bits, &c.last_progress})
        counts.visit(*count);
    counts.visit(result.buffers.front().peak);
    counts.visit_real(result.buffers.front().mean);
    for (Cell& cell : parts.array.cells()) {
        Cell::Loading loading = cell.loading();
        counts.visit(loading.hash);
        counts.visit(loading.hops);
        counts.visit(loading.cycles);
        cell.restore(loading);
    }
    counts.finish();
    if (taking) check_loading(c, now, parts.array.cells().size(), result);
}

}  // namespace

void expect_loaded_for(const MachineParts& parts, const LoadedArray& array) {
    if (array.key != loading_key(parts.environment.context.scene, parts.environment.settings) ||
        array.cells.size() != parts.array.cells().size())
        throw std::invalid_argument("a loaded array of another scene, size or voxels");
}

void hand_over_loaded(MachineParts& parts, RunResult& result,
                      const std::function<void(const LoadedArray&)>& to) {
    LoadedArray array;
    array.key = loading_key(parts.environment.context.scene, parts.environment.settings);
    array.timing = loading_timing(parts.environment.machine);
    visit_loading(parts, array.counts, false, result);
    for (Cell& cell : parts.array.cells()) array.cells.push_back(std::move(cell.store()));
    to(array);
    for (std::size_t i = 0; i < array.cells.size(); ++i)
        parts.array.cells()[i].store() = std::move(array.cells[i]);
}

void start_loaded(MachineParts& parts, LoadedArray& array, RunResult& result) {
    const bool same = array.timing == loading_timing(parts.environment.machine);
    result.loading = same ? LoadedBy::saved : LoadedBy::saved_other_timing;
    result.buffers.push_back({"load", 0, 0});
    visit_loading(parts, array.counts, true, result);
    for (std::size_t i = 0; i < array.cells.size(); ++i)
        parts.array.cells()[i].store() = std::move(array.cells[i]);
}

}  // namespace raycell
