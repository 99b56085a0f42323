// A deadlock as files: the knots for the JSON report, the whole wait-for graph, a picture of the ring; and
// the ledger of what recovery destroyed.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "pipeline/machine.hpp"

namespace raycell {

/// `deadlock.knot` of the report: the nodes of all knots with their ages, and the edges between them.
nlohmann::ordered_json knot_json(const RunResult& result);

/// Every node of the wait-for graph with its state, for checkers and other tools. Keys in
/// docs/use/results.md.
nlohmann::ordered_json waits_json(const RunResult& result);

/// The array with its knots and tails, and the oldest knot enlarged, as SVG.
std::string knot_svg(const RunResult& result, int width, int height);

/// `deadlock.ledger`: sums over the rays destroyed and sent again.
nlohmann::ordered_json ledger_json(const RunResult& result);
/// A line for each ray destroyed, in the order of cycles and cells.
std::string ledger_csv(const Ledger& ledger);

/// `deadlock.time_outs`: what time-outs of 16 to 2^20 cycles in every cell would have reported.
nlohmann::ordered_json time_outs_json(const RunResult& result);

}  // namespace raycell
