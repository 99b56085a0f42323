#include "testbench/common/cells_csv.hpp"

#include <charconv>

namespace raycell {
namespace {

/// Peak and mean of a cell's buffers of one sort.
struct BufferUse {
    int peak = 0;
    int buffers = 0;
    std::uint64_t occupied_cycles = 0;

    void add(const Link::ClassStatistics& s) {
        peak = std::max(peak, s.peak);
        ++buffers;
        occupied_cycles += s.occupied_cycles;
    }
    double mean(Cycle cycles) const {
        return buffers > 0 && cycles > 0 ? double(occupied_cycles) / (double(buffers) * double(cycles)) : 0.0;
    }
};

struct Inputs {
    BufferUse rays;  ///< with `shared`, all messages
    BufferUse answers;
    std::uint64_t busy_cycles = 0;
};

/// For each cell, its links from neighbours.
std::vector<Inputs> inputs_of(Machine& machine) {
    const Array& array = machine.array();
    const BufferClasses& classes = machine.environment().classes;
    std::vector<Inputs> inputs(array.cells().size());
    for (std::size_t i = 0; i < array.links().size(); ++i) {
        const Link& link = array.links()[i];
        Inputs& cell = inputs[array.sink_of(i)];
        const Side side = array.side_of(i);
        const bool horizontal = side == Side::east || side == Side::west;
        for (int index = 0; index < link.classes(); ++index) {
            if (!classes.used(index, horizontal, side)) continue;
            const bool answers = !classes.holds_rays(index);
            (answers ? cell.answers : cell.rays).add(link.statistics(index));
        }
        cell.busy_cycles += link.busy_cycles();
    }
    return inputs;
}

/// The fields of one line.
class Line {
  public:
    explicit Line(std::string& text) : text_(text) {}
    ~Line() { text_.back() = '\n'; }
    Line(const Line&) = delete;
    Line& operator=(const Line&) = delete;

    Line& operator<<(std::uint64_t value) {
        text_ += std::to_string(value) + ",";
        return *this;
    }
    Line& operator<<(int value) { return *this << std::uint64_t(value); }
    Line& operator<<(double value) {
        char digits[32];
        constexpr int places = 7;
        text_.append(
            digits,
            std::to_chars(digits, digits + sizeof digits, value, std::chars_format::general, places).ptr);
        text_ += ',';
        return *this;
    }

  private:
    std::string& text_;
};

}  // namespace

std::string cells_csv_header() {
    std::string text =
        "x,y,voxels,edges,ray_store_peak,ray_store_mean,ray_buffers_peak,ray_buffers_mean,"
        "answer_buffers_peak,answer_buffers_mean,link_busy_cycles,traversal_cycles,shading_cycles,loading_"
        "cycles,hops_load,"
        "hops_ray,hops_return,postponed,stall_cycles";
    for (std::size_t cause = 1; cause <= stall_causes; ++cause) {
        text += std::string(",stall_") + stall_names[cause];
    }
    return text + '\n';
}

std::vector<std::string> cells_csv_rows(Machine& machine, const RunResult& result) {
    std::vector<std::string> rows(machine.environment().share.rows().size());
    const Cycle now = machine.environment().scheduler.now();
    const Cycle cycles = result.precast_cycles + result.trace_cycles;
    const std::vector<Inputs> inputs = inputs_of(machine);
    for (std::size_t i = 0; i < inputs.size(); ++i) {
        const Cell& cell = machine.array().cells()[i];
        const Inputs& in = inputs[i];
        const CellStatistics s = cell.statistics(now);
        std::uint64_t stalls = 0;
        for (const std::uint64_t cycles_of_cause : s.stalls) stalls += cycles_of_cause;
        const double stored =
            result.trace_cycles > 0 ? double(s.slot_cycles) / double(result.trace_cycles) : 0.0;
        Line line(rows[i / std::size_t(machine.environment().width())]);
        line << cell.x() << cell.y() << std::uint64_t(cell.store().voxels.size())
             << std::uint64_t(cell.store().edges.size()) << cell.ray_store().peak() << stored << in.rays.peak
             << in.rays.mean(cycles) << in.answers.peak << in.answers.mean(cycles) << in.busy_cycles
             << s.traversal_cycles << s.shading_cycles << s.loading_cycles << s.load_hops << s.ray_hops
             << s.return_hops << s.postponed << stalls;
        for (std::size_t cause = 1; cause <= stall_causes; ++cause) line << s.stalls[Stall(cause)];
    }
    return rows;
}

std::string cells_csv(const UntimedMachine& machine) {
    std::string text = "x,y,voxels,edges\n";
    const auto width = std::size_t(machine.context().scene.frame.width);
    for (std::size_t i = 0; i < machine.cells().size(); ++i) {
        const CellStore& store = machine.cells()[i];
        Line(text) << std::uint64_t(i % width) << std::uint64_t(i / width)
                   << std::uint64_t(store.voxels.size()) << std::uint64_t(store.edges.size());
    }
    return text;
}

}  // namespace raycell
