// Numbers in golden vectors: the integers that a hardware register holds.
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

#include "model/numbers/arithmetic.hpp"

namespace raycell {

/// An error in golden vectors or in the stimuli of a cell: where, what, what was allowed.
struct GoldenError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// The words of a line, separated by blanks.
std::vector<std::string> tokens_of(const std::string& line);

/// Converts numbers to text and back without loss. A word is its integer, in units of its format's last bit.
/// A floating number is mantissa:exponent, with the value mantissa · 2^(exponent - bits + 1) and a mantissa
/// of `bits` bits beside the sign (zero is 0:0). A number that is not a word (exact arithmetic) is C's
/// hexadecimal floating point; infinity is "inf".
class Words {
  public:
    /// What the fields of a span depend on.
    struct Form {
        HitTest hit;
        Normals normals;
        bool gouraud;
    };
    explicit Words(const Arithmetic& arithmetic, const PictureSettings& picture = {})
        : arithmetic_(arithmetic), form_{picture.hit, picture.normals, picture.display == Display::gouraud} {}
    const Form& form() const { return form_; }
    const Formats& formats() const { return arithmetic_.formats(); }
    bool exact() const { return arithmetic_.exact(); }

    std::string word(const Format& format, double value) const;
    std::string floating(int bits, double value) const;
    /// The size of 1/dx as a message carries it: mantissa:exponent, with the value mantissa ·
    /// 2^(exponent - word_bits + 1). Its sign is the direction's.
    std::string reciprocal(double value) const;
    /// A distance to a source; the word's largest value is infinite.
    std::string reach(double value) const;
    /// They throw GoldenError for text that is not a number of this kind.
    double read_word(const Format& format, const std::string& text) const;
    double read_floating(int bits, const std::string& text) const;
    double read_reciprocal(const std::string& text) const;
    double read_reach(const std::string& text) const;

    /// C's hexadecimal floating point, whatever the arithmetic, or "inf".
    static std::string hexadecimal(double value);
    static double read_hexadecimal(const std::string& text);

  private:
    const Arithmetic& arithmetic_;
    Form form_;
};

}  // namespace raycell
