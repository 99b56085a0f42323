#include "model/geometry/sampling.hpp"

#include <cmath>

namespace raycell {
namespace {

constexpr int digits = 8;

/// Sobol's second dimension, `digits` binary digits behind the point; the first is the mirrored number.
unsigned second_dimension(unsigned number) {
    unsigned place = 0;
    unsigned direction = 1U << (digits - 1);
    for (; number > 0; number >>= 1, direction ^= direction >> 1) {
        if (number & 1) place ^= direction;
    }
    return place;
}

unsigned mirrored(unsigned number) {
    unsigned place = 0;
    for (unsigned half = 1U << (digits - 1); number > 0; number >>= 1, half >>= 1) {
        if (number & 1) place |= half;
    }
    return place;
}

/// The inverse of a tent's integral over (0, 1).
double under_tent(double share) {
    return share < 0.5 ? std::sqrt(share / 2) : 1 - std::sqrt((1 - share) / 2);
}

}  // namespace

dvec2 sample_place(int sample, int samples, PixelFilter filter) {
    unsigned boxes = 1;
    while (boxes < unsigned(samples)) boxes *= 2;
    constexpr unsigned all = 1U << digits;
    const unsigned turned = boxes >= 8 ? all / 8 : 0;
    const double middle = 0.5 / boxes;
    const dvec2 place(double(mirrored(unsigned(sample)) ^ turned) / all + middle,
                      double(second_dimension(unsigned(sample)) ^ turned) / all + middle);
    return filter == PixelFilter::box ? place : dvec2(under_tent(place.x), under_tent(place.y));
}

}  // namespace raycell
