// rtl_tb: raycell render with verilated cells in places of the array.
#include <iostream>
#include <systemc>

#include "testbench/common/cell_ranges.hpp"
#include "testbench/common/entry.hpp"
#include "testbench/common/help.hpp"
#include "testbench/common/new_file.hpp"
#include "testbench/common/version.hpp"
#include "testbench/raycell/command_line.hpp"
#include "testbench/raycell/commands.hpp"
#include "testbench/raycell/render_hooks.hpp"
#include "testbench/rtl/array/cell_library.hpp"
#include "testbench/rtl/array/rtl_socket.hpp"
#include "testbench/rtl/package.hpp"
#include "testbench/rtl/whole_files.hpp"

namespace raycell {
namespace {

struct RtlOptions {
    std::vector<CellRange> cells;
    RtlFrom from = RtlFrom::load;
    std::string library;
    std::string package;
    std::string header;
    std::string units;
    WholeSizes sizes;
    int fault = 0;
};

/// The RTL cells of a run.
class RtlRun {
  public:
    RenderHooks hooks();

  private:
    void add_options(CLI::App& app);
    void check(const RenderOptions& options) const;
    bool placed(const RenderOptions& options, const CellScene& scene);
    std::unique_ptr<CellSocket> make(const char* name, Environment& environment, int x, int y);
    int ended(int code) const;

    RtlOptions options_;
    std::unique_ptr<OptionTable> table_;
    std::unique_ptr<CellLibrary> library_;
    Disagreements disagreements_;
};

RenderHooks RtlRun::hooks() {
    return {[this](CLI::App& app) { add_options(app); },
            [this](const RenderOptions& options) { check(options); },
            [this](const RenderOptions& options, const CellScene& scene) { return placed(options, scene); },
            [this](const char* name, Environment& environment, int x, int y) {
                return make(name, environment, x, y);
            },
            [this](int code) { return ended(code); }};
}

void RtlRun::add_options(CLI::App& app) {
    table_ = std::make_unique<OptionTable>(app);
    table_->group("RTL cells");
    table_->cells("rtl", options_.cells, "cells in whose places RTL cells stand");
    table_->choice<RtlFrom>(
        "rtl-from", options_.from, {{"load", RtlFrom::load}, {"trace", RtlFrom::trace}},
        "who loads them: the RTL cells themselves, or the model's cells, up to the trace");
    table_->text("rtl-cell", options_.library, "FILE.so",
                 "library of the cell, verilated for this run's machine (testbench/rtl/render.py makes it)");
    table_->text("rtl-package", options_.package, "FILE.sv",
                 "write the package of this run's machine, and run nothing");
    table_->text("rtl-header", options_.header, "FILE.hpp", "the same for the C++ header");
    table_->text("rtl-units", options_.units, "FOLDER",
                 "the same for what the whole cell needs: microprograms, calls, sizes");
    table_->number("rtl-voxels", options_.sizes.voxels, 2, 1 << 14,
                   "with --rtl-units: voxels that a cell holds");
    table_->number("rtl-edges", options_.sizes.edges, 1, 1 << 16,
                   "with --rtl-units: edges of all its voxels");
    table_->number("rtl-fault", options_.fault, 0, 1000, "error to be put into every RTL cell; 0: none");
}

void RtlRun::check(const RenderOptions& options) const {
    refuse_ranks("rtl_tb");
    check_inside("--rtl", options_.cells, options.picture);
    if (options.engine == Engine::untimed)
        throw UsageError("--engine untimed: it has no cells to replace; expected timed");
    if (!options.frames.empty() && options.frame == 0)
        throw UsageError("--frames: RTL cells are in a run of one frame; expected --frame, too");
    const bool prints = !options_.package.empty() || !options_.header.empty() || !options_.units.empty();
    if (!prints && !options_.cells.empty() && options_.library.empty())
        throw UsageError("--rtl: expected --rtl-cell FILE.so, too, the library of the cell");
    if (options_.from == RtlFrom::load && !options.load_array.empty() && !options_.cells.empty())
        throw UsageError("--load-array: RTL cells would not be loaded; expected --rtl-from trace");
}

bool RtlRun::placed(const RenderOptions& options, const CellScene& scene) {
    const Context context(scene, options.picture);
    const RtlPackage package(context, options.machine);
    const std::string text = package.verilog();
    if (!options_.package.empty()) write_text(options_.package, text);
    if (!options_.header.empty()) write_text(options_.header, package.header());
    if (!options_.units.empty())
        write_units(options_.units, whole_files(context, options.machine, options_.sizes));
    if (!options_.package.empty() || !options_.header.empty() || !options_.units.empty()) return false;
    if (options_.cells.empty()) return true;
    if (options_.from == RtlFrom::load && viewer_of(context).tells_kinds)
        throw UsageError(
            "--rtl-from load: the RTL cell passes on viewer's messages of point sources alone; "
            "expected --rtl-from trace");
    library_ = std::make_unique<CellLibrary>(options_.library, text, options_.fault);
    return true;
}

std::unique_ptr<CellSocket> RtlRun::make(const char* name, Environment& environment, int x, int y) {
    const bool here = std::any_of(options_.cells.begin(), options_.cells.end(),
                                  [&](const CellRange& range) { return range.contains(x, y); });
    if (!here) return nullptr;
    return std::make_unique<RtlSocket>(name, environment, library_->make(x, y), options_.from,
                                       disagreements_);
}

int RtlRun::ended(int code) const {
    if (disagreements_.count() == 0) return code;
    std::cerr << "rtl_tb: the RTL cells did otherwise than the model " << disagreements_.count()
              << " times\n";
    return exit_comparison;
}

int run(int argc, char** argv) {
    CLI::App program{"raycell render with verilated cells in places of the array"};
    program.name("rtl_tb");
    program.formatter(std::make_shared<HelpFormatter>());
    add_version(program);
    program.require_subcommand(1);
    // Never destroyed, like the machine, whose cells use it.
    static RtlRun* const rtl = new RtlRun;
    const Command render = add_render_command(program, rtl->hooks());
    std::vector<std::string> words(argv + 1, argv + argc);
    if (!words.empty() && words.front() == "render") words = with_configuration(program, words, *render.app);
    try {
        parse(program, words);
    } catch (const CLI::ParseError& error) {
        return end_of_parsing(program, error);
    }
    return render.run();
}

}  // namespace
}  // namespace raycell

int sc_main(int argc, char** argv) {
    return raycell::run_guarded("rtl_tb", "a smaller array or scene",
                                [&] { return raycell::run(argc, argv); });
}
