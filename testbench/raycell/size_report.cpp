#include "testbench/raycell/size_report.hpp"

#include <algorithm>
#include <cstdio>

namespace raycell {
namespace {

using Json = nlohmann::ordered_json;
using Row = std::vector<std::string>;

std::string decimals(const char* format, double value) {
    char text[64];
    std::snprintf(text, sizeof text, format, value);
    return text;
}

/// Without the quotes that words have in JSON.
std::string plain(const Json& value) { return value.is_string() ? value.get<std::string>() : value.dump(); }

}  // namespace

std::string aligned(const std::vector<Row>& rows, std::size_t left) {
    std::vector<std::size_t> widths(rows.front().size(), 0);
    for (const Row& row : rows) {
        for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
    }
    std::string text;
    for (std::size_t r = 0; r < rows.size(); ++r) {
        for (std::size_t i = 0; i < widths.size(); ++i) {
            const std::string pad(widths[i] - rows[r][i].size(), ' ');
            text += (i == 0 ? "| " : " | ") + (i < left ? rows[r][i] + pad : pad + rows[r][i]);
        }
        text += " |\n";
        if (r > 0) continue;
        for (std::size_t i = 0; i < widths.size(); ++i) {
            text += "|" + std::string(widths[i] + 1, '-') + (i < left ? "-" : ":");
        }
        text += "|\n";
    }
    return text;
}

Json render_configuration(RenderOptions options) {
    CLI::App unused;
    OptionTable table(unused);
    add_scene_options(table, options);
    add_machine_options(table, options);
    return table.values();
}

Json report(const SizeTrial& trial) {
    RenderOptions options;
    options.picture.hit = trial.setting.hit;
    options.picture.normals = trial.setting.normals;
    options.picture.shadows = trial.setting.shadows;
    const Json words = render_configuration(options);
    const StorageCounts& storage = trial.storage;
    Json json = {{"hit", words["hit"]},
                 {"normals", words["normals"]},
                 {"shadows", words["shadows"]},
                 {"depth_levels", trial.setting.depth_levels},
                 {"word_bits", trial.setting.word_bits}};
    json["bits_per_voxel"] = double(storage.bits) / double(std::max<std::uint64_t>(storage.voxels, 1));
    json["bits_fullest_cell"] = storage.max_cell_bits;
    json["bits_total"] = storage.bits;
    json["voxels_fullest_cell"] = storage.max_voxels;
    json["psnr_db"] = trial.accuracy.psnr_db;
    json["wrong_hit_percent"] = trial.accuracy.wrong_hit_percent;
    json["meets"] = trial.meets;
    return json;
}

std::string tried_table(const Json& tried) {
    std::vector<Row> rows = {{"hit", "normals", "shadows", "levels", "word bits", "bits per voxel",
                              "bits of fullest cell", "dB", "wrong hits %", "meets"}};
    for (const Json& t : tried) {
        rows.push_back({t["hit"], t["normals"], t["shadows"], t["depth_levels"].dump(), t["word_bits"].dump(),
                        decimals("%.0f", t["bits_per_voxel"].get<double>()), t["bits_fullest_cell"].dump(),
                        decimals("%.2f", t["psnr_db"].get<double>()),
                        decimals("%.3f", t["wrong_hit_percent"].get<double>()),
                        t["meets"].get<bool>() ? "yes" : "no"});
    }
    return aligned(rows, 3);
}

std::string tried_csv(const Json& tried) {
    std::string text =
        "hit,normals,shadows,depth_levels,word_bits,bits_per_voxel,bits_fullest_cell,bits_total,"
        "voxels_fullest_cell,psnr_db,wrong_hit_percent,meets\n";
    for (const Json& trial : tried) {
        std::string line;
        for (const auto& [key, value] : trial.items()) {
            line += (line.empty() ? "" : ",") + plain(value);
        }
        text += line + "\n";
    }
    return text;
}

std::string words_for(const Json& t) {
    return "hit " + t["hit"].get<std::string>() + ", normals " + t["normals"].get<std::string>() +
           ", shadows " + t["shadows"].get<std::string>() + ", " + t["depth_levels"].dump() +
           (t["depth_levels"] == 1 ? " depth level" : " depth levels") + ", words of " +
           t["word_bits"].dump() + " bits";
}

std::string accuracy_words(const Json& t) {
    return decimals("%.2f", t["psnr_db"].get<double>()) + " dB, other first hit in " +
           decimals("%.3f", t["wrong_hit_percent"].get<double>()) + " % of the pixels";
}

Json paper_figures() {
    return {{"bits_per_voxel", 40 * 8}, {"voxels_fullest_cell", 16}, {"bits_fullest_cell", 5 * 1024 * 8}};
}

std::string beside_the_paper(const Json& trial) {
    const Json paper = paper_figures();
    std::vector<Row> rows = {{"", "this machine", "paper"}};
    rows.push_back({"bits per voxel, mean", decimals("%.0f", trial["bits_per_voxel"].get<double>()),
                    paper["bits_per_voxel"].dump()});
    rows.push_back({"voxels of the fullest cell", trial["voxels_fullest_cell"].dump(),
                    paper["voxels_fullest_cell"].dump()});
    rows.push_back(
        {"bits of the fullest cell", trial["bits_fullest_cell"].dump(), paper["bits_fullest_cell"].dump()});
    return aligned(rows, 1);
}

}  // namespace raycell
