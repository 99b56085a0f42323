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

/// A scope with its signals and the scopes in it.
struct Scope {
    std::string name;
    std::vector<const VcdWriter::Declaration*> signals;
    std::vector<Scope> scopes;
};

Scope tree_of(const std::vector<VcdWriter::Declaration>& declarations) {
    Scope top;
    std::vector<Scope*> path = {&top};
    for (const VcdWriter::Declaration& d : declarations) {
        if (d.kind == Kind::scope) {
            path.back()->scopes.push_back({d.name, {}, {}});
            path.push_back(&path.back()->scopes.back());
        } else if (d.kind == Kind::end_of_scope) {
            path.pop_back();
        } else {
            path.back()->signals.push_back(&d);
        }
    }
    return top.scopes.empty() ? top : top.scopes.front();
}

/// Buffers stand in a scope for each side, and in that of the distributor.
bool holds_buffers(const Scope& scope) {
    for (const char* side : {"east", "south", "west", "north", "distributor"}) {
        if (scope.name == side) return true;
    }
    return false;
}

class Writer {
  public:
    Writer(std::string text, const std::set<std::string>& quiet) : text_(std::move(text)), quiet_(quiet) {}

    /// The root's signals, then a group for each cell, the first of them open.
    void write(const Scope& root) {
        path_ = root.name;
        for (const auto* d : root.signals) signal(*d, path_);
        bool shut = false;
        for (const Scope& cell : root.scopes) {
            write_cell(cell, shut);
            shut = true;
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
    void open(const std::string& name, bool shut = false) {
        flags(group_begin | blank | (shut ? closed : 0));
        text_ += "-" + name + "\n";
    }
    void close(const std::string& name, bool shut = false) {
        flags(group_end | blank | (shut ? closed | collapsed : 0));
        text_ += "-" + name + "\n";
    }

    void write_cell(const Scope& cell, bool shut) {
        open(cell.name, shut);
        const std::string path = path_ + "." + cell.name;
        for (const Scope& scope : cell.scopes) {
            if (!holds_buffers(scope)) write_scope(scope, path);
        }
        write_buffers(cell, path, false);
        bool any = false;
        for (const Scope& side : cell.scopes) {
            for (const Scope& buffer : side.scopes)
                any = any || (holds_buffers(side) && is_quiet(cell, side, buffer));
        }
        if (any) {
            open("quiet buffers", true);
            write_buffers(cell, path, true);
            close("quiet buffers", true);
        }
        close(cell.name, shut);
    }
    bool is_quiet(const Scope& cell, const Scope& side, const Scope& buffer) const {
        return quiet_.count(cell.name + "." + side.name + "." + buffer.name) > 0;
    }
    void write_buffers(const Scope& cell, const std::string& path, bool quiet) {
        for (const Scope& side : cell.scopes) {
            if (!holds_buffers(side)) continue;
            for (const Scope& buffer : side.scopes) {
                if (is_quiet(cell, side, buffer) != quiet) continue;
                open(side.name + " " + buffer.name);
                for (const auto* d : buffer.signals) signal(*d, path + "." + side.name + "." + buffer.name);
                close(side.name + " " + buffer.name);
            }
        }
    }
    void write_scope(const Scope& scope, const std::string& path) {
        open(scope.name);
        for (const auto* d : scope.signals) signal(*d, path + "." + scope.name);
        for (const Scope& inner : scope.scopes) write_scope(inner, path + "." + scope.name);
        close(scope.name);
    }

    void signal(const VcdWriter::Declaration& d, const std::string& path) {
        flags(d.kind == Kind::flag     ? binary | right
              : d.kind == Kind::number ? decimal | right
                                       : ascii | right);
        text_ += path + "." + d.name;
        if (d.bits > 1) text_ += "[" + std::to_string(d.bits - 1) + ":0]";
        text_ += "\n";
    }

    std::string text_;
    const std::set<std::string>& quiet_;
    std::string path_;
    unsigned flags_ = 0;
};

}  // namespace

std::string gtkwave_save_file(const std::vector<VcdWriter::Declaration>& declarations,
                              const std::string& name, const SaveFileView& view,
                              const std::set<std::string>& quiet) {
    // GTKWave's zoom: 200 pixels show 2^-zoom units of time.
    constexpr double pixels_per_cycle = 8;
    const double zoom = -std::log2(double(view.cycle) * 200 / pixels_per_cycle);
    Writer writer("[*] raycell\n[dumpfile] \"" + name + ".vcd\"\n[savefile] \"" + name +
                      ".gtkw\"\n[timestart] " + std::to_string(view.from) +
                      "\n[size] 1600 900\n[pos] -1 -1\n*" + std::to_string(zoom) + " " +
                      std::to_string(view.marker) + "\n[sst_expanded] 0\n[signals_width] 380\n",
                  quiet);
    writer.write(tree_of(declarations));
    return writer.text();
}

}  // namespace raycell
