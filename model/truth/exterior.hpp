// The exterior processors' work: traces a ray on from where it left the cube, with the truth renderer's code
// (paper, section 3.3).
#pragma once

#include "model/tracing/tracing.hpp"
#include "model/truth/truth.hpp"

namespace raycell {

class ClassicalExterior : public ExteriorTracer {
  public:
    /// The renderer must have been made from this scene, with the settings of the machine's ray tree; both
    /// must outlive this object. It meets spheres and cones as such, unless it renders polygons.
    ClassicalExterior(const CellScene& scene, const TruthRenderer& truth);
    dvec3 radiance(const ExteriorRequest& request, const Ray& ray, Pixel* pixel) const override;
    bool blocked(const ExteriorRequest& request, const Ray& ray) const override;

  private:
    const CellScene& scene_;
    const TruthRenderer& truth_;
};

}  // namespace raycell
