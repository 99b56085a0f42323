// Trials of what a cell does while it is loaded, on spans of random polygons.
#include "model/loading/loading_words.hpp"
#include "testbench/microcode/span_trial.hpp"
#include "testbench/microcode/trial_lists.hpp"

namespace raycell {
namespace {

class ForwardTrial : public MicroTrial {
  public:
    explicit ForwardTrial(const MicroSetting& s)
        : MicroTrial(s, forward_program(s), {"load_forward"}), width_(s.extent.width) {}

  private:
    /// Messages that pass on: spans of other columns, and what all cells latch.
    void draw(MicroRandom& random) override {
        column_ = int(random.uniform(0, width_));
        x_ = random.chance(0.1) ? column_ : int(random.uniform(0, width_));
        type_ = random.chance(0.5) ? 5 : random.chance(0.5) ? 6 : int(random.uniform(0, 2));
        put("type", type_);
        put("x", x_);
        put("column", column_);
    }
    void compare() override { expect("makes", take("makes"), type_ == 5 && x_ == column_); }
    int width_;
    int column_ = 0, x_ = 0, type_ = 0;
};

class AdvanceTrial : public SpanTrial {
  public:
    explicit AdvanceTrial(const MicroSetting& s, HitTest rung, Normals normals)
        : SpanTrial(s, advance_program(s, rung, normals),
                    rung == HitTest::edge ? MicroCost{"load_advance"} : MicroCost{}, rung, normals) {}

  private:
    void draw(MicroRandom& random) override {
        draw_span(random);
        put("x", span_.x);
        put("last", span_.last);
        put_all();
    }
    void compare() override { expect_advanced(); }
};

/// A part, its corners in words: a rectangle, or what one line leaves of another's.
class CutTrial : public SpanTrial {
  public:
    explicit CutTrial(const MicroSetting& s)
        : SpanTrial(s, cut_program(s), {}, HitTest::edge, Normals::linear), words_(arithmetic_) {}

  private:
    using N = LoadingWords::Number;
    void draw(MicroRandom& random) override {
        do {
            draw_span(random);
        } while (span_.edge_count == 0);
        const N one = words_.number(1);
        const N far = span_.drop == 2 ? one : words_.number(spans_.extent.depth);
        corners_ = {{0, 0}, {one, 0}, {one, far}, {0, far}};
        int edge = int(random.uniform(0, span_.edge_count));
        const int before = int(random.uniform(0, span_.edge_count));
        for (int i = 0; i < before; ++i) {
            const std::vector<Corner<N>> left = cut(corners_, line(i));
            if (left.empty()) break;
            corners_ = left;
            edge = before;
        }
        line_ = line(edge);
        begin_ = random.chance(0.5) ? 0 : 10;
        put("begin", begin_);
        put("other", 10 - begin_);
        put("corners", double(corners_.size()));
        for (std::size_t i = 0; i < corners_.size(); ++i) {
            const std::string number = " " + std::to_string(std::size_t(begin_) + i);
            put_bits("u" + number, corners_[i].u);
            put_bits("v" + number, corners_[i].v);
        }
        put_bits("line a", line_.a);
        put_bits("line b", line_.b);
        put_bits("line c", line_.c);
    }
    Line<N> line(int edge) const {
        const EdgeFunction& e = span_.edges[std::size_t(edge)];
        return {words_.number(e.a), words_.number(e.b), words_.number(e.c) + words_.room()};
    }
    /// Sutherland and Hodgman's: the same as in part_in(), which does not tell its corners.
    std::vector<Corner<N>> cut(const std::vector<Corner<N>>& part, const Line<N>& by) const {
        std::vector<Corner<N>> kept;
        for (std::size_t i = 0; i < part.size(); ++i) {
            const Corner<N>& p = part[i];
            const Corner<N>& q = part[(i + 1) % part.size()];
            const N dp = words_.value(by, p);
            const N dq = words_.value(by, q);
            if (dp >= 0) kept.push_back(p);
            if ((dp >= 0) == (dq >= 0) || std::max(dp, dq) == 0) continue;
            const Corner<N>& in = dp > 0 ? p : q;
            const Corner<N>& out = dp > 0 ? q : p;
            kept.push_back({words_.between(in.u, out.u, std::max(dp, dq), std::min(dp, dq)),
                            words_.between(in.v, out.v, std::max(dp, dq), std::min(dp, dq))});
        }
        if (kept.size() < 3) kept.clear();
        return kept;
    }
    void compare() override {
        const std::vector<Corner<N>> left = cut(corners_, line_);
        expect("corners", take("corners"), double(left.size()));
        const auto begin = std::size_t(take("begin"));
        const auto number = [&](const std::string& name) { return words_.number(take(name)); };
        for (std::size_t i = 0; i < left.size(); ++i) {
            const std::string at = " " + std::to_string(begin + i);
            expect("u" + at, double(number("u" + at)), double(left[i].u));
            expect("v" + at, double(number("v" + at)), double(left[i].v));
        }
    }
    LoadingWords words_;
    std::vector<Corner<N>> corners_;
    Line<N> line_{};
    int begin_ = 0;
};

class PartTrial : public SpanTrial {
  public:
    explicit PartTrial(const MicroSetting& s)
        : SpanTrial(s, part_program(s, levels_of(s.extent)), {}, HitTest::edge, Normals::linear) {}

  private:
    void draw(MicroRandom& random) override {
        draw_span(random);
        put_axis();
        put_plane();
    }
    void compare() override {
        const Box column{-span_.slack, dvec3(1, 1, spans_.extent.depth) + span_.slack};
        const Part part =
            part_in({span_.plane, span_.drop, span_.edges.data(), span_.edge_count}, column, arithmetic_);
        expect("made", take("made"), !part.empty());
        if (part.empty()) return;
        const dvec2 middle = project(part.middle, span_.drop);
        expect("corners", take("corners"), part.corners);
        expect("z low", take("z low"), part.low.z);
        expect("z high", take("z high"), part.high.z);
        expect("middle u", take("middle u"), middle.x);
        expect("middle v", take("middle v"), middle.y);
        expect("twice area", take("twice area"), 2 * part.area);
    }
};

class LevelsTrial : public SpanTrial {
  public:
    explicit LevelsTrial(const MicroSetting& s)
        : SpanTrial(s, levels_program(s, levels_of(s.extent)), {}, HitTest::edge, Normals::linear) {}

  private:
    void draw(MicroRandom& random) override {
        do {
            draw_span(random);
            store_ = CellStore();
        } while (!make(store_));
        const Box column{-span_.slack, dvec3(1, 1, spans_.extent.depth) + span_.slack};
        const Part part =
            part_in({span_.plane, span_.drop, span_.edges.data(), span_.edge_count}, column, arithmetic_);
        put_axis();
        put("slack", span_.slack[span_.drop]);
        put("z low", part.low.z);
        put("z high", part.high.z);
    }
    void compare() override { expect_run(store_.voxels[0]); }
    CellStore store_;
};

/// A part of a voxel, from the voxel that the model makes.
class VoxelPartTrial : public SpanTrial {
  protected:
    VoxelPartTrial(const MicroSetting& s, MicroProgram program, Normals normals)
        : SpanTrial(s, std::move(program), {}, HitTest::edge, normals) {}
    void draw_voxel(MicroRandom& random) {
        do {
            draw_span(random);
            store_ = CellStore();
        } while (!make(store_));
        put_axis();
        put_plane();
    }
    CellStore store_;
};

class EdgeOfVoxelTrial : public VoxelPartTrial {
  public:
    explicit EdgeOfVoxelTrial(const MicroSetting& s)
        : VoxelPartTrial(s, edge_of_voxel_program(s), Normals::linear) {}

  private:
    void draw(MicroRandom& random) override {
        Coverage crossed;
        do {
            draw_voxel(random);
            const Voxel& voxel = store_.voxels[0];
            crossed = cover({span_.plane, span_.drop, span_.edges.data(), span_.edge_count}, {}, voxel.near,
                            voxel.far, false, arithmetic_);
        } while (crossed.crossings == 0);
        kept_ = std::size_t(random.uniform(0, crossed.crossings));
        const EdgeFunction& edge = span_.edges[std::size_t(crossed.crossing[kept_])];
        put("line a", edge.a);
        put("line b", edge.b);
        put("line c", edge.c);
        put("near", store_.voxels[0].near);
        put("far", store_.voxels[0].far);
    }
    void compare() override {
        const EdgeFunction& edge = store_.edges.at(kept_);
        expect("held a", take("held a"), edge.a);
        expect("held b", take("held b"), edge.b);
        expect("held c", take("held c"), edge.c);
    }
    std::size_t kept_ = 0;
};

class PlaneOfVoxelTrial : public VoxelPartTrial {
  public:
    explicit PlaneOfVoxelTrial(const MicroSetting& s)
        : VoxelPartTrial(s, plane_of_voxel_program(s), Normals::linear) {}

  private:
    void draw(MicroRandom& random) override {
        draw_voxel(random);
        put_place(store_.voxels[0]);
    }
    void compare() override { expect_plane(store_.voxels[0]); }
};

class NormalOfVoxelTrial : public VoxelPartTrial {
  public:
    NormalOfVoxelTrial(const MicroSetting& s, Normals normals)
        : VoxelPartTrial(s, normal_of_voxel_program(s, normals), normals) {}

  private:
    void draw(MicroRandom& random) override {
        draw_voxel(random);
        put_normals();
        put_place(store_.voxels[0]);
    }
    void compare() override { expect_normals(store_.voxels[0]); }
};

class VoxelTrial : public SpanTrial {
  public:
    VoxelTrial(const MicroSetting& s, HitTest rung, Normals normals, MicroCost cost)
        : SpanTrial(s, voxel_program(s, levels_of(s.extent), rung, normals), std::move(cost), rung, normals) {
    }

  private:
    void draw(MicroRandom& random) override {
        draw_span(random);
        put_all();
    }
    void compare() override {
        CellStore store;
        const bool made = make(store);
        expect("made", take("made"), made);
        if (made) expect_voxel(store);
    }
    void expect_mask(const Voxel& voxel) const {
        const char* const ends[] = {"mask u window from", "mask u window to", "mask v window from",
                                    "mask v window to"};
        for (std::size_t i = 0; i < 4; ++i) expect(ends[i], take(ends[i]), voxel.window[i]);
        for (unsigned row = 0; row < 8; ++row) {
            const std::string name = "mask row " + std::to_string(row);
            expect(name, take(name), double(voxel.mask >> (8 * row) & 0xff));
        }
    }
    void expect_voxel(const CellStore& store) {
        const Voxel& voxel = store.voxels[0];
        const HitTest rung = spans_.settings.hit;
        expect_run(voxel);
        expect_normals(voxel);
        const dvec2 point = project(voxel.point, voxel.drop);
        expect("point u", take("point u"), point.x);
        expect("point v", take("point v"), point.y);
        if (rung != HitTest::depth) expect("twice area", take("twice area"), 2 * voxel.area);
        if (rung == HitTest::interval) expect_slopes(voxel);
        if (rung >= HitTest::plane) expect_plane(voxel);
        if (rung == HitTest::mask) expect_mask(voxel);
        if (rung != HitTest::edge) return;
        expect("crossings", take("crossings"), double(store.edges.size()));
        for (std::size_t i = 0; i < store.edges.size(); ++i) {
            const std::string number = " " + std::to_string(i);
            expect("kept a" + number, take("kept a" + number), store.edges[i].a);
            expect("kept b" + number, take("kept b" + number), store.edges[i].b);
            expect("kept c" + number, take("kept c" + number), store.edges[i].c);
        }
    }
};

}  // namespace

TrialList loading_trials(const MicroSetting& s) {
    TrialList all;
    all.push_back(std::make_unique<ForwardTrial>(s));
    all.push_back(std::make_unique<AdvanceTrial>(s, HitTest::edge, Normals::linear));
    all.push_back(std::make_unique<CutTrial>(s));
    all.push_back(std::make_unique<PartTrial>(s));
    all.push_back(std::make_unique<LevelsTrial>(s));
    all.push_back(std::make_unique<EdgeOfVoxelTrial>(s));
    all.push_back(std::make_unique<PlaneOfVoxelTrial>(s));
    all.push_back(std::make_unique<NormalOfVoxelTrial>(s, Normals::linear));
    all.push_back(std::make_unique<NormalOfVoxelTrial>(s, Normals::voxel));
    all.push_back(std::make_unique<VoxelTrial>(s, HitTest::depth, Normals::voxel, MicroCost{"load_depth"}));
    all.push_back(
        std::make_unique<VoxelTrial>(s, HitTest::interval, Normals::linear, MicroCost{"load_interval"}));
    all.push_back(std::make_unique<VoxelTrial>(s, HitTest::plane, Normals::linear, MicroCost{"load_plane"}));
    all.push_back(std::make_unique<VoxelTrial>(s, HitTest::mask, Normals::linear, MicroCost{"load_mask"}));
    all.push_back(std::make_unique<VoxelTrial>(s, HitTest::edge, Normals::linear, MicroCost{"load_edge"}));
    return all;
}

TrialList loading_variants(const MicroSetting& s) {
    TrialList all;
    for (const Normals normals : {Normals::voxel, Normals::linear}) {
        all.push_back(std::make_unique<AdvanceTrial>(s, HitTest::depth, normals));
        for (const HitTest rung :
             {HitTest::depth, HitTest::interval, HitTest::plane, HitTest::mask, HitTest::edge})
            all.push_back(std::make_unique<VoxelTrial>(s, rung, normals, MicroCost{}));
    }
    return all;
}

}  // namespace raycell
