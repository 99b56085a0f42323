// Trials of the walk and of the rungs' tests.
#include <algorithm>
#include <cmath>

#include "model/tracing/intersect.hpp"
#include "model/tracing/ray.hpp"
#include "model/tracing/tracing.hpp"
#include "testbench/microcode/trial_lists.hpp"

namespace raycell {
namespace {

double depth_of(const MicroSetting& s) { return s.formats().depth.hold(s.extent.depth); }

/// A ray that starts anywhere in a cell, at a depth from 0 to `depth`.
Ray any_ray(MicroRandom& random, double depth, const Arithmetic& arithmetic) {
    const Formats& f = arithmetic.formats();
    Ray ray;
    set_direction(ray, any_direction(random, arithmetic), arithmetic);
    ray.position = {random.word(f.unit, 0, 1), random.word(f.unit, 0, 1), random.word(f.depth, 0, depth)};
    return ray;
}

class WalkTrial : public MicroTrial {
  public:
    WalkTrial(const MicroSetting& s, MicroProgram program)
        : MicroTrial(s, std::move(program), {"walk_step"}), depth_(depth_of(s)) {}
    WalkTrial(const MicroSetting& s) : WalkTrial(s, walk_program(s, depth_of(s))) {}

  private:
    void draw(MicroRandom& random) override {
        const Formats& f = arithmetic_.formats();
        ray_ = any_ray(random, depth_, arithmetic_);
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

/// A ray that leaves the cube through its front or back, before or when it comes to the cell's side.
class LeaveTrial : public MicroTrial {
  public:
    explicit LeaveTrial(const MicroSetting& s)
        : MicroTrial(s, leave_program(s, depth_of(s)), {"leave_cube", 1, 1}), depth_(depth_of(s)) {}

  private:
    void draw(MicroRandom& random) override {
        const Formats& f = arithmetic_.formats();
        do {
            ray_ = any_ray(random, 0, arithmetic_);
            crossing_ = next_crossing(ray_, arithmetic_).t;
            const double way = ray_.direction.z * std::min(crossing_, depth_);
            const double bound = ray_.direction.z > 0 ? depth_ : 0;
            ray_.position.z = random.chance(0.05) ? bound + random.uniform(-1, 1) * way
                                                  : bound - random.uniform(0, 1) * way;
            ray_.position.z = f.depth.hold(ray_.position.z);
        } while (!leaves());
        if (random.chance(0.5)) ray_.reach = arithmetic_.hold_reach(random.word(f.reach, 0, f.reach.most()));
        put("", ray_.position);
        put("d", ray_.direction);
        put("reach", std::isinf(ray_.reach) ? f.reach.most() : ray_.reach);
        put("axial", std::isinf(crossing_));
        if (!std::isinf(crossing_)) put("t", crossing_);
    }
    bool leaves() const {
        if (ray_.direction.z == 0) return false;
        const double end = depth_at(ray_, crossing_, arithmetic_);
        return ray_.direction.z > 0 ? end > depth_ : end < 0;
    }
    void compare() override {
        const double bound = ray_.direction.z > 0 ? depth_ : 0;
        const double t = std::min(way_out(ray_, bound, arithmetic_), crossing_);
        expect("t", take("t"), t);
        Ray out = ray_;
        start_outside(out, t, arithmetic_);
        expect("", out.position);
        const Format& reach = arithmetic_.formats().reach;
        expect("reach", take("reach"), std::isinf(out.reach) ? reach.most() : out.reach);
        if (!std::isinf(ray_.reach)) expect("left <= 0", take("left") <= 0, ray_.reach <= t);
    }
    double depth_, crossing_ = 0;
    Ray ray_;
};

/// A voxel's run against a ray's, going to the back or to the front.
class RunTrial : public MicroTrial {
  public:
    RunTrial(const MicroSetting& s, bool outwards)
        : MicroTrial(s, run_program(s, outwards), {outwards ? "" : "compare_interval"}),
          outwards_(outwards) {}

  private:
    void draw(MicroRandom& random) override {
        const Format& depth = arithmetic_.formats().depth;
        for (double* end : {&near_, &far_, &low_, &high_}) *end = random.word(depth, -1, depth.most() / 8);
        if (far_ < near_) std::swap(far_, near_);
        if (high_ < low_) std::swap(high_, low_);
        if (random.chance(0.2)) near_ = high_;
        far_ = std::max(far_, near_);
        most_ = random.chance(0.5) ? far_ : std::max(far_, random.word(depth, -1, depth.most() / 8));
        put("near", near_);
        put("far", far_);
        put("low", low_);
        put("high", high_);
        if (outwards_) put("most", most_);
    }
    void compare() override {
        const bool over = outwards_ ? most_ < low_ : near_ > high_;
        expect("meets", take("meets"), over ? 2 : !(near_ > high_ || far_ < low_));
    }
    bool outwards_;
    double near_ = 0, far_ = 0, low_ = 0, high_ = 0, most_ = 0;
};

/// A line that a new voxel passes in the index table, or behind which it stands.
class OrderTrial : public MicroTrial {
  public:
    explicit OrderTrial(const MicroSetting& s) : MicroTrial(s, order_program(s), {"load_order"}) {}

  private:
    void draw(MicroRandom& random) override {
        const Format& depth = arithmetic_.formats().depth;
        for (IndexEntry* line : {&line_, &voxel_}) {
            line->near = random.word(depth, 0, depth.most() / 8);
            line->far = std::max(line->near, random.word(depth, 0, depth.most() / 8));
        }
        // It stops once, and passes the others.
        if (random.chance(0.8) && voxel_.near > line_.near) {
            std::swap(voxel_.near, line_.near);
            line_.far = std::max(line_.near, line_.far);
        }
        if (random.chance(0.05)) voxel_.near = line_.near;
        if (random.chance(0.2)) voxel_.far = std::max(line_.far, voxel_.near);
        put("near", voxel_.near);
        put("far", voxel_.far);
        put("line near", line_.near);
        put("most", line_.far);
    }
    void compare() override {
        std::vector<IndexEntry> table;
        put_in_order(table, 0, line_.near, line_.far);
        put_in_order(table, 1, voxel_.near, voxel_.far);
        const bool before = table[0].voxel == 1;
        expect("before", take("before"), before);
        if (before) expect("most", take("most"), table[1].most);
    }
    IndexEntry line_, voxel_;
};

/// Where a ray enters a run, at rungs `depth` and `interval`.
class EnterTrial : public MicroTrial {
  public:
    EnterTrial(const MicroSetting& s, HitTest rung)
        : MicroTrial(s, enter_program(s, rung), {rung == HitTest::depth ? "" : "enter_run", 1, 1}),
          rung_(rung) {}

  private:
    /// Mostly a run that the ray's meets: the others are told apart before.
    void draw(MicroRandom& random) override {
        const Formats& f = arithmetic_.formats();
        const double depth = f.depth.most() / 8;
        ray_ = any_ray(random, depth, arithmetic_);
        end_ = random.chance(0.1) ? random.word(f.distance, 0, 2) : f.distance.hold(random.uniform(0.1, 1.5));
        const double z0 = ray_.position.z;
        const double z1 = depth_at(ray_, end_, arithmetic_);
        // Mostly behind the ray's beginning: a reciprocal is charged for each.
        const double met = random.chance(0.03)   ? z0
                           : random.chance(0.05) ? z1
                                                 : random.uniform(0, 1) * (z1 - z0) + z0;
        const double room =
            random.chance(0.05) ? random.uniform(0, 1) : std::abs(met - z0) * random.uniform(0, 1);
        voxel_ = Voxel();
        voxel_.near = random.chance(0.05) ? random.word(f.depth, 0, depth)
                                          : f.depth.hold(std::clamp(met - room, 0.0, depth));
        voxel_.far = std::max(f.depth.hold(std::max(met + room, voxel_.near)), voxel_.near + f.depth.step());
        put("z", ray_.position.z);
        put("z1", z1);
        put("dz", ray_.direction.z);
        put("near", voxel_.near);
        put("far", voxel_.far);
        put("end", end_);
    }
    void compare() override {
        const auto t = hit_voxel({}, voxel_, ray_, end_, rung_, arithmetic_);
        expect("hit", take("hit"), t ? 1 : 0);
        if (t) expect("t", take("t"), *t);
    }
    HitTest rung_;
    Ray ray_;
    Voxel voxel_;
    double end_ = 0;
};

class PlaneTrial : public MicroTrial {
  public:
    PlaneTrial(const MicroSetting& s, HitTest rung)
        : MicroTrial(s, plane_program(s, rung), {entry(rung), 1, 1}), rung_(rung) {}

  private:
    static const char* entry(HitTest rung) {
        return rung == HitTest::plane  ? "compare_plane"
               : rung == HitTest::mask ? "compare_mask"
                                       : "compare_edge";
    }

    /// A plane through a point that the ray may or may not reach, in a run around it.
    void draw(MicroRandom& random) override {
        const Formats& f = arithmetic_.formats();
        const double depth = f.depth.most() / 8;
        ray_ = any_ray(random, depth, arithmetic_);
        ray_.fresh = random.chance(0.3);
        if (random.chance(0.5)) ray_.leaves = 7;
        end_ = random.word(f.distance, 0, 2);
        const double at = random.uniform(-0.2, 1.2) * std::min(end_, 1.5);
        const dvec3 met = ray_.position + at * ray_.direction;
        voxel_ = Voxel();
        voxel_.polygon = 3;
        voxel_.near = voxel_.base = f.depth.hold(std::clamp(met.z - random.uniform(-0.1, 1), 0.0, depth));
        voxel_.far = std::max(f.depth.hold(voxel_.near + random.uniform(0, 2)), voxel_.near + f.depth.step());
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
        if (rung_ == HitTest::edge) return;
        ray_.leaves_front = random.chance(0.5);
        put("front", ray_.leaves_front ? 1 : 0);
        if (rung_ == HitTest::mask) draw_mask(random);
    }
    void draw_mask(MicroRandom& random) {
        for (int bit = 0; bit < 64; ++bit) voxel_.mask = voxel_.mask << 1 | (random.chance(0.7) ? 1 : 0);
        for (std::size_t axis = 0; axis < 2; ++axis) {
            const double from = random.chance(0.3) ? 0 : random.uniform(0, 32);
            const double to = random.chance(0.3) ? 32 : random.uniform(0, 32);
            voxel_.window[2 * axis] = std::uint8_t(std::min({from, to, 31.0}));
            voxel_.window[2 * axis + 1] =
                std::uint8_t(std::max({from, to, double(voxel_.window[2 * axis] + 1)}));
        }
        put_bits("mask", std::int64_t(voxel_.mask));
        put("u from", voxel_.window[0]);
        put("u to", voxel_.window[1]);
        put("v from", voxel_.window[2]);
        put("v to", voxel_.window[3]);
        put("drop x", voxel_.drop == 0 ? 1 : 0);
        put("drop z", voxel_.drop == 2 ? 1 : 0);
    }
    void compare() override {
        const auto t = hit_voxel({}, voxel_, ray_, end_, rung_, arithmetic_);
        expect("hit", take("hit"), t ? 1 : 0);
        if (!t) return;
        expect("t", take("t"), *t);
    }
    HitTest rung_;
    Ray ray_;
    Voxel voxel_;
    double end_ = 0;
};

class EdgeTrial : public MicroTrial {
  public:
    EdgeTrial(const MicroSetting& s) : MicroTrial(s, edge_program(s), {"per_edge"}) {}

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

}  // namespace

TrialList traversal_trials(const MicroSetting& s) {
    TrialList all;
    all.push_back(std::make_unique<WalkTrial>(s));
    all.push_back(std::make_unique<LeaveTrial>(s));
    all.push_back(std::make_unique<RunTrial>(s, false));
    all.push_back(std::make_unique<RunTrial>(s, true));
    all.push_back(std::make_unique<OrderTrial>(s));
    all.push_back(std::make_unique<EnterTrial>(s, HitTest::depth));
    all.push_back(std::make_unique<EnterTrial>(s, HitTest::interval));
    all.push_back(std::make_unique<PlaneTrial>(s, HitTest::plane));
    all.push_back(std::make_unique<PlaneTrial>(s, HitTest::mask));
    all.push_back(std::make_unique<PlaneTrial>(s, HitTest::edge));
    all.push_back(std::make_unique<EdgeTrial>(s));
    return all;
}

bool walk_differs(const MicroSetting& setting, const MicroProgram& other, std::uint64_t runs) {
    WalkTrial trial(setting, other);
    try {
        run_trial(trial, runs, 1);
    } catch (const std::runtime_error&) {
        return true;
    } catch (const std::logic_error&) {
        return true;
    }
    return false;
}

}  // namespace raycell
