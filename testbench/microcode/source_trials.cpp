// Trials of the programs for sources that are no points.
#include <algorithm>
#include <cmath>

#include "model/tracing/tracing.hpp"
#include "testbench/microcode/trial_lists.hpp"

namespace raycell {
namespace {

class FacingTrial : public MicroTrial {
  public:
    explicit FacingTrial(const MicroSetting& s) : MicroTrial(s, facing_program(s), {"source_facing"}) {
        source_.kind = SourceKind::directional;
    }

  private:
    void draw(MicroRandom& random) override {
        source_.axis = any_direction(random, arithmetic_);
        point_.normal = any_direction(random, arithmetic_);
        put("a", source_.axis);
        put("n", point_.normal);
    }
    void compare() override {
        expect("cosine", take("cosine"), view_source(point_, source_, arithmetic_).cosine);
    }
    Source source_;
    ShadePoint point_;
};

class EmissionTrial : public MicroTrial {
  public:
    explicit EmissionTrial(const MicroSetting& s)
        : MicroTrial(s, emission_program(s), {"source_emission", 1, 0, 0, 1}),
          operators_(s.numbers.operators, s.numbers.word_bits, s.numbers.rounding),
          rounded_(s.numbers.operators.power == PowerMethod::rounded) {
        source_.kind = SourceKind::spot;
    }

  private:
    /// Nearly always inside the cone: a power is charged for each.
    void draw(MicroRandom& random) override {
        const Format& unit = arithmetic_.formats().unit;
        const bool any = random.chance(0.02);
        double along = 0;
        dvec3 direction;
        do {
            for (int i = 0; i < 3; ++i) source_.position[i] = random.uniform(-100, 100);
            source_.position = arithmetic_.hold_place(source_.position);
            source_.axis = any_direction(random, arithmetic_);
            source_.cut_off = random.chance(0.5) ? 0 : unit.hold(random.uniform(0, 1));
            direction = view_source(point_, source_, arithmetic_).direction;
            along = arithmetic_.dot(unit, source_.axis, direction);
        } while (!any && along <= source_.cut_off);
        source_.falloff = arithmetic_.hold_shine(random.uniform(0, 100));
        put("a", source_.axis);
        put("l", direction);
        put("cut-off", source_.cut_off);
        put("falloff", operators_.exponent_word().hold(source_.falloff));
        if (rounded_) put("power", along > 0 ? arithmetic_.power(along, source_.falloff) : 0);
    }
    void compare() override {
        expect("emission", take("emission"), view_source(point_, source_, arithmetic_).emission);
    }
    Operators operators_;
    bool rounded_;
    Source source_;
    ShadePoint point_;
};

class EmittedTrial : public MicroTrial {
  public:
    explicit EmittedTrial(const MicroSetting& s) : MicroTrial(s, emitted_program(s), {"emitted"}) {}

  private:
    void draw(MicroRandom& random) override {
        const Format& unit = arithmetic_.formats().unit;
        for (double* share : {&emission_, &cosine_, &highlight_}) *share = random.word(unit, 0, 1);
        put("emission", emission_);
        put("cosine", cosine_);
        put("highlight", highlight_);
    }
    void compare() override {
        const Format& unit = arithmetic_.formats().unit;
        expect("cosine", take("cosine"), arithmetic_.product(unit, cosine_, emission_));
        expect("highlight", take("highlight"), arithmetic_.product(unit, highlight_, emission_));
    }
    double emission_ = 0, cosine_ = 0, highlight_ = 0;
};

class ShiftTrial : public MicroTrial {
  public:
    explicit ShiftTrial(const MicroSetting& s) : MicroTrial(s, shift_program(s), {"sample_shift"}) {}

  private:
    void draw(MicroRandom& random) override {
        polygon_ = std::uint32_t(random.uniform(0, 1 << 20));
        x_ = int(random.uniform(0, 4096));
        y_ = int(random.uniform(0, 4096));
        put("polygon", polygon_);
        put("x", x_);
        put("y", y_);
    }
    void compare() override {
        const SamplePlace shift = shift_of(polygon_, x_, y_);
        expect("u", take("u"), shift.u);
        expect("v", take("v"), shift.v);
    }
    std::uint32_t polygon_ = 0;
    int x_ = 0, y_ = 0;
};

/// A pattern's next place, drawn; what programs of samples share.
class PlaceTrial : public MicroTrial {
  protected:
    PlaceTrial(const MicroSetting& s, MicroProgram program, MicroCost cost)
        : MicroTrial(s, std::move(program), std::move(cost)) {}

    static std::uint16_t any(MicroRandom& random) {
        return std::uint16_t(random.chance(0.1) ? 0 : random.chance(0.1) ? 0xffff : random.uniform(0, 65536));
    }
    void draw_place(MicroRandom& random) {
        const SamplePlace before{any(random), any(random)}, step{any(random), any(random)};
        shift_ = {any(random), any(random)};
        place_ = before + step;
        put("u", before.u);
        put("v", before.v);
        put("step u", step.u);
        put("step v", step.v);
        put("shift u", shift_.u);
        put("shift v", shift_.v);
    }
    /// In the array, around it, or far away.
    dvec3 any_place(MicroRandom& random) const {
        const double size = std::exp2(random.uniform(0, random.chance(0.2) ? 29 : 12));
        return size * dvec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    }
    void put_mantissas(const std::string& name, const dvec3& v) {
        for (int i = 0; i < 3; ++i) put(name + "xyz"[i], scale_by(v[i], -source_.exponent));
    }
    void expect_place(const dvec3& from) {
        expect("u", take("u"), place_.u);
        expect("v", take("v"), place_.v);
        const Source sample = sample_of(source_, place_ + shift_, from, arithmetic_);
        for (int i = 0; i < 3; ++i)
            expect(std::string("s") + "xyz"[i], take(std::string("s") + "xyz"[i]),
                   scale_by(sample.position[i], -source_.exponent));
    }
    Source source_;
    SamplePlace place_, shift_;
};

class SampleTrial : public PlaceTrial {
  public:
    explicit SampleTrial(const MicroSetting& s) : PlaceTrial(s, sample_program(s), {"sample_place"}) {}

  private:
    void draw(MicroRandom& random) override {
        Source source;
        source.kind = random.chance(0.5) ? SourceKind::rectangle : SourceKind::triangle;
        source.position = any_place(random);
        source.edge_u = any_place(random);
        source.edge_v = any_place(random);
        source_ = hold(source, arithmetic_);
        draw_place(random);
        put("fold", source_.kind == SourceKind::triangle ? 1 : 0);
        put_mantissas("c", source_.position);
        put_mantissas("u ", source_.edge_u);
        put_mantissas("v ", source_.edge_v);
    }
    void compare() override { expect_place(dvec3(0)); }
};

class DiscAxesTrial : public MicroTrial {
  public:
    explicit DiscAxesTrial(const MicroSetting& s)
        : MicroTrial(s, disc_axes_program(s), {"disc_axes", 1, 0, 2}) {}

  private:
    void draw(MicroRandom& random) override {
        const Format mantissa(1, arithmetic_.formats().word_bits + 11);
        do {
            for (int i = 0; i < 3; ++i)
                way_[i] = random.chance(0.05) ? 0 : mantissa.hold(random.uniform(-1, 1));
        } while (way_ == dvec3(0));
        put("w", way_);
    }
    void compare() override {
        const DiscAxes axes = disc_axes(way_, arithmetic_);
        expect("t", axes.first);
        expect("b", axes.second);
    }
    dvec3 way_{0, 0, 0};
};

class DiscTrial : public PlaceTrial {
  public:
    explicit DiscTrial(const MicroSetting& s) : PlaceTrial(s, disc_program(s), {"disc_place", 1, 0, 1}) {}

  private:
    void draw(MicroRandom& random) override {
        Source source;
        source.kind = SourceKind::sphere;
        source.position = any_place(random);
        source.radius = std::abs(any_place(random).x);
        source_ = hold(source, arithmetic_);
        draw_place(random);
        // As seen from the array's corner; a sphere around that has no axes.
        const dvec3 way = arithmetic_.way(from_, source_.position);
        const DiscAxes axes = way == dvec3(0) ? DiscAxes{dvec3(0), dvec3(0)} : disc_axes(way, arithmetic_);
        put("t", axes.first);
        put("b", axes.second);
        put_mantissas("c", source_.position);
        put("radius", scale_by(source_.radius, -source_.exponent));
    }
    void compare() override { expect_place(from_); }
    dvec3 from_{0, 0, 0};
};

class LitSampleTrial : public MicroTrial {
  public:
    explicit LitSampleTrial(const MicroSetting& s)
        : MicroTrial(s, lit_sample_program(s), {"per_lit_sample", 1, 0, 0, 1}),
          operators_(s.numbers.operators, s.numbers.word_bits, s.numbers.rounding),
          rounded_(s.numbers.operators.power == PowerMethod::rounded) {}

  private:
    /// Nearly always with a highlight: a power is charged for each.
    void draw(MicroRandom& random) override {
        const Formats& f = arithmetic_.formats();
        const bool any = random.chance(0.02);
        do {
            direction_ = any_direction(random, arithmetic_);
            mirrored_ = any_direction(random, arithmetic_);
            along_ = arithmetic_.dot(f.unit, mirrored_, direction_);
        } while (!any && along_ <= 0);
        cosine_ = random.word(f.unit, 0, 1);
        specular_ = any ? 0 : std::max(random.word(f.feature, 0, 1), f.feature.step());
        shine_ = arithmetic_.hold_shine(random.uniform(0, 200));
        for (double* sum : {&diffuse_, &highlight_}) *sum = f.unit.hold(random.uniform(0, 1)) * 60;
        put("cosine", cosine_);
        put("ks", specular_);
        put("shine", operators_.exponent_word().hold(shine_));
        put("l", direction_);
        put("r", mirrored_);
        put("diffuse", diffuse_);
        put("highlight", highlight_);
        if (rounded_) put("power", along_ > 0 ? arithmetic_.power(along_, shine_) : 0);
    }
    void compare() override {
        const bool shines = specular_ > 0 && along_ > 0;
        expect("diffuse", take("diffuse"), diffuse_ + cosine_);
        expect("highlight", take("highlight"), highlight_ + (shines ? arithmetic_.power(along_, shine_) : 0));
    }
    Operators operators_;
    bool rounded_;
    dvec3 direction_{0, 0, 1}, mirrored_{0, 0, 1};
    double along_ = 0, cosine_ = 0, specular_ = 0, shine_ = 0, diffuse_ = 0, highlight_ = 0;
};

class MeanTrial : public MicroTrial {
  public:
    explicit MeanTrial(const MicroSetting& s) : MicroTrial(s, mean_program(s), {"sample_mean"}) {}

  private:
    void draw(MicroRandom& random) override {
        const Format& unit = arithmetic_.formats().unit;
        const int samples = int(random.uniform(1, 65));
        share_ = Lights({}, samples, arithmetic_).share;
        for (double* sum : {&diffuse_, &highlight_}) {
            *sum = 0;
            for (int k = 0; k < samples; ++k) *sum += unit.hold(random.uniform(0, 1));
        }
        const int exponent = exponent_of(share_) + 1;
        put("diffuse", diffuse_);
        put("highlight", highlight_);
        put("share", scale_by(share_, -exponent));
        put("share exponent", exponent);
    }
    void compare() override {
        const Format& unit = arithmetic_.formats().unit;
        expect("mean diffuse", take("mean diffuse"), arithmetic_.long_mac(unit, 0, diffuse_, share_));
        expect("mean highlight", take("mean highlight"), arithmetic_.long_mac(unit, 0, highlight_, share_));
    }
    double share_ = 1, diffuse_ = 0, highlight_ = 0;
};

}  // namespace

TrialList source_trials(const MicroSetting& s) {
    TrialList all;
    all.push_back(std::make_unique<FacingTrial>(s));
    all.push_back(std::make_unique<EmissionTrial>(s));
    all.push_back(std::make_unique<EmittedTrial>(s));
    all.push_back(std::make_unique<ShiftTrial>(s));
    all.push_back(std::make_unique<SampleTrial>(s));
    all.push_back(std::make_unique<DiscAxesTrial>(s));
    all.push_back(std::make_unique<DiscTrial>(s));
    all.push_back(std::make_unique<LitSampleTrial>(s));
    all.push_back(std::make_unique<MeanTrial>(s));
    return all;
}

}  // namespace raycell
