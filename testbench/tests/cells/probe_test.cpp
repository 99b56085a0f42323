// Waveforms: a dump must equal what link and cell observers recorded.
#include "cells/probes/probe.hpp"

#include <deque>
#include <sstream>

#include "../vcd.hpp"
#include "elaboration.hpp"

namespace raycell {
namespace {

constexpr std::uint64_t period_ps = 50000;

/// The expected signals of a buffer, computed from its sends and pops alone.
struct BufferRecord {
    struct Entry {
        Cycle visible;
        std::string ray;
    };
    std::map<Cycle, int> steps;  ///< change of occupancy by cycle
    std::vector<std::pair<Cycle, Entry>> sends;
    std::vector<Cycle> pops;

    /// The changes of `values` by cycle, without repeated values.
    static std::vector<vcd::Change> thinned(const std::string& first,
                                            const std::map<Cycle, std::string>& values) {
        std::vector<vcd::Change> changes = {{0, first}};
        for (const auto& [cycle, value] : values) {
            if (value != changes.back().value) changes.push_back({cycle, value});
        }
        return changes;
    }
    std::vector<vcd::Change> occupancy() const {
        std::map<Cycle, std::string> values;
        int count = 0;
        for (const auto& [cycle, step] : steps) {
            count += step;
            std::string digits;
            for (int rest = count; rest > 0 || digits.empty(); rest /= 2) {
                digits.insert(digits.begin(), char('0' + rest % 2));
            }
            values[cycle] = digits;
        }
        return thinned("0", values);
    }
    /// Ids of the message at the head. Message i is the head from its arrival or the pop of the message
    /// before, whichever is later, until its own pop.
    std::vector<vcd::Change> head() const {
        std::map<Cycle, std::string> values;
        for (std::size_t i = 0; i < sends.size(); ++i) {
            const Cycle from = std::max(sends[i].second.visible, i > 0 ? pops.at(i - 1) : 0);
            values[from] = sends[i].second.ray;
            if (i < pops.size()) values[pops[i]] = "-";
        }
        return thinned("-", values);
    }
};

/// Records events on the links into one cell, and the cell's own events.
struct Record : LinkObserver, CellObserver {
    std::map<std::pair<const Link*, int>, BufferRecord> buffers;
    std::vector<std::tuple<Cycle, CellEvent, std::uint64_t, std::uint32_t>> events;
    const Cell* cell = nullptr;

    void sent(const Link& link, int index, const Message& message, int cycles, Cycle now) override {
        BufferRecord& buffer = buffers[{&link, index}];
        const std::string ray = message.kind == Message::Kind::ray      ? ray_name(message.ray->ray.id)
                                : message.kind == Message::Kind::answer ? ray_name(message.answer->id)
                                                                        : "-";
        buffer.sends.push_back({now, {now + Cycle(cycles), ray}});
        ++buffer.steps[now];
    }
    void popped(const Link& link, int index, const Message&, Cycle now) override {
        buffers[{&link, index}].pops.push_back(now);
        --buffers[{&link, index}].steps[now];
    }
    void cell_event(const Cell& which, Cycle now, CellEvent event, std::uint64_t ray,
                    std::uint32_t detail) override {
        if (&which == cell) events.emplace_back(now, event, ray, detail);
    }
};

struct Probed {
    explicit Probed(const std::string& scene, int size, const std::vector<std::pair<int, int>>& cells,
                    const ProbeSettings& window, const std::function<void(MachineSettings&)>& change) {
        expect_first_elaboration();
        settings.width = settings.height = size;
        change(machine);
        placed = place_own_scene(scene, settings);
        timed =
            std::make_unique<Machine>("machine", placed->scene, settings, machine, placed->exterior.get());
        std::vector<const Cell*> watched;
        for (const auto& [x, y] : cells) watched.push_back(&timed->array().cell(x, y));
        file = std::tmpfile();
        probe = std::make_unique<Probe>(watched, timed->environment(), file, window,
                                        [this](const std::string& warning) { warnings.push_back(warning); });
        timed->environment().scheduler.set_sampler([this](Cycle now) { probe->sample(now); });
    }
    ~Probed() { std::fclose(file); }
    vcd::Dump run() {
        result = timed->run();
        last = timed->environment().scheduler.now();
        probe->finish(last);
        std::rewind(file);
        char part[4096];
        for (std::size_t n = 0; (n = std::fread(part, 1, sizeof part, file)) > 0;) text.append(part, n);
        return vcd::parse(text, period_ps);
    }
    PictureSettings settings;
    MachineSettings machine;
    std::unique_ptr<PlacedScene> placed;
    std::unique_ptr<Machine> timed;
    std::FILE* file = nullptr;
    std::unique_ptr<Probe> probe;
    std::vector<std::string> warnings;
    std::string text;
    RunResult result;
    Cycle last = 0;
};

constexpr const char* sides[] = {"east", "south", "west", "north"};

/// Runs still_life and compares every buffer of an inner cell with the record.
void expect_buffers_as_recorded(Networks networks, int depth) {
    Probed probed("still_life", 16, {{12, 10}, {8, 9}}, ProbeSettings(), [&](MachineSettings& m) {
        m.networks = networks;
        m.buffer_depth = depth;
    });
    Record record;
    const Cell& cell = probed.timed->array().cell(12, 10);
    record.cell = &cell;
    std::vector<Link*> into;
    for (std::size_t i = 0; i < probed.timed->array().links().size(); ++i) {
        if (probed.timed->array().sink_of(i) != 10 * 16 + 12) continue;
        into.push_back(&probed.timed->array().links()[i]);
        into.back()->set_observer(&record);
    }
    probed.timed->environment().meters.observer = &record;
    const vcd::Dump dump = probed.run();
    ASSERT_EQ(probed.result.verdict, Verdict::completed);
    std::size_t moved = 0;
    for (int side = 0; side < side_count; ++side) {
        for (const Link* link : into) {
            if (static_cast<const LinkIn*>(link) != cell.input(Side(side))) continue;
            for (int index = 0; index < link->classes(); ++index) {
                const BufferRecord& buffer = record.buffers[{link, index}];
                const std::string path =
                    std::string("raycell.cell_12_10.") + sides[side] + "." + class_name(networks, index);
                if (dump.kinds.count(path + ".occupancy") == 0) {
                    EXPECT_TRUE(buffer.sends.empty()) << path << " carries messages and has no signal";
                    continue;
                }
                moved += buffer.sends.size();
                EXPECT_EQ(dump.of(path + ".occupancy"), buffer.occupancy()) << path;
                EXPECT_EQ(dump.of(path + ".ray"), buffer.head()) << path;
            }
        }
    }
    EXPECT_GT(moved, 100u);
    std::size_t tested = 0;
    std::size_t accepted = 0;
    for (const auto& [now, event, ray, detail] : record.events) {
        if (event == CellEvent::test) {
            ++tested;
            const std::string units = "raycell.cell_12_10.traversal_";
            const std::string unit = units + (dump.at(units + "0.ray", now) == ray_name(ray) ? "0" : "1");
            EXPECT_EQ(dump.at(unit + ".ray", now), ray_name(ray));
            EXPECT_EQ(dump.at(unit + ".state", now), "busy");
        } else if (event == CellEvent::accept) {
            ++accepted;
            const std::string slot = "raycell.cell_12_10.ray_store.slot_" + std::to_string(detail);
            EXPECT_EQ(dump.at(slot + ".ray", now), ray_name(ray));
        }
    }
    EXPECT_GT(tested, 10u);
    EXPECT_GT(accepted, 0u);
}

TEST(TimedProbe, ShowsEveryBufferOfOneMessageAsItsSendsAndPopsSay) {
    expect_buffers_as_recorded(Networks::half, 1);
}

TEST(TimedProbe, ShowsEveryBufferOfThreeMessagesAsItsSendsAndPopsSay) {
    expect_buffers_as_recorded(Networks::half, 3);
}

TEST(TimedProbe, ShowsEveryBufferOfFourClassesAsItsSendsAndPopsSay) {
    expect_buffers_as_recorded(Networks::quadrant, 1);
}

TEST(TimedProbe, AWindowHasTheWholeRunsValuesInItsCyclesAndNoOthers) {
    const ProbeSettings window{154287, 157632, 1024000000};
    Probed probed("still_life", 16, {{12, 10}}, window, [](MachineSettings& m) {
        m.loading_units = m.traversal_units = m.buffer_depth = 1;
        m.exterior_processors = 64;
    });
    // A second probe of the same run records all cycles.
    std::FILE* whole_file = std::tmpfile();
    Probe whole({&probed.timed->array().cell(12, 10)}, probed.timed->environment(), whole_file,
                ProbeSettings(), [](const std::string&) {});
    probed.timed->environment().scheduler.set_sampler([&](Cycle now) {
        probed.probe->sample(now);
        whole.sample(now);
    });
    const vcd::Dump part = probed.run();
    whole.finish(probed.last);
    std::rewind(whole_file);
    std::string text;
    char piece[4096];
    for (std::size_t n = 0; (n = std::fread(piece, 1, sizeof piece, whole_file)) > 0;) text.append(piece, n);
    std::fclose(whole_file);
    const vcd::Dump all = vcd::parse(text, period_ps);
    ASSERT_GT(probed.last, window.to);
    EXPECT_EQ(part.stamps.front(), window.from);
    EXPECT_EQ(part.stamps.back(), window.to + 1) << "the last cycle's values last to its end";
    std::size_t changes = 0;
    for (const auto& [path, values] : part.changes) {
        std::vector<vcd::Change> expected = {{window.from, all.at(path, window.from)}};
        for (const vcd::Change& change : all.of(path)) {
            if (change.cycle > window.from && change.cycle <= window.to) expected.push_back(change);
        }
        EXPECT_EQ(values, expected) << path;
        changes += values.size() - 1;
    }
    EXPECT_GT(changes, 10u);
}

std::vector<std::pair<int, int>> all_cells(int size) {
    std::vector<std::pair<int, int>> cells;
    for (int y = 0; y < size; ++y) {
        for (int x = 0; x < size; ++x) cells.emplace_back(x, y);
    }
    return cells;
}

/// Number of heads that wait for each cause at the end of a deadlock. A buffer without a head must show no
/// stall.
std::map<std::string, int> causes_at_end(const Probed& probed, const vcd::Dump& dump) {
    std::map<std::string, int> causes;
    for (const auto& [path, changes] : dump.changes) {
        const std::string ending = ".type";
        if (path.size() < ending.size() || path.substr(path.size() - ending.size()) != ending) continue;
        const std::string stall_path = path.substr(0, path.size() - ending.size()) + ".stall";
        const std::string stall = dump.at(stall_path, probed.last);
        if (changes.back().value == "none") {
            EXPECT_EQ(stall, "none") << path;
        } else {
            ++causes[stall];
        }
    }
    return causes;
}

TEST(TimedProbe, HeadsInADeadlockOfSharedBuffersWaitForRoomAndForNothingThatPasses) {
    Probed probed("facing_mirrors", 24, all_cells(24), ProbeSettings(),
                  [](MachineSettings& m) { m.networks = Networks::shared, m.buffer_depth = 1; });
    const vcd::Dump dump = probed.run();
    ASSERT_EQ(probed.result.verdict, Verdict::deadlock);
    auto causes = causes_at_end(probed, dump);
    EXPECT_GT(causes["output_full"], 0);
    for (const char* passing : {"none", "traversal", "output_busy", "store_port", "answer_busy", "no_slot"}) {
        EXPECT_EQ(causes[passing], 0) << passing;
    }
}

TEST(TimedProbe, HeadsInADeadlockOfFullRayStoresWaitForSlots) {
    Probed probed("facing_mirrors", 28, all_cells(28), ProbeSettings(), [](MachineSettings& m) {
        m.ray_store = 1;
        m.recovery = Recovery::none;
    });
    const vcd::Dump dump = probed.run();
    ASSERT_EQ(probed.result.verdict, Verdict::deadlock);
    auto causes = causes_at_end(probed, dump);
    EXPECT_GT(causes["no_slot"], 0);
    for (const char* passing : {"none", "traversal", "output_busy", "store_port", "answer_busy"}) {
        EXPECT_EQ(causes[passing], 0) << passing;
    }
}

TEST(TimedProbe, ADumpEndsAtItsLimitBetweenTwoCyclesAndWarnsBeforeAndThen) {
    ProbeSettings small;
    small.limit = 200000;
    Probed probed("still_life", 16, {{6, 8}, {7, 9}, {8, 9}, {9, 10}}, small, [](MachineSettings&) {});
    const vcd::Dump dump = probed.run();
    EXPECT_EQ(probed.result.verdict, Verdict::completed);
    EXPECT_LE(probed.text.size(), small.limit);
    ASSERT_EQ(probed.warnings.size(), 2u);
    EXPECT_NE(probed.warnings[0].find("it ends at --vcd-limit"), std::string::npos) << probed.warnings[0];
    const std::string at = "ends before cycle " + std::to_string(dump.stamps.back());
    EXPECT_NE(probed.warnings[1].find(at), std::string::npos) << probed.warnings[1];
    ASSERT_EQ(dump.comments.size(), 2u);
    EXPECT_NE(dump.comments[1].find("stopped before cycle " + std::to_string(dump.stamps.back())),
              std::string::npos);
    EXPECT_LT(dump.stamps.back(), probed.last);
}

}  // namespace
}  // namespace raycell
