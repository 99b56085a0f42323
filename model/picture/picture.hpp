// The picture, and what is known about each pixel.
#pragma once

#include <cstdint>
#include <vector>

#include "model/geometry/polygon.hpp"

namespace raycell {

struct Pixel {
    dvec3 colour{0, 0, 0};  ///< linear, unbounded above
    double depth = 0;       ///< z of the first hit, cell widths; infinity where the background is seen
    dvec3 normal{0, 0, 0};  ///< of the first hit, turned to the ray, cell coordinates; 0 for background
    std::uint32_t polygon = no_polygon;  ///< of the first hit
    std::uint32_t cycle = 0;             ///< trace cycle in which the pixel was complete (timed only)
    std::uint32_t postponed = 0;  ///< times that a ray of its tree was destroyed and sent again (timed only)
    std::uint32_t samples = 1;    ///< primary rays whose mean the colour is
    std::uint32_t hops = 0;       ///< cell-to-cell hops of all rays and answers of the pixel's tree
};

/// Row-major, row 0 on top.
struct Picture {
    int width = 0;
    int height = 0;
    std::vector<Pixel> pixels;

    Picture() = default;
    Picture(int w, int h) : width(w), height(h), pixels(std::size_t(w) * std::size_t(h)) {}
    Pixel& at(int x, int y) { return pixels[std::size_t(y) * std::size_t(width) + std::size_t(x)]; }
    const Pixel& at(int x, int y) const {
        return pixels[std::size_t(y) * std::size_t(width) + std::size_t(x)];
    }
};

/// 64-bit FNV-1a over colour, depth, normal and polygon of every pixel (not cycle, not hops).
std::uint64_t image_hash(const Picture& picture);

}  // namespace raycell
