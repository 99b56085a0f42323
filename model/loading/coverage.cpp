#include "model/loading/coverage.hpp"

#include <algorithm>

#include "model/loading/loading_words.hpp"

namespace raycell {
namespace {

constexpr int window_bits = 5;  // 32nds
constexpr int mask_bits = 3;    // eighths

template <typename Ops>
class Coverer {
  public:
    using N = typename Ops::Number;
    struct Rectangle {
        Corner<N> low;
        Corner<N> high;
    };
    Coverer(const PartBounds& bounds, double near, double far, const Arithmetic& arithmetic)
        : ops_(arithmetic), axes_(projection(bounds.drop)), hair_(ops_.number(arithmetic.hair())) {
        whole_ = rectangle({0, 0, near}, {1, 1, far});
        for (int i = 0; i < bounds.edge_count; ++i) {
            const EdgeFunction& edge = bounds.edges[i];
            lines_[std::size_t(i)] = {ops_.number(edge.a), ops_.number(edge.b), ops_.number(edge.c)};
        }
        count_ = bounds.edge_count;
    }

    Coverage run(const Part& part, bool with_mask) {
        Coverage result;
        for (int i = 0; i < count_ && result.touched; ++i) {
            const Line<N>& line = lines_[std::size_t(i)];
            result.touched = most_over(line, whole_) >= -hair_;
            if (least_over(line, whole_) < -hair_) result.crossing[std::size_t(result.crossings++)] = i;
        }
        if (result.touched && with_mask) set_mask(result, rectangle(part.low, part.high));
        return result;
    }

  private:
    Rectangle rectangle(const dvec3& low, const dvec3& high) const {
        return {{ops_.number(low[axes_.u]), ops_.number(low[axes_.v])},
                {ops_.number(high[axes_.u]), ops_.number(high[axes_.v])}};
    }
    N least_over(const Line<N>& line, const Rectangle& r) const {
        return ops_.value(line, {line.a > 0 ? r.low.u : r.high.u, line.b > 0 ? r.low.v : r.high.v});
    }
    N most_over(const Line<N>& line, const Rectangle& r) const {
        return ops_.value(line, {line.a > 0 ? r.high.u : r.low.u, line.b > 0 ? r.high.v : r.low.v});
    }
    bool overlap(const Rectangle& a, const Rectangle& b) const {
        return a.low.u <= b.high.u + hair_ && b.low.u <= a.high.u + hair_ && a.low.v <= b.high.v + hair_ &&
               b.low.v <= a.high.v + hair_;
    }

    /// The window: the part's bounds, rounded outwards to 32nds of the footprint.
    void set_range(std::uint8_t* window, N low, N high, N whole_low, N size) const {
        const int from = ops_.parts_down(low - hair_ - whole_low, size, window_bits);
        const int to = ops_.parts_up(high + hair_ - whole_low, size, window_bits);
        window[0] = std::uint8_t(std::clamp(from, 0, window_steps - 1));
        window[1] = std::uint8_t(std::clamp(to, window[0] + 1, window_steps));
    }

    void set_mask(Coverage& result, const Rectangle& part) const {
        const N u = whole_.high.u - whole_.low.u;
        const N v = whole_.high.v - whole_.low.v;
        set_range(&result.window[0], part.low.u, part.high.u, whole_.low.u, u);
        set_range(&result.window[2], part.low.v, part.high.v, whole_.low.v, v);
        const auto place = [&](int at_u, int at_v) {
            return Corner<N>{ops_.step(whole_.low.u, u, at_u, window_bits),
                             ops_.step(whole_.low.v, v, at_v, window_bits)};
        };
        const Corner<N> low = place(result.window[0], result.window[2]);
        const Corner<N> high = place(result.window[1], result.window[3]);
        const auto border = [&](int column, int row) {
            return Corner<N>{ops_.step(low.u, high.u - low.u, column, mask_bits),
                             ops_.step(low.v, high.v - low.v, row, mask_bits)};
        };
        for (int row = 0; row < 8; ++row) {
            for (int column = 0; column < 8; ++column) {
                const Rectangle cell{border(column, row), border(column + 1, row + 1)};
                bool touched = overlap(cell, part);
                for (int i = 0; i < result.crossings && touched; ++i) {
                    const Line<N>& line = lines_[std::size_t(result.crossing[std::size_t(i)])];
                    touched = most_over(line, cell) >= -hair_;
                }
                if (touched) result.mask |= std::uint64_t(1) << unsigned(8 * row + column);
            }
        }
    }

    Ops ops_;
    Projection axes_;
    N hair_;
    Rectangle whole_;
    std::array<Line<N>, 4> lines_;
    int count_ = 0;
};

}  // namespace

Coverage cover(const PartBounds& bounds, const Part& part, double near, double far, bool with_mask,
               const Arithmetic& arithmetic) {
    if (arithmetic.exact()) return Coverer<Doubles>(bounds, near, far, arithmetic).run(part, with_mask);
    return Coverer<LoadingWords>(bounds, near, far, arithmetic).run(part, with_mask);
}

}  // namespace raycell
