// Trials of the operators and of the shading unit's programs.
#include <algorithm>
#include <cmath>

#include "model/shading/shading.hpp"
#include "model/tracing/ray.hpp"
#include "testbench/microcode/trial_lists.hpp"

namespace raycell {
namespace {

/// 1/x or 1/sqrt(x).
class OperatorTrial : public MicroTrial {
  public:
    OperatorTrial(const MicroSetting& s, bool root)
        : MicroTrial(s, root ? root_program(s) : reciprocal_program(s), {root ? "root" : "reciprocal"}),
          root_(root),
          operators_(s.numbers.operators, s.numbers.word_bits, s.numbers.rounding) {}

  private:
    void draw(MicroRandom& random) override {
        const Formats& f = arithmetic_.formats();
        const Format& argument = root_ ? f.field : f.accumulator;
        do {
            x_ = root_ ? random.word(argument, 0, argument.most()) : random.word(argument);
        } while (x_ == 0);
        put("x", x_);
    }
    void compare() override {
        const double wanted = root_ ? operators_.inverse_root(x_) : operators_.reciprocal(x_);
        expect(root_ ? "1/sqrt(x)" : "1/x", std::ldexp(take("r"), int(take("exponent"))), wanted);
    }
    bool root_;
    Operators operators_;
    double x_ = 0;
};

class PowerTrial : public MicroTrial {
  public:
    explicit PowerTrial(const MicroSetting& s)
        : MicroTrial(s, power_program(s),
                     {"power", 1, s.numbers.operators.power == PowerMethod::schlick ? 1 : 0}),
          operators_(s.numbers.operators, s.numbers.word_bits, s.numbers.rounding) {}

  private:
    void draw(MicroRandom& random) override {
        // Mostly as shading has them; the corners end sooner and would make the mean too low.
        const Format& unit = arithmetic_.formats().unit;
        const Format& shine = operators_.exponent_word();
        if (random.chance(0.05)) {
            base_ = random.word(unit, -0.1, 1.5);
            shine_ = random.word(shine, 0, 1 << 19);
        } else {
            base_ = std::clamp(unit.hold(random.uniform(0, 1)), unit.step(), 1 - unit.step());
            const double most = std::exp2(random.uniform(0, 19));
            shine_ = shine.hold(arithmetic_.hold_shine(random.uniform(0, most)));
        }
        put("base", base_);
        put("shine", shine_);
    }
    void compare() override { expect("power", take("power"), operators_.power(base_, shine_)); }
    Operators operators_;
    double base_ = 0, shine_ = 0;
};

class NormaliseTrial : public MicroTrial {
  public:
    NormaliseTrial(const MicroSetting& s) : MicroTrial(s, normalise_program(s), {"", 1, 0, 1}) {}

  private:
    void draw(MicroRandom& random) override {
        do {
            for (int i = 0; i < 3; ++i) v_[i] = random.word(arithmetic_.formats().field);
        } while (v_ == dvec3(0));
        put("", v_);
    }
    void compare() override { expect("n", arithmetic_.normalise(v_)); }
    dvec3 v_{0, 0, 0};
};

class NormalTrial : public MicroTrial {
  public:
    explicit NormalTrial(const MicroSetting& s) : MicroTrial(s, normal_program(s), {"normal_linear"}) {}

  private:
    void draw(MicroRandom& random) override {
        const Formats& f = arithmetic_.formats();
        for (dvec3* v : {&base_, &du_, &dv_}) {
            for (int i = 0; i < 3; ++i) (*v)[i] = random.word(f.normal);
        }
        u_ = random.word(f.unit, 0, 1);
        v_ = random.chance(0.5) ? random.word(f.unit, 0, 1) : random.word(f.depth, 0, f.depth.most() / 8);
        put("b", base_);
        put("u", du_);
        put("v", dv_);
        put("u", u_);
        put("v", v_);
    }
    dvec3 field() const {
        dvec3 normal;
        for (int i = 0; i < 3; ++i)
            normal[i] = arithmetic_.mac(arithmetic_.formats().field, base_[i], u_, du_[i], v_, dv_[i]);
        return normal;
    }
    void compare() override { expect("f", field()); }
    dvec3 base_{0, 0, 0}, du_{0, 0, 0}, dv_{0, 0, 0};
    double u_ = 0, v_ = 0;
};

class ReflectTrial : public MicroTrial {
  public:
    ReflectTrial(const MicroSetting& s) : MicroTrial(s, reflect_program(s), {"reflect", 1, 0, 1}) {}

  private:
    void draw(MicroRandom& random) override {
        point_.direction = any_direction(random, arithmetic_);
        point_.normal = random.chance(0.1) ? -point_.direction : any_direction(random, arithmetic_);
        put("d", point_.direction);
        put("n", point_.normal);
    }
    void compare() override { expect("r", reflect_direction(point_, arithmetic_)); }
    ShadePoint point_;
};

class RefractTrial : public MicroTrial {
  public:
    RefractTrial(const MicroSetting& s) : MicroTrial(s, refract_program(s), {"refract", 1, 1, 2}) {}

  private:
    void draw(MicroRandom& random) override {
        point_.direction = any_direction(random, arithmetic_);
        point_.normal = random.chance(0.1) ? -point_.direction : any_direction(random, arithmetic_);
        if (glm::dot(point_.direction, point_.normal) > 0) point_.normal = -point_.normal;
        point_.entering = random.chance(0.5);
        const Format& word = arithmetic_.formats().ior;
        ior_ = std::max(random.chance(0.1) ? random.word(word, 0, 3) : word.hold(random.uniform(1, 2)),
                        word.step());
        put("d", point_.direction);
        put("n", point_.normal);
        put("ior", ior_);
        put("entering", point_.entering ? 1 : 0);
    }
    void compare() override {
        dvec3 refracted;
        expect("total", take("total"), refract_direction(point_, ior_, refracted, arithmetic_) ? 0 : 1);
        expect("r", transmit_direction(point_, ior_, arithmetic_));
    }
    ShadePoint point_;
    double ior_ = 1;
};

class AmbientTrial : public MicroTrial {
  public:
    explicit AmbientTrial(const MicroSetting& s) : MicroTrial(s, ambient_program(s), {"local_intensity"}) {}

  private:
    void draw(MicroRandom& random) override {
        const Format& word = arithmetic_.formats().feature;
        material_.diffuse = random.word(word, 0, word.most());
        for (int i = 0; i < 3; ++i) material_.colour[i] = random.word(word, 0, word.most());
        put("kd", material_.diffuse);
        put("c", material_.colour);
    }
    void compare() override { expect("s", local_intensity({}, material_, nullptr, 0, 0, arithmetic_)); }
    Material material_;
};

class LightTrial : public MicroTrial {
  public:
    explicit LightTrial(const MicroSetting& s)
        : MicroTrial(s, light_program(s), {"per_lit_source", 1, 0, 0, 1}),
          operators_(s.numbers.operators, s.numbers.word_bits, s.numbers.rounding),
          rounded_(s.numbers.operators.power == PowerMethod::rounded) {}

  private:
    /// Nearly always a source with a highlight: a power is charged for each.
    void draw(MicroRandom& random) override {
        const Formats& f = arithmetic_.formats();
        const bool any = random.chance(0.02);
        SourceView view;
        dvec3 mirrored{0, 0, 0};
        double along = 0;
        do {
            point_.direction = any_direction(random, arithmetic_);
            point_.normal = any_direction(random, arithmetic_);
            point_.position = {f.unit.hold(random.uniform(0, 1)), f.unit.hold(random.uniform(0, 1)), 0};
            for (int i = 0; i < 3; ++i) source_.position[i] = random.uniform(-100, 100);
            source_.position = arithmetic_.hold_place(source_.position);
            view = view_source(point_, source_, arithmetic_);
            if (view.cosine < 0) point_.normal = -point_.normal;
            view = view_source(point_, source_, arithmetic_);
            mirrored = reflect_direction(point_, arithmetic_);
            along = arithmetic_.dot(f.unit, mirrored, view.direction);
        } while (!view.faces() || !(any || along > 0));
        material_.diffuse = random.word(f.feature, 0, 1);
        material_.specular = any ? 0 : std::max(random.word(f.feature, 0, 1), f.feature.step());
        material_.shine = arithmetic_.hold_shine(random.uniform(0, 200));
        for (int i = 0; i < 3; ++i) {
            material_.colour[i] = random.word(f.feature, 0, f.feature.most());
            source_.intensity[i] = random.word(f.intensity, 0, f.intensity.most());
        }
        put("cosine", view.cosine);
        put("l", view.direction);
        put("r", mirrored);
        put("kd", material_.diffuse);
        put("ks", material_.specular);
        put("shine", operators_.exponent_word().hold(material_.shine));
        put("c", material_.colour);
        put("i", source_.intensity);
        put("s", local_intensity(point_, material_, &source_, 1, 0, arithmetic_));
        if (rounded_) put("power", along > 0 ? arithmetic_.power(along, material_.shine) : 0);
    }
    void compare() override { expect("s", local_intensity(point_, material_, &source_, 1, 1, arithmetic_)); }
    Operators operators_;
    bool rounded_;
    ShadePoint point_;
    Source source_;
    Material material_;
};

class CombineTrial : public MicroTrial {
  public:
    CombineTrial(const MicroSetting& s) : MicroTrial(s, combine_program(s), {"local_intensity", 3}) {}

  private:
    void draw(MicroRandom& random) override {
        const Formats& f = arithmetic_.formats();
        for (double* value : {&local_, &reflected_, &refracted_})
            *value = random.word(f.intensity, 0, f.intensity.most());
        for (double* value : {&mirror_, &transmit_}) *value = random.word(f.feature, 0, 1);
        put("local", local_);
        put("mirror", mirror_);
        put("transmit", transmit_);
        put("reflected", reflected_);
        put("refracted", refracted_);
    }
    void compare() override {
        expect("sum", take("sum"),
               arithmetic_.mac(arithmetic_.formats().intensity, local_, mirror_, reflected_, transmit_,
                               refracted_));
    }
    double local_ = 0, mirror_ = 0, transmit_ = 0, reflected_ = 0, refracted_ = 0;
};

class TotalTrial : public MicroTrial {
  public:
    TotalTrial(const MicroSetting& s) : MicroTrial(s, total_program(s), {""}) {}

  private:
    void draw(MicroRandom& random) override {
        const Formats& f = arithmetic_.formats();
        material_.specular = random.word(f.feature, 0, 1);
        material_.transmit = random.word(f.feature, 0, 1);
        for (dvec3* colour : {&local_, &reflected_, &refracted_}) {
            for (int i = 0; i < 3; ++i) (*colour)[i] = random.word(f.intensity, 0, f.intensity.most());
        }
        put("mirror", material_.specular);
        put("transmit", material_.transmit);
        put("local ", local_);
        put("reflected ", reflected_);
        put("refracted ", refracted_);
    }
    void compare() override {
        expect("sum ", combine_intensity(local_, material_, reflected_, refracted_, arithmetic_));
    }
    Material material_;
    dvec3 local_{0, 0, 0}, reflected_{0, 0, 0}, refracted_{0, 0, 0};
};

}  // namespace

TrialList shading_trials(const MicroSetting& s) {
    TrialList all;
    all.push_back(std::make_unique<OperatorTrial>(s, false));
    all.push_back(std::make_unique<OperatorTrial>(s, true));
    if (s.numbers.operators.power != PowerMethod::rounded) all.push_back(std::make_unique<PowerTrial>(s));
    all.push_back(std::make_unique<NormaliseTrial>(s));
    all.push_back(std::make_unique<NormalTrial>(s));
    all.push_back(std::make_unique<ReflectTrial>(s));
    all.push_back(std::make_unique<RefractTrial>(s));
    all.push_back(std::make_unique<AmbientTrial>(s));
    all.push_back(std::make_unique<LightTrial>(s));
    all.push_back(std::make_unique<CombineTrial>(s));
    all.push_back(std::make_unique<TotalTrial>(s));
    return all;
}

}  // namespace raycell
