// The loading pipeline as numbered units and links: lanes of geometry and precomputation, a distributor per
// row, the cells.
#pragma once

#include <cstddef>
#include <string>

namespace raycell::loading {

enum class UnitGroup { geometry, precomputation, distributors, cells };
enum class LinkGroup { polygons, trapezes, down, rows, east };

/// Order of units: the geometries lane by lane, the precomputations, the distributors from the top row down,
/// the cells row by row. Order of links: from each geometry, from each precomputation, from each row to the
/// row below, from each row into its first cell, from each cell to its eastern neighbour.
///
/// Every row has a number for a link to the row below, so that numbers stay simple. A lane's last row has no
/// such link: it is absent().
struct Layout {
    int width = 1;   ///< columns of cells, >= 1
    int height = 1;  ///< rows of cells, >= 1
    int lanes = 1;   ///< 1..height

    std::size_t geometry(int lane) const { return std::size_t(lane); }
    std::size_t precomputation(int lane) const { return ways() + std::size_t(lane); }
    std::size_t distributor(int y) const { return 2 * ways() + std::size_t(y); }
    std::size_t cell(int x, int y) const {
        return 2 * ways() + rows() + std::size_t(y) * columns() + std::size_t(x);
    }
    std::size_t units() const { return 2 * ways() + rows() + rows() * columns(); }

    /// From a lane's geometry to its precomputation.
    std::size_t polygons(int lane) const { return std::size_t(lane); }
    /// From a lane's precomputation to the distributor of its first row.
    std::size_t trapezes(int lane) const { return ways() + std::size_t(lane); }
    /// From row y to the row below.
    std::size_t down(int y) const { return 2 * ways() + std::size_t(y); }
    std::size_t row(int y) const { return 2 * ways() + rows() + std::size_t(y); }
    /// From cell (x, y) to its eastern neighbour, which must exist.
    std::size_t east(int x, int y) const {
        return 2 * ways() + 2 * rows() + std::size_t(y) * (columns() - 1) + std::size_t(x);
    }
    /// Numbers of links, those of absent ones included.
    std::size_t links() const { return 2 * ways() + 2 * rows() + rows() * (columns() - 1); }
    bool absent(std::size_t link) const;

    /// Each lane has rows next to each other, as evenly as possible.
    int first_row(int lane) const { return int(rows() * std::size_t(lane) / ways()); }
    int last_row(int lane) const { return first_row(lane + 1) - 1; }
    int lane_of(int y) const { return int((std::size_t(y + 1) * ways() - 1) / rows()); }

    /// The cell or row of a unit, or of a link's source. Outside the array, x and y are -1.
    struct Place {
        int x = -1;
        int y = -1;
    };
    UnitGroup unit_group(std::size_t unit) const;
    Place unit_place(std::size_t unit) const;
    /// The lane of a geometry, a precomputation, a distributor or a cell.
    int unit_lane(std::size_t unit) const;
    std::string unit_name(std::size_t unit) const;
    LinkGroup link_group(std::size_t link) const;
    Place link_place(std::size_t link) const;
    std::string link_name(std::size_t link) const;
    std::size_t source_of(std::size_t link) const;
    std::size_t sink_of(std::size_t link) const;
    /// The link that a unit reads; geometry reads none.
    std::size_t input_of(std::size_t unit) const;

  private:
    std::size_t rows() const { return std::size_t(height); }
    std::size_t columns() const { return std::size_t(width); }
    std::size_t ways() const { return std::size_t(lanes); }
};

}  // namespace raycell::loading
