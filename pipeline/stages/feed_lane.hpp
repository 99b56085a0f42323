// A lane of the feed: geometry and precomputation for some rows of the array, next to each other.
#pragma once

#include "model/machine/feed_bits.hpp"
#include "pipeline/stages/geometry.hpp"
#include "pipeline/stages/precomputation.hpp"

namespace raycell {

/// The rows of lane `lane` of `lanes` in an array of `height` rows, as even as possible.
inline Stretch rows_of_lane(int lane, int lanes, int height) {
    const auto begin = [&](int i) { return int(std::int64_t(height) * i / lanes); };
    return {begin(lane), begin(lane + 1) - 1};
}

/// Each lane goes through the whole scene and loads its rows from it, whatever the others do. So the order of
/// the voxels in a cell does not depend on how many lanes there are.
struct FeedLane {
    FeedLane(Environment& environment, int lane, int lanes);

    const Stretch rows;
    Geometry geometry;
    Precomputation precomputation;
    Link polygons;  ///< from geometry to precomputation
    Link trapezes;  ///< from precomputation to the distributor of the lane's first row

    /// Load messages in the two stages and their links.
    std::size_t holds() const {
        return geometry.holds() + precomputation.holds() + std::size_t(polygons.occupancy(0)) +
               std::size_t(trapezes.occupancy(0));
    }
};

}  // namespace raycell
