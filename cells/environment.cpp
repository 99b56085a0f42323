#include "cells/environment.hpp"

namespace raycell {

int Environment::load_bits(const LoadItem& item) const {
    switch (item.kind) {
        case LoadItem::Kind::setup:
            return bits.setup(context.scene.sources.size());
        case LoadItem::Kind::features:
            return bits.features;
        case LoadItem::Kind::polygon:
            return int(item.polygon.vertices.size()) * bits.vertex + bits.polygon;
        case LoadItem::Kind::trapeze:
            return bits.trapeze;
        case LoadItem::Kind::span:
            return bits.span;
        case LoadItem::Kind::end_of_scene:
            break;
    }
    return bits.end_of_scene;
}

}  // namespace raycell
