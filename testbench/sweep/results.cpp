#include "testbench/sweep/results.hpp"

#include <algorithm>
#include <map>
#include <sstream>
#include <stdexcept>

namespace raycell {
namespace {

using Json = nlohmann::ordered_json;

std::string grouped(std::uint64_t number) {
    std::string digits = std::to_string(number);
    for (std::size_t i = digits.size(); i > 3; i -= 3) digits.insert(i - 3, ",");
    return digits;
}

std::string line(const std::vector<std::string>& cells) {
    std::string text = "|";
    for (const std::string& cell : cells) text += (cell.empty() ? "" : " " + cell) + " |";
    return text + "\n";
}

std::string head(const std::vector<std::string>& names) {
    return line(names) + line(std::vector<std::string>(names.size(), "---"));
}

/// Axes of several values that tell machines apart.
std::vector<std::size_t> machine_axes(const SweepDesign& design) {
    std::vector<std::size_t> axes = design.varying();
    axes.erase(std::remove_if(axes.begin(), axes.end(),
                              [&](std::size_t i) { return design.axes[i].option == "seed"; }),
               axes.end());
    return axes;
}

std::vector<std::string> bits_of(const SweepRow& row) {
    return {grouped(row.buffer_bits), grouped(row.ray_store_bits), grouped(row.register_bits),
            grouped(row.voxel_bits), grouped(row.cell_bits())};
}

std::string safe_table(const SweepDesign& design, const std::vector<SweepMachine>& machines, std::size_t m) {
    std::vector<std::size_t> others = machine_axes(design);
    others.erase(std::remove(others.begin(), others.end(), m), others.end());
    std::vector<std::vector<std::string>> order;
    std::map<std::vector<std::string>, std::vector<const SweepMachine*>> lines;  // by the other axes' values
    for (const SweepMachine& machine : machines) {
        std::vector<std::string> key;
        for (const std::size_t axis : others) key.push_back(machine.runs.front()->point.values[axis]);
        if (lines[key].empty()) order.push_back(key);
        lines[key].push_back(&machine);
    }
    std::vector<std::string> names;
    for (const std::size_t axis : others) names.push_back(design.axes[axis].option);
    for (const char* name :
         {"smallest M that ended", "runs of it", "cycles (median)", "bits a cell", "certain from M"})
        names.emplace_back(name);
    std::string text =
        "\nThe smallest `--ray-store` (M) from which on every run of this sweep ended; and the smallest one "
        "with "
        "which any\nrun is certain to end, whatever its rays:\n\n" +
        head(names);
    for (const auto& key : order) {
        std::vector<const SweepMachine*>& each = lines[key];
        std::stable_sort(each.begin(), each.end(), [&](const SweepMachine* a, const SweepMachine* b) {
            return std::stoll(a->runs.front()->point.values[m]) <
                   std::stoll(b->runs.front()->point.values[m]);
        });
        auto safe = each.end();
        while (safe != each.begin() && (*(safe - 1))->safe()) --safe;
        std::vector<std::string> cells = key;
        if (safe == each.end()) {
            cells.insert(cells.end(), {"none", "", "", ""});
        } else {
            const SweepRow& row = *(*safe)->runs.front();
            cells.insert(cells.end(), {row.point.values[m], std::to_string((*safe)->runs.size()),
                                       grouped(*(*safe)->cycles()), grouped(row.cell_bits())});
        }
        const auto certain = std::find_if(each.begin(), each.end(), [](const SweepMachine* machine) {
            return machine->runs.front()->certain;
        });
        cells.push_back(certain == each.end() ? "" : (*certain)->runs.front()->point.values[m]);
        text += line(cells);
    }
    return text;
}

}  // namespace

SweepRow row_of(const SweepPoint& point, const Json& report) {
    SweepRow row;
    try {
        row.point = point;
        row.verdict = report.at("verdict").get<std::string>();
        const Json& pixels = report.at("pixels");
        row.completed = pixels.at("completed").get<double>() / pixels.at("all").get<double>();
        const Json& cycles = report.at("cycles");
        row.load_cycles = cycles.at("load");
        row.cycles = cycles.at("precast").get<std::uint64_t>() + cycles.at("trace").get<std::uint64_t>();
        row.rays_sent = report.at("messages").at("rays").at("sent");
        row.postponed = report.at("messages").at("rays").at("destroyed");
        row.ray_store_peak = report.at("ray_store").at("peak");
        row.ray_store_mean = report.at("ray_store").at("mean");
        const Json& bits = report.at("storage_bits");
        row.buffer_bits =
            bits.at("ray_buffers").get<std::uint64_t>() + bits.at("answer_buffers").get<std::uint64_t>();
        row.ray_store_bits = bits.at("ray_store");
        row.register_bits = bits.at("registers").at("total");
        row.voxel_bits = report.at("voxels").at("max_bits_per_cell");
        const Json& deadlock = report.at("deadlock");
        row.certain = deadlock.at("bound").at("met");
        if (deadlock.contains("knot")) row.knot_cells = deadlock.at("knot").at("cells").size();
        if (report.contains("accuracy")) row.psnr = report.at("accuracy").at("scene").at("psnr_db").dump();
        row.image_hash = report.at("hash").at("image");
        row.schedule_hash = report.at("hash").at("schedule");
    } catch (const Json::exception& error) {
        throw std::runtime_error(std::string("a run's report is not whole: ") + error.what());
    }
    return row;
}

std::string sweep_csv(const SweepDesign& design, const std::vector<SweepRow>& rows) {
    const auto quoted = [](const std::string& word) {
        return word.find_first_of(",\"") == std::string::npos ? word : '"' + word + '"';
    };
    std::ostringstream csv;
    for (const std::size_t axis : design.varying()) csv << design.axes[axis].option << ',';
    csv << "verdict,completed_share,load_cycles,cycles,rays_sent,postponed,ray_store_peak,ray_store_mean,"
           "buffer_bits,ray_store_bits,register_bits,voxel_bits,cell_bits,certain,knot_cells,psnr_db,image_"
           "hash,"
           "schedule_hash\n";
    for (const SweepRow& row : rows) {
        for (const std::size_t axis : design.varying()) csv << quoted(row.point.values[axis]) << ',';
        csv << row.verdict << ',' << row.completed << ',' << row.load_cycles << ',' << row.cycles << ','
            << row.rays_sent << ',' << row.postponed << ',' << row.ray_store_peak << ',' << row.ray_store_mean
            << ',' << row.buffer_bits << ',' << row.ray_store_bits << ',' << row.register_bits << ','
            << row.voxel_bits << ',' << row.cell_bits() << ',' << row.certain << ',' << row.knot_cells << ','
            << row.psnr << ',' << row.image_hash << ',' << row.schedule_hash << '\n';
    }
    return csv.str();
}

bool SweepMachine::safe() const {
    return std::all_of(runs.begin(), runs.end(),
                       [](const SweepRow* run) { return run->verdict == "completed"; });
}

std::string SweepMachine::verdicts() const {
    std::vector<std::pair<std::string, int>> counts;
    for (const SweepRow* run : runs) {
        auto found = std::find_if(counts.begin(), counts.end(),
                                  [&](const auto& c) { return c.first == run->verdict; });
        if (found == counts.end()) found = counts.insert(counts.end(), {run->verdict, 0});
        ++found->second;
    }
    if (counts.size() == 1) return counts.front().first;
    std::string text;
    for (const auto& [verdict, count] : counts)
        text += (text.empty() ? "" : ", ") + std::to_string(count) + " " + verdict;
    return text;
}

std::optional<std::uint64_t> SweepMachine::cycles() const {
    std::vector<std::uint64_t> all;
    for (const SweepRow* run : runs) {
        if (run->verdict == "completed") all.push_back(run->cycles);
    }
    if (all.empty()) return std::nullopt;
    std::nth_element(all.begin(), all.begin() + std::ptrdiff_t(all.size() / 2), all.end());
    return all[all.size() / 2];
}

std::vector<SweepMachine> machines_of(const SweepDesign& design, const std::vector<SweepRow>& rows) {
    const std::vector<std::size_t> axes = machine_axes(design);
    std::vector<SweepMachine> machines;
    std::map<std::vector<std::string>, std::size_t> places;
    for (const SweepRow& row : rows) {
        std::vector<std::string> key;
        for (const std::size_t axis : axes) key.push_back(row.point.values[axis]);
        const auto [place, added] = places.emplace(key, machines.size());
        if (added) machines.emplace_back();
        machines[place->second].runs.push_back(&row);
    }
    return machines;
}

std::string sweep_table(const SweepDesign& design, const std::vector<SweepRow>& rows) {
    const std::vector<std::size_t> axes = machine_axes(design);
    const std::vector<SweepMachine> machines = machines_of(design, rows);
    const bool truth =
        std::any_of(rows.begin(), rows.end(), [](const SweepRow& row) { return !row.psnr.empty(); });
    std::vector<std::string> names;
    for (const std::size_t axis : axes) names.push_back(design.axes[axis].option);
    for (const char* name : {"verdict", "certain to end", "cycles (median)", "postponed", "ray store, peak"})
        names.emplace_back(name);
    if (truth) names.emplace_back("dB");
    for (const char* name :
         {"buffers, bits", "ray store, bits", "registers, bits", "voxels, bits", "bits a cell"})
        names.emplace_back(name);
    std::string text = head(names);
    for (const SweepMachine& machine : machines) {
        const SweepRow& first = *machine.runs.front();
        std::uint64_t postponed = 0;
        std::uint64_t peak = 0;
        for (const SweepRow* run : machine.runs) {
            postponed += run->postponed;
            peak = std::max(peak, run->ray_store_peak);
        }
        std::vector<std::string> cells;
        for (const std::size_t axis : axes) cells.push_back(first.point.values[axis]);
        cells.insert(cells.end(), {machine.verdicts(), first.certain ? "yes" : "no",
                                   machine.cycles() ? grouped(*machine.cycles()) : "",
                                   grouped(postponed / machine.runs.size()), std::to_string(peak)});
        if (truth) cells.push_back(first.psnr.substr(0, first.psnr.find('.') + 3));
        for (const std::string& bits : bits_of(first)) cells.push_back(bits);
        text += line(cells);
    }
    for (const std::size_t axis : axes) {
        if (design.axes[axis].option == "ray-store") text += safe_table(design, machines, axis);
    }
    return text;
}

}  // namespace raycell
