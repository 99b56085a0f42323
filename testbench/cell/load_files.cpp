#include "testbench/cell/load_files.hpp"

#include <algorithm>

namespace raycell {
namespace {

std::string package_of(const LoadCalls& calls, const MicroImage& image, const UnitFiles& files,
                       const LoadSizes& sizes) {
    std::string text =
        "// Written by cell_tb: fields, calls and the script of loading.\npackage load;\n"
        "  // verilator lint_off UNUSEDPARAM\n" +
        files.constants + calls.constants();
    const auto number = [&](const char* name, std::size_t value) {
        text += constant_line(name, std::int64_t(value));
    };
    number("REGISTERS", image.register_count());
    number("INSTRUCTIONS", image.instruction_count());
    number("LINES", std::max<std::size_t>(image.table_lines(), 1));
    number("ACCUMULATOR_BITS", std::size_t(image.accumulator_bits()));
    number("VOXELS_WORDS", sizes.memories[0]);
    number("EDGES_WORDS", sizes.memories[1]);
    number("TABLE_WORDS", sizes.memories[2]);
    number("MEMORY_BITS",
           std::size_t(bits_of(*std::max_element(sizes.memories.begin(), sizes.memories.end()) + 1)));
    number("STORE_WORDS", sizes.ports[0]);
    number("STORE_BITS", std::size_t(bits_of(sizes.ports[0] + 1)));
    number("PORT_WORDS", *std::max_element(sizes.ports.begin(), sizes.ports.end()));
    number("PORT_BITS", std::size_t(bits_of(*std::max_element(sizes.ports.begin(), sizes.ports.end()) + 1)));
    return text + "endpackage\n";
}

}  // namespace

std::vector<std::pair<std::string, std::string>> load_files(const LoadCalls& calls, const MicroImage& image,
                                                            const LoadSizes& sizes) {
    const UnitFiles lists = unit_files(calls.unit(), image, 0);
    return {{"load.sv", package_of(calls, image, lists, sizes)},
            {"load_programs.hex", image.instruction_file()},
            {"load_tables.hex", image.table_file()},
            {"load_registers.hex", image.register_file()},
            {"load_copies.hex", lists.copies},
            {"load_calls.hex", lists.calls},
            {"load_script.hex", calls.script().file()}};
}

}  // namespace raycell
