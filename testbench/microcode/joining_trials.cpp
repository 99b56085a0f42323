// Trials of what else a cell does while it is loaded: pieces that join a voxel, the index table, features and
// sources.
#include <cmath>

#include "testbench/microcode/span_trial.hpp"
#include "testbench/microcode/trial_lists.hpp"

namespace raycell {
namespace {

/// Two pieces of a polygon in one cell.
class JoinTrial : public SpanTrial {
  public:
    explicit JoinTrial(const MicroSetting& s)
        : SpanTrial(s, join_program(s, levels_of(s.extent)), {}, HitTest::edge, Normals::linear) {}

  private:
    void draw(MicroRandom& random) override {
        CellStore piece;
        do {
            draw_span(random);
            store_ = CellStore();
        } while (!make(store_));
        before_ = store_.voxels[0];
        do {
            draw_span(random);
            piece = CellStore();
        } while (span_.drop != before_.drop || !make(piece));
        piece_ = piece.voxels[0];
        put_axis_of(before_);
        put_part("", before_);
        put("twice area", 2 * before_.area);
        put_part("piece ", piece_);
        put("piece area", 2 * piece_.area);
        make(store_);
    }
    void put_axis_of(const Voxel& voxel) { put("drop z", voxel.drop == 2); }
    void put_part(const std::string& whose, const Voxel& voxel) {
        const dvec2 point = project(voxel.point, voxel.drop);
        put(whose + "near level", voxel.near_level);
        put(whose + "far level", voxel.far_level);
        put(whose + "near", voxel.near);
        put(whose + "point u", point.x);
        put(whose + "point v", point.y);
    }
    void compare() override {
        const Voxel& joined = store_.voxels.at(0);
        expect_run(joined);
        const dvec2 point = project(joined.point, joined.drop);
        expect("point u", take("point u"), point.x);
        expect("point v", take("point v"), point.y);
        expect("anchor v", take("anchor v"), joined.drop == 2 ? point.y : point.y - joined.base);
        expect("twice area", take("twice area"), 2 * joined.area);
        expect("way", take("way"), joined.near - before_.near);
        expect("piece way", take("piece way"), joined.near - piece_.near);
    }
    CellStore store_;
    Voxel before_, piece_;
};

class ComponentsTrial : public SpanTrial {
  public:
    explicit ComponentsTrial(const MicroSetting& s)
        : SpanTrial(s, components_program(s), {}, HitTest::edge, Normals::linear) {}

  private:
    void draw(MicroRandom& random) override {
        draw_span(random);
        normal_ = arithmetic_.hold(arithmetic_.formats().unit, span_.plane.n);
        const Projection axes = projection(span_.drop);
        put_axis();
        put("negative", span_.plane.n[span_.drop] < 0);
        put("plane u", normal_[axes.u]);
        put("plane v", normal_[axes.v]);
    }
    void compare() override { expect("n", normal_); }
    dvec3 normal_{0, 0, 0};
};

class MoveEdgeTrial : public MicroTrial {
  public:
    explicit MoveEdgeTrial(const MicroSetting& s) : MicroTrial(s, move_edge_program(s), {}) {}

  private:
    void draw(MicroRandom& random) override {
        const Formats& f = arithmetic_.formats();
        b_ = random.word(f.unit, -1, 1);
        c_ = random.word(f.edge_offset);
        way_ = random.word(f.depth);
        put("b", b_);
        put("c", c_);
        put("way", way_);
    }
    void compare() override {
        expect("c", take("c"), arithmetic_.mac(arithmetic_.formats().edge_offset, c_, b_, way_));
    }
    double b_ = 0, c_ = 0, way_ = 0;
};

class WidenTrial : public MicroTrial {
  public:
    explicit WidenTrial(const MicroSetting& s) : MicroTrial(s, widen_program(s), {}) {}

  private:
    void draw(MicroRandom& random) override {
        const Format& depth = arithmetic_.formats().depth;
        most_ = random.word(depth, 0, depth.most());
        far_ = random.word(depth, 0, depth.most());
        put("most", most_);
        put("far", far_);
    }
    void compare() override { expect("most", take("most"), std::max(most_, far_)); }
    double most_ = 0, far_ = 0;
};

class ShineTrial : public MicroTrial {
  public:
    explicit ShineTrial(const MicroSetting& s)
        : MicroTrial(s, shine_program(s), {}),
          word_(Operators(s.numbers.operators, s.numbers.word_bits, s.numbers.rounding).exponent_word()) {}

  private:
    void draw(MicroRandom& random) override {
        const Formats& f = arithmetic_.formats();
        const int fraction = f.shine_bits - Formats::shine_exponent_bits;
        shine_ = random.chance(0.1) ? 0 : arithmetic_.hold_shine(std::exp2(random.uniform(-9, 22)));
        const int exponent = shine_ > 0 ? exponent_of(shine_) + 9 : 0;
        put("exponent", exponent);
        put("fraction", shine_ > 0 ? scale_by(scale_by(shine_, 9 - exponent) - 1, fraction) : 0);
    }
    void compare() override {
        expect("shine", take("shine"), word_.hold(std::min(shine_, scale_by(1, word_.integer_bits() - 2))));
    }
    const Format word_;
    double shine_ = 0;
};

class SourcePlaceTrial : public MicroTrial {
  public:
    explicit SourcePlaceTrial(const MicroSetting& s) : MicroTrial(s, source_place_program(s), {}) {}

  private:
    void draw(MicroRandom& random) override {
        const double size = std::exp2(random.uniform(-2, 14));
        for (int i = 0; i < 3; ++i) place_[i] = random.uniform(-size, size);
        if (random.chance(0.1)) place_ = {-std::exp2(std::floor(random.uniform(0, 14))), 0, 0};
        place_ = arithmetic_.hold_place(place_);
        // As a message has it: the least exponent that keeps all below 1.
        const double most = std::max({place_.x, place_.y, place_.z, 0.0});
        const double least = std::min({place_.x, place_.y, place_.z, 0.0});
        int exponent = 0;
        if (most > 0 || least < 0) {
            exponent = -40;
            while (most >= std::exp2(exponent) || least < -std::exp2(exponent)) ++exponent;
        }
        put("exponent", exponent);
        for (int i = 0; i < 3; ++i) put(axis(i), scale_by(place_[i], -exponent));
    }
    void compare() override {
        const int exponent = arithmetic_.formats().place_exponent(place_);
        expect("exponent", take("exponent"), exponent);
        for (int i = 0; i < 3; ++i) expect(axis(i), take(axis(i)), scale_by(place_[i], -exponent));
    }
    static std::string axis(int i) { return std::string("s") + "xyz"[i]; }
    dvec3 place_{0, 0, 0};
};

}  // namespace

TrialList joining_trials(const MicroSetting& s) {
    TrialList all;
    all.push_back(std::make_unique<JoinTrial>(s));
    all.push_back(std::make_unique<ComponentsTrial>(s));
    all.push_back(std::make_unique<MoveEdgeTrial>(s));
    all.push_back(std::make_unique<WidenTrial>(s));
    all.push_back(std::make_unique<ShineTrial>(s));
    all.push_back(std::make_unique<SourcePlaceTrial>(s));
    return all;
}

}  // namespace raycell
