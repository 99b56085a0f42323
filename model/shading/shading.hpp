// Whitted's model with Phong's highlight, the same for the machine, the exterior and the truth (design,
// section 7). A caller that passes no arithmetic computes exactly.
#pragma once

#include <cstdint>

#include "model/geometry/placement.hpp"
#include "model/geometry/scene.hpp"
#include "model/numbers/arithmetic.hpp"
#include "model/shading/lights.hpp"

namespace raycell {

/// A surface point, as shading needs it.
struct ShadePoint {
    dvec3 position{0, 0, 0};   ///< cell coordinates
    dvec3 direction{0, 0, 1};  ///< of the arriving ray, unit
    dvec3 normal{0, 0, -1};    ///< unit, turned towards the arriving ray
    bool entering = true;      ///< the ray came from the front (the side that the stored normal points to)
    SamplePlace shift;         ///< of the samples of sources
};

/// Normalises a field's normal and turns it towards the ray. A vanishing normal falls back to the plane's.
ShadePoint shade_point(const dvec3& position, const dvec3& direction, const dvec3& raw_normal,
                       const dvec3& plane_normal, const Arithmetic& arithmetic = exact_arithmetic());

/// Direction and distance to a source, and whether the normal faces it and it shines this way (then a shadow
/// ray is worth sending).
struct SourceView {
    dvec3 direction{0, 0, 1};
    double distance = 0;  ///< infinite for a directional one
    double cosine = 0;    ///< N·L
    double emission = 1;  ///< share of its intensity that goes this way, 0..1
    bool faces() const { return cosine > 0 && emission > 0; }
};
SourceView view_source(const ShadePoint& point, const Source& source,
                       const Arithmetic& arithmetic = exact_arithmetic());

/// The same of a light: of its source, or of a sample of that.
SourceView view_light(const ShadePoint& point, const Lights& lights, std::size_t light,
                      const Arithmetic& arithmetic = exact_arithmetic());

/// Mirror direction of the arriving ray, unit.
dvec3 reflect_direction(const ShadePoint& point, const Arithmetic& arithmetic = exact_arithmetic());

/// Refracted direction by Snell's law; false on total internal reflection.
bool refract_direction(const ShadePoint& point, double ior, dvec3& out,
                       const Arithmetic& arithmetic = exact_arithmetic());

/// Weights of the secondary rays, 0 where the material sends none.
inline double mirror_share(const Material& m) { return m.mirror ? m.specular : 0.0; }
inline double transmit_share(const Material& m) { return m.transmit; }

/// Direction of the ray that carries the share T on: refracted, or mirrored on total internal reflection.
dvec3 transmit_direction(const ShadePoint& point, double ior,
                         const Arithmetic& arithmetic = exact_arithmetic());

/// Local part of the intensity: ambient 0.1·Kd·C, and e·I·(Kd·C·(N·L) + Ks·(R·L)^Shine) for each light whose
/// bit in `lit` is set, e its emission; a sample counts as its share of a source.
dvec3 local_intensity(const ShadePoint& point, const Material& material, const Lights& lights,
                      std::uint64_t lit, const Arithmetic& arithmetic = exact_arithmetic());

/// The same of sources without extent.
dvec3 local_intensity(const ShadePoint& point, const Material& material, const Source* sources,
                      std::size_t source_count, std::uint64_t lit,
                      const Arithmetic& arithmetic = exact_arithmetic());

/// local + Ks·reflected + T·refracted, in this order (bit-identity depends on the order).
dvec3 combine_intensity(const dvec3& local, const Material& material, const dvec3& reflected,
                        const dvec3& refracted, const Arithmetic& arithmetic = exact_arithmetic());

}  // namespace raycell
