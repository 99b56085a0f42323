// A run's statistics as JSON; the keys are listed in docs/use/results.md and stable.
#pragma once

#include <nlohmann/json.hpp>

#include "model/geometry/placement.hpp"
#include "model/picture/compare.hpp"
#include "pipeline/machine.hpp"

namespace raycell {

/// The whole report but for `config`, `accuracy`, `model`, `ranks` and `losses.sample`.
nlohmann::ordered_json report(const RunResult& result, const CellScene& scene, const PictureSettings& picture,
                              const MachineSettings& machine);
nlohmann::ordered_json report(const Picture& test, const Picture& truth);

/// JSON as text for a file; bytes of names that are not UTF-8 are replaced.
std::string to_text(const nlohmann::ordered_json& json);

/// A 64-bit hash as 16 hexadecimal digits: JSON's numbers can't hold it.
std::string hex(std::uint64_t value);

}  // namespace raycell
