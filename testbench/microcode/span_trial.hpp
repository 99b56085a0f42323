// Trials of programs that read a span: how spans are drawn, put into registers and compared.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "model/loading/loading.hpp"
#include "model/numbers/field_widths.hpp"
#include "testbench/microcode/trials.hpp"

namespace raycell {

/// The levels of a machine: as many as it asks for, of a height that cells can be told.
inline DepthLevels levels_of(const ArrayExtent& extent) {
    DepthLevels levels;
    levels.count = std::max(1, int(std::lround(extent.depth / extent.level)));
    const double level = extent.depth / levels.count;
    const double step = scale_by(1, exponent_of(level) + 1 - field::level_mantissa);
    levels.level = std::floor(level / step) * step;
    return levels;
}

/// Draws spans: of triangles from half a cell to several cells wide, now and then much larger or seen
/// edge-on.
class SpanDraw {
  public:
    SpanDraw(const MicroSetting& s, HitTest rung, Normals normals)
        : extent(s.extent), levels(levels_of(s.extent)), arithmetic(s.numbers, s.extent) {
        settings.hit = rung;
        settings.normals = normals;
        settings.numbers = s.numbers;
        settings.depth_levels = levels.count;
        extent.depth = levels.level * levels.count;
    }

    Span draw(MicroRandom& random) {
        for (;;) {
            std::optional<Span> span = try_once(random);
            if (span) return *span;
        }
    }

    ArrayExtent extent;
    DepthLevels levels;
    PictureSettings settings;
    Arithmetic arithmetic;

  private:
    std::optional<Span> try_once(MicroRandom& random) {
        const double size = random.chance(0.1) ? 40 : std::exp2(random.uniform(-1, 3));
        const dvec3 centre(random.uniform(0, extent.width), random.uniform(0, extent.height),
                           random.uniform(0, extent.depth));
        std::array<dvec3, 3> corners;
        std::array<dvec3, 3> normals;
        const bool axial = random.chance(0.1);
        const int axis = int(random.uniform(0, 3));
        for (std::size_t i = 0; i < 3; ++i) {
            dvec3 way(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
            if (axial) way[axis] = 0;
            corners[i] = centre + size / 2 * way;
        }
        const dvec3 across = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
        if (glm::length(across) < 0.01 * size * size) return std::nullopt;
        const bool flat = random.chance(0.2);
        const double bend = random.chance(0.1) ? 2 : 0.3;
        for (dvec3& normal : normals) {
            normal = glm::normalize(across);
            for (int i = 0; !flat && i < 3; ++i) normal[i] += bend * random.uniform(-1, 1);
            normal = glm::normalize(normal);
        }
        Polygon polygon = make_triangle(1, 0, corners, normals);
        const Box cube{{0, 0, 0}, {double(extent.width), double(extent.height), extent.depth}};
        if (!clip_to_cube(polygon, cube, arithmetic)) return std::nullopt;
        const std::vector<Trapeze> trapezes = precompute(polygon, arithmetic, extent.width, extent.height);
        if (trapezes.empty()) return std::nullopt;
        const Trapeze& t = trapezes[std::size_t(random.uniform(0, double(trapezes.size())))];
        const int row = std::min(int(random.uniform(t.rows.first, t.rows.last + 1)), t.rows.last);
        std::optional<Span> span = cut_span(t, row, extent.depth, settings.hit, arithmetic);
        if (!span) return std::nullopt;
        for (int cells = int(random.uniform(0, span->last - span->x + 1)); cells > 0; --cells)
            advance(*span, arithmetic);
        return span;
    }
};

class SpanTrial : public MicroTrial {
  protected:
    SpanTrial(const MicroSetting& s, MicroProgram program, MicroCost cost, HitTest rung, Normals normals)
        : MicroTrial(s, std::move(program), std::move(cost)), spans_(s, rung, normals) {}

    void draw_span(MicroRandom& random) { span_ = spans_.draw(random); }
    void put_axis() {
        put("drop x", span_.drop == 0);
        put("drop z", span_.drop == 2);
    }
    void put_plane() {
        const Projection axes = projection(span_.drop);
        put("negative", span_.plane.n[span_.drop] < 0);
        put("nu", span_.plane.n[axes.u]);
        put("nv", span_.plane.n[axes.v]);
        put("c", span_.plane.c);
        put("slack", span_.slack[span_.drop]);
        put("edges", span_.edge_count);
        for (std::size_t i = 0; i < std::size_t(span_.edge_count); ++i) {
            const std::string number = " " + std::to_string(i);
            put("edge a" + number, span_.edges[i].a);
            put("edge b" + number, span_.edges[i].b);
            put("edge c" + number, span_.edges[i].c);
        }
    }
    void put_normals() {
        put("b", span_.normal.base);
        put("u", span_.normal.du);
        put("v", span_.normal.dv);
    }
    void put_depth() {
        put("z", span_.z);
        put("dz", span_.dz);
        put("n", span_.n);
        put("dn", span_.dn);
    }
    void put_all() {
        put_axis();
        if (spans_.settings.hit == HitTest::depth) {
            put_depth();
        } else {
            put_plane();
        }
        put_normals();
    }
    /// The voxel of the span, as the cell stores it; nothing if the polygon does not touch the cell.
    bool make(CellStore& store) const {
        return store_voxel(store, span_, spans_.settings, spans_.levels.level, arithmetic_);
    }
    void expect_advanced() {
        const bool passes = span_.x < span_.last;
        expect("passes", take("passes"), passes);
        if (!passes) return;
        Span next = span_;
        advance(next, arithmetic_);
        expect("x", take("x"), next.x);
        const bool depth = spans_.settings.hit == HitTest::depth;
        if (!depth || spans_.settings.normals == Normals::linear) expect("b", next.normal.base);
        if (depth) {
            expect("z", take("z"), next.z);
            if (spans_.settings.normals == Normals::voxel) expect("n", next.n);
            return;
        }
        expect("c", take("c"), next.plane.c);
        for (std::size_t i = 0; i < std::size_t(next.edge_count); ++i) {
            const std::string name = "edge c " + std::to_string(i);
            expect(name, take(name), next.edges[i].c);
        }
    }
    void expect_run(const Voxel& voxel) const {
        expect("near level", take("near level"), voxel.near_level);
        expect("far level", take("far level"), voxel.far_level);
        expect("near", take("near"), voxel.near);
        expect("far", take("far"), voxel.far);
    }
    void expect_slopes(const Voxel& voxel) const {
        const Projection axes = projection(voxel.drop);
        expect("plane u", take("plane u"), voxel.plane.n[axes.u]);
        expect("plane v", take("plane v"), voxel.plane.n[axes.v]);
    }
    void expect_plane(const Voxel& voxel) const {
        expect_slopes(voxel);
        expect("plane c", take("plane c"), voxel.plane.c);
    }
    void expect_normals(const Voxel& voxel) const {
        expect("normal b", voxel.normal.base);
        expect("normal u", voxel.normal.du);
        expect("normal v", voxel.normal.dv);
    }
    void put_place(const Voxel& voxel) {
        const dvec2 point = project(voxel.point, voxel.drop);
        put("near", voxel.near);
        put("far", voxel.far);
        put("point u", point.x);
        put("point v", point.y);
        put("anchor v", voxel.drop == 2 ? point.y : point.y - voxel.base);
    }

    SpanDraw spans_;
    Span span_;
};

}  // namespace raycell
