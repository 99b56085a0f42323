// The studies, one function each; main.cpp lists them with a sentence.
#pragma once

#include "testbench/stability/report.hpp"

namespace raycell::stability {

Report study_slopes(const Effort& effort);
Report study_dda_drift(const Effort& effort);
Report study_span_drift(const Effort& effort);
Report study_normals(const Effort& effort);
Report study_grazing(const Effort& effort);
Report study_critical(const Effort& effort);
Report study_mirrors(const Effort& effort);
Report study_offset(const Effort& effort);
Report study_near_viewer(const Effort& effort);
Report study_coincident(const Effort& effort);
Report study_small(const Effort& effort);
Report study_chord_error(const Effort& effort);
Report study_loading_order(const Effort& effort);
Report study_saturation(const Effort& effort);

}  // namespace raycell::stability
