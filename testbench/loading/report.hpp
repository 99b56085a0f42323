// The reports of loading_tb: JSON, tables, text.
#pragma once

#include <nlohmann/json.hpp>

#include "pipeline/machine.hpp"
#include "testbench/loading/checks.hpp"

namespace raycell::loading {

/// All that is known at the end of a run.
struct Loading {
    const LoadPlan& plan;
    const LoadWatch& watch;
    const RunResult& result;
    const PictureSettings& picture;
    const MachineSettings& machine;
    const CellScene& scene;
    std::vector<const CellStore*> cells;  ///< row-major
    NamedFaults checks;
};

/// Everything but config and the model's wall seconds; the keys are in docs/reference/loading_tb.md.
nlohmann::ordered_json report(const Loading& loading);
/// A line per column, row, or link of the pipeline.
std::string columns_csv(const Loading& loading);
std::string rows_csv(const Loading& loading);
std::string links_csv(const Loading& loading);
/// For people.
std::string summary(const nlohmann::ordered_json& json);

}  // namespace raycell::loading
