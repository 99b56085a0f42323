// The points that shadow rays go to. A source that is no point is as many of them as there are samples: a
// pattern, the same for every hit, shifted by a hash of the voxel that was hit (Cranley and Patterson 1976).
#pragma once

#include <cstdint>
#include <vector>

#include "model/geometry/sources.hpp"
#include "model/numbers/arithmetic.hpp"

namespace raycell {

/// A place in a pattern, or its shift: fractions of 16 bits, which wrap around.
struct SamplePlace {
    std::uint16_t u = 0;
    std::uint16_t v = 0;
};
inline SamplePlace operator+(SamplePlace a, SamplePlace b) {
    return {std::uint16_t(a.u + b.u), std::uint16_t(a.v + b.v)};
}

/// The shift for the voxels of a polygon in cell (x, y).
SamplePlace shift_of(std::uint32_t polygon, int x, int y);

/// From each sample of a pattern to the next: a lattice of `samples` points in the unit square, in which
/// every row and column has one (Korobov). Of all such, the one whose nearest points are farthest apart.
SamplePlace step_of(int samples);

/// The end of a shadow ray: a source, or a sample of it.
struct Light {
    std::uint16_t source = 0;  ///< its number
    SamplePlace place;         ///< in the pattern, not shifted
};

/// Everything that a hit sends shadow rays to. Bit i of a word of sources, of a hit, a slot or a voxel, is
/// that of light i.
struct Lights {
    std::vector<Source> sources;
    std::vector<Light> rays;  ///< by source
    int samples = 1;          ///< of each source that is an area, 1..max_sources
    double share = 1;         ///< 1 / samples, a word

    /// The bits of the source whose first light this is.
    std::uint64_t bits(std::size_t first) const {
        const int count = is_area(sources[rays[first].source].kind) ? samples : 1;
        return (~std::uint64_t(0) >> (64 - count)) << first;
    }

    /// Whether any source is an area.
    bool areas() const {
        return std::any_of(sources.begin(), sources.end(), [](const Source& s) { return is_area(s.kind); });
    }

    Lights() = default;
    /// Throws std::invalid_argument if there are more lights than bits, and says with how many samples there
    /// would not be.
    Lights(std::vector<Source> held, int samples_of_each, const Arithmetic& arithmetic);
};

/// An area as a point in its middle, which shines as its points do; other sources as they are.
Source middle_of(const Source& source);

/// Two unit vectors across a way that is not 0, and across each other.
struct DiscAxes {
    dvec3 first{0, 0, 0};
    dvec3 second{0, 0, 0};
};
DiscAxes disc_axes(const dvec3& way, const Arithmetic& arithmetic);

/// A source as its sample: `at` is the shifted place in the pattern, `from` the point that sees it.
Source sample_of(const Source& source, SamplePlace at, const dvec3& from, const Arithmetic& arithmetic);

}  // namespace raycell
