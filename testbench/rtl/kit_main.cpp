// rtl_kit: what an RTL cell and its benches have to know of a machine, printed from the model.
#include <iostream>
#include <systemc>

#include "model/machine/load_wire.hpp"
#include "testbench/cell/record.hpp"
#include "testbench/common/entry.hpp"
#include "testbench/common/new_file.hpp"
#include "testbench/common/options.hpp"
#include "testbench/raycell/commands.hpp"
#include "testbench/rtl/package.hpp"
#include "testbench/rtl/whole_files.hpp"

namespace {

using namespace raycell;

struct Options {
    std::string record;
    std::string package;
    std::string header;
    bool setup = false;
    std::string cell;
    WholeSizes sizes;
};

/// The viewer's message of a record, as the cell would latch it: for records that begin when loading is over.
void print_setup(const std::string& name, const CellSetup& setup, const Context& context) {
    const LoadWire wire(setup.picture, context.arithmetic.formats());
    const WireBits bits = wire.pack(viewer_of(context));
    std::cout << name << ' ' << setup.x << ' ' << setup.y << ' ' << bits.size() << ' ' << bits.hex() << '\n';
}

int run(const Options& options) {
    const Record record = record_of_file(options.record);
    const Context context(record.setup.scene, record.setup.picture);
    const RtlPackage package(context, record.setup.machine);
    if (!options.package.empty()) write_text(options.package, package.verilog());
    if (!options.header.empty()) write_text(options.header, package.header());
    if (!options.cell.empty()) {
        write_units(options.cell, whole_files(context, record.setup.machine, options.sizes));
    }
    if (options.setup) print_setup(options.record, record.setup, context);
    if (options.package.empty() && options.header.empty() && options.cell.empty() && !options.setup)
        std::cout << package.verilog();
    return exit_done;
}

int run(int argc, char** argv) {
    CLI::App app{
        "The SystemVerilog package of a recorded machine: message layouts, widths, codes, constants"};
    app.name("rtl_kit");
    Options options;
    app.add_option("record", options.record, "golden vectors: their head has the machine")
        ->type_name("FILE")
        ->required();
    app.add_option("--package", options.package, "write the package here instead of printing it")
        ->type_name("FILE.sv");
    app.add_option("--header", options.header, "write a C++ header for the benches")->type_name("FILE.hpp");
    app.add_option("--cell", options.cell,
                   "write here what the whole cell needs beside the package: microprograms, calls, sizes")
        ->type_name("FOLDER");
    app.add_option("--voxels", options.sizes.voxels, "with --cell: voxels that a cell holds")
        ->type_name("N")
        ->capture_default_str();
    app.add_option("--edges", options.sizes.edges, "with --cell: edges of all its voxels")
        ->type_name("N")
        ->capture_default_str();
    app.add_flag(
        "--setup", options.setup,
        "print the record's name, the cell's column and row, and the viewer's message: its bits, and "
        "hexadecimal digits");
    return parse_and_run(app, {argv + 1, argv + argc}, [&] { return run(options); });
}

}  // namespace

int sc_main(int argc, char** argv) {
    return raycell::run_guarded("rtl_kit", "a smaller record", [&] { return run(argc, argv); });
}
