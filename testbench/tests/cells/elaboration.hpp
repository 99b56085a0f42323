// Shared by tests of timed modules: one elaboration per process, scripted actors, scenes.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <systemc>

#include "../property.hpp"
#include "cells/channels/link.hpp"
#include "model/machine/untimed.hpp"
#include "model/truth/exterior.hpp"
#include "model/truth/truth.hpp"
#include "pipeline/machine.hpp"
#include "scenes/load_scene.hpp"

namespace raycell {

/// SystemC elaborates once per process, so ctest runs each case in its own. Throws std::logic_error on a
/// second call.
inline void expect_first_elaboration() {
    static int elaborations = 0;
    if (++elaborations > 1)
        throw std::logic_error(
            "one elaboration per process: run by ctest, or with a --gtest_filter for one case");
}

/// Calls a function in each cycle in which it is woken; the function returns its next wake cycle, or never.
class Actor : public sc_core::sc_module, public Client {
  public:
    SC_HAS_PROCESS(Actor);
    Actor(sc_core::sc_module_name name, Scheduler& scheduler, std::function<Cycle(Cycle)> step)
        : sc_module(name), scheduler_(scheduler), step_(std::move(step)) {
        SC_METHOD(run);
        sensitive << wake_;
        dont_initialize();
    }
    void activate() override { wake_.notify(); }

  private:
    void run() {
        const Cycle next = step_(scheduler_.now());
        if (next != never) scheduler_.wake(*this, next);
    }
    Scheduler& scheduler_;
    std::function<Cycle(Cycle)> step_;
    sc_core::sc_event wake_;
};

/// One of the project's own scenes, with a tracer for the part outside the cube.
struct PlacedScene {
    CellScene scene;
    std::unique_ptr<TruthRenderer> truth;
    std::unique_ptr<ClassicalExterior> exterior;
};
inline std::unique_ptr<PlacedScene> place_own_scene(const std::string& name,
                                                    const PictureSettings& settings) {
    Diagnostics diagnostics;
    const Scene scene = load_scene(std::filesystem::path(RAYCELL_SOURCE_DIR) / "scenes" / (name + ".nff"),
                                   std::nullopt, diagnostics);
    auto placed = std::make_unique<PlacedScene>();
    placed->scene = place_scene(scene, place_frame(scene, settings), settings);
    placed->truth = std::make_unique<TruthRenderer>(placed->scene,
                                                    TruthSettings{settings.max_depth, settings.min_weight});
    placed->exterior = std::make_unique<ClassicalExterior>(placed->scene, *placed->truth);
    return placed;
}

}  // namespace raycell
