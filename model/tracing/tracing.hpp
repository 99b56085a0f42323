// What a cell decides about a ray: pure functions, shared by the untimed machine and the timed cells.
#pragma once

#include "model/picture/picture.hpp"
#include "model/shading/shading.hpp"
#include "model/tracing/intersect.hpp"

namespace raycell {

class SyntheticTraffic;

/// What every cell knows once the scene is loaded: features, sources, background and viewer, in the machine's
/// arithmetic. `scene` keeps the original values, for the exterior.
struct Context {
    const CellScene& scene;
    const PictureSettings& settings;
    Arithmetic arithmetic;
    std::vector<Material> objects;
    Lights lights;
    dvec3 background{0, 0, 0};
    dvec3 eye{0, 0, 0};
    double depth = 1;                           ///< of the cube, cell widths
    double normal_offset = 0;                   ///< cells
    const SyntheticTraffic* traffic = nullptr;  ///< set: hits are drawn, not found in the scene (traffic.hpp)

    /// All arguments must outlive the context. Throws std::invalid_argument for number settings that
    /// Arithmetic rejects, for more lights than bits, and for settings that synthetic traffic does not
    /// support: see traffic_picture().
    Context(const CellScene& placed, const PictureSettings& picture_settings,
            const SyntheticTraffic* synthetic = nullptr);
};

/// Rounds features to words, as the cells latch them.
Material hold(const Material& material, const Arithmetic& arithmetic);

/// Rounds a source to words, as the cells latch it.
Source hold(const Source& source, const Arithmetic& arithmetic);

/// The outcome of a ray's test in a cell.
struct Visit {
    enum class Event : std::uint8_t {
        hit,            ///< meets a voxel
        forward,        ///< continues over `crossing`, perhaps over the array's border
        leaves_cube,    ///< leaves through the front or the back while in this cell
        reaches_source  ///< a shadow ray that nothing blocked
    };
    Crossing crossing;
    CellHit hit;  ///< leaves_cube: its t is the distance to the front or the back
    Comparisons comparisons;
    Event event = Event::forward;
    bool leaves = false;  ///< it would leave the cube before the cell's side: that took a division
};
Visit visit_cell(const CellStore& store, const Ray& ray, const Context& context,
                 const IndexTable& index = {});

/// Cycles that the traversal unit needs for a visit.
std::uint32_t visit_cycles(const Visit& visit, const PictureSettings& settings, const CostTable& costs);

/// What is behind a face that a ray leaves through: nothing (background, lit) or work for the exterior.
enum class Beyond { nothing, exterior };
Beyond beyond_face(const Context& context, Face face);
inline Face face_of(Side side) {
    return side == Side::east    ? face_right
           : side == Side::west  ? face_left
           : side == Side::south ? face_bottom
                                 : face_top;
}
inline Face face_of_depth(const Ray& ray) { return ray.direction.z > 0 ? face_back : face_front; }

/// Puts a ray that leaves through the front or the back on its way to the border.
void start_outside(Ray& ray, double t_leave, const Arithmetic& arithmetic);

/// A ray handed to the exterior: from where it left the cube, in the array's coordinates.
struct ExteriorRequest {
    dvec3 origin{0, 0, 0};
    dvec3 direction{0, 0, 1};
    double reach = 0;
};
/// `ray` is about to cross the array's border from cell (x, y). In fixed arithmetic the direction is made
/// unit again, and the distance to a source is computed from the source, because the exterior is exact.
ExteriorRequest exterior_request(const Context& context, const Ray& ray, const Crossing& crossing, int x,
                                 int y);
/// From where a ray left the cube back to where it had started, on the polygon that it leaves: 0 or negative,
/// cell widths.
double started_at(const CellScene& scene, const ExteriorRequest& request, const Ray& ray);
/// An intensity from the exterior, as a message carries it.
dvec3 exterior_answer(const Context& context, const dvec3& intensity);

/// Classical ray tracing outside the cube (paper, section 3.3, second solution).
class ExteriorTracer {
  public:
    virtual ~ExteriorTracer() = default;
    /// A primary ray's first hit is recorded in `pixel`.
    virtual dvec3 radiance(const ExteriorRequest& request, const Ray& ray, Pixel* pixel) const = 0;
    virtual bool blocked(const ExteriorRequest& request, const Ray& ray) const = 0;
};

/// A hit as the shading unit sees it: the point, and the rays worth sending from it.
struct HitSetup {
    ShadePoint point;
    dvec3 local{0, 0, 0};      ///< hit point relative to the cell
    std::uint64_t facing = 0;  ///< bit per light that the normal faces and that shines this way
    bool reflects = false;
    bool refracts = false;  ///< has a child for the share T, mirrored on total internal reflection
    dvec3 reflected{0, 0, 0};
    dvec3 refracted{0, 0, 0};
};
HitSetup set_up_hit(const Context& context, const CellStore& store, const Ray& ray, const CellHit& hit, int x,
                    int y);

/// Whether a hit of this ray may have to wait for answers; only then it needs a slot of the ray store.
bool may_wait(const Context& context, const Ray& ray, std::uint32_t object);

/// Number of generations that may have to wait: `reserved` keeps one slot for each.
int waiting_generations(const Context& context);

/// A primary ray of cell (x, y): number pixel · samples + sample, with the pixel's number in the cell's
/// block.
Ray primary_ray(const Context& context, int x, int y, int number = 0);

/// Whether a pixel's first hit is that of this ray: the primary ray of its first sample.
inline bool shows_first_hit(const Ray& ray) {
    return ray.kind == RayKind::primary && sample_of_id(ray.id) == 0;
}

/// Children of a ray that hit: the reflected (child 0), the refracted (child 1), a shadow ray (child =
/// light).
Ray reflected_ray(const Context& context, const CellStore& store, const Ray& parent, const CellHit& hit,
                  const HitSetup& setup, int x, int y);
Ray refracted_ray(const Context& context, const CellStore& store, const Ray& parent, const CellHit& hit,
                  const HitSetup& setup, int x, int y);
Ray shadow_ray(const Context& context, const CellStore& store, const Ray& parent, const CellHit& hit,
               const HitSetup& setup, std::size_t light, int x, int y);

/// A ray from a voxel's own point to a light (memo, precast); ray.slot is the voxel.
Ray voxel_shadow_ray(const Context& context, const CellStore& store, std::uint32_t voxel, std::size_t light,
                     RayKind kind, int x, int y);

/// The intensity of a hit, from the answers to its children.
dvec3 shade_hit(const Context& context, const HitSetup& setup, std::uint32_t object, std::uint64_t lit,
                const dvec3& reflected, const dvec3& refracted);

/// Cycles from a cell's primary ray to its next, which the injector makes meanwhile; 0 if it has only one,
/// which is made while the scene is loaded. A direction takes as long as one to a source.
std::uint32_t primary_cycles(const Context& context, const CostTable& costs);

/// Cycles of the shading unit.
std::uint32_t setup_cycles(const Context& context, const HitSetup& setup, const CostTable& costs);
/// `lit`: lights that face the surface and whose light arrives; `waited`: the hit was in a slot.
std::uint32_t shade_cycles(const Context& context, const HitSetup& setup, std::uint32_t object,
                           std::uint64_t lit, bool waited, const CostTable& costs);

/// A pixel of a cell's block after loading (--stage load): its nearest voxel along z, without shadows.
/// `gouraud`: a voxel has one intensity, so all pixels of the cell that see it are alike.
Pixel display_cell(const Context& context, const CellStore& store, int x, int y, int pixel = 0);

/// Records first-hit data in a pixel, from the primary ray's hit.
void record_first_hit(Pixel& pixel, const HitSetup& setup, std::uint32_t polygon);

/// Records that a pixel sees the background.
void record_background(Pixel& pixel);

}  // namespace raycell
