#include "model/picture/picture.hpp"

#include "model/numbers/hash.hpp"

namespace raycell {

std::uint64_t image_hash(const Picture& picture) {
    Fnv hash;
    hash.add_bytes(&picture.width, sizeof picture.width);
    hash.add_bytes(&picture.height, sizeof picture.height);
    for (const Pixel& pixel : picture.pixels) {
        const double values[] = {pixel.colour.x, pixel.colour.y, pixel.colour.z, pixel.depth,
                                 pixel.normal.x, pixel.normal.y, pixel.normal.z};
        hash.add_bytes(values, sizeof values);
        hash.add_bytes(&pixel.polygon, sizeof pixel.polygon);
    }
    return hash.value();
}

}  // namespace raycell
