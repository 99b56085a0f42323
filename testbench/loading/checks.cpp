#include "testbench/loading/checks.hpp"

#include <cstring>

namespace raycell::loading {
namespace {

bool same(double a, double b) { return std::memcmp(&a, &b, sizeof a) == 0; }
bool same(const dvec3& a, const dvec3& b) { return same(a.x, b.x) && same(a.y, b.y) && same(a.z, b.z); }
bool same(const EdgeFunction& a, const EdgeFunction& b) {
    return same(a.a, b.a) && same(a.b, b.b) && same(a.c, b.c) && a.piece == b.piece;
}

/// The name of the first part of a voxel that differs; null if none does.
const char* difference(const Voxel& a, const Voxel& b) {
    if (a.polygon != b.polygon) return "polygon";
    if (a.object != b.object) return "object";
    if (a.near_level != b.near_level || a.far_level != b.far_level) return "depth levels";
    if (!same(a.near, b.near) || !same(a.far, b.far) || !same(a.base, b.base)) return "depth run";
    if (!same(a.plane.n, b.plane.n) || !same(a.plane.c, b.plane.c)) return "plane";
    if (!same(a.normal.base, b.normal.base) || !same(a.normal.du, b.normal.du) ||
        !same(a.normal.dv, b.normal.dv)) {
        return "normals";
    }
    if (a.drop != b.drop) return "dropped axis";
    if (a.pieces != b.pieces || a.edge_count != b.edge_count || a.first_edge != b.first_edge) return "edges";
    if (a.mask != b.mask || a.window != b.window) return "mask";
    if (!same(a.point, b.point) || !same(a.area, b.area)) return "point";
    return nullptr;
}

template <typename T, typename Same>
bool all_same(const std::vector<T>& a, const std::vector<T>& b, Same equal) {
    if (a.size() != b.size()) return false;
    for (std::size_t i = 0; i < a.size(); ++i) {
        if (!equal(a[i], b[i])) return false;
    }
    return true;
}

void compare(const std::string& where, const CellStore& a, const CellStore& b, Faults& faults) {
    if (a.voxels.size() != b.voxels.size()) {
        faults.add(where + ": " + std::to_string(a.voxels.size()) + " voxels, untimed " +
                   std::to_string(b.voxels.size()));
        return;
    }
    for (std::size_t i = 0; i < a.voxels.size(); ++i) {
        if (const char* what = difference(a.voxels[i], b.voxels[i])) {
            faults.add(where + ": voxel " + std::to_string(i) + " of polygon " +
                       std::to_string(a.voxels[i].polygon) + " differs from the untimed one in its " + what);
        }
    }
    const auto same_edge = [](const EdgeFunction& p, const EdgeFunction& q) { return same(p, q); };
    const auto same_vector = [](const dvec3& p, const dvec3& q) { return same(p, q); };
    if (!all_same(a.edges, b.edges, same_edge))
        faults.add(where + ": the edges differ from the untimed ones");
    if (!all_same(a.intensities, b.intensities, same_vector)) {
        faults.add(where + ": the intensities differ from the untimed ones");
    }
    if (a.lit != b.lit || a.known != b.known) {
        faults.add(where + ": the shadow bits differ from the untimed ones");
    }
    if (a.overflowed != b.overflowed) {
        faults.add(where + ": " + std::to_string(a.overflowed) + " voxels did not fit, untimed " +
                   std::to_string(b.overflowed));
    }
}

}  // namespace

Faults compare_stores(const std::vector<const CellStore*>& timed, const std::vector<CellStore>& untimed,
                      int width) {
    Faults faults;
    if (timed.size() != untimed.size()) {
        faults.add(std::to_string(timed.size()) + " cells, untimed " + std::to_string(untimed.size()));
        return faults;
    }
    for (std::size_t i = 0; i < timed.size(); ++i) {
        const std::string where = "cell (" + std::to_string(i % std::size_t(width)) + ", " +
                                  std::to_string(i / std::size_t(width)) + ")";
        compare(where, *timed[i], untimed[i], faults);
    }
    return faults;
}

Faults check_bound(Cycle cycles, const LoadPlan::Bound& bound) {
    Faults faults;
    if (cycles < bound.cycles) {
        faults.add(std::to_string(cycles) + " cycles, but " + bound.of + " alone needs " +
                   std::to_string(bound.cycles));
    }
    return faults;
}

std::uint64_t count_of(const NamedFaults& checks) {
    std::uint64_t sum = 0;
    for (const auto& [name, faults] : checks) sum += faults.count;
    return sum;
}

}  // namespace raycell::loading
