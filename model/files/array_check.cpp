#include "model/files/array_check.hpp"

#include <cmath>
#include <optional>
#include <stdexcept>

namespace raycell {
namespace {

/// Checks one cell. Messages name the voxel, and what was allowed.
class CellCheck {
  public:
    CellCheck(const CellStore& cell, const CellScene& scene, const PictureSettings& picture)
        : cell_(cell), scene_(scene), picture_(picture) {}

    void run() {
        const std::size_t voxels = cell_.voxels.size();
        const bool bounded = picture_.voxel_capacity > 0;
        if (bounded) at_most("number of voxels", voxels, std::uint64_t(picture_.voxel_capacity));
        const bool gouraud = picture_.display == Display::gouraud;
        if (cell_.intensities.size() != (gouraud ? voxels : 0))
            fail("number of intensities " + std::to_string(cell_.intensities.size()),
                 gouraud ? "one per voxel" : "none");
        for (const dvec3& intensity : cell_.intensities) number("intensity", intensity);
        for (std::size_t i = 0; i < voxels; ++i) {
            voxel_ = i;
            check(cell_.voxels[i]);
        }
    }

  private:
    [[noreturn]] void fail(const std::string& what, const std::string& expected) const {
        const std::string voxel = voxel_ ? ", voxel " + std::to_string(*voxel_) : "";
        throw std::runtime_error(voxel + ": " + what + "; expected " + expected);
    }
    void at_most(const char* what, std::uint64_t value, std::uint64_t most, std::uint64_t least = 0) const {
        if (value >= least && value <= most) return;
        fail(std::string(what) + " " + std::to_string(value),
             (least > 0 ? std::to_string(least) + " to " : std::string("at most ")) + std::to_string(most));
    }
    void below(const char* what, std::uint64_t value, std::uint64_t count) const {
        if (value < count) return;
        fail(std::string(what) + " " + std::to_string(value), "less than " + std::to_string(count));
    }
    void number(const char* what, double value) const {
        if (!std::isfinite(value)) fail(std::string(what) + " is not finite", "a number");
        if (picture_.numbers.arithmetic == Numbers::exact) return;
        // A word that a cell stores has at most 48 bits, and at most 40 of them are fraction bits.
        const double units = value * 0x1p40;
        if (std::abs(value) > 0x1p48 || units != std::floor(units))
            fail(std::string(what) + " is no word", "fixed-point words");
    }
    void number(const char* what, const dvec3& value) const {
        for (int axis = 0; axis < 3; ++axis) number(what, value[axis]);
    }

    void check(const Voxel& v) const {
        below("object", v.object, scene_.objects.size());
        below("polygon", v.polygon, scene_.polygons.size());
        const auto levels = std::int64_t(scene_.frame.depth_levels);
        if (v.near_level < 0 || v.far_level <= v.near_level || v.far_level > levels)
            fail("levels " + std::to_string(v.near_level) + " to " + std::to_string(v.far_level),
                 "an interval from 0 to " + std::to_string(levels));
        number("near", v.near), number("far", v.far), number("base", v.base);
        if (v.near > v.far) fail("near is beyond far", "near first");
        at_most("dropped axis", v.drop, 2);
        number("plane", v.plane.n), number("plane", v.plane.c);
        if (v.plane.n[v.drop] == 0) fail("the plane is parallel to its dropped axis", "one that is not");
        number("normal", v.normal.base), number("normal", v.normal.du), number("normal", v.normal.dv);
        number("point", v.point);
        if (!(std::isfinite(v.area) && v.area >= 0)) fail("area is no area", "0 or more");
        for (std::size_t axis = 0; axis < 2; ++axis) {
            at_most("end of the window", v.window[2 * axis + 1], window_steps, 1);
            below("beginning of the window", v.window[2 * axis], v.window[2 * axis + 1]);
        }
        check_edges(v);
    }

    void check_edges(const Voxel& v) const {
        const bool has_edges = picture_.hit == HitTest::edge;
        at_most("number of edges", v.edge_count, has_edges ? cell_.edges.size() : 0);
        at_most("first edge", v.first_edge, cell_.edges.size() - v.edge_count);
        at_most("number of pieces", v.pieces, v.edge_count, v.edge_count > 0 ? 1 : 0);
        std::uint32_t piece = 0;
        for (std::uint32_t i = 0; i < v.edge_count; ++i) {
            const EdgeFunction& edge = cell_.edges[std::size_t(v.first_edge) + i];
            number("edge", dvec3(edge.a, edge.b, edge.c));
            below("piece of an edge", edge.piece, v.pieces);
            if (edge.piece < piece) fail("the edges' pieces are not in order", "one after the other");
            piece = edge.piece;
        }
    }

    const CellStore& cell_;
    const CellScene& scene_;
    const PictureSettings& picture_;
    std::optional<std::size_t> voxel_;  ///< the one being checked
};

}  // namespace

void check_array(const LoadedArray& array, const CellScene& scene, const PictureSettings& picture,
                 const std::string& name) {
    for (std::size_t i = 0; i < array.cells.size(); ++i) {
        try {
            CellCheck(array.cells[i], scene, picture).run();
        } catch (const std::runtime_error& fault) {
            throw std::runtime_error(name + ": is damaged: cell " + std::to_string(i) + fault.what());
        }
    }
}

}  // namespace raycell
