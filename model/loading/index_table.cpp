#include "model/loading/index_table.hpp"

#include <algorithm>

namespace raycell {

std::uint32_t put_in_order(std::vector<IndexEntry>& table, std::uint32_t voxel, double near, double far) {
    std::size_t place = table.size();
    const bool known = voxel < table.size();
    if (known) {
        // What stands behind it stays there.
        while (table[--place].voxel != voxel) table[place].most = std::max(table[place].most, far);
    } else {
        table.emplace_back();
    }
    for (; place > 0 && table[place - 1].near > near; --place) {
        table[place] = table[place - 1];
        table[place].most = std::max(table[place].most, far);
    }
    table[place] = {near, far, place > 0 ? std::max(far, table[place - 1].most) : far, voxel};
    return std::uint32_t(table.size() - place);
}

}  // namespace raycell
