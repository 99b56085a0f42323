// What is said of frames in a row, from the reports of their runs.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "pipeline/run_result.hpp"

namespace raycell {

/// The verdict of a run's report.
Verdict verdict_of(const nlohmann::ordered_json& report);

/// The worst of the reports' verdicts: a deadlock before a livelock, a limit of cycles, one of voxels.
Verdict worst_of(const std::vector<nlohmann::ordered_json>& reports);

/// The block `frames` of the report, without `each`: the schedule in a row, null without cycles or if a frame
/// never ends, and the bits of a second store. `reports` is not empty.
nlohmann::ordered_json frames_report(const std::vector<nlohmann::ordered_json>& reports, double clock_mhz);

/// A line for each frame: verdict, cycles, when it is loaded and traced.
nlohmann::ordered_json each_frame(const std::vector<nlohmann::ordered_json>& reports);

/// The same in words, for standard output.
std::string frames_summary(const nlohmann::ordered_json& frames, Verdict worst, double clock_mhz);

}  // namespace raycell
