#include "model/picture/picture.hpp"

#include <cstring>

namespace raycell {

std::uint64_t image_hash(const Picture& picture) {
    std::uint64_t hash = 0xcbf29ce484222325ULL;
    const auto mix = [&hash](const void* data, std::size_t size) {
        const auto* bytes = static_cast<const unsigned char*>(data);
        for (std::size_t i = 0; i < size; ++i) hash = (hash ^ bytes[i]) * 0x100000001b3ULL;
    };
    mix(&picture.width, sizeof picture.width);
    mix(&picture.height, sizeof picture.height);
    for (const Pixel& pixel : picture.pixels) {
        const double values[] = {pixel.colour.x, pixel.colour.y, pixel.colour.z, pixel.depth,
                                 pixel.normal.x, pixel.normal.y, pixel.normal.z};
        mix(values, sizeof values);
        mix(&pixel.polygon, sizeof pixel.polygon);
    }
    return hash;
}

}  // namespace raycell
