// What the studies share: arithmetics, scenes made by hand, rays sent through a loaded array.
#pragma once

#include <functional>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "model/machine/untimed.hpp"

namespace raycell::stability {

constexpr double pi = 3.14159265358979323846;

class Random {
  public:
    explicit Random(std::uint64_t seed) : engine_(seed) {}
    double uniform(double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(engine_);
    }
    bool chance(double share) { return uniform(0, 1) < share; }
    dvec3 direction();

  private:
    std::mt19937_64 engine_;
};

NumberSettings exact_numbers();
NumberSettings fixed_numbers(int word_bits);
/// Exact arithmetic, and words of these lengths.
std::vector<NumberSettings> exact_and(const std::vector<int>& word_bits);
/// "exact" or "fixed 20".
std::string name_of(const NumberSettings& numbers);
std::string name_of(HitTest rung);
constexpr HitTest all_rungs[] = {HitTest::depth, HitTest::interval, HitTest::plane, HitTest::mask,
                                 HitTest::edge};

/// The largest and the mean of errors.
class Errors {
  public:
    void add(double error) {
        largest_ = std::max(largest_, error);
        sum_ += error;
        ++count_;
    }
    double largest() const { return largest_; }
    double mean() const { return count_ == 0 ? 0 : sum_ / double(count_); }
    std::int64_t count() const { return count_; }

  private:
    double largest_ = 0;
    double sum_ = 0;
    std::int64_t count_ = 0;
};

/// Counts how often something happened.
class Share {
  public:
    void add(bool happened) { ++all_, some_ += happened; }
    void add(const Share& other) { all_ += other.all_, some_ += other.some_; }
    std::int64_t some() const { return some_; }
    std::int64_t all() const { return all_; }
    double percent() const { return all_ == 0 ? 0 : 100.0 * double(some_) / double(all_); }

  private:
    std::int64_t some_ = 0;
    std::int64_t all_ = 0;
};

/// Angle between two directions, radians; accurate for small ones, too.
double angle_between(const dvec3& a, const dvec3& b);

/// An empty cube seen from infinity, one matt white object.
CellScene empty_scene(int width, int height, double depth, int levels);
std::uint32_t add_object(CellScene& scene, const Material& material);
void add_polygon(CellScene& scene, std::uint32_t object, std::vector<dvec3> vertices);
/// Adds the part of a plane through a point that lies in the cube.
void add_cross_section(CellScene& scene, std::uint32_t object, const dvec3& point, const dvec3& normal);
/// Adds a sphere of triangles whose vertex normals point outwards.
void add_ball(CellScene& scene, std::uint32_t object, const dvec3& centre, double radius, int slices,
              int stacks);

/// Settings for a scene made by hand: nothing lies outside of its cube.
PictureSettings settings_for(const CellScene& scene, const NumberSettings& numbers,
                             HitTest rung = HitTest::edge);

/// A scene and the machine that it is loaded into.
struct Loaded {
    Loaded(CellScene placed, const PictureSettings& settings)
        : scene(std::move(placed)), machine(scene, settings, nullptr) {}
    Loaded(const Loaded&) = delete;
    Loaded& operator=(const Loaded&) = delete;
    const Context& context() const { return machine.context(); }
    const Arithmetic& arithmetic() const { return machine.context().arithmetic; }
    const CellStore& cell(int x, int y) const {
        return machine.cells()[std::size_t(y) * std::size_t(scene.frame.width) + std::size_t(x)];
    }
    const CellScene scene;
    UntimedMachine machine;
};

/// A ray and the cell that it is in.
struct Placed {
    Ray ray;
    int x = 0;
    int y = 0;
};
/// A ray from a point inside the cube, as a cell holds it; it leaves no polygon.
Placed start_ray(const Loaded& loaded, const dvec3& origin, const dvec3& direction);

/// What a ray met.
struct Landing {
    Ray ray;  ///< as it stood in the cell
    CellHit hit;
    std::uint32_t polygon = no_polygon;
    int x = 0;
    int y = 0;
    double t = 0;  ///< distance from the start of the walk, cell widths
    dvec3 point{0, 0, 0};
};
/// Sends a ray from cell to cell as the untimed machine does. Returns nothing if it leaves the cube or
/// reaches its source. Throws std::logic_error for a ray that makes more than 2 * (width + height) + 4 hops.
std::optional<Landing> walk(const Loaded& loaded, Placed placed);

}  // namespace raycell::stability
