// rtl_replay: drives a verilated cell with golden vectors and compares all that it does, cycle by cycle.
#include <cstdlib>
#include <cstring>
#include <deque>
#include <fstream>
#include <iostream>
#include <map>
#include <sstream>
#include <tuple>

#include "testbench/rtl/bench/coverage.hpp"
#include "testbench/rtl/bench/hex_record.hpp"

namespace rtl {
namespace {

constexpr const char* side_names[] = {"east", "south", "west", "north", "load"};
constexpr std::size_t most_differences = 10;

/// What a record begins with: its file, and the viewer's message for one in which it does not come.
struct Task {
    std::string path;
    std::string viewer;
};

class Replay {
  public:
    Replay(VerilatedContext& context, const HexRecord& record, const Task& task, Coverage& coverage)
        : record_(record), coverage_(coverage), cell_(context, record.x, record.y) {
        for (const Line& line : record.out) {
            if (line.what == What::pixel)
                pixels_.push_back(line);
            else
                expected_[{int(line.what), line.side, line.index}].push_back(line);
        }
        const bool comes = !record.in.empty() && record.in.front().what == What::in &&
                           bits_of(record.in.front().message, 0, 3) % 7 == 0 &&
                           record.in.front().bits > setup_bits;
        cell_.reset(comes ? "" : task.viewer);
    }

    std::vector<std::string> run(bool every_cycle) {
        std::size_t next = 0;
        int phase = 0;
        for (std::uint64_t now = 1; now <= record_.last && differences_.empty(); ++now) {
            if (!every_cycle && cell_.idle() && next < record_.in.size() && record_.in[next].cycle > now)
                now = record_.in[next].cycle;  // nothing happens before it
            else if (!every_cycle && cell_.idle() && next == record_.in.size())
                break;
            now_ = now;
            cell_.begin(now);
            bool begins = false;
            while (next < record_.in.size() && record_.in[next].cycle <= now) {
                const Line& line = record_.in[next++];
                if (line.what == What::in) cell_.in(line.side, line.index, line.link, line.message, line.id);
                if (line.what == What::free) cell_.free(line.side, line.index);
                if (line.what == What::drain) cell_.drain(line.index == 1);
                if (line.what == What::phase) phase = line.index, begins = true;
            }
            cell_.phase(phase, begins);
            cell_.settle();
            compare();
#ifdef RTL_WHOLE
            if (cell_.late()) differ("the microprograms took longer than the cost table says");
#endif
            coverage_.sample(cell_);
            cell_.clock();
            ++cycles_;
        }
        finish();
        return differences_;
    }
    std::uint64_t compared() const { return compared_; }
    std::uint64_t cycles() const { return cycles_; }

  private:
    void differ(const std::string& text) {
        if (differences_.size() < most_differences)
            differences_.push_back(record_.name + ": cycle " + std::to_string(now_) + ": " + text);
    }

    /// The next line of a buffer, if it is of this cycle.
    const Line* due(int what, int side, int index) {
        auto& lines = expected_[{what, side, index}];
        const std::string did = std::string(what == int(What::out) ? "out " : "take ") + side_names[side] +
                                " " + std::to_string(index);
        if (lines.empty()) return differ(did + ": nothing more is expected of it"), nullptr;
        if (lines.front().cycle != now_)
            return differ(did + ": expected in cycle " + std::to_string(lines.front().cycle)), nullptr;
        line_ = lines.front();
        lines.pop_front();
        ++compared_;
        return &line_;
    }

    void compare() {
        if (cell_.makes_voxel())
            differ(
                "a span begins in this cell, which can't make voxels: expected a record of a cell that no "
                "span begins in");
        for (int side = 0; side <= sides && cell_.takes_any(); ++side) {
            for (int index = 0; index < classes; ++index)
                if (cell_.takes(side, index)) due(int(What::take), side, index);
        }
        for (int side = 0; side < sides && cell_.sends_any(); ++side) {
            if (!cell_.sends(side)) continue;
            const Sent sent = cell_.sent(side);
            const Line* line = due(int(What::out), side, sent.index);
            if (!line) continue;
            const std::string what =
                std::string("out ") + side_names[side] + " " + std::to_string(sent.index) + ": ";
            if (int(line->link) != sent.cycles)
                differ(what + "cycles on the link are " + std::to_string(sent.cycles) + ", expected " +
                       std::to_string(line->link));
            const std::string difference =
                record_.difference(sent.message, line->message, cell_.top().phase == 0);
            if (!difference.empty()) differ(what + difference);
        }
        if (cell_.pixel()) compare_pixel();
        for (auto& [key, lines] : expected_) {
            if (lines.empty() || lines.front().cycle > now_) continue;
            differ(std::string(std::get<0>(key) == int(What::out) ? "out " : "take ") +
                   side_names[std::get<1>(key)] + " " + std::to_string(std::get<2>(key)) +
                   ": it did not do what was expected in cycle " + std::to_string(lines.front().cycle));
        }
    }

    void compare_pixel() {
        if (pixels_.empty()) return differ("pixel complete: none is expected");
        if (pixels_.front().cycle != now_)
            differ("pixel complete: expected in cycle " + std::to_string(pixels_.front().cycle));
        if (cell_.pixel_digits() != pixels_.front().message)
            differ("pixel is " + cell_.pixel_digits() + ", expected " + pixels_.front().message);
        pixels_.pop_front();
        ++compared_;
    }

    void finish() {
        if (!differences_.empty()) return;
        now_ = record_.last;
        for (const auto& [key, lines] : expected_) {
            if (!lines.empty())
                differ(std::string(side_names[std::get<1>(key)]) + " " + std::to_string(std::get<2>(key)) +
                       ": " + std::to_string(lines.size()) + " events never came, the first of cycle " +
                       std::to_string(lines.front().cycle));
        }
        if (!pixels_.empty())
            differ("its pixel was never complete, expected in cycle " +
                   std::to_string(pixels_.front().cycle));
    }

    const HexRecord& record_;
    Coverage& coverage_;
    VerilatedCell cell_;
    std::map<std::tuple<int, int, int>, std::deque<Line>> expected_;
    std::deque<Line> pixels_;
    Line line_;
    std::uint64_t now_ = 0;
    std::uint64_t compared_ = 0;
    std::uint64_t cycles_ = 0;
    std::vector<std::string> differences_;
};

/// Tasks from the lines of rtl_kit --setup: PATH X Y BITS DIGITS.
std::vector<Task> read_tasks(std::istream& in) {
    std::vector<Task> tasks;
    for (std::string text; std::getline(in, text);) {
        std::istringstream words(text);
        Task task;
        std::string x, y, bits;
        if (words >> task.path >> x >> y >> bits >> task.viewer) tasks.push_back(task);
    }
    return tasks;
}

int run(int argc, char** argv) {
    bool every_cycle = false, coverage_wanted = false;
    int fault = 0;
    for (int i = 1; i < argc; ++i) {
        const std::string word = argv[i];
        if (word == "--every-cycle")
            every_cycle = true;
        else if (word == "--coverage")
            coverage_wanted = true;
        else if (word == "--fault" && i + 1 < argc)
            fault = std::atoi(argv[++i]);
        else
            throw std::runtime_error("'" + word +
                                     "': expected --coverage, --every-cycle or --fault N, and lines of "
                                     "'rtl_kit --setup' as input");
    }
    VerilatedContext context;
#ifdef RTL_FAULTS
    fault_of_all = fault;
#else
    if (fault != 0)
        throw std::runtime_error("--fault: this cell was verilated without RTL_FAULTS; expected none");
#endif
    Coverage coverage;
    std::size_t files = 0, failed = 0;
    std::uint64_t compared = 0, cycles = 0;
    for (const Task& task : read_tasks(std::cin)) {
        const HexRecord record = read_record(task.path);
        Replay replay(context, record, task, coverage);
        const auto differences = replay.run(every_cycle);
        for (const std::string& difference : differences) std::cout << difference << '\n';
        ++files;
        failed += !differences.empty();
        compared += replay.compared();
        cycles += replay.cycles();
    }
    if (coverage_wanted) std::cout << coverage.table();
    std::cout << files << " records, " << failed << " with differences; " << compared << " events compared, "
              << cycles << " cycles of the cell run\n";
    return failed ? 2 : 0;
}

}  // namespace
}  // namespace rtl

int main(int argc, char** argv) {
    try {
        return rtl::run(argc, argv);
    } catch (const std::exception& error) {
        std::cerr << "rtl_replay: " << error.what() << '\n';
        return 1;
    }
}
