// Shared by tests of units: a context without an array.
#pragma once

#include <gtest/gtest.h>

#include <systemc>

#include "../truth/hand_made.hpp"
#include "model/machine/need.hpp"

namespace raycell {

/// A 3x3 array, a cube 10 cells deep, exact arithmetic. Object 0 is matt, object 1 a mirror.
struct UnitContext {
    explicit UnitContext(int sources = 0, Shadows shadows = Shadows::per_hit)
        : scene(hand_made::cube(3, 3, 10)) {
        scene.objects = {hand_made::matt(1), hand_made::mirror(0.5)};
        scene.sources.resize(std::size_t(sources));
        settings.width = settings.height = 3;
        settings.shadows = shadows;
        settings.numbers.arithmetic = Numbers::exact;
        context = std::make_unique<Context>(scene, settings);
        store.voxels.resize(2);
        store.voxels[1].object = 1;
        make_index(store);
        store.lit.assign(2, 0);
        store.known.assign(2, 0);
    }
    CellScene scene;
    PictureSettings settings;
    std::unique_ptr<Context> context;
    CellStore store;
    CostTable costs;
};

}  // namespace raycell
