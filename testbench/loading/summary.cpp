// The summary of a run for people, made from its JSON.
#include <algorithm>
#include <iomanip>
#include <sstream>

#include "testbench/loading/report.hpp"

namespace raycell::loading {
namespace {

using Json = nlohmann::ordered_json;

std::string percent(const Json& share) {
    std::ostringstream text;
    text << std::fixed << std::setprecision(1) << 100 * share.get<double>() << " %";
    return text.str();
}

std::string fixed(const Json& number) {
    std::ostringstream text;
    text << std::fixed << std::setprecision(2) << number.get<double>();
    return text.str();
}

void add_stages(std::ostream& out, const Json& stages) {
    out << "\nstage             units    messages     busy  busiest unit                     starved  "
           "blocked\n";
    for (const auto& [name, s] : stages.items()) {
        out << std::left << std::setw(15) << name << std::right << std::setw(8) << s["units"].dump()
            << std::setw(12) << s["messages"].dump() << std::setw(9) << percent(s["busy_share"]) << "  "
            << std::left << std::setw(24) << s["busiest"].get<std::string>() << std::right << std::setw(7)
            << percent(s["busiest_share"]) << std::setw(9) << percent(s["starved_share"]) << std::setw(9)
            << percent(s["blocked_share"]) << '\n';
        if (!s.contains("voxels")) continue;
        const Json& v = s["voxels"];  // a cell makes them beside its other work
        out << "  their voxels " << std::setw(8) << s["units"].dump() << std::setw(12) << v["spans"].dump()
            << std::setw(9) << percent(v["busy_share"]) << "  " << std::left << std::setw(24)
            << v["busiest"].get<std::string>() << std::right << std::setw(7) << percent(v["busiest_share"])
            << "   at most " << v["most_kept"] << " spans in a cell\n";
    }
}

void add_links(std::ostream& out, const Json& links) {
    out << "\nlinks            number    messages     busy  busiest link                    depth  peak  "
           "mean  fullest\n";
    for (const auto& [name, l] : links.items()) {
        if (l["links"] == 0) continue;
        const Json& o = l["occupancy"];
        out << std::left << std::setw(15) << name << std::right << std::setw(8) << l["links"].dump()
            << std::setw(12) << l["messages"].dump() << std::setw(9) << percent(l["busy_share"]) << "  "
            << std::left << std::setw(24) << l["busiest"].get<std::string>() << std::right << std::setw(7)
            << percent(l["busiest_share"]) << std::setw(6) << l["depth"].dump() << std::setw(6)
            << o["peak"].dump() << std::setw(6) << fixed(o["mean"]) << std::setw(9)
            << fixed(o["fullest_mean"]) << '\n';
    }
}

void add_waits(std::ostream& out, const Json& stages) {
    out << "\nwaits, cycles over all units     output full  output busy\n";
    const auto line = [&](const std::string& name, const Json& w) {
        out << std::left << std::setw(29) << name << std::right << std::setw(15) << w["output_full"].dump()
            << std::setw(13) << w["output_busy"].dump() << '\n';
    };
    for (const auto& [name, s] : stages.items()) {
        const Json& w = s["waits"];
        if (w.contains("queue_full") && w["queue_full"] > 0)
            out << std::left << std::setw(29) << name + ", no place in them" << std::right << std::setw(15)
                << w["queue_full"].dump() << '\n';
        if (w.contains("output_full")) {
            line(name, w);
        } else {
            for (const auto& [output, waits] : w.items()) line(name + ", " + output, waits);
        }
    }
}

/// At most nine columns, evenly spaced, the first and the last among them.
void add_wavefront(std::ostream& out, const Json& wavefront) {
    const Json& first = wavefront["first_arrival"];
    const Json& last = wavefront["last_arrival"];
    const std::size_t columns = first.size();
    const std::size_t shown = std::min<std::size_t>(columns, 9);
    out << "\nwavefront, column: first, last arrival\n ";
    for (std::size_t i = 0; i < shown; ++i) {
        const std::size_t x = shown == 1 ? 0 : i * (columns - 1) / (shown - 1);
        if (first[x].is_null()) continue;
        out << ' ' << x << ": " << first[x] << ", " << last[x] << (i + 1 < shown ? ";" : "\n");
    }
}

/// Bins that double: 0, 1, 2, 3-4, 5-8, ...
void add_voxels(std::ostream& out, const Json& voxels) {
    out << "\nvoxels per cell: most " << voxels["max_per_cell"] << ", mean of occupied cells "
        << fixed(voxels["mean_per_occupied_cell"]) << ", did not fit " << voxels["overflowed"] << "\n ";
    std::uint64_t low = 0;
    std::uint64_t high = 0;
    std::uint64_t cells = 0;
    const auto flush = [&] {
        if (cells == 0) return;
        out << ' ' << low << (high > low ? "-" + std::to_string(high) : std::string()) << ": " << cells
            << ';';
        cells = 0;
    };
    for (const Json& pair : voxels["cells_by_voxels"]) {
        const auto count = pair[0].get<std::uint64_t>();
        while (count > high) {
            flush();
            low = high + 1;
            high = std::max<std::uint64_t>(2 * high, 1);
        }
        cells += pair[1].get<std::uint64_t>();
    }
    flush();
    out << " (voxels: cells)\n";
}

void add_checks(std::ostream& out, const Json& checks) {
    out << "\nchecks:";
    for (const auto& [name, check] : checks.items()) {
        out << ' ' << name << ' ';
        if (check["faults"] == 0) {
            out << "ok;";
        } else {
            out << check["faults"] << " FAULTS;";
        }
    }
    out << '\n';
}

}  // namespace

std::string summary(const Json& json) {
    std::ostringstream out;
    const Json& items = json["items"];
    const Json& cycles = json["cycles"];
    const Json& bound = json["bound"];
    out << "verdict " << json["verdict"].get<std::string>() << " after " << cycles["load"]
        << " cycles: " << items["polygons"] << " polygons, " << items["trapezes"] << " trapezes, "
        << items["spans"] << " spans, " << items["voxels"] << " voxels\n"
        << "cycles per polygon " << fixed(cycles["per_polygon"]) << ", trapeze "
        << fixed(cycles["per_trapeze"]) << ", span " << fixed(cycles["per_span"]) << ", voxel "
        << fixed(cycles["per_voxel"]) << '\n'
        << "bound " << bound["cycles"] << " cycles: " << bound["of"].get<std::string>() << "; reached "
        << percent(bound["efficiency"]) << ". Busiest: " << bound["busiest"]["of"].get<std::string>() << ", "
        << bound["busiest"]["cycles"] << " cycles\n";
    add_stages(out, json["stages"]);
    add_links(out, json["links"]);
    add_waits(out, json["stages"]);
    add_wavefront(out, json["wavefront"]);
    add_voxels(out, json["voxels"]);
    add_checks(out, json["checks"]);
    return out.str();
}

}  // namespace raycell::loading
