// Trials of what a cell makes of a hit: its setup, sources, the start of new rays; and of an answer's way.
#include <algorithm>
#include <cmath>

#include "model/tracing/tracing.hpp"
#include "testbench/microcode/trial_lists.hpp"

namespace raycell {
namespace {

/// A machine without anything in it, and a voxel in one of its cells.
struct Stage {
    explicit Stage(const MicroSetting& s)
        : scene(empty_scene(s)), picture(settings_of(s)), context(scene, picture) {
        context.objects.resize(1);
        store.voxels.resize(1);
    }
    static CellScene empty_scene(const MicroSetting& s) {
        CellScene scene;
        scene.frame.width = s.extent.width;
        scene.frame.height = s.extent.height;
        scene.frame.depth = s.extent.depth;
        scene.frame.depth_levels = std::max(1, int(std::lround(s.extent.depth / s.extent.level)));
        return scene;
    }
    static PictureSettings settings_of(const MicroSetting& s) {
        PictureSettings picture;
        picture.width = s.extent.width;
        picture.height = s.extent.height;
        picture.numbers = s.numbers;
        return picture;
    }
    /// A plane as a voxel has it.
    void draw_plane(MicroRandom& random) {
        const Formats& f = context.arithmetic.formats();
        Voxel& voxel = store.voxels[0];
        Plane plane;
        plane.n = any_direction(random, exact_arithmetic());
        voxel.drop = std::uint8_t(dominant_axis(plane.n));
        voxel.plane = hold_plane(plane, voxel.drop, dvec3(0), f.unit, f.offset);
    }
    dvec3 draw_point(MicroRandom& random) const {
        const Formats& f = context.arithmetic.formats();
        return {random.word(f.unit, 0, 1), random.word(f.unit, 0, 1), random.word(f.depth, 0, context.depth)};
    }

    CellScene scene;
    PictureSettings picture;
    Context context;
    CellStore store;
};

class SetupTrial : public MicroTrial {
  public:
    explicit SetupTrial(const MicroSetting& s)
        : MicroTrial(s, setup_program(s, {}), {"shade_setup", 1, 0, 1}), stage_(s) {}

  private:
    void draw(MicroRandom& random) override {
        const Formats& f = arithmetic_.formats();
        stage_.draw_plane(random);
        Voxel& voxel = stage_.store.voxels[0];
        ray_ = Ray();
        ray_.direction = any_direction(random, arithmetic_);
        ray_.position = stage_.draw_point(random);
        ray_.weight = random.word(f.unit, 0, 1);
        ray_.generation = std::uint8_t(random.uniform(0, 6));
        t_ = random.word(f.distance, 0, 2);
        const bool vanishes = random.chance(0.1);
        for (int i = 0; i < 3; ++i) {
            const double most = vanishes ? 16 * f.normal.step() : f.normal.most();
            voxel.normal.base[i] = random.word(f.normal, -most, most);
            voxel.normal.du[i] = vanishes ? 0 : random.word(f.normal);
            voxel.normal.dv[i] = vanishes ? 0 : random.word(f.normal);
        }
        Material& material = stage_.context.objects[0];
        material.specular = random.chance(0.3) ? 0 : random.word(f.feature, 0, 1);
        material.transmit = random.chance(0.3) ? 0 : random.word(f.feature, 0, 1);
        put("", ray_.position);
        put("d", ray_.direction);
        put("t", t_);
        put("f", field(voxel));
        put("g", voxel.plane.n);
        put("weight", ray_.weight);
        put("generation", ray_.generation);
        put("mirror", material.specular);
        put("transmit", material.transmit);
    }
    dvec3 field(const Voxel& voxel) const {
        const dvec3 p = point_at(ray_, t_, arithmetic_);
        const dvec2 uv = project({p.x, p.y, p.z - voxel.base}, voxel.drop);
        dvec3 normal;
        for (int i = 0; i < 3; ++i)
            normal[i] = arithmetic_.mac(arithmetic_.formats().field, voxel.normal.base[i], uv.x,
                                        voxel.normal.du[i], uv.y, voxel.normal.dv[i]);
        return normal;
    }
    void compare() override {
        const HitSetup setup = set_up_hit(stage_.context, stage_.store, ray_, {t_, 0}, 3, 5);
        expect("p", setup.local);
        expect("n", setup.point.normal);
        expect("entering", take("entering"), setup.point.entering ? 1 : 0);
        expect("reflects", take("reflects"), setup.reflects ? 1 : 0);
        expect("refracts", take("refracts"), setup.refracts ? 1 : 0);
    }
    Stage stage_;
    Ray ray_;
    double t_ = 0;
};

class PlaceTrial : public MicroTrial {
  public:
    explicit PlaceTrial(const MicroSetting& s) : MicroTrial(s, place_program(s), {""}), stage_(s) {}

  private:
    void draw(MicroRandom& random) override {
        const Formats& f = arithmetic_.formats();
        ray_.position = stage_.draw_point(random);
        ray_.direction = any_direction(random, arithmetic_);
        t_ = random.word(f.distance, 0, 2);
        base_ = random.word(f.depth, 0, stage_.context.depth);
        drop_ = random.chance(0.33) ? 0 : random.chance(0.5) ? 1 : 2;
        put("", ray_.position);
        put("d", ray_.direction);
        put("t", t_);
        put("base", base_);
        put("drop x", drop_ == 0 ? 1 : 0);
        put("drop z", drop_ == 2 ? 1 : 0);
    }
    void compare() override {
        const dvec3 p = point_at(ray_, t_, arithmetic_);
        const dvec2 uv = project({p.x, p.y, p.z - base_}, std::uint8_t(drop_));
        expect("u", take("u"), uv.x);
        expect("v", take("v"), uv.y);
    }
    Stage stage_;
    Ray ray_;
    double t_ = 0, base_ = 0;
    int drop_ = 0;
};

class SourceTrial : public MicroTrial {
  public:
    explicit SourceTrial(const MicroSetting& s)
        : MicroTrial(s, source_program(s), {"source_view", 1, 0, 1}), stage_(s) {}

  private:
    void draw(MicroRandom& random) override {
        const Formats& f = arithmetic_.formats();
        const dvec3 local = stage_.draw_point(random);
        const dvec2 cell{std::floor(random.uniform(0, stage_.picture.width)),
                         std::floor(random.uniform(0, stage_.picture.height))};
        point_.position = local + dvec3(cell, 0);
        point_.normal = any_direction(random, arithmetic_);
        // In the array, around it, or far away.
        const double size = std::exp2(random.uniform(0, random.chance(0.2) ? 30 : 12));
        dvec3 place = size * dvec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
        if (random.chance(0.2)) place = point_.position + place / 1000.0;
        if (random.chance(0.05)) place = point_.position;
        if (random.chance(0.1)) place[int(random.uniform(0, 3))] = point_.position[int(random.uniform(0, 3))];
        source_.position = arithmetic_.hold_place(place);
        const int exponent = f.place_exponent(source_.position);
        for (int i = 0; i < 3; ++i)
            put(std::string("s") + "xyz"[i], scale_by(source_.position[i], -exponent));
        put("exponent", exponent);
        put("p", local);
        put("cell x", cell.x);
        put("cell y", cell.y);
        put("n", point_.normal);
    }
    void compare() override {
        const SourceView view = view_source(point_, source_, arithmetic_);
        expect("l", view.direction);
        expect("cosine", take("cosine"), view.cosine);
        const double reach = arithmetic_.hold_reach(view.distance);
        expect("reach", take("reach"), std::isinf(reach) ? arithmetic_.formats().reach.most() : reach);
    }
    Stage stage_;
    ShadePoint point_;
    Source source_;
};

class StartTrial : public MicroTrial {
  public:
    explicit StartTrial(const MicroSetting& s)
        : MicroTrial(s, start_program(s, Arithmetic(s.numbers, s.extent).default_normal_offset()),
                     {"ray_start", 1, 2}),
          stage_(s) {}

  private:
    void draw(MicroRandom& random) override {
        const Formats& f = arithmetic_.formats();
        stage_.draw_plane(random);
        setup_ = HitSetup();
        setup_.local = stage_.draw_point(random);
        setup_.reflected = any_direction(random, arithmetic_);
        parent_.weight = random.word(f.unit, 0, 1);
        Material& material = stage_.context.objects[0];
        material.specular = random.word(f.feature, 0, 1);
        put("d", setup_.reflected);
        put("p", setup_.local);
        put("n", stage_.store.voxels[0].plane.n);
        put("weight", parent_.weight);
        put("share", material.specular);
    }
    void compare() override {
        const Ray ray = reflected_ray(stage_.context, stage_.store, parent_, {0, 0}, setup_, 3, 5);
        expect("", ray.position);
        expect("front", take("front"), ray.leaves_front ? 1 : 0);
        expect("weight", take("weight"), ray.weight);
        for (const bool y : {false, true}) {
            int exponent = 0;
            const double mantissa = std::frexp(std::abs(y ? ray.inverse_y : ray.inverse_x), &exponent);
            expect(y ? "my" : "mx", take(y ? "my" : "mx"), mantissa);
            expect(y ? "ey" : "ex", take(y ? "ey" : "ex"), exponent);
        }
    }
    Stage stage_;
    Ray parent_;
    HitSetup setup_;
};

class RouteTrial : public MicroTrial {
  public:
    explicit RouteTrial(const MicroSetting& s)
        : MicroTrial(s, route_program(s), {"route_return"}), extent_(s.extent) {}

  private:
    void draw(MicroRandom& random) override {
        x_ = int(random.uniform(0, extent_.width));
        y_ = int(random.uniform(0, extent_.height));
        home_x_ = random.chance(0.3) ? x_ : int(random.uniform(0, extent_.width));
        home_y_ = random.chance(0.3) ? y_ : int(random.uniform(0, extent_.height));
        put("x", x_);
        put("y", y_);
        put("home x", home_x_);
        put("home y", home_y_);
    }
    /// Each hop of the way that Router::way_home() takes: first all of x, then y.
    void compare() override {
        const double way = take("way");
        if (way == side_count) {
            expect("x at home", x_, home_x_);
            expect("y at home", y_, home_y_);
            return;
        }
        const Side side = Side(int(way));
        const int before = std::abs(home_x_ - x_) + std::abs(home_y_ - y_);
        const int x = x_ + step_x(side), y = y_ + step_y(side);
        expect("hops after one", std::abs(home_x_ - x) + std::abs(home_y_ - y), before - 1);
        if (step_y(side) != 0) expect("x where the way turns", x_, home_x_);
    }
    ArrayExtent extent_;
    int x_ = 0, y_ = 0, home_x_ = 0, home_y_ = 0;
};

}  // namespace

TrialList ray_trials(const MicroSetting& s) {
    TrialList all;
    all.push_back(std::make_unique<SetupTrial>(s));
    all.push_back(std::make_unique<PlaceTrial>(s));
    all.push_back(std::make_unique<SourceTrial>(s));
    all.push_back(std::make_unique<StartTrial>(s));
    all.push_back(std::make_unique<RouteTrial>(s));
    return all;
}

}  // namespace raycell
