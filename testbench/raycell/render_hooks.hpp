// What another program adds to raycell render.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>

#include "cells/hosts/cell_socket.hpp"
#include "model/tracing/tracing.hpp"
#include "testbench/common/options.hpp"

namespace raycell {

struct RenderHooks {
    /// Adds options, which are no part of a run's configuration.
    std::function<void(CLI::App&)> add_options;
    /// Called before anything is read; throws UsageError for options that it refuses.
    std::function<void(const RenderOptions&)> check;
    /// Called when the scene is in its place. False: the program ends here, without a run.
    std::function<bool(const RenderOptions&, const CellScene&)> placed;
    CellFactory own_cells;
    /// Called after the run; returns the program's exit code. `code` is that of the verdict.
    std::function<int(int code)> ended;
};

}  // namespace raycell
