#include "model/truth/surface_index.hpp"

#include <embree3/rtcore.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <new>
#include <stdexcept>
#include <string>
#include <utility>

namespace raycell {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double coordinate_limit = 1e15;  ///< Embree ignores boxes beyond 1.8e18

/// At most this many surfaces, of those that reach farthest, may stand apart from Embree's tree.
constexpr std::size_t most_apart = 16;

/// A query, stored behind Embree's own context; Embree hands the context's address back to the callbacks.
struct Query {
    RTCIntersectContext context;  // first, so that a pointer to it is a pointer to the query
    const ProbeRay& ray;
    std::uint32_t exclude;
    double t_max;      ///< hits beyond it don't count: the caller's limit, or the nearest hit plus a tie
    double start = 0;  ///< Embree's ray begins at ray.at(start)
    struct Hit {
        double t;
        std::size_t index;
    };
    std::vector<Hit> hits;  ///< all within a tie of the nearest, and perhaps some that no longer are
    double nearest = infinity;

    Query(const ProbeRay& probe, std::uint32_t leaves, double limit)
        : ray(probe), exclude(leaves), t_max(limit) {
        rtcInitIntersectContext(&context);
    }
    static Query& of(RTCIntersectContext* context) { return *reinterpret_cast<Query*>(context); }

    /// Records the surface if the ray meets it, and no other by more than a tie before it; true if recorded.
    bool offer(const Surfaces& surfaces, std::size_t candidate) {
        const std::optional<double> t = surfaces.meet(candidate, ray, exclude, nearest_hit, t_max);
        if (!t) return false;
        if (*t < nearest - exact_tie) hits.clear();
        hits.push_back({*t, candidate});
        nearest = std::min(nearest, *t);
        t_max = std::min(t_max, nearest + exact_tie);
        return true;
    }

    /// Of the hits within a tie of the nearest, the one with the lowest id.
    std::optional<SurfaceIndex::Nearest> chosen(const Surfaces& surfaces) const {
        std::optional<SurfaceIndex::Nearest> best;
        for (const Hit& hit : hits) {
            if (hit.t > nearest + exact_tie) continue;
            if (!best || surfaces.id(hit.index) < surfaces.id(best->index)) best = {hit.t, hit.index};
        }
        return best;
    }
};

float float_above(double value) {
    const float nearest = static_cast<float>(value);
    return std::nextafter(nearest, std::numeric_limits<float>::infinity());
}

Box polygon_bounds(const Polygon& polygon) {
    Box box{dvec3(infinity), dvec3(-infinity)};
    for (const dvec3& vertex : polygon.vertices) {
        box.low = glm::min(box.low, vertex);
        box.high = glm::max(box.high, vertex);
    }
    const double room = outline_room(polygon);
    return {box.low - room, box.high + room};
}

double reach_of(const Box& box) {
    const dvec3 reach = glm::max(glm::abs(box.low), glm::abs(box.high));
    return std::max({reach.x, reach.y, reach.z});
}

void check(const Surfaces& surfaces, std::size_t i) {
    const auto reject = [&](const char* why) {
        throw std::invalid_argument("polygon " + std::to_string(surfaces.id(i)) + " " + why);
    };
    if (!surfaces.polygon(i)) {
        const Box box = surfaces.bounds(i);
        for (int axis = 0; axis < 3; ++axis)
            if (!(std::abs(box.low[axis]) <= coordinate_limit &&
                  std::abs(box.high[axis]) <= coordinate_limit))
                reject("is of a curved surface that is not finite or reaches beyond 1e15 cells");
        return;
    }
    const Polygon& polygon = *surfaces.polygon(i);
    if (polygon.vertices.size() < 3) reject("has fewer than 3 vertices");
    for (const dvec3& vertex : polygon.vertices)
        for (int axis = 0; axis < 3; ++axis)
            if (!(std::abs(vertex[axis]) <= coordinate_limit))
                reject("has a vertex that is not finite or lies beyond 1e15 cells");
}

[[noreturn]] void fail(RTCError error, const std::string& what) {
    if (error == RTC_ERROR_OUT_OF_MEMORY) throw std::bad_alloc();
    throw std::runtime_error("Embree " + what + " (error " + std::to_string(int(error)) + ")");
}

/// Part of the ray inside a box, as an interval of t; empty if low > high.
struct Interval {
    double low;
    double high;
};
Interval clip_ray(const ProbeRay& ray, const Box& box, double t_max) {
    Interval inside{0, t_max};
    for (int axis = 0; axis < 3; ++axis) {
        const double from = ray.origin()[axis];
        const double step = ray.direction()[axis];
        if (step == 0) {
            if (from < box.low[axis] || from > box.high[axis]) return {1, 0};
            continue;
        }
        const double a = (box.low[axis] - from) / step;
        const double b = (box.high[axis] - from) / step;
        inside.low = std::max(inside.low, std::min(a, b));
        inside.high = std::min(inside.high, std::max(a, b));
    }
    return inside;
}

}  // namespace

std::vector<std::size_t> Surfaces::met() const {
    std::vector<std::size_t> numbers;
    std::vector<bool> flat(scene_.polygons.size(), true);
    if (of_ == TruthOf::scene) {
        for (std::size_t i = 0; i < flat.size(); ++i) {
            // Both are in the order of their ids; a clipped scene has lost some polygons.
            const auto after = std::upper_bound(
                scene_.curved.begin(), scene_.curved.end(), scene_.polygons[i].id,
                [](std::uint32_t id, const CurvedSurface& c) { return id < c.first_polygon; });
            flat[i] = after == scene_.curved.begin() || !std::prev(after)->owns(scene_.polygons[i].id);
        }
    }
    for (std::size_t i = 0; i < end(); ++i) {
        if (!polygon(i) || flat[i]) numbers.push_back(i);
    }
    return numbers;
}

Box Surfaces::bounds(std::size_t i) const {
    const Polygon* p = polygon(i);
    return p ? polygon_bounds(*p) : raycell::bounds_of(curved(i));
}

std::optional<double> Surfaces::meet(std::size_t i, const ProbeRay& ray, std::uint32_t leaves, double t_min,
                                     double t_max) const {
    if (const Polygon* p = polygon(i)) return p->id == leaves ? std::nullopt : ray.meet(*p, t_min, t_max);
    const CurvedSurface& surface = curved(i);
    return raycell::meet(surface, ray.origin(), ray.direction(), t_min, t_max,
                         surface.owns(leaves) ? std::optional(ray.started()) : std::nullopt,
                         scene_.within ? &*scene_.within : nullptr);
}

struct SurfaceIndex::Tree {
    const Surfaces surfaces;
    std::vector<std::size_t> apart;                 ///< surfaces tried for every ray
    std::vector<std::size_t> members;               ///< surfaces in Embree's tree, by its primitive ids
    Box bounds{dvec3(infinity), dvec3(-infinity)};  ///< of the members, padded
    double pad = 0;
    RTCDevice device = nullptr;
    RTCScene scene = nullptr;

    explicit Tree(const Surfaces& all) : surfaces(all) {}
    ~Tree() {
        if (scene) rtcReleaseScene(scene);
        if (device) rtcReleaseDevice(device);
    }

    void divide();
    void measure();
    void build();
    bool begin(RTCRay& ray, Query& query) const;

    static const Tree& of(const void* user) { return *static_cast<const Tree*>(user); }
    static void on_bounds(const RTCBoundsFunctionArguments* args);
    static void on_intersect(const RTCIntersectFunctionNArguments* args);
    static void on_occluded(const RTCOccludedFunctionNArguments* args);
};

void SurfaceIndex::Tree::on_bounds(const RTCBoundsFunctionArguments* args) {
    const Tree& tree = of(args->geometryUserPtr);
    Box box = tree.surfaces.bounds(tree.members[args->primID]);
    box.low -= tree.pad;
    box.high += tree.pad;
    *args->bounds_o = {float(box.low.x),  float(box.low.y),  float(box.low.z),  0,
                       float(box.high.x), float(box.high.y), float(box.high.z), 0};
}

void SurfaceIndex::Tree::on_intersect(const RTCIntersectFunctionNArguments* args) {
    if (!args->valid[0]) return;
    Query& query = Query::of(args->context);
    const Tree& tree = of(args->geometryUserPtr);
    if (!query.offer(tree.surfaces, tree.members[args->primID])) return;
    // Boxes are padded, so a box that begins beyond this holds nothing as near as the hit.
    reinterpret_cast<RTCRayHit*>(args->rayhit)->ray.tfar = float_above(query.t_max - query.start);
}

void SurfaceIndex::Tree::on_occluded(const RTCOccludedFunctionNArguments* args) {
    if (!args->valid[0]) return;
    const Tree& tree = of(args->geometryUserPtr);
    if (!Query::of(args->context).offer(tree.surfaces, tree.members[args->primID])) return;
    // Tells Embree to stop: something is in the way.
    reinterpret_cast<RTCRay*>(args->ray)->tfar = -std::numeric_limits<float>::infinity();
}

/// Keeps a few surfaces apart that reach much farther than all others, such as a floor to the horizon. In the
/// tree they would cost every other polygon its precision, and the padding would make the tree useless.
void SurfaceIndex::Tree::divide() {
    std::vector<std::pair<double, std::size_t>> by_reach;
    for (const std::size_t i : surfaces.met()) {
        check(surfaces, i);
        by_reach.emplace_back(reach_of(surfaces.bounds(i)), i);
    }
    const std::size_t most = std::min(most_apart, by_reach.size());
    std::partial_sort(by_reach.begin(), by_reach.begin() + std::ptrdiff_t(most), by_reach.end(),
                      [](const auto& a, const auto& b) { return a > b; });
    double others = 0;
    for (std::size_t i = most; i < by_reach.size(); ++i) others = std::max(others, by_reach[i].first);
    for (std::size_t i = 0; i < by_reach.size(); ++i) {
        const bool far = i < most && by_reach[i].first > 8 * others;
        (far ? apart : members).push_back(by_reach[i].second);
    }
    std::sort(members.begin(), members.end());  // the order of the scene: neighbours lie close together
}

/// Computes the members' box and the padding. The padding covers, with a factor of 3 to spare, the distance
/// by which single precision moves a point of the ray: half a unit in the last place of the origin, and of
/// the direction over the diagonal. The members' box bounds both, because Embree gets a ray only from where
/// it enters that box.
void SurfaceIndex::Tree::measure() {
    for (const std::size_t member : members) {
        const Box box = surfaces.bounds(member);
        bounds.low = glm::min(bounds.low, box.low);
        bounds.high = glm::max(bounds.high, box.high);
    }
    pad = 1e-3 + 16 * reach_of(bounds) * std::ldexp(1.0, -24);
    bounds.low -= pad;
    bounds.high += pad;
}

void SurfaceIndex::Tree::build() {
    // One thread: many programs may run beside each other, and building takes about a microsecond per
    // polygon.
    device = rtcNewDevice("threads=1");
    if (!device) fail(rtcGetDeviceError(nullptr), "has no device for this processor");
    scene = rtcNewScene(device);
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(members.size()));
    rtcSetGeometryUserData(geometry, this);
    rtcSetGeometryBoundsFunction(geometry, on_bounds, this);
    rtcSetGeometryIntersectFunction(geometry, on_intersect);
    rtcSetGeometryOccludedFunction(geometry, on_occluded);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene);
    const RTCError error = rtcGetDeviceError(device);
    if (error != RTC_ERROR_NONE)
        fail(error, "can't build its tree over " + std::to_string(members.size()) + " surfaces");
}

/// Sets up Embree's ray one pad before the query's ray enters the tree, so that rounding can't put the first
/// polygon behind its origin. False if the ray misses the tree.
bool SurfaceIndex::Tree::begin(RTCRay& ray, Query& query) const {
    if (!scene) return false;
    const Interval inside = clip_ray(query.ray, bounds, query.t_max);
    if (!(inside.low <= inside.high)) return false;
    query.start = inside.low - pad;
    const dvec3 origin = query.ray.at(query.start);
    const dvec3& direction = query.ray.direction();
    ray.org_x = float(origin.x);
    ray.org_y = float(origin.y);
    ray.org_z = float(origin.z);
    ray.dir_x = float(direction.x);
    ray.dir_y = float(direction.y);
    ray.dir_z = float(direction.z);
    ray.tnear = 0;
    ray.tfar = float_above(inside.high - query.start + pad);
    ray.time = 0;
    ray.mask = ~0u;
    ray.id = 0;
    ray.flags = 0;
    return true;
}

SurfaceIndex::SurfaceIndex(const Surfaces& surfaces) : tree_(std::make_unique<Tree>(surfaces)) {
    tree_->divide();
    if (tree_->members.empty()) return;
    tree_->measure();
    tree_->build();
}

SurfaceIndex::~SurfaceIndex() = default;

std::optional<SurfaceIndex::Nearest> SurfaceIndex::nearest(const ProbeRay& ray, std::uint32_t exclude,
                                                           double t_max) const {
    Query query(ray, exclude, t_max);
    for (const std::size_t surface : tree_->apart) query.offer(tree_->surfaces, surface);
    RTCRayHit embree_ray;
    if (tree_->begin(embree_ray.ray, query)) {
        embree_ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
        embree_ray.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
        rtcIntersect1(tree_->scene, &query.context, &embree_ray);
    }
    return query.chosen(tree_->surfaces);
}

bool SurfaceIndex::any(const ProbeRay& ray, std::uint32_t exclude, double t_max) const {
    Query query(ray, exclude, t_max);
    for (const std::size_t surface : tree_->apart)
        if (query.offer(tree_->surfaces, surface)) return true;
    RTCRay embree_ray;
    if (tree_->begin(embree_ray, query)) rtcOccluded1(tree_->scene, &query.context, &embree_ray);
    return !query.hits.empty();
}

}  // namespace raycell
