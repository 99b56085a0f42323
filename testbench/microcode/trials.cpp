#include "testbench/microcode/trials.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <stdexcept>

#include "model/settings/costs.hpp"
#include "model/shading/shading.hpp"
#include "model/tracing/intersect.hpp"
#include "model/tracing/ray.hpp"

namespace raycell {

double MicroRandom::word(const Format& format) { return word(format, format.least(), format.most()); }

double MicroRandom::word(const Format& format, double low, double high) {
    low = format.hold(low);
    high = format.hold(high);
    const double corner = uniform(0, 1);
    const auto inside = [&](double value) { return std::clamp(format.hold(value), low, high); };
    if (corner < 0.05) return low;
    if (corner < 0.10) return high;
    if (corner < 0.15) return inside(0);
    if (corner < 0.20) return inside(chance(0.5) ? format.step() : -format.step());
    if (corner < 0.40) return inside(uniform(low, high) * std::exp2(-uniform(0, format.bits())));
    if (corner < 0.50) {  // next to a power of two
        const double power = std::exp2(std::floor(uniform(-format.fraction_bits(), format.integer_bits())));
        return inside((chance(0.5) ? power : -power) + std::floor(uniform(-1, 2)) * format.step());
    }
    return inside(uniform(low, high));
}

MicroTrial::MicroTrial(const MicroSetting& setting, MicroProgram program, std::string cost, int table_cycles)
    : arithmetic_(setting.numbers, setting.extent),
      program_(std::move(program)),
      machine_(program_),
      cost_(std::move(cost)),
      table_cycles_(table_cycles) {}

int MicroTrial::step(MicroRandom& random) {
    draw(random);
    std::ostringstream inputs;
    inputs.precision(17);
    for (const MicroRegister& r : program_.registers) {
        if (r.name.find('.') == std::string::npos) inputs << ' ' << r.name << ' ' << machine_.take(r.name);
    }
    inputs_ = inputs.str();
    const int cycles = machine_.run();
    compare();
    return cycles;
}

void MicroTrial::put(const std::string& before, const dvec3& v, const std::string& after) {
    for (int i = 0; i < 3; ++i) put(before + "xyz"[i] + after, v[i]);
}

void MicroTrial::expect(const std::string& name, double found, double wanted) const {
    if (found == wanted) return;
    std::ostringstream text;
    text.precision(17);
    text << "microprogram " << program_.name << " on datapath " << program_.datapath.name << ": " << name
         << " is " << found << ", expected " << wanted << ", for" << inputs_;
    throw MicroDifference(text.str());
}

void MicroTrial::expect(const std::string& before, const dvec3& wanted) const {
    for (int i = 0; i < 3; ++i) expect(before + "xyz"[i], take(before + "xyz"[i]), wanted[i]);
}

namespace {

dvec3 any_direction(MicroRandom& random, const Arithmetic& arithmetic) {
    dvec3 v(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    for (int axis = 0; axis < 3; ++axis) {
        if (random.chance(0.1)) v[axis] = 0;
        if (random.chance(0.1)) v[axis] *= std::exp2(-random.uniform(0, 20));
    }
    if (v == dvec3(0)) v.z = 1;
    return arithmetic.normalise(v);
}

class WalkTrial : public MicroTrial {
  public:
    WalkTrial(const MicroSetting& s, const CostTable& costs, MicroProgram program)
        : MicroTrial(s, std::move(program), "walk_step", int(costs.walk_step)), depth_(depth_of(s)) {}
    WalkTrial(const MicroSetting& s, const CostTable& costs)
        : WalkTrial(s, costs, walk_program(s, depth_of(s))) {}

  private:
    static double depth_of(const MicroSetting& s) { return s.formats().depth.hold(s.extent.depth); }

    void draw(MicroRandom& random) override {
        const Formats& f = arithmetic_.formats();
        ray_ = Ray();
        set_direction(ray_, any_direction(random, arithmetic_), arithmetic_);
        ray_.position = {random.word(f.unit, 0, 1), random.word(f.unit, 0, 1),
                         random.word(f.depth, 0, depth_)};
        if (random.chance(0.5)) ray_.reach = arithmetic_.hold_reach(random.word(f.reach, 0, f.reach.most()));
        ray_.fresh = false;
        put("", ray_.position);
        put("d", ray_.direction);
        put("reach", std::isinf(ray_.reach) ? f.reach.most() : ray_.reach);
        put_reciprocal("x", ray_.inverse_x);
        put_reciprocal("y", ray_.inverse_y);
    }

    void put_reciprocal(const std::string& axis, double inverse) {
        int exponent = 0;
        put("m" + axis, std::frexp(std::abs(inverse), &exponent));
        put("e" + axis, exponent);
    }

    void compare() override {
        const bool axial = ray_.inverse_x == 0 && ray_.inverse_y == 0;
        expect("flags for axial", take("flags") == 2, axial);
        if (axial) return;
        const Crossing crossing = next_crossing(ray_, arithmetic_);
        Ray next = ray_;
        cross(next, crossing, arithmetic_);
        expect("side", take("side"), double(int(crossing.side)));
        expect("t", take("t"), crossing.t);
        expect("", next.position);
        const Format& reach = arithmetic_.formats().reach;
        expect("reach", take("reach"), std::isinf(next.reach) ? reach.most() : next.reach);
        const bool leaves = ray_.direction.z > 0 ? next.position.z > depth_ : next.position.z < 0;
        expect("flags", take("flags"), leaves ? 1 : 0);
        if (!std::isinf(ray_.reach)) expect("left <= 0", take("left") <= 0, ray_.reach <= crossing.t);
    }

    double depth_;
    Ray ray_;
};

class RunTrial : public MicroTrial {
  public:
    RunTrial(const MicroSetting& s, const CostTable& costs)
        : MicroTrial(s, run_program(s), "compare_interval", int(costs.compare_interval)) {}

  private:
    void draw(MicroRandom& random) override {
        const Format& depth = arithmetic_.formats().depth;
        for (double* end : {&near_, &far_, &low_, &high_}) *end = random.word(depth, -1, depth.most() / 8);
        if (far_ < near_) std::swap(far_, near_);
        if (high_ < low_) std::swap(high_, low_);
        if (random.chance(0.2)) near_ = high_;
        put("near", near_);
        put("far", std::max(far_, near_));
        put("low", low_);
        put("high", high_);
    }
    void compare() override {
        expect("meets", take("meets"), !(near_ > high_ || std::max(far_, near_) < low_));
    }
    double near_ = 0, far_ = 0, low_ = 0, high_ = 0;
};

class PlaneTrial : public MicroTrial {
  public:
    PlaneTrial(const MicroSetting& s, const CostTable& costs)
        : MicroTrial(s, plane_program(s), "compare_edge + reciprocal",
                     int(costs.compare_edge + costs.reciprocal(s.numbers.operators))) {}

  private:
    /// A plane through a point that the ray may or may not reach, in a run around it.
    void draw(MicroRandom& random) override {
        const Formats& f = arithmetic_.formats();
        const double depth = f.depth.most() / 8;
        ray_ = Ray();
        set_direction(ray_, any_direction(random, arithmetic_), arithmetic_);
        ray_.position = {random.word(f.unit, 0, 1), random.word(f.unit, 0, 1),
                         random.word(f.depth, 0, depth)};
        ray_.fresh = random.chance(0.3);
        if (random.chance(0.5)) ray_.leaves = 7;
        end_ = random.word(f.distance, 0, 2);
        const double at = random.uniform(-0.2, 1.2) * std::min(end_, 1.5);
        const dvec3 met = ray_.position + at * ray_.direction;
        voxel_ = Voxel();
        voxel_.polygon = 3;
        voxel_.near = voxel_.base = f.depth.hold(std::clamp(met.z - random.uniform(-0.1, 1), 0.0, depth));
        voxel_.far = f.depth.hold(voxel_.near + random.uniform(0, 2));
        Plane plane;
        plane.n = any_direction(random, exact_arithmetic());
        if (random.chance(0.2)) plane.n -= 0.999 * glm::dot(plane.n, ray_.direction) * ray_.direction;
        const dvec3 anchor = met - dvec3(0, 0, voxel_.base);
        plane.c = glm::dot(plane.n, anchor);
        voxel_.drop = std::uint8_t(dominant_axis(plane.n));
        voxel_.plane = hold_plane(plane, voxel_.drop, anchor, f.unit, f.offset);
        put("n", voxel_.plane.n);
        put("c", voxel_.plane.c);
        put("", ray_.position);
        put("d", ray_.direction);
        put("base", voxel_.base);
        put("near", voxel_.near);
        put("far", voxel_.far);
        put("end", end_);
        put("leaves", ray_.fresh && ray_.leaves != no_polygon ? 1 : 0);
    }
    void compare() override {
        const auto t = hit_voxel({}, voxel_, ray_, end_, HitTest::edge, 0.25, arithmetic_);
        expect("hit", take("hit"), t ? 1 : 0);
        if (!t) return;
        expect("t", take("t"), *t);
    }
    Ray ray_;
    Voxel voxel_;
    double end_ = 0;
};

class EdgeTrial : public MicroTrial {
  public:
    EdgeTrial(const MicroSetting& s, const CostTable& costs)
        : MicroTrial(s, edge_program(s), "per_edge", int(costs.per_edge)) {}

  private:
    void draw(MicroRandom& random) override {
        const Formats& f = arithmetic_.formats();
        const double angle = random.uniform(0, 6.3);
        a_ = arithmetic_.hold(f.unit, std::cos(angle));
        b_ = arithmetic_.hold(f.unit, std::sin(angle));
        c_ = random.word(f.edge_offset, -4, 4);
        u_ = random.word(f.unit, 0, 1);
        v_ = random.chance(0.5) ? random.word(f.unit, 0, 1) : random.word(f.depth, 0, f.depth.most() / 8);
        if (random.chance(0.3)) c_ = f.edge_offset.hold(-a_ * u_ - b_ * v_);
        for (const auto& [name, value] :
             {std::make_pair("a", a_), {"b", b_}, {"c", c_}, {"u", u_}, {"v", v_}})
            put(name, value);
    }
    void compare() override {
        const double at = arithmetic_.mac(arithmetic_.formats().edge_offset, c_, a_, u_, b_, v_);
        expect("inside", take("inside"), at >= -arithmetic_.hair());
    }
    double a_ = 0, b_ = 0, c_ = 0, u_ = 0, v_ = 0;
};

/// 1/x or 1/sqrt(x).
class OperatorTrial : public MicroTrial {
  public:
    OperatorTrial(const MicroSetting& s, const CostTable& costs, bool root)
        : MicroTrial(s, root ? root_program(s) : reciprocal_program(s), root ? "root" : "reciprocal",
                     int(root ? costs.root(s.numbers.operators) : costs.reciprocal(s.numbers.operators))),
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

class NormaliseTrial : public MicroTrial {
  public:
    NormaliseTrial(const MicroSetting& s, const CostTable& costs)
        : MicroTrial(s, normalise_program(s), "root", int(costs.root(s.numbers.operators))) {}

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
    NormalTrial(const MicroSetting& s, const CostTable& costs)
        : MicroTrial(s, normal_program(s), "normal_linear + root",
                     int(costs.normal_linear + costs.root(s.numbers.operators))) {}

  private:
    void draw(MicroRandom& random) override {
        const Formats& f = arithmetic_.formats();
        do {
            for (dvec3* v : {&base_, &du_, &dv_}) {
                for (int i = 0; i < 3; ++i) (*v)[i] = random.word(f.normal);
            }
            u_ = random.word(f.unit, 0, 1);
            v_ = random.chance(0.5) ? random.word(f.unit, 0, 1) : random.word(f.depth, 0, f.depth.most() / 8);
        } while (field() == dvec3(0));
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
    void compare() override { expect("n", arithmetic_.normalise(field())); }
    dvec3 base_{0, 0, 0}, du_{0, 0, 0}, dv_{0, 0, 0};
    double u_ = 0, v_ = 0;
};

class ReflectTrial : public MicroTrial {
  public:
    ReflectTrial(const MicroSetting& s, const CostTable& costs)
        : MicroTrial(s, reflect_program(s), "reflect + root",
                     int(costs.reflect + costs.root(s.numbers.operators))) {}

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
    RefractTrial(const MicroSetting& s, const CostTable& costs)
        : MicroTrial(s, refract_program(s), "refract + reciprocal + 2 root",
                     int(costs.refract + costs.reciprocal(s.numbers.operators) +
                         2 * costs.root(s.numbers.operators))) {}

  private:
    void draw(MicroRandom& random) override {
        point_.direction = any_direction(random, arithmetic_);
        point_.normal = random.chance(0.1) ? -point_.direction : any_direction(random, arithmetic_);
        if (glm::dot(point_.direction, point_.normal) > 0) point_.normal = -point_.normal;
        point_.entering = random.chance(0.5);
        ior_ = std::max(random.word(arithmetic_.formats().ior, 0, 3), arithmetic_.formats().ior.step());
        put("d", point_.direction);
        put("n", point_.normal);
        put("ior", ior_);
        put("entering", point_.entering ? 1 : 0);
    }
    void compare() override {
        dvec3 wanted;
        const bool passes = refract_direction(point_, ior_, wanted, arithmetic_);
        expect("total", take("total"), passes ? 0 : 1);
        if (passes) expect("r", wanted);
    }
    ShadePoint point_;
    double ior_ = 1;
};

class PointTrial : public MicroTrial {
  public:
    PointTrial(const MicroSetting& s, const CostTable& costs)
        : MicroTrial(s, point_program(s), "a part of shade_setup", int(costs.shade_setup)) {}

  private:
    void draw(MicroRandom& random) override {
        const Formats& f = arithmetic_.formats();
        ray_.direction = any_direction(random, arithmetic_);
        ray_.position = {random.word(f.unit, 0, 1), random.word(f.unit, 0, 1), random.word(f.depth)};
        t_ = random.word(f.distance, 0, f.distance.most());
        put("", ray_.position);
        put("d", ray_.direction);
        put("t", t_);
    }
    void compare() override { expect("p", point_at(ray_, t_, arithmetic_)); }
    Ray ray_;
    double t_ = 0;
};

class LightTrial : public MicroTrial {
  public:
    LightTrial(const MicroSetting& s, const CostTable& costs)
        : MicroTrial(s, light_program(s), "per_lit_source", int(costs.per_lit_source)) {}

  private:
    void draw(MicroRandom& random) override {
        const Formats& f = arithmetic_.formats();
        cosine_ = random.word(f.unit, 0, 1);
        kd_ = random.word(f.feature, 0, 1);
        highlight_ = random.word(f.intensity, 0, f.intensity.most());
        for (int i = 0; i < 3; ++i) {
            colour_[i] = random.word(f.feature, 0, f.feature.most());
            intensity_[i] = random.word(f.intensity, 0, f.intensity.most());
            sum_[i] = random.word(f.intensity, 0, f.intensity.most());
        }
        put("cosine", cosine_);
        put("kd", kd_);
        put("highlight", highlight_);
        put("c", colour_);
        put("i", intensity_);
        put("s", sum_);
    }
    void compare() override {  // the last lines of local_intensity()
        const Format& word = arithmetic_.formats().intensity;
        const double diffuse = arithmetic_.product(arithmetic_.formats().unit, kd_, cosine_);
        dvec3 wanted = sum_;
        for (int i = 0; i < 3; ++i) {
            const double share = arithmetic_.mac(word, highlight_, diffuse, colour_[i]);
            wanted[i] = arithmetic_.mac(word, sum_[i], intensity_[i], share);
        }
        expect("s", wanted);
    }
    double cosine_ = 0, kd_ = 0, highlight_ = 0;
    dvec3 colour_{0, 0, 0}, intensity_{0, 0, 0}, sum_{0, 0, 0};
};

class CombineTrial : public MicroTrial {
  public:
    CombineTrial(const MicroSetting& s, const CostTable& costs)
        : MicroTrial(s, combine_program(s), "local_intensity", int(costs.local_intensity)) {}

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

}  // namespace

std::vector<std::unique_ptr<MicroTrial>> micro_trials(const MicroSetting& s) {
    const CostTable costs;
    std::vector<std::unique_ptr<MicroTrial>> all;
    all.push_back(std::make_unique<WalkTrial>(s, costs));
    all.push_back(std::make_unique<RunTrial>(s, costs));
    all.push_back(std::make_unique<PlaneTrial>(s, costs));
    all.push_back(std::make_unique<EdgeTrial>(s, costs));
    all.push_back(std::make_unique<OperatorTrial>(s, costs, false));
    all.push_back(std::make_unique<OperatorTrial>(s, costs, true));
    all.push_back(std::make_unique<NormaliseTrial>(s, costs));
    all.push_back(std::make_unique<NormalTrial>(s, costs));
    all.push_back(std::make_unique<ReflectTrial>(s, costs));
    all.push_back(std::make_unique<RefractTrial>(s, costs));
    all.push_back(std::make_unique<PointTrial>(s, costs));
    all.push_back(std::make_unique<LightTrial>(s, costs));
    all.push_back(std::make_unique<CombineTrial>(s, costs));
    return all;
}

bool walk_differs(const MicroSetting& setting, const MicroProgram& other, std::uint64_t runs) {
    WalkTrial trial(setting, CostTable(), other);
    try {
        run_trial(trial, runs, 1);
    } catch (const std::runtime_error&) {
        return true;
    } catch (const std::logic_error&) {
        return true;
    }
    return false;
}

MicroTally run_trial(MicroTrial& trial, std::uint64_t runs, std::uint64_t seed) {
    MicroRandom random(seed);
    MicroTally tally;
    tally.least = std::numeric_limits<int>::max();
    std::uint64_t sum = 0;
    for (; tally.runs < runs; ++tally.runs) {
        const int cycles = trial.step(random);
        tally.least = std::min(tally.least, cycles);
        tally.most = std::max(tally.most, cycles);
        sum += std::uint64_t(cycles);
    }
    tally.mean = double(sum) / double(std::max<std::uint64_t>(runs, 1));
    return tally;
}

}  // namespace raycell
