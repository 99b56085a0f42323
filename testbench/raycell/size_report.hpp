// What a search for the smallest machine found: as text, CSV and JSON, and as a configuration of render.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "testbench/common/options.hpp"
#include "testbench/raycell/size_search.hpp"

namespace raycell {

/// A Markdown table, padded to be readable as text; the first `left` columns are words.
std::string aligned(const std::vector<std::vector<std::string>>& rows, std::size_t left);

/// Every option of `raycell render` with its value, for to_toml().
nlohmann::ordered_json render_configuration(RenderOptions options);

/// A trial's setting, storage and accuracy.
nlohmann::ordered_json report(const SizeTrial& trial);

/// The tried settings, as report() made them: a table for people, and one for scripts.
std::string tried_table(const nlohmann::ordered_json& tried);
std::string tried_csv(const nlohmann::ordered_json& tried);

/// "hit mask, normals voxel, ..."
std::string words_for(const nlohmann::ordered_json& trial);
/// "30.5 dB, other first hit in 1.2 % of the pixels"
std::string accuracy_words(const nlohmann::ordered_json& trial);

/// The paper's estimates: 40 bytes per voxel, 16 voxels in the first prototype, 5 Kbyte per cell.
nlohmann::ordered_json paper_figures();

/// A table of the machine beside the paper's.
std::string beside_the_paper(const nlohmann::ordered_json& trial);

}  // namespace raycell
