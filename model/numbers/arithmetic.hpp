// The cell's arithmetic, exact (double precision) or fixed (words), chosen at run time. Walk, hit tests and
// shading are written once, for both: every value that a register, a voxel or a message keeps is rounded to a
// format. In exact arithmetic a format changes nothing.
#pragma once

#include <cmath>
#include <glm/glm.hpp>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "model/numbers/fixed.hpp"
#include "model/numbers/operators.hpp"
#include "model/settings/settings.hpp"

namespace raycell {

using glm::dvec3;

/// Dimensions of an array, in cell widths. The formats depend on them and on the word length.
struct ArrayExtent {
    int width = 1;
    int height = 1;
    double depth = 1;
    double level = 1;
};

/// The formats of one machine; docs/reference/numbers.md has their table. F = word_bits - 2. They determine
/// the bits of messages and voxels in exact arithmetic too.
struct Formats {
    int word_bits = 20;
    int depth_bits = 0;  ///< integer bits of a depth within the cube
    Format unit;         ///< Q2.F: place in a cell, directions, slopes, cosines, shares of intensity
    Format depth;        ///< F fraction bits, integer part to the cube's depth: z, offset from a plane
    Format distance;     ///< F fraction bits, integer part to the cube's diagonal: t in a cell (register)
    Format reach;        ///< word_bits: distance to a source; the largest value counts as infinite
    Format offset;       ///< word_bits: a plane's offset, relative to the cell and to its voxel's run
    Format edge_offset;  ///< F fraction bits: an edge's offset, over the run
    Format normal;       ///< word_bits, Q4: normal field
    Format field;        ///< Q6.(F + 2): vectors before they are normalised, read from the accumulator
    Format accumulator;  ///< Q4.2F, 44 bits at most: a dot product of words before it is rounded
    Format intensity;    ///< word_bits, Q4: intensities, saturating at 8
    Format feature;      ///< unsigned Q2, 12 bits, longer in words of over 20: colours, Kd, Ks, T
    Format ior;          ///< unsigned Q2, 16 bits, longer in words of over 20: index of refraction
    Format loading;      ///< word_bits + 16: polygons, trapezes, spans; guard bits for their increments
    Format from;         ///< Q4.(word_bits + 11): a point as a share of a place's power of two (way())

    /// Throws std::invalid_argument for a word length outside 8 to 32.
    Formats(int word_bits, Rounding rounding, const ArrayExtent& extent);
    Formats() : Formats(20, Rounding::nearest, ArrayExtent()) {}

    int feature_bits() const { return feature.bits() - 1; }  ///< without the sign
    int ior_bits() const { return ior.bits() - 1; }
    int depth_word_bits() const { return depth_bits + word_bits; }  ///< of a depth in a message or a voxel
    int place_bits() const { return 3 * (word_bits + 12) + exponent_bits; }
    /// The exponent of a place's three mantissas: all of them, and all coordinates of the array, are below
    /// 2^it.
    int place_exponent(const dvec3& place) const;
    int array_exponent = 0;  ///< of the array's coordinates
    static constexpr int exponent_bits = 6;
    static constexpr int shine_exponent_bits = 5;  ///< from 2^-8; 0 is none
    int shine_bits = 12;  ///< a float: 5 exponent bits and 7 fraction bits, more in words of over 20

    /// The formats by name, as "Q2.18"; unsigned ones as "UQ2.10".
    std::vector<std::pair<std::string, std::string>> names() const;
};

class Arithmetic {
  public:
    /// Double precision.
    Arithmetic();
    /// Throws std::invalid_argument for a word length outside 8 to 32, or a table size that is not allowed.
    Arithmetic(const NumberSettings& settings, const ArrayExtent& extent);

    bool exact() const { return exact_; }
    const Formats& formats() const { return formats_; }

    double hold(const Format& f, double x) const { return exact_ ? x : f.hold(x); }
    dvec3 hold(const Format& f, const dvec3& v) const {
        return exact_ ? v : dvec3(f.hold(v.x), f.hold(v.y), f.hold(v.z));
    }

    /// c + a·b (+ ...), one rounding at the end.
    double mac(const Format& f, double c, double a, double b) const {
        if (exact_) return c + a * b;
        return narrow_ ? f.hold(c + a * b) : wide(f, c, a, b, 0, 0, 0, 0);
    }
    double mac(const Format& f, double c, double a1, double b1, double a2, double b2) const {
        if (exact_) return c + a1 * b1 + a2 * b2;
        return narrow_ ? f.hold(a1 * b1 + a2 * b2 + c) : wide(f, c, a1, b1, a2, b2, 0, 0);
    }
    double mac(const Format& f, double c, double a1, double b1, double a2, double b2, double a3,
               double b3) const {
        if (exact_) return c + (a1 * b1 + a2 * b2 + a3 * b3);
        return narrow_ ? f.hold(a1 * b1 + a2 * b2 + a3 * b3 + c) : wide(f, c, a1, b1, a2, b2, a3, b3);
    }
    /// The same for factors longer than a word, loading words among them.
    double long_mac(const Format& f, double c, double a1, double b1, double a2 = 0, double b2 = 0,
                    double a3 = 0, double b3 = 0) const {
        if (exact_) return c + (a1 * b1 + a2 * b2 + a3 * b3);
        return wide(f, c, a1, b1, a2, b2, a3, b3);
    }
    double product(const Format& f, double a, double b) const { return mac(f, 0.0, a, b); }
    double dot(const Format& f, const dvec3& a, const dvec3& b) const {
        return mac(f, 0.0, a.x, b.x, a.y, b.y, a.z, b.z);
    }
    /// c + s·v, per component.
    dvec3 along(const Format& f, const dvec3& c, double s, const dvec3& v) const {
        return {mac(f, c.x, s, v.x), mac(f, c.y, s, v.y), mac(f, c.z, s, v.z)};
    }

    /// 1/x for x != 0: a mantissa of word_bits bits with an exponent of its own.
    double reciprocal(double x) const { return exact_ ? 1.0 / x : operators_->reciprocal(x); }
    /// sqrt(x) = x/sqrt(x), x >= 0, as a unit word (x up to 4).
    double square_root(double x) const;
    double power(double base, double exponent) const {
        return exact_ ? std::pow(base, exponent) : operators_->power(base, exponent);
    }
    /// v/|v|; v is not 0. Fixed: shifted until its largest component fills a word, then 1/sqrt.
    dvec3 normalise(const dvec3& v) const;
    /// The same; also gives |v|, a word of `reach`.
    dvec3 normalise(const dvec3& v, double& length) const;
    /// place - point. Fixed: the point is rounded to the last bit of the place's mantissas first, then the
    /// difference is exact. It changes nothing of a place nearer than 8192 cells.
    dvec3 way(const dvec3& point, const dvec3& place) const;

    /// Tolerance of hit tests, in cells: a point this far outside an edge, or behind the end of a cell,
    /// counts as inside, so that neighbours leave no crack.
    double hair() const { return hair_; }
    /// Surfaces whose distances along a ray differ by no more than this (cells) tie: the lower polygon id
    /// counts.
    double tie() const { return tie_; }
    /// A ray that leaves a polygon and meets a neighbour of it nearer than this (cells) met it at their
    /// shared edge.
    double least_fresh_distance() const { return least_fresh_distance_; }
    /// The offset that a negative PictureSettings::normal_offset stands for, in cells; Context uses 0 instead
    /// where no offset is needed.
    double default_normal_offset() const { return default_normal_offset_; }

    /// Rounds a distance to a source. Returns infinity where the word saturates, since no way within the cube
    /// is that long.
    double hold_reach(double distance) const;
    /// Rounds a place that may lie far outside the array (source, viewer): word_bits + 12 bits per
    /// coordinate, one exponent for all three, at least the array's (Formats::place_exponent).
    dvec3 hold_place(const dvec3& place) const;

    /// Rounds Phong's power to the float that the features carry.
    double hold_shine(double shine) const;

  private:
    double wide(const Format& f, double c, double a1, double b1, double a2, double b2, double a3,
                double b3) const;

    bool exact_ = true;
    bool narrow_ = true;  ///< every sum of products fits a double's 53 bits
    double hair_;
    double tie_;
    double least_fresh_distance_;
    double default_normal_offset_;
    Formats formats_;
    Format mantissa_;  ///< Q1.(word_bits - 1)
    std::shared_ptr<const Operators> operators_;
};

/// The arithmetic of the truth and the exterior.
const Arithmetic& exact_arithmetic();

}  // namespace raycell
