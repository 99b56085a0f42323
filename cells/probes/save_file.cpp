#include "cells/probes/save_file.hpp"

#include <cmath>
#include <cstdio>

namespace raycell {
namespace {

// Flags of a line, from GTKWave's analyzer.h.
constexpr unsigned decimal = 0x4;
constexpr unsigned binary = 0x8;
constexpr unsigned right = 0x20;
constexpr unsigned blank = 0x200;
constexpr unsigned ascii = 0x800;
constexpr unsigned closed = 0x400000;
constexpr unsigned group_begin = 0x800000;
constexpr unsigned group_end = 0x1000000;
constexpr unsigned collapsed = 0x1000;

using Kind = VcdWriter::Declaration::Kind;

class Writer {
  public:
    explicit Writer(std::string text) : text_(std::move(text)) {}

    void declare(const VcdWriter::Declaration& d) {
        if (d.kind == Kind::scope) {
            open(d.name);
        } else if (d.kind == Kind::end_of_scope) {
            close();
        } else {
            signal(d);
        }
    }
    const std::string& text() const { return text_; }

  private:
    void flags(unsigned value) {
        if (value == flags_) return;
        flags_ = value;
        char digits[16];
        std::snprintf(digits, sizeof digits, "@%x\n", value);
        text_ += digits;
    }
    void open(const std::string& name) {
        scopes_.push_back(name);
        if (scopes_.size() == 1) return;  // the root
        if (scopes_.size() == 2) ++groups_;
        flags(group_begin | blank | (shut() ? closed : 0));
        text_ += "-" + name + "\n";
    }
    void close() {
        if (scopes_.size() > 1) {
            flags(group_end | blank | (shut() ? closed | collapsed : 0));
            text_ += "-" + scopes_.back() + "\n";
        }
        scopes_.pop_back();
    }
    /// Whether the current group is closed at first: the user opens it.
    bool shut() const { return groups_ > 1 && scopes_.size() == 2; }

    void signal(const VcdWriter::Declaration& d) {
        flags(d.kind == Kind::flag     ? binary | right
              : d.kind == Kind::number ? decimal | right
                                       : ascii | right);
        std::string path;
        for (const std::string& scope : scopes_) path += scope + ".";
        path += d.name;
        if (d.bits > 1) path += "[" + std::to_string(d.bits - 1) + ":0]";
        text_ += path + "\n";
    }

    std::string text_;
    std::vector<std::string> scopes_;
    unsigned flags_ = 0;
    int groups_ = 0;
};

}  // namespace

std::string gtkwave_save_file(const std::vector<VcdWriter::Declaration>& declarations,
                              const std::string& name, std::uint64_t from, std::uint64_t cycle) {
    // GTKWave's zoom: 200 pixels show 2^-zoom units of time.
    constexpr double pixels_per_cycle = 8;
    const double zoom = -std::log2(double(cycle) * 200 / pixels_per_cycle);
    Writer writer("[*] raycell\n[dumpfile] \"" + name + ".vcd\"\n[savefile] \"" + name +
                  ".gtkw\"\n[timestart] " + std::to_string(from) + "\n[size] 1600 900\n[pos] -1 -1\n*" +
                  std::to_string(zoom) + " -1\n[sst_expanded] 0\n[signals_width] 260\n");
    for (const auto& declaration : declarations) writer.declare(declaration);
    return writer.text();
}

}  // namespace raycell
