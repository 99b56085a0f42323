// Fields of messages and voxels as text: one list of fields serves all three classes, for writing, reading
// and naming them.
#pragma once

#include <array>
#include <charconv>
#include <cstdio>
#include <string>
#include <vector>

#include "model/geometry/polygon.hpp"
#include "testbench/golden/words.hpp"

namespace raycell {

/// A slot's word for the pixel: all ones on the wires.
constexpr const char* pixel_slot = "pixel";

class FieldWriter {
  public:
    explicit FieldWriter(const Words& words) : words_(words) {}
    const Formats& formats() const { return words_.formats(); }
    const Words::Form& form() const { return words_.form(); }
    void word(const char*, double value, const Format& format) { add(words_.word(format, value)); }
    void reciprocal(const char*, double value, double) { add(words_.reciprocal(value)); }
    void reach(const char*, double value) { add(words_.reach(value)); }
    template <typename T>
    void number(const char*, T value, std::uint64_t) {
        add(std::to_string(value));
    }
    /// -1: none.
    void polygon(const char*, std::uint32_t value) {
        add(value == no_polygon ? "-1" : std::to_string(value));
    }
    void slot(const char*, std::uint32_t value, bool of_pixel) {
        add(of_pixel ? pixel_slot : std::to_string(value));
    }
    /// 64 bits, 16 digits.
    void mask(const char*, std::uint64_t value) {
        char digits[20];
        std::snprintf(digits, sizeof digits, "%016llx", static_cast<unsigned long long>(value));
        add(digits);
    }
    std::string text;

  private:
    void add(const std::string& token) { text += " " + token; }
    const Words& words_;
};

class FieldReader {
  public:
    /// Reads from token `at` on.
    FieldReader(const Words& words, const std::vector<std::string>& tokens, std::size_t at = 1)
        : words_(words), tokens_(tokens), at_(at) {}
    const Formats& formats() const { return words_.formats(); }
    const Words::Form& form() const { return words_.form(); }
    void word(const char* name, double& value, const Format& format) {
        named(name, [&](const std::string& token) { value = words_.read_word(format, token); });
    }
    void reciprocal(const char* name, double& value, double direction) {
        named(name, [&](const std::string& token) { value = words_.read_reciprocal(token); });
        if (direction < 0) value = -value;
    }
    void reach(const char* name, double& value) {
        named(name, [&](const std::string& token) { value = words_.read_reach(token); });
    }
    template <typename T>
    void number(const char* name, T& value, std::uint64_t most) {
        const std::string& token = next(name);
        std::uint64_t read = 0;
        const char* const end = token.data() + token.size();
        const auto [stop, error] = std::from_chars(token.data(), end, read);
        if (stop != end || error != std::errc() || read > most)
            refuse(name, token, "a number from 0 to " + std::to_string(most));
        value = T(read);
    }
    void mask(const char* name, std::uint64_t& value) {
        const std::string& token = next(name);
        const char* const end = token.data() + token.size();
        const auto [stop, error] = std::from_chars(token.data(), end, value, 16);
        if (stop != end || error != std::errc()) refuse(name, token, "hexadecimal digits, 16 at most");
    }
    void polygon(const char* name, std::uint32_t& value) {
        if (at_ < tokens_.size() && tokens_[at_] == "-1") {
            ++at_;
            value = no_polygon;
        } else {
            number(name, value, no_polygon - 1);
        }
    }
    void slot(const char* name, std::uint32_t& value, bool& of_pixel) {
        of_pixel = at_ < tokens_.size() && tokens_[at_] == pixel_slot;
        if (of_pixel) {
            ++at_;
            value = 0;
        } else {
            number(name, value, 0xffffffffU);
        }
    }
    void finish() const {
        if (at_ == tokens_.size()) return;
        throw GoldenError("'" + tokens_[at_].substr(0, 60) + "': expected no more fields");
    }

  private:
    const std::string& next(const char* name) {
        if (at_ == tokens_.size()) throw GoldenError(std::string("field '") + name + "' is missing");
        return tokens_[at_++];
    }
    template <typename F>
    void named(const char* name, F&& read) {
        const std::string& token = next(name);
        try {
            read(token);
        } catch (const GoldenError& error) {
            throw GoldenError(std::string("field '") + name + "': " + error.what());
        }
    }
    [[noreturn]] static void refuse(const char* name, const std::string& token, const std::string& expected) {
        throw GoldenError(std::string("field '") + name + "': '" + token.substr(0, 60) + "': expected " +
                          expected);
    }
    const Words& words_;
    const std::vector<std::string>& tokens_;
    std::size_t at_;
};

class FieldNames {
  public:
    explicit FieldNames(const Words& words) : words_(words) {}
    const Formats& formats() const { return words_.formats(); }
    const Words::Form& form() const { return words_.form(); }
    void word(const char* name, double, const Format&) { add(name); }
    void reciprocal(const char* name, double, double) { add(name); }
    void reach(const char* name, double) { add(name); }
    template <typename T>
    void number(const char* name, T, std::uint64_t) {
        add(name);
    }
    void polygon(const char* name, std::uint32_t) { add(name); }
    void slot(const char* name, std::uint32_t, bool) { add(name); }
    void mask(const char* name, std::uint64_t) { add(name); }
    std::vector<std::string> all;

  private:
    void add(const char* name) { all.emplace_back(name); }
    const Words& words_;
};

/// Three components.
template <typename A, typename V>
void fields_of_vector(A& a, const std::array<const char*, 3>& names, V& v, const Format& format) {
    for (int axis = 0; axis < 3; ++axis) a.word(names[std::size_t(axis)], v[axis], format);
}

}  // namespace raycell
