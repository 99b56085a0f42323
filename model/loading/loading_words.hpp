// The two arithmetics of loading: doubles, and the words of a cell that makes its voxels.
#pragma once

#include <algorithm>
#include <cmath>

#include "model/geometry/polygon.hpp"
#include "model/loading/trapeze.hpp"
#include "model/numbers/arithmetic.hpp"
#include "model/numbers/tolerance.hpp"

namespace raycell {

template <typename N>
struct Line {  // a·u + b·v + c >= 0 inside
    N a;
    N b;
    N c;
};
template <typename N>
struct Corner {
    N u;
    N v;
};

/// Exact arithmetic: numbers are doubles.
struct Doubles {
    using Number = double;
    explicit Doubles(const Arithmetic&) {}
    static double room() { return exact_hair; }
    static double number(double x) { return x; }
    static double back(double n) { return n; }
    static double value(const Line<double>& line, const Corner<double>& p) {
        return line.c + (line.a * p.u + line.b * p.v);
    }
    static double between(double from, double to, double d_from, double d_to) {
        return from + (to - from) * (d_from / (d_from - d_to));
    }
    static double share(double sum, int n) { return sum / n; }
    static double product(double a, double b) { return a * b; }
    /// low + size·n / 2^bits.
    static double step(double low, double size, int n, int bits) { return low + size * n / (1 << bits); }
    /// offset / size in parts of 2^-bits, down and up.
    static int parts_down(double offset, double size, int bits) {
        return int(std::floor(offset / size * (1 << bits)));
    }
    static int parts_up(double offset, double size, int bits) {
        return int(std::ceil(offset / size * (1 << bits)));
    }
    /// The plane's third coordinate as a function of the other two.
    static Line<double> height(const Plane& plane, int drop) {
        const Projection axes = projection(drop);
        const double n = plane.n[drop];
        return {-plane.n[axes.u] / n, -plane.n[axes.v] / n, plane.c / n};
    }
};

/// Fixed arithmetic: numbers count last bits of loading words. What lies behind the last bit is cut off.
struct LoadingWords {
    using Number = std::int64_t;
    explicit LoadingWords(const Arithmetic& arithmetic)
        : fraction_(arithmetic.formats().loading.fraction_bits()),
          quotient_(arithmetic.formats().loading.bits() - 1),
          per_step_(scale_by(1, fraction_)),
          step_(scale_by(1, -fraction_)),
          room_(std::max(number(arithmetic.formats().unit.step()), Number(1))) {}
    Number room() const { return room_; }
    Number number(double x) const { return Number(std::floor(x * per_step_)); }
    double back(Number n) const { return double(n) * step_; }
    Number product(Number a, Number b) const { return cut_off(__int128(a) * b); }
    Number value(const Line<Number>& line, const Corner<Number>& p) const {
        return line.c + cut_off(__int128(line.a) * p.u + __int128(line.b) * p.v);
    }
    Number between(Number from, Number to, Number d_from, Number d_to) const {
        return from + Number(__int128(to - from) * quotient(d_from, d_from - d_to) >> quotient_);
    }
    /// sum / n by a product with the constant 2^32 / n, cut off.
    static Number share(Number sum, int n) {
        return Number(__int128(sum) * ((std::int64_t(1) << 32) / n) >> 32);
    }
    static Number step(Number low, Number size, int n, int bits) { return low + (size * n >> bits); }
    static int parts_down(Number offset, Number size, int bits) {
        // Where loading words have no fraction, a cell may have no width: all of it.
        if (size <= 0) return offset < 0 ? -(1 << bits) : 0;
        const Number parts = offset * (1 << bits);
        return int(parts >= 0 ? parts / size : -((-parts + size - 1) / size));
    }
    static int parts_up(Number offset, Number size, int bits) { return -parts_down(-offset, size, bits); }
    Line<Number> height(const Plane& plane, int drop) const {
        const Projection axes = projection(drop);
        const Number sign = plane.n[drop] < 0 ? -1 : 1;  // it is 1 or -1
        return {-sign * number(plane.n[axes.u]), -sign * number(plane.n[axes.v]), sign * number(plane.c)};
    }

  private:
    /// a·2^quotient_ / b, cut off, for 0 < a <= b. A double is near enough to be right but for the last bits.
    Number quotient(Number a, Number b) const {
        auto q = Number(double(a) / double(b) * scale_by(1, quotient_));
        __int128 rest = (__int128(a) << unsigned(quotient_)) - __int128(q) * b;
        for (; rest < 0; rest += b) --q;
        for (; rest >= b; rest -= b) ++q;
        return q;
    }

    /// A sum of products of words as a word. Short words in a very deep cube have no fraction at all.
    Number cut_off(__int128 sum) const {
        return fraction_ >= 0 ? Number(sum >> fraction_) : Number(sum * (__int128(1) << -fraction_));
    }

    int fraction_;
    int quotient_;  ///< fraction bits of a quotient
    double per_step_;
    double step_;
    Number room_;
};

}  // namespace raycell
