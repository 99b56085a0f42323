// The door to the cell's arithmetic: the operators that cost a cell more than an addition or a
// multiplication. Walk, hit tests and shading call these, so another arithmetic (words of fixed length, table
// look-ups) replaces them here. Signs and whole parts of numbers (abs, floor, clamp) are wiring and stay
// where they are used.
#pragma once

#include <cmath>
#include <glm/glm.hpp>

namespace raycell::arith {

using glm::dvec3;

inline double reciprocal(double x) { return 1.0 / x; }
inline double square_root(double x) { return std::sqrt(x); }
inline double power(double base, double exponent) { return std::pow(base, exponent); }
inline double dot(const dvec3& a, const dvec3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline dvec3 normalise(const dvec3& v) { return v * reciprocal(square_root(dot(v, v))); }

}  // namespace raycell::arith
