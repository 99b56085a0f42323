#include "testbench/raycell/frames_report.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

#include "model/machine/frame_schedule.hpp"

namespace raycell {
namespace {

using Json = nlohmann::ordered_json;

/// Best first.
constexpr Verdict verdicts[] = {Verdict::completed, Verdict::capacity, Verdict::cycle_limit,
                                Verdict::livelock,  Verdict::deadlock, Verdict::interrupted};

bool ends(const Json& report) {
    const Verdict verdict = verdict_of(report);
    return verdict == Verdict::completed || verdict == Verdict::capacity;
}

/// Cycles of the frames; empty if they are not known of all.
std::vector<FrameCycles> cycles_of(const std::vector<Json>& reports) {
    std::vector<FrameCycles> all;
    for (const Json& report : reports) {
        const Json& cycles = report["cycles"];
        if (!ends(report) || cycles["total"] == 0) return {};
        const std::uint64_t trace =
            cycles["precast"].get<std::uint64_t>() + cycles["trace"].get<std::uint64_t>();
        all.push_back({cycles["load"].get<std::uint64_t>(), trace});
    }
    return all;
}

Json schedule_report(const std::vector<FrameCycles>& cycles, double clock_mhz) {
    if (cycles.empty()) return {};
    const std::vector<FrameTimes> times = schedule_of(cycles);
    const SteadyState steady = steady_state_of(cycles);
    const double hertz = clock_mhz * 1e6;
    const double period = double(steady.period);
    return {
        {"first_frame_cycles", times.front().done},
        {"total_cycles", times.back().done},
        {"cycles_per_frame", steady.cycles_per_frame()},
        {"frames_per_second", hertz / steady.cycles_per_frame()},
        {"binds", steady.binds()},
        {"frames_bound_by_load", steady.bound_by_load},
        {"utilisation", {{"load", double(steady.load) / period}, {"trace", double(steady.trace) / period}}},
        {"one_store",
         {{"cycles_per_frame", steady.cycles_with_one_store()},
          {"frames_per_second", hertz / steady.cycles_with_one_store()}}}};
}

/// Of each part the most that a frame needs: their cubes, and so their formats, differ.
Json second_store(const std::vector<Json>& reports) {
    Json most = reports.front()["second_store_bits"];
    for (const Json& report : reports) {
        for (const auto& [part, bits] : report["second_store_bits"].items())
            most[part] = std::max(most[part].get<std::int64_t>(), bits.get<std::int64_t>());
    }
    std::int64_t total = 0;
    for (const char* part : {"store", "buffer", "output", "control", "latches"})
        total += most[part].get<std::int64_t>();
    most["total"] = total;
    return most;
}

}  // namespace

Verdict verdict_of(const Json& report) {
    for (const Verdict verdict : verdicts) {
        if (report["verdict"] == name_of(verdict)) return verdict;
    }
    throw std::logic_error("internal error: a frame's report has an unknown verdict");
}

Verdict worst_of(const std::vector<Json>& reports) {
    const auto gravity = [](Verdict verdict) {
        return std::find(std::begin(verdicts), std::end(verdicts), verdict) - std::begin(verdicts);
    };
    Verdict worst = Verdict::completed;
    for (const Json& report : reports) {
        if (gravity(verdict_of(report)) > gravity(worst)) worst = verdict_of(report);
    }
    return worst;
}

Json frames_report(const std::vector<Json>& reports, double clock_mhz) {
    return {{"count", reports.size()},
            {"schedule", schedule_report(cycles_of(reports), clock_mhz)},
            {"second_store_bits", second_store(reports)}};
}

Json each_frame(const std::vector<Json>& reports) {
    const std::vector<FrameTimes> times = schedule_of(cycles_of(reports));
    Json each = Json::array();
    for (std::size_t i = 0; i < reports.size(); ++i) {
        const Json& report = reports[i];
        Json frame = {{"frame", i + 1}, {"verdict", report["verdict"]}, {"cycles", report["cycles"]}};
        frame["in_a_row"] = Json();
        if (!times.empty()) {
            const FrameTimes& t = times[i];
            frame["in_a_row"] = {{"load_begins", t.load_begins},
                                 {"load_ends", t.load_ends},
                                 {"trace_begins", t.trace_begins},
                                 {"done", t.done}};
        }
        frame["voxels"] = {{"stored", report["voxels"]["stored"]},
                           {"max_bits_per_cell", report["voxels"]["max_bits_per_cell"]}};
        frame["hash"] = report["hash"];
        if (report.contains("accuracy")) frame["accuracy"] = {{"psnr_db", report["accuracy"]["psnr_db"]}};
        each.push_back(std::move(frame));
    }
    return each;
}

std::string frames_summary(const Json& frames, Verdict worst, double clock_mhz) {
    std::ostringstream text;
    text << "verdict " << name_of(worst) << "; " << frames["count"] << " frames";
    const Json& schedule = frames["schedule"];
    if (!schedule.is_null()) {
        const std::string binds = schedule["binds"];
        text << "; cycles: first " << schedule["first_frame_cycles"] << ", then "
             << std::llround(schedule["cycles_per_frame"].get<double>()) << " a frame, bound by "
             << (binds == "both" ? "load and trace" : binds) << " ("
             << std::llround(schedule["one_store"]["cycles_per_frame"].get<double>()) << " with one store)\n"
             << schedule["frames_per_second"].get<double>() << " frames a second at " << clock_mhz << " MHz";
    }
    const Json& bits = frames["second_store_bits"];
    text << "\nsecond store of voxels: " << bits["store"]
         << " bits a cell; all to load beside the trace: " << bits["total"] << " bits, " << bits["wires"]
         << " wires\n";
    return text.str();
}

}  // namespace raycell
