// The loading pipeline as numbered units and links: geometry, precomputation, a distributor per row, the
// cells.
#pragma once

#include <cstddef>
#include <string>

namespace raycell::loading {

enum class UnitGroup { geometry, precomputation, distributors, cells };
enum class LinkGroup { polygons, trapezes, down, rows, east };

/// Order of units: geometry, precomputation, the distributors from the top row down, the cells row by row.
/// Order of links: from geometry, from precomputation, from each row to the row below, from each row into its
/// first cell, from each cell to its eastern neighbour.
struct Layout {
    int width = 1;
    int height = 1;

    static constexpr std::size_t geometry = 0;
    static constexpr std::size_t precomputation = 1;
    std::size_t distributor(int y) const { return 2 + std::size_t(y); }
    std::size_t cell(int x, int y) const { return 2 + rows() + std::size_t(y) * columns() + std::size_t(x); }
    std::size_t units() const { return 2 + rows() + rows() * columns(); }

    static constexpr std::size_t polygons = 0;
    static constexpr std::size_t trapezes = 1;
    /// From row y to the row below, which must exist.
    std::size_t down(int y) const { return 2 + std::size_t(y); }
    std::size_t row(int y) const { return 1 + rows() + std::size_t(y); }
    /// From cell (x, y) to its eastern neighbour, which must exist.
    std::size_t east(int x, int y) const {
        return 1 + 2 * rows() + std::size_t(y) * (columns() - 1) + std::size_t(x);
    }
    std::size_t links() const { return 1 + 2 * rows() + rows() * (columns() - 1); }

    /// The cell or row of a unit, or of a link's source. Outside the array, x and y are -1.
    struct Place {
        int x = -1;
        int y = -1;
    };
    UnitGroup unit_group(std::size_t unit) const;
    Place unit_place(std::size_t unit) const;
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
};

}  // namespace raycell::loading
